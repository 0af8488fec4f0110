from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis.displacement import (
    compute_msd_per_agent,
    diffusion_coefficient,
    diffusion_exponent,
    mean_squared_displacement,
    squared_displacement,
)
from pogosim.analysis.trajectories import Trajectories, trajectories_of, unwrapped
from pogosim.errors import AnalysisError
from swarms import brownian_walk, metadata_of, rows_of


def run_of(rows: pd.DataFrame, **metadata: object) -> Trajectories:
    (run,) = trajectories_of(rows, {**metadata_of(), **metadata})
    return run


def line(times: int = 5, speed: float = 10.0) -> pd.DataFrame:
    """Two robots that go to the right at a speed in mm/s."""
    x = 100.0 + speed * np.arange(times)
    return rows_of(np.stack([np.column_stack([x, x * 0 + y]) for y in (100.0, 300.0)], axis=1))


def test_rows_in_any_order_are_arranged_by_time_and_robot() -> None:
    shuffled = line().sample(frac=1.0, random_state=3)
    run = run_of(shuffled)
    assert run.time_s.tolist() == [0, 1, 2, 3, 4]
    assert run.robot_id.tolist() == [0, 1]
    assert run.position_mm[:, 1].tolist() == [[100, 300], [110, 300], [120, 300], [130, 300], [140, 300]]


def test_a_robot_that_is_not_saved_at_a_time_has_no_position_then() -> None:
    run = run_of(line().drop(index=3))  # robot 1 at 1 s
    assert run.is_there.tolist() == [[True, True], [True, False], [True, True], [True, True], [True, True]]
    assert run.column("robot_id")[1].tolist()[0] == 0.0
    assert np.isnan(run.column("robot_id")[1][1])


def test_robots_reach_as_far_as_the_configuration_says() -> None:
    run = run_of(line(), **metadata_of(radius=20.0, communication_radius=60.0))
    assert run.reach_mm == 100.0
    assert run_of(line(), configuration={}).reach_mm == 80.0 + 2 * 26.5


def test_runs_of_a_batch_are_told_apart_by_run_and_columns_of_combinations() -> None:
    parts = [
        line().assign(run=run, arena_file=arena, **{"objects.robots.radius": radius})
        for arena, radius in (("disk", 20.0), ("square", 30.0))
        for run in (0, 1)
    ]
    runs = trajectories_of(pd.concat(parts), metadata_of())
    assert [(run.labels["run"], run.arena.name, run.radius_mm) for run in runs] == [
        (0, "disk", 20.0),
        (0, "square", 30.0),
        (1, "disk", 20.0),
        (1, "square", 30.0),
    ]


@pytest.mark.parametrize("columns", [["density"], "density"])
def test_columns_of_batches_of_others_tell_runs_apart(columns: object) -> None:
    rows = pd.concat([line().assign(run=0, seed=5, retry_attempt=0, density=name) for name in ("low", "high")])
    for configuration in ({"result_new_columns": columns}, {"pogobatch": {"result_new_columns": columns}}):
        metadata = {**metadata_of(), "program_version": "v0.10.10", "configuration": configuration}
        assert [run.labels for run in trajectories_of(rows, metadata)] == [
            {"run": 0, "density": "high"},
            {"run": 0, "density": "low"},
        ]


def test_each_combination_has_its_own_arena() -> None:
    rows = pd.concat([line().assign(run=0, arena_file=name) for name in ("small", "large")])
    small, large = ([[0, 0], [side, 0], [side, side], [0, side]] for side in (500.0, 2000.0))
    combinations = [
        {"columns": {"arena_file": "small"}, "arena_polygons": [small]},
        {"columns": {"arena_file": "large"}, "arena_polygons": [large]},
    ]
    metadata = {**metadata_of(), "combinations": combinations}
    areas = {run.arena.name: run.arena.area_mm2 for run in trajectories_of(rows, metadata)}
    assert areas == {"small": 500.0**2, "large": 2000.0**2}


