#!/usr/bin/python3
"""verify_table.py RESULTS: sorts RESULTS/verification_rows.csv, as the tests wrote it, by problem into
RESULTS/verification.csv."""

import argparse
import csv
import pathlib
import re


def key(row):
    """Number of the problem in its group, ("A", 3); problems without one come last."""
    match = re.match(r"([A-C])(\d+) ", row["problem"])
    return (match[1], int(match[2])) if match else ("~", 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, metavar="RESULTS")
    results = parser.parse_args().results
    with open(results / "verification_rows.csv", newline="") as file:
        rows = sorted(csv.DictReader(file), key=key)
    if not rows:
        parser.error(f"{results / 'verification_rows.csv'} has no rows")
    with open(results / "verification.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{len(rows)} checks: {results / 'verification.csv'}")


if __name__ == "__main__":
    main()
