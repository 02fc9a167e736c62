"""Maps of a run-out: GeoTIFF files as `talus run` writes them."""
from __future__ import annotations

import os
import re
import struct
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Damaged, Missing, UnknownFormat
from .tables import PURE

if TYPE_CHECKING:
    import xarray

# Tags of TIFF 6.0, and of GeoTIFF 1.1 and GDAL
_WIDTH, _HEIGHT, _BITS, _COMPRESSION, _OFFSETS, _ROWS, _LENGTHS, _PREDICTOR, _FORMAT = 256, 257, 258, 259, 273, 278, 279, 317, 339
_PIXEL, _TIE, _KEYS, _METADATA, _NO_DATA = 33550, 33922, 34735, 42112, 42113
_TYPES = {1: "B", 2: "B", 3: "H", 4: "I", 12: "d"}  # of the fields that Talus writes
_DEFLATE, _FLOATING_PREDICTOR, _FLOATS = 8, 3, 3
_PROJECTED, _GEOGRAPHIC, _USER_DEFINED = 3072, 2048, 32767


class Raster:
    """A map on a regular grid.

    values  (rows, columns) in single precision; nan where the map has no value.  The first row is the northernmost
    x, y    (columns,) and (rows,): centres of the cells [m]; y decreases
    axes    names of the two axes, such as ("x", "y"), ("z", "x") where y is up, or ("east", "north")
    name, unit
    crs     coordinate system, such as "EPSG:25832"; empty where the file names none
    """

    def __init__(self, path: str | os.PathLike[str], axes: Sequence[str] = ("x", "y")) -> None:
        self.path, self.axes = Path(path), (axes[0], axes[1])
        self.name = self.path.stem
        data = self.path.read_bytes()
        if data[:4] != b"II*\0":
            raise UnknownFormat(f"{self.path}: not a GeoTIFF as Talus writes it")
        try:
            self._read(data)
        except (struct.error, zlib.error, ValueError, KeyError, IndexError) as error:
            raise Damaged(f"{self.path}: {error}") from error

    def _read(self, data: bytes) -> None:
        tags = _tags(data)
        kind = (tags[_BITS][0], tags[_COMPRESSION][0], tags.get(_PREDICTOR, (1,))[0], tags.get(_FORMAT, (1,))[0])
        if kind != (32, _DEFLATE, _FLOATING_PREDICTOR, _FLOATS):
            raise UnknownFormat(f"{self.path}: not in single precision with deflate, as Talus writes it")
        width, height = tags[_WIDTH][0], tags[_HEIGHT][0]
        strips = []
        for strip, (offset, length) in enumerate(zip(tags[_OFFSETS], tags[_LENGTHS])):
            rows = min(tags[_ROWS][0], height - strip * tags[_ROWS][0])
            strips.append(_unpredicted(zlib.decompress(data[offset:offset + length]), rows, width))
        self.values = np.concatenate(strips)
        if self.values.shape != (height, width):
            raise ValueError(f"{len(self.values)} rows instead of {height}")
        self.values[self.values == np.float32(_text(tags[_NO_DATA]))] = np.nan
        (dx, dy), (west, north) = tags[_PIXEL][:2], tags[_TIE][3:5]
        self.x, self.y = west + dx * (np.arange(width) + 0.5), north - dy * (np.arange(height) + 0.5)
        self.cell = (dx, dy)
        unit = re.search(r'role="unittype">([^<]*)<', _text(tags[_METADATA])) if _METADATA in tags else None
        self.unit = unit[1] if unit else PURE
        self.crs = _crs(tags.get(_KEYS, ()))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """The first and last edge along both axes [m], as `matplotlib.pyplot.imshow` takes them."""
        (dx, dy), x, y = self.cell, self.x, self.y
        return x[0] - dx / 2, x[-1] + dx / 2, y[-1] - dy / 2, y[0] + dy / 2

    @property
    def area(self) -> float:
        """Area of a cell [m^2]."""
        return self.cell[0] * self.cell[1]

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.array(self.values, dtype=dtype)

    def __repr__(self) -> str:
        rows, columns = self.values.shape
        return f"<talus.Raster {self.name} [{self.unit}]: {rows} rows, {columns} columns of {self.cell[0]:.6g} m x {self.cell[1]:.6g} m>"

    def to_xarray(self) -> xarray.DataArray:
        """A DataArray with the dimensions `axes[1]` and `axes[0]`.  Needs xarray."""
        from .convert import raster_to_xarray
        return raster_to_xarray(self)

    def plot(self, ax: Any = None, **style: Any) -> Any:
        """Draws the map with a colour bar and returns its axes; `style` goes to `imshow`.  Needs matplotlib."""
        from .plots import plot_raster
        return plot_raster(self, ax, style)


def _tags(data: bytes) -> dict[int, tuple[Any, ...]]:
    """The fields of the first directory of a TIFF: {tag: values}."""
    start = struct.unpack_from("<I", data, 4)[0]
    tags = {}
    for entry in range(struct.unpack_from("<H", data, start)[0]):
        place = start + 2 + 12 * entry
        tag, kind, count = struct.unpack_from("<HHI", data, place)
        if kind in _TYPES:
            form = f"<{count}{_TYPES[kind]}"
            where = place + 8 if struct.calcsize(form) <= 4 else struct.unpack_from("<I", data, place + 8)[0]
            tags[tag] = struct.unpack_from(form, data, where)
    return tags


def _unpredicted(raw: bytes, rows: int, width: int) -> np.ndarray:
    """Rows of floats from the floating-point predictor (Adobe Photoshop TIFF Technical Note 3): the bytes of a row are stored by
    significance, the highest first, each less the one before."""
    planes = np.cumsum(np.frombuffer(raw, "u1").reshape(rows, 4 * width), axis=1, dtype="u1").reshape(rows, 4, width)
    return np.ascontiguousarray(planes.transpose(0, 2, 1)).view(">f4").reshape(rows, width).astype("f4")


def _text(values: Sequence[int]) -> str:
    return bytes(values).split(b"\0")[0].decode()


def _crs(keys: Sequence[int]) -> str:
    codes = {keys[k]: keys[k + 3] for k in range(4, len(keys) - 3, 4) if keys[k + 1] == 0}
    code = codes.get(_PROJECTED, codes.get(_GEOGRAPHIC, _USER_DEFINED))
    return f"EPSG:{code}" if code != _USER_DEFINED else ""


class Maps(Mapping[str, Raster]):
    """The maps of a run by name, each read when it is asked for: `run.maps["thickness_max"]`."""

    def __init__(self, folder: Path, axes: Sequence[str]) -> None:
        self.folder, self._axes = folder, axes
        self._names = sorted(path.stem for path in folder.glob("*.tif"))

    def __getitem__(self, name: str) -> Raster:
        if name not in self._names:
            raise Missing(self.folder, "map", name, self._names)
        return Raster(self.folder / f"{name}.tif", self._axes)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<talus.Maps {self.folder}: {', '.join(self._names)}>"
