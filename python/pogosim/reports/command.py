"""`pogosim analyze`: finds the analysis and leaves the rest of the command line to it."""

from __future__ import annotations

import functools
import sys
from collections.abc import Sequence

from pogosim.command.parser import complain, warn
from pogosim.extensions import ExtensionError, Own, Table
from pogosim.lines import say, say_error
from pogosim.nearest_name import listed, unknown
from pogosim.outputs import check_readable
from pogosim.reports.command_lines import Analysis

ANALYSES = Table(
    "pogosim.analyses",
    "analysis",
    "a pogosim.reports.command_lines.Analysis",
    lambda found: isinstance(found, Analysis),
    {
        name: Own(f"pogosim.reports.command_lines:{name.upper()}")
        for name in ("locomotion", "neighbors", "network", "coverage", "collective", "messages", "arena")
    },
)


def usage(prog: str) -> list[str]:
    """Return what `pogosim analyze --help` prints."""
    return [
        f"usage: {prog} ANALYSIS -i FILE -o DIR [OPTIONS]",
        "",
        "Computes what robots did, and writes tables (CSV) and figures (PDF, PNG).",
        "",
        "Analyses:",
        *listed(ANALYSES.listed(functools.partial(warn, prog))),
        "",
        f"{prog} ANALYSIS --help prints the options of an analysis.",
    ]


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim analyze") -> int:
    """Run the command line. Returns the exit code, which is 2 for wrong usage."""
    name, *rest = list(sys.argv[1:] if arguments is None else arguments) or [""]
    if name in ("-h", "--help", "help"):
        say(*usage(prog))
        return 0
    if not name:
        say_error(*usage(prog))
        return 2
    try:
        if ANALYSES.find(name) is None:
            return complain(prog, unknown("analysis", name, ANALYSES.names(), f"{prog} --help lists all analyses"))
    except ExtensionError as error:
        return complain(prog, error)
    return analyze(name, rest, f"{prog} {name}")


def analyze(name: str, arguments: Sequence[str] | None, prog: str) -> int:
    """Run the command line of an analysis. Returns the exit code, which is 2 for wrong usage or data."""
    try:
        analysis: Analysis = ANALYSES.load(name)
    except ExtensionError as error:
        return complain(prog, error)
    options = analysis.parser(prog).parse_args(arguments)
    try:
        check_readable(options.input)
    except OSError as error:
        return complain(prog, f"{error.filename}: {(error.strerror or str(error)).lower()}")
    from pogosim.reports.options import reported  # takes a while

    try:
        work = analysis.work
    except ExtensionError as error:
        return complain(prog, error)
    return reported(prog, options, work)


if __name__ == "__main__":
    sys.exit(main())
