#!/usr/bin/python3
"""Laws in shared libraries: the examples of docs/guide/own_laws.md compiled as it says, beside the laws of the program, and what goes wrong.

Usage: own_law_test.py PROGRAM
"""
import csv
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "docs/guide/own_laws"
PROGRAM = ""

ELASTIC = "law: own, library: libelastic.so, symbol: elastic, density: 2000, parameters: {youngs_modulus: 1.0e7}"
LINEAR = "law: linear_elastic, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0.3"
SOIL = ("law: own, library: libsoil.so, symbol: soil, density: 1900, "
        "parameters: {youngs_modulus: 5.0e6, friction_angle: 20, cohesion: 5.0e3}")
CONE = ("law: drucker_prager, density: 1900, youngs_modulus: 5.0e6, poisson_ratio: 0.3, friction_angle: 20, cohesion: 5.0e3, match: outer")
UMAT = "law: umat, library: libumat.so, density: 2000, constants: [1.0e7, 0.3, 4.0e4], depvar: 1, dissipation: true"
METAL = "law: von_mises, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0.3, yield_stress: 4.0e4"

SCENE = """title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [4, 2], cells: [16, 8]}}
materials: [{name: ground, %s}]
bodies: [{name: block, material: ground, shape: {type: box, low: [0, 0], high: [1.5, 1.5]}, particles_per_cell: 3, velocity: [2, 1], f_bar: false}]
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: friction, on: y_min, coefficient: 0.4}, {type: roller, on: x_min}]
time: {end: 0.1, max_step: 1.0e-3}
outputs: {particles: {every: 0.05, fields: [%s]}, history: {every: 0.01}, checkpoint: {at_end: true}}
"""

BROKEN = """#include <math.h>
#include <signal.h>
#include <stdio.h>
#include "talus_law.h"
static int begin(talus_law_setup* s) { s->bulk = 1e7; s->shear = 3e6; return 0; }
static int update(talus_law_block* b)
{
  %s
  return 0;
}
static const talus_law law = {.version = %s, .measure = TALUS_LAW_DEFORMATION, .name = "broken", .begin = begin, .update = update};
const talus_law* broken(void) { return &law; }
"""


def compile_law(source, library, *flags):
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", *flags, "-I", ROOT / "materials/interface", source, "-o", library, "-lm"], check=True)


