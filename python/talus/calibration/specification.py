"""The file of a calibration: which parameters of a scene are sought, from which observations, and how."""
from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .observations import Observation, read_observation
from .places import Block, Entry, Problems, read_yaml

METHODS = ("gauss_newton", "ensemble")
SCALES = ("linear", "log")
STEP = 0.05  # of the range between the bounds: measured, see docs/guide/calibration.md
_KEY = re.compile(r"[a-z]\w*(?:\[\d+\])?(?:\.[a-z]\w*(?:\[\d+\])?)*")


@dataclass(frozen=True)
class Parameter:
    """A key of the scene whose value is sought.  Methods work with its position between the bounds, from 0 to 1: equally spaced values, or
    with the scale `log` equally spaced logarithms."""

    key: str      #: as for --set, such as "materials[0].cohesion"
    start: float  #: value with which the search begins, in the unit of the scene, as are `low` and `high`
    low: float
    high: float
    scale: str    #: "linear" or "log"
    step: float   #: of the differences, as a share of the range
    prior: tuple[float, float] | None  #: what is known without the observations: position between the bounds, and its standard deviation

    @property
    def range(self) -> float:
        """high - low, or the logarithm of their ratio."""
        return np.log(self.high / self.low) if self.scale == "log" else self.high - self.low

    def position(self, value: float) -> float:
        """Where a value lies between the bounds, from 0 to 1."""
        return (np.log(value / self.low) if self.scale == "log" else value - self.low) / self.range

    def value(self, position: float) -> float:
        """The value at a position between the bounds."""
        if self.scale == "log":
            return float(self.low * np.exp(position * self.range))
        return float(self.low + position * self.range)


@dataclass(frozen=True)
class Search:
    """Settings of the methods."""

    method: str = "gauss_newton"
    most_runs: int = 30         #: of Gauss-Newton, those repeated from files included
    tolerance: float = 0.01     #: Gauss-Newton ends where the next step would reduce chi squared by less
    differences: str = "central"
    members: int = 20           #: of the ensemble
    assimilations: int = 4      #: of the ensemble
    seed: int = 1
    is_scaled: bool = False     #: whether the misfit of the best run widens the uncertainty


@dataclass(frozen=True)
class Specification:
    """What a calibration does."""

    file: Path
    scene: Path
    changes: dict[str, Any]                  #: changes of the scene in every run, as for --set
    parameters: list[Parameter]
    observations: list[Observation]
    search: Search
    problems: Problems = field(compare=False)
    places: dict[str, tuple[int, int]] = field(compare=False)  #: line and column of the value of each parameter or change

    def values(self, positions: np.ndarray) -> dict[str, float]:
        """The values of the parameters at positions between their bounds, shape (parameters,)."""
        return {parameter.key: parameter.value(float(position)) for parameter, position in zip(self.parameters, positions)}

    @property
    def start(self) -> np.ndarray:
        """Positions of the start values, shape (parameters,)."""
        return np.array([parameter.position(parameter.start) for parameter in self.parameters])


def read_specification(file: Path) -> Specification:
    """Reads the file of a calibration and all observations.  Raises SceneError with the place of each error in it."""
    top = read_yaml(file)
    block = Block(top)
    scene = block.file("scene")
    places: dict[str, tuple[int, int]] = {}
    changes = _read_changes(block.take("set"), places)
    parameters = _read_parameters(block.take("parameters", required=True), changes, places)
    observations = _read_observations(block.take("observations", required=True))
    search = _read_search(block, len(parameters))
    block.end()
    top.problems.raise_any()
    assert scene is not None
    return Specification(file, scene[0], changes, parameters, observations, search, top.problems, places)


def _read_changes(entry: Entry | None, places: dict[str, tuple[int, int]]) -> dict[str, Any]:
    changes: dict[str, Any] = {}
    if entry is None:
        return changes
    if not entry.is_mapping:
        entry.wrong(f"{entry.shown()} instead of a mapping of keys of the scene to values")
        return changes
    for name, value in entry.items():
        changes[name] = value.value()
        places[name] = value.line, value.column
    return changes


