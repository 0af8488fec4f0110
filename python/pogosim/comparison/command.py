"""Tell where two runs or two batches differ.

pogosim compare before.feather after.feather
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, finite, guarded, whole
from pogosim.errors import ToolError
from pogosim.outputs import check_readable, checked_output

FIGURES = ("png", "pdf", "svg")
TESTS = ("mann-whitney", "permutation")

EPILOG = """Configurations, versions and seeds are compared; the rows of two files, to see where they begin to
differ; and for batches with several runs each, the means of displacement, speed, neighbours, order and the
columns of the program, over time and at the end, with a test that is corrected for their number (Holm).

The exit code is 0 if the results are equal: the same rows or, for batches with different seeds, no number whose
distribution differs. It is 1 if they differ, and 2 if they cannot be compared."""


def level(text: str) -> float:
    """Return a level of significance from the command line."""
    if not 0.0 < (value := finite(text)) < 1.0:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1")
    return value


def tolerance(text: str) -> float:
    """Return a tolerance from the command line."""
    if (value := finite(text)) < 0.0:
        raise argparse.ArgumentTypeError(f"{text} is below 0")
    return value


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(
        prog=prog,
        description="Tells where two runs or two batches differ.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = made.add_argument
    add("a", metavar="A.feather", help="data file of a run or a batch, or a pattern of several in quotes")
    add("b", metavar="B.feather", help="the other one")
    add("-o", "--output", metavar="FILE", help="figure of the numbers of both over time (.png, .pdf, .svg)")
    add("--json", action="store_true", help="print all as JSON")
    add(
        "--tolerance",
        type=tolerance,
        default=0.0,
        metavar="X",
        help="by which share of their size, and this much, numbers with a fraction may differ in rows (%(default)g)",
    )
    add("--no-rows", action="store_true", help="do not compare rows, only distributions: for batches of the same seeds")
    add(
        "--level",
        type=level,
        default=0.05,
        metavar="P",
        help="level of significance of all tests together (%(default)g)",
    )
    add("--test", choices=TESTS, default=TESTS[0], help="test of two samples (%(default)s)")
    add("--category", metavar="NAME", help="objects of the numbers (robots, or all with a program)")
    add("--most", type=whole(1), default=20, metavar="N", help="lines of a list (%(default)s)")
    add("-q", "--quiet", action="store_true", help="say only whether they differ")
    return made


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim compare") -> int:
    """Run the command line; returns the exit code: 0 equal, 1 different, 2 they cannot be compared."""
    options = parser(prog).parse_args(sys.argv[1:] if arguments is None else arguments)

    def compare() -> int:
        if options.output is not None:
            for name in (options.a, options.b):
                wrong = f"{options.output}: unknown format of a figure; let it end in .{', .'.join(FIGURES)}"
                checked_output(options.output, name, FIGURES, wrong, "figure", "the data file ")
        check_readable([options.a, options.b])
        from pogosim.comparison.work import compare_files  # takes a while

        return compare_files(options, prog)

    try:
        return guarded(prog, compare)
    except MemoryError:
        return complain(prog, ToolError("there is not enough memory"))


if __name__ == "__main__":
    sys.exit(main())
