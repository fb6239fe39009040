"""What the pages of accuracy, speed and scaling show."""

from page_tables import count, measurements, number, of, read, source, table

PROBLEMS = {  # name in the tables: words for a reader
    "incline": "square on a slope of 30 degrees, friction 15: path after 2 s, laid on flat",
    "incline_solved": "the same, started in the depth and tilt of steady sliding",
    "oblique_impact": "oblique elastic impact of two squares: energy afterwards",
    "toppling_block": "block that topples about a corner: angle after 0.8 s",
    "bar_compressed": "bar of 8 deformable squares, k_n L/E = 1: shortening",
    "bar_wave": "bar of 8 deformable squares, k_n L/E = 0.1: frequency",
    "wall": "wall of 78 bricks under sudden gravity: motion of its top over its height",
    "pyramid": "pyramid of 55 squares under sudden gravity: the same",
}
MODELS = {"wall": "wall of bricks", "pyramid": "pyramid of squares", "pile": "falling pile", "slope": "long slope"}


def best(rows):
    """The row with the least error, of those that do not fail."""
    return min(rows, key=lambda row: float(row["error"]))


def accuracy():
    rows = read("accuracy_defaults.csv")

    def cheapest(row):
        settings, safety = row["fewest"].rsplit("S=", 1)
        settings = settings.replace("default", "default settings").strip().replace("_", " ")
        return f"{settings}, safety {safety}"

    peers = read("peers.csv")
    compared = []
    for row in rows:
        own = of(peers, problem=row["problem"])
        if own:
            found = [best(of(own, factor=engine)) for engine in ("Box2D", "Chipmunk")]
            compared.append([PROBLEMS[row["problem"]], number(row["error"], 2), number(1e3 * float(row["cpu_s"]), 2)] +
                            [text for peer in found for text in (number(peer["error"], 2),
                                                                number(1e3 * float(peer["cpu_s"]), 2))])
    points = len(read("accuracy.csv"))
    return {
        "defaults": table(
            ["problem", "error of the defaults", "CPU, ms", "contact evaluations", "over the fewest for that error",
             "settings with the fewest"],
            [[PROBLEMS[row["problem"]], number(row["error"], 2), number(1e3 * float(row["cpu_s"]), 2), count(row["evaluations"]),
              number(row["evaluations_over_fewest"], 3), cheapest(row)] for row in rows],
            source("accuracy", "accuracy_defaults.csv")),
        "peers": table(["problem", "gcpdda, defaults", "CPU, ms", "Box2D, least error", "CPU, ms", "Chipmunk, least error",
                        "CPU, ms"], compared, source("accuracy", "peers.csv")),
        "measurements": measurements("accuracy"),
        "points": f"{points:,d}",
        "most": number(max(float(row["evaluations_over_fewest"]) for row in rows), 3),
    }


def speed():
    rows = read("speed.csv")
    steps = read("speed_steps.csv")

    def case(blocks, kind):
        return next(row for row in rows if row["blocks"] == blocks and row["kind"] == kind and row["allowed_overlap"] == "0.001"
                    and row["steps"] != "400")

    ratio = float(case("5050", "deformable")["ns_per_contact_and_step"]) / float(case("5050", "rigid")["ns_per_contact_and_step"])
    return {
        "contacts": table(
            ["squares", "kind", "allowed overlap", "steps", "contacts a block", "ns a contact and step, median (least)",
             "simulated s per CPU s", "bytes a block at the peak"],
            [[count(row["blocks"]), row["kind"], row["allowed_overlap"], count(row["steps"]),
              number(row["contacts_per_block"]), f"{number(row['ns_per_contact_and_step'], 3)} ({number(row['least'], 3)})",
              number(row["simulated_s_per_cpu_s"]), count(row["peak_memory_per_block_bytes"])] for row in rows],
            source("speed", "speed.csv")),
        "steps": table(
            ["squares", "allowed overlap", "contact damping", "largest overlap, m", "longest step over the default one",
             "drift, m", "simulated s per CPU s, median (most)", "at the default step"],
            [[count(row["blocks"]), row["allowed_overlap"], number(row["contact_damping"], 1), number(row["largest_overlap_m"]),
              number(float(row["largest_step_s"]) / float(row["default_step_s"])), number(row["drift_m"], 2),
              f"{number(row['simulated_s_per_cpu_s'])} ({number(row['most'])})", number(row["at_default_step"])]
             for row in steps], source("speed", "speed_steps.csv")),
        "deformable_ratio": number(ratio),
        "measurements": measurements("speed"),
    }


def scaling():
    counts = read("scaling.csv")
    cells = {}
    for row in counts:
        cells.setdefault((row["problem"], row["blocks"]), {})[row["ranks"]] = row
    work = [[MODELS[problem], count(blocks)] + [number(ranks[r]["work_ratio"], 4) if r in ranks else "" for r in ("2", "4", "8")]
            for (problem, blocks), ranks in cells.items() if "64" not in ranks]
    parts = next(ranks for ranks in cells.values() if "64" in ranks)
    below = source("scaling", "scaling.csv")
    times = read("scaling_times.csv")
    model = read("scaling_model.csv")
    return {
        "work": table(["model", "blocks", "2 ranks", "4 ranks", "8 ranks"], work, below),
        "parts": table(["ranks", "blocks a rank", "ghosts a rank", "bytes a rank and step", "messages a rank and step",
                        "busiest rank's work over its share"],
                       [[r, count(float(row["blocks"]) / float(r)), count(row["ghosts_per_rank"]),
                         count(row["bytes_per_rank_and_step"]), number(row["messages_per_rank_and_step"]),
                         number(row["work_ratio"], 4)] for r, row in parts.items() if r != "1"], below),
        "times": table(["model", "blocks", "contacts a block", "steps", "wall s, 1 rank", "wall s, 2 ranks", "efficiency",
                        "two half-size runs at once", "efficiency over that", "share of communication"],
                       [[MODELS[row["problem"]], count(row["blocks"]), number(row["contacts_per_block"]), count(row["steps"]),
                         number(row["wall_1_rank_s"]), number(row["wall_2_ranks_s"]), number(row["efficiency"]),
                         number(row["ceiling"]), number(row["efficiency_over_ceiling"]), number(row["communication"], 2)]
                        for row in times], source("scaling", "scaling_times.csv")),
        "rounds": times[0]["rounds"],
        "model": table(["blocks", "ranks", "ghosts a rank", "share of a rank's blocks", "bytes a rank and step",
                        "map of cells on every rank, MB"],
                       [[count(row["blocks"]), count(row["ranks"]), count(row["ghosts_per_rank"]), number(row["share_of_ghosts"], 2),
                         count(row["bytes_per_rank_and_step"]), number(float(row["map_bytes_on_every_rank"]) / 1e6, 2)]
                        for row in model if int(row["blocks"]) >= 10**8], source("scaling", "scaling_model.csv")),
        "measurements": measurements("scaling"),
    }
