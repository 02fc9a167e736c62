#!/usr/bin/python3
"""Tests of talus.differences and of the command talus diff.

Usage: diff_test.py PROGRAM, the built talus.
"""
import math
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.differences.values import compare, largest_modulus, match_ids, match_times  # noqa: E402
from scratch import InAFolder  # noqa: E402

SCENE = """\
title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 2], cells: [8, 8]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: block, material: rubber, shape: {type: box, low: [0.5, 0], high: [1.5, 1]}, particles_per_cell: 3}
time: {end: 0.02}
loads: [{type: gravity, acceleration: [0.3, -9.81]}]
boundaries: [{type: friction, on: y_min, coefficient: 0.3}]
outputs:
  particles: {every: 0.01, fields: [velocity, stress]}
  mesh: {every: 0.01, fields: [mass, velocity]}
  history: {every: 0.01}
"""


class Values(unittest.TestCase):
    def test_times_are_matched_to_their_round_off(self):
        pairs = match_times(np.array([0, 0.1, 0.2, 0.3]), np.array([0, 0.1 * (1 + 1e-13), 0.2 * (1 + 1e-11), 0.4]))
        self.assertEqual((pairs.a.tolist(), pairs.b.tolist()), ([0, 1], [0, 1]))
        self.assertEqual((pairs.only_a.tolist(), pairs.only_b.tolist()), ([2, 3], [2, 3]))
        self.assertEqual(match_times(np.array([]), np.array([1.0])).only_b.tolist(), [0])

    def test_particles_are_matched_by_their_ids_in_any_order(self):
        pairs = match_ids(np.array([7, 3, 5]), np.array([5, 9, 7]))
        self.assertEqual(list(zip(pairs.a, pairs.b)), [(2, 0), (0, 2)])
        self.assertEqual((pairs.only_a.tolist(), pairs.only_b.tolist()), ([1], [1]))

    def test_the_largest_difference_is_found_and_those_beyond_the_tolerance_are_counted(self):
        gap = compare(np.array([[1, 2], [3, 4], [5, 6]]), np.array([[1, 2.5], [3, 3], [5.25, 6]]), 0.25)
        self.assertEqual((gap.values, gap.differing), (6, 2), "what is as far apart as allowed does not differ")
        self.assertEqual((gap.largest, gap.row, gap.component, gap.a, gap.b), (1, 1, 1, 4, 3))

    def test_what_is_no_number_is_the_same_as_itself_only(self):
        def differing(a, b, tolerance):
            return compare(np.array([a]), np.array([b]), tolerance).differing
        self.assertEqual(differing(math.nan, math.nan, 0), 0)
        self.assertEqual(differing(math.inf, math.inf, 0), 0)
        self.assertEqual(differing(0.0, -0.0, 0), 0)
        self.assertEqual(differing(math.nan, 1, 1e300), 1)
        self.assertEqual(differing(1, math.inf, math.inf), 1)
        self.assertEqual(differing(-math.inf, math.inf, 1), 1)
        self.assertEqual(largest_modulus(np.array([1, -3, math.nan, math.inf])), 3)


