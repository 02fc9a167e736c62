"""Measures of what particle files hold that more than one case takes."""
import numpy as np


def checkerboard(frame):
    """Scatter of pressure within cells over the scatter of their means: 0 for a smooth pressure, large for a checkerboard."""
    cell, pressure = frame["cell"].astype(int), frame["pressure"]
    count = np.bincount(cell)
    mean = np.bincount(cell, pressure) / np.maximum(count, 1)
    return float(np.std(pressure - mean[cell]) / np.std(mean[count > 0]))


def extended(places, values, at, count=12):
    """Value `at` a place where no particle sits: a linear field fitted to the values at the `count` places nearest to it."""
    nearest = np.argsort(np.linalg.norm(places - at, axis=1))[:count]
    return np.linalg.lstsq(np.c_[np.ones(count), places[nearest] - at], values[nearest], rcond=None)[0][0]
