#!/usr/bin/python3
"""Runs the examples of docs/guide/python.md, one block after the other, as a reader would: from a folder with the scenes of the repository.

A line that ends with a comment in quotes, such as `run.status  # "done"`, must have this value.
Usage: guide_test.py PROGRAM, the built talus.  Examples with pandas or xarray are skipped where these are not installed.
"""
import ast
import contextlib
import io
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.S | re.M)
PROMISED = re.compile(r'# "([^"]*)"$')


class Guide(unittest.TestCase):
    def run_statements(self, block, names):
        """Runs the statements of a block; those that are expressions with a promised value are compared."""
        lines = block.splitlines()
        for statement in ast.parse(block).body:
            promised = PROMISED.search(lines[statement.end_lineno - 1])
            if isinstance(statement, ast.Expr) and promised:
                value = eval(compile(ast.Expression(statement.value), "python.md", "eval"), names)
                self.assertEqual(value, promised[1], lines[statement.lineno - 1])
            else:
                exec(compile(ast.Module([statement], []), "python.md", "exec"), names)

    def test_every_block_runs(self):
        blocks = BLOCK.findall((ROOT / "docs/guide/python.md").read_text(encoding="utf-8"))
        self.assertGreater(len(blocks), 6)
        self.assertGreaterEqual(sum(len(PROMISED.findall(line)) for block in blocks for line in block.splitlines()), 2)
        missing, names = [], {}
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            Path("scenes").symlink_to(ROOT / "scenes")
            for block in blocks:
                with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(io.StringIO()):
                    try:
                        self.run_statements(block, names)
                    except talus.MissingPackage as error:
                        missing.append(str(error))
                if "SceneError" in block:
                    self.assertEqual(said.getvalue().count(" -> "), 2, said.getvalue())
            self.assertTrue(Path("heap.png").stat().st_size > 1000)
        if missing:
            self.skipTest("; ".join(missing))


if __name__ == "__main__":
    os.environ["TALUS"] = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
