#!/usr/bin/python3
"""One slope, two kernels: where the particles of the two runs end up apart, matched by their ids.

Usage: two_kernels.py [--out FILE.png]
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
    "title": "A bank of clay gives way",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [10, 3.5], "cells": [40, 14]}},
    "materials": [{"name": "clay", "law": "drucker_prager", "density": 1900, "youngs_modulus": 2e6, "poisson_ratio": 0.3,
                   "friction_angle": 12, "cohesion": 2e3, "match": "plane_strain"}],
    "bodies": [{"name": "bank", "material": "clay", "shape": {"type": "polygon", "points": [[0, 0], [6, 0], [4, 3], [0, 3]]}}],
    "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
    "boundaries": [{"type": "fixed", "on": "y_min"}, {"type": "roller", "on": "x_min"}],
    "time": {"end": 1.5},
    "outputs": {"particles": {"every": 0.5, "fields": ["displacement"]}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="two_kernels.png")
    out = options.parse_args().out
    figure = Figure(figsize=(7.5, 7), layout="constrained")
    panels = figure.subplots(3, 1)
    with tempfile.TemporaryDirectory() as scratch:
        ends = []
        for axes, kernel in zip(panels, ("projected", "umls")):
            run = talus.run(SCENE, out=Path(scratch) / kernel, set={"kernel": kernel})
            run.plot("displacement", ax=axes, vmin=0, vmax=2.5)
            axes.set_title(f"kernel {kernel}")
            ends.append(run.particles[-1])
        both = talus.compare(*ends)
        apart = np.linalg.norm(both.difference("position"), axis=1)
        place = both.pair("position")[0]
        dots = panels[2].scatter(place[:, 0], place[:, 1], c=apart, s=6, cmap="magma_r")
        panels[2].set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title="distance of the same particle in the two runs")
        figure.colorbar(dots, ax=panels[2], label="m")
        for axes in panels:
            axes.set(xlim=(0, 9), ylim=(0, 3))
        figure.savefig(out, dpi=100)
        print(f"{out}: {np.median(apart):.3g} m in the median, {apart.max():.3g} m at most")


if __name__ == "__main__":
    main()
