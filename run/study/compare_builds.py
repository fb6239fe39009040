#!/usr/bin/python3
"""compare_builds.py PROGRAM_A PROGRAM_B CASE [CASE_B] [--rounds N]: how long two builds of gcpdda take for a contact, at once.

Both run at the same time, each on a core of its own, and change places in every round: what else a shared machine has
to do then slows both. CASE is like deformable:100:2000, that is kind, rows of a pyramid (speed.py) and steps. Prints
the median of the ratios B/A for each place, of which it takes the geometric mean, by phases of the step; a program
against itself says how far such a number can be trusted.
"""
import argparse
import json
import math
import statistics
import subprocess
import tempfile
from pathlib import Path

import speed

PHASES = ("predict", "forces", "update")


def prepared(program, work, case):
    """The scene of a case with the step that the program chooses."""
    kind, rows, steps = case.split(":")
    text = speed.scene(work, int(rows), int(steps), kind, 1e-3)
    path = work / f"{case.replace(':', '_')}.toml"
    path.write_text(speed.stepped(text, speed.default_step(program, work, text), int(steps)))
    return path


def start(program, scene, core, work):
    return subprocess.Popen(["taskset", "-c", str(core), program, "run", scene, "--out", work / f"out{core}", "--overwrite"],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def nanoseconds(core, work):
    """Of a touching contact, by phase of the step and all in."""
    summary = json.loads((work / f"out{core}/summary.json").read_text())
    taken = {phase: 1e9 * summary["phases"][phase]["mean"] / summary["contact_steps"] for phase in PHASES}
    return taken | {"all": sum(taken.values())}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs=2, type=Path)
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--rounds", type=int, default=6)
    asked = parser.parse_args()
    first, second = (program.resolve() for program in asked.programs)
    with tempfile.TemporaryDirectory() as scratch:
        work = Path(scratch)
        scenes = [prepared(first, work, case) for case in (asked.cases * 2)[:2]]
        ratios, least = [], [math.inf, math.inf]
        for number in range(asked.rounds):
            cores = (0, 1) if number % 2 == 0 else (1, 0)
            running = [start(*what, work) for what in zip((first, second), scenes, cores)]
            if any(process.wait() != 0 for process in running):
                raise SystemExit("compare_builds.py: a run failed")
            a, b = (nanoseconds(core, work) for core in cores)
            ratios.append({key: b[key] / a[key] for key in a})
            least = [min(least[0], a["all"]), min(least[1], b["all"])]
        for key in ratios[0]:
            by_place = [statistics.median(math.log(r[key]) for r in ratios[place::2]) for place in (0, 1)]
            print(f"{key}: {math.exp(statistics.mean(by_place)):.3f} ({min(r[key] for r in ratios):.2f} to "
                  f"{max(r[key] for r in ratios):.2f})")
        print(f"least: {least[0]:.1f} and {least[1]:.1f} ns a contact and step, {asked.rounds} rounds")


if __name__ == "__main__":
    main()
