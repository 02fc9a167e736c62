"""Factors of safety by strength reduction: by how much the strength of bodies can be divided before they fail.

    found = talus.factor_of_safety("slope.yaml", width=0.01)
    found.factor, found.trials["growth"]
"""
from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..calibration.files import only_writer
from ..errors import EnvironmentFailure, MissingPackage, ProgramError, check_ranges
from ..program import find_program
from ..running import default_folder
from ..scenes import Scene, set_options, write_scene
from .finding import Search
from .plan import RUN, STATIC, Options, plan_search
from .results import FactorOfSafety
from .search import Range

__all__ = ["FactorOfSafety", "factor_of_safety", "folder_of_search", "search_in"]


def factor_of_safety(scene: Scene, *, set: Mapping[str, Any] | None = None, out: str | os.PathLike[str] | None = None, low: float = 0.5,
                     high: float = 3.0, width: float = 0.02, trials: str | None = None, duration: float | None = None,
                     damping: float | None = None, increments: int | None = None, growth: float = 0.1, kinetic: float | None = None,
                     steadiness: float | None = None, share: float = 0.99, bodies: Iterable[str] = (), jobs: int | None = None,
                     threads: int | None = None, launcher: str | None = None, quick: bool = False, pictures: bool = True,
                     tell: Callable[[str], object] | None = None, program: str | os.PathLike[str] | None = None) -> FactorOfSafety:
    """Finds the factor by which the strength of bodies can be divided before they fail (docs/guide/factor_of_safety.md).

    scene, set  as in `run`; the scene needs a geostatic or static stage
    out         folder for runs and results; default runs/NAME_fos.  Trials that are done there are not repeated
    low, high   factors that are tried first; the range is extended if both hold, or both fail
    width       how close holding and failing factors come
    trials      "run" or "static"; default as the stage that finds the state at rest
    duration    of a run [s]; default 3 sqrt(height / gravity), or 20 wave transit times if that is longer
    damping     local damping of a run; default 0.3
    increments  of a static trial; default 6
    growth      displacement in the second half of a trial over that in the first half, above which it fails
    kinetic     of a run: kinetic energy at its end over the peak, above which it fails; default 5e-4
    steadiness  of a static trial: displacement in its last third over the middle third, above which it fails; default 0.5
    share       the displacement that this share of the mass does not exceed is measured
    bodies      whose strength is divided; default all that have some
    jobs        trials at a time; default one for each core, up to 4
    threads     of each; default the cores over `jobs`
    launcher    what each run is started by, such as "mpirun -n 4"
    quick       each run coarse and short: only to see that they work
    pictures    whether pictures are drawn, which needs matplotlib
    tell        is called with a line of text for each run
    program     the program talus; default: `find_program`

    Raises SceneError, a ValueError, for wrong input, with the place of each error; RunFailed if the state at rest is not found, or if
    nothing holds or nothing fails in eight times the range; and as `run` does.  Ctrl-C lets the runs write their checkpoints.
    """
    names = (bodies,) if isinstance(bodies, str) else tuple(bodies)
    options = Options(Range(low, high, width), trials, duration, damping, increments, growth, kinetic, steadiness, share, names, quick)
    folder = Path(out) if out is not None else folder_of_search(scene)
    file = write_scene(scene, folder.parent / f"{folder.name}.yaml") if isinstance(scene, Mapping) else Path(scene)
    changes = set_options(set)[1::2]
    search_in(folder, file, changes, options, jobs, threads, launcher, pictures, tell or (lambda _: None), find_program(program))
    return FactorOfSafety(folder)


def folder_of_search(scene: Scene) -> Path:
    """The folder for results without `out`: runs/NAME_fos."""
    folder = default_folder(scene)
    return folder.with_name(f"{folder.name}_fos")


def search_in(folder: Path, scene: Path, changes: Sequence[str], options: Options, jobs: int | None, threads: int | None,
              launcher: str | None, pictures: bool, tell: Callable[[str], object], program: Path) -> Search:
    """Makes a search in a folder, with changes such as "time.end=2"."""
    _check(options, jobs, threads)
    plan = plan_search(scene, changes, folder, options, program)
    if (folder / "summary.json").exists():
        raise EnvironmentFailure(f"{folder} holds the results of a run: choose another folder with --out", 3)
    folder.mkdir(parents=True, exist_ok=True)
    with only_writer(folder):
        tell(f"{scene}: strength of {', '.join(plan.bodies)} divided; {plan.criterion_in_words}")
        search = Search(plan, options.range, jobs, threads, launcher, tell)
        search()
        if pictures:
            from .figures import draw_search
            try:
                draw_search(search, tell)
            except (ProgramError, MissingPackage) as error:
                tell(f"warning: not drawn: {error}")
    return search


def _check(options: Options, jobs: int | None, threads: int | None) -> None:
    """Raises SceneError with all options that are out of their range."""
    wrong = []
    given = {"low (--from)": options.range.low, "high (--to)": options.range.high, "width": options.range.width, "growth": options.growth,
             "duration": options.duration, "kinetic": options.kinetic, "steadiness": options.steadiness}
    wrong += [f"{name} {value:g} must be above 0" for name, value in given.items() if value is not None and not 0 < value < float("inf")]
    if not options.range.low < options.range.high:
        wrong.append(f"low (--from) {options.range.low:g} must be below high (--to) {options.range.high:g}")
    bounds = {"damping": (options.damping, 0, 0.9), "share": (options.share, 0, 1), "increments": (options.increments, 2, 1000),
              "jobs": (jobs, 1, 1024), "threads": (threads, 1, 1024)}
    if options.trials not in (None, RUN, STATIC):
        wrong.append(f"trials {options.trials!r} must be {RUN} or {STATIC}")
    check_ranges(bounds, wrong)
