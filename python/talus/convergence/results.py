"""Results of a convergence study."""
from __future__ import annotations

import functools
import os
from pathlib import Path
from typing import Any

from ..errors import Missing
from ..runs import Run, contents_of
from ..tables import Table


class Convergence:
    """The folder of a convergence study.  A quick one has runs, but neither table nor contents: these raise FileNotFoundError."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)

    @functools.cached_property
    def contents(self) -> dict[str, Any]:
        """convergence.json: criteria, levels from coarse to fine, numbers, warnings."""
        return contents_of(self.folder / "convergence.json", "the study did not end or was quick, or this is no folder of one")

    @property
    def table(self) -> Table:
        """The table convergence.csv, with a row for each number."""
        return Table(self.folder / "convergence.csv")

    @property
    def names(self) -> list[str]:
        """The names of the numbers."""
        return [number["quantity"] for number in self.contents["numbers"]]

    def number(self, name: str) -> dict[str, Any]:
        """A number: `values` from coarse to fine, `order`, `extrapolated` value and `uncertainty` of the finest value in its `unit`, None
        where they are unknown, `trend` and `verdict` as words.  Raises Missing if there is no such number."""
        for number in self.contents["numbers"]:
            if number["quantity"] == name:
                return number
        raise Missing(self.folder, "number", name, self.names)

    def level(self, factor: float) -> Run:
        """The run whose cells are nearest to this many times those of the scene."""
        level = min(self.contents["levels"], key=lambda one: abs(one["factor"] - factor))
        return Run(self.folder / level["folder"])

    def __repr__(self) -> str:
        return f"<talus.Convergence {self.folder}>"
