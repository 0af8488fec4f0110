"""Voronoi cells of robots in their arena: the part of the floor that is nearer to a robot than to any other.

Aurenhammer, "Voronoi diagrams - a survey of a fundamental geometric data structure", ACM Comput. Surv. 23, 345 (1991).
Distances are those as the crow flies, also past walls and holes; in periodic arenas, of the shortest image.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats

if TYPE_CHECKING:
    import shapely

Cells = npt.NDArray[Any]  # of shapely polygons

# Robots that are nearer to each other than this are at one place, for which the diagram has one cell.
SAME_PLACE_MM = 1e-4

# Far points make the cells of all robots finite. They are this many diameters of the scene away.
FAR = 8.0


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
    import shapely

    if len(position_mm) == 0:
        return np.empty(0, dtype=object)
    places, place = one_each(position_mm, arena)
    if arena.is_periodic:
        return np.asarray(periodic_cells(places, arena.size_mm)[place])
    floor = arena.shape() if floor is None else floor
    shapely.prepare(floor)
    low, high = arena.bounds_mm
    low, high = np.minimum(places.min(axis=0), low), np.maximum(places.max(axis=0), high)
    cells = cells_around(places, len(places), low, high)
    cut = ~shapely.covers(floor, cells)
    cells[cut] = shapely.intersection(cells[cut], floor)
    return np.asarray(cells[place])


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
    grid = np.round(arena.wrap(position_mm) / SAME_PLACE_MM)
    if arena.is_periodic:  # just below the upper border is at the lower one
        low, size = np.round(arena.bounds_mm[0] / SAME_PLACE_MM), np.round(arena.size_mm / SAME_PLACE_MM)
        grid = low + np.mod(grid - low, size)
    places, place = np.unique(grid, axis=0, return_inverse=True)
    return places * SAME_PLACE_MM, place.reshape(-1)


def periodic_cells(points: Floats, size_mm: Floats) -> Cells:
    """Return the cells of points in a periodic box, among their images. Shape (n, 2) to (n,)."""
    import shapely

    # A cell is complete if no point that is left out could be in the largest empty circle around one of its corners.
    margin = 5.0 * np.sqrt(float(np.prod(size_mm)) / len(points))
    while margin < size_mm.max():
        cells = cells_among_images(points, size_mm, margin)
        corners, owner = shapely.get_coordinates(cells, return_index=True)
        if 2.0 * np.linalg.norm(corners - points[owner], axis=1).max() <= margin:
            return cells
        margin *= 2.0
    return cells_among_images(points, size_mm, float(size_mm.max()))


def cells_among_images(points: Floats, size_mm: Floats, margin_mm: float) -> Cells:
    """Return the cells of points among those images that are at most a margin away from all points."""
    shifts = np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]) * size_mm
    images = (points[None] + shifts[:, None]).reshape(-1, 2)
    low, high = points.min(axis=0) - margin_mm, points.max(axis=0) + margin_mm
    images = images[((images >= low) & (images <= high)).all(axis=1)]
    return cells_around(np.concatenate([points, images]), len(points), low, high)


def cells_around(points: Floats, count: int, low: Floats, high: Floats) -> Cells:
    """Return the cells of the first points as polygons, finite ones that are right within a box.

    Args:
        points: Shape (n, 2), different from each other, in the box.
        count: How many cells.
        low: Least x and y of the box.
        high: Greatest x and y of the box.

    Returns:
        Shape (count,).
    """
    import shapely
    from scipy import spatial

    centre, reach = (low + high) / 2.0, max(float(np.hypot(*(high - low))), 1.0)
    angle = np.pi / 4.0 * np.arange(8) + 0.1
    far = FAR * reach * np.column_stack([np.cos(angle), np.sin(angle)])
    diagram = spatial.Voronoi(np.concatenate([points - centre, far]))
    # Each ridge, between two points, ends at two corners of both cells.
    ridges = np.asarray(diagram.ridge_vertices)
    cell = np.repeat(diagram.ridge_points.T.reshape(-1), 2)
    corner = np.tile(ridges.reshape(-1), 2)
    own = cell < count
    cell, corner = np.divmod(np.unique(cell[own] * len(diagram.vertices) + corner[own]), len(diagram.vertices))
    offset = diagram.vertices[corner] - diagram.points[cell]
    # Cells are convex, with their point inside.
    order = np.lexsort((np.arctan2(offset[:, 1], offset[:, 0]), cell))
    rings = shapely.linearrings(diagram.vertices[corner[order]] + centre, indices=cell[order])
    return np.asarray(shapely.polygons(rings))
