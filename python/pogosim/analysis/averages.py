"""Means of arrays with gaps: NaN is left out, and what is left without values is NaN, without warnings."""

from __future__ import annotations

import numpy as np

from pogosim.analysis.arena import Floats


def mean_and_variance(values: Floats, axis: int) -> tuple[Floats, Floats]:
    """Return the mean and the unbiased variance along an axis.

    Args:
        values: Any shape; NaN is left out.
        axis: The axis that goes.

    Returns:
        Mean (NaN without values) and variance (n - 1 in its denominator; NaN for fewer than two values).
    """
    count = np.isfinite(values).sum(axis=axis)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.nansum(values, axis=axis) / count
        deviation = values - np.expand_dims(mean, axis)
        variance = np.where(count > 1, np.nansum(deviation**2, axis=axis) / (count - 1), np.nan)
    return np.asarray(mean), np.asarray(variance)


def mean_and_sem(values: Floats, axis: int) -> tuple[Floats, Floats]:
    """Return the mean along an axis and its standard error, s / sqrt(n).

    Args:
        values: Any shape; NaN is left out.
        axis: The axis that goes.

    Returns:
        Mean (NaN without values) and standard error (NaN for fewer than two values).
    """
    mean, variance = mean_and_variance(values, axis)
    count = np.isfinite(values).sum(axis=axis)
    with np.errstate(invalid="ignore", divide="ignore"):
        return mean, np.sqrt(variance / count)


def sliding_mean(time_s: Floats, values: Floats, window_s: float) -> Floats:
    """Average over a window centred on each time, from window_s / 2 before it to window_s / 2 after it.

    At both ends of a run the window is cut off there, and no longer centred.

    Args:
        time_s: Shape (T,), increasing; any spacing.
        values: Shape (T, ...); NaN is left out.
        window_s: Width of the window. 0: only the value of the time itself.

    Returns:
        The shape of the values; NaN for windows without values.
    """
    slack = np.maximum(1e-6 * max(window_s, 1e-3), 2.0**-22 * np.abs(time_s))  # times are stored with 24 bits
    low = np.searchsorted(time_s, time_s - window_s / 2.0 - slack, side="left")
    high = np.searchsorted(time_s, time_s + window_s / 2.0 + slack, side="right")
    known = np.isfinite(values)
    nothing = np.zeros_like(values[:1])
    centre = np.nansum(values) / max(int(known.sum()), 1)  # sums remain small, and so do rounding errors
    total = np.concatenate([nothing, np.cumsum(np.where(known, values - centre, 0.0), axis=0)])
    count = np.concatenate([nothing, np.cumsum(known, axis=0)])
    with np.errstate(invalid="ignore"):
        return np.asarray(centre + (total[high] - total[low]) / (count[high] - count[low]))
