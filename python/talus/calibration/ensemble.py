"""Ensemble smoother with multiple data assimilation (ES-MDA): parameters by the correlations of an ensemble of runs, without derivatives.

Source: Emerick & Reynolds (2013), Ensemble smoother with multiple data assimilation, Computers & Geosciences 55, 3-15.  With linear
residuals and many members, the ensemble becomes a sample of the posterior distribution.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..packages import need
from .gauss_newton import Evaluate, NoResiduals

_FEWEST = 3          # members that must be left
_PRIOR = 0.25        # standard deviation of a parameter without a prior, of the range between its bounds


@dataclass
class Ensemble:
    """The ensemble after the last assimilation.

    positions    (members, n), between the bounds, each from 0 to 1
    prior        (members, n), before the first
    residuals    (m,), at the mean of `positions`
    spread       (m,), standard deviation of the residuals over the members
    misfits      mean of chi squared over the members: before the first assimilation, and after each
    evaluations  their number
    """

    positions: np.ndarray
    prior: np.ndarray
    residuals: np.ndarray
    spread: np.ndarray
    misfits: list[float]
    evaluations: int


def first_members(count: int, mean: np.ndarray, deviation: np.ndarray, seed: int) -> np.ndarray:
    """A Latin hypercube sample, (count, n), of independent normal distributions that are cut off at 0 and 1; mean and deviation: (n,)."""
    qmc, stats = need("scipy.stats.qmc", "samples parameters"), need("scipy.stats", "samples parameters")
    shares = qmc.LatinHypercube(len(mean), seed=seed).random(count)
    return stats.truncnorm.ppf(shares, (0 - mean) / deviation, (1 - mean) / deviation, mean, deviation)


def prior_of(priors: list[tuple[float, float] | None], start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means and deviations, (n,) each, of the first ensemble: those of the priors, or the start and a quarter of the range."""
    mean = np.array([start[k] if prior is None else np.clip(prior[0], 0, 1) for k, prior in enumerate(priors)])
    return mean, np.array([_PRIOR if prior is None else prior[1] for prior in priors])


def assimilate(evaluate: Evaluate, members: np.ndarray, assimilations: int, seed: int) -> Ensemble:
    """Moves an ensemble towards the observations, in several steps of equal weight.

    evaluate       gives the residuals, shape (m,), at several points at once; members whose residuals cannot be computed are left out
    members        (members, n), in the box from 0 to 1
    assimilations  number of steps, each with standard deviations that are larger by its square root
    seed           of the perturbations of the observations

    Raises NoResiduals if fewer than three members are left, or if the mean of the members has no residuals.
    """
    random = np.random.default_rng(seed)
    x, prior, misfits, count = members.copy(), members, [], 0
    for k in range(assimilations + 1):
        count += len(x)
        found = evaluate(list(x), f"assimilation {k}" if k else "prior")
        there = [i for i, residuals in enumerate(found) if residuals is not None]
        if len(there) < _FEWEST:
            raise NoResiduals(f"{len(there)} members of the ensemble have residuals: at least {_FEWEST} are needed")
        x, r = x[there], np.array([found[i] for i in there])
        misfits.append(float(np.mean(np.sum(r**2, axis=1))))
        if k < assimilations:
            x = np.clip(x + _change(x, r, assimilations, random), 0, 1)
    residuals = evaluate([x.mean(axis=0)], "mean")[0]
    if residuals is None:
        raise NoResiduals("the run with the mean of the members failed")
    return Ensemble(x, prior, residuals, r.std(axis=0, ddof=1), misfits, count + 1)


def _change(x: np.ndarray, r: np.ndarray, inflation: float, random: np.random.Generator) -> np.ndarray:
    """Changes of the members, (members, n), with the Kalman gain of their covariances: with residuals over their deviations that of the
    observations is the unit matrix times the inflation, so that the inverse follows from the singular values of the ensemble."""
    count = len(x)
    dx, dr = ((values - values.mean(axis=0)) / np.sqrt(count - 1) for values in (x, r))
    u, s, v = np.linalg.svd(dr, full_matrices=False)
    gain = dx.T @ (u * (s / (s**2 + inflation))) @ v
    perturbed = np.sqrt(inflation) * random.standard_normal(r.shape) - r
    return perturbed @ gain.T
