"""What a picture of blocks consists of: layers that are drawn over each other, each with a scale that all its panels
share.

A layer has prepare(shown, window), which sees all frames before the first is drawn; draw(axes, shown); explain(figure,
axes), which adds its colour bar; handles(), its entries of the legend; and says by `bars` and `has_legend` how much
room it needs. `shown` is a `Shown`: a frame and where its blocks are drawn.
"""

import functools

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..joints import affine_maps, strength_used
from . import style

KINDS = {1: ("rigid", "#7fa8c9"), 2: ("deformable", "#e0a15a")}


def largest_compression(frame):
    """Minus the smaller principal value of the mean Cauchy stress (tension positive)."""
    xx, yy, xy = frame.values("stress").T
    return np.hypot(0.5 * (xx - yy), xy) - 0.5 * (xx + yy)


def _size(name):
    return lambda frame: np.hypot(*frame.values(name)[:, :2].T)


# name: (values of a frame, label, unit, signed)
FIELDS = {
    "displacement": (_size("displacement"), "displacement", "m", False),
    "permanent": (None, "displacement since the stage began", "m", False),
    "velocity": (_size("velocity"), "speed", "m/s", False),
    "rotation": (lambda frame: np.degrees(frame.values("rotation")), "rotation, counter-clockwise", "°", True),
    "contact_force": (_size("contact_force"), "resultant of contact forces", "N/m", False),
    "stress": (largest_compression, "largest compressive stress", "Pa", False),
    "kind": (None, "", "", False),
    "none": (None, "", "", False),
}


class Shown:
    """A frame and where its blocks are drawn: where they are, or with their motion since the first frame magnified."""

    def __init__(self, frame, scale=1.0):
        self.frame, self.scale = frame, scale
        self.fixed, self.offsets, self.ids, self.time = frame.fixed, frame.offsets, frame.ids, frame.time
        self.points = frame.points
        if scale != 1.0:
            first = frame.result.start
            of_left = np.repeat(np.isin(first.ids, frame.ids), np.diff(first.offsets))
            start = first.points[of_left]
            self.points = start + scale * (frame.points - start)

    @functools.cached_property
    def polygons(self):
        return np.split(self.points, self.offsets[1:-1])[:len(self.ids)]  # none where no block is left

    @functools.cached_property
    def centroids(self):
        from ..frame import polygon_facts
        return polygon_facts(self.points, self.offsets)[1]

    def of(self, chosen):
        return [self.polygons[k] for k in np.flatnonzero(chosen)]

    def visible(self, window):
        """Mobile blocks that lie in the window, all mobile ones if there are none."""
        inside = ~self.fixed & style.within(self.polygons, window)
        return inside if inside.any() else ~self.fixed

    def moved(self, lines, block_ids):
        """Lines on those blocks where the blocks are drawn."""
        if self.scale == 1.0 or not len(lines):
            return lines
        _, matrices, old, new = affine_maps(self.frame, self)
        row = np.searchsorted(self.ids, block_ids)
        return new[row, None] + np.einsum("nij,nkj->nki", matrices[row], lines - old[row, None])


class Layer:
    bars = 0
    has_legend = False

    def prepare(self, shown, window):
        pass

    def explain(self, figure, axes):
        pass

    def handles(self):
        return []


