#!/usr/bin/python3
"""Two blocks collide: where the energy goes over time, and where the metal has yielded.

Usage: energy_of_impact.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

METAL = {"law": "von_mises", "density": 8000, "youngs_modulus": 1e9, "poisson_ratio": 0.3, "yield_stress": 5e6}
SCENE = {
    "title": "Two blocks collide",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [4, 1.6], "cells": [64, 26]}},
    "materials": [{"name": "metal", **METAL}],
    "bodies": [
        {"name": "left", "material": "metal", "shape": {"type": "box", "low": [0.5, 0.3], "high": [1.7, 1.3]}, "particles_per_cell": 4,
         "velocity": [20, 0]},
        {"name": "right", "material": "metal", "shape": {"type": "sphere", "centre": [2.5, 0.8], "radius": 0.6}, "particles_per_cell": 4}],
    "time": {"end": 0.03},
    "outputs": {"history": {"every": 1e-4, "bodies": ["left", "right"]}, "particles": {"every": 0.03, "fields": ["plastic_strain"]}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="energy_of_impact.png")
    out = options.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "blocks")
        history = run.history
        figure = Figure(figsize=(12, 4), layout="constrained")
        energy, blocks = figure.subplots(1, 2)
        names = ("kinetic_left", "kinetic_right", "strain", "plastic", "transfer_loss")
        energy.stackplot(1e3 * history["time"], *(history[name] / 1e3 for name in names), labels=[name.replace("_", " ") for name in names],
                         alpha=0.8)
        energy.axhline(history["kinetic"][0] / 1e3, color="k", linestyle="--", linewidth=1, label="at the start")
        energy.set(xlabel="time [ms]", ylabel="energy [kJ]")
        energy.legend(loc="lower right", fontsize="small")
        run.plot("plastic_strain", ax=blocks, cmap="magma_r")
        figure.savefig(out, dpi=100)
        print(f"{out}: {100 * history['plastic'][-1] / history['kinetic'][0]:.3g} % of the energy became plastic work")


if __name__ == "__main__":
    main()
