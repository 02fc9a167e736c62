"""Folders of runs and of parameter studies."""
from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .checkpoints import Checkpoint
from .errors import Damaged
from .fields import Mesh, Particles, Series
from .rasters import Maps, Raster
from .tables import Table

if TYPE_CHECKING:
    import pandas

BEFORE_THE_END = "the run did not end"  # app/run/summary.hpp


def _written(path: Path, what: str) -> Path:
    """The path of an optional file; raises FileNotFoundError if it does not exist."""
    if not path.exists():
        raise FileNotFoundError(f"{path} is not there: nothing has written {what} to this folder")
    return path


def contents_of(path: Path, why_not: str) -> dict[str, Any]:
    """The contents of a file of JSON.  Raises Damaged if it has others, and FileNotFoundError with a reason if it is not there."""
    if not path.exists():
        raise FileNotFoundError(f"{path} is not there: {why_not}")
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise Damaged(f"{path}: {error}") from error


class Run:
    """A results folder.  For a run in progress, or a killed one, it shows the results so far.

    folder  path of the folder
    log     what the program printed, if `talus.run` or `talus.resume` made this object; otherwise empty
    """

    def __init__(self, folder: str | os.PathLike[str], log: str = "") -> None:
        self.folder, self.log = Path(folder), log
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
        return "not ended" if summary.get("message") == BEFORE_THE_END else summary["status"]

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order of their numbers; empty while the summary does not contain them."""
        return [body["name"] for body in self.summary.get("bodies", [])] if (self.folder / "summary.json").exists() else []

    @property
    def warnings(self) -> list[str]:
        """The warnings of the run."""
        return list(self.summary.get("warnings", []))

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
    def maps(self) -> Maps:
        """The maps of the run-out (3-D) by name, each read when it is asked for."""
        _written(self.folder / "maps", "maps (outputs.runout, in 3-D)")
        heads = [name.removeprefix("front_") for name in self.runout if name.startswith("front_")]
        return Maps(self.folder / "maps", [name for name in heads if name != "elevation"])

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
    def rigid(self) -> Series:
        """Surfaces of the rigid bodies: a series of `Mesh`."""
        return Series(_written(self.folder / "rigid.pvd", "rigid bodies (rigid of the scene, with outputs.particles)"), Mesh)

    @property
    def checkpoints(self) -> list[Checkpoint]:
        """The existing checkpoints, in the order of their steps."""
        return [Checkpoint(path) for path in sorted((self.folder / "checkpoints").glob("step_*.h5"))]

    def contents(self) -> dict[str, int]:
        """The results that exist: {property: number of rows, files or maps}."""
        def rows(path: Path) -> int:
            with path.open("rb") as file:
                return max(sum(line.endswith(b"\n") for line in file) - 1, 0)
        found = {name: rows(path) for name in ("history", "runout") if (path := self.folder / f"{name}.csv").exists()}
        series = {"particles": "particles.pvd", "rigid": "rigid.pvd", "mesh_fields": "mesh.pvd"}
        found |= {name: len(Series(path, Mesh)) for name, file in series.items() if (path := self.folder / file).exists()}
        for name, files in (("maps", "maps/*.tif"), ("sections", "sections/*.csv"), ("checkpoints", "checkpoints/step_*.h5")):
            if number := len(list(self.folder.glob(files))):
                found[name] = number
        return found

    def plot(self, field: str | None = None, time: float | None = None, *, on: str = "particles", plane: str | None = None,
             body: str | int | None = None, ax: Any = None, colorbar: bool = True, **style: Any) -> Any:
        """Draws a field at a time and returns the Matplotlib axes; `ax.figure.savefig("a.png")` writes the picture.

        field  as in `talus render`: `displacement` (a vector by its length), `stress:xy` (a component), `stress` (its von Mises value),
               `pressure`; default the particles in grey, or the edges of the mesh
        time   that of the nearest file [s]; default the last
        on     "particles", or "mesh" for a field of outputs.mesh of a 2-D run
        plane  axes of the picture in 3-D, to the right and up, such as "xz"; default with the direction against gravity up
        body   only this body, by name or number
        ax     axes to draw into; default those of a new figure
        style  options of Matplotlib, such as cmap, vmin, vmax; colorbar=False leaves the colour bar out

        Raises Missing if there is no such field or body, FileNotFoundError without such files, MissingPackage without matplotlib.
        """
        from .plots import plane_of, plot_mesh, plot_particles
        if on == "particles":
            particles = self._frame(self.particles, time)
            plane = plane or plane_of(self.summary.get("dimension", 2), self.scene)
            return plot_particles(particles, field, plane, body, ax, colorbar, style)
        if on != "mesh":
            raise ValueError(f"on={on!r}: particles or mesh")
        return plot_mesh(self.mesh if field is None else self._frame(self.mesh_fields, time), field, ax, colorbar, style)

    def to_pyvista(self, time: float | None = None, on: str = "particles") -> Any:
        """Results at a time for PyVista: `run.to_pyvista().plot(scalars="pressure")`.

        time  that of the nearest file [s]; default the last
        on    "particles": a PolyData; "mesh": an UnstructuredGrid with the fields of outputs.mesh, if the run has them; "rigid": the
              surfaces of rigid bodies

        Raises MissingPackage without PyVista.
        """
        if on == "mesh" and not (self.folder / "mesh.pvd").exists():
            return self.mesh.to_pyvista()
        series = {"particles": lambda: self.particles, "mesh": lambda: self.mesh_fields, "rigid": lambda: self.rigid}
        if on not in series:
            raise ValueError(f"on={on!r}: particles, mesh or rigid")
        return self._frame(series[on](), time).to_pyvista()

    @staticmethod
    def _frame(series: Series, time: float | None) -> Any:
        if not len(series):
            raise FileNotFoundError(f"{series.path} lists no file yet")
        return series[-1] if time is None else series.at(time)

    def __repr__(self) -> str:
        status = self.status if (self.folder / "summary.json").exists() else "no summary"
        return f"<talus.Run {self.folder}: {status}>"

    def _repr_html_(self) -> str:
        from .notebook import run_to_html
        return run_to_html(self)


def open_run(folder: str | os.PathLike[str]) -> Run:
    """Opens the results of a run.  Files are read when they are asked for, so this costs nothing.

    folder  the results folder

    Raises FileNotFoundError if there is no such folder, or if it has neither a summary nor a history.
    """
    run = Run(folder)
    if not any((run.folder / name).exists() for name in ("summary.json", "history.csv", "progress.json")):
        raise FileNotFoundError(f"{run.folder} holds no results of a run (no summary.json)")
    return run


class Sweep:
    """The folder of a parameter study (`talus.sweep`, `talus sweep`): `table` has a row for each case; `run(k)` opens the results of
    case k, as numbered in the column `case`.  What depends on the kind of study raises FileNotFoundError where it was not written."""

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
        """The results of a case."""
        return Run(self.folder / f"case_{case:04}")

    def to_pandas(self) -> pandas.DataFrame:
        """The table, with the number of the case as index.  Needs pandas."""
        return self.table.to_pandas("case")

    @property
    def correlations(self) -> Table:
        """Spearman's rank correlation of each number with each key, a row for each number; of sampled keys."""
        return Table(_written(self.folder / "correlation.csv", "correlations (combine: latin or sobol)"))

    def exceedance(self, name: str) -> Table:
        """The share of cases in which a number, such as "toe" or "max(kinetic)", reaches or exceeds a value; of sampled keys."""
        return self._of_number("exceedance", name, "combine: latin or sobol")

    def tornado(self, name: str) -> Table:
        """A number in the low and in the high case of each key, the most important key first."""
        return self._of_number("tornado", name, "combine: tornado")

    def exceedance_map(self, name: str) -> Raster:
        """The share of cases in which a map exceeds the value that the study names."""
        return Raster(_written(self.folder / f"exceedance_{name}.tif", "an exceedance map (exceed)"))

    def _of_number(self, kind: str, name: str, how: str) -> Table:
        from .sweeps.findings import file_word
        return Table(_written(self.folder / f"{kind}_{file_word(name)}.csv", f"a table of {name} ({how})"))
