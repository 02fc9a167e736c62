#!/usr/bin/python3
"""Tests of check_hardening.py: a small program compiled with each protection missing in turn."""
import subprocess
import tempfile
import unittest
from pathlib import Path

from check_hardening import check

TEXT = '#include <stdio.h>\n#include <string.h>\nint main(int n, char** words) { char copy[32]; strcpy(copy, words[n - 1]); printf("%s\\n", copy); }\n'
FULL = {"pie": "-fPIE -pie", "relro": "-Wl,-z,relro", "now": "-Wl,-z,now", "stack": "-fstack-protector-strong",
        "fortify": "-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2", "noexec": "-Wl,-z,noexecstack"}
LESS = {"pie": ("-fno-pie -no-pie", "is not position independent"), "relro": ("-Wl,-z,norelro", "no segment that is made read-only"),
        "now": ("-Wl,-z,lazy", "binds symbols while it runs"), "stack": ("-fno-stack-protector", "no function has a stack protector"),
        "fortify": ("-U_FORTIFY_SOURCE", "no function is checked"), "noexec": ("-Wl,-z,execstack", "a stack that can be executed")}


class Hardening(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        (self.folder / "a.c").write_text(TEXT, encoding="utf-8")

    def faults(self, flags):
        subprocess.run(["gcc", "-O2", "-w", *" ".join(flags.values()).split(), self.folder / "a.c", "-o", self.folder / "a"], check=True)
        return check([str(self.folder / "a")])

    def test_nothing_is_missing(self):
        self.assertEqual(self.faults(FULL), [])

    def test_each_protection_that_is_missing_is_named(self):
        for name, (flags, words) in LESS.items():
            found = self.faults({**FULL, name: flags})
            self.assertTrue(any(words in fault for fault in found), f"{name}: {found}")


if __name__ == "__main__":
    unittest.main()
