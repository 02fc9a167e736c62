#!/usr/bin/python3
"""Tests of mutate.py: what a survivor is, and what the table says."""
import collections
import pathlib
import tempfile
import unittest

from mutants import mutants_of_group
from mutate import ALL, GROUPS, ROOT, judge, missed, read_notes, table


class Groups(unittest.TestCase):
    def test_every_group_has_sources(self):
        for name, group in GROUPS.items():
            self.assertTrue(mutants_of_group(ROOT, group.sources), name)


class MadeUpTree:
    """Change 1 fails test Sum.Holds of the second program, change 2 nothing."""

    def __init__(self):
        self.asked = []
        self.quick = {("first", ALL): ["Quick.Holds", "Other.Holds"], ("second", ALL): []}

    @staticmethod
    def limit(*_):
        return 1

    def run(self, number, target, chosen, _):
        self.asked.append((target, chosen))
        return number != 1 or target != "second", "Sum.Holds", ""


class Verdicts(unittest.TestCase):
    TESTS = (("first", ALL), ("second", ALL))

    def test_caught_by_the_second_and_first_tried_with_what_caught_before(self):
        tree, first = MadeUpTree(), collections.defaultdict(list)
        self.assertEqual(judge(1, self.TESTS, tree, first), ("caught", "second Sum.Holds"))
        self.assertEqual(dict(first), {"first": [], "second": ["Sum.Holds"]})
        tree.asked.clear()
        self.assertEqual(judge(1, self.TESTS, tree, first), ("caught", "second Sum.Holds"))
        self.assertEqual(tree.asked, [("first", "Quick.Holds:Other.Holds"), ("first", ALL), ("second", "Sum.Holds")])

    def test_survived_after_all_tests(self):
        tree = MadeUpTree()
        self.assertEqual(judge(2, self.TESTS, tree, collections.defaultdict(list)), ("survived", ""))
        self.assertEqual(tree.asked, [("first", "Quick.Holds:Other.Holds"), ("first", ALL), ("second", ALL)])


class Report(unittest.TestCase):
    @staticmethod
    def row(group, text, verdict):
        return {"group": group, "key": f"a.cpp: {text} : + -> -", "verdict": verdict, "by": "", "path": "a.cpp", "line": 1, "old": "+", "new": "-",
                "text": text}

    def test_equal_changes_do_not_count_and_survivors_ask_for_tests(self):
        rows = [self.row("laws", f"x{i}", "caught") for i in range(9)]
        rows += [self.row("laws", "y", "survived"), self.row("laws", "z", "survived"), self.row("laws", "w", "does not compile")]
        results = {r["key"]: r for r in rows}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "notes"
            file.write_text("# notes\na.cpp: y : + -> - := equal: y is 0\na.cpp: z : + -> - := the sum of two\n")
            notes = read_notes(file)
        text = table(results, notes)
        self.assertIn("| laws | 11 | 9 | 1 | 1 | 90 % | 1 |", text)
        self.assertIn("the sum of two", text)
        self.assertNotIn("`y`", text)
        self.assertEqual(missed(results, notes), [])
        self.assertEqual(missed(results, {}), ["laws"])


if __name__ == "__main__":
    unittest.main()
