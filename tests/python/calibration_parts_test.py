#!/usr/bin/python3
"""Tests of the parts of talus.calibration on cases with known answers: least squares, ensembles, their uncertainty, maps and outlines.

Usage: calibration_parts_test.py PROGRAM, which is not needed.
"""
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.calibration.ensemble import assimilate, first_members  # noqa: E402
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
            self.assertGreater(fit.promised, 1e-12)

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

    def test_steps_that_overshoot_are_shortened_by_damping(self):
        def saturating(x):
            return np.arctan(20 * (x - 0.5))
        fit = minimise(Calls(saturating), np.array([0.9]), np.array([0.01]), most=60, tolerance=1e-8)
        self.assertAlmostEqual(fit.position[0], 0.5, places=4)
        self.assertEqual(fit.ending, CONVERGED)

    def test_a_step_corrects_the_jacobian_by_what_it_has_shown(self):
        calls = Calls(lambda x: linear(x) + 8 * (x - HIDDEN) ** 2 @ np.ones((2, 4)))
        fit = minimise(calls, self.start, self.steps, most=60, tolerance=1e-8)
        np.testing.assert_allclose(fit.position, HIDDEN, atol=1e-4)
        self.assertEqual(calls.purposes.count("difference"), 2 * 4)  # at the start and at the minimum
        self.assertLessEqual(calls.purposes.count("step"), 5)

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


class Map:
    """A map of 4 by 3 cells of 1 m x 2 m, whose south-western corner is (10, 20)."""

    x, y, cell, extent = np.array([10.5, 11.5, 12.5, 13.5]), np.array([25.0, 23.0, 21.0]), (1.0, 2.0), (10, 14, 20, 26)
    values = np.array([[1.0, 2.0, 3.0, np.nan], [2.0, 3.0, 4.0, np.nan], [3.0, 4.0, 5.0, np.nan]], "f4")


class Measurements(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def test_grids_are_read_with_the_centres_of_their_cells(self):
        rows = "1 2 3\n4 5 -9\n"
        for name, heading in (("corner.asc", "xllcorner 10\nyllcorner 20"), ("centre.asc", "xllcenter 11\nyllcenter 21")):
            x, y, values = read_survey(self.write(name, f"NCOLS 3\nNROWS 2\n{heading}\ncellsize 2\nNODATA_value -9\n{rows}"))
            np.testing.assert_array_equal(x, [11, 13, 15])
            np.testing.assert_array_equal(y, [23, 21])
            np.testing.assert_array_equal(values, [[1, 2, 3], [4, 5, np.nan]])

    def test_damaged_grids_are_told(self):
        for text, words in (("nrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", "ncols"),
                            ("ncols 2\nnrows 1\ncellsize 1\n1 2\n", "xllcorner"),
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
        feature = {"type": "Feature", "geometry": polygon}
        for value in (polygon, feature, {"type": "FeatureCollection", "features": [feature]},
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


if __name__ == "__main__":
    sys.argv[1:2] = []
    unittest.main()
