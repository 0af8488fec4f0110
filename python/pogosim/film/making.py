"""A film or a page of a data file, as the command line asks for it."""

from __future__ import annotations

import argparse
import contextlib
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pogosim.command.parser import warn
from pogosim.errors import PictureError
from pogosim.film.ahead import made_ahead
from pogosim.film.encoder import PAGE, encode
from pogosim.film.frames import Frames, size_for
from pogosim.film.replay import write_replay
from pogosim.fonts import without_tex
from pogosim.lines import counted, say
from pogosim.picture.loading import load, sayings
from pogosim.picture.swarm import Recording

MAX_FRAMES = 1_000_000
AHEAD = 4  # frames that are drawn before ffmpeg takes them

# Players take delays below 20 ms for 100 ms, and delays are multiples of 10 ms.
GIF_FPS = 50.0


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


def shown(options: argparse.Namespace) -> dict[str, Any]:
    """Return what the command line says of what pictures show, as keys of the section `view`."""
    keys: dict[str, Any] = {"links": "below"} if options.links else {}
    if options.tail is not None:
        keys["trails"] = True
    return {**keys, **dict(options.view)}


def encode_film(
    recording: Recording, path: Path, suffix: str, times_s: Sequence[float], options: argparse.Namespace
) -> str:
    """Make a film for players; returns what is said of it."""
    width, height = size_for(recording, options.size)
    if suffix != ".gif":
        width, height = width + width % 2, height + height % 2
    frames = Frames(recording, (width, height), shown(options), options.tail)

    def drawn() -> Iterator[memoryview]:
        for time_s in times_s:
            frame = np.empty((height, width, 3), np.uint8)
            frames.draw(time_s, frame)
            yield frame.data.cast("B")

    with contextlib.closing(made_ahead(drawn(), AHEAD)) as ready:
        encode(ready, (width, height), options.fps, path)
    return f"{counted(len(times_s), 'frame')} of {width} x {height} pixels, {len(times_s) / options.fps:.2f} s"
