#!/usr/bin/python3
"""Charts of the stability study. Usage: plot_stability.py FOLDER. Reads the tables that `gcpdda-study
stability FOLDER` wrote and puts stability_map, rejected_variants and, where soak.csv exists, soak (PNG and
SVG) beside them; prints boundaries.csv where it exists."""

import argparse
import csv
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

DENSITY = 2600.0  # of the unit square, kg/m3
RUN_STIFFNESS = 1e8  # of the runs that limits.csv was measured on, Pa/m
RADIUS = 0.8  # spectral radius of the curves


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file)) or sys.exit(f"plot_stability.py: {path} has no rows")


def save(figure, folder, name):
    figure.tight_layout()
    for kind in ("png", "svg"):
        figure.savefig(folder / f"{name}.{kind}", dpi=150)
    plt.close(figure)


def of(table, **wanted):
    return [row for row in table if all(row[key] == value for key, value in wanted.items())]


MEMBERS = [
    ("leapfrog (default)", "generalized-alpha", "leapfrog", "C0"),
    ("start of the step", "generalized-alpha", "start", "C3"),
    ("predictor", "generalized-alpha", "predictor", "C1"),
    ("predictor at the end", "generalized-alpha", "predictor-end", "C2"),
    ("Newmark of DDA", "newmark-dda", "", "C4"),
]


def member(table, scheme, contact_time):
    found = of(table, scheme=scheme, contact_time=contact_time)
    radius = min({float(row["spectral_radius"]) for row in found}, key=lambda r: abs(r - RADIUS))
    return [row for row in found if float(row["spectral_radius"]) == radius]


def draw_growth(axes, growth):
    for name, scheme, contact_time, colour in MEMBERS:
        curve = member(growth, scheme, contact_time)
        w = [float(row["W"]) for row in curve]
        axes.plot(w, [float(row["theory"]) - 1.0 for row in curve], color=colour, label=name)
        axes.plot(w, [float(row["measured"]) - 1.0 for row in curve], "o", color=colour, ms=4, mfc="none")
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=1e-5)
    axes.set_yticks([-1e-1, -1e-3, -1e-5, 0.0, 1e-5, 1e-3, 1e-1, 10.0])
    axes.axhline(0.0, color="0.7", lw=0.8, zorder=0)
    axes.set_xlabel(r"$W=\omega\,\Delta t$")
    axes.set_ylabel("growth of the amplitude per step - 1")
    axes.set_title(f"Contact oscillation, spectral radius {RADIUS}\n(lines: theory, rings: runs)", fontsize=10)
    axes.legend(fontsize=8, loc="upper left")


def draw_map(axes, limits):
    """Lines dt = W_limit/omega of a unit square on a plane, stable below."""
    stiffness = [10.0**power for power in (6, 7, 8, 9, 10, 11)]
    for name, scheme, contact_time, colour in MEMBERS:
        row = member(of(limits, damping_ratio="0"), scheme, contact_time)[0]
        theory, measured = float(row["theory"]), float(row["measured"])
        if theory == 0.0:
            axes.fill_between(stiffness, 1e-7, 1.0, color=colour, alpha=0.12, lw=0,
                              label=f"{name}: grows at every step size")
            continue
        scale = [math.sqrt(DENSITY / k) for k in stiffness]
        axes.plot(stiffness, [theory * s for s in scale], color=colour, label=f"{name}: W = {theory:.3f}")
        axes.plot(RUN_STIFFNESS, measured * math.sqrt(DENSITY / RUN_STIFFNESS), "o", color=colour, mfc="none")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 0.3)
    axes.set_xlim(stiffness[0], stiffness[-1])
    axes.set_xlabel(r"joint stiffness $k_n$, Pa/m")
    axes.set_ylabel(r"time step $\Delta t$, s")
    axes.set_title("Largest stable step of a unit square\n(2600 kg/m$^3$): stable below its line; rings: runs", fontsize=10)
    axes.legend(fontsize=8, loc="lower left")


def draw_chains(axes, chains):
    for elasticity, colour in (("implicit", "C0"), ("explicit", "C3")):
        found = of(chains, elasticity=elasticity)
        x = [float(row["k_n L/E"]) for row in found]

        def squared(key):
            return [(float(row[key]) / float(row["omega_joint"])) ** 2 for row in found]

        axes.plot(x, squared("omega_max_theory"), color=colour, label=f"{elasticity}, theory of the chain")
        axes.plot(x, squared("omega_max_measured"), "o", color=colour, ms=5, mfc="none", label="runs")
        axes.plot(x, squared("product_bound_omega"), ":", color=colour, label="bound of the program")
    axes.axhline(4.0, color="0.6", lw=0.8)
    axes.text(1e3, 4.1, "4: rigid", ha="right", va="bottom", fontsize=8)
    axes.axhline(12.0, color="0.6", lw=0.8)
    axes.text(1e3, 12.3, "12: soft", ha="right", va="bottom", fontsize=8)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(3.0, 2e4)
    axes.set_xlabel(r"$k_n L/E$")
    axes.set_ylabel(r"$\omega_{\max}^2\,m/(k_n L)$")
    axes.set_title("Chain of ten deformable squares", fontsize=10)
    axes.legend(fontsize=8)


