#!/usr/bin/python3
"""The terrain of scenes/landslide is the one that make_terrain.py writes."""
import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parent))
import make_terrain  # noqa: E402

SHIPPED = Path(__file__).resolve().parent.parent / "scenes/landslide"


class MakeTerrain(unittest.TestCase):
    def test_what_is_shipped_is_what_is_written(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            sys.argv = ["make_terrain.py", folder]
            make_terrain.main()
            for name in ("ground", "slip"):
                shipped, written = SHIPPED / f"{name}.asc", Path(folder) / f"{name}.asc"
                self.assertEqual(shipped.with_suffix(".prj").read_text(), written.with_suffix(".prj").read_text())
                self.assertEqual(shipped.read_text().splitlines()[:6], written.read_text().splitlines()[:6])
                numpy.testing.assert_allclose(numpy.loadtxt(shipped, skiprows=6), numpy.loadtxt(written, skiprows=6), atol=0.011)  # the last digit

    def test_the_slip_surface_is_a_bowl_below_an_open_slope(self):
        ground, slip = (numpy.loadtxt(SHIPPED / f"{name}.asc", skiprows=6)[::-1] for name in ("ground", "slip"))
        depth = ground - slip
        row, column = numpy.unravel_index(depth.argmax(), depth.shape)
        self.assertAlmostEqual(depth.max(), make_terrain.DEPTH, delta=0.1)
        self.assertAlmostEqual((column + 0.5) * make_terrain.CELL, make_terrain.CENTRE[0], delta=make_terrain.CELL)
        self.assertAlmostEqual((row + 0.5) * make_terrain.CELL, make_terrain.CENTRE[1], delta=make_terrain.CELL)
        fall = (ground[row, column - 5] - ground[row, column + 5]) / (10 * make_terrain.CELL)
        self.assertAlmostEqual(numpy.degrees(numpy.arctan(fall)), 35, delta=2)


if __name__ == "__main__":
    unittest.main()
