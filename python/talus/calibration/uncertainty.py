"""How well observations determine parameters: covariances, intervals, and parameters that cannot be told apart."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from ..packages import need

SHARE = 0.95                  # of the intervals
_WIDE = 12**-0.5              # standard deviation of a uniform distribution between the bounds
_LARGE_CONDITION = 1e3
_LARGE_CORRELATION = 0.95
_PART_OF_DIRECTION = 0.3      # of a unit vector, above which a parameter is named
_UNLIKELY = 1e-3              # probability of a misfit below which the stated deviations are doubted
_ROUNDING = 1e-10             # singular values below this share of the largest count as zero


@dataclass
class Uncertainty:
    """Covariance of positions between the bounds, each from 0 to 1.

    covariance  (n, n); inf on the diagonal for a parameter that the observations do not determine
    condition   largest over smallest singular value of the Jacobian by these positions; nan for an ensemble
    chi2        sum of the squared residuals over their standard deviations
    freedom     number of observations less that of parameters
    warnings    what is badly determined, in words
    """

    covariance: np.ndarray
    condition: float
    chi2: float
    freedom: int
    warnings: list[str]

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations, (n,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def correlations(self) -> np.ndarray:
        """(n, n); nan where a parameter is not determined."""
        sigma = self.deviations
        with np.errstate(invalid="ignore", divide="ignore"):
            found = self.covariance / np.outer(sigma, sigma)
        found[np.diag_indices(len(sigma))] = 1.0
        return found

    @property
    def misfit_factor(self) -> float:
        """Root of chi squared per degree of freedom: 1 if the residuals are as large as the stated deviations."""
        return float(np.sqrt(self.chi2 / self.freedom)) if self.freedom > 0 else float("nan")


def interval(position: float, deviation: float) -> tuple[float, float]:
    """The interval around a position that contains SHARE of a normal distribution, cut off at the bounds 0 and 1."""
    half = NormalDist().inv_cdf(0.5 + SHARE / 2) * deviation
    return max(position - half, 0.0), min(position + half, 1.0)


def of_jacobian(jacobian: np.ndarray, residuals: np.ndarray, names: Sequence[str], priors: int = 0, *,
                is_scaled: bool = False) -> Uncertainty:
    """The uncertainty of a minimum: the covariance is (J^T J)^-1, with residuals over their standard deviations (so J^T W J of the plain
    ones, with the weights W).  Source: Seber & Wild (1989), Nonlinear Regression, section 2.1.

    jacobian   (m, n), derivatives of the residuals by the positions
    residuals  (m,)
    names      of the parameters, for warnings
    priors     how many of the residuals, the last ones, are of priors and not of observations
    is_scaled  multiplies the covariance by chi squared per degree of freedom where that is larger than 1
    """
    n = jacobian.shape[1]
    _, s, v = np.linalg.svd(jacobian, full_matrices=False)
    s, v = np.concatenate([s, np.zeros(n - len(s))]), v if len(v) == n else np.linalg.svd(jacobian)[2]
    determined = s > _ROUNDING * max(s[0], np.finfo(float).tiny)
    covariance = (v[determined].T / s[determined] ** 2) @ v[determined]
    lost = np.any(np.abs(v[~determined]) > np.sqrt(_ROUNDING), axis=0)
    covariance[lost, lost] = np.inf
    condition = float(s[0] / s[-1]) if determined.all() else float("inf")
    measured = residuals[: len(residuals) - priors]
    chi2, freedom = float(measured @ measured), len(measured) - n + priors
    found = Uncertainty(covariance, condition, chi2, freedom, [])
    if is_scaled and found.misfit_factor > 1:
        covariance *= found.misfit_factor**2
    found.warnings += _warnings_of_misfit(found, is_scaled)
    wide = [name for name, sigma in zip(names, found.deviations) if sigma > _WIDE]
    found.warnings += [f"{name} is not identifiable: the observations tell no more about it than its bounds do" for name in wide]
    for size, direction in zip(s[::-1], v[::-1]):
        if size * _LARGE_CONDITION >= s[0]:
            break
        parts = [name for name, part in zip(names, direction) if abs(part) > _PART_OF_DIRECTION]
        told = f"the observations hardly depend on {parts[0]}"
        if len(parts) > 1:
            told = f"only combinations of {' and '.join(parts)} are determined"
        found.warnings.append(f"the condition number is {condition:.3g}, more than {_LARGE_CONDITION:g}: {told}; "
                              "other observations, a prior or fewer parameters help")
    return Uncertainty(found.covariance, condition, chi2, freedom, found.warnings + _warnings_of_correlation(found, names))


def of_ensemble(positions: np.ndarray, prior: np.ndarray, residuals: np.ndarray, names: Sequence[str], *,
                is_scaled: bool = False) -> Uncertainty:
    """The uncertainty of the mean of an ensemble: the covariance of its members.

    positions  (members, n), after the last assimilation
    prior      (members, n), before the first
    residuals  (m,), of the mean
    """
    covariance = np.atleast_2d(np.cov(positions, rowvar=False))
    found = Uncertainty(covariance, float("nan"), float(residuals @ residuals), len(residuals) - len(names), [])
    if is_scaled and found.misfit_factor > 1:
        covariance *= found.misfit_factor**2
    found.warnings += _warnings_of_misfit(found, is_scaled)
    for name, now, before in zip(names, found.deviations, prior.std(axis=0, ddof=1)):
        if now > 0.8 * before:
            found.warnings.append(f"{name} is not identifiable: the ensemble has {now / before:.2g} of the width that it had before the "
                                  "first assimilation")
    found.warnings += _warnings_of_correlation(found, names)
    return found


def _warnings_of_misfit(found: Uncertainty, is_scaled: bool) -> list[str]:
    """A warning where residuals are so large that the stated deviations cannot be right."""
    if found.freedom <= 0:
        return ["there are not more observations than parameters: the misfit cannot be judged"]
    if need("scipy.stats", "judges misfits").chi2.sf(found.chi2, found.freedom) > _UNLIKELY:
        return []
    then = "the intervals are wider by this factor" if is_scaled else "the intervals are too narrow; `uncertainty: scaled` widens them"
    return [f"the residuals are {found.misfit_factor:.3g} times as large as the stated deviations allow: {then}"]


def _warnings_of_correlation(found: Uncertainty, names: Sequence[str]) -> list[str]:
    rho = found.correlations
    return [f"{names[i]} and {names[j]} are hard to tell apart: their estimates have a correlation of {rho[i, j]:.3f}"
            for i in range(len(names)) for j in range(i) if abs(rho[i, j]) > _LARGE_CORRELATION]
