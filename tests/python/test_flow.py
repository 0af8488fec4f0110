from __future__ import annotations

import numpy as np
import pytest
from pogosim.analysis.flow import VelocityField, velocity_fields
from pogosim.analysis.motion import velocity
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from swarms import Floats, metadata_of, rows_of


def places() -> Floats:
    return np.random.default_rng(6).uniform(0.0, 1000.0, (500, 2))


def run_of(position: Floats, periodic: bool = False) -> Trajectories:
    (run,) = trajectories_of(rows_of(position), metadata_of(1000.0, periodic))
    return run


def field_of(gradient: list[list[float]], periodic: bool = False) -> VelocityField:
    """The field of robots whose velocity is linear in x and y, around (500, 500)."""
    position = places()
    velocity = (position - 500.0) @ np.array(gradient).T + np.array([5.0, 2.0])
    ((_, field),) = velocity_fields(run_of(position[None], periodic), velocity[None], 150.0, (20, 10))
    return field


def known(values: Floats) -> Floats:
    found = values[np.isfinite(values)]
    assert found.size > 0.9 * values.size
    return found


def test_a_rotation_has_twice_its_angular_velocity_as_vorticity_clockwise_as_seen() -> None:
    # From x to y: v_x = -omega y, v_y = omega x.
    field = field_of([[0.0, -0.3], [0.3, 0.0]])
    assert field.vorticity.shape == (10, 20)
    np.testing.assert_allclose(known(field.vorticity), 0.6)
    np.testing.assert_allclose(known(field.enstrophy), 0.18)
    np.testing.assert_allclose(known(field.swirling_strength), 0.3)
    np.testing.assert_allclose(known(field.okubo_weiss), -0.36)
    np.testing.assert_allclose(known(field.divergence), 0.0, atol=1e-12)
    np.testing.assert_allclose(known(field_of([[0.0, 0.3], [-0.3, 0.0]]).vorticity), -0.6)


def test_velocities_of_cells_are_those_of_the_flow_there() -> None:
    field = field_of([[0.0, -0.3], [0.3, 0.0]])
    row, column = 4, 15  # centre (775, 450)
    assert field.velocity[row, column] == pytest.approx([5.0 - 0.3 * -50.0, 2.0 + 0.3 * 275.0])


def test_a_shear_has_vorticity_but_does_not_swirl() -> None:
    field = field_of([[0.0, 0.4], [0.0, 0.0]])
    np.testing.assert_allclose(known(field.vorticity), -0.4)
    np.testing.assert_allclose(known(field.swirling_strength), 0.0, atol=1e-6)
    np.testing.assert_allclose(known(field.okubo_weiss), 0.0, atol=1e-9)


def test_a_strain_has_no_vorticity_and_a_positive_okubo_weiss_parameter() -> None:
    field = field_of([[0.2, 0.0], [0.0, -0.2]])
    np.testing.assert_allclose(known(field.vorticity), 0.0, atol=1e-9)
    np.testing.assert_allclose(known(field.okubo_weiss), 0.16)


def test_robots_that_go_apart_diverge() -> None:
    np.testing.assert_allclose(known(field_of([[0.2, 0.0], [0.0, 0.2]]).divergence), 0.4)


def test_the_vorticity_of_a_turning_disk_is_found_from_its_trajectories() -> None:
    omega, period = 0.1, 0.1
    arm = places() - 500.0
    phase = omega * period * np.arange(3)
    turned = [arm @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) for a in phase]
    (run,) = trajectories_of(rows_of(500.0 + np.stack(turned), period_s=period), metadata_of())
    fields = [field for _, field in velocity_fields(run, velocity(run), 150.0, (10, 10))]
    assert np.isnan(fields[0].vorticity).all()  # no velocity yet
    np.testing.assert_allclose(known(fields[2].vorticity), 2.0 * omega, rtol=1e-3)


def test_a_field_does_not_see_periodic_borders() -> None:
    position = places()
    velocity = np.sin(2.0 * np.pi * position[:, ::-1] / 1000.0)
    shifted = (position + np.array([500.0, 300.0])) % 1000.0
    ((_, here),) = velocity_fields(run_of(position[None], True), velocity[None], 150.0, (10, 10))
    ((_, there),) = velocity_fields(run_of(shifted[None], True), velocity[None], 150.0, (10, 10))
    np.testing.assert_allclose(there.vorticity, np.roll(here.vorticity, (3, 5), (0, 1)), atol=1e-9)
    assert np.isfinite(here.vorticity[0]).all()


def test_cells_without_robots_on_all_sides_have_no_value() -> None:
    left = places()
    left = left[left[:, 0] < 500.0]
    ((_, field),) = velocity_fields(run_of(left[None]), np.ones_like(left)[None], 150.0, (20, 10))
    assert np.isnan(field.velocity[:, 12:]).all()
    assert np.isfinite(field.velocity[1:-1, 1:8]).all()


def test_a_cell_beside_all_robots_near_it_has_no_value() -> None:
    generator = np.random.default_rng(3)
    beside = np.stack([generator.uniform(560.0, 640.0, 30), generator.uniform(420.0, 580.0, 30)], axis=1)
    ((_, field),) = velocity_fields(run_of(beside[None]), np.ones_like(beside)[None], 150.0, (5, 5))
    assert np.isnan(field.velocity[2, 2]).all()  # its centre is (500, 500)


@pytest.mark.parametrize("robots", [1, 3])
def test_few_robots_are_no_flow(robots: int) -> None:
    position = places()[:robots]
    ((_, field),) = velocity_fields(run_of(position[None]), np.ones_like(position)[None], 150.0, (5, 5))
    assert np.isnan(field.gradient).all()


def test_robots_in_a_row_have_no_gradient() -> None:
    row = np.stack([np.linspace(400.0, 600.0, 20), np.full(20, 500.0)], axis=1)
    ((_, field),) = velocity_fields(run_of(row[None]), np.ones_like(row)[None], 150.0, (5, 5))
    assert np.isnan(field.gradient).all()
