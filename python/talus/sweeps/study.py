"""The file of a sweep: a scene, what varies, and what is collected from each case."""
from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..calibration.places import Block, Entry, Problems, read_yaml
from .distributions import Distribution, read_distribution, shares_of

MOST_CASES = 10_000
COMBINATIONS = ("grid", "rows", "latin", "sobol", "tornado")
SAMPLED = ("latin", "sobol")
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")


@dataclass(frozen=True)
class Value:
    """A value of a key as --set takes it, with its place in the file."""

    text: str
    entry: Entry = field(compare=False)


@dataclass(frozen=True)
class Exceed:
    """A map of the cases, and the value of which they may have more."""

    map: str
    above: float
    entry: Entry = field(compare=False)


@dataclass(frozen=True)
class Study:
    """What a sweep does.

    keys      that vary, as for --set
    cases     values of the keys, for each case in its order
    collect   names of numbers with their places; empty: the usual ones
    """

    file: Path
    scene: Path
    keys: list[str]
    combine: str
    cases: list[list[Value]]
    collect: list[Value]
    exceed: list[Exceed]
    warnings: list[str]
    problems: Problems = field(compare=False)

    def changes(self, case: int) -> list[str]:
        """key=value for each key of a case, which counts from 0, as for --set."""
        return [f"{key}={value.text}" for key, value in zip(self.keys, self.cases[case])]


def read_study(file: Path) -> Study:
    """Reads the file of a sweep.  Raises SceneError with the place of each error in it."""
    top = read_yaml(file)
    block = Block(top)
    scene = block.file("scene")
    combine = block.word("combine", COMBINATIONS, "grid")
    samples, seed = _read_samples(block, combine)
    collect = _read_collect(block.take("collect"))
    exceed = _read_exceed(block.take("exceed"))
    vary = block.take("vary", required=True)
    links = block.take("correlations")
    spread: dict[str, tuple[Entry, Distribution]] = {}
    lists: dict[str, tuple[Entry, list[Value]]] = {}
    for key, entry in _varied(vary):
        if combine in ("grid", "rows"):
            lists[key] = entry, _read_values(entry)
        elif (distribution := _read_spread(entry, combine)) is not None:
            spread[key] = entry, distribution
    correlations = _read_correlations(links, combine, list(spread), top.problems)
    block.end()
    if not top.problems.messages and lists and vary is not None:
        _check_lists(combine, lists, vary)
    top.problems.raise_any()
    assert scene is not None
    if combine in SAMPLED:
        cases = _sampled(spread, samples, seed, combine, correlations)
    elif combine == "tornado":
        cases = _tornado(spread)
    else:
        cases = _combined(combine, [values for _, values in lists.values()])
    is_odd = combine == "sobol" and samples & (samples - 1) != 0
    warnings = [f"{file}: samples: {samples} is no power of two, for which Sobol samples fill the space evenly"] if is_odd else []
    return Study(file, scene[0], list(spread) or list(lists), combine, cases, collect, exceed, warnings, top.problems)


def in_one_line(node: Any, inside: bool = False) -> str:
    """A value on one line as --set takes it: plain words as they were written, others in quotes."""
    if node.id == "sequence":
        return "[" + ", ".join(in_one_line(item, True) for item in node.value) + "]"
    if node.id == "mapping":
        return "{" + ", ".join(f"{_quoted(str(key.value))}: {in_one_line(value, True)}" for key, value in node.value) + "}"
    needs_quotes = node.style is not None or (inside and re.search(r"[,\[\]{}]", node.value))
    return _quoted(node.value) if needs_quotes else node.value


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + _CONTROL.sub(lambda found: f"\\x{ord(found[0]):02x}", escaped) + '"'


def _read_samples(block: Block, combine: str) -> tuple[int, int]:
    given = {name: block.take(name) for name in ("samples", "seed")}
    if combine not in SAMPLED:
        for entry in given.values():
            if entry is not None:
                entry.wrong("is of combine: latin or sobol")
        return 0, 1
    if given["samples"] is None:
        where = block.take("combine")
        assert where is not None
        where.wrong(f"{combine} needs samples: how many cases there are to be")
    samples = block.whole("samples", 2, low=2)
    if samples > MOST_CASES and given["samples"] is not None:
        given["samples"].wrong(f"these are more than {MOST_CASES} cases")
    return samples, block.whole("seed", 1, low=0)


def _read_collect(entry: Entry | None) -> list[Value]:
    return [Value(str(one.node.value), one) for one in _listed(entry, "names of numbers, such as [toe, max(kinetic)]")
            if _is_text(one)]


def _is_text(entry: Entry) -> bool:
    if entry.node.id == "scalar" and entry.node.value:
        return True
    entry.wrong(f"{entry.shown()} instead of a name")
    return False


def _listed(entry: Entry | None, example: str) -> list[Entry]:
    """The entries of a list; an error if it is none."""
    if entry is None:
        return []
    if not entry.is_list:
        entry.wrong(f"expected a list of {example}")
        return []
    return list(entry.entries())


