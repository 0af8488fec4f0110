"""The example IMU, in its configuration: robots feel what their motors do to them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import Run, run_shipped

GREEN, RED = 0x00FF00, 0xFF0000
DIAMETER_MM = 53.0
SIDE_MM = 2000.0
LINE = re.compile(
    r"\[ROBOT #(\d+)\] \[PRINTF\] (RUN|TUMBLE) gyro: (\S+) (\S+) (\S+) rad/s, "
    r"acc: (\S+) (\S+) (\S+) m/s2, temperature: (\S+) C: (OK|CHECK)"
)


@pytest.fixture(scope="module")
def shipped(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run_shipped("IMU", tmp_path_factory.mktemp("IMU"))


@pytest.fixture(scope="module")
def free(shipped: Run) -> pd.DataFrame:
    """Rows of robots that touch no other and have been in their phase for a row or more."""
    rows = shipped.frame()
    led = rows.pivot(index="time", columns="robot_id", values="led_rgb").to_numpy()
    settled = np.concatenate([np.full((1, led.shape[1]), False), led[1:] == led[:-1]])
    return rows[(settled & ~touches(rows)).ravel()]


def touches(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Whether another robot is within 15 mm, so near that it may have touched this one since the row before."""
    x = rows.pivot(index="time", columns="robot_id", values="x").to_numpy(dtype=float)
    y = rows.pivot(index="time", columns="robot_id", values="y").to_numpy(dtype=float)
    dx, dy = x[:, :, None] - x[:, None, :], y[:, :, None] - y[:, None, :]
    distance = np.hypot(dx, dy)
    distance[:, np.arange(x.shape[1]), np.arange(x.shape[1])] = np.inf
    return np.asarray(distance.min(axis=2) < DIAMETER_MM + 15.0)


def test_imu_rows_come_robot_by_robot_at_each_time(shipped: Run) -> None:
    # What the other tests count on.
    rows = shipped.frame()
    assert (rows["robot_id"].to_numpy().reshape(-1, 10) == np.arange(10)).all()
    assert (np.diff(rows["time"].to_numpy()) >= 0).all()


def test_imu_gyroscope_is_still_in_runs(free: pd.DataFrame) -> None:
    runs = free[free["led_rgb"] == GREEN]
    assert len(runs) > 2000
    np.testing.assert_allclose(runs["gyro_z"], 0.0, atol=1e-5)
    np.testing.assert_allclose(runs["acc_right"], 0.0, atol=1e-3)
    np.testing.assert_allclose(runs["acc_forward"], 0.0, atol=1e-3)


def test_imu_gyroscope_shows_four_radians_a_second_to_either_side_in_tumbles(free: pd.DataFrame) -> None:
    # max_angular_speed 2, one motor alone.
    tumbles = free[free["led_rgb"] == RED]
    assert len(tumbles) > 500
    np.testing.assert_allclose(np.abs(tumbles["gyro_z"]), 4.0, atol=1e-3)
    left = (tumbles["gyro_z"] > 0).mean()
    assert 0.4 < left < 0.6


def test_imu_gyroscope_is_positive_counter_clockwise(shipped: Run) -> None:
    rows = shipped.frame()
    angle = np.unwrap(rows.pivot(index="time", columns="robot_id", values="angle").to_numpy(dtype=float), axis=0)
    gyro = rows.pivot(index="time", columns="robot_id", values="gyro_z").to_numpy()
    # In the middle of a tumble. Angles of the data file turn clockwise.
    turned = np.diff(angle, axis=0) / 0.1
    same = (np.abs(gyro[:-1] - gyro[1:]) < 1e-3) & (np.abs(gyro[1:]) > 3.9) & (np.abs(turned) > 3.9)
    assert same.sum() > 500
    # Steps of 8 ms: rows are 96 or 104 ms apart.
    np.testing.assert_allclose(turned[same], -gyro[1:][same], rtol=0.05)


def test_imu_accelerometer_shows_the_centripetal_acceleration_in_tumbles(free: pd.DataFrame) -> None:
    # v omega = 0.05 m/s * 4 rad/s, to the right of a robot that turns right.
    tumbles = free[free["led_rgb"] == RED]
    np.testing.assert_allclose(tumbles["acc_right"], -0.05 * tumbles["gyro_z"], atol=0.005)


def test_imu_thermometer_shows_the_arenas_temperature(shipped: Run) -> None:
    assert (shipped.frame()["temperature"] == 25.0).all()


def test_imu_robot_0_prints_a_verdict_at_each_change(shipped: Run) -> None:
    lines = [LINE.fullmatch(line) for line in shipped.robot_lines]
    assert len(lines) > 30
    phases = []
    for line in lines:
        assert line is not None
        robot, phase, *numbers, verdict = line.groups()
        gyro_x, gyro_y, gyro_z, _, _, acc_z, temperature = map(float, numbers)
        assert robot == "0"
        assert (gyro_x, gyro_y, acc_z, temperature) == (0.0, 0.0, 0.0, 25.0)
        assert verdict == ("OK" if (abs(gyro_z) > 2) == (phase == "TUMBLE") else "CHECK")
        phases.append(phase)
    assert phases == ["TUMBLE" if i % 2 == 0 else "RUN" for i in range(len(phases))]


def test_imu_of_a_lone_robot_is_always_ok(tmp_path: Path) -> None:
    settings = {"objects.robots.nb": 1, "simulation_time": 100.0}
    lines = [LINE.fullmatch(line) for line in run_shipped("IMU", tmp_path, settings).robot_lines]
    assert len(lines) > 60
    turns = []
    for line in lines:
        assert line is not None
        assert line.group(10) == "OK", line.string
        turns.append((line.group(2), line.group(5)))
    assert set(turns) == {("RUN", "0.00"), ("TUMBLE", "4.00"), ("TUMBLE", "-4.00")}


def test_imu_example_runs_in_the_common_configuration(tmp_path: Path) -> None:
    # 100 robots, which collide, with damping: most verdicts are good all the same.
    result = run_shipped("IMU", tmp_path, {"parameters": {}}, configuration="simple")  # those are other examples'
    verdicts = [line.rsplit(": ", 1)[1] for line in result.robot_lines]
    assert len(verdicts) >= 10
    assert verdicts.count("OK") >= 0.7 * len(verdicts)
