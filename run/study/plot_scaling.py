#!/usr/bin/python3
"""plot_scaling.py FOLDER: draws FOLDER/scaling.csv and scaling_times.csv as scaling.png and .svg: work of the busiest
rank, ghosts and messages over the ranks, and efficiency on two ranks beside the machine's ceiling."""

import argparse
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

COLOURS = {"wall": "tab:blue", "pyramid": "tab:orange", "pile": "tab:green", "slope": "tab:red"}
MODELS = {"wall": "wall", "pyramid": "pyramid", "pile": "falling pile", "slope": "long slope"}
STYLES = ((1e4, "o", "-"), (5e4, "D", "-."), (5e5, "s", "--"), (float("inf"), "^", ":"))


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return rows or sys.exit(f"plot_scaling.py: {path} has no rows")


def curves(axes, rows, quantity, scale, shift):
    """One curve for each problem and size, over the ranks."""
    for problem, blocks in dict.fromkeys((row["problem"], row["blocks"]) for row in rows):
        mine = [row for row in rows if (row["problem"], row["blocks"]) == (problem, blocks) and int(row["ranks"]) > 1]
        mine.sort(key=lambda row: int(row["ranks"]))
        marker, line = next(style[1:] for style in STYLES if float(blocks) < style[0])
        axes.plot([int(row["ranks"]) for row in mine], [scale * (float(row[quantity]) - shift) for row in mine], marker=marker,
                  linestyle=line, color=COLOURS[problem], label=f"{MODELS[problem]}, {int(blocks):,} blocks")
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter("{x:.0f}")
    axes.set_xlabel("number of ranks")
    axes.grid(True, alpha=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    counts = read(folder / "scaling.csv")
    times = read(folder / "scaling_times.csv")
    figure, grid = plt.subplots(2, 3, figsize=(13.0, 8.6))
    for axes, quantity, scale, shift, title, label in (
        (grid[0][0], "work_ratio", 100.0, 1.0, "Work of the busiest rank", "counted work beyond its share, %"),
        (grid[0][1], "imbalance", 100.0, 1.0, "Imbalance", "busiest rank beyond the mean, %"),
        (grid[0][2], "ghosts_per_rank", 1.0, 0.0, "Ghosts", "blocks a rank sees of other ranks"),
        (grid[1][0], "bytes_per_rank_and_step", 1e-3, 0.0, "Bytes sent", "kB a rank and step"),
        (grid[1][1], "messages_per_rank_and_step", 1.0, 0.0, "Messages sent", "messages a rank and step"),
    ):
        curves(axes, counts, quantity, scale, shift)
        axes.set_title(title, fontsize=11)
        axes.set_ylabel(label)
        if quantity.startswith(("ghosts", "bytes")):
            axes.set_yscale("log")
        else:
            axes.set_ylim(bottom=0.0)
    handles, labels = grid[1][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=5, fontsize=9, frameon=False)
    axes = grid[1][2]
    place = numpy.arange(len(times))
    for offset, (quantity, label, colour) in enumerate((("efficiency", "efficiency", "tab:blue"),
                                                        ("ceiling", "two half-size runs at once", "0.6"),
                                                        ("communication", "share of communication", "tab:red"))):
        axes.bar(place + 0.27 * (offset - 1), [float(row[quantity]) for row in times], 0.25, label=label, color=colour)
    axes.set_xticks(place, [f"{MODELS[row['problem']]}, {int(row['blocks']):,}" for row in times], fontsize=8, rotation=35,
                    ha="right", rotation_mode="anchor")
    axes.set_title(f"Wall time on 2 ranks, medians of {times[0]['rounds']} rounds", fontsize=11)
    axes.set_ylabel("efficiency, share")
    axes.set_ylim(top=1.6)
    axes.legend(fontsize=9)
    figure.tight_layout(rect=(0, 0.08, 1, 1))
    for suffix in ("png", "svg"):
        figure.savefig(folder / f"scaling.{suffix}", dpi=120)


if __name__ == "__main__":
    main()
