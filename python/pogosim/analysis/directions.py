"""Where robots go at each time: unit vectors along velocities or headings."""

from __future__ import annotations

import numpy as np

from pogosim.analysis.arena import Floats
from pogosim.analysis.motion import velocity
from pogosim.analysis.trajectories import Trajectories
from pogosim.defaults import MIN_SPEED_MM_S


def unit_vectors(vector: Floats, min_length: float = 0.0) -> Floats:
    """Return vectors of length 1; NaN for those that are not longer than `min_length`. Shape (..., 2) to the same."""
    length = np.hypot(vector[..., 0], vector[..., 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where((length > min_length)[..., None], vector / length[..., None], np.nan))


def directions_of_motion(run: Trajectories, min_speed_mm_s: float = MIN_SPEED_MM_S) -> Floats:
    """Return the unit vector along the velocity of each robot.

    Args:
        run: See `pogosim.analysis.motion.velocity`.
        min_speed_mm_s: At this speed, and below, a robot has no direction.

    Returns:
        Shape (T, N, 2). NaN where a robot stands, or has no velocity.
    """
    return unit_vectors(velocity(run), min_speed_mm_s)


def directions_of_headings(run: Trajectories) -> Floats:
    """Return the unit vector along the heading of each robot, (cos, sin) of the column `angle`.

    Returns:
        Shape (T, N, 2). NaN where the file has no position or no angle.
    """
    unit = np.stack([np.cos(run.heading_rad), np.sin(run.heading_rad)], axis=2)
    return np.where(run.is_there[:, :, None], unit, np.nan)
