"""Runs that another command plans and starts, each in its own process: their input, their state, and those at work."""
from __future__ import annotations

import json
import os
import shlex
import signal
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .checkpoints import Checkpoint
from .errors import EnvironmentFailure, FileError, MissingPackage
from .runs import BEFORE_THE_END

TO_RUN, NOT_ENDED, STOPPED, FAILED, DONE = "to be run", "not ended", "stopped", "failed", "done"
_LOOK = 0.03      # s between looks at the runs
_LAST_LINES = 12  # of what a run said


@dataclass(frozen=True)
class Planned:
    """A run.

    scene    file of the scene
    changes  of the scene, as for --set
    folder   for its results; what it says goes to FOLDER.log
    digest   of the scene with the changes, as in summary.json
    quick    whether it is coarse and short
    """

    scene: Path
    changes: tuple[str, ...]
    folder: Path
    digest: str
    quick: bool = False

    @property
    def log(self) -> Path:
        """The file with what the run says."""
        return self.folder.with_name(self.folder.name + ".log")

    @property
    def command(self) -> str:
        """The command that repeats it, for the shell."""
        words = ["talus", "run", str(self.scene), "--out", str(self.folder), *(["--quick"] if self.quick else [])]
        return shlex.join(words + [word for change in self.changes for word in ("--set", change)])


@dataclass(frozen=True)
class Status:
    """The state of a run according to its folder.

    why      why results that are there do not count; or the message of a run that failed
    resumes  whether there is a checkpoint from which it continues
    """

    state: str
    why: str = ""
    resumes: bool = False


def status_of(run: Planned) -> Status:
    """The state of a run.  Results of another text of the scene or of other changes do not belong to it."""
    path = run.folder / "summary.json"
    if not path.exists():
        return Status(TO_RUN)
    try:
        summary = json.loads(path.read_text(encoding="utf-8"))
        status, message, digest = summary["status"], summary.get("message", ""), summary["scene"]["digest"]
        was_quick = any(stage.get("result") == "quick" for stage in summary["stages"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        return Status(TO_RUN, f"{path} is not the summary of a run: {error}")
    if digest != run.digest:
        return Status(TO_RUN, "its results are of another scene or of other changes")
    if status == "done":
        if was_quick != run.quick:
            return Status(TO_RUN, f"its results are {'not ' if run.quick else ''}of a quick run")
        return Status(DONE)
    if status == "stopped" or message == BEFORE_THE_END:
        return Status(STOPPED if status == "stopped" else NOT_ENDED, resumes=_resumes(run))
    return Status(FAILED, message)


def _resumes(run: Planned) -> bool:
    """Whether the newest checkpoint is sound and of this run."""
    newest = max((run.folder / "checkpoints").glob("step_*.h5"), default=None)
    try:
        if newest is None:
            return False
        with Checkpoint(newest) as saved:
            return bool(int(saved["run/quick"][0])) == run.quick
    except (OSError, FileError, KeyError, MissingPackage):
        return False


@dataclass(frozen=True)
class Share:
    """How many runs there are at a time, and threads of each; None: left to the launcher."""

    jobs: int
    threads: int | None


def cores() -> int:
    """The cores that this process may use; OMP_NUM_THREADS limits them, as it does in the program."""
    limit = os.environ.get("OMP_NUM_THREADS", "").partition(",")[0].strip()
    return max(1, int(limit)) if limit.isdecimal() else len(os.sched_getaffinity(0))


def divide_cores(jobs: int | None, threads: int | None, launcher: str | None, runs: int) -> Share:
    """Divides the cores among so many runs; what is not given follows from what is."""
    side_by_side = jobs or max(1, min(runs, cores() // (threads or 1)))
    return Share(side_by_side, threads if threads or launcher else max(1, cores() // side_by_side))


@dataclass(frozen=True)
class Ended:
    """A run that has ended: its code, negative for a signal, and its wall-clock time [s]."""

    run: Planned
    code: int
    seconds: float


class ChildRuns:
    """The runs at work.

    program   the program talus
    launcher  what each is started by, such as "mpirun -n 4"
    threads   of each; None: chosen by the program or the launcher
    """

    def __init__(self, program: Path, launcher: str | None, threads: int | None) -> None:
        self.program, self.launcher, self.threads = program, launcher, threads
        self._running: list[tuple[Planned, subprocess.Popen[bytes], float]] = []

    def __len__(self) -> int:
        return len(self._running)

    def start(self, run: Planned, status: Status) -> None:
        """Starts a run, or resumes it.  Raises EnvironmentFailure if that is impossible."""
        words = [*(self.launcher or "").split(), str(self.program), "run"]
        if status.resumes:
            words += ["--resume", str(run.folder)]
        else:
            words += [str(run.scene), "--out", str(run.folder), "--force", *(["--quick"] if run.quick else [])]
            words += [word for change in run.changes for word in ("--set", change)]
        words += ["--quiet", *(["--threads", str(self.threads)] if self.threads else [])]
        try:
            with run.log.open("wb") as log:  # a session of its own: Ctrl-C reaches this process alone, which passes it on once
                process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
        except OSError as error:
            hint = f": is there no {words[0]}?" if self.launcher else ""
            raise EnvironmentFailure(f"{run.folder} cannot be started: {error}{hint}", 3) from error
        self._running.append((run, process, time.monotonic()))

    def look(self) -> list[Ended]:
        """Waits a little; returns the runs that have ended."""
        time.sleep(_LOOK)
        ended = [Ended(run, process.returncode, time.monotonic() - begun)
                 for run, process, begun in self._running if process.poll() is not None]
        self._running = [entry for entry in self._running if entry[1].returncode is None]
        return ended

    def stop(self) -> list[Ended]:
        """Asks the runs to write checkpoints and end, and waits for that; returns them."""
        for _, process, _ in self._running:
            process.terminate()
        ended = []
        while self._running:
            ended += self.look()
        return ended

    def why(self, ended: Ended, status: Status) -> str:
        """The reason why a run ended without being done."""
        if ended.code == 0:
            return f"it ran to its end, but {status.why or 'its summary says otherwise'}: was the scene changed meanwhile?"
        if status.state == FAILED:
            return status.why
        if ended.code < 0:
            memory = " (where memory runs out the system kills; --jobs 1 needs less)" if -ended.code == signal.SIGKILL else ""
            again = "; it goes on from its last checkpoint when the command is given again" if status.resumes else ""
            return f"ended by signal {-ended.code}{memory}{again}"
        return last_lines(ended.run.log) or f"ended with {ended.code}"


def last_lines(log: Path) -> str:
    """The end of what a run said."""
    lines: Sequence[Any] = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return "\n    ".join(lines[-_LAST_LINES:])
