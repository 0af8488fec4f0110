"""`pogosim analyze`: finds the analysis and leaves the rest of the command line to it."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Sequence
from typing import NamedTuple

from pogosim.command.parser import Parser, complain
from pogosim.inputs import check_readable
from pogosim.lines import say, say_error
from pogosim.nearest_name import nearest_name
from pogosim.reports import command_lines


class Analysis(NamedTuple):
    """An analysis; its module has `analyze(options, prog)`, and is imported when its command line is understood."""

    module: str
    parser: Callable[[str], Parser]
    summary: str


ANALYSES: dict[str, Analysis] = {
    "locomotion": Analysis(
        "pogosim.reports.locomotion",
        command_lines.locomotion,
        "speeds, displacements, diffusion, persistence, densities",
    ),
    "neighbors": Analysis(
        "pogosim.reports.neighbors", command_lines.neighbors, "distances to neighbours, degrees, Fano factor, clusters"
    ),
    "network": Analysis(
        "pogosim.reports.network", command_lines.network, "components and Laplacian spectra of the proximity graph"
    ),
    "coverage": Analysis(
        "pogosim.reports.coverage", command_lines.coverage, "Voronoi cells and the share of the arena within reach"
    ),
    "collective": Analysis(
        "pogosim.reports.collective",
        command_lines.collective,
        "order, pair correlations, structure factor, flow, milling",
    ),
    "messages": Analysis(
        "pogosim.reports.messages",
        command_lines.messages,
        "what became of messages; reception by distance and cluster size",
    ),
    "arena": Analysis(
        "pogosim.reports.arena",
        command_lines.arena,
        "size, area and room of the arenas, and how much of them was visited",
    ),
}


def usage(prog: str) -> list[str]:
    """Return what `pogosim analyze --help` prints."""
    width = max(map(len, ANALYSES), default=0)
    listed = [f"  {name:{width}}  {analysis.summary}" for name, analysis in ANALYSES.items()]
    return [
        f"usage: {prog} ANALYSIS -i FILE -o DIR [OPTIONS]",
        "",
        "Computes what robots did, and writes tables (CSV) and figures (PDF, PNG).",
        "",
        "Analyses:",
        *listed,
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
    if name not in ANALYSES:
        near = nearest_name(name, ANALYSES)
        question = f"; did you mean '{near}'?" if near else f"; {prog} --help lists all analyses"
        return complain(prog, f"there is no analysis '{name}'{question}")
    return analyze(name, rest, f"{prog} {name}")


def analyze(name: str, arguments: Sequence[str] | None, prog: str) -> int:
    """Run the command line of an analysis. Returns the exit code, which is 2 for wrong usage or data."""
    options = ANALYSES[name].parser(prog).parse_args(arguments)
    try:
        check_readable(options.input)
    except OSError as error:
        return complain(prog, f"{error.filename}: {(error.strerror or str(error)).lower()}")
    from pogosim.reports.options import reported  # takes a while

    return reported(prog, options, importlib.import_module(ANALYSES[name].module).analyze)


if __name__ == "__main__":
    sys.exit(main())
