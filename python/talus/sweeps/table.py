"""sweep.csv: a row for each case with its values, its state, and results of the cases that are done."""
from __future__ import annotations

import fcntl
import math
import os
from collections.abc import Iterator

import numpy as np

from ..calibration.files import write_whole
from ..collected import collected, hint_for, history_in
from ..run_states import DONE, NOT_ENDED, STOPPED, Number, RunState, state_of
from ..tables import csv_text, number_text
from .checks import Plan

USUAL = ("kinetic", "plastic", "friction", "energy.closure", "mass.removed", "fastest", "steps", "simulated_time", "cost.wall")


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
                yield f'{at}: no case has a number "{name.text}"{hint_for(name.text, self._known)}'

    def _words(self, i: int) -> list[str]:
        return [str(i + 1), *(value.text for value in self._plan.study.cases[i]), self.states[i].state]

    def _csv(self) -> str:
        rows = [[*self._words(i), *(number_text(number and number.value) for number in self._numbers[i])] for i in range(len(self.states))]
        return csv_text([["case", *self._plan.study.keys, "status", *self.headings()], *rows])

    def _collect(self, i: int) -> None:
        numbers = self.states[i].numbers
        history = history_in(self._plan.cases[i].folder)
        self._numbers[i] = [collected(numbers, history, name) for name in self.names]
        if not all(self._numbers[i]):
            self._known = [*numbers, *(history or [])]
