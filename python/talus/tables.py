"""Tables (.csv) as columns."""
from __future__ import annotations

import csv
import io
import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Damaged, Missing

if TYPE_CHECKING:
    import pandas
    import xarray

PURE = "-"  # the unit of a pure number
_FORMULA = re.compile(r"'*[=+\-@]")


def cell(text: str) -> str:
    """A text that spreadsheets do not run as a formula: as io/output/csv.cpp, which has an apostrophe before it."""
    text = text.replace("\n", " ")
    try:
        float(text)
    except ValueError:
        return f"'{text}" if _FORMULA.match(text) else text
    return text


def number_text(value: float | None) -> str:
    """The shortest text of a number that gives it back; a whole one without a point, as the program writes it.  None and nan are empty."""
    return "" if value is None or math.isnan(value) else repr(float(value)).removesuffix(".0")


def csv_text(rows: Iterable[Iterable[str]]) -> str:
    """Rows of texts as .csv."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(map(cell, row) for row in rows)
    return text.getvalue()


def _as_text(entry: str) -> str:
    """The entry without the apostrophe that keeps spreadsheets from running it as a formula."""
    return entry[1:] if entry.startswith("'") and entry.lstrip("'")[:1] in ("=", "+", "-", "@") else entry


class Table(Mapping[str, np.ndarray]):
    """Columns of a .csv by name: `table["kinetic"]` has one number per row; empty entries are nan.  A column with entries that are not
    numbers is an array of str.

    path    path of the file
    units   {column: unit}
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        text = self.path.read_text(encoding="utf-8")
        records = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))  # without a last row that is still being written
        if not records:
            raise Damaged(f"{self.path}: there is no heading")
        self.units: dict[str, str] = {}
        for heading in map(_as_text, records[0]):
            name, mark, unit = heading.rpartition(" [")
            name = name if mark else heading
            if name in self.units:
                columns = [number for number, entry in enumerate(map(_as_text, records[0]), 1)
                           if (entry.rpartition(" [")[0] or entry) == name]
                raise Damaged(f'{self.path}: columns {" and ".join(map(str, columns))} are both called "{name}"')
            self.units[name] = unit.removesuffix("]") if mark else PURE
        for number, record in enumerate(records[1:], 2):
            if len(record) != len(records[0]):
                raise Damaged(f"{self.path}:{number}: {len(record)} entries for {len(records[0])} columns")
        columns = zip(*records[1:]) if len(records) > 1 else ((),) * len(self.units)
        self._columns = {name: _numbers(column) for name, column in zip(self.units, columns)}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise Missing(self.path, "column", name, list(self._columns))
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self._columns.values())))

    @property
    def array(self) -> np.ndarray:
        """The table as a structured array of shape (rows,), for example for `pandas.DataFrame(table.array)`."""
        whole = np.empty(self.rows, [(name, values.dtype) for name, values in self._columns.items()])
        for name, values in self._columns.items():
            whole[name] = values
        return whole

    def to_pandas(self, index: str | None = None) -> pandas.DataFrame:
        """A DataFrame with the columns of the table; `attrs["units"]` is {column: unit}.  Needs pandas.

        index  column that becomes the index, such as "time"; default the number of the row
        """
        from .convert import table_to_pandas
        return table_to_pandas(self, index)

    def to_xarray(self, dimension: str | None = None) -> xarray.Dataset:
        """A Dataset with a variable for each column; the attribute `units` of a variable is its unit.  Needs xarray.

        dimension  column that becomes the dimension, such as "time"; default the number of the row
        """
        from .convert import table_to_xarray
        return table_to_xarray(self, dimension)

    def plot(self, *columns: str, x: str = "time", ax: Any = None, **style: Any) -> Any:
        """Draws columns over `x`, one panel for each unit, and returns the axes: one, or an array of them.  Needs matplotlib.

        columns  default the energies, which are the columns in J that are not zero
        ax       axes to draw all columns into; default a new figure
        style    options of `matplotlib.axes.Axes.plot`

        Raises Missing if a column does not exist.
        """
        from .plots import plot_table
        return plot_table(self, columns, x, ax, style)

    def __repr__(self) -> str:
        return f"<talus.{type(self).__name__} {self.path.name}: {self.rows} rows, {len(self)} columns>"

    def _repr_html_(self) -> str:
        from .notebook import table_to_html
        return table_to_html(self)


def _numbers(entries: Sequence[str]) -> np.ndarray:
    try:
        return np.array([float(entry or "nan") for entry in entries])
    except ValueError:
        return np.array([_as_text(entry) for entry in entries])
