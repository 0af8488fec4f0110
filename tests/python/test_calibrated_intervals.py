"""What a calibration says becomes intervals from which each episode of a learner draws its robots."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from pogosim.calibration import intervals_of
from pogosim.errors import CalibrationError
from pogosim.learning import SwarmEnv
from running import SCENE

RESULT: dict[str, Any] = {
    "category": "robots",
    "parameters": {
        "max_linear_speed": {"value": 80.0, "standard_error": 10.0, "fitted": True},
        "angular_noise_stddev": {"value": 0.5, "standard_error": 0.001, "fitted": True},
        "linear_noise_stddev": {"value": 0.01, "standard_error": 0.02, "fitted": True},
        "body_linear_damping": {"value": 0.3, "standard_error": None, "fitted": False},
    },
    "angular_systematic_bias_domain": {"value": [-20, 1000], "standard_error": 12.2},
}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "calibration.json"
    path.write_text(json.dumps(RESULT))
    return path


def test_intervals_are_as_wide_as_errors_or_a_share_of_the_value_and_stay_in_range(file: Path) -> None:
    found = intervals_of(file)
    assert found.pop("objects.robots.angular_systematic_bias_domain") == [[-45, 1023]]
    expected = {
        "max_linear_speed": [60.0, 100.0],  # two errors
        "angular_noise_stddev": [0.45, 0.55],  # a tenth
        "linear_noise_stddev": [0.0, 0.05],  # not below 0
        "body_linear_damping": [0.3, 0.3],  # was not fitted
    }
    assert found == {f"objects.robots.{name}": pytest.approx(ends) for name, ends in expected.items()}
    assert intervals_of(file, errors=0, share=0)["objects.robots.max_linear_speed"] == [80.0, 80.0]


def test_each_episode_draws_robots_that_fit(file: Path) -> None:
    env = SwarmEnv(
        None,
        {"arena_file": "arenas/disk.csv", "arena_surface": 1e6, "objects": {"robots": SCENE["objects"]["robots"]}},
        observation=["photosensors"],
        actions=["motors"],
        reward="speed",
        end=1.0,
        runs=4,
        randomize=intervals_of(file),
    )
    with env:
        _, info = env.reset(seed=1)
    speeds = info["randomized"]["objects.robots.max_linear_speed"]
    assert len(set(speeds.tolist())) == 4
    assert ((speeds >= 60) & (speeds <= 100)).all()
    assert info["randomized"]["objects.robots.angular_systematic_bias_domain"].tolist() == [[-45, 1023]] * 4


@pytest.mark.parametrize(
    "text", ["", "[]", '{"category": "robots"}', json.dumps(RESULT | {"parameters": {"max_linear_speed": 3}})]
)
def test_other_files_are_refused_by_name(text: str, file: Path) -> None:
    file.write_text(text)
    with pytest.raises(CalibrationError, match=r"calibration\.json is no result of a calibration: expected"):
        intervals_of(file)


def test_missing_files_and_wrong_widths_are_refused(file: Path) -> None:
    with pytest.raises(CalibrationError, match=r"none\.json cannot be read"):
        intervals_of(file.with_name("none.json"))
    for wrong in (-1, math.nan, math.inf, True, "2"):
        with pytest.raises(CalibrationError, match="errors: expected a number of at least 0"):
            intervals_of(file, errors=wrong)  # type: ignore[arg-type]
