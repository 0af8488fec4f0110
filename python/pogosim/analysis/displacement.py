"""Mean squared displacements of robots, and what follows from them: diffusion coefficient and exponents."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from scipy import fft

from pogosim.analysis.arena import Floats
from pogosim.analysis.trajectories import Trajectories, trajectories_of, unwrapped
from pogosim.errors import AnalysisError

# Numbers that are transformed at once: 100 MB of spectra.
MAX_CELLS = 4_000_000

# If the file lacks more than this many times for each one that it has, positions at equal lags cannot be compared.
MOST_GAPS = 100


def squared_displacement(run: Trajectories) -> Floats:
    """Return the squared displacement of each robot from its first position, |r(t) - r(t0)|^2.

    Returns:
        Shape (T, N), mm^2; 0 at a robot's first position, NaN where it has none.
    """
    path = unwrapped(run)
    first = np.take_along_axis(path, np.argmax(run.is_there, axis=0)[None, :, None], axis=0)
    return np.asarray(((path - first) ** 2).sum(axis=2))


def displacement_by_lag(run: Trajectories) -> tuple[Floats, Floats]:
    """Return the squared displacement of each robot at the same times after its own first position, tau = t - t0.

    Returns:
        Lags in s, shape (T,), the first one 0, and squared displacements in mm^2, shape (T, N). NaN where a robot has
        no position, and after its last one. T is that of `at_regular_times`, if there are such times.

    Raises:
        AnalysisError: Robots have their first positions at different times, and save times are not evenly spaced.
    """
    try:
        run, period_s = at_regular_times(run)
        lags: Floats = period_s * np.arange(len(run.time_s), dtype=float)
    except AnalysisError:
        lags = run.time_s - run.time_s[0]
        if not run.is_there[0].all():
            raise
    squared, first = squared_displacement(run), np.argmax(run.is_there, axis=0)
    row = np.arange(len(lags))[:, None] + first
    shifted = np.take_along_axis(squared, np.minimum(row, len(lags) - 1), axis=0)
    return lags, np.where(row < len(lags), shifted, np.nan)


def mean_squared_displacement(run: Trajectories) -> tuple[Floats, Floats]:
    """Average the squared displacement over all robots and all pairs of times with the same lag.

    MSD(tau) = < |r(t + tau) - r(t)|^2 >, over robots and start times t. The sums over t are correlations, computed by
    fast Fourier transforms (Calandrini, Pellegrini, Calligari, Hinsen, Kneller, "nMoldyn", 2011), so 10 000 save times
    take no longer than reading them. Positions that are missing are left out.

    Args:
        run: Its times must be multiples of a period; some may be missing.

    Returns:
        The lags in s, shape (T,), the first one 0, and the mean squared displacement in mm^2, shape (T,). NaN for lags
        without a pair.

    Raises:
        AnalysisError: Save times are not evenly spaced.
    """
    run, period_s = at_regular_times(run)
    path = unwrapped(run)
    there = run.is_there
    robots = there.any(axis=0)
    # Around their mean, squares stay small, and so do rounding errors.
    path = np.where(there[:, :, None], path, 0.0)[:, robots]
    weight = there[:, robots].astype(float)
    path -= weight[:, :, None] * (path.sum(axis=0) / weight.sum(axis=0)[:, None])
    square = (path**2).sum(axis=2)
    total = correlation(weight, square) + correlation(square, weight)
    total -= 2.0 * (correlation(path[:, :, 0], path[:, :, 0]) + correlation(path[:, :, 1], path[:, :, 1]))
    lags: Floats = period_s * np.arange(len(path), dtype=float)
    mean = mean_over_pairs(np.maximum(total, 0.0), weight)
    mean[:1] = 0.0  # without rounding errors
    return lags, mean


def correlation(a: Floats, b: Floats) -> Floats:
    """Sum a(t) b(t + m) over t and columns, for each lag m. Shapes (T, N) to (T,)."""
    length = len(a)
    size = fft.next_fast_len(2 * length, real=True)
    spectrum = np.zeros(size // 2 + 1, dtype=complex)
    block = max(MAX_CELLS // size, 1)
    for start in range(0, a.shape[1], block):
        columns = slice(start, start + block)
        one = fft.rfft(a[:, columns], size, axis=0)
        other = one if b is a else fft.rfft(b[:, columns], size, axis=0)
        spectrum += (one.conj() * other).sum(axis=1)
    return np.asarray(fft.irfft(spectrum, size)[:length])


def mean_over_pairs(total: Floats, known: Floats) -> Floats:
    """Divide sums over pairs of times with the same lag, as of `correlation`, by the numbers of these pairs.

    Args:
        total: Sums, shape (T,).
        known: 1 for values that are known, else 0, shape (T, N).

    Returns:
        Shape (T,); NaN for lags without a pair, where transforms leave numbers such as 1e-12, not 0.
    """
    pairs = correlation(known, known).round()
    return np.where(pairs > 0.0, total / np.maximum(pairs, 1.0), np.nan)


def at_regular_times(run: Trajectories) -> tuple[Trajectories, float]:
    """Return the run at evenly spaced times, without positions where the file has no rows, and their spacing.

    A run is saved at the first time step after each period. So save times may be off by a time step, here by up to a
    quarter of the period.

    Returns:
        The run, with all multiples of the period as times, and the period in s; 1 if there is one time only.

    Raises:
        AnalysisError: Save times are not at multiples of a period.
    """
    if len(run.time_s) < 2:
        return run, 1.0
    since = run.time_s - run.time_s[0]
    steps = np.diff(since)
    estimate = float(np.mean(steps[steps < 1.5 * steps.min()]))
    period = float(since[-1] / max(np.round(since[-1] / estimate), 1.0))
    index = np.round(since / period).astype(np.int64)
    is_off = np.abs(since - period * index).max() > 0.25 * period
    if is_off or (np.diff(index) < 1).any() or index[-1] > MOST_GAPS * len(since):
        raise AnalysisError(f"its save times are not evenly spaced: {steps.min():g} s to {steps.max():g} s apart")
    if index[-1] + 1 == len(since):
        return run, period
    times = run.time_s[0] + period * np.arange(index[-1] + 1)
    position = np.full((len(times), *run.position_mm.shape[1:]), np.nan)
    heading, row = np.full(position.shape[:2], np.nan), np.full(position.shape[:2], -1, dtype=np.int64)
    position[index], heading[index], row[index] = run.position_mm, run.heading_rad, run.row
    return replace(run, time_s=times, position_mm=position, heading_rad=heading, row=row), period


def diffusion_coefficient(lag_s: Floats, msd_mm2: Floats) -> float:
    """Return D of MSD = 4 D tau + constant in two dimensions: a quarter of the slope of a least-squares line.

    Returns:
        D in mm^2/s; NaN for fewer than two lags.
    """
    good = np.isfinite(msd_mm2)
    if np.count_nonzero(good) < 2:
        return float("nan")
    lag = lag_s[good] - lag_s[good].mean()
    return float(lag @ msd_mm2[good] / (lag @ lag) / 4.0)


def diffusion_coefficients(run: Trajectories) -> Floats:
    """Return D of each robot: a quarter of the slope of a least-squares line through its squared displacements.

    |r(t) - r(t0)|^2 = 4 D (t - t0) + constant, over all its save times. One path is a rough estimate of D, with an
    error as large as D itself; the D of a run is more precise: `mean_squared_displacement` and `diffusion_coefficient`.

    Returns:
        Shape (N,), mm^2/s; negative for robots that ended near where they began. NaN for fewer than two positions.
    """
    squared = squared_displacement(run)
    known = run.is_there
    count = known.sum(axis=0)
    lag = np.where(known, run.time_s[:, None], np.nan)
    lag = lag - np.nansum(lag, axis=0) / count
    with np.errstate(invalid="ignore"):
        slope = np.nansum(lag * squared, axis=0) / np.nansum(lag**2, axis=0)
    return np.where(count > 1, slope / 4.0, np.nan)


def diffusion_exponent(lag_s: Floats, msd_mm2: Floats) -> float:
    """Return alpha of MSD ~ tau^alpha: the slope of a least-squares line through the logarithms.

    1 is diffusion, 2 is ballistic motion. Lags and displacements that are 0 are left out.

    Returns:
        NaN for fewer than two lags.
    """
    good = (lag_s > 0.0) & (msd_mm2 > 0.0)
    if np.count_nonzero(good) < 2:
        return float("nan")
    x = np.log(lag_s[good])
    x -= x.mean()
    return float(x @ np.log(msd_mm2[good]) / (x @ x))


def msd_per_agent(run: Trajectories) -> Floats:
    """Return |r(t) - r(t0)|^2 of each robot, averaged over its save times after t0.

    Returns:
        Shape (N,), mm^2. NaN for a robot with one position.
    """
    count = run.is_there.sum(axis=0)
    total = np.nansum(squared_displacement(run), axis=0)
    return np.where(count > 1, total / np.maximum(count - 1, 1), np.nan)


def compute_msd_per_agent(rows: pd.DataFrame, metadata: Mapping[str, Any] | None = None) -> pd.DataFrame:
    """Return the mean squared displacement of each robot: |r(t) - r(t0)|^2, averaged over its save times after t0.

    Args:
        rows: As of `pogosim.utils.load_dataframe`.
        metadata: See `trajectories_of`.

    Returns:
        A row per run and robot: the labels of the run, robot_category, robot_id, and MSD in mm^2. Robots with one
        position are left out; empty if there are no others.

    Raises:
        AnalysisError: See `trajectories_of`; not for rows without any position.
    """
    parts = []
    for run in trajectories_of(rows, metadata) if len(rows) else []:
        part = pd.DataFrame({"robot_category": run.category, "robot_id": run.robot_id, "MSD": msd_per_agent(run)})
        parts.append(part.dropna(subset="MSD"))
        for name, value in reversed(run.labels.items()):
            parts[-1].insert(0, name, value)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame({"run": [], "robot_id": [], "MSD": []})
