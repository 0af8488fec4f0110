"""The example active_brownian_particles: its mean squared displacement has the closed form of the literature."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from light_field import configuration
from running import by_robot, run_shipped

Array = npt.NDArray[np.float64]

NAME = "active_brownian_particles"
CONFIG = configuration(NAME)
PARAMETERS = CONFIG["parameters"]
D_R = PARAMETERS["rotational_diffusion"]
SPEED_MM_S = PARAMETERS["max_linear_speed"] / 2
RADIUS_MM = CONFIG["objects"]["robots"]["radius"]
SIDE_MM = 20_000.0
PERIOD_S = 0.08  # between rows: 5 ticks of 16 ms
SWIMS, REVERSES, SPINS = 0, 1, 2


def free_robots(max_angular_speed: float) -> dict[str, object]:
    """Settings for 300 robots in a periodic arena so wide that they hardly meet, without damping or noise."""
    return {
        "arena_file": "arenas/square.csv",
        "arena_surface": SIDE_MM**2,
        "boundary_condition": "periodic",
        "simulation_time": 60.0,
        "save_data_period": PERIOD_S,
        "objects.robots.nb": 300,
        "objects.robots.max_angular_speed": max_angular_speed,
        "parameters.max_angular_speed": max_angular_speed,
    }


def mean_squared_displacement(x: Array, y: Array, lag: int) -> float:
    """Mean over robots and starting times, mm^2."""
    return float(np.mean((x[lag:] - x[:-lag]) ** 2 + (y[lag:] - y[:-lag]) ** 2))


def closed_form(time_s: float) -> float:
    """Mean squared displacement of an active Brownian particle in the plane, mm^2 (Howse et al. 2007)."""
    return float(2 * SPEED_MM_S**2 / D_R**2 * (D_R * time_s - 1 + np.exp(-D_R * time_s)))


# The robot of the configuration holds each turn for 11 ticks; one that turns four times as fast needs a single tick.
@pytest.mark.parametrize(("max_angular_speed", "tolerance"), [(2.0, 0.1), (8.0, 0.05)])
def test_displacement_of_free_particles_has_the_closed_form(
    tmp_path: Path, max_angular_speed: float, tolerance: float
) -> None:
    frame = run_shipped(NAME, tmp_path, free_robots(max_angular_speed)).frame()
    assert (frame["phase"] == SWIMS).mean() > 0.998  # two meet now and then
    x, y = (np.unwrap(by_robot(frame, column), period=SIDE_MM, axis=0) for column in ("x", "y"))
    # From ballistic (0.11 times 1 / D_r) over the bend to diffusive (14 times).
    for lag in (1, 2, 4, 8, 16, 32, 64, 125):
        measured = mean_squared_displacement(x, y, lag)
        assert measured == pytest.approx(closed_form(lag * PERIOD_S), rel=tolerance), f"{lag * PERIOD_S} s"


def test_heading_forgets_itself_at_the_rate_of_rotational_diffusion(tmp_path: Path) -> None:
    heading = by_robot(run_shipped(NAME, tmp_path, free_robots(8.0)).frame(), "angle")
    for lag in (2, 5, 10, 15):
        memory = np.mean(np.cos(heading[lag:] - heading[:-lag]))
        assert memory == pytest.approx(np.exp(-D_R * lag * PERIOD_S), abs=0.02)


@pytest.fixture(scope="module")
def dish(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    """The configuration as it is: 50 robots in a round dish."""
    return run_shipped(NAME, tmp_path_factory.mktemp(NAME)).frame()


def at_the_wall(frame: pd.DataFrame) -> float:
    """Share of robots within 3 mm of the dish's wall, in the second half of the run."""
    dish_radius_mm = np.sqrt(1.0e6 / np.pi)
    later = frame[frame["time"] > frame["time"].max() / 2]
    distance = np.hypot(later["x"] - dish_radius_mm, later["y"] - dish_radius_mm)
    return float(np.mean(distance > dish_radius_mm - RADIUS_MM - 3.0))


def test_particles_that_swim_free_keep_their_speed(dish: pd.DataFrame) -> None:
    x, y = by_robot(dish, "x"), by_robot(dish, "y")
    speed = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)) / 0.16
    # An arc of 0.7 rad at most is nearly as long as its chord.
    assert np.mean((speed > 0.97 * SPEED_MM_S) & (speed < 1.01 * SPEED_MM_S)) > 0.5


