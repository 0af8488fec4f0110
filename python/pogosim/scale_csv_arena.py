"""`python -m pogosim.scale_csv_arena IN.csv OUT.(csv|svg)`: scales an arena to 150000 mm2, or another area.

`pogosim arena scale` does the same for every area.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from pogosim.command.main import ended
from pogosim.command.parser import Parser, guarded, positive
from pogosim.geometry.actions import convert
from pogosim.geometry.arena_file import read_arena
from pogosim.outputs import checked_output

AREA_MM2 = 150_000.0


def main(arguments: Sequence[str] | None = None, prog: str = "scale_csv_arena") -> int:
    """Run the command; returns its exit code."""
    parser = Parser(prog=prog, description="Scales an arena to an area; pogosim arena scale does the same.")
    parser.add_argument("arena", metavar="IN.csv", help="arena file")
    parser.add_argument("output", metavar="OUT", help="arena file (.csv) or drawing (.svg) to write, in mm")
    parser.add_argument("--area", type=positive, default=AREA_MM2, metavar="MM2", help="area to scale to (%(default)g)")
    options = parser.parse_args(arguments)

    def run() -> int:
        path = checked_output(options.output, options.arena, ("csv", "svg"))
        return convert(prog, read_arena(options.arena), path, options)

    return guarded(prog, run)


if __name__ == "__main__":
    sys.exit(ended("scale_csv_arena", main))
