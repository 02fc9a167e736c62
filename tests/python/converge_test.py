#!/usr/bin/python3
"""Tests of talus.converge and of the command talus converge: orders that are known exactly, levels of a scene, what is said of their numbers,
and scenes that are refused.

Usage: converge_test.py PROGRAM, the built talus.
"""
import math
import os
import signal
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.convergence.levels import scaled_mesh  # noqa: E402
from talus.convergence.richardson import FORMAL_ORDER, extrapolate  # noqa: E402
from scratch import InAFolder  # noqa: E402

HALVES = [0.4, 0.2, 0.1]
GRID = "grid: {low: [0, 0], high: [30, 1], cells: [30, 1]}"


def bar(mesh=GRID, more=""):
    """A bar of 25 m that swings in its first mode from rest length: after a quarter of its period of 10 s all of its energy is strain energy,
    1/2 * 1 kg/m^2 * (0.1 m/s)^2 * 25 m / 2 = 0.0625 J."""
    return (f"title: Bar\ndimension: 2\nmesh: {{{mesh}}}\ntime: {{end: 2.5, cfl: 0.4}}\n"
            "materials: [{name: rubber, law: linear_first_piola, density: 1, youngs_modulus: 100, poisson_ratio: 0}]\n"
            "bodies: [{name: bar, material: rubber, shape: {type: box, low: [0, 0], high: [25, 1]}, particles_per_cell: 6, velocity: "
            '["0.1 * sin(pi * x / 50)", "0"]}]\n'
            "boundaries: [{type: fixed, on: x_min}, {type: roller, on: y_min}, {type: roller, on: y_max}]\n"
            f"outputs: {{history: {{every: 0.1, fronts: [{{name: toe, direction: +x}}]}}}}\n{more}")


class Richardson(unittest.TestCase):
    @staticmethod
    def powers(limit, factor, order, sizes):
        return [limit + factor * size**order for size in sizes]

    def test_finds_order_and_limit_of_a_power_also_where_ratios_differ(self):
        of_other_ratios = [0.35, 0.2, 0.15], [0.4, 0.3, 0.1], [1.0, 0.2, 0.15]  # for the last the fixed-point iteration of the paper fails
        for order, sizes in [*((order, HALVES) for order in (0.6, 1, 1.5, 2, 2.9)),
                             *((order, sizes) for order in (0.6, 1, 2) for sizes in of_other_ratios)]:
            with self.subTest(order=order, sizes=sizes):
                found = extrapolate(sizes, self.powers(7, -3, order, sizes), 1e-12)
                self.assertEqual((found.verdict, found.trend), ("converges", "rises"))
                self.assertAlmostEqual(found.order, order, delta=1e-9)
                self.assertAlmostEqual(found.extrapolated, 7, delta=1e-9)
                if order <= FORMAL_ORDER:
                    self.assertAlmostEqual(found.uncertainty, 1.25 * 3 * sizes[-1]**order, delta=1e-9, msg="1.25 times the error")

    def test_gives_the_numbers_of_the_example_of_celik(self):
        """Celik et al. 2008, table 1, first column: N = 18000, 8000, 4500 cells, r21 = 1.5, r32 = 1.333; reattachment length."""
        found = extrapolate([1.5 * 1.333, 1.5, 1], [5.863, 5.972, 6.063], 1e-12)
        self.assertEqual(found.verdict, "converges")
        self.assertAlmostEqual(found.order, 1.53, delta=0.01)
        self.assertAlmostEqual(found.extrapolated, 6.1685, delta=0.001)
        self.assertAlmostEqual(found.uncertainty / 6.063, 0.022, delta=0.0005)

    def test_a_high_order_does_not_make_the_uncertainty_small(self):
        found = extrapolate(HALVES, self.powers(1, 1, 2.9, HALVES), 1e-12)
        self.assertEqual(found.trend, "falls")
        self.assertAlmostEqual(found.uncertainty, 1.25 * (0.2**2.9 - 0.1**2.9) / 3, delta=1e-12)

    def test_names_what_does_not_converge_and_extrapolates_nothing(self):
        four = [0.8, 0.4, 0.2, 0.1]
        turned = self.powers(1, 1, 2, four)
        turned[0] = turned[1] - 0.1  # the first change has the other sign
        for verdict, sizes, values in (
                ("oscillates", HALVES, [1, 3, 2]), ("osc. grows", HALVES, [1, 2, 0]), ("osc. grows", HALVES, [1, 2, 1]),
                ("diverges", HALVES, [1, 2, 4]), ("diverges", HALVES, [1, 2, 3]), ("diverges", HALVES, [1, 1, 3]),
                ("diverges", [0.4, 0.2, 0.19], [0, 1, 1.5]),  # the last change is the smaller one, but the sizes change by even less
                ("order<0.5", HALVES, self.powers(1, 1, 0.4, HALVES)), ("order>3", HALVES, self.powers(1, 1, 3.5, HALVES)),
                ("order>3", HALVES, [1, 0, -1e-9]), ("undecided", HALVES, [1, 2, 2]), ("undecided", four, [1, 2, 2, 2]),
                ("unsteady", four, turned), ("no value", HALVES, [1, math.nan, 2])):
            with self.subTest(sizes=sizes, values=values):
                found = extrapolate(sizes, values, 0)
                self.assertEqual((found.verdict, found.extrapolated, found.uncertainty), (verdict, None, None))
        self.assertEqual(extrapolate(HALVES, [1, 3, 2], 0).trend, "turns")
        self.assertAlmostEqual(extrapolate(HALVES, self.powers(1, 1, 0.4, HALVES), 0).order, 0.4, 9, "but told")
        self.assertEqual(extrapolate(HALVES, [1, 0, -1e-9], 0).order, math.inf)
        self.assertEqual(extrapolate(four, self.powers(1, 1, 2, four), 1e-12).verdict, "converges")

    def test_a_larger_last_change_converges_where_sizes_change_by_more(self):
        self.assertAlmostEqual(extrapolate([0.5, 0.4, 0.1], [0.5, 0.4, 0.1], 0).extrapolated, 0, delta=1e-9)

    def test_no_change_is_constant(self):
        found = extrapolate(HALVES, [5, 5 + 1e-12, 5], 1e-9)
        self.assertEqual((found.verdict, found.trend, found.extrapolated), ("constant", "stays", 5))
        self.assertAlmostEqual(found.uncertainty, 1e-12, delta=1e-15)


