#!/usr/bin/python3
"""Tests of schemata.py: which expression is switched, what the compiled whole answers, and who is to blame when it does not compile."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from mutants import code_only, mutants_of
from schemata import HEADER, brackets, culprits, region, schema

SOURCE = """#include <algorithm>
#include <array>
#include <cstdio>
template <class T> struct Twice { T of(T x) const { return 2 * x; } };
constexpr int size = 1 + 2;
constexpr double half(double x) noexcept { return 0.5 * x; }
double bent(double a, double b)
{
  double sum = a * b + half(a);   // a comment, with a comma
  for (int i = 0; i < size; ++i)
    if (a > 1 && b > 1) sum += a; else sum -= b;
  const auto twice = [&](double x) { return Twice<double>{}.of(x) + sum; };
  return a < b ? std::min(twice(a),
                          twice(b) - a)
               : -sum;
}
int main() { std::printf("%.12g", bent(3, 5)); }
"""


def regions(text):
    """What is switched for each change, in order."""
    code = code_only(text)
    pairs = brackets(code)
    return [text[begin:end] for begin, end, _ in (region(code, pairs, m) for m in mutants_of("a.cpp", text))]


class Regions(unittest.TestCase):
    def test_the_smallest_expression(self):
        for text, expected in [("x = a + b;\n", "a + b"), ("f(p, a + b, q);\n", "a + b"), ("return a < b ? c : d;\n", "a < b"),
                               ("y = a ? b - c : d;\n", "b - c"), ("v[i + j] = w;\n", "i + j"), ("if (a) x += b;\n", "x += b"),
                               ("} x -= b;\n", "x -= b"), ("else x *= b;\n", "x *= b"), ("x = std::array<int, 2>{a, b}[c] - d;\n", "std::array<int, 2>{a, b}[c] - d"),
                               ("y = f<A, B>(x) + ns::g(y, z);\n", "f<A, B>(x) + ns::g(y, z)"), ("for (i = 0; i < n; ++i)\n", "i < n"),
                               ("for (const auto& x : p - q)\n", "p - q"), ("y += a - b;\n", "y += a - b")]:
            self.assertEqual(regions(text)[0], expected, text)


class Compiled(unittest.TestCase):
    """Every change of the made-up source, switched at run time, answers as the source so changed does."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "header.hpp").write_text(HEADER)

    def compiled(self, name, text):
        (self.folder / f"{name}.cpp").write_text(text)
        return subprocess.run(["g++", "-std=c++20", "-w", f"{name}.cpp", "-o", name], cwd=self.folder, check=False, capture_output=True, text=True).stderr

    def answer(self, name, number):
        done = subprocess.run([self.folder / name], env={**os.environ, "TALUS_MUTANT": str(number)}, check=False, capture_output=True, text=True, timeout=60)
        return done.stdout

    def test_all_that_can_be_switched(self):
        numbered = dict(enumerate(mutants_of("all.cpp", SOURCE), start=1))
        text, together = schema(SOURCE, numbered, "header.hpp")
        guilty = culprits(self.compiled("all", text), {"all.cpp": numbered}, together, self.folder)
        self.assertEqual({numbered[n].text for n in guilty}, {"constexpr int size = 1 + 2;"})
        left = {n: m for n, m in numbered.items() if n not in guilty}
        self.assertEqual(self.compiled("all", schema(SOURCE, left, "header.hpp")[0]), "")
        self.assertEqual(self.compiled("plain", SOURCE), "")
        self.assertEqual(self.answer("all", 0), self.answer("plain", 0))
        endless = {n for n, m in left.items() if m.change == "< -> >=" and "for" in m.text}
        few = [n for n in left if n not in endless][::3]
        self.assertGreater(len(few), 4)
        for n in few:
            self.assertEqual(self.compiled("one", left[n].apply(SOURCE)), "")
            self.assertEqual(self.answer("all", n), self.answer("one", 0), left[n].key)

    def test_lines_keep_their_numbers(self):
        numbered = dict(enumerate(mutants_of("all.cpp", SOURCE), start=1))
        broken = SOURCE.replace(": -sum;", ": -unknown;")
        text, _ = schema(broken, {1: numbered[3]}, "header.hpp")
        self.assertIn(f"all.cpp:{broken[:broken.index('unknown')].count(chr(10)) + 1}:", self.compiled("all", text))


class Culprits(unittest.TestCase):
    SAID = """In file included from b.cpp:1:
/tree/a.hpp: In instantiation of 'T f(T)':
/tree/a.hpp:1000002:7:   required from here
core.hpp:9:3: error: no match
/tree/a.hpp:1000003:8: warning: unused
/tree/a.hpp: In function 'g':
/tree/a.hpp:2000004:8: error: void value
"""

    def test_named_by_their_lines_or_by_what_they_instantiate(self):
        numbered = {"a.hpp": dict.fromkeys((1, 2, 3, 4, 5), None)}
        together = {4: [4, 5], 5: [4, 5], **{n: [n] for n in (1, 2, 3)}}
        self.assertEqual(culprits(self.SAID, numbered, together, "/tree"), {2, 4, 5})

    def test_else_the_nearest_above(self):
        lines = dict(enumerate(mutants_of("a.hpp", "x = a + b;\n\ny = a + b;\n\n"), start=1))
        numbered = {"a.hpp": lines}
        said = "a.hpp:4:1: error: does not fit\n"
        self.assertEqual({lines[n].line for n in culprits(said, numbered, {n: [n] for n in lines}, "")}, {3})


if __name__ == "__main__":
    unittest.main()
