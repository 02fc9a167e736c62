#!/usr/bin/python3
"""Tests of talus.calibration: what it reads and writes, and calibrations of a block that falls and of a deposit.

Usage: calibration_test.py PROGRAM, the built talus.
"""
import contextlib
import io
import json
import math
import os
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus import __main__ as commands  # noqa: E402
from talus.calibration import evaluation, observations, read_specification, results  # noqa: E402
from talus.calibration.files import only_writer, write_whole  # noqa: E402
from scratch import InAFolder  # noqa: E402


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

    def add_parameter(self, line, end=""):
        self.write("calibration.yaml", CALIBRATION.replace("observations:", f"  {line}\nobservations:") + end)

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
        # rows of the history are a step apart, and linear between these
        np.testing.assert_allclose([gravity.deviation, velocity.deviation], np.sqrt(np.diag(covariance)), rtol=1e-2)
        self.assertAlmostEqual(result.correlations[0, 1], covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]), places=2)
        self.assertAlmostEqual(gravity.high - gravity.low, 2 * 1.96 * gravity.deviation, places=3)
        runs = result.runs
        self.assertEqual((runs.rows, runs["purpose"][0], set(runs["status"])), (len(lines), "start", {"done"}))
        self.assertLessEqual(runs.rows, 20)
        self.assertLess(runs["chi2"].min(), 0.1)
        self.assertGreater((self.folder / "out/calibration.png").stat().st_size, 5000)
        self.assertEqual(yaml.safe_load(Path("out/best.yaml").read_text(encoding="utf-8")), result.values)
        self.assertEqual(yaml.safe_load(f"a: {results._number(1e-5)}"), {"a": 1e-5})
        self.assertEqual([path.name for path in Path("out").iterdir() if path.name.startswith(".")], [])

    def test_runs_that_are_done_are_not_repeated_and_others_are(self):
        self.write("calibration.yaml", CALIBRATION + "gauss_newton: {most_runs: 9}\n")
        first = self.calibrate(jobs=2)
        with mock.patch.object(evaluation, "run", side_effect=AssertionError("a run was repeated")):
            again = self.calibrate()
        self.assertEqual(again.values, first.values)
        self.assertEqual(again.contents["runs"]["reused"], again.contents["runs"]["count"])
        self.observe(height(-9.81, 1.1))  # other observations: the first runs serve again
        other = self.calibrate()
        self.assertGreaterEqual(other.contents["runs"]["reused"], 5)
        self.assertAlmostEqual(other.values["bodies[0].velocity[1]"], 1.1, delta=0.02)
        self.write("scene.yaml", SCENE.replace("1000", "1001"))
        self.assertEqual(self.calibrate().contents["runs"]["reused"], 0)

    def test_a_calibration_that_was_stopped_goes_on(self):
        self.write("calibration.yaml", CALIBRATION + "gauss_newton: {most_runs: 9}\n")

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
        self.add_parameter("materials[0].density: {start: 900, low: 500, high: 2000, scale: log, prior: {mean: 1000, deviation: 50}}")
        density = self.calibrate().estimates["materials[0].density"]
        self.assertAlmostEqual(density.value, 1000, delta=2)
        self.assertAlmostEqual(density.deviation, 50, delta=0.5)

    def test_a_parameter_that_is_not_determined_has_no_number(self):
        self.add_parameter("watch.speed: {start: 100, low: 50, high: 200}", "gauss_newton: {differences: forward}\n")
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

    def test_a_run_without_a_value_is_stepped_around_and_told(self):
        lines, of_run, calls = [], observations.Curve.of_run, []

        def once(curve, run):
            calls.append(run)
            if len(calls) == 2:
                raise observations.NotComparable("nothing is there")
            return of_run(curve, run)
        with mock.patch.object(observations.Curve, "of_run", once):
            result = self.calibrate(tell=lines.append)
        self.assertIn("cannot be compared: nothing is there", lines[1])
        self.assertAlmostEqual(result.values["bodies[0].velocity[1]"], 1.2, delta=0.02)
        self.assertEqual(result.contents["runs"]["failed"], 1)

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
  - {type: historyy, file: height.csv}
  - {type: front, file: none.csv, deviation: 0.1, value: middle_uy}
  - {type: history, column: middle_ux, file: height.csv, deviation: 0.1}
