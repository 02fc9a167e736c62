"""Functions for all benchmarks: runs of talus, readers of their results, error measures, results and figures.

A benchmark is a folder with scene.yaml, README.md, its reference values and case.py; `evaluate(lab)` in case.py returns results.
Units are SI, as in the scenes.
"""
import concurrent.futures
import csv
import dataclasses
import functools
import hashlib
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading

import matplotlib
import matplotlib.figure
import matplotlib.ticker
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))

import talus  # noqa: E402

matplotlib.use("Agg")

matplotlib.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False, "figure.constrained_layout.use": True})
METHODS = {  # for sweeps, the default first; linear with tpic inverts particles
    f"{kernel}, {scheme}": {"kernel": kernel, "transfer.scheme": scheme}
    for kernel, scheme in (("projected", "aflip"), ("umls", "tpic"), ("umls", "flip"), ("umls", "apic"), ("linear", "flip"))}
METHODS["umls, exact_force, aflip"] = {"kernel": "umls", "umls.gradient": "exact_force", "transfer.scheme": "aflip"}
CHOICES = METHODS | {  # and those that sweeps leave out
    "projected, saflip": {"kernel": "projected", "transfer.scheme": "saflip"},
    "projected, extended, aflip": {"kernel": "projected", "projected.surfaces": "extended", "transfer.scheme": "aflip"}}
SUITED = {"umls": "tpic", "linear": "flip", "projected": "aflip"}  # kernel -> suitable transfer
OTHER_KERNELS = {"umls": "aflip", "linear": "flip"}  # beside the default, with their transfer: linear with aflip inverts particles where bodies meet
OVERRIDES = {"kernel": "kernel", "transfer": "transfer.scheme"}  # option of the command line -> key of the scene


class RunFailed(RuntimeError):
    """A run that failed, with the message of the program."""


class Run:
    """A run, perhaps still under way: whoever asks it for something waits for its end, and gets RunFailed where it ended badly.

    `history` maps a column (without its unit) to an array, `summary` is summary.json, `seconds` processor time, `memory` the largest resident set [B].
    """

    def __init__(self, case, label, folder, future):
        self.case, self.label, self._folder, self._future = case, label, pathlib.Path(folder), future

    @property
    def seconds(self):
        return self._future.result()

    @property
    def folder(self):
        self._future.result()
        return self._folder

    @functools.cached_property
    def history(self):
        return talus.Run(self.folder).history

    @functools.cached_property
    def summary(self):
        return talus.Run(self.folder).summary

    @property
    def particles(self):
        return sum(body["particles"] for body in self.summary["bodies"])

    @property
    def cells(self):
        return self.summary["mesh"]["cells"]

    @property
    def memory(self):
        return self.summary["cost"]["peak_memory [B]"]

    @functools.cached_property
    def frames(self):
        """Particle files in order of time as a talus.Series; empty if the scene writes none."""
        return talus.Run(self.folder).particles if (self.folder / "particles.pvd").exists() else []

    def last_frame(self):
        """Fields of the last particle file by name; 'position' has the shape (n, 3)."""
        return self.frames[-1]

    @property
    def ending(self):
        """Exit status and words of the program: (0, "") but where the run may fail and did."""
        path = self.folder / "ending.json"
        return tuple(json.loads(path.read_text(encoding="utf-8"))) if path.exists() else (0, "")

    def failure(self):
        """Waits for the end of the run; returns the message of a failed run, or None."""
        try:
            self._future.result()
        except RunFailed as failed:
            return str(failed)
        return None


class Search(Run):
    """A search of `talus fos`, with all its runs; as a run it is its trial with the highest factor that holds."""

    @functools.cached_property
    def found(self):
        """fos.json."""
        return json.loads((self.folder / "fos.json").read_text(encoding="utf-8"))

    def trial(self, factor):
        """The run with the strength divided by `factor`, one of those of `found`."""
        name = next(trial["folder"] for trial in self.found["trials"] if trial["factor"] == factor)
        return Run(self.case, f"{self.label}/{name}", self._folder / name, self._future)

    @functools.cached_property
    def _holds(self):
        return self.trial(self.found["highest_that_holds"])

    @property
    def history(self):
        return self._holds.history

    @property
    def summary(self):
        return self._holds.summary

    @property
    def frames(self):
        return self._holds.frames


