#!/usr/bin/python3
"""Writes the made-up valley of scenes/landslide: ground.asc, slip.asc (ESRI ASCII grids) and their .prj.

Usage: make_terrain.py FOLDER

An open slope of 35 degrees that gathers into a channel, which bends and ends on a flat fan; on the slope a bowl-shaped slip surface, 15 m deep at
most.  No such place exists: the coordinates are those of any valley in UTM zone 33N, WGS 84.
"""
import argparse
from pathlib import Path

import numpy

COLUMNS, ROWS, CELL = 120, 80, 6.0    # 720 m by 480 m
WEST, SOUTH = 512000.0, 5180000.0     # m, on the map
CROWN = 1042.0                        # m, elevation of the western edge

# The failure mass: a paraboloid below the slope over an ellipse of the plan
CENTRE, HALF_LENGTH, HALF_WIDTH, DEPTH = (140.0, 290.0), 78.0, 56.0, 15.0
ABOVE = 6.0                           # m: outside of the bowl the slip surface is so far above the ground at most

UTM_33N = ('PROJCS["WGS_1984_UTM_Zone_33N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
           'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],'
           'PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",15.0],PARAMETER["Scale_Factor",0.9996],'
           'PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]\n')


def step(x, low, high):
    """From 0 at low to 1 at high, with level ends."""
    t = numpy.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def fall(x):
    """Elevation along the valley below the crown: 35 degrees, then 14 in the channel, then 3 on the fan."""
    fine = numpy.linspace(0, COLUMNS * CELL, 20 * COLUMNS + 1)
    slope = numpy.radians(35 - 21 * step(fine, 230, 350) - 11 * step(fine, 430, 540))
    gradient = numpy.tan(slope)
    depth = numpy.concatenate([[0], numpy.cumsum(0.5 * (gradient[1:] + gradient[:-1]) * numpy.diff(fine))])
    return numpy.interp(x, fine, depth)


def axis(x):
    """Where the channel runs: straight down, then a bend to the south, then straight again."""
    return CENTRE[1] - 85 * step(x, 260, 480)


def ground(x, y):
    across = y - axis(x)
    gathers = step(x, 150, 310) * (1 - step(x, 430, 560))
    bowl = 5 * step(x, 0, 160) * (1 - step(x, 150, 330))                    # the slope itself is a little hollow
    sides = 26 * gathers * (1 - numpy.exp(-(across / 55)**2)) + bowl * (1 - numpy.exp(-(across / 110)**2))
    fan = step(x, 470, 600) * 0.05 * (numpy.sqrt(across**2 + 40**2) - 40)   # a flat cone: lower away from its axis
    rough = 0.35 * (numpy.sin(x / 17 + 0.4 * numpy.sin(y / 23)) * numpy.sin(y / 19 + 1) + 0.5 * numpy.sin(x / 7.3 + y / 11.9))
    return CROWN - fall(x) + sides - fan + rough


def slip(x, y):
    from_centre = ((x - CENTRE[0]) / HALF_LENGTH)**2 + ((y - CENTRE[1]) / HALF_WIDTH)**2
    return ground(x, y) - numpy.maximum(DEPTH * (1 - from_centre), -ABOVE)


def write(path, values):
    rows = "\n".join(" ".join(f"{value:.2f}" for value in row) for row in values[::-1])   # the first row is the northernmost
    path.write_text(f"ncols {COLUMNS}\nnrows {ROWS}\nxllcorner {WEST:.0f}\nyllcorner {SOUTH:.0f}\ncellsize {CELL:g}\nNODATA_value -9999\n{rows}\n")
    path.with_suffix(".prj").write_text(UTM_33N)


def main():
    parser = argparse.ArgumentParser(description="Writes the made-up valley of scenes/landslide.")
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    x, y = numpy.meshgrid((numpy.arange(COLUMNS) + 0.5) * CELL, (numpy.arange(ROWS) + 0.5) * CELL)
    write(folder / "ground.asc", ground(x, y))
    write(folder / "slip.asc", slip(x, y))
    depth = numpy.maximum(ground(x, y) - slip(x, y), 0)
    print(f"{folder}: ground {ground(x, y).min():.0f} to {ground(x, y).max():.0f} m, slip surface up to {depth.max():.1f} m deep, "
          f"{depth.sum() * CELL**2:.0f} m3 over {(depth > 0).sum() * CELL**2:.0f} m2")


if __name__ == "__main__":
    main()
