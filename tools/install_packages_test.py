#!/usr/bin/python3
"""Tests of install_packages.sh on releases that are made up: apt-get, apt-cache, dpkg-query and id of a folder that comes first on the path."""
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent / "install_packages.sh"
LIST = Path(__file__).resolve().parent / "debian-packages.txt"

FAKES = {
    "apt-get": 'echo "apt-get $*" >> "$FAKE/calls"; for word in $FAKE_FAILS; do case " $* " in *" $word "*) exit 100 ;; esac; done',
    "apt-cache": 'shift; for name in $*; do case " $FAKE_APT " in *" $name "*) what=1.0 ;; *) what="(none)" ;; esac; '
                 'printf "%s:\\n  Installed: (none)\\n  Candidate: %s\\n" "$name" "$what"; done',
    "dpkg-query": 'for name in $*; do case " $FAKE_INSTALLED " in *" $name "*) echo "ii  $name" ;; esac; done',
    "id": 'echo "$FAKE_USER"',
    "sudo": "exit 1",
}
TOOLS = "bash env sed awk tr sort xargs head paste grep dirname cat".split()


class Packages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        for name, text in FAKES.items():
            (self.folder / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
            (self.folder / name).chmod(0o755)
        for name in TOOLS:  # nothing else of this machine is on the path
            (self.folder / name).symlink_to(next(p for p in (Path("/usr/bin") / name, Path("/bin") / name) if p.exists()))
        self.listed = self.folder / "packages.txt"
        self.listed.write_text("[build]\ngcc  # a remark\ncmake\n?node:nodejs\n[test]\nold-14|old\n?chromium:chromium\n", encoding="utf-8")

    def install(self, *groups, apt="", installed="", user=0, fails=""):
        calls = self.folder / "calls"
        calls.unlink(missing_ok=True)
        environment = {"PATH": str(self.folder), "FAKE": str(self.folder), "FAKE_APT": apt, "FAKE_INSTALLED": installed, "FAKE_USER": str(user),
                       "FAKE_FAILS": fails, "TALUS_PACKAGES": str(self.listed)}
        done = subprocess.run([self.folder / "bash", SCRIPT, *groups], capture_output=True, text=True, check=False, env=environment, stdin=subprocess.DEVNULL)
        installs = [line.split("--no-install-recommends ")[1].split() for line in calls.read_text(encoding="utf-8").splitlines()
                    if " install " in line] if calls.exists() else []
        return done, [name for names in installs for name in names]

    def test_a_group_asks_for_its_own_packages_only(self):
        done, names = self.install("build", apt="gcc cmake nodejs old-14 chromium")
        self.assertEqual((done.returncode, names), (0, ["gcc", "cmake", "nodejs"]), done.stderr)

    def test_the_first_name_that_the_release_has_is_taken(self):
        self.assertEqual(self.install("test", apt="old-14 old chromium")[1], ["old-14", "chromium"])
        self.assertEqual(self.install("test", apt="old chromium")[1], ["old", "chromium"])
        self.assertEqual(self.install("test", apt="old-14 chromium", installed="old")[1], ["chromium"])

    def test_what_can_be_done_without_does_not_stop_anything(self):
        done, names = self.install("build", "test", apt="gcc cmake nodejs old")
        self.assertEqual((done.returncode, names), (0, ["gcc", "cmake", "old", "nodejs"]), done.stderr)
        self.assertIn("done without chromium", done.stdout)

    def test_nothing_is_fetched_for_what_the_release_does_not_have(self):
        done, names = self.install("test", installed="old")
        self.assertEqual((done.returncode, names, (self.folder / "calls").exists()), (0, [], False), done.stderr)
        self.assertIn("done without chromium", done.stdout)

    def test_without_network_the_build_goes_on_when_only_that_is_missing(self):
        done, _ = self.install("build", apt="nodejs", installed="gcc cmake", fails="update install")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("done without nodejs", done.stdout)
        done, _ = self.install("build", apt="gcc nodejs", installed="cmake", fails="update install")
        self.assertNotEqual(done.returncode, 0)

    def test_what_no_release_has_is_named_before_anything_is_installed(self):
        done, names = self.install("test", apt="chromium")
        self.assertEqual((done.returncode, names), (3, []))
        self.assertIn("old-14 or old", done.stderr)

    def test_who_is_not_root_is_told_what_to_type(self):
        done, names = self.install("build", "test", apt="gcc cmake nodejs old", installed="cmake", user=1000)
        self.assertEqual((done.returncode, names), (3, []))
        self.assertIn("apt-get install -y --no-install-recommends gcc old nodejs\n", done.stderr)
        self.assertEqual(self.install("build", apt="nodejs", installed="gcc cmake", user=1000)[0].returncode, 0)

    def test_a_group_that_is_none_is_refused(self):
        self.assertEqual(self.install("build", "fast")[0].returncode, 2)

    def test_a_program_asks_for_what_makes_it_and_nothing_else(self):
        self.listed = LIST
        _, names = self.install("build", apt="".join(f"{line.split()[0].lstrip('?').split(':')[-1].replace('|', ' ')} "
                                                     for line in LIST.read_text(encoding="utf-8").splitlines() if line and line[0] not in "#[ "))
        self.assertIn("libvtk9-dev", names)
        for name in ("chromium", "clang-14", "gnuplot-nox", "mkdocs", "libgtest-dev", "xvfb"):
            self.assertNotIn(name, names)


if __name__ == "__main__":
    unittest.main()
