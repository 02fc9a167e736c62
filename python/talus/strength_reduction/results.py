"""Results of a search for a factor of safety."""
from __future__ import annotations

import os
from pathlib import Path

from ..runs import Run, contents_of
from ..tables import Table


class FactorOfSafety:
    """The folder of a search.

    folder    path of the folder
    contents  fos.json
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self.contents = contents_of(self.folder / "fos.json", "no trial has been judged, or this is no folder of a search")

    @property
    def factor(self) -> float | None:
        """The factor of safety, the middle between the two below; None if the search has not ended."""
        return self.contents["factor_of_safety"]

    @property
    def holds(self) -> float | None:
        """The highest factor that holds, below `fails`; None if there is none so far."""
        return self.contents["highest_that_holds"]

    @property
    def fails(self) -> float | None:
        """The lowest factor that fails; None if there is none so far."""
        return self.contents["lowest_that_fails"]

    @property
    def out_of_order(self) -> list[float]:
        """Factors above `fails` that hold: look at these trials."""
        return list(self.contents["hold_above_that"])

    @property
    def trials(self) -> Table:
        """The table fos.csv, with a row for each trial in the order of their factors."""
        return Table(self.folder / "fos.csv")

    @property
    def at_rest(self) -> Run:
        """The run that found the state at rest."""
        return Run(self.folder / "at_rest")

    def trial(self, factor: float) -> Run:
        """The run with the factor that is nearest to this one."""
        trial = min(self.contents["trials"], key=lambda one: abs(one["factor"] - factor))
        return Run(self.folder / trial["folder"])

    def __str__(self) -> str:
        low, high = (f"{value:.6g}" if value is not None else "nothing" for value in (self.holds, self.fails))
        found = f"factor of safety {self.factor:.6g}" if self.factor is not None else "no factor of safety yet"
        return f"{found}: holds at {low}, fails at {high}"

    def __repr__(self) -> str:
        return f"<talus.FactorOfSafety {self.folder}: {self}>"
