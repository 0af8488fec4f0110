"""Draw a whole run in one picture: trajectories, and the robots at the end with their LEDs.

    python -m pogosim.swarm_picture results/demo/data.feather results/demo/swarm.png

Trails take the colour that the robot's head LED had at the time, and fade into the past. Objects have the shapes, and
the floor the light, that the configuration in the file's metadata says; membranes lie where their dots do
(serialize_dot_pose: true).
"""

from __future__ import annotations

import argparse
import io
import json
import math
import sys
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from pogosim.outputs import OutputError, PathLike, leads_to, real_output
from pogosim.scene import (
    MEMBRANES,
    POGOBOT_RADIUS_MM,
    Category,
    Floats,
    Lamp,
    Shape,
    bounds,
    light_levels,
    ray_names,
    read_categories,
    read_lamps,
)
from pogosim.utils import load_dataframe

# Robots of the real swarm, where a file does not say.
UNKNOWN = Category("robots", "pogobot", Shape(radius_mm=POGOBOT_RADIUS_MM))

# Long files are drawn from that many snapshots at most: more cannot be told apart.
MAX_SNAPSHOTS = 1500

RGB = ["rgb_0", "rgb_1", "rgb_2"]  # columns of colours
LIGHT_CELLS = 240  # along either side of the arena


# The colours of the simulator's window, too.
PALETTE: dict[str, Any] = json.loads((Path(__file__).parent / "palette.json").read_text(encoding="utf-8"))
PAPER: str = PALETTE["paper"]
FLOOR: str = PALETTE["floor"]
WALL: str = PALETTE["wall"]
EDGE: str = PALETTE["edge"]
INK: str = PALETTE["ink"]
DARK_LED = to_rgb(PALETTE["dark_led"])  # of a robot whose LED is off
NO_LED = to_rgb(PALETTE["no_led"])  # of what has none
DARK_WALL = to_rgb(PALETTE["dark_wall"])  # of a wall with a program whose LED is off
LAMPLIGHT = to_rgb(PALETTE["lamplight"])
MAX_LAMPLIGHT: float = PALETTE["brightest_lamplight"]  # opacity over the floor where it is brightest
LEDS = (PALETTE["dimmest_led"], PALETTE["brightest_led"])  # values between which brightness differs
LEDS_ON_SCREEN = (PALETTE["dimmest_led_on_screen"], PALETTE["brightest_led_on_screen"])  # 0 to 255


# Columns of the file that the picture uses, by what they hold.
NUMBERS = ("time", "x", "y", "angle")
INTEGERS = ("led_rgb", "subpart_id")
USED = {*NUMBERS, *INTEGERS, "robot_category", "robot_id", "run"}

PICTURES = ("eps", "jpeg", "jpg", "pdf", "png", "ps", "svg", "svgz", "tif", "tiff", "webp")
MAX_PIXELS = 2e8


@dataclass
class Swarm:
    """One run, ready to be drawn. Lengths in mm, y downwards; times in s."""

    rows: pd.DataFrame  # finite poses of objects, ordered by time; columns object, rgb_0 to rgb_2 (0 to 1) added
    dots: pd.DataFrame  # the same of the parts of membranes, at the end; columns subpart_id, too
    wall_colours: dict[str, Floats]  # of pogowalls at the end, by category
    polygons: list[Floats]  # each of shape (vertices, 2), at least one; the outer wall first
    categories: dict[str, Category]
    lamps: list[Lamp]
    rays: list[str]  # categories of lighthouses
    end_s: float

    def category(self, name: str) -> Category:
        """Look up how the objects of a category look."""
        return self.categories.get(name, UNKNOWN)


class PictureError(Exception):
    """The file holds nothing that can be drawn, or the picture cannot be made; says why."""


def led_brightness(led: npt.ArrayLike) -> Floats:
    """Brightness on the screen, 0 to 1, of LED values 0 to 255; any shape.

    The LEDs of the robots are bright at low values already: 0 is dark, 1 to 25 go linearly from
    100/255 to 210/255, and more does not look brighter.
    """
    values = np.asarray(led, dtype=float)
    lit = np.interp(values, LEDS, LEDS_ON_SCREEN) / 255.0
    return np.where(values > 0, lit, 0.0)


