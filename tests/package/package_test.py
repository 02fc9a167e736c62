#!/usr/bin/python3
"""Packs a build as `make package` does, unpacks the package and runs the program from there.  Nothing is installed.

Usage: package_test.py CPACK BUILD, the folder of a build.
"""
import json
import os
import re
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
FILES = """usr/bin/talus usr/libexec/talus/talus usr/libexec/talus/talus-render usr/lib/python3/dist-packages/talus/__init__.py usr/share/talus/python/talus/__init__.py
usr/share/talus/scenes/column_collapse/scene.yaml usr/share/talus/benchmarks/verify.py usr/share/talus/docs/index.md usr/share/talus/THIRD_PARTY.md
usr/share/doc/talus/copyright usr/share/doc/talus/changelog.gz usr/share/doc/talus/sbom.cdx.json usr/share/man/man1/talus.1.gz""".split()
ELF = b"\x7fELF"


def run(*words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **more)


class Package(unittest.TestCase):
    cpack = build = ""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = Path(cls.scratch.name)
        packed = run(cls.cpack, "--config", Path(cls.build) / "CPackConfig.cmake", "-B", cls.folder / "packed", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none")
        found = list((cls.folder / "packed").glob("talus_*_amd64.deb"))
        if packed.returncode or len(found) != 1:
            raise AssertionError(packed.stdout + packed.stderr)
        cls.package, cls.root = found[0], cls.folder / "root"
        subprocess.run(["dpkg-deb", "-x", cls.package, cls.root], check=True)
        cls.program = cls.root / "usr/bin/talus"
        # None of what a developer has set, nor a folder from which the build would be found
        cls.clean = {"env": {"PATH": "/usr/bin:/bin", "HOME": str(cls.folder), "LC_ALL": "C.UTF-8", "OMP_WAIT_POLICY": "passive"}, "cwd": cls.folder}

    def files(self):
        return [path for path in self.root.rglob("*") if path.is_file() and not path.is_symlink()]

    def programs(self):
        found = [path for path in self.files() if path.read_bytes().startswith(ELF)]
        self.assertGreaterEqual(len(found), 3)
        return found

    def test_the_files_are_there_and_no_others_of_the_build(self):
        for name in FILES:
            self.assertTrue((self.root / name).is_file(), name)
        for part in ("gmsh", "gdal", "petsc"):
            self.assertTrue(list(self.root.glob(f"usr/libexec/talus/**/libtalus_{part}.so")), part)
        self.assertEqual((Path(self.build) / "report.html").exists(), (self.root / "usr/libexec/talus/report.html").exists())
        has_completion = run(self.program, "completion", "bash", **self.clean).returncode == 0
        self.assertEqual(has_completion, (self.root / "usr/share/bash-completion/completions/talus").exists())
        strange = [path for path in self.files() if "__pycache__" in path.parts or path.suffix in {".a", ".o", ".ninja", ".log"}]
        self.assertEqual(strange, [])

    def test_permissions_are_those_of_a_package(self):
        for path in self.root.rglob("*"):
            if path.is_symlink():
                self.assertFalse(os.path.isabs(os.readlink(path)), path)
                self.assertTrue(path.exists(), f"{path} leads nowhere")
                continue
            mode = stat.S_IMODE(path.stat().st_mode)
            self.assertIn(mode, {0o755} if path.is_dir() else {0o755, 0o644}, path)
        for name in ("talus", "talus-render"):
            self.assertEqual(stat.S_IMODE((self.root / "usr/libexec/talus" / name).stat().st_mode), 0o755)

    def test_no_program_knows_where_it_was_built(self):
        places = {str(SOURCE).encode(), str(Path(self.build).resolve()).encode()}
        for path in self.programs():
            searched = re.findall(r"(?:RPATH|RUNPATH).*\[(.*)\]", run("readelf", "-d", path).stdout)
            for place in ":".join(searched).split(":"):
                self.assertRegex(place, r"^\$ORIGIN(/lib)?$", path)
            content = path.read_bytes()
            for place in places:  # a failed assertion of a build for tests names the source file, which is no place to look
                named = {text for text in re.findall(re.escape(place) + rb"[\w./-]*", content) if not text.endswith((b".hpp", b".cpp"))}
                self.assertEqual(named, set(), path)

    def test_what_is_handed_to_others_is_built_as_debian_builds(self):
        if "TALUS_HARDENED:BOOL=ON" not in (Path(self.build) / "CMakeCache.txt").read_text(encoding="utf-8"):
            self.skipTest("a build of a developer (tools/build_portable.sh looks at those for others)")
        checked = run(sys.executable, "-B", SOURCE / "tools/check_hardening.py", *self.programs())
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_the_package_names_what_it_needs(self):
        told = run("dpkg-deb", "-f", self.package).stdout
        for package in ("libgmsh4.8", "libgdal32", "libvtk9.1", "libhdf5-openmpi-103-1", "libpetsc-real3.18", "libopenmpi3", "libgomp1", "libmetis5"):
            self.assertRegex(told, rf"Depends:.*\b{re.escape(package)}\b")
        for package in ("xvfb", "xauth", "libgl1-mesa-dri", "python3-h5py"):
            self.assertRegex(told, rf"Recommends:.*\b{package}\b")
        self.assertRegex(told, r"Suggests:.*\bffmpeg\b")

    def test_the_bill_of_materials_names_all_that_is_in_the_programs_and_the_page(self):
        document = json.loads((self.root / "usr/share/doc/talus/sbom.cdx.json").read_text(encoding="utf-8"))
        self.assertEqual((document["bomFormat"], document["specVersion"]), ("CycloneDX", "1.5"))
        self.assertRegex(document["serialNumber"], r"^urn:uuid:[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$")
        told = run("dpkg-deb", "-f", self.package, "Version", "Depends").stdout
        self.assertIn(f"Version: {document['metadata']['component']['version']}\n", told)
        components = document["components"]
        references = [component["bom-ref"] for component in components]
        self.assertEqual(len(references), len(set(references)))
        for component in components:
            self.assertEqual(component["type"], "library")
            self.assertRegex(component["purl"], r"^pkg:(deb/\w+|npm)/[\w.%+~-]+(/[\w.-]+)?@[\w.%+~-]+(\?arch=\w+&distro=[\w.-]+)?$")
        (root,) = document["dependencies"]
        self.assertEqual(root["ref"], document["metadata"]["component"]["bom-ref"])
        self.assertLessEqual(set(root["dependsOn"]), set(references))
        # What dpkg-shlibdeps found by itself, and what a compiler leaves no trace of.
        linked = set(re.findall(r"[\w.+-]+", re.sub(r"\([^)]*\)", "", told.split("Depends:")[1]))) - {"python3"}
        self.assertGreater(len(linked), 10)
        self.assertLessEqual(linked | {"libeigen3-dev", "libcli11-dev", "nlohmann-json3-dev"}, {component["name"] for component in components})
        page = json.loads((SOURCE / "page/package.json").read_text(encoding="utf-8"))
        for name, version in page["dependencies"].items():
            self.assertIn(f"pkg:npm/{name}@{version}", root["dependsOn"])
        for name, version in page["devDependencies"].items():
            self.assertIn((name, version, "excluded"), {(c["name"], c["version"], c.get("scope")) for c in components})

    def test_the_program_runs_from_where_it_is_unpacked(self):
        told = run(self.program, "--version", **self.clean)
        self.assertRegex(told.stdout, r"^talus \d+\.\d+\.\d+")
        self.assertIn("licence:", run(self.program, "info", **self.clean).stdout)
        scene = self.root / "usr/share/talus/scenes/column_collapse/scene.yaml"  # whose mesh gmsh makes
        ran = run(self.program, "run", scene, "--quick", "--quiet", "--out", "column", **self.clean)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual([line for line in ran.stderr.splitlines() if not line.startswith("warning: ")], [])  # a coarse run may have those
        read = run("/usr/bin/python3", "-B", "-c", "import talus; run = talus.Run('column'); print(run.status, len(run.particles[-1]['id']) > 0)",
                   env={**self.clean["env"], "PYTHONPATH": str(self.root / "usr/lib/python3/dist-packages")}, cwd=self.folder)
        self.assertEqual((read.stdout, read.stderr), ("done True\n", ""))

    def test_the_suite_of_the_package_is_the_one_that_runs(self):
        told = run(self.program, "verify", "single_particle_bar", "--out", "verified", **self.clean)
        self.assertEqual((told.returncode, told.stderr), (0, ""))
        self.assertTrue((self.folder / "verified/verify.json").is_file())
        self.assertEqual([path for path in self.root.rglob("__pycache__")], [])
        wrong = run(self.program, "verify", "no_such_case", **self.clean)
        self.assertEqual(wrong.returncode, 2, wrong.stderr)


if __name__ == "__main__":
    Package.build = sys.argv.pop()
    Package.cpack = sys.argv.pop()
    unittest.main()
