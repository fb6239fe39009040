#!/usr/bin/python3
"""speed.py BUILD FOLDER [--quick]: what a touching contact costs in a step; writes the table of the speed study to FOLDER.

Pyramids of unit squares with friction settle under local damping, on one rank; CPU time of the step loop, all in. From
10^5 squares on they start pressed together, since few steps are taken. Use a quiet machine; median and least of the
repeats stand in the table.

Then the largest step at which a settled pile stays: its weight comes slowly, so that no joint ever overlaps by more than at
rest, a settle stage sets it to rest, and it goes on for 5 s with the dashpots of joints alone, or with no damping of
any kind, at longer and longer steps until some square has drifted by more than a micrometre. (Local damping of 0.8
would lower what is stable by sqrt(1.8).)
"""
import argparse
import csv
import json
import math
import os
import re
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy as np


MAKE_BLOCKS = Path(__file__).resolve().parent.parent / "make_blocks.py"


def scene(work, rows, steps, fidelity, overlap):
    text = (f'[run]\nduration = {steps}\ntime_step = 1.0\nfidelity = "{fidelity}"\nlocal_damping = 0.8\n'
            '[material.rock]\ndensity = 2600.0\nyoungs_modulus = 40e9\npoissons_ratio = 0.25\n[joint.default]\n'
            f'allowed_overlap = {overlap}\nfriction_angle_deg = 31.0\n[output]\ncontacts = false\n')
    if rows > 200:
        file = work / f"pyramid_{rows}.h5"
        if not file.exists():
            subprocess.run([MAKE_BLOCKS, file, "--shape", "pyramid", "--rows", str(rows), "--overlap", str(0.5 * overlap)],
                           check=True, stdout=subprocess.DEVNULL)
        return text + f'[blocks]\nfile = "{file}"\n'
    return (text + '[[block]]\nname = "floor"\nmaterial = "rock"\nfixed = true\n'
            f'vertices = [[-2, -2], [{rows + 2}, -2], [{rows + 2}, 0], [-2, 0]]\n[[pyramid]]\nname = "pyramid"\n'
            f'material = "rock"\norigin = [0.0, 0.0]\nrows = {rows}\nblock_size = [1.0, 1.0]\n')


def default_step(program, work, text):
    """The step the program chooses, s."""
    path = work / "asked.toml"
    path.write_text(text.replace("time_step = 1.0\n", ""))
    said = subprocess.run([program, "inspect", path], check=True, capture_output=True, text=True).stdout
    return float(re.search(r"^step +([-0-9.e]+) s", said, re.MULTILINE).group(1))


def stepped(text, step, steps):
    """The scene with so many of these steps, and frames at both ends."""
    duration = steps * step
    text = text.replace(f"duration = {steps}\ntime_step = 1.0", f"duration = {duration!r}\ntime_step = {step!r}")
    return text.replace("[output]\n", f"[output]\ninterval = {duration!r}\n")


def run(program, work, text, step, steps):
    """Summary of a run, and its peak of memory in bytes."""
    (work / "scene.toml").write_text(stepped(text, step, steps))
    out = work / "out"
    shutil.rmtree(out, ignore_errors=True)
    process = subprocess.Popen([program, "run", work / "scene.toml", "--out", out], stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"speed.py: the run failed, see {out}")
    return json.loads((out / "summary.json").read_text()), 1024 * usage.ru_maxrss


def displacements(out):
    """By frame, (blocks, 3): displacement and rotation."""
    frames = []
    for path in sorted((out / "frames").glob("frame_*.hdf")):
        with h5py.File(path) as file:
            data = file["VTKHDF/CellData"]
            frames.append(np.column_stack([data["displacement"][:, :2], data["rotation"][:]]))
    return frames


WATCH = 5.0  # s
MOST_DRIFT = 1e-6  # m
RAMP = 2.0  # s: longer than a pile swings, so that it never overlaps by more than at rest
SETTLE = '{name = "settle", kind = "settle", limit = 60.0, tolerance = 1e-7, kinetic_damping = true}'


