"""What several metrics of `pogosim analyze collective` need of a run, computed once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import pandas as pd

from pogosim.analysis import motion
from pogosim.analysis.arena import Floats
from pogosim.analysis.correlations import VectorCorrelation, vector_correlation
from pogosim.analysis.directions import directions_of_headings, unit_vectors
from pogosim.analysis.flow import blocks_of_fields
from pogosim.analysis.order import LocalAlignment, local_alignment
from pogosim.analysis.trajectories import Trajectories, need_columns
from pogosim.defaults import MIN_SPEED_MM_S

VORTICITY_BINS = 80


@dataclass(frozen=True)
class Settings:
    """What the command line says; the same for all runs."""

    direction: Literal["velocity", "heading"] = "velocity"
    min_speed_mm_s: float = MIN_SPEED_MM_S
    psi_k: int = 6
    gr_rmax_mm: float = 200.0
    gr_dr_mm: float = 2.0
    sk_shape: tuple[int, int] = (128, 128)
    v2_ref_mm2_s2: float | None = None  # None: the mean of all runs
    vorticity_shape: tuple[int, int] = (64, 64)
    milling_centre: Literal["cm", "arena"] = "cm"
    correlation_rmax_mm: float = 200.0
    correlation_dr_mm: float = 2.0
    fluctuations: bool = False
    vorticity_range: float = 1.0  # of the distribution, 1/s; the same for all runs, so that they can be averaged


@dataclass(frozen=True)
class Vortices:
    """Velocity fields of a run: their means at each time, over time, and the distribution of vorticity."""

    at_times: pd.DataFrame
    density: Floats  # (bins,), of vorticity, s
    velocity: Floats  # (rows, columns, 2), mean over time
    vorticity: Floats  # (rows, columns), mean over time


class Swarm:
    """A run and what follows from it."""

    def __init__(self, run: Trajectories, settings: Settings) -> None:
        """Nothing is computed before it is asked for."""
        self.run = run
        self.settings = settings

    @cached_property
    def velocity(self) -> Floats:
        """Velocities, shape (T, N, 2), mm/s."""
        return motion.velocity(self.run)

    @cached_property
    def direction(self) -> Floats:
        """Unit vectors of velocities or headings, shape (T, N, 2)."""
        if self.settings.direction == "velocity":
            return unit_vectors(self.velocity, self.settings.min_speed_mm_s)
        need_columns(self.run.rows, ["angle"])
        return directions_of_headings(self.run)

    @cached_property
    def local(self) -> LocalAlignment:
        """Alignment of neighbours."""
        return local_alignment(self.run, self.direction, self.run.reach_mm)

    @cached_property
    def correlation(self) -> VectorCorrelation:
        """Correlation of velocities, or of headings."""
        settings = self.settings
        vector = self.velocity if settings.direction == "velocity" else self.direction
        greatest, width = settings.correlation_rmax_mm, settings.correlation_dr_mm
        return vector_correlation(self.run, vector, greatest, width, settings.fluctuations)

    @cached_property
    def vortices(self) -> Vortices:
        """Velocity fields, without keeping them all."""
        settings = self.settings
        columns, rows = settings.vorticity_shape
        edges = np.linspace(-settings.vorticity_range, settings.vorticity_range, VORTICITY_BINS + 1)
        counted, cells = np.zeros(VORTICITY_BINS), 0
        parts: list[dict[str, Floats]] = []
        # Sums over times, by cell.
        known, velocity, vorticity = np.zeros(rows * columns), np.zeros((2, rows * columns)), np.zeros(rows * columns)
        for block in blocks_of_fields(self.run, self.velocity, self.run.reach_mm, settings.vorticity_shape):
            here = block.field
            turning, okubo_weiss = here.vorticity, here.okubo_weiss
            own = {
                "vorticity_per_s": turning,
                "abs_vorticity_per_s": np.abs(turning),
                "enstrophy_per_s2": here.enstrophy,
                "swirling_strength_rad_s": here.swirling_strength,
                "okubo_weiss_per_s2": okubo_weiss,
                "vortex_fraction": okubo_weiss < 0.0,
            }
            found = np.bincount(block.time, minlength=block.length)
            with np.errstate(invalid="ignore"):
                means = {
                    name: np.bincount(block.time, values, minlength=block.length) / found
                    for name, values in own.items()
                }
            share = found / (rows * columns)
            parts.append({"time_s": self.run.time_s[block.times], **means, "known_fraction": share})
            counted += np.histogram(turning, edges)[0]
            cells += len(block.cell)
            known += np.bincount(block.cell, minlength=len(known))
            velocity += [np.bincount(block.cell, part, minlength=len(known)) for part in here.velocity.T]
            vorticity += np.bincount(block.cell, turning, minlength=len(known))
        with np.errstate(invalid="ignore"):
            density = counted / (cells * np.diff(edges)) if cells else np.full(VORTICITY_BINS, np.nan)
            return Vortices(
                pd.DataFrame({name: np.concatenate([own[name] for own in parts]) for name in parts[0]}),
                density,
                (velocity / known).T.reshape(rows, columns, 2),
                (vorticity / known).reshape(rows, columns),
            )


def mean_of_robots(values: Floats) -> Floats:
    """Return the mean over the robots that have a value, at each time. Shape (T, N) to (T,), NaN without any."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.nansum(values, axis=1) / np.isfinite(values).sum(axis=1))
