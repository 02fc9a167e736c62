#!/usr/bin/python3
"""Plots columns of a run's history.csv over time, one panel per unit.

Usage: history.py DIR [column ...] [--out FILE.png]      without columns: lists those there are
"""
import argparse
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def read(path):
    """Names, units and values (by column) of a history; an empty entry is nan, a last row cut short by a kill is left out."""
    text = path.read_text(encoding="utf-8")
    rows = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))
    names, units = [], []
    for cell in rows[0]:
        name, _, unit = cell.rpartition(" [") if cell.endswith("]") else (cell, "", "")
        names.append(name or cell)
        units.append(unit.removesuffix("]") or "-")
    return names, units, [[float(row[i] or "nan") for row in rows[1:]] for i in range(len(names))]


def plot(names, units, values, wanted, out):
    """One panel per unit, in the order in which the units are asked for."""
    chosen = [names.index(name) for name in wanted]
    panels = list(dict.fromkeys(units[i] for i in chosen))
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(8, 1 + 2.6 * len(panels)), layout="constrained")
    for unit, axis in zip(panels, axes[:, 0]):
        for i in chosen:
            if units[i] == unit:
                axis.plot(values[0], values[i], label=names[i].replace("_", " "))
        axis.set_ylabel(f"[{unit}]")
        axis.grid(alpha=0.3)
        axis.legend(frameon=False)
    axes[-1, 0].set_xlabel(f"{names[0]} [{units[0]}]")
    figure.savefig(out, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("columns", nargs="*")
    parser.add_argument("--out", type=pathlib.Path)
    given = parser.parse_args()
    names, units, values = read(given.folder / "history.csv")
    if not given.columns:
        print("\n".join(f"{name} [{unit}]" for name, unit in zip(names, units)))
        return 0
    unknown = [name for name in given.columns if name not in names]
    if unknown:
        print(f"history.py: no column {', '.join(unknown)}; there are: {', '.join(names)}", file=sys.stderr)
        return 2
    out = given.out or given.folder / "history.png"
    plot(names, units, values, given.columns, out)
    print(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
