"""Units and axes of tracks: from the options, the names of columns, or the numbers themselves; and always said."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pogosim.calibration.reading import Warn
from pogosim.calibration.tracks import Floats, Tracks, continuous
from pogosim.calibration.unit_names import ANGLES_RAD, LENGTHS_MM, RARE_LENGTHS_MM
from pogosim.errors import CalibrationError

ARENA_TOLERANCE = 1.1  # tracks may extend over so much more than the arena: cameras are not perfect
SMALL_SHARE = 0.1  # of the arena; tracks within less suggest another unit
STRIDE_S = 0.4  # motion in which a direction shows
CLEAR_AGREEMENT = 0.6  # resultant length of angle less direction of motion, 0 to 1

Say = Callable[[str], None]


@dataclass(frozen=True)
class UnitOptions:
    """What the user says of the units.

    Attributes:
        length: mm, cm, m or px; None: not said.
        mm_per_pixel: Size of a pixel, needed for px.
        angle: rad or deg; None: not said.
        y_up: y points up and angles are counter-clockwise.
    """

    length: str | None = None
    mm_per_pixel: float | None = None
    angle: str | None = None
    y_up: bool = False


def in_millimetres(
    tracks: Tracks, column_unit: str | None, options: UnitOptions, arena_mm: Floats, say: Say, warn: Warn
) -> Tracks:
    """Convert positions to mm.

    Args:
        tracks: In the unit of the file.
        column_unit: Unit in the name of the column; None: it has none.
        options: They take precedence.
        arena_mm: Width and height of the arena. Shape (2,).
        say: Called with the unit that is used, and why.
        warn: Called with what is doubtful.

    Raises:
        CalibrationError: The size of a pixel is not known, or the tracks do not fit into the arena.
    """
    unit, why = options.length, "given"
    if unit is None and options.mm_per_pixel is not None:
        unit, why = "px", "given"
    if unit is None and column_unit:
        unit, why = column_unit, "name of the column"
    extent = np.nanmax(tracks.position_mm, axis=(0, 1)) - np.nanmin(tracks.position_mm, axis=(0, 1))
    if unit is None:
        unit, why = recognised_length(extent, arena_mm), "recognised by the size of the arena"
    if unit == "px" and options.mm_per_pixel is None:
        raise CalibrationError("positions in pixels need the size of a pixel: --mm-per-pixel MM")
    scale = (
        options.mm_per_pixel if unit == "px" and options.mm_per_pixel else (LENGTHS_MM | RARE_LENGTHS_MM).get(unit, 1.0)
    )
    size, arena = (f"{a:.0f} x {b:.0f} mm" for a, b in (extent * scale, arena_mm))
    if (extent * scale > ARENA_TOLERANCE * arena_mm).any():
        raise CalibrationError(
            f"tracks in {unit} ({why}) extend over {size}, but the arena is {arena}; give --length-unit, "
            "--mm-per-pixel, or the configuration of that arena"
        )
    if (extent * scale < SMALL_SHARE * arena_mm).all():
        warn(f"the tracks extend over {size} only, in an arena of {arena}: is {unit} their unit? (--length-unit)")
    scale_text = f" of {scale:g} mm" if unit == "px" else ""
    say(f"lengths: {unit}{scale_text} ({why}); the tracks extend over {size}, the arena over {arena}")
    return replace(tracks, position_mm=tracks.position_mm * scale, step_mm=tracks.step_mm * scale)


def recognised_length(extent: Floats, arena_mm: Floats) -> str:
    """Return the unit in which tracks fill the arena best, without leaving it; mm if none does."""
    share = {unit: float(np.max(extent * scale / arena_mm)) for unit, scale in LENGTHS_MM.items()}
    fitting = {unit: value for unit, value in share.items() if value <= ARENA_TOLERANCE}
    return max(fitting, key=lambda unit: fitting[unit]) if fitting else "mm"


def motion(tracks: Tracks) -> tuple[Floats, Floats]:
    """Return the direction of motion around each frame and the distance covered, in rad and mm; shape (frames, robots).

    NaN at ends of pieces.
    """
    half = tracks.frames_in(STRIDE_S / 2.0)
    direction = np.full(tracks.piece.shape, np.nan)
    distance = np.full(tracks.piece.shape, np.nan)
    if len(tracks.piece) <= 2 * half:
        return direction, distance
    step = tracks.position_mm[2 * half :] - tracks.position_mm[: -2 * half]
    together = (tracks.piece[2 * half :] == tracks.piece[: -2 * half]) & (tracks.piece[half:-half] >= 0)
    direction[half:-half] = np.where(together, np.arctan2(step[..., 1], step[..., 0]), np.nan)
    distance[half:-half] = np.where(together, np.hypot(step[..., 0], step[..., 1]), np.nan)
    return direction, distance


def agreement(angle_rad: Floats, tracks: Tracks) -> complex:
    """Compare headings with directions of motion, where robots are fast.

    Returns:
        Mean of exp(i (angle - direction)): its modulus is 1 if they differ by a constant, its argument that constant.
    """
    direction, distance = motion(tracks)
    both = np.isfinite(direction) & np.isfinite(angle_rad)
    if not both.any():
        return 0j
    fast = both & (distance > 0.5 * np.nanquantile(distance, 0.95))
    if not fast.any():
        return 0j
    return complex(np.mean(np.exp(1j * (angle_rad[fast] - direction[fast]))))


def in_radians(tracks: Tracks, column_unit: str | None, options: UnitOptions, say: Say, warn: Warn) -> Tracks:
    """Convert angles to rad, clockwise on the screen, 0 along +x; turned so that robots move along their heading.

    Args:
        tracks: Positions in mm, in the axes of the file; angles in the unit of the file.
        column_unit: Unit in the name of the column; None: it has none.
        options: They take precedence.
        say: Called with what is used, and why.
        warn: Called with what is doubtful.
    """
    if not tracks.has_angles:
        warn("the tracks have no angles: the direction of motion is used, which robots that stand or turn do not show")
        say("angles: none; directions of motion")
        return tracks
    known = options.angle or column_unit
    units = [known] if known else ["rad", "deg"]
    tries = {
        (unit, sign): agreement(sign * ANGLES_RAD[unit] * tracks.angle_rad, tracks)
        for unit, sign in itertools.product(units, (1, -1))
    }
    (unit, sign), found = max(tries.items(), key=lambda item: abs(item[1]))
    why = "given" if options.angle else "name of the column"
    if abs(found) < CLEAR_AGREEMENT:
        unit, sign, why = known or by_range(tracks.angle_rad), 1, why if known else "recognised by their range"
        warn(
            "the angles do not agree with the directions of motion, in radians or degrees, clockwise or not: robots "
            f"that hardly move, or another column? They are taken as they are, in {unit}"
        )
        say(f"angles: {unit} ({why})")
        return scaled_angles(tracks, ANGLES_RAD[unit])
    why = why if known else "recognised by the directions of motion"
    offset = math.atan2(found.imag, found.real)
    turned = f"; turned by {math.degrees(-offset):.0f} degrees, to the direction of motion" if abs(offset) > 0.1 else ""
    mirrored = "; their sign is changed, to agree with the directions of motion" if sign < 0 else ""
    say(f"angles: {unit} ({why}){mirrored}{turned}")
    scaled = scaled_angles(tracks, sign * ANGLES_RAD[unit])
    return replace(scaled, angle_rad=scaled.angle_rad - (offset if turned else 0.0))


def scaled_angles(tracks: Tracks, factor: float) -> Tracks:
    """Return tracks with other units of angles."""
    return replace(tracks, angle_rad=tracks.angle_rad * factor, step_rad=tracks.step_rad * abs(factor))


def by_range(angle: Floats) -> str:
    """Return the unit of angles that tell nothing but their range."""
    return "deg" if float(np.nanmax(np.abs(angle))) > 2.0 * math.pi + 0.1 else "rad"


def y_down(tracks: Tracks, options: UnitOptions, height_mm: float, say: Say) -> Tracks:
    """Turn the y axis down if it points up, within the height of the arena; angles in rad turn with it."""
    say("y axis: up (given), turned down" if options.y_up else "y axis: down (the default; --y-up if it points up)")
    if not options.y_up:
        return tracks
    position = tracks.position_mm * np.array([1.0, -1.0]) + np.array([0.0, height_mm])
    return replace(tracks, position_mm=position, angle_rad=-tracks.angle_rad)


def with_headings(tracks: Tracks, noise_mm: float) -> Tracks:
    """Give tracks without angles the directions of motion, where these exceed the noise of the tracker."""
    if tracks.has_angles:
        return tracks
    direction, distance = motion(tracks)
    return continuous(replace(tracks, angle_rad=np.where(distance > max(3.0, 6.0 * noise_mm), direction, np.nan)))
