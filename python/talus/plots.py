"""Pictures of results with Matplotlib."""
from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .components import AXES, Scalar, scalar_of
from .errors import Missing
from .fields import Mesh, Particles
from .packages import need
from .rasters import Raster
from .tables import PURE, Table

_MOST_CIRCLES = 200_000  # above this number particles are drawn as points: circles would take minutes
_OVERLAP = 1.4          # diameter of a circle over the side of the square or cube that it stands for: a square lattice shows no gap
_GRAVITY = re.compile(r"type:\s*gravity\b[^}]*?acceleration:\s*\[([^\]]*)\]", re.S)


def new_axes(ax: Any, **size: Any) -> Any:
    """The axes, or those of a new figure.  In a notebook the figure is shown; in a script `ax.figure.savefig` writes it."""
    pyplot = need("matplotlib.pyplot", "draws pictures")
    return ax if ax is not None else pyplot.subplots(layout="constrained", **size)[1]


def _with_unit(label: str, unit: str) -> str:
    return label if unit == PURE else f"{label} [{unit}]"


def plane_of(dimension: int, scene: str) -> str:
    """The two axes of a picture: x and y in 2-D; in 3-D a horizontal axis and the axis of gravity, if the text of the scene names it."""
    gravity = _GRAVITY.search(scene)
    try:
        pull = [abs(float(part)) for part in gravity[1].split(",")] if gravity else []
    except ValueError:
        pull = []
    up = AXES[int(np.argmax(pull))] if dimension == 3 and len(pull) == 3 else "y"
    return {"x": "yx", "y": "xy", "z": "xz"}[up]


def diameters(fields: Mapping[str, np.ndarray]) -> np.ndarray:
    """Diameters of circles for particles [m], (n,): sides of squares or cubes of their volume, times _OVERLAP."""
    dimension = 3 if np.ptp(fields["position"][:, 2]) > 0 else 2
    return _OVERLAP * np.asarray(fields["volume"], float) ** (1 / dimension)


def plot_particles(particles: Particles, field: str | None, plane: str, body: str | int | None, ax: Any, colorbar: bool,
                   style: dict[str, Any]) -> Any:
    """Draws particles as circles that touch their neighbours, the nearest to the eye on top."""
    collections = need("matplotlib.collections", "draws pictures")
    if len(plane) != 2 or plane[0] == plane[1] or not set(plane) <= set(AXES):
        raise ValueError(f"plane {plane!r}: two different letters of xyz, such as 'xz'")
    fields: Mapping[str, np.ndarray] = particles if body is None else particles.of(body)
    across, up = (AXES.index(axis) for axis in plane)
    shown = scalar_of(_Of(fields, particles), particles.units, field) if field is not None else None
    position = np.asarray(fields["position"])
    if not len(position):
        raise Missing(particles.path, "particle to draw in", particles.path.name if body is None else body, [])
    depth = position[:, 3 - across - up]
    order = np.argsort(depth if (across, up) in ((0, 1), (1, 2), (2, 0)) else -depth, kind="stable")
    place = position[order][:, (across, up)]
    axes = new_axes(ax, figsize=(8, 4.5))
    style.setdefault("cmap", "viridis")
    values = {"array": shown.values[order]} if shown else {"facecolor": style.pop("color", "0.6")}
    if shown is None:
        style.pop("cmap")
    limits = {name: style.pop(name) for name in ("vmin", "vmax") if name in style}
    if len(place) <= _MOST_CIRCLES and "volume" in fields:
        size = diameters(fields)[order]
        drawn = axes.add_collection(collections.EllipseCollection(size, size, 0.0, units="xy", offsets=place,
                                                                  offset_transform=axes.transData, linewidth=0, **values, **style))
        drawn.set_clim(limits.get("vmin"), limits.get("vmax"))
        axes.update_datalim([place.min(axis=0) - size.max(), place.max(axis=0) + size.max()])
        axes.autoscale_view()
    else:
        colours = {"c": values["array"], **limits, **style} if shown else {"color": values["facecolor"], **style}
        drawn = axes.scatter(*place.T, s=1, marker=",", linewidths=0, **colours)
    return _finish(axes, drawn if colorbar else None, shown, plane, particles.time)


