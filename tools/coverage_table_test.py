#!/usr/bin/python3
"""Tests of coverage_table.py."""
import unittest

from coverage_table import count, table


def entry(name, *lines):
    return {"file": name, "lines": [{"line_number": number, "count": times} for number, times in lines]}


class Coverage(unittest.TestCase):
    def test_a_line_is_run_if_one_instance_of_it_is(self):
        self.assertEqual(count({"files": [entry("core/a.hpp", (1, 0), (2, 0)), entry("core/a.hpp", (1, 7))]}), {"core/a.hpp": (2, 1)})

    def test_a_folder_below_the_floor_is_named(self):
        counts = {"core/a.cpp": (100, 95), "core/b.cpp": (100, 90), "mesh/a.cpp": (10, 8), "solver/a.cpp": (10, 10)}
        shown, low = table(counts, ["core", "mesh", "solver"], 90)
        self.assertEqual(low, ["mesh"])
        self.assertIn("| core | 200 | 185 | 92.5 |", shown)
        self.assertIn("  core/b.cpp: 10 of 100", shown)
        self.assertFalse(any("solver/a.cpp" in line for line in shown))

    def test_a_folder_of_which_nothing_was_measured_is_below_any_floor(self):
        self.assertEqual(table({}, ["core"], 90)[1], ["core"])


if __name__ == "__main__":
    unittest.main()
