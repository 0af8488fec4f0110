"""Mean squared displacement and heading autocorrelation of persistent random walks, ballistic to diffusive.

A walker of constant speed v whose heading forgets its direction at a rate k, <cos(theta(t) - theta(0))> = exp(-k t),
has the mean squared displacement

    MSD(t) = 2 v^2 / k^2 (k t - 1 + exp(-k t))

(Fürth, Zeitschrift für Physik 2, 244, 1920). k is the rotational diffusion coefficient D_r of an active Brownian
particle (Howse et al., Physical Review Letters 99, 048102, 2007), and lambda (1 - a) for tumbles at the rate lambda by
angles of the mean cosine a (Lovely and Dahlquist, Journal of Theoretical Biology 50, 477, 1975). Times between tumbles
are exponential; with steps of dt, both hold up to relative errors of (k dt)^2 / 12 and k dt^2 / (3 t).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pogosim.analysis.trajectories import trajectories_of, unwrapped

from .agreement import Comparison, Values, absolute, relative
from .experiment import Outcome, batch, compile_program

NAME = "persistent_walk"
RUNS, QUICK_RUNS = 4, 1
ROBOTS, TIME_S, QUICK_TIME_S = 100, 200.0, 100.0
SPEED_MM_S = 511.5 * 100 / 1023
WALKS = {  # results: title, decay rate of the heading's autocorrelation (1/s), colour
    "active_brownian": ("active Brownian, $D_r$ = 2 rad²/s", 2.0, "#1b6ca8"),
    "bacteria": ("run and tumble, 1/s, by 70.5°", 2.0 / 3.0, "#d98200"),
    "run_and_tumble": ("run and tumble, 1/s, any angle", 1.0, "#a8321b"),
}
LAGS = np.array([1, 2, 4, 8, 16, 32, 64, 128, 256])  # records
MARGIN_MSD = 0.002  # relative: ticks of 0.02 s
MARGIN_COSINE = 0.0005


def theory_msd(time_s: Values, decay_rate_s: float) -> Values:
    """Fürth's formula. Returns mm^2."""
    kt = decay_rate_s * time_s
    return np.asarray(2.0 * SPEED_MM_S**2 / decay_rate_s**2 * (kt - 1.0 + np.exp(-kt)))


def time_averages(rows: pd.DataFrame) -> tuple[Values, Values]:
    """Return each robot's squared displacements (mm^2) and cosines of turned angles. Shapes (robots, lags)."""
    squares, cosines = [], []
    for run in trajectories_of(rows):
        path, angle = unwrapped(run), run.heading_rad
        squares.append([((path[n:] - path[:-n]) ** 2).sum(axis=2).mean(axis=0) for n in LAGS])
        cosines.append([np.cos(angle[n:] - angle[:-n]).mean(axis=0) for n in LAGS])
    return np.hstack(squares).T, np.hstack(cosines).T


def draw_curves(axes: tuple[Axes, Axes], time_s: Values, msd: Comparison, cosine: Comparison, walk: str) -> None:
    """Draw dots for robots, a line for theory."""
    title, rate, colour = WALKS[walk]
    fine_s = np.geomspace(0.1, 100.0, 200)
    scale = theory_msd(time_s, rate)
    axes[0].plot(fine_s, theory_msd(fine_s, rate), color=colour, linewidth=1)
    axes[0].errorbar(time_s, scale * msd.measured, scale * msd.standard_error, fmt="o", color=colour, markersize=4)
    axes[1].plot(fine_s, np.exp(-rate * fine_s), color=colour, linewidth=1)
    axes[1].errorbar(time_s, cosine.measured, cosine.standard_error, fmt="o", color=colour, markersize=4, label=title)


def measure(folder: Path, quick: bool) -> Outcome:
    """Run, compare, draw."""
    runs, time_s = (QUICK_RUNS, QUICK_TIME_S) if quick else (RUNS, TIME_S)
    frames = batch(compile_program(NAME, folder), NAME, runs, {"simulation_time": time_s})
    counted = f"{runs} runs of {ROBOTS} robots for each walk, {time_s:g} s"
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    axes = figure.subplots(1, 2)
    comparisons, tables = [], []
    for walk, (_, rate, _) in WALKS.items():
        lag_s = LAGS * float(np.diff(np.sort(frames[walk]["time"].unique())[:2])[0])
        squares, cosines = time_averages(frames[walk])
        name = walk.replace("_", " ")
        msd = relative(f"{name}, MSD / theory", squares, theory_msd(lag_s, rate), MARGIN_MSD)
        cosine = absolute(f"{name}, autocorrelation", cosines, np.exp(-rate * lag_s), MARGIN_COSINE)
        comparisons += [msd, cosine]
        draw_curves(axes, lag_s, msd, cosine, walk)
        tables.append(pd.DataFrame({"time": lag_s, "msd": msd.measured, "cosine": cosine.measured}).round(9))
    axes[0].set(xscale="log", yscale="log", xlabel="time (s)", ylabel="mean squared displacement (mm²)")
    axes[1].set(xscale="log", xlabel="time (s)", ylabel="autocorrelation of the heading", ylim=(-0.1, 1.05))
    axes[1].legend(fontsize=8)
    return Outcome(counted, figure, tuple(tables), tuple(comparisons))