def test_imu_tells_a_robot_how_fast_it_swims(dish: pd.DataFrame) -> None:
    x, y = by_robot(dish, "x"), by_robot(dish, "y")
    felt_mm_s = 1000.0 * by_robot(dish, "velocity_forward")[1:-1]
    swims = by_robot(dish, "phase") == SWIMS
    fast = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)) / 0.16 > 0.97 * SPEED_MM_S
    free = swims[:-2] & swims[1:-1] & swims[2:] & fast[:-1] & fast[1:]
    assert free.sum() > 5000
    low, middle, high = np.percentile(felt_mm_s[free], [10, 50, 90])
    assert middle == pytest.approx(SPEED_MM_S, rel=0.03)
    assert high - low < 0.2 * SPEED_MM_S


def test_robots_that_say_they_are_stuck_were_slow(dish: pd.DataFrame) -> None:
    x, y, angle, phase = (by_robot(dish, column) for column in ("x", "y", "angle", "phase"))
    ahead_mm_s = (np.diff(x, axis=0) * np.cos(angle[:-1]) + np.diff(y, axis=0) * np.sin(angle[:-1])) / 0.16
    # Means of 0.32 s of swimming; those that are followed by a call for reverse, and all.
    before = (ahead_mm_s[:-2] + ahead_mm_s[1:-1]) / 2
    swims = (phase[:-3] == SWIMS) & (phase[1:-2] == SWIMS) & (phase[2:-1] == SWIMS)
    calls = swims & (phase[3:] == REVERSES)
    assert calls.sum() > 100
    assert np.mean(before[calls] < 0.5 * SPEED_MM_S) > 0.8
    assert np.mean(before[swims] < 0.5 * SPEED_MM_S) < 0.2


def test_stuck_particles_reverse_then_spin_then_swim_on(dish: pd.DataFrame) -> None:
    phase = by_robot(dish, "phase")
    pairs = zip(phase[:-1].ravel(), phase[1:].ravel(), strict=True)
    changes = {(int(a), int(b)) for a, b in pairs if a != b}
    # A spin of 0.1 s may begin and end between two rows.
    assert {(SWIMS, REVERSES), (REVERSES, SPINS), (SPINS, SWIMS)} <= changes
    assert (SWIMS, SPINS) not in changes
    assert (SPINS, REVERSES) not in changes


def test_reversing_robots_drive_backwards_and_spinning_ones_on_the_spot(dish: pd.DataFrame) -> None:
    phase, angle = by_robot(dish, "phase"), by_robot(dish, "angle")
    dx, dy = np.diff(by_robot(dish, "x"), axis=0), np.diff(by_robot(dish, "y"), axis=0)
    ahead_mm_s = (dx * np.cos(angle[:-1]) + dy * np.sin(angle[:-1])) / 0.16
    both = phase[:-1] == phase[1:]
    assert np.median(ahead_mm_s[both & (phase[1:] == REVERSES)]) == pytest.approx(-SPEED_MM_S, rel=0.02)
    spins = both & (phase[1:] == SPINS)
    assert np.median(np.abs(ahead_mm_s[spins])) < 1.0
    turned = (np.diff(angle, axis=0)[spins] + np.pi) % (2 * np.pi) - np.pi
    # 4 times max_angular_speed.
    assert np.median(np.abs(turned)) / 0.16 == pytest.approx(8.0, rel=0.02)


def test_stuck_detection_brings_particles_away_from_the_wall(dish: pd.DataFrame, tmp_path: Path) -> None:
    never = run_shipped(NAME, tmp_path, {"parameters.stuck_duration": 1_000_000}).frame()
    assert (never["phase"] == SWIMS).all()
    assert at_the_wall(dish) < 0.6 * at_the_wall(never)


def test_no_robot_stays_stuck(dish: pd.DataFrame) -> None:
    x, y = by_robot(dish, "x"), by_robot(dish, "y")
    # Within 5 s (31 rows) each robot gets somewhere; free ones swim 250 mm.
    window = 31
    spans = [
        np.hypot(np.ptp(x[i : i + window], axis=0), np.ptp(y[i : i + window], axis=0))
        for i in range(0, len(x) - window, window)
    ]
    assert np.quantile(spans, 0.01) > RADIUS_MM
    assert np.min(spans) > RADIUS_MM / 2
