from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis.averages import mean_and_sem, mean_and_variance, sliding_mean
from pogosim.analysis.displacement import (
    at_regular_times,
    diffusion_coefficients,
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
    unwrapped_heading,
    velocity,
)
from pogosim.analysis.persistence import (
    heading_autocorrelation,
    persistence_length,
    persistence_time,
    velocity_autocorrelation,
)
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.errors import AnalysisError
from swarms import Floats, brownian_walk, metadata_of, rows_of


def run_of(rows: pd.DataFrame, side_mm: float = 1000.0, periodic: bool = False) -> Trajectories:
    (run,) = trajectories_of(rows, metadata_of(side_mm, periodic))
    return run


def circle(times: int, radius_mm: float, omega_rad_s: float, period_s: float = 0.1) -> tuple[Floats, Floats]:
    """Positions and headings of one robot that drives on a circle."""
    angle = omega_rad_s * period_s * np.arange(times)
    position = 500.0 + radius_mm * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=1)
    return position[:, None], np.mod(angle + np.pi, 2.0 * np.pi)[:, None] - np.pi


def persistent_walk(times: int, robots: int, diffusion_rad2_s: float, seed: int = 4) -> tuple[Floats, Floats]:
    """Active Brownian particles of 10 mm/s, saved every 0.1 s: positions and headings."""
    turns = np.random.default_rng(seed).normal(0.0, np.sqrt(2.0 * diffusion_rad2_s * 0.1), (times, robots))
    heading = np.cumsum(turns, axis=0)
    position = np.cumsum(np.stack([np.cos(heading), np.sin(heading)], axis=2), axis=0)
    return position, np.mod(heading + np.pi, 2.0 * np.pi) - np.pi


def test_robot_on_a_circle_has_the_speed_and_angular_velocity_of_the_circle() -> None:
    position, heading = circle(200, radius_mm=50.0, omega_rad_s=2.0)
    run = run_of(rows_of(position, heading, period_s=0.1))
    chord = 2.0 * 50.0 * np.sin(0.1) / 0.1  # of an arc of 0.2 rad
    np.testing.assert_allclose(speed(run)[1:, 0], chord, rtol=1e-9)
    np.testing.assert_allclose(angular_velocity(run)[1:, 0], 2.0, rtol=1e-9)
    assert np.isnan(speed(run)[0]).all()
    assert np.isnan(angular_velocity(run)[0]).all()
    np.testing.assert_allclose(unwrapped_heading(run)[:, 0], 0.2 * np.arange(200), atol=1e-9)


def test_speed_across_a_gap_is_that_of_the_whole_step() -> None:
    x = 10.0 * np.arange(6)
    position = np.stack([np.column_stack([x, 0.0 * x])], axis=1)
    run = run_of(pd.concat([rows_of(position).drop(index=[2, 3]), rows_of(position[:4]).assign(robot_id=7)]))
    np.testing.assert_allclose(velocity(run)[:, 0, 0], [np.nan, 10, np.nan, np.nan, 10, 10])
    np.testing.assert_allclose(speed(run)[:, 1], [np.nan, 10, 10, 10, np.nan, np.nan])
    assert path_length(run).tolist() == [50, 30]


def test_angular_velocity_goes_on_after_a_row_without_heading() -> None:
    heading = np.array([[0.0], [np.nan], [1.0], [-2.9 + 2.0 * np.pi - np.pi]])
    run = run_of(rows_of(np.zeros((4, 1, 2)), heading))
    np.testing.assert_allclose(angular_velocity(run)[:, 0], [np.nan, np.nan, 0.5, np.pi - 2.9 - 1.0])


def test_motion_does_not_see_periodic_borders() -> None:
    x = 30.0 * np.arange(50)
    straight = np.stack([np.column_stack([x, -x])], axis=1)
    run = run_of(rows_of(np.mod(straight, 100.0)), 100.0, periodic=True)
    np.testing.assert_allclose(speed(run)[1:], 30.0 * np.sqrt(2.0))
    np.testing.assert_allclose(straightness(run), 1.0)
    np.testing.assert_allclose(net_displacement(run), 30.0 * 49 * np.sqrt(2.0))


def test_straightness_is_1_on_a_line_and_2_over_pi_on_a_half_circle() -> None:
    position, heading = circle(1001, radius_mm=100.0, omega_rad_s=np.pi / 100.0)
    line = np.stack([np.linspace(0.0, 100.0, 1001), np.zeros(1001)], axis=1)[:, None]
    still = np.zeros((1001, 1, 2))
    run = run_of(rows_of(np.concatenate([position, line, still], axis=1), np.repeat(heading, 3, axis=1), 0.1))
    np.testing.assert_allclose(straightness(run)[:2], [2.0 / np.pi, 1.0], rtol=1e-5)
    assert np.isnan(straightness(run)[2])
    assert path_length(run)[2] == 0.0


