"""Polynomial mutation within bounds.

K. Deb and S. Agrawal, "A niched-penalty approach for constraint handling in genetic algorithms", 1999; the bounded form
of K. Deb, "Multi-objective optimization using evolutionary algorithms", Wiley 2001.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def mutated(points: Floats, probability: float, eta: float, random: np.random.Generator) -> Floats:
    """Return mutated copies of points of the unit cube.

    Args:
        points: Points, shape (points, variables), from 0 to 1.
        probability: That a coordinate changes. At least one coordinate of each point does.
        eta: Crowding degree, 0 or more: the higher, the smaller the changes.
        random: Where chance comes from.
    """
    count, dimensions = points.shape
    chosen = random.random(points.shape) < probability
    chosen[np.arange(count), random.integers(dimensions, size=count)] = True
    u = random.random(points.shape)
    power = 1.0 / (eta + 1.0)
    down = (2.0 * u + (1.0 - 2.0 * u) * (1.0 - points) ** (eta + 1.0)) ** power - 1.0
    up = 1.0 - (2.0 * (1.0 - u) + (2.0 * u - 1.0) * points ** (eta + 1.0)) ** power
    moved = np.where(u <= 0.5, down, up)
    return np.clip(points + np.where(chosen, moved, 0.0), 0.0, 1.0)
