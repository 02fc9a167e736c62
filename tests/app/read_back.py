#!/usr/bin/python3
"""Reads what a run writes with readers that share no code with it: checkpoints by h5py, particle files by benchmarks/vtp.py, histories by csv.

Usage: read_back.py PROGRAM, the built talus.
"""
import csv
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
import vtp  # noqa: E402

SCENE = """title: Read back
dimension: 2
precision: {precision}
mesh: {{grid: {{low: [0, 0], high: [2, 2], cells: [6, 6]}}}}
materials:
  - {{name: soil, law: drucker_prager, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 500, match: plane_strain}}
bodies:
  - {{name: low, material: soil, shape: {{type: box, low: [0, 0], high: [1, 0.6]}}, particles_per_cell: 3, velocity: [3, -1]}}
loads: [{{type: gravity, acceleration: [0, -9.81]}}]
boundaries: [{{type: fixed, on: y_min}}, {{type: roller, on: x_min}}]
time: {{end: 0.03, max_step: 1.0e-3}}
outputs:
  checkpoint: {{steps: 10, keep: 9}}
  particles: {{every: 1.0e-6, fields: [velocity, stress, plastic_strain, mass]}}
  history: {{every: 1.0e-6}}
"""
KEPT = {"position": "Points", "velocity": "velocity", "stress": "stress", "mass": "mass"}  # in a checkpoint, in a particle file


class ReadBack(unittest.TestCase):
    program = ""

    def run_in(self, precision):
        folder = Path(self.scratch.name) / precision
        folder.mkdir()
        (folder / "scene.yaml").write_text(SCENE.format(precision=precision), encoding="utf-8")
        subprocess.run([self.program, "run", "scene.yaml", "--out", "out", "--quiet", "--threads", "1"], cwd=folder, check=True)
        return folder / "out"

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def test_a_checkpoint_holds_what_the_other_files_show(self):
        for precision, number in (("double", np.float64), ("single", np.float32)):
            out = self.run_in(precision)
            with (out / "history.csv").open(encoding="utf-8") as text:
                rows = list(csv.DictReader(text))
            with h5py.File(sorted((out / "checkpoints").glob("step_*.h5"))[1]) as kept:
                step = int(kept["clock/step"][0])
                self.assertEqual(step, 20)
                self.assertEqual(kept["particles/velocity"].dtype, number)
                self.assertEqual(kept["particles/position"].dtype, np.float64)
                self.assertEqual(kept["particles/position"].attrs["unit"], b"m")
                shown = vtp.read(out / f"particles_{step:04}.vtp")  # one a step, the first before any
                by_id = np.argsort(kept["particles/id"][()])
                for name, field in KEPT.items():
                    values = kept[f"particles/{name}"][()][by_id]
                    wanted = shown[field][:, :values.shape[1]] if values.ndim > 1 else shown[field]
                    np.testing.assert_array_equal(values.astype(wanted.dtype), wanted, err_msg=name)
                hardened = kept["laws/history/0/plastic_strain"][()][by_id].astype(np.float32)
                np.testing.assert_array_equal(hardened, shown["plastic_strain"])
                self.assertGreater(hardened.max(), 0)
                row = rows[step]
                self.assertEqual(float(row["time [s]"]), kept["clock/time"][0])
                self.assertAlmostEqual(float(row["gravity_work [J]"]), kept["energy/gravity"][0], delta=1e-9 * abs(kept["energy/gravity"][0]))
            summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
            self.assertEqual(summary["steps"], len(rows) - 1)
            self.assertEqual(summary["precision"], precision)


if __name__ == "__main__":
    ReadBack.program = sys.argv.pop(1)
    unittest.main()
