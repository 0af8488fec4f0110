"""Make a film of runs from their data files: .mp4, .webm or .gif, or a page of one for the browser, .html.

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
from pogosim.errors import PictureError
from pogosim.film.encoder import FORMATS, PAGE, check_ffmpeg
from pogosim.lines import counted
from pogosim.outputs import check_readable, checked_output
from pogosim.picture.options import add_what_to_draw, cannot_read, report


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
        return key, yaml.safe_load(value) if value else ""
    except yaml.YAMLError:
        raise argparse.ArgumentTypeError(f"{value} is no value of {key} in YAML") from None


def check_number_of_runs(options: argparse.Namespace) -> None:
    """Raise a PictureError where there is not one label for each run, or a page is asked for what only films have."""
    count = len(options.data)
    if options.labels and len(options.labels) != count:
        labels, files = counted(len(options.labels), "label"), counted(count, "data file")
        raise PictureError(f"{labels} for {files}; give one for each (--labels)")
    if Path(options.output).suffix.lower() != PAGE:
        return
    if count > 1:
        raise PictureError(f"a page shows one run, not {count}: make a film ({', '.join(FORMATS)}), or a page of each")
    for name in ("labels", "title", "subtitle", "credits"):
        if getattr(options, name):
            raise PictureError(f"--{name} is for films ({', '.join(FORMATS)}); {options.output} is a page")


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim film") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the film could not be made."""
    parser = Parser(prog=prog, description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "data", metavar="DATA.feather", nargs="+", help="data file of a run; films show several side by side"
    )
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
        help="what is shown, of a page at its start, as in the section `view` of a configuration (as that of the run)",
    )
    parser.add_argument(
        "--labels", nargs="+", metavar="TEXT", help="what stands above each run (what tells them apart)"
    )
    parser.add_argument("--title", default="", metavar="TEXT", help="show a card with this before the film, for 2 s")
    parser.add_argument("--subtitle", default="", metavar="TEXT", help="smaller, on the same card")
    parser.add_argument("--credits", default="", metavar="TEXT", help="show a card with this after the film, for 2 s")
    add_what_to_draw(parser)
    options = parser.parse_args(arguments)

    def make() -> None:
        wrong = f"{options.output}: unknown format of a film; let it end in {', '.join(FORMATS)} or {PAGE}"
        endings = [ending.removeprefix(".") for ending in (*FORMATS, PAGE)]
        for data in options.data:
            path = checked_output(options.output, data, endings, wrong, "film", "the data file ")
        for data in options.data:
            try:
                check_readable([data])
            except OSError as error:
                raise PictureError(cannot_read(data, error)) from error
        check_number_of_runs(options)
        if (suffix := Path(options.output).suffix.lower()) in FORMATS:
            check_ffmpeg(suffix)
        from pogosim.film.making import make_film  # takes a while

        make_film(path, options, prog)

    return report(prog, options.data[0], options.output, make)


if __name__ == "__main__":
    sys.exit(main())
