"""How robots move: speeds, angular velocities, lengths of paths, straightness, and Peclet numbers.

    from pogosim.analysis.motion import speed, straightness
    from pogosim.analysis.trajectories import trajectories_of

    for run in trajectories_of(rows):
        print(speed(run).shape, straightness(run))  # (times, robots), one value per robot

Values that need two rows of a robot are those of the step from its previous row to this one. Where a robot has no row
at some times, the step to its next row counts, over the time in between. Periodic borders do not count as jumps.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Floats
from pogosim.analysis.averages import mean_and_variance
from pogosim.analysis.displacement import diffusion_coefficients
from pogosim.analysis.trajectories import Trajectories, unwrapped


def previous_row(is_known: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Return for each time and robot the index of the last earlier time with a value; -1 if there is none.

    Args:
        is_known: Shape (T, N).

    Returns:
        Shape (T, N).
    """
    last = np.where(is_known, np.arange(len(is_known))[:, None], -1)
    np.maximum.accumulate(last, axis=0, out=last)
    return np.concatenate([np.full((1, is_known.shape[1]), -1), last[:-1]])


def steps(run: Trajectories) -> tuple[Floats, Floats]:
    """Return the displacement of each robot since its previous position, and the time since then.

    Returns:
        Displacements, shape (T, N, 2), mm, and durations, shape (T, N), s. NaN at a robot's first position, and where
        it has none.
    """
    path = unwrapped(run)
    before = previous_row(run.is_there)
    known = (before >= 0) & run.is_there
    earlier = np.take_along_axis(path, np.maximum(before, 0)[:, :, None], axis=0)
    duration = np.where(known, run.time_s[:, None] - run.time_s[np.maximum(before, 0)], np.nan)
    return np.where(known[:, :, None], path - earlier, np.nan), duration


def velocity(run: Trajectories) -> Floats:
    """Return the velocity of each robot: its displacement since its previous position, by the time since then.

    It is the mean velocity over that time, so a robot that turns in between is faster than its speed here.

    Returns:
        Shape (T, N, 2), mm/s; x to the right, y downwards. NaN at a robot's first position, and where it has none.
    """
    displacement, duration = steps(run)
    return np.asarray(displacement / duration[:, :, None])


def speed(run: Trajectories) -> Floats:
    """Return the speed of each robot, the norm of its `velocity`.

    Returns:
        Shape (T, N), mm/s. NaN at a robot's first position, and where it has none.
    """
    return np.asarray(np.linalg.norm(velocity(run), axis=2))


def angular_velocity(run: Trajectories) -> Floats:
    """Return how fast each robot's heading turns: omega = (theta(t) - theta(t')) / (t - t'), t' the previous row.

    Headings are unwrapped: of all angles that lead from one heading to the next, the smallest counts. So robots must
    turn less than half a turn between two save times.

    Returns:
        Shape (T, N), rad/s; positive from x to y, which is clockwise on the screen. NaN at a robot's first heading,
        and where it has none.
    """
    heading = run.heading_rad
    known = np.isfinite(heading)
    before = previous_row(known)
    both = known & (before >= 0)
    turn = heading - np.take_along_axis(heading, np.maximum(before, 0), axis=0)
    duration = np.where(both, run.time_s[:, None] - run.time_s[np.maximum(before, 0)], np.nan)
    return np.asarray((np.mod(turn + np.pi, 2.0 * np.pi) - np.pi) / duration)


def unwrapped_heading(run: Trajectories) -> Floats:
    """Return the headings without jumps by full turns: the first one of a robot and the sum of all turns since then.

    Returns:
        Shape (T, N), rad; NaN where a robot has no heading.
    """
    heading = run.heading_rad
    known = np.isfinite(heading)
    before = previous_row(known)
    turn = heading - np.take_along_axis(heading, np.maximum(before, 0), axis=0)
    turn = np.where(known & (before >= 0), np.mod(turn + np.pi, 2.0 * np.pi) - np.pi, 0.0)
    first = np.take_along_axis(heading, np.argmax(known, axis=0)[None], axis=0)
    return np.where(known, first + np.cumsum(turn, axis=0), np.nan)


def path_length(run: Trajectories) -> Floats:
    """Return the length of each robot's path: the sum of all its steps.

    Returns:
        Shape (N,), mm. NaN for a robot with one position.
    """
    length = np.linalg.norm(steps(run)[0], axis=2)
    return np.where(run.is_there.sum(axis=0) > 1, np.nansum(length, axis=0), np.nan)


def net_displacement(run: Trajectories) -> Floats:
    """Return the distance from each robot's first position to its last one.

    Returns:
        Shape (N,), mm. NaN for a robot with one position.
    """
    path, there = unwrapped(run), run.is_there
    first, last = np.argmax(there, axis=0), len(there) - 1 - np.argmax(there[::-1], axis=0)
    robots = np.arange(there.shape[1])
    distance = np.linalg.norm(path[last, robots] - path[first, robots], axis=1)
    return np.where(last > first, distance, np.nan)


def straightness(run: Trajectories) -> Floats:
    """Return how straight each robot's path is: its net displacement divided by its length.

    1 is a straight line, and 0 a path that ends where it began. For a random walk it falls with the length of the path
    (Batschelet, "Circular Statistics in Biology", 1981; Benhamou, J. Theor. Biol. 229, 2004), so compare runs of the
    same duration only.

    Returns:
        Shape (N,), 0 to 1. NaN for a robot that did not move, or has one position.
    """
    length = path_length(run)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0.0, np.minimum(net_displacement(run) / length, 1.0), np.nan)


def peclet_numbers(run: Trajectories, characteristic_length_mm: float | None = None) -> Floats:
    """Return the Peclet number of each robot, Pe = v L / D: how far its drive exceeds its diffusion.

    v is the mean speed of the robot, and D its diffusion coefficient (see `diffusion_coefficients`). For Pe >> 1 a
    robot crosses its own size by driving, for Pe << 1 by diffusion (Bechinger, Di Leonardo, Loewen, Reichhardt, Volpe,
    Volpe, "Active particles in complex and crowded environments", Rev. Mod. Phys. 88, 045006, 2016).

    Args:
        run: One run.
        characteristic_length_mm: L; None: the diameter of each robot.

    Returns:
        Shape (N,). NaN where D is not positive: the robot stood still, or did not move away from where it began.
    """
    length = 2.0 * run.sizes.radius_mm if characteristic_length_mm is None else characteristic_length_mm
    mean_speed = mean_and_variance(speed(run), axis=0)[0]
    diffusion = diffusion_coefficients(run)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(diffusion > 0.0, mean_speed * length / diffusion, np.nan)
