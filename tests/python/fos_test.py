#!/usr/bin/python3
"""Tests of talus.factor_of_safety and of the command talus fos: a bank whose factor is known.

Usage: fos_test.py PROGRAM, the built talus.
"""
import csv
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from scratch import InAFolder  # noqa: E402

FACTOR = 3.83 * 1e4 / (2000 * 9.81)  # coarse cells find the upper bound
AT_REST = "stages: [{type: geostatic, duration: 20, residual: 1.0e-2}, {type: run, duration: 60}]\n"
STATIC = "stages: [{type: static, increments: 2, initial_stress: {k0: 0.7}}, {type: run, duration: 60}]\n"


def bank(stages, law="mohr_coulomb, friction_angle: 0, cohesion: 1.0e4", body=""):
    """A vertical bank of clay 1 m high, which fails where c = 0.26 to 0.27 of its weight times its height (Taylor 1937; upper bound
    1 / 3.83)."""
    return ("title: Bank\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [3, 1.25], cells: [12, 5]}}\n"
            f"materials: [{{name: clay, law: {law}, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.4}}]\n"
            "bodies: [{name: bank, material: clay, shape: {type: box, low: [0, 0], high: [1.5, 1]}, particles_per_cell: 3, f_bar: true"
            f"{body}}}]\nloads: [{{type: gravity, acceleration: [0, -9.81]}}]\n"
            "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\non_exit: delete\n" + stages)