def test_robots_with_one_position_have_no_motion() -> None:
    run = run_of(rows_of(np.zeros((1, 2, 2))))
    for values in (speed(run), angular_velocity(run), path_length(run), net_displacement(run), straightness(run)):
        assert np.isnan(values).all()
    for values in (peclet_numbers(run), diffusion_coefficients(run), msd_per_agent(run)):
        assert values.shape == (2,)
        assert np.isnan(values).all()
    assert np.isnan(persistence_time(*heading_autocorrelation(run)))


def test_diffusion_coefficient_of_each_robot_is_a_quarter_of_its_slope() -> None:
    # |r - r0|^2 = 4 D t for r = (sqrt(4 D t), 0).
    times = np.arange(50.0)
    x = np.sqrt(4.0 * np.array([3.0, 8.0]) * times[:, None])
    run = run_of(rows_of(np.stack([x, 0.0 * x], axis=2)).drop(index=[3, 20, 40]))
    np.testing.assert_allclose(diffusion_coefficients(run), [3.0, 8.0])
    mean_speed = mean_and_variance(speed(run), axis=0)[0]
    np.testing.assert_allclose(peclet_numbers(run), mean_speed * 53.0 / [3.0, 8.0])
    np.testing.assert_allclose(peclet_numbers(run, 100.0), mean_speed * 100.0 / [3.0, 8.0])


def test_robot_that_comes_back_has_no_peclet_number() -> None:
    x = np.concatenate([np.arange(10.0), np.arange(10.0)[::-1], np.zeros(30)])
    run = run_of(rows_of(np.stack([x, 0.0 * x], axis=1)[:, None]))
    assert diffusion_coefficients(run)[0] < 0.0
    assert np.isnan(peclet_numbers(run)[0])


def test_displacement_by_lag_starts_at_the_first_position_of_each_robot() -> None:
    x = 10.0 * np.arange(4)
    position = np.stack([np.column_stack([x, 0.0 * x])] * 2, axis=1)
    lags, squared = displacement_by_lag(run_of(rows_of(position).drop(index=[1, 3])))  # robot 1 from 2 s on
    assert lags.tolist() == [0, 1, 2, 3]
    np.testing.assert_allclose(squared, np.array([[0, 0], [100, 100], [400, np.nan], [900, np.nan]]))


def test_save_times_may_be_off_by_a_time_step() -> None:
    rows = rows_of(brownian_walk(100, 3, 1.0))
    run = run_of(rows.assign(time=np.float32(np.ceil(np.round(rows["time"] * 0.1 / 0.008, 6)) * 0.008)))
    assert at_regular_times(run)[0] is run
    assert at_regular_times(run)[1] == pytest.approx(0.1, rel=1e-2)
    assert mean_squared_displacement(run)[1][1] == pytest.approx(2.0, rel=0.3)
    with pytest.raises(AnalysisError, match=r"not evenly spaced: 0\.3 s to 1\.7 s"):
        at_regular_times(run_of(rows.assign(time=rows["time"].replace(50.0, 49.3))))


def test_times_that_are_missing_count_as_such() -> None:
    rows = rows_of(brownian_walk(200, 50, 1.0))
    gone = rows["time"].isin([50.0, 51.0, 120.0])
    run, period_s = at_regular_times(run_of(rows[~gone]))
    assert (len(run.time_s), period_s) == (200, 1.0)
    assert np.flatnonzero(~run.is_there.all(axis=1)).tolist() == [50, 51, 120]
    assert np.isnan(run.column("x")[50]).all()
    lags, msd = mean_squared_displacement(run_of(rows[~gone]))
    every_lag, every_msd = mean_squared_displacement(run_of(rows))
    np.testing.assert_array_equal(lags, every_lag)
    np.testing.assert_allclose(msd[1:20], every_msd[1:20], rtol=0.05)


@pytest.mark.parametrize("count", [5, 8, 40, 101])
def test_lag_without_a_pair_has_no_mean(count: int) -> None:
    # Robot 0 is there in the first third, robot 1 in the last tenth.
    time = np.arange(float(count))
    seen = np.stack([time < count / 3, time > 0.9 * (count - 1)], axis=1)
    has_pair = np.array([(seen[lag:] & seen[: count - lag]).any() for lag in range(count)])
    assert not has_pair.all()
    run = run_of(rows_of(brownian_walk(count, 2, 50.0) + 1e4)[seen.ravel()])
    for mean in (mean_squared_displacement(run)[1], heading_autocorrelation(run)[1]):
        assert np.isnan(mean[~has_pair]).all(), mean
        assert np.isfinite(mean[has_pair]).all(), mean


