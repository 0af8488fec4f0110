"""The example moving_partition: a swarm that is divided drifts apart, and becomes one again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from running import run_shipped

ROBOT_RADIUS = 26.5  # mm
HALF_LENGTH = 300.0  # of the partition, mm
HALF_THICKNESS = 35.0
MIDDLE = 650.0  # x of the partition
FLOOR = 1200.0  # y of the wall that it reaches
INVENTION_PERIOD = 100.0  # s


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    return run_shipped("moving_partition", folder, settings).frame()


def of_run(frame: pd.DataFrame) -> pd.DataFrame:
    """The columns that the supervisor writes, one row per time."""
    robots = frame[frame["robot_category"] == "robots"]
    return robots.groupby("time")[["shut", "same_within", "same_across"]].first()


@pytest.fixture(scope="module")
def shipped(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("shipped"), {"save_data_period": 0.5})


def test_partition_moves_out_and_back_at_its_speed(shipped: pd.DataFrame) -> None:
    partition = shipped[shipped["robot_category"] == "partition"].set_index("time")
    assert (partition["x"] == MIDDLE).all()
    y = partition["y"]
    assert (y.loc[:60] == 300).all()  # in its recess
    assert y.loc[:300].is_monotonic_increasing
    assert y.loc[300:].is_monotonic_decreasing
    assert set(y.loc[120:300]) == {900}  # across the room
    assert set(y.loc[316:]) == {300}  # 600 mm at 40 mm/s take 15 s
    assert np.diff(y).max() == pytest.approx(40 * 0.5, rel=0.07)  # pushing robots, not slower
    np.testing.assert_allclose(of_run(shipped)["shut"].iloc[1:], (y.iloc[1:] - 300) / 600, atol=1e-6)


def test_partition_crushes_no_robot(shipped: pd.DataFrame) -> None:
    partition = shipped[shipped["robot_category"] == "partition"].set_index("time")
    robots = shipped[shipped["robot_category"] == "robots"]
    x = robots.pivot(index="time", columns="robot_id", values="x").to_numpy()
    y = robots.pivot(index="time", columns="robot_id", values="y").to_numpy()
    front = partition["y"].to_numpy()[:, None] + HALF_LENGTH
    distance = np.hypot(np.maximum(np.abs(x - MIDDLE) - HALF_THICKNESS, 0), np.maximum(y - front, 0))
    assert distance.min() > ROBOT_RADIUS - 1
    between = np.hypot(x[:, :, None] - x[:, None], y[:, :, None] - y[:, None])
    assert between[:, ~np.eye(x.shape[1], dtype=bool)].min() > 2 * ROBOT_RADIUS - 1
    assert y.max() < FLOOR - ROBOT_RADIUS + 1
    assert y.min() > FLOOR - 600 + ROBOT_RADIUS - 1  # none in the recess


def test_no_robot_changes_sides_while_the_partition_is_shut(shipped: pd.DataFrame) -> None:
    robots = shipped[(shipped["robot_category"] == "robots") & (shipped["time"] < 300)]
    robots = robots[robots["shut"] == 1]
    is_left = robots.groupby("robot_id")["x"].agg(lambda x: (x < MIDDLE).mean())
    assert set(is_left) == {0.0, 1.0}


def test_supervisor_measures_pairs_with_the_same_word(shipped: pd.DataFrame) -> None:
    robots = shipped[(shipped["robot_category"] == "robots") & (shipped["time"] == 200)]
    word, is_left = robots["word"].to_numpy(), robots["x"].to_numpy() < MIDDLE
    same, across = word[:, None] == word[None], is_left[:, None] != is_left[None]
    pairs = np.tri(len(word), k=-1, dtype=bool)
    assert robots["same_within"].iloc[0] == pytest.approx(same[pairs & ~across].mean(), abs=0.05)
    assert robots["same_across"].iloc[0] == pytest.approx(same[pairs & across].mean(), abs=0.05)


def test_halves_drift_apart_and_become_one_again(shipped: pd.DataFrame) -> None:
    measured = of_run(shipped)
    assert measured["same_across"].iloc[1] == 1  # one word at first
    divided = measured.loc[290:300]
    assert divided["same_within"].min() > 0.8
    assert divided["same_across"].max() < 0.05
    assert measured["same_across"].iloc[-1] > 0.3


def drifting(folder: Path, seed: int, settings: dict[str, object]) -> pd.DataFrame:
    """Measures of a run of slow copying, so that many words live side by side and chance averages out."""
    slow: dict[str, object] = {
        "parameters.copy_period": 5.0,
        "parameters.invention_period": INVENTION_PERIOD,
        "objects.robots.nb": 40,
    }
    return of_run(run(folder / str(seed), {"simulation_time": 150.0, "seed": seed, **slow, **settings}))


def test_words_in_common_are_forgotten_at_twice_the_rate_of_inventions(tmp_path: Path) -> None:
    # Two robots on different sides have the same word only if neither of their words was invented since the division.
    lags = np.array([10, 20, 40, 60])  # s
    errors = []
    for seed in range(16):
        measured = drifting(tmp_path, seed, {"parameters.divide_time": 0.0})
        start = float(measured.index[measured["shut"] == 1].min()) + 1
        assert start + max(lags) < 150
        across = np.array([measured["same_across"][start + lag] for lag in lags])
        errors.append(across - measured["same_across"][start] * np.exp(-2 * lags / INVENTION_PERIOD))
    standard_error = np.std(errors, axis=0, ddof=1) / np.sqrt(len(errors))
    assert standard_error.max() < 0.1
    assert (np.abs(np.mean(errors, axis=0)) < 3.5 * standard_error).all()


def test_without_a_division_the_sides_keep_words_in_common(tmp_path: Path) -> None:
    settings: dict[str, object] = {
        "parameters.divide_time": 1.0e6,
        "parameters.rejoin_time": 1.0e6,
        "parameters.copy_period": 1.0,
        "objects.robots.communication_radius": 150.0,
    }
    undivided = [drifting(tmp_path, seed, settings) for seed in range(6)]
    assert all((measured["shut"].iloc[1:] == 0).all() for measured in undivided)
    end = np.mean([measured["same_across"].iloc[-1] for measured in undivided])
    assert end > 4 * np.exp(-2 * 150 / INVENTION_PERIOD)
