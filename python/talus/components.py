"""Components of vectors and tensors: their names, and the numbers of a field that a picture shows."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .errors import Missing
from .tables import PURE

AXES = ("x", "y", "z")
PAIRS = ("xx", "yy", "zz", "xy", "yz", "xz")
ENTRIES = tuple(i + j for i in AXES for j in AXES)
NAMES: dict[int, tuple[str, ...]] = {3: AXES, 6: PAIRS, 9: ENTRIES}   # number of components -> names
DIMENSIONS = {3: "axis", 6: "component", 9: "entry"}                  # and what they are called in xarray
_IN_PLANE = ("xx", "yy", "zz", "xy")                                  # of a 2-D checkpoint


def names_of(field: str, components: int) -> list[str]:
    """Names of the columns of a field: `stress` with six components gives `stress_xx`, `stress_yy` ...; others are numbered."""
    known = NAMES.get(components, _IN_PLANE if components == 4 else tuple(map(str, range(components))))
    return [f"{field}_{name}" for name in known]


class Scalar(NamedTuple):
    """One number for each particle, node or cell."""

    values: np.ndarray  #: (n,)
    label: str          #: what it is, in words
    unit: str


def von_mises(stress: np.ndarray) -> np.ndarray:
    """The von Mises stress sqrt(3 J2) [Pa] of stresses (n, 6): xx, yy, zz, xy, yz, xz."""
    deviator = stress[:, :3] - stress[:, :3].mean(axis=1, keepdims=True)
    return np.sqrt(1.5 * (np.square(deviator).sum(axis=1) + 2 * np.square(stress[:, 3:]).sum(axis=1)))


def scalar_of(fields: Mapping[str, np.ndarray], units: Mapping[str, str], name: str) -> Scalar:
    """The numbers of a field as `talus render --field` shows them.

    name  `FIELD` or `FIELD:COMPONENT`: a scalar as it is, a vector by its length, a symmetric tensor by its von Mises value; components are
          x, y, z and xx, yy, zz, xy, yz, xz; of a tensor that is not symmetric also yx, zy, zx.  `pressure` and `von_mises` are computed
          from `stress` where the file lacks them

    Raises Missing if there is no such field or component.
    """
    field, mark, component = name.partition(":")
    where = getattr(fields, "path", Path("fields")).name
    unit = units.get(field, PURE)
    if field not in fields and field in ("pressure", "von_mises") and "stress" in fields and not mark:
        stress = np.asarray(fields["stress"], float)
        values = von_mises(stress) if field == "von_mises" else -stress[:, :3].mean(axis=1)
        return Scalar(values, _words(field), units.get("stress", "Pa"))
    values = np.asarray(fields[field], float)
    components = values.shape[1] if values.ndim > 1 else 1
    known = NAMES.get(components, ())
    if mark:
        if component not in known:
            raise Missing(where, f"component of {field}", component, known)
        return Scalar(values[:, known.index(component)], f"{_words(field)} {component}", unit)
    if components == 1:
        return Scalar(values.reshape(-1), _words(field), unit)
    if components == 3:
        return Scalar(np.linalg.norm(values, axis=1), _words(field), unit)
    if components == 6:
        return Scalar(von_mises(values), f"{_words(field)}, von Mises", unit)
    raise Missing(where, f"single number of {field}: name a component, such as {field}:xx;", field, known)


def _words(name: str) -> str:
    return name.replace("_", " ")
