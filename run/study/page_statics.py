"""What the page of the static solver shows."""

import math
import statistics

from page_tables import count, number, of, read, source, table

WAYS = ("static", "kinetic damping", "local damping", "slow loading")
TARGETS = {"normal_off": 0.01, "displacement_off": 0.04, "cap_off": 0.05}


def words_of(row):
    """A way to rest in words."""
    if row["way"] == "static":
        return f"static, {count(row['parts'])} increment{'s' if row['parts'] != '1' else ''}"
    return f"slow loading, {count(row['parts'])} steps" if row["way"] == "slow loading" else f"{row['way']}, at once"


def percent(value, digits=2):
    return number(100.0 * float(value), digits)


def marked(value, column):
    """A difference in percent, bold where it misses its target."""
    text = percent(value)
    return text if float(value) <= TARGETS[column] else f"**{text}**"


def cost_table(rows):
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        for way in dict.fromkeys(row["way"] for row in of(rows, scene=scene)):
            own = of(rows, scene=scene, way=way)
            at = {row["ratio"]: row for row in own}
            lines.append([scene, way] + [count(at[r]["evaluations"]) if at[r]["evaluations"] else "not reached"
                                         for r in ("0.01", "0.001", "0.0001", "1e-05", "1e-06")] +
                         [count(own[0]["settled_after"])] +
                         ["{} ({} to {})".format(*(number(own[0][f"cpu_over_static{which}"], 2)
                                                   for which in ("", "_least", "_most")))])
    return table(["scene", "way", "1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "evaluations to settled",
                  "CPU time over static"], lines, source("statics", "statics_cost.csv"))


def pairs_a_block(row):
    return float(row["pair_evaluations"]) / float(row["blocks"])


def evaluations_of_all(row):
    """How often the pair evaluations of a run would have looked at every pair of its model; of runs in several last bits
    the median, least and most."""
    median, least, most = (count(float(row[f"{which}pair_evaluations"]) / float(row["pairs"]))
                           for which in ("", "least_", "most_"))
    return median if row["rounds"] == "1" else f"{median} ({least} to {most})"


def growth_table(rows):
    lines = [[row["model"], count(row["blocks"]), row["start"], row["way"], count(row["evaluations"]),
              evaluations_of_all(row), count(pairs_a_block(row)), number(row["cpu_s"]), row["verdict"], row["loose"]]
             for row in rows]
    return table(["model", "blocks", "start", "way", "evaluations", "of all pairs", "pair evaluations a block", "CPU s",
                  "verdict", "loose blocks"], lines, source("statics", "statics_growth.csv"))


def exponents(rows):
    """Of N in the pair evaluations a block from the smallest to the largest slope, by way and start."""
    found = []
    for model, start in (("slope", "joints open"), ("slope", "in situ"), ("wall", "joints open")):
        for way in WAYS[:3]:
            own = [row for row in of(rows, model=model, start=start, way=way) if row["verdict"].startswith("settled")]
            if len(own) > 1:
                first, last = own[0], own[-1]
                power = (math.log(pairs_a_block(last) / pairs_a_block(first)) /
                         math.log(float(last["blocks"]) / float(first["blocks"])))
                found.append([model, start, way, f"{count(first['blocks'])} to {count(last['blocks'])}",
                              number(power, 2)])
    return table(["model", "start", "way", "blocks", "exponent of N"], found, source("statics", "statics_growth.csv"))


def over_static_table(rows):
    """CPU time of kinetic damping over that of the static solver, by model."""
    lines = []
    for kinetic in of(rows, way="kinetic damping"):
        static = of(rows, way="static", model=kinetic["model"], start=kinetic["start"], blocks=kinetic["blocks"])[0]
        lines.append([kinetic["model"], kinetic["start"], count(kinetic["blocks"]),
                      number(float(kinetic["cpu_s"]) / float(static["cpu_s"]), 2)])
    return table(["model", "start", "blocks", "CPU time of kinetic damping over static"], lines,
                 source("statics", "statics_growth.csv"))


def ranks_table(rows):
    lines = [[row["model"], row["start"], count(row["blocks"]), row["way"], count(row["evaluations"]),
              number(row["work_ratio"], 4), number(row["products"], 2), number(row["messages_per_rank"], 3), count(row["bytes_per_rank"]),
              number(row["reductions"], 3),
              "{} ({} to {})".format(*(number(row[f"efficiency{which}"], 2) for which in ("", "_least", "_most")))]
             for row in rows]
    return table(["model", "start", "blocks", "way", "evaluations", "busiest rank's work over its share", "products",
                  "messages a rank", "bytes a rank", "reductions", "efficiency"], lines, source("statics", "statics_ranks.csv"))


