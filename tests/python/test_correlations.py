from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pogosim.analysis.correlations import correlation_length, pair_correlation, vector_correlation
from pogosim.analysis.floor import covered_fraction, floor_of_centres, set_covariance
from pogosim.analysis.fluctuations import mean_square_speed, number_fluctuations
from pogosim.analysis.structure_factor import structure_factor
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.errors import AnalysisError
from swarms import Floats, freud_system, metadata_of, rows_of


def run_of(position: Floats, metadata: dict[str, Any]) -> Trajectories:
    (run,) = trajectories_of(rows_of(position), metadata)
    return run


def ideal_gas(times: int, robots: int, low: float = 0.0, high: float = 1000.0) -> Floats:
    return np.random.default_rng(7).uniform(low, high, (times, robots, 2))


def square_lattice(side: float = 1000.0, count: int = 20) -> Floats:
    """One time, count x count robots in a square lattice."""
    at = side * (np.arange(count) + 0.25) / count
    return np.stack(np.meshgrid(at, at), axis=2).reshape(1, -1, 2)


def ring_shaped(outer: float = 500.0, inner: float = 300.0) -> dict[str, Any]:
    """A round arena with a round hole, as metadata; robots are points."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)[:-1]
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    polygons = [(500.0 + radius * circle).tolist() for radius in (outer, inner)]
    return {**metadata_of(radius=1e-6), "arena_polygons": polygons}


def gas_in_ring(times: int, robots: int) -> Floats:
    """Uniform places between the walls of `ring_shaped`."""
    generator = np.random.default_rng(8)
    radius = np.sqrt(generator.uniform(301.0**2, 499.0**2, (times, robots)))
    angle = generator.uniform(0.0, 2.0 * np.pi, (times, robots))
    return np.asarray(500.0 + np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=2))


def test_centres_of_robots_cannot_be_closer_to_a_wall_than_their_radius() -> None:
    solid = run_of(ideal_gas(1, 2), metadata_of(1000.0, radius=20.0))
    assert floor_of_centres(solid).area == pytest.approx(960.0**2)
    periodic = run_of(ideal_gas(1, 2), metadata_of(1000.0, periodic=True))
    assert floor_of_centres(periodic).area == pytest.approx(1000.0**2)
    narrow = run_of(ideal_gas(1, 2, high=10.0), metadata_of(10.0, radius=20.0))
    assert floor_of_centres(narrow).area == pytest.approx(10.0**2)


def test_the_set_covariance_of_a_square_is_known() -> None:
    floor = floor_of_centres(run_of(ideal_gas(1, 2), metadata_of(1000.0, periodic=True)))
    r = np.array([0.0, 10.0, 100.0, 400.0])
    # The mean over angles of (L - r |cos|) (L - r |sin|).
    expected = 1000.0**2 - 4.0 * 1000.0 * r / np.pi + r**2 / np.pi
    np.testing.assert_allclose(set_covariance(floor, r), expected, rtol=1e-3)


def test_a_grid_over_a_disk_is_covered_by_its_area() -> None:
    import shapely

    disk = shapely.Point(50.0, 80.0).buffer(40.0, 64)
    covered = covered_fraction(disk, (20, 30))
    assert covered.shape == (30, 20)
    assert covered.mean() * 80.0**2 == pytest.approx(disk.area, rel=0.01)
    assert covered[15, 10] == 1.0
    assert covered[0, 0] == 0.0


@pytest.mark.parametrize("periodic", [True, False])
def test_g_of_an_ideal_gas_is_1_at_all_distances(periodic: bool) -> None:
    metadata = metadata_of(1000.0, periodic, radius=1e-6)
    own = pair_correlation(run_of(ideal_gas(200, 40), metadata), 450.0, 25.0)
    error = 1.0 / np.sqrt(own.expected)
    assert (np.abs(own.g_r - 1.0) < 4.0 * error).all()
    assert (error[1:] < 0.04).all()


def test_g_of_an_ideal_gas_is_1_between_the_walls_of_a_ring() -> None:
    own = pair_correlation(run_of(gas_in_ring(200, 40), ring_shaped()), 990.0, 30.0)
    assert (np.abs(own.g_r - 1.0) < 4.0 / np.sqrt(own.expected) + 0.01).all()


def test_g_is_that_of_freud_in_a_periodic_box() -> None:
    import freud

    run = run_of(ideal_gas(1, 200), metadata_of(1000.0, periodic=True))
    own = pair_correlation(run, 200.0, 10.0)
    rdf = freud.density.RDF(20, 200.0, normalization_mode="finite_size")
    rdf.compute(freud_system(run), reset=False)
    np.testing.assert_allclose(own.g_r, rdf.rdf, rtol=1e-4)


def test_g_of_a_square_lattice_has_4_neighbours_at_each_of_its_distances() -> None:
    own = pair_correlation(run_of(square_lattice(), metadata_of(1000.0, periodic=True)), 80.0, 4.0)
    assert own.distance_mm[own.pairs > 0].tolist() == [50.0, 70.0]
    assert own.pairs[own.pairs > 0].tolist() == [800.0, 800.0]  # 400 robots, 4 neighbours, each pair once


def test_g_is_not_known_beyond_half_a_periodic_box() -> None:
    own = pair_correlation(run_of(ideal_gas(3, 20), metadata_of(300.0, periodic=True)), 200.0, 10.0)
    assert np.isfinite(own.g_r[:15]).all()
    assert np.isnan(own.g_r[15:]).all()


def test_a_shift_across_periodic_borders_changes_nothing() -> None:
    position = np.random.default_rng(2).normal(500.0, 100.0, (3, 60, 2))
    metadata = metadata_of(1000.0, periodic=True)
    run, shifted = run_of(position, metadata), run_of((position + np.array([500.0, 480.0])) % 1000.0, metadata)
    vector = np.random.default_rng(3).normal(size=position.shape)
    np.testing.assert_array_equal(pair_correlation(run).pairs, pair_correlation(shifted).pairs)
    here, there = vector_correlation(run, vector), vector_correlation(shifted, vector)
    np.testing.assert_allclose(there.mean, here.mean, atol=1e-9)
    # Shifts by whole cells, 1000 / 100 mm.
    np.testing.assert_allclose(structure_factor(shifted, (100, 100)), structure_factor(run, (100, 100)), rtol=1e-6)


def test_unknown_arenas_have_no_g() -> None:
    (run,) = trajectories_of(rows_of(ideal_gas(1, 5)), {})
    for function in (pair_correlation, structure_factor, number_fluctuations):
        with pytest.raises(AnalysisError, match="what the arena is"):
            function(run)


@pytest.mark.parametrize("metadata", [metadata_of(1000.0, True), metadata_of(1000.0, radius=1e-6)])
def test_s_of_an_ideal_gas_is_1_at_all_wave_numbers(metadata: dict[str, Any]) -> None:
    wave, s = structure_factor(run_of(ideal_gas(300, 50), metadata), (32, 32))
    # The first ring has four waves along the sides, and four along the diagonals.
    assert wave[0] == pytest.approx(np.pi / 1000.0 * (1.0 + np.sqrt(2.0)), rel=1e-3)
    assert wave[-1] <= np.pi * 32 / 1000.0 + 1e-9
    np.testing.assert_allclose(s, 1.0, atol=0.16)
    assert s.mean() == pytest.approx(1.0, abs=0.02)


def test_s_of_an_ideal_gas_is_1_between_the_walls_of_a_ring() -> None:
    _, s = structure_factor(run_of(gas_in_ring(300, 50), ring_shaped()), (64, 64))
    np.testing.assert_allclose(s, 1.0, atol=0.15)


def test_s_of_a_lattice_is_n_at_its_bragg_peaks_and_0_elsewhere() -> None:
    wave, s = structure_factor(run_of(square_lattice(), metadata_of(1000.0, periodic=True)), (80, 80))
    # 20 waves per side: 4 of the modes in this ring are peaks, of N each.
    first = 19
    assert wave[first] == pytest.approx(2.0 * np.pi / 50.0, rel=0.01)
    mode = np.hypot(*np.mgrid[-39:40, -39:40])
    assert s[first] == pytest.approx(4 * 400 / np.count_nonzero((mode > 19.5) & (mode < 20.5)))
    np.testing.assert_allclose(s[:first], 0.0, atol=1e-9)


def test_vectors_that_decay_over_a_length_have_this_correlation_length() -> None:
    distance = 1.0 + 2.0 * np.arange(500.0)
    assert correlation_length(distance, np.exp(-distance / 40.0)) == pytest.approx(40.0, rel=0.01)
    with_gap = np.where(distance < 20.0, np.nan, 1.0 - distance / 100.0)
    assert correlation_length(distance, with_gap) == pytest.approx(50.0, rel=1e-3)
    assert np.isnan(correlation_length(distance, np.full(500, np.nan)))


def test_the_correlation_of_a_wave_of_directions_is_the_cosine_of_the_distance() -> None:
    x = 10.0 * np.arange(100)
    run = run_of(np.stack([x, 0.0 * x + 5.0], axis=1)[None], metadata_of(1000.0, periodic=True))
    angle = 2.0 * np.pi * x / 1000.0
    own = vector_correlation(run, 3.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)[None], 200.0, 20.0)
    assert own.mean_square == pytest.approx(9.0)
    # Bins of two distances each: 0 (none) and 10, 20 and 30, ...
    ten, twenty, thirty = np.cos(2.0 * np.pi * np.array([10.0, 20.0, 30.0]) / 1000.0)
    np.testing.assert_allclose(own.mean[:2], [ten, (twenty + thirty) / 2.0])
    np.testing.assert_allclose(own.at_times[0], own.mean)


def test_robots_that_go_the_same_way_are_correlated_but_have_no_fluctuations() -> None:
    run = run_of(ideal_gas(2, 50), metadata_of())
    vector = np.broadcast_to(np.array([2.0, 1.0]), (2, 50, 2)).copy()
    np.testing.assert_allclose(vector_correlation(run, vector, 200.0, 50.0).mean, 1.0)
    noise = np.random.default_rng(1).normal(size=vector.shape)
    fluctuating = vector_correlation(run, vector + noise, 200.0, 50.0, fluctuations=True)
    np.testing.assert_allclose(fluctuating.mean, 0.0, atol=0.25)


def test_robots_without_a_vector_have_no_pairs() -> None:
    run = run_of(ideal_gas(2, 10, high=50.0), metadata_of())
    vector = np.ones((2, 10, 2))
    vector[0], vector[1, :4] = np.nan, np.nan
    own = vector_correlation(run, vector, 100.0, 100.0)
    assert own.pairs.ravel().tolist() == [0, 6 * 5 / 2]
    assert own.mean.tolist() == pytest.approx([1.0])


@pytest.mark.parametrize("metadata", [metadata_of(1000.0, True), metadata_of(1000.0, radius=1e-6), ring_shaped()])
def test_numbers_in_boxes_of_an_ideal_gas_fluctuate_as_their_square_root(metadata: dict[str, Any]) -> None:
    position = gas_in_ring(300, 900) if len(metadata["arena_polygons"]) > 1 else ideal_gas(300, 900)
    own = number_fluctuations(run_of(position, metadata))
    assert len(own.box_mm) > 4
    assert own.exponent == pytest.approx(0.5, abs=0.02)
    np.testing.assert_allclose(own.deviation, np.sqrt(own.mean), rtol=0.06)


def test_numbers_in_boxes_do_not_fluctuate_with_robots_that_come_and_go() -> None:
    position = ideal_gas(300, 400)
    position[::2, 100:] = np.nan
    own = number_fluctuations(run_of(position, metadata_of(1000.0, periodic=True)))
    assert own.exponent == pytest.approx(0.5, abs=0.03)


def test_robots_that_keep_together_have_giant_number_fluctuations() -> None:
    generator = np.random.default_rng(5)
    clumps = np.repeat(generator.uniform(0.0, 1000.0, (300, 9, 2)), 100, axis=1) % 1000.0
    own = number_fluctuations(run_of(clumps, metadata_of(1000.0, periodic=True)))
    # Each clump of 100 counts as one: sigma = 10 sqrt(N).
    np.testing.assert_allclose(own.deviation, 10.0 * np.sqrt(own.mean), rtol=0.1)


def test_few_robots_have_no_exponent() -> None:
    own = number_fluctuations(run_of(ideal_gas(10, 3), metadata_of(1000.0, True)))
    assert np.isnan(own.exponent)


def test_the_mean_square_speed_leaves_out_robots_without_speed() -> None:
    velocity = np.array([[[3.0, 4.0], [np.nan, np.nan]], [[0.0, 1.0], [1.0, 0.0]], [[np.nan] * 2] * 2])
    np.testing.assert_array_equal(mean_square_speed(velocity), [25.0, 1.0, np.nan])
