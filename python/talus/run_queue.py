"""Runs, some at a time, until all have ended or a signal asks for the end."""
from __future__ import annotations

import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from .child_runs import ChildRuns, Ended, Share
from .errors import EnvironmentFailure, RunFailed
from .program import STOPPED as STOPPED_CODE
from .run_states import DONE, NOT_ENDED, STOPPED, TO_RUN, PlannedRun, RunState, is_at_work, state_of

_SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1)

Tell = Callable[[str], object]


class StoppedRuns(KeyboardInterrupt):
    """Runs were stopped, by a signal or by somebody else, and can go on; the text says how many."""


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


class RunQueue:
    """Runs that are started some at a time.

    runs       each with its name in messages, such as "case 3"
    look_again is called with the number of a run that has ended; returns its state
    share      runs at a time, and threads of each
    launcher   words before the program, such as "mpirun -n 4", or None
    tell       is called with lines of text
    """

    def __init__(self, runs: Sequence[tuple[str, PlannedRun]], look_again: Callable[[int], RunState], program: Path, share: Share,
                 launcher: str | None = None, tell: Tell = lambda _: None) -> None:
        self.runs, self.look_again, self.share, self.tell = runs, look_again, share, tell
        self.signal = ""                     #: that ended the queue
        self.failures: dict[int, str] = {}   #: {number: why}
        self._children = ChildRuns(program, launcher, share.threads)
        self._numbers = {run.folder: number for number, (_, run) in enumerate(runs)}

    def __call__(self, numbers: Iterable[int]) -> None:
        """Runs these until all have ended, or a signal asks for the end: then they write checkpoints."""
        waiting, was_asked = deque(numbers), False
        try:
            with StopRequests() as requests:
                while len(self._children) or (waiting and not requests.received):
                    while waiting and len(self._children) < self.share.jobs and not requests.received:
                        self._start(waiting.popleft())
                    if requests.received and not was_asked:
                        was_asked = True
                        self._children.ask_to_end()
                    ended = self._children.look()
                    self.signal = requests.received
                    for one in ended:
                        self._see_end(one)
        finally:
            self._children.stop()

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

    def _start(self, number: int) -> None:
        name, run = self.runs[number]
        state = state_of(run)  # another process may have run it in the meantime
        if state.state == DONE:
            self.tell(f"{name}: is done")
            return
        if state.state == NOT_ENDED and is_at_work(run):
            self.tell(f"{name}: another process is at work on it")
            return
        try:
            self._children.start(run, state)
        except EnvironmentFailure as error:
            self._fail(number, str(error))
            return
        begins = "begins" if state.goes_on_from is None else f"goes on after t = {state.goes_on_from:.6g} s"
        self.tell(f"{name}: {begins} ({run}{_remark(state)})")

    def _see_end(self, ended: Ended) -> None:
        number = self._numbers[ended.run.folder]
        name, state = self.runs[number][0], self.look_again(number)
        if ended.code == 0 and state.state == DONE:
            self.tell(f"{name}: done after {ended.seconds:.1f} s")
        elif ended.code == STOPPED_CODE:
            self.tell(f"{name}: stopped at t = {state.goes_on_from or 0.0:.6g} s")
        elif self.signal and -ended.code in (signal.SIGTERM, signal.SIGINT):
            self.tell(f"{name}: ended before its first step")
        else:
            self._fail(number, self._children.why(ended, state))

    def _fail(self, number: int, why: str) -> None:
        self.failures[number] = why
        self.tell(f"{self.runs[number][0]}: FAILED, see below")


def _remark(state: RunState) -> str:
    """Why results that are there do not count."""
    if state.goes_on_from is None and state.state in (STOPPED, NOT_ENDED):
        return "; what is there has no checkpoint to go on from"
    return f"; {state.why}" if state.state == TO_RUN and state.why else ""
