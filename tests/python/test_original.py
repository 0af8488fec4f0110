"""conf/original.yaml: a run as with the original simulator; and robots with the chips and the battery of a real one."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from running import ROOT, Run, example, run_command

CONFIGURATION = ROOT / "conf" / "original.yaml"
PAGE = ROOT / "docs" / "original.md"


def run_with(program: str, configuration: Path, folder: Path, *settings: str) -> Run:
    """Run an example for some seconds."""
    arguments = ["-c", str(configuration), "-g", "-q", "--set", "save_video_period=-1"]
    for setting in (f"data_filename={folder / 'data.feather'}", f"console_filename={folder / 'c.txt'}", *settings):
        arguments += ["--set", setting]
    return run_command(example(program), folder, arguments)


def test_configuration_has_every_key_of_its_page() -> None:
    written = yaml.safe_load(CONFIGURATION.read_text())
    own = written | written["objects"]["robots"]
    table = PAGE.read_text().split("| what |")[1].split("\n\n")[0]
    named = dict(re.findall(r"`(\w+): ([^`]+)`", table))
    assert named.pop("radius") == "10"  # no default of a pogobot there; all configurations give it
    assert len(named) == 8
    for key, value in named.items():
        assert own[key] == yaml.safe_load(value), key


def test_run_has_the_times_of_the_original_and_warns_of_its_walls_once(tmp_path: Path) -> None:
    result = run_with("run_and_tumble", CONFIGURATION, tmp_path, "simulation_time=4.2")
    assert result.code == 0
    assert result.errors.count("walls add energy") == 1
    times = sorted(set(result.frame()["time"].round(4)))
    assert times == pytest.approx([0.0, 1.01, 2.02, 3.03, 4.04])


def test_default_keeps_its_times(tmp_path: Path) -> None:
    result = run_with("run_and_tumble", ROOT / "conf" / "simple.yaml", tmp_path, "simulation_time=3.1")
    assert sorted(set(result.frame()["time"].round(4))) == [0.0, 1.0, 2.0, 3.0]


def sensed(folder: Path, *settings: str) -> pd.DataFrame:
    """Return what robots of the example IMU have recorded."""
    folder.mkdir()
    result = run_with("IMU", ROOT / "conf" / "IMU.yaml", folder, "simulation_time=5", *settings)
    assert result.code == 0, result.text
    return result.frame()


def test_key_of_each_chip_changes_what_a_program_reads_and_not_where_robots_go(tmp_path: Path) -> None:
    plain = sensed(tmp_path / "plain")
    robot = sensed(tmp_path / "robot", "objects.robots.sensor_model=robot")
    for column in ("x", "y", "angle", "pogobot_ticks"):
        pd.testing.assert_series_equal(plain[column], robot[column])
    later = plain["time"] > 0.0
    counts = robot["gyro_z"][later] / 0.00106528
    np.testing.assert_allclose(counts, counts.round(), atol=0.02)
    assert 0.0005 < (robot["gyro_z"] - plain["gyro_z"])[later].std() < 0.003
    forward = robot["acc_forward"][later] / 0.0047886
    np.testing.assert_allclose(forward, forward.round(), atol=0.02)


def test_acceleration_of_the_original_is_ten_times_as_large_or_over(tmp_path: Path) -> None:
    ours = sensed(tmp_path / "ours")["acc_forward"].abs().max()
    original = sensed(tmp_path / "original", "objects.robots.imu_acceleration=original")["acc_forward"].abs().max()
    assert original > 5.0 * ours


def test_battery_that_empties_ends_the_program_of_its_robot(tmp_path: Path) -> None:
    battery = "objects.robots.battery={capacity_mah: 0.05, idle_ma: 60, motor_ma: 0, led_ma: 0}"  # for 3 s
    result = run_with("IMU", ROOT / "conf" / "IMU.yaml", tmp_path, "simulation_time=6", battery)
    assert result.code == 0
    assert result.errors.count("is empty: the robot is switched off") == 1
    rows = result.frame()
    ticks = rows.pivot(index="time", columns="robot_id", values="pogobot_ticks")
    late = ticks[ticks.index > 3.05]
    assert (late.iloc[-1] == late.iloc[0]).all()
    assert (ticks[ticks.index < 2.95].diff().iloc[1:] > 0).all().all()
