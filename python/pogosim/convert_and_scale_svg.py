"""`python -m pogosim.convert_and_scale_svg IN.svg OUT.csv SCALED.svg`: an arena of the first path of a drawing.

OUT.csv has the size of the drawing; SCALED.svg is scaled to an area, 150000 mm2 unless told otherwise. `pogosim arena
from-svg` takes all shapes, and scales.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from pogosim.command.main import ended
from pogosim.command.parser import Parser, guarded, positive, warn
from pogosim.geometry.actions import check_valid, describe, write_outline
from pogosim.geometry.arena_file import scaled
from pogosim.geometry.svg_file import read_svg
from pogosim.lines import say
from pogosim.outputs import OutputError, checked_output, leads_to
from pogosim.scale_csv_arena import AREA_MM2


def main(arguments: Sequence[str] | None = None, prog: str = "convert_and_scale_svg") -> int:
    """Run the command; returns its exit code."""
    parser = Parser(prog=prog, description="Makes an arena of the first path of a drawing; see pogosim arena from-svg.")
    parser.add_argument("drawing", metavar="IN.svg", help="SVG file")
    parser.add_argument("output", metavar="OUT.csv", help="arena file to write, in units of the drawing")
    parser.add_argument("scaled", metavar="SCALED.svg", help="drawing to write, scaled to the area")
    parser.add_argument("--area", type=positive, default=AREA_MM2, metavar="MM2", help="area to scale to (%(default)g)")
    options = parser.parse_args(arguments)
    return guarded(prog, lambda: run(prog, options.drawing, options.output, options.scaled, options.area))


def run(prog: str, drawing: str, output: str, scaled_output: str, area_mm2: float) -> int:
    """Convert a drawing; raises ArenaError, OutputError or OSError if that is not possible."""
    csv = checked_output(output, drawing, ("csv",))
    svg = checked_output(scaled_output, drawing, ("svg",))
    if leads_to(csv, svg):
        raise OutputError(f"{output} and {scaled_output} are the same file; name two")
    outline, warnings = read_svg(drawing, first_path=True)
    for text in warnings:
        warn(prog, text)
    check_valid(outline)
    write_outline(outline, csv, output)
    arena = scaled(outline, area_mm2)
    write_outline(arena, svg, scaled_output)
    say(describe(scaled(outline, None), output))
    say(describe(arena, scaled_output))
    return 0


if __name__ == "__main__":
    sys.exit(ended("convert_and_scale_svg", main))
