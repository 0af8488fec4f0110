"""Milling: robots that go round a common centre."""

from __future__ import annotations

from typing import Literal

import numpy as np

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.directions import unit_vectors
from pogosim.analysis.trajectories import Trajectories
from pogosim.defaults import MIN_SPEED_MM_S
from pogosim.errors import AnalysisError


def centre_of_mass(run: Trajectories) -> Floats:
    """Return the mean position of the robots at each time.

    In a periodic arena, x and y are mean directions on a circle (Bai, Breen, "Calculating center of mass in an
    unbounded 2D environment", Journal of Graphics Tools 13, 2008).

    Returns:
        Shape (T, 2), mm. NaN at times without robots; and, in periodic arenas, where they are spread so evenly that no
        place is the centre.
    """
    there = run.is_there
    count = there.sum(axis=1)[:, None]
    position = np.where(there[:, :, None], run.position_mm, 0.0)
    with np.errstate(invalid="ignore"):
        if not run.arena.is_periodic:
            return np.asarray(position.sum(axis=1) / count)
        low, size = run.arena.bounds_mm[0], run.arena.size_mm
        angle = 2.0 * np.pi * (position - low) / size
        circle = np.where(there[:, :, None], np.exp(1j * angle), 0.0).sum(axis=1) / count
        place = low + np.mod(np.angle(circle) / (2.0 * np.pi), 1.0) * size
        return np.where(np.abs(circle) > 1e-9, place, np.nan)


def centre_of_arena(arena: Arena) -> Floats:
    """Return the centre of mass of the floor of an arena, (x, y) in mm.

    Raises:
        AnalysisError: The outline of the arena is not known.
    """
    if not arena.polygons:
        raise AnalysisError("it does not say what the arena is, so there is no centre of it")
    centre = arena.shape().centroid
    return np.array([centre.x, centre.y])


def milling(
    run: Trajectories, velocity: Floats, centre: Literal["cm", "arena"] = "cm", min_speed_mm_s: float = MIN_SPEED_MM_S
) -> tuple[Floats, Floats]:
    """Return how much robots go round a centre at each time.

    Tangential alignment is M = < r x u >, with unit vectors r from the centre to the robot and u along its velocity
    (Couzin, Krause, James, Ruxton, Franks, "Collective memory and spatial sorting in animal groups", Journal of
    Theoretical Biology 218, 2002). Normalised angular momentum is L = sum(R x v) / sum(|R| |v|), where robots count by
    distance and speed (Chuang, D'Orsogna, Marthaler, Bertozzi, Chayes, "State transitions and the continuum limit for a
    2D interacting, self-propelled particle system", Physica D 232, 2007).

    Both are positive if robots turn from the x axis towards the y axis, which is clockwise as seen with y downwards, as
    the column `angle` counts; 1 or -1: all circle around the centre, in the same sense.

    Args:
        run: Positions of the robots.
        velocity: Shape (T, N, 2), mm/s; NaN: the robot is left out.
        centre: `cm`, the centre of mass of the robots at this time, or `arena`, that of the floor. The velocity of the
            centre is not subtracted.
        min_speed_mm_s: At this speed, and below, a robot does not count in M.

    Returns:
        M and L, shapes (T,), -1 to 1. NaN at times without a moving robot away from the centre.

    Raises:
        AnalysisError: The arena's centre is wanted, and the arena is not known.
    """
    where = centre_of_mass(run) if centre == "cm" else np.broadcast_to(centre_of_arena(run.arena), (len(run.time_s), 2))
    arm = run.arena.minimum_image(run.position_mm - where[:, None])
    sine = cross(unit_vectors(arm), unit_vectors(velocity, min_speed_mm_s))
    momentum = cross(arm, velocity)
    scale = np.where(
        np.isfinite(momentum), np.hypot(*np.moveaxis(arm, 2, 0)) * np.hypot(*np.moveaxis(velocity, 2, 0)), 0
    )
    with np.errstate(invalid="ignore"):
        tangential = np.nansum(sine, axis=1) / np.isfinite(sine).sum(axis=1)
        return np.asarray(tangential), np.asarray(np.nansum(momentum, axis=1) / scale.sum(axis=1))


def cross(a: Floats, b: Floats) -> Floats:
    """Return the component of a x b out of the plane. Shapes (..., 2) to (...)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
