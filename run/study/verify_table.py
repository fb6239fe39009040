#!/usr/bin/python3
"""Table of the verification problems: verify_table.py RESULTS [--publish | --quick].

Sorts RESULTS/verification_rows.csv, as the tests wrote it, by problem into RESULTS/verification.csv. With --publish the
same table goes to run/verification.csv and, as Markdown, between the marker comments of run/README.md, and so does
RESULTS/goodman_bray.csv."""

import csv
import pathlib
import re
import shutil
import sys

RUN = pathlib.Path(__file__).resolve().parent.parent
GROUPS = {"A": "A. Integrator and kinematics", "B": "B. Contact and friction", "C": "C. Block systems",
          "": "Loads, supports and damping"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def key(row):
    """Number of the problem in its group, ("A", 3); problems without one come last."""
    match = re.match(r"([A-C])(\d+) ", row["problem"])
    return (match[1], int(match[2])) if match else ("~", 0)


def short(text, digits):
    return f"{float(text):.{digits}g}" if text else ""


def cells(row):
    bound = "" if row["relation"] == "=" else ("≤ " if row["relation"] == "<=" else "≥ ")
    error = f"{short(row['error'], 2)} (≤ {short(row['tolerance'], 2)})" if row["error"] else ""
    return [row["problem"].replace("|", "\\|"), bound + short(row["expected"], 7 if not bound else 3),
            short(row["got"], 7 if not bound else 3), error, short(row["cpu_s"], 2),
            row["steps"] if row["steps"] != "0" else ""]


def table(header, lines):
    text = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(text + ["| " + " | ".join(line) + " |" for line in lines])


def verification(rows):
    header = ["problem", "expected", "got", "relative error", "CPU s", "steps"]
    parts = []
    for letter, title in GROUPS.items():
        group = [row for row in rows if key(row)[0] == (letter or "~")]
        if group:
            parts.append(f"### {title}\n\n{table(header, map(cells, group))}")
    return "\n\n".join(parts)


def goodman_bray(rows):
    header = ["column", "published, kN/m", "model, kN/m", "its shear/cap", "from the corner, m", "base, kN/m",
              "its shear/cap", "from the corner, m"]
    return table(header, [list(row.values()) for row in rows])


def publish(name, text):
    """Put a text between <!-- name --> and <!-- end of name --> of run/README.md."""
    page = RUN / "README.md"
    old = page.read_text()
    new, count = re.subn(rf"(<!-- {name} -->\n).*?(<!-- end of {name} -->)",
                         lambda match: f"{match[1]}\n{text}\n\n{match[2]}", old, flags=re.DOTALL)
    if count != 1:
        sys.exit(f"verify_table.py: {page} has no place for {name}")
    page.write_text(new)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    results = pathlib.Path(sys.argv[1])
    rows = sorted(read(results / "verification_rows.csv"), key=key)
    with open(results / "verification.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{len(rows)} checks: {results / 'verification.csv'}")
    if "--publish" in sys.argv:
        shutil.copy(results / "verification.csv", RUN / "verification.csv")
        publish("verification", verification(rows))
        publish("goodman_bray", goodman_bray(read(results / "goodman_bray.csv")))


if __name__ == "__main__":
    main()
