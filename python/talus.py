"""Reads what Talus writes: runs, particles, meshes, histories, checkpoints, parameter studies.

    import talus
    run = talus.Run("runs/slope")
    run.history["kinetic"], run.history.units["kinetic"]      # (rows,), "J"
    last = run.particles[-1]
    last.time, last["position"], last.units["position"]       # s, (particles, 3), "m"
    last.of("clay")["stress"]                                 # of one body: (particles of it, 6)
    run.checkpoints[-1]["particles/velocity"]                 # in the precision of the run, its digest checked

One file, to be copied where it is wanted.  It needs numpy, h5py where checkpoints are read and lz4 where particles and meshes are
(Debian: python3-numpy, python3-h5py, python3-lz4).  Units are SI; a pure number has the unit "-".  Symmetric tensors have six components,
xx, yy, zz, xy, yz, xz (`tensors` makes matrices of them), others nine, by rows.  Vectors of particle and mesh files have three components
in two dimensions too.  Nothing here writes.

What is wrong with a file is a FileError that names it: `Damaged`, or `UnknownFormat` where another version wrote it.  A file that is not
there is a FileNotFoundError, a field, column or body that is not there a `Missing`, which says what there is.
"""
from __future__ import annotations

import csv
import difflib
import json
import os
import xml.etree.ElementTree as tree
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

__all__ = ["Checkpoint", "Comparison", "Damaged", "FileError", "Mesh", "Missing", "Particles", "Run", "Series", "Sweep", "Table", "UnknownFormat",
           "compare", "tensors"]

PURE = "-"  # the unit of a pure number
CHECKPOINT_FORMATS = (4, 5, 6, 7, 8)  # those that Checkpoint reads


class FileError(Exception):
    """A file that cannot be read; the text begins with its path."""


class Damaged(FileError):
    """A file that is cut short, or whose content contradicts itself."""


class UnknownFormat(FileError):
    """A file of another program, or of a version of Talus that this module does not know."""


class Missing(KeyError):
    """A field, column, array or body that is not there; the text says which there are."""

    def __init__(self, where: object, what: str, name: object, there: Sequence[str]) -> None:
        like = difflib.get_close_matches(str(name), there, 1)
        hint = f"did you mean {like[0]}?" if like else "there are " + ", ".join(there) if there else "there are none"
        super().__init__(f"{where}: no {what} {name}: {hint}")

    def __str__(self) -> str:
        return self.args[0]


def tensors(values: np.ndarray) -> np.ndarray:
    """Matrices of symmetric tensors, such as a field `stress`: (n, 6), or (n, 4) of a 2-D checkpoint, gives (n, 3, 3)."""
    full = np.zeros((len(values), 6), values.dtype)
    full[:, :values.shape[1]] = values
    return full[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)


# ---------------------------------------------------------------------------------------------------------------------------------- tables


def _as_text(entry: str) -> str:
    """Without the apostrophe that stands before what a spreadsheet would take for a formula."""
    return entry[1:] if entry.startswith("'") and entry.lstrip("'")[:1] in ("=", "+", "-", "@") else entry


