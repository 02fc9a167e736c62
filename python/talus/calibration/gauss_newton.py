"""Least squares with few and expensive evaluations: Gauss-Newton with the damping of Levenberg and Marquardt, on differences.

Sources: Marquardt (1963), An algorithm for least-squares estimation of nonlinear parameters; Nielsen (1999), Damping parameter in
Marquardt's method, report IMM-REP-1999-05 (change of the damping); Broyden (1965), A class of methods for solving nonlinear simultaneous
equations (update of the Jacobian).
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..packages import need

Evaluate = Callable[[Sequence[np.ndarray], str], "list[np.ndarray | None]"]
"""Residuals at some points, each over its standard deviation; None where they cannot be computed.  The text says what for."""

_FIRST_DAMPING = 1e-2   # of the square of the longest column of the Jacobian
_LONGEST_STEP = 0.25    # of the range between the bounds: where residuals hardly depend on a parameter, steps would go to its bound
_LEAST_DAMPING = 1e-8
_GOOD = 0.75            # actual over predicted decrease above which an updated Jacobian serves once more
_MOST_REJECTED = 5      # steps in a row, the last of which is damped 1000 times as much as the first
_DOMINATED = 1.0        # second over first difference above which a derivative is not to be trusted


CONVERGED = "converged"
USED_UP = "the runs are used up"
NO_DECREASE = "no step reduces chi squared any more: it is rough at this scale"


class NoResiduals(Exception):
    """The residuals cannot be computed where they are needed."""


@dataclass
class Fit:
    """A minimum of the sum of squares.

    position     (n,), between the bounds, each from 0 to 1
    residuals    (m,) there
    jacobian     (m, n), derivatives of the residuals by the position
    at           (n,), where the Jacobian was computed by differences; Broyden's updates follow if that is not `position`
    ending       CONVERGED, USED_UP or NO_DECREASE: why the search ended
    promised     by how much one more step would reduce chi squared, if the residuals were linear
    evaluations  their number
    iterations   chi squared after each accepted step
    curvature    (n,), for each parameter the second difference of the residuals over the first, as lengths: where it is 1 or more, the
                 function bends or scatters over the step as much as it rises
    """

    position: np.ndarray
    residuals: np.ndarray
    jacobian: np.ndarray
    at: np.ndarray
    ending: str
    promised: float
    evaluations: int
    iterations: list[float] = field(default_factory=list)
    curvature: np.ndarray = field(default_factory=lambda: np.zeros(0))


class _Search:
    """The state of a search."""

    def __init__(self, evaluate: Evaluate, start: np.ndarray, steps: np.ndarray, most: int, differences: str) -> None:
        self.evaluate, self.steps, self.most, self.is_central = evaluate, steps, most, differences == "central"
        self.count = 0
        first = self.call([start], "start")[0]
        if first is None:
            raise NoResiduals("the run with the start values failed")
        self.x, self.r = start, first
        self.jacobian, self.at = np.zeros((len(first), len(start))), np.full(len(start), np.nan)
        self.curvature = np.full(len(start), np.nan)

    def call(self, points: Sequence[np.ndarray], purpose: str) -> list[np.ndarray | None]:
        self.count += len(points)
        return self.evaluate(points, purpose)

    @property
    def chi2(self) -> float:
        return float(self.r @ self.r)

    @property
    def is_fresh(self) -> bool:
        return np.array_equal(self.at, self.x)

    @property
    def for_jacobian(self) -> int:
        """Evaluations that a Jacobian takes."""
        return (2 if self.is_central else 1) * len(self.x)

    def differentiate(self) -> None:
        """Computes the Jacobian by differences, all evaluations at once; one-sided where a bound or a failed evaluation is in the way."""
        points, signs = [], []
        for k, step in enumerate(self.steps):
            for sign in (1.0, -1.0) if self.is_central else (1.0 if self.x[k] + step <= 1 else -1.0,):
                point = self.x.copy()
                point[k] += sign * step
                if 0 <= point[k] <= 1:
                    points.append(point)
                    signs.append((k, sign))
        found = {key: value for key, value in zip(signs, self.call(points, "difference")) if value is not None}
        for k, step in enumerate(self.steps):
            up, down = found.get((k, 1.0)), found.get((k, -1.0))
            if up is None and down is None:
                raise NoResiduals(f"no run beside the values at hand has residuals: no difference of parameter {k + 1}")
            if up is not None and down is not None:
                self.jacobian[:, k] = (up - down) / (2 * step)
                self.curvature[k] = np.linalg.norm(up - 2 * self.r + down) / max(np.linalg.norm(up - down), np.finfo(float).tiny)
            else:
                self.jacobian[:, k] = (up - self.r) / step if up is not None else (self.r - down) / step
        self.at = self.x.copy()

    def update(self, step: np.ndarray, new: np.ndarray) -> None:
        """Broyden's update: the smallest change of the Jacobian that explains the residuals after a step."""
        self.jacobian = self.jacobian + np.outer(new - self.r - self.jacobian @ step, step) / (step @ step)


