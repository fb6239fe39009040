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
    summary, settled = search.outcome, search.settled
    # A search without trials has failed before the first one, or has been asked for the bound alone.
    has_failed = not summary["trials"] and summary["fails"] is not None
    page.verdict(*(factor_words(summary) if summary["trials"] or has_failed else bound_words(summary)))
    if has_failed and summary["settled"]["message"]:
        page.text(summary["settled"]["message"], "note")
    for slide in summary.get("earlier_slides", ()):
        page.text(slide_words(slide, "factor" if summary["trials"] or has_failed else "bound"), "note")
    if summary["trials"] and "first_block_holds" in summary:
        page.verdict(*first_block_words(summary))
    mechanism = search.mechanism
    cards = {"laws weakened": ", ".join(summary["families"]) or "all", "trials": str(len(summary["trials"])),
             "blocks that move": str(len(summary["moving"])),
             "CPU time": f"{sum(t['cpu_s'] for t in summary['trials']):.3g} s"}
    page.cards(cards)
    for stage in summary.get("left_out_stages", ()):
        page.text(f"Stage '{stage}' is left out with what it changes: it comes after the last settle stage.", "note")
    if settled.scene.get("earthquake", {}).get("record"):
        page.text("The earthquake of the scene is left out: the factor is that of blocks that were never shaken.")
    if summary["trials"]:
        _trials(page, search)
    if mechanism is not None and mechanism.frames:
        _mechanism(page, search, mechanism, frames)
    add_scene(page, settled.scene, settled)
    page.section("Settled state")
    if settled.frames:
        most, name, _ = moved_most(settled.frame("last"))
        factor = summary["settled"]["factor"]
        strength = "their full strength" if factor == 1.0 else f"strengths divided by {factor:g}"
        if has_failed:
            words = f"The blocks have not settled with {strength}, and there is no state from which trials could begin."
        else:
            words = "Trials begin from this state" if summary["trials"] else "Limit analysis is done at this state"
            words += f", in which the blocks rest with {strength}."
        page.text(f"{words} {name} has moved most, by {length(most)}.")
        page.pictures((picture(settled.plot.field("displacement")), "Displacement while settling."),
                      (picture(settled.plot.crosses()), "Principal stresses in the settled state."))
    add_provenance(page, search, settled.path / "scene.toml", facts(settled), "fos")
    return page


def factor_words(summary):
    """What the trials say about the factor of safety, and whether that is good, bad or open."""
    holds, fails = summary["holds"], summary["fails"]
    if "static_holds" in summary:
        ends = [f"{word} at {summary[key]:.5g}" for word, key in (("hold", "static_holds"), ("fail", "static_fails"))
                if summary[key] is not None]
        return (f"No factor of safety: by the static solver alone the blocks {' and '.join(ends)}, and the dynamic "
                "step confirms neither end within fos.limit. Use a longer fos.limit.", "open")
    if holds is None and fails is None:
        return "No trial came to a verdict.", "open"
    if fails is None:
        return f"The blocks still hold at {holds:.5g}; no factor tried made them fail.", "open"
    if holds is None:
        words = f"The blocks fail already at {fails:.5g}, the smallest factor tried."
        return words, "bad" if fails <= 1.0 else "open"
    bracket = f"the blocks hold when strengths are divided by {holds:.5g} and fail at {fails:.5g}"
    if summary["found"]:
        return (f"Factor of safety {summary['factor']:.4g}: {bracket}.",
                "good" if summary["factor"] >= 1.0 else "bad")
    reason = ("trials in between are undecided" if summary["undecided"]
              else "the search ended before the bracket was as narrow as fos.tolerance")
    return f"The factor of safety lies anywhere between two trials: {bracket}; {reason}.", "open"


def first_block_words(summary):
    """What the trials say about the first block that fails, where fos.ignore_area or fos.region leave some out."""
    holds, fails = summary["first_block_holds"], summary["first_block_fails"]
    if fails is None:
        return "First block: none fails at any factor tried.", "open"
    if holds is None:
        return f"First block: fails already at {fails:.5g}.", "bad" if fails <= 1.0 else "open"
    factor = 0.5 * (holds + fails)
    return (f"First block: factor {factor:.4g}, holds at {holds:.5g} and fails at {fails:.5g}.",
            "good" if factor >= 1.0 else "bad")


def slide_words(slide, result):
    """What a slide before the search means for the factor or the bound."""
    return (f"{slide['words'][0].upper()}{slide['words'][1:]}. The {result} is that of the place where the blocks came "
            "to hold, and their strength without reduction may already have failed (a factor below 1). Try a smaller "
            "failure_motion in that stage, or fos.largest_motion.")


def bound_words(summary):
    """The upper bound of limit analysis, and whether that is good, bad or open."""
    bound, resting = summary["bound"], summary["resting_bound"]
    if bound is None:
        text = ("Limit analysis gives no bound: forces balance the loads at the largest factor (fos.to), or the "
                "strengths have no part in it.")
    else:
        text = (f"Factor of safety at most {bound:.5g}, by limit analysis of rigid blocks at the settled state: with "
                "strengths divided by more no forces balance the loads.")
    if resting is not None and resting != bound:
        text += (f" Blocks that do not slide on hold at most at {resting:.5g}: beyond it joints have to close that are "
                 "open by up to a tenth of a block's size.")
    return text, "bad" if bound is not None and bound < 1.0 else "open"


def _trials(page, search):
    page.section("Trials")
    words = "Largest motion in each trial in sizes of a block, over the factor that divides the strengths."
    if has_bracket(search.summary):
        words += " The factor of safety lies in the grey band."
    page.pictures((picture(draw_trials(search)), words))
    page.table(search.trials, {"factor[-]": "factor", "verdict": "verdict", "time[s]": "time (s)", "steps": "steps",
                               "moved[-]": "largest motion (block sizes)",
                               "unbalanced_ratio[-]": "unbalanced ratio (-)", "cpu[s]": "CPU time (s)",
                               "decided_by": "decided by"})
    slides_from = search.summary.get("slides_from")
    if slides_from:
        page.text(f"At {slides_from:.5g} blocks slide to where they hold; where that is failure the factor is smaller, "
                  "and fos.largest_motion finds it.", "note")
    if search.summary["undecided"]:
        page.text("Trials without a verdict at their limit stay in the bracket; a longer fos.limit may decide them.",
                  "note")


def has_bracket(summary):
    return summary["holds"] is not None and summary["fails"] is not None


def draw_trials(search):
    trials, summary = search.trials, search.summary
    with plt.rc_context(style.PARAMETERS):
        figure, axes = plt.subplots(figsize=(7.2, 2.8), layout="constrained")
    if has_bracket(summary):
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
        blocks = "1 block moves" if len(moving) == 1 else f"{len(moving)} blocks move"
        page.text(f"{blocks} in the trial with the smallest factor that fails, {search.fails or 0:.5g}: on average in "
                  f"the direction of {round(angle)} degrees from the x axis, counter-clockwise, with a turn of "
                  f"{turn:.2g} degrees.")
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
               {"block": "block", "x": "displacement in x (m)", "y": "displacement in y (m)",
                "rotation": "rotation (°)", "motion": "motion (m)"})
    page.text("The blocks that have moved farthest.", "note")
