#!/usr/bin/python3
"""Tests of python/talus and of python/examples, with what a small run and a small study write.

Usage: reader_test.py PROGRAM, the built talus.
"""
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import lz4.block
import matplotlib.image
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402

SCENE = """title: Two blocks
dimension: 3
mesh: {grid: {low: [0, 0, 0], high: [4, 2, 2], cells: [8, 4, 4]}}
materials:
  - {name: soil, law: drucker_prager, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 20, cohesion: 100,
     match: outer}
  - {name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}
bodies:
  - {name: heap, material: soil, shape: {type: box, low: [0, 0, 0], high: [1.5, 1.5, 2]}, particles_per_cell: 4}
  - {name: stone, material: rubber, shape: {type: box, low: [2.5, 0, 0.5], high: [3, 1, 1.5]}, particles_per_cell: 4, velocity: [-1, 0, 0]}
loads: [{type: gravity, acceleration: [0, -9.81, 0]}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: z_min}, {type: roller, on: z_max}]
time: {end: 0.1}
outputs:
  checkpoint: {at_end: true}
  particles: {every: 0.025, fields: [velocity, displacement, stress, plastic_strain]}
  mesh: {every: 0.05, fields: [mass, velocity]}
  history: {every: 0.01, fronts: [{name: toe, direction: +x, body: heap}]}
  runout: {every: 0.05, moved: 0, sections: [{name: axis, along: [[1, 0], [1, 4]]}]}
"""
STUDY = "scene: scene.yaml\nvary:\n  materials[0].friction_angle: [10, 20, 40]\n  time.cfl: [0.4, 0.8]\ncollect: [toe, plastic]\n"
MANY = """title: More rows than one piece has
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [64, 64]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}]
bodies: [{name: all, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 6}]
time: {end: 1}
"""
ROWS_OF_A_PIECE = 32768  # core/parallel/slices.hpp