class OwnLaws(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("elastic", "soil", "umat"):
            compile_law(EXAMPLES / f"{name}.c", self.folder / f"lib{name}.so")

    def talus(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, env={**os.environ, "OMP_WAIT_POLICY": "passive"})

    def scene(self, name, law, fields="stress"):
        (self.folder / name).write_text(SCENE % (law, fields))
        return name

    def run_scene(self, name, out, *words):
        done = self.talus("run", name, "--out", out, "--quiet", "--force", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.rows(f"{out}/history.csv")

    def rows(self, file):
        with open(self.folder / file, newline="") as stream:
            lines = [line for line in stream if not line.startswith("#")]
        return [{key.split(" [")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]

    def drive(self, law, test, *words):
        self.scene("drive.yaml", law)
        done = self.talus("drive", "drive.yaml", "--test", test, "--strain", "0.02", "--steps", "200", "--out", "test.csv", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.rows("test.csv")

    def assert_near(self, one, other, relative, only=None):
        self.assertEqual(len(one), len(other))
        for key in only or one[0].keys() & other[0].keys():
            scale = max(abs(row[key]) for row in other)
            for a, b in zip(one, other):
                self.assertLessEqual(abs(a[key] - b[key]), relative * scale + 1e-30, key)

    def broken(self, body, version="TALUS_LAW_VERSION"):
        (self.folder / "broken.c").write_text(BROKEN % (body, version))
        compile_law(self.folder / "broken.c", self.folder / "libbroken.so")
        return self.scene("broken.yaml", "law: own, library: libbroken.so, symbol: broken, density: 2000")

    def test_elastic_law_drives_as_that_of_the_program(self):
        for test in ("triaxial_compression", "simple_shear", "oedometer"):
            self.assert_near(self.drive(ELASTIC, test), self.drive(LINEAR, test), 1e-9)

    def test_elastic_law_runs_as_that_of_the_program(self):
        own = self.run_scene(self.scene("own.yaml", ELASTIC), "own")
        self.assert_near(own, self.run_scene(self.scene("usual.yaml", LINEAR), "usual"), 1e-8, ["time", "kinetic", "centre_x", "centre_y"])

    def test_soil_is_a_cone_at_small_strain(self):
        for test in ("triaxial_compression", "triaxial_extension"):
            own, usual = (self.drive(law, test, "--pressure", "20e3") for law in (SOIL, CONE))
            for key, relative in (("stress_difference", 0.0015), ("plastic_strain", 0.0015), ("plastic_work", 0.0015)):
                self.assertLess(abs(own[-1][key] / usual[-1][key] - 1), relative, key)

    def test_umat_yields_as_von_mises(self):
        own, usual = (self.drive(law, "uniaxial_strain_rate") for law in (UMAT, METAL))
        for key, relative in (("stress_difference", 1e-12), ("plastic_work", 0.0015)):
            self.assertLess(abs(own[-1][key] / usual[-1][key] - 1), relative, key)
        self.run_scene(self.scene("umat.yaml", UMAT, "stress, sdv1, plastic_work, stran"), "umat")

    def test_threads_and_restart_do_not_change_a_number(self):
        for law, fields in ((SOIL, "stress, plastic_strain"), (UMAT, "stress, sdv1")):
            name = self.scene("whole.yaml", law, fields)
            self.run_scene(name, "whole", "--threads", 1)
            self.run_scene(name, "threads", "--threads", 2)
            stopped = self.talus("run", name, "--out", "parts", "--quiet", "--threads", 1, "--until", 30)
            self.assertEqual(stopped.returncode, 4, stopped.stderr)
            again = self.talus("run", "--resume", "parts", "--quiet", "--threads", 2)
            self.assertEqual(again.returncode, 0, again.stderr)
            for other in ("threads", "parts"):
                same = self.talus("diff", "whole", other, "--exact")
                same = same if "--exact" not in same.stderr else self.talus("diff", "whole", other)
                self.assertEqual(same.returncode, 0, same.stdout + same.stderr)
            shutil.rmtree(self.folder / "parts")

    def test_another_library_is_noticed_by_a_restart(self):
        name = self.scene("scene.yaml", SOIL)
        self.assertEqual(self.talus("run", name, "--out", "run", "--quiet", "--until", 20).returncode, 4)
        compile_law(EXAMPLES / "soil.c", self.folder / "libsoil.so", "-DANOTHER", "-O1")
        again = self.talus("run", "--resume", "run", "--quiet")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("goes on with another library", again.stderr)

    def test_static_stage_and_serial_law(self):
        text = SCENE % (SOIL + ", serial: true", "stress")
        text = text.replace(", velocity: [2, 1]", "").replace("time: {end: 0.1, max_step: 1.0e-3}", "stages: [{type: static, increments: 2}]")
        text = text.replace("particles: {every: 0.05, fields: [stress]}, history: {every: 0.01}, ", "")
        (self.folder / "static.yaml").write_text(text)
        done = self.talus("run", "static.yaml", "--out", "static", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_errors_of_the_scene_are_located(self):
        for law, words in (
                (ELASTIC.replace("libelastic", "libelastik"), ["materials[0] \"ground\".library: there is no file"]),
                (ELASTIC.replace("libelastic.so", "own.yaml"), ["library: the library cannot be opened"]),
                (ELASTIC.replace("symbol: elastic", "symbol: elastics"), ["symbol: the library has no function \"elastics\""]),
                (ELASTIC.replace("youngs_modulus", "young_modulus"), ["did you mean \"youngs_modulus\"?", "missing parameter \"youngs_modulus\""]),
                (ELASTIC.replace("1.0e7}", "1.0e7, poisson_ratio: 0.7}"), ["poisson_ratio", "0.7 is not allowed", "from -0.99 to 0.4999"]),
                (SOIL.replace("5.0e3}", "5.0e3, residual_cohesion: 6.0e3}"), ["residual_cohesion 6000 Pa is above cohesion 5000 Pa"]),
                (UMAT.replace("depvar: 1", "depvar: 1, initial_statev: [1, 2]"), ["initial_statev has 2 numbers, and depvar is 1"])):
            done = self.talus("check", self.scene("own.yaml", law))
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn("own.yaml:4:", done.stderr)
            for word in words:
                self.assertIn(word, done.stderr)

    def test_another_version_is_refused(self):
        done = self.talus("check", self.broken("", "TALUS_LAW_VERSION + 1"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("compiled with version 2 of talus_law.h", done.stderr)

    def test_failures_name_law_particle_and_time(self):
        message = 'snprintf(b->message, b->message_size, "too warm"); b->failed = 0; return 1;'
        for body, words in ((message, "law broken of libbroken.so: too warm (particle"), ("b->stress[0] = NAN;", "returned no finite stress"),
                            ("b->failed = 1; return 7;", "update() returned 7")):
            done = self.talus("run", self.broken(f"if (b->time > 0.01) {{ {body} }}"), "--out", "broken", "--quiet", "--force")
            self.assertEqual(done.returncode, 1, done.stderr)
            for word in ("broken of libbroken.so", words, "t = 0.01"):
                self.assertIn(word, done.stderr)

    def test_a_crash_names_the_law(self):
        done = self.talus("run", self.broken("if (b->time > 0.01) raise(SIGSEGV);"), "--out", "broken", "--quiet", "--threads", 1)
        self.assertEqual(done.returncode, -signal.SIGSEGV)
        self.assertIn("law broken of libbroken.so crashed (SIGSEGV", done.stderr)

    def test_an_exception_is_caught(self):
        source = (BROKEN % ('if (b->time > 0.01) throw std::runtime_error("thrown here");', "TALUS_LAW_VERSION"))
        source = source.replace("#include <math.h>", "#include <stdexcept>").replace("const talus_law* broken", "extern \"C\" const talus_law* broken")
        (self.folder / "broken.cpp").write_text(source)
        subprocess.run(["c++", "-std=c++20", "-shared", "-fPIC", "-I", ROOT / "materials/interface", "broken.cpp", "-o", "libbroken.so"],
                       cwd=self.folder, check=True)
        name = self.scene("broken.yaml", "law: own, library: libbroken.so, symbol: broken, density: 2000")
        done = self.talus("run", name, "--out", "broken", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("law broken of libbroken.so: thrown here", done.stderr)

    def test_results_are_read_without_the_library(self):
        self.run_scene(self.scene("own.yaml", SOIL, "displacement, plastic_strain"), "own")
        (self.folder / "libsoil.so").unlink()
        done = self.talus("report", "own")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_example_of_the_guide_passes_its_check(self):
        shutil.copy(EXAMPLES / "block.yaml", self.folder)
        done = self.talus("check", "block.yaml")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else str(ROOT / "build/release/talus")
    unittest.main()
