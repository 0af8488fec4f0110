"""What `pogosim arena` does."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from pogosim.command.parser import complain, warn
from pogosim.geometry.arena_file import ArenaError, Outline, as_csv, parse_outline, read_arena, scaled
from pogosim.lines import say
from pogosim.outputs import checked_output

PICTURES = ("pdf", "png", "svg")


def check_valid(outline: Outline) -> None:
    """Raise ArenaError if the simulator would not take an arena."""
    from pogosim.geometry.validity import problems

    if found := problems(outline):
        more = f" (and {len(found) - 1} more problems)" if len(found) > 1 else ""
        raise ArenaError(f"{outline.source}: {found[0]}{more}")


def read_any(prog: str, path: str) -> Outline:
    """Read an arena file or an SVG drawing, by its suffix, and print warnings."""
    if Path(path).suffix.lower() != ".svg":
        return read_arena(path)
    from pogosim.geometry.svg_file import read_svg

    outline, warnings = read_svg(path)
    for text in warnings:
        warn(prog, text)
    return outline


def write_outline(outline: Outline, path: Path, name: str) -> None:
    """Write an arena in mm as CSV or SVG, by the suffix of the name; it is valid as it is written.

    Raises:
        ArenaError: The simulator would not take it.
        OSError: It cannot be written.
    """
    text = as_csv(outline)
    check_valid(parse_outline(text, outline.source))
    if Path(name).suffix.lower() == ".svg":
        from pogosim.geometry.svg_file import as_svg

        text = as_svg(outline)
    write(path, text.encode(), name)


def write(path: Path, content: bytes, name: str) -> None:
    """Write a file; what keeps it from being written is told with its name.

    Raises:
        OSError: It cannot be written.
    """
    try:
        path.write_bytes(content)
    except OSError as error:
        raise OSError(error.errno, error.strerror, name) from None


def describe(outline: Outline, name: str) -> str:
    """Return the size and area of an arena in mm as a line."""
    width, height = outline.bounds[1] - outline.bounds[0]
    holes = len(outline.polygons) - 1
    corners = sum(map(len, outline.polygons))
    with_holes = f", {holes} hole{'' if holes == 1 else 's'}" if holes else ""
    return f"{name}: {width:.1f} x {height:.1f} mm, area {outline.area:.1f} mm2, {corners} corners{with_holes}"


def show_arena(prog: str, outline: Outline, arena: Outline, radius_mm: float, output: tuple[Path, str] | None) -> int:
    """Print what is to be said of an arena, and draw it; returns the exit code.

    Args:
        prog: Name of the command.
        outline: The arena as in its file.
        arena: The arena in mm.
        radius_mm: Radius of robots, mm.
        output: Where to draw it, and the name of the picture. None: nowhere.
    """
    from pogosim.geometry.validity import problems, room_for

    low, high = outline.bounds
    say(describe(arena, outline.source))
    say(
        f"in the file: from ({low[0]:g}, {low[1]:g}) to ({high[0]:g}, {high[1]:g}), area {outline.area:g}"
        f"{', periodic' if outline.periodic else ''}"
    )
    found = problems(outline)
    say(f"valid: {'no' if found else 'yes'}")
    for problem in found:
        say(f"  {problem}")
    room = None if found else room_for(arena, radius_mm)
    if room is not None:
        parts = f", in {len(room.parts)} parts" if len(room.parts) > 1 else ""
        say(f"robots of radius {radius_mm:g} mm can cover {100.0 * room.share:.1f} % of the area{parts}")
        if not room.parts:
            warn(prog, f"{outline.source}: a robot of radius {radius_mm:g} mm does not fit; enlarge the arena")
        elif len(room.parts) > 1:
            narrow = f"a passage is narrower than a robot, {2.0 * radius_mm:g} mm"
            warn(prog, f"{outline.source}: {narrow}: it divides the arena into {len(room.parts)} parts")
    if output is not None:
        from pogosim.fonts import rendered
        from pogosim.geometry.drawing import draw

        path, name = output
        validity = "" if not found else ", not valid"
        title = f"{Path(outline.source).name}: {arena.area:.6g} mm2{validity}"
        write(path, rendered(draw(arena, room, title), Path(name).suffix[1:].lower()), name)
    if found:
        return complain(prog, f"{outline.source}: the simulator does not take this arena: {found[0]}")
    return 0


def run_show(prog: str, options: argparse.Namespace) -> int:
    """Check, print and draw an arena."""
    output = None
    if options.output is not None:
        output = (checked_output(options.output, options.arena, PICTURES), options.output)
    outline = read_any(prog, options.arena)
    arena = scaled(outline, options.area, stretch=options.stretch)
    return show_arena(prog, outline, arena, options.radius, output)


def run_scale(prog: str, options: argparse.Namespace) -> int:
    """Scale an arena."""
    path = checked_output(options.output, options.arena, ("csv", "svg"))
    return convert(prog, read_any(prog, options.arena), path, options, stretch=options.stretch)


def run_to_svg(prog: str, options: argparse.Namespace) -> int:
    """Make a drawing of an arena."""
    path = checked_output(options.output, options.arena, ("svg",))
    return convert(prog, read_arena(options.arena), path, options)


def run_from_svg(prog: str, options: argparse.Namespace) -> int:
    """Make an arena of a drawing."""
    from pogosim.geometry.svg_file import read_svg

    path = checked_output(options.output, options.drawing, ("csv",))
    outline, warnings = read_svg(
        options.drawing, element=options.element, first_path=options.first_path, tolerance=options.tolerance
    )
    for text in warnings:
        warn(prog, text)
    return convert(prog, outline, path, options)


def convert(prog: str, outline: Outline, path: Path, options: argparse.Namespace, *, stretch: bool = False) -> int:
    """Scale an arena and write it."""
    check_valid(outline)
    arena = scaled(outline, options.area, stretch=stretch)
    write_outline(arena, path, options.output)
    if outline.periodic and Path(options.output).suffix.lower() == ".svg":
        warn(prog, f"{options.output} cannot say that the arena is periodic")
    say(describe(arena, options.output))
    return 0


ACTIONS: dict[str, Callable[[str, argparse.Namespace], int]] = {
    "show": run_show,
    "scale": run_scale,
    "from-svg": run_from_svg,
    "to-svg": run_to_svg,
}
