"""In a periodic arena, rows too far apart do not say which way robots went; whatever relies on that says so once."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import recordings
from batches import run_main
from pogosim.analysis.displacement import compute_msd_per_agent
from pogosim.analysis.motion import speed
from pogosim.analysis.trajectories import trajectories_of, unwrapped
from pogosim.film import command as film
from pogosim.periodic import AmbiguousStepsWarning, minimum_image, rounded_down, steps_of
from pogosim.picture.speed import OBJECT, with_speed
from pogosim.reports import command as analyze
from pogosim.swarm_picture import main as picture
from running import example, run
from swarms import metadata_of, rows_of, write_rows

SIDE_MM = 1000.0
SAYS = (
    "robots drive up to 100 mm/s (max_linear_speed), with 6 s between rows: enough to cross half of the periodic arena "
    "(500 mm), so that the shortest way to the next row need not be the one that they went. Speeds, displacements and "
    "paths may be wrong; record with a save_data_period below 5 s"
)


def drivers(period_s: float, speed_mm_s: float = 100.0, times: int = 8) -> pd.DataFrame:
    """Two robots that drive to the right all the time, in rows of a periodic square."""
    x = speed_mm_s * period_s * np.arange(times)
    place = np.stack([np.column_stack([(x + start) % SIDE_MM, x * 0.0 + 300.0]) for start in (5.0, 405.0)], axis=1)
    return rows_of(place, period_s=period_s)


def said(action: Any) -> list[str]:
    """Return the warnings of an action."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        action()
    return [str(warning.message) for warning in caught if issubclass(warning.category, AmbiguousStepsWarning)]


# ---- Analyses ----


