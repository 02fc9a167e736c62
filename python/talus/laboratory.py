"""One particle of a material along a path of strains and stresses, or through a laboratory test (`talus drive`)."""
from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from .program import call
from .scenes import HEADING, set_options, to_yaml
from .tables import Table

TESTS = ("triaxial_compression", "triaxial_extension", "simple_shear", "oedometer", "uniaxial_strain_rate")
_PAIRS = ("xx", "yy", "zz", "xy", "yz", "xz")
_NAME = "material"  # of a material that is given without a scene

Material = Union[str, "os.PathLike[str]", Mapping[str, Any]]


class MaterialTest(Table):
    """The response of one particle: columns by name, one row for the start and one for the end of each step.

    Columns: `time` [s], of a laboratory test what is measured (such as `axial_strain` and `stress_difference` [Pa]), the deformation
    gradient `F_xx` ..., the Cauchy stress `stress_xx` ... [Pa], tension positive, `p` (minus its mean) and `q` = sqrt(3 J2) [Pa], and the
    history variables of the law.

    log  what the program printed; of a laboratory test the result beside closed forms
    """

    def __init__(self, path: str | os.PathLike[str], log: str = "") -> None:
        super().__init__(path)
        self.log = log

    @property
    def stress(self) -> np.ndarray:
        """Cauchy stress [Pa], shape (rows, 6): xx, yy, zz, xy, yz, xz."""
        return np.stack([self[f"stress_{pair}"] for pair in _PAIRS], axis=1)

    @property
    def F(self) -> np.ndarray:
        """Deformation gradient, shape (rows, 3, 3)."""
        return np.stack([self[f"F_{i}{j}"] for i in "xyz" for j in "xyz"], axis=1).reshape(-1, 3, 3)

    @property
    def log_strain(self) -> np.ndarray:
        """Logarithmic (Hencky) strain of the left stretch, ln(V), shape (rows, 6): xx, yy, zz, xy, yz, xz (tensor components)."""
        squares, axes = np.linalg.eigh(self.F @ np.swapaxes(self.F, 1, 2))
        strain = np.einsum("nik,nk,njk->nij", axes, np.log(squares) / 2, axes)
        return strain[:, (0, 1, 2, 0, 1, 0), (0, 1, 2, 1, 2, 2)]


def drive(material: Material, path: Sequence[Mapping[str, Any]] | None = None, *, test: str | None = None, name: str | None = None,
          initial_stress: Sequence[float] | None = None, pressure: float | None = None, strain: float | None = None,
          rate: float | None = None, steps: int | None = None, set: Mapping[str, Any] | None = None,
          out: str | os.PathLike[str] | None = None, program: str | os.PathLike[str] | None = None) -> MaterialTest:
    """Takes one particle of a material along a path, or through a laboratory test.

    material        the law and its parameters as a dictionary, as in `materials` of a scene; or a scene, as a dictionary or the path of its
                    file (for `test`); or the path of a file with `material` and `path`
    path            parts of the path, one after the other, each {"time": seconds, "steps": number, "controls": {"zz": {"quantity":
                    "strain_rate", "value": -0.01}}}.  Quantities are strain_rate [1/s], velocity_gradient [1/s] and stress [Pa], which is
                    reached linearly over the part.  Components without control have no strain rate
    test            one of TESTS, instead of `path`
    name            material of the scene, where it has several
    initial_stress  xx, yy, zz, xy, yz, xz at the start [Pa], of `path`; default none
    pressure        stress at the start of a test, equal in all directions [Pa]
    strain, rate    axial or shear strain at the end of a test [-], and its rate [1/s]
    steps           number of steps of a test; of a path they are in its parts
    set             changes of the file, as in `run`
    out             keeps the table as this .csv

    Raises ValueError unless there is exactly one of a path and a test, or an argument belongs to the other; SceneError for wrong input;
    RunFailed if the law cannot follow the path.
    """
    of_test = {"--pressure": pressure, "--strain": strain, "--rate": rate, "--steps": steps, "--material": name}
    is_file = not isinstance(material, Mapping)
    if (path is None) == (test is None) and not (is_file and test is None and path is None):
        raise ValueError("give drive() either a path or a test")
    if is_file and (path is not None or initial_stress is not None):
        raise ValueError(f"path and initial_stress need the material as a dictionary, not as the file {material}")
    if test is None and (given := [option.removeprefix("--") for option, value in of_test.items() if value is not None]):
        raise ValueError(f"{', '.join(given)}: only with test")
    if test is not None and initial_stress is not None:
        raise ValueError("initial_stress: only with path; a test begins with pressure")
    with tempfile.TemporaryDirectory(prefix="talus_drive_") as scratch:
        table = Path(scratch) / "test.csv"
        file = Path(material) if not isinstance(material, Mapping) else Path(scratch) / "material.yaml"
        if isinstance(material, Mapping):
            written = _path_file(material, path, initial_stress) if path is not None else _scene_of(material)
            file.write_text(HEADING + to_yaml(written), encoding="utf-8")
        words = ["drive", str(file), "--out", str(table), *set_options(set)]
        if test is not None:
            words += ["--test", test]
            words += [word for option, value in of_test.items() if value is not None for word in (option, str(value))]
        log = call(words, program)
        result = MaterialTest(table, log)
        if out is not None:
            result.path = Path(shutil.copyfile(table, out))
        return result


def _path_file(material: Mapping[str, Any], path: Sequence[Mapping[str, Any]], initial_stress: Sequence[float] | None) -> dict[str, Any]:
    law = {key: value for key, value in material.items() if key != "name"}  # a name belongs to a scene
    return {"material": law, "initial_stress": None if initial_stress is None else list(initial_stress), "path": list(path)}


def _scene_of(material: Mapping[str, Any]) -> Mapping[str, Any]:
    """A scene with the material, which `talus drive --test` needs; a scene as it is."""
    if "materials" in material:
        return material
    return {"title": "One material", "dimension": 3, "mesh": {"grid": {"low": [0, 0, 0], "high": [1, 1, 1], "cells": [1, 1, 1]}},
            "materials": [{"name": _NAME, **material}],
            "bodies": [{"name": "body", "material": material.get("name", _NAME), "particles_per_cell": 1,
                        "shape": {"type": "box", "low": [0, 0, 0], "high": [1, 1, 1]}}],
            "time": {"end": 1}}
