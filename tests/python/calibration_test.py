#!/usr/bin/python3
"""Tests of talus.calibration: its methods on functions with known answers, its files, and calibrations of a block that falls.

Usage: calibration_test.py PROGRAM, the built talus.
"""
import contextlib
import io
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus import __main__ as commands  # noqa: E402
from talus.calibration import evaluation, read_specification  # noqa: E402
from talus.calibration.ensemble import assimilate, first_members  # noqa: E402
from talus.calibration.files import only_writer, write_whole  # noqa: E402
from talus.calibration.gauss_newton import CONVERGED, NO_DECREASE, USED_UP, NoResiduals, minimise  # noqa: E402
from talus.calibration.observations import sampled  # noqa: E402
from talus.calibration.outlines import contour_lines, read_outline, resampled, signed_distances  # noqa: E402
from talus.calibration.surveys import read_survey  # noqa: E402
from talus.calibration.uncertainty import interval, of_ensemble, of_jacobian  # noqa: E402

HIDDEN = np.array([0.3, 0.6])
MATRIX = np.array([[40.0, 5.0], [-10.0, 30.0], [20.0, 20.0], [5.0, -25.0]])


def linear(x):
    return MATRIX @ (x - HIDDEN)


def bent(x):
    """Nonlinear, with a minimum at HIDDEN where the residuals vanish."""
    return np.sinh(MATRIX @ (x - HIDDEN) / 20) * 20


class Calls:
    """A function as methods call it, which counts."""

    def __init__(self, function):
        self.function, self.purposes = function, []

    def __call__(self, points, purpose):
        self.purposes += [purpose] * len(points)
        return [self.function(point) for point in points]


class GaussNewton(unittest.TestCase):
    start, steps = np.array([0.5, 0.4]), np.array([0.05, 0.05])

    def test_a_linear_function_takes_the_steps_that_its_damping_wants(self):
        calls = Calls(linear)
        fit = minimise(calls, self.start, self.steps, most=30, tolerance=1e-4)
        np.testing.assert_allclose(fit.position, HIDDEN, atol=1e-3)
        np.testing.assert_allclose(fit.jacobian, MATRIX, rtol=1e-9)
        self.assertEqual((fit.ending, fit.evaluations), (CONVERGED, len(calls.purposes)))
        self.assertLessEqual(fit.evaluations, 1 + 2 * 4 + 4)

    def test_a_bent_function_is_minimised_in_few_evaluations(self):
        calls = Calls(bent)
        fit = minimise(calls, np.array([0.9, 0.1]), self.steps, most=40, tolerance=1e-4)
        np.testing.assert_allclose(fit.position, HIDDEN, atol=1e-3)
        self.assertEqual(fit.ending, CONVERGED)
        self.assertLessEqual(fit.evaluations, 30)
        self.assertEqual(fit.iterations, sorted(fit.iterations, reverse=True))
        np.testing.assert_array_equal(fit.at, fit.position)

    def test_no_more_evaluations_are_made_than_allowed(self):
        for most in (5, 6, 9, 10, 11, 14):
            calls = Calls(bent)
            fit = minimise(calls, np.array([0.9, 0.1]), self.steps, most=most, tolerance=1e-12)
            self.assertLessEqual(len(calls.purposes), most)
            self.assertEqual(fit.ending, USED_UP)

    def test_a_minimum_outside_is_found_at_the_bound(self):
        fit = minimise(Calls(lambda x: linear(x + [0.5, 0.0])), self.start, self.steps, most=40, tolerance=1e-6)
        self.assertEqual(fit.position[0], 0.0)
        free = MATRIX[:, 1]  # the best value of the second with the first at its bound
        best = HIDDEN[1] - free @ (MATRIX[:, 0] * (0.5 - HIDDEN[0])) / (free @ free)
        self.assertAlmostEqual(fit.position[1], best, places=4)

    def test_no_point_lies_outside_of_the_bounds(self):
        seen = []
        minimise(Calls(lambda x: (seen.append(x.copy()), bent(x))[1]), np.array([0.0, 1.0]), self.steps, most=40, tolerance=1e-4)
        self.assertGreaterEqual(np.min(seen), 0)
        self.assertLessEqual(np.max(seen), 1)

    def test_runs_that_fail_are_stepped_around(self):
        fit = minimise(Calls(lambda x: None if x[0] > 0.52 or x[1] > 0.7 else bent(x)), self.start, self.steps, most=40, tolerance=1e-4)
        np.testing.assert_allclose(fit.position, HIDDEN, atol=1e-3)
        with self.assertRaisesRegex(NoResiduals, "start"):
            minimise(Calls(lambda x: None), self.start, self.steps, most=40, tolerance=1e-4)
        with self.assertRaisesRegex(NoResiduals, "parameter 2"):
            minimise(Calls(lambda x: None if x[1] != 0.4 else bent(x)), self.start, self.steps, most=40, tolerance=1e-4)

    def test_forward_differences_take_half_of_the_evaluations(self):
        calls = Calls(linear)
        fit = minimise(calls, self.start, self.steps, most=40, tolerance=1e-4, differences="forward")
        np.testing.assert_allclose(fit.position, HIDDEN, atol=1e-3)
        self.assertEqual(calls.purposes[:4], ["start", "difference", "difference", "step"])

    def test_scatter_below_the_step_is_averaged_out_and_scatter_above_it_is_told(self):
        def scattered(x):
            return linear(x) + 0.2 * np.sin(np.arange(1, 5) * 4e3 * x.sum())
        fine = minimise(Calls(scattered), self.start, np.full(2, 0.05), most=40, tolerance=0.01)
        np.testing.assert_allclose(fine.position, HIDDEN, atol=0.02)
        self.assertLess(max(fine.curvature), 1)
        coarse = minimise(Calls(lambda x: linear(x) + 30 * np.cos(1e4 * x.sum() + np.arange(4))), self.start, np.full(2, 1e-3), most=60,
                          tolerance=0.01)
        self.assertIn(coarse.ending, (NO_DECREASE, USED_UP, CONVERGED))
        self.assertGreater(max(coarse.curvature), 0.5)

    def test_intervals_cover_the_truth_as_often_as_they_promise(self):
        random, inside, count = np.random.default_rng(1), 0, 300
        for _ in range(count):
            errors = random.standard_normal(4)
            fit = minimise(Calls(lambda x, e=errors: bent(x) + e), self.start, self.steps, most=60, tolerance=1e-3)
            found = of_jacobian(fit.jacobian, fit.residuals, ["a", "b"])
            inside += sum(low <= hidden <= high for hidden, (low, high)
                          in zip(HIDDEN, (interval(x, sigma) for x, sigma in zip(fit.position, found.deviations))))
        self.assertAlmostEqual(inside / (2 * count), 0.95, delta=0.03)


