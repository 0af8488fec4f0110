"""How evenly robots share an arena (areas of Voronoi cells), and how much of it they reach (union of disks)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.snapshots import Snapshots, snapshots_of
from pogosim.analysis.trajectories import Run
from pogosim.analysis.voronoi import Cells, cells_of_places, places_at_times
from pogosim.errors import AnalysisError

if TYPE_CHECKING:
    import shapely


def coverage_over_time(run: Run, reach_mm: float | None = None) -> pd.DataFrame:
    """Return statistics of the Voronoi cells and the coverage ratio at each save time.

    The coefficient of variation of the areas is 0 for a lattice; for independent, uniform positions (Poisson) its
    square is 0.280. E. N. Gilbert, "Random subdivisions of space into crystals", Ann. Math. Statist. 33, 958 (1962).

    Args:
        run: Its arena must have polygons. Robots without a position at a time have no cell.
        reach_mm: Radius of the disks; None: reach of the run.

    Returns:
        A row per time: time (s); mean_area (mm^2), std_area (mm^2), var_area (mm^4) and cv_area of the cells, with n in
        the denominator of the variance; n_cells, one for each robot; coverage_ratio, 0 to 1. Areas are NaN, and the
        ratio is 0, while there are no robots.

    Raises:
        AnalysisError: The arena is not known.
    """
    need_arena(run)
    reach = run.reach(reach_mm)
    floor = run.arena.shape()
    tables = [statistics(own, run.arena, floor, reach) for own in snapshots_of(run)]
    table = pd.concat(tables, ignore_index=True)
    table["coverage_ratio"] = np.minimum(table["coverage_ratio"] / floor.area, 1.0)
    table.insert(0, "time", run.time_s)
    table.insert(4, "cv_area", table["std_area"] / table["mean_area"])
    return table


def need_arena(run: Run) -> None:
    """Raise AnalysisError unless the arena of a run is known, and has a floor."""
    if not run.arena.polygons:
        raise AnalysisError(
            "it has no arena_polygons, the walls of the arena: name the configuration of the run with -c, and the "
            "folder of its arena file with --arenas-dir"
        )
    if not run.arena.area_mm2 > 0.0:
        raise AnalysisError("the floor of its arena has no area")


def statistics(own: Snapshots, arena: Arena, floor: shapely.Geometry, reach_mm: float) -> pd.DataFrame:
    """Return mean, standard deviation and variance of the areas of cells, their number, and the area reached.

    A row for each time of a block.
    """
    import shapely

    robots, covered = own.counts, np.zeros(own.length)
    mean, variance = np.full((2, own.length), np.nan)
    if len(own.robot):
        places, place, time = places_at_times(own.position_mm, own.time, arena)
        cells = cells_of_places(places, time, arena, floor)
        area = (shapely.area(cells) / np.bincount(place))[place]
        with np.errstate(invalid="ignore"):
            mean = np.bincount(own.time, area, minlength=own.length) / robots
            square = (area - mean[own.time]) ** 2
            variance = np.bincount(own.time, square, minlength=own.length) / robots
        reached = np.bincount(time, areas_in_reach(cells, places, reach_mm), minlength=own.length)
        covered = np.maximum(reached, 0.0)
    return pd.DataFrame(
        {
            "mean_area": mean,
            "std_area": np.sqrt(variance),
            "var_area": variance,
            "n_cells": robots,
            "coverage_ratio": covered,
        }
    )


def areas_in_reach(cells: Cells, place_mm: Floats, reach_mm: float) -> Floats:
    """Return the area of the intersection of the cell of each place with a disk around it, mm^2.

    A point is in a disk if its nearest robot is not farther away than the radius. So the union of the disks is made of
    these intersections, which do not overlap; see `disk_and_edges`.

    Args:
        cells: Cells of `cells_of_places`, shape (n,).
        place_mm: The same places, shape (n, 2).
        reach_mm: Radius of the disks.

    Returns:
        Shape (n,); it may be a little below 0, by rounding.
    """
    import shapely

    polygons, owner = shapely.get_parts(cells, return_index=True)
    is_area = shapely.area(polygons) > 0.0  # of an intersection that only touches: lines and points
    polygons, owner = polygons[is_area], owner[is_area]
    rings, polygon = shapely.get_rings(polygons, return_index=True)
    if len(rings) == 0:
        return np.zeros(len(cells))
    corners, ring = shapely.get_coordinates(rings, return_index=True)
    corners = corners - place_mm[owner[polygon[ring]]]
    # Outer walls count as areas, holes against them, whatever way round their corners are.
    is_outer = np.concatenate([[True], polygon[1:] != polygon[:-1]])
    inner = ring[1:] == ring[:-1]
    start, end = corners[:-1][inner], corners[1:][inner]
    edge_ring = ring[:-1][inner]
    turn = np.bincount(edge_ring, cross(start, end), minlength=len(rings))
    sign = np.where(is_outer, 1.0, -1.0) * np.sign(turn)
    parts = sign[edge_ring] * disk_and_edges(start, end, reach_mm)
    return np.asarray(np.bincount(owner[polygon[edge_ring]], parts, minlength=len(cells)), dtype=float)


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products of vectors in the plane. Shapes (n, 2) to (n,)."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def disk_and_edges(start: Floats, end: Floats, radius: float) -> Floats:
    """Return the signed areas of a disk around the origin within the triangles (origin, start, end).

    Summed over the edges of a polygon, they are the area of its intersection with the disk (Green's theorem): triangles
    where an edge is inside of the disk, sectors where it is outside.

    Args:
        start: First corners of the edges, shape (n, 2).
        end: Second corners, shape (n, 2).
        radius: Radius of the disk.

    Returns:
        Shape (n,), positive for edges that turn from x to y around the origin.
    """
    along = end - start
    # Where the edge is in the disk: |start + t along| < radius, for t from enter to leave.
    a = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    half_b = (start * along).sum(axis=1)
    root = np.sqrt(np.maximum(half_b**2 - a * ((start**2).sum(axis=1) - radius**2), 0.0))
    enter = np.clip((-half_b - root) / a, 0.0, 1.0)
    leave = np.clip((-half_b + root) / a, 0.0, 1.0)
    first, last = start + enter[:, None] * along, start + leave[:, None] * along
    return radius**2 / 2.0 * (turned(start, first) + turned(last, end)) + cross(first, last) / 2.0


def turned(a: Floats, b: Floats) -> Floats:
    """Return the angles from vectors a to vectors b, in rad, -pi to pi; 0 if one is zero."""
    return np.asarray(np.arctan2(cross(a, b), (a * b).sum(axis=1)))
