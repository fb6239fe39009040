"""The numbers of README.md, from the committed tables."""

import statistics

from page_tables import count, number, of, read, table
from page_blocks import flutter, soak
from page_checks import holds


def check(rows, problem):
    return next(row for row in rows if row["problem"] == problem)


def bracket(scene):
    row = of(read("fos_stiffness.csv"), scene=scene, youngs_modulus="rigid")[0]
    return f"{float(row['holds']):.4f} to {float(row['fails']):.4f}"


def to_rest():
    """Evaluations of the static solver, kinetic and local damping until the slope rests to 1e-5."""
    rows = of(read("statics_cost.csv"), scene="slope_jointed", ratio="1e-05")
    ways = ("static", "kinetic damping", "local damping")
    return ", ".join(count(of(rows, way=way)[0]["evaluations"]) for way in ways)


def same_forces(increments):
    """Largest difference of the largest normal forces of random rock masses: median and most, in %."""
    rows = of(read("statics_random.csv"), way="static", parts=increments)
    off = [100.0 * float(row["normal_off"]) for row in rows]
    return f"{number(statistics.median(off), 2)} %, {number(max(off), 2)} %"


def numbers():
    checks, cost, times = (read(f"{name}.csv") for name in ("verification", "speed", "scaling_times"))
    slope, error, _ = soak()
    states = flutter()
    rigid = next(r for r in cost if (r["blocks"], r["kind"], r["steps"], r["allowed_overlap"]) == ("5050", "rigid", "2000", "0.001"))
    deformable = next(r for r in cost if r["kind"] == "deformable")
    largest = cost[-1]
    efficiency = [float(row["efficiency"]) for row in times if float(row["contacts_per_block"]) > 1.0]
    lines = [
        ["problems with a known answer: checks within their tolerance", f"{sum(map(holds, checks))} of {len(checks)}", "verify"],
        ["block sliding on a slope of 30 degrees, friction 15: error of its acceleration",
         number(check(checks, "B3 (ii) th=30 phi=15, flat start: acceleration over 1..2 s")["error"], 2), "verify"],
        ["block resting on a slope of 20 degrees, friction 21: motion in 100 s over its size",
         number(check(checks, "B4 th=20 phi=21 at x=0 m: motion from 60 to 160 s")["got"], 2), "verify"],
        ["energy drift of 100 bouncing polygons in 10^6 block-steps, relative", f"{slope:.0e} ± {error:.0e}", "stability"],
        [f"sheared states of deformable blocks on sticking joints that grow, of {states['flutter_states']}",
         f"{states['flutter_grip']} ({states['flutter_centre']} with friction at the centre of pressure)", "flutter"],
        ["factor of safety, plane failure (limit equilibrium 1.9534)", bracket("plane_failure"), "stiffness"],
        ["factor of safety, toppling slope of Goodman and Bray (limit equilibrium 1.0682)", bracket("goodman_bray"), "stiffness"],
        ["evaluations until a slope of 1,992 blocks rests to 1e-5: static solver, kinetic damping, local damping",
         to_rest(), "statics"],
        ["largest normal forces of 30 rock masses, static solver with 50 increments against slow loading: median, most",
         same_forces("50"), "statics"],
        ["the same with 200 increments", same_forces("200"), "statics"],
        ["CPU time of a touching contact and step, 5,050 squares at rest: rigid, deformable",
         f"{number(rigid['ns_per_contact_and_step'], 2)} ns, {number(deformable['ns_per_contact_and_step'], 3)} ns", "speed"],
        [f"the same among {count(largest['blocks'])} squares, and memory of a block",
         f"{number(largest['ns_per_contact_and_step'], 2)} ns, {number(largest['peak_memory_per_block_bytes'], 3)} bytes", "speed"],
        ["parallel efficiency on 2 ranks, 5,000 to 100,000 touching blocks",
         f"{min(efficiency):.2f} to {max(efficiency):.2f}", "scaling"],
    ]
    return table(["number", "value", "made by"], [[a, b, f"`run/study.sh {c}`"] for a, b, c in lines])
