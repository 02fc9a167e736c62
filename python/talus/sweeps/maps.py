"""Maps of the cases of a sweep, and the share of cases in which they exceed a value, as GeoTIFF."""
from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..calibration.files import replaced
from ..calibration.surveys import read_survey
from ..rasters import Raster

_GEO_KEYS = (34735, 34736, 34737)  # GeoTIFF 1.1: keys, their numbers, their text
_SIZES = {2: 1, 3: 2, 4: 4, 12: 8}
_ASCII, _SHORT, _LONG, _DOUBLE = 2, 3, 4, 12


@dataclass(frozen=True)
class CaseMap:
    """A map of a case.

    values  (rows, columns), the first row is the northernmost
    x, y    (columns,) and (rows,), centres of the cells [m]; y decreases
    """

    path: Path
    values: np.ndarray
    x: np.ndarray
    y: np.ndarray

    @property
    def cell(self) -> tuple[float, float]:
        """Size of a cell [m]."""
        return float(self.x[1] - self.x[0]) if len(self.x) > 1 else self._square, self._square

    @property
    def _square(self) -> float:
        return float(self.y[0] - self.y[1]) if len(self.y) > 1 else float(self.x[1] - self.x[0]) if len(self.x) > 1 else 1.0

    def has_grid_of(self, other: CaseMap) -> bool:
        """Whether both have the same cells and the same coordinate system."""
        return np.array_equal(self.x, other.x) and np.array_equal(self.y, other.y) and _tags_of_crs(self.path) == _tags_of_crs(other.path)


def read_map(folder: Path, name: str) -> CaseMap | None:
    """The map of a case, a GeoTIFF as Talus writes it or an ESRI ASCII grid; None if there is none.  Raises FileError."""
    for path in (folder / "maps" / f"{name}{ending}" for ending in (".tif", ".asc")):
        if not path.exists():
            continue
        if path.suffix == ".asc":
            x, y, values = read_survey(path)
        else:
            raster = Raster(path)
            x, y, values = raster.x, raster.y, raster.values
        return CaseMap(path, values, x, y)
    return None


def write_share(path: Path, share: np.ndarray, like: CaseMap) -> None:
    """Writes a map (rows, columns) with the grid and the coordinate system of another one: as GeoTIFF in single precision; for an ASCII
    grid with its .prj beside it, if it has one."""
    rows, columns = share.shape
    packed = zlib.compress(_predicted(share.astype(">f4")))
    (dx, dy), start = like.cell, 8
    tags = {256: (_LONG, (columns,)), 257: (_LONG, (rows,)), 258: (_SHORT, (32,)), 259: (_SHORT, (8,)), 262: (_SHORT, (1,)),
            273: (_LONG, (start,)), 277: (_SHORT, (1,)), 278: (_LONG, (rows,)), 279: (_LONG, (len(packed),)), 317: (_SHORT, (3,)),
            339: (_SHORT, (3,)), 33550: (_DOUBLE, (dx, dy, 0.0)),
            33922: (_DOUBLE, (0.0, 0.0, 0.0, float(like.x[0]) - dx / 2, float(like.y[0]) + dy / 2, 0.0)), 42113: (_ASCII, b"nan\0")}
    fields = {tag: (kind, len(values), values if isinstance(values, bytes) else struct.pack(f"<{len(values)}{_LETTERS[kind]}", *values))
              for tag, (kind, values) in tags.items()}
    fields.update(_tags_of_crs(like.path))
    data = packed + b"\0" * (len(packed) % 2)
    directory = struct.pack("<H", len(fields))
    after = start + len(data) + 2 + 12 * len(fields) + 4  # of what does not fit into the directory
    extra = b""
    for tag, (kind, count, raw) in sorted(fields.items()):
        inside = raw.ljust(4, b"\0") if len(raw) <= 4 else struct.pack("<I", after + len(extra))
        directory += struct.pack("<HHI", tag, kind, count) + inside
        if len(raw) > 4:
            extra += raw + b"\0" * (len(raw) % 2)
    with replaced(path) as new:
        new.write_bytes(b"II*\0" + struct.pack("<I", start + len(data)) + data + directory + b"\0" * 4 + extra)
    projection = like.path.with_suffix(".prj")
    if like.path.suffix == ".asc" and projection.exists():
        with replaced(path.with_suffix(".prj")) as new:
            new.write_bytes(projection.read_bytes())


_LETTERS = {_ASCII: "B", _SHORT: "H", _LONG: "I", _DOUBLE: "d"}


def _predicted(values: np.ndarray) -> bytes:
    """Rows of floats for the floating-point predictor: the bytes of a row by significance, the highest first, each less the one before."""
    rows, columns = values.shape
    planes = values.view("u1").reshape(rows, columns, 4).transpose(0, 2, 1).reshape(rows, 4 * columns)
    return np.diff(planes, axis=1, prepend=np.zeros((rows, 1), "u1")).astype("u1").tobytes()


def _tags_of_crs(path: Path) -> dict[int, tuple[int, int, bytes]]:
    """The fields of the coordinate system of a GeoTIFF: {tag: (type, number of values, bytes)}."""
    found: dict[int, tuple[int, int, bytes]] = {}
    if path.suffix == ".asc":
        return found
    data = path.read_bytes()
    at = struct.unpack_from("<I", data, 4)[0]
    for k in range(struct.unpack_from("<H", data, at)[0]):
        tag, kind, count = struct.unpack_from("<HHI", data, at + 2 + 12 * k)
        if tag in _GEO_KEYS:
            size, place = _SIZES[kind] * count, at + 10 + 12 * k
            begin = place if size <= 4 else struct.unpack_from("<I", data, place)[0]
            found[tag] = kind, count, data[begin:begin + size]
    return found
