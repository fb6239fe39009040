#!/usr/bin/python3
"""The static solver: its cost against that of damped motion, and its equilibrium against that of slow loading.

    run/study/statics.py BUILD OUT_DIR [--quick] [--only PART ...] [--seed FIRST]
    run/study/statics.py BUILD OUT_DIR --large [MODEL ...]

PART is cost, paths, random, growth or ranks. Every run is on one rank, but for those of the last part. A count of evaluations is that of steps; pair evaluations
count the pairs of blocks that were evaluated. The ways to rest are the static solver with 1 to 800 increments of the load,
kinetic damping, local damping of 0.8, and slow loading: the load rises smoothly over a number of steps under local damping.

OUT_DIR/statics_cost.csv     evaluations and CPU time until the unbalanced ratio has fallen to a value
OUT_DIR/statics_paths.csv    difference from slow loading over 16,000 steps, against cost
OUT_DIR/statics_random.csv   the same of 30 random rock masses, with seeds from FIRST (1) on
OUT_DIR/statics_growth.csv   evaluations and CPU time of slopes and walls of up to 10^4 blocks; --large adds those of
                             10^5 and 10^6, or some of them: slope15, wall224, wall707
OUT_DIR/statics_ranks.csv    wall time on two ranks, work, messages and reductions. Use a quiet machine.
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
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy

import statics_scenes as scenes

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))
import gcpdda  # noqa: E402
from gcpdda.joints import strength_used  # noqa: E402

FAILED, UNDECIDED = 5, 7  # exit codes
RATIOS = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
AT_CAP = 0.95  # share of its strength from which on a contact counts as at the cap: beyond, the last swings decide
FAR, APART = 0.04, 0.01  # targets: of displacements over the sag, and of normal forces
LARGEST = 20   # normal forces that are compared
WAYS = {"static": 'solver = "static"', "kinetic damping": "kinetic_damping = true",
        "local damping": "local_damping = 0.8"}


class Rest:
    """A run: its facts, and its last frame once it is asked for."""

    def __init__(self, folder, log):
        self.folder, self.log = folder, log
        self.summary = json.loads((folder / "summary.json").read_text())
        stages = self.summary["stages"]
        self.settled = self.summary["verdict"] == "settled"
        self.left = "goes on with solver" in log
        self.loose = sum(stage.get("loose", 0) for stage in stages)
        self.step = self.summary["time_step"]

    @property
    def verdict(self):
        return self.summary["verdict"] + (", left to dynamics" if self.left else "")

    def state(self):
        """Displacement by block, normal force by pair of blocks, share of contacts at the cap."""
        frame = gcpdda.open_folder(self.folder).frame("last")
        free = ~frame.fixed
        moved = dict(zip(frame.ids[free].tolist(), frame.values("displacement")[free, :2]))
        data = frame._contact_data
        pushes = data["normal_force"] > 0.0
        forces = {}
        for pair, force in zip(map(tuple, data["blocks"][pushes].tolist()), data["normal_force"][pushes].tolist()):
            forces[pair] = forces.get(pair, 0.0) + force
        return moved, forces, float((strength_used(frame)[pushes] >= AT_CAP).mean()) if pushes.any() else 0.0


class Runner:
    def __init__(self, program, work):
        self.program, self.work, self.count = program, work, 0

    def run(self, case, keys, seconds=0.0, more=(), ranks=None):
        """@param seconds  over which the load comes
        @param ranks  started by mpirun; none: one without it"""
        self.count += 1
        folder = self.work / f"run{self.count}"
        sets = [word for setting in more for word in ("--set", setting)]
        start = ["mpirun", "-n", str(ranks), "--oversubscribe", "--bind-to", "none"] if ranks else []
        # Starts of Open MPI that share a scratch folder disturb each other.
        scratch = self.work / f"mpi{self.count}"
        scratch.mkdir()
        done = subprocess.run([*start, self.program, "run", case.file, "--out", folder, *case.arguments(keys, seconds),
                               *sets], capture_output=True, text=True,
                              env=os.environ | {"OMPI_MCA_orte_tmpdir_base": str(scratch)})
        if done.returncode not in (0, FAILED, UNDECIDED):
            raise SystemExit(f"{case.file}, {keys}:\n{done.stderr}")
        return Rest(folder, done.stderr)

    def slowly(self, case, steps, keys="local_damping = 0.8"):
        """Slow loading over so many steps."""
        step = self.step(case, keys)
        return self.run(case, keys, steps * step)

    def step(self, case, keys):
        """The step that a way to rest chooses, s."""
        said = subprocess.run([self.program, "inspect", case.file, *case.arguments(keys)], check=True,
                              capture_output=True, text=True).stdout
        return float(re.search(r"^step +([-0-9.e+]+) s", said, re.MULTILINE).group(1))

    def drop(self, rest):
        shutil.rmtree(rest.folder)


def difference(reference, other):
    """How far an equilibrium is from a reference, as columns of a table."""
    moved, forces, cap = reference
    moved_too, forces_too, cap_too = other
    sag = max(float(numpy.hypot(*u)) for u in moved.values())
    apart = numpy.array([float(numpy.hypot(*(moved_too[block] - u))) for block, u in moved.items()]) / sag
    largest = sorted(forces, key=lambda pair: -forces[pair])[:LARGEST]
    off = [abs(forces_too.get(pair, 0.0) / forces[pair] - 1.0) for pair in largest]
    return {"sag_m": sag, "displacement_off": float(apart.max()),
            "displacement_off_99": float(numpy.quantile(apart, 0.99)), "blocks_off": int((apart > FAR).sum()),
            "pairs_off": sum(value > APART for value in off), "normal_off": max(off),
            "normal_off_mean": statistics.mean(off), "cap": cap_too, "cap_off": abs(cap_too - cap)}


def facts(rest):
    summary = rest.summary
    return {"blocks": summary["blocks"], "verdict": rest.verdict, "loose": rest.loose, "evaluations": summary["steps"],
            "pair_evaluations": sum(summary["evaluations_per_rank"]), "pairs": int(summary["counters"]["most_pairs"]),
            "cpu_s": summary["cpu_s"]}


def write_table(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)), lineterminator="\n")
        table.writeheader()
        for row in rows:
            table.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()})


def tell(**row):
    words = (f"{key} {value:.3g}" if isinstance(value, float) else f"{key} {value}" for key, value in row.items())
    print(", ".join(words), flush=True)


def paths(runner, quick):
    """Difference from slow loading against cost."""
    most, slower = (2000, [500]) if quick else (16000, [500, 1000, 2000, 4000, 8000])
    increments = [1, 50] if quick else [1, 10, 25, 50, 100, 200, 400, 800]
    rows = []
    for name, case in scenes.cases(runner.work, quick).items():
        rest = runner.slowly(case, most, "tolerance = 1e-6, local_damping = 0.8")
        reference = rest.state()
        row = {"scene": name, "way": "slow loading", "parts": most}
        rows.append(row | facts(rest) | difference(reference, reference))
        tell(**rows[-1])
        runner.drop(rest)
        ways = [("static", n, lambda n=n: runner.run(case, f"{WAYS['static']}, increments = {n}")) for n in increments]
        ways += [(way, 1, lambda way=way: runner.run(case, WAYS[way])) for way in ("kinetic damping", "local damping")]
        ways += [("slow loading", n, lambda n=n: runner.slowly(case, n)) for n in slower]
        for way, parts, run in ways:
            rest = run()
            rows.append({"scene": name, "way": way, "parts": parts} | facts(rest) | difference(reference, rest.state()))
            tell(**rows[-1])
            runner.drop(rest)
    return rows


def random_masses(runner, quick, first=1):
    """Ways to rest of random rock masses; one that fails under slow loading is replaced by the next."""
    count, most, increments = (2, 1000, [50]) if quick else (30, 16000, [50, 100, 200, 800])
    rows, seed, taken = [], first - 1, 0
    while taken < count:
        seed += 1
        case, row = scenes.rock_mass(runner.work, seed)
        row = {"seed": seed} | row
        rest = runner.slowly(case, most, "tolerance = 1e-6, local_damping = 0.8")
        if not rest.settled or not 200 <= rest.summary["blocks"] <= 800:
            rows.append(row | {"way": "slow loading", "parts": most} | facts(rest))
            tell(**rows[-1])
            runner.drop(rest)
            continue
        taken += 1
        reference = rest.state()
        rows.append(row | {"way": "slow loading", "parts": most} | facts(rest) | difference(reference, reference))
        runner.drop(rest)
        ways = [("static", n, lambda n=n: runner.run(case, f"{WAYS['static']}, increments = {n}")) for n in increments]
        ways += [("slow loading", most // 2, lambda: runner.slowly(case, most // 2))]
        ways += [("kinetic damping", 1, lambda: runner.run(case, WAYS["kinetic damping"]))]
        for way, parts, run in ways:
            rest = run()
            rows.append(row | {"way": way, "parts": parts} | facts(rest) | difference(reference, rest.state()))
            tell(**rows[-1])
            runner.drop(rest)
    return rows


def reached(rest, first):
    """Evaluations until the unbalanced ratio is first down to each of RATIOS after `first` of them; the energies have
    a row a step."""
    ratio = gcpdda.open_folder(rest.folder).energy.filter(like="unbalanced").to_numpy()[1:, 0]
    if len(ratio) < rest.summary["steps"]:
        raise SystemExit(f"{rest.folder}: {len(ratio)} rows of energies in {rest.summary['steps']} steps")
    found = {}
    for least in RATIOS:
        below = numpy.flatnonzero(ratio[first:] <= least)
        found[least] = first + int(below[0]) + 1 if len(below) else None
    return found


def in_other_bits(case, count):
    """Settings of so many runs of a case whose densities differ in their tenth digit: evaluations hang on last bits."""
    materials = tomllib.loads(case.file.read_text())["material"]
    return [[f"material.{name}.density={material['density'] * (1.0 + 1e-10 * k)!r}"
             for name, material in materials.items()] for k in range(count)]


def cost(runner, quick):
    """Evaluations and CPU time to an unbalanced ratio. CPU times are of alternating runs without histories. Numbers of
    evaluations hang on last bits: from round to round densities differ in their tenth digit."""
    rounds, slow_steps = (1, 1000) if quick else (5, 8000)
    found = scenes.cases(runner.work, quick)
    rows = []
    for name in ("wall", "pyramid") if quick else ("wall", "pyramid", "slope_jointed, 10 GPa", "slope_jointed"):
        case = found[name]
        steps = {way: runner.step(case, keys) for way, keys in WAYS.items()}
        ways = {way: (f"{keys}, tolerance = 1e-6", 0.0, 50 if way == "static" else 0) for way, keys in WAYS.items()}
        if name == "slope_jointed, 10 GPa":  # a row of energies for every step takes long where blocks deform
            del ways["local damping"]
        else:
            ways["slow loading"] = (ways["local damping"][0], slow_steps * steps["local damping"], slow_steps)
            steps["slow loading"] = steps["local damping"]
        if name == "slope_jointed":  # as it ships, so that nothing slips while the rock takes up its weight
            ramp = tomllib.loads(case.file.read_text())["run"]["gravity_ramp"]
            way = f"kinetic damping, gravity over {ramp:g} s"
            steps[way] = steps["kinetic damping"]
            ways[way] = (ways["kinetic damping"][0], ramp, math.ceil(ramp / steps[way]))
        counts, cpu = {}, {way: [] for way in ways}
        for way, (keys, seconds, loaded) in ways.items():
            interval = scenes.LIMIT / math.ceil(scenes.LIMIT / steps[way] - 0.01)  # that of the program
            rest = runner.run(case, keys, seconds,
                              [f"output.interval={scenes.LIMIT}", f"output.history_interval={interval!r}"])
            counts[way] = reached(rest, loaded), rest
        for densities in in_other_bits(case, rounds):
            for way, (keys, seconds, _) in ways.items():
                rest = runner.run(case, keys, seconds, densities)
                cpu[way].append((rest.summary["cpu_s"], rest.summary["steps"]))
                runner.drop(rest)
        for way in ways:
            over = [own[0] / static[0] for own, static in zip(cpu[way], cpu["static"])]
            per_step = statistics.median(seconds / steps for seconds, steps in cpu[way])
            settled_after = statistics.median(steps for _, steps in cpu[way])
            at, rest = counts[way]
            for ratio, evaluations in at.items():
                rows.append({"scene": name, "way": way, "blocks": rest.summary["blocks"], "ratio": f"{ratio:g}",
                             "evaluations": evaluations, "cpu_s": evaluations * per_step if evaluations else None,
                             "settled_after": settled_after, "cpu_over_static": statistics.median(over),
                             "cpu_over_static_least": min(over), "cpu_over_static_most": max(over), "rounds": rounds})
            tell(scene=name, way=way, settled_after=settled_after, cpu_over_static=statistics.median(over),
                 **{f"{ratio:g}": n for ratio, n in at.items()})
            runner.drop(rest)
    return rows


SMALL = [("slope", 1), ("slope", 2), ("slope", 5), ("wall", 16), ("wall", 50)]  # benches, rows of bricks
LARGE = {("slope", 15): ["static", "kinetic damping"], ("wall", 224): ["static", "kinetic damping"],
         ("wall", 707): ["static"]}


def growth(runner, models, ways, rounds=1):
    """Evaluations of slopes of more and more benches and walls of more and more rows, the blocks of the same size. A row
    of the static solver is the median of so many runs."""
    rows = []
    for model, size in models:
        starts = {"joints open": scenes.pile(runner.work, "wall", size)} if model == "wall" else {
            start: scenes.slope_of_benches(size, start) for start in ("in situ", "joints open")}
        for start, case in starts.items():
            for way in ways:
                found = []
                for densities in in_other_bits(case, rounds if way == "static" else 1):
                    rest = runner.run(case, WAYS[way], more=densities)
                    found.append(facts(rest))
                    runner.drop(rest)
                found.sort(key=lambda run: run["pair_evaluations"])
                rows.append({"model": model, "size": size, "start": start, "way": way} | found[len(found) // 2]
                            | {"rounds": len(found), "least_pair_evaluations": found[0]["pair_evaluations"],
                               "most_pair_evaluations": found[-1]["pair_evaluations"]})
                tell(**rows[-1])
    return rows


def ranks(runner, quick):
    """Wall time of the step loop on one rank over twice that on two, in alternating runs: of stages of the static solver and
    of steps of damped motion."""
    models = [("slope", 1, "joints open", 1, 20)] if quick else \
        [("slope", 5, "joints open", 9, 300), ("slope", 15, "in situ", 3, 100), ("wall", 50, "joints open", 9, 300)]
    rows = []
    for model, size, start, rounds, steps in models:
        case = scenes.pile(runner.work, "wall", size) if model == "wall" else scenes.slope_of_benches(size, start)
        limit = steps * runner.step(case, WAYS["local damping"])
        few_steps = [f"stage.weight.limit={limit!r}", f"output.interval={limit!r}", f"output.history_interval={limit!r}"]
        taken = {"static": [], "local damping": []}
        last = {}
        for _ in range(rounds):
            for way, over in taken.items():
                walls = []
                for count in (1, 2):
                    rest = runner.run(case, WAYS[way], more=few_steps if way == "local damping" else [], ranks=count)
                    last[way, count] = rest.summary
                    walls.append(rest.summary["wall_s"])
                    runner.drop(rest)
                over.append(walls[0] / (2.0 * walls[1]))
        for way, over in taken.items():
            one, two = last[way, 1], last[way, 2]
            if one["steps"] != two["steps"]:
                raise SystemExit(f"{model} {size}, {way}: {one['steps']} steps on one rank, {two['steps']} on two")
            done = two["steps"]
            rows.append({"model": model, "size": size, "start": start, "way": way, "blocks": two["blocks"],
                         "evaluations": done, "work_ratio": 2.0 * max(two["work_per_rank"]) / sum(one["work_per_rank"]),
                         "ghosts_per_rank": sum(two["ghosts_per_rank"]) / 2.0,
                         "products": two["counters"]["products"] / done,
                         "messages_per_rank": two["messages_per_step"] / 2.0,
                         "bytes_per_rank": two["bytes_sent_per_step"] / 2.0,
                         "reductions": two["counters"]["reductions"] / done,
                         "efficiency": statistics.median(over), "efficiency_least": min(over),
                         "efficiency_most": max(over), "rounds": rounds})
            tell(**rows[-1])
    return rows


def known(path):
    """The rows of each model in the table of growth as it is."""
    rows = {}
    if path.exists():
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                rows.setdefault((row["model"], int(row["size"])), []).append(row)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, metavar="BUILD")
    parser.add_argument("out", type=Path, metavar="OUT_DIR")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=["cost", "paths", "random", "growth", "ranks"], metavar="PART")
    names = {f"{model}{size}": (model, size) for model, size in LARGE}
    parser.add_argument("--large", nargs="*", choices=[*names], metavar="MODEL")
    parser.add_argument("--seed", type=int, default=1, metavar="FIRST")
    asked = parser.parse_args()
    table = asked.out / "statics_growth.csv"
    parts = {"cost": cost, "paths": paths, "ranks": ranks,
             "random": lambda runner, quick: random_masses(runner, quick, asked.seed),
             "growth": lambda runner, quick: growth(runner, SMALL[:1] if quick else SMALL, [*WAYS], 1 if quick else 15)
             + [row for model in LARGE for row in known(table).get(model, [])]}
    with tempfile.TemporaryDirectory() as work:
        runner = Runner(asked.build.resolve() / "gcpdda", Path(work))
        if asked.large is not None:
            rows = known(table)
            for name in asked.large or names:
                rows[names[name]] = growth(runner, [names[name]], LARGE[names[name]])
            write_table(table, [row for model in [*SMALL, *LARGE] for row in rows.get(model, [])])
            return
        for part in asked.only or parts:
            write_table(asked.out / f"statics_{part}.csv", parts[part](runner, asked.quick))


if __name__ == "__main__":
    main()
