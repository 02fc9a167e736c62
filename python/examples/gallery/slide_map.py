#!/usr/bin/python3
"""A slide in three dimensions: the map of its largest thickness, the rim of the deposit and the section along its axis.

Usage: slide_map.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

SCENE = {
    "title": "A heap spreads on an inclined plane",
    "dimension": 3,
    "mesh": {"grid": {"low": [0, 0, 0], "high": [8, 4, 1.5], "cells": [32, 16, 6]}},
    "materials": [{"name": "debris", "law": "drucker_prager", "density": 1800, "youngs_modulus": 5e5, "poisson_ratio": 0.3,
                   "friction_angle": 25, "cohesion": 0, "match": "outer"}],
    "bodies": [{"name": "heap", "material": "debris", "shape": {"type": "box", "low": [0.5, 1.25, 0], "high": [2.5, 2.75, 1.2]},
                "particles_per_cell": 4}],
    "loads": [{"type": "gravity", "acceleration": [4.1, 0, -8.9]}],  # a plane inclined by 25 degrees
    "boundaries": [{"type": "friction", "on": "z_min", "coefficient": 0.45}, {"type": "roller", "on": "x_min"}],
    "time": {"end": 0.9},
    "on_exit": "delete",
    "outputs": {"runout": {"every": 0.1, "moved": 0.1, "sections": [{"name": "axis", "along": [[0, 2], [8, 2]]}]},
                "particles": {"every": 0.9, "fields": ["velocity"]}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="slide_map.png")
    out = options.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "slide")
        figure = Figure(figsize=(9, 8), layout="constrained")
        plan, along, view = figure.subplots(3, 1, height_ratios=[3, 2, 2])
        run.maps["thickness_max"].plot(ax=plan, cmap="YlOrBr")
        deposit = run.maps["thickness"]
        plan.contour(deposit.x, deposit.y, np.nan_to_num(deposit.values), levels=[0.05], colors="k")
        plan.set_title("largest thickness, and rim of the deposit")
        section = run.section("axis")
        along.plot(section["distance"], section["ground"], "k--", label="at the start")
        along.fill_between(section["distance"], section["surface"], alpha=0.6, label="at the end")
        along.set(xlabel="along the axis [m]", ylabel="z [m]")
        along.legend(frameon=False)
        run.plot("velocity", ax=view, plane="xz")
        figure.savefig(out, dpi=100)
        print(f"{out}: H/L = {run.runout['H/L'][-1]:.3g}, {run.runout['area'][-1]:.3g} m^2 reached")


if __name__ == "__main__":
    main()
