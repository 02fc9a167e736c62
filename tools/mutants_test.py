#!/usr/bin/python3
"""Tests of mutants.py on a made-up source: what is changed and what is left alone."""
import pathlib
import unittest

from mutants import code_only, mutants_of, sample

ROOT = pathlib.Path(__file__).resolve().parent.parent
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

    def test_known_survivors_are_among_the_changes(self):
        softening = [m for m in mutants_of("d.cpp", (ROOT / "materials" / "drucker_prager.cpp").read_text()) if m.text.startswith("T left = ")]
        self.assertTrue(any(m.new.startswith("1.01 * (") for m in softening))


class Samples(unittest.TestCase):
    def test_a_larger_sample_begins_with_the_smaller_and_a_seed_repeats_it(self):
        everything = list(range(100))
        self.assertEqual(sample("laws", everything, 10, 1), sample("laws", everything, 20, 1)[:10])
        self.assertNotEqual(sample("laws", everything, 10, 1), sample("laws", everything, 10, 2))
        self.assertEqual(len(set(sample("laws", everything, 100, 1))), 100)


if __name__ == "__main__":
    unittest.main()
