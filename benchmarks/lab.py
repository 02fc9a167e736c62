"""What every benchmark needs: runs of talus, readers of what they wrote, measures of error, results and figures.

A benchmark is a folder with scene.yaml, README.md, its reference values and case.py; `evaluate(lab)` in case.py returns results.
Units are SI, as in the scenes.
"""
import csv
import dataclasses
import hashlib
import json
import pathlib
import resource
import subprocess

import matplotlib
import matplotlib.ticker
import numpy as np

import vtp

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False, "figure.constrained_layout.use": True})


@dataclasses.dataclass
class Run:
    """A finished run: `history` maps a column (without its unit) to an array, `summary` is summary.json, `seconds` processor time."""

    folder: pathlib.Path
    history: dict
    summary: dict
    seconds: float

    @property
    def particles(self):
        return sum(body["particles"] for body in self.summary["bodies"])

    @property
    def cells(self):
        return self.summary["mesh"]["cells"]

    def frames(self):
        """Particle files in order of time."""
        return sorted(self.folder.glob("particles_*.vtp"))

    def last_frame(self):
        """Arrays of the last particle file by name; 'Points' are the positions, shape (n, 3)."""
        return vtp.read(self.frames()[-1])


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
        """True, False, or None where nothing is judged. A number that is not finite never passes."""
        if self.criterion == "reported":
            return None
        checks = {"at most": lambda: self.value <= self.tolerance, "at least": lambda: self.value >= self.tolerance,
                  "within": lambda: abs(self.value - self.reference) <= self.tolerance * abs(self.reference),
                  "near": lambda: abs(self.value - self.reference) <= self.tolerance}
        return bool(np.isfinite(self.value) and checks[self.criterion]())

    def record(self):
        """What results.json holds of it."""
        own = {key: getattr(self, key) for key in ("case", "metric", "unit", "value", "reference", "source", "criterion", "tolerance")}
        return {**own, "pass": self.passed, "mesh": f"{self.run.cells} cells", "particles": self.run.particles,
                "processor_seconds": self.run.seconds, "threads": self.run.summary["cost"]["threads"],
                "commit": self.run.summary["program"]["commit"]}


class Lab:
    """Runs scenes with one program and collects results; with `reuse`, a run with the same program and inputs is not repeated."""

    def __init__(self, program, runs, images, level="quick", reuse=False, threads=1):
        self.program, self.runs, self.images = pathlib.Path(program), pathlib.Path(runs), pathlib.Path(images)
        self.level, self.reuse, self.threads = level, reuse, threads
        self._program_key = hashlib.sha256(self.program.read_bytes()).hexdigest()
        self.figures = {}

    def run(self, scene, label, settings):
        """Runs `scene` (path below benchmarks/) into <runs>/<case>/<label> with settings {key: number, list or text}, as --set takes them.

        Raises RuntimeError with the program's own words when it fails.
        """
        path = ROOT / "benchmarks" / scene
        out = self.runs / path.parent.name / label
        words = [f"{key}={value if isinstance(value, str) else json.dumps(value)}" for key, value in settings.items()]
        inputs = json.dumps([self._program_key, path.read_text(encoding="utf-8"), words, self.threads])
        stamp = out / "inputs.json"
        seconds = self._seconds_of(stamp, inputs)
        if seconds is None:
            seconds = self._start(path, out, words)
            stamp.write_text(json.dumps({"inputs": inputs, "seconds": seconds}), encoding="utf-8")
        run = Run(out, read_history(out / "history.csv"), json.loads((out / "summary.json").read_text(encoding="utf-8")), seconds)
        print(f"  {path.parent.name}/{label}: {run.cells} cells, {run.particles} particles, {run.seconds:.1f} s", flush=True)
        return run

    def _seconds_of(self, stamp, inputs):
        """What the run of the same inputs took, or None where there is none to use again."""
        if not (self.reuse and stamp.exists()):
            return None
        known = json.loads(stamp.read_text(encoding="utf-8"))
        return known["seconds"] if known["inputs"] == inputs else None

    def _start(self, scene, out, words):
        """Runs the program; returns the processor time it took [s], which a busy machine changes less than that of the clock."""
        out.mkdir(parents=True, exist_ok=True)
        for old in [*out.glob("particles_*"), *out.glob("inputs.json")]:
            old.unlink()
        command = [self.program, "run", scene, "--out", out, "--threads", str(self.threads), "--quiet"]
        for word in words:
            command += ["--set", word]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            raise RuntimeError(f"{scene.parent.name}/{out.name} ended with {done.returncode}:\n{done.stderr or done.stdout}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def figure(self, case, name, draw, size=(6.4, 3.6), caption=""):
        """Saves what draw(figure) draws as <images>/<name>.png and notes it for the report."""
        figure = plt.figure(figsize=size)
        draw(figure)
        self.images.mkdir(parents=True, exist_ok=True)
        figure.savefig(self.images / f"{name}.png", dpi=110)
        plt.close(figure)
        self.figures.setdefault(case, []).append((f"{name}.png", caption))


def read_history(path):
    """Columns of a history.csv by name without unit; a last row cut short is left out."""
    text = path.read_text(encoding="utf-8")
    rows = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))
    values = np.array([[float(cell) for cell in row] for row in rows[1:]])
    return {name.split(" [")[0]: values[:, i] for i, name in enumerate(rows[0])}


def reference(case, name="reference.json"):
    """The reference data of a case: a .json as it is, a .csv as {column: array} ('#' starts a comment)."""
    path = ROOT / "benchmarks" / case / name
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        return json.loads(text)
    rows = [line for line in text.splitlines() if line and not line.startswith("#")]
    values = np.array([[float(cell) for cell in row] for row in csv.reader(rows[1:])])
    return {name: values[:, i] for i, name in enumerate(rows[0].split(","))}


def rms(values):
    """Root of the mean square over everything."""
    return float(np.sqrt(np.mean(np.square(values))))


def observed_order(sizes, errors):
    """Slope of log(error) over log(size) by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def size_axis(axis, sizes):
    """Ticks of a logarithmic axis at the sizes of cells and nowhere else."""
    axis.set_xscale("log")
    axis.set_xticks(sizes, [f"{size:g}" for size in sizes])
    axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.set_xlabel("cell size [m]")