class Uncertainties(unittest.TestCase):
    def test_the_covariance_is_the_inverse_of_the_normal_matrix(self):
        found = of_jacobian(MATRIX, np.array([1.0, -1.0, 0.5, 0.0]), ["a", "b"])
        np.testing.assert_allclose(found.covariance, np.linalg.inv(MATRIX.T @ MATRIX), rtol=1e-10)
        self.assertAlmostEqual(found.condition, np.linalg.cond(MATRIX))
        self.assertEqual((found.chi2, found.freedom, found.warnings), (2.25, 2, []))
        self.assertAlmostEqual(found.misfit_factor, math.sqrt(2.25 / 2))

    def test_large_residuals_are_told_and_can_widen_the_intervals(self):
        large = np.full(4, 10.0)
        stated, scaled = (of_jacobian(MATRIX, large, ["a", "b"], is_scaled=is_scaled) for is_scaled in (False, True))
        self.assertIn("too narrow", stated.warnings[0])
        np.testing.assert_allclose(scaled.covariance, stated.covariance * 400 / 2)

    def test_parameters_that_cannot_be_told_apart_are_named(self):
        found = of_jacobian(np.column_stack([MATRIX[:, 0], MATRIX[:, 0], MATRIX[:, 1]]), np.zeros(4), ["a", "b", "c"])
        self.assertEqual(np.isinf(found.deviations).tolist(), [True, True, False])
        self.assertAlmostEqual(found.deviations[2], math.sqrt(np.linalg.inv(MATRIX.T @ MATRIX)[1, 1]))
        text = "\n".join(found.warnings)
        for words in ("a is not identifiable", "b is not identifiable", "combinations of a and b", "condition number"):
            self.assertIn(words, text)
        self.assertNotIn("c is not", text)

    def test_a_parameter_without_influence_is_named(self):
        found = of_jacobian(np.column_stack([MATRIX, np.zeros(4)]), np.zeros(4), ["a", "b", "c"])
        self.assertIn("the observations hardly depend on c", "\n".join(found.warnings))
        self.assertIn("c is not identifiable", "\n".join(found.warnings))
        self.assertTrue(np.isinf(found.deviations[2]))
        np.testing.assert_allclose(found.covariance[:2, :2], np.linalg.inv(MATRIX.T @ MATRIX), rtol=1e-10)

    def test_correlated_estimates_are_told(self):
        found = of_jacobian(np.array([[50.0, 50.0], [50.0, 49.0], [1.0, -2.0]]), np.zeros(3), ["a", "b"])
        self.assertLess(found.correlations[0, 1], -0.95)
        self.assertIn("b and a are hard to tell apart", "\n".join(found.warnings))

    def test_intervals_end_at_the_bounds(self):
        low, high = interval(0.5, 0.1)
        self.assertAlmostEqual(high - low, 2 * 1.959964 * 0.1, places=6)
        self.assertEqual(interval(0.1, 0.2)[0], 0.0)
        self.assertEqual(interval(0.5, math.inf), (0.0, 1.0))


