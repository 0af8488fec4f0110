"""Tables of `pogosim analyze locomotion`: motion of robots, runs, and combinations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from pogosim.analysis.arena import Floats
from pogosim.analysis.averages import mean_and_sem, mean_and_variance, sliding_mean
from pogosim.analysis.displacement import (
    at_regular_times,
    diffusion_coefficient,
    diffusion_coefficients,
    diffusion_exponent,
    displacement_by_lag,
    mean_squared_displacement,
    msd_per_agent,
)
from pogosim.analysis.motion import (
    angular_velocity,
    net_displacement,
    path_length,
    peclet_numbers,
    speed,
    straightness,
)
from pogosim.analysis.persistence import (
    heading_autocorrelation,
    persistence_length,
    persistence_time,
    velocity_autocorrelation,
)
from pogosim.analysis.trajectories import Trajectories
from pogosim.errors import AnalysisError
from pogosim.reports.options import labelled


def robots_of(run: Trajectories) -> pd.DataFrame:
    """Return the category and number of each robot."""
    return pd.DataFrame({"robot_category": run.category, "robot_id": run.robot_id})


def is_evenly_spaced(run: Trajectories) -> bool:
    """Tell whether the save times of a run are multiples of a period."""
    try:
        at_regular_times(run)
    except AnalysisError:
        return False
    return True


def agent_table(run: Trajectories) -> pd.DataFrame:
    """Return the motion of each robot over its run: a row per robot that has two positions."""
    speed_mean, speed_variance = mean_and_variance(speed(run), axis=0)
    turning_mean, turning_variance = mean_and_variance(angular_velocity(run), axis=0)
    count = run.is_there.sum(axis=0)
    table = robots_of(run).assign(
        positions=count,
        mean_speed_mm_s=speed_mean,
        var_speed_mm2_s2=speed_variance,
        mean_angular_velocity_rad_s=turning_mean,
        var_angular_velocity_rad2_s2=turning_variance,
        path_length_mm=path_length(run),
        net_displacement_mm=net_displacement(run),
        straightness=straightness(run),
    )
    return labelled(table[count > 1], run)


def time_table(run: Trajectories, window_s: float) -> pd.DataFrame:
    """Return the mean motion of all robots over time, each one averaged over a sliding window before."""
    speeds = sliding_mean(run.time_s, speed(run), window_s)
    turning = sliding_mean(run.time_s, angular_velocity(run), window_s)
    table = pd.DataFrame({"time": run.time_s, "robots": np.isfinite(speeds).sum(axis=1)})
    for name, values in (("speed_mm_s", speeds), ("angular_velocity_rad_s", turning)):
        table[f"mean_{name}"], table[f"sem_{name}"] = mean_and_sem(values, axis=1)
    return labelled(table, run)


def peclet_table(run: Trajectories, characteristic_length_mm: float | None) -> pd.DataFrame:
    """Return the Peclet number of each robot that has two positions, and what it is computed from."""
    length = 2.0 * run.sizes.radius_mm if characteristic_length_mm is None else characteristic_length_mm
    table = robots_of(run).assign(
        mean_speed_mm_s=mean_and_variance(speed(run), axis=0)[0],
        diffusion_coefficient_mm2_s=diffusion_coefficients(run),
        characteristic_length_mm=length,
        peclet=peclet_numbers(run, characteristic_length_mm),
    )
    return labelled(table[run.is_there.sum(axis=0) > 1], run)


def msd_per_agent_table(run: Trajectories) -> pd.DataFrame:
    """Return the mean squared displacement of each robot that has two positions."""
    table = robots_of(run).assign(MSD=msd_per_agent(run))
    return labelled(table.dropna(subset="MSD"), run)


def msd_table(run: Trajectories) -> pd.DataFrame:
    """Return squared displacements against the lag: over robots from their first positions, and over all times."""
    try:
        lag, squared = displacement_by_lag(run)
    except AnalysisError:  # unevenly spaced, and robots begin at different times: there are no lags in common
        lag, squared = run.time_s - run.time_s[0], np.full(run.position_mm.shape[:2], np.nan)
    mean, error = mean_and_sem(squared, axis=1)
    table = pd.DataFrame({"lag_s": lag, "robots": np.isfinite(squared).sum(axis=1)})
    table = table.assign(msd_mm2=mean, sem_msd_mm2=error, time_averaged_msd_mm2=np.nan)
    if is_evenly_spaced(run):
        table["time_averaged_msd_mm2"] = mean_squared_displacement(run)[1]
    return labelled(table, run)


def autocorrelation_table(run: Trajectories) -> pd.DataFrame:
    """Return the autocorrelations of heading and velocity; NaN if times are not evenly spaced."""
    if not is_evenly_spaced(run):
        lags = run.time_s - run.time_s[0]
        return labelled(pd.DataFrame({"lag_s": lags, "heading": np.nan, "velocity": np.nan}), run)
    lags, heading = heading_autocorrelation(run)
    table = pd.DataFrame({"lag_s": lags, "heading": heading, "velocity": velocity_autocorrelation(run)[1]})
    return labelled(table, run)


def first_and_last_quarter(lag_s: Floats) -> tuple[slice, slice]:
    """Return slices of the lags: the first and the last 25 % of those above 0, at least two each."""
    zero = int(np.count_nonzero(lag_s <= 0.0))
    quarter = max(round((len(lag_s) - zero) / 4), 2)
    return slice(zero, zero + quarter), slice(max(len(lag_s) - quarter, zero), None)


def run_row(
    run: Trajectories, agents: pd.DataFrame, msd: pd.DataFrame, correlations: pd.DataFrame, peclet: pd.DataFrame
) -> pd.DataFrame:
    """Return what a run comes to in one row."""
    kind = "time_averaged_msd_mm2" if is_evenly_spaced(run) else "msd_mm2"
    lag, mean = msd["lag_s"].to_numpy(dtype=float), msd[kind].to_numpy(dtype=float)
    early, late = first_and_last_quarter(lag)
    times = {name: persistence_time(lag, correlations[name].to_numpy()) for name in ("heading", "velocity")}
    row = {
        "robots": len(agents),
        "times": len(run.time_s),
        "mean_speed_mm_s": agents["mean_speed_mm_s"].mean(),
        "mean_angular_velocity_rad_s": agents["mean_angular_velocity_rad_s"].mean(),
        "straightness": agents["straightness"].mean(),
        "diffusion_coefficient_mm2_s": diffusion_coefficient(lag[early], mean[early]),
        "msd_exponent_first_quarter": diffusion_exponent(lag[early], mean[early]),
        "msd_exponent_last_quarter": diffusion_exponent(lag[late], mean[late]),
        "median_peclet": peclet["peclet"].median(),
    }
    for name, time_s in times.items():
        row[f"{name}_persistence_time_s"] = time_s
        row[f"{name}_persistence_length_mm"] = persistence_length(run, time_s)
    return labelled(pd.DataFrame([row]), run)


def joined(tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Join tables of runs, also of runs without rows."""
    return pd.concat([table for table in tables if len(table)] or tables[:1], ignore_index=True)
