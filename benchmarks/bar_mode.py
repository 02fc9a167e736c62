"""The first axial mode of a bar that is fixed at one end: exact for a stress linear in F, at any amplitude."""
import numpy as np

import lab as tools

POINTS = [f"p{i}" for i in range(1, 10)] + ["tip"]


def displacement_error(history, data, speed):
    """Root mean square over ten points and all times of the error in displacement, relative to the amplitude at the tip.

    u = v0/omega sin(omega t) sin(pi X / 2L), omega = pi/(2L) sqrt(E/rho); X is the place of the followed particle at the start.
    """
    wave = np.pi / (2 * data["length [m]"])
    omega = wave * np.sqrt(data["modulus [Pa]"] / data["density [kg/m^3]"])
    exact = np.array([np.sin(wave * history[f"{p}_x"][0]) * np.sin(omega * history["time"]) for p in POINTS])
    measured = np.array([history[f"{p}_ux"] for p in POINTS]) * omega / speed
    return tools.rms(measured - exact)
