"""A recorded run as the painter takes it: what stands still, and arrays for each moment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.arguments import number
from pogosim.film.painter import HEARD, LINK, LINK_KINDS, Moment, Numbers, Painter, Stage, Trails
from pogosim.film.shown import check_follow, value_of_heat_map
from pogosim.film.timeline import Timeline, timeline_of
from pogosim.film.trails import Trail, TrailOfPlaces, TrailOfSeconds
from pogosim.periodic import minimum_image
from pogosim.picture.body_links import placed_links
from pogosim.picture.colouring import numbers_of
from pogosim.picture.links import box_of, proximity_pairs
from pogosim.picture.palette import DARK_WALL
from pogosim.picture.speed import SPEED, with_speed
from pogosim.picture.swarm import KIND, OBJECT, RGB, Recording
from pogosim.scene import BRIGHTEST, Kind, bounds, light_levels
from pogosim.shapes import Floats, Shape
from pogosim.view.beginning import view_of

LIGHT_CELLS = 100.0  # columns and rows of the map of light, where a file does not say

SIZES = {
    "disk": ("radius",),
    "rectangle": ("body_width", "body_height", "corner_radius"),
    "capsule": ("body_width", "body_height"),
    "triangle": ("side_length", "corner_radius"),
    "polygon": ("corner_radius",),
    "arena": (),
    "global": (),
}


def geometry_of(shape: Shape) -> dict[str, Any]:
    """Return the keys that describe a shape in a configuration."""
    sizes = {
        "radius": shape.radius_mm,
        "body_width": shape.width_mm,
        "body_height": shape.height_mm,
        "side_length": shape.side_length_mm,
        "corner_radius": shape.corner_radius_mm,
    }
    kind = shape.kind if shape.kind in SIZES else "disk"
    corners = {"corners": [list(corner) for corner in shape.line]} if kind == "polygon" else {}
    return {"geometry": kind, **{name: sizes[name] for name in SIZES[kind]}, **corners}


def kind_of(kind: Kind, has_parts: bool) -> dict[str, Any]:
    """Describe how the objects of a kind look; `has_parts`: of a membrane, the file has its parts."""
    if kind.is_wall:
        x_mm, y_mm = kind.position_mm or (0.0, 0.0)
        return {"is": "wall", "x": x_mm, "y": y_mm, **geometry_of(kind.shape)}
    if kind.is_membrane and not has_parts:  # a dot, where its first part is
        return {"is": "body", "geometry": "disk", "radius": kind.half_thickness_mm}
    role = "robot" if kind.runs_program else "body"
    if kind.is_membrane:
        role = "robot_membrane" if kind.runs_program else "membrane"
        return {"is": role, "segments": kind.segments, "half_thickness": kind.half_thickness_mm}
    if kind.shape.kind == "compound" and kind.parts:
        return {"is": role, "geometry": "compound", "parts": list(kind.parts)}
    geometry = geometry_of(kind.shape)
    return {"is": role, **(geometry if geometry["geometry"] not in ("arena", "global") else {"geometry": "disk"})}


def cells_of(configuration: Mapping[str, Any]) -> tuple[int, int]:
    """Return columns and rows of the map of light."""
    columns, rows = (number(configuration.get(f"light_map_nb_bin_{axis}"), LIGHT_CELLS) for axis in "xy")
    return max(int(columns), 1), max(int(rows), 1)


def packed(colours: Floats) -> Numbers:
    """Colours of shape (n, 3), 0 to 1, as 0xRRGGBB."""
    return np.asarray(np.round(255.0 * colours).astype(np.uint32) @ np.array([65536, 256, 1], np.uint32))


class Moments:
    """What a picture of a run shows at any time, and its painter."""

    def __init__(self, recording: Recording, options: Mapping[str, Any], tail_s: float | None = None) -> None:
        """Prepare.

        Args:
            recording: The run. Pictures show what its configuration says, as the window does.
            options: Keys of its section `view` that prevail over these.
            tail_s: Length of the trails, if there are any, s. None: as in the window.

        Raises:
            PictureError: It cannot be drawn.
        """
        swarm = recording.last
        swarm.check_steps()
        self.swarm, self.box = swarm, box_of(swarm)
        self.lamps = [lamp for lamp in swarm.lamps if lamp.has_place]
        self.shows_leds = swarm.colouring is None and "led_rgb" in swarm.rows
        self.line = timeline_of(recording, swarm.rows, [OBJECT])
        self.rgb = self.colours_of(self.line.rows)

        # Objects in the order in which runs create them, then walls.
        own = self.line.objects
        ids = np.nan_to_num(own["robot_id"].to_numpy(dtype=float))
        kinds = own[KIND].to_numpy(dtype=np.int64)
        counts_up = np.array([kind.talks for kind in swarm.kinds])[kinds]
        order = np.lexsort((np.where(counts_up, ids, -ids), kinds))
        self.line.known, self.line.objects = self.line.known[:, order], own.iloc[order]
        self.kinds = kinds[order]
        walls = [i for i, kind in enumerate(swarm.kinds) if kind.is_wall and not swarm.is_periodic]
        self.walls = [self.wall_of(recording.walls, number) for number in walls]

        # Parts of membranes.
        self.dots = timeline_of(recording, swarm.dots, [OBJECT, "subpart_id"]) if len(swarm.dots) else None
        part_counts, self.part_order = self.parts_of(self.dots)
        with_parts = set(self.kinds[part_counts[: len(self.kinds)] > 0].tolist())

        view = view_of(recording.configuration)
        check_follow(swarm, options)
        self.heat, self.heat_span = self.heat_of(value_of_heat_map(swarm, view, options))

        cells = cells_of(recording.configuration)
        self.light_places = self.centres(cells)
        self.light_key: object = None
        self.painter = Painter(
            Stage(
                {
                    "view": {"view": view},
                    "options": dict(options),
                    "periodic": swarm.is_periodic,
                    "leds": self.shows_leds,
                    "light_map": {"columns": cells[0], "rows": cells[1]},
                    "kinds": [kind_of(kind, i in with_parts) for i, kind in enumerate(swarm.kinds)],
                    "lamps": [geometry_of(lamp.shape) for lamp in self.lamps],
                },
                swarm.polygons,
                np.concatenate([self.kinds, walls]).astype(np.uint32),
                np.concatenate([ids[order], np.zeros(len(walls))]).astype(np.uint32),
                part_counts,
            )
        )
        self.trail: Trail | None = None
        if self.painter.shows("trails"):
            self.trail = TrailOfSeconds(self.line, self.rgb, tail_s) if tail_s else TrailOfPlaces(self.line, self.rgb)
        talks = np.array([kind.talks for kind in swarm.kinds])[self.kinds]
        self.talkers = np.flatnonzero(talks) if self.painter.shows("links") else None

    def colours_of(self, rows: pd.DataFrame) -> Numbers:
        """Colours of rows, 0xRRGGBB: of LEDs, or on the screen."""
        if self.shows_leds:
            return rows["led_rgb"].to_numpy().astype(np.uint32)
        return packed(rows[RGB].to_numpy(dtype=float))

    def heat_of(self, name: str | None) -> tuple[npt.NDArray[np.float32] | None, tuple[float, float]]:
        """Return the values of rows for the heat map of a value, shape (rows,), and their least and greatest.

        NaN where there is none. None in place of the values if there is no such heat map.
        """
        if name is None:
            return None, (np.nan, np.nan)
        rows = self.line.rows
        if name == SPEED:
            rows = with_speed(rows, self.swarm.period_mm, self.swarm.top_speed_mm_s)
        values = numbers_of(rows[name])
        known = values[np.isfinite(values)]
        span = (float(known.min()), float(known.max())) if len(known) else (np.nan, np.nan)
        return values.astype(np.float32), span

    def wall_of(self, walls: pd.DataFrame, number: int) -> tuple[Floats, Numbers]:
        """Times and colours of a wall, the one before its first row included."""
        rows = walls[walls[KIND] == number]
        dark = np.zeros(1, np.uint32) if self.shows_leds else packed(np.array([DARK_WALL]))
        return rows["time"].to_numpy(dtype=float), np.concatenate([dark, self.colours_of(rows)])

    def parts_of(self, dots: Timeline | None) -> tuple[Numbers, npt.NDArray[np.int64]]:
        """How many parts each object has, in the order of the stage, and where these are in a timeline of dots."""
        count = len(self.kinds) + len(self.walls)
        if dots is None:
            return np.zeros(count, np.uint32), np.zeros(0, np.int64)
        place = {int(number): i for i, number in enumerate(self.line.objects[OBJECT])}
        owners = [place.get(int(number), -1) for number in dots.objects[OBJECT]]
        own = np.array(owners, dtype=np.int64)
        counts = np.bincount(own[own >= 0], minlength=count).astype(np.uint32)
        counts[counts < 2] = 0
        order = np.lexsort((dots.objects["subpart_id"].to_numpy(), own))
        return counts, order[(own[order] >= 0) & (counts[own[order]] > 0)]

    def centres(self, cells: tuple[int, int]) -> Floats:
        """Centres of the cells of the map of light, shape (rows * columns, 2)."""
        low, high = bounds(self.swarm.polygons[:1])
        x, y = np.meshgrid(*((low[i] + (high - low)[i] * (np.arange(cells[i]) + 0.5) / cells[i]) for i in (0, 1)))
        return np.column_stack([x.ravel(), y.ravel()])

    def at(self, time_s: float, clock_s: float | None = None) -> Moment:
        """Return the run at a time, s; before its first and after its last record, it stands still.

        Args:
            time_s: The time.
            clock_s: The time that the picture says. None: the same.
        """
        line = self.line
        rows, place, heading = line.poses_at(time_s)
        there = line.known[line.index_at(time_s)] >= 0
        poses = np.full((len(there), 3), np.nan, np.float32)
        poses[there, :2], poses[there, 2] = place, heading
        rgb = np.zeros(len(there), np.uint32)
        rgb[there] = self.rgb[rows]
        velocities = heat = None
        if self.painter.shows("velocities"):
            velocities = np.full((self.painter.objects, 2), np.nan, np.float32)
            velocities[: len(there)][there] = line.velocities_at(time_s)
        if self.heat is not None:
            heat = np.full(self.painter.objects, np.nan, np.float32)
            heat[: len(there)][there] = self.heat[rows]
        walls = [colours[np.searchsorted(times, time_s, side="right")] for times, colours in self.walls]
        poses = np.concatenate([poses, np.full((len(walls), 3), np.nan, np.float32)])
        return Moment(
            time_s=time_s if clock_s is None else clock_s,
            poses=poses,
            rgb=np.concatenate([rgb, np.array(walls, np.uint32)]),
            parts=self.parts_at(time_s),
            lamps=self.lamps_at(time_s),
            light=self.light_at(time_s),
            trails=None if self.trail is None else self.trails_at(time_s),
            heard=self.heard(poses),
            links=self.links_at(time_s),
            velocities=velocities,
            heat=heat,
            heat_span=self.heat_span,
        )

    def trails_at(self, time_s: float) -> Trails | None:
        """Trails up to a time; walls have none."""
        if self.trail is None:
            return None
        trails = self.trail.until(time_s)
        return replace(trails, counts=np.concatenate([trails.counts, np.zeros(len(self.walls), np.uint32)]))

    def parts_at(self, time_s: float) -> npt.NDArray[np.float32]:
        """Places of the parts of membranes, shape (parts, 2)."""
        if self.dots is None:
            return np.zeros((0, 2), np.float32)
        _, place, _ = self.dots.poses_at(time_s)
        there = self.dots.known[self.dots.index_at(time_s)] >= 0
        places = np.full((len(there), 2), np.nan, np.float32)
        places[there] = place
        return places[self.part_order]

    def lamps_at(self, time_s: float) -> npt.NDArray[np.float32]:
        """Places of the lamps, shape (lamps, 2); in a periodic arena inside its box."""
        places = np.array([lamp.centre_at(time_s) for lamp in self.lamps]).reshape(-1, 2)
        if self.box is not None:
            places = self.box[0] + (places - self.box[0]) % (self.box[1] - self.box[0])
        return places.astype(np.float32)

    def light_at(self, time_s: float) -> npt.NDArray[np.int16] | None:
        """Levels of light, shape (rows, columns); None if they are as before, or not shown."""
        lamps = self.swarm.lamps
        if not lamps or not self.painter.shows("light_levels"):
            return None
        key = tuple((tuple(lamp.centre_at(time_s)), lamp.photo_phase(time_s)) for lamp in lamps)
        if key == self.light_key:
            return None
        self.light_key = key
        levels = light_levels(lamps, self.swarm.polygons, self.light_places, time_s, self.swarm.period_mm)
        return np.round(np.clip(levels, 0, BRIGHTEST)).astype(np.int16).reshape(self.painter.cells)

    def heard(self, poses: npt.NDArray[np.float32]) -> npt.NDArray[Any] | None:
        """Pairs of robots near enough to hear each other, of HEARD."""
        if self.talkers is None:
            return None
        own = self.talkers[np.isfinite(poses[self.talkers, 0])]
        place = poses[own, :2].astype(float)
        kinds = [self.swarm.kinds[number] for number in self.kinds[own]]
        reach = np.array([kind.communication_radius_mm for kind in kinds])
        radius = np.array([kind.shape.bounding_radius_mm for kind in kinds])
        first, second = proximity_pairs(place, reach, radius, self.box).T
        gap = np.hypot(*minimum_image(place[second] - place[first], self.swarm.period_mm).T)
        gap = gap - radius[first] - radius[second]
        is_sent, is_answered = gap <= reach[first], gap <= reach[second]
        pairs = np.zeros(len(first), HEARD)
        pairs["sender"] = own[np.where(is_sent, first, second)]
        pairs["listener"] = own[np.where(is_sent, second, first)]
        pairs["is_mutual"] = is_sent & is_answered
        return pairs

    def links_at(self, time_s: float) -> npt.NDArray[Any] | None:
        """Links between bodies, of LINK."""
        if self.swarm.links is None:
            return None
        rows, place, heading = self.line.poses_at(time_s)
        objects = self.line.rows[OBJECT].to_numpy(dtype=np.int64)[rows]
        order = np.argsort(objects)
        found = placed_links(self.swarm.links, objects[order], place[order], heading[order], time_s, self.box)
        start = found.start
        if self.box is not None:
            start = self.box[0] + (start - self.box[0]) % (self.box[1] - self.box[0])
        links = np.zeros(len(start), LINK)
        links["kind"] = [LINK_KINDS.index(str(kind)) for kind in found.kind]
        links["is_pinned"] = found.is_pinned
        links["from_mm"], links["to_mm"] = start, start + found.end - found.start
        links["load"] = found.load
        return links
