#!/usr/bin/python3
"""Triaxial tests of a soil at several pressures, and cycles of simple shear along a path of one's own.

Usage: triaxial_tests.py [--out FILE.png]
"""
import argparse
import sys
from pathlib import Path

from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

SOIL = {"law": "mohr_coulomb", "density": 2000, "youngs_modulus": 2e7, "poisson_ratio": 0.3, "friction_angle": 30, "cohesion": 10e3}
PRESSURES = (50e3, 100e3, 200e3)  # Pa
RATE = 1e-3                       # 1/s


def shear(gamma, steps=60):
    """A part of a path that shears x over y by gamma at constant vertical stress."""
    return {"time": abs(gamma) / RATE, "steps": steps, "controls": {
        "xy": {"quantity": "velocity_gradient", "value": RATE if gamma > 0 else -RATE}, "yy": {"quantity": "stress", "value": -100e3}}}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="triaxial_tests.png")
    out = options.parse_args().out
    figure = Figure(figsize=(12, 4), layout="constrained")
    curves, paths, cycles = figure.subplots(1, 3)
    for pressure in PRESSURES:
        test = talus.drive(SOIL, test="triaxial_compression", pressure=pressure, strain=0.05, steps=200)
        curves.plot(100 * test["axial_strain"], test["stress_difference"] / 1e3, label=f"{pressure / 1e3:g} kPa")
        paths.plot(test["p"] / 1e3, test["q"] / 1e3)
        paths.plot(test["p"][-1] / 1e3, test["q"][-1] / 1e3, "ko", markersize=4)
    curves.set(xlabel="axial strain [%]", ylabel="stress difference [kPa]", title="triaxial compression")
    curves.legend(frameon=False)
    paths.set(xlabel="p [kPa]", ylabel="q [kPa]", title="stress paths", xlim=0, ylim=0)

    cyclic = talus.drive(SOIL, [shear(0.01), shear(-0.02, 120), shear(0.02, 120)], initial_stress=[-100e3, -100e3, -100e3, 0, 0, 0])
    cycles.plot(100 * cyclic.F[:, 0, 1], cyclic["stress_xy"] / 1e3)
    cycles.set(xlabel="shear strain [%]", ylabel="shear stress [kPa]", title="simple shear, 100 kPa")
    for axes in (curves, paths, cycles):
        axes.grid(alpha=0.3)
    figure.savefig(out, dpi=100)
    print(f"{out}: at 100 kPa the soil carries {cyclic['stress_xy'].max() / 1e3:.4g} kPa of shear")


if __name__ == "__main__":
    main()
