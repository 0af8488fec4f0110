"""Coordinates that a tracker rounds, to whole pixels for instance.

Rounding is an error that is not independent from frame to frame: a robot at rest shows none of it, and one in motion
up to half a step. So simulated tracks are rounded like the measured ones. Random digits below a step, added to both,
keep their jitter a smooth function of the parameters (L. Schuchman, "Dither signals and their effect on quantization
noise", IEEE Transactions on Communication Technology 12(4), 1964).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pogosim.calibration.tracks import Floats, Tracks

LEAST_MM, LEAST_RAD = 0.05, 5e-4  # finer steps do not show beside the resolution of jitter
OF_UNIFORM = 1.0 / math.sqrt(12.0)  # standard deviation of a uniform distribution per width
TOLERANCE = 1e-3  # of a step
FEWEST = 3  # different values that can tell a step


def step_of(values: Floats) -> float:
    """Return the step of which all values are multiples, except for a common offset; 0: there is none."""
    different = np.unique(values[np.isfinite(values)])
    if len(different) < FEWEST:
        return 0.0
    steps = np.diff(different)
    # What is left of equal decimals in floating point is no step.
    step = float(steps[steps > 1e-9 * np.abs(different).max()].min(initial=np.inf))
    if not math.isfinite(step):
        return 0.0
    # A step of many decimals is measured better across all values.
    step = float(np.ptp(different)) / max(round(float(np.ptp(different)) / step), 1)
    away = (different - different[0]) / step
    return step if float(np.abs(away - np.rint(away)).max()) < TOLERANCE else 0.0


def with_steps(tracks: Tracks) -> Tracks:
    """Find the steps of coordinates and of angles, in the units of the tracks."""
    step = min(step_of(tracks.position_mm[..., 0]), step_of(tracks.position_mm[..., 1]))
    return replace(tracks, step_mm=step, step_rad=step_of(tracks.angle_rad) if tracks.has_angles else 0.0)


def noticed(tracks: Tracks) -> Tracks:
    """Forget steps that are too fine to matter. Tracks in mm and rad."""
    return replace(
        tracks,
        step_mm=tracks.step_mm if tracks.step_mm > LEAST_MM else 0.0,
        step_rad=tracks.step_rad if tracks.step_rad > LEAST_RAD else 0.0,
    )


def rounding_noise(tracks: Tracks) -> tuple[float, float]:
    """Return the standard deviation of the error of rounding, in mm and in rad."""
    return OF_UNIFORM * tracks.step_mm, OF_UNIFORM * tracks.step_rad


def in_words(tracks: Tracks) -> str:
    """Say to what coordinates are rounded; empty: to nothing."""
    steps = [
        f"{what} to {step:.2g} {unit} (noise of {noise:.2g} {unit})"
        for what, step, unit, noise in zip(
            ("positions", "angles"),
            (tracks.step_mm, tracks.step_rad),
            ("mm", "rad"),
            rounding_noise(tracks),
            strict=True,
        )
        if step > 0.0
    ]
    return ", ".join(steps)


def rounded(tracks: Tracks) -> Tracks:
    """Round as the tracker does."""
    position, angle = tracks.position_mm, tracks.angle_rad
    if tracks.step_mm > 0.0:
        position = np.rint(position / tracks.step_mm) * tracks.step_mm
    if tracks.step_rad > 0.0:
        angle = np.rint(angle / tracks.step_rad) * tracks.step_rad
    return replace(tracks, position_mm=position, angle_rad=angle)


def with_random_digits(tracks: Tracks, draws: np.random.Generator) -> Tracks:
    """Add what rounding may have taken away."""
    position, angle = tracks.position_mm, tracks.angle_rad
    if tracks.step_mm > 0.0:
        position = position + tracks.step_mm * draws.uniform(-0.5, 0.5, position.shape)
    if tracks.step_rad > 0.0:
        angle = angle + tracks.step_rad * draws.uniform(-0.5, 0.5, angle.shape)
    return replace(tracks, position_mm=position, angle_rad=angle)
