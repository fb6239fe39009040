#!/usr/bin/python3
"""plot_statics.py FOLDER: draws the tables of the statics study as statics.png: what a ratio of unbalanced forces
costs, how the cost grows, and how far the equilibrium is from that of slow loading."""

import argparse
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


LOOKS = {"static": ("tab:red", "o"), "kinetic damping": ("tab:blue", "s"), "local damping": ("tab:green", "^"),
         "slow loading": ("0.4", "D")}
SCENES = ["slope_jointed", "slope_jointed, 10 GPa", "wet_slope", "tunnel_jointed", "tunnel_jointed, 10 GPa", "deformable_tunnel",
          "wall", "pyramid", "slope_seeds"]
TARGETS = {"normal_off": 0.01, "displacement_off": 0.04}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file)) or sys.exit(f"plot_statics.py: {path} has no rows")


def finish(axes, x, y, title, **legend):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(x)
    axes.set_ylabel(y, fontsize=9)
    axes.set_title(title, fontsize=11)
    axes.grid(True, alpha=0.3)
    axes.legend(**{"fontsize": 8} | legend)


def draw_cost(axes, rows, column, words):
    scene = rows[-1]["scene"]
    for way, (colour, marker) in LOOKS.items():
        own = [row for row in rows if row["scene"] == scene and row["way"] == way and row[column]]
        axes.plot([float(row[column]) for row in own], [float(row["ratio"]) for row in own], marker + "-", color=colour,
                  label=way)
    finish(axes, words, "largest unbalanced force over largest force", f"{scene}, {int(rows[-1]['blocks']):,d} blocks",
           loc="lower left", bbox_to_anchor=(0.2, 0.0))
    if column == "cpu_s":
        axes.get_legend().remove()


def draw_growth(axes, rows):
    for model, start, line in (("slope", "joints open", "-"), ("slope", "in situ", "--"), ("wall", "joints open", ":")):
        for way, (colour, marker) in LOOKS.items():
            own = [row for row in rows if (row["model"], row["start"], row["way"]) == (model, start, way) and
                   row["verdict"] == "settled"]
            if own:
                pairs = [int(row["pair_evaluations"]) / int(row["blocks"]) for row in own]
                axes.plot([int(row["blocks"]) for row in own], pairs, marker + line, color=colour)
        axes.plot([], [], line, color="k", label=f"{model}, {start}")
    for way, (colour, marker) in list(LOOKS.items())[:3]:
        axes.plot([], [], marker, color=colour, label=way)
    finish(axes, "number of blocks", "pair evaluations of a block", "Growth: slopes and walls", loc="upper left")
    low, high = axes.get_ylim()
    axes.set_ylim(low, 100.0 * high)  # room for the legend


def draw_increments(axes, rows, random, column, words):
    """Static solver against increments, each scene a line, and the random rock masses as boxes."""
    names = [name for name in SCENES if any(row["scene"] == name for row in rows)]
    for k, name in enumerate(names):
        own = [row for row in rows if row["scene"] == name and row["way"] == "static"]
        axes.plot([int(row["parts"]) for row in own], [max(float(row[column]), 1e-6) for row in own], "o-",
                  color=f"C{k}", markersize=4, label=name)
    for parts in sorted({int(row["parts"]) for row in random if row["way"] == "static"}):
        values = [float(row[column]) for row in random if row["way"] == "static" and int(row["parts"]) == parts]
        axes.boxplot(values, positions=[1.25 * parts], widths=[0.25 * parts], showfliers=True, manage_ticks=False,
                     flierprops={"markersize": 2})
    axes.axhline(TARGETS[column], color="k", linestyle=":", label="target")
    axes.set_ylim(1e-9, 2.0)
    finish(axes, "increments of the load", words, "Static solver; boxes: random rock masses", loc="lower left", ncol=2)


def draw_accuracy(axes, rows):
    scene = "slope_jointed" if any(row["scene"] == "slope_jointed" for row in rows) else rows[-1]["scene"]
    for way, (colour, marker) in LOOKS.items():
        own = [row for row in rows if row["scene"] == scene and row["way"] == way and float(row["normal_off"]) > 0.0]
        own = sorted(own, key=lambda row: int(row["parts"]))
        x, y = [float(row["cpu_s"]) for row in own], [float(row["normal_off"]) for row in own]
        axes.plot(x, y, marker + "-", color=colour, label=way)
        for row, at in zip(own, zip(x, y)):
            if int(row["parts"]) > 1:
                axes.annotate(f"{int(row['parts']):,d}", at, fontsize=7, xytext=(3, 3), textcoords="offset points")
    axes.axhline(TARGETS["normal_off"], color="k", linestyle=":", label="target")
    finish(axes, "CPU time, s", "largest difference of the 20 largest normal forces",
           f"{scene}: speed against accuracy\n(numbers: increments, steps of the rise)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    cost, paths, random, growth = (read(folder / f"statics_{part}.csv")
                                   for part in ("cost", "paths", "random", "growth"))
    random = [row for row in random if row.get("normal_off")]
    figure, axes = plt.subplots(2, 3, figsize=(14.5, 8.4))
    draw_cost(axes[0, 0], cost, "evaluations", "evaluations")
    draw_cost(axes[0, 1], cost, "cpu_s", "CPU time, s")
    draw_growth(axes[0, 2], growth)
    draw_increments(axes[1, 0], paths, random, "normal_off", "largest difference of the 20 largest normal forces")
    draw_increments(axes[1, 1], paths, random, "displacement_off", "largest difference of displacements over the sag")
    draw_accuracy(axes[1, 2], paths)
    for panel in axes[1, :2]:
        panel.set_xlim(0.8, 1.7 * max(int(row["parts"]) for row in paths if row["way"] == "static"))
    figure.tight_layout()
    for suffix in ("png", "svg"):
        figure.savefig(folder / f"statics.{suffix}", dpi=110)


if __name__ == "__main__":
    main()
