"""The examples walls and avoid_walls: robots hear walls, membranes and objects."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from matplotlib.path import Path as Outline
from running import Run, run_shipped

Array = npt.NDArray[np.float64]

RADIUS = 26.5  # of a robot, mm
GREEN, RED, BLUE, YELLOW = 0x00FF00, 0xFF0000, 0x0000FF, 0xFFFF00


def robots_of(frame: pd.DataFrame) -> pd.DataFrame:
    return frame[frame["robot_category"] == "robots"]


def distance_to_disk_wall(robots: pd.DataFrame) -> Array:
    """From each robot's centre, in a disk of 1e6 mm^2 with its bounding box at the origin; mm."""
    radius = np.sqrt(1.0e6 / np.pi)
    distance: Array = radius - np.hypot(robots["x"] - radius, robots["y"] - radius).to_numpy(dtype=np.float64)
    return distance


# ---- walls ----


@pytest.fixture(scope="module")
def walls(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("walls")
    settings = {"data_logger_led": True, "simulation_time": 120}
    return run_shipped("walls", folder, settings, "walls_and_membranes")


def test_objects_have_the_ids_of_the_article(walls: Run) -> None:
    ids = walls.frame().groupby("robot_category")["robot_id"].unique()
    assert list(ids["walls"]) == [65535]
    assert list(ids["membranes"]) == [65534]
    assert sorted(ids["robots"]) == list(range(50))


def test_robots_gather_at_the_fixed_walls_and_rest_there(walls: Run) -> None:
    robots = robots_of(walls.frame())
    end = robots[robots["time"] == 120]
    resting = end[end["led_rgb"] == BLUE]
    assert len(resting) >= 40
    assert (robots[robots["time"] == 1]["led_rgb"] == BLUE).sum() < 20
    # The wall reaches an emitter on the rim within 50 mm; others push those who rest a little.
    assert np.quantile(distance_to_disk_wall(resting), 0.9) < 50 + RADIUS + 10


def test_robots_that_rest_do_not_move_unless_pushed(walls: Run) -> None:
    robots = robots_of(walls.frame())
    blue = robots.pivot(index="time", columns="robot_id", values="led_rgb") == BLUE
    stays = blue & blue.shift(1, fill_value=False)
    x, y = (robots.pivot(index="time", columns="robot_id", values=axis).diff().to_numpy() for axis in ("x", "y"))
    assert np.median(np.hypot(x, y)[stays.to_numpy()]) < 0.5  # mm in a second


def test_robots_enclosed_by_a_membrane_hear_no_wall(tmp_path: Path) -> None:
    settings = {
        "data_logger_led": True,
        "initial_formation_root_object": "membranes",
        "objects.robots.nb": 8,
        "objects.membranes.body_density": 1e6,  # too heavy to be pushed to the wall
        "objects.membranes.x": 564,
        "objects.membranes.y": 564,
        "save_data_period": 0.25,
    }
    run = run_shipped("walls", tmp_path, settings, "walls_and_membranes")
    frame = run.frame()
    robots = robots_of(frame)
    assert BLUE not in set(robots["led_rgb"])
    assert YELLOW in set(robots["led_rgb"])
    dots = frame[(frame["subpart_id"] >= 0) & (frame["time"] == frame["time"].max())]
    end = robots[robots["time"] == frame["time"].max()]
    assert Outline(dots[["x", "y"]].to_numpy()).contains_points(end[["x", "y"]].to_numpy()).all()


# ---- avoid_walls ----


def share_at_square_wall(frame: pd.DataFrame) -> float:
    """Part of the rows in which a robot is within 10 mm of a wall of the square of 1000 mm."""
    robots = robots_of(frame)
    robots = robots[robots["time"] > 5]
    gap = np.minimum.reduce([robots["x"], robots["y"], 1000 - robots["x"], 1000 - robots["y"]]) - RADIUS
    return float((gap < 10).mean())


def test_robots_keep_off_walls_that_they_hear(tmp_path: Path) -> None:
    deaf = {"objects.walls.communication_radius": 0, "objects.active_objects.communication_radius": 0}
    shares = []
    for name, settings in (("hearing", {}), ("deaf", deaf)):
        frame = run_shipped("avoid_walls", tmp_path / name, settings, "active_objects").frame()
        shares.append(share_at_square_wall(frame))
    assert shares[0] < 0.1
    assert shares[1] > 0.6


def test_passive_objects_have_rows_without_ticks(tmp_path: Path) -> None:
    frame = run_shipped("avoid_walls", tmp_path, {"simulation_time": 5}, "active_objects").frame()
    passive = frame[frame["robot_category"] == "passive_objects"]
    assert passive["pogobot_ticks"].isna().all()
    assert len(passive) == frame["time"].nunique()
