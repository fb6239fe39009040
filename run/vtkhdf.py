#!/usr/bin/python3
"""All frames of a run in one file for ParaView 5.12 and later (temporal VTKHDF):

    run/vtkhdf.py results/wall                      writes results/wall/run.vtkhdf
    run/vtkhdf.py results/wall --kind contacts      its contacts, or bolts, liners
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "python"))

from gcpdda import vtkhdf


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIR", help="result folder of a run")
    parser.add_argument("--kind", choices=list(vtkhdf.KINDS), default="blocks", help="whose frames (default: blocks)")
    parser.add_argument("--out", help="the file (default: in DIR)")
    arguments = parser.parse_args()
    try:
        print(vtkhdf.write(arguments.directory, arguments.out, arguments.kind))
    except (FileNotFoundError, OSError) as error:
        sys.exit(f"vtkhdf.py: {error}")


if __name__ == "__main__":
    main()
