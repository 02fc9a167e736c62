"""Observations: numbers that were measured, and the same numbers of a run."""
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from ..errors import FileError, Missing
from ..packages import need
from ..rasters import Raster
from ..runs import Run
from ..tables import Table
from .outlines import contour_lines, read_outline, resampled, signed_distances
from .places import Block, Entry
from .surveys import read_survey

TYPES = ("history", "front", "profile", "thickness", "outline")
MAPS = ("thickness", "thickness_max", "source", "erosion")  # of a run-out; where they have no value they are zero


class NotComparable(Exception):
    """A run and an observation that have nothing in common; the text says what is missing."""


@dataclass
class Observation(ABC):
    """Measured numbers.

    name        in tables and pictures
    unit        of `values` and `deviations`
    values      (n,), what was measured
    deviations  (n,), its standard deviation; the errors are taken as independent
    entry       where it stands in the file of the calibration
    """

    name: str
    unit: str
    values: np.ndarray
    deviations: np.ndarray
    entry: Entry = field(repr=False, compare=False)

    @abstractmethod
    def of_run(self, run: Run) -> np.ndarray:
        """The same numbers of a run, shape (n,).  Raises NotComparable if the run does not have them."""

    def residuals(self, run: Run) -> np.ndarray:
        """(value of the run - measured value) / standard deviation, shape (n,)."""
        return (self.of_run(run) - self.values) / self.deviations


@dataclass
class Curve(Observation):
    """A column of a table of a run, over time or over distance.

    x       (n,), times [s] or distances [m] of the values
    table   "history", "runout", or the name of a section
    column  of the table
    along   column of x: "time" or "distance"
    """

    x: np.ndarray
    table: str
    column: str
    along: str

    def of_run(self, run: Run) -> np.ndarray:
        try:
            table = {"history": lambda: run.history, "runout": lambda: run.runout}.get(self.table, lambda: run.section(self.table))()
            x, y = table[self.along], table[self.column]
        except (Missing, FileNotFoundError) as error:
            raise NotComparable(str(error)) from error
        if self.along == "distance":
            y = np.nan_to_num(y)  # without moved particles there is no thickness
        there = np.isfinite(y)
        if not there.any():
            raise NotComparable(f"{table.path}: column {self.column} is empty")
        margin = 1e-9 * max(abs(x[0]), abs(x[-1]))
        if self.x[0] < x[0] - margin or self.x[-1] > x[-1] + margin:
            raise NotComparable(f"{table.path} has {self.along} {x[0]:g} to {x[-1]:g}, the observation {self.x[0]:g} to {self.x[-1]:g}")
        return np.interp(self.x, x[there], y[there])


@dataclass
class Thickness(Observation):
    """Thickness of a deposit at places of the plan.

    places  (n, 2), positions in the coordinates of the maps [m]
    map     name of the map of the run
    """

    places: np.ndarray
    map: str

    def of_run(self, run: Run) -> np.ndarray:
        raster = map_of(run, self.map)
        west, east, south, north = raster.extent
        x, y = self.places.T
        if not np.any((x > west) & (x < east) & (y > south) & (y < north)):
            raise NotComparable(f"no place lies in the map {raster.path}, which is {west:g} to {east:g} by {south:g} to {north:g} m: "
                                "are its coordinates those of the scene?")
        return sampled(raster, self.places)


@dataclass
class Outline(Observation):
    """The rim of a deposit: values are distances [m] from points of the observed outline to the rim of the run, positive where the deposit
    of the run covers the point.

    points     (n, 2), points of the observed outline in the coordinates of the maps [m]
    lines      the observed outline as polylines, each (points, 2)
    map        name of the map of the run
    threshold  thickness of the rim [m]
    """

    points: np.ndarray
    lines: list[np.ndarray]
    map: str
    threshold: float

    def of_run(self, run: Run) -> np.ndarray:
        raster = map_of(run, self.map)
        rim = contour_lines(raster, self.threshold)
        if not rim:
            raise NotComparable(f"{raster.path} has no place as thick as threshold, {self.threshold:g} m: no deposit has a rim")
        return signed_distances(self.points, rim, sampled(raster, self.points) > self.threshold)


def map_of(run: Run, name: str) -> Raster:
    """A map of a run.  Raises NotComparable if it has none."""
    try:
        return run.maps[name]
    except (Missing, FileNotFoundError) as error:
        raise NotComparable(str(error)) from error


