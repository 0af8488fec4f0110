"""The picture of a calibration: measured and simulated speeds, turn rates and mean squared displacements."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pogosim.calibration.statistics import mean_square_displacement, speeds, turn_rates
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.fonts import rendered, without_tex

MEASURED, SIMULATED = "#1b6ca8", "#d98200"
BINS = 60
OUTSIDE = 0.002  # share of values at each end that histograms leave out


def histogram(axes: Axes, measured: Floats, simulated: Floats, label: str) -> None:
    """Draw the distribution of a quantity: measured filled, simulated as a line."""
    a, b = (values[np.isfinite(values)] for values in (measured, simulated))
    if len(a) and len(b):
        low, high = np.quantile(np.concatenate([a, b]), [OUTSIDE, 1.0 - OUTSIDE])
        edges = np.linspace(low, max(high, low + 1e-9), BINS + 1).tolist()
        axes.hist(a, edges, density=True, color=MEASURED, alpha=0.45, label="measured")
        axes.hist(b, edges, density=True, histtype="step", color=SIMULATED, linewidth=1.6, label="simulated")
    axes.set(xlabel=label, ylabel="probability density")


def displacement(axes: Axes, measured: Tracks, simulated: Tracks) -> None:
    """Draw the mean squared displacement over lags."""
    last_s = max(measured.length_s / 4.0, 2.0 * measured.frame_s)
    lags = np.unique(np.rint(np.geomspace(1.0, last_s / measured.frame_s, 30)).astype(int)) * measured.frame_s
    axes.loglog(lags, mean_square_displacement(measured, lags), "o", color=MEASURED, alpha=0.6, label="measured")
    axes.loglog(lags, mean_square_displacement(simulated, lags), color=SIMULATED, linewidth=1.6, label="simulated")
    axes.set(xlabel="lag (s)", ylabel="mean squared displacement (mm$^2$)")


@without_tex()
def picture(measured: Tracks, simulated: Tracks) -> bytes:
    """Return a PNG picture.

    Args:
        measured: Tracks, with the errors of the tracker.
        simulated: Robots with the fitted parameters, seen with the same errors.
    """
    figure = Figure(figsize=(12.0, 3.6), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    histogram(left, speeds(measured), speeds(simulated), "speed (mm/s)")
    histogram(middle, turn_rates(measured), turn_rates(simulated), "turn rate, positive: clockwise (rad/s)")
    displacement(right, measured, simulated)
    for axes in (left, middle, right):
        axes.grid(color="0.92")
        axes.set_axisbelow(True)
    left.legend()
    return rendered(figure, "png", 120)
