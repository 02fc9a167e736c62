"""Files of particles and meshes, and time series of them."""
from __future__ import annotations

import os
import xml.etree.ElementTree as tree
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Damaged, Missing, UnknownFormat
from .packages import need
from .tables import PURE

if TYPE_CHECKING:
    import pandas
    import xarray

_NUMBERS = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1", "String": "u1"}
_MARK = b'<AppendedData encoding="raw">'
_LONGEST_HEAD = 1 << 22  # bytes; headers of Talus have some thousands


class _VtkFile:
    """Arrays of a VTK XML file as Talus writes it: appended raw data, LZ4 blocks, 64-bit headers (VTK file formats, 'XML file formats').  Each is
    read on demand."""

    def __init__(self, path: Path, kind: str) -> None:
        self.path = path
        with path.open("rb") as file:
            head = file.read(1 << 14)
            while _MARK not in head and len(head) < _LONGEST_HEAD and (more := file.read(1 << 16)):
                head += more
        text, mark, appended = head.partition(_MARK)
        if not text.lstrip().startswith((b"<VTKFile", b"<?xml")):
            raise UnknownFormat(f"{path}: not a VTK XML file")
        if not mark:
            raise Damaged(f"{path}: cut short, or its data are not appended raw")
        try:
            root = tree.fromstring(text + b"</VTKFile>")
        except tree.ParseError as error:
            raise Damaged(f"{path}: {error}") from error
        if (root.get("type"), root.get("compressor"), root.get("header_type")) != (kind, "vtkLZ4DataCompressor", "UInt64"):
            raise UnknownFormat(f"{path}: not a {kind} with LZ4 blocks and 64-bit headers, as Talus writes it")
        self._start = len(text) + len(_MARK) + appended.find(b"_") + 1
        self.sections = {section: self._arrays(root, f"*/{place}") for section, place in (
            ("whole", "FieldData"), ("points", "Piece/PointData"), ("cell_data", "Piece/CellData"), ("place", "Piece/Points"),
            ("cells", "Piece/Cells"))}

    @staticmethod
    def _arrays(root: tree.Element, place: str) -> dict[str, tree.Element]:
        found = root.find(place)
        return {array.get("Name", ""): array for array in found} if found is not None else {}

    @staticmethod
    def unit(array: tree.Element) -> str:
        return next((key.text.strip() for key in array.iter("InformationKey") if key.get("name") == "UNITS_LABEL" and key.text), PURE)

    def read(self, array: tree.Element) -> np.ndarray:
        """Reads the header (blocks, size, size of the last, compressed sizes), then the blocks.  Shape (n,) or (n, components)."""
        block = need("lz4.block", "reads particle and mesh files")
        name = array.get("Name")
        try:
            with self.path.open("rb") as file:
                file.seek(self._start + int(array.get("offset", "")))
                blocks, size, last = np.frombuffer(file.read(24), "<u8").tolist()
                lengths = np.frombuffer(file.read(8 * blocks), "<u8", blocks).tolist()
                sizes = [size] * (blocks - 1) + [last or size] if blocks else []
                data = b"".join(block.decompress(file.read(length), uncompressed_size=full) for length, full in zip(lengths, sizes))
            values = np.frombuffer(data, _NUMBERS[array.get("type", "")])
            components = int(array.get("NumberOfComponents", "1"))
            return values.reshape(-1, components) if components > 1 else values
        except (ValueError, OverflowError, MemoryError, KeyError, block.LZ4BlockError) as error:
            raise Damaged(f"{self.path}: the field {name} is damaged ({error})") from error

    def time(self) -> float:
        there = self.sections["whole"].get("TimeValue")
        return float(self.read(there)[0]) if there is not None else float("nan")

    def made_by(self) -> str:
        there = self.sections["whole"].get("MadeBy")
        return self.read(there).tobytes().split(b"\0")[0].decode() if there is not None else ""


class _Fields(Mapping[str, np.ndarray]):
    """Fields of a file by name, each read at its first use."""

    def __init__(self, file: _VtkFile, fields: dict[str, tree.Element]) -> None:
        self._file, self._fields = file, fields
        self._read: dict[str, np.ndarray] = {}
        self.path = file.path
        self.units: dict[str, str] = {name: file.unit(array) for name, array in fields.items()}
        if "position" in fields:
            self.units["position"] = "m"

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._fields:
            raise Missing(self.path, "field", name, list(self._fields))
        if name not in self._read:
            self._read[name] = self._file.read(self._fields[name])
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    @property
    def time(self) -> float:
        """The time of the file [s]."""
        return self._file.time()

    @property
    def made_by(self) -> str:
        """The program and the scene of the run, as text."""
        return self._file.made_by()


