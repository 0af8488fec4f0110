"""Draw a whole run in one picture: trajectories, and the robots at the end with their LEDs.

    python -m pogosim.swarm_picture results/demo/data.feather results/demo/swarm.png

Trails take the colour that the robot's head LED had at the time, and fade into the past.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.collections import CircleCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from pogosim.utils import PathLike, load_dataframe

Floats = npt.NDArray[np.float64]

# Robots of the real swarm, where a file does not say (mm).
DEFAULT_RADIUS_MM = 26.5

# Long files are drawn from that many snapshots at most: more cannot be told apart.
MAX_SNAPSHOTS = 1500

PAPER = "#ffffff"
FLOOR = "#12151c"
WALL = "#3a4150"
EDGE = "#05070a"
INK = "#2b303a"
DARK_LED = 0.42  # grey of a robot whose LED is off


@dataclass
class Swarm:
    """One run, ready to be drawn. Lengths in mm, y downwards; times in s."""

    rows: pd.DataFrame  # finite poses, ordered by time; columns object, rgb_0 to rgb_2 (0 to 1) added
    polygons: list[Floats]  # each of shape (vertices, 2), at least one; the outer wall first
    radius_mm: dict[str, float]  # by category
    end_s: float


class PictureError(Exception):
    """The file holds nothing that can be drawn."""


def led_brightness(led: npt.ArrayLike) -> Floats:
    """Brightness on the screen, 0 to 1, of LED values 0 to 255; any shape.

    The LEDs of the robots are bright at low values already: 0 is dark, 1 to 25 go linearly from
    100/255 to 210/255, and more does not look brighter.
    """
    values = np.asarray(led, dtype=float)
    lit = np.interp(values, [1.0, 25.0], [100.0, 210.0]) / 255.0
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


def read_polygons(text: str) -> list[Floats]:
    """Outlines of the arena from the metadata of a file: YAML, a sequence of sequences of {x, y}."""
    try:
        polygons = yaml.safe_load(text) or []
        return [np.array([[p["x"], p["y"]] for p in polygon], dtype=float) for polygon in polygons]
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        raise PictureError(f"its metadata 'arena_polygons' is not a list of polygons: {error}") from error


def number(value: Any, default: float) -> float:
    """Return a configuration's value as a number; `default` if it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return default


def radii(configuration: dict[str, Any]) -> dict[str, float]:
    """Radius of each category of objects (mm): that of the disk, or of the disk around its shape."""
    objects = configuration.get("objects")
    result = {}
    for category, settings in (objects if isinstance(objects, dict) else {}).items():
        if not isinstance(settings, dict):
            continue
        shape = str(settings.get("geometry", "disk")).lower()
        if shape == "rectangle":
            sides = (number(settings.get(f"body_{side}"), 10.0) for side in ("width", "height"))
            radius = math.hypot(*sides) / 2.0
        elif shape == "triangle":
            radius = number(settings.get("side_length"), 10.0) / math.sqrt(3.0)
        else:
            radius = number(settings.get("radius"), DEFAULT_RADIUS_MM)
        result[str(category)] = radius
    return result


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
    if "run" in rows:
        rows = rows[rows["run"] == rows["run"].min()]
    if "subpart_id" in rows:
        rows = rows[rows["subpart_id"] < 0]
    rows = rows[np.isfinite(rows["x"]) & np.isfinite(rows["y"])]
    if rows.empty:
        raise PictureError("it holds no object with a position")

    rows = rows.sort_values("time", kind="stable").reset_index(drop=True)
    rows = rows.assign(
        **{
            name: default
            for name, default in (("robot_category", "robots"), ("robot_id", 0), ("angle", np.nan))
            if name not in rows
        }
    )
    rows["object"] = rows.groupby(["robot_category", "robot_id"], sort=True).ngroup()
    colours = led_colours(rows["led_rgb"].to_numpy()) if "led_rgb" in rows else category_colours(rows["robot_category"])
    rows[["rgb_0", "rgb_1", "rgb_2"]] = colours
    radius_mm = radii(metadata["configuration"])
    return Swarm(
        rows=rows,
        polygons=read_polygons(metadata.get("arena_polygons", "")) or [box_around(rows, radius_mm)],
        radius_mm=radius_mm,
        end_s=float(rows["time"].iloc[-1]),
    )


def box_around(rows: pd.DataFrame, radius_mm: dict[str, float]) -> Floats:
    """Return the box in which all objects ever were, as a polygon of shape (4, 2)."""
    margin = max(radius_mm.values(), default=DEFAULT_RADIUS_MM)
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


