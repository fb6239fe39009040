"""Exceptions for the exit codes of the program.

Each carries `exit_code`, the lines that the program printed (`output`) and, where the program got far enough to leave
one, the result folder (`path`).
"""

import re
from typing import NamedTuple


class Fault(NamedTuple):
    """One fault of a scene, as the program reports it. Faults of values that `set` replaces have no line and column."""

    file: str
    line: int | None
    column: int | None
    message: str


class GcpddaError(RuntimeError):
    """The program has ended with an exit code other than 0."""

    def __init__(self, message, exit_code, output="", path=None):
        super().__init__(message)
        self.exit_code, self.output, self.path = exit_code, output, path


class InternalError(GcpddaError):
    """Exit code 1, a signal, or an exit code that the program does not document."""


class UsageError(GcpddaError):
    """Exit code 2: the command line is wrong."""


class SceneError(GcpddaError):
    """Exit code 3: the scene has faults, all of which are in `faults`."""

    @property
    def faults(self):
        pattern = re.compile(r"^(.*?)(?::(\d+):(\d+))?: error: (.*)$", re.M)
        return [Fault(file, int(line) if line else None, int(column) if column else None, message)
                for file, line, column, message in pattern.findall(self.output)]


class FileError(GcpddaError):
    """Exit code 4: a file cannot be read or written, or the result folder holds another run."""


class NumericalError(GcpddaError):
    """Exit code 5: the computation has failed; `path` holds the results up to then."""


class Stopped(GcpddaError):
    """Exit code 6: stopped by a signal, with a checkpoint in `path`."""


class Undecided(GcpddaError):
    """Exit code 7: a stage or search has reached its limit without a verdict; `path` holds the results."""


_CLASSES = {1: InternalError, 2: UsageError, 3: SceneError, 4: FileError, 5: NumericalError, 6: Stopped,
            7: Undecided}


def program_lines(output):
    """The lines of an output that are not empty, without what mpirun says about the exit code behind them."""
    own = re.split(r"^-{20,}\n(?:Primary job|mpirun)", output, maxsplit=1, flags=re.M)[0]
    return [line for line in own.splitlines() if line.strip()]


def error_of(exit_code, output, path, outcome=None):
    """The exception for an exit code. Its message is `outcome`, or the lines of the program that tell why."""
    lines = program_lines(output)
    telling = [line for line in lines if re.search(r"\berror\b|^failed|^undecided|^stopped", line)]
    message = outcome or "\n".join(telling or lines[-5:]) or f"the program ended with exit code {exit_code}"
    return _CLASSES.get(exit_code, InternalError)(message, exit_code, output, path)
