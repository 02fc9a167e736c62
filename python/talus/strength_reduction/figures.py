"""Pictures of a search for a factor of safety."""
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..calibration.files import save_figure, write_whole
from ..packages import need
from ..program import call
from ..tables import csv_text, number_text
from .finding import Search
from .plan import Plan
from .search import FAILS, HOLDS, Trial

_COLOURS = {HOLDS: "tab:blue", FAILS: "tab:red"}


def draw_search(search: Search, tell: Callable[[str], object]) -> None:
    """Draws displacement and growth over the factor, and the bodies at the lowest factor that fails; `tell` is called with each path.
    Needs matplotlib.  Raises ProgramError if the program cannot draw."""
    plan = search.plan
    moved = [trial for trial in search.trials if trial.motion]
    rows = [map(number_text, (trial.factor, trial.motion.moved, trial.motion.growth)) for trial in moved if trial.motion]
    write_whole(plan.folder / "fos_curve.csv", csv_text([["factor", "displacement [m]", "growth [-]"], *rows]))
    tell(str(_draw(search, moved, "displacement [m]", "fos.png", lambda motion: motion.moved)))
    tell(str(_draw(search, moved, "growth [-]", "fos_growth.png", lambda motion: motion.growth)))
    failing = next((trial for trial in moved if trial.verdict == FAILS), None)
    if failing is not None:
        tell(str(_draw_mechanism(plan, failing)))


def _draw(search: Search, trials: list[Trial], label: str, name: str, measure: Callable[[Any], float]) -> Path:
    figure = need("matplotlib.figure", "draws pictures").Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    values = [measure(trial.motion) for trial in trials]
    axes.plot([trial.factor for trial in trials], values, color="0.6", linewidth=1, zorder=1)
    for verdict, colour in _COLOURS.items():
        points = [(trial.factor, value) for trial, value in zip(trials, values) if trial.verdict == verdict]
        if points:
            axes.plot(*zip(*points), "o", color=colour, label=verdict, zorder=2)
    bracket = search.bracket
    if bracket.low is not None and bracket.high is not None:
        axes.axvspan(bracket.low, bracket.high, color="0.9", zorder=0, label=f"holds at {bracket.low:.6g}, fails at {bracket.high:.6g}")
    if name == "fos.png" and values and min(values) > 0:
        axes.set_yscale("log")
    elif name != "fos.png":
        limit = search.plan.criterion.growth
        axes.axhline(limit, color="0.3", linestyle="--", linewidth=0.8, label=f"limit {limit:g}")
    axes.set(xlabel="factor", ylabel=label, title=search.plan.title)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    path = search.plan.folder / name
    save_figure(figure, path)
    return path


def _draw_mechanism(plan: Plan, failing: Trial) -> Path:
    path = plan.folder / "mechanism.png"
    call(["render", str(plan.folder / f"trial_{number_text(failing.factor)}"), "--out", str(path), "--field", plan.field], plan.program)
    return path
