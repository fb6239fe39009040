"""What the scripts plot.py and report.py do, for installations without them."""

import argparse
import sys

from . import command_line

COMMANDS = {"plot": command_line.plot, "report": command_line.report}

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, prog="python3 -m gcpdda", add_help=len(sys.argv) < 3)
    parser.add_argument("command", choices=COMMANDS, help="what to do; COMMAND --help has its options")
    parser.add_argument("words", nargs=argparse.REMAINDER, help="arguments of the command")
    chosen = parser.parse_args()
    sys.exit(COMMANDS[chosen.command](chosen.words))
