"""Tables, numbers and sources on the pages of the studies."""

import csv
import math
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parent.parent / "results" / "studies"


def read(name):
    """Rows of a committed table."""
    with open(RESULTS / name, newline="") as file:
        return list(csv.DictReader(file)) or sys.exit(f"{RESULTS / name} has no rows")


def of(rows, **wanted):
    """The rows that hold these values."""
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def number(value, digits=3):
    """A number with so many significant digits: 1,234,000, 0.00123 or 1.23e-04."""
    value = float(value)
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    power = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    decimals = digits - 1 - power
    if power >= 9 or power < -3 or decimals > 6:
        return f"{value:.{digits - 1}e}"
    if decimals >= 0:
        return f"{value:,.{decimals}f}"
    return f"{round(value, decimals):,.0f}"


def count(value):
    """A whole number: 1,234,567."""
    return f"{round(float(value)):,d}"


def source(study, *files):
    """The line below a table: its files, the command that makes them, date and machine."""
    row = next(row for row in read("recorded.csv") if row["study"] == study)
    names = ", ".join(f"[`{name}`]({name})" for name in files)
    return f"From {names}; `run/study.sh {study}`, {row['date']}, {row['machine']}."


def table(header, lines, below=""):
    """A table in Markdown, and the line with its source."""
    text = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    text += ["| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in lines]
    return "\n".join(text) + (f"\n\n{below}" if below else "")


def measurements(page):
    """What was measured by hand, with a command, for a page."""
    rows = [row for row in read("measurements.csv") if row["page"] == page]
    return table(["quantity", "value", "command", "date and machine"],
                 [[row["quantity"], row["value"], row["command"], f"{row['date']}, {row['machine']}"] for row in rows],
                 "From [`measurements.csv`](measurements.csv): single measurements, repeated as the command says.")
