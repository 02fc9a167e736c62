"""Folders of runs and of parameter studies."""
from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from .checkpoints import Checkpoint
from .errors import Damaged
from .fields import Mesh, Particles, Series
from .tables import Table

_BEFORE_THE_END = "the run did not end"  # app/run/summary.hpp


def _written(path: Path, what: str) -> Path:
    """The path of an optional file; raises FileNotFoundError if it does not exist."""
    if not path.exists():
        raise FileNotFoundError(f"{path} is not there: nothing has written {what} to this folder")
    return path


class Run:
    """A results folder.  For a run in progress, or a killed one, it shows the results so far."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"{self.folder} is no folder of results")

    @property
    def summary(self) -> dict[str, Any]:
        """The contents of summary.json; its keys contain units, such as "mass [kg]"."""
        path = self.folder / "summary.json"
        try:
            return json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise Damaged(f"{path}: {error}") from error

    @property
    def status(self) -> str:
        """`done`, `stopped`, `failed`, or `not ended` for a run in progress or a killed one."""
        summary = self.summary
        return "not ended" if summary.get("message") == _BEFORE_THE_END else summary["status"]

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order of their numbers; empty while the summary does not contain them."""
        return [body["name"] for body in self.summary.get("bodies", [])] if (self.folder / "summary.json").exists() else []

    @property
    def scene(self) -> str:
        """The text of the scene, with the changes by `--set` as comments at its end."""
        return (self.folder / "scene.yaml").read_text(encoding="utf-8")

    @property
    def history(self) -> Table:
        """The table history.csv, with a row for each output time."""
        return Table(_written(self.folder / "history.csv", "a history (outputs.history)"))

    @property
    def runout(self) -> Table:
        """The table runout.csv, with a row for each sample."""
        return Table(self.folder / "runout.csv")

    def section(self, name: str) -> Table:
        """A section through the maps of the run-out; "plane" in 2-D."""
        return Table(self.folder / "sections" / f"{name}.csv")

    @property
    def particles(self) -> Series:
        """Particle files: a series of `Particles`."""
        bodies = self.bodies
        return Series(_written(self.folder / "particles.pvd", "particle files (outputs.particles)"), lambda path: Particles(path, bodies))

    @property
    def mesh(self) -> Mesh:
        """The mesh, without fields."""
        return Mesh(self.folder / "mesh.vtu")

    @property
    def mesh_fields(self) -> Series:
        """Files of fields on the mesh (`outputs.mesh` of the scene): a series of `Mesh`."""
        return Series(_written(self.folder / "mesh.pvd", "files of fields on the mesh (outputs.mesh)"), Mesh)

    @property
    def checkpoints(self) -> list[Checkpoint]:
        """The existing checkpoints, in the order of their steps."""
        return [Checkpoint(path) for path in sorted((self.folder / "checkpoints").glob("step_*.h5"))]


class Sweep:
    """The folder of a parameter study (`talus sweep`): `table` has a row for each case; `run(k)` opens the results of case k, as numbered in the column `case`."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self.table = Table(_written(self.folder / "sweep.csv", "a table of a study (talus sweep)"))

    @property
    def keys(self) -> list[str]:
        """The varied keys of the scene, which are columns of the table."""
        names = list(self.table)
        return names[1:names.index("status")]

    @property
    def done(self) -> np.ndarray:
        """Whether each case is done, shape (cases,); only then its numbers exist."""
        return self.table["status"] == "done"

    def run(self, case: int) -> Run:
        return Run(self.folder / f"case_{case:04}")
