#!/usr/bin/python3
"""Chart of the flutter study. Usage: plot_flutter.py FOLDER. Reads flutter_map.csv and flutter_runs.csv, which
`gcpdda-study flutter FOLDER` wrote, and puts flutter.png beside them."""

import argparse
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

LEAST = 1e-3  # growth over omega where the colours begin


def rows(path):
    with open(path, newline="") as file:
        return [{key: value if key == "acts_at" else float(value) for key, value in row.items()}
                for row in csv.DictReader(file)] or sys.exit(f"plot_flutter.py: {path} has no rows")


def grid(table, angle, damping, key):
    """Growth by (k_n L/E, use), with both axes."""
    found = [row for row in table if row["joint_angle_deg"] == angle and row["damping_ratio"] == damping]
    use = sorted({row["use"] for row in found})
    softness = sorted({row["k_n L/E"] for row in found})
    place = {(row["k_n L/E"], row["use"]): row[key] for row in found}
    return use, softness, np.array([[place[s, u] for u in use] for s in softness])


def draw_map(axes, table, runs, angle, damping, key, acts_at):
    use, softness, growth = grid(table, angle, damping, key)
    mesh = axes.pcolormesh(use, softness, np.ma.masked_less(growth, LEAST), shading="nearest", cmap="inferno_r",
                           norm=LogNorm(LEAST, 0.5))
    for row in runs:
        if (row["acts_at"], row["joint_angle_deg"], row["damping_ratio"]) == (acts_at, angle, damping):
            grows = row["measured_over_omega"] > 5e-3
            axes.plot(row["use"], row["k_n L/E"], "^" if grows else "o", color="C0", mfc="C0" if grows else "none", ms=5)
    axes.set_yscale("log")
    axes.set_ylim(softness[0], softness[-1])
    axes.set_xlim(-1, 1)
    return mesh


def draw_limits(axes, table, angle):
    """Lines around what grows with a dashpot."""
    for damping, style in ((0.05, "-"), (0.2, ":")):
        use, softness, growth = grid(table, angle, damping, "growth_centre_over_omega")
        if growth.max() > LEAST:
            axes.contour(use, softness, growth, [LEAST], colors="C2", linestyles=style, linewidths=1.5)
        axes.plot([], [], color="C2", ls=style, label=f"limit with damping ratio {damping:g}")


def draw_comparison(axes, runs):
    for acts_at, colour, marker in (("centre of pressure", "C3", "^"), ("grip", "C0", "o")):
        found = [row for row in runs if row["acts_at"] == acts_at]
        axes.plot([row["theory_over_omega"] for row in found], [row["measured_over_omega"] for row in found], marker,
                  color=colour, mfc="none", ms=5, label=f"friction at the {acts_at}")
    top = 1.1 * max(row["theory_over_omega"] for row in runs)
    axes.plot([0, top], [0, top], color="0.6", lw=0.8, zorder=0)
    axes.set_xlabel(r"growth of the worst mode, theory, $\sigma/\omega_j$")
    axes.set_ylabel(r"growth in a run, $\sigma/\omega_j$")
    axes.set_title("Theory against runs, damping ratios 0 and 0.05", fontsize=10)
    axes.legend(fontsize=8, loc="upper left")


def draw_damping(axes, table):
    dampings = sorted({row["damping_ratio"] for row in table})
    angles = sorted({row["joint_angle_deg"] for row in table})
    for k, angle in enumerate(angles):
        worst = [grid(table, angle, d, "growth_centre_over_omega")[2].max() for d in dampings]
        axes.plot(dampings, worst, "-o", color=f"C{k}", mfc="none", label=f"centre of pressure, {angle:g} degrees")
    worst = [max(grid(table, angle, d, "growth_grip_over_omega")[2].max() for angle in angles) for d in dampings]
    axes.plot(dampings, worst, "k--s", mfc="none", label="grip, all angles")
    axes.set_xlabel("damping ratio of the joints")
    axes.set_ylabel(r"largest growth on the map, $\sigma/\omega_j$")
    axes.set_title("Dashpots of the joints do not stop the growth", fontsize=10)
    axes.legend(fontsize=8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    table = rows(folder / "flutter_map.csv")
    runs = rows(folder / "flutter_runs.csv")
    angles = sorted({row["joint_angle_deg"] for row in table})
    figure = plt.figure(figsize=(16, 9.5))
    top = figure.add_gridspec(1, 5, width_ratios=[1, 1, 1, 1, 0.05], left=0.05, right=0.95, top=0.9, bottom=0.57)
    bottom = figure.add_gridspec(1, 3, left=0.05, right=0.95, top=0.42, bottom=0.06, wspace=0.22)
    use_of_friction = r"use of friction, $T/(N\,\tan\varphi)$, $\varphi$ = 60 degrees"
    cells = [figure.add_subplot(top[k]) for k in range(4)]
    for axes, angle in zip(cells, angles):
        mesh = draw_map(axes, table, runs, angle, 0.0, "growth_centre_over_omega", "centre of pressure")
        draw_limits(axes, table, angle)
        axes.set_title(f"Centre of pressure (rejected),\njoints at {angle:g} degrees", fontsize=10)
        axes.set_xlabel(use_of_friction, fontsize=9)
    cells[0].set_ylabel(r"$k_n L/E$")
    cells[0].plot([], [], "^", color="C0", label="run without damping: grows")
    cells[0].plot([], [], "o", color="C0", mfc="none", label="run without damping: rests")
    cells[0].legend(fontsize=8, loc="lower center")
    bar = figure.colorbar(mesh, cax=figure.add_subplot(top[4]))
    bar.set_label(r"growth rate of the worst mode without" + "\n" + r"damping, $\sigma/\omega_j$; white: below $10^{-3}$")
    grip = figure.add_subplot(bottom[0])
    draw_map(grip, table, runs, angles[-1], 0.0, "growth_grip_over_omega", "grip")
    grip.set_title(f"Grip (the program), joints at {angles[-1]:g} degrees: no growth\n"
                   "(nor at any other angle or damping ratio)", fontsize=10)
    grip.set_xlabel(use_of_friction, fontsize=9)
    grip.set_ylabel(r"$k_n L/E$")
    draw_comparison(figure.add_subplot(bottom[1]), runs)
    draw_damping(figure.add_subplot(bottom[2]), table)
    figure.suptitle("Column of two deformable blocks between fixed plates, all joints stick under shear $T$ (positive: as under "
                    "compression along the column); " + r"$\omega_j=\sqrt{k_n/(\varrho L)}$", fontsize=11)
    figure.savefig(folder / "flutter.png", dpi=110)


if __name__ == "__main__":
    main()
