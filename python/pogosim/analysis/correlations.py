"""Correlations between pairs of robots by their distance: how many there are, and how their velocities agree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pogosim.analysis.arena import Floats
from pogosim.analysis.floor import floor_of_centres, set_covariance
from pogosim.analysis.snapshots import Snapshots, pairs_of, snapshots_of
from pogosim.analysis.trajectories import Trajectories

MAX_CELLS = 1_000_000  # bins of all times of a block


def distance_bins(greatest_mm: float, width_mm: float) -> Floats:
    """Return the borders of bins from 0 to the greatest distance, or a little beyond it; at least one bin."""
    count = max(int(np.ceil(greatest_mm / width_mm - 1e-9)), 1)
    return np.asarray(width_mm * np.arange(count + 1), dtype=float)


@dataclass(frozen=True)
class PairCorrelation:
    """Pairs of robots by distance. B bins."""

    distance_mm: Floats  # (B,), middle of the bin
    pairs: Floats  # (B,), pairs at all times together
    expected: Floats  # (B,), the same if robots stood at independent, uniform places; NaN where it cannot be said

    @property
    def g_r(self) -> Floats:
        """Pair correlation function g(r), shape (B,): 1 for independent positions; NaN beyond the size of the arena."""
        unknown = np.full(len(self.pairs), np.nan)
        return np.asarray(np.divide(self.pairs, self.expected, out=unknown, where=self.expected > 0.0))


def pair_correlation(run: Trajectories, greatest_mm: float = 200.0, width_mm: float = 2.0) -> PairCorrelation:
    """Return the pair correlation function (radial distribution function) g(r), averaged over all times.

    g(r) is the number of pairs at the distance r, divided by the number to expect if the same robots stood at
    independent, uniform places on the same floor: N (N - 1) / 2 * 2 pi r dr covariance(r) / A^2, with the area A where
    centres can be (see `floor_of_centres`) and its `set_covariance`, which is smaller than A by what is beyond walls.
    So g is 1 for an ideal gas, near walls and for few robots too. In a periodic arena the covariance is A, and g is
    known up to half the shorter side of the box. Source: Hansen, McDonald, "Theory of Simple Liquids", 2013, section
    2.5; for the borders see `set_covariance`.

    Args:
        run: Its arena must be known.
        greatest_mm: Largest distance.
        width_mm: Width of a bin.

    Returns:
        See `PairCorrelation`.

    Raises:
        AnalysisError: The outline of the arena is not known.
    """
    edges = distance_bins(greatest_mm, width_mm)
    floor = floor_of_centres(run)
    counted = np.zeros(len(edges) - 1)
    for own in snapshots_of(run):
        _, _, distance = pairs_of(own, run.arena, edges[-1])
        counted += np.bincount((distance / width_mm).astype(int), minlength=len(edges))[: len(edges) - 1]
    middle = (edges[1:] + edges[:-1]) / 2.0
    if run.arena.is_periodic:
        known = edges[1:] <= run.arena.size_mm.min() / 2.0 + 1e-9
        covariance = np.where(known, floor.area, np.nan)
    else:
        covariance = set_covariance(floor, middle)
    robots = run.is_there.sum(axis=1)
    possible = float((robots * (robots - 1)).sum()) / 2.0
    expected = possible * np.pi * np.diff(edges**2) * covariance / floor.area**2
    return PairCorrelation(middle, counted, expected)


@dataclass(frozen=True)
class VectorCorrelation:
    """Products of the vectors of pairs of robots, by distance. T times, B bins."""

    distance_mm: Floats  # (B,), middle of the bin
    pairs: Floats  # (T, B)
    product: Floats  # (T, B), sum of v_i . v_j over the pairs
    mean_square: Floats  # (T,), mean of |v|^2 over the robots; NaN without any

    @property
    def mean(self) -> Floats:
        """C(r) of all times together, shape (B,); NaN where there are no pairs."""
        known = np.isfinite(self.mean_square)
        scale = (self.pairs * self.mean_square[:, None])[known].sum(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(self.product[known].sum(axis=0) / scale)

    @property
    def at_times(self) -> Floats:
        """C(r) of each time, shape (T, B); NaN where there are no pairs."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(self.product / (self.pairs * self.mean_square[:, None]))


