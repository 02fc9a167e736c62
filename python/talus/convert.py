"""Results as objects of pandas, xarray and PyVista.  Each package is imported when it is needed."""
from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .components import DIMENSIONS, NAMES, names_of
from .errors import Missing
from .fields import Mesh, Particles, Series
from .packages import need
from .rasters import Raster
from .tables import PURE, Table

if TYPE_CHECKING:
    import pandas
    import xarray


def to_pandas(fields: Mapping[str, np.ndarray], units: Mapping[str, str] | None = None) -> pandas.DataFrame:
    """A DataFrame with one row for each particle.

    fields  arrays of the same length, such as `Particles`, `Particles.of("clay")` or `Checkpoint.particles("clay")`
    units   {field: unit}; default `fields.units`, if it exists

    A vector or tensor becomes several columns: `velocity_x`, `stress_xx`.  `id` is the index.  `attrs["units"]` is {column: unit}.
    Needs pandas.  Raises MissingPackage without it.
    """
    pandas = need("pandas", "makes data frames")
    units = getattr(fields, "units", {}) if units is None else units
    columns: dict[str, np.ndarray] = {}
    unit_of: dict[str, str] = {}
    for name, values in fields.items():
        parts = {name: values} if values.ndim == 1 else dict(zip(names_of(name, values.shape[1]), values.T))
        columns.update(parts)
        unit_of.update(dict.fromkeys(parts, units.get(name, PURE)))
    frame = pandas.DataFrame(columns)
    if "id" in columns:
        frame = frame.set_index("id")
        unit_of.pop("id")
    frame.attrs["units"] = unit_of
    return frame


def table_to_pandas(table: Table, index: str | None) -> pandas.DataFrame:
    pandas = need("pandas", "makes data frames")
    frame = pandas.DataFrame(dict(table.items()))
    frame.attrs["units"] = dict(table.units)
    if index is not None:
        table[index]  # Missing names the columns there are
        frame = frame.set_index(index)
    return frame


def table_to_xarray(table: Table, dimension: str | None) -> xarray.Dataset:
    xarray = need("xarray", "makes datasets")
    if dimension is not None:
        table[dimension]
    rows = dimension or "row"
    data = xarray.Dataset({name: (rows, values, {"units": table.units[name]}) for name, values in table.items()})
    return data.set_coords(dimension) if dimension else data


def _variable(values: np.ndarray, rows: Sequence[str], unit: str) -> Any:
    """What xarray.Dataset takes for a field: dimensions, values, attributes.  The last axis may be that of components."""
    over = values.shape[len(rows):]
    more = tuple(DIMENSIONS.get(size, f"components_{size}") for size in over)
    return (*rows, *more), values, {"units": unit}


def _component_names(sizes: Iterable[int]) -> dict[str, Any]:
    return {DIMENSIONS[size]: list(NAMES[size]) for size in sizes if size in NAMES}


def _components(values: np.ndarray) -> int:
    return values.shape[1] if values.ndim > 1 else 1


def particles_to_xarray(particles: Particles, fields: Sequence[str]) -> xarray.Dataset:
    xarray = need("xarray", "makes datasets")
    wanted = [name for name in fields or particles if name != "id"]
    arrays = {name: particles[name] for name in wanted}
    return xarray.Dataset({name: _variable(values, ("particle",), particles.units[name]) for name, values in arrays.items()},
                          {"particle": particles["id"], **_component_names(map(_components, arrays.values()))},
                          {"time": particles.time, "made_by": particles.made_by})


def mesh_to_xarray(mesh: Mesh, fields: Sequence[str]) -> xarray.Dataset:
    xarray = need("xarray", "makes datasets")
    arrays = {name: mesh[name] for name in fields or mesh}
    data = {name: _variable(values, ("cell" if name in mesh.on_cells else "node",), mesh.units[name]) for name, values in arrays.items()}
    places = {f"node_{axis}": ("node", mesh.nodes[:, k], {"units": "m"}) for k, axis in enumerate("xyz")}
    return xarray.Dataset({**data, "nodes_of_cell": (("cell", "corner"), mesh.cells)},
                          {**places, **_component_names(map(_components, arrays.values()))}, {"time": mesh.time})


def series_to_xarray(series: Series, fields: Sequence[str]) -> xarray.Dataset:
    xarray = need("xarray", "makes datasets")
    if not len(series):
        raise Missing(series.path, "file in", series.path.name, [])
    first = series[0]
    wanted = [name for name in fields or first if name != "id"]
    if isinstance(first, Mesh):
        steps = [mesh_to_xarray(mesh, wanted).drop_vars("nodes_of_cell") for mesh in series]
        whole = xarray.concat(steps, "time", coords="minimal", compat="override", combine_attrs="drop")
        return whole.assign_coords(time=("time", series.times, {"units": "s"})).assign(nodes_of_cell=(("cell", "corner"), first.cells))
    frames = list(series)
    ids = np.unique(np.concatenate([frame["id"] for frame in frames]))
    data: dict[str, Any] = {}
    for name in wanted:
        sample = first[name]
        whole_values = np.full((len(frames), len(ids), *sample.shape[1:]), np.nan, np.result_type(sample.dtype, "f4"))
        for values, frame in zip(whole_values, frames):
            values[np.searchsorted(ids, frame["id"])] = frame[name]
        data[name] = _variable(whole_values, ("time", "particle"), first.units[name])
    return xarray.Dataset(data, {"time": ("time", series.times, {"units": "s"}), "particle": ids,
                                 **_component_names(_components(first[name]) for name in wanted)})


def raster_to_xarray(raster: Raster) -> xarray.DataArray:
    xarray = need("xarray", "makes data arrays")
    across, up = raster.axes
    return xarray.DataArray(raster.values, {up: (up, raster.y, {"units": "m"}), across: (across, raster.x, {"units": "m"})}, (up, across),
                            raster.name, {"units": raster.unit, **({"crs": raster.crs} if raster.crs else {})})


def particles_to_pyvista(particles: Particles) -> Any:
    """A pyvista.PolyData with a vertex for each particle."""
    pyvista = need("pyvista", "draws in 3-D")
    cloud = pyvista.PolyData(np.array(particles["position"]))
    for name in particles:
        if name != "position":
            cloud.point_data[name] = np.array(particles[name])
    cloud.field_data["TimeValue"] = [particles.time]
    return cloud


def mesh_to_pyvista(mesh: Mesh) -> Any:
    """A pyvista.UnstructuredGrid of triangles or tetrahedra."""
    pyvista = need("pyvista", "draws in 3-D")
    kind = pyvista.CellType.TRIANGLE if mesh.cells.shape[1] == 3 else pyvista.CellType.TETRA
    grid = pyvista.UnstructuredGrid({kind: np.array(mesh.cells)}, np.array(mesh.nodes))
    for name in mesh:
        (grid.cell_data if name in mesh.on_cells else grid.point_data)[name] = np.array(mesh[name])
    grid.field_data["TimeValue"] = [mesh.time]
    return grid
