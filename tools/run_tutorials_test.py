#!/usr/bin/python3
"""Tests of run_tutorials.py: which promises hold and which are noticed to be broken."""
import pathlib
import tempfile
import unittest

import run_tutorials
from run_tutorials import Broken, blocks, check_printed, run, take_pictures

PRINTED = "energy [J]   run\n  gravity   5.2114e+07\n  strain   13460\n  plastic   4.76e+07\nresults in x\n"


class Printed(unittest.TestCase):
    def test_lines_hold_with_numbers_nearly_the_same(self):
        check_printed("energy [J] run\n  gravity 5.2e7\n", PRINTED)
        check_printed("...\n  plastic 4.7e+07\n", PRINTED)
        check_printed("energy ...\n...\nresults in x\n", PRINTED)

    def test_other_numbers_words_and_orders_do_not(self):
        for promise in ("...\n  plastic 4.3e+07\n", "...\n  plastics 4.76e+07\n", "...\nresults in x\nenergy [J] run\n", "energy [J] run\n  strain 13460\n",
                        "...\n  plastic 4.76e+07 J\n"):
            with self.assertRaises(Broken, msg=promise):
                check_printed(promise, PRINTED)


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def follow(self, text):
        page = self.folder / "page.md"
        page.write_text(text, encoding="utf-8")
        run(page, pathlib.Path("/bin/true"), self.folder / "scratch")
        return page

    def test_files_are_written_and_commands_run_in_order(self):
        self.follow("Write this to `a.txt`:\n\n```yaml\nx: 1\n```\n\n```sh\ncat a.txt > b.txt  # writes b.txt\ncat b.txt\n```\n\n```text\nx: 1\n```\n")
        self.assertEqual((self.folder / "scratch/b.txt").read_text(), "x: 1\n")

    def test_broken_promises_are_noticed(self):
        for page in ("```sh\nfalse\n```\n", "```sh\ntrue  # writes b.txt\n```\n", "```sh\necho 1\n```\n\n```text\n2\n```\n"):
            with self.assertRaises(Broken, msg=page):
                self.follow(page)

    def test_what_is_shown_of_a_file_must_stand_there(self):
        (self.folder / "law.hpp").write_text("struct Law {};\n", encoding="utf-8")
        self.follow("In [`law.hpp`](law.hpp):\n\n```cpp\nstruct Law {};\n```\n")
        with self.assertRaises(Broken):
            self.follow("In [`law.hpp`](law.hpp):\n\n```cpp\nstruct Other {};\n```\n")

    def test_pictures_go_to_where_the_page_shows_them_from(self):
        page = self.follow("```sh\necho picture > p.png\n```\n\n![It](images/p.png)\n")
        take_pictures(page, self.folder / "scratch")
        self.assertEqual((self.folder / "images/p.png").read_text(), "picture\n")


class Pages(unittest.TestCase):
    def test_every_tutorial_has_something_that_is_checked(self):
        for page in run_tutorials.PAGES.glob("*.md"):
            text = page.read_text(encoding="utf-8")
            checked = [b for b in blocks(text) if b[1] == "sh" or run_tutorials.QUOTED.search(b[0])]
            self.assertTrue(checked, page)


if __name__ == "__main__":
    unittest.main()
