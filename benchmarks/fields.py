"""Measures of fields in particle files that several cases use."""
import numpy as np


def checkerboard(frame):
    """Scatter of pressure within cells over the scatter of their means: 0 for a smooth pressure, large for a checkerboard."""
    cell, pressure = frame["cell"].astype(int), frame["pressure"]
    count = np.bincount(cell)
    mean = np.bincount(cell, pressure) / np.maximum(count, 1)
    return float(np.std(pressure - mean[cell]) / np.std(mean[count > 0]))


def extended(places, values, at, count=12):
    """The value at a position without a particle: a linear field fitted to the values at the `count` nearest positions."""
    nearest = np.argsort(np.linalg.norm(places - at, axis=1))[:count]
    return np.linalg.lstsq(np.c_[np.ones(count), places[nearest] - at], values[nearest], rcond=None)[0][0]
