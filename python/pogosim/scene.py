"""What a configuration says of the objects of a run, as far as pictures need it: their shapes, and the light."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.path import Path as Outline

from pogosim.arguments import number
from pogosim.object_facts import Entry, type_of
from pogosim.periodic import minimum_image
from pogosim.shapes import Floats, Shape, shape_of

# Levels of light are sensor counts, and sums of them stop here.
BRIGHTEST = 32767


@dataclass(frozen=True)
class Kind:
    """How the objects of one entry of `objects` look."""

    category: str
    shape: Shape
    runs_program: bool = True
    is_membrane: bool = False
    segments: bool = False  # of a membrane: it is drawn as a band
    half_thickness_mm: float = 0.0  # of a membrane
    is_wall: bool = False  # it has a program, and no body
    position_mm: tuple[float, float] | None = None  # x and y of a wall, where both are given
    talks: bool = True  # it has a rigid body and a program, so lines may join it to others near enough to hear it
    communication_radius_mm: float = 0.0  # if it talks: from an emitter to the edge of a listener; 0: mute
    parts: tuple[dict[str, Any], ...] = field(default=(), compare=False)  # of a compound, as the configuration has them


@dataclass(frozen=True)
class Lamp:
    """A spot of light, which the keys of static_light and orbiting_static_light describe."""

    shape: Shape
    centre_mm: tuple[float, float]
    mode: str = "static"  # or gradient, plane
    value: float = 10.0
    edge_value: float = 0.0
    gradient_radius_mm: float = -1.0  # 0 or less: the largest distance in the shape
    plane_angle_rad: float = 0.0
    plane_half_span_mm: float = 1000.0
    photo_start_at_s: float = -1.0
    photo_start_duration_s: float = 1.0
    photo_start_value: float = float(BRIGHTEST)
    orbit_radius_mm: float = 0.0
    orbit_speed_rad_s: float = 0.0
    orbit_phase_rad: float = 0.0

    @property
    def has_place(self) -> bool:
        """Whether it shines from a place that can be seen, not evenly everywhere."""
        return self.shape.kind not in ("global", "arena") or self.mode == "gradient"

    def centre_at(self, time_s: float) -> Floats:
        """Where the lamp is, (x, y) in mm."""
        angle = self.orbit_phase_rad + self.orbit_speed_rad_s * time_s
        return np.array(self.centre_mm) + self.orbit_radius_mm * np.array([math.cos(angle), math.sin(angle)])

    def photo_phase(self, time_s: float) -> int:
        """Phase of the photo start: -1 before it, 0 during it, 1 after it or without one."""
        since_s = time_s - self.photo_start_at_s
        if self.photo_start_at_s < 0.0 or since_s >= self.photo_start_duration_s:
            return 1
        return 0 if since_s >= 0.0 else -1

    def levels(self, points_mm: Floats, polygons: list[Floats], time_s: float, period_mm: Floats | None) -> Floats:
        """Light that it gives at points of the arena at a time. Shape (n, 2) to (n,); sensor counts."""
        offset = minimum_image(points_mm - self.centre_at(time_s), period_mm)
        if self.shape.kind == "arena":  # the insides of holes, too
            lit = np.any([Outline(polygon).contains_points(points_mm) for polygon in polygons], axis=0)
        else:
            lit = self.shape.holds(offset)
        return np.where(
            lit, self.levels_around(offset, self.gradient_reach_mm(polygons, time_s, period_mm), time_s), 0.0
        )

    def levels_around(self, offset: Floats, gradient_reach_mm: float, time_s: float) -> Floats:
        """Level at points relative to the centre, wherever the shape ends."""
        phase = self.photo_phase(time_s)
        if phase < 1:
            return np.full(len(offset), self.photo_start_value if phase == 0 else 0.0)
        share = np.zeros(len(offset))
        if self.mode == "gradient":
            share = np.hypot(*offset.T) / gradient_reach_mm
        elif self.mode == "plane":
            normal = np.array([math.cos(self.plane_angle_rad), math.sin(self.plane_angle_rad)])
            share = 0.5 + offset @ normal / (2.0 * self.plane_half_span_mm)
        return self.value + (self.edge_value - self.value) * np.clip(share, 0.0, 1.0)

    def gradient_reach_mm(self, polygons: list[Floats], time_s: float, period_mm: Floats | None) -> float:
        """Distance from the centre at which a gradient has its edge value."""
        if self.gradient_radius_mm > 0.0:
            return self.gradient_radius_mm
        if self.shape.kind not in ("global", "arena"):
            return self.shape.bounding_radius_mm
        if period_mm is not None:
            return float(np.hypot(*period_mm) / 2.0)
        low, high = bounds(polygons)
        centre = self.centre_at(time_s)
        return float(np.hypot(*np.maximum(centre - low, high - centre)))


def bounds(polygons: list[Floats]) -> tuple[Floats, Floats]:
    """Corners (x, y) of the smallest box around all polygons: least and greatest."""
    vertices = np.concatenate(polygons)
    return vertices.min(axis=0), vertices.max(axis=0)


def turned(polygon: Floats, clockwise: bool) -> Floats:
    """Order the vertices clockwise (on the screen) or against it."""
    x, y = polygon.T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return polygon if (area > 0) == clockwise else polygon[::-1]


def floor_outline(polygons: list[Floats]) -> Outline:
    """Return the floor, with holes cut out."""
    loops = [turned(polygon, clockwise=i == 0) for i, polygon in enumerate(polygons)]
    return Outline.make_compound_path(*(Outline(np.vstack([p, p[:1]]), closed=True) for p in loops))


def read_periodic(configuration: dict[str, Any]) -> bool:
    """Tell whether what leaves the arena comes back on the other side."""
    return str(configuration.get("boundary_condition")).lower() == "periodic"


def top_speed(entries: list[Entry]) -> float | None:
    """Return how fast the fastest robots drive, mm/s; None if nothing says it."""
    return max((own.top_speed_mm_s for own in entries if math.isfinite(own.top_speed_mm_s)), default=None)


def bodies_of(entries: list[Entry]) -> list[Entry]:
    """Entries of all objects except lamps."""
    return [own for own in entries if "lamp" not in own.has]


def spots_of(entries: list[Entry]) -> list[Entry]:
    """Entries of lamps that are drawn."""
    return [own for own in entries if own.drawn_as == "spot"]


def kinds_in(entries: list[Entry]) -> list[Kind]:
    """Return how the objects of each entry look, in the order of `bodies_of`."""
    return [
        Kind(
            own.category,
            shape_of(own.settings),
            runs_program="robot" in own.has,
            is_membrane="membrane" in own.has,
            segments=own.segments,
            half_thickness_mm=own.half_thickness_mm,
            is_wall=own.is_wall,
            position_mm=own.position_mm,
            talks=own.is_robot,
            communication_radius_mm=own.infrared_range_mm if own.is_robot else 0.0,
            parts=tuple(part for part in own.settings.get("parts") or () if isinstance(part, dict)),
        )
        for own in bodies_of(entries)
    ]


def lamps_in(entries: list[Entry]) -> list[Lamp]:
    """All spots of light; `nb` of an entry shine at the same place."""
    lamps = []
    for own in spots_of(entries):
        lamps += [read_lamp(own.settings)] * int(number(own.settings.get("nb"), 1.0))
    return lamps


def read_lamp(settings: dict[str, Any]) -> Lamp:
    """Read one spot of light."""

    def value(key: str, default: float) -> float:
        return number(settings.get(key), default)

    orbits = type_of(settings) != "static_light"
    centre = [value(axis, 0.0) for axis in ("x", "y")]
    if orbits:
        centre = [value(f"center_{axis}", own) for axis, own in zip(("x", "y"), centre, strict=True)]
    return Lamp(
        shape=shape_of(settings),
        centre_mm=(centre[0], centre[1]),
        mode=str(settings.get("light_mode", Lamp.mode)),
        value=value("value", Lamp.value),
        edge_value=value("edge_value", Lamp.edge_value),
        gradient_radius_mm=value("gradient_radius", Lamp.gradient_radius_mm),
        plane_angle_rad=value("plane_angle", Lamp.plane_angle_rad),
        plane_half_span_mm=value("plane_half_span", Lamp.plane_half_span_mm),
        photo_start_at_s=value("photo_start_at", Lamp.photo_start_at_s),
        photo_start_duration_s=value("photo_start_duration", Lamp.photo_start_duration_s),
        photo_start_value=value("photo_start_value", Lamp.photo_start_value),
        orbit_radius_mm=value("orbit_radius", Lamp.orbit_radius_mm) if orbits else 0.0,
        orbit_speed_rad_s=value("orbit_angular_speed", value("angular_speed", Lamp.orbit_speed_rad_s)),
        orbit_phase_rad=value("orbit_phase", Lamp.orbit_phase_rad),
    )


def unseen_light(entries: list[Entry]) -> list[str]:
    """What is not drawn of lamps: beams of lighthouses, light of kinds that only the simulator knows, and shadows."""
    lamps = [own for own in entries if "lamp" in own.has]
    beams = [f"beams of {own.category}" for own in lamps if own.drawn_as == "beam"]
    others = [f"light of {own.category}" for own in lamps if own.drawn_as not in ("beam", "spot")]
    shadows = [f"shadows of {own.category}" for own in spots_of(lamps) if own.settings.get("casts_shadows") is True]
    return beams + list(dict.fromkeys(others + shadows))


def light_levels(
    lamps: list[Lamp], polygons: list[Floats], points_mm: Floats, time_s: float, period_mm: Floats | None = None
) -> Floats:
    """Light of all lamps at points of the arena at a time.

    Args:
        lamps: Spots of light; their levels add up, to 32767 at most.
        polygons: Outlines of the arena, each of shape (vertices, 2), in mm.
        points_mm: Shape (n, 2).
        time_s: Since the start of the run.
        period_mm: Width and height of a periodic arena, in which the nearest image of each lamp counts. None: walls.

    Returns:
        Shape (n,), sensor counts.
    """
    total = np.zeros(len(points_mm))
    for lamp in lamps:
        total += lamp.levels(points_mm, polygons, time_s, period_mm)
    return np.minimum(total, BRIGHTEST)
