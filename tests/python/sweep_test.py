#!/usr/bin/python3
"""Tests of talus.sweeps: what a study says, samples of distributions, findings, and sweeps from Python.

Usage: sweep_test.py PROGRAM, the built talus.  Tests of the command are in tests/app/commands/sweep_command_test.cpp.
"""
import math
import os
import sys
import time
import unittest
import unittest.mock
from pathlib import Path

import numpy as np
from scipy import stats

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.calibration.places import Block, read_yaml  # noqa: E402
from talus.child_runs import Share, divide_cores  # noqa: E402
from talus.run_queue import RunQueue  # noqa: E402
from talus.run_states import PlannedRun, RunState, state_of  # noqa: E402
from talus.sweeps.distributions import read_distribution, shares_of  # noqa: E402
from talus.sweeps.findings import file_word, rank_correlation  # noqa: E402
from talus.sweeps.maps import CaseMap, read_map, write_share  # noqa: E402
from talus.sweeps.study import read_study  # noqa: E402
from talus.tables import cell  # noqa: E402
from scratch import InAFolder  # noqa: E402

SCENE = """\
title: A block that falls
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 3], cells: [4, 6]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: block, material: rubber, shape: {type: box, low: [0.5, 1.5], high: [1.5, 2.5]}, velocity: [0, 0]}
loads: [{type: gravity, acceleration: [0, -5]}]
time: {end: 0.02}
outputs: {history: {every: 0.005, fronts: [{name: toe, direction: +x}]}}
"""


class Studies(InAFolder):
    def setUp(self):
        super().setUp()
        self.write("scene.yaml", SCENE)

    def read(self, text):
        return read_study(self.write("study.yaml", text).relative_to(self.folder))

    def errors(self, text):
        try:
            self.read(text)
        except talus.SceneError as error:
            return str(error)
        return "none"

    def assert_says(self, text, *lines):
        said = self.errors(text)
        for line in lines:
            self.assertIn(line, said)

    @staticmethod
    def cases(study):
        return [" ".join(study.changes(i)) for i in range(len(study.cases))]

    @staticmethod
    def column(study, k):
        return np.array([float(case[k].text) for case in study.cases])