class ScaledMesh(unittest.TestCase):
    def test_has_every_key_with_a_size(self):
        self.assertEqual(scaled_mesh({"grid": {"cells": [10, 5]}}, 0.5), ["mesh.grid.cells=[20, 10]"])
        self.assertEqual(scaled_mesh({"size": 0.3, "refine": [{"size": 0.1}, {"size": 0.02}]}, 2),
                         ["mesh.size=0.6", "mesh.refine[0].size=0.2", "mesh.refine[1].size=0.04"])
        terrain = {"layers": [{}, {"size": 6}], "air": {"size": 10}, "refine": [{"size": 4}]}
        self.assertEqual(scaled_mesh({"size": 12, "terrain": terrain}, 0.5),
                         ["mesh.size=6", "mesh.terrain.layers[1].size=3", "mesh.terrain.air.size=5", "mesh.terrain.refine[0].size=2"])


class OfABar(InAFolder):
    def setUp(self):
        super().setUp()
        self.write("bar.yaml", bar())

    def converge(self, *words):
        """The command: exit code, output, complaints."""
        told = subprocess.run([self.program, "converge", "bar.yaml", "--out", "out", "--threads", "1", *words], capture_output=True,
                              encoding="utf-8", check=False)
        return told.returncode, told.stdout, told.stderr

    def assert_refused(self, *texts, words=()):
        code, _, complaint = self.converge(*words)
        self.assertEqual(code, 2)
        for text in texts:
            self.assertIn(text, complaint)
        self.assertFalse(Path("out").exists())

    def test_finds_the_energy_of_a_bar_and_its_order(self):
        doubled = "--ratio", "2", "--finer", "2"
        code, out, complaint = self.converge(*doubled, "--jobs", "2")
        self.assertEqual(code, 0, complaint)
        for text in ("cells_x0.25: begins (mesh.grid.cells=[120, 4])", "cells_x1: done after", "strain [J]"):
            self.assertIn(text, out)
        lines = out[out.index("cells of"):out.index("table in")].splitlines()
        self.assertLessEqual(max(map(len, lines)), 100)
        study = talus.Convergence("out")
        self.assertTrue(study.table.path.read_text(encoding="utf-8").startswith(
            "quantity,unit,cell_size_1 [m],cell_size_2 [m],cell_size_3 [m],value_1,value_2,value_3,trend,order,extrapolated,uncertainty,"
            "verdict\n"))
        sizes = [level["cell_size [m]"] for level in study.contents["levels"]]
        self.assertAlmostEqual(sizes[0], 4 * sizes[2], 12)
        strain = study.number("strain")
        self.assertEqual((strain["unit"], strain["trend"], strain["verdict"]), ("J", "falls", "converges"))
        self.assertAlmostEqual(strain["order"], 2, delta=0.1, msg="the order of the method")
        self.assertAlmostEqual(strain["values"][2], 0.0625, delta=strain["uncertainty"], msg="the true value is within the uncertainty")
        self.assertAlmostEqual(strain["extrapolated"], 0.0625, delta=2e-6, msg="nearer than the finest value, 1e-5")
        self.assertEqual(study.number("mass")["verdict"], "constant")
        self.assertEqual(study.level(0.25).summary["scene"]["set"], ["mesh.grid.cells=[120, 4]"])
        with self.assertRaisesRegex(talus.Missing, "did you mean strain"):
            study.number("straim")

        code, out, complaint = self.converge(*doubled, "--collect", "strain", "--within", "1")
        self.assertEqual(code, 0, complaint)
        self.assertNotIn("begins", out, "what is done is kept")
        code, _, complaint = self.converge(*doubled, "--collect", "strain,max(kinetic)", "--within", "1e-9", "--quiet")
        self.assertEqual(code, 1)
        self.assertIn("error: not within 1e-07 %: strain: ", complaint)
        code, out, complaint = self.converge(*doubled, "--json")
        self.assertEqual((code, out), (0, Path("out/convergence.json").read_text(encoding="utf-8")), complaint)
        code, _, complaint = self.converge(*doubled, "--collect", "straim,toe,nothing_like_it")
        self.assertEqual(code, 2)
        self.assertIn('no level has a number "straim" — did you mean "strain"?', complaint)
        self.assertIn('"nothing_like_it"', complaint)

    def test_from_python_and_warns_where_numbers_do_not_converge(self):
        """Too few cells for a period: the velocity at the end of three very coarse bars."""
        told, warned = [], []
        changes = {"mesh.grid.cells": [3, 1], "time.end": 7}
        study = talus.converge("bar.yaml", set=changes, out="out", ratio=2, finer=2, jobs=2, threads=1, tell=told.append, warn=warned.append)
        self.assertIn("table in out/convergence.csv", told[-1])
        self.assertIn("do NOT CONVERGE at these sizes", warned[0])
        self.assertEqual(study.contents["warnings"], warned)
        with self.assertRaisesRegex(talus.RunFailed, "not within 5 %: strain: "):
            talus.converge("bar.yaml", set=changes, out="out", ratio=2, finer=2, threads=1, collect="strain", within=0.05)
        with self.assertRaisesRegex(talus.SceneError, r"ratio 1 must be in \[1.2, 4\]\nerror: levels 9 must be in \[3, 8\]"):
            talus.converge("bar.yaml", ratio=1, levels=9)
        code, _, complaint = self.converge("--ratio", "2", "--finer", "2", "--set", "mesh.grid.cells=[3, 1]", "--set", "time.end=7")
        self.assertEqual(code, 0, complaint)
        self.assertIn("smaller cells may help: --finer 3 goes on", complaint)

    def test_lists_levels_and_warns_of_grids_that_are_not_similar(self):
        code, out, complaint = self.converge("--list")
        self.assertEqual(code, 0, complaint)
        for text in ("cells_x2 ", "cells_x1.414 ", "none: the scene as it is", "mesh.grid.cells=[15, 1]", "to be run"):
            self.assertIn(text, out)
        self.assertIn("warning: bar.yaml:3:7: mesh.grid.cells: [15, 1] of a level is not similar to [30, 1] in the scene", complaint)
        self.assertFalse(Path("out").exists())

    def test_refuses_cells_that_it_cannot_scale(self):
        self.write("bar.yaml", bar("file: bar.msh", "initial: {from: runs/other}\n"))
        self.assert_refused("bar.yaml:3:7: error: mesh.file: the cells of a mesh file stay as they are", "talus sweep",
                            "error: initial: the particles of another run keep their number", "2 errors, nothing was run.")
        self.write("bar.yaml", bar())
        self.assert_refused("bar.yaml:3:7: error: mesh: cells of", "hardly differ, although their sizes were scaled by 1.414",
                            words=("--set", "mesh.grid.cells=[1, 1]"))

    def test_says_errors_of_coarser_levels_in_the_scene(self):
        self.write("bar.yaml", bar(GRID.replace("[30, 1]}", "[30, 8]}")))
        self.assert_refused("the body has no particles", "(with mesh.grid.cells=",
                            words=("--ratio", "4", "--set", "bodies[0].shape={type: box, low: [0, 0], high: [1, 0.125]}"))

    def test_wrong_words_end_with_two(self):
        self.assertEqual(subprocess.run([self.program, "converge"], capture_output=True, check=False).returncode, 2)
        self.assertEqual(subprocess.run([self.program, "converge", "other.yaml"], capture_output=True, check=False).returncode, 2)
        for words in (("--levels", "2"), ("--ratio", "1"), ("--within", "0.1"), ("--set", "time.end=-1")):
            self.assert_refused(words=words)
        self.assert_refused("--finer 3 must be below --levels 3", words=("--levels", "3", "--finer", "3"))

    def test_quick_runs_are_not_compared(self):
        code, _, complaint = self.converge("--quick", "--ratio", "2", "--finer", "2")
        self.assertEqual(code, 0, complaint)
        self.assertIn("quick runs end after a number of steps", complaint)
        self.assertFalse(Path("out/convergence.csv").exists())
        with self.assertRaisesRegex(FileNotFoundError, "the study did not end or was quick"):
            talus.Convergence("out").names

    def test_stops_on_a_signal(self):
        words = [self.program, "converge", "bar.yaml", "--out", "out", "--threads", "1", "--ratio", "2", "--finer", "2", "--set",
                 "time.end=1e6"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            while b"begins" not in process.stdout.readline():
                pass
            process.send_signal(signal.SIGTERM)
            _, complaint = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4)
        self.assertIn(b"stopped by SIGTERM: of 3 levels 0 done", complaint)
        self.assertIn(b"go on by giving the command again", complaint)


if __name__ == "__main__":
    os.environ["OMP_WAIT_POLICY"] = "passive"
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
