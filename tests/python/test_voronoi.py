from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import shapely
from pogosim.analysis import snapshots
from pogosim.analysis.arena import Arena
from pogosim.analysis.coverage import coverage_over_time
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.analysis.voronoi import voronoi_areas, voronoi_cells
from pogosim.errors import AnalysisError
from swarms import Floats, metadata_of, rows_of

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
PERIODIC = Arena(polygons=[1000.0 * SQUARE], is_periodic=True)
WALLS = Arena(polygons=[1000.0 * SQUARE])
RING = Arena(polygons=[1000.0 * SQUARE, 400.0 + 200.0 * SQUARE])  # with a square hole in the middle
TALL = Arena(polygons=[np.array([10.0, 3000.0]) * SQUARE], is_periodic=True)
L_SHAPE = Arena(polygons=[np.array([[0, 0], [1000, 0], [1000, 500], [500, 500], [500, 1000], [0, 1000.0]])])


def uniform(robots: int, seed: int = 1) -> Floats:
    return np.random.default_rng(seed).uniform(0.0, 1000.0, (robots, 2))


def lattice(count: int, side_mm: float = 1000.0) -> Floats:
    x = side_mm * (np.arange(count) + 0.5) / count
    return np.stack(np.meshgrid(x, x), axis=2).reshape(-1, 2)


def areas(position_mm: Floats, arena: Arena) -> Floats:
    return voronoi_areas(voronoi_cells(position_mm, arena), position_mm, arena)


def covered(position_mm: Floats, arena: Arena, reach_mm: float) -> float:
    run = replace(run_at(position_mm), arena=arena)
    return float(coverage_over_time(run, reach_mm)["coverage_ratio"].iloc[0]) * arena.area_mm2


def run_at(position_mm: Floats, periodic: bool = False) -> Trajectories:
    position = np.asarray(position_mm, dtype=float)
    (run,) = trajectories_of(rows_of(position if position.ndim == 3 else position[None]), metadata_of(1000.0, periodic))
    return run


@pytest.mark.parametrize("arena", [PERIODIC, WALLS, RING, TALL, L_SHAPE])
@pytest.mark.parametrize("robots", [1, 2, 3, 10, 300])
def test_cells_add_up_to_the_arena(arena: Arena, robots: int) -> None:
    assert areas(uniform(robots), arena).sum() == pytest.approx(arena.area_mm2, rel=1e-9)


def test_cells_of_a_crowd_in_a_corner_fill_a_periodic_arena() -> None:
    crowd = 0.03 * uniform(300)
    assert areas(crowd, PERIODIC).sum() == pytest.approx(PERIODIC.area_mm2, rel=1e-9)
    middle = crowd + 500.0
    np.testing.assert_allclose(areas(middle, PERIODIC), areas(crowd, PERIODIC), rtol=1e-6)


@pytest.mark.parametrize("arena", [PERIODIC, WALLS, RING, L_SHAPE])
def test_each_point_is_in_the_cell_of_its_nearest_robot(arena: Arena) -> None:
    position, points = uniform(40), uniform(2000, seed=2)
    cells = voronoi_cells(position, arena)
    nearest = np.linalg.norm(arena.minimum_image(points[:, None] - position[None]), axis=2).argmin(axis=1)
    images = [[0.0, 0.0]]
    if arena.is_periodic:
        images = [[x, y] for x in (-1000.0, 0.0, 1000.0) for y in (-1000.0, 0.0, 1000.0)]
    is_in = [shapely.contains_xy(cells[nearest], *(points + shift).T) for shift in images]
    np.testing.assert_array_equal(np.any(is_in, axis=0), shapely.contains_xy(arena.shape(), *points.T))


@pytest.mark.parametrize("arena", [PERIODIC, WALLS])
def test_cells_of_a_square_lattice_are_equal(arena: Arena) -> None:
    np.testing.assert_allclose(areas(lattice(12), arena), 1000.0**2 / 144, rtol=1e-6)


