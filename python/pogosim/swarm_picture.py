"""Draw a run: trajectories, and the robots with their LEDs, at the end or at chosen times.

    python -m pogosim.swarm_picture results/demo/data.feather results/demo/swarm.png

Trails take the colour that the robot's head LED had at the time, and fade into the past. Objects have the shapes, and
the floor the light, that the configuration in the file's metadata says; membranes lie where their dots do
(serialize_dot_pose: true).
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from pogosim.command.parser import Parser
from pogosim.outputs import OutputError, leads_to, real_output, say
from pogosim.picture.errors import PictureError
from pogosim.picture.figure import draw, draw_series, notes, round_length, title
from pogosim.picture.layers import draw_scene, thinned, trail_segments
from pogosim.picture.options import add_what_to_draw, load, moment, positive, report, sayings
from pogosim.picture.palette import DARK_LED, FLOOR, INK, PAPER, led_brightness, led_colours
from pogosim.picture.swarm import Recording, Swarm, read_swarm

__all__ = [
    "DARK_LED",
    "FLOOR",
    "INK",
    "PAPER",
    "PictureError",
    "Swarm",
    "draw",
    "draw_scene",
    "led_brightness",
    "led_colours",
    "main",
    "notes",
    "read_swarm",
    "round_length",
    "thinned",
    "title",
    "trail_segments",
]

PICTURES = ("eps", "jpeg", "jpg", "pdf", "png", "ps", "svg", "svgz", "tif", "tiff", "webp")
DRAWINGS = ("eps", "pdf", "ps", "svg", "svgz")  # without pixels
MAX_PIXELS = 2e8


def picture_file(name: str, data: str) -> Path:
    """Return where the picture is to be written.

    Raises:
        OutputError: It is no name of a picture, no file, or that of the data.
    """
    suffix = Path(name).suffix[1:].lower()
    if name and leads_to(name, data):
        raise OutputError(f"the picture {name} would take the place of the data file {data}; name another picture")
    path = real_output(name)
    if suffix not in PICTURES:
        raise OutputError(f"{name} is no name of a picture; let it end in .{', .'.join(PICTURES)}")
    return path


def rendered(figure: Figure, picture: str, dpi: float) -> bytes:
    """Return the bytes of the picture, in the format of its name.

    Raises:
        PictureError: It would be too large or too small.
    """
    width, height = (float(inches) * dpi for inches in figure.get_size_inches())
    if width * height > MAX_PIXELS or min(width, height) < 1:
        raise PictureError(
            f"with --dpi {dpi:g} the picture has {width:.3g} x {height:.3g} pixels; at least 1, and at most "
            f"{MAX_PIXELS:.0e} together, are possible"
        )
    content = io.BytesIO()
    try:
        figure.savefig(content, format=Path(picture).suffix[1:].lower(), dpi=dpi)
    except (MemoryError, OverflowError, RuntimeError, SystemError, ValueError) as error:
        raise PictureError(f"matplotlib cannot make {picture} with --dpi {dpi:g}: {error}") from error
    return content.getvalue()


def figure_of(recording: Recording, options: argparse.Namespace) -> Figure:
    """Draw what the options ask for."""
    swarms = [recording.until(time_s) for time_s in options.at or [None]]
    if len(swarms) == 1:
        return draw(swarms[0], options.tail, options.links)
    return draw_series(swarms, options.tail, options.links)


def make_picture(options: argparse.Namespace, prog: str) -> None:
    """Draw a data file into a picture. A picture that is there stays until the new one is drawn.

    Raises:
        PictureError, OutputError, OSError, ValueError: Says which file, and why.
    """
    path = picture_file(options.picture, options.data)
    with sayings(options.data):
        recording = load(options, prog)
        figure = figure_of(recording, options)
    path.write_bytes(rendered(figure, options.picture, options.dpi))
    if not options.quiet:
        say(f"{options.picture}: {told_of(recording, figure, options)}")


def told_of(recording: Recording, figure: Figure, options: argparse.Namespace) -> str:
    """Return what is said of a picture: "100 robots after 20 s, 1245 x 1344 pixels"."""
    times_s = options.at or [recording.last.end_s]
    objects = title(recording.last, 1000.0).rsplit(" after ", 1)[0].replace("\u00a0", " ")
    text = f"{objects} after {', '.join(f'{time_s:.9g}' for time_s in times_s)} s"
    if Path(options.picture).suffix[1:].lower() in DRAWINGS:
        return text
    width, height = (round(float(inches) * options.dpi) for inches in figure.get_size_inches())
    return f"{text}, {width} x {height} pixels"


def main(arguments: Sequence[str] | None = None, prog: str = "swarm_picture") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the picture could not be made."""
    parser = Parser(prog=prog, description=(__doc__ or "").splitlines()[0])
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
    return report(prog, options.data, options.picture, lambda: make_picture(options, prog))


if __name__ == "__main__":
    sys.exit(main())
