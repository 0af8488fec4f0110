"""The example ssr: robots measure the second eigenvalue of their graph, and tell a disk from an annulus by it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
import yaml
from running import ROOT, Run, Settings, example, run, run_command

Array = npt.NDArray[np.float64]

INIT_WALK, WALK, PRE_DIFFUSION, DIFFUSION, AVG_LAMBDA, AVG_AVG_LAMBDA, WAITING = range(1, 8)
CYAN, VIOLET = 0x000202, 0x020002
START_S = 1.0  # the flash
PERIOD_S = 0.5  # 31 ticks: every neighbour is heard in each
RADIUS_MM, REACH_MM = 26.5, 70.0
K = 20  # steps per unit of time


def links(position: Array) -> Array:
    """Adjacency matrix of robots that head to +x and do not hide each other.

    One reaches another if one of its four emitters, on the rim, is near enough to the other's border. An emitter that
    faces away is never the nearest.
    """
    emitter = RADIUS_MM * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    step = position[None, :] - position[:, None]
    distance = np.linalg.norm(step[:, :, None] - emitter, axis=3).min(axis=2)
    adjacency: Array = (distance <= REACH_MM + RADIUS_MM).astype(float)
    np.fill_diagonal(adjacency, 0)
    return adjacency


def second_eigenvalue(adjacency: Array) -> float:
    return float(np.linalg.eigvalsh(np.diag(adjacency.sum(axis=1)) - adjacency)[1])


def decay_rate(eigenvalue: float) -> float:
    """A step takes the share eigenvalue / K of a pattern; ln|s| falls by a little more than that."""
    return float(-K * np.log1p(-eigenvalue / K))


def strip_of_robots(columns: int, rows: int, jitter_mm: float) -> Array:
    shifts = np.random.default_rng(1).uniform(-jitter_mm, jitter_mm, (columns * rows, 2))
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return 300 + 85.0 * np.stack([x.ravel(), y.ravel()], axis=1) + shifts


def run_on_graph(folder: Path, position: Array, parameters: Settings, seed: int = 1) -> pd.DataFrame:
    """Run one iteration on robots that stand still and lose no message."""
    folder.mkdir(exist_ok=True)
    poses = pd.DataFrame({"x": position[:, 0], "y": position[:, 1], "theta": 0.0})
    poses.to_csv(folder / "poses.csv", index=False)
    steps = parameters.get("nb_diffusion_steps", 100)
    assert isinstance(steps, int)
    robots = {
        "nb": len(position),
        "communication_radius": REACH_MM,
        "msg_success_rate": {"type": "static", "rate": 1.0},
        "max_linear_speed": 0.0,
        "max_angular_speed": 0.0,
    }
    settings = {
        "seed": seed,
        "arena_file": "arenas/square.csv",
        "communication_ignore_occlusions": True,
        "initial_formation": "imported",
        "formation_filename": "poses.csv",
        "simulation_time": START_S + (20 + 1 + 20 + 2 * steps + 40) * PERIOD_S + 0.2,
        "save_data_period": PERIOD_S,
        "objects.light": {"type": "static_light", "geometry": "global", "value": 200, "photo_start_at": START_S},
        "parameters": {"unit_period": int(1000 * PERIOD_S), **parameters},
        **{f"objects.robots.{key}": value for key, value in robots.items()},
    }
    result = run(example("ssr"), folder, settings)
    assert (result.code, result.errors) == (0, "")
    return result.frame()


# Fits begin when other patterns than the slowest are gone; a large s leaves something to fit then.
PATIENT = {
    "nb_diffusion_steps": 300,
    "nb_burn_in_steps": 150,
    "initial_s_max_val": 1000.0,
    "diffusion_convergence_threshold": 0.0,
}

Strip = tuple[Array, pd.DataFrame]


@pytest.fixture(scope="module")
def strip(tmp_path_factory: pytest.TempPathFactory) -> Strip:
    """Two rows of six robots, out of place: an irregular graph whose slowest pattern runs along the strip."""
    position = strip_of_robots(6, 2, jitter_mm=15.0)
    return position, run_on_graph(tmp_path_factory.mktemp("strip"), position, PATIENT)


def test_ssr_hears_just_the_robots_in_reach(strip: Strip) -> None:
    position, frame = strip
    adjacency = links(position)
    assert 2 <= adjacency.sum(axis=1).min() < adjacency.sum(axis=1).max() <= 5
    heard = frame[(frame["current_behavior"] == DIFFUSION) & (frame["t"] > 0)]
    for robot, neighbors, text in zip(heard["robot_id"], heard["nb_neighbors"], heard["neighbors_list"], strict=True):
        assert sorted(map(int, text.split(","))) == list(np.flatnonzero(adjacency[robot]))
        assert neighbors == adjacency[robot].sum()


def test_ssr_goes_through_its_schedule_on_the_clock_of_each_robot(strip: Strip) -> None:
    _, frame = strip
    expected = {INIT_WALK: 20, WAITING: 1, WALK: 20, PRE_DIFFUSION: 300, DIFFUSION: 300, AVG_LAMBDA: 20}
    counts = frame.groupby(["robot_id", "current_behavior"]).size().unstack()
    for behavior, periods in expected.items():
        assert np.abs(counts[behavior] - periods).max() <= 1, behavior


def test_ssr_conserves_the_sum_of_s_where_links_go_both_ways(strip: Strip) -> None:
    position, frame = strip
    np.testing.assert_array_equal(links(position), links(position).T)
    total = frame[frame["current_behavior"] == PRE_DIFFUSION].groupby("time")["s"].sum()
    assert len(total) >= 300
    np.testing.assert_allclose(total, total.iloc[0], atol=0.01)  # of numbers of 1000 with 24 bits


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_ssr_measures_the_second_eigenvalue_of_the_laplacian(seed: int, tmp_path: Path) -> None:
    position = strip_of_robots(6, 2, jitter_mm=15.0)
    eigenvalue = second_eigenvalue(links(position))
    frame = run_on_graph(tmp_path, position, PATIENT, seed)
    own = frame[frame["current_behavior"] == AVG_LAMBDA].groupby("robot_id")["lambda"].first()
    assert own.notna().sum() >= 10
    assert own.median() == pytest.approx(decay_rate(eigenvalue), rel=0.01)

    # In the end all know it, and agree on one number.
    agreed = frame[frame["time"] == frame["time"].max()]["avg_lambda"]
    assert agreed.to_numpy() == pytest.approx(decay_rate(eigenvalue), rel=0.01)
    assert agreed.to_numpy() == pytest.approx(eigenvalue, rel=0.03)


def test_ssr_measures_2_minus_sqrt_2_on_a_path_of_four_robots_or_nothing(tmp_path: Path) -> None:
    # Where s is equal at both ends, and in the middle, there is no slow pattern to be seen: in 1 of 4 diffusions.
    measured = []
    for seed in range(8):
        frame = run_on_graph(tmp_path / str(seed), strip_of_robots(4, 1, jitter_mm=0.0), PATIENT, seed)
        measured.append(frame[frame["time"] == frame["time"].max()]["avg_lambda"])
    values = pd.concat(measured).dropna()
    assert values.to_numpy() == pytest.approx(decay_rate(2 - np.sqrt(2)), rel=0.02)
    assert 4 * 1 <= len(values) <= 4 * 7


def run_in(arena: str, seed: int, folder: Path) -> Run:
    folder.mkdir()
    configuration = yaml.safe_load((ROOT / "conf" / "ssr.yaml").read_text())
    configuration |= {"arena_file": f"arenas/{arena}.csv", "save_data_period": configuration["simulation_time"]}
    configuration |= {"save_video_period": -1, "enable_console_logging": False, "data_filename": "data.feather"}
    (folder / "ssr.yaml").write_text(yaml.safe_dump(configuration))
    return run_command(example("ssr"), folder, ["-c", "ssr.yaml", "-g", "-q", "-s", str(seed)])


@pytest.mark.parametrize(("arena", "color"), [("disk", CYAN), ("annulus", VIOLET)])
def test_ssr_recognises_the_shape_in_nine_of_ten_runs(arena: str, color: int, tmp_path: Path) -> None:
    def all_agree(seed: int) -> bool:
        result = run_in(arena, seed, tmp_path / str(seed))
        assert (result.code, result.errors) == (0, "")
        frame = result.frame()
        end = frame[frame["time"] == frame["time"].max()]
        assert len(end) == 25
        return bool((end["led_rgb"] == color).all())

    with ThreadPoolExecutor(2) as pool:
        assert sum(pool.map(all_agree, range(10))) >= 9
