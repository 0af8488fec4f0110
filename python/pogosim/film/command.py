"""Make a film of a run from its data file: .mp4, .webm or .gif, or a page for the browser, .html.

pogosim film results/demo/data.feather -o results/demo/film.html
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from pogosim.command.parser import Parser, finite, positive
from pogosim.film.encoder import FORMATS, PAGE, check_ffmpeg
from pogosim.outputs import check_readable, checked_output
from pogosim.picture.options import add_what_to_draw, report


def size(text: str) -> tuple[int, int]:
    """Return width and height from the command line: 800 or 800x600."""
    found = re.fullmatch(r"(\d{1,5})(?:x(\d{1,5}))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text} is no size in pixels, such as 800 or 1280x720")
    return int(found[1]), int(found[2] or found[1])


def view_option(text: str) -> tuple[str, Any]:
    """Return a key of the section `view` and its value from the command line: trails=true."""
    key, equals, value = text.partition("=")
    if not key or not equals:
        raise argparse.ArgumentTypeError(f"{text} is no key and value, such as trails=true")
    try:
        return key, yaml.safe_load(value)
    except yaml.YAMLError:
        raise argparse.ArgumentTypeError(f"{value} is no value of {key} in YAML") from None


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim film") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the film could not be made."""
    parser = Parser(prog=prog, description=(__doc__ or "").splitlines()[0])
    parser.add_argument("data", metavar="DATA.feather", help="data file of a run")
    parser.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="film to write (.mp4, .webm, .gif), or page (.html)"
    )
    parser.add_argument("--speed", type=positive, default=1.0, metavar="X", help="times real time (%(default)g)")
    parser.add_argument("--fps", type=positive, default=30.0, help="frames per second of the film (%(default)g)")
    parser.add_argument("--from", dest="start", type=finite, metavar="SECONDS", help="time of the first frame (first)")
    parser.add_argument("--to", dest="end", type=finite, metavar="SECONDS", help="time of the last frame (last)")
    parser.add_argument("--tail", type=positive, metavar="SECONDS", help="show trails of this length")
    parser.add_argument("--size", type=size, metavar="WxH", help="pixels of a frame (the arena has 720)")
    parser.add_argument(
        "--view",
        type=view_option,
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="what films show, as in the section `view` of a configuration (as that of the run)",
    )
    add_what_to_draw(parser)
    options = parser.parse_args(arguments)

    def make() -> None:
        wrong = f"{options.output}: unknown format of a film; let it end in {', '.join(FORMATS)} or {PAGE}"
        endings = [ending.removeprefix(".") for ending in (*FORMATS, PAGE)]
        path = checked_output(options.output, options.data, endings, wrong, "film", "the data file ")
        check_readable([options.data])
        if (suffix := Path(options.output).suffix.lower()) in FORMATS:
            check_ffmpeg(suffix)
        from pogosim.film.making import make_film  # takes a while

        make_film(path, options, prog)

    return report(prog, options.data, options.output, make)


if __name__ == "__main__":
    sys.exit(main())
