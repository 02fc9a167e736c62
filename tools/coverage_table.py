#!/usr/bin/python3
"""Lines covered by folder, out of what gcovr --json has written.

Usage: coverage_table.py [--floor PERCENT] LINES.json FOLDER...      exit status 1 if a folder is below the floor, or has no line at all
"""
import argparse
import json
import sys
from pathlib import Path

SHOWN = 5   # files of a folder, those with the most lines missed


def count(document):
    """{file: (lines, lines that were run)}.  A line of a template stands once for each file that instantiates it: it is run if one has run it."""
    lines = {}
    for entry in document["files"]:
        seen = lines.setdefault(entry["file"], {})
        for line in entry["lines"]:
            if not line.get("gcovr/noncode", False):
                number = line["line_number"]
                seen[number] = seen.get(number, False) or line["count"] > 0
    return {name: (len(seen), sum(seen.values())) for name, seen in lines.items()}


def table(counts, folders, floor):
    """The rows of the table, and the folders below the floor."""
    shown, low = ["| folder | lines | run | % |", "|---|---|---|---|"], []
    missed = []
    for folder in folders:
        files = {name: numbers for name, numbers in counts.items() if name.startswith(f"{folder}/")}
        total, run = (sum(numbers[i] for numbers in files.values()) for i in (0, 1))
        percent = 100 * run / total if total else 0
        shown.append(f"| {folder} | {total} | {run} | {percent:.1f} |")
        if percent < floor:
            low.append(folder)
        worst = sorted(files, key=lambda name: (files[name][1] - files[name][0], name))[:SHOWN]
        missed += [f"  {name}: {files[name][0] - files[name][1]} of {files[name][0]}" for name in worst if files[name][1] < files[name][0]]
    return [*shown, "", "most lines not run:", *missed] if missed else shown, low


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--floor", type=float, default=0)
    words.add_argument("file", type=Path)
    words.add_argument("folders", nargs="+")
    asked = words.parse_args()
    shown, low = table(count(json.loads(asked.file.read_text(encoding="utf-8"))), asked.folders, asked.floor)
    print("\n".join(shown))
    if low:
        print(f"fewer than {asked.floor:g} % of the lines are run in {', '.join(low)}", file=sys.stderr)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
