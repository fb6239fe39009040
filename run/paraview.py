"""Large pictures of a run with ParaView (5.11 or later), which is not needed for anything else:

    xvfb-run -a pvbatch --force-offscreen-rendering run/paraview.py results/wall wall.png [TIME]

Without TIME the last frame is drawn. In the ParaView window the same: open run.hdf.series, then the filters
Extract Surface and Triangulate, without which polygons that are not convex are filled wrongly. Bolts are lines of
their own: bolts.hdf.series.
"""

import pathlib
import sys

# Before the modules of ParaView, which plain Python may not have.
if len(sys.argv) not in (3, 4):
    print(__doc__)
    sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)

# This file would hide ParaView's own module of the same name.
sys.path = [folder for folder in sys.path if pathlib.Path(folder or ".").resolve() != pathlib.Path(__file__).resolve().parent]

from paraview.simple import (
    ColorBy, CreateView, ExtractSurface, GetColorTransferFunction, GetScalarBar, OpenDataFile, Render, SaveScreenshot,
    Show, Triangulate,
)


def show_scale(name, preset, title, view):
    colours = GetColorTransferFunction(name)
    colours.ApplyPreset(preset, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    bar.Visibility = 1
    return bar


def show_bolts(path, view):
    """Those in place at the view's time, by their tension."""
    bolts = OpenDataFile(str(path))
    bolts.UpdatePipeline(view.ViewTime)
    count = bolts.GetDataInformation().GetNumberOfCells()
    print(f"{count} lines of bolts")
    if count == 0:
        return
    lines = Show(bolts, view)
    lines.LineWidth = 5.0
    ColorBy(lines, ("CELLS", "axial_force"))
    lines.RescaleTransferFunctionToDataRange(False, True)
    bar = show_scale("axial_force", "Inferno (matplotlib)", "tension of a bolt (N)", view)
    bar.WindowLocation = "Upper Right Corner"


def main(directory, picture, time=None):
    run = OpenDataFile(str(pathlib.Path(directory).resolve() / "run.hdf.series"))
    if run is None:
        sys.exit(f"paraview.py: cannot open {directory}/run.hdf.series")
    times = list(run.TimestepValues)
    print(f"{len(times)} frames, t = {times[0]:g} to {times[-1]:g} s")

    view = CreateView("RenderView")
    view.ViewSize = [1600, 1200]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    view.ViewTime = times[-1] if time is None else float(time)
    run.UpdatePipeline(view.ViewTime)

    surface = ExtractSurface(Input=run)
    blocks = Show(Triangulate(Input=surface), view)
    ColorBy(blocks, ("CELLS", "displacement", "Magnitude"))
    blocks.RescaleTransferFunctionToDataRange(False, True)
    show_scale("displacement", "Viridis (matplotlib)", "displacement (m)", view)

    edges = Show(surface, view)
    edges.Representation = "Wireframe"
    ColorBy(edges, ("CELLS", None))
    edges.AmbientColor = edges.DiffuseColor = [0.12, 0.14, 0.16]

    if (series := pathlib.Path(directory).resolve() / "bolts.hdf.series").exists():
        show_bolts(series, view)

    view.ResetCamera(True)
    Render(view)
    SaveScreenshot(picture, view)
    data = run.GetDataInformation()
    print(f"{data.GetNumberOfCells()} blocks, {data.GetNumberOfPoints()} vertices, bounds {data.GetBounds()}")


if __name__ == "__main__":
    main(*sys.argv[1:])
