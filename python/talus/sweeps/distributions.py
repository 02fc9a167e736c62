"""Distributions of uncertain keys, and samples of them."""
from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..calibration.places import Block, Entry, meant
from ..packages import need

KEPT = 3.0         # of a normal distribution: standard deviations to either side, unless low and high are given
ONE_DEVIATION = 0.1586552539314571  # share of a normal distribution that lies below the mean by more than a deviation
_FRIENDLY = ("uniform", "triangular", "normal", "lognormal")


@dataclass(frozen=True)
class Distribution:
    """A distribution of scipy.stats between two values, at which it is cut off.

    law        frozen distribution
    low, high  ends, which may be infinite
    three      values of a tornado: low, middle, high
    """

    law: Any
    low: float
    high: float
    three: tuple[float, float, float]

    def quantile(self, share: np.ndarray | float) -> np.ndarray:
        """The values below which these shares of the distribution lie; shares and values have the same shape."""
        below, above = self.law.cdf(self.low), self.law.cdf(self.high)
        return np.clip(self.law.ppf(below + np.asarray(share) * (above - below)), self.low, self.high)


def read_distribution(entry: Entry) -> Distribution | None:
    """The distribution in an entry such as {low: 1, high: 2}, {mean: 5, deviation: 1} or {distribution: gamma, a: 2, scale: 3}; None, and
    errors, where there is none."""
    block = Block(entry)
    named = block.take("distribution")
    name = block.text("distribution") if named is not None else ""
    stats = need("scipy.stats", "samples keys")
    before = len(entry.problems.messages)
    shapes: tuple[str, ...] = ()
    if name and name not in _FRIENDLY:
        law = getattr(stats, name, None)
        if not isinstance(law, stats.rv_continuous):
            known = [*_FRIENDLY, *(word for word in dir(stats) if isinstance(getattr(stats, word), stats.rv_continuous))]
            assert named is not None
            named.wrong(f'unknown distribution "{name}"{meant(name, known, "known: those of scipy.stats that are continuous")}')
            return None
        shapes = tuple((law.shapes or "").replace(",", " ").split())
        numbers = {word: _number(block, word) for word in (*shapes, "loc", "scale", "low", "high")}
    else:
        numbers = {word: _number(block, word) for word in _FRIENDLY_KEYS.get(name, ("low", "mode", "high", "mean", "deviation"))}
    block.end()
    if len(entry.problems.messages) > before:
        return None
    given = {word: value for word, value in numbers.items() if value is not None}
    if shapes or (name and name not in _FRIENDLY):
        return _of_scipy(entry, name, shapes, given)
    return _friendly(entry, name, given)


_FRIENDLY_KEYS = {"uniform": ("low", "high"), "triangular": ("low", "mode", "high"), "normal": ("mean", "deviation", "low", "high"),
                  "lognormal": ("mean", "deviation", "low", "high")}


def _number(block: Block, name: str) -> float | None:
    entry = block.take(name)
    value = entry.number() if entry is not None else None
    if entry is not None and value is not None and name in ("deviation", "scale") and value <= 0:
        entry.wrong(f"{value:g} must be > 0")
    return value


def _of_scipy(entry: Entry, name: str, shapes: tuple[str, ...], given: dict[str, float]) -> Distribution | None:
    if missing := [word for word in shapes if word not in given]:
        entry.wrong(f"{name} needs {' and '.join(missing)}, as in scipy.stats.{name}")
        return None
    parameters = {word: value for word, value in given.items() if word not in ("low", "high")}
    law = getattr(need("scipy.stats", "samples keys"), name)(**parameters)
    if not np.isfinite(law.median()):
        entry.wrong(f"these are no parameters of {name}: see scipy.stats.{name}")
        return None
    low, high = law.support()
    return _cut(entry, law, max(low, given.get("low", low)), min(high, given.get("high", high)))


