"""sweep.csv: a row for each case with its values, its state, and results of the cases that are done."""
from __future__ import annotations

import csv
import fcntl
import io
import math
import os
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..calibration.files import write_whole
from ..calibration.places import meant
from ..errors import FileError
from ..run_states import DONE, NOT_ENDED, STOPPED, Number, RunState, state_of
from ..tables import PURE, Table
from .checks import Plan

USUAL = ("kinetic", "plastic", "friction", "energy.closure", "mass.removed", "fastest", "steps", "simulated_time", "cost.wall")
_OF_COLUMN = re.compile(r"(last|max|min)\((.*)\)")
_FORMULA = re.compile(r"'*[=+\-@]")


class SweepTable:
    """The cases of a plan with their states and numbers."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.names = [name.text for name in plan.study.collect] or [*plan.fronts, *USUAL]
        self.states = [RunState() for _ in plan.cases]
        self._numbers: list[list[Number | None]] = [[None] * len(self.names) for _ in plan.cases]
        self._known: list[str] = []  # names in a case where one of `names` is missing

    def update(self) -> None:
        """Reads all cases that were not done at the last call, and rewrites sweep.csv; other processes may do so at the same time."""
        folder = self._plan.folder
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX)
            except OSError:
                pass  # no locks here
            for i, case in enumerate(self._plan.cases):
                if self.states[i].state != DONE:
                    self.states[i] = state_of(case)
                    if self.states[i].state == DONE:
                        self._collect(i)
            write_whole(folder / "sweep.csv", self._csv())
        finally:
            os.close(handle)

    def headings(self) -> list[str]:
        """The headings of the numbers, such as "toe [m]"."""
        units = [next((row[k].unit for row in self._numbers if row[k]), "") for k in range(len(self.names))]  # type: ignore[union-attr]
        return [f"{name} [{unit}]" if unit else name for name, unit in zip(self.names, units)]

    def column(self, k: int) -> np.ndarray:
        """A number of all cases, (cases,); nan where it is not known, or not finite."""
        values = [row[k].value if row[k] else math.nan for row in self._numbers]  # type: ignore[union-attr]
        return np.where(np.isfinite(values), values, np.nan)

    def print(self) -> str:
        """The table as text."""
        lines = [["case", *self._plan.study.keys, "status", *self.headings()]]
        for i, state in enumerate(self.states):
            words = self._words(i)
            if state.state in (STOPPED, NOT_ENDED):
                words[-1] += ", no checkpoint" if state.goes_on_from is None else f" at t = {state.goes_on_from:.6g} s"
            lines.append([*words, *("-" if number is None else f"{number.value:.6g}" for number in self._numbers[i])])
        widths = [max(map(len, column)) for column in zip(*lines)]
        return "".join("  ".join(word.rjust(width) for word, width in zip(line, widths)) + "\n" for line in lines)

    def unknown_names(self) -> Iterator[str]:
        """The names in `collect` that no case has, with what was probably meant."""
        for k, name in enumerate(self._plan.study.collect):
            if self._known and not any(row[k] for row in self._numbers):
                at = f"{self._plan.study.file}:{name.entry.line}:{name.entry.column}: {name.entry.key}"
                names = "the keys of summary.json, joined by points, and the columns of history.csv"
                hint = meant(_asked(name.text)[1], self._known, names)
                yield f'{at}: no case has a number "{name.text}"{hint}'

    def _words(self, i: int) -> list[str]:
        return [str(i + 1), *(value.text for value in self._plan.study.cases[i]), self.states[i].state]

    def _csv(self) -> str:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        for row in ([["case", *self._plan.study.keys, "status", *self.headings()]]
                    + [[*self._words(i), *map(_written, self._numbers[i])] for i in range(len(self.states))]):
            writer.writerow(map(cell, row))
        return text.getvalue()

    def _collect(self, i: int) -> None:
        numbers = self.states[i].numbers
        history = _history(self._plan.cases[i].folder)
        self._numbers[i] = [_of_summary(numbers, name) or _of_history(history, name) for name in self.names]
        if not all(self._numbers[i]):
            self._known = [*numbers, *(history or [])]


def cell(text: str) -> str:
    """A text that spreadsheets do not run as a formula: as io/output/csv.cpp, which has an apostrophe before it."""
    text = text.replace("\n", " ")
    try:
        float(text)
    except ValueError:
        return f"'{text}" if _FORMULA.match(text) else text
    return text


def number_text(value: float) -> str:
    """The shortest text of a number that gives it back; a whole one without a point, as the program writes it."""
    return repr(value).removesuffix(".0")


def _written(number: Number | None) -> str:
    return "" if number is None or math.isnan(number.value) else number_text(number.value)


def _history(folder: Path) -> Table | None:
    path = folder / "history.csv"
    try:
        return Table(path) if path.exists() else None
    except (FileError, OSError):
        return None


def _of_summary(numbers: dict[str, Number], name: str) -> Number | None:
    """The number of that name, or the only one whose name ends with it."""
    if name in numbers:
        return numbers[name]
    ends = [known for known in numbers if known.endswith(f".{name}")]
    return numbers[ends[0]] if len(ends) == 1 else None


def _asked(name: str) -> tuple[str, str]:
    """The statistic of a column and its name: "max(toe)" is that of the largest value, "toe" the last one."""
    found = _OF_COLUMN.fullmatch(name)
    return (found[1], found[2]) if found else ("last", name)


def _of_history(history: Table | None, name: str) -> Number | None:
    """The last value of a column that is not nan, or its largest or smallest; nan if all are."""
    which, column = _asked(name)
    if history is None or column not in history:
        return None
    values = history[column]
    values = values[~np.isnan(values)] if values.dtype.kind == "f" else np.empty(0)
    unit = history.units[column]
    value = {"last": lambda: values[-1], "max": values.max, "min": values.min}[which]() if len(values) else math.nan
    return Number(float(value), "" if unit == PURE else unit)
