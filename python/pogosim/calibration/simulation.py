"""Runs of the robots that were tracked: same program, same number, same start, seen at the same moments."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from pogosim.batch.rows import Runs
from pogosim.calibration.parameters import BIAS
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.errors import CalibrationError

PLACEMENT = ("nb", "x", "y", "angle", "poses", "area", "initial_formation")
OUTPUTS = (
    *("data_logger_fields", "data_logger_category", "message_log"),
    *("frames_name", "console_filename", "delete_old_files"),
)

# Runs write their rows, and nothing else.
ROWS_ALONE = {"enable_data_logging": True, "enable_console_logging": False, "save_video_period": -1}

Values = Mapping[str, float]
Bias = tuple[int, int]


@dataclass(frozen=True)
class Candidate:
    """Values to try."""

    values: tuple[tuple[str, float], ...]
    bias: Bias
    seed: int

    @staticmethod
    def of(values: Values, bias: Bias, seed: int) -> Candidate:
        """Return a candidate with values by key."""
        return Candidate(tuple(sorted(values.items())), bias, seed)


def trial(entries: dict[str, Any], category: str, own: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration for trial runs: with other keys of a category, placed by them, and with rows alone."""
    made = {key: value for key, value in copy.deepcopy(entries).items() if key not in OUTPUTS}
    entry = {key: value for key, value in made["objects"][category].items() if key not in PLACEMENT}
    made["objects"][category] = {**entry, **own}
    return {**made, "data_logger_category": [category], **ROWS_ALONE}


def rows_of(runs: Runs, configurations: Sequence[dict[str, Any]], seeds: Sequence[int]) -> list[pd.DataFrame]:
    """Run configurations, one run each; returns the rows of each.

    Raises:
        ToolError: A run fails; says what the simulator says.
    """
    rows: dict[int, pd.DataFrame] = {}
    for done in runs.rows_of(configurations, [[seed] for seed in seeds]):
        if done.rows is None:
            raise CalibrationError(f"{runs.program} failed in a trial run: {done.problem}")
        rows[done.number] = done.rows
    return [rows[number] for number in range(len(configurations))]


@dataclass(frozen=True)
class Simulator:
    """A program and a scene in which a category of robots is tried with other values.

    Attributes:
        runs: Does runs of the program.
        configuration: The user's; its category is changed.
        category: Name of the entry in `objects`.
        time_step_s: Its time step.
        poses: x, y in mm and angle in rad of each robot at the start. Shape (robots, 3).
        tracks: When and where robots are seen.
    """

    runs: Runs
    configuration: dict[str, Any]
    category: str
    time_step_s: float
    poses: Floats
    tracks: Tracks

    def configuration_of(self, candidate: Candidate) -> dict[str, Any]:
        """Return the configuration of a run."""
        own: dict[str, Any] = {key: value if value > 0.0 else 0 for key, value in candidate.values}
        own[BIAS] = list(candidate.bias)
        own["poses"] = [[float(value) for value in pose] for pose in self.poses]
        return {
            **trial(self.configuration, self.category, own),
            "simulation_time": self.tracks.length_s + 2.0 * self.tracks.frame_s,
            "save_data_period": self.period_s(),
        }

    def period_s(self) -> float:
        """Return the time between rows: that of the frames, if it is a multiple of the time step, or else one step."""
        step_s = self.time_step_s
        steps = self.tracks.frame_s / step_s
        return round(steps) * step_s if steps > 0.5 and abs(steps - round(steps)) < 1e-3 * steps else step_s

    def simulate(self, candidates: Sequence[Candidate]) -> list[pd.DataFrame]:
        """Run candidates.

        Returns:
            For each, the columns time (s), robot_id, x, y (mm), angle (rad).

        Raises:
            ToolError: A run fails; says what the simulator says.
        """
        made = [self.configuration_of(candidate) for candidate in candidates]
        return rows_of(self.runs, made, [candidate.seed for candidate in candidates])

    def seen(self, rows: pd.DataFrame) -> Tracks:
        """Return a run as the tracker would have seen it: at its frames, with its gaps, without its errors."""
        frames_s = np.arange(len(self.tracks.piece)) * self.tracks.frame_s
        position = np.empty(self.tracks.position_mm.shape)
        angle = np.empty(self.tracks.angle_rad.shape)
        for robot, (_, own) in enumerate(rows.groupby("robot_id")):
            time_s = own["time"].to_numpy(dtype=float)
            for axis, name in enumerate("xy"):
                position[:, robot, axis] = np.interp(frames_s, time_s, own[name].to_numpy(dtype=float))
            angle[:, robot] = np.interp(frames_s, time_s, np.unwrap(own["angle"].to_numpy(dtype=float)))
        hidden = self.tracks.piece < 0
        position[hidden] = np.nan
        unknown = ~np.isfinite(self.tracks.angle_rad) if self.tracks.has_angles else hidden
        angle[unknown] = np.nan
        return replace(self.tracks, position_mm=position, angle_rad=angle)