class _Of(Mapping[str, np.ndarray]):
    """The fields of a body, with the path of the file for messages."""

    def __init__(self, fields: Mapping[str, np.ndarray], file: Particles) -> None:
        self._fields, self.path = fields, file.path

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._fields:
            raise Missing(self.path, "field", name, list(self._fields))
        return self._fields[name]

    def __iter__(self) -> Any:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)


def plot_mesh(mesh: Mesh, field: str | None, ax: Any, colorbar: bool, style: dict[str, Any]) -> Any:
    """Draws a field on the triangles of a 2-D mesh, or their edges."""
    if mesh.cells.shape[1] != 3:
        raise ValueError(f"{mesh.path}: a mesh of tetrahedra; draw it with to_pyvista, or with ParaView")
    axes = new_axes(ax, figsize=(8, 4.5))
    x, y = mesh.nodes[:, 0], mesh.nodes[:, 1]
    if field is None:
        style = {"color": "0.5", "linewidth": 0.5, **style}
        axes.triplot(x, y, mesh.cells, **style)
        return _finish(axes, None, None, "xy", mesh.time)
    shown = scalar_of(mesh, mesh.units, field)
    if field.partition(":")[0] in mesh.on_cells:
        drawn = axes.tripcolor(x, y, mesh.cells, facecolors=shown.values, **style)
    else:
        drawn = axes.tripcolor(x, y, mesh.cells, shown.values, **{"shading": "gouraud", **style})
    return _finish(axes, drawn if colorbar else None, shown, "xy", mesh.time)


def _finish(axes: Any, drawn: Any, shown: Scalar | None, plane: str, time: float) -> Any:
    axes.set(xlabel=f"{plane[0]} [m]", ylabel=f"{plane[1]} [m]", aspect="equal")
    if not np.isnan(time):
        axes.set_title(f"t = {time:.4g} s", fontsize="medium")
    if drawn is not None and shown is not None:
        axes.figure.colorbar(drawn, ax=axes, label=_with_unit(shown.label, shown.unit), shrink=0.8)
    return axes


def plot_raster(raster: Raster, ax: Any, style: dict[str, Any]) -> Any:
    axes = new_axes(ax, figsize=(6, 5))
    drawn = axes.imshow(raster.values, **{"extent": raster.extent, "origin": "upper", "cmap": "viridis", **style})
    axes.figure.colorbar(drawn, ax=axes, label=_with_unit(raster.name.replace("_", " "), raster.unit), shrink=0.8)
    axes.set(xlabel=f"{raster.axes[0]} [m]", ylabel=f"{raster.axes[1]} [m]")
    return axes


def plot_table(table: Table, columns: Sequence[str], x: str, ax: Any, style: dict[str, Any]) -> Any:
    """Draws columns over another, one panel for each unit; returns the axes, an array of them if there are several."""
    across = table[x]
    wanted = list(columns) or [name for name, values in table.items() if name != x and values.dtype.kind == "f" and table.units[name] == "J"
                               and np.nanmax(np.abs(values), initial=0.0) > 0]
    if not wanted:
        raise Missing(table.path, "column to draw: name one", "", list(table))
    for name in wanted:
        table[name]
    units = list(dict.fromkeys(table.units[name] for name in wanted))
    if ax is not None:
        panels = [ax] * len(units)
    else:
        pyplot = need("matplotlib.pyplot", "draws pictures")
        figure = pyplot.figure(figsize=(8, 1 + 2.6 * len(units)), layout="constrained")
        panels = list(figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0])
    for unit, axes in zip(units, panels):
        for name in wanted:
            if table.units[name] == unit:
                axes.plot(across, table[name], label=name.replace("_", " "), **style)
        axes.set_ylabel(f"[{unit}]")
        axes.grid(alpha=0.3)
        axes.legend(frameon=False)
    panels[-1].set_xlabel(_with_unit(x.replace("_", " "), table.units[x]))
    return panels[0] if ax is not None or len(panels) == 1 else np.array(panels)
