#!/usr/bin/python3
"""What happened to the slope, in plain words, from the result folders of run/demo.sh."""
import argparse
import json
import pathlib
import re

import h5py
import numpy as np


def last_frame(folder):
    return sorted((folder / "frames").glob("frame_*.hdf"))[-1]


def report(folder):
    angle = float(re.search(r"friction_angle_deg\s*=\s*([\d.]+)", (folder / "scene.toml").read_text()).group(1))
    summary = json.loads((folder / "summary.json").read_text())
    with h5py.File(last_frame(folder)) as frame:
        cells = frame["VTKHDF/CellData"]
        mobile = cells["kind"][:] != 0
        moved = np.linalg.norm(cells["displacement"][:], axis=1)[mobile]
    largest = moved.max()
    speed = summary["energy"]["max_speed"]
    if speed < 1e-6:
        fate = (f"stands: the columns leaned by at most {1000 * largest:.1f} mm and came to rest "
                f"(fastest column {speed:.0e} m/s)")
    else:
        fate = (f"topples: {np.count_nonzero(moved > 1)} of {len(moved)} columns moved more than 1 m, the farthest "
                f"{largest:.1f} m, and the slope still moves at {speed:.1f} m/s")
    print(f"Friction angle {angle:g} degrees: after {summary['time']:g} s the slope {fate}.")
    print(f"  {summary['ranks']} ranks, {summary['steps']} steps in {summary['wall_s']:.1f} s, "
          f"largest overlap {1000 * summary['max_overlap']:.1f} mm.")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folders", nargs="+", type=pathlib.Path, metavar="DIR")
for folder in parser.parse_args().folders:
    report(folder)
print("Limit equilibrium puts the border at 38.15 degrees (Goodman and Bray's method, Wyllie and Mah's geometry).")