def led_colours(led_rgb: npt.ArrayLike) -> Floats:
    """Colours on the screen of LED values 0xRRGGBB of shape (n,). Shape (n, 3), 0 to 1."""
    packed = np.asarray(led_rgb, dtype=np.int64)
    channels = np.stack([(packed >> shift) & 0xFF for shift in (16, 8, 0)], axis=-1)
    colours = led_brightness(channels)
    colours[packed == 0] = DARK_LED
    return colours


def category_colours(categories: pd.Series[Any]) -> Floats:
    """One colour per category, in order of their names. Shape (n, 3), 0 to 1."""
    names = sorted(categories.unique())
    palette = np.asarray(mpl.colormaps["Set2"].colors)  # type: ignore[attr-defined]
    return palette[[names.index(name) % len(palette) for name in categories]]


def arena_of(metadata: dict[str, Any]) -> list[Floats]:
    """Outlines of the arena from the metadata of a file; none where it does not say."""
    polygons: list[Floats] | str = metadata.get("arena_polygons", [])
    if isinstance(polygons, str):
        raise PictureError("its metadata 'arena_polygons' is not a list of polygons")
    if not all(np.isfinite(polygon).all() for polygon in polygons):
        raise PictureError("its metadata 'arena_polygons' has corners that are not finite numbers")
    if polygons and (np.ptp(polygons[0], axis=0) <= 0).any():
        raise PictureError("its metadata 'arena_polygons' has an outer wall without width or height")
    return polygons


def read_swarm(path: PathLike) -> Swarm:
    """Read the file of a run (of several runs: the first).

    Raises:
        PictureError: The file has no poses.
        OSError, ValueError: It cannot be read.
    """
    rows, metadata = load_dataframe(path)
    missing = {"time", "x", "y"} - set(rows.columns)
    if missing:
        raise PictureError(f"it has no column {', '.join(sorted(missing))} (see data_logger_fields)")
    rows = checked(rows)
    if tells_runs_apart(rows, metadata):
        rows = rows[rows["run"] == rows["run"].min()]
    categories = read_categories(metadata["configuration"])
    rows = coloured(completed(rows), categories)

    # In files of earlier versions, walls have no pose.
    is_wall = rows["robot_category"].isin([name for name, own in categories.items() if own.type == "pogowall"])
    has_pose = np.isfinite(rows["x"]) & np.isfinite(rows["y"]) & ~is_wall
    is_part = rows["subpart_id"] >= 0
    objects = rows[has_pose & ~is_part].reset_index(drop=True)
    if objects.empty:
        raise PictureError("it holds no object with a position")
    end_s = float(objects["time"].iloc[-1])
    walls = rows[is_wall].groupby("robot_category").tail(1)
    return Swarm(
        rows=objects,
        dots=rows[has_pose & is_part & (rows["time"] == end_s)],
        wall_colours={str(name): own[RGB].to_numpy()[0] for name, own in walls.groupby("robot_category")},
        polygons=arena_of(metadata) or [box_around(rows[has_pose], categories)],
        categories=categories,
        lamps=read_lamps(metadata["configuration"]),
        rays=ray_names(metadata["configuration"]),
        end_s=end_s,
    )


def checked(rows: pd.DataFrame) -> pd.DataFrame:
    """Leave out columns that have the name of one of the simulator's, but other values.

    Raises:
        PictureError: A column that the picture needs does not hold what it should, or stands there several times.
    """
    twice = sorted({str(name) for name in rows.columns[rows.columns.duplicated()]} & USED)
    if twice:
        raise PictureError(f"it has several columns {', '.join(twice)}")
    for name in NUMBERS:
        if name in rows and not pd.api.types.is_float_dtype(rows[name]) | pd.api.types.is_integer_dtype(rows[name]):
            raise PictureError(f"its column {name} does not hold numbers")
    for name in ("robot_category", "robot_id"):
        kinds = {"string", "categorical", "integer", "floating", "integer-na", "empty"}
        if name in rows and pd.api.types.infer_dtype(rows[name], skipna=True) not in kinds:
            raise PictureError(f"its column {name} does not hold {'names' if name == 'robot_category' else 'numbers'}")
    strange = [name for name in INTEGERS if name in rows and not pd.api.types.is_integer_dtype(rows[name])]
    rows = rows.drop(columns=strange)
    if "robot_category" in rows:
        rows = rows.assign(robot_category=rows["robot_category"].astype(object).fillna("unnamed").astype(str))
    return rows


