"""The example moving_oscillators: wandering robots fall into step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import ROOT, Run, example, run_command, run_shipped

Array = npt.NDArray[np.float64]
RED, BLUE = 0x190000, 0x000019
TIME_LIMIT = 300.0


def run(folder: Path, settings: dict[str, object]) -> Run:
    return run_shipped("moving_oscillators", folder, settings)


def phases(frame: pd.DataFrame) -> Array:
    """One row per time, one column per robot; rad."""
    return frame.pivot(index="time", columns="robot_id", values="theta").to_numpy(dtype=np.float64)


def order(theta: Array) -> Array:
    result: Array = np.abs(np.exp(1j * theta).mean(axis=1))
    return result


@pytest.fixture(scope="module", params=[1, 2, 4])
def swarm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    # The end comes in the middle of a save period: with a short one, the last rows are near it.
    settings: dict[str, object] = {"seed": request.param, "simulation_time": TIME_LIMIT, "save_data_period": 0.03}
    return run(tmp_path_factory.mktemp("swarm"), settings)


def test_phases_fall_into_step_and_the_run_ends(swarm: Run) -> None:
    frame = swarm.frame()
    theta = phases(frame)
    r = order(theta)
    assert r[0] < 0.4
    assert r.max() > 0.95
    assert r[-1] == pytest.approx(0.95, abs=0.03)
    assert np.mean(theta[-1] >= 0) > 0.93
    assert frame["time"].max() < TIME_LIMIT - 10


def test_the_head_shows_the_half_of_the_dial(swarm: Run) -> None:
    frame = swarm.frame()
    frame = frame[frame["time"] > 0.1]
    upper = np.sin(frame["theta"]) >= 0
    assert (frame["led_rgb"] == np.where(upper, RED, BLUE)).all()


def test_uncoupled_clocks_keep_their_own_pace(tmp_path: Path) -> None:
    settings: dict[str, object] = {
        "parameters.coupling_k": 0.0,
        "parameters.move_to_osc_gain": 0.0,
        "parameters.natural_freq_mean": 2.0,
        "parameters.natural_freq_std": 0.5,
        "simulation_time": 50.0,
    }
    frame = run(tmp_path, settings).frame()
    turned = np.unwrap(phases(frame), axis=0)
    pace = (turned[-1] - turned[0]) / 50.0
    # Even between 1.5 and 2.5 rad/s.
    assert 1.49 < pace.min() < 1.6
    assert 2.4 < pace.max() < 2.51
    assert pace.mean() == pytest.approx(2.0, abs=3 * 0.5 / np.sqrt(3 * 60))
    assert order(phases(frame)).mean() < 0.3


def test_runs_hurry_the_clock_and_tumbles_slow_it(tmp_path: Path) -> None:
    always: dict[str, object] = {
        "parameters.coupling_k": 0.0,
        "parameters.natural_freq_std": 0.0,
        "parameters.enable_locomotion_coupling": False,
        "parameters.run_duration_min": 2000,
        "parameters.run_duration_max": 2000,
        "parameters.tumble_duration_min": 500,
        "parameters.tumble_duration_max": 500,
        "simulation_time": 100.0,
    }
    turned = np.unwrap(phases(run(tmp_path, always).frame()), axis=0)
    pace = (turned[-1] - turned[0]) / 100.0
    # Four fifths of the time at 1.25 rad/s, one fifth at 0.75; phases end with the first tick of 33 ms after.
    np.testing.assert_allclose(pace, 1.15, atol=0.01)


def test_wrong_led_mode_ends_the_program_with_2(tmp_path: Path) -> None:
    arguments = ["-c", str(ROOT / "conf/moving_oscillators.yaml"), "-g", "--set", "parameters.led_mode=disco"]
    result = run_command(example("moving_oscillators"), tmp_path, arguments)
    assert result.code == 2
    assert "parameters.led_mode: expected sign, phase or period, found 'disco'" in result.errors