class Ensembles(unittest.TestCase):
    def test_a_linear_problem_has_the_posterior_of_theory(self):
        mean, deviation = np.array([0.5, 0.5]), np.array([0.05, 0.1])
        data = np.array([0.5, -1.0, 1.0, 0.2])
        matrix, hidden = MATRIX / 2, np.array([0.52, 0.45])
        members = first_members(2000, mean, deviation, 1)
        found = assimilate(Calls(lambda x: matrix @ (x - hidden) - data), members, 4, 1)
        precision = matrix.T @ matrix + np.diag(deviation**-2.0)
        expected = np.linalg.solve(precision, matrix.T @ (matrix @ hidden + data) + mean / deviation**2)
        sigma = np.sqrt(np.diag(np.linalg.inv(precision)))
        np.testing.assert_allclose(found.positions.mean(axis=0), expected, atol=0.1 * sigma.min())
        np.testing.assert_allclose(np.cov(found.positions, rowvar=False), np.linalg.inv(precision), atol=0.1 * sigma.max() ** 2)
        self.assertEqual(found.misfits, sorted(found.misfits, reverse=True))
        self.assertEqual(found.evaluations, 5 * 2000 + 1)

    def test_the_first_members_are_a_latin_hypercube_between_the_bounds(self):
        members = first_members(50, np.array([0.5, 0.1]), np.array([0.2, 0.3]), 3)
        self.assertTrue(((members >= 0) & (members <= 1)).all())
        self.assertAlmostEqual(members[:, 0].mean(), 0.5, delta=0.01)
        np.testing.assert_array_equal(members, first_members(50, np.array([0.5, 0.1]), np.array([0.2, 0.3]), 3))

    def test_members_that_fail_are_left_out(self):
        members = first_members(40, np.array([0.5, 0.5]), np.array([0.2, 0.2]), 1)
        found = assimilate(Calls(lambda x: None if x[0] > 0.6 else bent(x)), members, 4, 1)
        self.assertLess(len(found.positions), 40)
        np.testing.assert_allclose(found.positions.mean(axis=0), HIDDEN, atol=0.05)
        with self.assertRaisesRegex(NoResiduals, "at least 3"):
            assimilate(Calls(lambda x: None), members, 4, 1)

    def test_a_parameter_without_influence_is_named(self):
        members = first_members(60, np.array([0.5, 0.5]), np.array([0.2, 0.2]), 1)
        found = assimilate(Calls(lambda x: MATRIX[:, 0] * (x[0] - 0.3)), members, 4, 1)
        told = of_ensemble(found.positions, members, found.residuals, ["a", "b"])
        self.assertIn("b is not identifiable", "\n".join(told.warnings))
        self.assertNotIn("a is not identifiable", "\n".join(told.warnings))


class InAFolder(unittest.TestCase):
    program = ""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        environment = mock.patch.dict(os.environ, {"TALUS": self.program})
        environment.start()
        self.addCleanup(environment.stop)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name


class Map:
    """A map of 4 by 3 cells of 1 m x 2 m, whose south-western corner is (10, 20)."""

    x, y, cell, extent = np.array([10.5, 11.5, 12.5, 13.5]), np.array([25.0, 23.0, 21.0]), (1.0, 2.0), (10, 14, 20, 26)
    values = np.array([[1.0, 2.0, 3.0, np.nan], [2.0, 3.0, 4.0, np.nan], [3.0, 4.0, 5.0, np.nan]], "f4")


