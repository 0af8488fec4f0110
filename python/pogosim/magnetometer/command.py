"""`pogosim calibrate magnetometer`: fits the model of a magnetometer to readings of a real robot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.parser import Parser, complain, finite, warn, whole
from pogosim.errors import ToolError
from pogosim.lines import say
from pogosim.outputs import OutputError, check_readable, leads_to, partial_output, real_output, told

PICTURE = "magnetometer.png"


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(
        prog=prog,
        description="Fits the model of a magnetometer to readings at known headings (docs/magnetometer.md), prints the "
        "lines for a configuration, and draws the readings with the fit.",
    )
    made.add_argument("table", metavar="TABLE.csv", help="CSV file with the columns angle, mag_x, mag_y, mag_z")
    made.add_argument("--picture", default=PICTURE, metavar="FILE.png", help="where to draw the readings (%(default)s)")
    made.add_argument("--harmonics", type=whole(1, 32), default=2, metavar="K", help="of the curve (%(default)s)")
    made.add_argument(
        "--angle-unit", choices=["degrees", "radians"], help="recognised by the largest one, if not given"
    )
    made.add_argument("--y-up", action="store_true", help="angles are counter-clockwise seen from above")
    made.add_argument(
        "--field-angle",
        type=finite,
        default=0.0,
        metavar="DEGREES",
        help="direction of the magnetic field where the table was recorded, clockwise from +x (%(default)s)",
    )
    return made


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim calibrate magnetometer") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be fitted, or written."""
    options = parser(prog).parse_args(arguments)
    try:
        check_readable([options.table])
        place = real_output(options.picture)
        if leads_to(options.picture, options.table):
            raise OutputError(f"{options.picture} is the table, which would be lost; choose another --picture")

        from pogosim.magnetometer.block import configuration_block  # takes a while
        from pogosim.magnetometer.figure import picture
        from pogosim.magnetometer.fit import check_ellipse, doubt, fit_curve
        from pogosim.magnetometer.table import read_reading_table

        field_angle_rad = math.radians(options.field_angle)
        table = read_reading_table(Path(options.table), options.angle_unit, options.y_up, lambda text: warn(prog, text))
        fitted = fit_curve(table, options.harmonics, field_angle_rad)
        doubts = doubt(table, options.harmonics, field_angle_rad)
        check_ellipse(fitted, table.source, doubts)
        if doubts:
            warn(prog, doubts)
        block = configuration_block(fitted, field_angle_rad)
        with partial_output(place) as partial:
            partial.write_bytes(picture(table, fitted, field_angle_rad))
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, told(error, options.picture))
    say(f"# {len(table.reading)} readings of {table.source}; drawn in {options.picture}", *block.splitlines())
    return 0