def test_a_column_run_of_the_users_own_does_not_split_a_run() -> None:
    run = run_of(line().assign(run=[3, 4] * 5), program_version="v0.11.0")
    assert run.position_mm.shape == (5, 2, 2)


def test_runs_with_other_robots_or_other_times_are_runs_of_their_own() -> None:
    later = line().assign(run=1, time=line()["time"] + 0.5)
    others = line().assign(run=1, robot_id=line()["robot_id"] + 2)
    for second in (later, others):
        runs = trajectories_of(pd.concat([line().assign(run=0), second]), metadata_of())
        assert [run.position_mm.shape for run in runs] == [(5, 2, 2)] * 2
        batch = {**metadata_of(), "program_version": "v0.11.0", "files": ["a", "b"]}
        assert len(trajectories_of(pd.concat([line().assign(run=0), second]), batch)) == 2


def test_two_rows_of_a_robot_at_one_time_are_refused() -> None:
    with pytest.raises(AnalysisError, match="several rows of robots 0 at 0 s"):
        trajectories_of(pd.concat([line(), line()]), metadata_of())


def test_missing_and_wrong_columns_are_named() -> None:
    with pytest.raises(AnalysisError, match="no column y; it has time, robot_category, robot_id, x, angle"):
        trajectories_of(line().drop(columns="y"))
    with pytest.raises(AnalysisError, match=r"its column x holds .*, not numbers"):
        trajectories_of(line().assign(x="left"))
    with pytest.raises(AnalysisError, match="no row with a time and a position"):
        trajectories_of(line().assign(x=np.nan))
    with pytest.raises(AnalysisError, match="no rows of the category 'boxes'; it has robots"):
        trajectories_of(line(), category="boxes")
    with pytest.raises(AnalysisError, match="no column heard"):
        run_of(line()).column("heard")


def test_robots_are_analysed_and_not_what_lies_around() -> None:
    boxes = line().assign(robot_category="boxes")
    assert set(run_of(pd.concat([boxes, line()])).category) == {"robots"}
    other = pd.concat([boxes, line().assign(robot_category="bots")])
    objects = {"boxes": {"type": "passive_object"}, "bots": {"type": "pogobot"}}
    assert set(run_of(other, configuration={"objects": objects}).category) == {"bots"}


def test_parts_of_membranes_are_left_out() -> None:
    parts = line().assign(subpart_id=1)
    assert run_of(pd.concat([line().assign(subpart_id=-1), parts])).position_mm.shape == (5, 2, 2)


def test_a_robot_that_goes_round_a_periodic_arena_goes_straight_on_when_unwrapped() -> None:
    x = 30.0 * np.arange(100)
    straight = np.stack([np.column_stack([x, 500.0 - x])], axis=1)
    run = run_of(rows_of(straight % 100.0), **metadata_of(100.0, periodic=True))
    path = unwrapped(run)
    np.testing.assert_allclose(path - path[0], straight - straight[0], atol=1e-9)


def test_unwrapping_goes_on_after_a_gap() -> None:
    x = 20.0 * np.arange(10)
    rows = rows_of(np.stack([np.column_stack([x % 100.0, 0 * x])], axis=1)).drop(index=[0, 5])
    path = unwrapped(run_of(rows, **metadata_of(100.0, periodic=True)))[:, 0, 0]
    np.testing.assert_allclose(path, [20, 40, 60, 80, 120, 140, 160, 180])


def test_walls_leave_positions_as_they_are() -> None:
    rows = rows_of(np.array([[[5.0, 5.0]], [[95.0, 5.0]]]))
    assert unwrapped(run_of(rows, **metadata_of(100.0))).ravel().tolist() == [5, 5, 95, 5]


def test_msd_by_fourier_transform_is_the_mean_over_all_pairs_of_times() -> None:
    position = np.random.default_rng(2).uniform(0.0, 1000.0, (30, 4, 2))
    rows = rows_of(position, period_s=0.5).drop(index=[7, 8, 30, 31, 32, 33])
    run = run_of(rows)
    lags, msd = mean_squared_displacement(run)
    position = run.position_mm
    for lag in range(len(run.time_s)):
        steps = position[lag:] - position[: len(position) - lag]
        expected = np.nanmean((steps**2).sum(axis=2))
        assert msd[lag] == pytest.approx(expected, rel=1e-9, abs=1e-6)
    np.testing.assert_allclose(lags, 0.5 * np.arange(30))