class Blocks(Layer):
    """Blocks filled by a field, fixed ones grey and hatched. `reference` is a Shown whose mobile blocks are
    outlined."""

    def __init__(self, field="displacement", since=None, reference=None):
        if field not in FIELDS:
            raise ValueError(f"no field {field}: there are {', '.join(FIELDS)}")
        self.field, self.since, self.reference = field, since, reference
        self.coloured = field not in ("kind", "none")
        self.bars, self.has_legend = int(self.coloured), field == "kind"

    def values(self, frame):
        if self.field == "permanent":
            return np.hypot(*(frame.values("displacement")[:, :2] - start_of(self.since, frame)).T)
        return FIELDS[self.field][0](frame)

    def prepare(self, shown, window):
        self.present = set(np.concatenate([s.frame.values("kind") for s in shown]).tolist())
        if not self.coloured:
            return
        _, self.label, unit, signed = FIELDS[self.field]
        seen = np.concatenate([self.values(s.frame)[s.visible(window)] for s in shown])
        largest = float(np.abs(seen).max(initial=0.0))
        self.factor, self.unit = style.unit_prefix(unit, largest)
        top = largest * self.factor or 1.0
        # Stress alone may change sign without being `signed`: some blocks are in tension.
        bottom = -top if signed else min(0.0, float(seen.min(initial=0.0)) * self.factor)
        everything = np.concatenate([self.values(s.frame)[~s.fixed] for s in shown]) * self.factor
        over, under = everything.max(initial=top) > 1.001 * top, everything.min(initial=bottom) < bottom - 1e-3 * top
        self.extend = {(0, 0): "neither", (1, 0): "max", (0, 1): "min", (1, 1): "both"}[int(over), int(under)]
        self.scale = ScalarMappable(Normalize(bottom, top), style.SIGNED if signed else style.SEQUENTIAL)

    def colours(self, shown):
        if self.field == "none":
            return style.PLAIN_FACE
        if self.field == "kind":
            return [KINDS.get(int(kind), KINDS[1])[1] for kind in shown.frame.values("kind")[~shown.fixed]]
        return self.scale.to_rgba(self.values(shown.frame)[~shown.fixed] * self.factor)

    def draw(self, axes, shown, window):
        in_view = max(int(style.within(shown.polygons, window).sum()), 1)
        width = float(np.clip(6.0 / np.sqrt(in_view), 0.06, 0.6))
        axes.add_collection(PolyCollection(shown.of(shown.fixed), facecolors=style.FIXED_FACE,
                                           edgecolors=style.FIXED_HATCH, hatch="////", linewidths=width))
        axes.add_collection(PolyCollection(shown.of(~shown.fixed), facecolors=self.colours(shown),
                                           edgecolors=style.EDGE, linewidths=width))
        if self.reference is not None:
            axes.add_collection(PolyCollection(self.reference.of(~self.reference.fixed), facecolors="none",
                                               edgecolors=style.OUTLINE, linewidths=max(1.2 * width, 0.3),
                                               linestyles=(0, (4, 3))))

    def explain(self, figure, axes):
        if self.coloured:
            style.colour_bar(figure, axes, self.scale, f"{self.label} ({self.unit})", self.extend)

    def handles(self):
        if self.field != "kind":
            return []
        patches = [Patch(fc=colour, ec=style.EDGE, lw=0.5, label=name) for k, (name, colour) in KINDS.items()
                   if k in self.present]
        if 0 in self.present:
            patches.append(Patch(fc=style.FIXED_FACE, ec=style.FIXED_HATCH, hatch="////", lw=0.5, label="fixed"))
        return patches


def start_of(reference, frame):
    """Displacements in a reference frame of the blocks of a frame; those of the frame itself of blocks that are gone in
    the reference: they have none since then."""
    known = dict(zip(frame.ids.tolist(), frame.values("displacement")[:, :2]))
    known |= dict(zip(reference.ids.tolist(), reference.values("displacement")[:, :2]))
    return np.array([known[block] for block in frame.ids.tolist()]).reshape(-1, 2)


