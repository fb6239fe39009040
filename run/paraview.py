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
here = pathlib.Path(__file__).resolve().parent
sys.path = [str(here / "python")] + [folder for folder in sys.path if pathlib.Path(folder or ".").resolve() != here]

from gcpdda import paraview_view

if __name__ == "__main__":
    try:
        paraview_view.draw(*sys.argv[1:])
    except FileNotFoundError as error:
        sys.exit(f"paraview.py: {error}")
