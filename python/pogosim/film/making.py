"""A film or a page of a data file, as the command line asks for it."""

from __future__ import annotations

import argparse
import contextlib
import math
from collections.abc import Iterator, Sequence
from itertools import repeat
from pathlib import Path

from pogosim.command.parser import warn
from pogosim.errors import PictureError
from pogosim.film.ahead import made_ahead
from pogosim.film.cards import CARD_S, card
from pogosim.film.encoder import PAGE, encode
from pogosim.film.grid import Grid, labels_of
from pogosim.film.replay import write_replay
from pogosim.film.shown import asked_for
from pogosim.fonts import without_tex
from pogosim.lines import counted, say
from pogosim.picture.loading import load, sayings
from pogosim.picture.swarm import Recording

MAX_FRAMES = 1_000_000
AHEAD = 4  # frames that are drawn before ffmpeg takes them

# Players take delays below 20 ms for 100 ms, and delays are multiples of 10 ms.
GIF_FPS = 50.0


def span(recordings: Sequence[Recording], options: argparse.Namespace) -> tuple[float, float]:
    """Return the first and last time of the film, s: of all runs together.

    Raises:
        PictureError: The runs have no such times.
    """
    first_s = min(float(recording.times_s[0]) for recording in recordings)
    last_s = max(float(recording.times_s[-1]) for recording in recordings)
    start_s = first_s if options.start is None else max(options.start, first_s)
    end_s = last_s if options.end is None else min(options.end, last_s)
    if start_s > end_s:
        raise PictureError(f"it has rows from {first_s:.9g} s to {last_s:.9g} s; --from and --to leave nothing of that")
    return start_s, end_s


def frame_times(start_s: float, end_s: float, speed: float, fps: float) -> list[float]:
    """Times of the frames of a film, s: the first at the start, the last at the end or shortly before.

    Raises:
        PictureError: There would be too many.
    """
    count = (end_s - start_s) * fps / speed + 1.0
    if count > MAX_FRAMES:
        raise PictureError(f"{count:.3g} frames are too many; choose a higher --speed, or less with --from and --to")
    return [start_s + i * speed / fps for i in range(math.floor(count + 1e-6))]


@without_tex()
def make_film(path: Path, options: argparse.Namespace, prog: str) -> None:
    """Make the film that the options ask for, and say what it is.

    Args:
        path: The film or page, as real_output() returns it.
        options: Options of the command.
        prog: Name of the command.

    Raises:
        PictureError, OSError: Says which file, and why.
    """
    suffix = Path(options.output).suffix.lower()
    if suffix == ".gif" and options.fps > GIF_FPS:
        warn(prog, f"a GIF has {GIF_FPS:g} frames per second, not {options.fps:g}: players show more of them slowly")
        options = argparse.Namespace(**{**vars(options), "fps": GIF_FPS})
    color_by = dict(options.view).get("color_by") if options.color_by is None else options.color_by
    recordings = []
    for data in options.data:
        with sayings(data):
            recordings.append(load(argparse.Namespace(**{**vars(options), "data": data, "color_by": color_by}), prog))
    with sayings(", ".join(options.data)):
        times_s = span(recordings, options)
        if suffix == PAGE:
            told, warnings = write_replay(recordings[0], path, times_s, options.data[0], options)
            for warning in warnings:
                warn(prog, warning)
        else:
            told = encode_film(recordings, path, frame_times(*times_s, options.speed, options.fps), options)
    if not options.quiet:
        say(f"{options.output}: {told}")


def encode_film(
    recordings: Sequence[Recording], path: Path, times_s: Sequence[float], options: argparse.Namespace
) -> str:
    """Make a film for players; returns what is said of it."""
    labels = options.labels or (labels_of(options.data, recordings) if len(recordings) > 1 else None)
    is_even = path.suffix.lower() != ".gif"
    grid = Grid(recordings, options.size, asked_for(options), options.tail, labels, is_even)
    of_card = max(round(CARD_S * options.fps), 1)
    before = of_card if options.title or options.subtitle else 0
    behind = of_card if options.credits else 0

    def drawn() -> Iterator[memoryview]:
        if before:
            yield from repeat(card(grid.size, options.title, options.subtitle).data.cast("B"), before)
        for time_s in times_s:
            yield grid.frame(time_s).data.cast("B")
        if behind:
            yield from repeat(card(grid.size, text=options.credits).data.cast("B"), behind)

    with contextlib.closing(made_ahead(drawn(), AHEAD)) as ready:
        encode(ready, grid.size, options.fps, path)
    count, (width, height) = before + len(times_s) + behind, grid.size
    return f"{counted(count, 'frame')} of {width} x {height} pixels, {count / options.fps:.2f} s"
