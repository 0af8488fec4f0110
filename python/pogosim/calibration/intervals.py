"""What a calibration leaves open of the robots: intervals from which each episode of a learner draws them."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from pogosim.calibration.parameters import BIAS, BIAS_LIMIT, PARAMETERS
from pogosim.errors import CalibrationError


def intervals_of(file: str | Path, *, errors: float = 2.0, share: float = 0.1) -> dict[str, list[Any]]:
    """Return which robots fit to a film, as `randomize` of `pogosim.learning.SwarmEnv` takes it.

        SwarmEnv(..., randomize=intervals_of("results/calibration/calibration.json") | {"initial_formation": [...]})

    A value that was fitted becomes an interval around it, as wide as its error and a share of the value say; one that
    was not stays as `calibration.yaml` has it. The range of the bias, from which each robot draws its own, gets wider
    at both ends by its error.

    Args:
        file: The `calibration.json` that `pogosim calibrate -o` writes.
        errors: How many standard errors an interval extends to both sides at least, 0 or more.
        share: By which share of the value it does at least, 0 or more: robots of another day differ by more than what
            a film cannot tell.

    Returns:
        Keys of the configuration, such as "objects.robots.max_linear_speed", with [low, high].

    Raises:
        CalibrationError: It is no such file, or an argument is no number of at least 0.
    """
    for name, value in (("errors", errors), ("share", share)):
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
            raise CalibrationError(f"{name}: expected a number of at least 0, found {value!r}")
    try:
        found = json.loads(Path(file).read_bytes())
        objects = f"objects.{found['category']}"
        bias, bias_error = found[BIAS]["value"], found[BIAS]["standard_error"]
        values = {
            name: (float(one["value"]), float(one["standard_error"]) if one["fitted"] else None)
            for name, one in found["parameters"].items()
            if name in PARAMETERS
        }
        low, high = (round(float(end)) for end in bias)
        margin = 0 if bias_error is None else math.ceil(errors * float(bias_error))
    except OSError as error:
        raise CalibrationError(f"{file} cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, OverflowError):
        raise CalibrationError(
            f"{file} is no result of a calibration: expected the calibration.json that pogosim calibrate -o DIR writes"
        ) from None
    intervals: dict[str, list[Any]] = {}
    for name, (value, error_of_value) in values.items():
        width = 0.0 if error_of_value is None else max(errors * error_of_value, share * value)
        intervals[f"{objects}.{name}"] = [max(value - width, 0.0), min(value + width, PARAMETERS[name].most)]
    intervals[f"{objects}.{BIAS}"] = [[max(low - margin, -BIAS_LIMIT), min(high + margin, BIAS_LIMIT)]]
    return intervals
