#!/usr/bin/python3
"""Tests of what a script sees of the run that calls it: arrays, their values beside the files of the run, their lives.

Usage: script_test.py PROGRAM, the built talus.
"""
import sys
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from scratch import InAFolder  # noqa: E402

SOIL = {"name": "soil", "law": "drucker_prager", "density": 1800, "youngs_modulus": 1e6, "poisson_ratio": 0.3, "friction_angle": 30,
        "cohesion": 500, "match": "plane_strain"}
RUBBER = {"name": "rubber", "law": "neo_hookean", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}


def scene(dimension=2, bodies=2):
    """Blocks of two laws that fall onto the ground."""
    low, middle, high = ([0] * dimension, [1] * dimension, [2] * dimension)
    boxes = [{"name": "heap", "material": "soil", "shape": {"type": "box", "low": low, "high": middle}},
             {"name": "ball", "material": "rubber", "shape": {"type": "box", "low": middle, "high": [1.5] * dimension}}]
    return {
        "title": "Seen by a script", "dimension": dimension,
        "mesh": {"grid": {"low": low, "high": high, "cells": [6] * dimension}},
        "materials": [SOIL, RUBBER][:bodies], "bodies": boxes[:bodies],
        "loads": [{"type": "gravity", "acceleration": [0] * (dimension - 1) + [-9.81]}],
        "boundaries": [{"type": "friction", "on": "xyz"[dimension - 1] + "_min", "coefficient": 0.3}],
        "time": {"end": 0.1},
        "outputs": {"particles": {"every": 0.1, "fields": ["velocity", "stress", "F", "displacement", "plastic_strain", "mass"]},
                    "mesh": {"every": 0.1, "fields": ["velocity", "mass"]}, "history": {"every": 0.05}},
    }


