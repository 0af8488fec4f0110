"""`python -m pogosim.arenas`: draws the arena of a configuration, scaled as the simulator scales it.

`pogosim arena show` does the same for an arena file.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from pogosim.command.main import ended
from pogosim.command.parser import Parser, guarded, positive
from pogosim.defaults import POGOBOT_RADIUS_MM
from pogosim.geometry.actions import PICTURES, show_arena
from pogosim.geometry.arena_file import ArenaError, Outline
from pogosim.geometry.configured import arena_of, read_entries
from pogosim.outputs import checked_output


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


def selected(options: argparse.Namespace) -> tuple[Outline, Outline]:
    """Return the arena as in its file, and in mm.

    Raises:
        ArenaError, OSError: Says what is wrong.
    """
    path = Path(options.config)
    # With all that is needed on the command line, no configuration is.
    is_needed = options.arena_file is None or path.is_file()
    given = {"arena_file": options.arena_file, "arena_surface": options.arena_surface}
    entries = (read_entries(path) if is_needed else {}) | {key: value for key, value in given.items() if value}
    if not isinstance(entries.get("arena_file"), str) or not entries["arena_file"]:
        raise ArenaError(f"{path} has no arena_file; give one with --arena-file")
    return arena_of(entries, path)


def run(prog: str, options: argparse.Namespace) -> int:
    """Draw the arena; raises ArenaError, OutputError or OSError if that is not possible."""
    outline, arena = selected(options)
    output = None
    if not options.no_save:
        name = str(Path(options.output_dir, options.outfile))
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        output = (checked_output(name, outline.source, PICTURES), name)
    code = show_arena(prog, outline, arena, POGOBOT_RADIUS_MM, output)
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