class StudyFiles(Studies):
    def test_is_a_grid_unless_it_says_rows_and_the_last_key_varies_fastest(self):
        vary = "scene: scene.yaml\nvary:\n  time.end: [1, 2.50]\n  mesh.size: [0.1, 0.2]\n"
        self.assertEqual(self.cases(self.read(vary)),
                         [f"time.end={end} mesh.size={size}" for end in ("1", "2.50") for size in ("0.1", "0.2")])
        self.assertEqual(self.cases(self.read(vary + "combine: rows\n")), ["time.end=1 mesh.size=0.1", "time.end=2.50 mesh.size=0.2"])

    def test_a_tornado_varies_one_key_at_a_time(self):
        study = self.read("scene: scene.yaml\nvary:\n  a: {low: 1, high: 2}\n  b: {mean: 10, deviation: 3}\ncombine: tornado\n")
        self.assertEqual(self.cases(study), ["a=1.5 b=10", "a=1 b=10", "a=2 b=10", "a=1.5 b=7", "a=1.5 b=13"])

    def test_values_of_any_kind_are_written_as_set_takes_them(self):
        study = self.read('scene: scene.yaml\nvary:\n  a:\n    - [0.5, "x, \\"y\\""]\n    - {type: box, low: [0, 0]}\n    - plain words\n'
                          "    - '1'\n    - true\n    - \"\\x07\"\n")
        self.assertEqual(self.cases(study), ['a=[0.5, "x, \\"y\\""]', 'a={"type": box, "low": [0, 0]}', "a=plain words", 'a="1"', "a=true",
                                             'a="\\x07"'])

    def test_knows_where_values_and_names_stand(self):
        study = self.read("scene: scene.yaml\nvary: {time.end: [1, 2]}\ncollect: [steps, toe]\n")
        self.assertEqual(study.scene, Path("scene.yaml"))
        value = study.cases[1][0].entry
        self.assertEqual((value.line, value.column, value.key), (2, 22, "vary.time.end[1]"))
        self.assertEqual(([name.text for name in study.collect], study.collect[1].entry.line), (["steps", "toe"], 3))

    def test_says_all_that_is_wrong_at_once(self):
        self.assert_says("scene: other.yaml\nvary:\n  a=b: [1]\n  time.end: 3\n  time.cfl: []\ncombine: gridd\ncolect: [a]\n",
                         "study.yaml:1:8: error: scene: there is no file other.yaml",
                         'study.yaml:3:3: error: vary.a=b: "a=b" is no path of keys',
                         "study.yaml:4:13: error: vary.time.end: expected a list of values, found \"3\"",
                         "study.yaml:5:13: error: vary.time.cfl: the list is empty",
                         'study.yaml:6:10: error: combine: "gridd" — did you mean "grid"?',
                         'study.yaml:7:1: error: unknown key "colect" — did you mean "collect"?', "6 errors, nothing was run.")

    def test_refuses_what_makes_no_cases(self):
        self.assert_says("scene: scene.yaml\n", 'missing key "vary"')
        self.assert_says("scene: scene.yaml\nvary: {}\n", "study.yaml:2:7: error: vary: expected a mapping of keys")
        for nothing in ("", " [1, 2]"):
            self.assert_says(f"scene: scene.yaml\nvary:{nothing}\n", "vary: expected a mapping of keys")
        self.assert_says("vary: {a: [1]}\n", 'missing key "scene"')
        self.assert_says("scene: scene.yaml\nvary: {a: &b [1], c: *b}\n", "study.yaml:2:11: error: anchors, aliases and tags are not read")

    def test_refuses_rows_of_unequal_length_and_cases_twice(self):
        self.assert_says("scene: scene.yaml\nvary:\n  a: [1, 2]\n  b: [1]\ncombine: rows\n",
                         "study.yaml:4:6: error: vary.b: has 1 values where a has 2")
        self.assert_says("scene: scene.yaml\nvary:\n  a: [1, 2, 1]\n", "study.yaml:3:13: error: vary.a[2]: 1 stands here twice")
        self.assertEqual(self.errors("scene: scene.yaml\nvary:\n  a: [1, 1]\n  b: [1, 2]\ncombine: rows\n"), "none")
        many = list(range(101))
        self.assert_says(f"scene: scene.yaml\nvary:\n  a: {many}\n  b: {many}\n", "vary: these are more than 10000 cases")
        self.assert_says("scene: scene.yaml\nvary: {a: {low: 1, high: 2}}\ncombine: latin\nsamples: 10001\n",
                         "study.yaml:4:10: error: samples: these are more than 10000 cases")

    def test_says_what_is_no_distribution(self):
        self.assert_says(
            "scene: scene.yaml\nvary:\n  a: [1, 2]\n  b: {low: 2, high: 1}\n  c: {mean: 1}\n  d: {low: 1, mode: 3, high: 2}\n"
            "  e: {hihg: 1}\n  f: {distribution: gama, a: 2}\n  g: {distribution: beta, a: 2}\n  h: {mean: 1, deviation: 0}\n"
            "  i: {distribution: lognormal, mean: -1, deviation: 1}\n  j: {distribution: beta, a: -2, b: 1}\n"
            "  k: {distribution: weibull_min, c: 2, low: 5, high: 4}\ncombine: latin\n",
            "study.yaml:3:6: error: vary.a: expected a distribution, such as {low: 1, high: 2}",
            "study.yaml:4:6: error: vary.b: low 2 must be below high 1",
            "study.yaml:5:6: error: vary.c: mean and deviation belong together",
            "study.yaml:6:6: error: vary.d: mode 3 is not between low 1 and high 2",
            'study.yaml:7:7: error: vary.e: unknown key "hihg" — did you mean "high"?',
            'study.yaml:8:21: error: vary.f.distribution: unknown distribution "gama" — did you mean "gamma"?',
            "study.yaml:9:6: error: vary.g: beta needs b, as in scipy.stats.beta",
            "study.yaml:10:27: error: vary.h.deviation: 0 must be > 0",
            "study.yaml:11:6: error: vary.i: the mean -1 must be > 0", "study.yaml:12:6: error: vary.j: these are no parameters of beta",
            "study.yaml:13:6: error: vary.k: no value of this distribution lies between 5 and 4",
            "study.yaml:14:10: error: combine: latin needs samples")
        self.assert_says("scene: scene.yaml\nvary:\n  a: {low: 1, high: 2}\n",
                         "study.yaml:3:6: error: vary.a: a distribution is of combine: latin, sobol or tornado")
        self.assert_says("scene: scene.yaml\nvary:\n  a: [1]\nsamples: 3\ncorrelations: []\n",
                         "study.yaml:4:10: error: samples: is of combine: latin",
                         "study.yaml:5:15: error: correlations: is of combine: latin or sobol")

    def test_says_what_is_no_correlation(self):
        study = ("scene: scene.yaml\ncombine: sobol\nsamples: 4\nvary: {a: {low: 0, high: 1}, b: {low: 0, high: 1}, c: {low: 0, high: 1}}\n"
                 "correlations:\n")
        self.assert_says(study + "  - {between: [a, d], value: 0.5}\n  - {between: [a], value: 0.5}\n  - {between: [a, b], value: 1.5}\n"
                         "  - {between: [b, c], value: 0.5}\n  - {between: [c, b], value: 0.4}\n",
                         'study.yaml:6:19: error: correlations[0].between[1]: "d" is no key of vary that has a distribution',
                         "study.yaml:7:15: error: correlations[1].between: expected two different keys",
                         "study.yaml:8:30: error: correlations[2].value: 1.5 must be in [-1, 1]",
                         "study.yaml:10:15: error: correlations[4].between: these two keys stand here twice")
        pairs = "".join(f"  - {{between: [{pair}], value: -0.9}}\n" for pair in ("a, b", "b, c", "a, c"))
        self.assert_says(study + pairs, "study.yaml:6:3: error: correlations: no variables have all of these correlations")


