"""Proximity links: pairs of robots near enough to hear each other, if nothing stands between them.

Two robots are linked within communication_radius + 2 * radius from centre to centre, the distance that all analyses of
data files use. In general, of two bodies a and b: max(range of a, range of b) + radius of a + radius of b.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pogosim.deferred import pandas as pd
from pogosim.deferred import spatial
from pogosim.periodic import minimum_image
from pogosim.picture.images import Box, lines_between
from pogosim.picture.swarm import KIND, OBJECT, Swarm
from pogosim.scene import bounds
from pogosim.shapes import Floats

Pairs = npt.NDArray[np.int64]


def proximity_pairs(position_mm: Floats, range_mm: Floats, radius_mm: Floats, box: Box | None = None) -> Pairs:
    """Find the pairs of bodies in range.

    Args:
        position_mm: Shape (n, 2), finite.
        range_mm: Infrared range of each, shape (n,); 0: it is mute. Two mute bodies are never linked.
        radius_mm: Radius of each, shape (n,).
        box: Least and greatest corner of a periodic arena, in which distances are those to the nearest image. None:
            solid walls.

    Returns:
        Shape (pairs, 2), the lower index first; in ascending order.
    """
    if len(position_mm) < 2 or range_mm.max() <= 0:
        return np.empty((0, 2), dtype=np.int64)
    furthest = float(range_mm.max() + 2.0 * radius_mm.max())
    size = None
    if box is not None:
        size = box[1] - box[0]
        position_mm = (position_mm - box[0]) % size
        position_mm = np.where(position_mm >= size, 0.0, position_mm)  # of -1e-20, the remainder is rounded up
    pairs = spatial.KDTree(position_mm, boxsize=size).query_pairs(furthest, output_type="ndarray").astype(np.int64)
    first, second = pairs.T
    step = minimum_image(position_mm[second] - position_mm[first], size)
    reach = np.maximum(range_mm[first], range_mm[second])
    near = (np.hypot(*step.T) <= reach + radius_mm[first] + radius_mm[second]) & (reach > 0)
    pairs = pairs[near]
    return np.asarray(pairs[np.lexsort(pairs.T[::-1])])


def link_segments(position_mm: Floats, pairs: Pairs, box: Box | None = None) -> Floats:
    """Lines that join pairs; a link across the border of a periodic arena is one line from either end.

    Args:
        position_mm: Shape (n, 2).
        pairs: Shape (m, 2).
        box: As in proximity_pairs().

    Returns:
        Shape (k, 2, 2): from and to, x and y; k is at least m.
    """
    return lines_between(position_mm[pairs[:, 0]], position_mm[pairs[:, 1]], box)[0]


def box_of(swarm: Swarm) -> Box | None:
    """Return the box of a periodic arena; None where walls are solid."""
    return bounds(swarm.polygons) if swarm.is_periodic else None


def links_at_end(swarm: Swarm) -> Floats:
    """Lines of all links at the end of the run, shape (k, 2, 2), mm."""
    last = swarm.rows.groupby(OBJECT).tail(1)
    return links_between(swarm, last)


def links_between(swarm: Swarm, rows: pd.DataFrame) -> Floats:
    """Lines of the links between the objects of some rows, one for each, shape (k, 2, 2), mm."""
    own = [swarm.kinds[number] for number in rows[KIND]]
    talks = np.array([category.talks for category in own], dtype=bool)
    position = rows[["x", "y"]].to_numpy(dtype=float)[talks]
    bodies = [category for category in own if category.talks]
    pairs = proximity_pairs(
        position,
        np.array([category.communication_radius_mm for category in bodies]),
        np.array([category.shape.bounding_radius_mm for category in bodies]),
        box_of(swarm),
    )
    return link_segments(position, pairs, box_of(swarm))
