#!/usr/bin/python3
"""Pictures and animations of a run, by the package run/python/gcpdda; `run/plot.py --help` has the options."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "python"))

from gcpdda import command_line

if __name__ == "__main__":
    sys.exit(command_line.plot())
