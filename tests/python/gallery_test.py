#!/usr/bin/python3
"""Runs every script of python/examples/gallery: it ends well and draws something, and the guide names it.

Usage: gallery_test.py PROGRAM, the built talus.
"""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib.image

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted((ROOT / "python/examples/gallery").glob("*.py"))
GUIDE = ROOT / "docs/guide/python.md"


class Gallery(unittest.TestCase):
    def test_every_script_runs_and_draws(self):
        self.assertGreaterEqual(len(SCRIPTS), 10)
        with tempfile.TemporaryDirectory() as folder:
            for script in SCRIPTS:
                picture = Path(folder) / f"{script.stem}.png"
                words = [sys.executable, "-B", script, "--out", picture]
                told = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
                self.assertEqual((told.returncode, told.stderr), (0, ""), script.name)
                self.assertIn(str(picture), told.stdout)
                self.assertGreater(matplotlib.image.imread(picture).std(), 0.02, f"{script.name} draws nothing")
            self.assertEqual({path.suffix for path in Path(folder).iterdir()}, {".png"}, "scripts leave files behind")

    def test_the_guide_names_every_script_and_shows_its_picture(self):
        guide = GUIDE.read_text(encoding="utf-8")
        for script in SCRIPTS:
            self.assertIn(f"examples/gallery/{script.name})", guide)
            self.assertIn(f"images/python_{script.stem}.png)", guide)
            self.assertTrue((ROOT / f"docs/images/python_{script.stem}.png").exists(), script.stem)


if __name__ == "__main__":
    os.environ["TALUS"] = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
