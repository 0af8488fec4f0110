"""The example push_sum: gossip finds the mean of all ids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import by_robot, run_shipped

Array = npt.NDArray[np.float64]

NB = 64
MEAN = (NB - 1) / 2
NEVER_LOST = {"type": "static", "rate": 1.0}
HALF_LOST = {"type": "static", "rate": 0.5}


def run(folder: Path, reception: dict[str, object], **settings: object) -> pd.DataFrame:
    folder.mkdir(exist_ok=True)
    changes = {"objects.robots.msg_success_rate": reception, **settings}
    return run_shipped("push_sum", folder, changes).frame()


@pytest.fixture(scope="module")
def grid(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("grid"), NEVER_LOST)


def test_estimates_become_the_mean_of_all_ids_on_every_robot(grid: pd.DataFrame) -> None:
    estimate = by_robot(grid, "estimate")
    np.testing.assert_array_equal(estimate[0], np.arange(NB))
    np.testing.assert_allclose(estimate[grid["time"].unique() >= 15], MEAN, rtol=0.001)


def test_sums_and_weights_are_conserved_at_all_times(grid: pd.DataFrame) -> None:
    # In single precision.
    np.testing.assert_allclose(by_robot(grid, "w_value").sum(axis=1), NB, rtol=1e-6)
    np.testing.assert_allclose(by_robot(grid, "s_value").sum(axis=1), NB * MEAN, rtol=1e-6)


def neighbors_on_grid(frame: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Robots in range of each other: on a grid of 105 mm the nearest robots, and not the next ones at 148 mm."""
    start = frame[frame["time"] == 0].sort_values("robot_id")
    place = start["x"].to_numpy() + 1j * start["y"].to_numpy()
    distance = np.abs(place[:, None] - place[None, :])
    near: npt.NDArray[np.bool_] = (distance > 0) & (distance < 110)
    return near


def test_differences_shrink_at_the_rate_of_the_network(grid: pd.DataFrame) -> None:
    # A round multiplies s and w by the matrix of shares; its second eigenvalue is the fate of the slowest pattern.
    near = neighbors_on_grid(grid)
    shares = (near + np.eye(NB)) / (near.sum(axis=0) + 1)
    expected = np.sort(np.linalg.eigvals(shares).real)[-2]
    first, last = np.searchsorted(grid["time"].unique(), [6.0, 9.0])
    spread = by_robot(grid, "estimate").std(axis=1)
    rounds = by_robot(grid, "round").mean(axis=1)
    measured = np.log(spread[last] / spread[first]) / (rounds[last] - rounds[first])
    assert measured == pytest.approx(np.log(expected), rel=0.05)


def test_rounds_come_15_times_a_second_once_the_neighbours_are_known(grid: pd.DataFrame) -> None:
    rounds = by_robot(grid, "round")
    time = grid["time"].unique()
    assert (rounds[time < 2.0] == 0).all()
    np.testing.assert_allclose(rounds[-1], (60 - 2) * 15, rtol=0.02)


def test_robots_count_their_neighbours(grid: pd.DataFrame) -> None:
    near = neighbors_on_grid(grid)
    end = grid[grid["time"] == 60]
    for robot, listed, total in zip(end["robot_id"], end["neighbors_list"], end["total_neighbors"], strict=True):
        assert {int(text) for text in listed.split(",")} == set(np.flatnonzero(near[robot]))
        assert total == near[robot].sum()


def test_half_of_the_messages_are_enough(tmp_path: Path) -> None:
    frame = run(tmp_path, HALF_LOST)
    estimate = by_robot(frame, "estimate")
    np.testing.assert_allclose(estimate[frame["time"].unique() >= 25], MEAN, rtol=0.005)


@pytest.mark.parametrize("seed", [2, 3])
def test_one_way_links_do_not_change_the_mean(tmp_path: Path, seed: int) -> None:
    # At random places in a dense swarm many robots hear others that do not hear them.
    settings: dict[str, object] = {"initial_formation": "random", "arena_surface": 5.0e5, "seed": seed}
    frame = run(tmp_path, NEVER_LOST, **settings)
    end = frame[frame["time"] == 60]
    heard = zip(end["robot_id"], end["neighbors_list"].str.split(","), strict=True)
    links = {(int(other), int(robot)) for robot, others in heard for other in others}
    assert len({(a, b) for a, b in links if (b, a) not in links}) > 5
    np.testing.assert_allclose(by_robot(frame, "w_value").sum(axis=1), NB, rtol=1e-6)
    np.testing.assert_allclose(by_robot(frame, "estimate")[-1], MEAN, rtol=0.001)


def test_robots_that_move_agree_on_about_the_mean(tmp_path: Path) -> None:
    settings: dict[str, object] = {"parameters.moving_robots": True, "save_data_period": 10}
    estimate = by_robot(run(tmp_path, NEVER_LOST, **settings), "estimate")[-1]
    assert np.median(estimate) == pytest.approx(MEAN, rel=0.1)
    assert np.quantile(estimate, 0.9) - np.quantile(estimate, 0.1) < 0.05 * MEAN
