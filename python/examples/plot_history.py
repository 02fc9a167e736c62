#!/usr/bin/python3
"""Plots columns of a run's history over time, one panel per unit.

Usage: plot_history.py DIR [column ...] [--out FILE.png]      without columns: lists those there are
"""
import argparse
import sys
from pathlib import Path

from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # not needed where the module is installed
import talus  # noqa: E402


def plot(history, wanted, out):
    """Draws one panel per unit, in the order of the columns."""
    panels = list(dict.fromkeys(history.units[name] for name in wanted))
    figure = Figure(figsize=(8, 1 + 2.6 * len(panels)), layout="constrained")
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for unit, axis in zip(panels, axes):
        for name in wanted:
            if history.units[name] == unit:
                axis.plot(history["time"], history[name], label=name.replace("_", " "))
        axis.set_ylabel(f"[{unit}]")
        axis.grid(alpha=0.3)
        axis.legend(frameon=False)
    axes[-1].set_xlabel("time [s]")
    figure.savefig(out, dpi=150)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("columns", nargs="*")
    options.add_argument("--out", type=Path)
    given = options.parse_args()
    history = talus.Run(given.folder).history
    if not given.columns:
        print("\n".join(f"{name} [{unit}]" for name, unit in history.units.items()))
        return
    for name in given.columns:
        history[name]  # says which there are where it is not one of them
    out = given.out or given.folder / "history.png"
    plot(history, given.columns, out)
    print(out)


if __name__ == "__main__":
    try:
        main()
    except (OSError, talus.FileError, talus.Missing) as error:
        sys.exit(f"plot_history.py: {error}")
