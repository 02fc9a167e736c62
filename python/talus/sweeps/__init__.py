"""Parameter studies: a scene with several values of its keys, and a table of the results.

    study = talus.sweep("study.yaml", jobs=4)
    study.to_pandas()[["materials[0].friction_angle", "toe"]]
"""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..child_runs import divide_cores
from ..errors import EnvironmentFailure, SceneError
from ..program import find_program
from ..run_queue import RunQueue
from ..run_states import DONE, NOT_ENDED, RunState, is_at_work
from ..runs import Sweep
from ..scenes import write_scene
from .checks import Plan, check_cases, plan_sweep
from .findings import Findings
from .study import read_study
from .table import SweepTable

__all__ = ["default_folder", "list_cases", "sweep"]

Tell = Callable[[str], object]


def default_folder(study: Path) -> Path:
    """The folder for results without `out`: runs/NAME, or for a `study.yaml` runs/ and the name of its folder with `_study`."""
    folder = study.absolute().parent.name
    return Path("runs") / (f"{folder}_study" if study.name == "study.yaml" and folder else study.stem)


def sweep(study: str | os.PathLike[str] | Mapping[str, Any], *, out: str | os.PathLike[str] | None = None, jobs: int | None = None,
          threads: int | None = None, case: int | None = None, launcher: str | None = None, quick: bool = False, pictures: bool = True,
          tell: Tell | None = None, warn: Tell | None = None, program: str | os.PathLike[str] | None = None) -> Sweep:
    """Runs the cases of a study that are not done yet, and returns its table and findings.

    study     path of the file (.yaml) that names the scene and what varies (docs/guide/parameter_studies.md); or a dictionary with these
              keys, which is written to OUT.yaml; give the scene as a `pathlib.Path` then
    out       folder of cases and table; default `default_folder`, for a dictionary runs/study
    jobs      cases at a time; default as many as there are cores for
    threads   of each; default the cores over the cases at a time
    case      this case alone, counted from 1
    launcher  words before the program, such as "mpirun -n 4"
    quick     coarse and short cases: only to see that they run
    pictures  whether pictures are drawn, which needs matplotlib
    tell      is called with lines of text: progress, the table, findings
    warn      is called with warnings; default `tell`, after "warning: "
    program   the program talus; default: `find_program`

    Needs PyYAML, for samples and findings SciPy, and h5py where a case was stopped.  Raises SceneError with all errors of all cases, at
    their places, before anything runs; RunFailed, which names the cases that failed, when the others have run and the table is written;
    EnvironmentFailure for a folder with other results.  Ctrl-C, and SIGTERM and SIGUSR1, let the cases write checkpoints and raise
    `StoppedRuns`, a KeyboardInterrupt; the same call goes on.
    """
    say = tell or (lambda _: None)
    plan = _plan(study, out, quick, program)
    chosen = _chosen(plan, case)
    check_cases(plan, chosen)
    table = SweepTable(plan)
    table.update()
    left = [i for i in chosen if table.states[i].state != DONE]
    share = divide_cores(1 if case is not None else jobs, threads, launcher, len(left))
    words = f" with {share.threads} thread{'' if share.threads == 1 else 's'} each" if share.threads is not None else ""
    say(f"{plan.study.file}: {len(left)} of {len(chosen)} case{'' if len(chosen) == 1 else 's'} of {plan.study.scene} to be run in "
        f"{plan.folder}, {share.jobs} at a time{words}")

    def look_again(i: int) -> RunState:
        table.update()
        return table.states[i]

    queue = RunQueue([(f"case {i + 1}", one) for i, one in enumerate(plan.cases)], look_again, plan.program, share, launcher, say)
    queue(left)
    table.update()
    say(f"{table.print()}table in {plan.folder / 'sweep.csv'}")
    _conclude(plan, table, pictures and not queue.signal, say, warn or (lambda text: say(f"warning: {text}")))
    queue.conclude(chosen, lambda i: table.states[i], "cases", "running the sweep again")
    return Sweep(plan.folder)


def list_cases(study: str | os.PathLike[str], *, out: str | os.PathLike[str] | None = None, quick: bool = False, tell: Tell, warn: Tell,
               program: str | os.PathLike[str] | None = None) -> None:
    """Tells the cases of a study and how far they are, runs nothing, and writes table and findings again if there is something."""
    plan = _plan(study, out, quick, program)
    check_cases(plan, [i for i, one in enumerate(plan.cases) if (one.folder / "summary.json").exists()], models=False)
    table = SweepTable(plan)
    if plan.folder.exists():
        table.update()
    tell(table.print().rstrip("\n"))
    for i, (one, state) in enumerate(zip(plan.cases, table.states)):
        if state.state == NOT_ENDED and is_at_work(one):
            tell(f"case {i + 1}: is running")
        elif state.why:
            tell(f"case {i + 1}: {state.why}")
    if plan.folder.exists():
        _conclude(plan, table, False, tell, warn)


def _plan(study: str | os.PathLike[str] | Mapping[str, Any], out: str | os.PathLike[str] | None, quick: bool,
          program: str | os.PathLike[str] | None) -> Plan:
    found = find_program(program)
    if isinstance(study, Mapping):
        folder = Path(out) if out is not None else Path("runs") / "study"
        file = write_scene(study, folder.parent / f"{folder.name}.yaml")
    else:
        file = Path(study)
        folder = Path(out) if out is not None else default_folder(file)
    plan = plan_sweep(read_study(file), folder, quick=quick, program=found)
    if (folder / "summary.json").exists():
        raise EnvironmentFailure(f"{folder} holds the results of a run: choose another folder with --out", 3)
    return plan


def _chosen(plan: Plan, case: int | None) -> list[int]:
    count = len(plan.cases)
    if case is not None and not 1 <= case <= count:
        raise SceneError(f"there is no case {case}: {plan.study.file} has {count}", 2)
    return [case - 1] if case is not None else list(range(count))


def _conclude(plan: Plan, table: SweepTable, pictures: bool, tell: Tell, warn: Tell) -> None:
    """Findings and remarks below the table."""
    findings = Findings(plan, table, pictures)
    for line in findings.text:
        tell(line)
    other: dict[str, list[int]] = {}
    for i, state in enumerate(table.states):
        if state.state == DONE and state.commit != plan.commit:
            other.setdefault(state.commit, []).append(i + 1)
    commits = [f"this program is of commit {plan.commit}; case {', '.join(map(str, numbers))} by commit {commit}: remove their folders to "
               "run them again" for commit, numbers in other.items()]
    known = {one.folder.name for one in plan.cases}
    strays = [f"{path} is of no case of this study" for path in sorted(plan.folder.glob("case_*"))
              if path.is_dir() and path.name not in known]
    for warning in [*plan.study.warnings, *findings.warnings, *commits, *table.unknown_names(), *strays]:
        warn(warning)
