"""Runs of the program in processes of their own: how many at a time, starting them, waiting for them, and why one was not done."""
from __future__ import annotations

import os
import shlex
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from .errors import EnvironmentFailure
from .run_states import FAILED, PlannedRun, RunState

_INTERVAL = 0.03  # s between looks at the processes
_LINES = 12       # of the output of a run that failed
_OF_SIGNAL = 128  # a launcher adds it to the number of a signal that ended the program


@dataclass(frozen=True)
class Share:
    """How many runs there are at a time, and threads of each; None: left to the launcher."""

    jobs: int
    threads: int | None


def divide_cores(jobs: int | None, threads: int | None, launcher: str | None, runs: int) -> Share:
    """Divides the cores among so many runs; what is not given follows from what is.  OMP_NUM_THREADS limits the cores, as in the program."""
    word = os.environ.get("OMP_NUM_THREADS", "").partition(",")[0].strip()
    cores = int(word) if word.isdecimal() and int(word) > 0 else len(os.sched_getaffinity(0))
    at_a_time = jobs or max(1, min(runs, cores // (threads or 1)))
    return Share(at_a_time, threads if threads or launcher else max(1, cores // at_a_time))


@dataclass(frozen=True)
class Ended:
    """A run that has ended: its code, negative for a signal, and its wall-clock time [s]."""

    run: PlannedRun
    code: int
    seconds: float


class ChildRuns:
    """The runs at work.

    program   the program talus
    launcher  words before it, such as "mpirun -n 4"
    threads   of each; None: chosen by the program or the launcher
    """

    def __init__(self, program: Path, launcher: str | None, threads: int | None) -> None:
        self.program, self.launcher, self.threads = program, launcher, threads
        self._running: list[tuple[PlannedRun, subprocess.Popen[bytes], float]] = []

    def __len__(self) -> int:
        return len(self._running)

    def start(self, run: PlannedRun, state: RunState) -> None:
        """Starts a run, or continues it where there is a checkpoint.  Raises EnvironmentFailure if that is impossible."""
        words = [*shlex.split(self.launcher or ""), str(self.program), "run"]
        if state.goes_on_from is not None:
            words += ["--resume", str(run.folder)]
        else:
            words += [str(run.scene), "--out", str(run.folder), "--force", *(["--quick"] if run.quick else [])]
            words += [word for change in run.changes for word in ("--set", change)]
        words += ["--quiet", *(["--threads", str(self.threads)] if self.threads is not None else [])]
        run.folder.parent.mkdir(parents=True, exist_ok=True)
        try:
            with run.log.open("wb") as log:  # a session of its own: Ctrl-C reaches this process alone, which passes it on once
                process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        except OSError as error:
            hint = f": is there no {words[0]}?" if self.launcher else ""
            raise EnvironmentFailure(f"{run.folder} cannot be started{hint} ({error})", 3) from error
        self._running.append((run, process, time.monotonic()))

    def look(self) -> list[Ended]:
        """Waits a little; returns the runs that have ended."""
        time.sleep(_INTERVAL)
        ended = [Ended(run, code if code <= _OF_SIGNAL else _OF_SIGNAL - code, time.monotonic() - begun)
                 for run, process, begun in self._running if (code := process.poll()) is not None]
        self._running = [entry for entry in self._running if entry[1].returncode is None]
        return ended

    def ask_to_end(self) -> None:
        """Asks the runs to write checkpoints and end."""
        for _, process, _ in self._running:
            process.terminate()

    def stop(self) -> list[Ended]:
        """Asks the runs to end, and waits for that; returns them."""
        self.ask_to_end()
        ended = []
        while self._running:
            ended += self.look()
        return ended

    def why(self, ended: Ended, state: RunState) -> str:
        """The reason why a run ended without being done."""
        if ended.code == 0:
            return f"it ran to its end, but {state.why or 'its summary says otherwise'}: was the scene changed meanwhile?"
        if state.state == FAILED:
            return state.why
        if ended.code < 0:
            memory = " (where memory runs out the system kills; --jobs 1 needs less)" if -ended.code == signal.SIGKILL else ""
            later = "; it goes on from its last checkpoint when the command is given again" if state.goes_on_from is not None else ""
            return f"ended by signal {-ended.code}{memory}{later}"
        said = "\n    ".join(ended.run.log.read_text(encoding="utf-8", errors="replace").splitlines()[-_LINES:])
        return said or f"ended with {ended.code}"
