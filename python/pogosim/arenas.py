"""`python -m pogosim.arenas`: draws the arena of a configuration, scaled as the simulator scales it.

`pogosim arena show` does the same for an arena file.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.option_words import OptionsError
from pogosim.batch.options import single_value
from pogosim.command.main import ended
from pogosim.command.parser import Parser, positive
from pogosim.geometry.actions import PICTURES, checked_output, guarded, show_arena
from pogosim.geometry.arena_file import ArenaError, Outline, read_arena, scaled
from pogosim.geometry.command import DEFAULT_AREA_MM2, DEFAULT_RADIUS_MM
from pogosim.installation import InstallationError, find_installation
from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml, problem_of


def parser(prog: str) -> Parser:
    """Return the parser of the command line."""
    made = Parser(prog=prog, description="Draws the arena of a configuration, and prints its size and validity.")
    made.add_argument("--config", default="conf/simple.yaml", metavar="FILE", help="configuration (conf/simple.yaml)")
    made.add_argument("--arena-file", metavar="FILE", help="arena file in place of the configuration's")
    made.add_argument("--arena-surface", type=positive, metavar="MM2", help="area in place of the configuration's")
    made.add_argument("--output-dir", default="results", metavar="DIR", help="folder of the picture (results)")
    made.add_argument("--outfile", default="arena_polygon.pdf", metavar="NAME", help="picture (arena_polygon.pdf)")
    made.add_argument("--no-save", action="store_true", help="write no picture")
    made.add_argument("--show", action="store_true", help="open the picture in a window")
    return made


def read_configuration(path: Path) -> dict[str, Any]:
    """Return the entries of a configuration file.

    Raises:
        ArenaError: It is none.
        OSError: It cannot be read.
    """
    if path.exists() and not path.is_file():
        raise ArenaError(f"{path} is not a file; expected a configuration")
    try:
        entries = parse_yaml(path.read_bytes().decode("utf-8"))
    except WRONG_VALUES as error:
        raise ArenaError(f"{path} is not a configuration: {problem_of(error)}") from None
    if not isinstance(entries, dict):
        raise ArenaError(f"{path} is not a configuration; expected keys such as arena_file")
    return entries


def find_arena(name: str, configuration: Path) -> Path:
    """Return an arena file, looked for as the simulator does: here, next to the configuration, in Pogosim's own folder.

    Raises:
        ArenaError: There is none.
    """
    places = [Path(), configuration.parent]
    with contextlib.suppress(InstallationError):
        places.append(find_installation().template.parent)
    found = next((place / name for place in places if (place / name).is_file()), None)
    if found is None:
        raise ArenaError(f"there is no arena file {name} here, in {configuration.parent} or with Pogosim")
    return found


def area_of(value: Any, path: Path) -> float | None:
    """Return the area that a configuration asks for in mm2; None if the arena file is in mm."""
    if value == "file":
        return None
    if value is None:
        return DEFAULT_AREA_MM2
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < float("inf"):
        raise ArenaError(f"{path}: arena_surface is {value}; expected a number above 0 (mm2), or 'file'")
    return float(value)


def selected(options: argparse.Namespace) -> tuple[Outline, Outline]:
    """Return the arena as in its file, and in mm.

    Raises:
        ArenaError, OSError: Says what is wrong.
    """
    path = Path(options.config)

    def entry(name: str) -> Any:
        try:
            return single_value(entries.get(name))
        except OptionsError as error:
            raise ArenaError(f"{path}: {name}: {error}") from None

    # With all that is needed on the command line, no configuration is.
    is_needed = options.arena_file is None or path.is_file()
    entries = read_configuration(path) if is_needed else {}
    name = options.arena_file or entry("arena_file")
    if not isinstance(name, str) or not name:
        raise ArenaError(f"{path} has no arena_file; give one with --arena-file")
    outline = read_arena(find_arena(name, path))
    area_mm2 = options.arena_surface or area_of(entry("arena_surface"), path)
    return outline, scaled(outline, area_mm2, stretch=entry("arena_stretch") is True)


def run(prog: str, options: argparse.Namespace) -> int:
    """Draw the arena; raises ArenaError, OutputError or OSError if that is not possible."""
    outline, arena = selected(options)
    output = None
    if not options.no_save:
        name = str(Path(options.output_dir, options.outfile))
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        output = (checked_output(name, outline.source, PICTURES), name)
    code = show_arena(prog, outline, arena, DEFAULT_RADIUS_MM, output)
    if options.show:
        show_window(arena)
    return code


def show_window(arena: Outline) -> None:
    """Open the arena in a window, and wait until it is closed.

    Raises:
        ArenaError: There is no display.
    """
    import matplotlib.pyplot as plt

    from pogosim.geometry.drawing import draw

    figure = plt.figure()
    if getattr(figure.canvas, "required_interactive_framework", None) is None:
        raise ArenaError("there is no display for a window, or no toolkit for it; open the picture instead")
    draw(arena, None, f"{Path(arena.source).name}: {arena.area:.6g} mm2", figure)
    plt.show()


def main(arguments: Sequence[str] | None = None, prog: str = "arenas") -> int:
    """Run the command. Returns its exit code: 0 done, 2 an input is missing, or the arena is not valid."""
    options = parser(prog).parse_args(arguments)
    return guarded(prog, lambda: run(prog, options))


if __name__ == "__main__":
    sys.exit(ended("arenas", main))
