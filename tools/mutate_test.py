#!/usr/bin/python3
"""Tests of mutate.py on a made-up source: what is changed, what is left alone, what is a survivor, and that the sources are as before."""
import pathlib
import subprocess
import tempfile
import unittest

from mutate import GROUPS, ROOT, Mutant, code_only, judge, missed, mutants_of, mutants_of_group, read_notes, sample, table

SOURCE = """#include <array>  // a - b
// excess = tau + q * p
double excess(double tau, double q, double p) { return tau + q * p; }
bool yields(double f) { return f > 0 && !(f == 1); }
const char* words = "a + b";
std::array<int, 2> pair;
template <class T> T opposite(T&& t) { return -t; }
double half(double x) { return 0.5 * x; }
double small = 1e-12;
int area(int a, int b) { return 2 * a + b; }
void f(int n) { assert(n < 3); }
"""


def changes(text):
    return {(m.old, m.new) for m in mutants_of("a.cpp", text)}


class Changes(unittest.TestCase):
    def test_operators_of_two_operands(self):
        for old, new in [("+", "-"), ("*", "/"), ("<", ">="), ("==", "!="), ("&&", "||"), ("-=", "+=")]:
            self.assertIn((old, new), changes(f"x = a {old} b;\n"))

    def test_signs_negations_bounds_and_truths(self):
        self.assertEqual(changes("f(-x);\n"), {("-", "")})
        self.assertIn(("-", ""), changes("Real y = -x;\n"))
        self.assertEqual(changes("if (!x) y = true;\n"), {("!", ""), ("true", "false")})
        self.assertEqual(changes("y = std::max(a, b);\n"), {("max", "min")})

    def test_an_operator_that_begins_a_line(self):
        self.assertEqual(changes("y = a\n    + b;\n"), {("+", "-")})

    def test_numbers_and_values_become_a_per_cent_larger(self):
        self.assertEqual(changes("f(0.5);\n"), {("0.5", "0.505")})
        self.assertIn(("a / b", "1.01 * (a / b)"), changes("const Real y = a / b;\n"))
        self.assertIn(("a / b", "1.01 * (a / b)"), changes("{ return a / b; }\n"))
        self.assertIn(("2", "3"), changes("y = 2 * a;\n"))

    def test_a_verdict_is_no_value(self):
        self.assertEqual(changes("{ return a < b; }\n"), {("<", ">=")})
        self.assertEqual(changes("{ return is_there(a); }\n"), set())

    def test_tolerances_arrows_templates_and_references_stay(self):
        for text in ["f(1e-12);\n", "p->f(T{});\n", "std::array<std::array<int, 2>, 3> a;\n", "g(T&& t, int* p);\n", "++i;\n", "--i;\n"]:
            self.assertEqual(changes(text), set(), text)

    def test_comments_texts_directives_and_asserts_stay(self):
        code = code_only(SOURCE)
        self.assertEqual(len(code), len(SOURCE))
        for gone in ["a - b", "excess = tau", '"a + b"', "include"]:
            self.assertNotIn(gone, code)
        lines = {m.line for m in mutants_of("a.cpp", SOURCE)}
        self.assertEqual(lines, {3, 4, 7, 8, 10})

    def test_a_change_touches_nothing_but_its_place(self):
        for m in mutants_of("a.cpp", SOURCE):
            self.assertEqual(SOURCE[m.begin:m.end], m.old)
            changed = m.apply(SOURCE)
            self.assertEqual(changed[:m.begin] + m.old + changed[m.begin + len(m.new):], SOURCE)

    def test_keys_differ_and_outlive_lines_put_before(self):
        first = [m.key for m in mutants_of("a.cpp", "x = a + b + c;\nx = a + b + c;\n")]
        self.assertEqual(len(first), 4)
        self.assertEqual(len(set(first)), 4)
        self.assertEqual([m.key for m in mutants_of("a.cpp", "\n\nx = a + b + c;\nx = a + b + c;\n")], first)

    def test_every_group_has_sources_and_known_survivors_are_among_their_changes(self):
        for name, group in GROUPS.items():
            self.assertTrue(mutants_of_group(ROOT, group), name)
        softening = [m for m in mutants_of("d.cpp", (ROOT / "materials" / "drucker_prager.cpp").read_text()) if m.text.startswith("T left = ")]
        self.assertTrue(any(m.new.startswith("1.01 * (") for m in softening))


class Samples(unittest.TestCase):
    def test_a_larger_sample_begins_with_the_smaller_and_a_seed_repeats_it(self):
        everything = list(range(100))
        self.assertEqual(sample("laws", everything, 10, 1), sample("laws", everything, 20, 1)[:10])
        self.assertNotEqual(sample("laws", everything, 10, 1), sample("laws", everything, 10, 2))
        self.assertEqual(len(set(sample("laws", everything, 100, 1))), 100)


class Verdicts(unittest.TestCase):
    """Compiles the made-up source and asks it for a number, as the tests of a folder would."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)
        (self.tree / "a.cpp").write_text("extern \"C\" int area(int a, int b, int unseen) {\n  return a * b + 0 * unseen;\n}\n")
        (self.tree / "test.cpp").write_text("extern \"C\" int area(int, int, int);\nint main() { return area(3, 5, 7) == 15 ? 0 : 1; }\n")

    def build(self, target):
        return subprocess.run(["g++", "-w", "-o", self.tree / target, self.tree / "a.cpp", self.tree / "test.cpp"], stderr=subprocess.DEVNULL,
                              check=False).returncode == 0

    def tried(self, target, _):
        return subprocess.run([self.tree / target], check=False).returncode == 0

    def judged(self, old, new):
        source = (self.tree / "a.cpp").read_text()
        begin = source.index(old, source.index("return"))
        verdict = judge(Mutant("a.cpp", begin, begin + len(old), old, new, 2, ""), self.tree, [("first", ""), ("second", "")], self.build, self.tried)
        self.assertEqual((self.tree / "a.cpp").read_text(), source)
        return verdict

    def test_caught_survived_and_no_program(self):
        self.assertEqual(self.judged("*", "/"), ("caught", "first"))
        self.assertEqual(self.judged("+", "-"), ("survived", ""))
        self.assertEqual(self.judged("*", ")"), ("does not compile", "first"))

    def test_the_source_comes_back_when_a_test_throws(self):
        source = (self.tree / "a.cpp").read_text()
        at = source.index("*")
        with self.assertRaises(KeyboardInterrupt):
            judge(Mutant("a.cpp", at, at + 1, "*", "/", 2, ""), self.tree, [("first", "")], self.build, self.interrupted)
        self.assertEqual((self.tree / "a.cpp").read_text(), source)

    @staticmethod
    def interrupted(*_):
        raise KeyboardInterrupt


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
