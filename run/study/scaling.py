#!/usr/bin/python3
"""scaling.py BUILD FOLDER [--quick]: what more ranks cost and bring; writes the tables of the scaling study to FOLDER.

Counts (work, ghosts, messages) are exact on any machine and at any number of ranks. Times are taken on two ranks only,
in rounds that alternate: one rank, two ranks, a half-size problem alone, two of them at once. The last two are the
ceiling that the machine itself sets. Use a quiet machine.
"""
import argparse
import csv
import json
import math
import os
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

MAKE_BLOCKS = Path(__file__).resolve().parent.parent / "make_blocks.py"
PROBLEMS = ("wall", "pyramid", "pile", "slope")
DENSITY = 2600.0


class Problem:
    """A scene of about so many blocks; stiffness by weight where it stands, by speed where it moves."""

    def __init__(self, name, blocks, folder):
        self.folder = folder
        rows = {"wall": math.sqrt(2.0 * blocks), "pyramid": math.sqrt(2.0 * blocks), "pile": math.sqrt(blocks),
                "slope": 0.2 * math.sqrt(blocks)}[name]
        rows = max(8, round(rows))
        allowed_overlap = 1e-3
        smallest = 0.3 if name == "pile" else 0.5
        height = 40.0 if name == "pile" else 0.5 * rows
        self.stiffness = DENSITY * 9.81 * height / (allowed_overlap * math.sqrt(smallest))
        self.time_step = 0.2 * math.sqrt(DENSITY * smallest / self.stiffness)
        # The sample wall has no ground of its own.
        self.floor = ('[[block]]\nname = "floor"\nmaterial = "rock"\nfixed = true\n'
                      f"vertices = [[-2, -2], [{blocks}, -2], [{blocks}, 0], [-2, 0]]\n" if name == "wall" else "")
        self.file = folder / f"{name}_{blocks}.h5"
        if not self.file.exists():
            overlap = 0.5 * allowed_overlap * math.sqrt(smallest)
            subprocess.run([MAKE_BLOCKS, self.file, "--shape", name, "--rows", str(rows), "--columns",
                            str(round(blocks / rows)), "--overlap", str(overlap)], check=True,
                           stdout=subprocess.DEVNULL)

    def scene(self, steps):
        path = self.folder / "scene.toml"
        duration = steps * self.time_step
        path.write_text(f'[run]\nduration = {duration}\ntime_step = {self.time_step}\nfidelity = "rigid"\n'
                        f'initial_friction = "zero"\n[material.rock]\ndensity = {DENSITY}\n[joint.default]\n'
                        f'normal_stiffness = {self.stiffness}\nfriction_angle_deg = 20.0\n[output]\n'
                        f"interval = {duration}\ncontacts = false\n[blocks]\nfile = \"{self.file}\"\n{self.floor}")
        return path


class Runner:
    def __init__(self, build, folder):
        self.program = build / "gcpdda"
        self.folder = folder
        self.num_started = 0

    def start(self, problem, steps, ranks, name="run"):
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        command = ["mpirun", "-n", str(ranks), "--oversubscribe", "--bind-to", "none", self.program, "run",
                   problem.scene(steps), "--out", out]
        # Starts of Open MPI that share a scratch folder, at once or one behind the other, disturb each other.
        self.num_started += 1
        scratch = self.folder / f"mpi_{self.num_started}"
        scratch.mkdir(exist_ok=True)
        environment = os.environ | {"OMPI_MCA_orte_tmpdir_base": str(scratch)}
        return out, subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def finish(self, started):
        out, process = started
        _, said = process.communicate()
        if process.returncode != 0:
            raise SystemExit(f"scaling.py: {said.decode()}")
        return json.loads((out / "summary.json").read_text())

    def run(self, problem, steps, ranks):
        return self.finish(self.start(problem, steps, ranks))


def share_of_communication(summary):
    phases = summary["phases"]
    loop = sum(phases[name]["mean"] for name in phases if name != "output")
    return (phases["ghosts"]["mean"] + phases["report"]["mean"]) / loop


PHASES = ("refresh", "predict", "ghosts", "forces", "update", "report", "output")


def excess(one, two):
    """What each phase takes on two ranks beyond half of what it takes one, us of a step."""
    return {f"{phase}_excess_us": 1e6 / one["steps"] * (two["phases"][phase]["mean"] - 0.5 * one["phases"][phase]["mean"])
            for phase in PHASES}


def write(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)


def count(runner, work, cases):
    """One row for each problem, size and number of ranks."""
    rows = []
    for name, blocks, steps, all_ranks in cases:
        problem = Problem(name, blocks, work)
        alone = None
        for ranks in all_ranks:
            summary = runner.run(problem, steps, ranks)
            work_done = summary["work_per_rank"]
            alone = alone or sum(work_done)
            steps_done = summary["steps"]
            rows.append({
                "problem": name, "blocks": summary["blocks"], "steps": steps_done, "ranks": ranks,
                "contacts_per_block": summary["contact_steps"] / steps_done / summary["blocks"],
                "evaluations_per_block": sum(summary["evaluations_per_rank"]) / steps_done / summary["blocks"],
                "work_ratio": max(work_done) * ranks / alone,
                "imbalance": max(work_done) * ranks / sum(work_done),
                "ghosts_per_rank": sum(summary["ghosts_per_rank"]) / ranks,
                "bytes_per_rank_and_step": summary["bytes_sent_per_step"] / ranks,
                "messages_per_rank_and_step": summary["messages_per_step"] / ranks,
                "refreshes": int(summary["counters"]["refreshes"]),
                "rebalances": int(summary["counters"]["rebalances"]),
                "migrations": int(summary["counters"]["migrations"]),
            })
            row = rows[-1]
            print(f"{name} {row['blocks']} blocks, {ranks} ranks: work {row['work_ratio']:.4f}, imbalance "
                  f"{row['imbalance']:.4f}, {row['ghosts_per_rank']:.0f} ghosts and {row['bytes_per_rank_and_step']:.0f} "
                  f"bytes in {row['messages_per_rank_and_step']:.2f} messages a rank and step", flush=True)
    return rows


