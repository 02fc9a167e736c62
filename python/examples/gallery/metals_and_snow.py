#!/usr/bin/python3
"""Strength of copper over rate by two laws, metal with voids that is torn at three triaxialities, snow with cohesion that is crushed and torn.

Usage: metals_and_snow.py [--out FILE.png]
"""
import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # not needed where the package is installed
import talus  # noqa: E402

# Annealed copper: docs/reference/materials.md.
THRESHOLD = {
    "law": "mechanical_threshold", "density": 8960, "bulk_modulus": 129e9, "shear_modulus": 46e9, "athermal_stress": 40e6, "shear_at_zero_kelvin": 45.78e9,
    "shear_loss": 3e9, "shear_temperature": 180, "boltzmann_over_burgers_cubed": 0.823e6, "activation_energy": 1.6, "activation_rate": 1e7,
    "activation_p": 2 / 3, "activation_q": 1, "hardening_modulus": 2.39e9, "hardening_by_log_rate": 12e6, "hardening_by_root_rate": 1.696e6, "hardening_shape": 2,
    "saturation_stress": 770e6, "saturation_energy": 0.2625, "saturation_rate": 1e7, "specific_heat": 385, "heat_fraction": 0.9}
JOHNSON_COOK = {
    "law": "johnson_cook", "density": 8960, "bulk_modulus": 129e9, "shear_modulus": 46e9, "yield_stress": 90e6, "hardening_coefficient": 292e6,
    "hardening_exponent": 0.31, "rate_coefficient": 0.025, "thermal_exponent": 1.09, "room_temperature": 298, "melting_temperature": 1356, "specific_heat": 385}
POROUS = {
    "law": "porous_ductile", "density": 7800, "youngs_modulus": 200e9, "poisson_ratio": 0.3, "yield_stress": 400e6, "hardening_coefficient": 500e6,
    "hardening_exponent": 0.5, "initial_porosity": 0.002, "nucleation": {"porosity": 0.04, "mean_strain": 0.3, "deviation": 0.1},
    "coalescence": {"porosity": 0.15, "failure_porosity": 0.25}}
SNOW = {"law": "cohesive_cam_clay", "density": 250, "youngs_modulus": 3e6, "poisson_ratio": 0.3, "critical_state_slope": 1.0, "preconsolidation_pressure": 20e3,
        "hardening_factor": 5}
RATES = np.logspace(-3, 5, 9)  # 1/s


def strength(law, rate, temperature):
    """The stress sqrt(3 J2) [Pa] at a shear of 0.2, of metal that its flow heats."""
    return talus.drive(law | {"initial_temperature": temperature}, test="simple_shear", strain=0.2, rate=rate, steps=400)["q"][-1]


def part(rates, time, steps):
    """A part of a path with these rates of strain along x, y, z [1/s]."""
    return {"time": time, "steps": steps, "controls": {axes: {"quantity": "strain_rate", "value": rate} for axes, rate in zip(("xx", "yy", "zz"), rates)}}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default="metals_and_snow.png")
    out = options.parse_args().out
    figure = Figure(figsize=(12, 4), layout="constrained")
    copper, steel, snow = figure.subplots(1, 3)
    for temperature, colour in ((298, "C0"), (718, "C3")):
        for law, line in ((THRESHOLD, "-"), (JOHNSON_COOK, "--")):
            copper.semilogx(RATES, [strength(law, rate, temperature) / 1e6 for rate in RATES], colour + line, label=f"{law['law']}, {temperature} K")
    copper.set(xlabel="rate of shear [1/s]", ylabel="sqrt(3 J2) at a shear of 0.2 [MPa]", title="copper", ylim=0)

    failed = []
    for share, colour in ((0.4, "C0"), (0.3, "C1"), (0.2, "C2")):
        test = talus.drive(POROUS, [part((1.0, -share, -share), 1.2, 4000)])
        stretch = test.F[:, 0, 0] - 1
        steel.plot(stretch, test["q"] / 1e6, colour, label=f"contracts by {share} across")
        porosity = POROUS["initial_porosity"] + test["porosity_gain"]
        steel.plot(stretch, 4000 * np.minimum(porosity, 0.25), colour + ":")
        failed += list(stretch[porosity >= 0.25][:1])
    steel.set(xlabel="extension", ylabel="sqrt(3 J2) [MPa], porosity [1/4000] dotted", title="metal with voids, torn", xlim=(0, 0.8), ylim=0)

    for beta in (0, 0.2, 0.5):
        test = talus.drive(SNOW | {"cohesion_ratio": beta}, [part((-1.0, -1.0, -1.0), 0.03, 600), part((1.0, 1.0, 1.0), 0.06, 1200)])
        snow.plot(100 * (1 - np.linalg.det(test.F)), test["p"] / 1e3, label=f"beta = {beta}")
    snow.set(xlabel="compaction [%]", ylabel="p [kPa]", title="snow, crushed and pulled apart")
    for axes in (copper, steel, snow):
        axes.legend(frameon=False, fontsize=8)
        axes.grid(alpha=0.3)
    figure.savefig(out, dpi=100)
    print(f"{out}: where it contracts least, the metal fails at extensions of {', '.join(f'{one:.2g}' for one in failed)}")


if __name__ == "__main__":
    main()
