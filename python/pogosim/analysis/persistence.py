"""How long robots keep their direction: autocorrelations of heading and velocity, persistence times and lengths."""

from __future__ import annotations

import math

import numpy as np

from pogosim.analysis.arena import Floats
from pogosim.analysis.averages import mean_and_variance
from pogosim.analysis.displacement import at_regular_times, correlation, mean_over_pairs
from pogosim.analysis.motion import speed, velocity
from pogosim.analysis.trajectories import Trajectories


def vector_autocorrelation(vectors: Floats) -> Floats:
    """Average the scalar product of vectors at two times over all columns and all pairs of times with the same lag.

    C(m) = < u(t) . u(t + m) >, by fast Fourier transforms, see `mean_squared_displacement`.

    Args:
        vectors: Shape (T, N, 2); NaN is left out.

    Returns:
        Shape (T,), in the unit of the vectors squared; NaN for lags without a pair.
    """
    known = np.asarray(np.isfinite(vectors).all(axis=2))
    filled = np.where(known[:, :, None], vectors, 0.0)
    total = correlation(filled[:, :, 0], filled[:, :, 0]) + correlation(filled[:, :, 1], filled[:, :, 1])
    return mean_over_pairs(total, known.astype(float))


def heading_autocorrelation(run: Trajectories) -> tuple[Floats, Floats]:
    """Return how much of a heading is left after a time: C(tau) = < cos(theta(t + tau) - theta(t)) >.

    1 is the same heading, 0 one at random. Rotational diffusion makes it exp(-D_r tau).

    Args:
        run: Its times must be multiples of a period; some may be missing.

    Returns:
        Lags in s, shape (T,), the first one 0, and C, shape (T,), -1 to 1. NaN for lags without a pair.

    Raises:
        AnalysisError: Save times are not evenly spaced.
    """
    run, period_s = at_regular_times(run)
    lags = period_s * np.arange(len(run.time_s), dtype=float)
    unit = np.stack([np.cos(run.heading_rad), np.sin(run.heading_rad)], axis=2)
    return lags, vector_autocorrelation(unit)


def velocity_autocorrelation(run: Trajectories) -> tuple[Floats, Floats]:
    """Return how much of a velocity is left after a time: C(tau) = < v(t) . v(t + tau) > / < v^2 >.

    Velocities are those of the steps between save times (`pogosim.analysis.motion.velocity`).

    Args:
        run: Its times must be multiples of a period; some may be missing.

    Returns:
        Lags in s, shape (T,), the first one 0, and C, shape (T,), 1 at lag 0. NaN for lags without a pair, or if
        nothing moves.

    Raises:
        AnalysisError: Save times are not evenly spaced.
    """
    run, period_s = at_regular_times(run)
    lags = period_s * np.arange(len(run.time_s), dtype=float)
    product = vector_autocorrelation(velocity(run))
    with np.errstate(invalid="ignore", divide="ignore"):
        return lags, np.where(product[0] > 0.0, product / product[0], np.nan)


def persistence_time(lag_s: Floats, autocorrelation: Floats) -> float:
    """Fit C(tau) = A exp(-tau / t_p): a least-squares line through log C, from the first lag until C < A / e.

    Lag 0 is left out, since velocities between save times scatter more than their correlations tell (A < 1 then).
    Lags beyond half the longest one are left out, too: they have few pairs. Robots that go in circles have no
    exponential; for them this is the time until they have turned away.

    Args:
        lag_s: Shape (T,), increasing from 0.
        autocorrelation: Shape (T,).

    Returns:
        t_p in s: infinite if C does not fall; NaN if it falls too fast to tell, below 1 / e in the first save period or
        by a further 1 / e within the next one, or if there are fewer than two lags.
    """
    usable = slice(1, max(len(lag_s) // 2, 3))
    lag, value = lag_s[usable], autocorrelation[usable]
    if len(value) == 0 or not value[0] > math.exp(-1.0):
        return math.nan
    low = np.flatnonzero(~(value > value[0] * math.exp(-1.0)))
    count = int(low[0]) if len(low) else len(value)
    if count < 2:
        return math.nan
    lag, value = lag[:count], value[:count]
    x = lag - lag.mean()
    rate = -float(x @ np.log(value) / (x @ x))
    return 1.0 / rate if rate > 1e-9 / lag[-1] else math.inf


def persistence_length(run: Trajectories, persistence_time_s: float) -> float:
    """Return how far robots go until they have lost their direction: l_p = < v > t_p, with their mean speed.

    Args:
        run: One run.
        persistence_time_s: Persistence time of `persistence_time`.

    Returns:
        l_p in mm; NaN if nothing is known of either.
    """
    mean_speed = float(mean_and_variance(speed(run).ravel(), axis=0)[0])
    return mean_speed * persistence_time_s if mean_speed > 0.0 else math.nan
