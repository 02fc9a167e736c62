"""Runs of a scene that a command makes, each in a folder of its own: how far they are, according to their files."""
from __future__ import annotations

import fcntl
import json
import os
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from .checkpoints import CHECKPOINT_FORMATS, Checkpoint
from .errors import FileError, Missing
from .runs import BEFORE_THE_END

TO_RUN, NOT_ENDED, STOPPED, FAILED, DONE = "to be run", "not ended", "stopped", "failed", "done"


@dataclass
class PlannedRun:
    """A scene with changes, and the results folder.

    changes       key=value, as for --set
    scene_digest  of the present scene with these changes, as in summary.json
    mesh_digest   of the present mesh; empty if it was not computed
    quick         whether it is coarse and short
    """

    scene: Path
    changes: Sequence[str]
    folder: Path
    scene_digest: str = ""
    mesh_digest: str = ""
    quick: bool = False

    def __str__(self) -> str:
        return ", ".join(self.changes) or "the scene as it is"

    @property
    def log(self) -> Path:
        """The file with the output of the run."""
        return self.folder.with_name(self.folder.name + ".log")

    @property
    def command(self) -> str:
        """The command that repeats it, for the shell."""
        changes = [word for change in self.changes for word in ("--set", change)]
        return shlex.join(["talus", "run", str(self.scene), "--out", str(self.folder), *(["--quick"] if self.quick else []), *changes])


class Number(NamedTuple):
    """A result of a run."""

    value: float
    unit: str  #: empty for a pure number


@dataclass(frozen=True)
class RunState:
    """How far a run is.

    state           one of TO_RUN, NOT_ENDED, STOPPED, FAILED, DONE
    why             why results in its folder do not count, or the message of a run that failed
    goes_on_from    time of its newest checkpoint [s]
    commit          of the program that made its results
    numbers         {name: number} of summary.json, with the names of all keys above, such as "balances.energy.terms.plastic"
    """

    state: str = TO_RUN
    why: str = ""
    goes_on_from: float | None = None
    commit: str = ""
    mesh_digest: str = ""
    numbers: dict[str, Number] = field(default_factory=dict, repr=False)


def state_of(run: PlannedRun) -> RunState:
    """The state of a run.  Results of another scene, of other changes or of another mesh, if its digest is known, do not count."""
    path = run.folder / "summary.json"
    if not path.exists():
        return RunState()
    try:
        summary = json.loads(path.read_text(encoding="utf-8"))
        scene, mesh = summary["scene"].get("digest", ""), summary["mesh"].get("digest", "")
        was_quick = any(stage.get("result") == "quick" for stage in summary["stages"])
        status, message, commit = summary.get("status", ""), summary.get("message", ""), summary["program"].get("commit", "")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        return RunState(why=f"{path} is not the summary of a run: {error}")
    if scene != run.scene_digest:
        return RunState(why="its results are of another scene or of other changes")
    if run.mesh_digest and mesh != run.mesh_digest:
        return RunState(why="its results are of another mesh")
    if status == DONE and was_quick != run.quick:
        return RunState(why="its results are not of a quick run" if run.quick else "its results are of a quick run")
    if status == DONE:
        return RunState(DONE, commit=commit, mesh_digest=mesh, numbers=dict(_numbers(summary, "", "")))
    if status == STOPPED or message == BEFORE_THE_END:
        time = _time_kept(run)
        return RunState(STOPPED if status == STOPPED else NOT_ENDED, goes_on_from=time, commit=commit, mesh_digest=mesh)
    return RunState(FAILED, message, commit=commit, mesh_digest=mesh)


def _numbers(value: Any, path: str, unit: str) -> Iterator[tuple[str, Number]]:
    """All numbers below a value of summary.json; null is a number that was not finite."""
    if isinstance(value, dict):
        for key, entry in value.items():
            name, mark, of_key = key.rpartition(" [")
            is_named = bool(mark) and key.endswith("]")
            whole = f"{path}.{name if is_named else key}" if path else name if is_named else key
            yield from _numbers(entry, whole, of_key[:-1] if is_named else "")
    elif isinstance(value, list):
        for k, entry in enumerate(value):
            yield from _numbers(entry, f"{path}[{k}]", unit)
    elif value is None or isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, Number(float("nan") if value is None else float(value), unit)


def _time_kept(run: PlannedRun) -> float | None:
    """The time of the newest checkpoint of this run [s], or None."""
    for path in sorted((run.folder / "checkpoints").glob("step_*.h5"), reverse=True):
        try:
            with Checkpoint(path) as kept:
                if kept.format != CHECKPOINT_FORMATS[-1]:
                    continue
                changes = [kept.text(f"run/set/{k}") for k in range(int(kept["run/set/count"][0]))]
                mesh = f"{int(kept['run/mesh'][0]) % 2**64:016x}"
                is_same = changes == list(run.changes) and bool(kept["run/quick"][0]) == run.quick and run.mesh_digest in ("", mesh)
                return kept.time if is_same else None
        except (OSError, FileError, Missing, ValueError):
            continue  # the program passes over damaged ones too
    return None


def is_at_work(run: PlannedRun) -> bool:
    """Whether another process writes to the folder, as far as the file system supports locks."""
    try:
        handle = os.open(run.folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    finally:
        os.close(handle)
    return False