def tells_runs_apart(rows: pd.DataFrame, metadata: dict[str, Any]) -> bool:
    """Tell whether there is a column run that numbers runs, as batches of runs write it, and is not the program's own.

    What a single run writes says its version, and has each object once at each time.
    """
    if "run" not in rows or not pd.api.types.is_integer_dtype(rows["run"]):
        return False
    names = [name for name in ("time", "robot_category", "robot_id", "subpart_id") if name in rows]
    return "program_version" not in metadata or bool(rows.duplicated(names).any())


def completed(rows: pd.DataFrame) -> pd.DataFrame:
    """Order rows by time, add columns that are not there, and number the objects."""
    rows = rows.sort_values("time", kind="stable").reset_index(drop=True)
    defaults: tuple[tuple[str, Any], ...]
    defaults = (("robot_category", "robots"), ("robot_id", 0), ("angle", np.nan), ("subpart_id", -1))
    rows = rows.assign(**{name: default for name, default in defaults if name not in rows})
    return rows.assign(object=rows.groupby(["robot_category", "robot_id"], sort=True).ngroup())


def coloured(rows: pd.DataFrame, categories: dict[str, Category]) -> pd.DataFrame:
    """Add the colours of LEDs, or of categories if the file does not have those."""
    if "led_rgb" in rows:
        colours = led_colours(rows["led_rgb"].to_numpy())
        passive = [name for name, own in categories.items() if own.type == "passive_object"]
        colours[rows["robot_category"].isin(passive).to_numpy()] = NO_LED
    else:
        colours = category_colours(rows["robot_category"])
    return rows.assign(**dict(zip(RGB, colours.T, strict=True)))


def box_around(rows: pd.DataFrame, categories: dict[str, Category]) -> Floats:
    """Return the box in which all objects ever were, as a polygon of shape (4, 2)."""
    names = rows["robot_category"].unique()
    margin = max(categories.get(str(name), UNKNOWN).shape.bounding_radius_mm for name in names)
    left, top = rows[["x", "y"]].to_numpy(dtype=float).min(axis=0) - margin
    right, bottom = rows[["x", "y"]].to_numpy(dtype=float).max(axis=0) + margin
    return np.array([[left, top], [right, top], [right, bottom], [left, bottom]])


def thinned(rows: pd.DataFrame, max_snapshots: int = MAX_SNAPSHOTS) -> pd.DataFrame:
    """Rows at no more than `max_snapshots` (at least 2) times, evenly chosen, the first and last among them."""
    times = np.sort(rows["time"].unique())
    if len(times) <= max_snapshots:
        return rows
    chosen = times[np.linspace(0, len(times) - 1, max_snapshots).round().astype(int)]
    return rows[rows["time"].isin(chosen)]


def trail_segments(rows: pd.DataFrame, extent_mm: Floats) -> tuple[Floats, pd.DataFrame]:
    """Steps of all objects: from each pose to the next one of the same object.

    Steps of more than half the arena are left out: there the object left through one side of a
    periodic arena and came in through the other.

    Args:
        rows: As in Swarm.
        extent_mm: Width and height of the arena.

    Returns:
        The steps, shape (n, 2, 2): from and to, x and y. And the n rows that they lead to.
    """
    ordered = rows.sort_values(["object", "time"], kind="stable")
    position = ordered[["x", "y"]].to_numpy(dtype=float)
    same_object = np.diff(ordered["object"].to_numpy()) == 0
    inside = (np.abs(np.diff(position, axis=0)) <= extent_mm / 2.0).all(axis=1)
    kept = same_object & inside
    segments = np.stack([position[:-1], position[1:]], axis=1)
    return segments[kept], ordered.iloc[1:][kept]


