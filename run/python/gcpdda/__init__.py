"""Drive gcpdda from Python and read what it writes.

    import gcpdda

    result = gcpdda.run("run/scenes/goodman_bray.toml", ranks=2, set={"joint.default.friction_angle_deg": 36})
    print(result.verdict, result.stages)
    result.plot.field("displacement", frame=["first", "last"], out="before_after.png")
    gcpdda.report(result.path)

The package is plain Python (3.11 or later) with numpy, h5py, pandas and matplotlib. It needs no installation: put
the folder run/python on PYTHONPATH, or install gcpdda with `cmake --install`. pandas and matplotlib are imported when
they are first used, so that a script that only runs scenes starts quickly.
"""

from .errors import (FileError, GcpddaError, InternalError, NumericalError, SceneError, Stopped, Undecided,
                     UsageError)
from .frame import Frame
from .program import ensemble, fos, inspect, program, run, sweep
from .result import Ensemble, Result, Safety, open_folder
from .scene import Scene

__all__ = ["run", "sweep", "fos", "ensemble", "inspect", "program", "open_folder", "Result", "Safety", "Ensemble",
           "Frame", "Scene", "report", "GcpddaError", "InternalError", "UsageError", "SceneError", "FileError",
           "NumericalError", "Stopped", "Undecided"]


def report(directory, out=None, **options):
    """Write one HTML file about the result folder of a run, of `fos` or of `ensemble`; see gcpdda.reports.report."""
    from .reports import report as write
    return write(directory, out, **options)
