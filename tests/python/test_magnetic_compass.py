"""The examples magnetic_compass and magnetic_vicsek: sensors are calibrated, flash keeps that, robots drive by it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import PROGRAMS, ROOT, Run, by_robot, compile_program, order, run, run_shipped

Array = npt.NDArray[np.float64]
CALIBRATING, CALIBRATED, NO_ELLIPSE, DRIVING = range(4)
# Sensors whose readings lie on an ellipse but for noise: their model without its distortion.
CENTRE, MAJOR, MINOR, NOISE = (400.0, 380.0), 180.0, 120.0, 3.0
PLAIN: dict[str, object] = {
    "magnetometer.robot_variation": {"noise_stddev": {"x": [NOISE], "y": [NOISE], "z": [NOISE]}},
    "magnetometer.procedural.ellipse.center": {"x": [CENTRE[0]], "y": [CENTRE[1]], "z": [0.0]},
    "magnetometer.procedural.ellipse.major_radius": [MAJOR],
    "magnetometer.procedural.ellipse.minor_radius": [MINOR],
    "magnetometer.procedural.distortion_harmonics": [],
}
RADIUS = 26.5  # mm, of a robot


def drive(name: str, folder: Path, settings: dict[str, object]) -> Run:
    """Run an example that reads and writes the flash file of this folder."""
    flash = str(folder / "robots.flash")
    return run_shipped(name, folder, {"flash_state.input_file": flash, "flash_state.output_file": flash, **settings})


def wrapped(angle: npt.ArrayLike) -> Array:
    result: Array = np.angle(np.exp(1j * np.asarray(angle)))
    return result


def deviations(frame: pd.DataFrame, start_s: float) -> Array:
    """How far each robot is off the straight line that it began at a time, at most, in mm.

    The line leads through its places at that time and two seconds later.
    """
    frame = frame[frame["time"] >= start_s - 1e-6]
    x, y = by_robot(frame, "x"), by_robot(frame, "y")
    times = frame["time"].unique()
    ahead = int(np.argmin(np.abs(times - times[0] - 2.0)))
    direction = np.stack([x[ahead] - x[0], y[ahead] - y[0]]) / np.hypot(x[ahead] - x[0], y[ahead] - y[0])
    result: Array = np.abs((x - x[0]) * direction[1] - (y - y[0]) * direction[0]).max(axis=0)
    return result


# ---- The fit


def test_fit_recovers_ellipses_of_every_place_shape_and_sense(tmp_path: Path) -> None:
    program = compile_program(
        tmp_path / "fit",
        PROGRAMS / "compass_fit.c",
        flags=["-Wall", "-Wextra", "-Werror", f"-I{ROOT / 'examples' / 'magnetic_compass'}", "-std=gnu11"],
    )
    result = run(program, tmp_path, {"objects.robots.nb": 1, "simulation_time": 0.1})
    said = [[float(word) for word in line.split("[PRINTF] ")[1].split()] for line in result.robot_lines]
    truth = [
        (0, 0, 160, 140, 1),
        (425, 425, 160, 140, -1),
        (-3000, 8000, 300, 100, -1),
        (50, -20, 200, 200, 1),
        (425, 300, 170, 120, -1),  # of half a turn
    ]
    assert len(said) == len(truth) + 1
    for (found, *values, worst), expected in zip(said, truth, strict=False):
        assert found == 1
        np.testing.assert_allclose(values, expected, atol=0.5)  # readings are whole numbers
        assert worst < 0.02 * 160 / expected[3]
    assert said[-1][0] == 0  # a robot that has not turned finds none


# ---- Calibration


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[pd.DataFrame]:
    """Three runs with plain sensors and one flash file: calibrating, driving by compass, driving without it."""
    folder = tmp_path_factory.mktemp("runs")
    settings: list[dict[str, object]] = [{}, {"parameters.course": 0.5}, {"parameters.use_compass": False}]
    return [drive("magnetic_compass", folder, {**PLAIN, "arena_surface": 1.0e8, **extra}).frame() for extra in settings]


def test_robots_with_blank_flash_turn_and_find_the_ellipse(runs: list[pd.DataFrame]) -> None:
    frame = runs[0]
    turning = frame[(frame["time"] > 0.1) & (frame["time"] < 9.9)]
    assert (turning["phase"] == CALIBRATING).all()
    assert (frame[frame["time"] > 10.1]["phase"] == CALIBRATED).all()
    end = frame[frame["time"] == frame["time"].max()]
    # The mean of N readings is as good as noise / sqrt(N), the centre of an ellipse as that times the root of 2: the
    # largest of 10 robots' errors is hardly ever above four times as much.
    error = NOISE * np.sqrt(2 / 600)
    for column, true in (
        ("centre_x", CENTRE[0]),
        ("centre_y", CENTRE[1]),
        ("major_radius", MAJOR),
        ("minor_radius", MINOR),
    ):
        assert np.abs(end[column] - true).max() < 4 * error, column
        assert end[column].std() > error / 4  # they do not know it, they measure it


def test_robots_stay_about_where_they_are_while_they_calibrate(runs: list[pd.DataFrame]) -> None:
    for column in ("x", "y"):
        assert np.ptp(by_robot(runs[0], column), axis=0).max() < 2 * RADIUS


def test_next_run_begins_with_the_ellipse_of_the_last_one(runs: list[pd.DataFrame]) -> None:
    columns = ["centre_x", "centre_y", "major_radius", "minor_radius"]
    calibrated = runs[0][runs[0]["time"] == runs[0]["time"].max()].set_index("robot_id")
    for later in runs[1:]:
        assert (later[later["time"] > 0]["phase"] == DRIVING).all()
        first = later[later["time"] == later["time"].unique()[1]].set_index("robot_id")
        assert (first[columns] == calibrated[columns]).all(axis=None)


def test_headings_are_as_good_as_the_noise_allows(runs: list[pd.DataFrame]) -> None:
    # A reading is off by noise / R along the major axis and noise / r along the minor one, on a unit circle.
    frame = runs[1][runs[1]["time"] > 5.0]
    error = wrapped(frame["heading"] - frame["angle"])
    phi = -frame["angle"]
    expected = NOISE * np.sqrt(np.mean((np.sin(phi) / MAJOR) ** 2 + (np.cos(phi) / MINOR) ** 2))
    assert np.sqrt(np.mean(error**2)) == pytest.approx(expected, rel=0.1)
    assert abs(error.mean()) < 0.2 * expected


def test_calibrated_robots_hold_their_course(runs: list[pd.DataFrame]) -> None:
    frame = runs[1][runs[1]["time"] > 10.0]
    mean = frame.groupby("robot_id")["angle"].mean()
    np.testing.assert_allclose(mean, 0.5, atol=0.02)


def test_calibrated_robots_drive_straighter_than_others_by_a_factor_of_fifty(runs: list[pd.DataFrame]) -> None:
    # One motor is up to a tenth stronger than the other: without a compass robots drive in circles.
    by_compass, without = (deviations(frame, 8.0) for frame in runs[1:])
    assert np.median(without) > 50 * np.median(by_compass)
    assert by_compass.max() < RADIUS


# ---- What can be missing


def test_robots_without_a_magnetometer_say_so_and_keep_nothing(tmp_path: Path) -> None:
    settings: dict[str, object] = {"objects.robots.magnetometer_enabled": False}
    for _ in range(2):
        result = drive("magnetic_compass", tmp_path, settings)
        end = result.frame().groupby("robot_id")["phase"].last()
        assert (end == NO_ELLIPSE).all()
        said = [line for line in result.robot_lines if "no ellipse in 0 readings" in line]
        assert len(said) == 10


def test_robots_that_do_not_turn_find_no_ellipse(tmp_path: Path) -> None:
    settings: dict[str, object] = {"objects.robots.max_angular_speed": 0.0, "objects.robots.max_linear_speed": 0.0}
    settings["objects.robots.angular_systematic_bias_domain"] = [0, 0]
    result = drive("magnetic_compass", tmp_path, settings)
    assert (result.frame().groupby("robot_id")["phase"].last() == NO_ELLIPSE).all()
    assert re.search(r"no ellipse in 6\d\d readings", result.text)


# ---- A flock by compass


@pytest.fixture(scope="module")
def flocks(tmp_path_factory: pytest.TempPathFactory) -> list[pd.DataFrame]:
    """Two runs with one flash file, with the shipped sensors, which differ and whose curves are distorted."""
    folder = tmp_path_factory.mktemp("flocks")
    return [drive("magnetic_vicsek", folder, {"seed": 1}).frame() for _ in range(2)]


def test_flock_calibrates_in_the_first_run_only(flocks: list[pd.DataFrame]) -> None:
    first, second = flocks
    assert not first[first["time"] < 9.9]["is_calibrated"].any()
    assert first[first["time"] > 40]["is_calibrated"].all()
    assert second[second["time"] > 0]["is_calibrated"].all()


def test_robots_flock_by_their_compasses(flocks: list[pd.DataFrame]) -> None:
    for frame in flocks:
        assert order(frame)[0] < 0.3
        assert order(frame)[frame["time"].unique() >= 90].min() > 0.9


def test_compasses_of_all_robots_agree_though_their_sensors_differ(flocks: list[pd.DataFrame]) -> None:
    frame = flocks[1][flocks[1]["time"] > 0]
    error = np.abs(wrapped(frame["heading"] - frame["angle"]))
    assert np.median(error) < 0.1
    assert np.quantile(error, 0.99) < 0.25


def test_robots_do_not_flock_by_compass_at_high_noise(tmp_path: Path) -> None:
    frame = drive("magnetic_vicsek", tmp_path, {"parameters.noise_eta": 6.0}).frame()
    assert order(frame)[frame["time"].unique() >= 60].mean() < 0.25
