#!/usr/bin/python3
"""Stress along a line: means over the particles near each of its points, weighted by their distance.

Usage: stress_along_line.py DIR --start X Y [Z] --end X Y [Z] [--radius METRES] [--time SECONDS] [--out FILE.png]
"""
import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # not needed where the module is installed
import talus  # noqa: E402

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")


def along(start, end, points, position, values, radius):
    """Distances from the start [m] and means of the values (points, components); nan where no particle is nearer than the radius."""
    share = np.linspace(0, 1, points)
    means = np.full((points, values.shape[1]), np.nan)
    for row, place in enumerate(start + share[:, None] * (end - start)):
        weight = np.clip(1 - np.linalg.norm(position - place, axis=1) / radius, 0, None)
        if weight.any():
            means[row] = weight @ values / weight.sum()
    return share * np.linalg.norm(end - start), means


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--start", type=float, nargs="+", required=True)
    options.add_argument("--end", type=float, nargs="+", required=True)
    options.add_argument("--radius", type=float, help="default a tenth of the line [m]")
    options.add_argument("--time", type=float, help="that of the nearest file; default the last [s]")
    options.add_argument("--out", type=Path)
    given = options.parse_args()
    if len(given.start) != len(given.end) or len(given.start) not in (2, 3):
        options.error("--start and --end are points of two or of three coordinates")
    series = talus.Run(given.folder).particles
    frame = series[-1] if given.time is None else series.at(given.time)
    start, end = (np.pad(point, (0, 3 - len(point))) for point in (given.start, given.end))
    radius = given.radius or np.linalg.norm(end - start) / 10
    distance, stress = along(start, end, 60, frame["position"], frame["stress"].astype(float), radius)
    if np.isnan(stress).all():
        sys.exit(f"stress_along_line.py: no particle is nearer to the line than {radius:g} m")

    figure = Figure(figsize=(7, 4), layout="constrained")
    axis = figure.subplots()
    for component, name in enumerate(COMPONENTS):
        if np.nanmax(np.abs(stress[:, component])) > 0:
            axis.plot(distance, stress[:, component] / 1e3, label=name)
    axis.set(xlabel="along the line [m]", ylabel="stress, tension positive [kPa]", title=f"{frame.time:.4g} s")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False)
    out = given.out or given.folder / "stress_along_line.png"
    figure.savefig(out, dpi=150)
    print(out)


if __name__ == "__main__":
    try:
        main()
    except (OSError, talus.FileError, talus.Missing) as error:
        sys.exit(f"stress_along_line.py: {error}")
