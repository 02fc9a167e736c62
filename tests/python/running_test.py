#!/usr/bin/python3
"""Tests of what python/talus does with the program: finds it, runs scenes, follows and resumes runs, passes on errors with their places.

Usage: running_test.py PROGRAM, the built talus.
"""
import contextlib
import io
import math
import os
import re
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.program import messages_of  # noqa: E402
from talus.running import default_folder  # noqa: E402
from scratch import InAFolder  # noqa: E402

SCENE = {
    "title": "A falling block",
    "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": np.array([2.0, 3.0]), "cells": (4, 6)}},
    "materials": [{"name": "rubber", "law": "neo_hookean", "density": np.float64(1000), "youngs_modulus": 1e5, "poisson_ratio": 0.3}],
    "bodies": [{"name": "block", "material": "rubber", "shape": {"type": "box", "low": [0.5, 1.5], "high": [1.5, 2.5]}, "velocity": None}],
    "loads": [{"type": "gravity", "acceleration": [0, -9.81]}],
    "time": {"end": 0.05},
    "outputs": {"particles": {"every": 0.05}, "history": {"every": 0.01}},
}
FREE_FALL = 9.81 * 0.05  # m/s, at the end


class Runs(InAFolder):
    def speed_at_the_end(self, run):
        history = run.history
        return -history["momentum_y"][-1] / history["mass"][-1]

    def test_a_dictionary_runs_as_the_file_with_the_same_text_does(self):
        of_dictionary = talus.run(SCENE, out="a", threads=1)
        self.assertEqual(of_dictionary.status, "done")
        # velocities are half a step before the time of the row
        half_step = of_dictionary.history["dt"][-1] / 2 * 9.81
        self.assertAlmostEqual(self.speed_at_the_end(of_dictionary), FREE_FALL, delta=2.1 * half_step)
        of_file = talus.run("a.yaml", out=Path("b"), threads=2)
        self.assertEqual([run.summary["cost"]["threads"] for run in (of_dictionary, of_file)], [1, 2])
        np.testing.assert_array_equal(of_file.history.array, of_dictionary.history.array)
        self.assertIn("block", of_file.bodies)
        self.assertIn("gravity_work", of_file.log)

    def test_changes_by_set_reach_the_run_whatever_their_type(self):
        run = talus.run(SCENE, out="a", set={"time.end": 0.02, "bodies[0].velocity": np.array([3.0, 0.0]), "title": 'two: "words", #1',
                                             "outputs.history": {"every": 0.01, "bodies": ["block"]}, "outputs.particles.fields": ["mass"]})
        self.assertEqual((run.summary["title"], run.summary["simulated_time [s]"]), ('two: "words", #1', 0.02))
        self.assertAlmostEqual(run.history["momentum_block_x"][0] / run.history["mass"][0], 3.0, places=12)

    def test_results_go_to_the_folder_that_the_program_would_take(self):
        for words in ("valley/scene.yaml", "study/slope.yaml"):
            path = self.folder / words
            path.parent.mkdir()
            path.write_text(talus.to_yaml(SCENE), encoding="utf-8")
            subprocess.run([self.program, "run", words, "--quiet"], check=True)
            self.assertTrue((default_folder(words) / "summary.json").exists(), words)
        self.assertEqual(talus.run(SCENE).folder, Path("runs/a_falling_block"))

    def test_errors_of_a_scene_have_their_places_and_nothing_is_run(self):
        wrong = {**SCENE, "time": {"end": -1, "wrong_key": 1}}
        with self.assertRaises(talus.SceneError) as caught:
            talus.run(wrong, out="a", set={"bodies[0].material": "rubbr"})
        error = caught.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual((error.code, error.run), (2, None))
        lines = Path("a.yaml").read_text(encoding="utf-8").splitlines()
        of_time = [message for message in error.errors if message.file == "a.yaml"]
        self.assertEqual([message.key for message in of_time], ["time.end", "time"])
        for message, what in zip(of_time, ("-1", "wrong_key")):
            self.assertTrue(lines[message.line - 1][message.column - 1:].startswith(what), message)
            self.assertEqual(message.source, lines[message.line - 1])
        of_set = [message.text for message in error.errors if message.file.startswith("--set bodies[0].material")]
        self.assertTrue(of_set and "rubber" in of_set[0], str(error))
        self.assertIn("a.yaml:", str(error))
        self.assertFalse(Path("a").exists())

    def test_a_run_that_fails_says_where_and_keeps_its_results(self):
        with self.assertRaises(talus.RunFailed) as caught:
            talus.run(SCENE, out="a", set={"watch.speed": 0.1})
        error = caught.exception
        self.assertEqual((error.code, error.run.status), (1, "failed"))
        message, = error.errors
        self.assertIn("watch.speed", message.text)
        place = Path(message.file).read_text(encoding="utf-8").splitlines()[message.line - 1]
        self.assertIn("block", place)
        self.assertGreater(error.run.history.rows, 0)

    def test_a_folder_that_must_not_be_replaced_is_a_failure_of_the_environment(self):
        stopped = talus.run(SCENE, out="a", until=3)
        self.assertEqual((stopped.status, stopped.summary["steps"]), ("stopped", 3))
        with self.assertRaisesRegex(talus.EnvironmentFailure, "can go on"):
            talus.run(SCENE, out="a")
        self.assertEqual(talus.run(SCENE, out="a", force=True).status, "done")

    def test_a_resumed_run_ends_as_one_without_a_stop(self):
        whole, stopped = talus.run(SCENE, out="a"), talus.run(SCENE, out="b", until=3)
        resumed = talus.resume(stopped)
        self.assertEqual((resumed.folder, resumed.status), (Path("b"), "done"))
        np.testing.assert_array_equal(resumed.history.array, whole.history.array)
        checkpoint, = talus.run(SCENE, out="c", until=3).folder.glob("checkpoints/*.h5")
        self.assertEqual(talus.resume(checkpoint, out="d").folder, Path("d"))

    def test_words_of_a_launcher_stand_before_the_program(self):
        launcher = "sh -c 'echo $2 $# >> started; exec \"$@\"' launcher"
        talus.run(SCENE, out="a", until=3, launcher=launcher)
        self.assertEqual(talus.resume("a", launcher=launcher).status, "done")
        self.assertEqual([line.split()[0] for line in Path("started").read_text(encoding="utf-8").splitlines()], ["run", "run"])
        with self.assertRaises(FileNotFoundError):
            talus.run(SCENE, out="b", launcher="no_such_launcher -n 2")

    def test_a_file_of_yours_is_not_replaced_by_a_scene(self):
        Path("a.yaml").write_text("mine: 1\n", encoding="utf-8")
        with self.assertRaisesRegex(FileExistsError, "a.yaml was not written by this package"):
            talus.run(SCENE, out="a")
        self.assertEqual(Path("a.yaml").read_text(encoding="utf-8"), "mine: 1\n")
        talus.run(SCENE, out="b")
        talus.run(SCENE, out="b")

    def test_progress_grows_to_the_end(self):
        seen = []
        talus.run(SCENE, out="a", set={"time.max_step": 2e-6}, progress=seen.append, threads=1)
        self.assertGreater(len(seen), 1, "the run is too short to be followed")
        fractions = [now.fraction for now in seen]
        self.assertEqual((fractions, fractions[-1], seen[-1].stage), (sorted(fractions), 1.0, "run"))
        self.assertLess(fractions[0], 1)
        self.assertTrue(math.isclose(seen[-1].done, 0.05))

    def test_a_bar_ends_at_all_of_the_time(self):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            talus.run(SCENE, out="a", progress=True)
        self.assertRegex(said.getvalue(), r"\[#{30}\] 100 %  t = 0.05 s, step \d+ *\n$")

    def test_an_exception_of_the_progress_function_stops_the_run_with_a_checkpoint(self):
        def enough(_):
            raise LookupError("enough")
        with self.assertRaisesRegex(LookupError, "enough"):
            talus.run({**SCENE, "time": {"end": 1000}, "loads": None}, out="a", progress=enough)
        run = talus.open("a")
        self.assertEqual((run.status, len(run.checkpoints)), ("stopped", 1))

    def test_ctrl_c_stops_the_run_with_a_checkpoint(self):
        Path("long.yaml").write_text(talus.to_yaml({**SCENE, "time": {"end": 1000}, "loads": None}), encoding="utf-8")
        script = f"import sys; sys.path.insert(0, {str(ROOT / 'python')!r}); import talus; talus.run('long.yaml', out='a', threads=1)"
        process = subprocess.Popen([sys.executable, "-B", "-c", script], stderr=subprocess.PIPE, text=True)
        while not Path("a/progress.json").exists() and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        complaints = process.communicate(timeout=60)[1]
        self.assertIn("KeyboardInterrupt", complaints)
        self.assertEqual(talus.open("a").status, "stopped")

    def test_facts_are_what_the_program_makes_of_a_scene(self):
        facts = talus.facts(SCENE, set={"title": "1e3 \"quoted\", [in brackets]", "materials[0].density": 1.5e3})
        self.assertEqual(facts["title"], '1e3 "quoted", [in brackets]')
        self.assertEqual(facts["keys"]["title"], facts["title"])
        self.assertEqual(facts["keys"]["materials"][0]["density"], 1500)
        body = facts["bodies"][0]
        self.assertGreater(body["particles"], 0)
        self.assertGreater(body["highest [m]"], body["lowest [m]"])
        self.assertEqual(body["stages"][0]["material"], facts["keys"]["materials"][0]["name"])
        self.assertEqual(facts["scene"]["set"][1], "materials[0].density=1500.0")
        with self.assertRaises(talus.SceneError):
            talus.facts(SCENE, set={"materials[0].density": -1})

    def test_check_and_manual_are_those_of_the_program(self):
        self.assertRegex(talus.check(SCENE), r"body \"block\": \d+ particles")
        with self.assertRaisesRegex(talus.SceneError, "unknown law \"rubber\""):
            talus.check(SCENE, set={"materials[0].law": "rubber"})
        self.assertIn("neo_hookean", talus.manual("neo_hookean"))
        with self.assertRaisesRegex(talus.SceneError, "frictoin"):
            talus.manual("frictoin")
        self.assertIn("materials", talus.schema()["properties"])
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_particles_as_a_table_start_another_run(self):
        soil = {"name": "soil", "law": "drucker_prager", "density": 2000, "youngs_modulus": 1e7, "poisson_ratio": 0.3, "friction_angle": 30,
                "cohesion": 1e4, "match": "plane_strain"}
        scene = {**SCENE, "materials": [soil], "bodies": [{"name": "block", "material": "soil", "region": "all"}],
                 "boundaries": [{"type": "fixed", "on": "y_min"}, {"type": "roller", "on": "x_min"}, {"type": "roller", "on": "x_max"}],
                 "stages": [{"type": "geostatic", "duration": 10, "initial_stress": {"k0": 0.5}}], "time": None,
                 "outputs": {"particles": {"every": 10, "fields": ["stress", "plastic_strain"]}}}
        first = talus.run(scene, out="first").particles[0]  # with the stress of K0
        first.to_pandas().to_csv("state.csv")
        scene["stages"] = [{"type": "geostatic", "duration": 10}]
        for table in (Path("state.csv"), first.path):
            scene["bodies"] = [{"name": "block", "material": "soil", "region": "all", "particles_per_cell": 12, "initial": {"table": table}}]
            run = talus.run(scene, out="second", force=True)
            start = run.particles[0]
            scale = np.abs(first["stress"]).max()
            np.testing.assert_allclose(start["stress"][:, 1], -2000 * 9.81 * (3 - start["position"][:, 1]), atol=1e-5 * scale)
            self.assertLess(run.summary["start_states"][0]["farthest [m]"], 0.3)
            self.assertEqual(run.summary["start_states"][0]["points"], len(first["id"]))

    def test_files_named_by_a_path_are_found_from_the_folder_of_the_script(self):
        talus.run(SCENE, out="made/mesh")
        scene = {**SCENE, "mesh": {"file": Path("made/mesh/mesh.msh")}}
        self.assertIn("particles", talus.check(scene))
        self.assertEqual(talus.run(scene, out="somewhere/else").status, "done")