class OfARun(unittest.TestCase):
    program = ""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name)
        for name, text in (("scene.yaml", SCENE), ("study.yaml", STUDY), ("many.yaml", MANY)):
            (cls.folder / name).write_text(text, encoding="utf-8")
        for words in (["run", "scene.yaml", "--out", "out"], ["sweep", "study.yaml", "--out", "sweep", "--quick"],
                      ["run", "many.yaml", "--out", "many", "--until", "1"]):
            told = subprocess.run([cls.program, *words, "--quiet"], cwd=cls.folder, capture_output=True, text=True, check=False)
            if told.returncode not in (0, 4):  # 4: --until stops it
                raise AssertionError(told.stderr)
        cls.run_ = talus.Run(cls.folder / "out")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def checkpoint(self, check=True):
        path, = (self.folder / "out" / "checkpoints").glob("*.h5")
        kept = talus.Checkpoint(path, check)
        self.addCleanup(kept.close)
        return kept

    def test_a_run_tells_its_status_scene_and_bodies(self):
        self.assertEqual(self.run_.status, "done")
        self.assertTrue(self.run_.scene.startswith(SCENE))
        self.assertEqual(self.run_.bodies, ["heap", "stone"])

    def test_a_run_that_was_killed_has_not_ended(self):
        process = subprocess.Popen([self.program, "run", "scene.yaml", "--out", "killed", "--quiet", "--set", "time.end=1000"], cwd=self.folder)
        while not (self.folder / "killed" / "history.csv").exists() and process.poll() is None:
            time.sleep(0.02)
        process.kill()
        process.wait()
        self.assertEqual(talus.Run(self.folder / "killed").status, "not ended")
        self.assertEqual(talus.Run(self.folder / "many").status, "stopped")

    def test_a_run_out_has_a_table_and_sections(self):
        self.assertEqual(self.run_.runout.units["volume"], "m^3")
        self.assertEqual(self.run_.runout["time"][0], 0)
        self.assertEqual(self.run_.section("axis")["distance"][[0, -1]].tolist(), [0, 4])

    def test_a_history_has_columns_with_units_and_is_a_structured_array(self):
        history = self.run_.history
        self.assertEqual((history.units["kinetic"], history.units["step"], history.units["momentum_x"]), ("J", "-", "kg m/s"))
        self.assertEqual(history["time"][[0, -1]].tolist(), [0, self.run_.summary["simulated_time [s]"]])
        whole = history.array
        self.assertEqual(whole.shape, (history.rows,))
        np.testing.assert_array_equal(whole["toe"], history["toe"])

    def test_frames_have_fields_with_units_by_body(self):
        series = self.run_.particles
        self.assertEqual([frame.time for frame in series], series.times.tolist())
        self.assertEqual(series.at(0.06).time, series.times[np.abs(series.times - 0.06).argmin()])
        last = series[-1]
        self.assertEqual((last.units["position"], last.units["stress"], last.units["plastic_strain"]), ("m", "Pa", "-"))
        self.assertEqual((last["position"].shape, last["stress"].shape), ((len(last["id"]), 3), (len(last["id"]), 6)))
        for body in self.run_.summary["bodies"]:
            self.assertEqual(len(last.of(body["name"])["id"]), body["particles"])
        np.testing.assert_array_equal(last.of("stone")["id"], last.of(1)["id"])
        self.assertGreater(series[0].of("stone")["position"][:, 0].min(), 2.5)
        self.assertIn("talus", last.made_by)

    def test_the_mesh_fills_its_box_and_its_fields_hold_the_mass(self):
        mesh = self.run_.mesh
        corners = mesh.nodes[mesh.cells]
        volume = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        self.assertAlmostEqual(volume.sum(), 16, places=12)
        shown = self.run_.mesh_fields[-1]
        self.assertAlmostEqual(shown["mass"].astype(float).sum() / self.run_.history["mass"][-1], 1, places=6)
        self.assertEqual((shown.units["mass"], shown.on_cells), ("kg", set()))

    def test_a_checkpoint_has_time_step_bodies_and_the_state_of_the_last_frame(self):
        kept, last = self.checkpoint(), self.run_.particles[-1]
        self.assertEqual((kept.time, kept.step), (last.time, self.run_.summary["steps"]))
        self.assertEqual([(body.name, body.material, body.law) for body in kept.bodies], [("heap", "soil", "drucker_prager"), ("stone", "rubber", "neo_hookean")])
        self.assertEqual(kept.text("run/scene"), SCENE)
        self.assertEqual((kept.units["particles/velocity"], kept.units["particles/volume"]), ("m/s", "m^3"))
        heap = kept.particles("heap")
        self.assertEqual((set(heap["id"]), heap["plastic_strain"].shape), (set(last.of("heap")["id"]), heap["id"].shape))
        both = talus.compare(last, kept.particles())
        self.assertEqual((len(both.ids), len(both.only_first), len(both.only_second)), (len(last["id"]), 0, 0))
        for field in ("position", "velocity", "stress"):
            far = both.largest(field)
            self.assertLessEqual(far.largest, 1e-7 * far.over, field)  # single precision in the particle file

    def test_every_array_fits_its_digest_also_one_of_several_pieces(self):
        kept = self.checkpoint()
        self.assertEqual(sum(kept[name].nbytes >= 0 for name in kept), len(kept))
        with talus.Checkpoint(next((self.folder / "many" / "checkpoints").glob("*.h5"))) as many:
            self.assertGreater(len(many["particles/id"]), ROWS_OF_A_PIECE)
            for name in many:
                self.assertIsNotNone(many[name])

    def test_one_wrong_bit_of_a_checkpoint_is_damage(self):
        for source, row in (("out", 7), ("many", ROWS_OF_A_PIECE + 7)):
            path = self.folder / f"bit_{source}.h5"
            shutil.copy(next((self.folder / source / "checkpoints").glob("*.h5")), path)
            with h5py.File(path, "r+") as file:
                values = file["particles/stress"][row]
                values[0] = np.nextafter(values[0], np.inf)
                file["particles/stress"][row] = values
            with talus.Checkpoint(path) as kept, self.assertRaisesRegex(talus.Damaged, f"bit_{source}.h5: particles/stress is damaged"):
                kept["particles/stress"]
            with talus.Checkpoint(path, check=False) as kept:
                self.assertEqual(kept["particles/stress"][row, 0], values[0])

    def test_what_is_no_sound_file_of_a_known_version_is_refused_by_name(self):
        sound = next((self.folder / "out" / "checkpoints").glob("*.h5"))
        later = self.folder / "later.h5"
        shutil.copy(sound, later)
        with h5py.File(later, "r+") as file:
            file["format"][0] = 99
        short, text, foreign = self.folder / "short.h5", self.folder / "text.h5", self.folder / "foreign.h5"
        short.write_bytes(sound.read_bytes()[:5000])
        text.write_text("no such file\n", encoding="utf-8")
        with h5py.File(foreign, "w") as file:
            file["x"] = [1.0]
        for path, kind, words in ((short, talus.Damaged, "short.h5"), (text, talus.UnknownFormat, "text.h5"), (foreign, talus.UnknownFormat, "no checkpoint")):
            with self.assertRaisesRegex(kind, words):
                talus.Checkpoint(path)
        with self.assertRaisesRegex(talus.UnknownFormat, "format 99; this module knows 4, 5"):
            talus.Checkpoint(later, check=False)
        cut = self.folder / "cut.vtp"
        cut.write_bytes(self.run_.particles.paths[-1].read_bytes()[:-20000])
        with self.assertRaisesRegex(talus.Damaged, "cut.vtp: the field"):
            dict(talus.Particles(cut))
        with self.assertRaises(talus.UnknownFormat):
            talus.Particles(self.folder / "out" / "mesh.vtu")
        with self.assertRaises(FileNotFoundError):
            talus.Run(self.folder / "nowhere")
        with self.assertRaisesRegex(FileNotFoundError, "sweep.csv is not there: nothing has written a table"):
            talus.Sweep(self.folder)

    def test_what_is_not_there_is_named_with_what_is(self):
        last = self.run_.particles[-1]
        with self.assertRaisesRegex(talus.Missing, "no field velocty: did you mean velocity"):
            last["velocty"]
        with self.assertRaisesRegex(talus.Missing, "no body pile: there are heap, stone"):
            last.of("pile")
        with self.assertRaisesRegex(talus.Missing, "no column toes: did you mean toe"):
            self.run_.history["toes"]
        self.assertNotIn("velocty", last)
        with self.assertRaises(talus.Missing):
            self.checkpoint().particles("pile")

    def test_particles_are_found_again_by_their_ids(self):
        first = {"id": np.array([3, 1, 2]), "x": np.array([3.0, 1.0, np.nan])}
        second = {"id": np.array([2, 4, 3]), "x": np.array([np.nan, 4.0, 5.0])}
        both = talus.compare(first, second)
        self.assertEqual((both.ids.tolist(), both.only_first.tolist(), both.only_second.tolist()), ([2, 3], [1], [4]))
        self.assertEqual(both.largest("x"), (2.0, 3, 0, 5.0))
        self.assertEqual(talus.compare({"id": [1], "x": np.array([1.0])}, {"id": [1], "x": np.array([np.nan])}).largest("x").largest, np.inf)

    def test_a_study_has_a_table_its_keys_and_its_runs(self):
        sweep = talus.Sweep(self.folder / "sweep")
        self.assertEqual((sweep.keys, sweep.done.tolist()), (["materials[0].friction_angle", "time.cfl"], [True] * 6))
        self.assertEqual(sweep.table.units["toe"], "m")
        self.assertEqual(sweep.run(2).history["toe"][-1], sweep.table["toe"][1])

    def test_every_example_runs_and_draws(self):
        wanted = {"plot_history.py": ["out", "kinetic", "plastic", "toe"], "slope_profile.py": ["out"], "deposit_map.py": ["out"],
                  "stress_along_line.py": ["out", *"--start 0.5 0 1 --end 0.5 1.5 1 --radius 0.4".split()],
                  "sweep_convergence.py": ["sweep", "materials[0].friction_angle", "plastic", "--order"]}
        self.assertEqual(set(wanted), {path.name for path in (ROOT / "python/examples").glob("*.py")})
        started = {name: subprocess.Popen([sys.executable, ROOT / "python/examples" / name, *words, "--out", f"{name}.png"], cwd=self.folder,
                                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for name, words in wanted.items()}
        for name, process in started.items():
            said, complaints = process.communicate(timeout=60)
            self.assertEqual((process.returncode, complaints), (0, ""), name)
            self.assertIn(f"{name}.png", said)
            self.assertGreater(matplotlib.image.imread(self.folder / f"{name}.png").std(), 0.02, f"{name} draws nothing")


class Parts(unittest.TestCase):
    def test_tensors_are_symmetric_matrices(self):
        np.testing.assert_array_equal(talus.tensors(np.array([[1.0, 2, 3, 4, 5, 6]])), [[[1, 4, 6], [4, 2, 5], [6, 5, 3]]])
        np.testing.assert_array_equal(talus.tensors(np.array([[1.0, 2, 3, 4]])), [[[1, 4, 0], [4, 2, 0], [0, 0, 3]]])

    def test_arrays_of_particle_files_come_back_whatever_the_last_block_holds(self):
        values = np.arange(60.0)
        with tempfile.TemporaryDirectory() as folder:
            for block in (48, 64, 480, 4096):
                np.testing.assert_array_equal(talus.Particles(write_particles(folder, values, block))["position"], values.reshape(20, 3))

    def test_a_table_keeps_words_units_and_empty_entries_and_loses_a_row_cut_short(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "history.csv"
            path.write_text('time [s],status,"b [x], c [J]"\n0,done,\n0.5,"a ""b""",2\n1,', encoding="utf-8")
            table = talus.Table(path)
            self.assertEqual(table.units, {"time": "s", "status": "-", "b [x], c": "J"})
            self.assertEqual((table["time"].tolist(), table["status"].tolist()), ([0, 0.5], ["done", 'a "b"']))
            np.testing.assert_array_equal(table["b [x], c"], [np.nan, 2])
            path.write_text("time [s],'=1+1 [m],''@x,'plain,status\n0,1,2,3,'-a\n", encoding="utf-8")
            self.assertEqual(list(talus.Table(path)), ["time", "=1+1", "'@x", "'plain", "status"])
            self.assertEqual(talus.Table(path)["status"].tolist(), ["-a"])
            path.write_text("time [s],x\n0\n", encoding="utf-8")
            with self.assertRaisesRegex(talus.Damaged, "history.csv:2: 1 entries for 2 columns"):
                talus.Table(path)


def write_particles(folder, values, block):
    """A file with one array, in LZ4 blocks of `block` bytes."""
    raw = values.tobytes()
    parts = [raw[i:i + block] for i in range(0, len(raw), block)]
    packed = [lz4.block.compress(part, store_size=False) for part in parts]
    last = len(parts[-1]) if len(parts[-1]) < block else 0
    head = ('<VTKFile type="PolyData" header_type="UInt64" compressor="vtkLZ4DataCompressor"><PolyData><Piece><PointData/><Points>'
            '<DataArray type="Float64" Name="Points" NumberOfComponents="3" offset="0"/></Points></Piece></PolyData>'
            '<AppendedData encoding="raw">_')
    path = Path(folder) / "p.vtp"
    path.write_bytes(head.encode() + struct.pack(f"<{3 + len(packed)}Q", len(parts), block, last, *map(len, packed)) + b"".join(packed))
    return path


if __name__ == "__main__":
    OfARun.program = sys.argv.pop(1)
    unittest.main()