def draw_stability(folder):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.7))
    draw_growth(left, rows(folder / "growth.csv"))
    draw_map(middle, rows(folder / "limits.csv"))
    draw_chains(right, rows(folder / "chain_limits.csv"))
    save(figure, folder, "stability_map")


def draw_restitution(axes, table):
    for contact_time, colour in (("start", "C3"), ("leapfrog", "C0")):
        found = of(table, contact_time=contact_time)
        w = [float(row["W"]) for row in found]
        mean = [float(row["mean"]) for row in found]
        spread = [[m - float(row["lowest"]) for m, row in zip(mean, found)],
                  [float(row["highest"]) - m for m, row in zip(mean, found)]]
        axes.errorbar(w, mean, spread, fmt="o", color=colour, mfc="none", capsize=3, label=f"{contact_time}: runs")
        axes.plot(w, [float(row["predicted"]) for row in found], color=colour, label=f"{contact_time}: predicted")
    axes.set_xscale("log")
    axes.set_xlabel(r"$W=\omega\,\Delta t$")
    axes.set_ylabel("speed after over speed before")
    axes.set_title("One elastic rebound: time of the contact force", fontsize=10)


VARIANTS = {"trial configurations": "trial configurations (program)", "longest": "largest so far (program)",
            "current": "current length", "scaled": "current length, force scaled with it",
            "distributed": "distributed (program)", "piece normals": "along normals of the pieces",
            "resultant": "at the resultant"}


def draw_problem(axes, table, problem, title, label, log_y=True):
    variants = dict.fromkeys(row["variant"] for row in of(table, problem=problem))
    for i, variant in enumerate(variants):
        found = of(table, problem=problem, variant=variant)
        axes.plot([int(row["step"]) for row in found], [float(row["value"]) for row in found],
                  color=f"C{(0, 3, 1)[i]}", linestyle=("-", "--", ":")[i], label=VARIANTS.get(variant, variant), lw=1.6)
    if log_y:
        axes.set_yscale("log")
    if problem == "sheared and rocking":
        axes.set_ylim(top=20.0)  # room for the legend
    axes.set_xlabel("step")
    axes.set_ylabel(label)
    axes.set_title(title, fontsize=10)


def draw_paths(axes, table):
    styles = iter(("C0-o", "C3-o", "C0--s", "C3--s", "C0:^", "C3:^"))
    for path, variant in dict.fromkeys((row["path"], row["variant"]) for row in table):
        found = of(table, path=path, variant=variant)
        axes.loglog([int(row["steps"]) for row in found], [float(row["net_over_total"]) for row in found],
                    next(styles), ms=4, mfc="none", label=f"{path}: {variant}")
    axes.set_ylim(bottom=1e-13)
    axes.set_xlabel("steps of the path")
    axes.set_ylabel("net work over total work")
    axes.set_title("Closed paths in contact: potentials\n(flat face and corner: block strained by 3 %)", fontsize=10)


def draw_rejected(folder):
    figure, axes = plt.subplots(2, 3, figsize=(13, 8.2))
    friction = rows(folder / "friction_variants.csv")
    draw_restitution(axes[0][0], rows(folder / "restitution.csv"))
    energy = "energy over energy supplied"
    draw_problem(axes[0][1], friction, "sticking", "Sticking square: the spring is stretched by", energy)
    draw_problem(axes[0][2], friction, "sheared and rocking",
                 "Rocking square under shear:\njoint length in the tangential stiffness", energy)
    draw_problem(axes[1][0], friction, "rocking", "Rocking square: three dashpots", energy)
    draw_problem(axes[1][1], friction, "sliding", "Sliding square, 30/15 degrees: three dashpots", "relative error of the path")
    draw_paths(axes[1][2], rows(folder / "closed_paths.csv"))
    for cell in axes.flat:
        cell.legend(fontsize=8)
    save(figure, folder, "rejected_variants")


def draw_soak(folder):
    table = rows(folder / "soak.csv")
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.plot([float(row["block_steps"]) for row in table], [float(row["energy_ratio"]) for row in table], lw=1)
    axes.set_xlabel("block steps")
    axes.set_ylabel("energy / energy at the start")
    axes.set_title("Many steps without damping", fontsize=10)
    save(figure, folder, "soak")


def print_table(table):
    width = {key: max(len(key), *(len(row[key]) for row in table)) for key in table[0]}
    for row in [{key: key for key in width}, *table]:
        print("  ".join(row[key].ljust(width[key]) for key in width).rstrip())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    draw_stability(folder)
    draw_rejected(folder)
    if (folder / "soak.csv").exists():
        draw_soak(folder)
    if (folder / "boundaries.csv").exists():
        print_table(rows(folder / "boundaries.csv"))


if __name__ == "__main__":
    main()