class Particles(_Fields):
    """A particle file (.vtp): fields by name, one row per particle; `position` [m], shape (n, 3), and `id`, shape (n,), always exist.

    units    {field: unit}
    bodies   names of the bodies, in the order of their numbers in the field `body`; empty without a summary
    """

    def __init__(self, path: str | os.PathLike[str], bodies: Sequence[str] = ()) -> None:
        file = _VtkFile(Path(path), "PolyData")
        super().__init__(file, {**{"position": array for array in file.sections["place"].values()}, **file.sections["points"]})
        self.bodies = list(bodies)

    def of(self, body: str | int) -> dict[str, np.ndarray]:
        """All fields of the particles of one body, by its name or number.  Raises Missing if there is no such body."""
        number = self.bodies.index(body) if isinstance(body, str) and body in self.bodies else body
        if not isinstance(number, int):
            raise Missing(self.path, "body", body, self.bodies)
        own = self["body"] == number
        return {name: values[own] for name, values in self.items()}

    def __repr__(self) -> str:
        return f"<talus.Particles {self.path.name}: {', '.join(self)}>"

    def to_pandas(self, body: str | int | None = None) -> pandas.DataFrame:
        """A DataFrame with the particles of all bodies or of one: `id` is the index, vectors and tensors are columns such as `velocity_x`
        and `stress_xx`, and `attrs["units"]` is {column: unit}.  Needs pandas."""
        from .convert import to_pandas
        return to_pandas(self if body is None else self.of(body), self.units)

    def to_xarray(self, *fields: str) -> xarray.Dataset:
        """A Dataset with the dimension `particle`, whose coordinate is `id`, and `axis`, `component` or `entry` for the components.
        fields: default all.  Needs xarray."""
        from .convert import particles_to_xarray
        return particles_to_xarray(self, fields)

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with the fields as `point_data`.  Needs PyVista."""
        from .convert import particles_to_pyvista
        return particles_to_pyvista(self)

    def plot(self, field: str | None = None, plane: str = "xy", body: str | int | None = None, ax: Any = None, colorbar: bool = True,
             **style: Any) -> Any:
        """Draws the particles and returns the axes; `Run.plot` has the arguments.  Needs matplotlib."""
        from .plots import plot_particles
        return plot_particles(self, field, plane, body, ax, colorbar, style)


class Mesh(_Fields):
    """A mesh file (.vtu): fields on nodes and cells by name (`on_cells` contains the names of fields on cells).

    nodes   (nodes, 3) [m]
    cells   (cells, 3) triangles or (cells, 4) tetrahedra: numbers of their nodes
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        file = _VtkFile(Path(path), "UnstructuredGrid")
        on_cells = file.sections["cell_data"]
        super().__init__(file, {**file.sections["points"], **on_cells})
        self.on_cells = set(on_cells)
        self.nodes = file.read(next(iter(file.sections["place"].values())))
        corners, ends = (file.read(file.sections["cells"][name]) for name in ("connectivity", "offsets"))
        width = int(ends[0]) if len(ends) else 1
        if len(corners) != width * len(ends) or (np.diff(ends) != width).any():
            raise Damaged(f"{self.path}: {len(corners)} corners do not make {len(ends)} cells of one kind")
        self.cells = corners.reshape(len(ends), width)

    def __repr__(self) -> str:
        return f"<talus.Mesh {self.path.name}: {len(self.nodes)} nodes, {len(self.cells)} cells{''.join(', ' + name for name in self)}>"

    def to_xarray(self, *fields: str) -> xarray.Dataset:
        """A Dataset with the dimensions `node` and `cell`; `nodes_of_cell` has the nodes of each cell, `node_x` ... the places [m].
        fields: default all.  Needs xarray."""
        from .convert import mesh_to_xarray
        return mesh_to_xarray(self, fields)

    def to_pyvista(self) -> Any:
        """A `pyvista.UnstructuredGrid` with the fields as `point_data` and `cell_data`.  Needs PyVista."""
        from .convert import mesh_to_pyvista
        return mesh_to_pyvista(self)

    def plot(self, field: str | None = None, ax: Any = None, colorbar: bool = True, **style: Any) -> Any:
        """Draws a field on a 2-D mesh, or without a field its edges, and returns the axes.  Needs matplotlib."""
        from .plots import plot_mesh
        return plot_mesh(self, field, ax, colorbar, style)


class Series(Sequence[Any]):
    """Files of a .pvd in order of time, each opened on demand: `series[-1]`, `series.at(2.5)`.

    times   (n,) [s]
    paths   paths of the files
    """

    def __init__(self, path: str | os.PathLike[str], open_file: Any) -> None:
        self.path, self._open = Path(path), open_file
        try:
            entries = tree.parse(self.path).getroot().findall("Collection/DataSet")
            self.times = np.array([float(entry.attrib["timestep"]) for entry in entries])
            self.paths = [self.path.parent / entry.attrib["file"] for entry in entries]
        except (tree.ParseError, KeyError, ValueError) as error:
            raise Damaged(f"{self.path}: {error}") from error

    def __len__(self) -> int:
        return len(self.paths)

    def __getitem__(self, number: Any) -> Any:
        return [self._open(path) for path in self.paths[number]] if isinstance(number, slice) else self._open(self.paths[number])

    def at(self, time: float) -> Any:
        """The file whose time is nearest to this time [s]."""
        if not self.paths:
            raise Missing(self.path, "file at", time, [])
        return self[int(np.abs(self.times - time).argmin())]

    def __repr__(self) -> str:
        return f"<talus.Series {self.path.name}: {len(self)} files>"

    def to_xarray(self, *fields: str) -> xarray.Dataset:
        """All files as one Dataset, with the dimension `time` [s] first.  Needs xarray.

        Particles are matched by their ids: a particle that is absent from a file is nan there.  All values of the fields are in memory
        then: name the fields that you need (default all).
        """
        from .convert import series_to_xarray
        return series_to_xarray(self, fields)
