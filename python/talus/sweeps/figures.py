"""Pictures of a sweep."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..calibration.files import save_figure
from ..packages import need
from .maps import CaseMap

_LOW, _HIGH = "#0072b2", "#d55e00"  # Okabe & Ito (2008): distinguishable with any kind of colour blindness


def _figure(width: float, height: float) -> tuple[Any, Any]:
    figure = need("matplotlib.figure", "draws pictures").Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _label(heading: str) -> str:
    return heading.replace("_", " ").removesuffix(" [-]")


def draw_exceedance(path: Path, heading: str, values: np.ndarray, shares: np.ndarray) -> None:
    """The share of cases that reach a value, (cases,), over the values in their order."""
    figure, axes = _figure(8, 5)
    axes.step(np.append(values, values[-1]), np.append(shares, 0.0), where="pre", color=_LOW, linewidth=1.6)
    axes.plot(values, shares, "o", color=_LOW, markersize=4)
    axes.set(xlabel=_label(heading), ylabel="share of cases", ylim=(0, 1.05), title=f"Share of {len(values)} cases that reach a value")
    axes.grid(color="0.9")
    save_figure(figure, path)


def draw_tornado(path: Path, heading: str, base: float, bars: Sequence[tuple[str, str, str, float, float]]) -> None:
    """A bar to either side of a line for each key: key, low and high value, and the number in these two cases."""
    high = 0.55 * len(bars)
    figure, axes = _figure(8, 2.0 + high)
    places = np.arange(len(bars))
    for end, colour, label in ((3, _LOW, "at the low value"), (4, _HIGH, "at the high value")):
        axes.barh(places, np.array([bar[end] for bar in bars]) - base, left=base, height=0.55, color=colour, label=label)
    axes.axvline(base, color="black", linewidth=1, label="all in the middle")
    axes.set_yticks(places, [f"{key}\n{low} to {high}" for key, low, high, _, _ in bars])
    axes.invert_yaxis()
    axes.margins(x=0.08)
    axes.set(xlabel=_label(heading), title="One key at a time, low and high")
    axes.grid(axis="x", color="0.9")
    axes.set_axisbelow(True)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.5 / (high + 0.65)), ncols=3, frameon=False)
    save_figure(figure, path)


def draw_correlations(path: Path, keys: Sequence[str], headings: Sequence[str], matrix: np.ndarray) -> None:
    """Rank correlations, (numbers, keys), as a coloured table."""
    figure, axes = _figure(3.2 + 1.3 * len(keys), 1.8 + 0.42 * len(headings))
    image = axes.imshow(matrix, cmap="RdBu_r", vmin=-1, vmax=1, aspect="auto")
    axes.set_xticks(range(len(keys)), keys, rotation=25, ha="right")
    axes.set_yticks(range(len(headings)), headings)
    for (row, column), r in np.ndenumerate(matrix):
        if np.isfinite(r):
            axes.text(column, row, f"{r:+.2f}", ha="center", va="center", color="white" if abs(r) > 0.6 else "black")
    axes.set_title("Rank correlation")
    figure.colorbar(image, ax=axes)
    save_figure(figure, path)


def draw_map(path: Path, what: str, grid: CaseMap, share: np.ndarray) -> None:
    """The share of cases at each place, (rows, columns); places that no case reaches are left white."""
    (dx, dy), x, y = grid.cell, grid.x, grid.y
    wide, high = len(x) * dx, len(y) * dy
    figure, axes = _figure(8, float(np.clip(7 * high / wide, 2.5, 9)))
    extent = x[0] - dx / 2, x[-1] + dx / 2, y[-1] - dy / 2, y[0] + dy / 2
    image = axes.imshow(np.where(share > 0, share, np.nan), extent=extent, vmin=0, vmax=1, cmap="viridis")
    axes.set(xlabel="[m]", ylabel="[m]", title=what[0].upper() + what[1:])
    axes.ticklabel_format(useOffset=False, style="plain")
    figure.colorbar(image, ax=axes)
    save_figure(figure, path)
