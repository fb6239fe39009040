#!/usr/bin/python3
"""plot_accuracy.py FOLDER: draws FOLDER/accuracy.csv (and peers.csv where it exists) as one log-log chart of error
against cost for each problem, over CPU time (accuracy.png, .svg) and contact evaluations (accuracy_evaluations.png,
.svg), and writes all points as accuracy.json. The default is a star, the Pareto front a line."""

import csv
import json
import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {  # factor: colour, marker
    "default": ("black", "o"),
    "stiffness": ("tab:red", "s"),
    "scheme": ("tab:blue", "^"),
    "contact_time": ("tab:orange", "v"),
    "spectral_radius": ("tab:green", "D"),
    "fidelity": ("tab:purple", "P"),
    "elasticity": ("tab:brown", "X"),
    "Box2D": ("tab:cyan", "h"),
    "Chipmunk": ("tab:pink", "p"),
}
TEXT_COLUMNS = {"problem", "compared", "factor", "value"}


def read(path):
    with open(path, newline="") as file:
        return [{k: v if k in TEXT_COLUMNS else float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def front(points, cost):
    """The points that no other one beats in error at lower cost, cheapest first."""
    best = math.inf
    kept = []
    for point in sorted(points, key=lambda p: (p[cost], p["error"])):
        if point["error"] < best:
            best = point["error"]
            kept.append(point)
    return kept


def draw(rows, cost, label, stem):
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    columns = 4
    figure, grid = plt.subplots(math.ceil(len(problems) / columns), columns, figsize=(17, 8.2), squeeze=False)
    for axes, problem in zip(grid.flat, problems):
        points = [p for p in rows if p["problem"] == problem and math.isfinite(p["error"]) and p[cost] > 0.0]
        top = 10.0  # what is worse has failed
        shown = [p for p in points if p["error"] < top]
        floor = max(min((p["error"] for p in shown if p["error"] > 0.0), default=1e-16), 1e-16)
        for p in shown:
            p["drawn"] = max(p["error"], floor)
        scale = 1e3 if cost == "cpu_s" else 1.0
        for (factor, value) in dict.fromkeys((p["factor"], p["value"]) for p in shown):
            colour, marker = STYLE[factor]
            curve = sorted((p for p in shown if (p["factor"], p["value"]) == (factor, value) and p["safety"] != 0.0),
                           key=lambda p: p[cost])
            axes.plot([scale * p[cost] for p in curve], [p["drawn"] for p in curve], color=colour, marker=marker,
                      markersize=4, linewidth=0.7, alpha=0.75)
        ours = [p for p in front(shown, cost)]
        axes.plot([scale * p[cost] for p in ours], [p["drawn"] for p in ours], color="0.6", linewidth=6, alpha=0.4,
                  drawstyle="steps-post", zorder=0)
        for p in shown:
            if p["factor"] == "default" and p["safety"] == 0.0:
                axes.plot(scale * p[cost], p["drawn"], marker="*", markersize=17, color="gold", markeredgecolor="black",
                          zorder=5)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(problem, fontsize=11)
        axes.set_xlabel(label, fontsize=9)
        axes.set_ylabel("relative error", fontsize=9)
        axes.grid(True, which="major", alpha=0.3)
    for axes in grid.flat[len(problems):]:
        axes.axis("off")
    handles = [plt.Line2D([], [], color=c, marker=m, label=f) for f, (c, m) in STYLE.items()
               if any(p["factor"] == f for p in rows)]
    handles += [plt.Line2D([], [], color="gold", marker="*", markersize=14, markeredgecolor="black", linestyle="",
                           label="the defaults"),
                plt.Line2D([], [], color="0.6", linewidth=6, alpha=0.4, label="Pareto front")]
    figure.legend(handles=handles, loc="lower center", ncol=len(handles), fontsize=9, frameon=False)
    figure.tight_layout(rect=(0, 0.035, 1, 1))
    for suffix in ("png", "svg"):
        figure.savefig(f"{stem}.{suffix}", dpi=150)
    plt.close(figure)


def main():
    folder = Path(sys.argv[1])
    rows = read(folder / "accuracy.csv")
    peers = folder / "peers.csv"
    rows += read(peers) if peers.exists() else []
    draw(rows, "cpu_s", "CPU time of stepping, ms", folder / "accuracy")
    draw([r for r in rows if r["evaluations"] > 0], "evaluations", "contact evaluations", folder / "accuracy_evaluations")
    finite = [{k: v for k, v in row.items() if k != "drawn"} for row in rows if math.isfinite(row["error"])]
    (folder / "accuracy.json").write_text(json.dumps(finite, indent=0))


if __name__ == "__main__":
    main()