def turned(polygon: Floats, clockwise: bool) -> Floats:
    """Order the vertices clockwise (on the screen) or against it."""
    x, y = polygon.T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return polygon if (area > 0) == clockwise else polygon[::-1]


def draw_arena(axes: Axes, polygons: list[Floats]) -> PathPatch:
    """Draw the floor, with holes cut out, and the walls around it. Returns the floor."""
    loops = [turned(polygon, clockwise=i == 0) for i, polygon in enumerate(polygons)]
    outline = Outline.make_compound_path(*(Outline(np.vstack([p, p[:1]]), closed=True) for p in loops))
    floor = PathPatch(outline, facecolor=FLOOR, edgecolor=WALL, linewidth=2.2, joinstyle="round", zorder=1)
    axes.add_patch(floor)
    return floor


def draw_trails(axes: Axes, swarm: Swarm, extent_mm: Floats, tail_s: float) -> None:
    """Draw the last `tail_s` seconds of all trajectories, fading into the past."""
    start_s = swarm.end_s - tail_s
    rows = swarm.rows[~is_membrane(swarm)]  # the pose of those is their first dot's
    recent = rows[rows["time"] >= start_s]
    segments, ends = trail_segments(thinned(recent), extent_mm)
    # Oldest first, so that the present lies above the past.
    order = np.argsort(ends["time"].to_numpy(), kind="stable")
    freshness = np.clip((ends["time"].to_numpy(dtype=float) - start_s) / tail_s, 0.0, 1.0)
    colours = np.column_stack([ends[RGB].to_numpy(), 0.04 + 0.7 * freshness**3])
    axes.add_collection(
        LineCollection(
            list(segments[order]),
            colors=list(map(tuple, colours[order])),
            linewidths=list(0.5 + 0.9 * freshness[order]),
            capstyle="round",
            zorder=2,
        )
    )


def is_membrane(swarm: Swarm) -> pd.Series[bool]:
    """Tell which rows are those of membranes."""
    names = [name for name, own in swarm.categories.items() if own.type in MEMBRANES]
    return swarm.rows["robot_category"].isin(names)


def placed(outline: Floats, position: Floats, angle: Floats) -> Floats:
    """Put an outline at n poses. Shape (corners, 2), (n, 2) and (n,) to (n, corners, 2)."""
    turn = np.nan_to_num(angle)[:, None]
    x, y = outline.T
    turned_outline = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)], axis=-1)
    return np.asarray(turned_outline + position[:, None, :])


