#!/usr/bin/python3
"""Makes the runs of talus fos of every example scene with a geostatic stage, whatever keys it has.

Usage: fos_scenes_test.py PROGRAM, the built talus.
"""
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from scratch import InAFolder  # noqa: E402


class Examples(InAFolder):
    """Runs that are cut short say nothing of the slope; they say whether a trial is a scene that can be run."""

    def test_makes_trials_of_every_example_with_a_state_at_rest(self):
        scenes = [scene for scene in sorted(ROOT.glob("scenes/*/scene.yaml")) if "type: geostatic" in scene.read_text(encoding="utf-8")]
        self.assertGreaterEqual(len(scenes), 5)
        for scene in scenes:
            with self.subTest(scene.parent.name):
                out = self.folder / scene.parent.name
                told = subprocess.run([self.program, "fos", scene, "--out", out, "--quick", "--from", "0.01", "--to", "100", "--width", "100",
                                       "--duration", "1", "--jobs", "1", "--threads", "1", "--no-pictures", "--quiet"], capture_output=True,
                                      encoding="utf-8", check=False)
                self.assertIn(told.returncode, (0, 1), told.stderr)  # 1: all hold, or all fail
                self.assertEqual(talus.open(out / "trial_0.01").status, "done", told.stderr)


if __name__ == "__main__":
    InAFolder.program = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
