"""The example phototaxis_gradient: robots climb to the lamp, and search for it in the dark."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from light_field import Array, configuration, light_at, light_on_sensors
from running import run_shipped

NAME = "phototaxis_gradient"
CONFIG = configuration(NAME)
LAMP, ROBOTS = CONFIG["objects"]["lamp"], CONFIG["objects"]["robots"]
RADIUS_MM = ROBOTS["radius"]
SIDE_MM = 1500.0
CLIMBS = 2


@pytest.fixture(scope="module")
def rows(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run_shipped(NAME, tmp_path_factory.mktemp(NAME)).frame()


def mean_light(rows: pd.DataFrame) -> Array:
    """Light at the robots' centres as the configuration says it, mean over the swarm, one per time."""
    level = light_at(CONFIG, rows["x"], rows["y"])
    return np.asarray(pd.Series(level).groupby(rows["time"].to_numpy()).mean())


def brightest_mean() -> float:
    """Mean light of a swarm in the densest disk around the lamp: hexagonal packing covers 0.907 of the plane."""
    disk_radius_mm = RADIUS_MM * np.sqrt(ROBOTS["nb"] / 0.907)
    # The mean distance from the middle of a disk is 2/3 of its radius.
    return float(200 + LAMP["value"] * (1 - 2 / 3 * disk_radius_mm / LAMP["gradient_radius"]))


def test_phototaxis_gradient_climbs_to_most_of_the_light_there_is(rows: pd.DataFrame) -> None:
    light = mean_light(rows)
    # Anywhere at random: the lamp's cone over the arena.
    anywhere = 200 + LAMP["value"] * np.pi * LAMP["gradient_radius"] ** 2 / 3 / SIDE_MM**2
    assert light[0] == pytest.approx(anywhere, rel=0.35)
    assert light[-1] > 0.9 * brightest_mean()
    # And stays there.
    assert light[rows["time"].unique() > 60].min() > 0.9 * brightest_mean()


def test_phototaxis_gradient_robots_in_the_light_climb_and_others_search(rows: pd.DataFrame) -> None:
    x, y, angle = (rows[column].to_numpy(dtype=float) for column in ("x", "y", "angle"))
    on_sensors = light_on_sensors(CONFIG, x, y, angle, RADIUS_MM)
    climbs = rows["phase"].to_numpy() == CLIMBS
    later = rows["time"].to_numpy() > 0.1
    threshold = CONFIG["parameters"]["dark_threshold"]
    assert climbs[later & (on_sensors > threshold + 100)].mean() > 0.99
    # In the plain dark the noise, 5 / sqrt(3) for the mean of three, reaches 10 above it once in 3700 ticks.
    assert climbs[later & (on_sensors == 200)].mean() < 0.03


def test_phototaxis_gradient_robots_see_what_is_there(rows: pd.DataFrame) -> None:
    # Written down up to 20 ms after it was seen: 2 mm of a robot at full speed, at 50 counts/mm, and a cell of 15 mm.
    x, y, angle = (rows[column].to_numpy(dtype=float) for column in ("x", "y", "angle"))
    away = SIDE_MM / 2 - np.maximum(abs(x - SIDE_MM / 2), abs(y - SIDE_MM / 2)) > 2 * RADIUS_MM
    error = (rows["light"].to_numpy() - light_on_sensors(CONFIG, x, y, angle, RADIUS_MM))[away]
    assert abs(np.mean(error)) < 30
    assert np.percentile(np.abs(error), 99) < 15 * LAMP["value"] / LAMP["gradient_radius"]


def test_phototaxis_gradient_one_robot_drives_straight_at_the_lamp(tmp_path: Path) -> None:
    # Alone, 500 mm left of the lamp, with its side towards it: a quarter turn, then nearly the shortest way.
    settings = {
        "simulation_time": 6.0,
        "save_data_period": 0.1,
        "light_map_nb_bin_x": 1500,
        "light_map_nb_bin_y": 1500,
        "objects.robots.nb": 1,
        "objects.robots.x": LAMP["x"],
        "objects.robots.y": LAMP["y"] - 500.0,
        "objects.robots.photosensors_noise_stddev": 0.0,
    }
    path = run_shipped(NAME, tmp_path, settings).frame()
    assert path["angle"].iloc[0] == 0  # to the right; the lamp is below
    distance = np.hypot(path["x"] - LAMP["x"], path["y"] - LAMP["y"]).to_numpy()
    # 500 mm at 100 mm/s, and half a second for the turn.
    assert distance[path["time"] <= 5.6].min() < 15
    travelled = np.hypot(np.diff(path["x"]), np.diff(path["y"]))[: np.argmin(distance)].sum()
    assert travelled < 1.05 * (distance[0] - distance.min())


def test_phototaxis_gradient_search_alone_finds_brighter_places(tmp_path: Path) -> None:
    # Nowhere is it bright enough to climb: only longer runs uphill are left, or not even those.
    climbed = []
    for factor in (1, 4):
        settings = {
            "simulation_time": 60.0,
            "parameters.dark_threshold": 32767,
            "parameters.uphill_factor": factor,
            "parameters.run_duration_min": 300,
            "parameters.run_duration_max": 900,
            "objects.robots.nb": 120,
            "objects.robots.radius": 5.0,  # they get less in each other's way
        }
        frame = run_shipped(NAME, tmp_path / str(factor), settings).frame()
        assert (frame["phase"] != CLIMBS).all()
        climbed.append(mean_light(frame)[60:].mean())
    anywhere = 200 + LAMP["value"] * np.pi * LAMP["gradient_radius"] ** 2 / 3 / SIDE_MM**2
    # The lamp's light varies by 1.4 times its mean over the arena, and 120 robots are as many chances.
    assert climbed[0] == pytest.approx(anywhere, rel=0.25)
    assert climbed[1] > 2.5 * anywhere
