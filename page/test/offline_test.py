#!/usr/bin/python3
"""How the page is made where nothing can be fetched: cmake/MakePage.cmake with an npm that fails.  Usage: offline_test.py CMAKE BUILD."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]


class Offline(unittest.TestCase):
    cmake = build = ""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.page = self.folder / "report.html"

    def program(self, name, text):
        path = self.folder / name
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
        return path

    def make(self, npm, node):
        words = {"npm": npm, "node": node, "source": SOURCE, "work": self.folder / "page", "page": self.page}
        return subprocess.run([self.cmake, *[word for key, value in words.items() for word in ("-D", f"{key}={value}")],
                               "-P", SOURCE.parent / "cmake/MakePage.cmake"], capture_output=True, text=True, check=False)

    def test_without_network_the_build_goes_on_and_says_what_is_left_out(self):
        self.page.write_text("an older page", encoding="utf-8")
        done = self.make(self.program("npm", "echo 'npm ERR! network request failed' >&2; exit 1"), self.program("node", "exit 1"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the page of `talus report` and `talus watch` is left out", done.stderr)
        self.assertIn("npm ERR! network request failed", done.stderr)
        self.assertFalse(self.page.exists())

    def test_without_node_the_build_goes_on(self):
        done = self.make("", "")
        self.assertEqual((done.returncode, self.page.exists()), (0, False))
        self.assertIn("Node.js 18 or later and npm were not found", done.stderr)

    def test_libraries_are_fetched_once_for_a_lock_file(self):
        npm = self.program("npm", f"echo called >> {self.folder}/calls")
        node = self.program("node", 'echo made > "$2"')
        for _ in range(2):
            self.assertEqual(self.make(npm, node).returncode, 0)
            self.assertEqual(self.page.read_text(encoding="utf-8"), "made\n")
        self.assertEqual((self.folder / "calls").read_text(encoding="utf-8"), "called\n")
        (self.folder / "page/installed").write_text("of another lock file", encoding="utf-8")
        self.make(npm, node)
        self.assertEqual((self.folder / "calls").read_text(encoding="utf-8"), "called\ncalled\n")

    def test_a_page_that_cannot_be_made_of_what_is_there_is_an_error(self):
        done = self.make(self.program("npm", "exit 0"), self.program("node", "exit 1"))
        self.assertNotEqual(done.returncode, 0)


if __name__ == "__main__":
    Offline.build = sys.argv.pop()
    Offline.cmake = sys.argv.pop()
    unittest.main()
