"""The examples show what their first lines say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import Run, Settings, by_robot, example, run

Array = npt.NDArray[np.float64]
LARGE = 1.0e9  # mm^2, in which a few robots do not meet
GREEN = 0x00FF00
FLASH = {
    "type": "static_light",
    "geometry": "global",
    "value": 200,
    "photo_start_at": 1.0,
    "photo_start_duration": 1.0,
}


def run_example(name: str, folder: Path, settings: Settings) -> Run:
    result = run(example(name), folder, settings)
    assert (result.code, result.errors) == (0, "")
    return result


# ---- helloworld ----


@pytest.fixture(scope="module")
def hello(tmp_path_factory: pytest.TempPathFactory) -> Run:
    settings = {"arena_surface": LARGE, "simulation_time": 48.5, "objects.robots.max_angular_speed": 2.0}
    return run_example("helloworld", tmp_path_factory.mktemp("helloworld"), settings)


def test_helloworld_turns_clockwise_for_ten_seconds_then_back(hello: Run) -> None:
    frame = hello.frame()
    turned = np.unwrap(by_robot(frame, "angle"), axis=0)
    turned -= turned[0]
    time = frame["time"].unique()
    expected = 4.0 * np.interp(time, [0, 10, 20, 30, 40, 48.5], [0, 10, 0, 10, 0, 8.5])
    # The change comes with the first tick after it is due, 16 ms at most.
    np.testing.assert_allclose(turned, np.broadcast_to(expected[:, None], turned.shape), atol=4 * 0.016 * 8)
    first = turned[(time > 0) & (time <= 10)] / time[(time > 0) & (time <= 10), None]
    np.testing.assert_allclose(first, 4.0, rtol=1e-3)


def test_helloworld_drives_in_circles_of_12_5_mm(hello: Run) -> None:
    frame = hello.frame()
    frame = frame[frame["time"] <= 10]
    for column in ("x", "y"):
        path = by_robot(frame, column)
        np.testing.assert_allclose(np.ptp(path, axis=0), 25.0, atol=0.7)


def test_helloworld_greets_once_per_1000_ticks_by_robot_0_only(hello: Run) -> None:
    assert len(hello.robot_lines) == 4
    for number, line in enumerate(hello.robot_lines):
        ticks, milliseconds = 1000 * number, 16000 * number
        assert line.startswith("[ROBOT #0] [PRINTF] HELLO WORLD! I am robot 0. ")
        assert f"Time: {milliseconds} ms, " in line
        assert line.endswith(f" us, ticks: {ticks}")


# ---- run_and_tumble ----


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    settings = {
        "arena_surface": LARGE,
        "initial_formation": "random",
        "simulation_time": 300.0,
        "data_logger_led": True,
        "objects.robots.nb": 60,
        "objects.robots.max_angular_speed": 2.0,
    }
    return run_example("run_and_tumble", tmp_path_factory.mktemp("walk"), settings).frame()


def test_run_and_tumble_runs_straight_at_100_mm_per_second(walk: pd.DataFrame) -> None:
    angle, led = by_robot(walk, "angle"), by_robot(walk, "led_rgb")
    distance = np.hypot(np.diff(by_robot(walk, "x"), axis=0), np.diff(by_robot(walk, "y"), axis=0))
    running = (led[:-1] == GREEN) & (led[1:] == GREEN) & (angle[:-1] == angle[1:])
    assert running.sum() > 50_000
    # Coordinates of single precision are good to some micrometres here.
    np.testing.assert_allclose(distance[running], 10.0, atol=0.05)


def test_run_and_tumble_turns_at_4_rad_per_second_to_both_sides(walk: pd.DataFrame) -> None:
    angle, led = np.unwrap(by_robot(walk, "angle"), axis=0), by_robot(walk, "led_rgb")
    turn = np.diff(angle, axis=0)[1:-1]
    # In the middle of a tumble: red before, at and after.
    tumbling = (led[:-3] != GREEN) & (led[1:-2] != GREEN) & (led[2:-1] != GREEN) & (led[3:] != GREEN)
    whole = tumbling & (np.abs(turn) > 0.39)
    left, right = turn[whole & (turn < 0)], turn[whole & (turn > 0)]
    assert np.median(right) == pytest.approx(0.4, rel=1e-3)
    assert np.median(left) == pytest.approx(-0.4, rel=1e-3)
    assert 0.9 < len(left) / len(right) < 1.1


def test_run_and_tumble_is_ballistic_at_once_and_diffusive_in_the_long_run(walk: pd.DataFrame) -> None:
    x, y = by_robot(walk, "x"), by_robot(walk, "y")

    def exponent(first: int, last: int) -> float:
        def mean_square(lag: int) -> float:
            return float(np.mean((x[lag:] - x[:-lag]) ** 2 + (y[lag:] - y[:-lag]) ** 2))

        return float(np.log(mean_square(last) / mean_square(first)) / np.log(last / first))

    assert exponent(1, 2) == pytest.approx(2.0, abs=0.1)  # 0.1 s, of runs of 0.7 s
    assert exponent(100, 500) == pytest.approx(1.0, abs=0.1)  # 10 s to 50 s


def test_run_and_tumble_prints_its_parameters_and_its_phase(tmp_path: Path) -> None:
    parameters = {"test_vect": [10.0, 20.0, 30.0, 40.0], "run_duration_min": 100_000, "run_duration_max": 100_000}
    settings = {"simulation_time": 33.0, "parameters": {**parameters, "tumble_duration_max": 150}}
    lines = run_example("run_and_tumble", tmp_path, settings).robot_lines
    assert lines[0] == "[ROBOT #0] [PRINTF] test_vect: 10.0 20.0 30.0 40.0"
    assert len(lines) == 4
    assert lines[2:] == ["[ROBOT #0] [PRINTF] phase: RUN"] * 2


def test_run_and_tumble_drives_backwards_in_half_of_its_runs_when_asked(tmp_path: Path) -> None:
    settings = {
        "arena_surface": LARGE,
        "simulation_time": 100.0,
        "data_logger_led": True,
        "objects.robots.nb": 20,
        "parameters.enable_backward_dir": True,
    }
    frame = run_example("run_and_tumble", tmp_path, settings).frame()
    angle, led = by_robot(frame, "angle"), by_robot(frame, "led_rgb")
    dx, dy = np.diff(by_robot(frame, "x"), axis=0), np.diff(by_robot(frame, "y"), axis=0)
    running = (led[:-1] == GREEN) & (led[1:] == GREEN) & (angle[:-1] == angle[1:])
    ahead = (dx * np.cos(angle[:-1]) + dy * np.sin(angle[:-1]))[running]
    np.testing.assert_allclose(np.abs(ahead), 10.0, atol=0.05)
    assert 0.4 < np.mean(ahead > 0) < 0.6


# ---- hanabi ----

HANABI_NB = 49


@pytest.fixture(scope="module")
def fireworks(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    settings = {
        "arena_file": "arenas/square.csv",
        "initial_formation": "chessboard",  # 7 by 7, neighbours 100 mm apart: connected
        "simulation_time": 120.0,
        "objects.light": FLASH,
        "objects.robots.nb": HANABI_NB,
    }
    return run_example("hanabi", tmp_path_factory.mktemp("hanabi"), settings).frame()


def test_hanabi_writes_rows_from_the_flash_on(fireworks: pd.DataFrame) -> None:
    assert fireworks["time"].min() == pytest.approx(1.1)  # the flash comes at 1 s, after the rows of 1.0 s
    assert set(fireworks.groupby("time").size()) == {HANABI_NB}


def test_hanabi_stays_white_for_five_seconds(fireworks: pd.DataFrame) -> None:
    booting = fireworks[fireworks["time"] < 6.0]
    assert (booting["age"] == 0).all()
    assert (booting["rgb_colors_index"] == 0).all()


def test_hanabi_robots_stand_still(fireworks: pd.DataFrame) -> None:
    for column in ("x", "y", "angle"):
        assert np.ptp(by_robot(fireworks, column), axis=0).max() == 0


def test_hanabi_ages_never_decrease(fireworks: pd.DataFrame) -> None:
    ages = by_robot(fireworks, "age")
    assert np.diff(ages, axis=0).min() == 0
    assert ages[-1].max() > 10


def test_hanabi_robots_share_one_colour_soon_after_each_change(fireworks: pd.DataFrame) -> None:
    colours = by_robot(fireworks[fireworks["time"] > 7.0], "rgb_colors_index").astype(int)
    most_common = np.array([np.bincount(row).max() for row in colours])
    agreed = most_common >= 0.95 * HANABI_NB
    assert agreed.mean() > 0.8
    # Disagreement lasts as long as a wave needs: 6 hops or so of some tens of ms.
    lengths = np.diff(np.flatnonzero(np.concatenate([[True], agreed, [True]])))
    assert np.median(lengths[lengths > 1] - 1) <= 5  # in rows of 0.1 s


def test_hanabi_changes_as_often_as_chance_says(fireworks: pd.DataFrame) -> None:
    # 2 of 20000 ticks of 62.5 Hz for each robot, and 9 of 10 draws are another colour.
    ages = by_robot(fireworks, "age")
    expected = 2 / 20000 * 62.5 * HANABI_NB * 0.9 * (120.0 - 6.0)
    # A change during another one's wave adds nothing to the highest age.
    assert 0.5 * expected < ages[-1].max() < expected + 3 * np.sqrt(expected)


def test_hanabi_without_a_flash_does_nothing(tmp_path: Path) -> None:
    result = run(example("hanabi"), tmp_path, {"simulation_time": 10.0})
    assert result.code == 0
    (warning,) = result.errors.splitlines()
    assert "pogobot_photosensors_read(): there is no lamp in this world" in warning
    assert len(result.frame()) == 0


def test_hanabi_robots_move_when_asked(tmp_path: Path) -> None:
    settings = {"simulation_time": 10.0, "objects.light": FLASH, "parameters.moving_robots": True}
    frame = run_example("hanabi", tmp_path, settings).frame()
    assert np.ptp(by_robot(frame, "x"), axis=0).min() > 10
