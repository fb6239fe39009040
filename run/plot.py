#!/usr/bin/python3
"""Pictures and animations of a run: blocks filled and coloured by a field.

    run/plot.py results/wall --frame last --field displacement --out wall.png
    run/plot.py results/wall --frame 0,last --field stress --out before_after.png
    run/plot.py results/wall --frame all --field velocity --out wall.gif
    run/plot.py results/seismic_slope --field permanent --since shaking --out permanent.png
    run/plot.py results/seismic_slope --rayleigh --out damping.png

Fixed blocks are grey and hatched, phreatic lines blue and dashed. Bolts are coloured by their tension, joint by joint,
with a dot where they have yielded and dashed where they are broken. Panels and pictures of one call share axes and
colour scales.
"""

import argparse
import json
import pathlib
import sys
import tomllib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.patches import Patch

EDGE = "#20242a"
FIXED_FACE, FIXED_HATCH = "#d4d4d4", "#8c8c8c"
KINDS = {1: ("rigid", "#7fa8c9"), 2: ("deformable", "#e0a15a")}


def largest_compression(data):
    """Minus the smaller principal value of the mean Cauchy stress (tension positive)."""
    xx, yy, xy = data["stress"][:].T
    return np.hypot(0.5 * (xx - yy), xy) - 0.5 * (xx + yy)


# name: (values of a CellData group, label, unit, signed)
FIELDS = {
    "displacement": (lambda d: np.hypot(*d["displacement"][:, :2].T), "displacement", "m", False),
    "permanent": (lambda d: d["displacement"][:, :2], "displacement since the stage began", "m", False),
    "velocity": (lambda d: np.hypot(*d["velocity"][:, :2].T), "speed", "m/s", False),
    "rotation": (lambda d: np.degrees(d["rotation"][:]), "rotation, counter-clockwise", "°", True),
    "contact_force": (lambda d: np.hypot(*d["contact_force"][:, :2].T), "resultant of contact forces", "N/m", False),
    "stress": (largest_compression, "largest compressive stress", "Pa", False),
    "kind": (lambda d: d["kind"][:], "", "", False),
}


class Frame:
    def __init__(self, path, field):
        with h5py.File(path) as file:
            grid = file["VTKHDF"]
            self.time = float(grid.attrs["time"])
            self.points = grid["Points"][:, :2]
            self.offsets = grid["Offsets"][:]
            self.blocks = grid["CellData/block"][:]
            self.fixed = grid["CellData/kind"][:] == 0
            self.values = FIELDS[field][0](grid["CellData"])

    def points_of(self, blocks):
        """Points of those blocks alone: later frames may have lost some."""
        return self.points[np.repeat(np.isin(self.blocks, blocks), np.diff(self.offsets))]

    def polygons(self, of_blocks):
        return [self.points[self.offsets[b] : self.offsets[b + 1]] for b in np.flatnonzero(of_blocks)]


def chosen_frames(directory, words):
    """Paths of the frames that `0,last` or `all` name."""
    paths = sorted((directory / "frames").glob("frame_*.hdf"))
    if not paths:
        sys.exit(f"plot.py: no frames in {directory}")
    by_number = {int(path.stem.split("_")[1]): path for path in paths}
    chosen = []
    for word in words.split(","):
        if word == "all":
            chosen += paths
        elif word in ("first", "last"):
            chosen.append(paths[0 if word == "first" else -1])
        elif word.isdigit() and int(word) in by_number:
            chosen.append(by_number[int(word)])
        else:
            sys.exit(f"plot.py: no frame {word}: there are {min(by_number)} to {max(by_number)}, first, last, all")
    return chosen


def frame_before(directory, stage):
    """The last frame that is not later than the beginning of a stage."""
    summary = directory / "summary.json"
    if not summary.exists():
        sys.exit(f"plot.py: no {summary}, which tells when stages began: the run goes on, or was killed")
    stages = json.loads(summary.read_text()).get("stages", [])
    names = [entry["name"] for entry in stages]
    if stage not in names:
        sys.exit(f"plot.py: no stage {stage}: there are {', '.join(names) or 'none'}")
    number = names.index(stage)
    begin = stages[number - 1]["time"] if number > 0 else 0.0
    paths = chosen_frames(directory, "all")
    times = [h5py.File(path)["VTKHDF"].attrs["time"] for path in paths]
    return paths[max(i for i, time in enumerate(times) if time <= begin + 1e-9 * max(begin, 1.0))]


