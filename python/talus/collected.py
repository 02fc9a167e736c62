"""Numbers of a run by their names: of its summary, or of a column of its history."""
from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from .calibration.places import meant
from .errors import FileError
from .run_states import Number
from .tables import PURE, Table

_OF_COLUMN = re.compile(r"(last|max|min)\((.*)\)")


def history_in(folder: Path) -> Table | None:
    """The history in the results folder of a run; None if it has none that can be read."""
    path = folder / "history.csv"
    try:
        return Table(path) if path.exists() else None
    except (FileError, OSError):
        return None


def of_summary(numbers: Mapping[str, Number], name: str) -> Number | None:
    """The number of that name, or the only one whose name ends with it."""
    if name in numbers:
        return numbers[name]
    ends = [known for known in numbers if known.endswith(f".{name}")]
    return numbers[ends[0]] if len(ends) == 1 else None


def asked(name: str) -> tuple[str, str]:
    """The statistic of a column and its name: "max(toe)" is that of the largest value, "toe" the last one."""
    found = _OF_COLUMN.fullmatch(name)
    return (found[1], found[2]) if found else ("last", name)


def known_values(history: Table, column: str) -> np.ndarray:
    """The values of a column that are numbers and not nan."""
    values = history[column]
    return values[~np.isnan(values)] if values.dtype.kind == "f" else np.empty(0)


def unit_of(history: Table, column: str) -> str:
    """The unit of a column; empty for a pure number."""
    return "" if history.units[column] == PURE else history.units[column]


def collected(numbers: Mapping[str, Number], history: Table | None, name: str) -> Number | None:
    """The number of the summary with that name, or that of a column: its last value that is not nan, or its largest or smallest; nan if
    all are."""
    if (number := of_summary(numbers, name)) is not None:
        return number
    which, column = asked(name)
    if history is None or column not in history:
        return None
    values = known_values(history, column)
    value = {"last": values[-1], "max": values.max(), "min": values.min()}[which] if len(values) else math.nan
    return Number(float(value), unit_of(history, column))


def hint_for(name: str, known: Sequence[str]) -> str:
    """What was probably meant by a name of no number, where these are known; or where names come from."""
    return meant(asked(name)[1], known, "names are the keys of summary.json, joined by points, and the columns of history.csv")
