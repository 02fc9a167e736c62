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
import time
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from talus.runs import open_run  # noqa: E402

EXAMPLES = ROOT / "docs/guide/own_laws"
PROGRAM = ""

ELASTIC = "law: own, library: libelastic.so, symbol: elastic, density: 2000, parameters: {youngs_modulus: 1.0e7}"
LINEAR = "law: linear_elastic, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0.3"
SOIL = ("law: own, library: libsoil.so, symbol: soil, density: 1900, "
        "parameters: {youngs_modulus: 5.0e6, friction_angle: 20, cohesion: 5.0e3}")
CONE = ("law: drucker_prager, density: 1900, youngs_modulus: 5.0e6, poisson_ratio: 0.3, friction_angle: 20, cohesion: 5.0e3, match: outer")
PYTHON = ("law: own, library: metal.py, symbol: metal, density: 2000, parameters: {youngs_modulus: 1.0e7, yield_stress: 4.0e4}")
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


ORTHOTROPIC = """#include <math.h>
#include <stddef.h>
#include "talus_law.h"
/* Moduli of 11, 22, 33 and of the engineering shears 12, 13, 23. */
static const double moduli[6] = {1.0e7, 1.3e7, 1.7e7, 2.0e6, 3.0e6, 5.0e6};
static int begin(talus_law_setup* s) { s->bulk = 2.0e7; s->shear = 1.0e7; return 0; }
static int update(talus_law_block* b)
{
  static const int abaqus[6] = {0, 1, 2, 3, 5, 4}; /* xx, yy, zz, xy, yz, xz there */
  for (int p = 0; p < b->n; ++p)
    for (int k = 0; k < 6; ++k) {
      const double e = b->strain[k * b->stride + p];
      b->stress[k * b->stride + p] += moduli[abaqus[k]] * (k < 3 ? 1 : 2) * e;
      b->history[k * b->stride + p] += e;
    }
  return 0;
}
static const talus_law_variable variables[] = {{"turned", "-", "", 6, 1, 0}};
static const talus_law law = {.version = TALUS_LAW_VERSION, .measure = TALUS_LAW_STRAIN, .name = "own", .n_variables = 1, .variables = variables,
                              .begin = begin, .update = update};
const talus_law* own(void) { return &law; }

void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl, double* ddsddt, double* drplde,
           double* drpldt, const double* stran, const double* dstran, const double* time, const double* dtime, const double* temp,
           const double* dtemp, const double* predef, const double* dpred, const char* cmname, const int* ndi, const int* nshr,
           const int* ntens, const int* nstatv, const double* props, const int* nprops, const double* coords, const double* drot)
{
  static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  double t[3][3], turned[3][3] = {{0}};
  for (int k = 0; k < 6; ++k)
    t[row[k]][column[k]] = t[column[k]][row[k]] = statev[k];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n)
          turned[i][j] += drot[3 * m + i] * t[m][n] * drot[3 * n + j]; /* Fortran: by columns */
  for (int k = 0; k < 6; ++k) {
    stress[k] += moduli[k] * dstran[k];
    ddsdde[7 * k] = moduli[k];
    statev[k] = turned[row[k]][column[k]] + dstran[k] / (k < 3 ? 1 : 2);
  }
}
"""


