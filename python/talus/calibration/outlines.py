"""Outlines of deposits: read from files, found in maps, and how far they are from points."""
from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Damaged
from ..packages import need
from ..rasters import Raster
from ..tables import Table

_DEPTH = {"LineString": 0, "Polygon": 1, "MultiLineString": 1, "MultiPolygon": 2}  # lists around a line of GeoJSON (RFC 7946)
_AXES = (("x", "y"), ("east", "north"))


def read_outline(path: Path) -> list[np.ndarray]:
    """Reads lines of an outline, each (points, 2) [m]; that of a polygon ends where it begins.

    path  GeoJSON (.geojson, .json) with lines or polygons; or a table (.csv) with the columns x and y, or east and north, or else its first
          two, one line for each value of the column `line` if there is one

    Raises a FileError if it cannot be read, or has no line of two points.
    """
    lines = list(_of_table(path)) if path.suffix.lower() == ".csv" else list(_of_geojson(path))
    if not lines or any(len(line) < 2 for line in lines):
        raise Damaged(f"{path}: an outline has at least two points")
    if not all(np.isfinite(line).all() for line in lines):
        raise Damaged(f"{path}: a coordinate is no number")
    return lines


def _of_table(path: Path) -> Iterator[np.ndarray]:
    table = Table(path)
    names = next((pair for pair in _AXES if set(pair) <= set(table)), tuple(table)[:2])
    if len(names) < 2:
        raise Damaged(f"{path}: the columns x and y are expected")
    columns = [table[name] for name in names]
    if any(column.dtype.kind != "f" for column in columns):
        raise Damaged(f"{path}: a coordinate is no number")
    points = np.stack(columns, axis=-1)
    of_line = table["line"] if "line" in table else np.zeros(len(points))
    for line in dict.fromkeys(of_line.tolist()):
        yield points[of_line == line]


def _of_geojson(path: Path) -> Iterator[np.ndarray]:
    try:
        yield from _geometries(json.loads(path.read_text(encoding="utf-8")))
    except (ValueError, KeyError, TypeError, IndexError, AttributeError) as error:
        raise Damaged(f"{path}: no GeoJSON with lines or polygons: {error}") from error


def _geometries(value: Any) -> Iterator[np.ndarray]:
    kind = value["type"]
    if kind == "FeatureCollection":
        parts = value["features"]
    elif kind == "Feature":
        parts = [value["geometry"]]
    elif kind == "GeometryCollection":
        parts = value["geometries"]
    else:
        if kind not in _DEPTH:
            raise ValueError(f"{kind} is no outline")
        lines = [value["coordinates"]]
        for _ in range(_DEPTH[kind]):
            lines = [line for lists in lines for line in lists]
        yield from (np.array([point[:2] for point in line], float) for line in lines)
        return
    for part in parts:
        yield from _geometries(part)


def resampled(lines: Sequence[np.ndarray], spacing: float | None) -> np.ndarray:
    """Points of lines, (n, 2): their vertices, the last one of a closed line left out; or points that are about `spacing` [m] apart."""
    found = []
    for line in lines:
        is_closed = len(line) > 2 and np.array_equal(line[0], line[-1])
        if spacing is not None:
            along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
            at = np.linspace(0, along[-1], max(int(round(along[-1] / spacing)), 1) + 1)
            line = np.stack([np.interp(at, along, line[:, axis]) for axis in range(2)], axis=-1)
        found.append(line[:-1] if is_closed else line)
    return np.concatenate(found)


def contour_lines(raster: Raster, level: float) -> list[np.ndarray]:
    """Lines along which a map has a value, each (points, 2) [m]: linear between the centres of the cells, with zero where the map has no
    value.  A deposit that reaches the edge of the map is open there: an observed outline should have no points on that edge."""
    contour = need("contourpy", "finds outlines in maps")
    x, y = np.asarray(raster.x, float), np.asarray(raster.y, float)[::-1]
    values = np.nan_to_num(raster.values.astype(float))[::-1]
    return [line for line in contour.contour_generator(x, y, values).lines(level) if len(line) > 1]


def signed_distances(points: np.ndarray, lines: Sequence[np.ndarray], inside: np.ndarray) -> np.ndarray:
    """Distances [m] of points (n, 2) to the nearest of some lines, positive for those that are `inside` (n,), otherwise negative."""
    begin = np.concatenate([line[:-1] for line in lines])
    along = np.concatenate([np.diff(line, axis=0) for line in lines])
    square = np.maximum(np.sum(along**2, axis=1), np.finfo(float).tiny)
    from_begin = points[:, None] - begin
    share = np.clip(np.sum(from_begin * along, axis=2) / square, 0, 1)
    distance = np.linalg.norm(from_begin - share[..., None] * along, axis=2).min(axis=1)
    return np.where(inside, distance, -distance)