class Measurements(InAFolder):
    def test_grids_are_read_with_the_centres_of_their_cells(self):
        rows = "1 2 3\n4 5 -9\n"
        for name, heading in (("corner.asc", "xllcorner 10\nyllcorner 20"), ("centre.asc", "xllcenter 11\nyllcenter 21")):
            x, y, values = read_survey(self.write(name, f"NCOLS 3\nNROWS 2\n{heading}\ncellsize 2\nNODATA_value -9\n{rows}"))
            np.testing.assert_array_equal(x, [11, 13, 15])
            np.testing.assert_array_equal(y, [23, 21])
            np.testing.assert_array_equal(values, [[1, 2, 3], [4, 5, np.nan]])

    def test_damaged_grids_are_told(self):
        for text, words in (("nrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", "ncols"), ("ncols 2\nnrows 1\ncellsize 1\n1 2\n", "xllcorner"),
                            ("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", "reshape"), ("ncols two\n", "two")):
            with self.assertRaisesRegex(talus.Damaged, words):
                read_survey(self.write("bad.asc", text))

    def test_maps_are_linear_between_centres_and_zero_without_values(self):
        places = np.array([[10.5, 25.0], [11.0, 24.0], [13.5, 23.0], [100.0, 23.0]])
        np.testing.assert_allclose(sampled(Map(), places), [1.0, 2.0, 0.0, 0.0])

    def test_a_contour_and_distances_to_it(self):
        points = np.concatenate(contour_lines(Map(), 2.5))
        for expected in ([11.0, 23.0], [12.0, 25.0], [10.5, 22.0]):
            self.assertLess(np.linalg.norm(points - expected, axis=1).min(), 1e-9, expected)
        square = [np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]])]
        points = np.array([[1.0, 0.5], [3.0, 1.0], [3.0, 3.0], [2.0, 1.0]])
        found = signed_distances(points, square, np.array([True, False, False, False]))
        np.testing.assert_allclose(found, [0.5, -1.0, -math.sqrt(2), 0.0], atol=1e-12)

    def test_outlines_of_all_kinds(self):
        ring = [[0, 0], [4, 0], [4, 2], [0, 0]]
        polygon = {"type": "Polygon", "coordinates": [ring]}
        for value in (polygon, {"type": "Feature", "geometry": polygon}, {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": polygon}]},
                      {"type": "MultiPolygon", "coordinates": [[ring]]}, {"type": "LineString", "coordinates": ring},
                      {"type": "MultiLineString", "coordinates": [ring]}):
            line, = read_outline(self.write("outline.geojson", json.dumps(value)))
            np.testing.assert_array_equal(line, ring)
        np.testing.assert_array_equal(resampled([np.array(ring, float)], None), ring[:-1])
        np.testing.assert_allclose(resampled([np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]])], 1.0), [[0, 0], [1, 0], [2, 0], [2, 1]])
        one, two = read_outline(self.write("outline.csv", "line,east [m],north [m]\n1,0,0\n1,1,0\n2,5,5\n2,6,7\n"))
        np.testing.assert_array_equal([*one, *two], [[0, 0], [1, 0], [5, 5], [6, 7]])
        for text in ('{"type": "Point", "coordinates": [0, 0]}', "[", '{"type": "LineString", "coordinates": [[0, 0]]}'):
            with self.assertRaises(talus.Damaged):
                read_outline(self.write("bad.geojson", text))


SCENE = """\
title: A falling block
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 3], cells: [4, 6]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: block, material: rubber, shape: {type: box, low: [0.5, 1.5], high: [1.5, 2.5]}, velocity: [0, 0]}
loads: [{type: gravity, acceleration: [0, -5]}]
time: {end: 0.2}
outputs: {history: {every: 0.01, points: [{name: middle, at: [1, 2]}]}}
"""
CALIBRATION = """\
scene: scene.yaml
parameters:
  loads[0].acceleration[1]: {start: -6, low: -15, high: -2}
  bodies[0].velocity[1]: {start: 0.5, low: -2, high: 3}
observations:
  - {type: history, column: middle_uy, file: height.csv, deviation: 0.002}
"""
TIMES = np.arange(0.02, 0.2, 0.02)


