#!/usr/bin/python3
"""statics_study.py BUILD FOLDER: run/study/statics.py --quick and its charts, and what the tables say of small models.

The tables have a row for every way to rest. On a wall, a pyramid and a slope more increments end nearer to slow
loading, the default number ends within some per cent of it, and the static solver takes fewer evaluations than damped
motion.
"""

import csv
import subprocess
import sys
from pathlib import Path

STUDY = Path(__file__).resolve().parents[2] / "run" / "study"
WAYS = ["static", "kinetic damping", "local damping", "slow loading"]


def of(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def check_cost(rows):
    for scene in ("wall", "pyramid"):
        assert {row["way"] for row in of(rows, scene=scene)} == set(WAYS), scene
        for way in WAYS:
            own = of(rows, scene=scene, way=way)
            assert [row["ratio"] for row in own] == ["0.1", "0.01", "0.001", "0.0001", "1e-05", "1e-06"], own
            counts = [int(row["evaluations"]) for row in own]
            assert counts == sorted(counts) and counts[-1] <= int(own[0]["settled_after"]) + 1000, (scene, way, counts)
            # The load of the static solver is complete after 50 evaluations; that of slow loading after its rise.
            assert counts[0] > {"static": 49, "slow loading": 999}.get(way, 0), (scene, way, counts)
        at = {way: int(of(rows, scene=scene, way=way, ratio="1e-05")[0]["evaluations"]) for way in WAYS}
        assert at["static"] < at["kinetic damping"] < at["local damping"] < at["slow loading"], at


def check_paths(rows):
    for scene in ("wall", "pyramid", "slope_seeds"):
        reference = of(rows, scene=scene, way="slow loading", parts="2000")[0]
        assert float(reference["normal_off"]) == float(reference["displacement_off"]) == 0.0, reference
        at_once, default = (of(rows, scene=scene, way="static", parts=parts)[0] for parts in ("1", "50"))
        assert default["verdict"] == at_once["verdict"] == "settled", (at_once, default)
        assert 50 < int(default["evaluations"]) < 200, default
        for column, most in (("normal_off", 0.03), ("displacement_off", 0.15)):
            assert float(default[column]) < min(most, float(at_once[column])), (scene, column, at_once, default)
        assert 0.0 <= float(default["cap"]) <= 1.0 and float(default["sag_m"]) > 0.0, default


def check_random(rows):
    compared = [row for row in rows if row["normal_off"]]
    assert len({row["seed"] for row in compared}) == 2, rows
    for row in of(compared, way="static"):
        assert 200 <= int(row["blocks"]) <= 800 and row["verdict"] == "settled", row
        assert float(row["displacement_off_99"]) < 0.15, row


def check_growth(rows):
    assert {(row["start"], row["way"]) for row in rows} == {(start, way) for start in ("joints open", "in situ")
                                                            for way in WAYS[:3]}, rows
    for row in rows:
        assert row["verdict"] == "settled", row
        evaluations, pairs = int(row["evaluations"]), int(row["pairs"])
        assert evaluations * int(row["blocks"]) < int(row["pair_evaluations"]) <= evaluations * pairs, row


def check_ranks(rows):
    static, motion = (of(rows, way=way)[0] for way in ("static", "local damping"))
    for row in (static, motion):
        assert 1.0 <= float(row["work_ratio"]) < 1.5 and float(row["efficiency"]) > 0.0, row
    # A product sends its rows to the neighbour and takes one reduction; a step sends one message.
    assert float(motion["products"]) == 0.0 and float(motion["messages_per_rank"]) == 1.0, motion
    assert float(static["products"]) > 1.0, static
    assert float(static["messages_per_rank"]) >= 1.0 + float(static["products"]), static
    assert 1.0 < float(static["reductions"]) / float(static["products"]) < 3.0, static


def main():
    build, folder = (Path(word) for word in sys.argv[1:3])
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([STUDY / "statics.py", build, folder, "--quick"], check=True)
    subprocess.run([STUDY / "plot_statics.py", folder], check=True)
    checks = {"cost": check_cost, "paths": check_paths, "random": check_random, "growth": check_growth,
              "ranks": check_ranks}
    for part, check in checks.items():
        with open(folder / f"statics_{part}.csv", newline="") as file:
            check(list(csv.DictReader(file)))
    assert (folder / "statics.png").stat().st_size > 10000
    print("the tables of the statics study have what they should")


if __name__ == "__main__":
    main()
