"""The report of a run."""

import datetime
import re

import numpy as np

from ..plot import png
from ..plot.over_time import energy_parts
from ..plot.style import view
from .page import Page, text_of
from .scene_tables import add_provenance, add_scene

DPI = 100
PLAYER_BYTES = 4_000_000  # of images, a third less than their text
KINDS = {"completed": "good", "settled": "good", "failed": "bad", "undecided": "open", "stopped": "open"}
MANY_BLOCKS = 20_000  # joints of more blocks than this are not drawn: they would be finer than a pixel


def picture(figure):
    """PNG of a figure, which is closed."""
    import matplotlib.pyplot as plt
    image = png(figure, DPI)
    plt.close(figure)
    return image


def run_page(result, title, frames):
    page = Page(title)
    _head(page, result)
    if result.frames and len(result.frame("first").ids):
        _motion(page, result, frames)
    _warnings(page, result)
    add_scene(page, result.scene, result)
    _stages(page, result)
    if result.frames:
        _end(page, result)
    _histories(page, result)
    _energy(page, result)
    _bolts(page, result)
    _liners(page, result)
    _speed(page, result)
    add_provenance(page, result, result.path / "scene.toml", facts(result))
    return page


def facts(result):
    summary = result.summary or {}
    path = result.path / ("summary.json" if summary else "scene.toml")
    ended = datetime.datetime.fromtimestamp(path.stat().st_mtime).astimezone().isoformat(timespec="seconds")
    unknown = "not recorded" if summary else "the run goes on"
    return {"version of the program": summary.get("version", unknown), "command": summary.get("command", unknown),
            "ranks": summary.get("ranks", "the run goes on"), "last written": ended}


def moved_most(frame):
    """Largest displacement of a mobile block in m, its name, and where it is."""
    mobile = frame.blocks[frame.blocks["kind"] != "fixed"]
    row = mobile.loc[mobile["displacement"].idxmax()]
    return float(row["displacement"]), row["name"], row


def length(value):
    """A length with a unit that keeps it short."""
    for factor, unit in ((1.0, "m"), (1e3, "mm"), (1e6, "µm")):
        if abs(value) * factor >= 0.995 or unit == "µm":
            return f"{value * factor:.3g} {unit}"
    return f"{value:.3g} m"


def _head(page, result):
    summary = result.summary
    if summary is None:
        page.verdict(f"The run goes on, or was killed: t = {result.reached:g} s so far.", "open")
    else:
        message = summary["message"] or summary["verdict"]
        page.verdict(f"{summary['verdict'].capitalize()}: {message}.", KINDS.get(summary["verdict"], "bad"))
    cards = {}
    if result.frames:
        frame = result.frame("last")
        cards["blocks"] = f"{len(frame.ids):,}"
        if (~frame.fixed).any():
            most, name, _ = moved_most(frame)
            cards[f"largest displacement, of {name}"] = length(most)
    if summary:
        cards |= {"simulated": f"{summary['time']:.4g} s", "steps": f"{summary['steps']:,}",
                  "largest overlap": length(summary["max_overlap"]), "wall time": f"{summary['total_wall_s']:.3g} s"}
    page.cards(cards)


def _motion(page, result, frames):
    page.section("Motion")
    stills = limited(result, frames)
    if stills:
        page.player(stills, f"Displacement of blocks in {len(stills)} of {len(result.frames)} frames. One scale for "
                            "all of them.")
    page.pictures((picture(result.plot.before_after("displacement")), "Displacement in the first and the last frame."))


