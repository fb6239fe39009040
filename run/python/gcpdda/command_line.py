"""What run/plot.py and `python3 -m gcpdda plot` understand."""

import argparse
import pathlib
import sys

from .result import Result

PLOT = """Pictures and animations of a run: blocks coloured by a field, joints, forces, stresses, arrows, curves.

    run/plot.py results/wall --frame last --field displacement --out wall.png
    run/plot.py results/wall --frame 0,last --field stress --out before_after.png
    run/plot.py results/wall --frame all --field velocity --out wall.gif
    run/plot.py results/wall --joints state --out joints.png
    run/plot.py results/wall --crosses --arrows displacement --out stress.png
    run/plot.py results/seismic_slope --field permanent --since shaking --out permanent.png
    run/plot.py results/seismic_slope --history displacement --out history.png
    run/plot.py results/seismic_slope --rayleigh --out damping.png

Fixed blocks are grey and hatched, phreatic lines blue and dashed. Bolts are coloured by their tension, joint by joint,
with a dot where they have yielded and dashed where they are broken. Liners are drawn in their thickness, coloured by
their thrust (--liners), with a dot where they have cracked and a cross where they are broken. Panels and pictures of
one call share axes and scales, which fit the window that is shown.
"""


def _frame(word):
    return int(word) if word.isdigit() else word


def _plot_parser():
    from .plot import ARROWS, FIELDS, HISTORIES, JOINTS, LINERS
    parser = argparse.ArgumentParser(prog="plot.py", description=PLOT,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path, metavar="DIR", help="result folder of a run")
    parser.add_argument("--frame", default="last", help="N, first, last, all, or several: 0,last (default: last)")
    parser.add_argument("--field", choices=FIELDS,
                        help="what fills the blocks (default: displacement, or none with another layer)")
    parser.add_argument("--joints", choices=JOINTS, help="colour joints")
    parser.add_argument("--arrows", choices=ARROWS, help="draw arrows of blocks, or of forces at contacts")
    parser.add_argument("--chains", action="store_true", help="draw force chains")
    parser.add_argument("--crosses", action="store_true", help="draw principal stresses, tension red")
    parser.add_argument("--pressure", action="store_true", help="draw the water pressure on the edges of blocks")
    parser.add_argument("--history", choices=HISTORIES,
                        help="draw a quantity of the monitors over time instead of blocks")
    parser.add_argument("--monitors", help="names of the monitors to draw: crest,toe (default: all)")
    parser.add_argument("--profile", metavar="NAME",
                        help="draw a monitored line instead of blocks: displacement, or what --history says")
    parser.add_argument("--energy", action="store_true", help="draw energies over time instead of blocks")
    parser.add_argument("--bolts", action="store_true", help="draw the tension of bolts over time instead of blocks")
    parser.add_argument("--liners", choices=LINERS, default="thrust", help="what liners are coloured by")
    parser.add_argument("--moments", action="store_true", help="draw the bending moments of liners across them")
    parser.add_argument("--liner-history", action="store_true",
                        help="draw the largest thrust and moment of liners over time instead of blocks")
    parser.add_argument("--rayleigh", action="store_true",
                        help="draw the damping ratio of run.rayleigh instead of blocks")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="FILE.png, .pdf, .svg; FILE.gif is animated")
    parser.add_argument("--scale", type=float, default=1.0, help="draw the motion since the first frame so many times")
    parser.add_argument("--compare", choices=["first"], help="outline the blocks as they were in the first frame")
    parser.add_argument("--since", metavar="STAGE", help="stage from whose beginning permanent displacement counts")
    parser.add_argument("--window", type=lambda text: [float(x) for x in text.split(",")], metavar="X0,Y0,X1,Y1",
                        help="part of the plane to draw (default: all of it)")
    parser.add_argument("--title")
    parser.add_argument("--dpi", type=float, default=160)
    parser.add_argument("--seconds", type=float, help="length of an animation (default: 8)")
    parser.add_argument("--fps", type=float, help="frames of an animation in a second, instead of its length")
    return parser


def plot(words=None):
    """Draws what the words of a command line say; returns an exit code."""
    parser = _plot_parser()
    chosen = parser.parse_args(words)
    if ("permanent" in (chosen.field, chosen.arrows)) != (chosen.since is not None):
        parser.error("--field permanent or --arrows permanent and --since STAGE belong together")
    if chosen.window is not None and len(chosen.window) != 4:
        parser.error("--window takes four numbers: --window=X0,Y0,X1,Y1")
    try:
        _draw(Result(chosen.directory), chosen)
    except (FileNotFoundError, KeyError, ValueError) as error:
        sys.exit(f"plot.py: {error.args[0] if isinstance(error, KeyError) else error}")
    return 0


def _draw(result, chosen):
    plots, file = result.plot, {"out": chosen.out, "dpi": chosen.dpi}
    if chosen.rayleigh:
        plots.rayleigh(**file)
    elif chosen.energy:
        plots.energy(**file)
    elif chosen.bolts:
        plots.bolts(**file)
    elif chosen.liner_history:
        plots.liners(**file)
    elif chosen.profile:
        plots.profile(chosen.profile, chosen.history or "displacement", **file)
    elif chosen.history:
        plots.history(chosen.history, chosen.monitors.split(",") if chosen.monitors else None, **file)
    else:
        frames = [_frame(word) for word in chosen.frame.split(",")]
        if chosen.out.suffix != ".gif" and frames == ["all"] and len(result.frames) > 30:
            raise ValueError(f"{len(result.frames)} panels cannot be read: choose some with --frame, or write a .gif")
        plots.map(chosen.field, joints=chosen.joints, arrows=chosen.arrows, chains=chosen.chains,
                  crosses=chosen.crosses, pressure=chosen.pressure, frame=frames, window=chosen.window,
                  scale=chosen.scale, compare=chosen.compare, since=chosen.since, title=chosen.title,
                  seconds=chosen.seconds, fps=chosen.fps, liners=chosen.liners, moments=chosen.moments, **file)


REPORT = """One HTML file about the result folder of a run, of `gcpdda fos` or of `gcpdda ensemble`, which opens without
a network: scene, stages with verdicts, pictures, histories, energy, warnings, bolts, liners, factor of safety and its
mechanism, speed.

    run/report.py results/wall
    run/report.py results/goodman_bray_fos --out goodman_bray.html
"""


def report(words=None, name="report.py"):
    """Writes the report that the words of a command line ask for; returns an exit code, as the program has them."""
    parser = argparse.ArgumentParser(prog=name, description=REPORT,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path, metavar="DIR", help="result folder")
    parser.add_argument("--out", type=pathlib.Path, help="FILE.html (default: DIR/report.html)")
    parser.add_argument("--title", help="heading (default: the name of the folder)")
    parser.add_argument("--frames", type=int, default=40, help="most frames of the player, 0 for none (default: 40)")
    chosen = parser.parse_args(words)
    from .reports import report as write
    try:
        out = write(chosen.directory, chosen.out, title=chosen.title, frames=chosen.frames)
    except (OSError, ValueError) as error:
        print(f"{name}: error: {error}", file=sys.stderr)
        return 4
    except KeyError as error:
        print(f"{name}: error: {chosen.directory} is damaged: {error} is missing in one of its files, no report is "
              "written; compute the folder again, or restore its files from a copy", file=sys.stderr)
        return 4
    path = str(out).encode(errors="replace").decode()
    print(f"{path}, {out.stat().st_size / 1e6:.2f} MB")
    return 0