class Coloured(Layer):
    """Lines with a colour bar. A subclass says what lines() there are and what their values() mean."""

    bars = 1
    signed = False
    colours = style.JOINTS
    width = 1.6
    label, unit = "", ""
    largest = None  # end of the scale, if it does not follow from the values

    def prepare(self, shown, window):
        seen = []
        for one in shown:
            lines, values = self.lines(one)
            if len(lines):
                values = values[style.within(lines, window)]
                seen.append(values[np.isfinite(values)])
        seen = np.concatenate(seen) if seen else np.empty(0)
        largest = self.largest or float(np.abs(seen).max(initial=0.0))
        self.factor, self.shown_unit = style.unit_prefix(self.unit, largest)
        top = largest * self.factor or 1.0
        bottom = -top if self.signed and seen.min(initial=0.0) < 0.0 else 0.0
        self.scale = ScalarMappable(Normalize(bottom, top), style.SIGNED if bottom < 0.0 else self.colours)

    def draw(self, axes, shown, window):
        lines, values = self.lines(shown)
        if not len(lines):
            return
        inside = style.within(lines, window)
        lines, values = lines[inside], values[inside]
        order = np.argsort(np.abs(values), kind="stable")  # the largest on top
        top = self.scale.norm.vmax
        share = np.clip(np.abs(values[order]) * self.factor / top, 0.0, 1.0)
        widths = line_width(self.width, len(lines)) * (0.35 + 0.65 * share)
        axes.add_collection(LineCollection(lines[order], colors=self.scale.to_rgba(values[order] * self.factor),
                                           linewidths=widths, zorder=4, capstyle="round"))

    def explain(self, figure, axes):
        unit = f" ({self.shown_unit})" if self.shown_unit not in ("", "-") else " (-)"
        style.colour_bar(figure, axes, self.scale, self.label + unit, "max" if self.largest else "neither")


def line_width(width, count):
    """Thinner where there are many lines."""
    return width * float(np.clip(2.2 - 0.4 * np.log10(max(count, 1)), 0.5, 1.8))


class JointLines(Coloured):
    """Joints coloured by what has happened at them since the first frame, or by the forces that they carry."""

    QUANTITIES = {  # label, unit, signed, from contacts
        "shear_displacement": ("shear displacement of joints", "m", False, False),
        "opening": ("opening of joints", "m", False, False),
        "slip": ("accumulated slip of contacts", "m", False, True),
        "normal_force": ("normal force of contacts, compression positive", "N/m", True, True),
        "shear_force": ("shear force of contacts", "N/m", False, True),
        "overlap": ("overlap of contacts", "m", False, True),
        "strength_used": ("strength used, T/(N tan φ + c l)", "-", False, True),
    }

    def __init__(self, quantity):
        self.quantity = quantity
        self.label, self.unit, self.signed, self.from_contacts = self.QUANTITIES[quantity]
        if quantity == "strength_used":
            self.largest, self.colours = 1.0, style.USED

    def lines(self, shown):
        frame = shown.frame
        if self.from_contacts:
            values = (strength_used(frame) if self.quantity == "strength_used"
                      else frame.contacts[self.quantity].to_numpy())
            values = np.abs(values) if self.quantity == "shear_force" else values
            return shown.moved(frame.contact_lines, frame.contacts["block_a"].to_numpy()), values
        table = frame.joints
        values = table[self.quantity].to_numpy()
        values = np.maximum(values, 0.0) if self.quantity == "opening" else np.abs(values)
        return joint_lines(shown), np.tile(values, 2)


def joint_lines(shown):
    """Lines of joints on the edges of their first blocks, then on those of their second blocks."""
    frame = shown.frame
    sides = [shown.moved(frame.joint_lines[:, side], frame.joints[name].to_numpy())
             for side, name in enumerate(("block_a", "block_b"))]
    return np.concatenate(sides)


class JointStates(Layer):
    """Joints coloured by their state."""

    has_legend = True
    COLOURS = {"unloaded": "#c3c8cd", "stick": "#7d8894", "slip": "#e08214", "open": "#2b7bba", "bond": "#3a9a4b",
               "broken": "#c2185b"}

    def prepare(self, shown, window):
        seen = set()
        for one in shown:
            lines = joint_lines(one)
            one.frame.expect_contacts()
            if len(lines):
                seen |= set(np.tile(one.frame.joints["state"].to_numpy(), 2)[style.within(lines, window)])
        self.present = [state for state in self.COLOURS if state in seen]

    def draw(self, axes, shown, window):
        table = shown.frame.joints
        lines = joint_lines(shown)
        inside = style.within(lines, window) if len(lines) else np.empty(0, dtype=bool)
        states = np.tile(table["state"].to_numpy(), 2)
        width = line_width(1.5, int(inside.sum()))
        for state in self.present:
            chosen = inside & (states == state)
            quiet = state in ("unloaded", "stick")
            axes.add_collection(LineCollection(lines[chosen], colors=self.COLOURS[state],
                                               linewidths=width * (0.6 if quiet else 1.2),
                                               zorder=4 if quiet else 5, capstyle="round"))

    def handles(self):
        return [Line2D([], [], color=self.COLOURS[state], lw=2.0, label=state) for state in self.present]


