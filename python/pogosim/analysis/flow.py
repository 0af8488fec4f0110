"""The swarm as a flow: its velocity field on a grid, and how it rotates and deforms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pogosim.analysis.arena import Arena, Floats
from pogosim.analysis.floor import grid_of
from pogosim.analysis.neighbourhood import tree_of
from pogosim.analysis.trajectories import Trajectories

MIN_ROBOTS = 4


@dataclass(frozen=True)
class VelocityField:
    """Velocity and its gradient at the centres of cells. Rows from the top, as y downwards. NaN where it is not known.

    Rotation is positive from the x axis towards the y axis: clockwise as seen, as the column `angle` counts.
    """

    velocity: Floats  # (rows, columns, 2), mm/s
    gradient: Floats  # (rows, columns, 2, 2), 1/s; [..., a, b] is the derivative of v_a by b

    @property
    def vorticity(self) -> Floats:
        """Vorticity d v_y / dx - d v_x / dy, 1/s: twice the angular velocity of a rigid rotation."""
        return np.asarray(self.gradient[..., 1, 0] - self.gradient[..., 0, 1])

    @property
    def divergence(self) -> Floats:
        """Divergence d v_x / dx + d v_y / dy, 1/s: positive where robots go apart."""
        return np.asarray(self.gradient[..., 0, 0] + self.gradient[..., 1, 1])

    @property
    def enstrophy(self) -> Floats:
        """Enstrophy density, half the square of the vorticity, 1/s^2."""
        return np.asarray(self.vorticity**2 / 2.0)

    @property
    def swirling_strength(self) -> Floats:
        """Imaginary part of the eigenvalues of the gradient, rad/s; 0 where they are real.

        The angular velocity at which paths go round; a shear has vorticity but no swirling strength. Source: Zhou,
        Adrian, Balachandar, Kendall, "Mechanisms for generating coherent packets of hairpin vortices in channel flow",
        Journal of Fluid Mechanics 387, 1999.
        """
        g = self.gradient
        determinant = g[..., 0, 0] * g[..., 1, 1] - g[..., 0, 1] * g[..., 1, 0]
        return np.asarray(np.sqrt(np.maximum(determinant - self.divergence**2 / 4.0, 0.0)))

    @property
    def okubo_weiss(self) -> Floats:
        """Okubo-Weiss parameter, normal strain^2 + shear strain^2 - vorticity^2, 1/s^2: negative in a vortex.

        Source: Okubo, Deep-Sea Research 17, 1970; Weiss, Physica D 48, 1991.
        """
        g = self.gradient
        normal, shear = g[..., 0, 0] - g[..., 1, 1], g[..., 1, 0] + g[..., 0, 1]
        return np.asarray(normal**2 + shear**2 - self.vorticity**2)


def flow_bounds(run: Trajectories) -> tuple[Floats, Floats]:
    """Return the corners of the grid: those of the arena, or of all positions if the arena is not known."""
    if run.arena.polygons:
        return run.arena.bounds_mm
    position = run.position_mm[run.is_there]
    return position.min(axis=0), position.max(axis=0)


def velocity_fields(
    run: Trajectories, velocity: Floats, radius_mm: float, shape: tuple[int, int] = (64, 64)
) -> Iterator[tuple[float, VelocityField]]:
    """Yield the velocity field at each time.

    At the centre of each cell, a plane is fitted to the velocities of the robots around it by least squares, with the
    weights (1 - (d / radius)^2)^2. So a flow that is linear in x and y, such as a rotation, comes out exactly, however
    robots are spread (local linear regression; Fan, Gijbels, "Local Polynomial Modelling and Its Applications", 1996).
    There are values only where at least four robots are within the radius, on all sides of the cell: their mean place
    is less than one standard deviation from it.

    Args:
        run: Positions of the robots.
        velocity: Shape (T, N, 2), mm/s; NaN: the robot is left out.
        radius_mm: How far robots count; the resolution of the field, however fine the grid is.
        shape: Columns and rows of the grid, over `flow_bounds`.

    Yields:
        Time in s, and the field.
    """
    cells = grid_of(flow_bounds(run), shape)
    for time, position, own in zip(run.time_s, run.position_mm, velocity, strict=True):
        use = np.isfinite(position).all(axis=1) & np.isfinite(own).all(axis=1)
        yield float(time), velocity_field(run.arena, position[use], own[use], cells, radius_mm)


def velocity_field(
    arena: Arena, position_mm: Floats, velocity: Floats, cells_mm: Floats, radius_mm: float
) -> VelocityField:
    """Fit the velocity field at places; see `velocity_fields`.

    Args:
        arena: Across periodic borders, the nearest images count.
        position_mm: Shape (n, 2), finite.
        velocity: Shape (n, 2), mm/s, finite.
        cells_mm: Places, shape (rows, columns, 2).
        radius_mm: How far robots count.
    """
    shape = cells_mm.shape[:2]
    places = cells_mm.reshape(-1, 2)
    if len(position_mm) < MIN_ROBOTS:
        return VelocityField(np.full((*shape, 2), np.nan), np.full((*shape, 2, 2), np.nan))
    cell, robot, distance = near(arena, places, position_mm, radius_mm)
    weight = (1.0 - (distance / radius_mm) ** 2) ** 2
    offset = arena.minimum_image(position_mm[robot] - places[cell])

    def total(values: Floats) -> Floats:
        return np.asarray(np.bincount(cell, values, minlength=len(places)), dtype=float)

    with np.errstate(invalid="ignore", divide="ignore"):
        all_weights = total(weight)
        centre = np.stack([total(weight * offset[:, a]) for a in (0, 1)], axis=1) / all_weights[:, None]
        mean = np.stack([total(weight * velocity[robot, a]) for a in (0, 1)], axis=1) / all_weights[:, None]
        arm = offset - centre[cell]
        xx, xy, yy = (total(weight * arm[:, a] * arm[:, b]) / all_weights for a, b in ((0, 0), (0, 1), (1, 1)))
        determinant = xx * yy - xy**2
        inverse = np.stack([yy, -xy, -xy, xx], axis=1).reshape(-1, 2, 2) / determinant[:, None, None]
        product = np.stack([total(weight * velocity[robot, a] * arm[:, b]) for a in (0, 1) for b in (0, 1)], axis=1)
        gradient = (product / all_weights[:, None]).reshape(-1, 2, 2) @ inverse
        value = mean - (gradient @ centre[:, :, None])[:, :, 0]
        off_centre = np.einsum("na,nab,nb->n", centre, inverse, centre)
        good = (total(np.ones(len(cell))) >= MIN_ROBOTS) & (determinant > 1e-3 * (xx + yy) ** 2) & (off_centre < 1.0)
    value[~good], gradient[~good] = np.nan, np.nan
    return VelocityField(value.reshape(*shape, 2), gradient.reshape(*shape, 2, 2))


def near(
    arena: Arena, places: Floats, position_mm: Floats, radius_mm: float
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Floats]:
    """Return all pairs of a place and a position within the radius: both indices, and the distance."""
    trees = [tree_of(points, arena)[0] for points in (places, position_mm)]
    found = trees[0].sparse_distance_matrix(trees[1], radius_mm, output_type="ndarray")
    return found["i"].astype(np.int64), found["j"].astype(np.int64), found["v"]
