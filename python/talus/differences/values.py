"""Matching of the items of two runs and comparison of their values, independent of files."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

SAME_TIME = 1e-12  # relative; two runs may add the same steps in another order


class Pairs(NamedTuple):
    """The matched rows of two lists, and unmatched ones."""

    a: np.ndarray       #: (pairs,) rows of the first list, in ascending order of what is matched
    b: np.ndarray       #: (pairs,) those of the second one
    only_a: np.ndarray  #: rows without a partner
    only_b: np.ndarray


def match_times(a: np.ndarray, b: np.ndarray) -> Pairs:
    """Matches times that are equal within a relative 1e-12.  Both lists must ascend."""
    if not len(a) or not len(b):
        nothing = np.array([], int)
        return Pairs(nothing, nothing, np.arange(len(a)), np.arange(len(b)))
    after = np.clip(np.searchsorted(b, a), 0, len(b) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(np.abs(b[before] - a) < np.abs(b[after] - a), before, after)
    same = np.abs(b[nearest] - a) <= SAME_TIME * np.maximum(np.abs(a), np.abs(b[nearest]))
    rows, partners = np.flatnonzero(same), nearest[same]
    return Pairs(rows, partners, np.flatnonzero(~same), np.setdiff1d(np.arange(len(b)), partners))


def match_ids(a: np.ndarray, b: np.ndarray) -> Pairs:
    """Matches ids in any order; no id may be repeated in a list."""
    _, rows, partners = np.intersect1d(a, b, assume_unique=True, return_indices=True)
    alone = (np.setdiff1d(np.arange(len(one)), matched) for one, matched in ((a, rows), (b, partners)))
    only_a, only_b = (one[np.argsort(ids[one], kind="stable")] for one, ids in zip(alone, (a, b)))
    return Pairs(rows, partners, only_a, only_b)


def largest_modulus(values: np.ndarray) -> float:
    """The largest absolute value among the finite numbers; 0 if there are none."""
    return float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))


class Gap(NamedTuple):
    """The difference between values of two runs.

    values     number of compared values
    differing  number of those with a difference above the tolerance
    largest    the largest |a - b|; infinite if only one is a number, or only one is infinite
    row        of the largest difference, among the compared ones
    component  of the largest difference
    a, b       the two values
    """

    values: int = 0
    differing: int = 0
    largest: float = 0.0
    row: int = 0
    component: int = 0
    a: float = 0.0
    b: float = 0.0


def compare(a: np.ndarray, b: np.ndarray, tolerance: float) -> Gap:
    """Compares values, (rows,) or (rows, components) each.  They differ if their difference is above `tolerance` (same unit), or if only
    one is nan or infinite; nan equals nan, and 0 equals -0."""
    a, b = (np.asarray(values, float).reshape(len(values), -1) for values in (a, b))
    if not a.size:
        return Gap()
    with np.errstate(invalid="ignore", over="ignore"):
        apart = np.abs(a - b)
    apart[(a == b) | (np.isnan(a) & np.isnan(b))] = 0.0
    apart[np.isnan(apart)] = np.inf
    row, component = (int(number) for number in np.unravel_index(np.argmax(apart), apart.shape))
    differing = int(np.count_nonzero((apart > tolerance) | np.isinf(apart)))  # infinite ones count even with an infinite tolerance
    return Gap(a.size, differing, float(apart[row, component]), row, component, float(a[row, component]), float(b[row, component]))
