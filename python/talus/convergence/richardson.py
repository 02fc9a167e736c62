"""A number that was computed with cells of several sizes: observed order, extrapolated value, grid convergence index."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

# What values say of convergence, with a sentence for a warning.  Only the first two have an extrapolated value.
CONVERGES, CONSTANT, OSCILLATES, OSCILLATES_AND_GROWS, DIVERGES = "converges", "constant", "oscillates", "osc. grows", "diverges"
ORDER_LOW, ORDER_HIGH, UNSTEADY, UNDECIDED, NO_VALUE = "order<0.5", "order>3", "unsteady", "undecided", "no value"
MEANING = {CONVERGES: "the changes have one sign and fall with an order between 0.5 and 3",
           CONSTANT: "the same at all sizes, but for rounding",
           OSCILLATES: "oscillatory convergence: the changes alternate in sign and fall",
           OSCILLATES_AND_GROWS: "oscillatory divergence: the changes alternate in sign and do not fall",
           DIVERGES: "divergence: the changes have one sign and do not fall",
           ORDER_LOW: "the changes fall too slowly: where they lead cannot be told",
           ORDER_HIGH: "the changes fall faster than the method converges, which is an accident of these sizes",
           UNSTEADY: "the order of the three finest sizes is not that of the next coarser ones",
           UNDECIDED: "the two finest values are equal and the coarser one is not: no order follows",
           NO_VALUE: "not known at every size"}

RISES, FALLS, TURNS, STAYS = "rises", "falls", "turns", "stays"  # as cells become smaller

# Orders that are believed.  The method is of second order where all is smooth and of first order at fronts and where material yields.
# Below the lowest, an extrapolation goes several times as far as the values differ; above the highest, an order is an accident.
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 3.0
FORMAL_ORDER = 2.0    # of linear shape functions: the grid convergence index takes no higher one
SAFETY_FACTOR = 1.25  # of the grid convergence index for three sizes [Roache 1994, 1998]
_STEADY_WITHIN = 1.0  # orders of successive sizes that differ by more are UNSTEADY


@dataclass(frozen=True)
class Extrapolation:
    """What values at several sizes of cells tell.

    order         observed order, also one that is not believed; infinite above 20
    extrapolated  value for cells of no size, in the unit of the number
    uncertainty   grid convergence index of the finest value, in the unit of the number
    """

    verdict: str = NO_VALUE
    trend: str = STAYS
    order: float | None = None
    extrapolated: float | None = None
    uncertainty: float | None = None

    @property
    def is_told(self) -> bool:
        """Whether there is an extrapolated value."""
        return self.verdict in (CONVERGES, CONSTANT)


def observed_order(change_coarse: float, change_fine: float, ratio_coarse: float, ratio_fine: float) -> float | None:
    """The order p of three values with changes of one sign: the root of
    ratio_fine^p (ratio_coarse^p - 1) / (ratio_fine^p - 1) = change_coarse / change_fine,
    eq. 3 of Celik, Ghia, Roache, Freitas, Coleman & Raad 2008 (J. Fluids Eng. 130, 078001).  None if no positive p solves it: the changes
    do not fall with the sizes.  Infinite above 20.

    ratio_coarse, ratio_fine  sizes of cells over the next smaller ones, above 1

    The equation is solved by bisection: its left side grows with p, and their fixed-point iteration fails where
    ratio_coarse > ratio_fine^2.
    """
    largest, halvings = 20.0, 60
    wanted, coarse, fine = math.log(change_coarse / change_fine), math.log(ratio_coarse), math.log(ratio_fine)

    def log_of_changes(p: float) -> float:
        return p * fine + math.log(math.expm1(p * coarse) / math.expm1(p * fine))

    if not wanted > math.log(coarse / fine):  # the limit for p = 0
        return None
    if wanted > log_of_changes(largest):
        return math.inf
    low, high = 0.0, largest
    for _ in range(halvings):
        middle = (low + high) / 2
        low, high = (middle, high) if log_of_changes(middle) < wanted else (low, middle)
    return (low + high) / 2


def extrapolate(sizes: Sequence[float], values: Sequence[float], floor: float) -> Extrapolation:
    """Judges values at sizes of cells [m], from coarse to fine, at least three of each.  The three finest count; coarser ones only have to
    agree.  Extrapolated value: eq. 5, grid convergence index: eq. 7 of Celik et al. 2008, with the order limited to FORMAL_ORDER.

    floor  differences up to this, in the unit of the values, are rounding
    """
    if not all(map(math.isfinite, values)):
        return Extrapolation()
    verdict, order = _judge(sizes[-3:], values[-3:], floor)
    trend, value = _trend_of(values, floor), values[-1]
    if verdict == CONSTANT and trend == STAYS:
        return Extrapolation(verdict, trend, None, value, max(values) - min(values))
    if verdict == CONSTANT:  # only the finest are equal
        verdict = UNDECIDED
    if verdict != CONVERGES or order is None:
        return Extrapolation(verdict, trend, order)
    if len(sizes) > 3:
        before = _judge(sizes[-4:-1], values[-4:-1], floor)[1]
        if before is None or abs(before - order) > _STEADY_WITHIN:
            return Extrapolation(UNSTEADY, trend, order)

    def share(power: float) -> float:
        return (values[-2] - value) / math.expm1(power * math.log(sizes[-2] / sizes[-1]))

    return Extrapolation(verdict, trend, order, value - share(order), SAFETY_FACTOR * abs(share(min(order, FORMAL_ORDER))))


def _judge(sizes: Sequence[float], values: Sequence[float], floor: float) -> tuple[str, float | None]:
    """The verdict on three values, and their order if there is one."""
    coarse, fine = values[0] - values[1], values[1] - values[2]
    if abs(fine) <= floor:
        return CONSTANT if abs(coarse) <= floor else UNDECIDED, None
    if abs(coarse) <= floor:
        return DIVERGES, None
    if (coarse > 0) != (fine > 0):
        return OSCILLATES if abs(fine) < abs(coarse) else OSCILLATES_AND_GROWS, None
    order = observed_order(coarse, fine, sizes[0] / sizes[1], sizes[1] / sizes[2])
    if order is None:
        return DIVERGES, None
    return ORDER_LOW if order < LOWEST_ORDER else ORDER_HIGH if order > HIGHEST_ORDER else CONVERGES, order


def _trend_of(values: Sequence[float], floor: float) -> str:
    changes = [finer - coarser for coarser, finer in zip(values, values[1:])]
    up, down = any(change > floor for change in changes), any(change < -floor for change in changes)
    return TURNS if up and down else RISES if up else FALLS if down else STAYS
