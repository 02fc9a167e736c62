"""The numbers of a convergence study: chosen from the results of its levels, judged, and written as tables."""
from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..collected import asked, collected, hint_for, history_in, known_values, unit_of
from ..errors import RunFailed, SceneError
from ..run_states import Number, RunState, state_of
from ..tables import Table, csv_text, number_text
from .levels import Level, Plan
from .richardson import (CONSTANT, FORMAL_ORDER, HIGHEST_ORDER, LOWEST_ORDER, MEANING, SAFETY_FACTOR, STAYS, Extrapolation, extrapolate)

_RELATIVE_ROUNDING = 1e-9
# Columns of a history that describe steps and solvers, and not the bodies.
_NO_RESULTS = ("time", "step", "dt", "stage", "residual", "newton_iterations", "linear_iterations", "solve_residual", "increment_cuts",
               "pressure_iterations", "pressure_residual")
# Numbers of a summary that are results; a point at the end: all below that key.  Those of the energy are columns of the history as well.
_RESULTS_OF_SUMMARY = ("simulated_time", "watch.fastest", "balances.mass.removed", "runout.")
_ENERGY_TERMS = "balances.energy.terms."
_SHOWN_LEVELS, _MOST_NAMES, _WIDTH_OF_NAME = 3, 6, 19


@dataclass(frozen=True)
class LevelNumber:
    """A number with its values in the order of the levels, nan where there is none."""

    name: str
    unit: str
    values: list[float]
    judged: Extrapolation

    @property
    def relative(self) -> float | None:
        """The uncertainty over the finest value; None if there is no uncertainty or the value is zero."""
        if self.judged.uncertainty is None or self.values[-1] == 0:
            return None
        return self.judged.uncertainty / abs(self.values[-1])

    @property
    def last_change(self) -> float | None:
        """The change between the two finest levels over the finest value; None if that is zero."""
        coarse, fine = self.values[-2:]
        if self.judged.trend == STAYS and self.judged.verdict == CONSTANT:
            return 0.0
        return (fine - coarse) / abs(fine) if fine != 0 else None


def numbers_of(plan: Plan, states: Sequence[RunState]) -> list[LevelNumber]:
    """The numbers that are asked for, or all physical ones: the last value of each column of the history of the finest level, its largest
    or smallest value if that is not near its first or its last one, and the physical results in its summary.  All levels have to be done.
    Changes below 1e-9 of the largest value with the same unit in that history count as rounding.  Raises SceneError with all names that
    no level has."""
    results = [(state.numbers, history_in(level.folder)) for level, state in zip(plan.levels, states)]
    summary, history = results[-1]
    sizes, scales = [level.size for level in plan.levels], _scales_of(history)
    numbers, unknown = [], []
    for name in plan.options.collect or _usual_names(summary, history):
        found = [collected(*of_level, name) for of_level in results]
        if not any(found):
            unknown.append(f'--collect: no level has a number "{name}"{hint_for(name, [*summary, *(history or [])])}')
            continue
        unit = [number.unit for number in found if number is not None][-1]
        values = [math.nan if number is None else number.value for number in found]
        scale = max([scales.get(unit, 0.0), *(abs(value) for value in values if math.isfinite(value))])
        judged = extrapolate(sizes, values, _RELATIVE_ROUNDING * scale)
        if all(abs(value) <= _RELATIVE_ROUNDING * scale for value in values):
            judged = Extrapolation(CONSTANT, STAYS, None, 0.0, 0.0)
        numbers.append(LevelNumber(asked(name)[1] if name.startswith("last(") else name, unit, values, judged))
    if unknown:
        raise SceneError("\n".join(unknown), 2)
    return numbers


