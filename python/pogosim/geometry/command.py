"""`pogosim arena`: draws, checks, scales and converts arenas."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from pogosim.command.parser import Parser, guarded, positive
from pogosim.defaults import AREA_MM2, POGOBOT_RADIUS_MM


def area(text: str) -> float | None:
    """Return an area in mm2, or None for `file`: the file is in mm."""
    return None if text == "file" else positive(text)


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(prog=prog, description="Draws, checks, scales and converts arenas (docs/configuration.md).")
    actions = made.add_subparsers(metavar="ACTION", required=True, dest="action", parser_class=Parser)

    show = actions.add_parser("show", help="check an arena, print its size, and draw it")
    show.add_argument("arena", metavar="ARENA.csv", help="arena file, or an SVG drawing")
    show.add_argument("output", nargs="?", metavar="OUT.pdf", help="picture to write, .pdf, .png or .svg")
    add_area(show, AREA_MM2, "1e6, as in configurations")
    show.add_argument("--stretch", action="store_true", help="as with arena_stretch: true")
    show.add_argument(
        "--radius", type=positive, default=POGOBOT_RADIUS_MM, metavar="MM", help="radius of the robots (%(default)g)"
    )

    scale = actions.add_parser("scale", help="scale an arena to an area")
    scale.add_argument("arena", metavar="IN.csv", help="arena file")
    scale.add_argument("output", metavar="OUT", help="arena file (.csv) or drawing (.svg) to write, in mm")
    scale.add_argument(
        "--area", type=positive, required=True, metavar="MM2", help="area inside the outer wall less the holes"
    )
    scale.add_argument("--stretch", action="store_true", help="stretch the bounding box to a square first")

    from_svg = actions.add_parser("from-svg", help="make an arena of a drawing")
    from_svg.add_argument("drawing", metavar="IN.svg", help="SVG file; its largest closed shape is the outer wall")
    from_svg.add_argument("output", metavar="OUT.csv", help="arena file to write")
    add_area(from_svg, None, "file: units of the drawing, 1 unit = 1 mm")
    from_svg.add_argument("--element", metavar="ID", help="take only the element of this id, such as a group")
    from_svg.add_argument("--first-path", action="store_true", help="take only the first path")
    from_svg.add_argument(
        "--tolerance",
        type=positive,
        default=1e-4,
        metavar="SHARE",
        help="how far walls may be from curves, as a share of the diagonal of the drawing (%(default)g)",
    )

    to_svg = actions.add_parser("to-svg", help="make a drawing of an arena")
    to_svg.add_argument("arena", metavar="IN.csv", help="arena file")
    to_svg.add_argument("output", metavar="OUT.svg", help="drawing to write, in mm")
    add_area(to_svg, None, "file: the arena file is in mm")
    return made


def add_area(made: argparse.ArgumentParser, default: float | None, words: str) -> None:
    """Add the option --area."""
    made.add_argument(
        "--area",
        type=area,
        default=default,
        metavar="MM2",
        help=f"area inside the outer wall less the holes, or 'file' to keep the size ({words})",
    )


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim arena") -> int:
    """Run the command. Returns its exit code: 0 done, 2 an arena is not valid, or nothing could be done."""
    options = parser(prog).parse_args(arguments)
    prog = f"{prog} {options.action}"
    from pogosim.geometry.actions import ACTIONS  # takes a while

    return guarded(prog, lambda: ACTIONS[options.action](prog, options))