def make_permanent(frames, reference):
    """Sizes of the displacements since the reference frame, whose blocks may have gone since."""
    known = dict(zip(reference.blocks.tolist(), reference.values))
    for frame in frames:
        start = np.array([known[block] for block in frame.blocks.tolist()])
        frame.values = np.hypot(*(frame.values - start).T)


def draw_rayleigh(directory, out, dpi):
    """Damping ratio over frequency of run.rayleigh, and the shares of alpha and beta."""
    with open(directory / "scene.toml", "rb") as file:
        rayleigh = tomllib.load(file)["run"].get("rayleigh")
    if rayleigh is None:
        sys.exit(f"plot.py: {directory / 'scene.toml'} has no run.rayleigh")
    ratio, least = float(rayleigh["ratio"]), float(rayleigh["frequency"])
    f = np.geomspace(0.1 * least, 10.0 * least, 400)
    by_mass, by_stiffness = 0.5 * ratio * least / f, 0.5 * ratio * f / least
    figure, axes = plt.subplots(figsize=(5.2, 3.4), layout="constrained")
    axes.plot(f, by_mass + by_stiffness, color=EDGE, lw=1.4, label="both")
    axes.plot(f, by_mass, color="#2f7fd6", lw=1.0, ls=(0, (5, 2)), label="alpha M")
    axes.plot(f, by_stiffness, color="#b0332a", lw=1.0, ls=(0, (5, 2)), label="beta K")
    axes.plot([least], [ratio], "o", color=EDGE, ms=4)
    axes.annotate(f"{ratio:g} at {least:g} Hz", (least, ratio), xytext=(0, 8), textcoords="offset points", ha="center")
    axes.set(xscale="log", xlabel="frequency (Hz)", ylabel="damping ratio", xlim=(f[0], f[-1]), ylim=(0.0, None))
    axes.set_title(f"alpha = {2.0 * np.pi * least * ratio:.4g} 1/s, beta = {ratio / (2.0 * np.pi * least):.4g} s", fontsize=9)
    axes.legend(frameon=False)
    figure.savefig(out, dpi=dpi)


def view(frames):
    """Limits of the axes: the mobile blocks of all frames, and of the fixed ones what lies around them."""
    def box(of_fixed):
        points = [f.points[np.repeat(f.fixed, np.diff(f.offsets)) == of_fixed] for f in frames]
        points = np.concatenate(points)
        return (points.min(axis=0), points.max(axis=0)) if len(points) else None

    mobile, fixed = box(False), box(True)
    low, high = mobile or fixed
    extent = (high - low).max()
    low, high = low - 0.03 * extent, high + 0.03 * extent
    if mobile and fixed:
        low = np.maximum(np.minimum(low, fixed[0] - 0.01 * extent), low - 0.12 * extent)
        high = np.minimum(np.maximum(high, fixed[1] + 0.01 * extent), high + 0.12 * extent)
    return low, high


def unit_prefix(unit, largest):
    """Factor and unit that keep the numbers of a colour bar short."""
    if unit == "°" or largest == 0.0:
        return 1.0, unit
    for factor, prefix in ((1e-9, "G"), (1e-6, "M"), (1e-3, "k"), (1.0, ""), (1e3, "m"), (1e6, "µ")):
        if prefix in "GMk" and prefix and unit.startswith("m"):
            continue  # no kilometres
        if largest * factor >= 0.999:
            return factor, prefix + unit
    return 1e9, "n" + unit


class Colours:
    """Colour of each block, one scale for all frames."""

    def __init__(self, field, frames):
        _, self.label, unit, signed = FIELDS[field]
        self.by_kind = field == "kind"
        mobile = np.concatenate([f.values[~f.fixed] for f in frames])
        largest = float(np.abs(mobile).max()) if len(mobile) else 0.0
        self.factor, self.unit = unit_prefix(unit, largest)
        top = largest * self.factor or 1.0
        # Stress alone may change sign without being `signed`: some blocks are in tension.
        bottom = -top if signed else min(0.0, float(mobile.min(initial=0.0)) * self.factor)
        self.scale = ScalarMappable(Normalize(bottom, top), "RdBu_r" if signed else "viridis")

    def of(self, frame):
        values = frame.values[~frame.fixed]
        if self.by_kind:
            return [KINDS.get(int(kind), KINDS[1])[1] for kind in values]
        return self.scale.to_rgba(values * self.factor)

    def explain(self, figure, axes, frames):
        if not self.by_kind:
            bar = figure.colorbar(self.scale, ax=axes, shrink=0.85, aspect=28 * axes[0].get_gridspec().nrows, pad=0.02)
            bar.set_label(f"{self.label} ({self.unit})")
            bar.outline.set_linewidth(0.5)
            return
        present = set(np.unique(np.concatenate([f.values for f in frames])).tolist())
        patches = [Patch(fc=colour, ec=EDGE, lw=0.5, label=name) for k, (name, colour) in KINDS.items() if k in present]
        if 0 in present:
            patches.append(Patch(fc=FIXED_FACE, ec=FIXED_HATCH, hatch="////", lw=0.5, label="fixed"))
        figure.legend(handles=patches, loc="lower center", ncol=3, frameon=False)


