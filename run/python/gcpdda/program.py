"""Runs the program gcpdda and turns its exit codes into exceptions."""

import itertools
import numbers
import os
import pathlib
import queue
import shutil
import subprocess
import sys
import threading
import tomllib

from .errors import GcpddaError, NumericalError, Stopped, Undecided, error_of, program_lines
from .result import Ensemble, Result, Safety
from .scene import Scene, read_toml, toml_value

FILES_EXIT_CODE = 4  # a file cannot be read or written, or the result folder holds another run
NUMERICAL_EXIT_CODE = 5  # this code and those above it are outcomes of a computation
_HERE = pathlib.Path(__file__).resolve().parent


def program(path=None):
    """Path of the program: `path`, $GCPDDA, the build folder of this tree, the installation of this package, or
    PATH."""
    tree = _HERE.parents[2]  # of run/python/gcpdda
    candidates = [path, os.environ.get("GCPDDA"), tree / "build" / "gcpdda"]
    candidates += [folder / "bin" / "gcpdda" for folder in _HERE.parents[2:6]]
    candidates.append(shutil.which("gcpdda"))
    for candidate in candidates:
        if candidate and os.access(candidate, os.X_OK) and pathlib.Path(candidate).is_file():
            return str(candidate)
        if candidate and candidate is path:
            break
    raise FileNotFoundError(f"the program gcpdda is not at {path}" if path else
                            "the program gcpdda is not found: build it (cmake --build build), put it on PATH, or set "
                            "the environment variable GCPDDA to its path")


def run(scene, ranks=2, set=None, out=None, *, overwrite=False, progress=False, program=None):
    """Runs a scene, a path or a `Scene`, and returns its `Result`.

    ranks       number of processes among which the blocks are divided, 1 or more
    set         values of the scene to replace, by path: {"joint.default.friction_angle_deg": 36}; files in them are
                found from the folder of the scene
    out         result folder; results/<name of the scene> if not given. A `Scene` is written as OUT.toml beside it;
                the file that it was read from is never replaced
    overwrite   whether a run in the result folder is replaced; otherwise it is an error (FileError)
    progress    True prints what the program prints, and the simulated time on a terminal; a function is called as
                progress(time, line) with the simulated time in s and a line of the program, or None as time goes on
    program     path of the program, where it is not found by itself

    An exit code other than 0 raises the exception of gcpdda.errors that stands for it. A run whose blocks fail has exit
    code 0: its verdict is "failed".
    """
    out = _folder(scene, out, "")
    _execute("run", scene, ranks, set, out, overwrite, progress, program, ())
    return Result(out)


def fos(scene, ranks=2, set=None, out=None, *, overwrite=False, progress=False, program=None, **limits):
    """Searches the factor of safety of a scene and returns a `Safety`. Keywords `from_`, `to`, `tolerance` and
    `families` (a list) replace those of [fos]; the others are those of `run`."""
    out = _folder(scene, out, "_fos")
    words = []
    for key, value in limits.items():
        if key.rstrip("_") not in ("from", "to", "tolerance", "families"):
            raise TypeError(f"fos() has no keyword {key}: from_, to, tolerance and families replace keys of [fos]")
        words += [f"--{key.rstrip('_')}", ",".join(value) if isinstance(value, (list, tuple)) else str(value)]
    _execute("fos", scene, ranks, set, out, overwrite, progress, program, words)
    return Safety(out)


def ensemble(scene, ranks=2, set=None, out=None, *, count=None, overwrite=False, progress=False, program=None):
    """Computes the members of an ensemble and returns an `Ensemble`; the keywords are those of `run`, and the `count`
    of members. A call for a folder that holds members adds those that are missing."""
    out = _folder(scene, out, "_ensemble")
    words = [] if count is None else ["--count", str(count)]
    _execute("ensemble", scene, ranks, set, out, overwrite, progress, program, words)
    return Ensemble(out)


def inspect(scene, set=None, *, program=None):
    """What `gcpdda inspect` prints about a scene, which is checked but not run; faults raise a SceneError."""
    import tempfile
    with tempfile.TemporaryDirectory(prefix="gcpdda_") as folder:
        return _execute("inspect", scene, 1, set, pathlib.Path(folder) / "scene", False, False, program, ())


