"""Effect of single precision: every number of two verification runs, one in double and one in single, side by side.

Usage: precision.py DOUBLE/verify.json SINGLE/verify.json [--write-docs]      the table goes to the terminal, or into docs/development/precision.md
"""
import argparse
import json
import pathlib

from lab import ROOT

PAGE = ROOT / "docs" / "development" / "precision.md"
BEGIN, END = "<!-- table: begin, written by benchmarks/precision.py -->", "<!-- table: end -->"
STEPS = (1e-6, 1e-4, 1e-2)  # relative changes that are counted
NOTHING = 1e-9  # errors and drifts below this are round-off in both precisions


def numbers(path):
    """{(case, metric): record} of a verification run."""
    document = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    return {(record["case"], record["metric"]): record for record in document["results"]}


def change(double, single):
    """Relative change of a number; None if neither run has it, 1 if only one has it."""
    a, b = double["value"], single["value"] if single else None
    if a is None and b is None:
        return None
    if a is None or b is None:
        return 1.0
    size = max(abs(a), abs(b), abs(double["reference"] or 0) if isinstance(double["reference"], (int, float)) else 0)
    return 0.0 if size < NOTHING else abs(a - b) / size


def rows(double, single):
    """A row of the table for every case: changes of numbers and of verdicts."""
    table = []
    for case in dict.fromkeys(case for case, _ in double):
        changes = {metric: change(record, single.get((case, metric))) for (of, metric), record in double.items() if of == case}
        changes = {metric: value for metric, value in changes.items() if value is not None}
        turned = sum(1 for (of, metric), record in double.items() if of == case and record["pass"] and not single.get((case, metric), {}).get("pass"))
        if changes:
            worst = max(changes, key=changes.get)
            counts = [sum(1 for value in changes.values() if value > step) for step in STEPS]
            table.append([case, len(changes), *counts, f"{changes[worst]:.0e}", worst, turned])
    return table


def markdown(table):
    """The table with its totals."""
    heads = ["case", "numbers", *(f"changed by more than {step:.0e}".replace("e-0", "e-") for step in STEPS), "most", "of", "judged numbers that fail in single only"]
    total = ["**all**", *(sum(row[k] for row in table) for k in range(1, 2 + len(STEPS))), "", "", sum(row[-1] for row in table)]
    lines = [heads, ["---"] * len(heads), *table, total]
    return "\n".join("| " + " | ".join(str(entry) for entry in line) + " |" for line in lines)


def main():
    options = argparse.ArgumentParser(description="What single precision costs.")
    options.add_argument("double", type=pathlib.Path)
    options.add_argument("single", type=pathlib.Path)
    options.add_argument("--write-docs", action="store_true", help="put the table into docs/development/precision.md")
    given = options.parse_args()
    text = markdown(rows(numbers(given.double), numbers(given.single)))
    if not given.write_docs:
        print(text)
        return
    page = PAGE.read_text(encoding="utf-8")
    head, rest = page.split(BEGIN)
    PAGE.write_text(f"{head}{BEGIN}\n{text}\n{END}{rest.split(END)[1]}", encoding="utf-8")


if __name__ == "__main__":
    main()