class Table(Mapping[str, np.ndarray]):
    """Columns of a .csv by name: `table["kinetic"]` has one number a row, an empty entry is nan.  A column with an entry that is no number is
    an array of str.

    path    of the file
    units   {column: unit}
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        text = self.path.read_text(encoding="utf-8")
        records = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))  # a last row that is still being written is left out
        if not records:
            raise Damaged(f"{self.path}: there is no heading")
        self.units: dict[str, str] = {}
        for heading in map(_as_text, records[0]):
            name, mark, unit = heading.rpartition(" [")
            self.units[name if mark else heading] = unit.removesuffix("]") if mark else PURE
        for number, record in enumerate(records[1:], 2):
            if len(record) != len(records[0]):
                raise Damaged(f"{self.path}:{number}: {len(record)} entries for {len(records[0])} columns")
        columns = zip(*records[1:]) if len(records) > 1 else ((),) * len(self.units)
        self._columns = {name: _numbers(column) for name, column in zip(self.units, columns)}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise Missing(self.path, "column", name, list(self._columns))
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        return len(next(iter(self._columns.values())))

    @property
    def array(self) -> np.ndarray:
        """The same as a structured array, shape (rows,); `pandas.DataFrame(table.array)` takes it."""
        whole = np.empty(self.rows, [(name, values.dtype) for name, values in self._columns.items()])
        for name, values in self._columns.items():
            whole[name] = values
        return whole


def _numbers(entries: Sequence[str]) -> np.ndarray:
    try:
        return np.array([float(entry or "nan") for entry in entries])
    except ValueError:
        return np.array([_as_text(entry) for entry in entries])


# -------------------------------------------------------------------------------------------------------------------- particles and meshes

_NUMBERS = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1", "String": "u1"}
_MARK = b'<AppendedData encoding="raw">'
_LONGEST_HEAD = 1 << 22  # bytes; as Talus writes it, it has some thousands


class _VtkFile:
    """Arrays of a VTK XML file as Talus writes it: appended raw data, LZ4 blocks, 64-bit headers (VTK file formats, 'XML file formats').  Each is
    read when it is asked for."""

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
            ("whole", "FieldData"), ("points", "Piece/PointData"), ("cell_data", "Piece/CellData"), ("place", "Piece/Points"), ("cells", "Piece/Cells"))}

    @staticmethod
    def _arrays(root: tree.Element, place: str) -> dict[str, tree.Element]:
        found = root.find(place)
        return {array.get("Name", ""): array for array in found} if found is not None else {}

    @staticmethod
    def unit(array: tree.Element) -> str:
        return next((key.text.strip() for key in array.iter("InformationKey") if key.get("name") == "UNITS_LABEL" and key.text), PURE)

    def read(self, array: tree.Element) -> np.ndarray:
        """Header (blocks, size, size of the last, compressed sizes), then the blocks.  Shape (n,) or (n, components)."""
        import lz4.block
        name = array.get("Name")
        try:
            with self.path.open("rb") as file:
                file.seek(self._start + int(array.get("offset", "")))
                blocks, size, last = np.frombuffer(file.read(24), "<u8").tolist()
                lengths = np.frombuffer(file.read(8 * blocks), "<u8", blocks).tolist()
                sizes = [size] * (blocks - 1) + [last or size] if blocks else []
                data = b"".join(lz4.block.decompress(file.read(length), uncompressed_size=full) for length, full in zip(lengths, sizes))
            values = np.frombuffer(data, _NUMBERS[array.get("type", "")])
            components = int(array.get("NumberOfComponents", "1"))
            return values.reshape(-1, components) if components > 1 else values
        except (ValueError, OverflowError, MemoryError, KeyError, lz4.block.LZ4BlockError) as error:
            raise Damaged(f"{self.path}: the field {name} is damaged ({error})") from error

    def time(self) -> float:
        there = self.sections["whole"].get("TimeValue")
        return float(self.read(there)[0]) if there is not None else float("nan")

    def made_by(self) -> str:
        there = self.sections["whole"].get("MadeBy")
        return self.read(there).tobytes().split(b"\0")[0].decode() if there is not None else ""


class _Fields(Mapping[str, np.ndarray]):
    """Fields of a file by name, each read when it is first asked for."""

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
        """[s]"""
        return self._file.time()

    @property
    def made_by(self) -> str:
        """The program and the scene that wrote the file, in words."""
        return self._file.made_by()


class Particles(_Fields):
    """A particle file (.vtp): fields by name, one row a particle; `position` [m], shape (n, 3), and `id`, shape (n,), are always there.

    units    {field: unit}
    bodies   names of the bodies, in the order of their numbers in the field `body`; empty where no summary told them
    """

    def __init__(self, path: str | os.PathLike[str], bodies: Sequence[str] = ()) -> None:
        file = _VtkFile(Path(path), "PolyData")
        super().__init__(file, {**{"position": array for array in file.sections["place"].values()}, **file.sections["points"]})
        self.bodies = list(bodies)

    def of(self, body: str | int) -> dict[str, np.ndarray]:
        """All fields of the particles of one body, by its name or number.  Missing: there is no such body."""
        number = self.bodies.index(body) if body in self.bodies else body
        if not isinstance(number, int):
            raise Missing(self.path, "body", body, self.bodies)
        own = self["body"] == number
        return {name: values[own] for name, values in self.items()}


class Mesh(_Fields):
    """A mesh file (.vtu): fields on nodes and cells by name (`on_cells` says which are which).

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


