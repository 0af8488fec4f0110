"""Steps of robots in periodic arenas, where what leaves on one side comes back on the other.

A file has where robots were, not how they got there. The shortest way from one row to the next is taken; that is the
true one as long as robots move less than half of the arena in between.
"""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt

from pogosim.errors import AmbiguousStepsWarning as AmbiguousStepsWarning

Floats = npt.NDArray[np.float64]

# Robots may be a little faster than their motors drive them: noise, and others that push.
MARGIN = 1.05


def minimum_image(offset_mm: npt.ArrayLike, size_mm: Floats | None) -> Floats:
    """Return the shortest of all images of an offset.

    Args:
        offset_mm: Shape (..., 2).
        size_mm: Width and height of a periodic arena. None: it has walls, and offsets stay as they are.

    Returns:
        Shape (..., 2), mm.
    """
    offset = np.asarray(offset_mm, dtype=float)
    return offset if size_mm is None else offset - size_mm * np.round(offset / size_mm)


def steps_of(
    offset_mm: Floats, duration_s: Floats, size_mm: Floats | None, top_speed_mm_s: npt.ArrayLike | None
) -> Floats:
    """Return the steps of robots from one row to the next, without jumps at periodic borders.

    Warns (AmbiguousStepsWarning) if robots are fast enough for another way across the borders in the same time.

    Args:
        offset_mm: From each row to the next one of the same robot, shape (..., 2).
        duration_s: Between them, shape (...).
        size_mm: Width and height of a periodic arena. None: it has walls.
        top_speed_mm_s: Top speed of each robot or of all, mm/s, for each duration. None or NaN: unknown; the speed of
            the fastest step of such robots counts.

    Returns:
        Shape (..., 2), mm.
    """
    step = minimum_image(offset_mm, size_mm)
    if size_mm is not None and step.size:
        warn_if_ambiguous(step, np.asarray(duration_s, dtype=float), size_mm, top_speed_mm_s)
    return step


def warn_if_ambiguous(
    step_mm: Floats, duration_s: Floats, size_mm: Floats, top_speed_mm_s: npt.ArrayLike | None
) -> None:
    """Warn if, for one of these steps, shape (..., 2), a robot of this speed could have taken another way."""
    known = np.isfinite(step_mm).all(axis=-1) & (duration_s > 0.0)
    if not known.any():
        return
    step, duration = np.abs(step_mm[known]), duration_s[known]
    length = np.hypot(*step.T)
    told = np.asarray(np.nan if top_speed_mm_s is None else top_speed_mm_s, dtype=float)
    told = np.broadcast_to(told, duration_s.shape)[known]
    is_told = np.isfinite(told)
    speed = np.where(is_told, told, (length / duration).max(where=~is_told, initial=0.0))
    # The second shortest way leads once more across the border that is nearer.
    others = [np.hypot(size_mm[axis] - step[:, axis], step[:, 1 - axis]) for axis in (0, 1)]
    is_ambiguous = np.minimum(*others) <= MARGIN * speed * duration
    is_ambiguous &= speed > 0.0
    if not is_ambiguous.any():
        return
    fastest = int(np.argmax(np.where(is_ambiguous, speed, 0.0)))
    top_mm_s = float(speed[fastest])
    half_mm = float(size_mm.min()) / 2.0
    fast = (
        f"robots go up to {length.max():.4g} mm from row to row"
        if not is_told[fastest]
        else f"robots drive up to {top_mm_s:.4g} mm/s (max_linear_speed), with {duration.max():.4g} s between rows"
    )
    warnings.warn(
        f"{fast}: enough to cross half of the periodic arena ({half_mm:.4g} mm), so that the shortest way to the next "
        "row need not be the one that they went. Speeds, displacements and paths may be wrong; record with a "
        f"save_data_period below {rounded_down(half_mm / top_mm_s):g} s",
        AmbiguousStepsWarning,
        stacklevel=2,
    )


def rounded_down(value: float) -> float:
    """Return two digits of a number above 0, not more than it."""
    digit = 10.0 ** (np.floor(np.log10(value)) - 1.0)
    return float(f"{np.floor(value / digit * (1.0 + 1e-9)) * digit:.2g}")
