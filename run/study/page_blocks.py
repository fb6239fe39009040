"""What the pages of stability and fidelity show."""

from page_tables import count, number, of, read, source, table

KINDS = ("5 GPa", "30 GPa", "300 GPa")
FEATURES = {"100 mobile blocks far away": "100 further mobile blocks that fall elsewhere",
            "the same scene again": "none: the same scene again, for the scatter"}


def soak():
    """Drift of the energy, relative, in 1e6 block-steps: slope of a straight line, and its standard error."""
    rows = read("soak.csv")
    x = [float(row["block_steps"]) / 1e6 for row in rows]
    y = [float(row["energy_ratio"]) for row in rows]
    x_mean, y_mean = sum(x) / len(x), sum(y) / len(y)
    spread = sum((a - x_mean) ** 2 for a in x)
    slope = sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y)) / spread
    rest = sum((b - y_mean - slope * (a - x_mean)) ** 2 for a, b in zip(x, y))
    return slope, (rest / (len(x) - 2) / spread) ** 0.5, x[-1]


def flutter():
    """Of the map of sheared columns: states, how many grow, worst growth, largest deviation of the runs."""
    rows, runs = read("flutter_map.csv"), read("flutter_runs.csv")
    least = 1e-3
    centre = [float(row["growth_centre_over_omega"]) for row in rows]
    grip = [float(row["growth_grip_over_omega"]) for row in rows]
    growing = [row for row in runs if row["acts_at"] == "centre of pressure" and float(row["theory_over_omega"]) > 0.05]
    apart = max(abs(float(row["measured_over_omega"]) / float(row["theory_over_omega"]) - 1.0) for row in growing)
    return {"flutter_states": f"{len(rows):,d}", "flutter_centre": f"{sum(g > least for g in centre):,d}",
            "flutter_grip": f"{sum(g > least for g in grip):,d}", "flutter_worst": number(max(centre), 2),
            "flutter_apart": number(100.0 * apart, 1), "flutter_source": source("flutter", "flutter_map.csv", "flutter_runs.csv")}


def stability():
    limits, chains, failures = read("limits.csv"), read("chain_limits.csv"), read("boundaries.csv")
    apart = max(abs(float(row["measured"]) / float(row["theory"]) - 1.0) for row in limits if float(row["theory"]) > 0.0)
    rebounds = read("restitution.csv")
    slope, error, block_steps = soak()

    def joint_units(row, key):
        return number((float(row[key]) / float(row["omega_joint"])) ** 2, 4)

    def last_good(row):
        if row["boundary"] == "none":
            return "none"
        return count(row["boundary"]) if float(row["boundary"]).is_integer() else number(row["boundary"])

    def happens(row):
        return row["what_happens_beyond"].split(";")[0].split(": warning")[0]

    return {
        "limits": table(["scheme", "contact force taken at", "spectral radius", "damping ratio", "limit of W, theory",
                         "limit of W, runs"],
                        [[row["scheme"], row["contact_time"] or "as the scheme says", row["spectral_radius"], row["damping_ratio"],
                          number(row["theory"], 4) if float(row["theory"]) else "none: grows at every W",
                          number(row["measured"], 4) if float(row["measured"]) else "grows"] for row in limits],
                        source("stability", "limits.csv")),
        "members": str(len({(row["scheme"], row["contact_time"], row["spectral_radius"]) for row in limits})),
        "limits_apart": number(100.0 * apart, 1),
        "chains": table(["blocks", "elasticity", "k_n L/E", "omega_max^2 m/(k_n L), runs", "theory of the chain",
                         "bound of the program"],
                        [[row["kind"], row["elasticity"], number(row["k_n L/E"], 1) if float(row["k_n L/E"]) else "0",
                          joint_units(row, "omega_max_measured"), joint_units(row, "omega_max_theory"),
                          joint_units(row, "product_bound_omega")] for row in chains], source("stability", "chain_limits.csv")),
        "rebounds": table(["contact force taken at", "W", "speed after over before, predicted", "mean of the runs", "lowest",
                           "highest"],
                          [[row["contact_time"], row["W"], number(row["predicted"], 4), number(row["mean"], 4),
                            number(row["lowest"], 4), number(row["highest"], 4)] for row in rebounds],
                          source("stability", "restitution.csv")),
        "failures": table(["problem", "parameter", "last good value", "what happens beyond"],
                          [[row["problem"], row["parameter"] + (f", {row['unit']}" if row["unit"] != "1" else ""),
                            last_good(row), happens(row)]
                           for row in failures], source("stability", "boundaries.csv")),
        "num_failures": str(len(failures)),
        "soak_drift": f"{slope:.0e} ± {error:.0e}", "soak_steps": f"{count(1e6 * block_steps)}",
        "soak_source": source("stability", "soak.csv"),
    } | flutter()


