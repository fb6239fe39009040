"""Pictures of a result folder: `result.plot.field("stress", out="stress.png")`.

Every picture has axes in metres or seconds, units and a scale. Panels and pictures of one call share axes and scales,
and the scales fit the window that is shown. Without `out` a picture is returned as a matplotlib figure, which a
notebook shows.
"""

import io
import pathlib

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np

from . import over_time, style
from .layers import (FIELDS, LINERS, Arrows, Blocks, Bolts, Chains, Crosses, JointLines, JointStates, Layer, Liners,
                     Shown)
from .water import Pressure, Water

__all__ = ["Plots", "FIELDS", "JOINTS", "ARROWS", "HISTORIES", "Layer"]

JOINTS = ("state", *JointLines.QUANTITIES)
ARROWS = tuple(Arrows.QUANTITIES)
HISTORIES = tuple(over_time.HISTORIES)
LONGEST = 8.0  # s, an animation if nothing else is asked for
MOST_FRAMES = 120


class Plots:
    """The pictures of one result. All maps of blocks take these keywords:

    frame       a number, "first", "last", "all", or a list of them: one panel each (default: last)
    window      (x0, y0, x1, y1) in m: part of the plane to draw
    scale       draws the motion since the first frame so many times; of trials of a search since the settled state
    compare     "first" outlines the blocks as they were then
    since       the stage from whose beginning permanent displacement counts
    title, dpi, out     a heading; resolution; file: .png, .pdf, .svg, or .gif, which is animated
    """

    def __init__(self, result):
        self.result = result

    def field(self, field="displacement", **options):
        """Blocks filled by a field: displacement, permanent, velocity, rotation, stress (the largest compressive one),
        contact_force, kind, or none."""
        return self.map(field, **options)

    def joints(self, quantity="state", **options):
        """Joints as coloured lines: state, shear_displacement, opening, slip, normal_force, shear_force, overlap or
        strength_used."""
        return self.map(joints=quantity, **options)

    def strength(self, **options):
        """How much of their strength contacts use: T/(N tan phi + c l), 1 where they slip."""
        return self.map(joints="strength_used", **options)

    def forces(self, **options):
        """Forces at contacts as arrows."""
        return self.map(arrows="force", **options)

    def chains(self, **options):
        """Force chains: lines from block to block, as wide as the normal force between them."""
        return self.map(chains=True, **options)

    def crosses(self, **options):
        """Principal stresses as crosses, tension red."""
        return self.map(crosses=True, **options)

    def vectors(self, quantity="displacement", **options):
        """Arrows of the displacement, permanent displacement or velocity of blocks."""
        return self.map(arrows=quantity, **options)

    def water(self, **options):
        """Water pressure on the edges of blocks."""
        return self.map(pressure=True, **options)

    def before_after(self, field="displacement", before="first", after="last", **options):
        """Two frames side by side."""
        return self.map(field, frame=[before, after], **options)

    def animate(self, out, field="displacement", seconds=None, fps=None, **options):
        """A .gif of all frames that lasts at most `seconds` (8), or has `fps` frames a second."""
        return self.map(field, frame="all", out=out, seconds=seconds, fps=fps, **options)

    def stills(self, field="displacement", most=40, dpi=90, window=None):
        """Times and PNG images of at most so many frames, all of one size and with one scale: what a player shows."""
        every = -(-len(self.result.frames) // most)
        frames = self.result.frames[::-every][::-1]
        layers = [Blocks(field), Water(), Liners(frames), Bolts(frames)]
        shown, layers, limits = self._prepared(frames, layers, 1.0, window)
        figure, (axes,) = style.map_figure(1, limits, layers)
        for one in shown:
            _clear(axes)
            _draw(axes, one, layers, limits, f"t = {one.time:.4g} s")
            yield one.time, png(figure, dpi, tight=False)
        plt.close(figure)

    def map(self, field=None, *, joints=None, arrows=None, chains=False, crosses=False, pressure=False, frame="last",
            window=None, scale=1.0, compare=None, since=None, title=None, dpi=160, out=None, seconds=None, fps=None,
            liners="thrust", moments=False):
        """Any of these over each other. Blocks are filled by `field`, or left plain where something else is drawn.
        Liners, if there are any, are coloured by thrust, moment, shear or strength_used; `moments` draws their
        moments across them, on the side that is in tension."""
        plain = joints or arrows or chains or crosses or pressure
        frames = self._frames(frame)
        if ("permanent" in (field, arrows)) != (since is not None):
            raise ValueError("'permanent' as field or arrows and the argument 'since' belong together: give "
                             "since=NAME, the stage from whose beginning the displacement counts, or neither")
        start = self.result.before(since) if since else None
        layers = [Blocks(field or ("none" if plain else "displacement"), start,
                         Shown(self.result.start) if compare else None), Water()]
        layers += [Pressure()] if pressure else []
        if joints:
            layers.append(JointStates() if joints == "state" else JointLines(_known(joints, JOINTS, "joints")))
        layers += [Chains()] if chains else []
        layers += [Crosses(key_on_right=bool(arrows))] if crosses else []  # the key of the arrows is on the left
        layers += [Arrows(_known(arrows, ARROWS, "arrows"), start)] if arrows else []
        layers += [Liners(frames, _known(liners, LINERS, "liners by"), moments), Bolts(frames)]
        shown, layers, limits = self._prepared(frames, layers, scale, window)
        if out is not None and pathlib.Path(out).suffix == ".gif":
            return _animate(shown, layers, limits, out, title, dpi, seconds, fps)
        figure, panels = style.map_figure(len(shown), limits, layers, title)
        for axes, one in zip(panels, shown):
            _draw(axes, one, layers, limits, f"t = {one.time:.4g} s")
        return _finished(figure, out, dpi)

    @staticmethod
    def _prepared(frames, layers, scale, window):
        shown = [Shown(one, scale) for one in frames]
        limits = tuple(np.reshape(np.array(window, dtype=float), (2, 2))) if window is not None else style.view(shown)
        for layer in layers:
            layer.prepare(shown, limits)
        return shown, layers, limits

    def history(self, quantity="displacement", names=None, *, dpi=160, out=None):
        """A quantity of monitored blocks and points over time, all of them or some `names`."""
        return _finished(over_time.draw_history(self.result, _known(quantity, HISTORIES, "history"), names), out, dpi)

    def profile(self, name=None, quantity="displacement", times=None, *, dpi=160, out=None):
        """A quantity along a monitored line, at some `times` in s or at five of its rows, the last among them."""
        quantity = _known(quantity, over_time.PROFILES, "profile of")
        return _finished(over_time.draw_profile(self.result, name, quantity, times), out, dpi)

    def energy(self, *, dpi=160, out=None):
        """Where the energy is and where it went, and how far the model is from rest, over time."""
        return _finished(over_time.draw_energy(self.result), out, dpi)

    def bolts(self, *, dpi=160, out=None):
        """Tension of bolts over time."""
        return _finished(over_time.draw_bolts(self.result), out, dpi)

    def liners(self, *, dpi=160, out=None):
        """Largest thrust, moment and share of the strength used of liners over time."""
        return _finished(over_time.draw_liners(self.result), out, dpi)

    def rayleigh(self, *, dpi=160, out=None):
        """Damping ratio over frequency of run.rayleigh as it is at the end of the run."""
        return _finished(over_time.draw_rayleigh(self.result), out, dpi)

    def _frames(self, which):
        chosen = []
        for one in which if isinstance(which, (list, tuple)) else [which]:
            chosen += self.result.frames if one == "all" else [self.result.frame(one)]
        if not chosen:
            raise FileNotFoundError(f"no frames in {self.result.path}")
        return chosen


def _known(name, names, what):
    if name not in names:
        raise ValueError(f"no {what} {name}: there are {', '.join(names)}")
    return name


def _clear(axes):
    for old in [*axes.collections, *axes.lines, *axes.texts, *axes.artists]:
        old.remove()


def _draw(axes, shown, layers, window, title):
    with plt.rc_context(style.PARAMETERS):
        for layer in layers:
            layer.draw(axes, shown, window)
    axes.set(xlim=(window[0][0], window[1][0]), ylim=(window[0][1], window[1][1]))
    axes.set_title(title, fontsize=9)


def _finished(figure, out, dpi):
    if out is None:
        return figure
    out = pathlib.Path(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".png":
        out.write_bytes(png(figure, dpi))
    else:
        figure.savefig(out, dpi=dpi, bbox_inches="tight", pad_inches=0.06)
    plt.close(figure)
    return None


def png(figure, dpi, tight=True):
    """A figure as PNG with 256 colours, which has a third of the bytes and looks the same."""
    from PIL import Image
    true_colours, few_colours = io.BytesIO(), io.BytesIO()
    margins = {"bbox_inches": "tight", "pad_inches": 0.06} if tight else {}
    figure.savefig(true_colours, format="png", dpi=dpi, **margins)
    few = Image.open(true_colours).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=2,
                                                           dither=Image.Dither.NONE)
    few.save(few_colours, "PNG", optimize=True)
    return few_colours.getvalue()


def _animate(shown, layers, window, out, title, dpi, seconds, fps):
    every = 1 if fps else -(-len(shown) // MOST_FRAMES)
    shown = shown[::-every][::-1]  # the last frame is always there
    fps = fps or float(np.clip(len(shown) / (seconds or LONGEST), 2.0, 25.0))
    figure, (axes,) = style.map_figure(1, window, layers, title)

    def show(number):
        _clear(axes)
        _draw(axes, shown[number], layers, window, f"t = {shown[number].time:.3f} s")

    movie = matplotlib.animation.FuncAnimation(figure, show, frames=len(shown), init_func=lambda: None)
    pathlib.Path(out).parent.mkdir(parents=True, exist_ok=True)
    movie.save(out, writer=matplotlib.animation.PillowWriter(fps=fps), dpi=min(dpi, 110))
    plt.close(figure)
