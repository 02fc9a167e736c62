#!/usr/bin/python3
"""Reads what a run writes with readers that share no code with it.

Checkpoints by h5py, particle and mesh files by python/talus, series by xml, histories by csv, the summary by json.  Meshes as .msh are
read by gmsh itself in tests/io/mesh/gmsh_read_test.cpp.

Usage: read_back.py PROGRAM, the built talus.
"""
import csv
import json
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import talus  # noqa: E402

SCENE = """title: Read back
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 2], cells: [6, 6]}}
materials:
  - {name: soil, law: drucker_prager, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 500, match: plane_strain}
bodies:
  - {name: low, material: soil, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [3, -1]}
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}]
time: {end: 0.03, max_step: 1.0e-3}
outputs:
  checkpoint: {steps: 10, keep: 9}
  particles: {every: 1.0e-6, fields: [velocity, stress, plastic_strain, mass]}
  mesh: {every: 1.0e-6, fields: [mass, velocity, reaction]}
  history: {every: 1.0e-6}
"""
KEPT = ("position", "velocity", "stress", "mass")  # in a checkpoint and in a particle file

SINGLE = 2e-6  # of numbers that files show in single precision, a few of them added up


def series(path):
    """Times [s] and files of a .pvd."""
    sets = tree.parse(path).getroot().findall("Collection/DataSet")
    return [float(data.get("timestep")) for data in sets], [path.parent / data.get("file") for data in sets]