def vector_correlation(
    run: Trajectories,
    vector: Floats,
    greatest_mm: float = 200.0,
    width_mm: float = 2.0,
    fluctuations: bool = False,
) -> VectorCorrelation:
    """Return the correlation of velocities (or directions) by distance, C(r) = <v_i . v_j>_r / <|v|^2>.

    The mean is over all pairs of different robots at a distance r at the same time. For unit vectors C(r) is the mean
    cosine of the angle between them. Source: Cavagna, Cimarelli, Giardina, Parisi, Santagati, Stefanini, Viale,
    "Scale-free correlations in starling flocks", PNAS 107, 2010, where the mean of all robots is subtracted first.

    Args:
        run: Positions of the robots.
        vector: Shape (T, N, 2); NaN: the robot is left out.
        greatest_mm: Largest distance.
        width_mm: Width of a bin.
        fluctuations: Subtract the mean vector of each time first. Otherwise C(r) of a swarm in which all go the same
            way is 1 at all distances.

    Returns:
        See `VectorCorrelation`.
    """
    edges = distance_bins(greatest_mm, width_mm)
    uses = run.is_there & np.isfinite(vector).all(axis=2)
    pairs, product = np.zeros((2, len(uses), len(edges) - 1))
    mean_square = np.full(len(uses), np.nan)
    bins = len(edges)  # and one for what is beyond
    for block in snapshots_of(run, uses, max(MAX_CELLS // bins, 1)):
        own = block.of(vector)
        count = np.maximum(block.counts, 1)
        if fluctuations:
            own = own - (summed(block, own) / count[:, None])[block.time]
        i, j, distance = pairs_of(block, run.arena, edges[-1])
        cell = bins * block.time[i] + (distance / width_mm).astype(int)
        scalar = own[i, 0] * own[j, 0] + own[i, 1] * own[j, 1]
        for table, weights in ((pairs, None), (product, scalar)):
            found = np.bincount(cell, weights, minlength=bins * block.length)
            table[block.times] = found.reshape(block.length, bins)[:, :-1]
        squares = summed(block, own**2).sum(axis=1)
        mean_square[block.times] = np.where(block.counts > 0, squares / count, np.nan)
    return VectorCorrelation((edges[1:] + edges[:-1]) / 2.0, pairs, product, mean_square)


def summed(block: Snapshots, vector: Floats) -> Floats:
    """Return the sums of the vectors of the points at each time. Shape (n, 2) to (length, 2)."""
    return np.column_stack([np.bincount(block.time, part, minlength=block.length) for part in vector.T])


def correlation_length(distance_mm: Floats, correlation: Floats) -> float:
    """Return the integral of the positive part of a correlation over the distance, by trapezoids.

    It begins with C(0) = 1, and goes over distances without pairs in a straight line. exp(-r / l) has l, apart from
    what is beyond the largest distance. With few pairs it is too long, since noise has a positive part.

    Args:
        distance_mm: Shape (B,).
        correlation: Shape (B,), NaN where there are no pairs.

    Returns:
        Length in mm; NaN if there are no pairs at all.
    """
    return float(correlation_lengths(distance_mm, correlation[None])[0])


def correlation_lengths(distance_mm: Floats, correlation: Floats) -> Floats:
    """Return the `correlation_length` of each time. Shapes (B,) and (T, B) to (T,)."""
    first = np.zeros((len(correlation), 1))
    value = np.hstack([first + 1.0, np.maximum(correlation, 0.0)])
    x = np.concatenate([[0.0], distance_mm])
    known = np.isfinite(value)
    # The bin before each that has pairs, itself left out.
    before = np.maximum.accumulate(np.where(known, np.arange(len(x)), 0), axis=1)[:, :-1]
    area = (x[1:] - x[before]) * (value[:, 1:] + np.take_along_axis(value, before, axis=1)) / 2.0
    has = known[:, 1:]
    return np.where(has.any(axis=1), np.where(has, area, 0.0).sum(axis=1), np.nan)
