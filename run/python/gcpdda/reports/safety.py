"""The report of a search for the factor of safety."""

import matplotlib.pyplot as plt
import numpy as np

from ..plot import style
from .page import Page
from .run import draws_joints, facts, length, limited, moved_most, picture
from .scene_tables import add_provenance, add_scene

COLOURS = {"settled": "#2e7d4f", "failed": "#b0332a"}


def safety_page(search, title, frames):
    page = Page(title)
    summary = search.summary
    if summary["found"]:
        page.verdict(f"Factor of safety {summary['factor']:.4g}: the blocks hold when strengths are divided by "
                     f"{summary['holds']:.5g} and fail at {summary['fails']:.5g}.",
                     "good" if summary["factor"] >= 1.0 else "bad")
    else:
        page.verdict("The factor of safety has not been found: no bracket between a trial that holds and one that "
                     "fails.", "open")
    mechanism = search.mechanism
    cards = {"laws weakened": ", ".join(summary["families"]) or "all", "trials": str(len(summary["trials"])),
             "blocks that move": str(len(summary["moving"])),
             "CPU time": f"{sum(t['cpu_s'] for t in summary['trials']):.3g} s"}
    page.cards(cards)
    _trials(page, search)
    if mechanism is not None and mechanism.frames:
        _mechanism(page, search, mechanism, frames)
    settled = search.settled
    add_scene(page, settled.scene, settled)
    page.section("Settled state")
    if settled.frames:
        most, name, _ = moved_most(settled.frame("last"))
        page.text("Trials begin from this state, in which the blocks rest with their full strength. "
                  f"{name} has moved most, by {length(most)}.")
        page.pictures((picture(settled.plot.field("displacement")), "Displacement while settling."),
                      (picture(settled.plot.crosses()), "Principal stresses before strengths are lowered."))
    add_provenance(page, search, settled.path / "scene.toml", facts(settled), "fos")
    return page


def _trials(page, search):
    page.section("Trials")
    page.pictures((picture(draw_trials(search)),
                   "Largest motion in each trial in sizes of a block, over the factor that divides the "
                   "strengths. The factor of safety lies in the grey band."))
    page.table(search.trials, {"factor[-]": "factor", "verdict": "verdict", "time[s]": "time (s)", "steps": "steps",
                               "moved[-]": "largest motion (block sizes)",
                               "unbalanced_ratio[-]": "unbalanced ratio (-)", "cpu[s]": "CPU time (s)"})
    slides_from = search.summary.get("slides_from")
    if slides_from:
        page.text(f"At {slides_from:.5g} blocks slide to where they hold; fos.largest_motion says from where on that is "
                  "failure.", "note")
    if search.summary["undecided"]:
        page.text("Trials without a verdict at their limit stay in the bracket; a longer fos.limit may decide them.",
                  "note")


def draw_trials(search):
    trials, summary = search.trials, search.summary
    with plt.rc_context(style.PARAMETERS):
        figure, axes = plt.subplots(figsize=(7.2, 2.8), layout="constrained")
    if summary["found"]:
        axes.axvspan(summary["holds"], summary["fails"], color="#d9dde2", lw=0)
    for verdict, rows in trials.groupby("verdict"):
        axes.semilogy(rows["factor[-]"], np.maximum(rows["moved[-]"], 1e-12), "o", ms=6,
                      color=COLOURS.get(verdict, "#a66a00"), label=verdict)
    axes.set(xlabel="factor that divides the strengths (-)", ylabel="largest motion (block sizes)")
    axes.grid(axis="y", color="#e8e8e8", lw=0.5)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=8)
    return figure


def _mechanism(page, search, mechanism, frames):
    summary = search.summary
    page.section("Mechanism")
    moving = summary["moving"]
    if moving:
        x, y = np.mean([entry["x"] for entry in moving]), np.mean([entry["y"] for entry in moving])
        turn = np.degrees(np.mean([abs(entry["rotation"]) for entry in moving]))
        angle = np.degrees(np.arctan2(y, x))
        page.text(f"{len(moving)} blocks move in the trial with the smallest factor that fails, "
                  f"{search.fails or 0:.5g}: on average in the direction of {angle:.0f} degrees from the x axis, "
                  f"counter-clockwise, and they turn by {turn:.2g} degrees.")
    stills = limited(mechanism, frames)
    if stills:
        page.player(stills, "Displacement of blocks in that trial.")
    page.pictures((picture(mechanism.plot.map("displacement", arrows="displacement")),
                   "Blocks that move, and where to."))
    if draws_joints(mechanism):
        page.pictures((picture(mechanism.plot.joints("state")), "Joints in that trial."))
    if mechanism.frame("last").has_contacts:
        page.pictures((picture(mechanism.plot.strength()),
                       "Strength that contacts use, with strengths divided by the factor."))
    farthest = sorted(moving, key=lambda entry: -entry["motion"])[:15]
    page.table([entry | {"rotation": float(np.degrees(entry["rotation"]))} for entry in farthest],
               {"block": "block", "x": "x (m)", "y": "y (m)", "rotation": "rotation (°)", "motion": "motion (m)"})
    page.text("The blocks that have moved farthest.", "note")
