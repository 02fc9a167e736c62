#!/usr/bin/python3
"""How far does a column of sand run out?  One run for each angle of friction, by `set`, and a table of them.

Usage: friction_study.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

WIDTH, HEIGHT = 0.5, 0.8  # m
SCENE = {
    "title": "Column of sand",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [3, 1], "cells": [48, 16]}},
    "materials": [{"name": "sand", "law": "drucker_prager", "density": 1600, "youngs_modulus": 1e6, "poisson_ratio": 0.3,
                   "friction_angle": 30, "cohesion": 0, "match": "plane_strain"}],
    "bodies": [{"name": "column", "material": "sand", "shape": {"type": "box", "low": [0, 0], "high": [WIDTH, HEIGHT]},
                "particles_per_cell": 4}],
    "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
    "boundaries": [{"type": "friction", "on": "y_min", "coefficient": 0.5}, {"type": "roller", "on": "x_min"}],
    "time": {"end": 1.0},
    "outputs": {"history": {"every": 0.02, "fronts": [{"name": "toe", "direction": "+x"}]}},
}
ANGLES = (20, 25, 30, 35, 40)  # degrees


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="friction_study.png")
    out = options.parse_args().out
    figure = Figure(figsize=(10, 4), layout="constrained")
    over_time, over_angle = figure.subplots(1, 2)
    toes = []
    with tempfile.TemporaryDirectory() as scratch:
        for angle in ANGLES:
            run = talus.run(SCENE, out=Path(scratch) / f"angle_{angle}", set={
                "materials[0].friction_angle": angle, "boundaries[0].coefficient": round(np.tan(np.radians(angle)), 4)})
            run.history.plot("toe", ax=over_time, color=f"{0.8 - 0.02 * (angle - 10)}")
            toes.append(run.history["toe"][-1])
            print(f"{angle} degrees: toe at {toes[-1]:.4g} m")
    over_time.legend([f"{angle}°" for angle in ANGLES], frameon=False, title="friction")
    over_time.set_ylabel("toe [m]")
    over_angle.plot(ANGLES, (np.array(toes) - WIDTH) / WIDTH, "o-")
    over_angle.set(xlabel="angle of friction [°]", ylabel="run-out over the width of the column")
    over_angle.grid(alpha=0.3)
    figure.savefig(out, dpi=100)
    print(out)


if __name__ == "__main__":
    main()
