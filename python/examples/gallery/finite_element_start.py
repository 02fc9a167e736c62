#!/usr/bin/python3
"""A slope starts with the stress of a finite element analysis, then loses its strength: the table, the particles and the slide.

Usage: finite_element_start.py [--out FILE.png]
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

YOUNG, NU, DENSITY, G = 2e7, 0.3, 1900, 9.81


def elastic_slope(nx=30, ny=8):
    """Nodes, triangles and their stress xx, yy, zz, xy [Pa] under gravity: linear triangles, smooth sides, fixed base."""
    s, t = np.meshgrid(np.linspace(0, 15, nx + 1), np.linspace(0, 1, ny + 1), indexing="ij")
    x = np.stack([s, t * np.interp(s, [5, 9], [5, 2])], -1).reshape(-1, 2)
    corner = (np.arange(nx)[:, None] * (ny + 1) + np.arange(ny)).ravel()
    cells = np.concatenate([np.stack([corner, corner + ny + 1, corner + ny + 2], 1), np.stack([corner, corner + ny + 2, corner + 1], 1)])
    law = YOUNG / (1 + NU) / (1 - 2 * NU) * np.array([[1 - NU, NU, 0], [NU, 1 - NU, 0], [NU, NU, 0], [0, 0, 0.5 - NU]])  # xx, yy, zz, xy
    edges = np.roll(x[cells], -1, 1) - np.roll(x[cells], -2, 1)  # opposite to each corner
    area = 0.5 * (edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    slope = np.stack([-edges[..., 1], edges[..., 0]], -1) / (-2 * area[:, None, None])
    strain = np.zeros((len(cells), 3, 6))
    strain[:, 0, 0::2], strain[:, 1, 1::2] = slope[..., 0], slope[..., 1]
    strain[:, 2, 0::2], strain[:, 2, 1::2] = slope[..., 1], slope[..., 0]
    rows = (2 * cells[..., None] + [0, 1]).reshape(-1, 6)
    stiffness, force = np.zeros((x.size, x.size)), np.zeros(x.size)
    np.add.at(stiffness, (rows[:, :, None], rows[:, None]), area[:, None, None] * strain.transpose(0, 2, 1) @ law[[0, 1, 3]] @ strain)
    np.add.at(force, 2 * cells + 1, -DENSITY * G * area[:, None] / 3)
    free = np.setdiff1d(np.arange(x.size), np.concatenate([2 * np.flatnonzero(np.isin(x[:, 0], (0, 15))), 2 * np.flatnonzero(x[:, 1] == 0),
                                                           2 * np.flatnonzero(x[:, 1] == 0) + 1]))
    u = np.zeros(x.size)
    u[free] = np.linalg.solve(stiffness[np.ix_(free, free)], force[free])
    return x, cells, (law @ strain @ u[rows][..., None])[..., 0]


SCENE = {
    "title": "A slope from a finite element analysis",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [15, 6], "cells": [45, 18]}},
    "materials": [{"name": "clay", "law": "drucker_prager", "density": DENSITY, "youngs_modulus": YOUNG, "poisson_ratio": NU,
                   "friction_angle": 20, "cohesion": 2e4, "match": "plane_strain"}],
    "bodies": [{"name": "slope", "material": "clay",
                "shape": {"type": "polygon", "points": [[0, 0], [15, 0], [15, 2], [9, 2], [5, 5], [0, 5]]}}],
    "loads": [{"type": "gravity", "acceleration": [0, -G]}],
    "boundaries": [{"type": "fixed", "on": "y_min"}, {"type": "roller", "on": "x_min"}, {"type": "roller", "on": "x_max"}],
    "stages": [{"type": "geostatic", "duration": 10}, {"type": "run", "duration": 2, "weaken": [{"factor": 4}]}],
    "outputs": {"particles": {"every": 0.5, "fields": ["stress", "displacement"]}},
}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="finite_element_start.png")
    out = options.parse_args().out
    figure = Figure(figsize=(8, 9), layout="constrained")
    given, taken, slide = figure.subplots(3, 1)
    x, cells, stress = elastic_slope()
    with tempfile.TemporaryDirectory() as scratch:
        table = Path(scratch) / "state.csv"
        np.savetxt(table, np.hstack([x[cells].mean(1), stress]), delimiter=",", comments="", header="x,y,stress_xx,stress_yy,stress_zz,stress_xy")
        SCENE["bodies"][0]["initial"] = {"table": table}
        run = talus.run(SCENE, out=Path(scratch) / "slope")
        colours = given.tripcolor(x[:, 0], x[:, 1], cells, stress[:, 0] / 1e3, vmin=-40, vmax=0)
        figure.colorbar(colours, ax=given, label="stress xx [kPa]")
        first = run.particles[0]
        dots = taken.scatter(*first["position"][:, :2].T, c=first["stress"][:, 0] / 1e3, s=3, vmin=-40, vmax=0)
        figure.colorbar(dots, ax=taken, label="stress xx [kPa]")
        run.plot("displacement", ax=slide)
        begin, end = run.summary["stages"][0]["residual_at_begin"], run.summary["stages"][0]["residual"]
    for axes, title in ((given, "finite elements"), (taken, f"particles at the start: unbalanced force {begin:.2g} of the loads"),
                        (slide, "2 s after the strength has fallen to a quarter")):
        axes.set(aspect="equal", xlim=(0, 15), ylim=(0, 5.5), title=title)
    figure.savefig(out, dpi=100)
    print(f"{out}: unbalanced force {begin:.3g} of the loads, {end:.3g} at rest")


if __name__ == "__main__":
    main()
