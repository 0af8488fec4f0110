"""`pogosim picture`: draws a run: trajectories, and the robots with their LEDs, at the end or at chosen times."""

from __future__ import annotations

from collections.abc import Sequence

from pogosim.command.parser import Parser, finite, positive
from pogosim.outputs import check_readable, checked_output
from pogosim.picture.options import add_what_to_draw, report

PICTURES = ("eps", "jpeg", "jpg", "pdf", "png", "ps", "svg", "svgz", "tif", "tiff", "webp")


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
        type=finite,
        nargs="+",
        metavar="SECONDS",
        help="state at that time (the end); of several, a panel each",
    )
    add_what_to_draw(parser)
    options = parser.parse_args(arguments)

    def make() -> None:
        wrong = f"{options.picture} is not a picture file name; expected one that ends in .{', .'.join(PICTURES)}"
        path = checked_output(options.picture, options.data, PICTURES, wrong, "picture", "the data file ")
        check_readable([options.data])
        from pogosim.picture.making import make_picture  # takes a while

        make_picture(path, options, prog)

    return report(prog, options.data, options.picture, make)
