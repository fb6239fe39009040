#!/usr/bin/python3
"""plot_speed.py FOLDER: draws FOLDER/speed.csv and speed_steps.csv as speed.png and .svg: what a contact and step costs, what a
block needs of memory, and how much time a settled pile covers in a second of CPU time."""

import argparse
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file)) or sys.exit(f"plot_speed.py: {path} has no rows")


def label_blocks(axes):
    axes.set_xscale("log")
    axes.set_xlabel("number of blocks")
    axes.grid(True, alpha=0.3)


def draw_costs(axes, rows):
    """Of each size and kind the case with the most steps: what a pile takes at rest, or pressed together."""
    for kind, colour, marker in (("rigid", "tab:blue", "o"), ("deformable", "tab:orange", "s")):
        cases = {}
        for row in rows:
            if row["kind"] == kind and float(row["allowed_overlap"]) == 1e-3:
                cases[int(row["blocks"])] = row
        x = sorted(cases)
        middle = [float(cases[n]["ns_per_contact_and_step"]) for n in x]
        least = [float(cases[n]["least"]) for n in x]
        axes.errorbar(x, middle, [[m - low for m, low in zip(middle, least)], [0.0] * len(x)], color=colour, marker=marker,
                      capsize=3, label=f"{kind}: median, bar to the least")
    axes.set_ylim(0.0, 1.15 * axes.get_ylim()[1])
    axes.set_ylabel("CPU time of a contact and step, ns")
    axes.set_title("Cost of a touching contact", fontsize=11)
    axes.legend(fontsize=9, loc="lower right")
    label_blocks(axes)


def draw_memory(axes, rows):
    cases = {int(row["blocks"]): float(row["peak_memory_per_block_bytes"]) for row in rows if row["kind"] == "rigid"}
    x = sorted(cases)
    axes.plot(x, [cases[n] / 1e3 for n in x], "o-", color="tab:green", label="peak")
    axes.plot(x, [40e6 / n / 1e3 for n in x], ":", color="0.5", label="the program itself, 40 MB")
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.1)
    axes.set_ylabel("peak of memory over blocks, kB")
    axes.set_title("Memory of a block", fontsize=11)
    axes.legend(fontsize=9)
    label_blocks(axes)


def draw_time(axes, rows):
    rows = [row for row in rows if float(row["contact_damping"]) > 0.0 and row.get("largest_step_s")]
    names = [f"{int(row['blocks']):,d} squares,\nallowed overlap\n{float(row['allowed_overlap']):g}" for row in rows]
    y = range(len(rows))
    longest = [float(row["simulated_s_per_cpu_s"]) for row in rows]
    default = [float(row["at_default_step"]) for row in rows]
    axes.barh([k - 0.18 for k in y], longest, 0.36, color="tab:purple", label="longest stable step")
    axes.barh([k + 0.18 for k in y], default, 0.36, color="tab:pink", label="default step")
    for k in y:
        for value, shift in ((longest[k], -0.18), (default[k], 0.18)):
            axes.text(1.08 * value, k + shift, f"{value:.2g}", va="center", fontsize=9)
    axes.set_yticks(list(y), names, fontsize=9)
    axes.set_xscale("log")
    axes.set_xlim(0.1, 100.0)
    axes.set_ylim(len(rows) + 0.2, -0.6)
    axes.set_xlabel("simulated seconds in a CPU second")
    axes.set_title("Settled piles", fontsize=11)
    axes.legend(fontsize=9, loc="lower right", ncol=2)
    axes.grid(True, axis="x", alpha=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    rows = read(folder / "speed.csv")
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.5, 3.9))
    draw_costs(left, rows)
    draw_memory(middle, rows)
    draw_time(right, read(folder / "speed_steps.csv"))
    figure.tight_layout()
    for suffix in ("png", "svg"):
        figure.savefig(folder / f"speed.{suffix}", dpi=130)


if __name__ == "__main__":
    main()