def sweep(scene, values, ranks=2, set=None, out=None, *, overwrite=False, progress=False, program=None):
    """Runs a scene for all combinations of values, one after the other, and returns a table with a row for each.

        table = gcpdda.sweep("slope.toml", {"joint.default.friction_angle_deg": [30, 33, 36]})

    values      {path: [value, ...]}; with several paths every combination is run
    out         folder that gets a result folder for each row; results/<name of the scene>_sweep if not given

    Columns: one for each path; verdict; time, the simulated time at the end in s; largest_displacement in m;
    exit_code and message; result, the `Result` or None. A row whose run fails has its exit code and message, and
    the sweep goes on; where the program refuses a run, because of the scene or of an earlier run in the folder, there
    is no result.
    """
    import pandas
    out = _folder(scene, out, "_sweep")
    rows = []
    for number, combination in enumerate(itertools.product(*values.values())):
        row = dict(zip(values, combination)) | {"verdict": None, "time": None, "largest_displacement": None,
                                                "exit_code": 0, "message": "", "result": None}
        folder = out / f"{number:03d}"
        try:
            row["result"] = run(scene, ranks, (set or {}) | dict(zip(values, combination)), folder,
                                overwrite=overwrite, progress=progress, program=program)
        except GcpddaError as error:
            row |= {"exit_code": error.exit_code, "message": str(error)}
            # A run that is refused leaves the results of an earlier one in the folder.
            if isinstance(error, (NumericalError, Stopped, Undecided)) and (folder / "summary.json").exists():
                row["result"] = Result(folder)
        if row["result"] is not None:
            moved = row["result"].frame("last").blocks
            row |= {"verdict": row["result"].verdict, "time": row["result"].summary["time"],
                    "largest_displacement": float(moved["displacement"][moved["kind"] != "fixed"].max())}
        rows.append(row)
    return pandas.DataFrame(rows)


def _folder(scene, out, ending):
    stem = scene.name if isinstance(scene, Scene) else pathlib.Path(scene).stem
    return pathlib.Path(out) if out is not None else pathlib.Path("results") / (stem + ending)


def _environment(ranks):
    """What run/set_up.sh sets: containers run as root, forbid single-copy messages, and have few cores."""
    settings = {"OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMPI_MCA_mpi_yield_when_idle": "1",
                "OMP_NUM_THREADS": "1"}
    if os.geteuid() == 0:
        settings |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    if ranks > len(os.sched_getaffinity(0)):
        settings |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
    return settings | dict(os.environ)


def _execute(task, scene, ranks, values, out, overwrite, progress, executable, words):
    """Runs the program, returns what it prints, raises the exception for its exit code."""
    if isinstance(ranks, bool) or not isinstance(ranks, numbers.Integral) or ranks < 1:
        raise ValueError(f"ranks is {ranks!r}, which is no positive whole number, and the program cannot start on it; "
                         "try ranks=1, or ranks=2")
    written, before = None, None
    if isinstance(scene, Scene):
        values = scene.values_to_set(values or {})
        scene, written, before = _written(scene, out.with_name(out.name + ".toml"))
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [program(executable), task, str(scene), *words]
    if task != "inspect":
        command += ["--out", str(out)] + (["--overwrite"] if overwrite else [])
    for path, value in (values or {}).items():
        command += ["--set", f"{path}={toml_value(value)}"]
    say = _say if progress is True else progress
    lines = []
    with subprocess.Popen(command, env=_environment(ranks), text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as process:
        try:
            _follow(process, Result(out), lines, say)
        finally:
            if process.poll() is None:
                process.terminate()
    output = "\n".join(lines)
    if process.returncode == FILES_EXIT_CODE and written is not None:
        _put_back(written, before)
    if process.returncode != 0:
        of_search = task == "fos" and process.returncode >= NUMERICAL_EXIT_CODE
        outcome = _outcome_of_search(out, output) if of_search else None
        raise error_of(process.returncode, output, out if out.exists() else None, outcome)
    return output


def _outcome_of_search(out, output):
    """What a search came to: the sentences with which its report begins, or its last line where no report is written.
    The lines of single runs, of which the output has more, say something else."""
    lines, report = program_lines(output), out / "fos.txt"
    written = report.read_text(errors="replace").splitlines() if report.exists() else []
    sentences = list(itertools.takewhile(lambda line: not line.startswith("strengths divided: "), written))
    if sentences and set(sentences) <= set(lines):  # else the report is that of an earlier search
        return "\n".join(sentences)
    return lines[-1] if lines else None


def _written(scene, path):
    """The file of a scene for the program; the same where this call has written it, and what was in it before."""
    if not scene.is_read_from(path):
        before = path.read_bytes() if path.exists() else None
        return scene.write(path), path, before
    if read_toml(path) != tomllib.loads(scene.toml()):
        raise FileExistsError(f"the scene was read from {path} and has changed: its file would be replaced; choose "
                              "another result folder with out")
    return path, None, None


def _put_back(path, content):
    """Of a run that is refused: OUT.toml goes on belonging to what is in OUT."""
    if content is None:
        path.unlink()
    else:
        path.write_bytes(content)


def _follow(process, result, lines, say):
    """Collects the lines of the process until it ends; tells `say` each of them and, while there are none, the time."""
    arrived = queue.Queue()

    def read():
        for line in process.stdout:
            arrived.put(line.rstrip("\n"))
        arrived.put(None)

    threading.Thread(target=read, daemon=True).start()
    while True:
        try:
            line = arrived.get(timeout=0.5)
        except queue.Empty:
            if say:
                say(result.reached, None)
            continue
        if line is None:
            break
        lines.append(line)
        if say:
            say(result.reached, line)
    process.wait()


def _say(time, line):
    if line is not None:
        print(line, flush=True)
    elif sys.stdout.isatty():
        print(f"\rt = {time:.4g} s ", end="", flush=True)
