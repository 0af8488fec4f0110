"""Arenas of files: outlines as CSV, scaled as the simulator does it; for data that do not have their arena."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.errors import AnalysisError

PERIODIC = "boundary_condition: periodic"


def read_arena(path: Path, surface_mm2: float | None = None, stretch: bool = False, periodic: bool = False) -> Arena:
    """Read an arena file: a corner `x,y` per line, blank lines between outlines, the outer wall first.

    Args:
        path: CSV; lines with `#` are comments; `# boundary_condition: periodic` means that the arena is periodic.
        surface_mm2: Area to which the floor is scaled, holes not counted; None: the file is in mm.
        stretch: Make the bounding box a square first.
        periodic: It is, whatever the file says.

    Returns:
        The arena, with the corner of its bounding box at (0, 0).

    Raises:
        AnalysisError: The file is no arena.
        OSError: It cannot be read.
    """
    outlines: list[list[list[float]]] = [[]]
    for number, line in enumerate(path.read_text(encoding="utf-8-sig", errors="replace").splitlines(), 1):
        text, _, comment = line.partition("#")
        periodic = periodic or " ".join(comment.split()) == PERIODIC
        if text.strip():
            outlines[-1].append(corner(text, f"{path}:{number}"))
        elif not comment and outlines[-1]:
            outlines.append([])
    polygons = [np.array(outline) for outline in outlines if outline]
    if not polygons or min(map(len, polygons)) < 3 or not (np.ptp(polygons[0], axis=0) > 0.0).all():
        raise AnalysisError(f"{path}: expected outlines of three corners or more, one 'x,y' a line")
    return placed(Arena(path.stem, polygons, periodic), surface_mm2, stretch)


def corner(text: str, where: str) -> list[float]:
    """Return the coordinates of a line of an arena file."""
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        raise AnalysisError(f"{where}: expected a corner 'x,y', found '{text.strip()[:40]}'") from None
    if not np.isfinite([x, y]).all():
        raise AnalysisError(f"{where}: coordinates are finite numbers, found '{text.strip()[:40]}'")
    return [x, y]


def placed(arena: Arena, surface_mm2: float | None, stretch: bool) -> Arena:
    """Move an arena to the origin, and scale it to an area."""
    low, size = arena.bounds_mm[0], arena.size_mm
    scale: Floats = size.max() / size if stretch else np.ones(2)
    polygons = [(polygon - low) * scale for polygon in arena.polygons]
    if surface_mm2 is not None:
        walls = Arena(arena.name, polygons)  # of periodic arenas, too, the area is that within the outlines
        polygons = [polygon * np.sqrt(surface_mm2 / walls.area_mm2) for polygon in polygons]
    return Arena(arena.name, polygons, arena.is_periodic)
