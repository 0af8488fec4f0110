"""Make a film of a run from its data file: .mp4, .webm or .gif, or a page for the browser, .html.

pogosim film results/demo/data.feather -o results/demo/film.html
"""

from __future__ import annotations

import argparse
import math
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from pogosim.command.parser import Parser, warn
from pogosim.film.encoder import FORMATS, check_ffmpeg, encode
from pogosim.film.replay import write_replay
from pogosim.film.stills import Look, Stills, size_for
from pogosim.outputs import OutputError, leads_to, real_output, say
from pogosim.picture.errors import PictureError
from pogosim.picture.options import add_what_to_draw, load, moment, positive, report, sayings
from pogosim.picture.swarm import Recording

PAGE = ".html"
MAX_FRAMES = 1_000_000


def size(text: str) -> tuple[int, int]:
    """Return width and height from the command line: 800 or 800x600."""
    found = re.fullmatch(r"(\d{1,5})(?:x(\d{1,5}))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text} is no size in pixels, such as 800 or 1280x720")
    return int(found[1]), int(found[2] or found[1])


def film_file(name: str, data: str) -> Path:
    """Return where the film is to be written.

    Raises:
        OutputError: It is no name of a film, no file, or that of the data.
    """
    if name and leads_to(name, data):
        raise OutputError(f"the film {name} would take the place of the data file {data}; name another film")
    path = real_output(name)
    if Path(name).suffix.lower() not in (*FORMATS, PAGE):
        raise OutputError(f"{name}: unknown format of a film; let it end in {', '.join(FORMATS)} or {PAGE}")
    return path


def span(recording: Recording, options: argparse.Namespace) -> tuple[float, float]:
    """Return the first and last time of the film, s.

    Raises:
        PictureError: The run has no such times.
    """
    times_s = recording.times_s
    start_s = times_s[0] if options.start is None else max(options.start, times_s[0])
    end_s = times_s[-1] if options.end is None else min(options.end, times_s[-1])
    if start_s > end_s:
        raise PictureError(
            f"it has rows from {times_s[0]:.9g} s to {times_s[-1]:.9g} s; --from and --to leave nothing of that"
        )
    return float(start_s), float(end_s)


def frame_times(start_s: float, end_s: float, speed: float, fps: float) -> list[float]:
    """Times of the frames of a film, s: the first at the start, the last at the end or shortly before.

    Raises:
        PictureError: There would be too many.
    """
    count = (end_s - start_s) * fps / speed + 1.0
    if count > MAX_FRAMES:
        raise PictureError(f"{count:.3g} frames are too many; choose a higher --speed, or less with --from and --to")
    return [start_s + i * speed / fps for i in range(math.floor(count + 1e-6))]


def make_film(options: argparse.Namespace, prog: str) -> None:
    """Make the film that the options ask for, and say what it is.

    Raises:
        PictureError, OutputError, OSError: Says which file, and why.
    """
    path = film_file(options.output, options.data)
    suffix = Path(options.output).suffix.lower()
    if suffix in FORMATS:
        check_ffmpeg(suffix)
    with sayings(options.data):
        recording = load(options, prog)
        start_s, end_s = span(recording, options)
        if suffix == PAGE:
            told, warnings = write_replay(recording, path, (start_s, end_s), options)
            for warning in warnings:
                warn(prog, warning)
        else:
            told = encode_film(
                recording, path, suffix, frame_times(start_s, end_s, options.speed, options.fps), options
            )
    if not options.quiet:
        say(f"{options.output}: {told}")


def encode_film(
    recording: Recording, path: Path, suffix: str, times_s: Sequence[float], options: argparse.Namespace
) -> str:
    """Make a film for players; returns what is said of it."""
    pixels = size_for(recording, options.size, is_even=suffix != ".gif")
    stills = Stills(recording, pixels, Look(options.tail, options.links))

    def frames() -> Iterator[bytes]:
        for time_s in times_s:
            yield stills.frame(time_s)

    encode(frames(), pixels, options.fps, path)
    return f"{len(times_s)} frames of {pixels[0]} x {pixels[1]} pixels, {len(times_s) / options.fps:.2f} s"


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim film") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the film could not be made."""
    parser = Parser(prog=prog, description=(__doc__ or "").splitlines()[0])
    parser.add_argument("data", metavar="DATA.feather", help="data file of a run")
    parser.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="film to write (.mp4, .webm, .gif), or page (.html)"
    )
    parser.add_argument("--speed", type=positive, default=1.0, metavar="X", help="times real time (%(default)g)")
    parser.add_argument("--fps", type=positive, default=30.0, help="frames per second of the film (%(default)g)")
    parser.add_argument("--from", dest="start", type=moment, metavar="SECONDS", help="time of the first frame (first)")
    parser.add_argument("--to", dest="end", type=moment, metavar="SECONDS", help="time of the last frame (last)")
    parser.add_argument("--tail", type=positive, metavar="SECONDS", help="length of the trails (none)")
    parser.add_argument("--size", type=size, metavar="WxH", help="pixels of a frame (the arena has 720)")
    add_what_to_draw(parser)
    options = parser.parse_args(arguments)
    return report(prog, options.data, options.output, lambda: make_film(options, prog))


if __name__ == "__main__":
    sys.exit(main())