def fidelity():
    rows, features, scenes, factors = read("fidelity.csv"), read("unused.csv"), read("scenes.csv"), read("fos_stiffness.csv")
    lines, worst = [], 1.0
    for problem in dict.fromkeys(row["problem"] for row in rows):
        for ratio in dict.fromkeys(row["k_n_L_over_E"] for row in of(rows, problem=problem)):
            kinds = {row["fidelity"]: row for row in of(rows, problem=problem, k_n_L_over_E=ratio)}
            rigid = kinds["rigid"]
            worst = max(worst, float(rigid["predicted_error"]) / float(rigid["error"]))
            lines.append([problem, ratio, number(rigid["predicted_error"], 2), number(rigid["error"], 2),
                          number(kinds["deformable"]["error"], 2), kinds["auto"]["deformable_blocks"] + " of " +
                          kinds["deformable"]["deformable_blocks"], number(kinds["auto"]["error"], 2),
                          number(float(kinds["auto"]["cpu_s"]) / float(kinds["deformable"]["cpu_s"]), 2)])
    moved = []
    for scene in dict.fromkeys(row["scene"] for row in scenes):
        kinds = {row["blocks"]: row for row in of(scenes, scene=scene)}
        same = all(kind["verdicts"] == kinds["rigid"]["verdicts"] for kind in kinds.values())
        moved.append([f"`{scene}`", kinds["rigid"]["verdicts"] if same else "differ", number(kinds["rigid"]["displacement_m"], 2)] +
                     [f"{number(kinds[k]['displacement_ratio'], 3)} ({number(kinds[k]['compression_ratio'], 3)})" for k in KINDS])
    searches = []
    for scene in dict.fromkeys(row["scene"] for row in factors):
        for row in of(factors, scene=scene):
            rigid = row["youngs_modulus"] == "rigid"
            searches.append([f"`{scene}`", "rigid" if rigid else f"{float(row['youngs_modulus']) / 1e9:g} GPa",
                             f"{float(row['holds']):.4f}", f"{float(row['fails']):.4f}", row["undecided_trials"]])
    return {
        "fidelity": table(["problem", "k_n L/E", "predicted error of rigid", "rigid", "deformable",
                           "blocks that auto lets deform", "auto", "CPU of auto over deformable"], lines,
                          source("fidelity", "fidelity.csv")),
        "prediction_factor": number(worst, 2),
        "unused": table(["feature", "CPU time", "contact evaluations", "contacts"],
                        [[FEATURES.get(row["feature"], row["feature"]), number(row["cpu_ratio"]), number(row["evaluations_ratio"], 4),
                          number(row["contact_steps_ratio"], 4)] for row in features], source("fidelity", "unused.csv")),
        "scenes": table(["scene", "verdicts, for all stiffnesses", "rigid: displacement, m"] +
                        [f"{kind}: over rigid (compression)" for kind in KINDS], moved, source("scenes", "scenes.csv")),
        "same_verdicts": (f"All {len(moved)} scenes end" if all(line[1] != "differ" for line in moved) else
                          f"{sum(line[1] != 'differ' for line in moved)} of {len(moved)} scenes end"),
        "factors": table(["scene", "Young's modulus of the blocks", "holds", "fails", "undecided trials"], searches,
                         source("stiffness", "fos_stiffness.csv")),
    }