def largest_step(program, work, rows, overlap, contact_damping, repeats):
    """Settle a pyramid, then look for the longest step at which it stays."""
    text = scene(work, rows, 1, "rigid", overlap).replace("time_step = 1.0\n", "").replace("local_damping = 0.8\n", "")
    text = text.replace("[run]\n", f"[run]\ngravity_ramp = {RAMP}\n")
    default = default_step(program, work, text)
    path = work / "settle.toml"
    settled = work / "settled"
    path.write_text(f"stage = [{SETTLE}]\n" + text.replace("duration = 1\n", "").replace("[output]\n", "[output]\ninterval = 60.0\n"))
    shutil.rmtree(settled, ignore_errors=True)
    subprocess.run([program, "run", path, "--out", settled], check=True, stderr=subprocess.DEVNULL)
    goes_on = work / "goes_on"

    def stays(factor, interval=0.5):
        shutil.rmtree(goes_on, ignore_errors=True)
        shutil.copytree(settled, goes_on)
        step = 0.5 / math.ceil(0.5 / (factor * default))  # frames come after whole numbers of steps
        watch = (f'{{name = "watch", kind = "run", duration = {WATCH}, '
                 f'set = {{"run.time_step" = {step!r}, "run.contact_damping" = {contact_damping}}}}}')
        process = subprocess.run([program, "restart", goes_on, "--set", f"stage=[{SETTLE}, {watch}]", "--set",
                                  f"output.interval={interval}"], stderr=subprocess.DEVNULL)
        if process.returncode not in (0, 7):
            return None
        frames = displacements(goes_on)  # at t = 0, at rest, and in every interval of the watch
        drift = max(float(np.abs(frame - frames[1]).max()) for frame in frames[1:])
        summary = json.loads((goes_on / "summary.json").read_text())
        return {"largest_step_s": step, "drift_m": drift, "simulated_s_per_cpu_s": WATCH / summary["cpu_s"],
                "largest_overlap_m": summary["max_overlap"]} if drift <= MOST_DRIFT else None

    best, low, high = stays(1.0), 1.0, 8.0
    while best and high > 1.03 * low:
        factor = math.sqrt(low * high)
        found = stays(factor)
        if found:
            best, low = found, factor
        else:
            high = factor
    row = {"blocks": rows * (rows + 1) // 2, "allowed_overlap": overlap, "contact_damping": contact_damping,
           "default_step_s": default}
    if best:
        speeds = [stays(low, WATCH)["simulated_s_per_cpu_s"] for _ in range(repeats)]
        at_default = statistics.median(stays(1.0, WATCH)["simulated_s_per_cpu_s"] for _ in range(repeats))
        row |= best | {"simulated_s_per_cpu_s": statistics.median(speeds), "most": max(speeds), "repeats": repeats,
                       "at_default_step": at_default}
        print(f"{row['blocks']} squares, allowed overlap {overlap:g}, contact damping {contact_damping:g}: stays at "
              f"{best['largest_step_s'] / default:.2f} times the default step of {default:.3g} s, drift {best['drift_m']:.1e} m "
              f"in 5 s, overlaps by no more than {best['largest_overlap_m']:.3g} m, {row['simulated_s_per_cpu_s']:.3g} "
              f"simulated s per CPU s, {at_default:.3g} at the default step", flush=True)
    return row


def write_table(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        table.writeheader()
        table.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, metavar="BUILD")
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    program, folder, quick = arguments.build.resolve() / "gcpdda", arguments.folder, arguments.quick
    repeats = 1 if quick else 5
    cases = [(20, 100, "rigid", 1e-3), (20, 100, "deformable", 1e-3)] if quick else [
        (20, 4000, "rigid", 1e-3), (100, 400, "rigid", 1e-3), (100, 2000, "rigid", 1e-3), (100, 2000, "deformable", 1e-3),
        (100, 2000, "rigid", 2e-3), (100, 2000, "rigid", 2e-2), (447, 400, "rigid", 1e-3), (1413, 40, "rigid", 1e-3)]
    rows = []
    work = Path(tempfile.mkdtemp())
    try:
        for pyramid_rows, steps, fidelity, overlap in cases:
            text = scene(work, pyramid_rows, steps, fidelity, overlap)
            step = default_step(program, work, text)
            nanoseconds = []
            for _ in range(repeats):
                summary, memory = run(program, work, text, step, steps)
                nanoseconds.append(1e9 * summary["cpu_s"] / summary["contact_steps"])
            blocks = summary["blocks"]
            rows.append({
                "blocks": blocks, "kind": fidelity, "allowed_overlap": overlap, "steps": summary["steps"],
                "contacts_per_block": summary["contact_steps"] / summary["steps"] / blocks,
                "evaluations_per_block": sum(summary["evaluations_per_rank"]) / summary["steps"] / blocks,
                "ns_per_contact_and_step": statistics.median(nanoseconds), "least": min(nanoseconds), "repeats": repeats,
                "simulated_s_per_cpu_s": summary["time"] / summary["cpu_s"], "largest_overlap_m": summary["max_overlap"],
                "peak_memory_per_block_bytes": memory / blocks})
            row = rows[-1]
            print(f"{blocks} {fidelity} squares, allowed overlap {overlap:g}: {row['ns_per_contact_and_step']:.0f} ns a "
                  f"contact and step (least {row['least']:.0f}), {row['contacts_per_block']:.2f} contacts a block, "
                  f"{row['simulated_s_per_cpu_s']:.3g} simulated s per CPU s, {row['peak_memory_per_block_bytes']:.0f} "
                  "bytes a block at the peak", flush=True)
        write_table(folder / "speed.csv", rows)
        piles = [(10, 1e-3, 0.05)] if quick else [(20, 1.48e-4, 0.05), (20, 1.48e-4, 0.0), (100, 1.9e-3, 0.05),
                                                  (100, 1.9e-3, 0.0), (100, 1.95e-2, 0.05), (100, 1.95e-2, 0.0)]
        write_table(folder / "speed_steps.csv", [largest_step(program, work, *pile, repeats) for pile in piles])
    finally:
        shutil.rmtree(work)


if __name__ == "__main__":
    main()