class FindsTheProgram(InAFolder):
    def test_the_variable_comes_before_the_path_and_the_path_before_the_repository(self):
        places = []
        for name in ("variable", "path"):
            place = self.folder / name / "talus"
            place.parent.mkdir()
            place.write_text("#!/bin/sh\n", encoding="utf-8")
            place.chmod(0o755)
            places.append(place)
        with mock.patch.dict(os.environ, {"TALUS": str(places[0]), "PATH": str(places[1].parent)}):
            self.assertEqual(talus.find_program(), places[0])
            del os.environ["TALUS"]
            self.assertEqual(talus.find_program(), places[1])
            self.assertEqual(talus.find_program(places[0]), places[0])
            os.environ["PATH"] = str(self.folder)
            with mock.patch("talus.program._REPOSITORY", self.folder / "clone"):
                with self.assertRaisesRegex(FileNotFoundError, "environment variable TALUS"):
                    talus.find_program()
                built = self.folder / "clone/build/talus"
                built.parent.mkdir(parents=True)
                places[0].rename(built)
                self.assertEqual(talus.find_program(), built)
            os.environ["TALUS"] = "nowhere/talus"
            with self.assertRaisesRegex(FileNotFoundError, "TALUS names nowhere/talus, which is no program"):
                talus.find_program()


