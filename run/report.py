#!/usr/bin/python3
"""One HTML file about the result folder of a run, of `gcpdda fos` or of `gcpdda ensemble`, which opens without a
network."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "python"))

from gcpdda import command_line

if __name__ == "__main__":
    sys.exit(command_line.report())
