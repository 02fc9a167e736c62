#!/usr/bin/python3
"""Tests of check_text.py: what must pass and what must fail."""
import unittest

from check_text import check_text


class Text(unittest.TestCase):
    def passes(self, line):
        self.assertEqual(check_text("a.md", line), [])

    def fails(self, line):
        self.assertEqual(len(check_text("a.md", line)), 1, f"{line!r} was not noticed")

    def test_paths_of_one_machine(self):
        self.fails("see " + "/" + "home/me/notes")
        self.fails("-I" + " " + "/" + "work/main")
        self.passes("https://example.org/home/page")
        self.passes("stress/work balance, ~/work is fine")

    def test_paths_out_of_the_tree(self):
        self.fails(".." + "/shared/design.md")
        self.passes("../mesh/shared_nodes.hpp")

    def test_issue_numbers(self):
        self.fails("see issue " + "#12")
        self.passes("issue of the day; colour #123456; section 3")

    def test_leftovers(self):
        self.fails("<" * 7 + " HEAD")
        self.fails("text  ")

    def test_meshes_are_written_by_programs(self):
        self.assertEqual(check_text("slope.msh", "1 2 3 \n"), [])

    def test_one_file_does_not_fill_the_screen(self):
        self.assertLess(len(check_text("a.md", " \n" * 1000)), 10)

    def test_findings_name_file_and_line(self):
        self.assertTrue(check_text("a.md", "\n \n")[0].startswith("a.md:2: "))


if __name__ == "__main__":
    unittest.main()
