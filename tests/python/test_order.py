from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis.bond_order import bond_order
from pogosim.analysis.directions import directions_of_headings, directions_of_motion
from pogosim.analysis.milling import centre_of_mass, milling
from pogosim.analysis.motion import velocity
from pogosim.analysis.neighbourhood import pairs_within
from pogosim.analysis.order import local_alignment, nematic_order, polar_order
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.errors import AnalysisError
from swarms import Floats, freud_system, metadata_of, rows_of


def run_of(rows: pd.DataFrame, side_mm: float = 1000.0, periodic: bool = False) -> Trajectories:
    (run,) = trajectories_of(rows, metadata_of(side_mm, periodic))
    return run


def with_headings(heading_rad: Floats, position_mm: Floats | None = None, periodic: bool = False) -> Trajectories:
    """Robots with these headings, shape (times, robots), all in one place or at positions of shape (robots, 2)."""
    place = np.full((heading_rad.shape[1], 2), 500.0) if position_mm is None else position_mm
    return run_of(rows_of(np.repeat(place[None], len(heading_rad), axis=0), heading_rad), periodic=periodic)


def random_headings(times: int, robots: int) -> Floats:
    return np.random.default_rng(5).uniform(-np.pi, np.pi, (times, robots))


def disk_turning(omega: float, times: int = 4, period_s: float = 0.1) -> Floats:
    """Positions of 50 robots on a disk around (500, 500) that turns with omega in rad/s, from x towards y."""
    generator = np.random.default_rng(4)
    radius, angle = 300.0 * np.sqrt(generator.random(50)), generator.uniform(-np.pi, np.pi, 50)
    phase = angle + omega * period_s * np.arange(times)[:, None]
    disk = np.stack([radius * np.cos(phase), radius * np.sin(phase)], axis=2)
    return np.asarray(500.0 + disk - disk.mean(axis=1, keepdims=True))


def lattice(rows: int, columns: int, spacing: float, basis: tuple[float, float]) -> Floats:
    """Points of a lattice: rows are `basis[1]` spacings apart, and every other one is shifted by `basis[0]`."""
    y, x = np.mgrid[:rows, :columns]
    points = np.stack([(x + basis[0] * (y % 2)) * spacing, y * basis[1] * spacing], axis=2)
    return np.asarray(points.reshape(-1, 2), dtype=float)


HEXAGONAL = (0.5, np.sqrt(3.0) / 2.0)
SQUARE = (0.0, 1.0)


def test_robots_with_one_heading_have_polar_order_1_and_two_opposite_halves_have_0() -> None:
    same = with_headings(np.full((1, 10), 0.7))
    opposite = with_headings(np.array([[0.7, 0.7, 0.7 + np.pi, 0.7 - np.pi]]))
    assert polar_order(directions_of_headings(same)) == pytest.approx(1.0)
    assert polar_order(directions_of_headings(opposite)) == pytest.approx(0.0, abs=1e-12)
    assert nematic_order(directions_of_headings(opposite)) == pytest.approx(1.0)


def test_independent_headings_have_the_polar_order_of_chance() -> None:
    direction = directions_of_headings(with_headings(random_headings(2000, 50)))
    chance = np.sqrt(np.pi) / (2.0 * np.sqrt(50))
    assert polar_order(direction).mean() == pytest.approx(chance, rel=0.03)
    assert nematic_order(direction).mean() == pytest.approx(chance, rel=0.03)


def test_velocities_are_those_since_the_time_before() -> None:
    run = run_of(rows_of(np.array([[[10.0, 10.0]], [[13.0, 14.0]], [[13.0, 14.0]]]), period_s=0.5))
    assert velocity(run)[1:, 0].tolist() == [[6, 8], [0, 0]]
    direction = directions_of_motion(run)[:, 0]
    assert np.isnan(direction[[0, 2]]).all()  # the first time, and a robot that stands
    assert direction[1].tolist() == [0.6, 0.8]


