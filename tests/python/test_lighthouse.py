"""The example lighthouse_localization: robots know where they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest
from light_field import configuration, outline_mm
from running import Settings, run_shipped

Array = npt.NDArray[np.float64]

CORNER = 0.75  # of the map, in the robots' own unit
FIRST_CYCLE_S = 0.5 + 0.1 + np.pi / 3.0  # two white frames and two right angles at 3 rad/s


def located(folder: Path, settings: Settings | None = None) -> pd.DataFrame:
    """All rows of a run, with the errors of x and y (mm) of the positions that robots think they have."""
    rows = run_shipped("lighthouse_localization", folder, settings, "lighthouse").frame()
    width, height = outline_mm(configuration("lighthouse")).max(axis=0)
    rows["error_x"] = width / 2 * (1 + rows["pred_x"] / CORNER) - rows["x"]
    rows["error_y"] = height / 2 * (1 + rows["pred_y"] / CORNER) - rows["y"]
    return rows


def rmse_mm(rows: pd.DataFrame) -> float:
    valid = rows[rows["pose_valid"]]
    return float(np.sqrt((valid["error_x"] ** 2 + valid["error_y"] ** 2).mean()))


@pytest.fixture(scope="module")
def rows(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    return located(tmp_path_factory.mktemp("lighthouse"))


def test_estimates_follow_the_positions(rows: pd.DataFrame) -> None:
    valid = rows[rows["pose_valid"]]
    for axis in ("x", "y"):
        assert np.corrcoef(valid[f"pred_{axis}"], valid[axis])[0, 1] > 0.99


def test_estimates_are_a_few_centimetres_off_and_not_to_one_side(rows: pd.DataFrame) -> None:
    assert rmse_mm(rows) < 40.0
    valid = rows[rows["pose_valid"]]
    assert abs(valid["error_x"].mean()) < 15.0
    assert abs(valid["error_y"].mean()) < 15.0
    assert np.hypot(valid["error_x"], valid["error_y"]).max() < 150.0


def test_every_robot_knows_its_position_after_the_first_cycle_and_none_before(rows: pd.DataFrame) -> None:
    assert not rows.loc[rows["time"] < FIRST_CYCLE_S, "pose_valid"].any()
    later = rows[rows["time"] > FIRST_CYCLE_S + 0.1]
    assert later["pose_valid"].mean() > 0.95
    assert later.groupby("robot_id")["pose_valid"].any().all()


def test_slower_beams_are_more_accurate(rows: pd.DataFrame, tmp_path: Path) -> None:
    # Between two looks of a robot a beam at 1 rad/s turns by a third.
    slow = {"objects.lighthouses.angular_speed": 1.0, "parameters.lighthouse_omega": 1.0}
    assert rmse_mm(located(tmp_path, slow)) < 0.6 * rmse_mm(rows)


@pytest.mark.parametrize(
    "light", [{"value": 0}, {"angular_speed": 0.0}, {"white_frame_value": 0}], ids=lambda light: next(iter(light))
)
def test_without_beams_or_white_frames_no_robot_claims_to_know(light: dict[str, object], tmp_path: Path) -> None:
    settings = {f"objects.lighthouses.{key}": value for key, value in light.items()}
    assert not located(tmp_path, {**settings, "simulation_time": 8.0})["pose_valid"].any()


def test_thin_beams_are_missed_now_and_then_but_not_for_long(tmp_path: Path) -> None:
    # Beams of 0.02 rad that move on by 0.03 rad in a time step leave a third of all places dark; a robot has its three
    # sensors at three places, but looks only every 16 ms.
    rows = located(tmp_path, {"objects.lighthouses.ray_half_width": 0.01})
    later = rows[rows["time"] > FIRST_CYCLE_S + 0.1]
    assert 0.3 < later["pose_valid"].mean() < 0.9
    assert later.groupby("robot_id")["pose_valid"].any().all()
    assert rmse_mm(rows) < 40.0


def test_ambient_light_does_not_disturb(rows: pd.DataFrame, tmp_path: Path) -> None:
    ambient = {"type": "static_light", "geometry": "global", "value": 200}
    lit = located(tmp_path, {"objects.ambient": ambient})
    pd.testing.assert_frame_equal(lit, rows)
