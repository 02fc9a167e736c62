"""Comparison of the particles of two files; matrices of tensors."""
from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .errors import Missing


def tensors(values: np.ndarray) -> np.ndarray:
    """Matrices of symmetric tensors, such as a field `stress`: (n, 6), or (n, 4) of a 2-D checkpoint, gives (n, 3, 3)."""
    full = np.zeros((len(values), 6), values.dtype)
    full[:, :values.shape[1]] = values
    return full[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)


class Difference(NamedTuple):
    """The largest difference of two files in a field."""

    largest: float  #: largest difference of any component, in the unit of the field
    id: int         #: id of the particle
    component: int
    over: float     #: the largest value of the field in both files, for comparison


class Comparison:
    """Particles of two files, matched by their ids.

    ids                     (n,) ids of the particles in both files, ascending
    only_first, only_second ids of the particles in one file only
    """

    def __init__(self, first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> None:
        self._first, self._second = first, second
        self.ids, self._rows_1, self._rows_2 = np.intersect1d(first["id"], second["id"], assume_unique=True, return_indices=True)
        self.only_first, self.only_second = np.setdiff1d(first["id"], self.ids), np.setdiff1d(second["id"], self.ids)

    def pair(self, field: str) -> tuple[np.ndarray, np.ndarray]:
        """The values of both files, in the order of `ids`."""
        return self._first[field][self._rows_1], self._second[field][self._rows_2]

    def difference(self, field: str) -> np.ndarray:
        """The second minus the first values, in double precision, in the order of `ids`."""
        first, second = self.pair(field)
        return second.astype(float) - first

    def largest(self, field: str) -> Difference:
        """The largest difference; a nan on one side only counts as inf.  Raises Missing if no particle is in both files."""
        first, second = (values.astype(float).reshape(len(self.ids), -1) for values in self.pair(field))
        if not first.size:
            raise Missing("comparison", "particle in both of field", field, [])
        apart = np.where(np.isnan(first) & np.isnan(second), 0.0, np.abs(second - first))
        apart[np.isnan(first) != np.isnan(second)] = np.inf
        row, component = np.unravel_index(apart.argmax(), apart.shape)
        over = np.nanmax(np.abs([first, second]), initial=0.0)
        return Difference(float(apart[row, component]), int(self.ids[row]), int(component), float(over))


def compare(first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> Comparison:
    """Compares particles of one or two runs by their ids.  Arguments: results of `Particles`, `Particles.of` or `Checkpoint.particles`."""
    return Comparison(first, second)