class OwnLaws(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("elastic", "soil", "umat"):
            compile_law(EXAMPLES / f"{name}.c", self.folder / f"lib{name}.so")
        shutil.copy(EXAMPLES / "metal.py", self.folder)

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

    def test_law_in_python_is_von_mises(self):
        for test in ("uniaxial_strain_rate", "simple_shear", "oedometer"):
            own, usual = (self.drive(law, test) for law in (PYTHON, UMAT))
            for a, b in zip(own, usual):
                for key in ("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz"):
                    self.assertLess(abs(a[key] - b[key]), 1e-12 * 4e4 * 10, key)
                self.assertLess(abs(a["plastic_work"] - b["plastic_work"]), 0.02 * b["plastic_work"] + 1e-3)   # per initial and present volume
                self.assertEqual(a["plastic_strain"] > 0, b["plastic_work"] > 0)

    def test_errors_of_laws_in_python_have_their_line(self):
        whole = (EXAMPLES / "metal.py").read_text()
        for old, new, words in (
                ("    def update(self, block):\n", "    def update(self, block):\n        block.speed\n", "metal.py:18: in update(): AttributeError"),
                ("        stress[:] = deviator\n", "        return deviator\n", "returns nothing"),
                ("        stress[:] = deviator\n", "        self.kept = block.F[:, 0]\n", "update() keeps block.F, which changes later: keep block.F.copy()"),
                ("        strain, stress = block.strain", "        block.F[:] = 0\n        strain, stress = block.strain", "read-only"),
                ("        stress[:] = deviator\n", "        stress[:] = np.nan\n", "returned no finite stress")):
            (self.folder / "metal.py").write_text(whole.replace(old, new))
            done = self.talus("run", self.scene("python.yaml", PYTHON), "--out", "python", "--quiet", "--force")
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn(words, done.stderr)
        for old, new, words in (
                ("class metal", "class bronze", "there is no law metal"), ("def update", "def step", "it has no function update"),
                ("return E / (3", "return 1 / 0 * E / (3", "metal.py:15: in begin(): ZeroDivisionError"),
                ("import numpy", "import numbers numpy", "metal.py:2:"), ('"plastic_strain": "-"', '"plastic_strain": ("-", 3)', "3 components, not 1 or 6")):
            (self.folder / "metal.py").write_text(whole.replace(old, new))
            done = self.talus("check", self.scene("python.yaml", PYTHON))
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(words, done.stderr)
            self.assertIn("python.yaml:4:", done.stderr)

    def test_strength_of_a_law_in_python_is_divided(self):
        """Bitwise: a stage with half the strength is a run of a material with half of it."""
        def with_stage(name, law, more):
            text = SCENE % (law, "stress")
            (self.folder / name).write_text(text.replace("time: {end: 0.1, max_step: 1.0e-3}", "stages: [{type: run, duration: 0.05%s}]" % more))
            self.run_scene(name, name + ".out")
            return (self.folder / f"{name}.out/history.csv").read_bytes()
        half = with_stage("half.yaml", PYTHON.replace("4.0e4", "2.0e4"), "")
        self.assertEqual(with_stage("weak.yaml", PYTHON, ", weaken: [{body: block, factor: 2}]"), half)
        self.assertNotEqual(with_stage("whole.yaml", PYTHON, ""), half)

    def test_umat_gets_components_and_rotation_as_abaqus_gives_them(self):
        """Six different moduli, a tensor in STATEV that the subroutine rotates by DROT, and the sum of strains: beside the same through talus_law.h."""
        (self.folder / "both.c").write_text(ORTHOTROPIC)
        compile_law(self.folder / "both.c", self.folder / "libboth.so")
        rows = {}
        for name, law in (("umat", "law: umat, library: libboth.so, density: 2000, depvar: 6, bulk_modulus: 2.0e7, shear_modulus: 1.0e7"),
                          ("own", "law: own, library: libboth.so, symbol: own, density: 2000")):
            text = (SCENE % (law, "stress")).replace("dimension: 2", "dimension: 3")
            for old, new in (("low: [0, 0], high: [4, 2], cells: [16, 8]", "low: [-2, -2, -2], high: [4, 3, 3], cells: [6, 5, 5]"),
                             ("low: [0, 0], high: [1.5, 1.5]", "low: [0, 0, 0], high: [1.5, 1, 1]"), ("[0, -9.81]", "[0, 0, 0]"),
                             ("velocity: [2, 1]", "velocity: ['3*y+z', '-5*x+2*z', '4*x-3*y+x*z']"),
                             ("particles_per_cell: 3", "particles_per_cell: 4"), ("end: 0.1", "end: 0.05"), ("every: 0.05", "every: 0.025")):
                self.assertIn(old, text)
                text = text.replace(old, new)
            text = "\n".join(line for line in text.splitlines() if not line.startswith("boundaries")) + "\n"
            (self.folder / f"{name}.yaml").write_text(text)
            self.run_scene(f"{name}.yaml", name)
            rows[name] = open_run(self.folder / name).checkpoints[-1].particles("block")
        own, umat = rows["own"], rows["umat"]
        np.testing.assert_allclose(umat["stress"], own["stress"], rtol=0, atol=1e-11 * abs(own["stress"]).max())
        turned = np.stack([umat[f"sdv{k}"] for k in (1, 2, 3, 4, 6, 5)], axis=1)
        self.assertGreater(abs(own["turned"][:, 3:]).min(axis=1).max(), 1e-3)   # shears of all three planes
        np.testing.assert_allclose(turned, own["turned"], rtol=0, atol=1e-12)
        np.testing.assert_allclose(umat["stran"], own["turned"], rtol=0, atol=1e-12)

    def test_umat_in_fortran(self):
        if shutil.which("gfortran") is None:
            self.skipTest("no gfortran")
        subprocess.run(["gfortran", "-O2", "-shared", "-fPIC", EXAMPLES / "umat.f", "-o", self.folder / "libfortran.so"], check=True)
        law = "law: umat, library: libfortran.so, density: 2000, constants: [1.0e7, 0.3]"
        self.assert_near(self.drive(law, "triaxial_compression"), self.drive(LINEAR, "triaxial_compression"), 1e-9, ["stress_difference", "F_zz"])

    def test_a_shorter_step_is_an_error_of_one_particle(self):
        text = (EXAMPLES / "umat.c").read_text().replace("  const double E = props[0]", "  if (*noel == 5 && time[1] > 0.01)\n    *pnewdt = 0.5;\n  const double E = props[0]")
        (self.folder / "short.c").write_text(text)
        compile_law(self.folder / "short.c", self.folder / "libumat.so")
        name = self.scene("short.yaml", UMAT)
        done = self.talus("run", name, "--out", "short", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("it asks for a shorter time step, PNEWDT = 0.5", done.stderr)
        self.assertIn("(particle 4 of", done.stderr)
        text = (self.folder / name).read_text() + "watch: {on_failure: delete, failed_mass: 0.01}\n"
        (self.folder / name).write_text(text)
        self.run_scene(name, "without")
        first, last = (open_run(self.folder / "without").particles[k]["id"] for k in (0, -1))
        self.assertEqual(set(first) - set(last), {4})

    def test_laws_of_a_scene_share_names_of_one_form(self):
        (self.folder / "both.c").write_text(ORTHOTROPIC)
        (self.folder / "other.c").write_text(ORTHOTROPIC.replace('"turned", "-", "", 6, 1, 0', '"turned", "-", "", 1, 0, 0'))
        for name in ("both", "other"):
            compile_law(self.folder / f"{name}.c", self.folder / f"lib{name}.so")
        law = "law: own, library: lib%s.so, symbol: own, density: 2000"
        done = self.talus("check", self.scene("two.yaml", law % "both" + "}, {name: another, " + law % "other"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("materials[1] \"another\".symbol: the history variable \"turned\" of the law own of libother.so has 1 components", done.stderr)

    def test_subroutines_cannot_suspend_yielding(self):
        text = SCENE % (UMAT, "stress")
        text = text.replace(", velocity: [2, 1]", "").replace("time: {end: 0.1, max_step: 1.0e-3}", "stages: [{type: geostatic, duration: 1}]")
        (self.folder / "geostatic.yaml").write_text(text)
        done = self.talus("check", "geostatic.yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("stages[0]: the subroutine of material \"ground\" cannot suspend yielding", done.stderr)

    def test_moduli_that_bound_no_step_are_an_error(self):
        done = self.talus("run", self.broken("if (b->time > 0.01) b->bulk[0] = -1e9;"), "--out", "broken", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("from which no time step follows", done.stderr)

    def test_threads_and_restart_do_not_change_a_number(self):
        for law, fields in ((SOIL, "stress, plastic_strain"), (UMAT, "stress, sdv1"), (PYTHON, "stress, plastic_strain")):
            name = self.scene("whole.yaml", law, fields)
            self.run_scene(name, "whole", "--threads", 1)
            self.run_scene(name, "threads", "--threads", 2)
            stopped = self.talus("run", name, "--out", "parts", "--quiet", "--threads", 1, "--until", 30)
            self.assertEqual(stopped.returncode, 4, stopped.stderr)
            again = self.talus("run", "--resume", "parts", "--quiet", "--threads", 2)
            self.assertEqual(again.returncode, 0, again.stderr)
            for other in ("threads", "parts"):
                same = self.talus("diff", "whole", other)
                self.assertEqual(same.returncode, 0, same.stdout + same.stderr)
                self.assertIn("the same", same.stdout)
                self.assertEqual(*((self.folder / run / "history.csv").read_bytes() for run in ("whole", other)))
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

    def test_a_loop_without_end_is_named_when_the_run_is_ended(self):
        name = self.broken('volatile int forever = b->time > 0.01 && b->id[0] > 20; if (forever) fclose(fopen("loops", "w")); while (forever) ;')
        command = [PROGRAM, "run", name, "--out", "broken", "--quiet", "--threads", "2"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True) as run:
            for _ in range(600):  # the machine may be busy
                if (self.folder / "loops").exists():
                    break
                time.sleep(0.1)
            run.send_signal(signal.SIGINT)
            with self.assertRaises(subprocess.TimeoutExpired):
                run.wait(1.5)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(30), -signal.SIGINT)
            self.assertIn("error: law broken of libbroken.so had not returned in a block of particles, from ", run.stderr.read())

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