def test_cells_of_a_hexagonal_lattice_are_equal() -> None:
    spacing = np.array([1.0, np.sqrt(3.0)]) * 50.0
    box = Arena(polygons=[SQUARE * spacing * [10, 6]], is_periodic=True)
    corners = np.stack(np.meshgrid(np.arange(10), np.arange(6)), axis=2).reshape(-1, 2) * spacing
    position = np.concatenate([corners, corners + spacing / 2])
    np.testing.assert_allclose(areas(position, box), spacing.prod() / 2, rtol=1e-6)


def test_cells_of_independent_robots_vary_as_gilbert_computed() -> None:
    # Variance over squared mean: 0.280 for a Poisson process in the plane.
    variation = [(lambda a: a.var() / a.mean() ** 2)(areas(uniform(2000, seed), PERIODIC)) for seed in range(10)]
    assert np.mean(variation) == pytest.approx(0.280, abs=0.006)


@pytest.mark.parametrize("robots", [1, 2, 60])
def test_a_shift_across_periodic_borders_changes_nothing(robots: int) -> None:
    position = uniform(robots)
    shifted = (position + np.array([612.0, -288.0])) % 1000.0
    np.testing.assert_allclose(areas(shifted, PERIODIC), areas(position, PERIODIC), rtol=1e-6)
    assert covered(shifted, PERIODIC, 133.0) == pytest.approx(covered(position, PERIODIC, 133.0), rel=1e-6)


def test_robots_at_one_place_share_a_cell() -> None:
    position = np.array([[250.0, 500.0], [250.0, 500.0 + 1e-7], [750.0, 500.0], [250.0, 500.0]])
    for arena in (WALLS, PERIODIC):
        np.testing.assert_allclose(areas(position, arena), [5e5 / 3, 5e5 / 3, 5e5, 5e5 / 3])
        assert covered(position, arena, 100.0) == pytest.approx(2 * np.pi * 100.0**2)
    across = np.array([[0.0, 500.0], [1000.0 - 1e-9, 500.0]])
    np.testing.assert_allclose(areas(across, PERIODIC), 5e5)


def test_robots_in_a_line_have_cells() -> None:
    position = np.array([[100.0, 500.0], [300.0, 500.0], [900.0, 500.0]])
    np.testing.assert_allclose(areas(position, WALLS), [2e5, 4e5, 4e5], rtol=1e-6)
    np.testing.assert_allclose(areas(position, PERIODIC), [2e5, 4e5, 4e5], rtol=1e-6)


def test_a_robot_outside_of_the_walls_or_in_a_hole_has_a_cell() -> None:
    position = np.array([[-1e-3, 500.0], [750.0, 500.0]])
    np.testing.assert_allclose(areas(position, WALLS), [375e3, 625e3], rtol=1e-5)
    assert areas(np.array([[500.0, 500.0]]), RING).tolist() == [pytest.approx(96e4)]


def test_a_disk_away_from_walls_covers_pi_r_squared() -> None:
    for arena in (WALLS, PERIODIC, RING):
        assert covered(np.array([[200.0, 200.0]]), arena, 133.0) == pytest.approx(np.pi * 133.0**2, rel=1e-9)


def test_walls_cut_disks_and_periodic_borders_do_not() -> None:
    corner = np.array([[0.0, 0.0]])
    assert covered(corner, WALLS, 100.0) == pytest.approx(np.pi * 100.0**2 / 4)
    assert covered(corner, PERIODIC, 100.0) == pytest.approx(np.pi * 100.0**2)


def test_two_disks_cover_their_sum_without_the_lens() -> None:
    radius, distance = 100.0, 120.0
    lens = 2 * radius**2 * np.arccos(distance / 2 / radius) - distance / 2 * np.sqrt(4 * radius**2 - distance**2)
    expected = 2 * np.pi * radius**2 - lens
    assert covered(np.array([[400.0, 500.0], [520.0, 500.0]]), WALLS, radius) == pytest.approx(expected)
    assert covered(np.array([[970.0, 500.0], [90.0, 500.0]]), PERIODIC, radius) == pytest.approx(expected)