@dataclasses.dataclass
class Result:
    """One measured number. `criterion`: 'at most' or 'at least' the tolerance; 'within' it of the reference, relative; 'near' it, in the
    unit of the value; or 'reported', without a verdict."""

    case: str
    metric: str
    unit: str
    value: float
    criterion: str
    tolerance: float | None
    reference: float | None
    source: str
    run: Run

    @property
    def passed(self):
        """True or False, or None without a criterion.  A number that is not finite never passes."""
        if self.criterion == "reported":
            return None
        checks = {"at most": lambda: self.value <= self.tolerance, "at least": lambda: self.value >= self.tolerance,
                  "within": lambda: abs(self.value - self.reference) <= self.tolerance * abs(self.reference),
                  "near": lambda: abs(self.value - self.reference) <= self.tolerance}
        return bool(np.isfinite(self.value) and checks[self.criterion]())

    def record(self):
        """The entry of verify.json; a value that is not finite is null."""
        own = {key: plain(getattr(self, key)) for key in ("case", "metric", "unit", "value", "reference", "source", "criterion", "tolerance")}
        summary = self.run.summary
        return {**own, "pass": self.passed, "mesh": f"{self.run.cells} cells", "particles": self.run.particles, "kernel": summary["kernel"],
                "transfer": summary["transfer"], "processor_seconds": self.run.seconds, "peak_memory [B]": self.run.memory,
                "threads": summary["cost"]["threads"], "commit": summary["program"]["commit"]}


@dataclasses.dataclass
class Tradeoff:
    """What `talus tradeoff` sweeps: `axes` {name: {label: settings}}, the first label of each axis being the customary choice, the first axis that of
    the cells; error(run) in `unit` ('-': of one, shown in per cent). `what` names the error."""

    scene: str
    axes: dict
    error: object
    what: str
    settings: dict = dataclasses.field(default_factory=dict)