def test_velocities_do_not_see_periodic_borders() -> None:
    run = run_of(rows_of(np.array([[[995.0, 500.0]], [[5.0, 500.0]]])), periodic=True)
    assert velocity(run)[1, 0].tolist() == [10, 0]


def test_robots_without_a_direction_are_left_out() -> None:
    heading = np.array([[0.0, 0.0, np.nan], [0.0, np.pi, np.nan], [np.nan, np.nan, np.nan]])
    order = polar_order(directions_of_headings(with_headings(heading)))
    np.testing.assert_allclose(order, [1.0, 0.0, np.nan], atol=1e-12)


def test_pairs_are_found_across_periodic_borders_only() -> None:
    position = np.array([[5.0, 500.0], [995.0, 500.0], [995.0, 5.0], [500.0, 995.0]])
    for periodic, expected in ((True, [(0, 1)]), (False, [])):
        run = run_of(rows_of(position[None]), periodic=periodic)
        i, j, _ = pairs_within(position, run.arena, 20.0)
        assert list(zip(i.tolist(), j.tolist(), strict=True)) == expected


def test_a_position_just_left_of_a_periodic_border_is_inside() -> None:
    position = np.array([[-1e-20, 5.0], [999.0, 5.0]])
    run = run_of(rows_of(position[None]), periodic=True)
    assert len(pairs_within(position, run.arena, 2.0)[0]) == 1


def test_local_alignment_of_three_robots_is_that_of_a_sum_of_three_vectors() -> None:
    position = np.array([[100.0, 100.0], [200.0, 100.0], [300.0, 100.0], [800.0, 800.0]])
    run = with_headings(np.array([[0.0, np.pi / 2, np.pi / 2, 1.0]]), position)
    local = local_alignment(run, directions_of_headings(run), 133.0)
    assert local.group_size.tolist() == [[2, 3, 2, 1]]
    order = np.sqrt([2.0, 5.0, 4.0]) / [2, 3, 2]
    np.testing.assert_allclose(local.polar_order[0], [*order, np.nan])
    np.testing.assert_allclose(local.pair_alignment[0], [0.0, 0.5, 1.0, np.nan], atol=1e-12)
    np.testing.assert_allclose(local.rayleigh_z[0, :3], 2.0 * np.array([2, 3, 2]) * order**2)
    np.testing.assert_allclose(local.corrected[0, 2], 1.0 - np.sqrt(np.pi) / (2.0 * np.sqrt(2.0)))


def test_local_order_of_independent_headings_is_what_the_correction_subtracts() -> None:
    run = with_headings(random_headings(4000, 10))  # all in one place: groups of ten
    local = local_alignment(run, directions_of_headings(run), 133.0)
    assert (local.group_size == 10).all()
    assert local.polar_order.mean() == pytest.approx(np.sqrt(np.pi) / (2.0 * np.sqrt(10)), rel=0.02)
    # chi^2 with two degrees of freedom: mean 2, and 5 % are above 5.99.
    assert local.rayleigh_z.mean() == pytest.approx(2.0, rel=0.05)
    assert (local.rayleigh_z > 5.99).mean() == pytest.approx(0.05, abs=0.01)
    assert local.pair_alignment.mean() == pytest.approx(0.0, abs=0.01)


def test_robots_in_a_hexagonal_lattice_have_psi_6_of_1_and_in_a_square_one_psi_4() -> None:
    side = 1000.0
    square = run_of(rows_of(lattice(10, 10, side / 10, SQUARE)[None]), side, periodic=True)
    np.testing.assert_allclose(np.abs(bond_order(square, 4)), 1.0)
    np.testing.assert_allclose(bond_order(square, 4).real, 1.0)
    hexagonal = run_of(rows_of(100.0 + lattice(9, 9, 50.0, HEXAGONAL)[None]))
    inside = np.zeros((9, 9), dtype=bool)
    inside[1:-1, 1:-1] = True
    psi = bond_order(hexagonal, 6)[0, inside.ravel()]
    np.testing.assert_allclose(psi, 1.0, atol=1e-9)