def complaints(numbers: Sequence[LevelNumber]) -> list[str]:
    """Sentences on the numbers that do not converge, one for each verdict."""
    wrong = [number for number in numbers if not number.judged.is_told]
    lines = [f"{len(wrong)} of {len(numbers)} numbers do NOT CONVERGE at these sizes: nothing is extrapolated, and their uncertainty is "
             "unknown"]
    for verdict, meaning in MEANING.items():
        names = [number.name for number in wrong if number.judged.verdict == verdict]
        more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
        lines += [f"{verdict}: {meaning}: {', '.join(names[:_MOST_NAMES])}{more}"] if names else []
    return lines if wrong else []


def require_within(limit: float | None, numbers: Sequence[LevelNumber]) -> None:
    """Raises RunFailed with the numbers whose uncertainty is larger than this share of their value, or unknown."""
    if limit is None:
        return
    beyond = []
    for number in numbers:
        relative = number.relative
        if number.judged.uncertainty != 0 and not (relative is not None and relative <= limit):
            beyond.append(f"{number.name}: {100 * relative:.3g} %" if relative is not None else f"{number.name}: {number.judged.verdict}")
    if beyond:
        raise RunFailed(f"not within {100 * limit:.6g} %: {'; '.join(beyond)}", 1)


def print_levels(plan: Plan) -> str:
    """The levels as text: folder, size, cells, particles, state, changes."""
    lines = [f"{'level':<12} {'mean size [m]':>13} {'cells':>10} {'particles':>10}  {'state':<10} changes"]
    for level in plan.levels:
        changes = level.of_mesh[0] + (", ..." if len(level.of_mesh) > 1 else "") if level.of_mesh else "none: the scene as it is"
        lines.append(f"{level.folder.name:<12} {level.size:>13.4g} {level.cells:>10} {level.particles:>10}  {state_of(level).state:<10} "
                     f"{changes}")
    return "\n".join(lines)


def print_numbers(plan: Plan, numbers: Sequence[LevelNumber]) -> str:
    """The numbers as text of 100 columns, with the three finest levels; numbers that are zero at all levels are only counted."""
    sizes = [f"{level.size:.3g} m" for level in plan.levels[-_SHOWN_LEVELS:]]
    lines = [_line("cells of", sizes, "trend", "change", "order", "extrapol.", "+-", "verdict")]
    zeros = 0
    for number in numbers:
        judged = number.judged
        if judged.extrapolated == 0 and judged.uncertainty == 0:
            zeros += 1
            continue
        order = f"{judged.order:.1f}" if judged.order is not None else "-"
        lines.append(_line(_heading(number), map(_short, number.values[-_SHOWN_LEVELS:]), judged.trend,
                           _in_percent(number.last_change, signed=True), order, _short(judged.extrapolated), _in_percent(number.relative),
                           judged.verdict))
    if zeros:
        lines.append(f"zero at all sizes: {zeros} number{'' if zeros == 1 else 's'}")
    return "\n".join(lines)


def convergence_csv(plan: Plan, numbers: Sequence[LevelNumber]) -> str:
    """The text of convergence.csv."""
    count = range(1, len(plan.levels) + 1)
    rows = [["quantity", "unit", *(f"cell_size_{k} [m]" for k in count), *(f"value_{k}" for k in count), "trend", "order", "extrapolated",
             "uncertainty", "verdict"]]
    for number in numbers:
        judged = number.judged
        rows.append([number.name, number.unit, *(number_text(level.size) for level in plan.levels), *map(_finite_text, number.values),
                     judged.trend, *map(_finite_text, (judged.order, judged.extrapolated, judged.uncertainty)), judged.verdict])
    return csv_text(rows)


def convergence_json(plan: Plan, numbers: Sequence[LevelNumber], warnings: Sequence[str]) -> str:
    """The text of convergence.json."""
    criteria = {"safety_factor": SAFETY_FACTOR, "lowest_order": LOWEST_ORDER, "highest_order": HIGHEST_ORDER, "formal_order": FORMAL_ORDER}
    contents = {"scene": str(plan.scene), "commit": plan.commit, "ratio": plan.options.ratio, "criteria": criteria,
                "levels": [_of_level(level) for level in plan.levels], "numbers": [_of_number(number) for number in numbers],
                "warnings": list(warnings)}
    return json.dumps(contents, indent=2, ensure_ascii=False) + "\n"