def draw(axes, frame, colours, reference):
    width = float(np.clip(6.0 / np.sqrt(max(len(frame.fixed), 1)), 0.08, 0.6))
    with plt.rc_context({"hatch.linewidth": 0.5}):
        axes.add_collection(PolyCollection(frame.polygons(frame.fixed), facecolors=FIXED_FACE,
                                           edgecolors=FIXED_HATCH, hatch="////", linewidths=width))
        axes.add_collection(PolyCollection(frame.polygons(~frame.fixed), facecolors=colours.of(frame),
                                           edgecolors=EDGE, linewidths=width))
        if reference is not None:
            axes.add_collection(PolyCollection(reference.polygons(~reference.fixed), facecolors="none",
                                               edgecolors="#b0332a", linewidths=1.2 * width, linestyles=(0, (4, 3))))


def draw_water(axes, directory):
    """Phreatic lines of the scene, on or off, level beyond their ends."""
    with open(directory / "scene.toml", "rb") as file:
        tables = tomllib.load(file).get("water", {})
    left, right = axes.get_xlim()
    for table in tables.values():
        x, y = np.array(table["phreatic"], dtype=float).T
        inside = x[(x > left) & (x < right)]
        at = np.concatenate(([left], inside, [right]))
        axes.plot(at, np.interp(at, x, y), color="#2f7fd6", lw=1.2, ls=(0, (5, 2)), zorder=3)


class Bolts:
    """Lines of the bolts in place in each frame, one colour scale for all."""

    def __init__(self, paths):
        self.of_frame = [self.read(path.with_name(path.name.replace("frame_", "bolts_"))) for path in paths]
        tensions = np.concatenate([tension for _, tension, _ in self.of_frame])
        largest = float(np.abs(tensions).max(initial=0.0))
        self.present = len(tensions) > 0
        self.factor, self.unit = unit_prefix("N", largest)
        low = min(0.0, float(tensions.min(initial=0.0)) * self.factor)
        self.scale = ScalarMappable(Normalize(low, largest * self.factor or 1.0), "YlOrRd")

    @staticmethod
    def read(path):
        """Lines, their tension in N, their state."""
        if not path.exists():
            return [], np.empty(0), np.empty(0, dtype=int)
        with h5py.File(path) as file:
            grid = file["VTKHDF"]
            points, ends = grid["Points"][:, :2], grid["Offsets"][:]
            lines = [points[a:b] for a, b in zip(ends[:-1], ends[1:])]
            return lines, grid["CellData/axial_force"][:], grid["CellData/state"][:]

    def draw(self, axes, number):
        lines, tension, state = self.of_frame[number]
        if not lines:
            return
        styles = [(0, (1.2, 1.0)) if s == 2 else "-" for s in state]
        axes.add_collection(LineCollection(lines, colors=EDGE, linewidths=2.6, linestyles=styles, zorder=4))
        axes.add_collection(LineCollection(lines, colors=self.scale.to_rgba(tension * self.factor), linewidths=1.7,
                                           linestyles=styles, zorder=5))
        marks = np.array([0.5 * (line[(len(line) - 1) // 2] + line[len(line) // 2])
                          for line, s in zip(lines, state) if s > 0]).reshape(-1, 2)
        axes.scatter(*marks.T, s=9.0, c="white", edgecolors=EDGE, linewidths=0.7, zorder=6)

    def explain(self, figure, axes):
        if self.present:
            bar = figure.colorbar(self.scale, ax=axes, shrink=0.85, aspect=28 * axes[0].get_gridspec().nrows, pad=0.02)
            bar.set_label(f"tension of a bolt ({self.unit})")
            bar.outline.set_linewidth(0.5)


def grid_shape(number, size):
    """Rows and columns of panels: wide scenes one below the other, others side by side."""
    columns = 1 if size[0] > 1.8 * size[1] else min(number, 3)
    return -(-number // columns), columns


def new_figure(frames, number, colours, bolts, arguments):
    low, high = np.reshape(arguments.window, (2, 2)) if arguments.window else view(frames)
    title = arguments.title
    rows, columns = grid_shape(number, high - low)
    ratio = float(np.clip((high - low)[1] / (high - low)[0], 0.2, 2.5))
    panel = min(6.4 if columns == 1 else 4.2, 7.0 / ratio / (1 if columns == 1 else 1.3))
    panel = max(panel, 3.0)
    size = (columns * panel + 1.7 + (1.0 if bolts.present else 0.0), rows * (panel * ratio + 0.7) + (0.35 if title else 0.0) + (0.4 if colours.by_kind else 0.0))
    figure, axes = plt.subplots(rows, columns, squeeze=False, figsize=size, sharex=True, sharey=True)
    figure.set_layout_engine("constrained", rect=(0, 0.4 / size[1], 1, 1 - 0.4 / size[1]) if colours.by_kind else (0, 0, 1, 1))
    if title:
        figure.suptitle(title, fontsize=11)
    for i, panel_axes in enumerate(axes.flat):
        panel_axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]), visible=i < number)
        below = i + columns >= number
        panel_axes.tick_params(labelbottom=below)
        panel_axes.set_xlabel("x (m)" if below else "")
        panel_axes.set_ylabel("y (m)" if i % columns == 0 else "")
    colours.explain(figure, list(axes.flat), frames)
    bolts.explain(figure, list(axes.flat))
    return figure, list(axes.flat)[:number]