def _read_parameters(entry: Entry | None, changes: dict[str, Any], places: dict[str, tuple[int, int]]) -> list[Parameter]:
    found: list[Parameter] = []
    if entry is None:
        return found
    if not entry.is_mapping or not entry.node.value:
        entry.wrong("a mapping is expected, such as `materials[0].cohesion: {start: 500, low: 50, high: 5000, scale: log}`")
        return found
    for key, one in entry.items():
        places[key] = one.line, one.column
        if not _KEY.fullmatch(key):
            one.wrong(f'"{key}" is no key of a scene, such as materials[0].friction_angle')
        elif key in changes:
            one.wrong(f"{key} is also changed by `set`")
        if parameter := _read_parameter(key, one):
            found.append(parameter)
    return found


def _read_parameter(key: str, entry: Entry) -> Parameter | None:
    block = Block(entry)
    scale = block.word("scale", SCALES, "linear")
    low, high, start = block.number("low"), block.number("high"), block.number("start")
    step = block.number("step", STEP, above=0, high=0.5)
    mean, deviation = _read_prior(block.take("prior"))
    block.end()
    if low is None or high is None or start is None or step is None:
        return None
    places = {name: block.take(name) or entry for name in ("low", "high", "start")}
    if not low < high:
        places["high"].wrong(f"{high:g} must be > low, which is {low:g}")
    elif scale == "log" and low <= 0:
        places["low"].wrong(f"{low:g} must be > 0 with scale log")
    elif not low <= start <= high:
        places["start"].wrong(f"{start:g} is outside of [low, high], which is [{low:g}, {high:g}]")
    else:
        plain = Parameter(key, start, low, high, scale, step, None)
        if mean is None or deviation is None:
            return plain
        if scale == "log" and mean <= 0:
            block.entry.wrong(f"prior: the mean {mean:g} must be > 0 with scale log")
            return plain
        share = deviation / mean / plain.range if scale == "log" else deviation / plain.range
        return Parameter(key, start, low, high, scale, step, (plain.position(mean), share))
    return None


def _read_prior(entry: Entry | None) -> tuple[float | None, float | None]:
    if entry is None:
        return None, None
    block = Block(entry)
    prior = block.number("mean"), block.number("deviation", above=0)
    block.end()
    return prior


def _read_observations(entry: Entry | None) -> list[Observation]:
    found: list[Observation] = []
    if entry is None:
        return found
    if not entry.is_list or not entry.node.value:
        entry.wrong("a list is expected, such as `- {type: front, file: front.csv, deviation: 0.05}`")
        return found
    names: set[str] = set()
    for one in entry.entries():
        observation = read_observation(one)
        if observation is None:
            continue
        if observation.name in names:
            one.wrong(f'another observation has the name "{observation.name}": give one of them a `name`')
        names.add(observation.name)
        found.append(observation)
    return found


def _read_search(block: Block, parameters: int) -> Search:
    usual = Search()
    method = block.word("method", METHODS, usual.method)
    is_scaled = block.word("uncertainty", ("stated", "scaled"), "stated") == "scaled"
    other = {"gauss_newton": "ensemble", "ensemble": "gauss_newton"}[method]
    if (stray := block.take(other)) is not None:
        stray.wrong(f"settings of another method than the one that is chosen (method: {method})")
    entry = block.take(method)
    if entry is None:
        return Search(method=method, most_runs=max(usual.most_runs, 1 + 2 * parameters), is_scaled=is_scaled)
    own = Block(entry)
    if method == "ensemble":
        search = Search(method, members=own.whole("members", usual.members, low=3), seed=own.whole("seed", usual.seed, low=0),
                        assimilations=own.whole("assimilations", usual.assimilations, low=1), is_scaled=is_scaled)
    else:
        tolerance = own.number("tolerance", usual.tolerance, above=0)
        differences = own.word("differences", ("central", "forward"), usual.differences)
        fewest = 1 + parameters * (2 if differences == "central" else 1)  # the start and a Jacobian
        search = Search(method, most_runs=own.whole("most_runs", max(usual.most_runs, fewest), low=fewest),
                        tolerance=tolerance or usual.tolerance, differences=differences, is_scaled=is_scaled)
    own.end()
    return search
