"""Runs of the program: started, followed while they compute, resumed."""
from __future__ import annotations

import contextlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

from .program import STOPPED, call, error_of, facts_of, find_program
from .runs import Run
from .scenes import HEADING, Scene, set_options, to_yaml, write_scene

_INTERVAL = 0.2  # s between looks at progress.json, which a run writes about once a second
_BAR = 30        # characters


@dataclass(frozen=True)
class Progress:
    """How far a run has come."""

    stage: str          #: name of the stage
    done: float         #: simulated time of all stages so far [s]
    total: float        #: simulated time of all stages in total [s]
    time: float         #: simulated time of the run [s]
    dt: float           #: length of the last step [s]
    step: int           #: number of steps
    elapsed: float      #: wall-clock time of this process [s]
    done_before: float  #: simulated time that was done when this process began [s]

    @property
    def fraction(self) -> float:
        """Share of the simulated time that is done, from 0 to 1."""
        return min(self.done / self.total, 1.0) if self.total > 0 else 0.0

    @property
    def remaining(self) -> float:
        """Wall-clock time that the rest takes at the speed so far [s]; nan before the first step."""
        here = self.done - self.done_before
        return self.elapsed * max(self.total - self.done, 0.0) / here if here > 0 else float("nan")


ProgressOption = Union[bool, Callable[[Progress], object], None]


def run(scene: Scene, *, set: Mapping[str, Any] | None = None, out: str | os.PathLike[str] | None = None, threads: int | None = None,
        progress: ProgressOption = None, quick: bool = False, strict: bool = False, force: bool = False, until: int | None = None,
        script: str | os.PathLike[str] | None = None, launcher: str | None = None,
        program: str | os.PathLike[str] | None = None) -> Run:
    """Runs a scene to its end and returns its results.

    scene     path of a scene file; or a scene as a dictionary, which is written to the file OUT.yaml beside the folder OUT (see
              `to_yaml`)
    set       changes of the scene: {"time.end": 2, "bodies[0].velocity": [1, 0]}
    out       folder for the results; default as in the program, runs/NAME; NAME is made of the title if the scene is a dictionary
    threads   number of threads; default what the scene says, or as many as pay for its particles
    progress  True draws a bar on the standard error; a function is called with a `Progress` about once a second and at the end.
              An exception of the function stops the run as Ctrl-C does and is passed on
    quick     coarse and short: only to see that the scene runs
    strict    balances that do not close are an error
    force     replaces a run that was stopped or has failed and could be resumed
    until     stops after this number of steps with a checkpoint; the status is then "stopped"
    script    file with functions start, step, history and end, which the run calls between its steps; what it prints is in `Run.log`
    launcher  words before the program, such as "mpirun -n 4"
    program   the program talus; default: `find_program`

    Raises SceneError for wrong input, with the place of each error, RunFailed if the run fails, EnvironmentFailure for a full disk or a
    folder that must not be replaced, FileExistsError if OUT.yaml is a file of yours, and FileNotFoundError without the program.
    Ctrl-C lets the run finish its step and write a checkpoint, for `resume`; then KeyboardInterrupt is raised.
    """
    found = find_program(program)
    folder = Path(out) if out is not None else default_folder(scene)
    file = write_scene(scene, folder.parent / f"{folder.name}.yaml") if isinstance(scene, Mapping) else Path(scene)
    words = ["run", str(file), "--out", str(folder), *set_options(set), *_options(threads, quick=quick, strict=strict, force=force)]
    if script is not None:
        words += ["--script", str(Path(script).absolute())]
    words += ["--until", str(until)] if until is not None else []
    return _follow([*shlex.split(launcher or ""), str(found), *words], folder, progress)


def resume(run: Run | str | os.PathLike[str], *, set: Mapping[str, Any] | None = None, out: str | os.PathLike[str] | None = None,
           threads: int | None = None, progress: ProgressOption = None, until: int | None = None, launcher: str | None = None,
           program: str | os.PathLike[str] | None = None) -> Run:
    """Continues a run that was stopped, from its newest checkpoint, and returns its results.

    run   the run, its folder, or one of its checkpoints
    set   changes that a resumed run may have, such as {"stages[0].duration": 60}
    out   folder for the later results; default the folder of the run

    Other arguments and errors are those of `run`.
    """
    begin = run.folder if isinstance(run, Run) else Path(run)
    folder = Path(out) if out is not None else begin if begin.is_dir() else begin.parent.parent
    words = ["run", "--resume", str(begin), *(["--out", str(out)] if out is not None else []), *set_options(set), *_options(threads)]
    words += ["--until", str(until)] if until is not None else []
    return _follow([*shlex.split(launcher or ""), str(find_program(program)), *words], folder, progress)


