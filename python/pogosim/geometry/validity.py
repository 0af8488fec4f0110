"""Whether the simulator takes an arena, and whether robots fit through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry import LinearRing, MultiPolygon
from shapely.geometry.base import BaseGeometry
from shapely.validation import explain_validity

from pogosim.geometry.arena_file import Floats, Outline, signed_area

# Least area of a polygon, as a fraction of its bounding box's squared diagonal, as in src/geometry/arena_file.cpp.
THINNEST = 1.0e-7
# Parts of the room for a robot's centre below this fraction of all are rounding.
SMALLEST_PART = 1.0e-6


def name_of(number: int) -> str:
    """Return what a polygon is called: the first is the outer one, the others are holes 1, 2, ..."""
    return "the outer polygon" if number == 0 else f"hole {number}"


def ring_of(polygon: Floats) -> LinearRing:
    """Return a polygon's edges, in the single precision with which the simulator computes."""
    return LinearRing(polygon.astype(np.float32).astype(float))


def problems(outline: Outline) -> list[str]:
    """Return why the simulator does not take an arena, one line each; nothing if it does.

    It wants polygons with an area that neither cross nor touch themselves or each other, and each hole inside the outer
    one, and not inside another hole.
    """
    found = []
    rings = [ring_of(polygon) for polygon in outline.polygons]
    for number, (polygon, ring) in enumerate(zip(outline.polygons, rings, strict=True)):
        size = np.ptp(polygon, axis=0)
        if not abs(signed_area(polygon)) > THINNEST * float((size**2).sum()):
            found.append(f"{name_of(number)} encloses no area: its corners are on one line, or its loops cancel out")
        elif not ring.is_simple:
            found.append(f"{name_of(number)} crosses or touches itself{place_of_crossing(ring)}")
    if found:
        return found
    tree = shapely.STRtree(rings)
    first, second = tree.query(rings, predicate="intersects")
    for a, b in sorted({(int(i), int(j)) for i, j in zip(first, second, strict=True) if i < j}):
        where = rings[a].intersection(rings[b]).representative_point()
        found.append(f"{name_of(a)} and {name_of(b)} cross or touch near ({where.x:g}, {where.y:g})")
    return found or nesting_problems(rings)


def place_of_crossing(ring: LinearRing) -> str:
    """Return where a ring crosses itself, as part of a sentence."""
    reason = explain_validity(Polygon(ring))
    _, bracket, place = reason.partition("[")
    return f" near ({', '.join(place.rstrip(']').split())})" if bracket else ""


def nesting_problems(rings: list[LinearRing]) -> list[str]:
    """Return which holes are not directly inside the outer polygon; no two rings cross."""
    filled = [Polygon(ring) for ring in rings]
    inside, around = shapely.STRtree(filled).query(filled, predicate="within")
    parents: dict[int, set[int]] = {number: set() for number in range(len(rings))}
    for a, b in zip(inside, around, strict=True):
        if a != b:
            parents[int(a)].add(int(b))
    found = []
    for number in range(1, len(rings)):
        if 0 not in parents[number]:
            found.append(f"hole {number} is outside the outer polygon, which must be the first one of the file")
        elif others := sorted(parents[number] - {0}):
            found.append(f"hole {number} is inside hole {others[0]}")
    return found


@dataclass(frozen=True)
class Room:
    """How much room an arena has for robots of one size.

    Attributes:
        floor: The floor of the arena.
        parts: What robots can cover, in the parts into which narrow places divide it; none: they do not fit.
    """

    floor: Polygon
    parts: tuple[BaseGeometry, ...]

    @property
    def share(self) -> float:
        """Share of the floor that robots can cover, 0 to 1."""
        return min(float(shapely.union_all(self.parts).area) / self.floor.area, 1.0) if self.parts else 0.0


def room_for(outline: Outline, radius_mm: float) -> Room:
    """Return how much room an arena has for disks: its opening by a disk, part by part.

    J. Serra, "Image analysis and mathematical morphology", Academic Press, 1982.

    Args:
        outline: An arena without problems(), in mm.
        radius_mm: Radius of the robots, mm, above 0.
    """
    floor = floor_of(outline)
    centres = floor.buffer(-radius_mm, quad_segs=32)
    parts = centres.geoms if isinstance(centres, MultiPolygon) else [centres]
    large = [part for part in parts if part.area > SMALLEST_PART * floor.area]
    return Room(floor, tuple(part.buffer(radius_mm, quad_segs=32).intersection(floor) for part in large))


def floor_of(outline: Outline) -> Polygon:
    """Return the floor of a valid arena, with its holes."""
    return Polygon(outline.polygons[0], outline.polygons[1:])