method_: ensemble
""")
        found = self.errors()
        self.assertEqual([place[:2] for place in found],
                         [(1, 8), (3, 55), (4, 34), (4, 55), (5, 37), (7, 69), (8, 12), (9, 25), (10, 46), (11, 1)])
        texts = [text for *_, text in found]
        for text, words in zip(texts, ("scen.yaml", "must be > low", "outside of [low, high]", 'did you mean "scale"', '"six" is no number',
                                       "must be > 0", 'did you mean "history"', "none.csv", "no column middle_ux: did you mean middle_uy",
                                       'did you mean "method"')):
            self.assertIn(words, text)
        self.assertEqual(found[1][2], "parameters.materials[0].density.high")

    def test_runs_that_are_too_few_for_a_jacobian_are_refused(self):
        self.write("calibration.yaml", CALIBRATION + "gauss_newton: {most_runs: 4}\n")
        (line, column, key, text), = self.errors()
        self.assertEqual((line, column, key), (7, 27, "gauss_newton.most_runs"))
        self.assertIn(">= 5", text)

    def test_a_file_that_is_no_yaml_is_told_at_its_place(self):
        self.write("calibration.yaml", "scene: [scene.yaml\nparameters: 1\n")
        (line, _, _, text), = self.errors()
        self.assertEqual(line, 2)
        self.assertIn("no YAML", text)

    def test_what_the_program_says_of_a_value_is_told_at_the_value(self):
        wrong = CALIBRATION.replace("bodies[0].velocity[1]", "bodies[0].velocitty[1]")
        self.write("calibration.yaml", wrong + 'set: {"materials[0].density": -1}\n')
        with self.assertRaises(talus.SceneError) as caught:
            self.calibrate()
        places = {(message.line, message.column) for message in caught.exception.errors}
        self.assertEqual(places, {(4, 27), (7, 31)})
        self.assertIn('did you mean "velocity"', str(caught.exception))

    def test_a_bound_that_the_scene_does_not_take_is_told_before_anything_runs(self):
        self.add_parameter("materials[0].density: {start: 900, low: -5, high: 2000}")
        with self.assertRaisesRegex(talus.SceneError, "-5.0 must be > 0"):
            self.calibrate()
        self.assertFalse(Path("out").exists())

    def test_numbers_and_scales(self):
        self.add_parameter("materials[0].density: {start: 1e3, low: 1e2, high: 1e4, scale: log}")
        spec = read_specification(Path("calibration.yaml"))
        density = spec.parameters[2]
        self.assertAlmostEqual(density.position(1000), 0.5)
        self.assertAlmostEqual(density.value(0.25), 10**2.5)
        self.assertAlmostEqual(spec.parameters[0].value(spec.parameters[0].position(-9.81)), -9.81)


class Examples(InAFolder):
    def test_the_observations_of_the_deposit_are_those_that_the_script_computes(self):
        script = ROOT / "python/examples/calibration/synthetic_deposit.py"
        subprocess.run([sys.executable, "-B", script, "--out", "."], check=True, capture_output=True)
        for name in ("scene.yaml", "calibration.yaml"):
            self.write(name, (ROOT / "scenes/deposit" / name).read_text(encoding="utf-8"))
        stored, written = (read_specification(folder / "calibration.yaml").observations for folder in (ROOT / "scenes/deposit", Path(".")))
        self.assertEqual([(one.name, len(one.values)) for one in stored],
                         [("thickness", 210), ("outline", 30), ("front", 19), ("top_uz", 19)])
        for one, other in zip(stored, written):
            np.testing.assert_allclose(one.values, other.values, atol=0.02)

    def test_a_run_with_the_hidden_values_agrees_with_observations_without_errors(self):
        folder = ROOT / "python/examples/calibration"
        words = [sys.executable, "-B", folder / "synthetic_deposit.py", "--out", ".", "--errors", "0"]
        subprocess.run(words, check=True, capture_output=True)
        for name in ("scene.yaml", "calibration.yaml"):
            self.write(name, (ROOT / "scenes/deposit" / name).read_text(encoding="utf-8"))
        spec = read_specification(Path("calibration.yaml"))
        hidden = {"materials[0].friction_angle": 26, "materials[0].cohesion": 150, "boundaries[0].coefficient": 0.35}
        best, start = talus.run("scene.yaml", set=hidden, out="hidden"), talus.run("scene.yaml", out="start")
        for one in spec.observations:
            np.testing.assert_allclose(one.of_run(best), one.values, atol=2e-5, err_msg=one.name)  # digits of the files
            self.assertGreater(np.sqrt(np.mean(one.residuals(start) ** 2)), 3, one.name)
        covered = spec.observations[1].of_run(start)  # the deposit of stronger sand ends before the rim
        self.assertLess(covered.max(), 0)


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
