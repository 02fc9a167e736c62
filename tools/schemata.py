"""Puts many changes into one source, each behind a switch that the environment sets when a program starts: TALUS_MUTANT=17.

A change is put where the smallest expression ends that it is part of:

    const Real q = a * b + c;   ->   const Real q = (is(17) ? value(a * b - c) : value(a * b + c));

What has to be known to the compiler (the size of an array, a constexpr) cannot be switched and does not compile; the numbers of lines say
whose fault that is, and it is left out.
"""
import collections
import re

from mutants import code_only

CHANGED = 1_000_000   # line of the text of change 17: 1000017
ORIGINAL = 2_000_000  # line of what stood there: 2000017 for the region whose first change is 17

HEADER = """// Made by tools/mutate.py.
#pragma once
#include <cstdlib>
#include <type_traits>
#include <utility>

namespace talus_mutants {

inline const int chosen = [] {
  const char* const text = std::getenv("TALUS_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

// No constant expression, but allowed in functions that could be in one.
constexpr bool is(int n) noexcept { return n < 0 ? false : chosen == n; }

// What an expression is worth: matrices that Eigen has yet to work out become ones of one type.
template <class T>
constexpr auto value(T&& t)
{
  if constexpr (requires { typename std::decay_t<T>::PlainObject; })
    return typename std::decay_t<T>::PlainObject(std::forward<T>(t));
  else
    return std::decay_t<T>(std::forward<T>(t));
}

}  // namespace talus_mutants
"""

ASSIGNMENTS = ("+=", "-=", "*=", "/=")
CONTROL = re.compile(r"\b(?:if(?:\s+constexpr)?|for|while|switch)\s*$")
BEFORE_A_BLOCK = re.compile(r"(?:[;{})\]]|\b(?:else|do|const|noexcept|mutable|override|try))\s*$")
STATEMENT_WORDS = {"return", "else", "do", "case", "throw", "co_return"}
CLOSERS = {")": "(", "]": "[", "}": "{"}


def brackets(code):
    """{position: position of the other} of every bracket; < and > are some where the formatter puts no blank before them."""
    pairs, stack = {}, []
    for i, c in enumerate(code):
        before = code[i - 1] if i else ""
        if c in "([{" or (c == "<" and (re.match(r"[\w\]]", before) or code.endswith("template ", 0, i)) and code[i + 1:i + 2] not in (" ", "=", "<")):
            stack.append(i)
        elif c in ")]}":
            while stack and code[stack[-1]] != CLOSERS[c]:
                stack.pop()
            if stack:
                pairs[stack.pop()] = i
        elif c == ">" and before not in ("-", " ", "=") and stack and code[stack[-1]] == "<":
            pairs[stack.pop()] = i
    return pairs | {end: begin for begin, end in pairs.items()}


def is_assignment(code, i):
    """Whether the = at i, alone or after another operator, gives something a value."""
    return code[i - 1] not in "=!<>" and code[i + 1] != "="


def is_scope(code, i):
    return ":" in (code[i - 1], code[i + 1])


def left_end(code, pairs, i):
    """Where the expression begins that has position i in it."""
    while i > 0:
        c = code[i - 1]
        if c in ")]}>" and i - 1 in pairs:
            begin = pairs[i - 1]
            if (c == ")" and CONTROL.search(code, max(0, begin - 20), begin)) or (c == "}" and BEFORE_A_BLOCK.search(code, max(0, begin - 20), begin)):
                break
            i = begin
        elif c in "([{;,?}" or (c == "<" and i - 1 in pairs) or (c == ":" and not is_scope(code, i - 1)) or (c == "=" and is_assignment(code, i - 1)):
            break
        elif c.isalnum() or c == "_":
            word = re.search(r"\w+\Z", code[max(0, i - 60):i]).group()
            if word in STATEMENT_WORDS:
                break
            i -= len(word)
        else:
            i -= 1
    return i + len(code[i:]) - len(code[i:].lstrip())


def right_end(code, pairs, i):
    """The position where the expression ends."""
    while i < len(code):
        c = code[i]
        if c in "([{<" and i in pairs:
            i = pairs[i] + 1
        elif c in ")]};,?" or (c == ">" and i in pairs) or (c == ":" and not is_scope(code, i)) or (c == "=" and is_assignment(code, i)):
            break
        else:
            i += 1
    return len(code[:i].rstrip())


