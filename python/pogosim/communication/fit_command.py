"""`pogosim fit-comm`: fits a law of reception to measurements."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, finite, positive, whole
from pogosim.communication.fit_settings import OBJECTIVES
from pogosim.communication.reception_law import LAWS, SHORT_HEADER_BYTES, parameter_names

RESULTS = "model_final_results.json"
RESIDUALS = "model_residuals.csv"


def assignment(text: str) -> tuple[str, str]:
    """Split NAME=VALUE."""
    name, equals, value = text.partition("=")
    if not equals or not name:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form NAME=...")
    return name.strip(), value


def fixed_value(text: str) -> tuple[str, float]:
    """Return the parameter and value of NAME=VALUE."""
    name, value = assignment(text)
    return name, finite(value)


def bounds(text: str) -> tuple[str, tuple[float, float]]:
    """Return the parameter and bounds of NAME=LOW:HIGH."""
    name, value = assignment(text)
    low, colon, high = value.partition(":")
    if not colon:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form NAME=LOW:HIGH")
    return name, (finite(low), finite(high))


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(
        prog=prog,
        description="Fits a law of reception over infrared to measurements (docs/communication.md), and prints "
        "how well it fits and the lines for a configuration.",
    )
    made.add_argument(
        "data",
        nargs="?",
        metavar="DATA.csv",
        help="measurements, with the columns payload_size (bytes), nb_neighbors (or cluster_size), p_send and "
        "success_probability; without it, those of real robots",
    )
    made.add_argument("--example", action="store_true", help="fit the measurements of real robots, the default")
    made.add_argument("-o", "--output-dir", metavar="DIR", help=f"folder for {RESULTS}, {RESIDUALS} and pictures")
    made.add_argument(
        "--law", choices=list(LAWS), default="dynamic", help="dynamic: the article's equation (default); power: older"
    )
    made.add_argument(
        "--objective",
        choices=OBJECTIVES,
        default="r2",
        help="r2: least squares (default); huber: strange measurements count for less",
    )
    made.add_argument(
        "--huber-delta", type=positive, default=0.1, help="residual from which Huber's loss is linear (%(default)g)"
    )
    names = ", ".join(parameter_names(LAWS["dynamic"]))
    made.add_argument(
        "--bounds",
        type=bounds,
        action="append",
        default=[],
        metavar="NAME=LOW:HIGH",
        help=f"of {names}; may be repeated",
    )
    made.add_argument(
        "--fix", type=fixed_value, action="append", default=[], metavar="NAME=VALUE", help="do not fit this parameter"
    )
    made.add_argument(
        "--header-bytes",
        type=whole(0, 1000),
        default=SHORT_HEADER_BYTES,
        metavar="N",
        help="header of the messages: 3 in short ones (default), 8 in long ones",
    )
    made.add_argument(
        "--seed", type=whole(1, 2**32 - 10**4), default=42, metavar="N", help="of the search (%(default)s)"
    )
    made.add_argument("--restarts", type=whole(0, 1000), default=2, metavar="N", help="more searches (%(default)s)")
    return made


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim fit-comm") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be fitted, or written."""
    options = parser(prog).parse_args(arguments)
    if options.example and options.data:
        return complain(prog, f"--example stands for the measurements of real robots; leave out it or {options.data}")
    from pogosim.communication.fit_report import fit_measurements  # takes a while

    return fit_measurements(options, prog)
