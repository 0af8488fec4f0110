"""The command lines of all analyses; nothing else is imported until one is understood."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

from pogosim.command.parser import Parser, positive, whole
from pogosim.defaults import MIN_SPEED_MM_S
from pogosim.extensions import ExtensionError, located, said

NEIGHBOURS = "neighbors_list"  # the column that programs usually have

Analyze = Callable[[argparse.Namespace, str], None]


@dataclass(frozen=True)
class Analysis:
    """An analysis.

    Attributes:
        summary: What it computes, a line of `pogosim analyze --help`.
        parser: Returns the parser of its options, given how the command is called ("pogosim analyze NAME").
        analyze: Writes tables and figures, given the options and how the command is called. As "module:function", it is
            imported when the command line is understood.
    """

    summary: str
    parser: Callable[[str], Parser]
    analyze: Analyze | str

    @property
    def work(self) -> Analyze:
        """What writes tables and figures.

        Raises:
            ExtensionError: It cannot be imported.
        """
        if not isinstance(self.analyze, str):
            return self.analyze
        try:
            found: Analyze = located(self.analyze)
        except (Exception, SystemExit) as error:  # whatever a module of a package does when it is imported
            raise ExtensionError(f"{self.analyze} cannot be imported: {said(error)}") from None
        return found


def analysis_parser(prog: str, description: str) -> Parser:
    """Return a parser with the options that all analyses of robots have."""
    parser = file_parser(
        prog,
        description,
        "data file of a run or a batch, several, or a pattern in quotes (results/result.feather)",
        "objects to analyse (robots, or all with a program)",
        default=["results/result.feather"],
    )
    parser.add_argument(
        "--rc", type=positive, metavar="MM", help="neighbours are closer than this (communication_radius + 2 radius)"
    )
    parser.add_argument(
        *("-j", "--jobs", "--workers"),
        type=whole(1, 10**4),
        default=1,
        metavar="N",
        help="runs analysed at the same time, each in a process of its own (%(default)s)",
    )
    return parser


def file_parser(prog: str, description: str, files: str, objects: str, default: list[str] | None = None) -> Parser:
    """Return a parser of what is read and written, and of which objects; `files`, `objects`: help on these."""
    parser = Parser(prog=prog, description=description)
    parser.add_argument(
        *("-i", "--input", "--inputFile"),
        nargs="+",
        required=default is None,
        default=default,
        metavar="FILE",
        help=files,
    )
    parser.add_argument(
        "-o", "--output-dir", "--outputDir", default=".", metavar="DIR", help="folder for tables and figures (.)"
    )
    parser.add_argument("--category", metavar="NAME", help=objects)
    return parser


def add_arenas(parser: Parser) -> None:
    """Add the options for data without their arena."""
    parser.add_argument(
        "-c", "--config", metavar="FILE", help="configuration of the runs, for data that do not have their arena"
    )
    parser.add_argument(
        "--arenas-dir", default="arenas", metavar="DIR", help="folder of the arena files of this configuration (arenas)"
    )


def locomotion(prog: str) -> Parser:
    """Return the parser of `pogosim analyze locomotion`."""
    parser = analysis_parser(
        prog,
        "Computes speeds, displacements, diffusion, persistence and densities of robots: tables in DIR/stats, figures "
        "(PDF, PNG) in DIR, and DIR/SUMMARY.txt.",
    )
    parser.add_argument(
        "--window", type=positive, default=2.0, metavar="S", help="sliding window of speeds (%(default)g s)"
    )
    parser.add_argument(
        "--characteristic-length", type=positive, metavar="MM", help="length of the Peclet number (2 radius)"
    )
    parser.add_argument("--bins", type=whole(1, 2000), default=30, metavar="N", help="bins of heat maps (%(default)s)")
    parser.add_argument("--steps", type=whole(1), default=20, metavar="N", help="save times of a trace (%(default)s)")
    parser.add_argument("--gif", action="store_true", help="make films of the traces, too: traces/*.gif")
    return parser


def neighbors(prog: str) -> Parser:
    """Return the parser of `pogosim analyze neighbors`."""
    parser = analysis_parser(prog, "Distances to neighbours, degrees, Fano factor and clusters of robots over time.")
    parser.add_argument(
        "--neighborsCol",
        "--neighbors-col",
        metavar="COLUMN",
        help=f"neighbours are the robots whose ids are listed there ({NEIGHBOURS}, if the data have it)",
    )
    parser.add_argument("--k", type=whole(1), default=3, metavar="K", help="without lists: the K nearest (%(default)s)")
    parser.add_argument(
        "--statBasis",
        "--stat-basis",
        choices=("run", "robot", "both"),
        default="both",
        help="distances are averaged over runs, or over the robots of all runs (both)",
    )
    return parser


def network(prog: str) -> Parser:
    """Return the parser of `pogosim analyze network`."""
    parser = analysis_parser(prog, "Components, degrees and Laplacian spectra of the proximity graph of robots.")
    parser.add_argument(
        "--k-first",
        type=whole(1, 10_000),
        default=5,
        metavar="K",
        help="how many small non-zero eigenvalues (%(default)s)",
    )
    parser.add_argument(
        "--avg-window-s",
        type=window,
        metavar="S",
        help="graphs are averaged over windows of this many seconds (auto: rc / mean speed, and 10 save periods)",
    )
    parser.add_argument(
        "--zero-tol",
        type=positive,
        default=1e-10,
        metavar="X",
        help="eigenvalues up to this count as zero (%(default)g)",
    )
    return parser


def window(text: str) -> float | None:
    """Return a number of seconds from the command line; None for auto."""
    return None if text == "auto" else positive(text)


def coverage(prog: str) -> Parser:
    """Return the parser of `pogosim analyze coverage`."""
    parser = analysis_parser(prog, "Areas of the Voronoi cells of robots, and the share of the arena within reach.")
    add_arenas(parser)
    parser.add_argument("--run", type=int, metavar="N", help="analyse only the runs with this number (all)")
    return parser


def collective(prog: str) -> Parser:
    """Return the parser of `pogosim analyze collective`."""
    own = analysis_parser(prog, "Measures order, structure and flow of a swarm.")
    add = own.add_argument
    add("--direction", choices=("velocity", "heading"), default="velocity", help="what is aligned (velocity)")
    add(
        "--min-speed",
        type=positive,
        default=MIN_SPEED_MM_S,
        metavar="MM_S",
        help=f"slower robots have no direction ({MIN_SPEED_MM_S} mm/s)",
    )
    add("--psi-k", type=whole(1, 100), default=6, metavar="K", help="symmetry of the bond order (%(default)s)")
    add("--gr-rmax", type=positive, default=200.0, metavar="MM", help="largest distance of g(r) (%(default)g)")
    add("--gr-dr", type=positive, default=2.0, metavar="MM", help="width of its bins (%(default)g)")
    add("--sk-nx", type=whole(4, 4096), default=128, metavar="N", help="columns of the grid of S(k) (%(default)s)")
    add("--sk-ny", type=whole(4, 4096), default=128, metavar="N", help="rows of it (%(default)s)")
    add("--v2-ref", type=positive, metavar="MM2_S2", help="mean square speed that Teff_ratio is for (that of all runs)")
    add("--vort-nx", type=whole(2, 4096), default=64, metavar="N", help="columns of the velocity field (%(default)s)")
    add("--vort-ny", type=whole(2, 4096), default=64, metavar="N", help="rows of it (%(default)s)")
    add("--milling-center", choices=("cm", "arena"), default="cm", help="centre of mass, or of the arena (cm)")
    add("--aligncorr-rmax", type=positive, default=200.0, metavar="MM", help="largest distance of C(r) (%(default)g)")
    add("--aligncorr-dr", type=positive, default=2.0, metavar="MM", help="width of its bins (%(default)g)")
    add("--aligncorr-fluctuations", action="store_true", help="subtract the mean of all robots first")
    add("-N", "--no-csv", action="store_true", help="do not write CSV files")
    add("--no-extended-infos", action="store_true", help="do not write SUMMARY_metric_details.txt and metrics.pkl")
    return own


def messages(prog: str) -> Parser:
    """Return the parser of `pogosim analyze messages`."""
    parser = file_parser(
        prog,
        "Says what became of messages, and how many got through.",
        "message log of a run (message_log of its configuration), several, or a pattern in quotes",
        "senders to analyse (all)",
    )
    parser.add_argument(
        "--bin", type=positive, default=10.0, metavar="MM", help="width of the bins of distance (%(default)g)"
    )
    return parser


def arena(prog: str) -> Parser:
    """Return the parser of `pogosim analyze arena`."""
    parser = analysis_parser(prog, "Says how large arenas are, what room they have, and how much of them was visited.")
    add_arenas(parser)
    return parser


LOCOMOTION = Analysis(
    "speeds, displacements, diffusion, persistence, densities", locomotion, "pogosim.reports.locomotion:analyze"
)
NEIGHBORS = Analysis(
    "distances to neighbours, degrees, Fano factor, clusters", neighbors, "pogosim.reports.neighbors:analyze"
)
NETWORK = Analysis(
    "components and Laplacian spectra of the proximity graph", network, "pogosim.reports.network:analyze"
)
COVERAGE = Analysis(
    "Voronoi cells and the share of the arena within reach", coverage, "pogosim.reports.coverage:analyze"
)
COLLECTIVE = Analysis(
    "order, pair correlations, structure factor, flow, milling", collective, "pogosim.reports.collective:analyze"
)
MESSAGES = Analysis(
    "what became of messages; reception by distance and cluster size", messages, "pogosim.reports.messages:analyze"
)
ARENA = Analysis(
    "size, area and room of the arenas, and how much of them was visited", arena, "pogosim.reports.arena:analyze"
)