def test_msd_of_a_straight_run_is_speed_times_lag_squared() -> None:
    lags, msd = mean_squared_displacement(run_of(line(times=50, speed=12.0)))
    np.testing.assert_allclose(msd, (12.0 * lags) ** 2, atol=1e-6)
    assert diffusion_exponent(lags, msd) == pytest.approx(2.0)


def test_msd_of_a_brownian_walk_is_4_d_lag() -> None:
    # Steps of standard deviation s each second: D = s^2 / 2.
    run = run_of(rows_of(brownian_walk(2000, 100, step_mm=3.0)))
    lags, msd = mean_squared_displacement(run)
    assert diffusion_coefficient(lags[:20], msd[:20]) == pytest.approx(4.5, rel=0.02)
    assert diffusion_exponent(lags[:20], msd[:20]) == pytest.approx(1.0, abs=0.02)


def test_msd_does_not_see_periodic_borders() -> None:
    position = brownian_walk(500, 20, step_mm=5.0)
    free = mean_squared_displacement(run_of(rows_of(position)))[1]
    wrapped = run_of(rows_of(position % 200.0), **metadata_of(200.0, periodic=True))
    np.testing.assert_allclose(mean_squared_displacement(wrapped)[1], free, rtol=1e-6, atol=1e-6)


def test_unevenly_spaced_times_are_refused() -> None:
    rows = line()
    with pytest.raises(AnalysisError, match=r"not evenly spaced: 0\.7 s to 1\.3 s"):
        mean_squared_displacement(run_of(rows.assign(time=rows["time"].replace(2.0, 2.3))))


def test_displacement_counts_from_the_first_position_of_each_robot() -> None:
    run = run_of(line().drop(index=1))  # robot 1 at 0 s
    assert squared_displacement(run)[:, 0].tolist() == [0, 100, 400, 900, 1600]
    np.testing.assert_array_equal(squared_displacement(run)[:, 1], [np.nan, 0, 100, 400, 900])


def test_msd_per_agent_is_the_mean_after_the_first_position() -> None:
    table = compute_msd_per_agent(line(times=4).assign(run=2, arena_file="disk"), metadata_of())
    assert table["MSD"].tolist() == [pytest.approx((100 + 400 + 900) / 3)] * 2
    assert table[["run", "arena_file", "robot_id"]].iloc[1].tolist() == [2, "disk", 1]
    assert compute_msd_per_agent(line(times=1), metadata_of()).empty
    assert compute_msd_per_agent(line()[:0]).empty


def test_a_users_column_with_a_dot_in_its_name_does_not_cut_runs_to_pieces() -> None:
    rows = pd.concat([line().assign(run=run, **{"imu.gyro": [0.0, 1.0] * 5}) for run in (0, 1)])
    runs = trajectories_of(rows, metadata_of())
    assert [run.position_mm.shape for run in runs] == [(5, 2, 2)] * 2


def test_arenas_of_one_name_and_different_sizes_are_told_apart() -> None:
    rows = pd.concat([line().assign(run=0, arena_surface=side) for side in (500.0, 2000.0)])
    combinations = [
        {"columns": {"arena_surface": side}, "arena_polygons": [[[0, 0], [side, 0], [side, side], [0, side]]]}
        for side in (500.0, 2000.0)
    ]
    runs = trajectories_of(rows, {**metadata_of(), "combinations": combinations})
    assert [(run.arena.name, run.arena.area_mm2) for run in runs] == [("square", 500.0**2), ("square_2", 2000.0**2)]


def test_what_a_run_came_to_counts_more_than_what_was_written() -> None:
    resolved = metadata_of(radius=30.0, communication_radius=50.0)["configuration"]
    assert run_of(line(), **metadata_of(), resolved_configuration=resolved).reach_mm == 110.0