class OfABank(InAFolder):
    def fos(self, *words, scene="bank.yaml"):
        """The command: exit code, output, complaints."""
        told = subprocess.run([self.program, "fos", scene, "--out", "out", "--threads", "1", "--no-pictures", *words], capture_output=True,
                              encoding="utf-8", check=False)
        return told.returncode, told.stdout, told.stderr

    def contents(self):
        return json.loads(Path("out/fos.json").read_text(encoding="utf-8"))

    def test_finds_where_a_bank_fails_and_goes_on_with_what_is_there(self):
        self.write("bank.yaml", bank(AT_REST))
        code, out, complaint = self.fos("--from", "1", "--to", "4", "--width", "1", "--jobs", "2")
        self.assertEqual(code, 0, complaint)
        for text in ("at rest: begins", "strength divided by 4", "1: begins (as it is)", "factor of safety "):
            self.assertIn(text, out)
        code, out, complaint = self.fos("--from", "1", "--to", "4", "--width", "0.5", "--jobs", "2")
        self.assertEqual(code, 0, complaint)
        for text in ("at rest: done before", "trials judged before"):
            self.assertIn(text, out)
        self.assertNotIn("1: begins", out)
        with open("out/fos.csv", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], ["factor", "verdict", "moved [m]", "growth", "kinetic_over_peak", "duration [s]", "by_growth_alone",
                                   "steadiness", "message"])
        self.assertEqual((rows[1][:2], rows[-1][:2]), (["1", "holds"], ["4", "fails"]))
        contents = self.contents()
        self.assertEqual(list(contents), ["scene", "commit", "factor_of_safety", "highest_that_holds", "lowest_that_fails",
                                          "hold_above_that", "width", "bodies", "criterion", "trials"])
        self.assertAlmostEqual(contents["factor_of_safety"], FACTOR, delta=0.5)
        self.assertTrue(contents["highest_that_holds"] < contents["factor_of_safety"] < contents["lowest_that_fails"])

        words = shlex.split(contents["trials"][0]["command"])
        words[words.index("--out") + 1] = "alone"
        subprocess.run([self.program, *words[1:], "--quiet"], check=True)
        self.assertEqual(Path("alone/history.csv").read_bytes(), Path("out/trial_1/history.csv").read_bytes(), "a trial can be repeated")

    def test_a_trial_has_the_strength_of_a_scene_with_other_parameters(self):
        """Bitwise the run with a cohesion that was divided by hand."""
        self.write("bank.yaml", bank(AT_REST))
        self.assertEqual(self.fos("--from", "1", "--to", "4", "--width", "3", "--jobs", "2")[0], 0)
        run = talus.FactorOfSafety("out").trial(4)
        changes = [change.replace(", weaken: [{body: bank, factor: 4.0}]", "") for change in run.summary["scene"]["set"]]
        self.assertNotEqual(changes, run.summary["scene"]["set"])
        words = [word for change in [*changes, "materials[0].cohesion=2500"] for word in ("--set", change)]
        subprocess.run([self.program, "run", "bank.yaml", "--out", "by_hand", "--quiet", *words], check=True)
        self.assertEqual(Path("by_hand/history.csv").read_bytes(), (run.folder / "history.csv").read_bytes())

    def test_from_python_with_a_scene_as_dictionary_and_pictures(self):
        clay = {"name": "clay", "law": "von_mises", "yield_stress": 17320, "density": 2000, "youngs_modulus": 2e6, "poisson_ratio": 0.4}
        scene = {"title": "Bank", "dimension": 2, "mesh": {"grid": {"low": [0, 0], "high": [3, 1.25], "cells": [12, 5]}},
                 "materials": [clay],
                 "bodies": [{"name": "bank", "material": "clay", "shape": {"type": "box", "low": [0, 0], "high": [1.5, 1]},
                             "particles_per_cell": 3, "f_bar": True}],
                 "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
                 "boundaries": [{"type": "fixed", "on": "y_min"}, {"type": "roller", "on": "x_min"}, {"type": "roller", "on": "x_max"}],
                 "on_exit": "delete", "stages": [{"type": "geostatic", "duration": 20, "residual": 1e-2}]}
        told = []
        found = talus.factor_of_safety(scene, out="out", low=1, high=4, width=1.5, jobs=2, threads=1, tell=told.append,
                                       set={"bodies[0].particles_per_cell": 4})
        self.assertTrue(found.holds < found.factor < found.fails)
        self.assertIn(f"factor of safety {found.factor:.6g}: holds at", str(found))
        self.assertEqual(found.trials["factor"].tolist(), sorted(found.trials["factor"]))
        self.assertEqual(found.trial(4).status, "done")
        self.assertEqual(found.at_rest.summary["scene"]["set"][0], "bodies[0].particles_per_cell=4")
        can_render = Path(self.program).with_name("talus-render").exists()
        for name in ("fos.png", "fos_growth.png", *(["mechanism.png"] if can_render else [])):
            self.assertTrue(Path("out", name).read_bytes().startswith(b"\x89PNG"), told)
        self.assertEqual(Path("out/fos_curve.csv").read_text(encoding="utf-8").splitlines()[0], "factor,displacement [m],growth [-]")

    def test_static_trials_find_the_factor_that_runs_find(self):
        """Each increment of a static trial has the same loads: a bank that stands moves in the first one only, one that fails in each."""
        self.write("bank.yaml", bank(STATIC).replace("cells: [12, 5]", "cells: [24, 10]"))
        code, out, complaint = self.fos("--from", "1.75", "--to", "2.25", "--width", "0.25", "--jobs", "2")
        self.assertEqual(code, 0, complaint)
        self.assertIn("6 equilibria each; fails: growth above 0.1 and steadiness above 0.5, or no equilibrium", out)
        self.assertAlmostEqual(self.contents()["factor_of_safety"], FACTOR, delta=0.25)  # runs find 1.875
        self.assertIn("type: static, increments: 6", Path("out/trial_1.75/summary.json").read_text(encoding="utf-8"))
        self.assertEqual(self.fos("--duration", "2")[0], 2)
        self.assertIn("belong to trials that are runs", self.fos("--kinetic", "1.0e-3")[2])
        _, out, _ = self.fos("--from", "1.75", "--to", "2.25", "--width", "0.5", "--growth", "10", "--steadiness", "2", "--jobs", "2")
        self.assertIn(" 2  holds", out, "neither limit is reached")
        self.assertEqual(self.fos("--trials", "damped")[0], 2)
        self.write("bank.yaml", bank(AT_REST))
        self.assertIn("--increments and --steadiness belong to static trials", self.fos("--increments", "4")[2])

    def test_says_what_keeps_strength_from_being_divided(self):
        self.write("bank.yaml", bank("time: {end: 1}\n"))
        code, _, complaint = self.fos()
        self.assertEqual(code, 2)
        self.assertIn("bank.yaml: error: stages: there is no stage of type geostatic or static", complaint)
        self.write("bank.yaml", bank(AT_REST, "neo_hookean"))
        code, _, complaint = self.fos("--bodies", "bank")
        self.assertEqual(code, 2)
        self.assertIn('bank.yaml:5:10: error: bodies[0] "bank": --bodies: its material "clay" has no strength to divide', complaint)
        self.assertIn("no body has a material with strength", self.fos()[2])
        self.write("bank.yaml", bank(AT_REST))
        self.assertIn("--bodies: in the state at rest: no body bnk: did you mean bank?", self.fos("--bodies", "bnk")[2])
        for words in (("--from", "2", "--to", "1"), ("--width", "0"), ("--width", "wide"), ("--share", "2")):
            self.assertEqual(self.fos(*words)[0], 2, words)
        with self.assertRaises(talus.SceneError) as raised:
            talus.factor_of_safety("bank.yaml", low=2, high=1, width=0, trials="damped", out="out")
        self.assertEqual(len(str(raised.exception).splitlines()), 3, "all errors are told")
        self.write("bank.yaml", bank(AT_REST).replace("density: 2000", "density: -1").replace("poisson_ratio: 0.4", "poisson_ratio: 2"))
        self.assertRegex(self.fos()[2], r"(?s)bank.yaml:4:\d+: error: .*density.*bank.yaml:4:\d+: error: .*poisson_ratio")
        self.assertFalse(Path("out").exists())

    def test_loads_that_change_at_rest_are_refused_as_time_begins_anew_in_trials(self):
        grows = bank(AT_REST).replace("[0, -9.81]}]", "[0, -9.81], table: [[0, 0], [5, 1]]}]")
        self.write("bank.yaml", grows)
        code, _, complaint = self.fos()
        self.assertEqual(code, 2)
        self.assertIn("loads[0].table: time begins anew in the trials", complaint)
        self.assertFalse(Path("out").exists())

    def test_another_mesh_of_the_same_name_begins_the_search_anew(self):
        scene = bank(AT_REST).replace("mesh: {grid: {low: [0, 0], high: [3, 1.25], cells: [12, 5]}}", "mesh: {file: bank.msh}")
        words = ("--from", "1", "--to", "4", "--width", "3", "--jobs", "2", "--duration", "0.2")
        for cells in ("[12, 5]", "[12, 6]"):
            self.write("grid.yaml", bank(AT_REST).replace("[12, 5]", cells))
            subprocess.run([self.program, "mesh", "grid.yaml", "--out", "bank.msh"], check=True, capture_output=True)
            self.write("bank.yaml", scene)
            code, out, complaint = self.fos(*words)
            self.assertIn(code, (0, 1), complaint)
            self.assertIn("at rest: begins", out)
        self.assertIn("done before", self.fos(*words)[1])

    def test_trials_keep_what_a_body_is_and_not_how_it_is_filled(self):
        """All that a body can say of how it is filled, a water table that moves before the state at rest, a wall for one stage only."""
        scene = bank("water: {table: {elevation: 0.2}}\nstages: [{type: geostatic, duration: 20, residual: 1.0e-2, name: first, "
                     "initial_stress: {k0: 0.6}}, {type: geostatic, duration: 20, residual: 1.0e-2, name: second, water: {table: "
                     "{elevation: 0.4}}}, {type: run, duration: 60, water: {table: {elevation: 0.1}}}]\n",
                     body=", saturated_density: 2100, velocity: [0, 0]")
        self.write("bank.yaml", scene.replace("on: x_max", "where: x_max, during: [second]"))
        code, _, complaint = self.fos("--from", "1", "--to", "4", "--width", "3", "--jobs", "2", "--quick", "--duration", "1")
        self.assertIn(code, (0, 1), complaint)
        summary = talus.open("out/trial_4").summary
        self.assertEqual(summary["status"], "done", complaint)
        self.assertIn("water.table={elevation: 0.4}", summary["scene"]["set"], "that of the state at rest")
        self.assertIn("bodies=[{name: bank, material: clay, f_bar: true}]", summary["scene"]["set"])

    def test_a_body_has_the_material_that_it_has_at_rest(self):
        """Bodies of one material, of which one is weakened; the material changed and weakened before the state at rest."""
        scene = bank("stages: [{type: geostatic, duration: 20, residual: 1.0e-2}, {type: geostatic, name: second, duration: 20, residual: "
                     "1.0e-2, change: [{body: bank, material: firm}], weaken: [{body: bank, factor: 1.25}]}]\n")
        scene = scene.replace("materials: [{", "materials: [{name: firm, law: mohr_coulomb, friction_angle: 0, cohesion: 2.5e4, "
                                               "density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.4}, {")
        scene = scene.replace("bodies: [", "bodies: [{name: base, material: firm, shape: {type: box, low: [1.5, 0], high: [3, 0.25]}, "
                                           "particles_per_cell: 3}, ")
        self.write("bank.yaml", scene)
        code, _, complaint = self.fos("--from", "1", "--to", "4", "--width", "3", "--jobs", "2", "--quick", "--bodies", "bank")
        self.assertIn(code, (0, 1), complaint)
        changes = talus.open("out/trial_4").summary["scene"]["set"]
        self.assertIn("bodies=[{name: base, material: firm}, {name: bank, material: firm, f_bar: true}]", changes)
        self.assertIn("weaken: [{body: bank, factor: 5.0}]", next(change for change in changes if change.startswith("stages=")))

    def test_a_trial_that_breaks_off_has_failed(self):
        self.write("bank.yaml", bank(AT_REST).replace("on_exit: delete\n", "watch: {speed: 0.5, on_speed: stop}\n"))
        words = ("--from", "1", "--to", "8", "--width", "7", "--jobs", "2")
        code, out, complaint = self.fos(*words)
        self.assertEqual(code, 0, complaint)
        self.assertIn("the run broke off: ", out)
        self.assertIn("\n8,fails,,,,,0,,", Path("out/fos.csv").read_text(encoding="utf-8"))
        _, out, _ = self.fos(*words)
        self.assertIn("2 trials judged before", out)
        self.assertNotIn("begins", out)

    def test_a_search_that_is_stopped_goes_on_from_the_checkpoints(self):
        self.write("bank.yaml", bank(AT_REST.replace("residual: 1.0e-2", "residual: 1.0e-9")).replace("cells: [12, 5]", "cells: [48, 20]"))
        process = subprocess.Popen([self.program, "fos", "bank.yaml", "--out", "out", "--threads", "1", "--jobs", "1", "--no-pictures"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        deadline = time.monotonic() + 60
        while not Path("out/at_rest/progress.json").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        complaint = process.communicate(timeout=60)[1].decode()
        self.assertEqual(process.returncode, 4, complaint)
        self.assertIn("the same command goes on, with the runs that are done in out", complaint)
        self.assertEqual(talus.open("out/at_rest").status, "stopped")
        process = subprocess.Popen([self.program, "fos", "bank.yaml", "--out", "out", "--threads", "1", "--jobs", "1", "--no-pictures"],
                                   stdout=subprocess.PIPE)
        self.assertIn(b"strength of bank divided", process.stdout.readline())
        self.assertIn(b"at rest: goes on", process.stdout.readline())
        code, _, complaint = self.fos()
        self.assertEqual(code, 3, "two searches in one folder")
        self.assertIn("another process is at work in out", complaint)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4)

    def test_the_state_at_rest_may_not_be_found(self):
        self.write("bank.yaml", bank(AT_REST.replace("duration: 20", "duration: 0.01")))
        code, _, complaint = self.fos()
        self.assertEqual(code, 1)
        self.assertIn("the state at rest was not found: ", complaint)
        self.assertEqual(self.fos("--launcher", "no_such_launcher")[0], 3)
        shutil.rmtree("out")
        subprocess.run([self.program, "run", "bank.yaml", "--quick", "--quiet", "--out", "out"], check=True)
        code, _, complaint = self.fos()
        self.assertEqual(code, 3)
        self.assertIn("out holds the results of a run: choose another folder with --out", complaint)


if __name__ == "__main__":
    os.environ["OMP_WAIT_POLICY"] = "passive"
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