def _read_exceed(entry: Entry | None) -> list[Exceed]:
    found = []
    for one in _listed(entry, "maps, such as [{map: thickness_max, above: 0.5}]"):
        block = Block(one)
        found.append(Exceed(block.text("map"), block.number("above") or 0.0, one))
        block.end()
    return found


def _varied(vary: Entry | None) -> list[tuple[str, Entry]]:
    if vary is None:
        return []
    if not vary.is_mapping or not vary.node.value:
        vary.wrong("expected a mapping of keys of the scene, such as {mesh.size: [0.1, 0.2]}")
        return []
    for name, _ in vary.node.value:
        if "=" in str(name.value):
            where = Entry(name, f"vary.{name.value}", vary.problems)
            where.wrong(f'"{name.value}" is no path of keys such as time.end or materials[0].cohesion')
    return list(vary.items())


def _read_values(entry: Entry) -> list[Value]:
    if entry.is_mapping and any(name.value in ("low", "mean", "distribution") for name, _ in entry.node.value):
        entry.wrong("a distribution is of combine: latin, sobol or tornado")
    elif not entry.is_list:
        entry.wrong(f"expected a list of values, found {entry.shown()}")
    elif not entry.node.value:
        entry.wrong("the list is empty")
    else:
        return [Value(in_one_line(one.node), one) for one in entry.entries()]
    return []


def _read_spread(entry: Entry, combine: str) -> Distribution | None:
    if entry.is_mapping:
        return read_distribution(entry)
    entry.wrong("expected a distribution, such as {low: 1, high: 2} or {mean: 1.5, deviation: 0.2}: combine is " + combine)
    return None


def _read_correlations(entry: Entry | None, combine: str, keys: list[str], problems: Problems) -> np.ndarray:
    """The matrix of a Gaussian copula, (keys, keys)."""
    matrix = np.eye(len(keys))
    if entry is not None and combine not in SAMPLED:
        entry.wrong("is of combine: latin or sobol")
        return matrix
    before = len(problems.messages)
    for one in _listed(entry, "pairs, such as [{between: [materials[0].cohesion, materials[0].friction_angle], value: -0.5}]"):
        block = Block(one)
        value = block.number("value", low=-1, high=1)
        pair = block.take("between", required=True)
        block.end()
        places = [_place_of(word, keys) for word in _listed(pair, "two keys")]
        if pair is None or value is None or None in places:
            continue
        if len(places) != 2 or places[0] == places[1]:
            pair.wrong("expected two different keys of vary")
        elif matrix[places[0], places[1]] != 0:
            pair.wrong("these two keys stand here twice")
        else:
            matrix[places[0], places[1]] = matrix[places[1], places[0]] = value
    if entry is not None and len(problems.messages) == before and np.linalg.eigvalsh(matrix).min() <= 1e-9:
        entry.wrong("no variables have all of these correlations: the matrix of them is not positive definite")
    return matrix


def _place_of(word: Entry, keys: list[str]) -> int | None:
    if word.node.id == "scalar" and word.node.value in keys:
        return keys.index(word.node.value)
    word.wrong(f"{word.shown()} is no key of vary that has a distribution")
    return None


def _check_lists(combine: str, lists: dict[str, tuple[Entry, list[Value]]], vary: Entry) -> None:
    """Errors of lists of other lengths than the first, of cases that occur twice, and of too many cases."""
    first, (_, values_of_first) = next(iter(lists.items()))
    count = 1
    for key, (entry, values) in lists.items():
        if combine == "rows":
            count = len(values)
            if len(values) != len(values_of_first):
                entry.wrong(f"has {len(values)} values where {first} has {len(values_of_first)}: in rows the first meets the first, the "
                            "second the second")
            continue
        count *= len(values)
        known: set[str] = set()
        for value in values:
            if value.text in known:
                value.entry.wrong(f"{value.text} stands here twice: so would its cases")
            known.add(value.text)
    if count > MOST_CASES:
        vary.wrong(f"these are more than {MOST_CASES} cases")


def _combined(combine: str, columns: list[list[Value]]) -> list[list[Value]]:
    if combine == "rows":
        return [list(row) for row in zip(*columns)]
    cases: list[list[Value]] = [[]]
    for values in columns:
        cases = [[*case, value] for case in cases for value in values]
    return cases


def _text(value: float) -> str:
    return f"{value:.6g}"


def _sampled(spread: dict[str, tuple[Entry, Distribution]], samples: int, seed: int, method: str,
             correlations: np.ndarray) -> list[list[Value]]:
    shares = shares_of(list(spread), samples, seed, method, correlations)
    columns = [[Value(_text(value), entry) for value in distribution.quantile(column)]
               for (entry, distribution), column in zip(spread.values(), shares.T)]
    return _combined("rows", columns)


def _tornado(spread: dict[str, tuple[Entry, Distribution]]) -> list[list[Value]]:
    """All keys in the middle, then the low and the high case of each."""
    middle = [Value(_text(distribution.three[1]), entry) for entry, distribution in spread.values()]
    cases = [middle]
    for k, (entry, distribution) in enumerate(spread.values()):
        for end in (0, 2):
            cases.append([*middle[:k], Value(_text(distribution.three[end]), entry), *middle[k + 1:]])
    return cases
