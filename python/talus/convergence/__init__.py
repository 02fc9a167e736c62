"""How far results depend on the cells: a scene with cells of several sizes, order of convergence and uncertainty of its numbers.

    study = talus.converge("slope.yaml", collect=["toe", "max(kinetic)"])
    study.number("toe")["extrapolated"], study.number("toe")["uncertainty"]
"""
from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from ..calibration.files import only_writer, write_whole
from ..child_runs import Share, divide_cores
from ..collected import of_summary
from ..errors import EnvironmentFailure
from ..program import find_program
from ..run_queue import RunQueue
from ..run_states import DONE, RunState, state_of
from ..running import default_folder
from ..scenes import Scene, set_options, write_scene
from .levels import Options, Plan, check_options, plan_levels
from .numbers import LevelNumber, complaints, convergence_csv, convergence_json, numbers_of, print_levels, print_numbers, require_within
from .results import Convergence

__all__ = ["Convergence", "converge", "folder_of_study", "plan_study", "run_study"]

Tell = Callable[[str], object]
_SAME_TIME = 1e-6  # times that differ by less, over themselves, are the same


def converge(scene: Scene, *, set: Mapping[str, Any] | None = None, out: str | os.PathLike[str] | None = None, ratio: float = math.sqrt(2),
             levels: int = 3, finer: int = 0, collect: Iterable[str] = (), within: float | None = None, jobs: int | None = None,
             threads: int | None = None, launcher: str | None = None, quick: bool = False, tell: Tell | None = None,
             warn: Tell | None = None, program: str | os.PathLike[str] | None = None) -> Convergence:
    """Runs a scene with cells of several sizes, and finds how far its results depend on them (docs/guide/convergence.md).

    scene, set  as in `run`; Talus makes the mesh of the scene, and its particles do not come from another run
    out         folder of levels and table; default runs/NAME_convergence.  Levels that are done there are not repeated
    ratio       size of the cells of a level over that of the next finer one, in [1.2, 4]
    levels      how many there are, in [3, 8]
    finer       how many of them have smaller cells than the scene; the others have its cells and larger ones
    collect     names of numbers, such as "toe" or "max(kinetic)"; default all physical results
    within      uncertainty of each number of `collect` over its value, above which RunFailed is raised; default none
    jobs        levels at a time; default 1, as the finest takes most of the time
    threads     of each; default as for a run, with `jobs` the cores over that
    launcher    what each run is started by, such as "mpirun -n 4"
    quick       each level coarse and short, only to see that they run: their numbers are not compared
    tell        is called with lines of text: levels, progress, the table
    warn        is called with warnings, such as numbers that do not converge; default `tell`, after "warning: "
    program     the program talus; default: `find_program`

    Raises SceneError, a ValueError, with all errors of the scene and of its levels before anything runs, also where cells cannot be scaled
    or hardly change, and for names of numbers that no level has; RunFailed if a level failed, or a number is not within the share that
    `within` gives; EnvironmentFailure for a folder with other results, or one in which another process is at work.  Ctrl-C, and SIGTERM and
    SIGUSR1, let the runs write checkpoints and raise `StoppedRuns`, a KeyboardInterrupt; the same call goes on.
    """
    names = (collect,) if isinstance(collect, str) else tuple(collect)
    options = Options(ratio, levels, finer, names, within, quick)
    check_options(options, jobs, threads)
    folder = Path(out) if out is not None else folder_of_study(scene)
    file = write_scene(scene, folder.parent / f"{folder.name}.yaml") if isinstance(scene, Mapping) else Path(scene)
    say = tell or (lambda _: None)
    plan = plan_study(file, set_options(set)[1::2], folder, options, find_program(program))
    say(describe(plan))
    require_within(within, run_study(plan, jobs, threads, launcher, say, warn or (lambda text: say(f"warning: {text}"))))
    return Convergence(folder)


def folder_of_study(scene: Scene) -> Path:
    """The folder for results without `out`: runs/NAME_convergence."""
    folder = default_folder(scene)
    return folder.with_name(f"{folder.name}_convergence")


def plan_study(scene: Path, changes: list[str], folder: Path, options: Options, program: Path) -> Plan:
    """Checks a study; as `plan_levels`.  Raises EnvironmentFailure too if the folder holds other results."""
    plan = plan_levels(scene, changes, folder, options, program)
    if (folder / "summary.json").exists():
        raise EnvironmentFailure(f"{folder} holds the results of a run: choose another folder with --out", 3)
    return plan


def describe(plan: Plan) -> str:
    """The levels and how far they are."""
    return f"{plan.scene}: sizes of cells by a ratio of {plan.options.ratio:.6g}, in {plan.folder}\n{print_levels(plan)}"


def run_study(plan: Plan, jobs: int | None, threads: int | None, launcher: str | None, tell: Tell, warn: Tell) -> list[LevelNumber]:
    """Runs the levels that are not done, writes convergence.csv and convergence.json, and returns the numbers; none of a quick study."""
    plan.folder.mkdir(parents=True, exist_ok=True)
    with only_writer(plan.folder):
        states = _run_levels(plan, jobs, threads, launcher, tell)
        if plan.options.quick:
            warn("quick runs end after a number of steps, so at other times for other cells: their numbers are not compared")
            return []
        numbers = numbers_of(plan, states)
        warnings = [*plan.warnings, *_doubts(plan, states), *complaints(numbers)]
        table = plan.folder / "convergence.csv"
        write_whole(table, convergence_csv(plan, numbers))
        write_whole(plan.folder / "convergence.json", convergence_json(plan, numbers, warnings))
    tell(f"{print_numbers(plan, numbers)}\nchange: between the two finest levels; +-: grid convergence index; both over the finest value\n"
         f"table in {table}")
    for warning in warnings:
        warn(warning)
    return numbers


def _run_levels(plan: Plan, jobs: int | None, threads: int | None, launcher: str | None, tell: Tell) -> list[RunState]:
    """Runs the levels that are not done; returns the states of all, which are done."""
    waiting = [k for k, level in enumerate(plan.levels) if state_of(level).state != DONE]
    # The finest level takes most of the time: one after the other, each with all cores, is quicker than side by side.
    share = divide_cores(jobs, threads, launcher, len(waiting)) if jobs is not None else Share(1, threads)
    queue = RunQueue([(level.folder.name, level) for level in plan.levels], lambda k: state_of(plan.levels[k]), plan.program, share,
                     launcher, tell)
    queue(waiting)
    states = [state_of(level) for level in plan.levels]
    queue.conclude(range(len(states)), lambda k: states[k], "levels", "giving the command again")
    for level, state in zip(plan.levels, states):
        if state.state != DONE:
            raise EnvironmentFailure(f"{level.folder} is not done: another process is at work on it", 3)
    return states


def _doubts(plan: Plan, states: list[RunState]) -> list[str]:
    """Warnings on the results as a whole."""
    warnings = []
    others = [f"{level.folder} by commit {state.commit}" for level, state in zip(plan.levels, states) if state.commit != plan.commit]
    if others:
        warnings.append(f"this program is of commit {plan.commit}, but {', '.join(others)}: remove these folders to run them again")
    ends = [time.value for state in states if (time := of_summary(state.numbers, "simulated_time")) is not None]
    if ends and max(ends) > (1 + _SAME_TIME) * min(ends):
        times = ", ".join(f"{time:.6g}" for time in ends)
        warnings.append(f"the levels end at different times, t = {times} s: last values are not of the same moment")
    return warnings
