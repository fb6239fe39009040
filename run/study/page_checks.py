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


def limit_cells(row):
    means = [(row["by_static_and_step"], "static and dynamic"), (row["by_step"], "dynamic"),
             (row["by_undamped_step"], "undamped"), (row["undecided"], "undecided")]
    return [row["problem"], row["solver"], number(row["known"], 5), f"{number(row['holds'], 5)} to {number(row['fails'], 5)}",
            f"{100.0 * float(row['error']):.2f} %", row["trials"], count(row["evaluations"]),
            ", ".join(f"{cases} {word}" for cases, word in means if cases != "0")]


def safety_limits():
    """The tables of known factors of safety, one for each half, and how far the worst is off."""
    rows = sorted(read("safety_limits.csv"), key=lambda row: row["problem"])
    header = ["problem", "trials by", "known", "found", "error of the middle", "trials", "evaluations", "verdicts by"]
    texts = {}
    for half in ("tuned", "untouched"):
        own = [row for row in rows if row["half"] == half]
        texts[f"limits_{half}"] = table(header, [limit_cells(row) for row in own], source("verify", "safety_limits.csv"))
        texts[f"num_{half}"] = str(len({row["problem"] for row in own}))
        texts[f"worst_{half}"] = f"{100.0 * max(float(row['error']) for row in own):.2f}"
    texts["unfound"] = str(sum(row["exit_code"] != "0" for row in rows))
    return texts


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
    texts.update(safety_limits())
    texts["checks"] = f"{len(rows):,d}"
    texts["verdict"] = ("All of them hold." if not failed else
                        f"{len(failed)} of them do not hold: " + "; ".join(failed) + ".")
    return texts
