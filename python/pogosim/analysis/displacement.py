"""Mean squared displacements of robots, and what follows from them: diffusion coefficient and exponents."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy import fft

from pogosim.analysis.arena import Floats
from pogosim.analysis.errors import AnalysisError
from pogosim.analysis.trajectories import Trajectories, trajectories_of, unwrapped


def squared_displacement(run: Trajectories) -> Floats:
    """Return the squared displacement of each robot from its first position, |r(t) - r(t0)|^2.

    Returns:
        Shape (T, N), mm^2; 0 at a robot's first position, NaN where it has none.
    """
    path = unwrapped(run)
    first = np.take_along_axis(path, np.argmax(run.is_there, axis=0)[None, :, None], axis=0)
    return np.asarray(((path - first) ** 2).sum(axis=2))


def mean_squared_displacement(run: Trajectories) -> tuple[Floats, Floats]:
    """Average the squared displacement over all robots and all pairs of times with the same lag.

    MSD(tau) = < |r(t + tau) - r(t)|^2 >, over robots and start times t. The sums over t are correlations, computed by
    fast Fourier transforms (Calandrini, Pellegrini, Calligari, Hinsen, Kneller, "nMoldyn", 2011), so 10 000 save times
    take no longer than reading them. Positions that are missing are left out.

    Args:
        run: Its times must be evenly spaced.

    Returns:
        The lags in s, shape (T,), the first one 0, and the mean squared displacement in mm^2, shape (T,). NaN for lags
        without a pair.

    Raises:
        AnalysisError: Save times are not evenly spaced.
    """
    period_s = save_period_s(run)
    path = unwrapped(run)
    there = run.is_there
    robots = there.any(axis=0)
    # Around their mean, squares stay small, and so do rounding errors.
    path = np.where(there[:, :, None], path, 0.0)[:, robots]
    weight = there[:, robots].astype(float)
    path -= weight[:, :, None] * (path.sum(axis=0) / weight.sum(axis=0)[:, None])
    square = (path**2).sum(axis=2)
    pairs = correlation(weight, weight).round()
    total = correlation(weight, square) + correlation(square, weight)
    total -= 2.0 * (correlation(path[:, :, 0], path[:, :, 0]) + correlation(path[:, :, 1], path[:, :, 1]))
    lags: Floats = period_s * np.arange(len(path), dtype=float)
    with np.errstate(invalid="ignore"):
        mean: Floats = np.maximum(total, 0.0) / pairs
    return lags, mean


def correlation(a: Floats, b: Floats) -> Floats:
    """Sum a(t) b(t + m) over t and columns, for each lag m. Shapes (T, N) to (T,)."""
    length = len(a)
    size = fft.next_fast_len(2 * length, real=True)
    spectrum = (fft.rfft(a, size, axis=0).conj() * fft.rfft(b, size, axis=0)).sum(axis=1)
    return np.asarray(fft.irfft(spectrum, size)[:length])


def save_period_s(run: Trajectories) -> float:
    """Return the time between two save times; 1 if there is only one.

    Raises:
        AnalysisError: It is not the same everywhere. Times are stored with 24 bits, and compared accordingly.
    """
    if len(run.time_s) < 2:
        return 1.0
    steps = np.diff(run.time_s)
    period = float(run.time_s[-1] - run.time_s[0]) / len(steps)
    if np.abs(steps - period).max() > 0.01 * period + 2.0**-22 * np.abs(run.time_s).max():
        raise AnalysisError(f"its save times are not evenly spaced: {steps.min():g} s to {steps.max():g} s apart")
    return period


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
        total = np.nansum(squared_displacement(run), axis=0)
        count = run.is_there.sum(axis=0)
        moved = count > 1
        part = pd.DataFrame({"robot_category": run.category[moved], "robot_id": run.robot_id[moved]})
        parts.append(part.assign(MSD=total[moved] / (count[moved] - 1)))
        for name, value in reversed(run.labels.items()):
            parts[-1].insert(0, name, value)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame({"run": [], "robot_id": [], "MSD": []})
