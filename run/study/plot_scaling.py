#!/usr/bin/python3
"""plot_scaling.py FOLDER: draws FOLDER/scaling.csv and scaling_times.csv as scaling.png and .svg: work of the busiest
rank, ghosts and messages over the ranks, and efficiency on two ranks beside the machine's ceiling."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

COLOURS = {"wall": "tab:blue", "pyramid": "tab:orange", "pile": "tab:green", "slope": "tab:red"}
STYLES = ((1e4, "o", "-"), (5e4, "D", "-."), (5e5, "s", "--"), (float("inf"), "^", ":"))


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def curves(axes, rows, quantity, shift=0.0):
    """One curve for each problem and size, over the ranks."""
    for problem, blocks in dict.fromkeys((row["problem"], row["blocks"]) for row in rows):
        mine = [row for row in rows if (row["problem"], row["blocks"]) == (problem, blocks) and int(row["ranks"]) > 1]
        mine.sort(key=lambda row: int(row["ranks"]))
        marker, line = next(style[1:] for style in STYLES if float(blocks) < style[0])
        axes.plot([int(row["ranks"]) for row in mine], [float(row[quantity]) - shift for row in mine], marker=marker,
                  linestyle=line, color=COLOURS[problem], label=f"{problem}, {int(blocks):,} blocks")
    axes.set_xscale("log", base=2)
    axes.set_xlabel("ranks")
    axes.grid(True, alpha=0.3)


def main():
    folder = Path(sys.argv[1])
    counts = read(folder / "scaling.csv")
    times = read(folder / "scaling_times.csv")
    figure, grid = plt.subplots(2, 3, figsize=(16.0, 9.0))
    for axes, quantity, shift, title in (
        (grid[0][0], "work_ratio", 1.0, "excess of the busiest rank's counted work over its share"),
        (grid[0][1], "imbalance", 1.0, "imbalance of counted work, max/mean - 1"),
        (grid[0][2], "ghosts_per_rank", 0.0, "ghosts a rank at the end"),
        (grid[1][0], "bytes_per_rank_and_step", 0.0, "bytes a rank and step"),
        (grid[1][1], "messages_per_rank_and_step", 0.0, "messages a rank and step"),
    ):
        curves(axes, counts, quantity, shift)
        axes.set_title(title, fontsize=10)
        if quantity.startswith(("ghosts", "bytes")):
            axes.set_yscale("log")
        else:
            axes.set_ylim(bottom=0.0)
    grid[1][0].legend(fontsize=7, loc="upper right", ncols=2)
    grid[1][0].set_ylim(top=1e7)
    axes = grid[1][2]
    place = numpy.arange(len(times))
    for offset, (quantity, label, colour) in enumerate((("efficiency", "efficiency on 2 ranks", "tab:blue"),
                                                        ("ceiling", "two half-size runs at once", "0.6"),
                                                        ("communication", "share of communication", "tab:red"))):
        axes.bar(place + 0.27 * (offset - 1), [float(row[quantity]) for row in times], 0.25, label=label, color=colour)
    axes.set_xticks(place, [f"{row['problem']}\n{int(row['blocks']):,}" for row in times], fontsize=7)
    axes.set_title(f"2 ranks, medians of {times[0]['rounds']}", fontsize=10)
    axes.set_ylim(top=1.5)
    axes.legend(fontsize=7)
    figure.tight_layout()
    for suffix in ("png", "svg"):
        figure.savefig(folder / f"scaling.{suffix}", dpi=150)


if __name__ == "__main__":
    main()
