"""Where points are in an arena: distances to walls, and densities on its floor."""

from __future__ import annotations

import numpy as np
import pytest
from pogosim.analysis.arena import Arena
from pogosim.analysis.density import count_density, kernel_density
from pogosim.analysis.walls import distance_to_walls, is_on_floor
from swarms import Floats


def square(low: float, high: float) -> Floats:
    return np.array([[low, low], [high, low], [high, high], [low, high]])


def disk(radius_mm: float) -> Floats:
    angle = np.linspace(0.0, 2.0 * np.pi, 2001)[:-1]
    return 500.0 + radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])


WITH_HOLE = Arena("hole", [square(0.0, 1000.0), square(400.0, 600.0)])


def test_distance_in_a_square_is_that_to_the_nearest_side() -> None:
    points = np.random.default_rng(1).uniform(0.0, 1000.0, (5, 40, 2))
    expected = np.minimum(points, 1000.0 - points).min(axis=-1)
    np.testing.assert_allclose(distance_to_walls(Arena("square", [square(0.0, 1000.0)]), points), expected)


def test_distance_in_a_disk_is_what_the_radius_leaves() -> None:
    points = np.random.default_rng(1).uniform(0.0, 1000.0, (500, 2))
    expected = np.abs(400.0 - np.linalg.norm(points - 500.0, axis=1))
    np.testing.assert_allclose(distance_to_walls(Arena("disk", [disk(400.0)]), points), expected, atol=0.01)


def test_holes_have_walls() -> None:
    points = np.array([[500.0, 350.0], [500.0, 100.0], [500.0, 450.0], [1010.0, 500.0], [400.0, 500.0]])
    np.testing.assert_allclose(distance_to_walls(WITH_HOLE, points), [50, 100, 50, 10, 0])
    assert is_on_floor(WITH_HOLE, points).tolist() == [True, True, False, False, True]


def test_points_that_are_not_known_have_no_distance() -> None:
    points = np.array([[[500.0, 100.0], [np.nan, 5.0]], [[np.inf, 5.0], [500.0, 100.0]]])
    np.testing.assert_allclose(distance_to_walls(WITH_HOLE, points), [[100, np.nan], [np.nan, 100]])
    assert is_on_floor(WITH_HOLE, points).tolist() == [[True, False], [False, True]]


@pytest.mark.parametrize("arena", [Arena(), Arena("periodic", [square(0.0, 100.0)], is_periodic=True)])
def test_without_walls_they_are_infinitely_far(arena: Arena) -> None:
    points = np.array([[50.0, 50.0], [np.nan, 0.0], [-10.0, 300.0]])
    np.testing.assert_allclose(distance_to_walls(arena, points), [np.inf, np.nan, np.inf])
    assert is_on_floor(arena, points).tolist() == [True, False, True]


def on_floor(arena: Arena, count: int) -> Floats:
    points = np.random.default_rng(5).uniform(0.0, 1000.0, (count, 2))
    return points[is_on_floor(arena, points)]


@pytest.mark.parametrize("arena", [WITH_HOLE, Arena("disk", [disk(400.0)])], ids=lambda arena: arena.name)
def test_robots_anywhere_on_the_floor_have_the_same_density_everywhere(arena: Arena) -> None:
    points = on_floor(arena, 400_000)
    uniform = 1e6 / arena.area_mm2
    counted = count_density(arena, points, bins=15).probability_per_m2
    assert np.nanmax(np.abs(counted / uniform - 1.0)) < 0.2
    smooth = kernel_density(arena, points).probability_per_m2
    assert np.nanmax(np.abs(smooth / uniform - 1.0)) < 0.1
    centre = smooth.shape[0] // 2
    assert np.isnan(smooth[centre, centre]) == (arena.name == "hole")


def test_densities_integrate_to_1() -> None:
    points = np.random.default_rng(3).normal(500.0, 50.0, (1000, 2))
    arena = Arena("square", [square(0.0, 1000.0)])
    for grid in (count_density(arena, points), kernel_density(arena, points)):
        area_m2 = np.outer(np.diff(grid.y_mm), np.diff(grid.x_mm)) * 1e-6
        assert np.nansum(grid.probability_per_m2 * area_m2) == pytest.approx(1.0)


def test_kernel_density_of_a_normal_distribution_is_a_wider_one() -> None:
    points = np.random.default_rng(3).normal(500.0, 60.0, (20_000, 2))
    grid = kernel_density(Arena("square", [square(0.0, 1000.0)]), points, bandwidth_mm=80.0)
    peak = 1e6 / (2.0 * np.pi * (60.0**2 + 80.0**2))
    assert grid.probability_per_m2.max() == pytest.approx(peak, rel=0.02)


def test_density_goes_on_across_periodic_borders() -> None:
    arena = Arena("periodic", [square(0.0, 1000.0)], is_periodic=True)
    points = np.random.default_rng(3).normal(500.0, 60.0, (2000, 2))
    middle = kernel_density(arena, points, bandwidth_mm=40.0).probability_per_m2
    corner = kernel_density(arena, np.mod(points + 500.0, 1000.0), bandwidth_mm=40.0).probability_per_m2
    np.testing.assert_allclose(np.roll(middle, (100, 100), axis=(0, 1)), corner, atol=1e-9)


def test_without_outline_the_grid_is_around_the_points() -> None:
    grid = count_density(Arena(), np.array([[10.0, 20.0], [110.0, 70.0], [np.nan, 0.0]]), bins=10)
    assert (grid.x_mm[0], grid.x_mm[-1], grid.y_mm[0], grid.y_mm[-1]) == (10, 110, 20, 70)
    assert grid.probability_per_m2.shape == (5, 10)
    assert np.isnan(count_density(Arena(), np.full((3, 2), np.nan)).probability_per_m2).all()
    assert kernel_density(Arena(), np.array([[5.0, 5.0]])).probability_per_m2.max() > 0.0
