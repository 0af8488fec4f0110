"""Positions far away, alone or all at one place: every analysis and picture does a bounded amount of work."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from in_process import pogosim
from matplotlib.figure import Figure
from pogosim.analysis.arena import Arena
from pogosim.analysis.density import count_density, kernel_density
from pogosim.analysis.trajectories import trajectories_of
from pogosim.far_away import FARTHEST_MM
from pogosim.picture.swarm import read_recording
from pogosim.reports.command import ANALYSES
from scipy import ndimage
from swarms import metadata_of, rows_of, square, write_rows

Floats = npt.NDArray[np.float64]
SQUARE = Arena("square", [np.array([[p["x"], p["y"]] for p in square(1000.0)])])
PERIODIC = Arena("square", SQUARE.polygons, is_periodic=True)


def swarm(times: int = 4, robots: int = 20) -> Floats:
    """Robots that hardly move, shape (times, robots, 2)."""
    random = np.random.default_rng(1)
    return random.uniform(50.0, 950.0, (1, robots, 2)) + np.cumsum(random.normal(0.0, 5.0, (times, robots, 2)), axis=0)


def with_one_at(place_mm: float) -> Floats:
    positions = swarm()
    positions[:, 0] = place_mm
    return positions


@pytest.fixture
def largest_kernel(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of bins that kernels go to each side."""
    radii: list[int] = []
    real = ndimage.gaussian_filter

    def watched(values: Floats, sigma: Floats, *, radius: Any = None, **options: Any) -> Floats:
        radii.append(int(np.max(np.ceil(4.0 * np.asarray(sigma)) if radius is None else radius)))
        return np.asarray(real(values, sigma, radius=radius, **options))

    monkeypatch.setattr(ndimage, "gaussian_filter", watched)
    return radii


@pytest.mark.parametrize("arena", [SQUARE, PERIODIC, Arena()], ids=["walls", "periodic", "unknown"])
@pytest.mark.parametrize("place_mm", [1e4, 1e6, FARTHEST_MM])
def test_kernels_are_not_wider_than_a_few_grids(arena: Arena, place_mm: float, largest_kernel: list[int]) -> None:
    points = np.concatenate([swarm(1, 80)[0], [[place_mm, 500.0]]])
    grid = kernel_density(arena, points)
    assert np.isfinite(grid.probability_per_m2).any()
    kernel_density(arena, points, bandwidth_mm=1e9)
    assert max(largest_kernel) <= 4 * 200


def test_robots_outside_of_the_arena_do_not_change_the_density_inside() -> None:
    points = swarm(1, 80)[0]
    alone = kernel_density(SQUARE, points)
    with_far = kernel_density(SQUARE, np.concatenate([points, [[1e6, 500.0], [-1e6, 1e6]]]))
    assert np.array_equal(alone.probability_per_m2, with_far.probability_per_m2)


def test_wide_kernels_are_flat_and_integrate_to_one() -> None:
    for arena in (SQUARE, PERIODIC):
        density = kernel_density(arena, swarm(1, 80)[0], bandwidth_mm=1e8).probability_per_m2
        assert density == pytest.approx(np.ones_like(density), rel=1e-3)


def test_arena_without_a_robot_in_it_has_no_density() -> None:
    far = np.full((5, 2), 1e5)
    assert np.isnan(kernel_density(SQUARE, far).probability_per_m2).all()
    assert not np.nan_to_num(count_density(SQUARE, far).probability_per_m2).any()


@pytest.mark.parametrize("place_mm", [1.1 * FARTHEST_MM, 1e30, -1e200, np.inf])
def test_positions_that_no_run_can_have_are_left_out_and_told(place_mm: float, tmp_path: Path) -> None:
    rows = rows_of(with_one_at(place_mm))
    with pytest.warns(RuntimeWarning, match="4 of 80 rows are left out: their positions are more than 10 km away"):
        (run,) = trajectories_of(rows, metadata_of())
    assert run.position_mm.shape == (4, 19, 2)
    file = write_rows(tmp_path / "far.feather", rows, metadata_of())
    with pytest.warns(RuntimeWarning, match="4 of 80 rows are left out"):
        assert len(read_recording(file).last.rows) == 76


def two_far_away() -> Floats:
    """One robot where one can be, though outside of the arena, and one where none can be."""
    positions = with_one_at(1e30)
    positions[:, 1] = 1e6
    return positions


SWARMS = {"two far away": two_far_away(), "all at one place, once": np.full((1, 20, 2), 500.0)}


@pytest.fixture
def small_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures of few pixels, since nothing looks at them."""
    real = Figure.savefig
    monkeypatch.setattr(
        Figure,
        "savefig",
        lambda figure, path, **options: (
            None if str(path).endswith(".pdf") else real(figure, path, **options | {"dpi": 20})
        ),
    )


@pytest.mark.usefixtures("small_figures")
@pytest.mark.parametrize("tool", ["picture", "film", *sorted(set(ANALYSES.own) - {"messages"})])
def test_tools_do_bounded_work_whatever_the_positions(tool: str, tmp_path: Path) -> None:
    for number, (name, positions) in enumerate(SWARMS.items()):
        file = write_rows(tmp_path / f"{number}.feather", rows_of(positions), metadata_of())
        arguments = {
            "picture": ["picture", str(file), str(tmp_path / f"{number}.png")],
            "film": ["film", str(file), "-o", str(tmp_path / f"{number}.html")],
        }.get(tool, ["analyze", tool, "-i", str(file), "-o", str(tmp_path / f"{number}")])
        result = pogosim(tmp_path, *arguments)
        assert result.code == 0, (name, result.text)
        assert ("rows are left out" in result.errors) == (name == "two far away"), (name, result.errors)
        assert "Traceback" not in result.errors
