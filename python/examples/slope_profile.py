#!/usr/bin/python3
"""Surface of a slope before and after: the highest particle in each interval of x, and the distance of the debris.

Usage: slope_profile.py DIR [--stretch METRES] [--out FILE.png]      in 3-D the highest over the whole width
"""
import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # not needed where the module is installed
import talus  # noqa: E402


def surface(particles, edges):
    """Height y of the highest particle between neighbouring edges of x [m]; nan where there is none."""
    x, y = particles["position"][:, 0], particles["position"][:, 1]
    highest = np.full(len(edges) - 1, -np.inf)
    stretch = np.searchsorted(edges, x, "right") - 1
    np.maximum.at(highest, np.minimum(stretch, len(highest) - 1), y)
    return np.where(np.isfinite(highest), highest, np.nan)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--stretch", type=float, help="length of a stretch [m]; default a hundredth of all")
    options.add_argument("--out", type=Path)
    given = options.parse_args()
    series = talus.Run(given.folder).particles
    first, last = series[0], series[-1]
    x = np.concatenate([first["position"][:, 0], last["position"][:, 0]])
    edges = np.linspace(x.min(), x.max(), round(np.ptp(x) / given.stretch) + 1 if given.stretch else 101)
    middle = (edges[1:] + edges[:-1]) / 2
    moved = np.linalg.norm(talus.compare(first, last).difference("position"), axis=1)

    figure = Figure(figsize=(8, 3.5), layout="constrained")
    axis = figure.subplots()
    dots = axis.scatter(*last["position"][:, :2].T, c=np.linalg.norm(last["displacement"], axis=1) if "displacement" in last else "0.8", s=1, cmap="viridis")
    if "displacement" in last:
        figure.colorbar(dots, label="displacement [m]", shrink=0.6)
    axis.plot(middle, surface(first, edges), "k--", linewidth=1, label=f"{first.time:.3g} s")
    axis.plot(middle, surface(last, edges), "k-", linewidth=1.5, label=f"{last.time:.3g} s")
    axis.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axis.legend(frameon=False)
    out = given.out or given.folder / "profile.png"
    figure.savefig(out, dpi=150)
    print(f"{out}: the farthest particle moved {moved.max():.4g} m, the foremost stands at x = {last['position'][:, 0].max():.4g} m")


if __name__ == "__main__":
    try:
        main()
    except (OSError, talus.FileError, talus.Missing) as error:
        sys.exit(f"slope_profile.py: {error}")
