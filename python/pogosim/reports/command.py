"""`pogosim analyze`: finds the analysis and leaves the rest of the command line to it."""

from __future__ import annotations

import difflib
import importlib
import sys
from collections.abc import Sequence
from typing import NamedTuple

from pogosim.command.parser import complain
from pogosim.outputs import say


class Analysis(NamedTuple):
    """An analysis; its module has `main(arguments, prog) -> exit code`, and is imported when it is called."""

    module: str
    summary: str


ANALYSES: dict[str, Analysis] = {
    "locomotion": Analysis("pogosim.reports.locomotion", "speeds, displacements, diffusion, persistence, densities"),
    "neighbors": Analysis("pogosim.reports.neighbors", "distances to neighbours, degrees, Fano factor, clusters"),
    "network": Analysis("pogosim.reports.network", "components and Laplacian spectra of the proximity graph"),
    "coverage": Analysis("pogosim.reports.coverage", "Voronoi cells and the share of the arena within reach"),
    "collective": Analysis("pogosim.reports.collective", "order, pair correlations, structure factor, flow, milling"),
    "messages": Analysis("pogosim.reports.messages", "what became of messages; reception by distance and cluster size"),
    "arena": Analysis("pogosim.reports.arena", "size, area and room of the arenas, and how much of them was visited"),
}


def usage(prog: str) -> str:
    """Return what `pogosim analyze --help` prints."""
    width = max(map(len, ANALYSES), default=0)
    listed = [f"  {name:{width}}  {analysis.summary}" for name, analysis in ANALYSES.items()]
    return "\n".join(
        [
            f"usage: {prog} ANALYSIS -i FILE -o DIR [OPTIONS]",
            "",
            "Computes what robots did, and writes tables (CSV) and figures (PDF, PNG).",
            "",
            "Analyses:",
            *listed,
            "",
            f"{prog} ANALYSIS --help prints the options of an analysis.",
        ]
    )


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim analyze") -> int:
    """Run the command line. Returns the exit code, which is 2 for wrong usage."""
    name, *rest = list(sys.argv[1:] if arguments is None else arguments) or [""]
    if name in ("-h", "--help", "help"):
        say(usage(prog))
        return 0
    if not name:
        print(usage(prog), file=sys.stderr)
        return 2
    if name not in ANALYSES:
        near = difflib.get_close_matches(name, ANALYSES, n=1)
        question = f"; did you mean '{near[0]}'?" if near else f"; {prog} --help lists all analyses"
        return complain(prog, f"there is no analysis '{name}'{question}")
    code: int = importlib.import_module(ANALYSES[name].module).main(rest, f"{prog} {name}")
    return code


if __name__ == "__main__":
    sys.exit(main())