def check(scene: Scene, *, set: Mapping[str, Any] | None = None, program: str | os.PathLike[str] | None = None) -> str:
    """What `talus check` says of a scene and its mesh: counts, steps, memory and disk that a run would take.  Nothing is written.

    scene, set  as in `run`

    Raises SceneError, which has the place of each error.
    """
    with _as_file(scene) as file:
        return call(["check", str(file), *set_options(set)], program)


def facts(scene: Scene, *, set: Mapping[str, Any] | None = None, program: str | os.PathLike[str] | None = None) -> dict[str, Any]:
    """What a scene consists of, as the program checks it: `stages` by name and type; `bodies` with their laws in each stage, particles,
    extent along `up` and wave speed; `mesh`; `gravity [m/s^2]`; all `keys` with their changes.  Nothing is written.

    scene, set  as in `run`

    Raises SceneError, which has the place of each error.
    """
    with _as_file(scene) as file:
        return facts_of(file, set_options(set)[1::2], program=program)


@contextlib.contextmanager
def _as_file(scene: Scene) -> Iterator[Path]:
    """The file of a scene; of a dictionary one that is removed when the block ends."""
    if not isinstance(scene, Mapping):
        yield Path(scene)
        return
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", prefix="talus_scene_", encoding="utf-8") as file:
        file.write(HEADING + to_yaml(scene))
        file.flush()
        yield Path(file.name)


def default_folder(scene: Scene) -> Path:
    """The folder for results without `out`: that of the program (app/observers/results.cpp), or one with the name of the title."""
    if isinstance(scene, Mapping):
        return Path("runs") / (re.sub(r"\W+", "_", str(scene.get("title", ""))).strip("_").lower() or "scene")
    path = Path(scene)
    folder = path.absolute().parent.name
    return Path("runs") / (folder if path.name == "scene.yaml" and folder else path.stem)


def _options(threads: int | None, **switches: bool) -> list[str]:
    named = [f"--{name}" for name, on in switches.items() if on]
    return named + (["--threads", str(threads)] if threads is not None else [])


def _follow(words: Sequence[str], folder: Path, progress: ProgressOption) -> Run:
    """Runs a command that writes results and reports its progress."""
    tell = _Bar() if progress is True else progress or None
    began = time.time_ns()
    with tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as complained:
        # A session of its own: Ctrl-C reaches this process alone, which passes it on once; the second one would end the run at once
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=said, stderr=complained, start_new_session=True)
        try:
            last: Progress | None = None
            while (code := _wait(process)) is None:
                now = _progress_of(folder, began) if tell else None
                if tell and now is not None and now != last:
                    tell(now)
                    last = now
        except BaseException:
            process.terminate()
            process.wait()
            raise
        finally:
            if isinstance(tell, _Bar):
                tell.close()
        log, complaints = (_text(file) for file in (said, complained))
    run = Run(folder, log=log) if (folder / "summary.json").exists() else None
    if code not in (0, STOPPED) or run is None:
        raise error_of(code, complaints, log, run=run if code == 1 else None)
    if tell and code == 0:
        tell(_end_of(run, last))
        if isinstance(tell, _Bar):
            tell.close()
    return run


def _wait(process: subprocess.Popen[bytes]) -> int | None:
    try:
        return process.wait(_INTERVAL)
    except subprocess.TimeoutExpired:
        return None


def _text(file: Any) -> str:
    file.seek(0)
    return file.read().decode("utf-8", "replace")


def _progress_of(folder: Path, since: int) -> Progress | None:
    """The contents of progress.json; None if this run has not written it yet."""
    path = folder / "progress.json"
    try:
        if path.stat().st_mtime_ns < since:
            return None  # of a run that was killed
        values = json.loads(path.read_text(encoding="utf-8"))
        return Progress(values["stage"], values["done [s]"], values["total [s]"], values["time [s]"], values["dt [s]"], values["step"],
                        values["elapsed [s]"], values["done_before [s]"])
    except (OSError, ValueError, KeyError):
        return None


def _end_of(run: Run, last: Progress | None) -> Progress:
    summary = run.summary
    total = last.total if last else summary["simulated_time [s]"]
    return Progress(summary["stages"][-1]["name"], total, total, summary["simulated_time [s]"], last.dt if last else float("nan"),
                    summary["steps"], summary["cost"]["wall [s]"], last.done_before if last else 0.0)


class _Bar:
    """A bar on the standard error, on one line that is drawn again."""

    def __init__(self) -> None:
        self._open = False

    def __call__(self, now: Progress) -> None:
        filled = round(_BAR * now.fraction)
        left = f", {now.remaining:.0f} s left" if now.remaining > 0 else ""
        text = f"[{'#' * filled}{' ' * (_BAR - filled)}] {100 * now.fraction:3.0f} %  t = {now.time:.4g} s, step {now.step}{left}"
        sys.stderr.write(f"\r{text:<100}")
        sys.stderr.flush()
        self._open = True

    def close(self) -> None:
        if self._open:
            sys.stderr.write("\n")
            self._open = False
