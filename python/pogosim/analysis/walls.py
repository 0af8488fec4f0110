"""Where robots are with respect to the walls of their arena: on the floor or not, and how far from a wall.

    from pogosim.analysis.walls import distance_to_walls

    for run in trajectories_of(rows):
        near = distance_to_walls(run.arena, run.position_mm) < 2 * run.radius_mm  # (times, robots)

Holes have walls, too. A periodic arena has none, and neither has one whose outlines the file does not have.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats


def has_walls(arena: Arena) -> bool:
    """Tell whether robots can meet a wall there."""
    return bool(arena.polygons) and not arena.is_periodic


def is_on_floor(arena: Arena, position_mm: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Tell which points are on the floor: within the outer wall, not in a hole; on a wall counts as on the floor.

    Args:
        arena: Without walls, all points are on the floor.
        position_mm: Shape (..., 2).

    Returns:
        Shape (...). False where a coordinate is not finite.
    """
    points = np.asarray(position_mm, dtype=float)
    known = np.isfinite(points).all(axis=-1)
    if not has_walls(arena):
        return np.asarray(known)
    import shapely

    floor = arena.shape()
    shapely.prepare(floor)
    inside = np.zeros(known.shape, dtype=bool)
    inside[known] = shapely.intersects_xy(floor, points[known])
    return inside


def distance_to_walls(arena: Arena, position_mm: npt.ArrayLike) -> Floats:
    """Return the distance of points to the nearest wall, the outer one or that of a hole.

    Distances are positive on both sides of a wall (`is_on_floor` tells which), and from the point itself: a robot
    touches the wall at a distance of its radius.

    Args:
        arena: Without walls, distances are infinite.
        position_mm: Shape (..., 2).

    Returns:
        Shape (...), mm, at least 0. NaN where a coordinate is not finite.
    """
    points = np.asarray(position_mm, dtype=float)
    known = np.isfinite(points).all(axis=-1)
    distance = np.where(known, np.inf, np.nan)
    if not has_walls(arena):
        return distance
    import shapely

    walls = arena.shape().boundary
    shapely.prepare(walls)
    distance[known] = shapely.distance(walls, shapely.points(points[known]))
    return distance
