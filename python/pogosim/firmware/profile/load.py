"""How much of its time a tick takes: on average, at most, and in 95 of 100 ticks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pogosim.firmware.profile.raw import Profile, Tick

PERCENTILE = 95


@dataclass(frozen=True)
class Load:
    """What ticks take, in cycles of the clock, with those that go by in the robots' library.

    Attributes:
        mean: Mean of all ticks.
        percentile: The least value that 95 % of the ticks do not exceed.
        worst: That of the tick which takes most; the first one, if several do.
        worst_tick: This tick.
        share_of_calls: Share of the time that is in functions of the robots' library, 0 to 1.
        share_of_misses: Share in which the processor waits for code that is not in its instruction cache, 0 to 1.
        share_over_budget: Share of the ticks that take more than their budget, 0 to 1; 0 without a main loop.
    """

    mean: float
    percentile: float
    worst: float
    worst_tick: Tick
    share_of_calls: float
    share_of_misses: float
    share_over_budget: float


def percentile(values: Sequence[float], percent: float) -> float:
    """Return the least of the values that a percentage (above 0, to 100) of them do not exceed (nearest rank)."""
    rank = math.ceil(len(values) * percent / 100)
    return sorted(values)[max(rank, 1) - 1]


def load_of(profile: Profile) -> Load:
    """Return what the ticks of a profile take; it has at least one."""
    costs = [profile.cost(tick) for tick in profile.ticks]
    total = sum(costs)
    worst = max(costs)
    of_calls = sum(profile.cycles_during(tick.call_us) for tick in profile.ticks)
    budget = profile.budget_cycles
    return Load(
        mean=total / len(costs),
        percentile=percentile(costs, PERCENTILE),
        worst=worst,
        worst_tick=profile.ticks[costs.index(worst)],
        share_of_calls=of_calls / total if total > 0 else 0.0,
        share_of_misses=sum(tick.miss_cycles for tick in profile.ticks) / total if total > 0 else 0.0,
        share_over_budget=0.0 if budget is None else sum(cost > budget for cost in costs) / len(costs),
    )
