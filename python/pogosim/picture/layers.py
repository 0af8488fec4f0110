"""The layers of a picture, from the floor to the robots; each is drawn into axes that show the arena in mm."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import PathPatch

from pogosim.deferred import pandas as pd
from pogosim.picture.body_links import placed_at
from pogosim.picture.images import Box, joined, lines_between, seen_places
from pogosim.picture.links import box_of, links_at_end
from pogosim.picture.palette import (
    DARK_LED,
    DARK_WALL,
    EDGE,
    FLOOR,
    LAMPLIGHT,
    LINK,
    MAX_LAMPLIGHT,
    PAPER,
    WALL,
    tension_colours,
)
from pogosim.picture.swarm import KIND, OBJECT, RGB, Swarm, rows_of_kinds
from pogosim.scene import Kind, bounds, floor_outline, light_levels
from pogosim.shapes import Floats, Shape

# Long files are drawn from that many snapshots at most: more cannot be told apart.
MAX_SNAPSHOTS = 1500

WALL_PT = 2.2
GLOWS = ((1.75, 0.05), (1.5, 0.08), (1.25, 0.13))  # shares of the radius of a robot, and opacities

LINK_PT = (("rod", 2.2), ("spring", 1.4))  # widths
HINGE_PT, PIN_PT, LINK_EDGE_PT = 5.2, 3.6, 0.5

LIGHT_CELLS = 240  # along either side of the arena


def thinned(rows: pd.DataFrame, max_snapshots: int = MAX_SNAPSHOTS) -> pd.DataFrame:
    """Rows at no more than `max_snapshots` (at least 2) times, evenly chosen, the first and last among them."""
    times = np.sort(rows["time"].unique())
    if len(times) <= max_snapshots:
        return rows
    chosen = times[np.linspace(0, len(times) - 1, max_snapshots).round().astype(int)]
    return rows[rows["time"].isin(chosen)]


def trail_segments(rows: pd.DataFrame, extent_mm: Floats, box: Box | None = None) -> tuple[Floats, pd.DataFrame]:
    """Steps of all objects: from each pose to the next one of the same object.

    Args:
        rows: As in Swarm.
        extent_mm: Width and height of the arena.
        box: The box of a periodic arena, in which a step across the border is one line from either end. None: steps of
            more than half the arena are left out.

    Returns:
        The steps, shape (n, 2, 2): from and to, x and y. And the n rows that they lead to.
    """
    ordered = rows.sort_values([OBJECT, "time"], kind="stable")
    position = ordered[["x", "y"]].to_numpy(dtype=float)
    kept = np.diff(ordered[OBJECT].to_numpy()) == 0
    if box is None:
        kept &= (np.abs(np.diff(position, axis=0)) <= extent_mm / 2.0).all(axis=1)
    segments, which = lines_between(position[:-1][kept], position[1:][kept], box)
    return segments, ordered.iloc[1:][kept].iloc[which]


def draw_arena(axes: Axes, polygons: list[Floats]) -> PathPatch:
    """Draw the floor, with holes cut out, and the walls around it. Returns the floor."""
    floor = PathPatch(
        floor_outline(polygons), facecolor=FLOOR, edgecolor=WALL, linewidth=WALL_PT, joinstyle="round", zorder=1
    )
    axes.add_patch(floor)
    return floor


def draw_border(axes: Axes, swarm: Swarm) -> PathPatch | None:
    """Draw the border of a periodic arena over the bodies that cross it. Returns the border; None where walls are."""
    if not swarm.is_periodic:
        return None
    outline = floor_outline(swarm.polygons)
    border = PathPatch(outline, fill=False, edgecolor=WALL, linewidth=WALL_PT, joinstyle="round", zorder=6)
    axes.add_patch(border)
    return border


def cut_off(artist: Artist, swarm: Swarm, floor: PathPatch) -> None:
    """In a periodic arena, cut off what lies beyond the border: it is drawn on the other side, too."""
    if swarm.is_periodic:
        artist.set_clip_path(floor)


def draw_trails(axes: Axes, swarm: Swarm, floor: PathPatch, tail_s: float, max_snapshots: int = MAX_SNAPSHOTS) -> None:
    """Draw the last `tail_s` seconds of all trajectories, fading into the past, from so many snapshots at most."""
    swarm.check_steps()
    start_s = swarm.end_s - tail_s
    rows = swarm.rows[~is_membrane(swarm)]  # the pose of those is their first dot's
    recent = rows[rows["time"] >= start_s]
    segments, ends = trail_segments(thinned(recent, max_snapshots), extent_of(swarm), box_of(swarm))
    # Oldest first, so that the present lies above the past.
    order = np.argsort(ends["time"].to_numpy(), kind="stable")
    freshness = np.clip((ends["time"].to_numpy(dtype=float) - start_s) / tail_s, 0.0, 1.0)
    colours = np.column_stack([ends[RGB].to_numpy(), 0.04 + 0.7 * freshness**3])
    trails = LineCollection(
        list(segments[order]),
        colors=list(map(tuple, colours[order])),
        linewidths=list(0.5 + 0.9 * freshness[order]),
        capstyle="round",
        zorder=2,
    )
    axes.add_collection(trails)
    cut_off(trails, swarm, floor)


def is_membrane(swarm: Swarm) -> npt.NDArray[np.bool_]:
    """Tell which rows are those of membranes, shape (rows,)."""
    return rows_of_kinds(swarm.rows, [kind.is_membrane for kind in swarm.kinds])


def placed(outline: Floats, position: Floats, angle: Floats) -> Floats:
    """Put an outline at n poses. Shape (corners, 2), (n, 2) and (n,) to (n, corners, 2)."""
    turn = np.nan_to_num(angle)[:, None]
    x, y = outline.T
    turned_outline = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)], axis=-1)
    return np.asarray(turned_outline + position[:, None, :])


def light_opacity(swarm: Swarm, time_s: float, cells: int = LIGHT_CELLS) -> Floats:
    """Opacity of the lamplight over the floor, where lamps shine more than where they shine least.

    Args:
        swarm: With its lamps and its arena.
        time_s: Since the start of the run.
        cells: Along either side of the arena.

    Returns:
        Shape (cells * cells,), row by row from the top left; 0 to 1 as shares of the greatest opacity. All 0 if
        the light is even.
    """
    polygons = swarm.polygons
    low, high = bounds(polygons)
    share = (np.arange(cells) + 0.5) / cells
    x, y = np.meshgrid(*(low[:, None] + (high - low)[:, None] * share))
    points = np.column_stack([x.ravel(), y.ravel()])
    levels = light_levels(swarm.lamps, polygons, points, time_s, swarm.period_mm)
    inside = floor_outline(polygons).contains_points(points)
    return opacity_of(levels, inside)


def opacity_of(levels: Floats, inside: npt.NDArray[np.bool_]) -> Floats:
    """Opacity of the lamplight of cells with these levels of light, of which some are inside. Shape (cells,)."""
    darkest = levels[inside].min() if inside.any() else levels.min()
    brightest = levels.max()
    if brightest <= darkest:
        return np.zeros(len(levels))
    return np.asarray(np.clip((levels - darkest) / brightest, 0.0, 1.0))


def draw_light(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Brighten the floor where lamps shine more than where they shine least. An even light shows nothing."""
    low, high = bounds(swarm.polygons)
    opacity = MAX_LAMPLIGHT * light_opacity(swarm, swarm.end_s)
    if not opacity.any():
        return
    image = np.concatenate([np.full((len(opacity), 3), LAMPLIGHT), opacity[:, None]], axis=1)
    light = axes.imshow(
        image.reshape(LIGHT_CELLS, LIGHT_CELLS, 4),
        extent=(low[0], high[0], high[1], low[1]),
        interpolation="bilinear",
        zorder=1.2,
    )
    light.set_clip_path(floor)


