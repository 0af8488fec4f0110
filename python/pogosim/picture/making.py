"""A picture of a data file, as the command line asks for it."""

from __future__ import annotations

import argparse
import io
from pathlib import Path

from matplotlib.figure import Figure

from pogosim.errors import PictureError
from pogosim.fonts import any_characters, without_tex
from pogosim.lines import say
from pogosim.picture.figure import draw, draw_series, title
from pogosim.picture.loading import load, sayings
from pogosim.picture.swarm import Recording

MAX_PIXELS = 2e8
DRAWINGS = ("eps", "pdf", "ps", "svg", "svgz")  # without pixels


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
        with any_characters():
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


@without_tex()
def make_picture(path: Path, options: argparse.Namespace, prog: str) -> None:
    """Draw a data file into a picture. A picture that is there stays until the new one is drawn.

    Args:
        path: The picture, as real_output() returns it.
        options: Options of the command.
        prog: Name of the command.

    Raises:
        PictureError, OSError, ValueError: Says which file, and why.
    """
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
