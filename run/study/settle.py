#!/usr/bin/python3
"""What a settle stage saves: a wall of bricks under its own weight, brought to rest by slow dynamics and by settle.

    run/study/settle.py GCPDDA OUT_DIR [--quick]

The wall has 50 rows of 100 bricks; --quick takes 12 rows of 20. Slow dynamics is what one does without settle: gravity
rises slowly, joints are damped as usual, and nothing else takes energy. The slower it rises, the less the wall sways
afterwards: the time of the rise is doubled until the wall stays within 1e-3 of its greatest settlement of where a settle
stage of a hundred times smaller tolerance leaves it, all through the quarter of that time that follows the rise: a wall
that sways passes through its place of rest, too. Prints steps and contact evaluations of both.
"""

import argparse
import json
import os
import subprocess

import h5py
import numpy

SCENE = """[run]
{run}fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 35.0
[output]
interval = {interval}
contacts = false
[[block]]
name = "floor"
material = "rock"
fixed = true
vertices = [[-1, -1], [{right}, -1], [{right}, 0], [-1, 0]]
[[wall]]
name = "w"
material = "rock"
origin = [0.0, 0.0]
rows = {rows}
columns = {columns}
block_size = [1.0, 0.5]
{stages}"""


def run(gcpdda, out, name, rows, columns, keys, interval, stages, counted=1):
    """Summary, and displacements in the last frames that count."""
    text = SCENE.format(run=keys, interval=interval, right=columns + 1, rows=rows, columns=columns, stages=stages)
    scene = os.path.join(out, name + ".toml")
    with open(scene, "w") as file:
        file.write(text)
    folder = os.path.join(out, name)
    subprocess.run([gcpdda, "run", scene, "--out", folder, "--overwrite"], check=True, stderr=subprocess.DEVNULL)
    with open(os.path.join(folder, "summary.json")) as file:
        summary = json.load(file)
    frames = sorted(f for f in os.listdir(os.path.join(folder, "frames")) if f.startswith("frame_"))
    displacements = []
    for frame in frames[-counted:]:
        with h5py.File(os.path.join(folder, "frames", frame)) as file:
            displacements.append(numpy.array(file["VTKHDF/CellData/displacement"])[:, :2])
    return summary, displacements


def settle(tolerance, more=""):
    return f'[[stage]]\nkind = "settle"\nlimit = 100.0\nsolver = "dynamic"\ntolerance = {tolerance}\n{more}'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gcpdda", metavar="GCPDDA")
    parser.add_argument("out", metavar="OUT_DIR")
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    gcpdda, out = arguments.gcpdda, arguments.out
    rows, columns = (12, 20) if arguments.quick else (50, 100)
    os.makedirs(out, exist_ok=True)
    _, rest = run(gcpdda, out, "reference", rows, columns, "", 20.0, settle(1e-7))
    largest = numpy.abs(rest[0]).max()
    rows_of_table = []

    def tell(name, summary, displacements):
        error = max(numpy.abs(displacement - rest[0]).max() for displacement in displacements) / largest
        rows_of_table.append((name, summary["steps"], sum(summary["evaluations_per_rank"]), error))
        print(f"{name:32} {summary['steps']:8} steps {sum(summary['evaluations_per_rank']):12} contact evaluations, "
              f"{error:.1e} of the settlement off", flush=True)
        return error

    tell("settle, local damping", *run(gcpdda, out, "settle", rows, columns, "", 20.0, settle(1e-5)))
    tell("settle, kinetic damping",
         *run(gcpdda, out, "kinetic", rows, columns, "", 20.0, settle(1e-5, "kinetic_damping = true\n")))
    rise = 0.25
    while True:
        rise *= 2.0
        keys = f"duration = {1.25 * rise}\ngravity_ramp = {rise}\n"
        if tell(f"slow dynamics, gravity in {rise:g} s",
                *run(gcpdda, out, "slow", rows, columns, keys, rise / 64, "", counted=17)) <= 1e-3 or rise > 100.0:
            break
    _, steps, evaluations, _ = rows_of_table[1]
    print(f"kinetic damping takes 1/{rows_of_table[-1][1] / steps:.1f} of the steps and 1/{rows_of_table[-1][2] / evaluations:.1f} "
          "of the contact evaluations")


if __name__ == "__main__":
    main()