def wall_lines(wall: Kind, polygons: list[Floats]) -> list[Floats]:
    """Outlines of walls with a program, each of shape (corners, 2), mm."""
    if wall.shape.kind == "arena":
        return polygons
    return [wall.shape.outline() + np.array(wall.position_mm or (0.0, 0.0))]


def is_dark_wall(colour: Floats | None) -> bool:
    """Tell whether the LED of a wall, of a colour of shape (3,) or none, is off."""
    return colour is None or bool((colour == DARK_LED).all())


def wall_colour(colour: Floats | None) -> Floats:
    """Colour in which a wall shines whose LED has a colour, shape (3,), or none."""
    return np.array(DARK_WALL) if is_dark_wall(colour) else np.asarray(colour)


def draw_walls(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw walls that run programs as lines that glow in the colour of their LED."""
    for number, wall in enumerate(swarm.kinds):
        if not wall.is_wall:
            continue
        colour = wall_colour(swarm.wall_colours.get(number))
        closed = [np.vstack([line, line[:1]]) for line in wall_lines(wall, swarm.polygons)]
        for width, alpha in ((16.0, 0.10), (11.0, 0.16), (6.0, 0.28), (1.8, 1.0)):
            glow = LineCollection(closed, colors=[(*colour, alpha)], linewidths=width, joinstyle="round", zorder=1.5)
            axes.add_collection(glow)
            if alpha < 1.0:
                glow.set_clip_path(floor)


def draw_membranes(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw the lines and dots of membranes; those without dots in the file as a mark at their first."""
    for _, dots in swarm.dots.sort_values("subpart_id").groupby(OBJECT):
        kind = swarm.kinds[int(dots[KIND].iloc[0])]
        half_thickness = kind.half_thickness_mm
        ring = joined(dots[["x", "y"]].to_numpy(dtype=float), box_of(swarm))
        middle = (ring.min(axis=0) + ring.max(axis=0)) / 2.0
        reach = np.hypot(*(ring - middle).T).max() + half_thickness
        places = seen_places(middle[None], reach, box_of(swarm))[1]
        lines = list(ring + (places - middle)[:, None])
        colour = dots[RGB].to_numpy()[0]
        width = 2.0 * half_thickness * points_per_mm(axes)
        segments = kind.segments
        style = {"joinstyle": "round", "capstyle": "round"}
        outline = LineCollection(
            lines, colors=[(*colour, 0.45)], linewidths=width if segments else width / 3, zorder=4, **style
        )
        dot = Shape(radius_mm=half_thickness * (0.35 if segments else 1.0)).outline()
        centres = np.concatenate([line[:-1] for line in lines])
        disks = PolyCollection(
            list(placed(dot, centres, np.zeros(len(centres)))),
            facecolors=[tuple(colour)],
            edgecolors=EDGE,
            linewidths=0.5,
            zorder=4.1,
        )
        for collection in (outline, disks):
            axes.add_collection(collection)
            cut_off(collection, swarm, floor)
    marks = marked_membranes(swarm)
    axes.scatter(
        marks["x"], marks["y"], s=60.0, marker="D", facecolors="none", edgecolors=list(marks[RGB].to_numpy()), zorder=4
    )


def marked_membranes(swarm: Swarm) -> pd.DataFrame:
    """Last rows of the membranes whose dots the file does not have."""
    last = swarm.rows[is_membrane(swarm)].groupby(OBJECT).tail(1)
    return last[~last[OBJECT].isin(swarm.dots[OBJECT])]


def draw_bodies(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw every rigid object at its last pose: its shape, and a tick where it heads."""
    last = swarm.rows[~is_membrane(swarm)].groupby(OBJECT).tail(1)
    for _, rows in last.groupby(["robot_category", KIND]):
        draw_alike(axes, swarm, swarm.kinds[int(rows[KIND].iloc[0])], rows, floor)


def draw_alike(axes: Axes, swarm: Swarm, kind: Kind, rows: pd.DataFrame, floor: PathPatch) -> None:
    """Draw objects that look the same; lit LEDs, if colours are those, glow."""
    shape = kind.shape
    reach = GLOWS[0][0] * shape.bounding_radius_mm
    which, position = seen_places(rows[["x", "y"]].to_numpy(dtype=float), reach, box_of(swarm))
    angle = rows["angle"].to_numpy(dtype=float)[which]
    colours = rows[RGB].to_numpy()[which]

    def bodies(scale: float, **style: Any) -> PolyCollection:
        collection = PolyCollection(list(placed(scale * shape.outline(), position, angle)), **style)
        axes.add_collection(collection)
        return collection

    # A lit LED lights up the floor around.
    lit = (colours != DARK_LED).any(axis=1) & kind.runs_program
    for scale, alpha in GLOWS if swarm.colouring is None else ():
        glow = bodies(scale, facecolors=np.column_stack([colours, alpha * lit]), zorder=3)
        glow.set_clip_path(floor)

    # Bodies, with ticks that stand out from them.
    cut_off(bodies(1.0, facecolors=colours, edgecolors=EDGE, linewidths=0.8, zorder=4), swarm, floor)
    brightness = colours @ [0.299, 0.587, 0.114]
    heading = np.column_stack([np.cos(angle), np.sin(angle)])
    ticks = np.stack([position + heading * shape.reach_mm * f for f in (0.25, 0.95)], axis=1)
    known = np.isfinite(angle)
    marks = LineCollection(
        list(ticks[known]),
        colors=list(np.where(brightness > 0.25, EDGE, PAPER)[known]),
        linewidths=1.6,
        capstyle="butt",
        zorder=5,
    )
    axes.add_collection(marks)
    cut_off(marks, swarm, floor)


def points_per_mm(axes: Axes) -> float:
    """Scale of the picture, in points (1/72 inch) per mm of the arena."""
    pixels = axes.transData.transform([[0.0, 0.0], [1.0, 0.0]])
    figure = axes.get_figure(root=True)
    assert figure is not None
    return float(abs(pixels[1, 0] - pixels[0, 0]) * 72.0 / figure.dpi)


def show_arena(axes: Axes, swarm: Swarm) -> None:
    """Let axes show the arena in true proportions, and nothing else."""
    low, high = bounds(swarm.polygons)
    margin = 0.02 * extent_of(swarm).max()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(high[1] + margin, low[1] - margin)  # y runs downwards
    axes.apply_aspect()


def extent_of(swarm: Swarm) -> Floats:
    """Width and height of the arena, mm."""
    low, high = bounds(swarm.polygons)
    return high - low


def draw_links(axes: Axes, segments: Floats, floor: PathPatch) -> None:
    """Draw lines between robots, shape (k, 2, 2), mm; they end at the walls."""
    lines = LineCollection(list(segments), colors=LINK, alpha=0.5, linewidths=0.8, zorder=2.5)
    axes.add_collection(lines)
    lines.set_clip_path(floor)


def draw_body_links(axes: Axes, swarm: Swarm, floor: PathPatch) -> None:
    """Draw springs and rods between bodies as lines, hinges and ends in the arena as dots, coloured by tension.

    They are above bodies, and below the ticks that say where these head.
    """
    if swarm.links is None:
        return
    rows = swarm.rows.groupby(OBJECT).tail(1)
    placed_now = placed_at(swarm.links, rows, OBJECT, swarm.end_s, box_of(swarm))
    colours = tension_colours(placed_now.load)
    for kind, width in LINK_PT:
        of_kind = np.flatnonzero(placed_now.kind == kind)
        segments, which = lines_between(placed_now.start[of_kind], placed_now.end[of_kind], box_of(swarm))
        for own, extra in ((EDGE, 2.0 * LINK_EDGE_PT), (colours[of_kind[which]], 0.0)):
            lines = LineCollection(list(segments), colors=own, linewidths=width + extra, capstyle="round", zorder=4.6)
            axes.add_collection(lines)
            cut_off(lines, swarm, floor)
    reach = HINGE_PT / points_per_mm(axes)
    for chosen, points, size in (
        (placed_now.kind == "hinge", placed_now.start, HINGE_PT),
        (placed_now.is_pinned & (placed_now.kind != "hinge"), placed_now.end, PIN_PT),
    ):
        which, places = seen_places(points[chosen], reach, box_of(swarm))
        dots = axes.scatter(
            places[:, 0],
            places[:, 1],
            s=size**2,
            c=colours[chosen][which],
            edgecolors=EDGE,
            linewidths=LINK_EDGE_PT,
            zorder=4.7,
        )
        cut_off(dots, swarm, floor)


def draw_scene(axes: Axes, swarm: Swarm, tail_s: float | None = None, links: bool = False) -> None:
    """Draw a run into axes, which then show its arena in true proportions.

    Args:
        axes: Where to.
        swarm: The run.
        tail_s: Length of the trails in s, above 0. None: the whole run.
        links: Whether lines join robots near enough to hear each other.
    """
    show_arena(axes, swarm)
    first_s = float(swarm.rows["time"].iloc[0])
    floor = draw_arena(axes, swarm.polygons)
    draw_light(axes, swarm, floor)
    draw_walls(axes, swarm, floor)
    draw_trails(axes, swarm, floor, tail_s or max(swarm.end_s - first_s, 1e-9))
    if links:
        draw_links(axes, links_at_end(swarm), floor)
    draw_membranes(axes, swarm, floor)
    draw_bodies(axes, swarm, floor)
    draw_body_links(axes, swarm, floor)
    draw_border(axes, swarm)
