"""Calibration: parameters of a scene from observations, by many runs.

    result = talus.calibrate("calibration.yaml", jobs=4)
    result.estimates["materials[0].friction_angle"].value
    talus.run("scene.yaml", set=result.values)
"""
from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..errors import RunFailed, SceneError
from ..program import find_program
from ..running import check
from .ensemble import assimilate, first_members, prior_of
from .evaluation import Evaluation
from .files import only_writer
from .gauss_newton import CONVERGED, NoResiduals, is_dominated, minimise
from .results import Calibration, Estimate, write_results
from .specification import Specification, read_specification
from .uncertainty import of_ensemble, of_jacobian

__all__ = ["Calibration", "Estimate", "calibrate", "default_folder", "read_specification"]


def default_folder(specification: Path) -> Path:
    """The folder for results without `out`: runs/NAME, or for a `calibration.yaml` runs/ and the name of its folder with `_calibration`."""
    folder = specification.absolute().parent.name
    return Path("runs") / (f"{folder}_calibration" if specification.name == "calibration.yaml" and folder else specification.stem)


def calibrate(specification: str | os.PathLike[str], *, out: str | os.PathLike[str] | None = None, jobs: int = 1,
              threads: int | None = None, tell: Callable[[str], object] | None = None, pictures: bool = True,
              launcher: str | None = None, program: str | os.PathLike[str] | None = None) -> Calibration:
    """Finds parameters of a scene from observations, with their uncertainty.

    specification  path of the file (.yaml) that names scene, parameters and observations (docs/guide/calibration.md)
    out            folder for runs and results; default `default_folder`.  Runs that are done there are not repeated
    jobs           runs at a time
    threads        of each run; default what the program takes, with several runs at a time and no launcher the cores over these
    tell           is called with a line of text for each run
    pictures       whether calibration.png is drawn, which needs matplotlib
    launcher       words before the program, such as "mpirun -n 4"
    program        the program talus; default: `find_program`

    Needs scipy and PyYAML, for outlines contourpy.  Raises SceneError for wrong input, with the place of each error; RunFailed if the run
    at the start fails, or so many others that there is no estimate; and as `run` does.  Ctrl-C lets the runs write their checkpoints.
    """
    spec = read_specification(Path(specification))
    found_program = find_program(program)
    _check_scene(spec, found_program)
    folder = Path(out) if out is not None else default_folder(Path(specification))
    folder.mkdir(parents=True, exist_ok=True)
    with only_writer(folder):
        of_each = threads if threads is not None or launcher or jobs == 1 else max((os.cpu_count() or 1) // jobs, 1)
        evaluation = Evaluation(spec, folder, jobs, of_each, found_program, tell or (lambda _: None), launcher)
        try:
            result = (_by_ensemble if spec.search.method == "ensemble" else _by_gauss_newton)(spec, evaluation)
        except NoResiduals as error:
            failed = [f"run {record.number} ({record.folder}): {record.error}" for record in evaluation.records
                      if record.status == "failed"]
            raise RunFailed("\n".join([f"no estimate: {error}", *failed]), 1) from error
        if pictures:
            from .figure import write_figure
            best = next(record for record in evaluation.records if record.number == result.contents["best_run"]["number"])
            write_figure(result, spec.observations, evaluation.records[0], best)
    return result


def _check_scene(spec: Specification, program: Path) -> None:
    """Checks the scene with all parameters at their starts, and at both ends of their ranges.  Errors of a value are told at its place."""
    for positions in (spec.start, np.zeros(len(spec.parameters)), np.ones(len(spec.parameters))):
        try:
            check(spec.scene, set={**spec.changes, **spec.values(positions)}, program=program)
        except SceneError as error:
            elsewhere = False
            for message in error.errors:
                key = message.file.removeprefix("--set ").partition("=")[0]
                if message.file.startswith("--set ") and key in spec.places:
                    spec.problems.add(*spec.places[key], message.key or key, message.text)
                else:
                    elsewhere = True
            if elsewhere or not spec.problems.messages:
                raise
    spec.problems.raise_any()


def _by_gauss_newton(spec: Specification, evaluation: Evaluation) -> Calibration:
    search = spec.search
    steps = np.array([parameter.step for parameter in spec.parameters])
    fit = minimise(evaluation, spec.start, steps, most=search.most_runs, tolerance=search.tolerance, differences=search.differences)
    names = [parameter.key for parameter in spec.parameters]
    priors = sum(parameter.prior is not None for parameter in spec.parameters)
    found = of_jacobian(fit.jacobian, fit.residuals, names, priors, is_scaled=search.is_scaled)
    if fit.ending != CONVERGED:
        found.warnings.insert(0, f"the minimum is not certain: {fit.ending}; one more step would reduce chi squared by about "
                                 f"{fit.promised:.2g} (by 1 is a step of one standard deviation)")
    if np.any(np.abs(fit.position - fit.at) > found.deviations):
        found.warnings.append("the covariance is that of a Jacobian further away than a standard deviation: allow more runs (most_runs)")
    found.warnings += [f"{name}: residuals bend or scatter over its step as much as they change; try another `step`"
                       for name, curvature in zip(names, fit.curvature) if is_dominated(curvature)]
    curvature = [float(value) if np.isfinite(value) else None for value in fit.curvature]
    return write_results(spec, evaluation, fit.position, found, fit.ending,
                         {"chi2_of_steps": fit.iterations, "second_over_first_difference": curvature})


def _by_ensemble(spec: Specification, evaluation: Evaluation) -> Calibration:
    search = spec.search
    mean, deviation = prior_of([parameter.prior for parameter in spec.parameters], spec.start)
    members = first_members(search.members, mean, deviation, search.seed)
    ensemble = assimilate(evaluation.without_priors, members, search.assimilations, search.seed)
    names = [parameter.key for parameter in spec.parameters]
    found = of_ensemble(ensemble.positions, ensemble.prior, ensemble.residuals, names, is_scaled=search.is_scaled)
    return write_results(spec, evaluation, ensemble.positions.mean(axis=0), found, f"{search.assimilations} assimilations are done", {
        "chi2_of_assimilations": ensemble.misfits,
        "members": [list(spec.values(position).values()) for position in ensemble.positions]})