def limited(result, most):
    """Stills for the player, fewer of them where they are large; none where no block is left, since all that it shows
    may be empty."""
    if most == 0 or len(result.frames) < 2 or not len(result.frame("last").ids):
        return []
    size = max(len(image) for _, image in result.plot.stills(most=2, dpi=80))
    return list(result.plot.stills(most=max(2, min(most, PLAYER_BYTES // size)), dpi=80))


def _warnings(page, result):
    page.section("Warnings")
    lines = [line for line in result.log.splitlines() if re.search(r"\b(warning|info|error):", line)]
    share = residual_share(result)
    if share is not None and share > 0.01:
        lines.insert(0, f"report: the energy residual is {100 * share:.2g} % of the energy turned over, see Energy")
    if result.summary and result.summary["verdict"] == "undecided":
        lines.insert(0, "report: a stage reached its limit undecided; a longer limit may decide it")
    if lines:
        page.bullets(lines)
    else:
        page.text("The program printed none.")


def _stages(page, result):
    stages = result.stages
    if not len(stages):
        return
    page.section("Stages")
    settings = {stage.get("name", f"stage{k}"): stage for k, stage in enumerate(result.scene.get("stage", []))}
    rows = [row | {"changes": words_on_changes(settings.get(row["name"], {}))} for row in stages.to_dict("records")]
    page.table(rows, {"name": "stage", "kind": "kind", "changes": "changes at its beginning",
                      "verdict": "verdict", "begin": "begin (s)", "end": "end (s)", "steps": "steps",
                      "unbalanced_ratio": "unbalanced ratio (-)",
                      "moved": "largest motion (block sizes)", "removed": "blocks removed"})
    page.text("The unbalanced ratio is the largest net force over the largest force in the model; the motion is that "
              "within the stage. Settled: blocks have come to rest. Failed: a block moves on. Undecided: neither, when "
              "the stage ended.", "note")
    # A trial of a search has no frames of the stages before.
    begin = result.frame("first").time if result.frames else np.inf
    shown = [row for row in stages.to_dict("records")
             if row["steps"] > 0 and row["end"] > row["begin"] and row["end"] >= begin]
    for row in shown[:12]:
        page.heading(f"Stage {row['name']}: {row['verdict']}")
        if settings.get(row["name"], {}).get("set"):
            page.keys(settings[row["name"]]["set"])
        number = result.at_end_of(row["name"]).number
        if not len(result.frame(number).ids):
            page.text("No block is left.")
            continue
        pictures = [(picture(result.plot.field("permanent", since=row["name"], frame=number)),
                     f"Displacement since stage {row['name']} began, at its end.")]
        if draws_joints(result):
            pictures.append((picture(result.plot.joints("state", frame=number)), "Joints at the end of the stage."))
        page.pictures(*pictures)
    if len(shown) > 12:
        page.text(f"The pictures of {len(shown) - 12} further stages are left out.", "note")


def words_on_changes(stage):
    """What a table [[stage]] excavates and sets, and over how long."""
    words = [f"excavates {key} {', '.join(stage[key])}" for key in ("openings", "blocks") if stage.get(key)]
    if stage.get("region"):
        words.append("excavates the blocks in region " + " ".join(f"({x:.10g}, {y:.10g})" for x, y in stage["region"]))
    words += [f"{key} = {stage[key]:g} s" for key in ("relax", "ramp") if stage.get(key)]
    words += [f"{path} = {text_of(value)}" for path, value in stage.get("set", {}).items()]
    return "; ".join(words)


def draws_joints(result):
    return result.frame("last").has_contacts and len(result.frame("first").ids) <= MANY_BLOCKS


def close_up(result):
    """The part of the plane whose blocks have moved most, None where that is most of the model."""
    frame = result.frame("last")
    mobile = np.flatnonzero(~frame.fixed)
    moved = np.hypot(*frame.values("displacement")[mobile, :2].T)
    if not len(mobile) or moved.max() == 0.0:
        return None
    at = frame.centroids[mobile[moved > 0.2 * moved.max()]]
    low, high = view([frame])
    size = np.maximum(1.6 * (at.max(axis=0) - at.min(axis=0)), 0.3 * (high - low).max())
    middle = 0.5 * (at.max(axis=0) + at.min(axis=0))
    part_low, part_high = np.maximum(middle - 0.5 * size, low), np.minimum(middle + 0.5 * size, high)
    return [*part_low, *part_high] if np.prod(part_high - part_low) < 0.4 * np.prod(high - low) else None


def _end(page, result):
    page.section("State at the end")
    if not len(result.frame("last").ids):
        page.text("No block is left.")
        return
    plots, part = result.plot, {"window": close_up(result)}
    if part["window"]:
        page.text("The pictures show the part of the model that has moved most.", "note")
    page.pictures((picture(plots.field("stress", **part)),
                   "Largest compressive stress, the mean of each block. Negative where a block is in tension."),
                  (picture(plots.crosses(**part)),
                   "Principal stresses: crosses are as long as the stresses, tension is red."))
    if not result.frame("last").has_contacts:
        page.text("The scene has output.contacts = false: joints and contact forces are not drawn.", "note")
        return
    if draws_joints(result):
        page.pictures((picture(plots.joints("state", **part)), "State of the joints of the first frame."),
                      (picture(plots.joints("shear_displacement", **part)),
                       "Shear displacement of joints since the first frame."))
    page.pictures((picture(plots.strength(**part)), "Strength that contacts use: 1 where they slip."),
                  (picture(plots.chains(**part)), "Force chains: normal forces of contacts from block to block."))
    if result.scene.get("water"):
        page.pictures((picture(plots.water()), "Water pressure on the edges of blocks."))
    arrows = [(picture(plots.vectors("displacement", **part)), "Displacement of blocks since the start.")]
    if np.abs(result.frame("last").values("velocity")).max() > 0.0:
        arrows.append((picture(plots.vectors("velocity", **part)), "Velocity of blocks."))
    page.pictures(*arrows)


def _histories(page, result):
    profiles = [name for name in result.profiles if len(result.history(name))]
    names = [name for name in result.histories if len(result.history(name))]
    if profiles:
        page.section("Profiles")
        page.pictures(*((picture(result.plot.profile(name)), f"Displacement along {name}.") for name in profiles))
    if not names:
        return
    page.section("Histories")
    page.pictures((picture(result.plot.history("displacement")),
                   "Displacement of monitored blocks and points; stages are marked."))
    columns = [column for name in names for column in result.history(name).columns]
    page.pictures((picture(result.plot.history("speed")), "Their speed."))
    if "sxx[Pa]" in columns:
        page.pictures((picture(result.plot.history("fy")), "Vertical contact force on monitored blocks."))
    rows = []
    for name in names:
        table = result.history(name)
        last = {"monitor": name, "rows": len(table)} | {column: float(table[column].iloc[-1])
                                                        for column in table.columns}
        rows.append(last)
    page.table(rows)
    page.text("The last row of each history.", "note")


def residual_share(result):
    """The residual over the energy that was turned over: losses, work, and the largest change of what is stored."""
    table = result.energy
    if not len(table):
        return None
    parts = energy_parts(table)
    turned_over = max(float(np.abs(values).max()) for name, values in parts.items() if name != "residual")
    return float(np.abs(parts["residual"]).max()) / turned_over if turned_over > 0.0 else 0.0


MEANINGS = {
    "kinetic": "energy of motion", "strain": "elastic energy in deformable blocks",
    "contact": "elastic energy in contacts, normal and shear",
    "gravity": "potential energy: falls when blocks sink", "support": "elastic energy in bolts and liners",
    "friction_loss": "work that slipping joints have taken",
    "damping_loss": "work that dashpots and numerical damping have taken",
    "support_loss": "work that yielding bolts and liners, cracks and rupture have taken",
    "taken": "what stages took with the blocks that they removed and the motion that they stopped",
    "boundary_work": "work of loads, driven blocks and excavated ones on the model",
    "residual": "what is stored, lost and taken less the work from outside: zero if time steps were infinitely short"}


def _energy(page, result):
    table = result.energy
    if len(table) < 2:
        return
    page.section("Energy")
    page.pictures((picture(result.plot.energy()),
                   "Above: changes of energy since the start. Below: how far the model is from rest."))
    parts = energy_parts(table)
    rows = [{"part": name.replace("_", " "), "change": float(values.iloc[-1]), "meaning": MEANINGS[name]}
            for name, values in parts.items()]
    page.table(rows,
               {"part": "part", "change": "change since the start (J/m)", "meaning": "meaning"})
    share = residual_share(result)
    if share < 0.01:
        words = "That is small: time steps and contacts account for the energy."
    elif share < 0.05:
        words = "That is noticeable: check that the answer stays the same with run.safety half as large."
    else:
        words = ("That is large: impacts or steps are not resolved, and speeds and run-out cannot be trusted. Halve "
                 "run.safety and compare.")
    page.text(f"The largest residual is {100 * share:.2g} % of the energy turned over. {words}")


def _bolts(page, result):
    bolts = (result.summary or {}).get("bolts", [])
    if not bolts:
        return
    page.section("Bolts")
    if len(result.bolts):
        page.pictures((picture(result.plot.bolts()),
                       "Tension of each bolt, where it crosses the joint that pulls most."))
    page.table(bolts, {"name": "bolt", "support": "type", "installed": "installed (s)", "in_place": "in place",
                       "axial": "tension (N)", "largest_axial": "largest tension (N)", "shear": "shear (N)",
                       "largest_shear": "largest shear (N)",
                       "extension": "extension (m)", "joints": "joints", "yielded": "yielded", "broken": "broken"})


def _liners(page, result):
    liners = (result.summary or {}).get("liners", [])
    if not liners:
        return
    page.section("Liners")
    if len(result.liners):
        page.pictures((picture(result.plot.liners()),
                       "Largest thrust and moment of each liner, and the share of its strength that is used."))
    page.table(liners, {"name": "liner", "support": "type", "installed": "installed (s)", "in_place": "in place",
                        "elements": "elements", "compression": "thrust (N/m)",
                        "largest_compression": "largest thrust (N/m)", "largest_moment": "largest moment (N)",
                        "largest_shear": "largest shear (N/m)", "strength_used": "strength used", "cracked": "cracked",
                        "yielded": "yielded", "broken": "broken"})


def _speed(page, result):
    summary = result.summary
    if not summary:
        return
    page.section("Speed")
    contacts = summary["contact_steps"] / max(summary["steps"], 1)
    cost = 1e9 * summary["cpu_s"] / max(summary["contact_steps"], 1)
    page.table([{"what": name, "value": value} for name, value in {
        "ranks": str(summary["ranks"]), "steps": f"{summary['steps']:,}",
        "last time step": f"{summary['time_step']:.4g} s",
        "touching pairs, mean over steps": f"{contacts:,.0f}", "step loop": f"{summary['wall_s']:.4g} s wall time",
        "CPU time of the step loop": f"{summary['cpu_s']:.4g} s over all ranks",
        "CPU time of a touching pair and step": f"{cost:.3g} ns", "set-up": f"{summary['setup_wall_s']:.3g} s",
        "output": f"{summary['output_wall_s']:.3g} s", "all": f"{summary['total_wall_s']:.4g} s",
        "imbalance of ranks (1 is best)": f"{summary['imbalance']:.3f}"}.items()])
    phases = [{"phase": name, "mean": times["mean"], "max": times["max"]} for name, times in summary["phases"].items()]
    page.table(phases, {"phase": "phase of a step", "mean": "mean over ranks (s)", "max": "slowest rank (s)"})
