"""What a configuration says of the objects of a run, as far as pictures need it: their shapes, and the light."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.path import Path as Outline

from pogosim.arguments import number
from pogosim.defaults import COMMUNICATION_RADIUS_MM
from pogosim.periodic import minimum_image
from pogosim.shapes import Floats, Shape, shape_of

MEMBRANES = ("membrane", "rectmembrane")
RAYS = ("rotating_ray_of_light", "alternating_rays_of_light")
SPOTS = ("static_light", "orbiting_static_light", "orbiting_light")

TALKERS = ("pogobot", "pogobject", "active_object")  # bodies with a program

# Levels of light are sensor counts, and sums of them stop here.
BRIGHTEST = 32767


@dataclass(frozen=True)
class Kind:
    """How the objects of one entry of `objects` look."""

    category: str
    type: str  # lower case, "pogobot"
    shape: Shape
    half_thickness_mm: float = 0.0  # of a membrane
    position_mm: tuple[float, float] | None = None  # x and y of a wall, where both are given
    communication_radius_mm: float = 0.0  # from an emitter to the edge of a listener; 0: mute


@dataclass(frozen=True)
class Lamp:
    """A spot of light: static_light or orbiting_static_light."""

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


def entries(configuration: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """Entries of `objects` that are maps, each with its name; a category may be a list of several."""
    objects = configuration.get("objects")
    pairs = objects.items() if isinstance(objects, dict) else []
    return [
        (str(name), settings)
        for name, value in pairs
        for settings in (value if isinstance(value, list) else [value])
        if isinstance(settings, dict)
    ]


def type_of(settings: dict[str, Any]) -> str:
    """Type of an entry in lower case."""
    return str(settings.get("type", "pogobot")).lower()


def half_thickness_of(settings: dict[str, Any]) -> float:
    """Half the thickness of a membrane, mm; 0 for what is none."""
    dot_radius = number(settings.get("dot_radius"), 10.0)
    if type_of(settings) == "rectmembrane":
        return number(settings.get("rect_thickness"), dot_radius) / 2.0
    return dot_radius if type_of(settings) == "membrane" else 0.0


def position_of(settings: dict[str, Any]) -> tuple[float, float] | None:
    """`x` and `y` of an entry, mm; None unless it has both."""
    x, y = (number(settings.get(axis), math.nan) for axis in ("x", "y"))
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None


def communication_radius_of(settings: dict[str, Any]) -> float:
    """Infrared range of a body with a program, mm; 0 for all else."""
    if type_of(settings) not in TALKERS:
        return 0.0
    return number(settings.get("communication_radius"), COMMUNICATION_RADIUS_MM)


def read_periodic(configuration: dict[str, Any]) -> bool:
    """Tell whether what leaves the arena comes back on the other side."""
    return str(configuration.get("boundary_condition")).lower() == "periodic"


def read_top_speed(configuration: dict[str, Any]) -> float | None:
    """Return how fast the fastest robots of a configuration drive, mm/s; None if it does not say."""
    drivers = [settings for _, settings in entries(configuration) if type_of(settings) == "pogobot"]
    speeds = [number(own.get("max_linear_speed"), math.nan) for own in drivers]
    return max((speed for speed in speeds if math.isfinite(speed)), default=None)


def bodies_of(configuration: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """Entries of all objects except lamps, each with the name of its category."""
    return [(name, own) for name, own in entries(configuration) if type_of(own) not in SPOTS + RAYS]


def read_kinds(configuration: dict[str, Any]) -> list[Kind]:
    """Return how the objects of each entry look, in the order of `bodies_of`."""
    return [
        Kind(
            name,
            type_of(own),
            shape_of(own),
            half_thickness_of(own),
            position_of(own) if type_of(own) == "pogowall" else None,
            communication_radius_of(own),
        )
        for name, own in bodies_of(configuration)
    ]


def read_lamps(configuration: dict[str, Any]) -> list[Lamp]:
    """All spots of light; `nb` of an entry shine at the same place."""
    lamps = []
    for _, settings in entries(configuration):
        if type_of(settings) in SPOTS:
            lamps += [read_lamp(settings)] * int(number(settings.get("nb"), 1.0))
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


def ray_names(configuration: dict[str, Any]) -> list[str]:
    """Categories of lighthouses."""
    return [name for name, settings in entries(configuration) if type_of(settings) in RAYS]


def shadow_names(configuration: dict[str, Any]) -> list[str]:
    """Categories of lamps that cast shadows."""
    lamps = [(name, settings) for name, settings in entries(configuration) if type_of(settings) in SPOTS]
    return list(dict.fromkeys(name for name, settings in lamps if settings.get("casts_shadows") is True))


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