class Series(Sequence[Any]):
    """Files of a .pvd in order of time, each opened when it is asked for: `series[-1]`, `series.at(2.5)`.

    times   (n,) [s]
    paths   of the files
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
        """The file nearest to this time [s]."""
        if not self.paths:
            raise Missing(self.path, "file at", time, [])
        return self[int(np.abs(self.times - time).argmin())]


class Difference(NamedTuple):
    """Where two files are furthest apart in a field."""

    largest: float  #: in the unit of the field, of any component
    id: int         #: of the particle
    component: int
    over: float     #: the largest value of the field in both, to compare with


class Comparison:
    """Particles of two files, found again by their ids.

    ids                     (n,) of those that are in both, ascending
    only_first, only_second of those that are in one
    """

    def __init__(self, first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> None:
        self._first, self._second = first, second
        self.ids, self._rows_1, self._rows_2 = np.intersect1d(first["id"], second["id"], assume_unique=True, return_indices=True)
        self.only_first, self.only_second = np.setdiff1d(first["id"], self.ids), np.setdiff1d(second["id"], self.ids)

    def pair(self, field: str) -> tuple[np.ndarray, np.ndarray]:
        """The values of both, row for row of `ids`."""
        return self._first[field][self._rows_1], self._second[field][self._rows_2]

    def difference(self, field: str) -> np.ndarray:
        """Second less first, in double precision, row for row of `ids`."""
        first, second = self.pair(field)
        return second.astype(float) - first

    def largest(self, field: str) -> Difference:
        """Where they are furthest apart; a nan on one side only is as far apart as can be (inf).  Missing: no particle is in both."""
        first, second = (values.astype(float).reshape(len(self.ids), -1) for values in self.pair(field))
        if not first.size:
            raise Missing("comparison", "particle in both of field", field, [])
        apart = np.where(np.isnan(first) & np.isnan(second), 0.0, np.abs(second - first))
        apart[np.isnan(first) != np.isnan(second)] = np.inf
        row, component = np.unravel_index(apart.argmax(), apart.shape)
        over = np.nanmax(np.abs([first, second]), initial=0.0)
        return Difference(float(apart[row, component]), int(self.ids[row]), int(component), float(over))


def compare(first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> Comparison:
    """Two files of particles, of one run or of two, by the ids of the particles.  What `Particles`, `Particles.of` and `Checkpoint.particles` give."""
    return Comparison(first, second)


# -------------------------------------------------------------------------------------------------------------------------- checkpoints


class Body(NamedTuple):
    """A body as a checkpoint has it; its particles are the rows `begin` to `end`."""

    name: str
    material: str
    law: str
    begin: int
    end: int


class Checkpoint(Mapping[str, np.ndarray]):
    """A checkpoint (.h5): every array by its path, such as `particles/stress`, shape (rows,) or (rows, columns), in the precision of the run.
    A text is an array of uint8; `text` decodes it.  The file is open as long as the object lives, or until `close`; it is its own context.

    time [s], step, bodies, version, commit; `units` is {path: unit}.

    check: the digest of each array is computed as it is read, and Damaged raised where it does not fit (0.15 s for a column of a million rows).
    UnknownFormat: not a checkpoint, or of a format other than CHECKPOINT_FORMATS.
    """

    def __init__(self, path: str | os.PathLike[str], check: bool = True) -> None:
        import h5py
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
        self.bodies = [Body(*(self.text(f"recorder/bodies/{b}/{key}") for key in ("name", "material", "law")),
                            *(int(self[f"bodies/{b}/{key}"][0]) for key in ("begin", "end"))) for b in range(int(self["bodies/count"][0]))]

    def close(self) -> None:
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
            sound = not self._check or _fits_digest(name, array, values)
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            raise Damaged(f"{self.path}: {name} is damaged ({error})") from error
        if not sound:
            raise Damaged(f"{self.path}: {name} is damaged (its values do not fit their digest)")
        return np.frombuffer(values.tobytes(), "u1") if values.dtype.kind == "S" else values

    def text(self, name: str) -> str:
        """A text, such as `run/scene`."""
        return self[name].tobytes().decode()

    def _unit(self, name: str) -> str:
        unit = self._file[name].attrs.get("unit", PURE.encode())
        return (unit.decode() if isinstance(unit, bytes) else str(unit)).replace("^D", f"^{self.dimension}")

    def particles(self, body: str | int | None = None) -> dict[str, np.ndarray]:
        """Fields of all particles, as `particles/...` has them; of one body, by name or number, with the history variables of its law as well.
        Fields that the run had no use for are left out."""
        fields = {name.removeprefix("particles/"): self[name] for name in self._paths if name.startswith("particles/")}
        rows = len(fields["id"])
        fields = {name: values for name, values in fields.items() if len(values) == rows}
        if body is None:
            return fields
        names = [own.name for own in self.bodies]
        number = names.index(body) if body in names else body
        if not isinstance(number, int) or not 0 <= number < len(names):
            raise Missing(self.path, "body", body, names)
        own, history = self.bodies[number], f"laws/history/{number}/"
        return {**{name: values[own.begin:own.end] for name, values in fields.items()},
                **{name.removeprefix(history): self[name] for name in self._paths if name.startswith(history)}}


_FACTOR = np.uint64(0x9E3779B97F4A7C15)
_LANES = 8


def _digest_step(h: np.ndarray, word: np.ndarray) -> np.ndarray:
    mixed = (h ^ word) * _FACTOR  # modulo 2^64
    return (mixed << np.uint64(29)) | (mixed >> np.uint64(35))


def _digests(pieces: Sequence[bytes], seed: int) -> list[int]:
    """Digests of pieces of bytes, as io/array_file.cpp computes them: eight lanes of words and what is left over; of all pieces at a time."""
    if not pieces:
        return []
    size = max(map(len, pieces))
    same = [piece for piece in pieces if len(piece) == size]
    if len(same) < len(pieces):  # the first and the last may be shorter
        done = iter(_digests(same, seed))
        return [next(done) if len(piece) == size else _digests([piece], seed)[0] for piece in pieces]
    blocks, over = divmod(size, 8 * _LANES)
    whole = np.array([np.frombuffer(piece, "<u8", blocks * _LANES) for piece in pieces]).reshape(len(pieces), blocks, _LANES)
    rest = np.array([np.frombuffer(piece[size - over:].ljust(8 * _LANES, b"\0"), "<u8") for piece in pieces])
    start = np.array([seed], np.uint64)
    lanes = np.broadcast_to(_digest_step(start, np.arange(_LANES, dtype=np.uint64)), (len(pieces), _LANES))
    for block in range(blocks):
        lanes = _digest_step(lanes, whole[:, block])
    h = np.broadcast_to(_digest_step(start, np.array([size], np.uint64)), len(pieces))
    for k in range(_LANES):
        h = _digest_step(_digest_step(h, lanes[:, k]), rest[:, k])
    return (h ^ (h >> np.uint64(32))).tolist()


def _digest_of_words(words: Sequence[int], seed: int) -> int:
    return _digests([np.array(words, "<u8").tobytes()], seed)[0]


def _fits_digest(name: str, array: Any, values: np.ndarray) -> bool:
    """Whether the values of an array are those that were written (io/array_file.cpp): each piece of rows has a digest that begins with that of what
    the values mean, and the attribute `digest` is that of all of them."""
    rows, columns = (*values.shape, 1)[:2]
    word = {"f8": "double", "f4": "float", "i4": "int32", "i8": "int64", "u1": "uint8"}.get(values.dtype.str[1:], "text")
    unit = array.attrs.get("unit", b"")
    unit = unit if isinstance(unit, bytes) else str(unit).encode()
    meaning = _digests([f"{name}\n{word}\n{rows} x {columns}\n".encode() + unit], 0)[0]
    data, row_bytes = values.tobytes(), columns * values.dtype.itemsize
    if "pieces" not in array.attrs:
        return _digest_of_words(_digests([data] if rows else [], meaning), meaning) == int(array.attrs["digest"])
    piece, lead, *kept = (int(word) for word in array.attrs["pieces"])
    ends = [*range(piece - lead, rows, piece), rows]
    found = _digests([data[begin * row_bytes:end * row_bytes] for begin, end in zip([0, *ends], ends)], meaning)
    return found == kept and _digest_of_words([piece, lead, *kept], meaning) == int(array.attrs["digest"])


# ---------------------------------------------------------------------------------------------------------------------- runs and studies


_BEFORE_THE_END = "the run did not end"  # app/run/summary.hpp


def _written(path: Path, what: str) -> Path:
    """The path of a file that not every folder has."""
    if not path.exists():
        raise FileNotFoundError(f"{path} is not there: nothing has written {what} to this folder")
    return path


class Run:
    """A folder of results.  Of a run that goes on, or was killed, it shows what is there so far."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"{self.folder} is no folder of results")

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json; units stand in its keys, such as "mass [kg]"."""
        path = self.folder / "summary.json"
        try:
            return json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise Damaged(f"{path}: {error}") from error

    @property
    def status(self) -> str:
        """`done`, `stopped`, `failed`, or `not ended` of a run that goes on or was killed."""
        summary = self.summary
        return "not ended" if summary.get("message") == _BEFORE_THE_END else summary["status"]

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order of their numbers; empty as long as the summary does not tell them."""
        return [body["name"] for body in self.summary.get("bodies", [])] if (self.folder / "summary.json").exists() else []

    @property
    def scene(self) -> str:
        """The text of the scene; what `--set` changed stands at its end, in comments."""
        return (self.folder / "scene.yaml").read_text(encoding="utf-8")

    @property
    def history(self) -> Table:
        """history.csv: a row for each time."""
        return Table(_written(self.folder / "history.csv", "a history (outputs.history)"))

    @property
    def runout(self) -> Table:
        """runout.csv: a row for each look."""
        return Table(self.folder / "runout.csv")

    def section(self, name: str) -> Table:
        """A section through the maps of the run-out; "plane" in 2-D."""
        return Table(self.folder / "sections" / f"{name}.csv")

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
        """Files of fields on the mesh, where the scene asks for them (`outputs.mesh`): a series of `Mesh`."""
        return Series(_written(self.folder / "mesh.pvd", "files of fields on the mesh (outputs.mesh)"), Mesh)

    @property
    def checkpoints(self) -> list[Checkpoint]:
        """Those that are kept, in the order of their steps; empty where there are none."""
        return [Checkpoint(path) for path in sorted((self.folder / "checkpoints").glob("step_*.h5"))]


class Sweep:
    """The folder of a parameter study (`talus sweep`): `table` has a row for each case, `run(k)` its results, k counted from 1 as in the column `case`."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self.table = Table(_written(self.folder / "sweep.csv", "a table of a study (talus sweep)"))

    @property
    def keys(self) -> list[str]:
        """Those of the scene that vary: columns of the table."""
        names = list(self.table)
        return names[1:names.index("status")]

    @property
    def done(self) -> np.ndarray:
        """(cases,) whether it is done: only then its numbers are there."""
        return self.table["status"] == "done"

    def run(self, case: int) -> Run:
        return Run(self.folder / f"case_{case:04}")