def bounds(polygons: list[Floats]) -> tuple[Floats, Floats]:
    """Corners (x, y) of the smallest box around the arena: least and greatest (mm)."""
    vertices = np.concatenate(polygons)
    return vertices.min(axis=0), vertices.max(axis=0)


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
    recent = swarm.rows[swarm.rows["time"] >= start_s]
    segments, ends = trail_segments(thinned(recent), extent_mm)
    # Oldest first, so that the present lies above the past.
    order = np.argsort(ends["time"].to_numpy(), kind="stable")
    freshness = np.clip((ends["time"].to_numpy(dtype=float) - start_s) / tail_s, 0.0, 1.0)
    colours = np.column_stack([ends[["rgb_0", "rgb_1", "rgb_2"]].to_numpy(), 0.04 + 0.7 * freshness**3])
    axes.add_collection(
        LineCollection(
            list(segments[order]),
            colors=list(map(tuple, colours[order])),
            linewidths=list(0.5 + 0.9 * freshness[order]),
            capstyle="round",
            zorder=2,
        )
    )


def draw_robots(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw every object at its last pose: a disk of its radius, and a tick where it heads."""
    last = swarm.rows.groupby("object").tail(1)
    position = last[["x", "y"]].to_numpy(dtype=float)
    angle = last["angle"].to_numpy(dtype=float)
    colours = last[["rgb_0", "rgb_1", "rgb_2"]].to_numpy()
    radius = np.array([swarm.radius_mm.get(str(c), DEFAULT_RADIUS_MM) for c in last["robot_category"]])

    def disks(scale: float, **style: Any) -> CircleCollection:
        collection = CircleCollection(
            list(math.pi * (radius * scale * points_per_mm(axes)) ** 2),
            offsets=position,
            offset_transform=axes.transData,
            **style,
        )
        axes.add_collection(collection)
        return collection

    # A lit LED lights up the floor around.
    lit = (colours != DARK_LED).any(axis=1)
    for scale, alpha in ((1.75, 0.05), (1.5, 0.08), (1.25, 0.13)):
        glow = disks(scale, facecolors=np.column_stack([colours, alpha * lit]), zorder=3)
        glow.set_clip_path(floor)

    # Bodies, with ticks that stand out from them.
    disks(1.0, facecolors=colours, edgecolors=EDGE, linewidths=0.8, zorder=4)
    brightness = colours @ [0.299, 0.587, 0.114]
    heading = np.column_stack([np.cos(angle), np.sin(angle)])
    ticks = np.stack([position + heading * radius[:, None] * f for f in (0.25, 0.95)], axis=1)
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


def title(swarm: Swarm) -> str:
    """Return what the picture shows: objects by category, and the time."""
    counts = swarm.rows.groupby("robot_category")["object"].nunique()
    return ", ".join(f"{count} {category}" for category, count in counts.items()) + f" after {swarm.end_s:g} s"


def draw(swarm: Swarm, tail_s: float | None = None) -> Figure:
    """Draw a run.

    Args:
        swarm: The run.
        tail_s: Length of the trails in s, above 0. None: the whole run.
    """
    low, high = bounds(swarm.polygons)
    extent = high - low
    first_s = float(swarm.rows["time"].iloc[0])
    margin = 0.02 * extent.max()
    size = 8.0 * extent / extent.max()

    figure = Figure(figsize=(size[0] + 0.3, size[1] + 0.9), facecolor=PAPER)
    axes = figure.add_axes((0.0, 0.07, 1.0, 0.86))
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(high[1] + margin, low[1] - margin)  # y runs downwards
    axes.apply_aspect()

    floor = draw_arena(axes, swarm.polygons)
    draw_trails(axes, swarm, extent, tail_s or max(swarm.end_s - first_s, 1e-9))
    draw_robots(axes, swarm, floor)
    draw_scale_bar(axes, low, high)
    axes.set_title(title(swarm), color=INK, fontsize=13, pad=8)
    return figure


def positive(text: str) -> float:
    """Return a number above 0 from the command line."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return value


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code: 0, or 2 if the picture could not be made."""
    parser = argparse.ArgumentParser(prog="swarm_picture", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("data", metavar="DATA.feather", help="data file of a run")
    parser.add_argument("picture", metavar="OUT.png", help="picture to write (png, pdf, svg)")
    parser.add_argument("--dpi", type=positive, default=150.0, help="dots per inch (150)")
    parser.add_argument("--tail", type=positive, metavar="SECONDS", help="length of the trails (whole run)")
    options = parser.parse_args(arguments)
    try:
        figure = draw(read_swarm(options.data), options.tail)
        figure.savefig(options.picture, dpi=options.dpi)
    except PictureError as error:
        print(f"swarm_picture: cannot draw {options.data}: {error}", file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(f"swarm_picture: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