class Chains(Coloured):
    """Force chains: a line from centroid to centroid through every contact, as wide as its normal force."""

    label, unit, width = "normal force of contacts", "N/m", 2.6

    def lines(self, shown):
        frame, table = shown.frame, shown.frame.contacts
        if not len(table):
            return np.empty((0, 3, 2)), np.empty(0)
        middle = shown.moved(frame.contact_lines, table["block_a"].to_numpy()).mean(axis=1)
        ends = []
        for column in ("block_a", "block_b"):
            rows = np.searchsorted(shown.ids, table[column].to_numpy())
            fixed = shown.fixed[rows][:, None]  # the centroid of the ground is far away
            ends.append(np.where(fixed, middle, shown.centroids[rows]))
        return np.stack([ends[0], middle, ends[1]], axis=1), np.maximum(table["normal_force"].to_numpy(), 0.0)

    def draw(self, axes, shown, window):
        lines, values = self.lines(shown)
        if not len(lines):
            return
        inside = style.within(lines, window)
        lines, values = lines[inside], values[inside]
        share = np.clip(values * self.factor / self.scale.norm.vmax, 0.0, 1.0)
        order = np.argsort(share, kind="stable")
        axes.add_collection(LineCollection(lines[order], colors=self.scale.to_rgba(values[order] * self.factor),
                                           linewidths=(line_width(self.width, len(lines))
                                                       * np.maximum(share[order], 0.03)),
                                           zorder=4, capstyle="round"))


class Arrows(Layer):
    """Arrows with a key: displacement, velocity or permanent displacement of blocks, or forces at contacts."""

    QUANTITIES = {"displacement": ("displacement", "m"), "velocity": ("velocity", "m/s"),
                  "permanent": ("displacement since the stage began", "m"),
                  "force": ("contact force on the upper block", "N/m")}
    COLOUR = "#8c1d18"

    def __init__(self, quantity, since=None, most=600):
        self.quantity, self.since, self.most = quantity, since, most
        self.label, self.unit = self.QUANTITIES[quantity]

    def vectors(self, shown, window):
        """Where arrows begin and what they are, thinned to the largest in each cell of a grid if there are too many."""
        frame = shown.frame
        if self.quantity == "force":
            at = shown.moved(frame.contact_lines, frame.contacts["block_a"].to_numpy()).mean(axis=1)
            values = frame.contact_forces
            rows = [np.searchsorted(shown.ids, frame.contacts[name].to_numpy()) for name in ("block_a", "block_b")]
            height = [np.where(shown.fixed[row], -np.inf, shown.centroids[row, 1]) for row in rows]
            values = np.where((height[0] >= height[1])[:, None], values, -values)
        else:
            mobile = ~shown.fixed
            values = frame.values("velocity" if self.quantity == "velocity" else "displacement")[:, :2]
            if self.quantity == "permanent":
                values = values - start_of(self.since, frame)
            at, values = shown.centroids[mobile], values[mobile]
        inside = ((at >= window[0]) & (at <= window[1])).all(axis=1)
        return thinned(at[inside], values[inside], window, self.most)

    def prepare(self, shown, window):
        sizes = [np.hypot(*self.vectors(one, window)[1].T).max(initial=0.0) for one in shown]
        self.largest = float(max(sizes))
        self.factor, self.shown_unit = style.unit_prefix(self.unit, self.largest)

    def draw(self, axes, shown, window):
        at, values = self.vectors(shown, window)
        if self.largest == 0.0:
            axes.text(0.0, 1.03, "all are zero", fontsize=8, transform=axes.transAxes)
            return
        extent = float((window[1] - window[0]).max())
        per_metre = self.largest / (0.09 * extent)  # the largest arrow
        size = np.hypot(*values.T)
        keep = size > 1e-3 * self.largest
        arrows = axes.quiver(*at[keep].T, *values[keep].T, angles="xy", scale_units="xy", scale=per_metre,
                             color=self.COLOUR, width=0.0026, headwidth=4.0, headlength=5.0, headaxislength=4.5,
                             minlength=0.4, zorder=6)
        size = nice(0.7 * self.largest * self.factor)
        share = size / self.factor / per_metre / (window[1] - window[0])[0]  # the tip; the arrow begins at 0
        axes.quiverkey(arrows, share, 1.03, size / self.factor, f"{size:g} {self.shown_unit}", labelpos="E",
                       coordinates="axes", fontproperties={"size": 8})

    def handles(self):
        return [Line2D([], [], color=self.COLOUR, lw=1.5, marker=">", ms=4, label=self.label)]

    has_legend = True