class Samples(Studies):
    def test_fill_each_part_of_each_distribution_once(self):
        one = "scene: scene.yaml\nvary:\n  a: {low: 10, high: 20}\n"
        text = one + "  b: {low: 0, mode: 1, high: 4}\ncombine: latin\nsamples: 10\n"
        study = self.read(text)
        a, b = self.column(study, 0), self.column(study, 1)
        self.assertEqual(len(a), 10)
        self.assertTrue(np.any(np.diff(a) < 0))
        np.testing.assert_array_equal(self.column(self.read(text + "seed: 1\n"), 0), a)
        self.assertTrue(np.any(self.column(self.read(text + "seed: 2\n"), 0) != a))
        np.testing.assert_array_equal(self.column(self.read(one + "combine: latin\nsamples: 10\n"), 0), a, "another key changes nothing")
        np.testing.assert_array_equal(np.sort(np.floor(a - 10)), np.arange(10))
        below = np.where(b < 1, b * b / 4, 1 - (4 - b)**2 / 12)  # share of the triangle up to b
        np.testing.assert_array_equal(np.sort(np.floor(10 * np.clip(below, 1e-5, 1 - 1e-5))), np.arange(10))

    def test_of_sobol_are_more_even_than_by_chance_and_complain_of_other_numbers_than_powers_of_two(self):
        text = "scene: scene.yaml\nvary: {a: {low: 0, high: 1}, b: {low: 0, high: 1}}\ncombine: sobol\nsamples: "
        study = self.read(text + "64\n")
        points = np.column_stack([self.column(study, 0), self.column(study, 1)])
        counts = np.histogram2d(*points.T, bins=8, range=[[0, 1], [0, 1]])[0]
        np.testing.assert_array_equal(counts, 1)
        self.assertEqual((self.cases(self.read(text + "64\n")), study.warnings), (self.cases(study), []))
        self.assertNotEqual(self.cases(self.read(text + "64\nseed: 2\n")), self.cases(study))
        odd = self.read(text + "40\n")
        self.assertEqual((len(odd.cases), self.cases(odd)), (40, self.cases(study)[:40]))
        self.assertIn("40 is no power of two", odd.warnings[0])

    def distribution(self, text):
        return read_distribution(Block(read_yaml(self.write("one.yaml", f"a: {text}\n"))).take("a"))

    def test_quantiles_are_those_of_the_distributions(self):
        normal = self.distribution("{mean: 5, deviation: 2}")
        self.assertAlmostEqual(float(normal.quantile(0.5)), 5, 12)
        one_of_three = 0.5 + 0.5 * math.erf(math.sqrt(0.5)) / math.erf(3 * math.sqrt(0.5))
        self.assertAlmostEqual(float(normal.quantile(one_of_three)), 7, 9)
        self.assertGreaterEqual(normal.quantile(1e-12), -1)
        self.assertAlmostEqual(float(self.distribution("{mean: 5, deviation: 2, low: 4}").quantile(1e-9)), 4, 6)
        triangle = self.distribution("{low: 1, mode: 2, high: 5}")
        self.assertAlmostEqual(float(triangle.quantile(0.25)), 2, 12)
        self.assertAlmostEqual(float(triangle.quantile(0.75)), 5 - math.sqrt(0.25 * 4 * 3), 12)

    def test_a_lognormal_distribution_has_the_mean_and_deviation_that_are_given(self):
        values = self.distribution("{distribution: lognormal, mean: 20, deviation: 5}").quantile((np.arange(200000) + 0.5) / 200000)
        self.assertAlmostEqual(values.mean(), 20, 2)
        self.assertAlmostEqual(values.std(), 5, 2)
        self.assertLessEqual(self.distribution("{distribution: lognormal, mean: 20, deviation: 5, high: 30}").quantile(1 - 1e-9), 30)

    def test_any_continuous_distribution_of_scipy_is_known_and_can_be_cut_off(self):
        gamma = self.distribution("{distribution: gamma, a: 2, scale: 3, loc: 1}")
        np.testing.assert_allclose(gamma.quantile([0.1, 0.9]), stats.gamma(2, loc=1, scale=3).ppf([0.1, 0.9]))
        np.testing.assert_allclose(gamma.three, stats.gamma(2, loc=1, scale=3).ppf(stats.norm.cdf([-1, 0, 1])))
        cut = self.distribution("{distribution: gamma, a: 2, scale: 3, loc: 1, low: 4, high: 8}")
        np.testing.assert_allclose(cut.quantile([0, 1]), [4, 8])
        whole = stats.gamma(2, loc=1, scale=3)
        self.assertAlmostEqual(whole.cdf(cut.quantile(0.5)), (whole.cdf(4) + whole.cdf(8)) / 2)

    def test_are_correlated_as_the_copula_says_and_each_is_still_in_its_part(self):
        correlations = np.array([[1, -0.6, 0], [-0.6, 1, 0], [0, 0, 1]])
        alone = shares_of(["a", "b", "c"], 200, 1, "latin", np.eye(3))
        latin = shares_of(["a", "b", "c"], 200, 1, "latin", correlations)
        np.testing.assert_array_equal(latin[:, 2], alone[:, 2])
        for k in range(3):
            np.testing.assert_array_equal(np.sort(np.floor(200 * latin[:, k])), np.arange(200))
        sobol = shares_of(["a", "b", "c"], 256, 1, "sobol", correlations)
        for shares, close in ((latin, 0.02), (sobol, 0.05)):
            found = np.corrcoef(stats.norm.ppf(shares), rowvar=False)
            self.assertAlmostEqual(found[0, 1], -0.6, delta=close)
            self.assertAlmostEqual(found[0, 2], 0, delta=0.12)
            self.assertAlmostEqual(rank_correlation(shares[:, 0], shares[:, 1]), 6 / math.pi * math.asin(-0.3), delta=0.05)


