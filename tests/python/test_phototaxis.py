"""The example phototaxis, in its configuration: robots gather where it is bright."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from light_field import Array, configuration, light_at, light_on_sensors, outline_mm
from running import run_shipped

BLUE, RED = 0x0000FF, 0xFF0000
CONFIG = configuration("phototaxis")
ROBOTS = CONFIG["objects"]["robots"]
THRESHOLD = CONFIG["parameters"]["light_goal_threshold"]
# A bias up to 100 on each sensor, and noise of 50 (5 of its deviations for a mean of three).
SENSOR_ERROR = 100 + 5 * 50 / np.sqrt(3)


@pytest.fixture(scope="module")
def rows(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run_shipped("phototaxis", tmp_path_factory.mktemp("phototaxis")).frame()


def stopped(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Which robots stay; shape (times, robots)."""
    return np.asarray(rows.pivot(index="time", columns="robot_id", values="led_rgb").to_numpy() == BLUE)


def bright_share() -> float:
    """Share of the arena in which it is bright enough to stay, by Monte Carlo over the cells of the light map."""
    width, height = outline_mm(CONFIG).max(axis=0)
    x, y = np.meshgrid((np.arange(300) + 0.5) * width / 300, (np.arange(300) + 0.5) * height / 300)
    bright = np.mean(light_at(CONFIG, x, y) >= THRESHOLD) * width * height
    return float(bright / float(CONFIG["arena_surface"]))


def sensor_levels(rows: pd.DataFrame) -> Array:
    x, y, angle = (rows[column].to_numpy(dtype=float) for column in ("x", "y", "angle"))
    return light_on_sensors(CONFIG, x, y, angle, ROBOTS["radius"])


def test_phototaxis_starts_with_a_tumble(rows: pd.DataFrame) -> None:
    assert (rows[rows["time"] == 0]["led_rgb"] == RED).all()


def test_phototaxis_flash_stops_all_robots_for_its_second(rows: pd.DataFrame) -> None:
    during, before = (rows[np.isclose(rows["time"], t)] for t in (1.5, 0.5))
    assert (during["led_rgb"] == BLUE).all()
    # No light before the flash, but for the lamps without one.
    assert (before["led_rgb"] == BLUE).mean() < 0.5
    after = rows[np.isclose(rows["time"], 2.5)]
    assert (after["led_rgb"] == BLUE).mean() < 0.6


def test_phototaxis_gathers_most_robots_in_the_bright_places(rows: pd.DataFrame) -> None:
    assert bright_share() < 0.25
    share = stopped(rows).mean(axis=1)
    assert share[rows["time"].unique() < 1].max() < 0.4
    assert share[-1] > 0.9


def test_phototaxis_share_of_robots_that_stay_grows_on_average(rows: pd.DataFrame) -> None:
    share = stopped(rows)[rows["time"].unique() > 2.0].mean(axis=1)
    by_ten_seconds = share[: len(share) // 20 * 20].reshape(-1, 20).mean(axis=1)
    # In a swarm of 60 one that is pushed out again counts 0.017.
    assert np.diff(by_ten_seconds).min() > -0.02
    assert by_ten_seconds[-1] - by_ten_seconds[0] > 0.4


def test_phototaxis_robots_stay_exactly_where_it_is_bright_enough(rows: pd.DataFrame) -> None:
    later = rows[rows["time"] > 2.5]
    level, stays = sensor_levels(later), later["led_rgb"].to_numpy() == BLUE
    # Robots are written down up to 20 ms after their last tick, in which they may drive or be pushed by 2 mm.
    assert np.mean(level[stays] < THRESHOLD - SENSOR_ERROR) < 0.002
    assert np.mean(level[~stays] > THRESHOLD + SENSOR_ERROR) < 0.01
    assert stays.sum() > 10_000
    assert (~stays).sum() > 500


def test_phototaxis_robots_end_where_it_is_bright_enough(rows: pd.DataFrame) -> None:
    last = rows[rows["time"] == rows["time"].max()]
    stay = last[last["led_rgb"] == BLUE]
    assert sensor_levels(stay).min() > THRESHOLD - SENSOR_ERROR
    # Two sensors in the light of 30000 are enough, so that the middle of some bodies lies beyond a lamp's edge.
    assert np.mean(light_at(CONFIG, stay["x"], stay["y"]) > THRESHOLD - SENSOR_ERROR) > 0.8


def test_phototaxis_all_three_places_are_found(rows: pd.DataFrame) -> None:
    last = rows[(rows["time"] == rows["time"].max()) & (rows["led_rgb"] == BLUE)]
    for name in ("round_light", "square_light", "slope_light"):
        lamp = CONFIG["objects"][name]
        reach = lamp.get("radius") or np.hypot(lamp["body_width"], lamp["body_height"]) / 2
        near = np.hypot(last["x"] - lamp["x"], last["y"] - lamp["y"]) < reach
        assert near.sum() >= 5, name


def test_phototaxis_robots_that_stay_do_not_move_unless_pushed(rows: pd.DataFrame) -> None:
    stays = stopped(rows)
    x = rows.pivot(index="time", columns="robot_id", values="x").to_numpy()
    y = rows.pivot(index="time", columns="robot_id", values="y").to_numpy()
    moved_mm = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))[stays[:-1] & stays[1:]]
    assert np.mean(moved_mm < 0.1) > 0.9
