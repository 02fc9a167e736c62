#!/usr/bin/python3
"""A strip is pushed into clay in static equilibrium: load over settlement with two numbers of increments, and the work of the solver.

Usage: load_and_settlement.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

STRENGTH, HALF_WIDTH, SETTLEMENT = 1e5, 3.0, 0.075  # Pa, m, m
SCENE = {
    "title": "Strip on clay",
    "dimension": 2,
    "mesh": {"size": 1.0, "regions": [{"name": "clay", "shape": {"type": "box", "low": [0, 0], "high": [15, 8]}},
                                      {"name": "strip", "shape": {"type": "box", "low": [0, 8], "high": [HALF_WIDTH, 9]}},
                                      {"name": "air", "shape": {"type": "box", "low": [HALF_WIDTH, 8], "high": [15, 9]}}]},
    "materials": [{"name": "clay", "law": "von_mises", "density": 2000, "shear_modulus": 1e8, "bulk_modulus": 2e8,
                   "yield_stress": np.sqrt(3) * STRENGTH}],
    "bodies": [{"name": "clay", "material": "clay", "region": "clay", "particles_per_cell": 4, "f_bar": True}],
    "boundaries": [{"type": "velocity", "on": "strip", "velocity": [0, -SETTLEMENT]}, {"type": "roller", "on": "x_min"},
                   {"type": "roller", "on": "x_max"}, {"type": "fixed", "on": "y_min"}],
    "stages": [{"type": "quasi_static", "duration": 1, "increments": 10}],
    "outputs": {"particles": {"every": 1}, "history": {"every": 0.001}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="load_and_settlement.png")
    out = options.parse_args().out
    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    with tempfile.TemporaryDirectory() as scratch:
        for increments in (10, 20):
            run = talus.run(SCENE, set={"stages[0].increments": increments}, out=Path(scratch) / f"strip_{increments}")
            rows = run.history
            load = np.abs(rows["reaction_strip_y"]) / (STRENGTH * HALF_WIDTH)
            left.plot(1000 * SETTLEMENT * rows["time"], load, ".-", label=f"{increments} increments")
            right.plot(1000 * SETTLEMENT * rows["time"], rows["newton_iterations"], ".-")
    left.axhline(2 + np.pi, color="k", lw=0.8, label=r"Prandtl, 2 + $\pi$")
    left.set(xlabel="settlement [mm]", ylabel="load over strength and width")
    left.legend(frameon=False)
    right.set(xlabel="settlement [mm]", ylabel="iterations of Newton's method")
    figure.savefig(out, dpi=100)
    print(out)


if __name__ == "__main__":
    main()
