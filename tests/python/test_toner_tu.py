"""The example toner_tu: velocities that obey the equation of Toner and Tu."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from running import by_robot, run_shipped

Array = npt.NDArray[np.float64]
SIDE = 1200.0  # of the periodic arena, mm
ALONE: dict[str, object] = {
    "objects.robots.communication_radius": 0.0,
    "arena_surface": 4.0e7,
    "objects.robots.nb": 300,
}


def run(folder: Path, settings: dict[str, object]) -> pd.DataFrame:
    return run_shipped("toner_tu", folder, settings).frame()


def wanted(frame: pd.DataFrame) -> npt.NDArray[np.complex128]:
    """Velocities of the equation, x + i y. Shape (times, robots)."""
    return by_robot(frame, "velocity_x") + 1j * by_robot(frame, "velocity_y")


def driven(frame: pd.DataFrame) -> npt.NDArray[np.complex128]:
    """True velocities, x + i y, from one row to the next. Shape (times - 1, robots)."""
    step = np.diff(by_robot(frame, "x") + 1j * by_robot(frame, "y"), axis=0)
    wrapped = [(part + SIDE / 2) % SIDE - SIDE / 2 for part in (step.real, step.imag)]
    return np.asarray(wrapped[0] + 1j * wrapped[1], dtype=np.complex128) / np.diff(frame["time"].unique())[:, None]


def order(velocity: npt.NDArray[np.complex128]) -> Array:
    """Length of the sum of all velocities by the sum of their lengths, at each time."""
    result: Array = np.abs(velocity.sum(axis=1)) / np.maximum(np.abs(velocity).sum(axis=1), 1e-9)
    return result


@pytest.fixture(scope="module", params=[0, 1, 2])
def flock(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return run(tmp_path_factory.mktemp("flock"), {"seed": request.param})


# ---- The flock


def test_robots_at_rest_become_a_flock(flock: pd.DataFrame) -> None:
    velocity = wanted(flock)
    assert (velocity[0] == 0).all()
    assert order(velocity)[:4].max() < 0.6
    assert order(velocity)[-120:].min() > 0.95
    assert order(driven(flock))[-120:].min() > 0.95  # not in their variables alone


@pytest.mark.parametrize("speed", [30.0, 50.0, 80.0])
def test_flock_moves_at_the_root_of_alpha_by_beta(tmp_path: Path, speed: float) -> None:
    frame = run(tmp_path, {"parameters.beta": 1.0 / speed**2, "parameters.noise": 3.0, "simulation_time": 60.0})
    late = frame["time"].unique() >= 30
    assert np.abs(wanted(frame)[late]).mean() == pytest.approx(speed, rel=0.04)
    assert np.abs(driven(frame)[late[1:]]).mean() == pytest.approx(speed, rel=0.05)


def test_order_falls_as_noise_rises(tmp_path: Path) -> None:
    orders = []
    for noise in (10.0, 40.0, 80.0, 200.0):
        frame = run(tmp_path / str(noise), {"parameters.noise": noise})
        orders.append(order(driven(frame))[-120:].mean())
    assert orders == sorted(orders, reverse=True)
    assert orders[2] < 0.35
    assert orders[3] < 0.2  # independent directions: about 1 / sqrt(100)


def test_without_alignment_there_is_no_flock(tmp_path: Path) -> None:
    frame = run(tmp_path, {"parameters.alignment": 0.0})
    assert order(wanted(frame))[-120:].mean() < 0.2
    assert np.abs(wanted(frame))[-120:].mean() == pytest.approx(50.0, rel=0.15)  # they drive, though


def test_with_negative_alpha_robots_stay_where_they_are(tmp_path: Path) -> None:
    frame = run(tmp_path, {"parameters.alpha": -1.0, "parameters.pressure": 0.0})
    assert np.abs(wanted(frame)).max() < 40
    assert order(wanted(frame))[-120:].mean() < 0.25


def test_no_direction_is_better_than_another(tmp_path: Path) -> None:
    directions = []
    for seed in range(10):
        velocity = wanted(run(tmp_path / str(seed), {"seed": seed, "simulation_time": 25.0}))
        assert order(velocity)[-1] > 0.8
        mean = velocity[-1].mean()
        directions.append(mean / np.abs(mean))
    assert np.abs(np.mean(directions)) < 0.8  # 1 chance in 600 for independent directions (Rayleigh)


def test_pressure_keeps_robots_apart(tmp_path: Path) -> None:
    flock, without = (run(tmp_path / str(pressure), {"parameters.pressure": pressure}) for pressure in (20.0, 0.0))
    assert without[without["time"] > 60]["nb_neighbors"].mean() > 1.5 * flock[flock["time"] > 60]["nb_neighbors"].mean()


def test_gyroscope_keeps_the_axes(flock: pd.DataFrame) -> None:
    start = flock[flock["time"] == 0]["angle"].iloc[0]
    assert (flock[flock["time"] == 0]["angle"] == start).all()  # put down in parallel
    error = np.angle(np.exp(1j * (flock["heading"] + start - flock["angle"])))
    assert np.quantile(np.abs(error), 0.95) < 0.15


# ---- Robots that hear no other: the equation of one velocity


def test_lone_velocity_has_the_stationary_distribution_of_the_equation(tmp_path: Path) -> None:
    # The potential -alpha v^2 / 2 + beta v^4 / 4 in two dimensions, at temperature noise^2 / 2.
    alpha, beta, noise = 1.0, 1.0e-3, 20.0
    settings = {"parameters.alpha": alpha, "parameters.beta": beta, "parameters.noise": noise, "simulation_time": 40.0}
    late = np.abs(wanted(run(tmp_path, {**ALONE, **settings}))[40:])
    v = np.linspace(0.0, 100.0, 10001)
    weight = v * np.exp(-2 * (-alpha * v**2 / 2 + beta * v**4 / 4) / noise**2)
    weight /= weight.sum()
    for power in (1, 2, 4):
        assert (late**power).mean() == pytest.approx((weight * v**power).sum(), rel=0.03), power
    for speed in (10.0, 20.0, 40.0):
        assert (late < speed).mean() == pytest.approx(weight[v < speed].sum(), abs=0.015)


def test_small_velocities_grow_at_the_rate_alpha(tmp_path: Path) -> None:
    # d <v^2> / dt = 2 alpha <v^2> + 2 noise^2
    alpha, noise = 1.5, 0.5
    settings = {"parameters.alpha": alpha, "parameters.noise": noise, "simulation_time": 2.01, "save_data_period": 0.5}
    velocity = wanted(run(tmp_path, {**ALONE, **settings}))
    for row, time_s in ((2, 1.0), (4, 2.0)):
        expected = noise**2 / alpha * (np.exp(2 * alpha * time_s) - 1)
        # The square of a velocity of two random components varies as much as it is large: 1 / sqrt(300), times 3.
        assert (np.abs(velocity[row]) ** 2).mean() == pytest.approx(expected, rel=0.2)


def test_without_noise_rest_stays(tmp_path: Path) -> None:
    frame = run(tmp_path, {**ALONE, "parameters.noise": 0.0, "simulation_time": 5.0})
    assert (wanted(frame) == 0).all()
    assert (frame.groupby("robot_id")[["x", "y", "angle"]].nunique() == 1).all(axis=None)
