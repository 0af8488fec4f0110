"""Shapes of objects, as far as pictures need them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.path import Path as Outline

from pogosim.arguments import number
from pogosim.defaults import POGOBOT_RADIUS_MM
from pogosim.deferred import shapely

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Corners = tuple[tuple[float, float], ...]

# A disk has so many corners.
DISK_CORNERS = 72
# Parts of a compound hold together up to this gap.
TOUCHING_MM = 0.1


@dataclass(frozen=True)
class Shape:
    """Shape of an object around its origin, heading along +x. Only the sizes of its own kind count."""

    kind: str = "disk"  # disk, rectangle, capsule, triangle, polygon or compound; also global and arena
    radius_mm: float = 10.0
    width_mm: float = 10.0  # along x
    height_mm: float = 10.0  # along y
    side_length_mm: float = 10.0  # of an equilateral triangle, one corner towards -y
    corner_radius_mm: float = 0.0  # of a rectangle, triangle or polygon: rounds within the sharp corners
    line: Corners = ()  # of a polygon, its sharp corners; of a compound, the line around it

    @property
    def is_round(self) -> bool:
        """Whether it is a disk, as far as a picture shows."""
        return self.kind not in ("rectangle", "capsule", "triangle", "polygon", "compound")

    @property
    def bounding_radius_mm(self) -> float:
        """Radius of the smallest disk around the origin that holds the shape."""
        return self.radius_mm if self.is_round else float(np.hypot(*self.outline().T).max())

    @property
    def reach_mm(self) -> float:
        """Distance from the origin to the border along the heading; 0 of a compound that does not lie that way."""
        if self.is_round:
            return self.radius_mm
        (x, y), (next_x, next_y) = self.outline().T, np.roll(self.outline(), -1, axis=0).T
        crosses = (y <= 0.0) != (next_y <= 0.0)
        rise = np.where(crosses, next_y - y, 1.0)
        return float(np.where(crosses, x - y * (next_x - x) / rise, 0.0).max(initial=0.0))

    def outline(self) -> Floats:
        """Corners, shape (n, 2), in mm; a disk has 72. A hole of a compound is cut open at a line."""
        if self.is_round:
            angle = -math.pi / 2.0 + 2.0 * math.pi * np.arange(DISK_CORNERS) / DISK_CORNERS
            return self.radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])
        if self.kind == "capsule":
            radius = min(self.width_mm, self.height_mm) / 2.0
            end = np.array([self.width_mm / 2.0 - radius, self.height_mm / 2.0 - radius])
            return ring_of(shapely.LineString([-end, end]).buffer(radius, quad_segs=DISK_CORNERS // 4))
        if self.corner_radius_mm > 0.0 and self.kind != "compound":
            core = shapely.Polygon(self.sharp()).buffer(-self.corner_radius_mm, join_style="mitre", mitre_limit=100.0)
            return ring_of(core.buffer(self.corner_radius_mm, quad_segs=DISK_CORNERS // 4))
        return self.sharp()

    def sharp(self) -> Floats:
        """Corners without rounding."""
        if self.kind == "rectangle":
            return np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [self.width_mm / 2.0, self.height_mm / 2.0]
        if self.kind == "triangle":
            angle = -math.pi / 2.0 + 2.0 * math.pi * np.arange(3) / 3.0
            return self.side_length_mm / math.sqrt(3.0) * np.column_stack([np.cos(angle), np.sin(angle)])
        return np.array(self.line, dtype=float).reshape(-1, 2)

    def holds(self, offset_mm: Floats) -> Bools:
        """Tell which points, relative to the origin, are inside. Shape (n, 2) to (n,)."""
        if self.kind == "global":
            return np.ones(len(offset_mm), dtype=bool)
        if self.kind == "disk":
            return np.asarray(np.hypot(*offset_mm.T) <= self.radius_mm)
        return Outline(self.outline()).contains_points(offset_mm)


def shape_of(settings: dict[str, Any]) -> Shape:
    """Shape that an entry's `geometry` and sizes say. What cannot be read has the simulator's default.

    The origin of a polygon or compound is its centre of mass; where parts of a compound overlap, both weigh.
    """
    is_pogobot = str(settings.get("type", "pogobot")).lower() == "pogobot"
    plain = Shape(radius_mm=POGOBOT_RADIUS_MM) if is_pogobot else Shape()
    kind = str(settings.get("geometry", plain.kind)).lower()
    shape = Shape(
        kind=kind,
        radius_mm=number(settings.get("radius"), plain.radius_mm),
        width_mm=number(settings.get("body_width"), plain.width_mm),
        height_mm=number(settings.get("body_height"), plain.height_mm),
        side_length_mm=number(settings.get("side_length"), plain.side_length_mm),
        corner_radius_mm=number(settings.get("corner_radius"), 0.0),
        line=corners_of(settings.get("corners")) if kind == "polygon" else (),
    )
    if kind == "polygon" and len(shape.line) > 2:
        return with_line(shape, shape.sharp() - centre_of([shapely.Polygon(shape.outline())]))
    if kind == "compound":
        parts = [placed_part(part) for part in settings.get("parts") or () if isinstance(part, dict)]
        if parts:
            return with_line(shape, joined(parts) - centre_of(parts))
    return shape if kind not in ("polygon", "compound") else Shape()


def with_line(shape: Shape, line_mm: Floats) -> Shape:
    """Return the shape with another line."""
    return Shape(shape.kind, corner_radius_mm=shape.corner_radius_mm, line=tuple((x, y) for x, y in line_mm.tolist()))


def corners_of(value: object) -> Corners:
    """Corners as they are written; none where they are not a list of pairs."""
    if not isinstance(value, list) or not all(isinstance(pair, list) and len(pair) == 2 for pair in value):
        return ()
    return tuple((number(x, 0.0), number(y, 0.0)) for x, y in value)


def placed_part(settings: dict[str, Any]) -> shapely.Polygon:
    """A part of a compound where it is."""
    angle = math.radians(number(settings.get("angle_deg"), 0.0))
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    offset = [number(settings.get(axis), 0.0) for axis in ("x", "y")]
    return shapely.Polygon(shape_of({"type": "part"} | settings).outline() @ turn + offset)


def centre_of(parts: list[shapely.Polygon]) -> Floats:
    """Centre of mass, (x, y)."""
    weights = [part.area for part in parts]
    return np.average([[part.centroid.x, part.centroid.y] for part in parts], axis=0, weights=weights)


def joined(parts: list[shapely.Polygon]) -> Floats:
    """The line around parts that overlap or touch. Shape (n, 2)."""
    wider = shapely.union_all([part.buffer(TOUCHING_MM / 2.0, join_style="mitre") for part in parts])
    return ring_of(wider.buffer(-TOUCHING_MM / 2.0, join_style="mitre").simplify(TOUCHING_MM / 10.0))


def ring_of(area: shapely.Geometry) -> Floats:
    """Line around an area, with a cut to each hole. Shape (n, 2)."""
    largest = max(getattr(area, "geoms", [area]), key=lambda part: part.area)
    ring = np.array(largest.exterior.coords)[:-1]
    for hole in largest.interiors:
        inner = np.array(hole.coords)[:-1]
        apart = np.hypot(*(ring[:, None] - inner[None]).transpose(2, 0, 1))
        at, start = np.unravel_index(int(apart.argmin()), apart.shape)
        inner = np.roll(inner, -int(start), axis=0)
        ring = np.vstack([ring[: at + 1], inner, inner[:1], ring[at:]])
    return ring