def nice(value):
    """The largest of 1, 2, 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-9)))


def thinned(at, values, window, most):
    """The largest vector in each cell of a grid of about `most` cells."""
    if len(at) <= most:
        return at, values
    cell = np.sqrt(np.prod(window[1] - window[0]) / most)
    cells = np.floor((at - window[0]) / cell).astype(int)
    order = np.argsort(-np.hypot(*values.T), kind="stable")
    _, first = np.unique(cells[order], axis=0, return_index=True)
    return at[order][first], values[order][first]


class Crosses(Layer):
    """Principal stresses as crosses: lines along the two directions, as long as the stresses, tension red. Where there
    are many blocks a cross is the mean over the blocks of a cell, weighted by area."""

    has_legend = True
    COMPRESSION, TENSION = "#173f70", "#d01c1c"

    def __init__(self, most=400, key_on_right=False):
        self.most, self.key_on_right = most, key_on_right

    def principal(self, shown, window):
        """Places, principal stresses (n, 2) and unit directions (n, 2, 2: stress, component)."""
        chosen = shown.visible(window)
        at, stress, areas = shown.centroids[chosen], shown.frame.values("stress")[chosen], shown.frame.areas[chosen]
        inside = ((at >= window[0]) & (at <= window[1])).all(axis=1)
        at, stress, areas = at[inside], stress[inside], areas[inside]
        if len(at) > self.most:
            cell = np.sqrt(np.prod(window[1] - window[0]) / self.most)
            _, which = np.unique(np.floor((at - window[0]) / cell).astype(int), axis=0, return_inverse=True)
            weight = np.bincount(which, areas)
            at, stress = (np.stack([np.bincount(which, areas * column) / weight for column in table.T], axis=1)
                          for table in (at, stress))
        tensor = stress[:, [0, 2, 2, 1]].reshape(-1, 2, 2)
        values, vectors = np.linalg.eigh(tensor)
        return at, values, np.swapaxes(vectors, 1, 2)

    def prepare(self, shown, window):
        found = [self.principal(one, window) for one in shown]
        sizes = np.concatenate([np.abs(values).max(axis=1) for _, values, _ in found])
        self.largest = float(np.quantile(sizes, 0.9)) if len(sizes) else 0.0  # a few are longer
        self.largest = self.largest or float(sizes.max(initial=0.0)) or 1.0
        count = max(len(at) for at, _, _ in found)
        self.length = 0.9 * np.sqrt(np.prod(window[1] - window[0]) / max(count, 16))
        self.has_tension = any((values > 0.02 * self.largest).any() for _, values, _ in found)
        self.factor, self.unit = style.unit_prefix("Pa", self.largest)

    def draw(self, axes, shown, window):
        at, values, directions = self.principal(shown, window)
        half = 0.5 * self.length * values[..., None] / self.largest * directions
        lines = np.stack([at[:, None] - half, at[:, None] + half], axis=2).reshape(-1, 2, 2)
        tension = values.ravel() > 0.0
        for chosen, colour in ((~tension, self.COMPRESSION), (tension, self.TENSION)):
            axes.add_collection(LineCollection(lines[chosen], colors=colour, linewidths=0.9, zorder=5))
        # The scale, above the axes.
        size = nice(self.largest * self.factor)
        share = self.length * size / self.factor / self.largest / (window[1] - window[0])[0]
        begin = 1.0 - share if self.key_on_right else 0.0
        beside = begin - 0.01 if self.key_on_right else share + 0.01
        axes.plot([begin, begin + share], [1.035, 1.035], color=self.COMPRESSION, lw=1.2, transform=axes.transAxes,
                  clip_on=False)
        axes.text(beside, 1.035, f"{size:g} {self.unit}", fontsize=8, va="center", transform=axes.transAxes,
                  ha="right" if self.key_on_right else "left")

    def handles(self):
        entries = [Line2D([], [], color=self.COMPRESSION, lw=1.2, label="compression")]
        return entries + ([Line2D([], [], color=self.TENSION, lw=1.2, label="tension")] if self.has_tension else [])


class Bolts(Layer):
    """Bolts in place in each frame, coloured by their tension, with a dot where they have yielded, dashed where
    broken."""

    def __init__(self, frames):
        self.bars = int(any(len(frame.bolt_lines) for frame in frames))

    def prepare(self, shown, window):
        tensions = np.concatenate([one.frame.bolts["axial_force"].to_numpy() if self.bars else np.empty(0)
                                   for one in shown])
        largest = float(np.abs(tensions).max(initial=0.0))
        self.factor, self.unit = style.unit_prefix("N", largest)
        low = min(0.0, float(tensions.min(initial=0.0)) * self.factor)
        self.scale = ScalarMappable(Normalize(low, largest * self.factor or 1.0), style.BOLTS)

    def draw(self, axes, shown, window):
        lines = shown.frame.bolt_lines
        if not lines:
            return
        table = shown.frame.bolts
        tension, state = table["axial_force"].to_numpy(), table["state"]
        styles = [(0, (1.2, 1.0)) if s == "broken" else "-" for s in state]
        axes.add_collection(LineCollection(lines, colors=style.EDGE, linewidths=2.6, linestyles=styles, zorder=7))
        axes.add_collection(LineCollection(lines, colors=self.scale.to_rgba(tension * self.factor), linewidths=1.7,
                                           linestyles=styles, zorder=8))
        marks = np.array([0.5 * (line[(len(line) - 1) // 2] + line[len(line) // 2])
                          for line, s in zip(lines, state) if s != "elastic"]).reshape(-1, 2)
        axes.scatter(*marks.T, s=9.0, c="white", edgecolors=style.EDGE, linewidths=0.7, zorder=9)

    def explain(self, figure, axes):
        if self.bars:
            style.colour_bar(figure, axes, self.scale, f"tension of a bolt ({self.unit})")


# name: (label, unit, signed, values of a table of elements)
LINERS = {
    "thrust": ("thrust of liners, compression positive", "N/m", True, lambda t: -t["axial_force"]),
    "moment": ("largest moment of an element", "N m/m", False,
               lambda t: np.maximum(t["moment_begin"].abs(), t["moment_end"].abs())),
    "shear": ("shear force of liners", "N/m", False, lambda t: t["shear_force"].abs()),
    "strength_used": ("strength of liners used", "-", False, lambda t: t["strength_used"]),
}


class Liners(Layer):
    """Elements of liners in their true thickness, or as thick as can be seen, on the side of the void; a white dot
    where one has cracked, a cross where one is broken. `moments` draws the bending moment across the face."""

    least_width = 1.0 / 150.0  # of the size of the window
    longest_moment = 0.08      # of the same

    def __init__(self, frames, quantity="thrust", moments=False):
        self.quantity, self.moments = quantity, moments
        self.bars = int(any(len(frame.liner_lines) for frame in frames))
        self.has_legend = bool(self.bars)
        self.label, self.unit, self.signed, self.values_of = LINERS[quantity]

    def prepare(self, shown, window):
        self.size = float(np.ptp(np.asarray(window), axis=0).max())
        tables = [one.frame.liners for one in shown] if self.bars else []
        values = np.concatenate([self.values_of(table).to_numpy() for table in tables] or [np.empty(0)])
        largest = 1.0 if self.quantity == "strength_used" else float(np.abs(values).max(initial=0.0))
        self.factor, self.shown_unit = style.unit_prefix(self.unit, largest)
        top = largest * self.factor or 1.0
        bottom = min(0.0, float(values.min(initial=0.0)) * self.factor)
        colours = style.USED if self.quantity == "strength_used" else style.LINERS
        self.scale = ScalarMappable(Normalize(bottom, top), colours)
        self.states = {state for table in tables for state, rows in (
            ("cracked", table["cracked"] & (table["state"] != "broken")), ("broken", table["state"] == "broken"))
            if rows.any()}
        self.largest_moment = max((float(table[["moment_begin", "moment_end"]].abs().max().max())
                                   for table in tables if len(table)), default=0.0)

    def draw(self, axes, shown, window):
        lines, table = shown.frame.liner_lines, shown.frame.liners
        if not len(lines):
            return
        way = lines[:, 1] - lines[:, 0]
        across = np.stack([-way[:, 1], way[:, 0]], axis=1)  # into the void
        across /= np.maximum(np.hypot(*across.T), 1e-300)[:, None]
        width = np.maximum(table["thickness"].to_numpy(), self.least_width * self.size)[:, None]
        begin, end = lines[:, 0], lines[:, 1]
        corners = np.stack([begin, end, end + width * across, begin + width * across], axis=1)
        whole = (table["state"] != "broken").to_numpy()
        colours = self.scale.to_rgba(self.values_of(table).to_numpy() * self.factor)
        axes.add_collection(PolyCollection(corners[whole], facecolors=colours[whole], edgecolors=style.EDGE,
                                           linewidths=0.5, zorder=6))
        axes.add_collection(PolyCollection(corners[~whole], facecolors="white", edgecolors=style.EDGE, linewidths=0.5,
                                           linestyles=(0, (2, 2)), zorder=6))
        if self.moments and self.largest_moment > 0.0:
            self._draw_moments(axes, lines, across, table)
        middle = corners.mean(axis=1)
        cracked = table["cracked"].to_numpy() & whole
        axes.scatter(*middle[cracked].T, s=9.0, c="white", edgecolors=style.EDGE, linewidths=0.7, zorder=9)
        axes.scatter(*middle[~whole].T, s=16.0, c=style.OUTLINE, marker="x", linewidths=1.1, zorder=9)

    def _draw_moments(self, axes, lines, across, table):
        reach = self.longest_moment * self.size / self.largest_moment
        ends = [lines[:, k] - reach * table[name].to_numpy()[:, None] * across  # tension on the rock: into the rock
                for k, name in enumerate(("moment_begin", "moment_end"))]
        shapes = np.stack([lines[:, 0], ends[0], ends[1], lines[:, 1]], axis=1)
        axes.add_collection(PolyCollection(shapes, facecolors=(0.13, 0.45, 0.73, 0.35), edgecolors="#1f5fae",
                                           linewidths=0.6, zorder=7))

    def explain(self, figure, axes):
        if self.bars:
            unit = f" ({self.shown_unit})"
            style.colour_bar(figure, axes, self.scale, self.label + unit)

    def handles(self):
        marks = []
        if "cracked" in self.states:
            marks.append(Line2D([], [], ls="", marker="o", ms=4, mfc="white", mec=style.EDGE, label="liner cracked"))
        if "broken" in self.states:
            marks.append(Line2D([], [], ls="", marker="x", ms=5, mec=style.OUTLINE, label="liner broken"))
        if self.moments and self.largest_moment > 0.0:
            factor, unit = style.unit_prefix("N m/m", self.largest_moment)
            label = f"moment on the side in tension, largest {self.largest_moment * factor:.3g} {unit}"
            marks.append(Patch(fc=(0.13, 0.45, 0.73, 0.35), ec="#1f5fae", lw=0.6, label=label))
        return marks
