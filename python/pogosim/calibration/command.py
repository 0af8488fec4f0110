"""`pogosim calibrate`: fits the motion of simulated robots to tracks of real ones."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from pogosim.batch.ending import catch_signals
from pogosim.batch.run_options import ISOLATED
from pogosim.calibration.parameters import NAMES
from pogosim.calibration.results import LINES, PICTURE, RESULT, write_protocol
from pogosim.calibration.unit_names import ANGLES_RAD, LENGTHS_MM
from pogosim.command.parser import Parser, complain, guarded, positive, whole
from pogosim.outputs import check_readable

INTERRUPTED = 130
MAGNETOMETER = "magnetometer"  # in place of a file: the fit of a magnetometer


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(
        prog=prog,
        description="Fits speed, noise and bias of simulated robots to tracks of real ones (docs/calibration.md), and "
        "prints the lines for a configuration. pogosim calibrate magnetometer TABLE.csv: that of a magnetometer.",
    )
    made.add_argument(
        "tracks", nargs="?", metavar="TRACKS", help="CSV file with the columns time, id, x, y, angle; or a data file"
    )
    made.add_argument("-c", "--config", metavar="CONF.yaml", help="arena, and the robots with the values to start from")
    made.add_argument(
        "-S",
        "--simulator-binary",
        metavar="PROGRAM",
        help="what the robots ran: a program, a .c or .cpp file, or a project (default: the program of --protocol)",
    )
    made.add_argument(
        "--protocol",
        metavar="NAME",
        help="make a project of the program to run on the robots, and do nothing else; NAME.c: write the program alone",
    )
    made.add_argument(
        "--category", metavar="NAME", help="the robots' entry in `objects` (the only one of type pogobot)"
    )
    made.add_argument("--parameters", metavar="A,B", help=f"fit only these of {', '.join(NAMES)}")
    made.add_argument("-o", "--output-dir", metavar="DIR", help=f"folder for {RESULT}, {LINES} and {PICTURE}")
    units = made.add_argument_group("units of the tracks (recognised and printed, if not given)")
    units.add_argument("--length-unit", choices=[*LENGTHS_MM, "px"])
    units.add_argument("--mm-per-pixel", type=positive, metavar="MM", help="size of a pixel, for positions in pixels")
    units.add_argument("--angle-unit", choices=list(ANGLES_RAD))
    units.add_argument("--y-up", action="store_true", help="y points up, and angles are counter-clockwise")
    units.add_argument("--fps", type=positive, metavar="N", help="frames per second, if times are frame numbers")
    made.add_argument("--runs", type=whole(1, 1000), default=3, metavar="N", help="runs to average (%(default)s)")
    made.add_argument(
        "--seed", type=whole(0, 2**32 - 10**4), default=42, metavar="N", help="of the first run (%(default)s)"
    )
    made.add_argument(
        "-j", "--workers", type=whole(1, 10**4), metavar="N", help="runs at the same time (one per processor)"
    )
    made.add_argument("--isolated", action="store_true", help=ISOLATED)
    return made


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim calibrate") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be fitted, or written, 130 interrupted."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given[:1] == [MAGNETOMETER]:
        from pogosim.magnetometer import command as magnetometer

        return magnetometer.main(given[1:], f"{prog} {MAGNETOMETER}")
    made = parser(prog)
    options = made.parse_args(given)

    def run() -> None:
        if options.protocol is not None:
            write_protocol(Path(options.protocol))
            return
        if options.tracks is None or options.config is None:
            made.error("expected TRACKS and -c CONF.yaml, or --protocol NAME")
        check_readable([options.tracks])
        catch_signals()
        from pogosim.calibration.work import calibrate  # takes a while

        calibrate(prog, options)

    try:
        return guarded(prog, run, f"the folder for temporary files, {tempfile.gettempdir()}")
    except KeyboardInterrupt:
        complain(prog, "interrupted; nothing is written")
        return INTERRUPTED
    except MemoryError:
        return complain(prog, "not enough memory for tracks of this length; use a part of the film")


if __name__ == "__main__":
    sys.exit(main())
