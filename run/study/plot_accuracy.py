#!/usr/bin/python3
"""plot_accuracy.py FOLDER: draws FOLDER/accuracy.csv (and peers.csv where it exists) as one log-log chart of error
against cost for each problem, over CPU time (accuracy.png, and four of the problems in accuracy_overview.png) and contact
evaluations (accuracy_evaluations.png), all as .svg too, and writes all points as accuracy.json. The default is a star, the
Pareto front a line."""

import argparse
import csv
import sys
import json
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {  # factor: colour, marker, words
    "default": ("black", "o", "default settings"),
    "stiffness": ("tab:red", "s", "joints 10 times as soft or stiff"),
    "scheme": ("tab:blue", "^", "other schemes"),
    "contact_time": ("tab:orange", "v", "contact force at another time"),
    "spectral_radius": ("tab:green", "D", "other spectral radii"),
    "fidelity": ("tab:purple", "P", "rigid blocks"),
    "elasticity": ("tab:brown", "X", "explicit elasticity"),
    "Box2D": ("tab:cyan", "h", "Box2D"),
    "Chipmunk": ("tab:pink", "p", "Chipmunk"),
}
TITLES = {
    "incline": "Square sliding on a slope, laid on flat:\npath after 2 s",
    "incline_solved": "The same, started in the depth and tilt\nof steady sliding",
    "oblique_impact": "Oblique elastic impact of two squares:\nenergy afterwards",
    "toppling_block": "Block toppling about a corner:\nangle after 0.8 s",
    "bar_compressed": "Bar of deformable squares:\nshortening",
    "bar_wave": "Bar of deformable squares:\nfrequency",
    "wall": "Wall of 78 bricks, sudden gravity:\nmotion of its top over its height",
    "pyramid": "Pyramid of 55 squares, sudden gravity:\nmotion of its top over its height",
}
OVERVIEW = ("incline", "oblique_impact", "bar_wave", "wall")  # of README.md: sliding, impact, deformation, piles
TEXT_COLUMNS = {"problem", "compared", "factor", "value"}


def read(path):
    with open(path, newline="") as file:
        rows = [{k: v if k in TEXT_COLUMNS else float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return rows


def front(points, cost):
    """The points that no other one beats in error at lower cost, cheapest first."""
    best = math.inf
    kept = []
    for point in sorted(points, key=lambda p: (p[cost], p["error"])):
        if point["error"] < best:
            best = point["error"]
            kept.append(point)
    return kept


def draw_panel(axes, points, cost):
    top = 10.0  # what is worse has failed
    shown = [p for p in points if math.isfinite(p["error"]) and p[cost] > 0.0 and p["error"] < top]
    floor = max(min((p["error"] for p in shown if p["error"] > 0.0), default=1e-16), 1e-16)
    for p in shown:
        p["drawn"] = max(p["error"], floor)
    scale = 1e3 if cost == "cpu_s" else 1.0
    for (factor, value) in dict.fromkeys((p["factor"], p["value"]) for p in shown):
        colour, marker, _ = STYLE[factor]
        curve = sorted((p for p in shown if (p["factor"], p["value"]) == (factor, value) and p["safety"] != 0.0),
                       key=lambda p: p[cost])
        axes.plot([scale * p[cost] for p in curve], [p["drawn"] for p in curve], color=colour, marker=marker, markersize=4.5,
                  linewidth=0.8, alpha=0.75)
    best = front(shown, cost)
    axes.plot([scale * p[cost] for p in best], [p["drawn"] for p in best], color="0.6", linewidth=6, alpha=0.4,
              drawstyle="steps-post", zorder=0)
    for p in shown:
        if p["factor"] == "default" and p["safety"] == 0.0:
            axes.plot(scale * p[cost], p["drawn"], marker="*", markersize=17, color="gold", markeredgecolor="black", zorder=5)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", alpha=0.3)


def draw(rows, problems, cost, label, stem, columns):
    lines = math.ceil(len(problems) / columns)
    figure, grid = plt.subplots(lines, columns, figsize=(5.2 * columns, 3.3 * lines + 0.6), squeeze=False)
    for k, (axes, problem) in enumerate(zip(grid.flat, problems)):
        draw_panel(axes, [p for p in rows if p["problem"] == problem], cost)
        axes.set_title(TITLES[problem], fontsize=11)
        axes.set_xlabel(label)
        if k % columns == 0:
            axes.set_ylabel("relative error")
    for axes in grid.flat[len(problems):]:
        axes.axis("off")
    used = {p["factor"] for p in rows if p["problem"] in problems}
    handles = [plt.Line2D([], [], color=c, marker=m, label=words) for f, (c, m, words) in STYLE.items() if f in used]
    handles += [plt.Line2D([], [], color="gold", marker="*", markersize=14, markeredgecolor="black", linestyle="",
                           label="the defaults"),
                plt.Line2D([], [], color="0.6", linewidth=6, alpha=0.4, label="least error for the cost")]
    figure.legend(handles=handles, loc="lower center", ncol=4, fontsize=9.5, frameon=False)
    figure.tight_layout(rect=(0, 0.7 / figure.get_figheight(), 1, 1))
    for suffix in ("png", "svg"):
        figure.savefig(f"{stem}.{suffix}", dpi=120)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    rows = read(folder / "accuracy.csv") or sys.exit(f"plot_accuracy.py: {folder / 'accuracy.csv'} has no rows")
    peers = folder / "peers.csv"
    rows += read(peers) if peers.exists() else []  # no rows where no other engine is installed
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    draw(rows, problems, "cpu_s", "CPU time of the steps, ms", folder / "accuracy", 2)
    draw(rows, [p for p in OVERVIEW if p in problems], "cpu_s", "CPU time of the steps, ms", folder / "accuracy_overview", 2)
    draw([r for r in rows if r["evaluations"] > 0], problems, "evaluations", "contact evaluations",
         folder / "accuracy_evaluations", 2)
    finite = [{k: v for k, v in row.items() if k != "drawn"} for row in rows if math.isfinite(row["error"])]
    (folder / "accuracy.json").write_text(json.dumps(finite, indent=0))


if __name__ == "__main__":
    main()
