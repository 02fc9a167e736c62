"""What tests of the package share."""
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock


class InAFolder(unittest.TestCase):
    """Each test in an empty folder of its own, with `program` as the one that the package runs."""
    program = ""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        environment = mock.patch.dict(os.environ, {"TALUS": self.program})
        environment.start()
        self.addCleanup(environment.stop)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name