class OfRuns(InAFolder):
    """Results of a falling block in the folder `a`, to compare others with."""

    def setUp(self):
        super().setUp()
        self.write("block.yaml", SCENE)
        shutil.copytree(self.original, "a")

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        scene = Path(scratch.name) / "block.yaml"
        scene.write_text(SCENE, encoding="utf-8")
        cls.original = Path(scratch.name) / "a"
        subprocess.run([cls.program, "run", scene, "--quiet", "--out", cls.original], check=True)

    def run_scene(self, name, *words):
        subprocess.run([self.program, "run", "block.yaml", "--quiet", "--out", name, *words], check=True)

    def diff(self, *words):
        """The command: exit code, output, complaints."""
        told = subprocess.run([self.program, "diff", *words], capture_output=True, encoding="utf-8", check=False)
        return told.returncode, told.stdout, told.stderr

    def test_the_same_run_twice_is_the_same(self):
        self.run_scene("b", "--threads", "1")
        code, out, _ = self.diff("a", "b")
        self.assertEqual(code, 0, out)
        self.assertTrue(out.endswith("\nthe same\n"), out)
        self.assertRegex(out, "particles +unit +largest difference +over scale +where +values that differ")
        self.assertRegex(out, r"  velocity +m/s +0 +0 +- +0 of [0-9]+\n")
        self.assertRegex(out, r"  reaction_y_min_y +N +0 +0 +- +0 of [0-9]+\n")
        self.assertRegex(out, "made with the same scene.yaml, mesh.msh, .*version, commit")
        found = talus.diff("a", talus.open("b"))
        self.assertTrue(found.same)
        self.assertFalse(found, "there is no difference")
        self.assertEqual(found.lines["particles stress"].gap.values, 6 * len(talus.open("a").particles[0]["id"]) * found.tables[0].times)

    def test_another_density_differs_and_the_table_says_where(self):
        self.run_scene("b", "--set", "materials[0].density=1100")
        code, out, _ = self.diff("a", "b")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"  stress +Pa +[0-9.e+]+ +0\.[0-9]+ +t = 0\.02 s, particle [0-9]+, [xyz][xyz] +[1-9]")
        self.assertRegex(out, r"  mass +kg +[0-9.]+ +0\.09[01][0-9]* +t = 0\.02 s, node [0-9]+ +[1-9]")  # 1 of 11
        self.assertRegex(out, r"  mass +kg +100 +0\.0909 +t = 0 s, row 1 +[1-9]")
        self.assertRegex(out, r"only in a: [0-9]+ times?, the first t = 0\.01[0-9]* s", "other steps, so another first step after 0.01 s")
        self.assertRegex(out, r"\n[0-9]+ of [0-9]+ fields differ; not all is in both runs\n$")
        found = talus.diff("a", "b", last=True)
        stress, a, b = found.lines["particles stress"], *(talus.open(name).particles[-1] for name in ("a", "b"))
        self.assertAlmostEqual(stress.gap.largest, float(np.abs(a["stress"].astype(float) - b["stress"]).max()))
        self.assertIn("particles stress", found.differing)

    def test_what_is_within_the_tolerance_is_the_same(self):
        self.run_scene("b", "--set", "materials[0].density=1001", "--set", "time.cfl=0.3")
        self.assertEqual(self.diff("a", "b", "--last", "--field", "stress")[0], 1)
        self.assertEqual(self.diff("a", "b", "--last", "--field", "stress", "--relative", "1e-9")[0], 1)
        code, out, _ = self.diff("a", "b", "--last", "--field", "stress", "--relative", "0.5")
        self.assertEqual(code, 0, out)
        self.assertTrue(out.endswith("\nthe same\n"), out)
        self.assertEqual(self.diff("a", "b", "--last", "--field", "stress", "--absolute", "1e6")[0], 0, "[Pa]")
        self.assertEqual(self.diff("a", "b", "--field", "stress", "--relative", "0.5")[0], 1, "times that only one run has always differ")

    def test_compares_the_fields_that_are_asked_for(self):
        shutil.copytree("a", "b")
        code, out, _ = self.diff("--field", "velocity", "kinetic", "--last", "a", "b")
        self.assertEqual(code, 0)
        self.assertIn("velocity", out)
        self.assertIn("kinetic", out)
        self.assertNotIn("stress", out)
        code, _, complaint = self.diff("a", "b", "--field", "velocty")
        self.assertEqual((code, complaint), (2, "error: neither a nor b: no field velocty: did you mean velocity?\n"))

    def test_names_files_fields_and_times_that_only_one_run_has(self):
        shutil.copytree("a", "b")
        Path("b/history.csv").unlink()
        code, out, _ = self.diff("a", "b")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"  kinetic +J +- +- +only in a +-\n")
        self.run_scene("fewer", "--set", "outputs.particles.fields=[stress]")
        code, out, _ = self.diff("fewer", "a")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"  velocity +m/s +- +- +only in a +-\n")
        self.assertRegex(out, r"\n1 of [0-9]+ fields differ\n$")
        self.run_scene("longer", "--set", "time.end=0.03")
        code, out, _ = self.diff("a", "longer", "--field", "velocity")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"only in longer: [0-9] times?, the first t = 0\.0[0-9]+ s")

    def test_names_particles_that_only_one_run_has_and_other_meshes(self):
        self.run_scene("finer", "--set", "bodies[0].particles_per_cell=6")
        code, out, _ = self.diff("a", "finer", "--last", "--field", "stress")
        self.assertEqual(code, 1)
        more = r"only in finer: particles 96, 97, 98, 99, 100 and 91 more at t = 0\.02 s"
        self.assertRegex(out, more, "32 triangles of 3 or 6 particles")
        self.run_scene("coarser", "--set", "mesh.grid.cells=[4, 4]")
        code, out, _ = self.diff("a", "coarser")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"  position +m +- +- +81 and 25 nodes +-\n")
        self.assertIn("made with other scene.yaml, mesh.msh", out)

    def test_what_cannot_be_read_ends_with_two(self):
        self.assertEqual(self.diff("a")[0], 2)
        self.assertEqual(self.diff("a", "a", "--relative", "-1")[0], 2)
        self.assertEqual(self.diff("a", "nowhere"), (2, "", "error: nowhere holds no results of a run (no summary.json)\n"))
        with self.assertRaises(ValueError):
            talus.diff("a", "a", absolute=-1)
        shutil.copytree("a", "b")
        file = sorted(Path("b").glob("*.vtp"))[-1]
        whole = file.read_bytes()
        for wrong in (whole[:3 * len(whole) // 4], b"no XML"):  # the first as after a full disk
            file.write_bytes(wrong)
            code, out, complaint = self.diff("a", "b")
            self.assertEqual((code, out, complaint.count("\n")), (2, "", 1), complaint)
            self.assertTrue(complaint.startswith(f"error: {file}: "), complaint)
        file.unlink()
        code, _, complaint = self.diff("a", "b")
        self.assertEqual(code, 2)
        self.assertIn(str(file), complaint)
        file.write_bytes(whole)
        self.assertEqual(self.diff("a", "b")[0], 0)

    def test_damaged_histories_and_summaries_are_refused(self):
        shutil.copytree("a", "b")
        self.write("b/history.csv", "time [s],kinetic [J]\n0,1\n0,2\n")
        self.assertEqual(self.diff("a", "b"), (2, "", "error: b/history.csv: its times do not ascend: entry 2 is 0 s\n"))
        self.write("b/history.csv", "time [s],kinetic [J],toe [m],kinetic [m]\n0,1,2,3\n")
        self.assertEqual(self.diff("a", "b"), (2, "", 'error: b/history.csv: columns 2 and 4 are both called "kinetic"\n'))
        shutil.copy("a/history.csv", "b/history.csv")
        self.write("b/summary.json", "{}")
        self.assertIn("b/summary.json is not the summary of a run", self.diff("a", "b")[2])


if __name__ == "__main__":
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
