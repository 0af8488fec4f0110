"""`pogosim compare-brains`: where a program in C and its firmware begin to differ."""

from __future__ import annotations

import argparse
import contextlib
import functools
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pogosim.command.parser import Parser, complain, finite, guarded, setting, warn, whole
from pogosim.errors import ToolError
from pogosim.extensions import let_find_models
from pogosim.firmware.making import FirmwareError, made_in, temporary_project
from pogosim.installation import find_installation
from pogosim.lines import say
from pogosim.projects import run_make

if TYPE_CHECKING:
    from pogosim.firmware.comparing import Difference

EPILOG = """PROGRAM is the folder of a project, or a .c or .cpp file; it is built as a program in C and as firmware
(make emu). Both run with the same seed, where code takes no time and random numbers are the simulator's, and with the
parameters of the source. Compared are ticks, LEDs, poses, messages and USERDATA after each step. The exit code is 1 if
anything differs."""


@contextlib.contextmanager
def built(what: Path) -> Iterator[tuple[Path, Path]]:
    """Build a project or source file; gives its shared object and its firmware, until the end of the block.

    Raises:
        ToolError: It cannot be built.
        OSError: It cannot be read.
    """
    pogosim = find_installation()
    folder: contextlib.AbstractContextManager[Path]
    if what.is_dir():
        folder = contextlib.nullcontext(what)
    elif what.suffix in (".c", ".cpp") and what.is_file():
        folder = temporary_project(what, pogosim)
    else:
        raise FirmwareError(f"there is no project, .c or .cpp file {what}, which could be built in both ways")
    with folder as project:
        firmware = made_in(project, what, pogosim)
        run_make(project, "sim", pogosim, what)
        yield project / f"{project.resolve().name}.so", firmware


def shown(value: Any) -> str:
    """Return a value of one robot as text."""
    return " ".join(str(value).split())


def own_setting(text: str) -> tuple[str, Any]:
    """Return the key and the value that `--set` gives."""
    key, value = setting(text)
    if key.split(".")[0] == "parameters":
        raise argparse.ArgumentTypeError(f"{key}: both runs have the parameters of the source; change them there")
    return key, value


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(
        prog=prog,
        usage=f"{prog} PROGRAM -c CONFIG [OPTIONS]",
        description="Runs a program in C and its firmware side by side, and lists the first tick and variable that "
        "differ.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("program", metavar="PROGRAM", type=Path, help="folder of a project, or .c or .cpp file")
    made.add_argument("-c", "--config", metavar="FILE", type=Path, help="configuration; default: conf/test.yaml in it")
    made.add_argument(
        "-s", "--seed", metavar="N", type=whole(0), help="random seed; default: that of the configuration"
    )
    made.add_argument(
        "--set",
        metavar="KEY=VALUE",
        type=own_setting,
        action="append",
        default=[],
        dest="settings",
        help="value of a key of the configuration, such as objects.robots.nb=50; may be repeated",
    )
    made.add_argument("--category", metavar="NAME", default="robots", help="whose robots (default: %(default)s)")
    made.add_argument("--until", metavar="S", type=finite, default=math.inf, help="simulated time to compare, s")
    made.add_argument(
        "--tolerance",
        metavar="X",
        type=finite,
        default=0.0,
        help="by which share of their size, and this much, numbers with a fraction may differ (default: %(default)s)",
    )
    made.add_argument("--most", metavar="N", type=whole(1), default=20, help="variables to list (default: %(default)s)")
    return made


def compare(options: argparse.Namespace) -> int:
    """Compare as the options say. Returns the exit code: 0 equal, 1 different.

    Raises:
        ToolError: It cannot be done.
        OSError: A file cannot be read.
    """
    from pogosim.firmware.comparing import Comparison  # takes a while
    from pogosim.simulation import SimulationError

    if options.config is None and not options.program.is_dir():
        raise FirmwareError("expected a configuration: -c CONFIG")
    configuration = options.config or options.program / "conf" / "test.yaml"
    settings = dict(options.settings) | ({} if options.seed is None else {"seed": options.seed})
    try:
        with (
            built(options.program) as (program, firmware),
            Comparison(program, firmware, configuration, options.category, settings) as comparison,
        ):
            if comparison.robots == 0:
                raise FirmwareError(
                    f"{configuration} has no robots of the category '{options.category}' that run the program"
                )
            comparison.tolerance = options.tolerance
            found = comparison.run(options.until, options.most)
            robots, time_s, without = comparison.robots, comparison.time_s, comparison.without_user_data
    except SimulationError as error:
        raise ToolError(str(error)) from None
    if not found:
        say(f"equal for {time_s:g} s: {robots} robots do the same as a program and as firmware")
    else:
        say(*table_of(found))
    if without:
        say(f"there is no USERDATA to compare: {without}")
    return 1 if found else 0


def table_of(found: Sequence[Difference]) -> list[str]:
    """Return lines that list differences."""
    rows = [("time (s)", "tick", "robot", "variable", "program", "firmware")]
    rows += [
        (f"{d.time_s:.3f}", str(d.tick), f"#{d.robot}", d.name, shown(d.program), shown(d.firmware)) for d in found
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return ["  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim compare-brains") -> int:
    """Run the command. Returns its exit code: 0 equal, 1 different, 2 nothing could be compared."""
    options = parser(prog).parse_args(sys.argv[1:] if arguments is None else arguments)
    if not options.program.exists():
        return complain(prog, f"there is no project, .c or .cpp file {options.program}")
    let_find_models(functools.partial(warn, prog))
    return guarded(prog, lambda: compare(options), options.program)