def paths_table(rows):
    shown = {*(("static", n) for n in ("1", "50", "100", "200", "800")), ("kinetic damping", "1"), ("local damping", "1"),
             ("slow loading", "8000")}
    lines = [[row["scene"], words_of(row), count(row["evaluations"]), number(row["cpu_s"]),
              marked(row["normal_off"], "normal_off"), row["pairs_off"],
              marked(row["displacement_off"], "displacement_off"), row["blocks_off"],
              marked(row["cap_off"], "cap_off"), row["verdict"]] for row in rows if (row["way"], row["parts"]) in shown]
    return table(["scene", "way", "evaluations", "CPU s", "20 largest N: worst, %", "of them beyond 1 %",
                  "displacement: worst, % of sag", "blocks beyond 4 %", "share at the cap, difference in %", "verdict"],
                 lines, source("statics", "statics_paths.csv"))


def random_table(rows):
    lines = []
    for way, parts in (*(("static", n) for n in ("50", "100", "200", "800")), ("kinetic damping", "1"),
                       ("slow loading", "8000")):
        own = of(rows, way=way, parts=parts)
        line = [words_of(own[0]), str(len(own))]
        for column in ("normal_off", "normal_off_mean", "displacement_off", "displacement_off_99", "cap_off"):
            values = [float(row[column]) for row in own]
            line.append(f"{percent(statistics.median(values))}, {percent(max(values))}")
        for column, target in TARGETS.items():
            line.append(str(sum(float(row[column]) <= target for row in own)))
        line.append(f"{statistics.median(int(row['evaluations']) for row in own):,.0f}")
        lines.append(line)
    return table(["way", "rock masses", "20 largest N: worst, %", "20 largest N: mean, %",
                  "displacement: worst block, % of sag", "displacement: 99 % of blocks, % of sag",
                  "share at the cap, difference in %", "N within 1 %", "displacement within 4 %",
                  "cap within 0.05", "evaluations, median"], lines,
                 source("statics", "statics_random.csv") + " Pairs are median and largest.")


def statics():
    cost, paths, random, growth, ranks = (read(f"statics_{part}.csv")
                                          for part in ("cost", "paths", "random", "growth", "ranks"))
    compared = [row for row in random if row["normal_off"]]
    default = of(compared, way="static", parts="50")
    finest = of(compared, way="static", parts="800")

    def beyond(rows, column):
        return [row for row in rows if float(row[column]) > TARGETS[column]]

    def missing(parts):
        own = of(compared, way="static", parts=parts)
        return str(sum(any(float(row[column]) > target for column, target in TARGETS.items()) for row in own))

    def scenes(parts):
        own = of(paths, way="static", parts=parts)
        return ", ".join(row["scene"] for row in own
                         if any(float(row[column]) > target for column, target in TARGETS.items())) or "none"

    def blocks(words):
        return f"{words} block" + ("s" if words != "1" else "")

    many = [row for row in default if int(row["blocks_off"]) > 10]
    then = [of(compared, way="static", parts="200", seed=row["seed"])[0]["blocks_off"] for row in many]
    far, still = beyond(default, "displacement_off"), beyond(finest, "displacement_off")
    return {
        "cost": cost_table(cost), "growth": growth_table(growth), "exponents": exponents(growth),
        "ranks": ranks_table(ranks),
        "over_static": over_static_table(growth),
        "paths": paths_table(paths), "random": random_table(compared), "masses": str(len(default)),
        "deformable": str(len(of(default, fidelity="deformable"))), "slopes": str(len(of(default, kind="slope"))),
        "replaced": str(len(random) - len(compared)),
        "blocks_low": count(min(int(row["blocks"]) for row in default)),
        "blocks_high": count(max(int(row["blocks"]) for row in default)),
        "far": str(len(far)),
        "far_blocks": count(statistics.median(int(row["blocks_off"]) for row in far) if far else 0),
        "far_most": count(max((int(row["blocks_off"]) for row in far), default=0)),
        "still": ", ".join(f"seed {row['seed']} ({blocks(row['blocks_off'])}, {percent(row['displacement_off'])} %)"
                           for row in still) or "none",
        "still_forces": ", ".join(f"seed {row['seed']} ({percent(row['normal_off'])} %)"
                                  for row in beyond(finest, "normal_off")) or "none",
        "scenes_50": scenes("50"), "scenes_100": scenes("100"), "missing_50": missing("50"),
        "missing_100": missing("100"), "missing_200": missing("200"),
        "missing_800": missing("800"), "then": " and ".join(then) or "none",
        "many": " and ".join(f"{row['blocks_off']} in seed {row['seed']}" for row in many) or "none",
        "left": str(sum("left" in row["verdict"] for row in of(compared, way="static"))),
        "runs": str(len(of(compared, way="static"))),
    }
