from __future__ import annotations

import numpy as np
import pytest
from pogosim.analysis import snapshots
from pogosim.analysis.neighbourhood import (
    cluster_sizes,
    clusters,
    degrees,
    fano_factor,
    nearest_distances,
    neighbours,
)
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from swarms import Floats, metadata_of, rows_of


def run_at(position_mm: Floats, side_mm: float = 1000.0, periodic: bool = False, missing: int = -1) -> Trajectories:
    """A run of robots at positions of shape (n, 2), or (times, n, 2); without the robot `missing`, at first."""
    position = np.asarray(position_mm, dtype=float)
    rows = rows_of(position if position.ndim == 3 else position[None])
    (run,) = trajectories_of(rows.drop(index=missing) if missing >= 0 else rows, metadata_of(side_mm, periodic))
    return run


def square_lattice(count: int, spacing_mm: float) -> Floats:
    x = spacing_mm * (np.arange(count) + 0.5)
    return np.stack(np.meshgrid(x, x), axis=2).reshape(-1, 2)


def uniform(robots: int, side_mm: float, times: int = 1, seed: int = 1) -> Floats:
    return np.random.default_rng(seed).uniform(0.0, side_mm, (times, robots, 2))


def test_pairs_are_those_within_reach_in_both_directions() -> None:
    (now,) = neighbours(run_at(np.array([[0.0, 0.0], [100.0, 0.0], [220.0, 0.0], [400.0, 0.0]])), 120.0)
    assert list(zip(now.robot, now.neighbour, now.distance_mm, strict=True)) == [
        (0, 1, 100.0),
        (1, 0, 100.0),
        (1, 2, 120.0),
        (2, 1, 120.0),
    ]
    assert now.degree().tolist() == [1, 2, 1, 0]
    assert now.adjacency().toarray().tolist() == [[0, 1, 0, 0], [1, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 0]]


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("reach", [40.0, 90.0, 160.0, 300.0])  # in a periodic arena, also beyond half of it
def test_pairs_are_those_of_the_matrix_of_all_distances(periodic: bool, reach: float) -> None:
    run = run_at(uniform(40, 200.0, times=3), 200.0, periodic)
    for now, position in zip(neighbours(run, reach), run.position_mm, strict=True):
        distance = np.linalg.norm(run.arena.minimum_image(position[:, None] - position[None]), axis=2)
        expected = (distance <= reach) & ~np.eye(40, dtype=bool)
        np.testing.assert_array_equal(now.adjacency().toarray(), expected)
        np.testing.assert_allclose(now.distance_mm, distance[expected])
    np.testing.assert_array_equal(degrees(run, reach), [now.degree() for now in neighbours(run, reach)])


def test_a_neighbour_at_exactly_the_reach_is_one() -> None:
    run = run_at(np.array([[0.0, 0.0], [120.0, 0.0]]))
    assert nearest_distances(run, 1, 120.0).ravel().tolist() == [120.0, 120.0]
    assert degrees(run, 120.0).tolist() == [[1, 1]]
    assert degrees(run, 119.9).tolist() == [[0, 0]]


def test_in_a_periodic_lattice_each_robot_has_four_neighbours_and_the_fano_factor_is_0() -> None:
    run = run_at(square_lattice(10, 100.0), periodic=True)
    assert (degrees(run, 101.0) == 4).all()
    assert fano_factor(degrees(run, 101.0)).tolist() == [0.0]
    np.testing.assert_allclose(nearest_distances(run, 6, 101.0)[0, :, :4], 100.0)
    assert np.isnan(nearest_distances(run, 6, 101.0)[0, :, 4:]).all()
    np.testing.assert_allclose(nearest_distances(run, 5, np.inf)[0, :, 4], 100.0 * np.sqrt(2.0))


def test_within_a_lattice_with_walls_border_robots_have_fewer_neighbours() -> None:
    degree = degrees(run_at(square_lattice(10, 100.0)), 101.0)
    assert np.bincount(degree[0].astype(int)).tolist() == [0, 0, 4, 32, 64]


def test_degrees_of_an_ideal_gas_are_poisson() -> None:
    # Mean degree = density pi r^2; variance = mean, so the Fano factor is 1.
    degree = degrees(run_at(uniform(2000, 1000.0, times=20), periodic=True), 30.0)
    assert degree.mean() == pytest.approx(1999 * np.pi * 30.0**2 / 1000.0**2, rel=0.01)
    assert fano_factor(degree).mean() == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (517.0, 0.0), (-333.0, 871.0)])
