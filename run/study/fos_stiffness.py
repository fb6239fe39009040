#!/usr/bin/python3
"""Factor of safety against the stiffness of the blocks: plane failure, a jointed slope, a toppling slope.

    run/study/fos_stiffness.py BUILD OUT_DIR [--quick] [--only NAME ...]

Searches with rigid blocks and with deformable ones of E from 1 GPa to 1 TPa (fidelity = "auto" with an accepted error of
1e-9). --quick leaves the jointed slope out and takes E = 1 and 30 GPa. OUT_DIR/fos_stiffness.csv has a row a search, and
fos_stiffness.png draws the brackets.
"""

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SCENES = Path(__file__).resolve().parent.parent / "scenes"
CASES = {  # arguments, limit equilibrium, and title of the panel
    "plane_failure": ([], 1.9534, "Plane failure\n(dashed: limit equilibrium of the block)"),
    "slope_jointed": (["--families", "bedding", "--from", "0.9", "--to", "1.3"], 1.076,
                      "Jointed slope; its benches fail first\n(dashed: plane through the toe)"),
    "goodman_bray": (["--from", "0.95", "--to", "1.2", "--tolerance", "0.005", "--set", "fos.limit=20"], 1.0682,
                     "Toppling slope of Goodman and Bray\n(dashed: limit equilibrium)"),
}
MODULI = [1e9, 3e9, 10e9, 30e9, 100e9, 1e12]
LONG = {"slope_jointed": [1e9, 10e9, 100e9]}  # each search takes a minute or two of CPU time


def search(program, name, modulus, out):
    stiffness = "rigid" if modulus is None else f"{modulus:g}"
    folder = out / "fos_stiffness" / f"{name}_{stiffness}"
    sets = ["run.fidelity=rigid"] if modulus is None else [
        "run.fidelity=auto", "run.accepted_error=1e-9", f"material.rock.youngs_modulus={modulus}",
        "material.rock.poissons_ratio=0.25"]
    done = subprocess.run([program, "fos", SCENES / f"{name}.toml", "--out", folder, "--overwrite", *CASES[name][0],
                           *(word for setting in sets for word in ("--set", setting))], capture_output=True, text=True)
    if done.returncode not in (0, 7):
        raise SystemExit(f"{name}, E = {modulus}:\n{done.stderr}")
    found = json.loads((folder / "fos.json").read_text())
    return {"scene": name, "youngs_modulus": stiffness, "holds": found["holds"],
            "fails": found["fails"], "undecided_trials": len(found["undecided"]),
            "evaluations": sum(trial["evaluations"] for trial in found["trials"]) + found["settled"]["evaluations"]}


def draw(rows, path):
    names = list(dict.fromkeys(row["scene"] for row in rows))
    figure, axes = plt.subplots(1, len(names), figsize=(4.2 * len(names), 3.6), squeeze=False)
    for axis, name in zip(axes[0], names):
        own = [row for row in rows if row["scene"] == name]
        for row in own:
            rigid = row["youngs_modulus"] == "rigid"
            x = 1e13 if rigid else float(row["youngs_modulus"])
            axis.plot([x, x], [row["holds"], row["fails"]], "C1" if rigid else "C0", marker="_", markersize=9)
        axis.axhline(CASES[name][1], color="0.5", linestyle="--", linewidth=1)
        axis.set_xscale("log")
        axis.set_xticks([1e9, 1e10, 1e11, 1e12, 1e13], ["1", "10", "100", "1000", "rigid"])
        middle = CASES[name][1]
        axis.set_ylim(min(middle * 0.9, min(r["holds"] for r in own) * 0.99), max(middle * 1.1, max(r["fails"] for r in own) * 1.01))
        axis.set_xlabel("Young's modulus of the blocks, GPa")
        axis.set_title(CASES[name][2], fontsize=10)
        axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("factor of safety, from holds to fails")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=CASES)
    asked = parser.parse_args()
    names = asked.only or [name for name in CASES if not (asked.quick and name == "slope_jointed")]
    rows = []
    for name in names:
        for modulus in ([1e9, 30e9] if asked.quick else LONG.get(name, MODULI)) + [None]:
            rows.append(search(asked.build / "gcpdda", name, modulus, asked.out))
            print(*rows[-1].values(), flush=True)
    with open(asked.out / "fos_stiffness.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw(rows, asked.out / "fos_stiffness.png")


if __name__ == "__main__":
    sys.exit(main())
