"""Voronoi cells of robots in their arena: the part of the floor that is nearer to a robot than to any other.

Aurenhammer, "Voronoi diagrams - a survey of a fundamental geometric data structure", ACM Comput. Surv. 23, 345 (1991).
Distances are those as the crow flies, also past walls and holes; in periodic arenas, of the shortest image.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.snapshots import Integers

if TYPE_CHECKING:
    import shapely

Cells = npt.NDArray[Any]  # of shapely polygons

# Robots that are nearer to each other than this are at one place, for which the diagram has one cell.
SAME_PLACE_MM = 1e-4

# Far points make the cells of all robots finite. They are this many diameters of the scene away.
FAR = 8.0

# Corners of a cell that are nearer to each other, in diameters of the scene, are one.
SAME_CORNER = 1e-11

# Diagrams of so many times in a row, and as many rows, are one; each is so many diameters from the next.
TILES = 4
APART = 3.0


def voronoi_cells(position_mm: Floats, arena: Arena, floor: shapely.Geometry | None = None) -> Cells:
    """Return the Voronoi cells of robots, clipped to the floor of their arena.

    Args:
        position_mm: Shape (n, 2), finite. Robots outside of the arena (by rounding, or in a hole) have cells, too.
        arena: With polygons.
        floor: `arena.shape()`, prepared, if there are many snapshots.

    Returns:
        Shape (n,): shapely geometries in mm, mostly convex polygons; walls can divide a cell into several. Together,
        they cover the floor once. Several robots at one place have the same cell. In periodic arenas, cells are around
        their robots, and go on across the borders.
    """
    if len(position_mm) == 0:
        return np.empty(0, dtype=object)
    places, place = one_each(position_mm, arena)
    return np.asarray(cells_of_places(places, np.zeros(len(places), dtype=np.int64), arena, floor)[place])


def cells_of_places(place_mm: Floats, time: Integers, arena: Arena, floor: shapely.Geometry | None = None) -> Cells:
    """Return the Voronoi cells of places at several times, clipped to the floor of their arena.

    Args:
        place_mm: Shape (n, 2), n > 0, finite, of each time different from each other; see `places_at_times`.
        time: Number of the time of each, increasing, shape (n,).
        arena: See `voronoi_cells`.
        floor: See `voronoi_cells`.

    Returns:
        Shape (n,).
    """
    import shapely

    if arena.is_periodic:
        return periodic_cells(place_mm, time, arena.size_mm)
    floor = arena.shape() if floor is None else floor
    shapely.prepare(floor)
    low, high = arena.bounds_mm
    low, high = np.minimum(place_mm.min(axis=0), low), np.maximum(place_mm.max(axis=0), high)
    cells = cells_around(place_mm, time, np.ones(len(place_mm), dtype=bool), low, high)
    cut = ~shapely.covers(floor, cells)
    cells[cut] = shapely.intersection(cells[cut], floor)
    return cells


def voronoi_areas(cells: Cells, position_mm: Floats, arena: Arena) -> Floats:
    """Return the areas of Voronoi cells; robots at one place share theirs. Sum: the area of the arena.

    Args:
        cells: Cells of `voronoi_cells`, shape (n,).
        position_mm: The same positions, shape (n, 2).
        arena: The same arena.

    Returns:
        Shape (n,), mm^2.
    """
    import shapely

    place = one_each(position_mm, arena)[1]
    return np.asarray(shapely.area(cells) / np.bincount(place)[place])


def one_each(position_mm: Floats, arena: Arena) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Return the places at which there are robots, each once, and the number of the place of each robot.

    Args:
        position_mm: Shape (n, 2), n > 0.
        arena: If it is periodic, places are in its box.

    Returns:
        Shapes (m, 2), in mm, and (n,).
    """
    places, place, _ = places_at_times(position_mm, np.zeros(len(position_mm), dtype=np.int64), arena)
    return places, place


def places_at_times(position_mm: Floats, time: Integers, arena: Arena) -> tuple[Floats, Integers, Integers]:
    """Do what `one_each` does for robots at several times.

    Args:
        position_mm: Shape (n, 2).
        time: Number of the time of each, increasing, shape (n,).
        arena: See `one_each`.

    Returns:
        The places, shape (m, 2), those of each time after those of the time before; the number of the place of each
        robot, shape (n,); and the time of each place, shape (m,).
    """
    grid = np.round(arena.wrap(position_mm) / SAME_PLACE_MM)
    if arena.is_periodic:  # just below the upper border is at the lower one
        low, size = np.round(arena.bounds_mm[0] / SAME_PLACE_MM), np.round(arena.size_mm / SAME_PLACE_MM)
        grid = low + np.mod(grid - low, size)
    order = np.lexsort((grid[:, 1], grid[:, 0], time))
    ordered = np.column_stack([time, grid])[order]
    is_new = np.concatenate([np.ones(min(len(order), 1), dtype=bool), (np.diff(ordered, axis=0) != 0).any(axis=1)])
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.cumsum(is_new) - 1
    return ordered[is_new, 1:] * SAME_PLACE_MM, place, time[order[is_new]]


