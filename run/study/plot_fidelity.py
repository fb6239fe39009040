#!/usr/bin/python3
"""plot_fidelity.py FOLDER: draws FOLDER/fidelity.csv as fidelity.png and .svg: error and cost of rigid and deformable
blocks and of what fidelity = "auto" takes, over k_n L/E, with the error that auto predicts for rigid blocks."""

import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TITLES = {"bar": "Bar of 8 squares under compression", "wall": "Wall of bricks under a loaded beam"}
LEAST = 1e-7  # smaller errors are drawn here
STYLE = {
    "rigid": dict(color="tab:red", marker="s", label="rigid"),
    "deformable": dict(color="tab:blue", marker="o", label="deformable"),
    "auto": dict(color="black", marker="*", markersize=11, linestyle="--", linewidth=0.8, label="auto"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    with open(folder / "fidelity.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    figure, grid = plt.subplots(2, len(problems), figsize=(5.5 * len(problems), 7.5), sharex=True, squeeze=False)
    for (above, below), problem in zip(zip(*grid), problems):
        for fidelity, style in STYLE.items():
            mine = [r for r in rows if r["problem"] == problem and r["fidelity"] == fidelity]
            ratio = [float(r["k_n_L_over_E"]) for r in mine]
            above.plot(ratio, [max(float(r["error"]), LEAST) for r in mine], **style)
            below.plot(ratio, [1e3 * float(r["cpu_s"]) for r in mine], **style)
        predicted = [x / (1.0 + x) for x in ratio]
        above.fill_between(ratio, [0.5 * p for p in predicted], [2.0 * p for p in predicted], color="tab:red", alpha=0.15,
                           label="predicted for rigid, half to twice")
        above.axhline(0.01, color="0.5", linestyle=":", label="accepted error")
        above.set(xscale="log", yscale="log", title=TITLES[problem], ylabel="relative error of the settlement")
        below.set(xscale="log", yscale="log", xlabel=r"stiffness of the joints over that of the blocks, $k_n L/E$",
                  ylabel="CPU time of the steps, ms")
        for axes in (above, below):
            axes.grid(True, alpha=0.3)
    grid[0][0].legend(fontsize=9, loc="center right")
    grid[0][0].text(2e-4, 1.3 * LEAST, "errors below 1e-7 are drawn at 1e-7", fontsize=8, color="0.4")
    figure.tight_layout()
    for suffix in ("png", "svg"):
        figure.savefig(folder / f"fidelity.{suffix}", dpi=150)


if __name__ == "__main__":
    main()
