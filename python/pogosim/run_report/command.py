"""Write a report of a run or a batch: one page for the browser, with all that it shows in it.

pogosim report result.feather -o report.html
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from pogosim.command.parser import Parser, positive
from pogosim.outputs import check_readable, checked_output
from pogosim.picture.options import report

PAGE = ("html", "htm")


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(
        prog=prog,
        description="Writes a report of a run or a batch: one page with what was run, the command that repeats it, "
        "warnings, a replay, figures over time and their numbers. It needs no network, and can be printed.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = made.add_argument
    add("data", metavar="DATA.feather", help="data file of a run or a batch, or a pattern of several in quotes")
    add("-o", "--output", metavar="FILE.html", required=True, help="page to write")
    add("--title", metavar="TEXT", help="heading of the page (the name of the data file)")
    add("--program", metavar="FILE", help="program that ran, for the command that repeats it; data files do not say it")
    add("--log", metavar="FILE", help="what the run printed, for its warnings (log.txt, where a batch has kept it)")
    add("--category", metavar="NAME", help="objects of the figures (robots, or all with a program)")
    add("--run", type=int, metavar="N", help="of several runs, the one to replay, by its number (the first)")
    add("--combination", type=int, metavar="N", help="of a batch with several combinations, the one to replay (0)")
    add("--color-by", metavar="COLUMN", help="at its start, the replay shows the values of this column (LEDs)")
    add("--speed", type=positive, metavar="X", help="speed of the replay, times real time (the run in half a minute)")
    add("--no-replay", action="store_true", help="leave out the replay: a picture of the end remains")
    add("-q", "--quiet", action="store_true", help="do not say what was written")
    return made


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim report") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the report could not be made."""
    options = parser(prog).parse_args(arguments)

    def make() -> None:
        wrong = f"{options.output}: a report is a page for the browser; let it end in .html"
        path = checked_output(options.output, options.data, PAGE, wrong, "report", "the data file ")
        check_readable([options.data])
        if options.log is not None:
            checked_output(options.output, options.log, PAGE, wrong, "report", "the log ")
            check_readable([options.log])
        from pogosim.run_report.making import make_report  # takes a while

        make_report(path, options, prog)

    return report(prog, options.data, options.output, make)


if __name__ == "__main__":
    sys.exit(main())
