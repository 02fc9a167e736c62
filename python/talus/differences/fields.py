"""Comparison of the results of two runs: one table each for particles, nodes, cells and the history."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..components import names_of
from ..errors import Damaged
from ..fields import Mesh, Particles, Series
from ..runs import Run
from ..tables import PURE, Table
from .values import Gap, compare, largest_modulus, match_ids, match_times

_SHOWN = 5  # ids of particles that only one run has


@dataclass(frozen=True)
class Asked:
    """What is compared: values differ where |a - b| > absolute + relative * largest value of their field.

    fields  that are compared; empty: all
    last    only the last time that both runs have
    """

    relative: float = 0.0
    absolute: float = 0.0
    fields: tuple[str, ...] = ()
    last: bool = False


class Shape(NamedTuple):
    """The unit and number of components of a field in one run."""

    unit: str
    components: int


@dataclass
class FieldLine:
    """A field of both runs.

    shapes    in each run; None if the run does not have the field
    scale     the largest value in both runs at all times
    gap       the difference
    where     position of the largest difference
    obstacle  why values could not be compared; they count as different
    """

    name: str
    shapes: list[Shape | None] = field(default_factory=lambda: [None, None])
    scale: float = 0.0
    gap: Gap = Gap()
    where: str = ""
    obstacle: str = ""

    @property
    def differs(self) -> bool:
        """Whether the runs differ in this field."""
        return bool(self.obstacle) or self.gap.differing > 0

    @property
    def unit(self) -> str:
        """Its unit; PURE for a pure number."""
        return next(shape.unit for shape in self.shapes if shape is not None)


@dataclass
class FieldTable:
    """The fields of particles, nodes, cells or rows of the history of both runs.

    title, item  name of the items in plural and singular
    names        of all fields, in the order of the files
    lines        of the fields that are compared
    times        number of compared times
    one_sided    descriptions of times and items that only one run has
    """

    title: str
    item: str
    names: list[str] = field(default_factory=list)
    lines: list[FieldLine] = field(default_factory=list)
    times: int = 0
    one_sided: list[str] = field(default_factory=list)


class Snapshot(NamedTuple):
    """The contents of one file for one table; ids are None for numbered items."""

    ids: np.ndarray | None
    values: Mapping[str, np.ndarray]
    units: Mapping[str, str]


Folders = tuple[Path, Path]
Read = Callable[[Path], list[Snapshot]]


def compare_all(folders: Folders, asked: Asked) -> list[FieldTable]:
    """Compares all tables.  Raises FileError or OSError if results cannot be read or compared."""
    particles, mesh = [FieldTable("particles", "particle")], [FieldTable("nodes", "node"), FieldTable("cells", "cell")]
    _compare_series(particles, "particles.pvd", _particles_in, folders, asked)
    _compare_series(mesh, "mesh.pvd", _mesh_fields_in, folders, asked)
    return [*particles, *mesh, _compare_histories(folders, asked)]


def _particles_in(path: Path) -> list[Snapshot]:
    particles = Particles(path)
    ids, counts = np.unique(particles["id"], return_counts=True)
    if (counts > 1).any():
        raise Damaged(f"{path}: there are two particles {ids[counts > 1][0]}")
    return [Snapshot(particles["id"], {name: particles[name] for name in particles if name != "id"}, particles.units)]


def _mesh_fields_in(path: Path) -> list[Snapshot]:
    mesh = Mesh(path)
    nodes = {"position": mesh.nodes, **{name: mesh[name] for name in mesh if name not in mesh.on_cells}}
    cells = {name: mesh[name] for name in mesh if name in mesh.on_cells}
    return [Snapshot(None, nodes, {**mesh.units, "position": "m"}), Snapshot(None, cells, mesh.units)]


def _compare_series(tables: Sequence[FieldTable], name: str, read: Read, folders: Folders, asked: Asked) -> None:
    """Compares the files of a list (.pvd), each of which has a snapshot for each table."""
    series = [Series(folder / name, read) if (folder / name).exists() else None for folder in folders]
    times = [one.times if one is not None else np.array([]) for one in series]
    for folder, own in zip(folders, times):
        _check_ascending(own, folder / name)
    for run, one in enumerate(series):
        for number in range(len(one) if one is not None else 0):
            for table, snapshot in zip(tables, one[number]):  # type: ignore[index]
                for field_name, values in snapshot.values.items():
                    _note_field(table, run, field_name, snapshot.units.get(field_name, PURE), values)
    pairs, one_sided = _common_times(times, folders, asked.last)
    for table in tables:
        _choose_lines(table, folders, asked)
        table.one_sided, table.times = list(one_sided), len(pairs)
    if not any(table.lines for table in tables):
        return
    alone: list[list[list[str]]] = [[[], []] for _ in tables]
    for i, j in pairs:
        assert series[0] is not None and series[1] is not None
        for table, a, b, lone in zip(tables, series[0][i], series[1][j], alone):
            _compare_snapshots(table, a, b, float(times[0][i]), asked, lone)
    for table, lone in zip(tables, alone):
        for folder, found in zip(folders, lone):
            if found:
                more = f", others at {len(found) - 1} more times" if len(found) > 1 else ""
                table.one_sided.append(f"only in {folder}: {found[0]}{more}")


def _compare_snapshots(table: FieldTable, a: Snapshot, b: Snapshot, time: float, asked: Asked, lone: list[list[str]]) -> None:
    """Compares one pair of files."""
    pairs = match_ids(a.ids, b.ids) if a.ids is not None and b.ids is not None else None
    if pairs is not None:
        for found, ids, rows in ((lone[0], a.ids, pairs.only_a), (lone[1], b.ids, pairs.only_b)):
            if len(rows) and ids is not None:
                found.append(_particles_in_words(ids[rows], time))
    for line in table.lines:
        if line.obstacle or (line.name not in a.values and line.name not in b.values):
            continue
        if line.name not in a.values or line.name not in b.values:
            line.obstacle = f"at t = {time:.6g} s only in one run"
            continue
        first, second = a.values[line.name], b.values[line.name]
        if pairs is None and len(first) != len(second):
            line.obstacle = f"{len(first)} and {len(second)} {table.title}"
            continue
        if pairs is not None:
            first, second = first[pairs.a], second[pairs.b]
        gap = compare(first, second, _tolerance(line, asked))
        row = int(a.ids[pairs.a[gap.row]]) if pairs is not None and a.ids is not None and len(pairs.a) else gap.row
        _add_gap(line, gap, f"t = {time:.6g} s, {table.item} {row}")


def _particles_in_words(ids: np.ndarray, time: float) -> str:
    more = f" and {len(ids) - _SHOWN} more" if len(ids) > _SHOWN else ""
    return f"particle{'s' if len(ids) > 1 else ''} {', '.join(map(str, ids[:_SHOWN]))}{more} at t = {time:.6g} s"


def _compare_histories(folders: Folders, asked: Asked) -> FieldTable:
    table = FieldTable("history", "row")
    histories = [_history(folder / "history.csv") if (folder / "history.csv").exists() else None for folder in folders]
    times = [history["time"] if history is not None else np.array([]) for history in histories]
    for run, (history, own, folder) in enumerate(zip(histories, times, folders)):
        _check_ascending(own, folder / "history.csv")
        for name in list(history or [])[1:]:
            assert history is not None
            _note_field(table, run, name, history.units[name], history[name])
    _choose_lines(table, folders, asked)
    pairs, table.one_sided = _common_times(times, folders, asked.last)
    table.times = len(pairs)
    for line in table.lines:
        if line.obstacle or not pairs:
            continue
        assert histories[0] is not None and histories[1] is not None
        rows, partners = (np.array(side, int) for side in zip(*pairs))
        gap = compare(histories[0][line.name][rows], histories[1][line.name][partners], _tolerance(line, asked))
        row = int(rows[gap.row])
        _add_gap(line, gap, f"t = {times[0][row]:.6g} s, row {row + 1}")
    return table


def _history(path: Path) -> Table:
    table = Table(path)
    if next(iter(table), "") != "time":
        raise Damaged(f"{path}: its first column is not the time")
    for name in table:
        if table[name].dtype.kind != "f":
            raise Damaged(f"{path}: the column {name} has entries that are not numbers")
    return table


def _note_field(table: FieldTable, run: int, name: str, unit: str, values: np.ndarray) -> None:
    """Records a field of a run before the comparison: the tolerance needs the largest value of all files."""
    line = next((line for line in table.lines if line.name == name), None)
    if line is None:
        line = FieldLine(name)
        table.lines.append(line)
    line.scale = max(line.scale, largest_modulus(values))
    if line.shapes[run] is None:
        line.shapes[run] = Shape(unit, values.shape[1] if values.ndim > 1 else 1)


def _choose_lines(table: FieldTable, folders: Folders, asked: Asked) -> None:
    """Keeps the requested lines, and records why some cannot be compared."""
    table.names = [line.name for line in table.lines]
    table.lines = [line for line in table.lines if not asked.fields or line.name in asked.fields]
    for line in table.lines:
        a, b = line.shapes
        if a is None or b is None:
            line.obstacle = f"only in {folders[0 if a is not None else 1]}"
        elif a.components != b.components:
            line.obstacle = f"{a.components} and {b.components} components"
        elif a.unit != b.unit:
            line.obstacle = f"in [{a.unit}] and in [{b.unit}]"


def _add_gap(line: FieldLine, gap: Gap, where: str) -> None:
    """Adds the result for one pair of files."""
    before, shape = line.gap, line.shapes[0]
    if gap.largest > before.largest and shape is not None:
        component = names_of("", shape.components)[gap.component].removeprefix("_") if shape.components > 1 else ""
        numbered = "component " if component.isdecimal() else ""
        line.where = where + (f", {numbered}{component}" if component else "")
        if np.isinf(gap.largest):
            line.where += f": {gap.a:.6g} and {gap.b:.6g}"
        line.gap = gap
    line.gap = line.gap._replace(values=before.values + gap.values, differing=before.differing + gap.differing)


def _tolerance(line: FieldLine, asked: Asked) -> float:
    return asked.absolute + asked.relative * line.scale


def _check_ascending(times: np.ndarray, path: Path) -> None:
    """Checks that times ascend, so that two lists can be compared."""
    for number, time in enumerate(times):
        if not np.isfinite(time) or (number > 0 and not time > times[number - 1]):
            raise Damaged(f"{path}: its times do not ascend: entry {number + 1} is {_plain(time)} s")


def _common_times(times: Sequence[np.ndarray], folders: Folders, last: bool) -> tuple[list[tuple[int, int]], list[str]]:
    """The times that both runs have, and a description of the others."""
    found = match_times(times[0], times[1])
    pairs = list(zip(found.a.tolist(), found.b.tolist()))
    if bool(len(times[0])) != bool(len(times[1])):
        return pairs, [f"only in {folders[0 if len(times[0]) else 1]}"]
    one_sided = ["there is no time that both have"] if not pairs and len(times[0]) else []
    if last:
        return pairs[-1:], one_sided
    for folder, own, alone in zip(folders, times, (found.only_a, found.only_b)):
        if len(alone):
            one_sided.append(f"only in {folder}: {len(alone)} time{'s' if len(alone) > 1 else ''}, the first t = {_plain(own[alone[0]])} s")
    return pairs, one_sided


def _plain(value: float) -> str:
    return repr(float(value)).removesuffix(".0")


def origins(folders: Folders) -> tuple[list[str], list[str]]:
    """Scene and program of the runs: names of what is the same, and of what is not, with both.  Raises Damaged for damaged summaries."""
    same, other = [], []
    for name in ("scene.yaml", "mesh.msh"):
        there = [(folder / name).exists() for folder in folders]
        if there[0] != there[1]:
            other.append(f"{name} (only in {folders[0 if there[0] else 1]})")
        elif there[0]:
            (same if (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes() else other).append(name)
    a, b = (_origin(folder) for folder in folders)
    for name, value in a.items():
        if value == b[name]:
            same.append(name)
        else:
            other.append(f"{name} ({value} and {b[name]})")
    return same, other


def _origin(folder: Path) -> dict[str, str]:
    summary = Run(folder).summary
    program = summary.get("program") if isinstance(summary, dict) else None
    if not isinstance(program, dict) or "status" not in summary:
        raise Damaged(f"{folder / 'summary.json'} is not the summary of a run")
    places = {"status": summary, "version": program, "commit": program, "compiler": program, "flags": program, "kernel": summary,
              "transfer": summary, "threads": summary.get("cost", {})}
    return {name: str(place.get("build" if name == "flags" else name, "unknown")) for name, place in places.items()}