class Lab:
    """Runs scenes with one program and collects what cases find; with `reuse`, a run with the same program and inputs is not repeated.

    `jobs` runs go on at a time. `overrides` {key of the scene: word} apply to each run whose settings do not choose that key themselves.
    """

    def __init__(self, program, runs, images, level="quick", reuse=False, threads=1, jobs=1, overrides=None):
        self.program, self.runs, self.images = pathlib.Path(program), pathlib.Path(runs), pathlib.Path(images)
        self.level, self.reuse, self.threads, self.overrides = level, reuse, threads, overrides or {}
        self._program_key = hashlib.sha256(self.program.read_bytes()).hexdigest()
        self._pool = concurrent.futures.ThreadPoolExecutor(jobs)
        self._lock, self._drawing = threading.Lock(), threading.Lock()
        self._handles = {}  # (case, label) -> inputs, run
        self.figures, self.orders = [], []

    def fos(self, scene, label, settings, **options):
        """As run(), of `talus fos` with options such as width=0.05; returns a Search."""
        words = [word for key, value in options.items() for word in (f"--{key}", str(value))]
        return self.run(scene, label, settings, command=("fos", "--jobs", "1", "--no-pictures", *words))

    def run(self, scene, label, settings, may_fail=False, command=("run",)):
        """Starts `scene` (path below benchmarks/) into <runs>/<case>/<label> with settings {key: number, list or text}, as --set takes them.

        Returns at once; the run waits its turn and whoever asks it for something waits for it. So ask for all runs first, then measure.
        Where it `may_fail`, an exit status that the program promises (1 to 3) is an `ending` like any other; what it wrote until then is there.
        """
        path = ROOT / "benchmarks" / scene
        case, out = path.parent.name, self.runs / path.parent.name / label
        words = [f"{key}={value if isinstance(value, str) else json.dumps(value)}" for key, value in overridden(settings, self.overrides).items()]
        texts = [file.read_text(encoding="utf-8") for file in [path, *sorted(path.parent.glob("*.geo"))]]
        inputs = json.dumps([self._program_key, texts, words, self.threads, *command[1:]])
        with self._lock:
            known, handle = self._handles.get((case, label), (None, None))
            if handle and known != inputs:
                raise ValueError(f"two different runs are called {case}/{label}")
            if not handle:
                handle = (Search if command[0] == "fos" else Run)(case, label, out, self._pool.submit(self._work, path, out, words, inputs, may_fail, command))
                self._handles[case, label] = inputs, handle
        return handle

    def runs_of(self, case):
        """All runs of a case, in the order of their start."""
        with self._lock:
            return [run for (owner, _), (_, run) in self._handles.items() if owner == case]

    def close(self):
        """Cancels the runs that have not started."""
        self._pool.shutdown(cancel_futures=True)

    def _work(self, path, out, words, inputs, may_fail, command):
        """Starts the run, or finds the results of an earlier run with the same input; returns the processor time [s]."""
        stamp = out / "inputs.json"
        seconds = self._seconds_of(stamp, inputs)
        if seconds is None:
            seconds = self._start(path, out, words, may_fail, command)
            stamp.write_text(json.dumps({"inputs": inputs, "seconds": seconds}), encoding="utf-8")
        print(f"  {path.parent.name}/{out.name}: {seconds:.1f} s", flush=True)
        return seconds

    def _seconds_of(self, stamp, inputs):
        """The processor time [s] of an earlier run with the same input, or None if there is none."""
        if not (self.reuse and stamp.exists()):
            return None
        known = json.loads(stamp.read_text(encoding="utf-8"))
        return known["seconds"] if known["inputs"] == inputs else None

    def _start(self, scene, out, words, may_fail, command):
        """Runs the program; returns its processor time [s], which depends less on other work of the machine than wall time."""
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        line = [self.program, command[0], scene, "--out", out, "--threads", str(self.threads), "--quiet", *command[1:]]
        for word in words:
            line += ["--set", word]
        with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
            child = subprocess.Popen(line, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0)
            said = output.read().strip()
        for folder in {self.runs, self.runs.resolve(), ROOT}:  # messages must be equal on all machines
            said = said.replace(f"{folder}/", "")
        if may_fail and child.returncode in (1, 2, 3):
            (out / "ending.json").write_text(json.dumps([child.returncode, said]), encoding="utf-8")
            return usage.ru_utime + usage.ru_stime
        if child.returncode != 0:
            raise RunFailed(f"{scene.parent.name}/{out.name} ended with {child.returncode}: {said}")
        left = "fos.json" if command[0] == "fos" else "summary.json"
        if not (out / left).exists():
            raise RunFailed(f"{scene.parent.name}/{out.name} ended with 0 and left no {left} in {out}: {said}")
        return usage.ru_utime + usage.ru_stime

    def figure(self, case, name, draw, size=(6.4, 3.6), caption="", shown="everywhere"):
        """Saves what draw(figure) draws as <images>/<name>.png and notes it for the reports; with shown='report', for the pages of the run alone."""
        with self._drawing:
            figure = matplotlib.figure.Figure(figsize=size)
            draw(figure)
            self.images.mkdir(parents=True, exist_ok=True)
            figure.savefig(self.images / f"{name}.png", dpi=110)
            self.figures.append({"case": case, "file": f"{name}.png", "caption": caption, "shown": shown})

    def convergence(self, case, name, sizes, errors, expected=None):
        """Notes errors over sizes of cells [m] for a table with the observed order between neighbours and over all."""
        self.orders.append({"case": case, "name": name, "sizes": [plain(size) for size in sizes], "errors": [plain(error) for error in errors],
                            "orders": [plain(order) for order in neighbours(sizes, errors)], "order": plain(observed_order(sizes, errors)),
                            "expected": expected})


class OtherKernel:
    """A lab at the quick level whose runs have another kernel with its transfer; they may fail."""

    level = "quick"

    def __init__(self, lab, kernel):
        self._lab, self._kernel = lab, kernel

    def run(self, scene, label, settings):
        return self._lab.run(scene, f"{label}_{self._kernel}", {**settings, "kernel": self._kernel, "transfer.scheme": OTHER_KERNELS[self._kernel]}, may_fail=True)