def draw_light(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Brighten the floor where lamps shine more than where they shine least. An even light shows nothing."""
    low, high = bounds(swarm.polygons)
    share = (np.arange(LIGHT_CELLS) + 0.5) / LIGHT_CELLS
    x, y = np.meshgrid(*(low[:, None] + (high - low)[:, None] * share))
    points = np.column_stack([x.ravel(), y.ravel()])
    levels = light_levels(swarm.lamps, swarm.polygons, points, swarm.end_s)
    inside = floor.get_path().contains_points(points)
    darkest = levels[inside].min() if inside.any() else levels.min()
    brightest = levels.max()
    if brightest <= darkest:
        return
    opacity = MAX_LAMPLIGHT * np.clip((levels - darkest) / brightest, 0.0, 1.0)
    image = np.concatenate([np.full((len(points), 3), LAMPLIGHT), opacity[:, None]], axis=1)
    light = axes.imshow(
        image.reshape(LIGHT_CELLS, LIGHT_CELLS, 4),
        extent=(low[0], high[0], high[1], low[1]),
        interpolation="bilinear",
        zorder=1.2,
    )
    light.set_clip_path(floor)


def draw_walls(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw walls that run programs as lines that glow in the colour of their LED."""
    for wall in swarm.categories.values():
        if wall.type != "pogowall":
            continue
        lines = swarm.polygons
        if wall.shape.kind != "arena":
            lines = [wall.shape.outline() + np.array(wall.position_mm or (0.0, 0.0))]
        colour = swarm.wall_colours.get(wall.name, np.array(DARK_LED))
        colour = np.array(DARK_WALL) if (colour == DARK_LED).all() else colour
        closed = [np.vstack([line, line[:1]]) for line in lines]
        for width, alpha in ((16.0, 0.10), (11.0, 0.16), (6.0, 0.28), (1.8, 1.0)):
            glow = LineCollection(closed, colors=[(*colour, alpha)], linewidths=width, joinstyle="round", zorder=1.5)
            axes.add_collection(glow)
            if alpha < 1.0:
                glow.set_clip_path(floor)


def draw_membranes(axes: Axes, swarm: Swarm) -> None:
    """Draw the lines and dots of membranes; those without dots in the file as a mark at their first."""
    for (name, _), dots in swarm.dots.sort_values("subpart_id").groupby(["robot_category", "robot_id"]):
        half_thickness = swarm.category(str(name)).half_thickness_mm
        centres = dots[["x", "y"]].to_numpy(dtype=float)
        colour = dots[RGB].to_numpy()[0]
        line = [np.vstack([centres, centres[:1]])]
        width = 2.0 * half_thickness * points_per_mm(axes)
        segments = swarm.category(str(name)).type == "rectmembrane"
        style = {"joinstyle": "round", "capstyle": "round"}
        axes.add_collection(
            LineCollection(
                line, colors=[(*colour, 0.45)], linewidths=width if segments else width / 3, zorder=4, **style
            )
        )
        dot = Shape(radius_mm=half_thickness * (0.35 if segments else 1.0)).outline()
        axes.add_collection(
            PolyCollection(
                list(placed(dot, centres, np.zeros(len(centres)))),
                facecolors=[tuple(colour)],
                edgecolors=EDGE,
                linewidths=0.5,
                zorder=4.1,
            )
        )
    marks = marked_membranes(swarm)
    axes.scatter(
        marks["x"], marks["y"], s=60.0, marker="D", facecolors="none", edgecolors=list(marks[RGB].to_numpy()), zorder=4
    )


def marked_membranes(swarm: Swarm) -> pd.DataFrame:
    """Last rows of the membranes whose dots the file does not have."""
    last = swarm.rows[is_membrane(swarm)].groupby("object").tail(1)
    return last[~last["object"].isin(swarm.dots["object"])]


def draw_bodies(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw every rigid object at its last pose: its shape, and a tick where it heads."""
    last = swarm.rows[~is_membrane(swarm)].groupby("object").tail(1)
    for name, rows in last.groupby("robot_category"):
        draw_category(axes, swarm.category(str(name)), rows, floor)


def draw_category(axes: Axes, category: Category, rows: pd.DataFrame, floor: PathPatch) -> None:
    """Draw the objects of one category."""
    shape = category.shape
    position = rows[["x", "y"]].to_numpy(dtype=float)
    angle = rows["angle"].to_numpy(dtype=float)
    colours = rows[RGB].to_numpy()

    def bodies(scale: float, **style: Any) -> PolyCollection:
        collection = PolyCollection(list(placed(scale * shape.outline(), position, angle)), **style)
        axes.add_collection(collection)
        return collection

    # A lit LED lights up the floor around.
    lit = (colours != DARK_LED).any(axis=1) & (category.type != "passive_object")
    for scale, alpha in ((1.75, 0.05), (1.5, 0.08), (1.25, 0.13)):
        glow = bodies(scale, facecolors=np.column_stack([colours, alpha * lit]), zorder=3)
        glow.set_clip_path(floor)

    # Bodies, with ticks that stand out from them.
    bodies(1.0, facecolors=colours, edgecolors=EDGE, linewidths=0.8, zorder=4)
    brightness = colours @ [0.299, 0.587, 0.114]
    heading = np.column_stack([np.cos(angle), np.sin(angle)])
    ticks = np.stack([position + heading * shape.reach_mm * f for f in (0.25, 0.95)], axis=1)
    known = np.isfinite(angle)
    axes.add_collection(
        LineCollection(
            list(ticks[known]),
            colors=list(np.where(brightness > 0.25, EDGE, PAPER)[known]),
            linewidths=1.6,
            capstyle="butt",
            zorder=5,
        )
    )


def points_per_mm(axes: Axes) -> float:
    """Scale of the picture, in points (1/72 inch) per mm of the arena."""
    pixels = axes.transData.transform([[0.0, 0.0], [1.0, 0.0]])
    figure = axes.get_figure(root=True)
    assert figure is not None
    return float(abs(pixels[1, 0] - pixels[0, 0]) * 72.0 / figure.dpi)


def round_length(width_mm: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is at most a quarter of the width."""
    power = 10.0 ** math.floor(math.log10(width_mm / 4.0))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= width_mm / 4.0)


def draw_scale_bar(axes: Axes, low: Floats, high: Floats) -> None:
    """Draw a bar of a round length under the lower left corner of the arena."""
    length = round_length(high[0] - low[0])
    pad = 0.03 * (high[1] - low[1])
    y = high[1] + pad
    axes.plot(
        [low[0], low[0] + length],
        [y, y],
        color=INK,
        linewidth=2.5,
        solid_capstyle="butt",
        clip_on=False,
    )
    axes.text(
        low[0] + length / 2,
        y + 0.35 * pad,
        f"{length:g} mm",
        color=INK,
        ha="center",
        va="top",
        fontsize=9,
    )


def notes(swarm: Swarm) -> str:
    """Return what the picture does not show, though it was there."""
    unseen = [f"beams of {name}" for name in swarm.rays]
    unseen += [
        f"the shape of {name} (serialize_dot_pose)" for name in marked_membranes(swarm)["robot_category"].unique()
    ]
    return f"not drawn: {', '.join(unseen)}" if unseen else ""


def draw_notes(axes: Axes, text: str, low: Floats, high: Floats) -> None:
    """Write the notes under the lower right corner of the arena."""
    y = high[1] + 0.03 * (high[1] - low[1])
    axes.text(high[0], y, text, color=INK, ha="right", va="top", fontsize=9)


def counted(category: str, count: int) -> str:
    """Return the name of a category as words behind a number: one robot, two active objects."""
    words = category.replace("_", "\u00a0").strip()
    is_plural = words.endswith("s") and not words.endswith("ss")
    return words[:-1] if count == 1 and is_plural else words


def title(swarm: Swarm, width_inches: float) -> str:
    """Return what the picture shows, in lines that fit into it: objects by category, and the time."""
    counts = swarm.rows.groupby("robot_category")["object"].nunique()
    parts = [f"{count}\u00a0{counted(str(category), int(count))}" for category, count in counts.items()]
    text = ", ".join(parts) + f" after {swarm.end_s:g} s"
    return textwrap.fill(text, width=max(int(8.5 * width_inches), 20), break_long_words=False)


def draw_scene(axes: Axes, swarm: Swarm, tail_s: float | None = None) -> None:
    """Draw a run into axes, which then show its arena in true proportions.

    Args:
        axes: Where to.
        swarm: The run.
        tail_s: Length of the trails in s, above 0. None: the whole run.
    """
    low, high = bounds(swarm.polygons)
    extent = high - low
    margin = 0.02 * extent.max()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(high[1] + margin, low[1] - margin)  # y runs downwards
    axes.apply_aspect()

    first_s = float(swarm.rows["time"].iloc[0])
    floor = draw_arena(axes, swarm.polygons)
    draw_light(axes, swarm, floor)
    draw_walls(axes, swarm, floor)
    draw_trails(axes, swarm, extent, tail_s or max(swarm.end_s - first_s, 1e-9))
    draw_membranes(axes, swarm)
    draw_bodies(axes, swarm, floor)


def draw(swarm: Swarm, tail_s: float | None = None) -> Figure:
    """Draw a run, with a heading and a scale bar. Arguments as in draw_scene()."""
    low, high = bounds(swarm.polygons)
    extent = high - low
    size = 8.0 * extent / extent.max()

    heading = title(swarm, size[0])
    beside_scale_bar = max(int(9.0 * size[0]), 20)  # characters
    below = textwrap.fill(notes(swarm), width=beside_scale_bar, break_long_words=False)
    height = size[1] + 0.9  # with one line of heading and one of notes
    more_above = 0.22 * heading.count("\n")
    more_below = 0.15 * below.count("\n")
    total = height + more_above + more_below
    figure = Figure(figsize=(size[0] + 0.3, total), facecolor=PAPER)
    axes = figure.add_axes((0.0, (0.07 * height + more_below) / total, 1.0, 0.86 * height / total))
    draw_scene(axes, swarm, tail_s)
    draw_scale_bar(axes, low, high)
    draw_notes(axes, below, low, high)
    axes.set_title(heading, color=INK, fontsize=13, pad=8)
    return figure


def positive(text: str) -> float:
    """Return a number above 0 from the command line."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return value


def picture_file(name: str, data: str) -> Path:
    """Return where the picture is to be written.

    Raises:
        OutputError: It is no name of a picture, no file, or that of the data.
    """
    suffix = Path(name).suffix[1:].lower()
    if name and leads_to(name, data):
        raise OutputError(f"the picture {name} would take the place of the data file {data}; name another picture")
    path = real_output(name)
    if suffix not in PICTURES:
        raise OutputError(f"{name} is no name of a picture; let it end in .{', .'.join(PICTURES)}")
    return path


def rendered(figure: Figure, picture: str, dpi: float) -> bytes:
    """Return the bytes of the picture, in the format of its name.

    Raises:
        PictureError: It would be too large or too small.
    """
    width, height = (float(inches) * dpi for inches in figure.get_size_inches())
    if width * height > MAX_PIXELS or min(width, height) < 1:
        raise PictureError(
            f"with --dpi {dpi:g} the picture has {width:.3g} x {height:.3g} pixels; at least 1, and at most "
            f"{MAX_PIXELS:.0e} together, are possible"
        )
    content = io.BytesIO()
    try:
        figure.savefig(content, format=Path(picture).suffix[1:].lower(), dpi=dpi)
    except (MemoryError, OverflowError, RuntimeError, SystemError, ValueError) as error:
        raise PictureError(f"matplotlib cannot make {picture} with --dpi {dpi:g}: {error}") from error
    return content.getvalue()


def make_picture(data: str, picture: str, dpi: float, tail_s: float | None) -> None:
    """Draw a data file into a picture. A picture that is there stays until the new one is drawn.

    Raises:
        PictureError, OutputError, OSError, ValueError: Says which file, and why.
    """
    path = picture_file(picture, data)
    try:
        swarm = read_swarm(data)
        figure = draw(swarm, tail_s)
    except PictureError as error:
        raise PictureError(f"cannot draw {data}: {error}") from error
    except (TypeError, KeyError, IndexError, OverflowError, MemoryError, np.linalg.LinAlgError) as error:
        raise PictureError(f"cannot draw {data}: its columns or metadata are not those of a run: {error}") from error
    except ValueError as error:
        named = str(data) in str(error)
        raise PictureError(str(error) if named else f"cannot draw {data}: {error}") from error
    path.write_bytes(rendered(figure, picture, dpi))


def main(arguments: Sequence[str] | None = None, prog: str = "swarm_picture") -> int:
    """Run the command line; returns the exit code: 0, or 2 if the picture could not be made."""
    parser = argparse.ArgumentParser(prog=prog, description=(__doc__ or "").splitlines()[0])
    parser.add_argument("data", metavar="DATA.feather", help="data file of a run")
    parser.add_argument("picture", metavar="OUT.png", help=f"picture to write ({', '.join(PICTURES)})")
    parser.add_argument("--dpi", type=positive, default=150.0, help="dots per inch (150)")
    parser.add_argument("--tail", type=positive, metavar="SECONDS", help="length of the trails (whole run)")
    options = parser.parse_args(arguments)
    try:
        make_picture(options.data, options.picture, options.dpi, options.tail)
    except (PictureError, OutputError) as error:
        print(f"{prog}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        is_data = str(error.filename) == options.data
        task = f"read '{options.data}'" if is_data else f"write '{options.picture}'"
        is_missing = is_data and isinstance(error, FileNotFoundError)
        reason = "no such file" if is_missing else (error.strerror or str(error)).lower()
        print(f"{prog}: cannot {task}: {reason}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
