"""Where bodies and ways are seen in a periodic arena: what crosses the border comes back on the other side.

A body at the border is drawn once for each side from which it reaches into the arena, and pictures cut off what is
beyond the border.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from pogosim.periodic import minimum_image
from pogosim.shapes import Floats

Box: TypeAlias = tuple[Floats, Floats]  # least and greatest corner of a periodic arena
Indices = npt.NDArray[np.int64]

# Steps to the images of a place, in widths and heights of the arena; its own place first.
STEPS = np.array([(column, row) for column in (0, -1, 1) for row in (0, -1, 1)], dtype=float)


def seen_places(position_mm: Floats, reach_mm: npt.ArrayLike, box: Box | None) -> tuple[Indices, Floats]:
    """Return all places at which bodies reach into the arena.

    Args:
        position_mm: Shape (n, 2), finite.
        reach_mm: Radius of each, or one of all.
        box: The box of a periodic arena. None: walls are solid, and every body is seen at its own place only.

    Returns:
        Which body is seen, shape (k,), in the order of bodies, and where, shape (k, 2).
    """
    if box is None:
        return np.arange(len(position_mm)), position_mm
    low, high = box
    places = position_mm[:, None] + STEPS * (high - low)
    reach = np.broadcast_to(np.asarray(reach_mm, dtype=float), len(position_mm))[:, None, None]
    is_seen = ((places + reach >= low) & (places - reach <= high)).all(axis=-1)
    which, image = np.nonzero(is_seen)
    return which, places[which, image]


def lines_between(start_mm: Floats, end_mm: Floats, box: Box | None) -> tuple[Floats, Indices]:
    """Return the shortest lines between n pairs of places; across the border of a periodic arena, one from either end.

    Args:
        start_mm: Shape (n, 2).
        end_mm: Shape (n, 2).
        box: As in seen_places().

    Returns:
        Lines, shape (k, 2, 2): from and to, x and y; k is at least n. And the pair of each, shape (k,).
    """
    if box is None:
        return np.stack([start_mm, end_mm], axis=1), np.arange(len(start_mm))
    step = minimum_image(end_mm - start_mm, box[1] - box[0])
    crosses = np.flatnonzero(~np.isclose(start_mm + step, end_mm).all(axis=1))
    forth = np.stack([start_mm, start_mm + step], axis=1)
    back = np.stack([end_mm, end_mm - step], axis=1)[crosses]
    return np.concatenate([forth, back]), np.concatenate([np.arange(len(start_mm)), crosses])


def joined(places_mm: Floats, box: Box | None) -> Floats:
    """Return a closed line through places that lie in a ring, the first one again at its end.

    Args:
        places_mm: Shape (n, 2), at least one.
        box: As in seen_places(); the line then leads the shortest way from place to place, even out of the box.

    Returns:
        Shape (n + 1, 2).
    """
    steps = minimum_image(np.diff(places_mm, axis=0, append=places_mm[:1]), None if box is None else box[1] - box[0])
    return np.asarray(places_mm[0] + np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]))