def with_other_kernels(lab, start):
    """At the full level, reported results with the other kernels: start(lab) starts runs and returns pairs of a run and a function that measures it."""
    pairs = [(kernel, *pair) for kernel in OTHER_KERNELS for pair in start(OtherKernel(lab, kernel))] if lab.level == "full" else []
    results = []
    for kernel, run, measure in pairs:
        if run.ending[0]:
            results.append(Result(run.case, f"time at which the run failed, {run.label}", "s", float(run.history["time"][-1]), "reported", None, None, "", run))
        else:
            results += [dataclasses.replace(result, metric=f"{result.metric}, {kernel}", criterion="reported", tolerance=None) for result in measure()]
    return results


def overridden(settings, overrides):
    """`settings` with those `overrides` whose key, or a block around it, is not set in `settings`."""
    return {**{key: word for key, word in overrides.items() if key not in settings and key.split(".")[0] not in settings}, **settings}


def mesh_name(size, higher):
    """What results with cells of `size` [m] are called, where the room is `higher` [m] than that of the scene, so that gmsh makes other triangles."""
    return f"cells of {size} m" + (f", room higher by {higher} m" if higher else "")


def plain(value):
    """A number of numpy as a Python number, or None if it is not finite: JSON has neither."""
    if isinstance(value, (float, np.floating)):
        return float(value) if np.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


def reference(case, name="reference.json"):
    """The reference data of a case: a .json as it is, a .csv as {column: array} ('#' starts a comment)."""
    path = ROOT / "benchmarks" / case / name
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        return json.loads(text)
    rows = [line for line in text.splitlines() if line and not line.startswith("#")]
    values = np.array([[float(cell) for cell in row] for row in csv.reader(rows[1:])])
    return {name: values[:, i] for i, name in enumerate(rows[0].split(","))}


def module(case, name="case"):
    """The module case.py of a benchmark, or another of its Python files."""
    spec = importlib.util.spec_from_file_location(f"{name}_{case}", ROOT / "benchmarks" / case / f"{name}.py")
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def label(name):
    """The name of a result as the name of a folder."""
    return re.sub(r"[^\w.-]+", "_", name)


def ends(runs):
    """Of {key: run} those that end well, so that a method that fails somewhere does not take the results of others with it: its run is a result that failed."""
    return {key: run for key, run in runs.items() if not run.failure()}


def ended(run, measure):
    """The measured value of a run; nan if the run failed."""
    return measure(run) if run.ending[0] == 0 else float("nan")


def rms(values):
    """Root mean square over all entries."""
    return float(np.sqrt(np.mean(np.square(values))))


def observed_order(sizes, errors):
    """Order of convergence: slope of log(error) over log(size) by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def neighbours(sizes, errors):
    """Observed order between each size and the next."""
    return [float(np.log(errors[i] / errors[i + 1]) / np.log(sizes[i] / sizes[i + 1])) for i in range(len(sizes) - 1)]


def size_axis(axis, sizes):
    """Sets ticks of a logarithmic axis at the sizes of cells only."""
    axis.set_xscale("log")
    axis.set_xticks(sizes, [f"{size:g}" for size in sizes])
    axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.set_xlabel("cell size [m]")


def draw_pressing_stress(figure, runs, data):
    """Draws the stress -xx over data["pressure [Pa]"] at the particles, one panel for each of the `runs` by name."""
    for axis, (name, run) in zip(figure.subplots(1, len(runs), sharey=True), runs.items()):
        frame = run.last_frame()
        dots = axis.scatter(frame["position"][:, 0], frame["position"][:, 1], c=-frame["stress"][:, 0] / data["pressure [Pa]"], s=4, vmin=0.8, vmax=1.2, cmap="coolwarm")
        axis.set(title=name, aspect="equal", xlabel="x [m]")
    figure.colorbar(dots, label="pressing stress over the exact one")
