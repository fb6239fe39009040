"""Pictures with ParaView, whose Python (pvbatch) imports this module; nothing else does."""

import pathlib

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


def show_support(path, view, kind, title):
    """Draws the bolts or liners in place at the view's time, coloured by their axial force."""
    bolts = OpenDataFile(str(path))
    bolts.UpdatePipeline(view.ViewTime)
    count = bolts.GetDataInformation().GetNumberOfCells()
    print(f"{count} lines of {kind}")
    if count == 0:
        return
    lines = Show(bolts, view)
    lines.LineWidth = 5.0
    ColorBy(lines, ("CELLS", "axial_force"))
    lines.RescaleTransferFunctionToDataRange(False, True)
    bar = show_scale("axial_force", "Inferno (matplotlib)", title, view)
    bar.WindowLocation = "Upper Right Corner"


def draw(directory, picture, time=None):
    """Blocks coloured by displacement, bolts and liners by tension, at a time or in the last frame."""
    run = OpenDataFile(str(pathlib.Path(directory).resolve() / "run.hdf.series"))
    if run is None:
        raise FileNotFoundError(f"cannot open {directory}/run.hdf.series")
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

    for kind, title in (("bolts", "tension of a bolt (N)"), ("liners", "tension of a liner (N/m)")):
        if (series := pathlib.Path(directory).resolve() / f"{kind}.hdf.series").exists():
            show_support(series, view, kind, title)

    view.ResetCamera(True)
    Render(view)
    SaveScreenshot(picture, view)
    data = run.GetDataInformation()
    print(f"{data.GetNumberOfCells()} blocks, {data.GetNumberOfPoints()} vertices, bounds {data.GetBounds()}")