class Parts(InAFolder):
    def test_rank_correlation_is_that_of_ranks_not_of_values(self):
        x = np.arange(1.0, 6)
        self.assertAlmostEqual(rank_correlation(x, np.array([1, 10, 11, 1000, 1e6])), 1, 12)
        self.assertAlmostEqual(rank_correlation(x, x[::-1]), -1, 12)
        self.assertTrue(math.isnan(rank_correlation(x, np.full(5, 7.0))))
        # 1 - 6 sum d^2 / (n (n^2 - 1)); ties share their mean rank
        self.assertAlmostEqual(rank_correlation(x, np.array([2.0, 1, 4, 3, 5])), 1 - 6 * 4 / (5.0 * 24), 12)
        self.assertAlmostEqual(rank_correlation(np.array([1.0, 1, 2]), np.array([1.0, 2, 3])), math.sqrt(0.75), 12)

    def test_texts_of_tables(self):
        names = {"max(kinetic) [J]": "max_kinetic", "bodies[0].mass [kg]": "bodies_0_.mass", "toe": "toe"}
        self.assertEqual([file_word(name) for name in names], list(names.values()))
        self.assertEqual([cell(word) for word in ("=1+1", "-2", "'=a", "a")], ["'=1+1", "-2", "''=a", "a"])

    def test_a_share_has_the_grid_of_a_map_and_is_read_back(self):
        (self.folder / "maps").mkdir()
        self.write("maps/height.asc", "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 50\ncellsize 2\nNODATA_value -9999\n1 2 3\n4 -9999 6\n")
        self.write("maps/height.prj", "PROJCS[]")
        like = read_map(self.folder, "height")
        write_share(self.folder / "share.tif", np.array([[0, 0.5, 1], [0.25, 0, 0.125]]), like)
        back = talus.Raster(self.folder / "share.tif")
        np.testing.assert_array_equal(back.values, np.array([[0, 0.5, 1], [0.25, 0, 0.125]], "f4"))
        self.assertEqual((back.x.tolist(), back.y.tolist(), back.crs), ([101, 103, 105], [53, 51], ""))
        self.assertEqual((self.folder / "share.prj").read_text(encoding="utf-8"), "PROJCS[]")
        self.assertTrue(like.has_grid_of(like))
        self.assertFalse(like.has_grid_of(CaseMap(like.path, like.values, like.x + 1, like.y)))
        self.assertIsNone(read_map(self.folder, "depth"))

    def test_cores_are_divided(self):
        with unittest.mock.patch.dict(os.environ, {"OMP_NUM_THREADS": "8"}):
            self.assertEqual(divide_cores(None, None, None, 20), Share(8, 1))
            self.assertEqual(divide_cores(None, None, None, 2), Share(2, 4))
            self.assertEqual(divide_cores(3, None, None, 20), Share(3, 2))
            self.assertEqual(divide_cores(None, 4, None, 20), Share(2, 4))
            self.assertEqual(divide_cores(None, None, "mpirun", 20), Share(8, None))

    def test_a_summary_of_another_run_says_why_it_does_not_count(self):
        run = PlannedRun(Path("scene.yaml"), ["time.end=1"], self.folder / "out", "1", "2")
        self.assertEqual(state_of(run), RunState())
        run.folder.mkdir()
        for text, why in (("{", "is not the summary of a run"), ("[]", "is not the summary of a run"),
                          ('{"scene": {"digest": "0"}, "mesh": {}, "stages": [], "program": {}}', "of another scene"),
                          ('{"scene": {"digest": "1"}, "mesh": {"digest": "0"}, "stages": [], "program": {}}', "of another mesh"),
                          ('{"status": "done", "scene": {"digest": "1"}, "mesh": {"digest": "2"}, "stages": [{"result": "quick"}], '
                           '"program": {}}', "are of a quick run")):
            self.write("out/summary.json", text)
            self.assertIn(why, state_of(run).why)

    def test_a_queue_that_breaks_off_ends_its_runs_and_waits_for_them(self):
        began, ended = self.folder / "began", self.folder / "ended"
        script = self.write("slow", f"#!/bin/sh\ntrap 'sleep 0.2; touch {ended}; exit 4' TERM\ntouch {began}\nsleep 20 & wait\n")
        script.chmod(0o755)

        def fail(line):
            while not began.exists():
                time.sleep(0.01)
            raise OSError(line)
        runs = [("run 1", PlannedRun(Path("scene.yaml"), [], self.folder / "out"))]
        queue = RunQueue(runs, lambda _: RunState(), script, Share(1, 1), tell=fail)
        with self.assertRaisesRegex(OSError, "run 1: begins"):
            queue([0])
        self.assertTrue(ended.exists())


