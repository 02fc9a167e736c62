#!/usr/bin/python3
"""Tests of talus.drive: stresses against closed forms, what is refused and why.

Usage: drive_test.py PROGRAM, the built talus.
"""
import os
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402

RUBBER = {"law": "neo_hookean", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.25}
SOIL = {"name": "soil", "law": "mohr_coulomb", "density": 2000, "youngs_modulus": 2e7, "poisson_ratio": 0.3, "friction_angle": 30,
        "cohesion": 10e3}
LAME = 0.4e6  # Pa, both of RUBBER: E nu / ((1 + nu) (1 - 2 nu)) and E / (2 (1 + nu))


def part(quantity, value, component="zz", time=1.0, steps=50):
    return {"time": time, "steps": steps, "controls": {component: {"quantity": quantity, "value": value}}}


class Drive(unittest.TestCase):
    def test_stress_in_uniaxial_strain_is_that_of_the_law(self):
        test = talus.drive(RUBBER, [part("strain_rate", 0.2)])
        stretch = test.F[:, 2, 2]
        self.assertEqual((test.rows, test.stress.shape, test.F.shape), (51, (51, 6), (51, 3, 3)))
        # J s = mu (b - I) + lambda ln(J) I: docs/reference/materials.md
        np.testing.assert_allclose(test.stress[:, 2], (LAME * (stretch**2 - 1) + LAME * np.log(stretch)) / stretch, rtol=1e-9, atol=1e-6)
        np.testing.assert_allclose(test.stress[:, 0], LAME * np.log(stretch) / stretch, rtol=1e-9, atol=1e-6)
        np.testing.assert_allclose(test.log_strain[:, 2], np.log(stretch), rtol=1e-12)
        self.assertAlmostEqual(np.log(stretch[-1]), 0.2, delta=1e-3)
        self.assertEqual((test.units["stress_zz"], test.units["F_zz"], test.units["p"]), ("Pa", "-", "Pa"))

    def test_shear_is_in_the_right_components(self):
        test = talus.drive(RUBBER, [part("velocity_gradient", 0.1, "xy")])
        shear = test.F[-1, 0, 1]
        self.assertGreater(shear, 0.09)
        self.assertEqual(test.F[-1, 1, 0], 0)
        self.assertAlmostEqual(test.stress[-1, 3] / (LAME * shear), 1, places=9)
        # b = F F^T has the eigenvalues exp(2 e): tr b - 2 = shear^2 in its plane
        b = test.F[-1] @ test.F[-1].T
        strain = talus.tensors(test.log_strain[-1:])[0]
        values, axes = np.linalg.eigh(strain)
        np.testing.assert_allclose(axes @ np.diag(np.exp(2 * values)) @ axes.T, b, atol=1e-12)

    def test_a_triaxial_test_reaches_the_strength_of_mohr_coulomb(self):
        test = talus.drive(SOIL, test="triaxial_compression", pressure=100e3, strain=0.1, rate=1e-2, steps=200)
        sine = np.sin(np.radians(30))
        strength = 2 * (100e3 * sine + 10e3 * np.cos(np.radians(30))) / (1 - sine)
        self.assertAlmostEqual(test["stress_difference"].max() / strength, 1, delta=2e-3)  # yields in Kirchhoff stress: J is less than 1
        self.assertEqual((test.rows, test["axial_strain"][-1]), (201, 0.1))
        self.assertIn("closed form: Mohr-Coulomb", test.log)

    def test_a_path_begins_with_its_stress_and_a_name_does_no_harm(self):
        start = np.array([-50e3, -60e3, -70e3, 0, 1e3, 0])
        test = talus.drive(SOIL, [part("strain_rate", 0.0), part("stress", -80e3, time=2)], initial_stress=start)
        np.testing.assert_allclose(test.stress[0], start)
        self.assertAlmostEqual(test.stress[-1, 2] / -80e3, 1, places=6)
        self.assertEqual((test["time"][-1], test.rows), (3, 101))

    def test_a_scene_names_its_material_and_set_changes_it(self):
        scene = str(ROOT / "scenes/slope_failure_2d/scene.yaml")
        weak, strong = (talus.drive(scene, test="simple_shear", pressure=1e5, set={"materials[0].cohesion": cohesion})["shear_stress"].max()
                        for cohesion in (5e3, 50e3))
        self.assertLess(weak, strong)
        both = {"title": "Two", "dimension": 2, "mesh": {"grid": {"low": [0, 0], "high": [1, 1], "cells": [2, 2]}},
                "materials": [SOIL, {**RUBBER, "name": "rubber"}], "time": {"end": 1},
                "bodies": [{"name": "all", "material": "soil", "shape": {"type": "box", "low": [0, 0], "high": [1, 1]}}]}
        self.assertNotIn("plastic_strain", talus.drive(both, test="oedometer", name="rubber"))
        with self.assertRaisesRegex(talus.SceneError, "--material is needed where there are several: soil or rubber"):
            talus.drive(both, test="oedometer")

    def test_a_file_of_a_path_is_read_and_the_table_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            file, table = Path(folder) / "path.yaml", Path(folder) / "table.csv"
            file.write_text(talus.to_yaml({"material": RUBBER, "path": [part("strain_rate", 0.1)]}), encoding="utf-8")
            test = talus.drive(file, out=table)
            self.assertEqual((test.path, test.rows), (table, 51))
            np.testing.assert_array_equal(talus.Table(table).array, test.array)

    def test_what_does_not_fit_together_is_refused(self):
        path = [part("strain_rate", 0.1)]
        for words, given in (("either a path or a test", {}), ("either a path or a test", {"path": path, "test": "oedometer"}),
                             ("pressure: only with test", {"path": path, "pressure": 1e5}),
                             ("initial_stress: only with path", {"test": "oedometer", "initial_stress": [0] * 6})):
            with self.assertRaisesRegex(ValueError, words):
                talus.drive(RUBBER, **given)
        with self.assertRaisesRegex(ValueError, "need the material as a dictionary"):
            talus.drive("scene.yaml", path)
        with self.assertRaises(talus.SceneError) as caught:
            talus.drive({**RUBBER, "poisson_ratio": 0.7}, path)
        self.assertEqual([message.key for message in caught.exception.errors], ["material.poisson_ratio"])
        with self.assertRaisesRegex(talus.SceneError, "oedometre"):
            talus.drive(RUBBER, test="oedometre")

    def test_the_names_of_tests_are_those_of_the_program(self):
        for name in talus.TESTS:
            self.assertGreater(talus.drive(RUBBER, test=name, steps=3, strain=0.01).rows, 3, name)


if __name__ == "__main__":
    os.environ["TALUS"] = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
