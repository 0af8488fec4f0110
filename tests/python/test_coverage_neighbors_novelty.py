"""The example coverage_neighbors_novelty: robots spread over the arena because they get bored with each other."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import ROOT, Settings, example, run, run_command

Array = npt.NDArray[np.float64]

NAME = "coverage_neighbors_novelty"
RUN, TUMBLE = 0, 1
TAU_S = 5.0
REACH_MM = 80.0 + 2 * 26.5  # between centres
SURFACE_MM2 = 2.0e6


def spread(folder: Path, *settings: str) -> pd.DataFrame:
    """Run the shipped configuration, for 120 s."""
    configuration = str(ROOT / "conf" / f"{NAME}.yaml")
    chosen = ["data_filename=data.feather", "enable_console_logging=false", f"arena_file={ROOT}/arenas/disk.csv"]
    overrides = [part for setting in (*chosen, *settings) for part in ("--set", setting)]
    result = run_command(example(NAME), folder, ["-c", configuration, "-g", "-q", *overrides])
    assert (result.code, result.errors) == (0, "")
    return result.frame()


def unevenness_and_coverage(rows: pd.DataFrame) -> tuple[float, float]:
    """Coefficient of variation of the areas of Voronoi cells, and the share of the arena within reach of a robot.

    Points on a grid of 12 mm belong to the cell of the nearest robot.
    """
    radius = np.sqrt(SURFACE_MM2 / np.pi)
    axis = np.arange(6.0, 2 * radius, 12.0)
    points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 1, 2)
    points = points[np.hypot(*(points[:, 0] - radius).T) < radius]
    distance = np.linalg.norm(points - rows[["x", "y"]].to_numpy(dtype=float), axis=2)
    area = np.bincount(distance.argmin(axis=1), minlength=len(rows))
    return float(area.std() / area.mean()), float((distance.min(axis=1) < REACH_MM).mean())


def mean_at(frame: pd.DataFrame, times: list[float]) -> Array:
    return np.asarray(np.mean([unevenness_and_coverage(frame[frame["time"] == time]) for time in times], axis=0))


@pytest.fixture(scope="module")
def novelty(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return spread(tmp_path_factory.mktemp("novelty"))


def test_coverage_robots_leave_the_wall_and_spread_evenly(novelty: pd.DataFrame) -> None:
    uneven_first, covered_first = mean_at(novelty, [0.0])
    uneven_last, covered_last = mean_at(novelty, [80.0, 90.0, 100.0, 110.0, 120.0])
    assert uneven_first > 1.0
    assert covered_first < 0.5
    assert uneven_last < 0.85 * uneven_first
    assert covered_last > 0.78


def test_coverage_robots_without_boredom_stay_where_they_are(tmp_path: Path) -> None:
    frame = spread(tmp_path, "parameters.w_nov=0.0")
    uneven_last, covered_last = mean_at(frame, [80.0, 100.0, 120.0])
    assert uneven_last > 1.0
    assert covered_last < 0.65


def test_coverage_robots_get_to_know_more_and_more_others(novelty: pd.DataFrame) -> None:
    known = novelty.pivot(index="time", columns="robot_id", values="nov_unique").to_numpy()
    assert (np.diff(known, axis=0) >= 0).all()
    assert known[0].max() == 0
    assert known[-1].min() > 5
    assert known.max() <= 99


def run_few(folder: Path, settings: Settings) -> pd.DataFrame:
    result = run(example(NAME), folder, {"initial_formation": "disk", **settings})
    assert (result.code, result.errors) == (0, "")
    return result.frame()


def test_coverage_robots_of_a_small_arena_meet_nearly_all_others_and_not_themselves(tmp_path: Path) -> None:
    settings = {"arena_surface": 1.0e5, "simulation_time": 200.0, "objects.robots.nb": 12, "save_data_period": 1.0}
    frame = run_few(tmp_path, settings)
    known = frame[frame["time"] == 200.0]["nov_unique"]
    assert known.max() == 11
    assert known.min() >= 9
    assert known.mean() > 10.3
    listed = frame[frame["neighbors_list"] != ""]
    assert len(listed) > 1000
    for robot, number, text in zip(
        listed["robot_id"], listed["total_neighbors"], listed["neighbors_list"], strict=True
    ):
        neighbors = text.split(",")
        assert len(set(neighbors)) == number
        assert str(robot) not in neighbors


def test_coverage_robot_alone_feels_isolated_with_time_constant_tau(tmp_path: Path) -> None:
    frame = run_few(tmp_path, {"objects.robots.nb": 1, "simulation_time": 7.0, "parameters.decay_tau": TAU_S})
    expected = TAU_S * (1 - np.exp(-frame["time"] / TAU_S))
    np.testing.assert_allclose(frame["iso_cnt"], expected, atol=0.03)
    np.testing.assert_allclose(frame["surprise"], 0.7 * frame["iso_cnt"], rtol=1e-5)
    assert (frame["nov_cnt"] == 0).all()


def test_coverage_robots_get_bored_when_they_have_known_all_neighbours_for_tau(tmp_path: Path) -> None:
    # Robots that cannot drive away; their first heartbeats take a fraction of a second.
    still = {"objects.robots.max_linear_speed": 0.0, "objects.robots.max_angular_speed": 0.0}
    settings = {"objects.robots.nb": 4, "simulation_time": 12.0, "communication_ignore_occlusions": True, **still}
    frame = run_few(tmp_path, settings)
    assert (frame[frame["time"] > 1]["total_neighbors"] == 3).all()
    assert (frame[frame["time"] <= TAU_S]["nov_cnt"] == 0).all()

    def bored_since(start_s: float) -> Array:
        return np.asarray(TAU_S * (1 - np.exp(-np.maximum(0, frame["time"] - start_s) / TAU_S)))

    before_escapes = frame["surprise"] < 2
    assert (frame["nov_cnt"] <= bored_since(TAU_S) + 0.03).all()
    assert (frame["nov_cnt"] >= bored_since(TAU_S + 1) - 0.03)[before_escapes].all()


@pytest.mark.parametrize(
    ("law", "longer_than_twice"), [("levy", 2**-1.5), ("exponential", np.exp(-2)), ("linear", 4.8 / 5.4)]
)
def test_coverage_runs_take_times_of_the_chosen_law(law: str, longer_than_twice: float, tmp_path: Path) -> None:
    settings = {
        "objects.robots.nb": 40,
        "simulation_time": 150.0,
        "save_data_period": 0.05,
        "parameters": {"run_law": law, "urgency_gain": 0.0, "w_iso": 0.0, "w_nov": 0.0},
    }
    state = run_few(tmp_path, settings).pivot(index="time", columns="robot_id", values="state").to_numpy()
    durations: list[float] = []
    for robot in state.T:
        starts = np.flatnonzero(np.diff(robot)) + 1
        durations += [0.05 * (b - a) for a, b in itertools.pairwise(starts) if robot[a] == RUN]
    assert len(durations) > 1000
    assert min(durations) > 0.5
    assert max(durations) < 6.1
    # From 0.6 to 6 s.
    assert np.mean(np.array(durations) > 1.2) == pytest.approx(longer_than_twice, abs=0.05)


def test_coverage_refuses_an_unknown_law(tmp_path: Path) -> None:
    result = run(example(NAME), tmp_path, {"parameters.run_law": "brownian"})
    assert result.code == 2
    assert "parameters.run_law: expected levy, exponential or linear, found 'brownian'" in result.errors