def minimise(evaluate: Evaluate, start: np.ndarray, steps: np.ndarray, *, most: int, tolerance: float, differences: str = "central") -> Fit:
    """Minimises the sum of the squares of residuals over the box from 0 to 1 in each of n parameters.

    evaluate     gives the residuals, shape (m,), at several points at once
    start        (n,)
    steps        (n,), of the differences
    most         evaluations; the last ones are kept for the Jacobian at the minimum
    tolerance    ends where the next step would reduce chi squared by less: with residuals over their standard deviations, 0.01 is a step of
                 a tenth of a standard deviation of the estimate
    differences  "central" or "forward"

    Between two Jacobians by differences, steps use Broyden's update as long as they reduce chi squared about as predicted.
    Raises NoResiduals where the residuals at the start, or all around a point, cannot be computed.
    """
    search = _Search(evaluate, np.array(start, float), steps, most, differences)
    search.differentiate()
    damping, growth, rejected, is_trusted, history = _FIRST_DAMPING, 2.0, 0, True, [search.chi2]
    while True:
        left = most - search.count
        promised = _step(search, _LEAST_DAMPING)[1]
        is_small = promised < tolerance
        if is_small and (search.is_fresh or left < search.for_jacobian):
            ending = CONVERGED
            break
        is_last_chance = left - 1 < search.for_jacobian  # a step more, and there will be no Jacobian at the minimum
        if not search.is_fresh and left >= search.for_jacobian and (is_small or is_last_chance or not is_trusted):
            search.differentiate()
            is_trusted = True
            continue
        if left < 1 or rejected >= _MOST_REJECTED:
            ending = NO_DECREASE if left >= 1 else USED_UP
            break
        step, predicted = _step(search, damping)
        new = search.call([search.x + step], "step")[0]
        gain = (search.chi2 - float(new @ new)) / predicted if new is not None else -1.0
        is_trusted = gain >= _GOOD
        if new is not None and gain > 0:
            search.update(step, new)
            search.x, search.r, rejected = search.x + step, new, 0
            history.append(search.chi2)
            damping, growth = max(damping * max(1 / 3, 1 - (2 * gain - 1) ** 3), _LEAST_DAMPING), 2.0
        else:
            rejected += 1
            damping, growth = damping * growth, 2 * growth
    return Fit(search.x, search.r, search.jacobian, search.at, ending, promised, search.count, history, search.curvature)


def _step(search: _Search, damping: float) -> tuple[np.ndarray, float]:
    """The damped step within the bounds, and by how much it reduces chi squared if the residuals are linear.  All parameters are damped
    alike, as positions between bounds have one scale (Levenberg); damping by the columns (Marquardt) would let weak ones run away."""
    optimize = need("scipy.optimize", "solves least squares with bounds")
    n = len(search.x)
    longest = max(float(np.linalg.norm(search.jacobian, axis=0).max()), np.finfo(float).tiny)
    matrix = np.concatenate([search.jacobian, np.sqrt(damping) * longest * np.eye(n)])
    target = np.concatenate([-search.r, np.zeros(n)])
    margin = 1e-12  # lsq_linear wants a box with an inside
    box = (np.maximum(-search.x - margin, -_LONGEST_STEP), np.minimum(1 - search.x + margin, _LONGEST_STEP))
    step = optimize.lsq_linear(matrix, target, box, method="bvls").x
    step = np.clip(search.x + step, 0, 1) - search.x
    after = search.r + search.jacobian @ step
    return step, search.chi2 - float(after @ after)


def is_dominated(curvature: float) -> bool:
    """Whether a difference is dominated by curvature or scatter."""
    return bool(curvature >= _DOMINATED)