def test_heading_of_active_brownian_particles_persists_for_one_over_the_diffusion_constant() -> None:
    run = run_of(rows_of(*persistent_walk(2000, 100, diffusion_rad2_s=0.5), period_s=0.1))
    lags, heading = heading_autocorrelation(run)
    assert heading[0] == pytest.approx(1.0)
    np.testing.assert_allclose(heading[:20], np.exp(-0.5 * lags[:20]), atol=0.03)
    assert persistence_time(lags, heading) == pytest.approx(2.0, rel=0.08)
    # The velocity follows the heading, at 10 mm/s.
    time_s = persistence_time(*velocity_autocorrelation(run))
    assert time_s == pytest.approx(2.0, rel=0.08)
    assert persistence_length(run, time_s) == pytest.approx(10.0 * time_s)


def test_autocorrelation_of_a_circle_is_the_cosine_of_the_angle() -> None:
    run = run_of(rows_of(*circle(400, 50.0, omega_rad_s=1.0), period_s=0.1))
    for lags, value in (heading_autocorrelation(run), velocity_autocorrelation(run)):
        np.testing.assert_allclose(value[:300], np.cos(lags[:300]), atol=1e-6)


def test_brownian_steps_have_no_persistence_and_straight_ones_no_end() -> None:
    run = run_of(rows_of(brownian_walk(500, 50, 1.0)))
    assert np.abs(velocity_autocorrelation(run)[1][1:100]).max() < 0.05
    assert np.isnan(persistence_time(*velocity_autocorrelation(run)))
    x = np.arange(500.0)
    straight = run_of(rows_of(np.stack([x, x], axis=1)[:, None]))
    assert persistence_time(*velocity_autocorrelation(straight)) == np.inf
    assert persistence_time(*heading_autocorrelation(straight)) == np.inf


def test_autocorrelations_leave_missing_rows_out() -> None:
    position, heading = persistent_walk(300, 5, 0.5)
    gaps = np.random.default_rng(0).random((300, 5)) < 0.2
    run = run_of(rows_of(position, np.where(gaps, np.nan, heading), period_s=0.1))
    unit = np.exp(1j * run.heading_rad)
    for lag in (1, 7, 100, 250):
        expected = np.nanmean((unit[lag:] * unit[:-lag].conj()).real)
        assert heading_autocorrelation(run)[1][lag] == pytest.approx(expected, abs=1e-9)


def test_nothing_that_moves_has_no_velocity_autocorrelation() -> None:
    run = run_of(rows_of(np.zeros((10, 2, 2))))
    assert np.isnan(velocity_autocorrelation(run)[1]).all()
    assert np.isnan(persistence_length(run, 1.0))


def test_means_leave_missing_values_out() -> None:
    values = np.array([[1.0, np.nan, np.nan], [3.0, 5.0, np.nan], [8.0, np.nan, np.nan]])
    mean, variance = mean_and_variance(values, axis=0)
    np.testing.assert_allclose(mean, [4.0, 5.0, np.nan])
    np.testing.assert_allclose(variance, [13.0, np.nan, np.nan])
    np.testing.assert_allclose(mean_and_sem(values, axis=0)[1], [np.sqrt(13.0 / 3.0), np.nan, np.nan])


def test_sliding_mean_is_that_of_the_window_around_each_time() -> None:
    time = np.array([0.0, 1.0, 2.0, 3.0, 10.0], dtype=np.float32).astype(float)
    values = np.array([[1.0], [2.0], [np.nan], [8.0], [5.0]])
    np.testing.assert_allclose(sliding_mean(time, values, 2.0)[:, 0], [1.5, 1.5, 5.0, 8.0, 5.0])
    np.testing.assert_allclose(sliding_mean(time, values, 0.0), values)


def test_sliding_mean_of_late_times_is_that_of_whole_windows() -> None:
    time = np.float32(1000.0 + 0.1 * np.arange(200)).astype(float)
    value = np.arange(200.0)
    np.testing.assert_allclose(sliding_mean(time, value, 0.6)[3:-3], value[3:-3])


def test_persistence_is_that_of_lags_with_many_pairs() -> None:
    lags = np.arange(100.0)
    correlation = np.exp(-lags / 200.0)
    correlation[50:] = 0.7  # of few pairs
    assert persistence_time(lags, correlation) == pytest.approx(200.0, rel=1e-6)
