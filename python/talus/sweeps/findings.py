"""Statistics over the cases of a sweep: influence of keys, probability of exceedance, and maps of it."""
from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..calibration.files import write_whole
from ..errors import FileError, MissingPackage
from ..packages import need
from ..run_states import DONE
from ..tables import csv_text, number_text
from .checks import Plan
from .maps import CaseMap, read_map, write_share
from .study import SAMPLED, Exceed
from .table import SweepTable


def rank_correlation(a: np.ndarray, b: np.ndarray) -> float:
    """Spearman's rank correlation of two columns, (cases,) each; equal values share their mean rank.  nan if one of them does not vary."""
    if len(a) < 2 or np.ptp(a) == 0 or np.ptp(b) == 0:
        return float("nan")
    return float(need("scipy.stats", "finds correlations").spearmanr(a, b)[0])


@dataclass
class Findings:
    """Writes what the combination of values allows, about the cases that are done, and draws it.

    text      for the user, in lines
    warnings  what is missing, and why
    """

    plan: Plan
    table: SweepTable
    pictures: bool
    text: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        combine = self.plan.study.combine
        self._headings = self.table.headings()
        self._done = np.array([state.state == DONE for state in self.table.states], bool)
        if combine in SAMPLED and self._done.sum() > 1:
            self._correlations()
            for k in range(len(self._headings)):
                self._exceedance(k)
        if combine == "tornado":
            for k in range(len(self._headings)):
                self._tornado(k)
        for exceed in self.plan.study.exceed:
            self._exceedance_map(exceed)

    def _write(self, name: str, rows: Sequence[Sequence[str]]) -> Path:
        path = self.plan.folder / name
        write_whole(path, csv_text(rows))
        self.text.append(str(path))
        return path

    def _draw(self, path: Path, function: str, *what: Any) -> None:
        if not self.pictures:
            return
        try:
            from . import figures
            getattr(figures, function)(path.with_suffix(".png"), *what)
            self.text.append(str(path.with_suffix(".png")))
        except (MissingPackage, OSError) as error:  # the tables are there
            self.warnings.append(f"{path.with_suffix('.png')} is not drawn: {error}")
            self.pictures = False

    def _sample(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        """A number in the cases that have it, (cases,), and the keys there, (cases, keys)."""
        numbers = self.table.column(k)
        there = self._done & np.isfinite(numbers)
        values = [[float(value.text) for value in self.plan.study.cases[i]] for i in np.flatnonzero(there)]
        return numbers[there], np.array(values).reshape(-1, len(self.plan.study.keys))

    def _correlations(self) -> None:
        keys = self.plan.study.keys
        width = max(map(len, ["rank correlation with", *self._headings]))
        self.text.append("  ".join(["rank correlation with".ljust(width), *keys, "cases"]))
        rows, matrix = [["number", *keys, "cases"]], []
        for k, heading in enumerate(self._headings):
            numbers, values = self._sample(k)
            found = [rank_correlation(column, numbers) for column in values.T]
            matrix.append(found)
            rows.append([heading, *map(number_text, found), str(len(numbers))])
            told = [("-" if np.isnan(r) else f"{r:+.2f}").rjust(len(key)) for r, key in zip(found, keys)]
            self.text.append("  ".join([heading.ljust(width), *told, f"{len(numbers):>5}"]))
        path = self._write("correlation.csv", rows)
        self._draw(path, "draw_correlations", keys, self._headings, np.array(matrix))

    def _exceedance(self, k: int) -> None:
        """The share of cases in which a number is equal or larger, over the number."""
        values = np.sort(self._sample(k)[0])
        if len(values) < 2:
            return
        shares = (len(values) - np.arange(len(values))) / len(values)
        heading = _with_unit(self._headings[k])
        rows = [[number_text(value), number_text(share)] for value, share in zip(values.tolist(), shares.tolist())]
        path = self._write(f"exceedance_{file_word(self._headings[k])}.csv", [[heading, "share_of_cases [-]"], *rows])
        if values[0] < values[-1]:
            self._draw(path, "draw_exceedance", heading, values, shares)

    def _tornado(self, k: int) -> None:
        """A number in the low and in the high case of each key, by the effect."""
        cases, numbers, heading = self.plan.study.cases, self.table.column(k), self._headings[k]
        bars = [(key, cases[1 + 2 * v][v].text, cases[2 + 2 * v][v].text, float(numbers[1 + 2 * v]), float(numbers[2 + 2 * v]))
                for v, key in enumerate(self.plan.study.keys)]
        bars = sorted((bar for bar in bars if np.isfinite(bar[3:]).all()), key=lambda bar: -abs(bar[4] - bar[3]))
        base = float(numbers[0])
        if not bars or not np.isfinite(base):
            return
        rows = [["key", "low value", "high value", f"at low: {heading}", f"at high: {heading}", f"all in the middle: {heading}"]]
        self.text.append(f"{heading}: {base:.6g} with all in the middle")
        for key, low, high, at_low, at_high in bars:
            rows.append([key, low, high, *map(number_text, (at_low, at_high, base))])
            self.text.append(f"  {key}: {at_low:.6g} at {low}, {at_high:.6g} at {high}")
        path = self._write(f"tornado_{file_word(heading)}.csv", rows)
        self._draw(path, "draw_tornado", _with_unit(heading), base, bars)

    def _maps(self, exceed: Exceed) -> Iterator[tuple[int, CaseMap]]:
        """The maps of the cases that are done; a warning and no more of them where one is missing or lies on another grid."""
        first: tuple[int, CaseMap] | None = None
        for i in np.flatnonzero(self._done).tolist():
            try:
                found = read_map(self.plan.cases[i].folder, exceed.map)
            except FileError as error:
                raise _NoMap(str(error)) from error
            if found is None:
                raise _NoMap(f"case {i + 1} has no maps/{exceed.map}.tif; outputs.runout of the scene makes maps")
            first = first or (i, found)
            if not found.has_grid_of(first[1]):
                raise _NoMap(f"the maps of case {first[0] + 1} and case {i + 1} lie on different grids: give outputs.runout.cell, and all "
                             "cases one mesh")
            yield i, found

    def _exceedance_map(self, exceed: Exceed) -> None:
        count, over, like = 0, np.zeros(0), None
        try:
            for _, found in self._maps(exceed):
                over = np.zeros(found.values.shape) if like is None else over
                like = like or found
                over += found.values > exceed.above  # nan is not
                count += 1
        except _NoMap as error:
            entry = exceed.entry
            self.warnings.append(f"{self.plan.study.file}:{entry.line}:{entry.column}: {entry.key}: {error}")
            return
        if like is None:
            return
        path = self.plan.folder / f"exceedance_{exceed.map}.tif"
        write_share(path, over / count, like)
        what = f"share of {count} cases in which {exceed.map} exceeds {exceed.above:.6g}"
        self.text.append(f"{path}: {what}")
        self._draw(path, "draw_map", what, like, over / count)


class _NoMap(Exception):
    """There is no map of all cases, for the reason that is its text."""


def file_word(heading: str) -> str:
    """The part of a file name for a heading: max_kinetic for "max(kinetic) [J]"."""
    return re.sub(r"[^A-Za-z0-9.-]+", "_", heading.partition(" [")[0]).strip("_")


def _with_unit(heading: str) -> str:
    return heading if " [" in heading else f"{heading} [-]"
