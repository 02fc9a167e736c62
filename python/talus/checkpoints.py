"""Checkpoints: the whole state of a run."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .digests import fits_digest
from .errors import Damaged, Missing, UnknownFormat
from .packages import need
from .tables import PURE

CHECKPOINT_FORMATS = (4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14)  # formats that Checkpoint reads


class Body(NamedTuple):
    """A body in a checkpoint; its particles are the rows from `begin` up to `end`, without `end`."""

    name: str
    material: str
    law: str
    begin: int
    end: int


class Checkpoint(Mapping[str, np.ndarray]):
    """A checkpoint (.h5): every array by its path, such as `particles/stress`, shape (rows,) or (rows, columns), in the type of the file.
    A text is an array of uint8; `text` decodes it.  The file is open as long as the object lives, or until `close`; it can be used in a
    `with` statement.

    Attributes: time [s], step, bodies, version, commit; `units` is {path: unit}.

    check: whether the digest of each array is compared when it is read; Damaged is raised if it differs (0.15 s for a million rows).
    Raises UnknownFormat if the file is not a checkpoint, or has a format other than CHECKPOINT_FORMATS.
    """

    def __init__(self, path: str | os.PathLike[str], check: bool = True) -> None:
        h5py = need("h5py", "reads checkpoints")
        self.path, self._check = Path(path), check
        if not self.path.exists():
            raise FileNotFoundError(f"{self.path} is not there")
        try:
            self._file = h5py.File(self.path, "r")
            self._paths: list[str] = []
            self._file.visititems(lambda name, item: self._paths.append(name) if isinstance(item, h5py.Dataset) else None)
        except (OSError, RuntimeError, KeyError) as error:
            with self.path.open("rb") as begin:
                kind = Damaged if begin.read(8) == b"\x89HDF\r\n\x1a\n" else UnknownFormat
            raise kind(f"{self.path}: {error}") from error
        if "format" not in self._paths:
            raise UnknownFormat(f"{self.path}: no checkpoint of Talus")
        self.format = int(self["format"][0])
        if self.format not in CHECKPOINT_FORMATS:
            raise UnknownFormat(f"{self.path}: format {self.format}; this module knows {', '.join(map(str, CHECKPOINT_FORMATS))}")
        self.version, self.commit = self.text("run/version"), self.text("run/commit")
        self.time, self.step = float(self["clock/time"][0]), int(self["clock/step"][0])
        self.dimension: int = self._file["particles/position"].shape[1]
        self.units = {name: self._unit(name) for name in self._paths}
        self.bodies = [self._body(b) for b in range(int(self["bodies/count"][0]))]

    def _body(self, number: int) -> Body:
        name, material, law = (self.text(f"recorder/bodies/{number}/{key}") for key in ("name", "material", "law"))
        begin, end = (int(self[f"bodies/{number}/{key}"][0]) for key in ("begin", "end"))
        return Body(name, material, law, begin, end)

    def close(self) -> None:
        """Closes the file; arrays that were read stay."""
        self._file.close()

    def __enter__(self) -> Checkpoint:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[str]:
        return iter(self._paths)

    def __len__(self) -> int:
        return len(self._paths)

    def __contains__(self, name: object) -> bool:
        return name in self._paths

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._paths:
            raise Missing(self.path, "array", name, self._paths)
        try:
            array = self._file[name]
            values = array[()]
            sound = not self._check or fits_digest(name, array, values)
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            raise Damaged(f"{self.path}: {name} is damaged ({error})") from error
        if not sound:
            raise Damaged(f"{self.path}: {name} is damaged (its values do not fit their digest)")
        return np.frombuffer(values.tobytes(), "u1") if values.dtype.kind == "S" else values

    def text(self, name: str) -> str:
        """The text at a path, such as `run/scene`."""
        return self[name].tobytes().decode()

    def _unit(self, name: str) -> str:
        unit = self._file[name].attrs.get("unit", PURE.encode())
        return (unit.decode() if isinstance(unit, bytes) else str(unit)).replace("^D", f"^{self.dimension}")

    def particles(self, body: str | int | None = None) -> dict[str, np.ndarray]:
        """The fields of all particles in `particles/...`, or of one body, by name or number, with the history variables of its law.
        Fields that the run did not use are left out."""
        fields = {name.removeprefix("particles/"): self[name] for name in self._paths if name.startswith("particles/")}
        rows = len(fields["id"])
        fields = {name: values for name, values in fields.items() if len(values) == rows}
        if body is None:
            return fields
        names = [own.name for own in self.bodies]
        number = names.index(body) if isinstance(body, str) and body in names else body
        if not isinstance(number, int) or not 0 <= number < len(names):
            raise Missing(self.path, "body", body, names)
        own, history = self.bodies[number], f"laws/history/{number}/"
        return {**{name: values[own.begin:own.end] for name, values in fields.items()},
                **{name.removeprefix(history): self[name] for name in self._paths if name.startswith(history)}}
