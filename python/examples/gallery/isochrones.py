#!/usr/bin/python3
"""A layer of clay consolidates under a load: pore pressure over depth at several times, beside the series of Terzaghi.

Usage: isochrones.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

HEIGHT, LOAD, STIFFNESS, PERMEABILITY, WEIGHT = 1.0, 1e4, 1e7, 1e-3, 9810  # m, Pa, Pa, m/s, N/m^3
DIFFUSIVITY = PERMEABILITY * STIFFNESS / WEIGHT  # m^2/s: drained modulus in one dimension, Poisson's ratio 0
TIMES = (0.02, 0.05, 0.1, 0.2, 0.5)  # of H^2 / diffusivity
SCENE = {
    "title": "Layer of clay",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [0.2, HEIGHT], "cells": [4, 20]}},
    "materials": [{"name": "clay", "law": "linear_elastic", "density": 2000, "youngs_modulus": STIFFNESS, "poisson_ratio": 0}],
    "bodies": [{"name": "layer", "material": "clay", "region": "all", "particles_per_cell": 3}],
    "water": {"unit_weight": WEIGHT, "flow": {"bodies": [{"body": "layer", "porosity": 0.4, "permeability": PERMEABILITY}],
                                              "drained": ["y_max"]}},
    "loads": [{"type": "traction", "on": "y_max", "pressure": LOAD}],
    "boundaries": [{"type": "roller", "on": side} for side in ("x_min", "x_max", "y_min")],
    "time": {"end": 0.5 * HEIGHT**2 / DIFFUSIVITY},
    "outputs": {"particles": {"every": 0.01 * HEIGHT**2 / DIFFUSIVITY, "fields": ["pore_pressure"]}},
}


def terzaghi(depth, factor):
    odd = np.pi / 2 * (2 * np.arange(200)[:, None] + 1)
    return (2 / odd * np.sin(odd * depth) * np.exp(-(odd**2) * factor)).sum(0)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="isochrones.png")
    out = options.parse_args().out
    figure = Figure(figsize=(6, 5), layout="constrained")
    axes = figure.subplots()
    depth = np.linspace(0, 1, 200)
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "layer")
        for number, factor in enumerate(TIMES):
            frame = run.particles.at(factor * HEIGHT**2 / DIFFUSIVITY)
            axes.plot(frame["pore_pressure"] / LOAD, 1 - frame["position"][:, 1] / HEIGHT, ".", ms=3, color=f"C{number}", label=f"T = {factor}")
            axes.plot(terzaghi(depth, factor), depth, color="k", lw=0.8)
    axes.invert_yaxis()
    axes.set(xlabel="pore pressure over load", ylabel="depth over height", title="Particles, and the series of Terzaghi (lines)")
    axes.legend(frameon=False)
    figure.savefig(out, dpi=100)
    print(out)


if __name__ == "__main__":
    main()
