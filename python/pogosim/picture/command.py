"""`pogosim picture`: draws a run: trajectories, and the robots with their LEDs, at the end or at chosen times."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pogosim.command.parser import Parser
from pogosim.outputs import OutputError, check_readable, leads_to, real_output
from pogosim.picture.options import add_what_to_draw, moment, positive, report

PICTURES = ("eps", "jpeg", "jpg", "pdf", "png", "ps", "svg", "svgz", "tif", "tiff", "webp")


def picture_file(name: str, data: str) -> Path:
    """Return where the picture is to be written.

    Raises:
        OutputError: It is not a picture's file name, not a file, or that of the data.
    """
    suffix = Path(name).suffix[1:].lower()
    if name and leads_to(name, data):
        raise OutputError(f"the picture {name} would take the place of the data file {data}; name another picture")
    path = real_output(name)
    if suffix not in PICTURES:
        raise OutputError(f"{name} is not a picture file name; expected one that ends in .{', .'.join(PICTURES)}")
    return path


def main(arguments: Sequence[str] | None = None, prog: str = "swarm_picture") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the picture could not be made."""
    parser = Parser(
        prog=prog,
        description="Draw a run: trajectories, and the robots with their LEDs, at the end or at chosen times.",
    )
    parser.add_argument("data", metavar="DATA.feather", help="data file of a run")
    parser.add_argument("picture", metavar="OUT.png", help=f"picture to write ({', '.join(PICTURES)})")
    parser.add_argument("--dpi", type=positive, default=150.0, help="dots per inch (%(default)g)")
    parser.add_argument("--tail", type=positive, metavar="SECONDS", help="length of the trails (whole run)")
    parser.add_argument(
        "--at",
        type=moment,
        nargs="+",
        metavar="SECONDS",
        help="state at that time (the end); of several, a panel each",
    )
    add_what_to_draw(parser)
    options = parser.parse_args(arguments)

    def make() -> None:
        path = picture_file(options.picture, options.data)
        check_readable([options.data])
        from pogosim.picture.making import make_picture  # takes a while

        make_picture(path, options, prog)

    return report(prog, options.data, options.picture, make)