class ReadBack(unittest.TestCase):
    program = ""

    def finished_run(self):
        folder = Path(self.scratch.name)
        (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
        subprocess.run([self.program, "run", "scene.yaml", "--out", "out", "--quiet", "--threads", "1"], cwd=folder, check=True)
        return folder / "out"

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def history_of(self, out):
        with (out / "history.csv").open(encoding="utf-8") as text:
            return [{name.split(" [")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(text)]

    def test_series_and_their_files_show_what_the_history_says(self):
        out = self.finished_run()
        rows = self.history_of(out)
        times, files = series(out / "particles.pvd")
        self.assertEqual(times, [row["time"] for row in rows])
        self.assertEqual([file.name for file in files], [f"particles_{n:04}.vtp" for n in range(len(rows))])
        for row, file in zip(rows, files):
            shown = talus.Particles(file)
            mass, velocity = shown["mass"].astype(float), shown["velocity"].astype(float)
            self.assertAlmostEqual(mass.sum(), row["mass"], delta=SINGLE * row["mass"])
            self.assertAlmostEqual(0.5 * (mass * (velocity**2).sum(axis=1)).sum(), row["kinetic"], delta=SINGLE * rows[0]["kinetic"])

        times, files = series(out / "mesh.pvd")  # none before the first step
        self.assertEqual(times, [row["time"] for row in rows[1:]])
        scale = rows[0]["mass"] * 3  # [kg m/s] of the block at the start
        for row, file in zip(rows[1:], files):
            shown = talus.Mesh(file)
            mass = shown["mass"].astype(float)
            self.assertAlmostEqual(mass.sum(), row["mass"], delta=SINGLE * row["mass"])
            moved = (mass[:, None] * shown["velocity"]).sum(axis=0)
            for axis in (0, 1):
                self.assertAlmostEqual(moved[axis], row["momentum_" + "xy"[axis]], delta=SINGLE * scale)
                borne = shown["reaction"][:, axis].sum()
                told = row["reaction_y_min_" + "xy"[axis]] + row["reaction_x_min_" + "xy"[axis]]
                kick = row["dt"] * (0.5 if row is rows[1] else 1)  # forces act from the time of the old velocities on: half the first step
                self.assertAlmostEqual(borne * kick, told * row["dt"], delta=SINGLE * scale)

    def test_the_mesh_is_the_grid_of_the_scene(self):
        out = self.finished_run()
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        for name in ("mesh.vtu", "mesh_0000.vtu"):
            shown = talus.Mesh(out / name)
            points, cells = shown.nodes, shown.cells
            self.assertEqual(summary["mesh"]["nodes"], len(points))
            self.assertEqual(summary["mesh"]["cells"], len(cells))
            self.assertEqual(cells.shape[1], 3)
            grid = {(x, y) for x in range(7) for y in range(7)}
            self.assertEqual({(round(3 * x), round(3 * y)) for x, y, _ in points}, grid)
            np.testing.assert_allclose(3 * points[:, :2], np.round(3 * points[:, :2]), atol=1e-14)
            a, b = (points[cells[:, k]] - points[cells[:, 0]] for k in (1, 2))
            area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
            self.assertGreater(area.min(), 0)
            self.assertAlmostEqual(area.sum(), 4, places=12)

    def test_the_summary_says_what_the_history_ends_with(self):
        out = self.finished_run()
        rows = self.history_of(out)
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["status"], "done")
        self.assertEqual(summary["simulated_time [s]"], rows[-1]["time"])
        self.assertEqual([stage["kind"] for stage in summary["stages"]], ["run"])
        self.assertEqual(summary["stages"][0]["steps"], rows[-1]["step"])
        self.assertEqual(summary["stages"][0]["duration [s]"], rows[-1]["time"])
        body, = summary["bodies"]
        self.assertEqual((body["name"], body["law"]), ("low", "drucker_prager"))
        self.assertEqual(body["particles"], len(talus.Particles(out / "particles_0000.vtp")["id"]))
        balances = summary["balances"]
        terms = {name.split(" [")[0]: value for name, value in balances["energy"]["terms"].items()}
        self.assertEqual(terms["kinetic_start"], rows[0]["kinetic"])
        shared = set(terms) & set(rows[-1])
        self.assertGreaterEqual(len(shared), 10)
        for name in shared:
            self.assertEqual(terms[name], rows[-1][name], name)
        self.assertEqual(balances["mass"]["start [kg]"], rows[0]["mass"])
        self.assertEqual(balances["mass"]["end [kg]"], rows[-1]["mass"])
        for key, row in (("start", rows[0]), ("end", rows[-1])):
            np.testing.assert_allclose(balances["momentum"][f"{key} [kg m/s]"], [row["momentum_x"], row["momentum_y"]], rtol=1e-12)
            np.testing.assert_allclose(balances["angular_momentum"][f"{key} [kg m^2/s]"], [row["angular_momentum_z"]], rtol=1e-12)
        defect = abs(terms["energy_defect"])
        open_part = min(defect, abs(terms["transfer_loss"] + terms["energy_defect"]))  # the default transfer is MUSL
        largest = max(abs(terms[name]) for name in set(terms) - {"transfer_loss", "energy_defect", "unexplained / dissipated"})
        self.assertAlmostEqual(balances["energy"]["closure"], open_part / largest, places=12)
        for kept in ("mass", "momentum"):
            self.assertTrue(balances[kept]["closes"], kept)
        for name in summary["files"]:
            self.assertTrue((out / name).is_file(), name)

    def test_a_checkpoint_holds_what_the_other_files_show(self):
        out = self.finished_run()
        with (out / "history.csv").open(encoding="utf-8") as text:
            rows = list(csv.DictReader(text))
        with h5py.File(sorted((out / "checkpoints").glob("step_*.h5"))[1]) as kept:
            step = int(kept["clock/step"][0])
            self.assertEqual(step, 20)
            self.assertEqual(kept["particles/velocity"].dtype, np.float64)
            self.assertEqual(kept["particles/position"].dtype, np.float64)
            self.assertEqual(kept["particles/position"].attrs["unit"], b"m")
            shown = talus.Particles(out / f"particles_{step:04}.vtp")  # one a step, the first before any
            by_id = np.argsort(kept["particles/id"][()])
            for name in KEPT:
                values = kept[f"particles/{name}"][()][by_id]
                wanted = shown[name][:, :values.shape[1]] if values.ndim > 1 else shown[name]
                np.testing.assert_array_equal(values.astype(wanted.dtype), wanted, err_msg=name)
            hardened = kept["laws/history/0/plastic_strain"][()][by_id].astype(np.float32)
            np.testing.assert_array_equal(hardened, shown["plastic_strain"])
            self.assertGreater(hardened.max(), 0)
            row = rows[step]
            self.assertEqual(float(row["time [s]"]), kept["clock/time"][0])
            self.assertAlmostEqual(float(row["gravity_work [J]"]), kept["energy/gravity"][0], delta=1e-9 * abs(kept["energy/gravity"][0]))
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["steps"], len(rows) - 1)


if __name__ == "__main__":
    ReadBack.program = sys.argv.pop(1)
    unittest.main()
