"""Maps of what was measured: GeoTIFF files as Talus writes them, and ESRI ASCII grids."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import Damaged
from ..rasters import Raster

_LOWER_LEFT = {"xllcorner": 0.0, "yllcorner": 0.0, "xllcenter": -0.5, "yllcenter": -0.5}  # cells from it to the edge of the map


def read_survey(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Reads a map.

    path  a GeoTIFF (.tif) as Talus writes it, or an ESRI ASCII grid (.asc)

    Returns x (columns,) and y (rows,), the centres of the cells [m], where y decreases, and the values (rows, columns), nan where there
    are none.  Raises a FileError if it cannot be read.
    """
    if path.suffix.lower() != ".asc":
        raster = Raster(path)
        return raster.x, raster.y, raster.values.astype(float)
    heading: dict[str, float] = {}
    lines = path.read_text(encoding="utf-8").splitlines()
    for line in lines:
        words = line.split()
        if len(words) != 2 or not words[0][0].isalpha():
            break
        try:
            heading[words[0].lower()] = float(words[1])
        except ValueError as error:
            raise Damaged(f"{path}:{len(heading) + 1}: {words[1]} is no number") from error
    try:
        columns, rows, cell = int(heading["ncols"]), int(heading["nrows"]), heading["cellsize"]
        west, south = (next(heading[word] + shift * cell for word, shift in _LOWER_LEFT.items() if word in heading and word[0] == axis)
                       for axis in "xy")
        values = np.array(" ".join(lines[len(heading):]).split(), float).reshape(rows, columns)
    except KeyError as error:
        raise Damaged(f"{path}: the heading has no {error.args[0]}") from error
    except (StopIteration, RuntimeError) as error:
        raise Damaged(f"{path}: the heading has no xllcorner and yllcorner") from error
    except ValueError as error:
        raise Damaged(f"{path}: {error}") from error
    values[values == heading.get("nodata_value", -9999.0)] = np.nan
    return west + cell * (np.arange(columns) + 0.5), south + cell * (rows - np.arange(rows) - 0.5), values