def _friendly(entry: Entry, name: str, given: dict[str, float]) -> Distribution | None:
    """A distribution by its ends, its mean or its mode."""
    stats = need("scipy.stats", "samples keys")
    if ("mean" in given) != ("deviation" in given):
        entry.wrong("mean and deviation belong together")
    elif "mean" in given and "mode" in given:
        entry.wrong("mode is of a triangular distribution, mean of a normal one: one of them")
    elif "mean" not in given and name in ("normal", "lognormal"):
        entry.wrong(f"{name} needs mean and deviation")
    elif "mean" not in given and not {"low", "high"} <= given.keys():
        entry.wrong("low and high are needed, with mode or without; or mean and deviation")
    elif "mode" not in given and name == "triangular":
        entry.wrong("triangular needs low, mode and high")
    elif "mean" not in given:
        low, high = given["low"], given["high"]
        mode = given.get("mode")
        if not _is_between(entry, low, high, "mode", mode):
            return None
        middle = 0.5 * (low + high) if mode is None else mode
        law = stats.uniform(low, high - low) if mode is None else stats.triang((mode - low) / (high - low), low, high - low)
        return Distribution(law, low, high, (low, middle, high))
    elif name == "lognormal":
        if given["mean"] <= 0:
            entry.wrong(f"the mean {given['mean']:g} must be > 0, of a lognormal distribution")
            return None
        variance = np.log1p((given["deviation"] / given["mean"])**2)
        law = stats.lognorm(np.sqrt(variance), scale=given["mean"] * np.exp(-variance / 2))
        return _cut(entry, law, max(0.0, given.get("low", 0.0)), given.get("high", np.inf))
    else:
        mean, deviation = given["mean"], given["deviation"]
        low, high = given.get("low", mean - KEPT * deviation), given.get("high", mean + KEPT * deviation)
        if not _is_between(entry, low, high, "mean", mean):
            return None
        return Distribution(stats.norm(mean, deviation), low, high, (max(low, mean - deviation), mean, min(high, mean + deviation)))
    return None


def _is_between(entry: Entry, low: float, high: float, name: str, value: float | None) -> bool:
    if not low < high:
        entry.wrong(f"low {low:g} must be below high {high:g}")
    elif value is not None and not low <= value <= high:
        entry.wrong(f"{name} {value:g} is not between low {low:g} and high {high:g}")
    else:
        return True
    return False


def _cut(entry: Entry, law: Any, low: float, high: float) -> Distribution | None:
    """The distribution between two values; its tornado has the median, and the quantiles of one deviation of a normal distribution."""
    if not low < high or not law.cdf(high) - law.cdf(low) > 0:
        entry.wrong(f"no value of this distribution lies between {low:g} and {high:g}")
        return None
    whole = Distribution(law, low, high, (low, low, high))
    three = whole.quantile(np.array([ONE_DEVIATION, 0.5, 1 - ONE_DEVIATION]))
    return Distribution(law, low, high, (float(three[0]), float(three[1]), float(three[2])))


def shares_of(keys: Sequence[str], count: int, seed: int, method: str, correlations: np.ndarray) -> np.ndarray:
    """Samples of the unit cube, (count, keys), with the correlations of a Gaussian copula.

    method        "latin": a Latin hypercube (McKay, Beckman & Conover 1979), with random numbers for each key, so that another key does not
                  change those of this one; correlated keys are put into another order (Iman & Conover 1982).  "sobol": a scrambled sequence
    correlations  (keys, keys), of the normal variables of the copula
    """
    qmc, stats = need("scipy.stats.qmc", "samples keys"), need("scipy.stats", "samples keys")
    linked = np.flatnonzero(np.any(correlations != np.eye(len(keys)), axis=1))
    if method == "sobol":
        power = int(np.ceil(np.log2(count)))  # a whole power of two, of which the first are taken
        shares = qmc.Sobol(len(keys), seed=seed).random_base2(power)[:count]
        shares = np.clip(shares, 0.5 / 2**30, 1 - 0.5 / 2**30)
    else:
        shares = np.hstack([qmc.LatinHypercube(1, seed=np.random.default_rng([seed, zlib.crc32(key.encode())])).random(count)
                            for key in keys])
    if not linked.size:
        return shares
    normal = stats.norm.ppf(shares[:, linked])
    factor = np.linalg.cholesky(correlations[np.ix_(linked, linked)])
    if method == "sobol":
        shares[:, linked] = stats.norm.cdf(normal @ factor.T)
        return shares
    there = np.corrcoef(normal, rowvar=False)  # by chance, and taken out where there are enough samples
    if count > 2 * len(linked):
        normal = normal @ np.linalg.inv(np.linalg.cholesky(there)).T
    order = np.argsort(np.argsort(normal @ factor.T, axis=0), axis=0)
    shares[:, linked] = np.take_along_axis(np.sort(shares[:, linked], axis=0), order, axis=0)
    return shares
