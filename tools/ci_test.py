#!/usr/bin/python3
"""Tests of what `make` and CI do with warnings and processors: what anyone types does not fail by a warning, and CI types the same.

Nothing is compiled: `make -n` prints what it would do.
"""
import json
import os
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def commands(*words, **variables):
    kept = {name: value for name, value in os.environ.items() if name not in {"TALUS_WERROR", "BUILD", "LEVEL", "MAKEFLAGS"}}
    return subprocess.run(["make", "-n", "-C", ROOT, *words], capture_output=True, text=True, check=True, env={**kept, **variables}).stdout


class Ci(unittest.TestCase):
    def test_no_preset_makes_warnings_errors(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        self.assertGreater(len(presets), 5)
        self.assertEqual([p["name"] for p in presets if "TALUS_WERROR" in p.get("cacheVariables", {})], [])
        self.assertFalse(any("-Werror" in str(p) for p in presets))

    def test_warnings_are_errors_only_where_it_is_asked_for(self):
        for target in ("build", "test"):
            self.assertIn("-D TALUS_WERROR=OFF", commands(target))
            self.assertIn("-D TALUS_WERROR=ON", commands(target, TALUS_WERROR="ON"))
        self.assertRegex((ROOT / "tools/ci.sh").read_text(encoding="utf-8"), r"(?m)^export TALUS_WERROR=ON$")

    def test_ci_types_make_build_and_make_test_for_another_processor_in_a_folder_of_its_own(self):
        script = (ROOT / "tools/ci.sh").read_text(encoding="utf-8")
        self.assertRegex(script, r'(?m)^all_stages=\(.*\bbuild\b.* test\)$')
        for stage, target in ("build", "build"), ("test", "test"):
            self.assertRegex(script, rf'(?m)^stage_{stage}\(\) \{{ make {target} \$newcomer JOBS="\$jobs"; \}}$')
        words = re.search(r'(?m)^newcomer="(.*)"$', script).group(1).split()
        for target in "build", "test":
            there, here = commands(target, *words), commands(target)
            self.assertRegex(there, r"cmake --preset release -B build/newcomer -D TALUS_LEVEL=x86-64-v\d ")
            self.assertIn("cmake --preset release -B build/release -D TALUS_LEVEL= ", here)
            self.assertEqual(there.replace("build/newcomer", "build/release").replace("TALUS_LEVEL=x86-64-v3", "TALUS_LEVEL="), here)

    def test_cases_left_to_the_night_are_not_those_of_the_readme(self):
        cases = re.search(r"(?m)^nightly_cases=\((.*)\)$", (ROOT / "tools/ci.sh").read_text(encoding="utf-8")).group(1).split()
        rows = set(re.findall(r"(?m)^\| \[.*?\]\(benchmarks/(\w+)/README.md\)", (ROOT / "README.md").read_text(encoding="utf-8")))
        self.assertGreater(len(rows), 8)
        self.assertFalse(rows & set(cases))
        for case in cases:
            self.assertTrue((ROOT / "benchmarks" / case / "case.py").exists(), case)

    def test_targets_ask_for_their_packages_only(self):
        self.assertRegex(commands("build"), r"(?m)^tools/install_packages.sh build$")
        self.assertRegex(commands("site"), r"(?m)^tools/install_packages.sh docs$")


if __name__ == "__main__":
    unittest.main()
