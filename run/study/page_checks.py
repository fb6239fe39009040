"""What the page of the verification shows."""

import re

from page_tables import count, number, read, source, table

GROUPS = {"A": "Integrator and kinematics", "B": "Contact and friction", "C": "Block systems",
          "": "Loads, supports, water and damping"}
BOUNDS = {"=": "", "<=": "≤ ", ">=": "≥ "}


def group(row):
    match = re.match(r"([A-C])\d+ ", row["problem"])
    return match[1] if match else ""


def holds(row):
    """Whether a check is within its tolerance or limit."""
    if row["relation"] == "=":
        return float(row["error"]) <= float(row["tolerance"])
    got, expected = float(row["got"]), float(row["expected"])
    return got <= expected if row["relation"] == "<=" else got >= expected


def cells(row):
    digits = 5 if row["relation"] == "=" else 3
    error = f"{number(row['error'], 2)} (≤ {number(row['tolerance'], 2)})" if row["error"] else ""
    return [row["problem"], BOUNDS[row["relation"]] + number(row["expected"], digits), number(row["got"], digits), error,
            count(row["steps"]) if row["steps"] not in ("", "0") else ""]


def verification():
    rows = read("verification.csv")
    failed = [row["problem"] for row in rows if not holds(row)]
    below = source("verify", "verification.csv")
    header = ["problem", "expected", "computed", "relative error (tolerance)", "steps"]
    texts = {f"group_{letter or 'rest'}": table(header, [cells(row) for row in rows if group(row) == letter], below)
             for letter in GROUPS}
    columns = read("goodman_bray.csv")
    texts["goodman_bray"] = table(
        ["column", "published, kN/m", "model, kN/m", "shear over cap", "from the corner, m", "base, kN/m", "shear over cap",
         "from the corner, m"], [list(row.values()) for row in columns], source("verify", "goodman_bray.csv"))
    texts["checks"] = f"{len(rows):,d}"
    texts["verdict"] = ("All of them hold." if not failed else
                        f"{len(failed)} of them do not hold: " + "; ".join(failed) + ".")
    return texts
