"""`pogosim best-psend`: the chance to send at which most messages arrive."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, finite, positive
from pogosim.communication.reception_law import LAWS, DynamicLaw, Law, PowerLaw, parameter_names, parameters_of
from pogosim.communication.sending import SENDING_DEFAULTS, SendingError, best_sending
from pogosim.lines import say


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
