#!/usr/bin/python3
"""Turn a picture of `gcpdda blocks --svg`, `gcpdda inspect --svg`, `gcpdda fos` or `gcpdda ensemble` into PNG."""
import argparse
import re
import xml.etree.ElementTree as xml

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import hsv_to_rgb

POINTS = 0.72  # of a pixel of the SVG, which has 100 pixels to an inch


def colour(text):
    """'#rrggbb', a name, or hsl(h,s%,l%)."""
    match = re.fullmatch(r"hsl\(([\d.]+),([\d.]+)%,([\d.]+)%\)", text)
    if not match:
        return text
    hue, saturation, light = float(match[1]) / 360, float(match[2]) / 100, float(match[3]) / 100
    value = light + saturation * min(light, 1 - light)
    return tuple(hsv_to_rgb((hue, 2 * (1 - light / value) if value > 0 else 0, value)))


def main(svg, png, dpi):
    root = xml.parse(svg).getroot()
    width, height = float(root.get("width")), float(root.get("height"))
    figure = plt.figure(figsize=(width / 100, height / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    polygons, fills, strokes = [], [], []
    lines, colours, widths = [], [], []
    for element in root:
        kind = element.tag.split("}")[-1]
        if kind == "polygon":
            polygons.append([tuple(map(float, p.split(","))) for p in element.get("points").split()])
            fills.append(colour(element.get("fill")))
            strokes.append(float(element.get("stroke-width")))
        elif kind == "path":
            numbers = list(map(float, re.findall(r"[-\d.]+", element.get("d"))))
            lines.append([numbers[:2], numbers[2:]])
            colours.append(colour(element.get("stroke")))
            widths.append(POINTS * float(element.get("stroke-width")))
        elif kind == "rect" and element.get("x"):
            x, y, wide, high = (float(element.get(name)) for name in ("x", "y", "width", "height"))
            axes.add_patch(plt.Rectangle((x, y), wide, high, color=colour(element.get("fill")), lw=0))
        elif kind == "circle":
            axes.add_patch(plt.Circle((float(element.get("cx")), float(element.get("cy"))), float(element.get("r")),
                                      fill=False, color=element.get("stroke"), lw=1.5, zorder=4))
        elif kind == "text":
            axes.text(float(element.get("x")), float(element.get("y")), element.text, zorder=5,
                      fontsize=POINTS * float(element.get("font-size", root.get("font-size", 14))),
                      ha={"middle": "center", "end": "right"}.get(element.get("text-anchor"), "left"),
                      color=colour(element.get("fill", "black")))
    # Outlines of very many blocks would cover their colours: these blocks are outlined by their own colour.
    edges = ["#555555" if stroke * dpi / 100 > 0.1 else fill for fill, stroke in zip(fills, strokes)]
    axes.add_collection(PolyCollection(polygons, facecolors=fills, edgecolors=edges, linewidths=strokes))
    axes.add_collection(LineCollection(lines, colors=colours, linewidths=widths))
    figure.savefig(png, dpi=dpi)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("svg", metavar="IN.svg")
    parser.add_argument("png", metavar="OUT.png")
    parser.add_argument("--dpi", type=float, default=70)
    arguments = parser.parse_args()
    main(arguments.svg, arguments.png, arguments.dpi)
