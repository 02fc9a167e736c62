"""The search for a factor of safety in its folder: runs, verdicts, files."""
from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..calibration.evaluation import Stopped
from ..calibration.files import write_whole
from ..child_runs import ChildRuns, Ended, divide_cores
from ..errors import EnvironmentFailure, RunFailed
from ..program import STOPPED as STOPPED_ON_REQUEST
from ..run_states import DONE, FAILED, PlannedRun, state_of
from ..runs import Run
from ..tables import Table, csv_text, number_text
from .plan import RUN, STATIC, Plan
from .search import FAILS, HOLDS, UNCLEAR, Bracket, Motion, Range, Trial, bracket_of, judge, motion_of, next_factors

_LONGEST = 2         # a trial without a clear verdict is repeated, so many times as long
_MOST_AT_A_TIME = 4  # default: n trials divide the bracket by n + 1, so more of them save little time
_RUN_FAILED = 1      # exit code of a run that failed by its physics

Tell = Callable[[str], object]


@dataclass(frozen=True)
class _Try:
    """A factor to run, and its duration over the usual one."""

    factor: float
    times: int
    run: PlannedRun


class Search:
    """A search in its folder; `trials` are judged so far, in the order of their factors.

    jobs, threads, launcher  as in `factor_of_safety`
    tell                     is called with a line for each run
    """

    def __init__(self, plan: Plan, asked: Range, jobs: int | None, threads: int | None, launcher: str | None, tell: Tell) -> None:
        self.plan, self.asked, self.tell = plan, asked, tell
        self.trials: list[Trial] = []
        self._share = divide_cores(jobs, threads, launcher, _MOST_AT_A_TIME)
        self._alone = ChildRuns(plan.program, launcher, threads)  # of one run, which has all cores
        self._runs = ChildRuns(plan.program, launcher, self._share.threads)
        self._made: dict[float, PlannedRun] = {}
        self._broken_off = broken_off(plan.folder / "fos.json")   # digests of trials that failed by their physics

    def __call__(self) -> None:
        """Runs the search.  Raises RunFailed, EnvironmentFailure, Stopped; after an exception such as KeyboardInterrupt the runs have
        written checkpoints."""
        try:
            self._find_rest()
            self._look_for_trials()
            while factors := next_factors(self.trials, self.asked, self._share.jobs):
                self._try(factors)
                self.write_files()
        except BaseException:
            self._alone.stop()
            for ended in self._runs.stop():
                if ended.code == 0:
                    self.tell(f"{ended.run.folder.name}: done after {ended.seconds:.1f} s")
            raise
        self.write_files()

    @property
    def bracket(self) -> Bracket:
        """What the trials enclose."""
        return bracket_of(self.trials)

    @property
    def factor(self) -> float | None:
        """The middle of the bracket; None until it is narrow."""
        low, high = self.bracket.low, self.bracket.high
        return (low + high) / 2 if low is not None and high is not None and self.bracket.is_narrow(self.asked.width) else None

    def table(self) -> str:
        """The trials as text for the terminal."""
        rows = [f"{'factor':>10}  {'verdict':<8} {'growth':>9} {self._second_measure:>13} {'moved [m]':>11} {'time [s]':>9}"]
        for trial in self.trials:
            motion = trial.motion
            numbers = [f"{motion.growth:.3g}", _second_of(motion), f"{motion.moved:.4g}", f"{motion.duration:.4g}"] if motion else ["-"] * 4
            row = f"{trial.factor:>10.6g}  {trial.verdict:<8} {numbers[0]:>9} {numbers[1]:>13} {numbers[2]:>11} {numbers[3]:>9}"
            if trial.by_growth_alone:
                row += "  by growth alone: the measures contradict each other"
            rows.append(row + (f"  the run broke off: {trial.message.splitlines()[0]}" if trial.message else ""))
        return "\n".join(rows)

    def write_files(self) -> None:
        """Writes fos.csv and fos.json."""
        rows = [["factor", "verdict", "moved [m]", "growth", "kinetic_over_peak", "duration [s]", "by_growth_alone", "steadiness",
                 "message"]]
        for trial in self.trials:
            motion = trial.motion
            measures = [motion.moved, motion.growth, motion.liveliness, motion.duration] if motion else [None] * 4
            rows.append([number_text(trial.factor), trial.verdict, *map(number_text, measures), str(int(trial.by_growth_alone)),
                         number_text(motion.steadiness if motion else None), trial.message])
        write_whole(self.plan.folder / "fos.csv", csv_text(rows))
        write_whole(self.plan.folder / "fos.json", json.dumps(self._contents(), indent=2, ensure_ascii=False) + "\n")

    def _contents(self) -> dict[str, Any]:
        plan, bracket = self.plan, self.bracket
        summary = Run(plan.at_rest.folder).summary
        return {"scene": str(plan.scene), "commit": summary.get("program", {}).get("commit", ""), "factor_of_safety": self.factor,
                "highest_that_holds": bracket.low, "lowest_that_fails": bracket.high, "hold_above_that": bracket.out_of_order,
                "width": self.asked.width, "bodies": list(plan.bodies),
                "criterion": {"growth": plan.criterion.growth, "kinetic_over_peak": plan.criterion.liveliness,
                              "steadiness": plan.criterion.steadiness, "settlement [m]": plan.before.settlement,
                              "height [m]": plan.before.height},
                "trials": [self._entry(trial) for trial in self.trials]}

    def _entry(self, trial: Trial) -> dict[str, Any]:
        motion, run = trial.motion, self._made[trial.factor]
        measures = (motion.moved, motion.growth, motion.liveliness, motion.steadiness, motion.duration) if motion else [None] * 5
        names = ("moved [m]", "growth", "kinetic_over_peak", "steadiness", "duration [s]")
        return {"factor": trial.factor, "verdict": trial.verdict,
                **{name: value if value is not None and math.isfinite(value) else None for name, value in zip(names, measures)},
                "by_growth_alone": trial.by_growth_alone, "message": trial.message, "folder": run.folder.name,
                "scene_digest": run.scene_digest, "command": run.command}

    @property
    def _second_measure(self) -> str:
        return "steadiness" if self.plan.kind == STATIC else "kinetic/peak"

    def _find_rest(self) -> None:
        rest = self.plan.at_rest
        status = state_of(rest)
        if status.state == DONE:
            return self.tell(f"at rest: done before, in {rest.folder}")
        self.tell(f"at rest: {'goes on' if status.goes_on_from is not None else 'begins'} in {rest.folder}")
        self._alone.start(rest, status)
        ended: list[Ended] = []
        while not ended:
            ended = self._alone.look()
        now = state_of(rest)
        if ended[0].code == 0 and now.state == DONE:
            return self.tell(f"at rest: done after {ended[0].seconds:.1f} s")
        self._refuse_stopped(ended[0])
        text = f"the state at rest was not found: {self._alone.why(ended[0], now)}"
        raise RunFailed(text, 1) if ended[0].code == _RUN_FAILED else EnvironmentFailure(text, 3)

    @staticmethod
    def _refuse_stopped(ended: Ended) -> None:
        if ended.code == STOPPED_ON_REQUEST:
            raise Stopped(f"{ended.run.folder} was told to stop")

    def _look_for_trials(self) -> None:
        """Reads the trials of an earlier search."""
        factors = []
        for folder in self.plan.folder.glob("trial_*"):
            try:
                if (folder / "summary.json").exists():
                    factors.append(float(folder.name.removeprefix("trial_")))
            except ValueError:
                pass  # a folder that is not one of this search
        for factor in sorted(factors):
            for times in (_LONGEST, 1):
                if self._judge(_Try(factor, times, self.plan.trial(factor, times))):
                    break
        if self.trials:
            self.tell(f"{len(self.trials)} trial{'s' if len(self.trials) > 1 else ''} judged before")

    def _judge(self, one: _Try) -> Trial | None:
        """Judges an existing run; returns the verdict, which is added to the trials, if there is one."""
        status = state_of(one.run)
        trial = None
        if status.state == FAILED and one.run.scene_digest in self._broken_off:
            trial = Trial(one.factor, FAILS, message=status.why)
        elif status.state == DONE:
            motion = motion_of(Table(one.run.folder / "history.csv"), self.plan.columns, self.plan.before)
            verdict = judge(motion, self.plan.criterion) if motion else UNCLEAR
            is_last = one.times == _LONGEST or one.run.quick
            if motion and verdict == UNCLEAR and is_last:
                trial = Trial(one.factor, FAILS if motion.growth > self.plan.criterion.growth else HOLDS, motion, by_growth_alone=True)
            elif motion and verdict != UNCLEAR:
                trial = Trial(one.factor, verdict, motion)
        if trial is not None:
            self._made[one.factor] = one.run
            self.trials = sorted([*self.trials, trial], key=lambda known: known.factor)
        return trial

    def _try(self, factors: Sequence[float]) -> None:
        waiting = deque(_Try(factor, 1, self.plan.trial(factor, 1)) for factor in factors)
        started: dict[Path, _Try] = {}
        while waiting or len(self._runs):
            while waiting and len(self._runs) < self._share.jobs:
                one = waiting.popleft()
                status = state_of(one.run)
                self._runs.start(one.run, status)
                what = "as it is" if one.factor == 1 else f"strength divided by {one.factor:.6g}"
                self.tell(f"{one.factor:.6g}: {'goes on' if status.goes_on_from is not None else 'begins'} ({what})")
                started[one.run.folder] = one
            for ended in self._runs.look():
                waiting.extend(self._see_end(started[ended.run.folder], ended))

    def _see_end(self, one: _Try, ended: Ended) -> list[_Try]:
        """Judges a run that has ended, or returns the same one with twice the duration."""
        self._refuse_stopped(ended)
        status = state_of(one.run)
        if ended.code == _RUN_FAILED and status.state == FAILED:
            self._broken_off.add(one.run.scene_digest)
        elif ended.code != 0:
            raise EnvironmentFailure(f"the trial of {one.factor:.6g} did not run: {self._runs.why(ended, status)}", 3)
        trial = self._judge(one)
        if trial is not None:
            motion = trial.motion
            measures = f" (growth {motion.growth:.3g}, {self._second_measure} {_second_of(motion)})" if motion else ""
            self.tell(f"{one.factor:.6g}: {trial.verdict} after {ended.seconds:.1f} s{measures}")
            return []
        if status.state != DONE or one.times == _LONGEST:
            raise EnvironmentFailure(f"the trial of {one.factor:.6g} left no history to judge it by in {one.run.folder}", 3)
        longer = 2 * one.times
        unit = " s" if self.plan.kind == RUN else " increments"
        length = number_text(longer * self.plan.duration)
        self.tell(f"{one.factor:.6g}: unclear, the measures contradict each other; begins anew, {length}{unit} long")
        return [_Try(one.factor, longer, self.plan.trial(one.factor, longer))]


def broken_off(path: Path) -> set[str]:
    """Digests of the trials in fos.json whose run failed; none if there is no such file."""
    try:
        trials = json.loads(path.read_text(encoding="utf-8"))["trials"]
        return {trial["scene_digest"] for trial in trials if trial["message"]}
    except (OSError, ValueError, KeyError, TypeError):
        return set()


def _second_of(motion: Motion) -> str:
    return f"{motion.liveliness:.2e}" if motion.liveliness is not None else f"{motion.steadiness or 0:.3g}"