def save_picture(frames, colours, bolts, arguments, reference):
    figure, panels = new_figure(frames, len(frames), colours, bolts, arguments)
    for number, (axes, frame) in enumerate(zip(panels, frames)):
        draw(axes, frame, colours, reference)
        draw_water(axes, arguments.directory)
        bolts.draw(axes, number)
        axes.set_title(f"t = {frame.time:.4g} s", fontsize=9)
    figure.savefig(arguments.out, dpi=arguments.dpi, bbox_inches="tight", pad_inches=0.06)


def save_movie(frames, colours, bolts, arguments, reference):
    figure, (axes,) = new_figure(frames, 1, colours, bolts, arguments)

    def show(number):
        frame = frames[number]
        for old in list(axes.collections):
            old.remove()
        draw(axes, frame, colours, reference)
        bolts.draw(axes, number)
        axes.set_title(f"t = {frame.time:.3f} s", fontsize=9)

    movie = matplotlib.animation.FuncAnimation(figure, show, frames=len(frames), init_func=lambda: None)
    movie.save(arguments.out, writer=matplotlib.animation.PillowWriter(fps=arguments.fps), dpi=min(arguments.dpi, 110))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path, metavar="DIR", help="result folder of a run")
    parser.add_argument("--frame", default="last", help="N, first, last, all, or several: 0,last (default: last)")
    parser.add_argument("--field", choices=FIELDS, default="displacement")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="FILE.png, .pdf, .svg; FILE.gif is animated")
    parser.add_argument("--scale", type=float, default=1.0, help="draw the motion since the first frame so many times")
    parser.add_argument("--compare", choices=["first"], help="outline the blocks as they were in the first frame")
    parser.add_argument("--since", metavar="STAGE", help="stage from whose beginning --field permanent counts")
    parser.add_argument("--rayleigh", action="store_true", help="draw the damping ratio of run.rayleigh instead of blocks")
    parser.add_argument("--window", type=lambda text: [float(x) for x in text.split(",")], metavar="X0,Y0,X1,Y1",
                        help="part of the plane to draw (default: all of it)")
    parser.add_argument("--title")
    parser.add_argument("--dpi", type=float, default=160)
    parser.add_argument("--fps", type=float, default=12)
    arguments = parser.parse_args()

    plt.rcParams.update({"font.size": 9, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
                         "axes.spines.top": False, "axes.spines.right": False})
    if arguments.rayleigh:
        draw_rayleigh(arguments.directory, arguments.out, arguments.dpi)
        return
    if (arguments.field == "permanent") != (arguments.since is not None):
        parser.error("--field permanent and --since STAGE belong together")
    paths = chosen_frames(arguments.directory, arguments.frame)
    frames = [Frame(path, arguments.field) for path in paths]
    first = Frame(chosen_frames(arguments.directory, "first")[0], arguments.field)
    for frame in frames:
        start = first.points_of(frame.blocks)
        frame.points = start + arguments.scale * (frame.points - start)
    if arguments.since:
        make_permanent(frames, Frame(frame_before(arguments.directory, arguments.since), arguments.field))
    colours = Colours(arguments.field, frames)
    save = save_movie if arguments.out.suffix == ".gif" else save_picture
    save(frames, colours, Bolts(paths), arguments, first if arguments.compare else None)


if __name__ == "__main__":
    main()