def time_rounds(runner, work, cases, rounds):
    """Efficiency on two ranks, beside what two independent runs reach."""
    rows = []
    for name, blocks, steps in cases:
        whole = Problem(name, blocks, work)
        half = Problem(name, blocks // 2, work)
        taken = []
        for _ in range(rounds):
            one = runner.run(whole, steps, 1)
            two = runner.run(whole, steps, 2)
            alone = runner.run(half, steps, 1)
            pair = [runner.start(half, steps, 1, f"half{k}") for k in range(2)]
            at_once = [runner.finish(started) for started in pair]
            taken.append({"efficiency": one["wall_s"] / (2.0 * two["wall_s"]),
                          "ceiling": alone["wall_s"] / max(run["wall_s"] for run in at_once),
                          "wall_1": one["wall_s"], "wall_2": two["wall_s"],
                          "communication": share_of_communication(two)} | excess(one, two))
        middle = {key: statistics.median(t[key] for t in taken) for key in taken[0]}
        contacts = one["contact_steps"] / one["steps"] / one["blocks"]
        rows.append({"problem": name, "blocks": one["blocks"], "contacts_per_block": contacts, "steps": steps,
                     "rounds": rounds, "wall_1_rank_s": middle["wall_1"], "wall_2_ranks_s": middle["wall_2"],
                     "efficiency": middle["efficiency"], "ceiling": middle["ceiling"],
                     "efficiency_over_ceiling": statistics.median(t["efficiency"] / t["ceiling"] for t in taken),
                     "communication": middle["communication"], "build": "release"} |
                    {key: middle[key] for key in excess(one, two)})
        row = rows[-1]
        print(f"{name} {row['blocks']} blocks, {contacts:.2f} contacts a block, median of {rounds}: efficiency on 2 ranks "
              f"{row['efficiency']:.3f}, ceiling {row['ceiling']:.3f}, of it {row['efficiency_over_ceiling']:.3f}, "
              f"communication {row['communication']:.3f}", flush=True)
    return rows


def model(counts):
    """What the surface law, fitted to the most cut wall, says of more ranks and blocks than a machine here holds."""
    most_cut = max(counts, key=lambda row: row["ranks"])
    cut = [row for row in counts if row["problem"] == "wall" and row["blocks"] == most_cut["blocks"] and row["ranks"] >= 4]
    # Ghosts a rank over the square root of its blocks; messages level off at the neighbours of a part.
    per_root = [row["ghosts_per_rank"] / math.sqrt(row["blocks"] / row["ranks"]) for row in cut]
    bytes_per_ghost = cut[-1]["bytes_per_rank_and_step"] / cut[-1]["ghosts_per_rank"]
    messages = max(row["messages_per_rank_and_step"] for row in cut)
    rows = []
    for blocks in (1e6, 1e7, 1e8, 1e9):
        for ranks in (1e3, 1e4, 1e5):
            own = blocks / ranks
            ghosts = per_root[-1] * math.sqrt(own)
            cells = min(2.0**27, 2.0 * blocks, max(blocks / 2.0, 1024.0 * ranks), max(2.0**20, 1024.0 * ranks))
            rows.append({"blocks": int(blocks), "ranks": int(ranks), "blocks_per_rank": own, "ghosts_per_rank": ghosts,
                         "bytes_per_rank_and_step": bytes_per_ghost * ghosts, "messages_per_rank_and_step": messages,
                         "share_of_ghosts": ghosts / own, "cells_on_every_rank": int(cells),
                         "map_bytes_on_every_rank": 4 * int(cells), "weights_bytes_while_cutting": 8 * int(cells)})
    print(f"surface law: {per_root[-1]:.2f} sqrt(blocks a rank) ghosts ({min(per_root):.2f} to {max(per_root):.2f} over "
          f"{cut[0]['ranks']} to {cut[-1]['ranks']} ranks), {bytes_per_ghost:.0f} bytes each, {messages:.1f} messages")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, metavar="BUILD")
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    build, folder, quick = arguments.build.resolve(), arguments.folder, arguments.quick
    folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
    with tempfile.TemporaryDirectory() as scratch:
        work = Path(scratch)
        runner = Runner(build, work)
        if quick:
            counted = [(name, 5000, 40, (1, 2, 4) if name == "pile" else (1, 2)) for name in PROBLEMS]
            timed = [("wall", 2000, 40)]
        else:
            counted = [(name, 5000, 300, (1, 2, 4, 8)) for name in PROBLEMS]
            counted += [(name, 100000, 20, (1, 2, 4, 8)) for name in PROBLEMS]
            counted += [("wall", 20000, 4, (1, 2, 4, 8, 16, 32, 64))]
            counted += [(name, 1000000, 4, (1, 2)) for name in PROBLEMS]
            timed = [(name, 5000, 2000) for name in PROBLEMS] + [(name, 100000, 40) for name in PROBLEMS]
        counts = count(runner, work, counted)
        write(folder / "scaling.csv", counts)
        if not quick:
            write(folder / "scaling_model.csv", model(counts))
        write(folder / "scaling_times.csv", time_rounds(runner, work, timed, 1 if quick else 7))


if __name__ == "__main__":
    main()