def region(code, pairs, mutant):
    """(begin, end, kind) of the smallest expression around a change; kind "void": a statement without a value."""
    begin, end = left_end(code, pairs, mutant.begin), right_end(code, pairs, mutant.end)
    return min(begin, mutant.begin), max(end, mutant.end), "void" if mutant.old in ASSIGNMENTS else "value"


def one_line(text):
    """The text on one line, without comments."""
    return " ".join(re.sub(r"//[^\n]*", "", text).split("\n"))


def schema(source, numbered, header):
    """(the source with all its changes {number: Mutant}, {number: numbers of all changes of the same expression})."""
    code = code_only(source)
    pairs = brackets(code)
    regions = []   # (begin, end, kind, numbers): none overlaps another
    for begin, end, kind, number in sorted(((*region(code, pairs, m), n) for n, m in numbered.items()), key=lambda r: (r[0], -r[1], r[3])):
        if regions and begin < regions[-1][1]:
            first, last, outer, numbers = regions[-1]
            regions[-1] = (first, max(last, end), outer, [*numbers, number])
        else:
            regions.append((begin, end, kind, [number]))
    text, at = [f'#include "{header}"\n#line 1\n'], 0
    for begin, end, kind, numbers in regions:
        wrap = "static_cast<void>({})" if kind == "void" else "::talus_mutants::value({})"
        text.append(source[at:begin] + "(")
        for number in numbers:
            m = numbered[number]
            changed = one_line(source[begin:m.begin] + m.new + source[m.end:end])
            text.append(f"\n#line {CHANGED + number}\n::talus_mutants::is({number}) ? {wrap.format(changed)} :")
        line = source.count("\n", 0, end) + 1
        text.append(f"\n#line {ORIGINAL + min(numbers)}\n{wrap.format(one_line(source[begin:end]))}\n#line {line}\n)")
        at = end
    return "".join(text) + source[at:], {n: numbers for *_, numbers in regions for n in numbers}


PLACE = re.compile(r"^(?P<path>[^\s:]+):(?P<line>\d+):\d+:\s*(?P<kind>(?:fatal )?error|note|  required|required)", re.MULTILINE)
ANY_PLACE = re.compile(r"(?P<path>[\w./+-]+\.[ch]pp):(?P<line>\d+)")


def culprits(said, numbered, together, root):
    """Numbers of the changes that the compiler complains of.  numbered: {path: {number: Mutant}}; together: {number: numbers of the same
    expression}; root: what paths begin with.
    An error elsewhere is that of the change on whose behalf something was instantiated, else of the nearest one above it in the file."""
    guilty = set()
    for block in blocks_of(said):
        places = [(m["path"].removeprefix(f"{root}/"), int(m["line"])) for m in ANY_PLACE.finditer(block)]
        first = next((m for m in PLACE.finditer(block) if "error" in m["kind"]), None)
        at = [(first["path"].removeprefix(f"{root}/"), int(first["line"]))] if first else []
        for path, line in at + places:
            numbers = numbers_of_line(line, numbered.get(path, {}), together)
            if numbers:
                guilty |= {n for number in numbers for n in together[number]} if "constant expression" in block else numbers
                break
        else:
            guilty |= nearest(at + places, numbered)
    return guilty


def blocks_of(said):
    """What a compiler says, an error each: from what leads to it to what it notes.  No warnings."""
    block, has_error, warns = [], False, False
    for line in said.splitlines():
        leads = re.match(r"^(?:In file included|[^\s:]+: In )", line)
        error, warning = re.search(r": (?:fatal )?error: ", line), ": warning: " in line
        if leads or error or warning:
            if has_error:
                yield "\n".join(block)
            if has_error or warns or warning or (leads and "In file included" in line):
                block, has_error = [], False
            warns = warning
        if not warns:
            block.append(line)
            has_error = has_error or bool(error)
    if has_error:
        yield "\n".join(block)


def numbers_of_line(line, of_file, together):
    if line >= ORIGINAL:
        return set(together.get(line - ORIGINAL, ())) & of_file.keys()
    return {line - CHANGED} & of_file.keys() if line >= CHANGED else set()


def nearest(places, numbered):
    found = collections.Counter()
    for path, line in places:
        for number, m in numbered.get(path, {}).items():
            if m.line <= line < CHANGED:
                found[number] = max(found[number], m.line - line - 1_000_000 * (path != places[0][0]) + 2_000_000)
    return {found.most_common(1)[0][0]} if found else set()