class Scripts(InAFolder):
    def run_with(self, text, of=None, **more):
        file = self.write("hooks.py", "import numpy as np\n" + text)
        return talus.run(of or scene(), out="out", script=file, **more)

    def saved(self):
        return np.load(self.folder / "seen.npz")

    def test_arrays_are_those_of_the_files(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                run = self.run_with("""
def end(simulation):
    p = simulation.particles
    arrays = {name: p[name] for name in p}
    arrays |= {"nodes_" + name: simulation.nodes[name] for name in simulation.nodes}
    np.savez("seen.npz", **arrays)
""", scene(dimension), force=True)
                seen, frame, nodes = self.saved(), run.particles[-1], run.mesh_fields[-1]
                rows = np.argsort(seen["id"])
                np.testing.assert_array_equal(seen["id"][rows], frame["id"])
                for name in ("velocity", "stress", "F", "displacement", "plastic_strain", "mass", "position"):
                    there, here = frame[name], seen[name][rows]
                    if name in ("velocity", "displacement", "position"):
                        self.assertEqual(here.shape, (len(rows), dimension))
                        there = there[:, :dimension]
                    np.testing.assert_allclose(here.reshape(len(rows), -1), there.reshape(len(rows), -1), rtol=2e-7, atol=1e-30, err_msg=name)
                self.assertEqual(seen["F"].shape, (len(rows), 3, 3))
                self.assertEqual(seen["velocity_gradient"].shape, (len(rows), dimension, dimension))
                self.assertGreater(np.abs(seen["F"] - seen["F"].transpose(0, 2, 1)).max(), 1e-6)  # rows and columns are told apart
                np.testing.assert_allclose(seen["volume"], np.linalg.det(seen["F"]) * seen["mass"] / self.density_of(seen), rtol=1e-12)
                np.testing.assert_allclose(seen["nodes_velocity"], nodes["velocity"][:, :dimension], rtol=2e-7, atol=1e-30)
                self.assertEqual(seen["nodes_position"].shape, nodes["velocity"][:, :dimension].shape)

    @staticmethod
    def density_of(seen):
        return np.where(seen["body"] == 0, 1800, 1000)

    def test_columns_are_no_copies_and_cannot_be_written(self):
        self.run_with("""
def step(simulation):
    p, heap = simulation.particles, simulation.bodies["heap"]
    for name in ("position", "velocity", "F", "stress", "mass", "volume", "id"):
        assert np.shares_memory(p[name], p[name]), name
        assert np.shares_memory(heap[name], p[name]) and len(heap[name]) == len(heap), name
        np.testing.assert_array_equal(p[name][heap.rows], heap[name])
        assert not p[name].flags.writeable and p[name].dtype.itemsize == 8
    assert np.shares_memory(heap["plastic_strain"], heap["plastic_strain"])
    assert not np.shares_memory(p["plastic_strain"], p["plastic_strain"])   # of two laws
    np.testing.assert_array_equal(p["plastic_strain"][heap.rows], heap["plastic_strain"])
    assert (heap.name, heap.material, heap.law) == ("heap", "soil", "drucker_prager")
    assert len(p) == sum(len(body) for body in simulation.bodies.values())
    assert "plastic_strain" not in simulation.bodies["ball"] and "stress" in p
""")

    def test_a_kept_array_has_its_values_for_ever(self):
        self.run_with("""
kept = []

def keep(simulation):
    p = simulation.particles
    kept.append([(p[name], p[name].copy()) for name in ("position", "stress", "F", "id")]
                + [(body["plastic_strain"][::2], body["plastic_strain"][::2].copy())
                   for body in simulation.bodies.values() if "plastic_strain" in body])

start = step = keep

def end(simulation):
    keep(simulation)
    assert len(kept) > 5
    for pairs in kept:
        for array, then in pairs:
            np.testing.assert_array_equal(array, then)
    assert not np.array_equal(kept[1][0][0], kept[-1][0][0])
""")

    def test_velocities_are_set_where_and_when_it_says(self):
        run = self.run_with("""
def step(simulation):
    if simulation.step != 3:
        return
    before = simulation.particles["velocity"]
    old = before.copy()
    simulation.bodies["ball"]["velocity"] = [7, 0]
    simulation.bodies["ball"]["velocity"] = simulation.bodies["ball"]["velocity"] + [1, 0]
    now = simulation.particles["velocity"]
    np.testing.assert_array_equal(before, old)
    np.testing.assert_array_equal(now[simulation.bodies["heap"].rows], old[simulation.bodies["heap"].rows])
    np.testing.assert_array_equal(now[simulation.bodies["ball"].rows], np.tile([8.0, 0.0], (len(simulation.bodies["ball"]), 1)))
    simulation.stop("look")
""")
        self.assertEqual(run.status, "stopped")
        np.testing.assert_array_equal(run.checkpoints[-1].particles("ball")["velocity"][:, 0], 8.0)

    def test_the_first_step_is_as_short_as_the_new_velocities_ask(self):
        """As that of bodies which have them from the scene."""
        fast = scene(bodies=1)
        fast["boundaries"], fast["time"], fast["outputs"] = None, {"end": 1e-3}, {"history": {"every": 1e-9}}
        fast["bodies"] = [{**fast["bodies"][0], "velocity": [300, 0]}]
        first = talus.run(fast, out="scene").history["dt"][1]
        fast["bodies"] = [{**fast["bodies"][0], "velocity": None}]
        slow = talus.run(fast, out="slow").history["dt"][1]
        run = self.run_with("def start(simulation):\n    simulation.particles['velocity'] = [300, 0]\n", fast)
        self.assertEqual(run.history["dt"][1], first)
        self.assertGreater(slow, 2 * first)

    def test_a_particle_code_of_ones_own(self):
        """Gravity by the script alone is gravity."""
        no_gravity = scene(bodies=1)
        no_gravity["loads"], no_gravity["boundaries"] = None, None
        run = self.run_with("""
def step(simulation):
    simulation.particles["velocity"] = simulation.particles["velocity"] + [0, -9.81 * simulation.dt]
""", no_gravity, set={"bodies[0].shape.low": [0.5, 0.8], "bodies[0].shape.high": [1.5, 1.8]})
        row = {name: run.history[name][-1] for name in ("momentum_y", "mass", "kinetic", "time", "dt")}
        self.assertAlmostEqual(row["momentum_y"] / row["mass"], -9.81 * row["time"], delta=9.81 * row["dt"])
        self.assertLess(run.history["transfer_loss"][-1], 0.01 * row["kinetic"])

    def test_what_it_prints_is_in_the_log_and_errors_have_their_place(self):
        run = self.run_with("def end(simulation):\n    print(simulation.folder, simulation.stage, simulation.dimension)\n")
        self.assertIn("out run 2\n", run.log)
        with self.assertRaises(talus.RunFailed) as caught:
            self.run_with("def step(simulation):\n    simulation.particles['speed']\n")
        self.assertIn("hooks.py:3: in step(): KeyError", str(caught.exception))
        self.assertEqual(caught.exception.run.status, "failed")
        with self.assertRaises(talus.SceneError):
            self.run_with("def step(simulation)\n", force=True)


if __name__ == "__main__":
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