class Parts(unittest.TestCase):
    def test_yaml_reads_back_as_it_was(self):
        for value in ({"a": {"b": {"c": [1, [2.5, -3e-9]]}}, "d": [], "e": {}},
                      {"list": [{"x": 1, "deep": {"y": [{"z": "w"}]}}, {"x": True}, {}]},
                      {"text": ["plain", "1", "1e5", "yes", "No", "null", "", "a: b", "# c", "- d", "é", 'q"\\', "x.y-z", "+x", "~",
                                "two\nlines"]},
                      {"0.1 * sin(x)": 1e16, "big": 10**20, "five": {"a": 1, "b": 2, "c": 3, "d": 4, "e": 5}}):
            self.assertEqual(yaml.load(talus.to_yaml(value), YamlOfToday), value)

    def test_values_of_numpy_are_written_as_numbers_and_none_is_left_out(self):
        text = talus.to_yaml({"v": np.array([1.0, 2.0]), "n": np.int64(3), "s": np.bool_(True), "gone": None, "t": (np.float32(0.5),),
                              "w": np.array(7), "inner": {"gone": None, "kept": 1}})
        self.assertEqual(yaml.safe_load(text), {"v": [1, 2], "n": 3, "s": True, "t": [0.5], "w": 7, "inner": {"kept": 1}})
        with self.assertRaisesRegex(TypeError, "a scene has no place for"):
            talus.to_yaml({"a": {1, 2}})
        with self.assertRaisesRegex(TypeError, "keys of a scene are text"):
            talus.to_yaml({1: 2})

    def test_messages_are_read_with_and_without_places(self):
        found = messages_of('a b.yaml:4:33: error: materials[0] "clay: 1".law: unknown law\n    4 |   law: x\n      |        ^\n'
                            "warning: slow: it is\n"
                            "m.msh:7: error: no such node\n--set t.e=-1: error: t.e: -1 must be > 0 s\n3 errors, nothing was run.\n")
        self.assertEqual([tuple(message) for message in found], [
            ("error", "a b.yaml", 4, 33, 'materials[0] "clay: 1".law', "unknown law", "  law: x"),
            ("warning", "", 0, 0, "", "slow: it is", ""),
            ("error", "m.msh", 7, 0, "", "no such node", ""), ("error", "--set t.e=-1", 0, 0, "t.e", "-1 must be > 0 s", "")])

    def test_the_version_is_that_of_the_program_and_of_the_package(self):
        project = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        self.assertIn(f"project(talus VERSION {talus.__version__} ", project)

    def test_every_public_name_is_described(self):
        for name in talus.__all__:
            if callable(value := getattr(talus, name)):
                self.assertTrue(value.__doc__, name)


class YamlOfToday(yaml.SafeLoader):
    """YAML 1.2 as the program reads it: 1e16 is a number, and `on` is text."""


OF_1_1 = {f"tag:yaml.org,2002:{kind}" for kind in ("float", "bool", "timestamp")}
YamlOfToday.yaml_implicit_resolvers = {first: [(tag, pattern) for tag, pattern in known if tag not in OF_1_1]
                                       for first, known in yaml.SafeLoader.yaml_implicit_resolvers.items()}
YamlOfToday.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^-?[0-9]+(\.[0-9]*)?(e[-+]?[0-9]+)?$"), list("-0123456789"))
YamlOfToday.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(true|false)$"), list("tf"))


if __name__ == "__main__":
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
