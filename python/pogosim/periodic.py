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
        ambiguity = Ambiguity(size_mm)
        ambiguity.add(step, np.asarray(duration_s, dtype=float), top_speed_mm_s)
        ambiguity.warn()
    return step


class Ambiguity:
    """Whether robots could have taken another way across the borders, for steps that are added one part after another.

    Args:
        size_mm: Width and height of the periodic arena.
    """

    def __init__(self, size_mm: Floats) -> None:
        self.size_mm = size_mm
        self.length_mm = 0.0  # the longest step
        self.duration_s = 0.0  # the longest time between rows
        self.told_mm_s = 0.0  # the greatest speed that the file says, of those of ambiguous steps
        self.untold_mm_s = 0.0  # the speed of the fastest step of robots whose top speed is unknown
        self.other_way_mm_s = np.inf  # the least speed with which one of those takes another way

    def add(self, step_mm: Floats, duration_s: Floats, top_speed_mm_s: npt.ArrayLike | None) -> None:
        """Add steps, shape (..., 2), see `steps_of`."""
        known = np.isfinite(step_mm).all(axis=-1) & (duration_s > 0.0)
        if not known.any():
            return
        step, duration = np.abs(step_mm[known]), duration_s[known]
        length = np.hypot(*step.T)
        told = np.asarray(np.nan if top_speed_mm_s is None else top_speed_mm_s, dtype=float)
        told = np.broadcast_to(told, duration_s.shape)[known]
        is_told = np.isfinite(told)
        # The second shortest way leads once more across the border that is nearer.
        other = np.minimum(*[np.hypot(self.size_mm[axis] - step[:, axis], step[:, 1 - axis]) for axis in (0, 1)])
        is_ambiguous = is_told & (other <= MARGIN * told * duration)
        self.length_mm = max(self.length_mm, float(length.max()))
        self.duration_s = max(self.duration_s, float(duration.max()))
        self.told_mm_s = float(told.max(where=is_ambiguous, initial=self.told_mm_s))
        self.untold_mm_s = float((length / duration).max(where=~is_told, initial=self.untold_mm_s))
        self.other_way_mm_s = float((other / duration).min(where=~is_told, initial=self.other_way_mm_s))

    def warn(self) -> None:
        """Warn (AmbiguousStepsWarning) if, for one of the steps, a robot of its speed could have taken another way."""
        untold_mm_s = self.untold_mm_s if self.other_way_mm_s <= MARGIN * self.untold_mm_s else 0.0
        top_mm_s = max(self.told_mm_s, untold_mm_s)
        if not top_mm_s > 0.0:
            return
        half_mm = float(self.size_mm.min()) / 2.0
        fast = (
            f"robots go up to {self.length_mm:.4g} mm from row to row"
            if untold_mm_s > self.told_mm_s
            else f"robots drive up to {top_mm_s:.4g} mm/s (max_linear_speed), with {self.duration_s:.4g} s between rows"
        )
        warnings.warn(
            f"{fast}: enough to cross half of the periodic arena ({half_mm:.4g} mm), so that the shortest way to the "
            "next row need not be the one that they went. Speeds, displacements and paths may be wrong; record with a "
            f"save_data_period below {rounded_down(half_mm / top_mm_s):g} s",
            AmbiguousStepsWarning,
            stacklevel=3,
        )


def rounded_down(value: float) -> float:
    """Return two digits of a number above 0, not more than it."""
    digit = 10.0 ** (np.floor(np.log10(value)) - 1.0)
    return float(f"{np.floor(value / digit * (1.0 + 1e-9)) * digit:.2g}")