@pytest.mark.parametrize("period_s", [0.5, 2.0, 4.5])
def test_rows_near_enough_in_time_give_the_true_speed_without_a_word(period_s: float) -> None:
    (trajectories,) = trajectories_of(drivers(period_s), metadata_of(periodic=True, max_linear_speed=100.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.allclose(speed(trajectories)[1:], 100.0)
        assert np.allclose(unwrapped(trajectories)[-1, 0], [5.0 + 7 * 100.0 * period_s, 300.0])


def test_rows_too_far_apart_are_said_with_the_period_that_would_do() -> None:
    (trajectories,) = trajectories_of(drivers(6.0), metadata_of(periodic=True, max_linear_speed=100.0))
    assert said(lambda: unwrapped(trajectories)) == [SAYS]
    assert np.allclose(speed(trajectories)[1:], 400.0 / 6.0)  # the shorter way round


def test_default_objective_of_searches_says_it() -> None:
    metadata = metadata_of(periodic=True, max_linear_speed=100.0)
    assert said(lambda: compute_msd_per_agent(drivers(6.0), metadata)) == [SAYS]


def test_robots_that_go_the_whole_way_round_between_rows_are_not_taken_for_resting_ones() -> None:
    metadata = metadata_of(periodic=True, max_linear_speed=100.0)
    (trajectories,) = trajectories_of(drivers(10.0), metadata)
    assert said(lambda: unwrapped(trajectories)) == [SAYS.replace("6 s", "10 s")]


def test_slow_robots_are_sure_as_long_as_no_other_way_is_as_fast() -> None:
    # Within 6 s they could go 600 mm; what is 60 mm away is that or 940 mm away.
    metadata = metadata_of(periodic=True, max_linear_speed=100.0)
    (trajectories,) = trajectories_of(drivers(6.0, speed_mm_s=10.0), metadata)
    assert said(lambda: unwrapped(trajectories)) == []


def test_an_arena_with_walls_has_nothing_to_say() -> None:
    (trajectories,) = trajectories_of(drivers(6.0), metadata_of(max_linear_speed=100.0))
    assert said(lambda: unwrapped(trajectories)) == []


def test_rows_that_a_robot_does_not_have_count_with_the_time_between_those_that_it_has() -> None:
    metadata = metadata_of(periodic=True, max_linear_speed=100.0)
    rows = drivers(3.0)
    (whole,) = trajectories_of(rows, metadata)
    assert said(lambda: unwrapped(whole)) == []
    (gap,) = trajectories_of(rows[~((rows["robot_id"] == 1) & (rows["time"] == 6.0))], metadata)
    assert said(lambda: unwrapped(gap)) == [SAYS]


def test_without_a_configuration_steps_of_nearly_half_the_arena_are_suspect() -> None:
    metadata = {**metadata_of(periodic=True), "configuration": {"boundary_condition": "periodic"}}
    (near,) = trajectories_of(drivers(4.0), metadata)
    assert said(lambda: unwrapped(near)) == []
    (far,) = trajectories_of(drivers(4.9), metadata)
    (text,) = said(lambda: unwrapped(far))
    assert text.startswith("robots go up to 490 mm from row to row: enough to cross half of the periodic arena")


def test_batches_of_other_speeds_are_judged_by_their_own() -> None:
    name = "objects.robots.max_linear_speed"
    rows = pd.concat([drivers(6.0, own / 2.0).assign(run=0, **{name: own}) for own in (20.0, 200.0)])
    slow, fast = trajectories_of(rows, metadata_of(periodic=True))
    assert said(lambda: unwrapped(slow)) == []
    assert "200 mm/s" in said(lambda: unwrapped(fast))[0]


# ---- One function for all ----


def test_minimum_image_is_the_shortest_and_walls_change_nothing() -> None:
    offset = np.array([[600.0, -600.0], [400.0, 100.0], [np.nan, 1.0]])
    size = np.array([1000.0, 2000.0])
    assert np.array_equal(
        minimum_image(offset, size), [[-400.0, -600.0], [400.0, 100.0], [np.nan, 1.0]], equal_nan=True
    )
    assert np.array_equal(minimum_image(offset, None), offset, equal_nan=True)


def test_steps_without_a_duration_or_a_place_are_left_out() -> None:
    size = np.array([1000.0, 1000.0])
    steps = np.array([[500.0, 0.0], [np.nan, 0.0], [500.0, 0.0]])
    assert said(lambda: steps_of(steps, np.array([0.0, 9.0, np.nan]), size, 100.0)) == []
    assert said(lambda: steps_of(steps[:0], np.zeros(0), size, 100.0)) == []
    assert said(lambda: steps_of(np.zeros((3, 2)), np.ones(3), size, None)) == []


def test_period_that_would_do_is_never_rounded_up() -> None:
    assert [rounded_down(value) for value in (5.0, 4.99, 0.0123, 1234.0, 9.99)] == [5.0, 4.9, 0.012, 1200.0, 9.9]


def test_speeds_in_pictures_come_with_the_same_warning() -> None:
    rows = drivers(6.0).rename(columns={"robot_id": OBJECT})
    size = np.array([SIDE_MM, SIDE_MM])
    assert said(lambda: with_speed(rows, size, 100.0)) == [SAYS]
    assert said(lambda: with_speed(rows, None, 100.0)) == []


# ---- Commands ----


def recorded(path: Path, period_s: float, **settings: Any) -> Path:
    """Write a data file of a run in a periodic square."""
    robots = {"type": "pogobot", "geometry": "disk", "radius": 26.5, "max_linear_speed": 100.0}
    return recordings.write(path, drivers(period_s), {"robots": robots}, boundary_condition="periodic", **settings)


@pytest.mark.parametrize("more", [["film.html"], ["film.gif", "--fps", "1", "--speed", "20", "--size", "200"]])
def test_film_says_once_that_robots_may_have_gone_another_way(more: list[str], tmp_path: Path) -> None:
    recorded(tmp_path / "data.feather", 6.0)
    result = run_main(tmp_path, ["data.feather", "-o", *more], film.main)
    assert (result.code, result.errors) == (0, f"pogosim film: warning: {SAYS}\n")
    recorded(tmp_path / "data.feather", 3.0)
    assert run_main(tmp_path, ["data.feather", "-o", *more], film.main).errors == ""


@pytest.mark.parametrize("more", [[], ["--color-by", "speed"], ["--at", "6", "12"]])
def test_picture_says_it_once_too(more: list[str], tmp_path: Path) -> None:
    recorded(tmp_path / "data.feather", 6.0)
    result = run_main(tmp_path, ["data.feather", "out.png", *more], picture)
    assert (result.code, result.errors) == (0, f"swarm_picture: warning: {SAYS}\n")


def test_analyses_of_many_runs_say_it_once(tmp_path: Path) -> None:
    rows = pd.concat([drivers(6.0).assign(run=run) for run in range(3)])
    write_rows(tmp_path / "many.feather", rows, metadata_of(periodic=True, max_linear_speed=100.0))
    result = run_main(tmp_path, ["locomotion", "-i", "many.feather", "-o", "out"], analyze.main)
    assert result.code == 0
    assert result.errors.count(f"warning: {SAYS}\n") == 1
    assert result.errors.count("AmbiguousStepsWarning") == 0


def test_a_run_says_it_before_it_begins(tmp_path: Path) -> None:
    settings = {
        "arena_file": "arenas/square.csv",
        "boundary_condition": "periodic",
        "simulation_time": 12.0,
        "save_data_period": 6.0,
        "objects.robots.max_linear_speed": 100.0,
    }
    result = run(example("helloworld"), tmp_path, settings)
    assert result.code == 0
    assert (
        "scene.yaml:5: save_data_period: within 6 s, 'robots' can cross half of the periodic arena (500 mm) at their "
        "100 mm/s (max_linear_speed): the shortest way between two rows need not be theirs, and speeds and "
        "displacements from the data file may be wrong. Use less than 5 s"
    ) in result.errors
    for change in (
        {"save_data_period": 5.0},
        {"boundary_condition": "solid"},
        {"enable_data_logging": False},
        {"data_logger_fields": ["time"]},
        {"save_data_period": -1.0},
        {"objects.robots.max_linear_speed": 50.0},
        {"simulation_time": 5.0},
    ):
        assert run(example("helloworld"), tmp_path, {**settings, **change}).errors == "", change
