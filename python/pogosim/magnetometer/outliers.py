"""Rows of a table of readings that are far from the curve of the others.

The simulator looks for the same ones (src/sim/magnetometer_doubts.cpp).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pogosim.calibration.tracks import Floats
from pogosim.magnetometer.fit import basis
from pogosim.magnetometer.table import ReadingTable

FAR = 3.0  # distances of the quartiles from each other
LEAST_WIDTH = 10.0  # of the quartiles, counts
OF_NORMAL = 1.4826  # standard deviation of a normal distribution over the median of its size
LEAST_SCALE = 1.0  # counts: readings are whole
NEAR, OUTLIER = 6.0, 10.0  # usual distances from the curve
ROUNDS = 10
MOST_SHARE = 0.25  # beyond it, the curve is wrong, not the rows


def outliers(table: ReadingTable, order: int, field_angle_rad: float) -> NDArray[np.int64]:
    """Return the numbers of the rows, from 0; none if they are many, or if the others do not determine the curve."""
    matrix = basis(field_angle_rad - table.angle_rad, order)
    low, high = np.percentile(table.reading, [25.0, 75.0], axis=0)
    far = FAR * np.maximum(high - low, LEAST_WIDTH)
    is_near = np.all((table.reading >= low - far) & (table.reading <= high + far), axis=1)
    # Rows that were near the curve of others give a better one.
    for _ in range(ROUNDS):
        if is_near.sum() <= matrix.shape[1] or np.linalg.matrix_rank(matrix[is_near]) < matrix.shape[1]:
            return np.zeros(0, dtype=np.int64)
        distance = distances(matrix, table.reading, is_near)
        if np.array_equal(distance <= NEAR, is_near):
            break
        is_near = distance <= NEAR
    found = np.flatnonzero(distance > OUTLIER)
    return found if len(found) <= MOST_SHARE * len(table.reading) else found[:0]


def distances(matrix: Floats, reading: Floats, is_near: NDArray[np.bool_]) -> Floats:
    """Return the distances of all rows from the curve of those that are near, in units of the usual one of these."""
    coefficients = np.linalg.lstsq(matrix[is_near], reading[is_near], rcond=None)[0]
    distance = np.abs(reading - matrix @ coefficients)
    scale = np.maximum(OF_NORMAL * np.median(distance[is_near], axis=0), LEAST_SCALE)
    return np.asarray(np.max(distance / scale, axis=1), dtype=np.float64)


def doubt(table: ReadingTable, order: int, field_angle_rad: float) -> str:
    """Return what is wrong with rows of a table; empty if nothing is."""
    found = outliers(table, order, field_angle_rad)
    if not len(found):
        return ""
    reading = ", ".join(f"{count:g}" for count in table.reading[found[0]])
    more = f", like {len(found) - 1} more" if len(found) > 1 else ""
    return (
        f"{table.source}: the reading {reading} at {math.degrees(table.angle_rad[found[0]]):g} degrees is far from the "
        f"curve of the other rows{more}; correct or delete it"
    )