def _of_level(level: Level) -> dict[str, Any]:
    return {"factor": level.factor, "cell_size [m]": level.size, "cells": level.cells, "particles": level.particles,
            "state": state_of(level).state, "set": list(level.changes), "folder": level.folder.name, "scene_digest": level.scene_digest,
            "command": level.command}


def _of_number(number: LevelNumber) -> dict[str, Any]:
    judged = number.judged
    return {"quantity": number.name, "unit": number.unit, "values": list(map(_finite, number.values)), "trend": judged.trend,
            "order": _finite(judged.order), "extrapolated": judged.extrapolated, "uncertainty": judged.uncertainty,
            "verdict": judged.verdict}


def _usual_names(summary: dict[str, Number], history: Table | None) -> list[str]:
    """The names of all physical results.  Columns are asked by `last(...)`, as the summary may have the same name."""
    names, columns = [], list(history or [])
    for column in columns:
        if history is not None and column not in _NO_RESULTS:
            extreme = _extreme_of(column, known_values(history, column))
            names += [f"last({column})", *([extreme] if extreme else [])]
    for name, number in summary.items():
        is_result = any(name.startswith(known) if known.endswith(".") else name == known for known in _RESULTS_OF_SUMMARY)
        is_term = name.startswith(_ENERGY_TERMS) and number.unit == "J" and not name.endswith("_start")
        if is_result or (is_term and name.removeprefix(_ENERGY_TERMS) not in columns):
            names.append(name)
    return names


def _extreme_of(name: str, values: np.ndarray) -> str:
    """"max(name)" or "min(name)" if the value that is farthest from zero differs from the first and from the last one by more than a
    hundredth of the range; else nothing."""
    if not len(values):
        return ""
    low, high = values.min(), values.max()
    is_max = abs(high) >= abs(low)
    extreme = high if is_max else low
    near = max(0.01 * (high - low), _RELATIVE_ROUNDING * abs(extreme))
    if abs(extreme - values[0]) <= near or abs(extreme - values[-1]) <= near:
        return ""
    return f"{'max' if is_max else 'min'}({name})"


def _scales_of(history: Table | None) -> dict[str, float]:
    """The largest magnitude of each unit in a history."""
    scales: dict[str, float] = {}
    for column in history or []:
        assert history is not None
        values = known_values(history, column)
        unit = unit_of(history, column)
        scales[unit] = max(scales.get(unit, 0.0), float(np.abs(values[np.isfinite(values)]).max(initial=0.0)))
    return scales


def _line(name: str, values: Any, trend: str, change: str, order: str, extrapolated: str, uncertainty: str, verdict: str) -> str:
    """A line of the table of numbers, 100 columns wide; a longer name has a line of its own."""
    long = f"\n{'':{_WIDTH_OF_NAME}}" if len(name) > _WIDTH_OF_NAME else ""
    numbers = "".join(f"{value:>11}" for value in values)
    return f"{name:{_WIDTH_OF_NAME}}{long}{numbers}{trend:>6}{change:>7}{order:>6}{extrapolated:>11}{uncertainty:>7} {verdict}"


def _heading(number: LevelNumber) -> str:
    return f"{number.name} [{number.unit}]" if number.unit else number.name


def _short(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.4g}"


def _in_percent(share: float | None, signed: bool = False) -> str:
    """A share in percent with two digits, in at most 7 characters; with its sign if asked for."""
    if share is None or math.isnan(share):
        return "-"
    size, sign = abs(share), "" if not signed or share == 0 else "+" if share > 0 else "-"
    if size == 0:
        return "0%"
    if size < 1e-4:
        return "<0.01%"
    if size > 9.99:
        return f"{'<' if sign == '-' else '>'}{sign}999%"
    return f"{sign}{100 * size:{'.2f' if size < 0.001 else '.2g' if size < 0.1 else '.0f'}}%"


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _finite_text(value: float | None) -> str:
    return number_text(_finite(value))
