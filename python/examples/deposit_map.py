#!/usr/bin/python3
"""Map of the depth of a deposit in plan, 3-D: by how much the surface (the highest particle over each square) rose or sank since the start.

Usage: deposit_map.py DIR [--up y|z] [--square METRES] [--time SECONDS] [--out FILE.png]
"""
import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # not needed where the module is installed
import talus  # noqa: E402

PLAN = {"y": (0, 2), "z": (0, 1)}  # up -> the two axes of the plan


def tops(position, up, low, square, shape):
    """Height of the highest particle over each square, -inf without particles; shape (nx, ny)."""
    place = ((position[:, PLAN[up]] - low) / square).astype(int)
    highest = np.full(shape, -np.inf)
    np.maximum.at(highest, tuple(place.T), position[:, "xyz".index(up)])
    return highest


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--up", choices=PLAN, default="y", help="axis against gravity; default y")
    options.add_argument("--square", type=float, help="side of a square [m]; default twice the spacing of the particles")
    options.add_argument("--time", type=float, help="that of the nearest file; default the last [s]")
    options.add_argument("--out", type=Path)
    given = options.parse_args()
    series = talus.Run(given.folder).particles
    first, last = series[0], series[-1] if given.time is None else series.at(given.time)
    both = np.concatenate([first["position"], last["position"]])
    low, high = both[:, PLAN[given.up]].min(axis=0), both[:, PLAN[given.up]].max(axis=0)
    if (high - low).min() <= 0:
        sys.exit("deposit_map.py: these are results of two dimensions, which have no plan")
    square = given.square or 2 * np.cbrt(np.prod(np.ptp(first["position"], axis=0)) / len(first["id"]))
    shape = tuple(((high - low) / square).astype(int) + 1)
    before, after = (tops(frame["position"], given.up, low, square, shape) for frame in (first, last))
    ground = both[:, "xyz".index(given.up)].min()  # where nothing was
    rise = np.where(np.isfinite(after), after, ground) - np.where(np.isfinite(before), before, ground)
    rise[~np.isfinite(before) & ~np.isfinite(after)] = np.nan

    figure = Figure(figsize=(8, 1.2 + 7 * shape[1] / shape[0]), layout="constrained")
    axis = figure.subplots()
    limit = np.nanmax(np.abs(rise)) or 1
    shown = axis.imshow(rise.T, origin="lower", cmap="PuOr", vmin=-limit, vmax=limit,
                        extent=(low[0], low[0] + shape[0] * square, low[1], low[1] + shape[1] * square))
    figure.colorbar(shown, label="risen [m]", shrink=0.8)
    axis.set(xlabel="x [m]", ylabel=f"{'xyz'[PLAN[given.up][1]]} [m]", title=f"{last.time:.4g} s")
    out = given.out or given.folder / "deposit.png"
    figure.savefig(out, dpi=150)
    print(f"{out}: risen by {max(np.nanmax(rise), 0):.3g} m at most, sunk by {max(-np.nanmin(rise), 0):.3g} m")


if __name__ == "__main__":
    try:
        main()
    except (OSError, talus.FileError, talus.Missing) as error:
        sys.exit(f"deposit_map.py: {error}")
