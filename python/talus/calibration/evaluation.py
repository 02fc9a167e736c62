"""Runs of a calibration: started several at a time, taken from files where they are done, compared with the observations."""
from __future__ import annotations

import csv
import hashlib
import io
import json
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import FileError, RunFailed, SceneError
from ..packages import need
from ..running import Progress, resume, run
from ..runs import BEFORE_THE_END, Run
from ..scenes import flow
from .files import write_whole
from .observations import NotComparable, Observation
from .places import Problems
from .specification import Specification

Tell = Callable[[str], object]


@dataclass
class Record:
    """A run of a calibration.

    number   counted from 1 in the order in which runs were asked for
    purpose  "start", "difference", "step", "prior", "assimilation 1", "mean"
    values   of the parameters, {key: value}
    folder   with its results, below the folder of the calibration
    status   "to be run", "done" or "failed"
    reused   whether it was done before
    error    why it failed
    commit   of the program
    values_of_run   numbers to compare with the observations, an array for each; empty if it failed
    chi2     sum of the squared residuals over their standard deviations, for each observation
    not_comparable  observations that the run cannot be compared with, each with the reason
    """

    number: int
    purpose: str
    values: dict[str, float]
    folder: Path
    status: str = "to be run"
    reused: bool = False
    error: str = ""
    commit: str = ""
    values_of_run: list[np.ndarray] = field(default_factory=list, repr=False)
    chi2: list[float] = field(default_factory=list)
    not_comparable: list[tuple[Observation, str]] = field(default_factory=list, repr=False)


class Stopped(Exception):
    """Raised in a run to stop it."""