def height(gravity, velocity):
    """Displacement of a body in free fall, m."""
    return velocity * TIMES + gravity * TIMES**2 / 2


class OfABlock(InAFolder):
    def setUp(self):
        super().setUp()
        self.write("scene.yaml", SCENE)
        self.write("calibration.yaml", CALIBRATION)
        self.observe(height(-9.81, 1.2))

    def observe(self, values):
        self.write("height.csv", "time [s],middle_uy [m]\n" + "".join(f"{t:.3f},{u!r}\n" for t, u in zip(TIMES, values.tolist())))

    def calibrate(self, **options):
        return talus.calibrate("calibration.yaml", **{"out": "out", "threads": 1, "pictures": False, **options})


class Calibrations(OfABlock):
    def test_free_fall_gives_gravity_and_velocity_with_the_uncertainty_of_a_parabola(self):
        lines = []
        result = self.calibrate(tell=lines.append, pictures=True)
        gravity, velocity = result.estimates.values()
        # what is left is half a step of integration in the history and the step that is not worth a run
        self.assertAlmostEqual(gravity.value, -9.81, delta=0.1 * gravity.deviation)
        self.assertAlmostEqual(velocity.value, 1.2, delta=0.1 * velocity.deviation)
        design = np.column_stack([TIMES**2 / 2, TIMES]) / 0.002
        covariance = np.linalg.inv(design.T @ design)
        np.testing.assert_allclose([gravity.deviation, velocity.deviation], np.sqrt(np.diag(covariance)), rtol=1e-2)  # rows of the history are a step apart
        self.assertAlmostEqual(result.correlations[0, 1], covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]), places=2)
        self.assertAlmostEqual(gravity.high - gravity.low, 2 * 1.96 * gravity.deviation, places=3)
        runs = result.runs
        self.assertEqual((runs.rows, runs["purpose"][0], set(runs["status"])), (len(lines), "start", {"done"}))
        self.assertLessEqual(runs.rows, 20)
        self.assertLess(runs["chi2"].min(), 0.1)
        self.assertGreater((self.folder / "out/calibration.png").stat().st_size, 5000)
        import yaml
        self.assertEqual(yaml.safe_load(Path("out/best.yaml").read_text(encoding="utf-8")), result.values)
        self.assertEqual([path.name for path in Path("out").iterdir() if path.name.startswith(".")], [])

    def test_runs_that_are_done_are_not_repeated_and_others_are(self):
        first = self.calibrate(jobs=2)
        with mock.patch.object(evaluation, "run", side_effect=AssertionError("a run was repeated")):
            again = self.calibrate()
        self.assertEqual(again.values, first.values)
        self.assertEqual(again.contents["runs"]["reused"], again.contents["runs"]["count"])
        self.observe(height(-9.81, 1.1))  # other observations: the first runs serve again
        other = self.calibrate()
        self.assertGreaterEqual(other.contents["runs"]["reused"], 5)
        self.assertAlmostEqual(other.values["bodies[0].velocity[1]"], 1.1, delta=0.01)
        self.write("scene.yaml", SCENE.replace("1000", "1001"))
        self.assertEqual(self.calibrate().contents["runs"]["reused"], 0)

    def test_a_calibration_that_was_stopped_goes_on(self):
        def stop(line):
            if line.startswith("run 4"):
                raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            self.calibrate(tell=stop)
        self.assertFalse(Path("out/calibration.json").exists())
        result = self.calibrate()
        self.assertGreaterEqual(result.contents["runs"]["reused"], 4)
        self.assertEqual(result.values, self.calibrate(out="whole").values)

    def test_an_ensemble_finds_them_too(self):
        self.write("calibration.yaml", f"{CALIBRATION}method: ensemble\nensemble: {{members: 8, assimilations: 2}}\n")
        result = self.calibrate(jobs=2)
        gravity, velocity = result.estimates.values()
        self.assertAlmostEqual(gravity.value, -9.81, delta=3 * gravity.deviation)
        self.assertAlmostEqual(velocity.value, 1.2, delta=3 * velocity.deviation)
        self.assertLess(velocity.deviation, 0.2)
        self.assertEqual(result.runs.rows, 8 * 3 + 1)

    def test_a_prior_decides_where_observations_do_not(self):
        self.write("calibration.yaml", CALIBRATION.replace("observations:", """\
  materials[0].density: {start: 900, low: 500, high: 2000, scale: log, prior: {mean: 1000, deviation: 50}}
observations:"""))
        density = self.calibrate().estimates["materials[0].density"]
        self.assertAlmostEqual(density.value, 1000, delta=2)
        self.assertAlmostEqual(density.deviation, 50, delta=0.5)

    def test_a_parameter_that_is_not_determined_has_no_number(self):
        self.write("calibration.yaml", CALIBRATION.replace("observations:", "  watch.speed: {start: 100, low: 50, high: 200}\nobservations:"))
        result = self.calibrate()
        self.assertIn("watch.speed is not identifiable", "\n".join(result.warnings))
        self.assertIn("not determined", str(result))
        self.assertEqual(result.estimates["watch.speed"].deviation, math.inf)
        self.assertIsNone(json.loads(Path("out/calibration.json").read_text(encoding="utf-8"))["parameters"][2]["deviation"])
        self.assertAlmostEqual(result.values["loads[0].acceleration[1]"], -9.81, delta=0.05)

    def test_what_no_run_can_be_compared_with_is_told_at_its_place(self):
        self.write("calibration.yaml", CALIBRATION.replace("middle_uy,", "middle_uz,").replace("height.csv", "wrong.csv") +
                   "  - {type: thickness, file: grid.asc, deviation: 0.1}\n")
        self.write("wrong.csv", "time,middle_uz\n0.1,1\n0.9,1\n")
        self.write("grid.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n")
        with self.assertRaises(talus.SceneError) as caught:
            self.calibrate()
        self.assertEqual([(message.line, message.column) for message in caught.exception.errors], [(6, 5), (7, 5)])
        self.assertIn("middle_uy", caught.exception.errors[0].text)

    def test_a_run_that_fails_at_the_start_ends_it(self):
        self.write("calibration.yaml", CALIBRATION + "set: {watch.speed: 0.01}\n")
        with self.assertRaisesRegex(talus.RunFailed, "start values"):
            self.calibrate()
        self.assertIn("failed", Path("out/calibration.csv").read_text(encoding="utf-8"))