def sampled(raster: Raster, places: np.ndarray) -> np.ndarray:
    """Values of a map at places of shape (n, 2): linear between the centres of the cells; zero where the map has no value, and outside."""
    ndimage = need("scipy.ndimage", "interpolates maps")
    rows = (raster.y[0] - places[:, 1]) / raster.cell[1]
    columns = (places[:, 0] - raster.x[0]) / raster.cell[0]
    # a place within rounding of a centre takes the value of that cell alone
    rows, columns = (np.where(np.abs(k - np.round(k)) < 1e-6, np.round(k), k) for k in (rows, columns))
    return ndimage.map_coordinates(np.nan_to_num(raster.values.astype(float)), [rows, columns], order=1, mode="constant", cval=0.0)


def read_observation(entry: Entry) -> Observation | None:
    """Reads an entry of the list `observations` with its file.  None, and errors at their places, if something is wrong."""
    before = len(entry.problems.messages)
    block = Block(entry)
    kind = block.word("type", TYPES)
    if len(entry.problems.messages) > before:
        return None  # its other keys mean nothing without a type
    name = block.text("name", kind)
    reader = {"history": _read_history, "front": _read_front, "profile": _read_profile, "thickness": _read_thickness,
              "outline": _read_outline}[kind]
    try:
        found = reader(block, name)
    except Missing as error:  # a column
        (block.take("file") or entry).wrong(str(error))
        found = None
    except (FileError, OSError, ValueError) as error:
        (block.take("file") or entry).wrong(f"cannot be read: {error}")
        found = None
    block.end()
    return found if len(entry.problems.messages) == before else None


def _read_curve(block: Block, name: str, table: str, column: str, along: str, value: str) -> Curve | None:
    """The columns of a table (.csv): `along`, the value, and the deviation if that is a word and not a number."""
    file = block.file("file")
    along_name, value_name = block.text(along, along), block.text("value", value)
    deviation = block.take("deviation", required=True)
    if file is None or deviation is None:
        return None
    data = Table(file[0])
    x, y = data[along_name], data[value_name]
    by_column = deviation.node.id == "scalar" and deviation.node.value in data
    sigma = data[deviation.node.value] if by_column else _constant(block, len(y))
    if sigma is None:
        return None
    if any(values.dtype.kind != "f" for values in (x, y, sigma)):
        raise ValueError(f"{file[0]}: an entry is no number")
    use = np.isfinite(x) & np.isfinite(y) & np.isfinite(sigma)
    order = np.argsort(x[use], kind="stable")
    x, y, sigma = (values[use][order] for values in (x, y, sigma))
    if not len(x):
        raise ValueError(f"{file[0]}: there is no row with numbers")
    if np.any(sigma <= 0):
        deviation.wrong("standard deviations must be > 0")
        return None
    unit = data.units[value_name]
    return Curve(name, unit, y, sigma, block.entry, x, table, column, along)


def _constant(block: Block, count: int) -> np.ndarray | None:
    sigma = block.number("deviation", above=0)
    return None if sigma is None else np.full(count, sigma)


def _read_history(block: Block, name: str) -> Observation | None:
    column = block.text("column")
    if not column:
        for name_of_key in ("file", "time", "value", "deviation"):
            block.take(name_of_key)
        return None  # what is missing has been reported
    return _read_curve(block, column if name == "history" else name, "history", column, "time", column)


def _read_front(block: Block, name: str) -> Observation | None:
    column = block.text("column", "L")
    return _read_curve(block, name, "runout", column, "time", column)


def _read_profile(block: Block, name: str) -> Observation | None:
    column = block.text("column", "thickness")
    return _read_curve(block, name, block.text("section", "plane"), column, "distance", column)


def _read_thickness(block: Block, name: str) -> Observation | None:
    file = block.file("file")
    chosen = block.word("map", MAPS, "thickness")
    empty = block.word("no_data", ("zero", "ignore"), "zero")
    stride = block.whole("stride", 1, low=1)
    sigma = block.number("deviation", above=0, unit="m")
    if file is None or sigma is None:
        return None
    x, y, values = read_survey(file[0])
    values = values[::stride, ::stride]
    if empty == "zero":
        values = np.nan_to_num(values)
    places = np.stack(np.meshgrid(x[::stride], y[::stride]), axis=-1)
    there = np.isfinite(values)
    if not there.any():
        raise ValueError(f"{file[0]} has no values")
    return Thickness(name, "m", values[there], np.full(int(there.sum()), sigma), block.entry, places[there], chosen)


def _read_outline(block: Block, name: str) -> Observation | None:
    file = block.file("file")
    chosen = block.word("map", MAPS, "thickness")
    threshold = block.number("threshold", above=0, unit="m")
    spacing = block.number("spacing", above=0, unit="m") if block.take("spacing") is not None else None
    sigma = block.number("deviation", above=0, unit="m")
    if file is None or sigma is None or threshold is None:
        return None
    lines = read_outline(file[0])
    points = resampled(lines, spacing)
    return Outline(name, "m", np.zeros(len(points)), np.full(len(points), sigma), block.entry, points, lines, chosen, threshold)
