#!/usr/bin/python3
"""A number of a parameter study over one of its keys, a line for each combination of the others.  With --order the key is a length that goes to
nothing by one ratio (cells): the order of convergence, and what Richardson's extrapolation of the three smallest makes of the number.

Usage: sweep_convergence.py DIR KEY NUMBER [--order] [--out FILE.png]      such as runs/column_study mesh.size toe --order
"""
import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # not needed where the module is installed
import talus  # noqa: E402


LOWEST_ORDER = 0.5  # below it an extrapolation goes further than the values do, and tells nothing


def observed_order(lengths, values):
    """Of values at three lengths of one ratio, the smallest first; nan where they do not approach one another from one side."""
    (h1, h2, h3), (v1, v2, v3) = lengths, values
    if not np.isclose(h2 / h1, h3 / h2, rtol=0.01) or (v3 - v2) * (v2 - v1) <= 0:
        return float("nan")
    return np.log((v3 - v2) / (v2 - v1)) / np.log(h2 / h1)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("key")
    options.add_argument("number")
    options.add_argument("--order", action="store_true", help="the key is a length: extrapolate to nothing")
    options.add_argument("--out", type=Path)
    given = options.parse_args()
    sweep = talus.Sweep(given.folder)
    table = sweep.table
    keys, values = table[given.key][sweep.done], table[given.number][sweep.done]
    unit = table.units[given.number]
    others = [name for name in sweep.keys if name != given.key]
    lines: dict[tuple, list[int]] = {}  # values of the other keys -> rows
    for row in np.argsort(keys, kind="stable"):
        lines.setdefault(tuple(table[name][sweep.done][row] for name in others), []).append(row)

    figure = Figure(figsize=(6, 4), layout="constrained")
    axis = figure.subplots()
    for other, rows in lines.items():
        name = ", ".join(f"{key} {value}" for key, value in zip(others, other)) or "all cases"
        drawn, = axis.plot(keys[rows], values[rows], "o-", label=name)
        print(f"{name}: " + ", ".join(f"{value:.6g}" for value in values[rows]) + f" {unit} at {', '.join(f'{key:g}' for key in keys[rows])}")
        if not given.order or len(rows) < 3:
            continue
        h, v = keys[rows[:3]], values[rows[:3]]
        order = observed_order(h, v)
        if order >= LOWEST_ORDER:
            limit = v[0] - (v[1] - v[0]) / ((h[1] / h[0])**order - 1)
            axis.axhline(limit, color=drawn.get_color(), linestyle="--")
            print(f"  order {order:.3g}, extrapolated {limit:.6g} {unit} (dashed)")
        else:
            print(f"  order {order:.3g}: these values do not tell where they go to")
    axis.legend(frameon=False)
    axis.set(xlabel=given.key, ylabel=f"{given.number} [{unit}]")
    axis.grid(alpha=0.3)
    out = given.out or given.folder / "convergence.png"
    figure.savefig(out, dpi=150)
    print(out)


if __name__ == "__main__":
    try:
        main()
    except (OSError, talus.FileError, talus.Missing) as error:
        sys.exit(f"sweep_convergence.py: {error}")
