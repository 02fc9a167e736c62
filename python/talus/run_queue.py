"""Runs in processes of their own, some at a time, until all have ended or a signal asks for the end."""
from __future__ import annotations

import os
import shlex
import signal
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .errors import RunFailed
from .program import STOPPED as STOPPED_CODE
from .run_states import DONE, FAILED, NOT_ENDED, STOPPED, TO_RUN, PlannedRun, RunState, is_at_work, state_of

_INTERVAL = 0.03  # s between looks at the processes
_LINES = 12       # of the output of a run that failed
_SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1)
_NOT_STARTED, _OF_SIGNAL = 127, 128  # as shells and launchers say that there is no program, and that a signal ended it

Tell = Callable[[str], object]


class StoppedRuns(KeyboardInterrupt):
    """Runs were stopped, by a signal or by somebody else, and can go on; the text says how many."""


def divide_cores(jobs: int | None, threads: int | None, runs: int, *, has_launcher: bool) -> tuple[int, int | None]:
    """The number of runs at a time, and of threads of each, None if the launcher decides: what is not given follows from the cores."""
    word = os.environ.get("OMP_NUM_THREADS", "").split(",")[0]
    cores = int(word) if word.isdecimal() and int(word) > 0 else len(os.sched_getaffinity(0))
    at_a_time = jobs if jobs is not None else max(1, min(runs, cores // (threads or 1)))
    return at_a_time, threads if threads is not None or has_launcher else max(1, cores // at_a_time)


class StopRequests:
    """While it is open, SIGTERM, SIGINT and SIGUSR1 are noted, in `received`, instead of ending this process; a second SIGINT ends it.
    Without effect in threads, which get no signals."""

    def __init__(self) -> None:
        self.received = ""
        self._before: dict[int, Any] = {}

    def _note(self, number: int, _: Any) -> None:
        if number == signal.SIGINT and self.received == "SIGINT":
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            signal.raise_signal(signal.SIGINT)
        self.received = signal.Signals(number).name

    def __enter__(self) -> StopRequests:
        if threading.current_thread() is threading.main_thread():
            self._before = {number: signal.signal(number, self._note) for number in _SIGNALS}
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)


@dataclass
class _Running:
    number: int
    process: subprocess.Popen[bytes]
    begun: float


@dataclass
class RunQueue:
    """Runs that are started some at a time.

    scene      of all runs
    runs       each with its name in messages, such as "case 3"
    look_again is called with the number of a run that has ended; returns its state
    jobs       runs at a time
    threads    of each; None: chosen by the launcher
    launcher   words before the program, such as "mpirun -n 4", or None
    """

    scene: Path
    runs: Sequence[tuple[str, PlannedRun]]
    look_again: Callable[[int], RunState]
    program: Path
    jobs: int
    threads: int | None
    launcher: str | None = None
    quick: bool = False
    tell: Tell = lambda _: None
    signal: str = field(default="", init=False)                       #: that ended the queue
    failures: dict[int, str] = field(default_factory=dict, init=False)  #: {number: why}
    _running: list[_Running] = field(default_factory=list, init=False)

    def __call__(self, numbers: Iterable[int]) -> None:
        """Runs these until all have ended, or a signal asks for the end: then they write checkpoints."""
        waiting, was_asked = deque(numbers), False
        try:
            with StopRequests() as requests:
                while self._running or (waiting and not requests.received):
                    while waiting and len(self._running) < self.jobs and not requests.received:
                        self._start(waiting.popleft())
                    if requests.received and not was_asked:
                        was_asked = True
                        self._ask_to_end()
                    time.sleep(_INTERVAL)
                    self.signal = requests.received
                    self._look()
        finally:
            self._ask_to_end()
            for one in self._running:
                one.process.wait()

    def conclude(self, numbers: Sequence[int], state: Callable[[int], RunState], several: str, again: str) -> None:
        """Raises RunFailed if some of these failed, StoppedRuns if some were stopped.

        several, again  words for messages, such as "cases" and "running the sweep again"
        """
        states = [state(number).state for number in numbers]
        done, stopped = states.count(DONE), states.count(STOPPED)
        ending = f"of {len(numbers)} {several} {done} done, {stopped} stopped with a checkpoint; go on by {again}"
        if self.signal and done < len(numbers):
            raise StoppedRuns(f"stopped by {self.signal}: {ending}")
        if self.failures:
            lines = [f"  {self.runs[number][0]} ({self.runs[number][1]}): {why}" for number, why in sorted(self.failures.items())]
            raise RunFailed("\n".join([f"{len(lines)} of {len(numbers)} {several} failed; {again} repeats them", *lines]), 1)
        if stopped:
            raise StoppedRuns(ending)

    def _ask_to_end(self) -> None:
        for one in self._running:
            one.process.terminate()

    def _start(self, number: int) -> None:
        name, run = self.runs[number]
        state = state_of(run, quick=self.quick)  # another process may have run it in the meantime
        if state.state == DONE:
            self.tell(f"{name}: is done")
            return
        if state.state == NOT_ENDED and is_at_work(run):
            self.tell(f"{name}: another process is at work on it")
            return
        words = [*shlex.split(self.launcher or ""), str(self.program), "run"]
        if state.goes_on_from is not None:
            words += ["--resume", str(run.folder)]
        else:
            words += [str(self.scene), "--out", str(run.folder), "--force"]
            words += [word for change in run.changes for word in ("--set", change)]
            words += ["--quick"] if self.quick else []
        words += ["--quiet", *(["--threads", str(self.threads)] if self.threads is not None else [])]
        run.folder.parent.mkdir(parents=True, exist_ok=True)
        with _log(run).open("wb") as log:
            try:
                process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
            except OSError as error:
                self._end(number, _NOT_STARTED, 0.0, str(error))
                return
        self._running.append(_Running(number, process, time.monotonic()))
        begins = "begins" if state.goes_on_from is None else f"goes on after t = {state.goes_on_from:.6g} s"
        self.tell(f"{name}: {begins} ({run}{_remark(state)})")

    def _look(self) -> None:
        for one in list(self._running):
            if (code := one.process.poll()) is not None:
                self._running.remove(one)
                self._end(one.number, code if code <= _OF_SIGNAL else _OF_SIGNAL - code, time.monotonic() - one.begun)

    def _end(self, number: int, code: int, seconds: float, why: str = "") -> None:
        name, run = self.runs[number]
        state = self.look_again(number)
        if code == 0 and state.state == DONE:
            self.tell(f"{name}: done after {seconds:.1f} s")
        elif code == STOPPED_CODE:
            self.tell(f"{name}: stopped at t = {state.goes_on_from or 0.0:.6g} s")
        elif self.signal and -code in (signal.SIGTERM, signal.SIGINT):
            self.tell(f"{name}: ended before its first step")
        else:
            self.failures[number] = self._why(run, code, state, why)
            self.tell(f"{name}: FAILED, see below")

    def _why(self, run: PlannedRun, code: int, state: RunState, why: str) -> str:
        if code == 0:
            return f"it ran to its end, but {state.why or 'its summary says otherwise'}: was the scene changed meanwhile?"
        if state.state == FAILED:
            return state.why
        if code < 0:
            memory = " (where memory runs out the system kills; --jobs 1 needs less)" if -code == signal.SIGKILL else ""
            later = "; it goes on from its last checkpoint when the command is given again" if state.goes_on_from is not None else ""
            return f"ended by signal {-code}{memory}{later}"
        said = why or "\n    ".join(_log(run).read_text(encoding="utf-8", errors="replace").splitlines()[-_LINES:])
        if code == _NOT_STARTED:
            return f"cannot be started{f': is there no {self.launcher}?' if self.launcher else ''}" + (f"\n    {said}" if said else "")
        return said or f"ended with {code}"


def _log(run: PlannedRun) -> Path:
    return run.folder.with_name(run.folder.name + ".log")


def _remark(state: RunState) -> str:
    """Why results that are there do not count."""
    if state.goes_on_from is None and state.state in (STOPPED, NOT_ENDED):
        return "; what is there has no checkpoint to go on from"
    return f"; {state.why}" if state.state == TO_RUN and state.why else ""