class Evaluation:
    """Residuals of the observations at positions of the parameters.

    spec     what is calibrated
    out      folder of the calibration; runs are in its folder `runs`, under the digests of their inputs
    jobs     runs at a time
    threads  of each run; None: chosen by the program
    tell     is called with a line for each run
    launcher words before the program, such as "mpirun -n 4"
    """

    def __init__(self, spec: Specification, out: Path, jobs: int, threads: int | None, program: Path, tell: Tell,
                 launcher: str | None = None) -> None:
        self.spec, self.out, self.jobs, self.tell = spec, out, jobs, tell
        self._how: dict[str, Any] = {"threads": threads, "launcher": launcher, "program": program}
        self.records: list[Record] = []
        self._by_folder: dict[Path, Record] = {}
        self._inputs = inputs_digest(spec.scene, spec.changes)
        self._stop = threading.Event()

    def __call__(self, positions: Sequence[np.ndarray], purpose: str) -> list[np.ndarray | None]:
        """Residuals over their standard deviations at positions between the bounds, (n,) each; those of priors are the last ones.  None
        where a run failed.  Raises SceneError if no run so far can be compared with the observations."""
        records = [self._record(self.spec.values(position), purpose) for position in positions]
        waiting = list(dict.fromkeys(record.folder for record in records if record.status == "to be run"))
        with ThreadPoolExecutor(self.jobs) as pool:
            futures = [pool.submit(self._run, self._by_folder[folder]) for folder in waiting]
            try:
                self._follow(futures)
            except BaseException:
                self._stop.set()
                for future in futures:
                    future.cancel()
                raise
        write_whole(self.out / "calibration.csv", self.table())
        self._raise_not_comparable()
        return [self._residuals(record, position) for record, position in zip(records, positions)]

    def without_priors(self, positions: Sequence[np.ndarray], purpose: str) -> list[np.ndarray | None]:
        """The residuals of observations alone: the first ensemble has the priors in it."""
        count = sum(len(observation.values) for observation in self.spec.observations)
        return [None if residuals is None else residuals[:count] for residuals in self(positions, purpose)]

    def of(self, position: np.ndarray) -> Record:
        """The run at a position that was evaluated."""
        return self._by_folder[self._folder(self.spec.values(position))]

    def table(self) -> str:
        """The runs as text of a .csv, a row for each."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        names = [observation.name for observation in self.spec.observations]
        writer.writerow(["run", "purpose", *(parameter.key for parameter in self.spec.parameters), "status", "chi2",
                         *(f"chi2_{name}" for name in names), "folder"])
        for record in self.records:
            of_observations = [repr(value) for value in record.chi2] or [""] * len(names)
            whole = repr(float(sum(record.chi2))) if record.chi2 else ""
            writer.writerow([record.number, record.purpose, *map(repr, record.values.values()), record.status, whole, *of_observations,
                             record.folder.relative_to(self.out)])
        return text.getvalue()

    def _changes(self, values: Mapping[str, float]) -> dict[str, Any]:
        return {**self.spec.changes, **values}

    def _folder(self, values: Mapping[str, float]) -> Path:
        words = [self._inputs, *(f"{key}={flow(value)}" for key, value in self._changes(values).items())]
        return self.out / "runs" / hashlib.sha256("\n".join(words).encode()).hexdigest()[:16]

    def _record(self, values: dict[str, float], purpose: str) -> Record:
        folder = self._folder(values)
        if folder not in self._by_folder:
            self._by_folder[folder] = Record(len(self.records) + 1, purpose, values, folder)
            self.records.append(self._by_folder[folder])
        return self._by_folder[folder]

    def _follow(self, futures: Sequence[Future[None]]) -> None:
        wait(futures, return_when=FIRST_EXCEPTION)
        for future in futures:
            if future.done():
                future.result()

    def _run(self, record: Record) -> None:
        """Runs one, or takes its results if they are there; it has failed where the program says so, and where it cannot be compared."""
        if self._stop.is_set():
            return
        summary = _summary(record.folder)
        record.reused = summary.get("status") == "done"
        try:
            if not record.reused:
                self._start(record, summary)
        except RunFailed as error:
            record.status, record.error = "failed", str(error)
            self.tell(f"run {record.number} ({record.purpose}) FAILED: {error}")
            return
        results = Run(record.folder)
        record.commit = results.summary.get("program", {}).get("commit", "")
        self._compare(record, results)
        told = "is done" if record.reused else f"took {results.summary['cost']['wall [s]']:.1f} s"
        shown = ", ".join(f"{key} {value:.6g}" for key, value in record.values.items())
        result = f"chi squared {sum(record.chi2):.4g}" if record.chi2 else f"cannot be compared: {record.error}"
        self.tell(f"run {record.number} ({record.purpose}) {told}: {shown}: {result}")

    def _start(self, record: Record, summary: Mapping[str, Any]) -> None:
        """Starts a run, or continues one that was stopped or killed after a checkpoint."""
        was_interrupted = summary.get("status") == "stopped" or summary.get("message") == BEFORE_THE_END
        if was_interrupted and any((record.folder / "checkpoints").glob("step_*.h5")):
            try:
                return self._check_ended(resume(record.folder, progress=self._look, **self._how))
            except SceneError:
                pass  # a checkpoint of another version of the program
        record.folder.parent.mkdir(parents=True, exist_ok=True)
        return self._check_ended(run(self.spec.scene, set=self._changes(record.values), out=record.folder, force=True, progress=self._look,
                                     **self._how))

    def _check_ended(self, ended: Run) -> None:
        if ended.status != "done":
            raise Stopped

    def _look(self, _: Progress) -> None:
        if self._stop.is_set():
            raise Stopped

    def _compare(self, record: Record, results: Run) -> None:
        """Compares a run with all observations; it has failed if that cannot be done, such as for a deposit without a rim."""
        found, wrong = [], []
        for observation in self.spec.observations:
            try:
                found.append(observation.of_run(results))
            except (NotComparable, FileError) as error:
                wrong.append((observation, str(error)))
        record.not_comparable, record.error = wrong, "; ".join(text for _, text in wrong)
        if not wrong:
            record.values_of_run = found
            record.chi2 = [float(np.sum(((values - observation.values) / observation.deviations) ** 2))
                           for observation, values in zip(self.spec.observations, found)]
        record.status = "failed" if wrong else "done"

    def _raise_not_comparable(self) -> None:
        """Raises SceneError with what no run could be compared with, at its place in the file; does nothing once a run could."""
        if any(record.status == "done" for record in self.records):
            return
        problems = Problems(self.spec.file)
        for observation, text in (entry for record in self.records for entry in record.not_comparable):
            problems.add(observation.entry.line, observation.entry.column, observation.entry.key, f"cannot be compared: {text}")
            if len({message.key for message in problems.messages}) < len(problems.messages):
                problems.messages.pop()  # another run said the same
        problems.raise_any()

    def _residuals(self, record: Record, position: np.ndarray) -> np.ndarray | None:
        if record.status != "done":
            return None
        parts = [(values - observation.values) / observation.deviations
                 for observation, values in zip(self.spec.observations, record.values_of_run)]
        priors = [(position[k] - parameter.prior[0]) / parameter.prior[1]
                  for k, parameter in enumerate(self.spec.parameters) if parameter.prior is not None]
        return np.concatenate([*parts, priors])


def _summary(folder: Path) -> dict[str, Any]:
    """The summary of a run; empty if there is none, or a damaged one."""
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def inputs_digest(scene: Path, changes: Mapping[str, Any]) -> str:
    """A digest of the text of a scene and of the files that it or its changes name, relative to its folder."""
    text = scene.read_bytes()
    digest = hashlib.sha256(text)
    for name in sorted({*_words(_loaded(text)), *_words(changes)}):
        file = scene.parent / name
        if file.is_file():
            digest.update(name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def _loaded(text: bytes) -> Any:
    yaml = need("yaml", "reads YAML files")
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError:
        return None  # the program says what is wrong


def _words(value: Any) -> list[str]:
    if isinstance(value, Mapping):
        return [word for entry in value.values() for word in _words(entry)]
    if isinstance(value, list):
        return [word for entry in value for word in _words(entry)]
    return [value] if isinstance(value, str) and 0 < len(value) < 256 and "\0" not in value and "\n" not in value else []
