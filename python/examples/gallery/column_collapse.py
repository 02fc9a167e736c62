#!/usr/bin/python3
"""A column of sand collapses: the scene is a dictionary, and pictures of four times share one colour scale.

Usage: column_collapse.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

SCENE = {
    "title": "Column of sand",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [3.2, 1.2], "cells": [48, 18]}},
    "materials": [{"name": "sand", "law": "drucker_prager", "density": 1600, "youngs_modulus": 1e6, "poisson_ratio": 0.3,
                   "friction_angle": 30, "cohesion": 0, "match": "plane_strain"}],
    "bodies": [{"name": "column", "material": "sand", "shape": {"type": "box", "low": [0, 0], "high": [0.8, 1]}, "particles_per_cell": 4}],
    "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
    "boundaries": [{"type": "friction", "on": "y_min", "coefficient": 0.58}, {"type": "roller", "on": "x_min"}],
    "time": {"end": 1.0},
    "outputs": {"particles": {"every": 0.05, "fields": ["displacement"]}, "history": {"every": 0.01}},
}
TIMES = (0, 0.25, 0.5, 1.0)  # s


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="column_collapse.png")
    out = options.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "column")
        figure = Figure(figsize=(10, 5), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True, sharey=True)
        for time, axes in zip(TIMES, panels.flat):
            run.plot("displacement", time, ax=axes, vmin=0, vmax=1, colorbar=False)
            axes.label_outer()
        figure.colorbar(panels[0, 0].collections[0], ax=panels, label="displacement [m]")
        figure.savefig(out, dpi=100)
        print(f"{out}: {run.summary['steps']} steps, the farthest particle is at x = {run.particles[-1]['position'][:, 0].max():.3g} m")


if __name__ == "__main__":
    main()