def periodic_cells(points: Floats, time: Integers, size_mm: Floats) -> Cells:
    """Return the cells of points in a periodic box, among their images. Shapes (n, 2) and (n,) to (n,)."""
    import shapely

    cells = np.empty(len(points), dtype=object)
    # A cell is complete if no point that is left out could be in the largest empty circle around one of its corners.
    count = np.maximum(np.bincount(time), 1)
    margin = np.minimum(5.0 * np.sqrt(float(np.prod(size_mm)) / count), size_mm.max())
    pending = np.ones(len(count), dtype=bool)
    while (own := pending[time]).any():
        cells[own] = cells_among_images(points[own], time[own], size_mm, margin)
        corners, owner = shapely.get_coordinates(cells[own], return_index=True)
        radius = np.zeros(len(count))
        np.maximum.at(radius, time[own][owner], np.linalg.norm(corners - points[own][owner], axis=1))
        pending &= (2.0 * radius > margin) & (margin < size_mm.max())
        margin = np.minimum(2.0 * margin, size_mm.max())
    return cells


def cells_among_images(points: Floats, time: Integers, size_mm: Floats, margin_mm: Floats) -> Cells:
    """Return the cells of points among those images that are at most the margin of their time away from all points."""
    shifts = np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]) * size_mm
    images, image_time = (points[None] + shifts[:, None]).reshape(-1, 2), np.tile(time, len(shifts))
    margin = margin_mm[image_time][:, None]
    low, high = points.min(axis=0), points.max(axis=0)
    near = ((images >= low - margin) & (images <= high + margin)).all(axis=1)
    every, every_time = np.concatenate([points, images[near]]), np.concatenate([time, image_time[near]])
    order = np.argsort(every_time, kind="stable")
    most = float(margin_mm[time].max())
    own = np.arange(len(every)) < len(points)
    return cells_around(every[order], every_time[order], own[order], low - most, high + most)


def cells_around(points: Floats, time: Integers, own: npt.NDArray[np.bool_], low: Floats, high: Floats) -> Cells:
    """Return the cells of points as polygons, finite ones that are right within a box.

    Several times are side by side in one diagram, so far apart that points of one are not the nearest ones to any place
    in the box of another.

    Args:
        points: Shape (n, 2), of each time different from each other, in the box.
        time: Number of the time of each, increasing, shape (n,).
        own: Which of them have a cell that is wanted, m of them, shape (n,).
        low: Least x and y of the box.
        high: Greatest x and y of the box.

    Returns:
        Shape (m,).
    """
    import shapely

    centre, reach = (low + high) / 2.0, max(float(np.hypot(*(high - low))), 1.0)
    number = np.cumsum(np.concatenate([[0], np.diff(time) > 0]))  # of times that have points
    block = number // (TILES**2)
    border = np.searchsorted(block, np.arange(block[-1] + 2))
    owner = np.cumsum(own) - 1
    corners, cells = [], []
    for begin, end in itertools.pairwise(border):
        line, column = np.divmod(number[begin:end] - number[begin], TILES)
        tile = APART * reach * np.column_stack([column, line])
        corner, cell = corners_of_cells(points[begin:end] - centre, tile, own[begin:end], reach)
        corners.append(corner + centre)
        cells.append(owner[begin:end][cell])
    rings = shapely.linearrings(np.concatenate(corners), indices=np.concatenate(cells))
    return np.asarray(shapely.polygons(rings))


def corners_of_cells(points: Floats, tile: Floats, own: npt.NDArray[np.bool_], reach: float) -> tuple[Floats, Integers]:
    """Return the corners of the cells of some points, going around each of them, and the number of the point of each.

    Args:
        points: Shape (n, 2).
        tile: By how much each is shifted in the diagram, shape (n, 2).
        own: Which points, shape (n,).
        reach: Greatest distance of points and of places of interest with the same shift.

    Returns:
        Shapes (c, 2) and (c,), by points; without their shifts.
    """
    from scipy import spatial

    middle = (tile.min(axis=0) + tile.max(axis=0)) / 2.0
    angle = np.pi / 4.0 * np.arange(8) + 0.1
    far = (FAR * reach + float(np.hypot(*middle))) * np.column_stack([np.cos(angle), np.sin(angle)])
    shifted = np.concatenate([points + tile - middle, far])
    # Corners of cells are the centres of the circles through the corners of Delaunay triangles.
    triangles = spatial.Delaunay(shifted).simplices
    a, b, c = np.moveaxis(shifted[triangles], 1, 0)
    centre = a + circumcentres(b - a, c - a)
    cell, corner = triangles.reshape(-1), np.repeat(np.arange(len(triangles)), 3)
    wanted = np.concatenate([own, np.zeros(len(far), dtype=bool)])[cell] & np.isfinite(centre).all(axis=1)[corner]
    cell = cell[wanted]
    offset = centre[corner[wanted]] - shifted[cell]
    # Cells are convex, with their point inside.
    order = np.lexsort((np.arctan2(offset[:, 1], offset[:, 0]), cell))
    cell, offset = cell[order], offset[order]
    # Where four points or more are on one circle, a corner is there several times.
    first = np.searchsorted(cell, cell)
    before = (
        np.where(first == np.arange(len(cell)), np.searchsorted(cell, cell, side="right"), np.arange(len(cell))) - 1
    )
    is_new = np.abs(offset - offset[before]).max(axis=1) > SAME_CORNER * reach
    cell, offset = cell[is_new], offset[is_new]
    return points[cell] + offset, cell


def circumcentres(b: Floats, c: Floats) -> Floats:
    """Return the centres of the circles through the origin, b and c, shape (n, 2) each; not finite if on a line."""
    square_b, square_c = (b**2).sum(axis=1), (c**2).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        double = 2.0 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
        x = (c[:, 1] * square_b - b[:, 1] * square_c) / double
        y = (b[:, 0] * square_c - c[:, 0] * square_b) / double
    return np.column_stack([x, y])
