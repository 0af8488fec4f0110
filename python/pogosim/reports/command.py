"""`pogosim analyze`: finds the analysis and leaves the rest of the command line to it."""

from __future__ import annotations

import argparse
import functools
import sys
from collections.abc import Sequence
from typing import Any

from pogosim.arguments import shown
from pogosim.command.parser import complain, warn
from pogosim.errors import ToolError
from pogosim.extensions import ExtensionError, Own, Table, takes
from pogosim.lines import say, say_error
from pogosim.nearest_name import listed, unknown
from pogosim.outputs import check_readable
from pogosim.reports.command_lines import Analysis


def is_analysis(found: Any) -> bool:
    """Tell whether something is an analysis that can be called."""
    return (
        isinstance(found, Analysis)
        and takes(found.parser, "prog")
        and (isinstance(found.analyze, str) or takes(found.analyze, "options", "prog"))
    )


ANALYSES = Table(
    "pogosim.analyses",
    "analysis",
    "a pogosim.reports.command_lines.Analysis with functions parser(prog) and analyze(options, prog)",
    is_analysis,
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
        with ANALYSES.calling(name, may_exit=True):
            options = options_of(analysis, arguments, prog)
        check_readable(options.input)
        work = analysis.work
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, f"{error.filename}: {(error.strerror or str(error)).lower()}")
    from pogosim.reports.options import reported  # takes a while

    def called(options: argparse.Namespace, prog: str) -> None:
        with ANALYSES.calling(name):
            work(options, prog)

    return reported(prog, options, called)


def options_of(analysis: Analysis, arguments: Sequence[str] | None, prog: str) -> argparse.Namespace:
    """Return what the command line of an analysis says.

    Raises:
        TypeError: Its parser, which may be of another package, is none, or lacks the options of all analyses.
    """
    parser = analysis.parser(prog)
    if not isinstance(parser, argparse.ArgumentParser):
        raise TypeError(f"parser() returned {shown(parser)}, expected what analysis_parser() returns")
    options = parser.parse_args(arguments)
    if missing := [option for option in ("input", "output_dir") if not hasattr(options, option)]:
        raise TypeError(f"its parser has no option for {' and '.join(missing)}, which that of analysis_parser() has")
    return options


if __name__ == "__main__":
    sys.exit(main())
