"""Tracks of robots on a regular grid of frames, cut where a robot is lost or taken for another one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.calibration.reading import TrackTable, Warn
from pogosim.errors import CalibrationError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

MOST_FRAMES = 1_000_000  # eleven hours at 25 frames/s
LONGEST_GAP_S = 0.25  # that a track bridges; robots turn by less than half a turn in it
LEAST_TRACK_S = 2.0
LEAST_LENGTH_S = 5.0
SLOWEST_FPS = 2.0


@dataclass(frozen=True)
class Tracks:
    """Poses of robots in frames; NaN where a robot was not seen.

    Attributes:
        position_mm: Shape (frames, robots, 2), in the axes of the simulator: x to the right, y down.
        angle_rad: Shape (frames, robots), clockwise on the screen, continuous within a piece; NaN also where the
            heading is not known.
        piece: Shape (frames, robots); number of the piece of a track without gaps, -1 where the robot was not seen.
        frame_s: Time from frame to frame.
        has_angles: The tracker knows the heading; otherwise it is the direction of motion.
        step_mm: Positions are rounded to multiples of it; 0: they are not.
        step_rad: The same of angles.
    """

    position_mm: Floats
    angle_rad: Floats
    piece: Ints
    frame_s: float
    has_angles: bool = True
    step_mm: float = 0.0
    step_rad: float = 0.0

    @property
    def robots(self) -> int:
        """Number of robots."""
        return int(self.position_mm.shape[1])

    @property
    def length_s(self) -> float:
        """Time from the first frame to the last one."""
        return (len(self.position_mm) - 1) * self.frame_s

    def frames_in(self, lag_s: float) -> int:
        """Number of frames nearest to a time, at least 1."""
        return max(1, round(lag_s / self.frame_s))


def frame_numbers(table: TrackTable, fps: float | None, warn: Warn) -> tuple[Ints, float]:
    """Return the number of the frame of each row, from 0, and the time between frames in s.

    Raises:
        CalibrationError: There are no times, or they cannot be seconds.
    """
    rows = table.rows
    if fps is not None:
        frames = rows["frame"] if "frame" in rows else rows["time"]
        check_length(frames.to_numpy(), table.source, "frame")
        numbers = np.rint(frames.to_numpy()).astype(np.int64)
        return numbers - numbers.min(), 1.0 / fps
    if "time" not in rows:
        raise CalibrationError(f"{table.source} has frame numbers but no times; say how many frames a second: --fps N")
    time_s = rows["time"].to_numpy() * (1e-3 if table.units.get("time") == "ms" else 1.0)
    if len(np.unique(time_s)) < 2:
        raise CalibrationError(f"{table.source} holds one moment only; expected tracks over some time")
    frame_s = time_between_frames(time_s, rows["id"].to_numpy(), table.source)
    check_length(time_s / frame_s, table.source, f"frame of {frame_s:.3g} s")
    since = (time_s - time_s.min()) / frame_s
    # Frames may begin between two whole ones, if the first row is late.
    since = since - np.angle(np.mean(np.exp(2j * np.pi * since))) / (2.0 * np.pi)
    numbers = np.rint(since).astype(np.int64)
    jitter = float(np.std(since - numbers))
    if jitter > 0.1:
        warn(f"{table.source}: the times are irregular by {jitter:.0%} of a frame; they are rounded to whole frames")
    return numbers - numbers.min(), frame_s


def check_length(frames: Floats, source: str, unit: str) -> None:
    """Check that a film is not longer than memory allows, as it would be with one wrong time.

    Raises:
        CalibrationError: It is; says where.
    """
    if np.ptp(frames) > MOST_FRAMES:
        middle = float(np.median(frames))
        row = int(np.argmax(np.abs(frames - middle)))
        raise CalibrationError(
            f"{source}: row {row + 1} is {abs(frames[row] - middle):.3g} times a {unit} away from the middle of the "
            f"others; expected {MOST_FRAMES} frames at most: correct its time, or remove it"
        )


def time_between_frames(time_s: Floats, ids: npt.NDArray[Any], source: str) -> float:
    """Return the time between frames, more precisely than the median over the rows of each robot.

    Raises:
        CalibrationError: It is too long for tracks.
    """
    order = np.lexsort((time_s, ids.astype(str)))
    steps, same = np.diff(time_s[order]), ids[order][1:] == ids[order][:-1]
    steps = steps[same & (steps > 0.0)]
    usual = float(np.median(steps)) if len(steps) else float(np.ptp(time_s))
    if usual * SLOWEST_FPS > 1.0:
        raise CalibrationError(
            f"{source}: {usual:g} s from row to row; expected {SLOWEST_FPS:g} frames a second or more; "
            "if the times are frame numbers, give --fps N; if they are milliseconds, call the column time_ms"
        )
    frames = np.rint(steps / usual)
    near = frames <= LONGEST_GAP_S / usual + 1.0
    return float(steps[near].sum() / frames[near].sum()) if frames[near].any() else usual


def on_grid(table: TrackTable, frames: Ints, frame_s: float, warn: Warn) -> Tracks:
    """Put rows on a grid of frames; position and angle keep their units.

    Raises:
        CalibrationError: The tracks are too short.
    """
    rows = table.rows.assign(frame_number=frames)
    repeated = rows.duplicated(["frame_number", "id"])
    if repeated.any():
        warn(f"{table.source}: {repeated.sum()} rows of a robot that the same frame has already are left out")
        rows = rows[~repeated]
    seen = rows.groupby("id")["frame_number"].transform("size")
    brief = seen * frame_s < LEAST_TRACK_S
    if brief.any():
        warn(f"{table.source}: {rows['id'][brief].nunique()} tracks shorter than {LEAST_TRACK_S:g} s are left out")
        rows = rows[~brief]
    last = int(rows["frame_number"].max() - rows["frame_number"].min()) if len(rows) else 0
    if last * frame_s < LEAST_LENGTH_S:
        raise CalibrationError(
            f"{table.source}: tracks of {last * frame_s:.3g} s; expected {LEAST_LENGTH_S:g} s or more, and a minute "
            "or more for good results"
        )
    ids = {name: number for number, name in enumerate(sorted(rows["id"].unique(), key=str))}
    at = (rows["frame_number"].to_numpy() - int(rows["frame_number"].min()), rows["id"].map(ids).to_numpy())
    position = np.full((last + 1, len(ids), 2), np.nan)
    angle = np.full((last + 1, len(ids)), np.nan)
    position[at] = rows[["x", "y"]].to_numpy()
    if "angle" in rows:
        angle[at] = rows["angle"].to_numpy()
    piece = np.where(np.isfinite(position[..., 0]), 0, -1)
    return Tracks(position, angle, piece, frame_s, "angle" in rows)


def jump_limit_mm(tracks: Tracks, radius_mm: float) -> float:
    """Return the distance from a frame to the next that no robot covers: a radius and three times the fastest usual."""
    step = np.hypot(*np.moveaxis(np.diff(tracks.position_mm, axis=0), -1, 0))
    usual = np.nanquantile(step, 0.95) if np.isfinite(step).any() else 0.0
    return radius_mm + 3.0 * float(usual)


def cut(tracks: Tracks, radius_mm: float, warn: Warn) -> Tracks:
    """Cut tracks at gaps and at jumps. Lengths in mm, angles in any unit."""
    limit_mm = jump_limit_mm(tracks, radius_mm)
    piece = np.full(tracks.piece.shape, -1, dtype=np.int64)
    gaps = jumps = 0
    for robot in range(tracks.robots):
        seen = np.flatnonzero(np.isfinite(tracks.position_mm[:, robot, 0]))
        wait = np.diff(seen)
        leap = np.hypot(*np.diff(tracks.position_mm[seen, robot], axis=0).T) > limit_mm * wait
        gap = wait * tracks.frame_s > LONGEST_GAP_S
        piece[seen, robot] = np.concatenate([[0], np.cumsum(gap | leap)])
        gaps, jumps = gaps + int(gap.sum()), jumps + int((leap & ~gap).sum())
    if jumps:
        warn(
            f"{jumps} jumps of more than {limit_mm:.0f} mm from a frame to the next: tracks are cut there (robots "
            "taken for each other?)"
        )
    if gaps:
        warn(f"{gaps} gaps of more than {LONGEST_GAP_S:g} s: tracks are cut there")
    return replace(tracks, piece=piece)


def continuous(tracks: Tracks) -> Tracks:
    """Make angles in rad continuous within each piece, beyond (-pi, pi]."""
    angle = np.full(tracks.angle_rad.shape, np.nan)
    for robot in range(tracks.robots):
        for number in np.unique(tracks.piece[:, robot]):
            here = np.flatnonzero((tracks.piece[:, robot] == number) & np.isfinite(tracks.angle_rad[:, robot]))
            angle[here, robot] = np.unwrap(tracks.angle_rad[here, robot])
    return replace(tracks, angle_rad=angle)