class Inputs(OfABlock):
    def errors(self):
        with self.assertRaises(talus.SceneError) as caught:
            read_specification(Path("calibration.yaml"))
        return [(message.line, message.column, message.key, message.text) for message in caught.exception.errors]

    def test_all_errors_are_told_at_once_with_their_places(self):
        self.write("calibration.yaml", """\
scene: scen.yaml
parameters:
  materials[0].density: {start: 900, low: 1000, high: 500}
  bodies[0].velocity[1]: {start: 5, low: -2, high: 3, scal: log}
  loads[0].acceleration[1]: {start: six, low: -15, high: -2, scale: log}
observations:
  - {type: history, column: middle_uy, file: height.csv, deviation: -1}
  - {type: histroy, file: height.csv}
  - {type: front, file: none.csv, deviation: 0.1, value: middle_uy}
  - {type: history, column: middle_ux, file: height.csv, deviation: 0.1}
methode: ensemble
""")
        found = self.errors()
        self.assertEqual([place[:2] for place in found],
                         [(1, 8), (3, 55), (4, 34), (4, 55), (5, 37), (7, 69), (8, 12), (9, 25), (10, 46), (11, 1)])
        texts = [text for *_, text in found]
        for text, words in zip(texts, ("scen.yaml", "must be > low", "outside of [low, high]", 'did you mean "scale"', '"six" is no number', "must be > 0",
                                       'did you mean "history"', "none.csv", "no column middle_ux: did you mean middle_uy", 'did you mean "method"')):
            self.assertIn(words, text)
        self.assertEqual(found[1][2], "parameters.materials[0].density.high")

    def test_a_file_that_is_no_yaml_is_told_at_its_place(self):
        self.write("calibration.yaml", "scene: [scene.yaml\nparameters: 1\n")
        (line, _, _, text), = self.errors()
        self.assertEqual(line, 2)
        self.assertIn("no YAML", text)

    def test_what_the_program_says_of_a_value_is_told_at_the_value(self):
        self.write("calibration.yaml", CALIBRATION.replace("bodies[0].velocity[1]", "bodies[0].velocitty[1]") + "set: {materials[0].density: -1}\n"
                   .replace("materials[0].density", '"materials[0].density"'))
        with self.assertRaises(talus.SceneError) as caught:
            self.calibrate()
        places = {(message.line, message.column) for message in caught.exception.errors}
        self.assertEqual(places, {(4, 27), (7, 31)})
        self.assertIn('did you mean "velocity"', str(caught.exception))

    def test_a_bound_that_the_scene_does_not_take_is_told_before_anything_runs(self):
        self.write("calibration.yaml", CALIBRATION.replace("observations:", "  materials[0].density: {start: 900, low: -5, high: 2000}\nobservations:"))
        with self.assertRaisesRegex(talus.SceneError, "-5.0 must be > 0"):
            self.calibrate()
        self.assertFalse(Path("out").exists())

    def test_numbers_and_scales(self):
        self.write("calibration.yaml", CALIBRATION.replace("observations:",
                                                           "  materials[0].density: {start: 1e3, low: 1e2, high: 1e4, scale: log}\nobservations:"))
        spec = read_specification(Path("calibration.yaml"))
        density = spec.parameters[2]
        self.assertAlmostEqual(density.position(1000), 0.5)
        self.assertAlmostEqual(density.value(0.25), 10**2.5)
        self.assertAlmostEqual(spec.parameters[0].value(spec.parameters[0].position(-9.81)), -9.81)


