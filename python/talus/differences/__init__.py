"""Differences of two runs, field by field.

    found = talus.diff("runs/a", "runs/b", relative=1e-6)
    found.same, print(found)
"""
from __future__ import annotations

import difflib
import os
from collections.abc import Iterable
from pathlib import Path

from ..errors import FileError, Missing
from ..runs import Run
from ..tables import PURE
from .fields import Asked, FieldLine, FieldTable, compare_all, origins
from .values import Gap

__all__ = ["Differences", "FieldLine", "FieldTable", "Gap", "diff"]


class Differences:
    """How two runs differ.

    tables      of particles, nodes, cells and the history, with a line for each field that was compared
    same_of     what the runs have in common: scene.yaml, mesh.msh, version, commit ...
    other_of    what they do not have in common, which is no difference of results
    """

    def __init__(self, folders: tuple[Path, Path], tables: list[FieldTable]) -> None:
        self.tables = [table for table in tables if table.lines]
        self.same_of, self.other_of = origins(folders)

    @property
    def lines(self) -> dict[str, FieldLine]:
        """{"particles velocity": its line}, of all tables."""
        return {f"{table.title} {line.name}": line for table in self.tables for line in table.lines}

    @property
    def differing(self) -> list[str]:
        """The fields that differ, such as "particles velocity"."""
        return [name for name, line in self.lines.items() if line.differs]

    @property
    def same(self) -> bool:
        """Whether all fields are the same, and both runs have all of them at the same times."""
        return not self.differing and not any(table.one_sided for table in self.tables)

    def __bool__(self) -> bool:
        return not self.same

    def __str__(self) -> str:
        lines = [line for table in self.tables for line in [*_table_in_words(table), ""]]
        lines += [f"made with the same {', '.join(self.same_of)}"] if self.same_of else []
        lines += [f"made with other {', '.join(self.other_of)}"] if self.other_of else []
        missing = "; not all is in both runs" if any(table.one_sided for table in self.tables) else ""
        return "\n".join([*lines, "the same" if self.same else f"{len(self.differing)} of {len(self.lines)} fields differ{missing}"])

    def __repr__(self) -> str:
        return f"<talus.Differences: {str(self).splitlines()[-1]}>"


def diff(a: Run | str | os.PathLike[str], b: Run | str | os.PathLike[str], *, relative: float = 0.0, absolute: float = 0.0,
         fields: Iterable[str] = (), last: bool = False) -> Differences:
    """Compares the results of two runs: particles by their ids, nodes and cells by their numbers, the history by its columns.

    a, b      runs, or their folders
    relative  allowed difference over the largest value of the field in both runs
    absolute  allowed difference besides, in the unit of each field
    fields    that are compared; default all
    last      compares only the last time that both runs have

    Raises ValueError for a negative tolerance, FileNotFoundError for folders and files that are not there, FileError for those that cannot
    be read, and Missing if neither run has a field of `fields`.
    """
    if not (relative >= 0 and absolute >= 0):
        raise ValueError(f"relative {relative:g} and absolute {absolute:g} must be at least 0")
    folders = tuple(run.folder if isinstance(run, Run) else Path(run) for run in (a, b))
    for folder in folders:
        if not (folder / "summary.json").exists():
            raise FileNotFoundError(f"{folder} holds no results of a run (no summary.json)")
    asked = Asked(relative, absolute, (fields,) if isinstance(fields, str) else tuple(fields), last)
    tables = compare_all((folders[0], folders[1]), asked)
    _check_names(tables, folders, asked)
    return Differences((folders[0], folders[1]), tables)


def _check_names(tables: list[FieldTable], folders: tuple[Path, ...], asked: Asked) -> None:
    known = list(dict.fromkeys(name for table in tables for name in table.names))
    if not known:
        raise FileError(f"{folders[0]} and {folders[1]} hold nothing to compare: no particles.pvd, no mesh.pvd, no history.csv")
    for name in asked.fields:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            raise Missing(f"neither {folders[0]} nor {folders[1]}", "field", name, near or known)


def _table_in_words(table: FieldTable) -> list[str]:
    rows = [(table.title, "unit", "largest difference", "over scale", "where", "values that differ"), *map(_cells, table.lines)]
    width = [max(len(row[k]) for row in rows) for k in range(6)]
    lines = ["  ".join(f"{word:{side}{size}}" for word, side, size in zip(row, "<<>><>", width)) for row in rows]
    lines.append(f"  {table.times} time{'s' if table.times != 1 else ''} compared")
    return lines + [f"  {words}" for words in table.one_sided]


def _cells(line: FieldLine) -> tuple[str, str, str, str, str, str]:
    unit = "" if line.unit == PURE else line.unit
    if line.obstacle:
        return f"  {line.name}", unit, "-", "-", line.obstacle, "-"
    gap = line.gap
    largest = f"{gap.largest:.3g}" if gap.values else "-"
    share = gap.largest / line.scale if line.scale else gap.largest  # infinite where nothing finite is there
    over = f"{share:.3g}" if gap.values else "-"
    return f"  {line.name}", unit, largest, over, line.where or "-", f"{gap.differing} of {gap.values}"
