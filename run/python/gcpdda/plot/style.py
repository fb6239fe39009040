"""Fonts, colours, units and figures that all pictures share."""

import matplotlib
import numpy as np

matplotlib.rcParams.setdefault("backend", "Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LinearSegmentedColormap

EDGE = "#20242a"
FIXED_FACE, FIXED_HATCH = "#d4d4d4", "#8c8c8c"
PLAIN_FACE = "#f1efea"
WATER = "#1f5fae"
OUTLINE = "#b0332a"
PARAMETERS = {"font.size": 9, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
              "axes.spines.top": False, "axes.spines.right": False, "hatch.linewidth": 0.5,
              "axes.formatter.useoffset": False}


def _part(name, low, high):
    return LinearSegmentedColormap.from_list(f"{name}_part", plt.get_cmap(name)(np.linspace(low, high, 256)))


# Zero is light and the end is not black, so that dark joints are seen on every colour.
SEQUENTIAL = _part("YlGnBu", 0.0, 0.82)
SIGNED = _part("RdBu_r", 0.1, 0.9)
BOLTS = plt.get_cmap("YlOrRd")
LINERS = plt.get_cmap("plasma_r")
JOINTS = LinearSegmentedColormap.from_list("joints", ["#b9bec4", "#e39ac0", "#c2338f", "#4d0857"])
USED = LinearSegmentedColormap.from_list("used", ["#b9c7d3", "#d9d08a", "#ee9a3a", "#d1362f", "#7a0c2e"])


def unit_prefix(unit, largest):
    """Factor and unit that keep the numbers of a colour bar short."""
    if unit in ("°", "-", "") or largest == 0.0:
        return 1.0, unit
    for factor, prefix in ((1e-9, "G"), (1e-6, "M"), (1e-3, "k"), (1.0, ""), (1e3, "m"), (1e6, "µ")):
        if prefix in "GMk" and prefix and unit.startswith("m"):
            continue  # no kilometres
        if largest * factor >= 0.999:
            return factor, prefix + unit
    return 1e9, "n" + unit


def view(frames):
    """Limits of the axes: the mobile blocks of all frames, and of the fixed ones what lies around them."""
    def box(of_fixed):
        points = np.concatenate([f.points[np.repeat(f.fixed, np.diff(f.offsets)) == of_fixed] for f in frames])
        return (points.min(axis=0), points.max(axis=0)) if len(points) else None

    mobile, fixed = box(False), box(True)
    if mobile is None and fixed is None:
        raise ValueError("there are no blocks to draw: none is left in these frames")
    low, high = mobile or fixed
    extent = (high - low).max()
    low, high = low - 0.03 * extent, high + 0.03 * extent
    if mobile and fixed:
        low = np.maximum(np.minimum(low, fixed[0] - 0.01 * extent), low - 0.12 * extent)
        high = np.minimum(np.maximum(high, fixed[1] + 0.01 * extent), high + 0.12 * extent)
    return low, high


def within(lines, window):
    """True for lines or polygons (arrays of points, or lists of them) of which a part lies in the bounding box."""
    low, high = window
    if isinstance(lines, np.ndarray):
        least, most = lines.min(axis=1), lines.max(axis=1)
    else:
        least = np.array([line.min(axis=0) for line in lines]).reshape(-1, 2)
        most = np.array([line.max(axis=0) for line in lines]).reshape(-1, 2)
    return ((most >= low) & (least <= high)).all(axis=1)


def grid_shape(number, size):
    """Rows and columns of panels: wide scenes one below the other, others side by side."""
    columns = 1 if size[0] > 1.8 * size[1] else min(number, 3)
    return -(-number // columns), columns


def most_ticks(low, high, width):
    """As many intervals of an axis as leave room for the labels, which are long in map coordinates; at most 9.

    width   of the axis in inches
    """
    decimals = 2 if high - low < 8.0 else 0
    characters = max(len(f"{end:.0f}") for end in (low, high)) + decimals
    return int(np.clip(72.0 * width / (6.0 * characters + 10.0), 2, 9))


def map_figure(number, window, layers, title=None):
    """A figure with `number` panels that show the window, room for the colour bars of the layers, and its panels."""
    low, high = window
    rows, columns = grid_shape(number, high - low)
    ratio = float(np.clip((high - low)[1] / (high - low)[0], 0.2, 2.5))
    panel = min(6.4 if columns == 1 else 4.2, 7.0 / ratio / (1 if columns == 1 else 1.3))
    panel = max(panel, 3.0)
    bars = sum(layer.bars for layer in layers)
    legend = 0.4 if any(layer.has_legend for layer in layers) else 0.0
    size = (columns * panel + 0.7 + 1.0 * bars, rows * (panel * ratio + 0.7) + (0.35 if title else 0.0) + legend)
    with plt.rc_context(PARAMETERS):
        figure, axes = plt.subplots(rows, columns, squeeze=False, figsize=size, sharex=True, sharey=True)
        figure.set_layout_engine("constrained", rect=(0, legend / size[1], 1, 1 - legend / size[1]))
        if title:
            figure.suptitle(title, fontsize=11)
        for i, panel_axes in enumerate(axes.flat):
            panel_axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]), visible=i < number)
            below = i + columns >= number
            panel_axes.tick_params(labelbottom=below)
            panel_axes.ticklabel_format(style="plain", useOffset=False)  # a factor would lie on the keys above the axes
            panel_axes.locator_params(axis="x", nbins=most_ticks(low[0], high[0], panel))
            panel_axes.set_xlabel("x (m)" if below else "")
            panel_axes.set_ylabel("y (m)" if i % columns == 0 else "")
        handles = []
        for layer in layers:
            layer.explain(figure, list(axes.flat))
            handles += layer.handles()
        if handles:
            figure.legend(handles=handles, loc="lower center", ncol=5, frameon=False, fontsize=8)
    return figure, list(axes.flat)[:number]


def colour_bar(figure, axes, scale, label, extend="neither"):
    bar = figure.colorbar(scale, ax=axes, shrink=0.85, aspect=28 * axes[0].get_gridspec().nrows, pad=0.02,
                          extend=extend)
    bar.set_label(label)
    bar.outline.set_linewidth(0.5)
    return bar
