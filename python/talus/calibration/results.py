"""Results of a calibration: estimates with their uncertainty, as files and as text."""
from __future__ import annotations

import json
import math
import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..runs import contents_of
from ..scenes import flow, set_options
from ..tables import Table
from .evaluation import Evaluation, Record
from .files import write_whole
from .specification import Parameter, Specification
from .uncertainty import SHARE, Uncertainty, interval


@dataclass(frozen=True)
class Estimate:
    """The estimate of a parameter, in the unit of the scene."""

    key: str
    value: float
    deviation: float             #: standard deviation; with scale log, that of the logarithm times the value; inf if it is not determined
    low: float                   #: the 95 % interval, cut off at the bounds
    high: float
    start: float                 #: value with which the search began
    scale: str                   #: "linear" or "log"


class Calibration:
    """The folder of a calibration.

    folder  path of the folder
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        self.contents = contents_of(self.folder / "calibration.json", "the calibration did not end, or this is no folder of one")

    @property
    def estimates(self) -> dict[str, Estimate]:
        """{key: estimate}, in the order of the file."""
        names = ("key", "value", "deviation", "low", "high", "start", "scale")
        return {one["key"]: Estimate(**{name: math.inf if one[name] is None else one[name] for name in names})
                for one in self.contents["parameters"]}

    @property
    def values(self) -> dict[str, float]:
        """The estimates as `talus.run(set=...)` takes them."""
        return {key: estimate.value for key, estimate in self.estimates.items()}

    @property
    def correlations(self) -> np.ndarray:
        """Correlations of the estimates, (n, n); nan where a parameter is not determined."""
        return np.array([[math.nan if value is None else value for value in row] for row in self.contents["correlations"]])

    @property
    def warnings(self) -> list[str]:
        """What is badly determined, in words."""
        return list(self.contents["warnings"])

    @property
    def runs(self) -> Table:
        """The table calibration.csv, with a row for each run."""
        return Table(self.folder / "calibration.csv")

    def __str__(self) -> str:
        return told(self.contents)

    def __repr__(self) -> str:
        return f"<talus.Calibration {self.folder}: {', '.join(f'{key} {value:.4g}' for key, value in self.values.items())}>"


def write_results(spec: Specification, evaluation: Evaluation, position: np.ndarray, found: Uncertainty, ending: str, more: dict[str, Any],
                  ) -> Calibration:
    """Writes calibration.json and best.yaml.

    position  (n,), the estimate, between the bounds
    ending    why the search ended
    more      entries of calibration.json that only one method has
    """
    best = evaluation.of(position)
    warnings = found.warnings + _at_bounds(spec.parameters, position) + _of_program(evaluation.records)
    contents = {
        "scene": str(spec.scene), "specification": str(spec.file), "method": spec.search.method, "ending": ending,
        "parameters": [_estimate(parameter, x, sigma) for parameter, x, sigma in zip(spec.parameters, position, found.deviations)],
        "confidence": SHARE,
        "correlations": _plain(found.correlations), "covariance_of_positions": _plain(found.covariance),
        "condition_number": _plain(found.condition),
        "chi2": found.chi2, "degrees_of_freedom": found.freedom, "misfit_factor": _plain(found.misfit_factor),
        "observations": [{"name": observation.name, "count": len(observation.values), "chi2": chi2,
                          "rms_over_deviation": math.sqrt(chi2 / len(observation.values)),
                          "rms": float(np.sqrt(np.mean((values - observation.values) ** 2))), "unit": observation.unit}
                         for observation, chi2, values in zip(spec.observations, best.chi2, best.values_of_run)],
        "runs": {"count": len(evaluation.records), "reused": sum(record.reused for record in evaluation.records),
                 "failed": sum(record.status == "failed" for record in evaluation.records)},
        "best_run": {"number": best.number, "folder": str(best.folder.relative_to(evaluation.out))},
        "warnings": warnings, **more,
    }
    command = shlex.join(["talus", "run", str(spec.scene), *set_options({**spec.changes, **best.values})])
    lines = [f"# Estimates of {spec.file.name}: talus.run(scene, set=...) takes them, and the program as", f"# {command}",
             *(f"{key}: {_number(value)}" for key, value in best.values.items())]
    write_whole(evaluation.out / "best.yaml", "\n".join(lines) + "\n")
    write_whole(evaluation.out / "calibration.json", json.dumps(contents, indent=2, ensure_ascii=False) + "\n")
    return Calibration(evaluation.out)


def _number(value: float) -> str:
    """A number as YAML 1.1 reads it too, which is that of PyYAML: with a point before an exponent."""
    text = flow(value)
    return text.replace("e", ".0e") if "." not in text else text


def _estimate(parameter: Parameter, position: float, deviation: float) -> dict[str, Any]:
    value = parameter.value(float(position))
    ends = interval(float(position), float(deviation))
    slope = value * parameter.range if parameter.scale == "log" else parameter.range
    return {"key": parameter.key, "value": value, "deviation": _plain(deviation * slope), "low": parameter.value(ends[0]),
            "high": parameter.value(ends[1]), "start": parameter.start, "scale": parameter.scale, "bounds": [parameter.low, parameter.high]}


def _plain(value: Any) -> Any:
    """Numbers and arrays for JSON, which has no nan and no inf: null."""
    if isinstance(value, np.ndarray):
        return [_plain(entry) for entry in value]
    return float(value) if math.isfinite(value) else None


def _at_bounds(parameters: list[Parameter], position: np.ndarray) -> list[str]:
    near = 1e-6
    return [f"{parameter.key} is at its bound {parameter.value(round(float(x))):g}: its interval does not count; are the bounds too narrow?"
            for parameter, x in zip(parameters, position) if x < near or x > 1 - near]


def _of_program(records: list[Record]) -> list[str]:
    commits = sorted({record.commit for record in records if record.commit})
    return [f"the runs are of several versions of the program ({', '.join(commits)}): remove their folders to repeat them"] \
        if len(commits) > 1 else []


def told(contents: dict[str, Any]) -> str:
    """The results as text for the terminal."""
    rows = [["parameter", "start", "estimate", "deviation", f"{100 * contents['confidence']:.0f} % interval"]]
    for one in contents["parameters"]:
        sigma = "not determined" if one["deviation"] is None else f"{one['deviation']:.3g}"
        rows.append([one["key"], f"{one['start']:.6g}", f"{one['value']:.6g}", sigma, f"{one['low']:.5g} to {one['high']:.5g}"])
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    lines = ["  ".join(word.ljust(width) for word, width in zip(row, widths)).rstrip() for row in rows]
    lines.append("")
    lines += [f"{one['name']}: {one['count']} values, root mean square of the residuals {one['rms']:.3g}"
              f"{' ' + one['unit'] if one['unit'] != '-' else ''}, {one['rms_over_deviation']:.3g} deviations"
              for one in contents["observations"]]
    runs = contents["runs"]
    condition = f", condition number {contents['condition_number']:.3g}" if contents["condition_number"] is not None else ""
    lines.append(f"{contents['ending']} after {runs['count']} runs, {runs['reused']} of them done before{condition}")
    return "\n".join(lines + [f"warning: {warning}" for warning in contents["warnings"]])