def test_bond_order_is_that_of_freud_and_of_chance_in_an_ideal_gas() -> None:
    import freud

    position = np.random.default_rng(3).uniform(0.0, 1000.0, (1, 400, 2))
    run = run_of(rows_of(position), periodic=True)
    psi = bond_order(run)
    box, points = freud_system(run)
    expected = freud.order.Hexatic(k=6).compute((box, points)).particle_order
    np.testing.assert_allclose(psi[0], expected, atol=2e-3)
    assert np.abs(psi).mean() == pytest.approx(np.sqrt(np.pi) / (2.0 * np.sqrt(6)), rel=0.1)
    shifted = run_of(rows_of((position + np.array([300.0, 700.0])) % 1000.0), periodic=True)
    np.testing.assert_allclose(bond_order(shifted), psi, atol=1e-9)


def test_bond_order_needs_more_than_k_robots() -> None:
    assert np.isnan(bond_order(run_of(rows_of(lattice(2, 3, 50.0, SQUARE)[None])), 6)).all()


def test_robots_in_one_place_have_a_bond_order_without_themselves() -> None:
    run = run_of(rows_of(np.full((1, 20, 2), 500.0)))
    np.testing.assert_allclose(bond_order(run), 1.0)  # offsets of 0 have direction 0


@pytest.mark.parametrize("centre", ["cm", "arena"])
def test_a_turning_disk_mills_and_its_sign_is_that_of_omega(centre: str) -> None:
    for sign in (1.0, -1.0):
        run = run_of(rows_of(disk_turning(sign * 0.5), period_s=0.1))
        tangential, momentum = milling(run, velocity(run), "cm" if centre == "cm" else "arena")
        assert np.isnan(tangential[0])
        # Chords lag behind tangents by half the angle of a step.
        np.testing.assert_allclose(tangential[1:], sign * np.cos(0.025), rtol=1e-3)
        np.testing.assert_allclose(momentum[1:], sign * np.cos(0.025), rtol=1e-3)


def test_a_swarm_that_goes_straight_does_not_mill() -> None:
    position = disk_turning(0.0) + 10.0 * np.arange(4)[:, None, None]
    tangential, momentum = milling(run := run_of(rows_of(position)), velocity(run))
    np.testing.assert_allclose(momentum[1:], 0.0, atol=1e-12)
    assert np.abs(tangential[1:]).max() < 0.2


def test_milling_does_not_see_periodic_borders() -> None:
    position = disk_turning(0.5)
    inside = milling(run := run_of(rows_of(position), periodic=True), velocity(run))
    shifted = (position + np.array([430.0, 510.0])) % 1000.0
    across = milling(run := run_of(rows_of(shifted), periodic=True), velocity(run))
    np.testing.assert_allclose(across, inside, atol=1e-9)


def test_the_centre_of_mass_is_found_across_the_border() -> None:
    position = np.array([[[990.0, 500.0], [30.0, 500.0]]])
    assert centre_of_mass(run_of(rows_of(position), periodic=True))[0] == pytest.approx([10.0, 500.0])
    assert centre_of_mass(run_of(rows_of(position)))[0] == pytest.approx([510.0, 500.0])
    spread = np.array([[[0.0, 500.0], [500.0, 500.0]]])
    assert np.isnan(centre_of_mass(run_of(rows_of(spread), periodic=True))[0, 0])


def test_the_centre_of_an_unknown_arena_is_refused() -> None:
    (run,) = trajectories_of(rows_of(disk_turning(0.5)), {})
    with pytest.raises(AnalysisError, match="what the arena is"):
        milling(run, velocity(run), "arena")


def test_one_robot_at_one_time_has_an_order_of_its_heading_and_nothing_else() -> None:
    run = run_of(rows_of(np.full((1, 1, 2), 500.0)))
    assert polar_order(directions_of_headings(run)).tolist() == [1.0]
    assert np.isnan(polar_order(directions_of_motion(run))).all()
    assert np.isnan(local_alignment(run, directions_of_headings(run), 133.0).polar_order).all()
    assert np.isnan(bond_order(run)).all()
    assert np.isnan(milling(run, velocity(run))).all()
