"""How often robots should send so that most of their messages are received."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pogosim.communication.reception_law import DynamicLaw, Law
from pogosim.errors import ToolError

# What compute_optimal_psend takes for the four-parameter law. They are not those of `type: realistic`.
SENDING_DEFAULTS = {"alpha": 1e-6, "beta": 3.0708, "gamma": 2.3234, "delta": 1.1897}


class SendingError(ToolError):
    """There is no best chance to send; says why."""


@dataclass(frozen=True)
class BestSending:
    """The chance to send at which most messages arrive.

    Attributes:
        send_probability: Chance to send in a tick; above 1 only if it was not to be clipped.
        reception_probability: Chance that one receiver gets a message, 0 to 1.
        messages_per_tick: cluster size x chance to send x chance of reception: messages of the whole cluster that one
            receiver gets per tick (if it were to hear itself, too).
    """

    send_probability: float
    reception_probability: float
    messages_per_tick: float


def messages_per_tick(law: Law, message_bytes: float, send_probability: float, cluster_size: float) -> float:
    """Return c p P(m, p, c), the messages per tick that get through in a cluster. Arguments as in the laws."""
    chance = float(law.probability(message_bytes, send_probability, cluster_size))
    return cluster_size * send_probability * chance


def best_sending(law: Law, message_bytes: float, cluster_size: float, *, clip: bool = True) -> BestSending:
    """Return the chance to send that maximises the messages that get through, c p P(p).

    Both laws have the form P = 1 / (a + k p^gamma + t p). Where the derivative of p / (a + k p^gamma + t p) is zero,

        a + k p^gamma + t p = p (gamma k p^(gamma - 1) + t),  so  p = (a / (k (gamma - 1)))^(1 / gamma)

    whatever t. It is a maximum if gamma > 1; otherwise sending more is always better. With a < 1, the law may promise
    more than certain reception there, so that P is 1; the best p is then the largest at which P still is.

    Args:
        law: The law of reception; a, k > 0, t >= 0.
        message_bytes: Header and payload, bytes, above 0.
        cluster_size: Robots that hear each other, the sender included, at least 1.
        clip: Return at most 1, what a robot can do.

    Raises:
        SendingError: The law has no maximum, or its parameters are out of range.
    """
    base, collisions, interaction = coefficients(law, message_bytes, cluster_size)
    best = math.inf
    if law.gamma > 1.0 and collisions > 0.0:
        # In logarithms, for large messages.
        best = math.exp(min((math.log(base) - math.log(collisions) - math.log(law.gamma - 1.0)) / law.gamma, 700.0))
        best = last_certain(base, collisions, interaction, law.gamma, best)
    if clip:
        best = min(best, 1.0)
    elif not best < 1e300:
        raise SendingError(
            f"with gamma = {law.gamma:g} and these sizes, sending more is always better: there is no best chance "
            "without clipping to 1"
        )
    chance = float(law.probability(message_bytes, best, cluster_size))
    return BestSending(best, chance, messages_per_tick(law, message_bytes, best, cluster_size))


def coefficients(law: Law, message_bytes: float, cluster_size: float) -> tuple[float, float, float]:
    """Return a, k and t of the denominator a + k p^gamma + t p.

    Raises:
        SendingError: They are not positive, or too large to compute with.
    """
    try:
        if isinstance(law, DynamicLaw):
            collisions = law.beta * cluster_size**law.delta * math.exp(law.zeta * message_bytes)
            found = (law.alpha, collisions, law.theta * cluster_size)
        else:
            found = (1.0, law.alpha * message_bytes**law.beta * cluster_size**law.delta, 0.0)
    except OverflowError:
        found = (math.nan, math.nan, math.nan)
    base, collisions, interaction = found
    if not (0.0 < base < math.inf and 0.0 <= collisions < math.inf and 0.0 <= interaction < math.inf):
        raise SendingError("the law cannot be computed with these parameters and sizes; choose others, not below 0")
    return found


def last_certain(base: float, collisions: float, interaction: float, gamma: float, best: float) -> float:
    """Return the largest p from `best` on at which the law still promises at least certain reception, or `best`."""

    def excess(p: float) -> float:
        return base + collisions * float(p**gamma) + interaction * p - 1.0

    if base >= 1.0 or excess(best) >= 0.0:
        return best
    low, high = best, best
    while excess(high) < 0.0:
        high *= 2.0
    for _ in range(200):  # bisection to the last digit
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return low