class Command(OfABlock):
    def call(self, *words):
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(io.StringIO()) as complained:
            code = commands.main([*map(str, words)])
        return code, said.getvalue(), complained.getvalue()

    def test_a_calibration_from_the_shell(self):
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
        told = subprocess.run([sys.executable, "-B", "-m", "talus", "calibrate", "calibration.yaml", "--out", "out", "--no-pictures",
                               "--program", self.program], env=environment, capture_output=True, text=True, check=False)
        self.assertEqual((told.returncode, told.stderr), (0, ""))
        for words in ("run 1 (start)", "loads[0].acceleration[1]", "95 % interval", "results in out"):
            self.assertIn(words, told.stdout)

    def test_exit_codes(self):
        self.assertEqual(self.call("calibrate", "none.yaml")[0], 2)
        self.assertEqual(self.call("calibrate", "calibration.yaml", "--program", "no_such_program")[0], 3)
        self.write("wrong.yaml", CALIBRATION.replace("deviation: 0.002", "deviation: 0"))
        code, _, complained = self.call("calibrate", "wrong.yaml", "--no-pictures")
        self.assertEqual(code, 2)
        self.assertTrue(complained.startswith("wrong.yaml:6:69: error: observations[0].deviation: 0 must be > 0"), complained)
        self.assertTrue(complained.endswith("1 error, nothing was run.\n"))
        self.write("fails.yaml", CALIBRATION + "set: {watch.speed: 0.01}\n")
        self.assertEqual(self.call("calibrate", "fails.yaml", "--out", "fails", "--quiet")[0], 1)
        with mock.patch.object(commands, "calibrate", side_effect=KeyboardInterrupt):
            self.assertEqual(self.call("calibrate", "calibration.yaml")[0], 4)


class Files(InAFolder):
    def test_a_file_is_replaced_as_a_whole_or_not_at_all(self):
        path = self.write("a.txt", "before")
        with mock.patch.object(Path, "replace", side_effect=OSError("disk full")), self.assertRaises(OSError):
            write_whole(path, "after")
        self.assertEqual((path.read_text(encoding="utf-8"), [entry.name for entry in self.folder.iterdir()]), ("before", ["a.txt"]))
        write_whole(path, "after")
        self.assertEqual(path.read_text(encoding="utf-8"), "after")

    def test_a_folder_has_one_writer(self):
        with only_writer(self.folder), self.assertRaisesRegex(talus.EnvironmentFailure, "another process"), only_writer(self.folder):
            self.fail("two writers")
        with only_writer(self.folder):
            pass

    def test_files_that_a_scene_names_belong_to_its_inputs(self):
        scene = self.write("scene.yaml", "mesh: {file: mesh.msh}\n")
        without = evaluation.inputs_digest(scene, {})
        self.write("mesh.msh", "1")
        one = evaluation.inputs_digest(scene, {})
        self.write("mesh.msh", "2")
        two = evaluation.inputs_digest(scene, {})
        self.assertEqual(len({without, one, two}), 3)
        self.write("other.msh", "3")
        self.assertNotEqual(evaluation.inputs_digest(scene, {"mesh.file": "other.msh"}), two)


if __name__ == "__main__":
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
