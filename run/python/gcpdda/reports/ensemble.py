"""The report of an ensemble."""

import matplotlib.pyplot as plt
import numpy as np

from ..plot import style
from ..result import read_scene
from .page import Page
from .run import picture
from .scene_tables import add_provenance, add_scene

COLOURS = {"holds": "#2e7d4f", "fails": "#b0332a"}
MOST_ROWS = 300


def ensemble_page(ensemble, title):
    page = Page(title)
    summary, members = ensemble.outcome, ensemble.members
    probability = summary["probability_of_failure"]
    if probability is None:
        page.verdict("No member has a verdict yet.", "open")
    else:
        trials = summary["holds"] + summary["fails"] + summary["undecided"]  # members that cannot run are none
        page.verdict(f"Probability of failure {probability:.3g}: {summary['fails']} of {trials} members fail; with "
                     f"{100 * summary['confidence']:.0f} % confidence it lies between {summary['low']:.3g} and "
                     f"{summary['high']:.3g}.",
                     "open" if summary["undecided"] else "good" if summary["fails"] == 0 else "bad")
    page.cards({"members": f"{summary['done']} of {summary['count']}", "hold": str(summary["holds"]),
                "fail": str(summary["fails"]), "undecided": str(summary["undecided"]),
                "cannot run": str(summary["cannot_run"])})
    if summary.get("holds_after_slide"):
        page.text(f"{summary['holds_after_slide']} members held only after blocks slid while they settled: the "
                  "strength may have failed where they were. Column message names the blocks; a smaller "
                  "failure_motion of that stage takes such slides for failure.", "note")
    page.section("Members")
    if summary["measure"] == "factor" and summary["factors"]:
        page.pictures((picture(draw_factors(members)),
                       f"Factors of safety of the {len(factors_of(members))} members with a trial that holds and one "
                       "that fails."))
        page.table([{name: summary[name] for name in ("mean", "deviation", "skewness", "least", "most")}])
    page.pictures(*((picture(draw_values(members, key)), f"Values of {key} that members drew, by outcome.")
                    for key in summary["keys"]))
    if len(summary["keys"]) >= 2:
        page.pictures((picture(draw_pair(members, *summary["keys"][:2])),
                       "Members over the first two values that vary."))
    page.text("The interval is that of Clopper and Pearson; undecided members widen it to both sides.", "note")
    page.table(members.head(MOST_ROWS))
    if len(members) > MOST_ROWS:
        page.text(f"The first {MOST_ROWS} of {len(members)} members; ensemble_members.csv has all.", "note")
    scene_file = ensemble.path / "ensemble.toml"
    scene = read_scene(scene_file, ["run", "material", "joint", "ensemble"])
    page.section("What varies")
    vary = scene["ensemble"].get("vary", [])
    page.table(vary)
    if scene["ensemble"].get("correlation"):
        page.heading("Correlations")
        page.table(scene["ensemble"]["correlation"])
    add_scene(page, scene)
    add_provenance(page, ensemble, scene_file, {"members done": summary["done"]}, "ensemble")
    return page


def _axes():
    with plt.rc_context(style.PARAMETERS):
        figure, axes = plt.subplots(figsize=(6.0, 3.0), layout="constrained")
    return figure, axes


def _legend(axes):
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=8)


def draw_values(members, key):
    """Histogram of a value, the outcomes above each other."""
    figure, axes = _axes()
    groups = [(outcome, rows[key].dropna()) for outcome, rows in members.groupby("outcome")]
    edges = np.histogram_bin_edges(members[key].dropna(), bins=min(20, max(5, len(members) // 5)))
    axes.hist([values for _, values in groups], edges, stacked=True,
              color=[COLOURS.get(outcome, "#a66a00") for outcome, _ in groups],
              label=[outcome for outcome, _ in groups], edgecolor="white", linewidth=0.5)
    axes.set(xlabel=key, ylabel="members")
    _legend(axes)
    return figure


def draw_pair(members, x, y):
    figure, axes = _axes()
    for outcome, rows in members.groupby("outcome"):
        axes.plot(rows[x], rows[y], "o" if outcome == "holds" else "X", ms=5, color=COLOURS.get(outcome, "#a66a00"),
                  label=outcome)
    axes.set(xlabel=x, ylabel=y)
    _legend(axes)
    return figure


def factors_of(members):
    """The middles of the brackets of the members that have one."""
    return members[["holds", "fails"]].dropna().mean(axis=1)


def draw_factors(members):
    """Histogram of factors of safety; failure is below 1."""
    figure, axes = _axes()
    factors = factors_of(members)
    axes.hist(factors, bins=min(24, max(6, len(factors) // 4)), color="#7fa8c9", edgecolor="white", linewidth=0.5)
    axes.axvline(1.0, color="#b0332a", lw=1.2)
    axes.set(xlabel="factor of safety (-)", ylabel="members")
    return figure