class Sweeps(Studies):
    def sweep(self, text, **options):
        self.write("study.yaml", "scene: scene.yaml\n" + text)
        return talus.sweep("study.yaml", **{"out": "out", "threads": 1, "pictures": False, **options})

    def test_give_a_table_with_the_results_and_do_not_repeat_what_is_done(self):
        vary = 'vary: {"materials[0].youngs_modulus": [1.0e5, 2.0e5]}\ncollect: [max(kinetic), steps]\n'
        lines = []
        found = self.sweep(vary, tell=lines.append)
        frame = found.to_pandas()
        self.assertEqual((list(frame.index), list(frame["status"])), ([1, 2], ["done", "done"]))
        self.assertEqual(frame["max(kinetic)"][2], found.run(2).history["kinetic"].max())
        self.assertEqual(frame.attrs["units"]["max(kinetic)"], "J")
        self.assertTrue(any(line.startswith("case 2: done after") for line in lines))
        again = []
        self.sweep(vary, tell=again.append)
        self.assertIn("study.yaml: 0 of 2 cases", again[0])

    def test_of_a_dictionary_with_samples_have_findings_and_pictures(self):
        study = {"scene": Path("scene.yaml"), "combine": "sobol", "samples": 8, "collect": ["steps", "simulated_time"],
                 "vary": {"time.end": {"low": 0.005, "high": 0.015},
                          "materials[0].youngs_modulus": {"distribution": "lognormal", "mean": 1e5, "deviation": 3e4}},
                 "correlations": [{"between": ["time.end", "materials[0].youngs_modulus"], "value": 0.7}]}
        found = talus.sweep(study, out="runs/sobol", threads=1)
        self.assertAlmostEqual(found.correlations["time.end"][list(found.correlations["number"]).index("simulated_time [s]")], 1)
        shares = found.exceedance("simulated_time")
        np.testing.assert_allclose(shares["share_of_cases"], np.arange(8, 0, -1) / 8)
        self.assertTrue(np.all(np.diff(shares["simulated_time"]) > 0))
        for name in ("correlation", "exceedance_simulated_time", "exceedance_steps"):
            self.assertGreater((self.folder / f"runs/sobol/{name}.png").stat().st_size, 5000)
        with self.assertRaisesRegex(FileNotFoundError, "combine: tornado"):
            found.tornado("steps")

    def test_of_one_key_at_a_time_have_a_tornado(self):
        found = self.sweep('vary: {time.end: {low: 0.005, high: 0.015}, "loads[0].acceleration[1]": {mean: -5, deviation: 0.1}}\n'
                           "combine: tornado\ncollect: [simulated_time]\n", pictures=True)
        table = found.tornado("simulated_time")
        self.assertEqual(list(table["key"]), ["time.end", "loads[0].acceleration[1]"])
        np.testing.assert_allclose(table["at high: simulated_time"], [0.015, 0.01])
        self.assertGreater((self.folder / "out/tornado_simulated_time.png").stat().st_size, 5000)

    def test_that_fail_name_the_cases_when_the_others_are_done(self):
        with self.assertRaisesRegex(talus.RunFailed, r"1 of 2 cases failed; .*\n  case 2 \(bodies\[0\].velocity=\[900, 0\]\): .*"):
            self.sweep('vary: {"bodies[0].velocity": [[0, 0], [900, 0]]}\n')
        self.assertEqual(list(talus.Sweep("out").table["status"]), ["done", "failed"])

    def test_that_are_wrong_write_nothing(self):
        with self.assertRaises(talus.SceneError) as raised:
            self.sweep('vary: {"materials[0].youngs_modulus": [1.0e5, -1], "bodies[0].material": [rubber, rubbr]}\n')
        self.assertEqual([(message.line, message.column) for message in raised.exception.errors], [(2, 47), (2, 83)])
        self.assertFalse(Path("out").exists())
        with self.assertRaisesRegex(talus.SceneError, "there is no case 3: study.yaml has 1"):
            self.sweep("vary: {time.end: [0.01]}\n", case=3)
        Path("out").mkdir()
        self.write("out/summary.json", "{}")
        with self.assertRaisesRegex(talus.EnvironmentFailure, "holds the results of a run"):
            self.sweep("vary: {time.end: [0.01]}\n")


if __name__ == "__main__":
    InAFolder.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
