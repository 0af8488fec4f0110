"""How often robots should send so that most of their messages are received: `pogosim best-psend`."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass

from pogosim.command.parser import Parser, complain, finite, positive
from pogosim.communication.reception_law import LAWS, DynamicLaw, Law, PowerLaw, parameter_names, parameters_of
from pogosim.errors import ToolError
from pogosim.lines import say

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


# ---- The command ----


def cluster(text: str) -> float:
    """Return a number of robots from the command line, at least 1."""
    if (value := finite(text)) < 1.0:
        raise argparse.ArgumentTypeError(f"{text} is less than 1; the sender counts, too")
    return value


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(
        prog=prog,
        description="Prints the chance to send, per tick, at which most messages arrive in a cluster of robots that "
        "all send as often: the maximum of c p P(p), with P of a law of reception (docs/communication.md).",
    )
    made.add_argument(
        "-c",
        "--cluster",
        "--cluster-size",
        "--cluster_size",
        type=cluster,
        required=True,
        help="robots in the cluster, the sender included",
    )
    made.add_argument(
        "-m", "--msg-size", "--msg_size", type=positive, required=True, help="size of messages with their header, bytes"
    )
    made.add_argument(
        "--law",
        choices=list(LAWS),
        default=PowerLaw.NAME,
        help="power: 1/(1 + alpha m^beta p^gamma c^delta) (default); dynamic: the article's equation",
    )
    for name in parameter_names(DynamicLaw):
        short = [] if name in ("zeta", "theta") else [f"-{name[0]}"]
        defaults = ", ".join(f"{law}: {by_name[name]:g}" for law, by_name in all_defaults().items() if name in by_name)
        made.add_argument(*short, f"--{name}", type=finite, help=f"parameter of the law ({defaults})")
    made.add_argument(
        "-f",
        "--frequency",
        type=positive,
        default=30.0,
        metavar="HZ",
        help="ticks per second (%(default)g, as in the article; a program that does not set main_loop_hz has 60)",
    )
    made.add_argument(
        "-u", "--no-clip", "--no_clip", action="store_true", help="print the maximum of the formula even if above 1"
    )
    return made


def all_defaults() -> dict[str, dict[str, float]]:
    """Return the parameters of each law that hold unless others are given."""
    return {"power": SENDING_DEFAULTS, "dynamic": parameters_of(DynamicLaw())}


def law_of(options: argparse.Namespace) -> Law:
    """Return the law that the options describe.

    Raises:
        SendingError: A parameter of another law is given.
    """
    names = parameter_names(LAWS[options.law])
    given = {name: value for name in parameter_names(DynamicLaw) if (value := getattr(options, name)) is not None}
    foreign = [name for name in given if name not in names]
    if foreign:
        raise SendingError(f"the law '{options.law}' has no parameter {foreign[0]}; choose --law dynamic for it")
    return LAWS[options.law](**(all_defaults()[options.law] | given))


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim best-psend") -> int:
    """Run the command. Returns its exit code: 0 done, 2 there is no such chance."""
    options = parser(prog).parse_args(arguments)
    try:
        law = law_of(options)
        best = best_sending(law, options.msg_size, options.cluster, clip=not options.no_clip)
    except SendingError as error:
        return complain(prog, error)
    shown = ", ".join(f"{name} {value:g}" for name, value in parameters_of(law).items())
    say(f"law: {law.NAME} ({shown})")
    say(f"cluster of {options.cluster:g} robots, messages of {options.msg_size:g} bytes")
    say(f"best chance to send per tick: p* = {best.send_probability:.4f}")
    if best.send_probability <= 1.0:
        say(f"percent_msgs_sent_per_ticks: {max(1, round(100.0 * best.send_probability))}")
    say(f"probability of reception: {best.reception_probability:.4f}")
    say(f"expected messages per step: {best.messages_per_tick:.4f}")
    say(f"expected messages per second: {best.messages_per_tick * options.frequency:.4f} (at {options.frequency:g} Hz)")
    return 0
