#!/usr/bin/python3
"""Every shipped scene with rigid blocks and with blocks of 5, 30 and 300 GPa: the same verdicts, and by how much answers differ.

    run/study/scenes.py BUILD OUT_DIR [--quick] [--only NAME ...]

A scene runs as it ships but for youngs_modulus and fidelity = "auto" with an accepted error of 1e-6, so that every block
that the scene lets deform does. Scenes of 10^5 blocks run with one bench and with a tunnel of 10 m. --quick takes the
scenes that need little time, and E = 5 GPa alone. OUT_DIR/scenes.csv has a row a run: verdict and steps of each stage,
largest displacement at the end of the first stage with steps (of a scene without stages: at the end), what rigid blocks
leave out of the joints' compliance, k_n L/(E + k_n L) at most, the ratio of that displacement to the rigid one, and what it
would be at most if all of it were compression of flush joints, 1 + k_n L/E. Where blocks slide or fall the ratio is that of
their ways.
"""

import argparse
import csv
import json
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import h5py
import numpy

SCENES = Path(__file__).resolve().parent.parent / "scenes"
MODULI = {"rigid": None, "5 GPa": 5e9, "30 GPa": 30e9, "300 GPa": 300e9}
SHORTER = {  # settings that leave a scene of 10^5 blocks its kind
    "slope_large": ["region.slope.bench=[{height=20, face_angle_deg=72}]", "region.slope.toe_length=10",
                    "region.slope.crest_length=25", "region.slope.depth=6"],
    "tunnel_large": ["region.polygon=[[-31, -30], [31, -30], [31, 30], [-31, 30]]",
                     'opening=[{name="tunnel", shape="horseshoe", centre=[0, 0], width=10, height=10}]'],
}
OWN_KIND = {"deformable_slope", "deformable_tunnel"}  # they deform as they ship
SLOW = {"slope_large", "slope_jointed", "tunnel_large", "wet_slope", "seismic_slope", "slope_seeds", "masonry_wall", "rockfall",
        "toppling", "goodman_bray", "bolted_tunnel", "lined_tunnel"}


def arguments(name, modulus):
    """--set arguments that make a scene's blocks deform."""
    with open(SCENES / f"{name}.toml", "rb") as file:
        scene = tomllib.load(file)
    sets = list(SHORTER.get(name, []))
    sets.append("output.contacts=false")
    if modulus is None:
        sets.append("run.fidelity=rigid")
    else:
        sets += ["run.fidelity=auto", "run.accepted_error=1e-6"]
        for material in scene["material"]:
            sets += [f"material.{material}.youngs_modulus={modulus}", f"material.{material}.poissons_ratio=0.25"]
    return [word for setting in sets for word in ("--set", setting)]


def displacement(folder, at):
    """Largest displacement of a mobile block (m) in the last frame that is not later than `at`."""
    last = None
    for path in sorted((folder / "frames").glob("frame_*.hdf")):
        with h5py.File(path) as file:
            if file["VTKHDF"].attrs.get("time", file.attrs.get("time", 0.0)) > at * (1 + 1e-9):
                break
            cells = file["VTKHDF/CellData"]
            moved = numpy.array(cells["displacement"])[numpy.array(cells["kind"]) != 0, :2]
            last = float(numpy.hypot(*moved.T).max()) if len(moved) else 0.0
    return last


def run(program, name, kind, out):
    folder = out / "scenes" / f"{name}_{kind.replace(' ', '_')}"
    started = time.monotonic()
    done = subprocess.run([program, "run", SCENES / f"{name}.toml", "--out", folder, "--overwrite",
                           *arguments(name, MODULI[kind])], capture_output=True, text=True)
    row = {"scene": name, "blocks": kind, "exit": done.returncode, "wall_s": round(time.monotonic() - started, 1)}
    if done.returncode in (2, 3):
        raise SystemExit(f"{name}, {kind}:\n{done.stderr}")
    summary = json.loads((folder / "summary.json").read_text())
    stages = summary.get("stages") or [{"verdict": summary["verdict"], "steps": summary["steps"], "time": summary["time"]}]
    row["verdicts"] = " ".join(stage["verdict"] for stage in stages)
    row["steps"] = " ".join(str(stage["steps"]) for stage in stages)
    first = next((stage for stage in stages if stage["steps"] > 0), stages[-1])
    row["displacement_m"] = displacement(folder, first["time"])
    shares = re.search(r"would leave out up to ([0-9.e+-]+)$", done.stderr, re.MULTILINE)
    row["compliance_share"] = float(shares.group(1)) if shares else 0.0
    row["message"] = summary["message"]
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+")
    asked = parser.parse_args()
    names = sorted(path.stem for path in SCENES.glob("*.toml"))
    names = [n for n in names if n not in OWN_KIND]
    names = [n for n in names if (n in asked.only if asked.only else not (asked.quick and n in SLOW))]
    kinds = ["rigid", "5 GPa"] if asked.quick else list(MODULI)
    rows, wrong = [], []
    for name in names:
        rigid = None
        for kind in kinds:
            row = run(asked.build / "gcpdda", name, kind, asked.out)
            rigid = rigid or row
            row["displacement_ratio"] = (row["displacement_m"] / rigid["displacement_m"] if rigid["displacement_m"] else 1.0)
            row["compression_ratio"] = 1.0 / (1.0 - row["compliance_share"])
            if row["verdicts"] != rigid["verdicts"] or row["exit"] != rigid["exit"]:
                wrong.append(f"{name}, {kind}: {row['verdicts']} (exit {row['exit']}), rigid {rigid['verdicts']} "
                             f"(exit {rigid['exit']}): {row['message']}")
            rows.append(row)
            print(*row.values(), flush=True)
    path = asked.out / "scenes.csv"
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, [key for key in rows[0] if key not in ("message", "wall_s")], extrasaction="ignore",
                                lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print("\n".join(wrong) or f"{len(rows)} runs of {len(names)} scenes: blocks that deform end as rigid ones do")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
