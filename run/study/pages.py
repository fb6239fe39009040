#!/usr/bin/python3
"""The pages of the studies, written from the committed tables.

    run/study/pages.py                 write run/results/studies/*.md and the numbers in README.md
    run/study/pages.py --check         write nothing; exit 1 where a page differs from its tables
    run/study/pages.py --record STUDY  note date and machine of a study that has just run, then write

A page is a template of run/study/pages/ in which every {{name}} is replaced by what the page's function below makes from
the CSV files in run/results/studies. recorded.csv holds date and machine of each study, which a table's last line repeats.
"""

import argparse
import csv
import datetime
import difflib
import os
import platform
import re
import sys
from pathlib import Path

from page_numbers import numbers
from page_tables import RESULTS, read
from page_blocks import fidelity, stability
from page_cost import accuracy, scaling, speed
from page_statics import statics
from page_checks import verification

TEMPLATES = Path(__file__).resolve().parent / "pages"
README = RESULTS.parents[2] / "README.md"
PAGES = {"verification": verification, "accuracy": accuracy, "stability": stability, "fidelity": fidelity, "statics": statics,
         "speed": speed, "scaling": scaling}
START, END = "<!-- numbers: written by run/study/pages.py -->\n", "<!-- end of numbers -->"


def render(name):
    """The text of a page."""
    texts = PAGES[name]()
    template = (TEMPLATES / f"{name}.md").read_text()
    note = f"<!-- Written by run/study/pages.py from run/study/pages/{name}.md and the tables of this folder. -->\n\n"
    return note + re.sub(r"\{\{(\w+)\}\}", lambda match: texts[match[1]], template)


def with_numbers(text):
    """README.md with the table of numbers between its markers."""
    head, rest = text.split(START)
    return head + START + "\n" + numbers() + "\n\n" + END + rest.split(END)[1]


def written():
    """Every file that is written here, and its text."""
    files = {RESULTS / f"{name}.md": render(name) for name in PAGES}
    files[README] = with_numbers(README.read_text())
    return files


def machine():
    """What a reader has to know of this machine, in a few words."""
    facts = Path("/proc/cpuinfo").read_text()
    name = re.search(r"model name\s*: (.*)", facts)
    widest = next((words for flag, words in ((" avx512f", "AVX-512"), (" avx2", "AVX2")) if flag in facts), "SSE2")
    return f"{name[1] if name else platform.machine()}, {os.cpu_count()} cores, {widest}"


def record(study):
    """Put today's date and this machine beside a study."""
    path = RESULTS / "recorded.csv"
    rows = {row["study"]: row for row in read("recorded.csv")}
    rows[study] = {"study": study, "date": datetime.date.today().isoformat(), "machine": machine()}
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, ["study", "date", "machine"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[name] for name in sorted(rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--check", action="store_true")
    choice.add_argument("--record", metavar="STUDY")
    asked = parser.parse_args()
    if asked.record:
        record(asked.record)
    differ = False
    for path, text in written().items():
        old = path.read_text() if path.exists() else ""
        if old == text:
            continue
        if asked.check:
            differ = True
            sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), text.splitlines(True), str(path), "generated", n=1))
        else:
            path.write_text(text)
            print(path)
    if differ:
        sys.exit("pages.py: pages differ from their tables, run run/study/pages.py")


if __name__ == "__main__":
    main()
