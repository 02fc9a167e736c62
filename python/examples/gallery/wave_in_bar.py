#!/usr/bin/python3
"""A bar hits a wall: velocity of its particles over place and time, beside the paths of the elastic wave.

Usage: wave_in_bar.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

LENGTH, SPEED = 1.0, 0.1  # m, m/s
MODULUS, DENSITY = 1e6, 1000.0  # Poisson's ratio 0: the wave speed is sqrt(E / rho)
WAVE = np.sqrt(MODULUS / DENSITY)
SCENE = {
    "title": "A bar hits a wall",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [1.2, 0.05], "cells": [96, 4]}},
    "materials": [{"name": "rubber", "law": "neo_hookean", "density": DENSITY, "youngs_modulus": MODULUS, "poisson_ratio": 0}],
    "bodies": [{"name": "bar", "material": "rubber", "shape": {"type": "box", "low": [0, 0], "high": [LENGTH, 0.05]},
                "particles_per_cell": 4, "velocity": [-SPEED, 0]}],
    "boundaries": [{"type": "roller", "on": side} for side in ("x_min", "y_min", "y_max")],
    "time": {"end": 2 * LENGTH / WAVE},
    "outputs": {"particles": {"every": LENGTH / WAVE / 50, "fields": ["velocity", "displacement"]}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="wave_in_bar.png")
    out = options.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, out=Path(scratch) / "bar")
        frames = run.particles
        edges = np.linspace(0, LENGTH, 81)
        mean = []  # velocity in each interval of the bar, for each file
        for frame in frames:
            both = talus.compare(frames[0], frame)  # the same particles, by their ids
            start, velocity = both.pair("position")[0][:, 0], both.pair("velocity")[1][:, 0]
            mean.append(np.histogram(start, edges, weights=velocity)[0] / np.histogram(start, edges)[0])
        times = frames.times

    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots()
    shown = axes.pcolormesh((edges[1:] + edges[:-1]) / 2, 1e3 * times, mean, cmap="coolwarm", vmin=-1.2 * SPEED, vmax=1.2 * SPEED)
    axes.plot([0, LENGTH, 0], [0, 1e3 * LENGTH / WAVE, 2e3 * LENGTH / WAVE], "k--", linewidth=1, label=f"wave of {WAVE:.3g} m/s")
    axes.set(xlabel="place in the bar at the start [m]", ylabel="time [ms]")
    axes.legend(loc="lower right")
    figure.colorbar(shown, label="velocity along the bar [m/s]")
    figure.savefig(out, dpi=100)
    print(f"{out}: {len(times)} files; after {1e3 * times[-1]:.3g} ms the bar leaves with {mean[-1].mean():.3g} m/s")


if __name__ == "__main__":
    main()
