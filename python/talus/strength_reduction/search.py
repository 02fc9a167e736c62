"""The search for a factor of safety: the verdict on a trial, and the choice of the next factors."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import RunFailed
from ..tables import Table

HOLDS, FAILS, UNCLEAR = "holds", "fails", "unclear"
FARTHEST = 8      # how far the range is extended
CLEAR_MARGIN = 5  # a growth that is below or above its limit by this factor decides alone
_FAR = 0.1        # of the height: what has moved farther has failed, also if it has come to rest


@dataclass(frozen=True)
class AtRest:
    """Properties of the bodies before their strength is divided."""

    gravity: float     #: [m/s^2]
    height: float      #: of the bodies along gravity [m]
    wave_speed: float  #: lowest wave speed of their materials [m/s]

    @property
    def settlement(self) -> float:
        """The settlement of a body of this height under its own weight, rho g h^2 / (rho c^2) [m]."""
        return self.gravity * self.height * self.height / (self.wave_speed * self.wave_speed)


def usual_duration(bodies: AtRest) -> float:
    """The default duration of a trial [s]: three times sqrt(height / gravity), or twenty wave transit times, whichever is longer; rounded
    to two digits."""
    value = max(3 * math.sqrt(bodies.height / bodies.gravity), 20 * bodies.height / bodies.wave_speed)
    digit = 10 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.floor(value / digit + 0.5) * digit:.6g}")


@dataclass(frozen=True)
class Motion:
    """Measures of whether a slope fails, from the history after its strength was divided."""

    moved: float              #: displacement at the end, the largest of the columns [m]
    growth: float             #: displacement in the second half of the time over that in the first half, or over half of the settlement [-]
    liveliness: float | None  #: kinetic energy in the last tenth of the time over its peak [-]; None for equilibria, which have none
    steadiness: float | None  #: of equilibria: displacement in the last third over that in the middle third [-]
    duration: float           #: of the trial [s]
    lost: float = 0.0         #: share of the mass that has left in the trial [-]
    far: bool = False         #: whether it has moved farther than what stands can: a tenth of the height, or the settlement if that is more


def motion_of(history: Table, moved: Sequence[str], bodies: AtRest) -> Motion | None:
    """The measures of a history; None if it does not have the columns, or has less than two rows."""
    if any(name not in history for name in ("time", "kinetic", "mass", *moved)) or history.rows < 2:
        return None
    time, kinetic = history["time"], history["kinetic"]
    largest = np.max([np.zeros(len(time)), *(np.nan_to_num(history[name], nan=0.0) for name in moved)], axis=0)
    duration, end = float(time[-1] - time[0]), float(largest[-1])

    def at(share: float) -> float:
        return _value_at(time[0] + share * duration, time, largest)

    first = max(at(0.5), 0.5 * bodies.settlement)
    growth = (end - at(0.5)) / first if first > 0 else 0.0
    liveliness = steadiness = None
    if (peak := float(np.max(kinetic))) > 0:
        late = kinetic[time >= time[-1] - 0.1 * duration]
        liveliness = sum(late.tolist()) / len(late) / peak
    else:
        middle, last = at(2 / 3) - at(1 / 3), end - at(2 / 3)
        steadiness = last / middle if middle > 0 else math.inf if last > 0 else 0.0
    lost = 1 - float(history["mass"][-1] / history["mass"][0])
    return Motion(end, growth, liveliness, steadiness, duration, lost, end > max(_FAR * bodies.height, bodies.settlement))


def _value_at(time: float, times: np.ndarray, values: np.ndarray) -> float:
    """The value at a time, linear between rows."""
    after = int(np.searchsorted(times, time))
    if after in (0, len(times)):
        return float(values[0 if after == 0 else -1])
    share = (time - times[after - 1]) / (times[after] - times[after - 1])
    return float(values[after - 1] + share * (values[after] - values[after - 1]))


@dataclass(frozen=True)
class Criterion:
    """The limits of the measures above which the slope counts as failing."""

    growth: float = 0.1
    liveliness: float = 5e-4
    steadiness: float = 0.5
    lost: float = 0.01


def judge(motion: Motion, criterion: Criterion) -> str:
    """The verdict on a trial.

    What has moved far has failed even if it lies still at the end, and so has ground of which a part has left.
    A growth that is far below or above its limit decides alone: particles may oscillate, and where hardly anything moves the peak is as
    small.  In between both measures have to agree; if they contradict each other the verdict is unclear.  Equilibria fail if growth and
    steadiness are above their limits: what comes to rest moves less and less.
    """
    if motion.far or motion.lost > criterion.lost:
        return FAILS
    if motion.steadiness is not None:
        return HOLDS if motion.growth <= criterion.growth or motion.steadiness <= criterion.steadiness else FAILS
    if motion.growth <= criterion.growth / CLEAR_MARGIN:
        return HOLDS
    if motion.growth > criterion.growth * CLEAR_MARGIN:
        return FAILS
    grows = not motion.growth <= criterion.growth
    moves = motion.liveliness is not None and not motion.liveliness <= criterion.liveliness
    return UNCLEAR if grows != moves else FAILS if grows else HOLDS


@dataclass(frozen=True)
class Trial:
    """A factor with its result."""

    factor: float
    verdict: str
    motion: Motion | None = None   #: None if the run failed
    by_growth_alone: bool = False  #: the measures contradicted each other also in the longest trial
    message: str = ""              #: of a run that failed


@dataclass(frozen=True)
class Bracket:
    """The factor of safety is above `low`, the highest below `high` that holds, and below `high`, the lowest that fails."""

    low: float | None
    high: float | None
    out_of_order: list[float] = field(default_factory=list)  #: factors above `high` that hold

    def is_narrow(self, width: float) -> bool:
        """Whether both ends are known, and no farther apart than `width`."""
        return self.low is not None and self.high is not None and self.high - self.low <= width * (1 + 1e-9)


def bracket_of(trials: Sequence[Trial]) -> Bracket:
    """What the trials enclose."""
    high = min((trial.factor for trial in trials if trial.verdict == FAILS), default=None)
    held = sorted(trial.factor for trial in trials if trial.verdict == HOLDS)
    below = [factor for factor in held if high is None or factor < high]
    return Bracket(below[-1] if below else None, high, held[len(below):])


@dataclass(frozen=True)
class Range:
    """The factors that are tried first, and how close holding and failing ones come."""

    low: float = 0.5
    high: float = 3.0
    width: float = 0.02


def next_factors(trials: Sequence[Trial], asked: Range, jobs: int) -> list[float]:
    """The factors to be tried at the same time, at most `jobs`; none when the bracket is narrow enough.

    First the ends of the range, which is extended up to FARTHEST times, then equal parts inside, at multiples of half the width.
    Raises RunFailed if all factors hold or all fail.
    """
    bracket = bracket_of(trials)
    if bracket.low is None or bracket.high is None:
        return _ends(trials, bracket, asked)[:jobs]
    grid, left = asked.width / 2, bracket.high - bracket.low
    if bracket.is_narrow(asked.width):
        return []
    enough = math.ceil(left / asked.width * (1 - 1e-9)) - 1
    parts = min(max(enough, 1), jobs) + 1
    found: list[float] = []
    for k in range(1, parts):
        factor = float(f"{math.floor((bracket.low + left * k / parts) / grid + 0.5) * grid:.9g}")
        if bracket.low < factor < bracket.high and (not found or factor > found[-1]):
            found.append(factor)
    return found


def _ends(trials: Sequence[Trial], bracket: Bracket, asked: Range) -> list[float]:
    known = {trial.factor for trial in trials}
    found: list[float] = []
    if bracket.low is None:
        factor = asked.low
        while factor in known:
            factor /= 2
        if factor < asked.low / FARTHEST:
            raise RunFailed(f"fails even where the strength is divided by {2 * factor:.6g}: it does not stand at all, or moves for another "
                            "reason; look at the trials", 1)
        found.append(factor)
    if bracket.high is None:
        factor = asked.high
        while factor in known:
            factor *= 2
        if factor > asked.high * FARTHEST:
            raise RunFailed(f"holds even where the strength is divided by {factor / 2:.6g}: nothing here fails by lack of strength", 1)
        found.append(factor)
    return found
