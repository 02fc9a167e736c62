"""The picture of a calibration: observations with the run at the start and the best one, and residuals."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..packages import need
from ..runs import Run
from ..tables import PURE
from .evaluation import Record
from .files import save_figure
from .observations import Curve, Observation, Outline, Thickness, map_of
from .outlines import contour_lines
from .results import Calibration

_START, _BEST, _MEASURED = "0.6", "tab:blue", "black"


def write_figure(result: Calibration, observations: list[Observation], start: Record, best: Record) -> Path:
    """Draws a column for each observation, above it with the first run (grey) and the best one (blue), below the residuals of both
    over the standard deviations.  Returns the path of the picture, calibration.png.  Needs matplotlib."""
    figure = need("matplotlib.figure", "draws pictures").Figure(figsize=(4.4 * len(observations), 7), layout="constrained")
    panels = figure.subplots(2, len(observations), squeeze=False)
    for k, (observation, (above, below)) in enumerate(zip(observations, panels.T)):
        ends = [(record, record.values_of_run[k], colour, label)
                for record, colour, label in ((start, _START, start.purpose), (best, _BEST, "estimate")) if record.values_of_run]
        {Curve: _draw_curve, Thickness: _draw_thickness, Outline: _draw_outline}[type(observation)](above, observation, ends)
        above.set_title(observation.name, fontsize="medium")
        x = observation.x if isinstance(observation, Curve) else np.arange(1, len(observation.values) + 1)
        for _, values, colour, label in ends:
            below.plot(x, (values - observation.values) / observation.deviations, ".", color=colour, markersize=4, label=label)
        below.axhspan(-1.96, 1.96, color="0.93", zorder=0)
        below.axhline(0, color="0.7", linewidth=0.8, zorder=1)
        below.set_xlabel(_label(observation.along, _unit_along(observation)) if isinstance(observation, Curve) else "number of the value")
        if ends:  # those of the start may be many times as large: they are cut off
            last = (ends[-1][1] - observation.values) / observation.deviations
            limit = max(4.0, 1.5 * float(np.abs(last).max()))
            below.set_ylim(-limit, limit)
    panels[1, 0].set_ylabel("residual over standard deviation")
    panels[0, 0].legend(frameon=False, fontsize="small")
    estimates = [f"{one.key} = {one.value:.4g} ± {one.deviation:.2g}" for one in result.estimates.values()]
    figure.suptitle(",  ".join(estimates), fontsize="medium")
    path = result.folder / "calibration.png"
    save_figure(figure, path)
    return path


def _unit_along(observation: Curve) -> str:
    return "s" if observation.along == "time" else "m"


def _label(name: str, unit: str) -> str:
    return name.replace("_", " ") if unit == PURE else f"{name.replace('_', ' ')} [{unit}]"


def _draw_curve(axes: Any, observation: Curve, ends: list[tuple[Record, np.ndarray, str, str]]) -> None:
    for _, values, colour, label in ends:
        axes.plot(observation.x, values, color=colour, label=label)
    axes.errorbar(observation.x, observation.values, observation.deviations, fmt=".", color=_MEASURED, markersize=4, linewidth=0.8,
                  label="measured")
    axes.set(xlabel=_label(observation.along, _unit_along(observation)), ylabel=_label(observation.column, observation.unit))


def _draw_thickness(axes: Any, observation: Thickness, ends: list[tuple[Record, np.ndarray, str, str]]) -> None:
    for _, values, colour, label in ends:
        axes.plot(observation.values, values, ".", color=colour, markersize=4, label=label)
    most = max([float(observation.values.max()), *(float(values.max()) for _, values, _, _ in ends)])
    axes.plot([0, most], [0, most], color=_MEASURED, linewidth=0.8, label="measured")
    axes.set(xlabel="measured [m]", ylabel="of the run [m]")


def _draw_outline(axes: Any, observation: Outline, ends: list[tuple[Record, np.ndarray, str, str]]) -> None:
    for record, _, colour, label in ends:
        for k, line in enumerate(contour_lines(map_of(Run(record.folder), observation.map), observation.threshold)):
            axes.plot(*line.T, color=colour, label=label if k == 0 else None)
    axes.plot(*observation.points.T, ".", color=_MEASURED, markersize=4, label="measured")
    axes.set(xlabel="[m]", ylabel="[m]", aspect="equal")
