"""Phreatic lines, and the pressure of water on the edges of blocks."""

import numpy as np
from matplotlib.colors import LinearSegmentedColormap

from . import style
from .layers import Coloured, Layer

PRESSURE = LinearSegmentedColormap.from_list("pressure", ["#b9dcf2", "#2f7fd6", "#0b2a63"])


def waters(result, at):
    """The water tables of a scene as they are at a frame or a time in s, with what stages have set: {name: keys}."""
    return result.table_at("water", at)


class Water(Layer):
    """Phreatic lines, level beyond their ends: dashed where there is water in the frame, faint where not."""

    def draw(self, axes, shown, window):
        left, right = window[0][0], window[1][0]
        for table in waters(shown.frame.result, shown.frame).values():
            x, y = np.array(table["phreatic"], dtype=float).T
            at = np.concatenate(([left], x[(x > left) & (x < right)], [right]))
            active = table.get("active", True)
            axes.plot(at, np.interp(at, x, y), color="white", lw=2.4, alpha=0.7 if active else 0.3, zorder=3)
            axes.plot(at, np.interp(at, x, y), color=style.WATER, lw=1.3 if active else 0.7, ls=(0, (5, 2)),
                      alpha=1.0 if active else 0.5, zorder=3.1)


class Pressure(Coloured):
    """Edges of blocks below the phreatic lines of active water, coloured by its pressure. Water that wets some joint
    laws only is drawn on contacts with these laws."""

    label, unit, width, colours = "water pressure", "Pa", 1.8, PRESSURE

    def lines(self, shown):
        frame = shown.frame
        gravity = float(np.hypot(*frame.result.table_at("run", frame).get("gravity", [0.0, -9.81])))
        following = np.arange(1, len(shown.points) + 1)
        following[shown.offsets[1:] - 1] = shown.offsets[:-1]
        mobile = ~np.repeat(frame.fixed, np.diff(shown.offsets))
        edges = np.stack([shown.points, shown.points[following]], axis=1)[mobile]
        lines, values = [np.empty((0, 2, 2))], [np.empty(0)]
        for table in waters(frame.result, frame).values():
            if not table.get("active", True):
                continue
            wetted = edges
            if "joints" in table and frame.has_contacts:
                chosen = frame.contacts["joint"].isin(table["joints"]).to_numpy()
                wetted = shown.moved(frame.contact_lines, frame.contacts["block_a"].to_numpy())[chosen]
            x, y = np.array(table["phreatic"], dtype=float).T
            middle = wetted.mean(axis=1)
            depth = np.interp(middle[:, 0], x, y) - middle[:, 1]
            lines.append(wetted[depth > 0.0])
            values.append(table.get("density", 1000.0) * gravity * depth[depth > 0.0])
        return np.concatenate(lines), np.concatenate(values)
