"""Arena files: outlines as CSV, read as the simulator reads them (src/geometry/arena_file.cpp)."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pogosim.errors import ToolError

Floats = npt.NDArray[np.float64]

PERIODIC = "boundary_condition: periodic"
BLANKS = " \t\v\f"
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
DIGITS = 4  # behind the point, in files that are written: 0.1 um of an arena in mm


class ArenaError(ToolError):
    """An arena cannot be read, used or written; says which file, where, and what to do."""


@dataclass(frozen=True)
class Outline:
    """The polygons of an arena.

    Attributes:
        polygons: First the outer one, then its holes; each of shape (corners, 2), not closed, at least 3 corners. x to
            the right, y down. In the unit of the file, or mm.
        source: Name of the file, for messages.
        periodic: The opposite sides of the bounding box are one.
    """

    polygons: tuple[Floats, ...]
    source: str
    periodic: bool = False

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Top left and bottom right corner of the bounding box of all polygons. Shape (2,) each."""
        corners = np.vstack(self.polygons)
        return corners.min(axis=0), corners.max(axis=0)

    @property
    def area(self) -> float:
        """Area of the outer polygon less the holes, in squares of the unit."""
        areas = [abs(signed_area(polygon)) for polygon in self.polygons]
        return areas[0] - sum(areas[1:])


def signed_area(polygon: Floats) -> float:
    """Return the area of a polygon of shape (corners, 2), positive if its corners go clockwise on the screen."""
    x, y = (polygon - polygon[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def without_repetitions(polygon: Sequence[tuple[float, float]]) -> Floats:
    """Return the corners without those that equal their predecessor, and the last if it equals the first.

    They are compared in single precision, as the simulator computes.
    """
    corners = np.asarray(polygon, dtype=float).reshape(-1, 2)
    single = corners.astype(np.float32)
    differs = np.ones(len(corners), dtype=bool)
    differs[1:] = (single[1:] != single[:-1]).any(axis=1)
    kept, single = corners[differs], single[differs]
    return kept[:-1] if len(kept) > 1 and (single[0] == single[-1]).all() else kept


def parse_coordinate(field: str) -> float | None:
    """Return a decimal number that is finite in single precision, or None."""
    field = field.strip(BLANKS)
    if len(field) >= 2 and field[0] == field[-1] == '"':
        field = field[1:-1].strip(BLANKS)
    if not NUMBER.fullmatch(field):
        return None
    value = float(field)
    return value if abs(value) <= float(np.finfo(np.float32).max) else None


def parse_outline(text: str, source: str) -> Outline:
    """Return the polygons of the text of an arena file: `x,y` a line, a blank line between polygons, # for comments.

    Raises:
        ArenaError: Says which line is wrong.
    """
    blocks: list[list[tuple[float, float]]] = []
    first_lines: list[int] = []
    periodic, starts_polygon = False, True
    for number, raw in enumerate(re.split(r"\r\n|\r|\n", text.removeprefix("\ufeff")), start=1):
        line = raw.strip(BLANKS)
        if line.startswith("#"):
            periodic = periodic or line[1:].strip(BLANKS) == PERIODIC
            continue
        if line:
            coordinates = [parse_coordinate(field) for field in line.split(",")]
            if len(coordinates) != 2 or coordinates[0] is None or coordinates[1] is None:
                raise ArenaError(
                    f"{source}:{number}: expected a corner 'x,y', found {line[:40]!r}. Write one corner a line, with "
                    "one comma between its coordinates; a blank line ends a polygon"
                )
            if starts_polygon:
                blocks.append([])
                first_lines.append(number)
            blocks[-1].append((coordinates[0], coordinates[1]))
        starts_polygon = not line
    if not blocks:
        raise ArenaError(f"{source}: the file has no polygon; expected the corners of an arena, one 'x,y' a line")
    polygons = tuple(without_repetitions(block) for block in blocks)
    for polygon, line_number in zip(polygons, first_lines, strict=True):
        if len(polygon) < 3:
            raise ArenaError(
                f"{source}:{line_number}: this polygon has {len(polygon)} different corner"
                f"{'' if len(polygon) == 1 else 's'}, and needs at least 3. A blank line ends a polygon"
            )
    return Outline(polygons, source, periodic)


def read_arena(path: str | Path) -> Outline:
    """Read an arena file. Its polygons may still lie wrongly to each other, see validity.py.

    Raises:
        ArenaError: It is no arena file.
        OSError: It cannot be read.
    """
    file = Path(path)
    if file.exists() and not file.is_file():
        raise ArenaError(f"{path} is not a file; expected an arena, a CSV file of corners")
    try:
        text = file.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise ArenaError(f"{path} is not a text file; expected an arena, one corner 'x,y' a line") from None
    return parse_outline(text, str(path))


def scaled(outline: Outline, area_mm2: float | None, *, stretch: bool = False) -> Outline:
    """Return an outline in mm, the corner of its bounding box at (0, 0), as the simulator scales it.

    Args:
        outline: The polygons.
        area_mm2: Area of the outer polygon less the holes that is asked for, mm2, above 0. None: the file is in mm.
        stretch: First stretch the bounding box to a square; only with an area.

    Raises:
        ArenaError: The outer polygon less the holes has no area, or the result would leave the numbers.
    """
    if not (math.isfinite(outline.area) and outline.area > 0.0):
        raise ArenaError(
            f"{outline.source}: the outer polygon less the holes has an area of {outline.area:g}, which must be "
            "positive. The first polygon must be the outer one"
        )
    low, high = outline.bounds
    width, height = high - low
    aspect = height / width if stretch and area_mm2 is not None else 1.0
    factor_y = math.sqrt((outline.area if area_mm2 is None else area_mm2) / outline.area / aspect)
    factors = np.array([factor_y * aspect, factor_y])
    return dataclasses.replace(outline, polygons=tuple((polygon - low) * factors for polygon in outline.polygons))


def digits_for(outline: Outline) -> int:
    """Return how many digits behind the point keep the shape: more for outlines of small numbers."""
    low, high = outline.bounds
    extent = float((high - low).max())
    return max(DIGITS, DIGITS + 3 - math.ceil(math.log10(extent))) if extent > 0.0 else DIGITS


def as_csv(outline: Outline) -> str:
    """Return the text of the arena file of an outline."""
    digits = digits_for(outline)
    # Adding zero turns a rounded -0.0 into 0.0.
    blocks = [
        "".join(
            f"{round(x, digits) + 0.0:.{digits}f},{round(y, digits) + 0.0:.{digits}f}\n" for x, y in polygon.tolist()
        )
        for polygon in outline.polygons
    ]
    return (f"# {PERIODIC}\n" if outline.periodic else "") + "\n".join(blocks)