def test_a_shift_across_periodic_borders_changes_nothing(shift: tuple[float, float]) -> None:
    position = uniform(50, 1000.0)
    still, shifted = (run_at(p, periodic=True) for p in (position, (position + shift) % 1000.0))
    np.testing.assert_array_equal(degrees(shifted), degrees(still))
    np.testing.assert_array_equal(clusters(shifted), clusters(still))
    np.testing.assert_allclose(nearest_distances(shifted), nearest_distances(still), atol=1e-9)


def test_robots_outside_a_periodic_box_count_by_their_image() -> None:
    run = run_at(np.array([[-1e-14, 500.0], [1000.0, 500.0], [1050.0, 500.0]]), periodic=True)
    np.testing.assert_allclose(nearest_distances(run, 2)[0], [[0, 50], [0, 50], [50, 50]], atol=1e-9)


def test_robots_that_are_not_there_are_no_neighbours() -> None:
    run = run_at(np.array([[[0.0, 0.0], [50.0, 0.0], [100.0, 0.0]]] * 2), missing=1)
    np.testing.assert_array_equal(degrees(run, 60.0), [[0, np.nan, 0], [1, 2, 1]])
    np.testing.assert_array_equal(nearest_distances(run, 1)[:, :, 0], [[100, np.nan, 100], [50, 50, 50]])
    assert clusters(run, 60.0).tolist() == [[0, -1, 1], [0, 0, 0]]
    assert cluster_sizes(clusters(run, 60.0)).tolist() == [[1, 1], [3, 0]]
    np.testing.assert_allclose(fano_factor(degrees(run, 60.0)), [np.nan, (2 / 9) / (4 / 3)])


def test_clusters_are_numbered_by_size() -> None:
    x = np.array([0.0, 500.0, 510.0, 900.0, 520.0, 910.0])
    cluster = clusters(run_at(np.column_stack([x, 0.0 * x])), 15.0)
    assert cluster.tolist() == [[2, 0, 0, 1, 0, 1]]
    assert cluster_sizes(cluster).tolist() == [[3, 2, 1]]


def test_a_chain_across_a_periodic_border_is_one_cluster() -> None:
    x = np.array([900.0, 990.0, 80.0, 170.0])
    position = np.column_stack([x, 0.0 * x])
    assert cluster_sizes(clusters(run_at(position, periodic=True), 100.0)).tolist() == [[4]]
    assert cluster_sizes(clusters(run_at(position), 100.0)).tolist() == [[2, 2]]


def test_robots_at_the_same_place_are_neighbours_but_none_is_its_own() -> None:
    run = run_at(np.full((3, 2), 10.0))
    assert degrees(run).tolist() == [[2, 2, 2]]
    assert nearest_distances(run, 2).tolist() == [[[0, 0]] * 3]
    assert all(now.robot.tolist() == [0, 0, 1, 1, 2, 2] for now in neighbours(run))


def test_one_robot_has_no_neighbour() -> None:
    run = run_at(np.array([[10.0, 10.0]]))
    assert degrees(run).tolist() == [[0]]
    assert clusters(run).tolist() == [[0]]
    assert np.isnan(nearest_distances(run)).all()
    assert np.isnan(fano_factor(degrees(run))).all()


@pytest.mark.parametrize("periodic", [False, True])
def test_blocks_of_times_make_no_difference(periodic: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    run = run_at(uniform(30, 200.0, times=7), 200.0, periodic, missing=4)
    whole = degrees(run, 60.0), clusters(run, 60.0), nearest_distances(run, 4, 90.0)
    monkeypatch.setattr(snapshots, "MAX_POINTS", 61)
    assert [block.times for block in snapshots.snapshots_of(run)] == [
        slice(0, 2),
        slice(2, 4),
        slice(4, 6),
        slice(6, 7),
    ]
    divided = degrees(run, 60.0), clusters(run, 60.0), nearest_distances(run, 4, 90.0)
    for one, other in zip(whole, divided, strict=True):
        np.testing.assert_array_equal(one, other)


def test_robots_in_one_place_at_all_times_are_neighbours_of_that_time_only() -> None:
    run = run_at(np.full((50, 4, 2), 500.0))
    np.testing.assert_array_equal(degrees(run, 133.0), 3.0)
    np.testing.assert_array_equal(degrees(run, np.inf), 3.0)
    np.testing.assert_array_equal(nearest_distances(run, 3), 0.0)
    assert np.isnan(nearest_distances(run, 5)[..., 3:]).all()