def test_a_disk_in_a_hole_covers_what_reaches_out_of_it() -> None:
    middle = np.array([[500.0, 500.0]])
    assert covered(middle, RING, 90.0) == pytest.approx(0.0, abs=1e-9)
    assert covered(middle, RING, 200.0) == pytest.approx(np.pi * 200.0**2 - 200.0**2)
    # Four segments of a circle around a square of half its width reach out.
    segments = 4 * (120.0**2 * np.arccos(100.0 / 120.0) - 100.0 * np.sqrt(120.0**2 - 100.0**2))
    assert covered(middle, RING, 120.0) == pytest.approx(segments)


@pytest.mark.parametrize("arena", [WALLS, RING, L_SHAPE])
def test_coverage_is_that_of_the_union_of_disks(arena: Arena) -> None:
    position = uniform(30)
    disks = shapely.union_all(shapely.buffer(shapely.points(position), 90.0, quad_segs=500))
    expected = shapely.area(shapely.intersection(disks, arena.shape()))
    assert covered(position, arena, 90.0) == pytest.approx(expected, rel=1e-5)


def test_disks_larger_than_the_arena_cover_it() -> None:
    for arena in (WALLS, PERIODIC, RING, L_SHAPE):
        assert covered(uniform(5), arena, 3000.0) == pytest.approx(arena.area_mm2)


def test_coverage_of_an_ideal_gas_is_that_of_a_boolean_model() -> None:
    # Chance that none of n robots is within r of a point: (1 - pi r^2 / A)^n.
    position = np.random.default_rng(5).uniform(0.0, 1000.0, (200, 100, 2))
    table = coverage_over_time(run_at(position, periodic=True), 60.0)
    assert table["coverage_ratio"].mean() == pytest.approx(1 - (1 - np.pi * 0.06**2) ** 100, abs=0.005)


def test_table_over_time_of_a_lattice_that_loses_a_robot() -> None:
    position = np.stack([lattice(4), lattice(4)])
    position[1, 0] = np.nan
    table = coverage_over_time(run_at(position))
    assert table.columns.tolist() == [
        "time",
        "mean_area",
        "std_area",
        "var_area",
        "cv_area",
        "n_cells",
        "coverage_ratio",
    ]
    assert table["n_cells"].tolist() == [16, 15]
    np.testing.assert_allclose(table["mean_area"], [1e6 / 16, 1e6 / 15])
    assert table["cv_area"][0] == pytest.approx(0.0, abs=1e-6)
    assert table["cv_area"][1] > 0.1
    np.testing.assert_allclose(table["var_area"], table["std_area"] ** 2)


def test_an_unknown_arena_is_an_error() -> None:
    (run,) = trajectories_of(rows_of(lattice(2)[None]), {})
    with pytest.raises(AnalysisError, match="no arena_polygons"):
        coverage_over_time(run)


@pytest.mark.parametrize("periodic", [False, True])
def test_cells_of_many_times_are_those_of_each_time_alone(periodic: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    position = np.random.default_rng(5).uniform(0.0, 1000.0, (23, 12, 2))
    position[4, 1:] = np.nan  # one robot
    position[9] = np.nan  # none
    position[11, 3] = position[11, 8]
    (run,) = trajectories_of(rows_of(position), metadata_of(1000.0, periodic))
    table = coverage_over_time(run)
    monkeypatch.setattr(snapshots, "MAX_POINTS", 1)
    pd.testing.assert_frame_equal(coverage_over_time(run), table)
    assert table["n_cells"].tolist()[4] == 1
    assert table["mean_area"].iloc[4] == pytest.approx(1e6)
