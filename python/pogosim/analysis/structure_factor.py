"""The static structure factor: at which wavelengths is the density of robots uneven?"""

from __future__ import annotations

import numpy as np
from scipy import fft

from pogosim.analysis.arena import Floats
from pogosim.analysis.floor import box_of, covered_fraction, floor_of_centres
from pogosim.analysis.snapshots import snapshots_of
from pogosim.analysis.trajectories import Trajectories

MAX_CELLS = 100_000  # cells of all times that are transformed at once: what fits into the cache


def structure_factor(run: Trajectories, shape: tuple[int, int] = (128, 128)) -> tuple[Floats, Floats]:
    """Return the static structure factor, averaged over directions of the wave vector and over all times.

    S(k) = |sum_j exp(-i k . r_j) - N W(k)|^2 / (N (1 - |W(k)|^2)), where W(k) is the Fourier transform of the floor
    where centres can be, divided by its area: what N robots spread evenly over it have. In a periodic box W is 0, and
    S(k) is the usual one (Hansen, McDonald, "Theory of Simple Liquids", 2013, section 4.1). Either way it is 1 for
    independent, uniform places. Small S at small k: more even than chance (hyperuniform); large S: clusters; a lattice
    has Bragg peaks.

    Robots are counted in the cells of a grid over the bounding box, whose Fourier transform is a fast one. A place is
    thus known up to half a cell: a Bragg peak at k is lower by the factor sinc(kx dx / 2)^2 sinc(ky dy / 2)^2, at least
    0.81 for k below half the largest one.

    Args:
        run: Its arena must be known.
        shape: Columns and rows of the grid, at least 4 each.

    Returns:
        Wave numbers |k| in rad/mm and S, shape (K,): means over rings whose width is that of a step in k. Up to half a
        wave per cell. NaN if no robot has a position.

    Raises:
        AnalysisError: The outline of the arena is not known.
    """
    floor = floor_of_centres(run)
    low, high = box_of(floor)
    columns, rows = shape
    cell = (high - low) / shape
    window = covered_fraction(floor, shape)
    form = np.fft.rfft2(window / window.sum())
    total, times = np.zeros(form.shape), 0
    for own in snapshots_of(run, most_times=max(MAX_CELLS // (columns * rows), 1)):
        column, row = np.clip(((own.position_mm - low) / cell).astype(int), 0, np.array(shape) - 1).T
        place = (own.time * rows + row) * columns + column
        count = np.bincount(place, minlength=own.length * rows * columns).reshape(-1, rows, columns)
        robots = own.counts
        there = np.flatnonzero(robots)
        difference = fft.rfft2(count[there].astype(float)) - robots[there, None, None] * form
        total += np.einsum("tyx,t->yx", difference.real**2 + difference.imag**2, 1.0 / robots[there])
        times += len(there)
    evenness = 1.0 - np.abs(form) ** 2
    kx = 2.0 * np.pi * np.fft.rfftfreq(columns, cell[0])
    ky = 2.0 * np.pi * np.fft.fftfreq(rows, cell[1])
    wave = np.hypot(kx, ky[:, None])
    step = 2.0 * np.pi / (high - low).min()
    ring = np.rint(wave / step).astype(int)
    good = (ring > 0) & (wave <= np.pi / cell.max()) & (evenness > 1e-6)
    # Columns stand for kx and -kx, apart from the first one and, of an even number, the last one.
    weight = np.where((np.arange(len(kx)) == 0) | (2 * np.arange(len(kx)) == columns), 1.0, 2.0) * np.ones_like(wave)
    ring, weight = ring[good], weight[good]
    modes = np.bincount(ring, weight)
    there = np.flatnonzero(modes)
    mean_wave = np.bincount(ring, weight * wave[good])[there] / modes[there]
    mean_s = np.bincount(ring, weight * (total / evenness.clip(1e-6))[good])[there] / modes[there]
    return mean_wave, mean_s / times if times else np.full(len(there), np.nan)
