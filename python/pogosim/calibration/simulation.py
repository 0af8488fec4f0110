"""Runs of the robots that were tracked: same program, same number, same start, seen at the same moments."""

from __future__ import annotations

import copy
import os
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.calibration.errors import CalibrationError
from pogosim.calibration.parameters import BIAS
from pogosim.calibration.tracks import Floats, Tracks
from pogosim.scene import number
from pogosim.utils import load_dataframe
from pogosim.yaml_1_2 import dump_yaml

TIME_STEP_S = 0.01  # default of the configuration
PLACEMENT = ("nb", "x", "y", "angle", "poses", "area", "initial_formation")
OUTPUTS = ("data_logger_fields", "data_logger_category", "frames_name", "console_filename", "delete_old_files")
FILES = ("arena_file", "formation_filename")
LONGEST_RUN_S = 600.0  # of wall-clock time

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


@dataclass(frozen=True)
class Simulator:
    """A program and a scene in which a category of robots is tried with other values.

    Attributes:
        program: Compiled program.
        configuration: The user's; its category is changed.
        folder: Of the configuration file, to find what it names.
        category: Name of the entry in `objects`.
        poses: x, y in mm and angle in rad of each robot at the start. Shape (robots, 3).
        tracks: When and where robots are seen.
        temporary: Folder for runs.
    """

    program: Path
    configuration: dict[str, Any]
    folder: Path
    category: str
    poses: Floats
    tracks: Tracks
    temporary: Path

    def configuration_of(self, candidate: Candidate, data: Path) -> dict[str, Any]:
        """Return the configuration of a run."""
        made = copy.deepcopy(self.configuration)
        for key in FILES:
            beside = self.folder / str(made.get(key, ""))
            if key in made and not Path(str(made[key])).exists() and beside.exists():
                made[key] = str(beside.resolve())
        entry = {key: value for key, value in made["objects"][self.category].items() if key not in PLACEMENT}
        entry |= {key: value if value > 0.0 else 0 for key, value in candidate.values}
        entry[BIAS] = list(candidate.bias)
        entry["poses"] = [[float(value) for value in pose] for pose in self.poses]
        made["objects"][self.category] = entry
        for key in OUTPUTS:
            made.pop(key, None)
        made |= {
            "simulation_time": self.tracks.length_s + 2.0 * self.tracks.frame_s,
            "save_data_period": self.period_s(),
            "data_filename": str(data),
            "data_logger_category": [self.category],
            "enable_data_logging": True,
            "enable_console_logging": False,
            "save_video_period": -1,
            "seed": candidate.seed,
        }
        return made

    def period_s(self) -> float:
        """Return the time between rows: that of the frames, if it is a multiple of the time step, or else one step."""
        step_s = number(self.configuration.get("time_step"), TIME_STEP_S)
        steps = self.tracks.frame_s / step_s
        return round(steps) * step_s if steps > 0.5 and abs(steps - round(steps)) < 1e-3 * steps else step_s

    def simulate(self, candidate: Candidate) -> pd.DataFrame:
        """Run a candidate.

        Returns:
            Columns time (s), robot_id, x, y (mm), angle (rad).

        Raises:
            CalibrationError: The run fails; says what the simulator says.
        """
        with tempfile.TemporaryDirectory(dir=self.temporary) as folder:
            data, file = Path(folder) / "data.feather", Path(folder) / "run.yaml"
            file.write_text(dump_yaml(self.configuration_of(candidate, data)), encoding="utf-8")
            command = [os.path.realpath(self.program), "-c", str(file), "-g", "-q", "-nr"]
            try:
                ended = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_RUN_S, check=False)
            except subprocess.TimeoutExpired:
                raise CalibrationError(f"{self.program} took more than {LONGEST_RUN_S:g} s for one run") from None
            except OSError as error:
                raise CalibrationError(f"cannot run {self.program}: {error.strerror}") from None
            if ended.returncode != 0 or not data.is_file():
                lines = (ended.stderr.strip() or ended.stdout.strip()).replace(str(file), "the configuration")
                last = lines.splitlines()[-1] if lines else f"exit code {ended.returncode}, without a data file"
                raise CalibrationError(f"{self.program} failed in a trial run: {last}")
            rows = load_dataframe(data)[0]
            rows.attrs = {}  # pandas copies them with every column
            return rows

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
        return Tracks(position, angle, self.tracks.piece, self.tracks.frame_s, self.tracks.has_angles)
