#!/usr/bin/python3
"""A checkpoint as arrays: pressure, plastic strain and speed of a falling column, and its kinetic energy by layers.

Usage: checkpoint_arrays.py [--out FILE.png]
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
    "title": "Column of sand",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [2.5, 1], "cells": [50, 20]}},
    "materials": [{"name": "sand", "law": "drucker_prager", "density": 1600, "youngs_modulus": 1e6, "poisson_ratio": 0.3,
                   "friction_angle": 32, "cohesion": 0, "match": "plane_strain"}],
    "bodies": [{"name": "column", "material": "sand", "shape": {"type": "box", "low": [0, 0], "high": [0.6, 0.8]}}],
    "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
    "boundaries": [{"type": "friction", "on": "y_min", "coefficient": 0.5}, {"type": "roller", "on": "x_min"}],
    "time": {"end": 0.3},
    "outputs": {"checkpoint": {"at_end": True}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="checkpoint_arrays.png")
    out = options.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "column")
        with run.checkpoints[-1] as state:
            column, time = state.particles("column"), state.time
            units = {name: state.units[f"particles/{name}"] for name in ("velocity", "mass", "stress")}
    place, mass, speed = column["position"], column["mass"], np.linalg.norm(column["velocity"], axis=1)
    mean = talus.tensors(column["stress"]).trace(axis1=1, axis2=2) / 3  # Pa, tension is positive
    figure = Figure(figsize=(10, 6), layout="constrained")
    views = figure.subplots(2, 2)
    for axes, values, title in zip(views[0], (-mean / 1e3, column["plastic_strain"]), ("mean pressure [kPa]", "plastic strain [-]")):
        dots = axes.scatter(place[:, 0], place[:, 1], c=values, s=4, vmax=np.quantile(values, 0.98))
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=f"{title} after {time:.3g} s")
        figure.colorbar(dots, ax=axes)
    views[1, 0].hist(speed, bins=40, weights=mass)
    views[1, 0].set(xlabel=f"speed [{units['velocity']}]", ylabel=f"mass [{units['mass']}]")
    level = np.linspace(place[:, 1].min(), place[:, 1].max(), 15)
    layer = np.digitize(place[:, 1], level[1:-1])
    energy = np.bincount(layer, 0.5 * mass * speed**2, len(level) - 1)
    views[1, 1].barh((level[1:] + level[:-1]) / 2, energy, 0.9 * (level[1] - level[0]))
    views[1, 1].set(xlabel="kinetic energy of a layer [J]", ylabel="y [m]")
    figure.savefig(out, dpi=100)
    print(f"{out}: kinetic energy {energy.sum():.4g} J of {mass.sum():.4g} kg")


if __name__ == "__main__":
    main()
