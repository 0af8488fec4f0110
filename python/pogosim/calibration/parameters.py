"""The parameters of the motion of a category of robots, as the configuration has them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pogosim.errors import CalibrationError

BIAS = "angular_systematic_bias_domain"
BIAS_LIMIT = 1023  # motor power units
DAMPING_SCALE = 10.0  # 1/s; slows down robots whose motors are set 60 times a second by nearly a tenth


@dataclass(frozen=True)
class Parameter:
    """A key of the configuration with one number.

    Attributes:
        key: Its name.
        unit: What it is in.
        least: Smallest value of a fit; a fitted value near it is none.
        most: Largest value of a fit.
        start: Where a fit starts if the configuration says 0.
        is_logarithmic: Fitted by its logarithm: its scale is a factor e. Otherwise in units of DAMPING_SCALE.
    """

    key: str
    unit: str
    least: float
    most: float
    start: float
    is_logarithmic: bool = True

    def coordinate(self, value: float) -> float:
        """Return the coordinate in which the statistics are nearly linear."""
        return math.log(max(value, self.least)) if self.is_logarithmic else value / DAMPING_SCALE

    def value(self, coordinate: float) -> float:
        """Return the value at a coordinate, within its range."""
        raw = math.exp(min(coordinate, 50.0)) if self.is_logarithmic else DAMPING_SCALE * coordinate
        return float(min(max(raw, self.least), self.most))


PARAMETERS = {
    parameter.key: parameter
    for parameter in (
        Parameter("max_linear_speed", "mm/s", 1.0, 5000.0, 100.0),
        Parameter("max_angular_speed", "rad/s", 0.01, 200.0, 1.0),
        Parameter("linear_noise_stddev", "100 mm/s", 0.002, 50.0, 0.2),
        Parameter("angular_noise_stddev", "rad/s", 0.005, 100.0, 0.3),
        Parameter("body_linear_damping", "1/s", 0.0, 1000.0, 0.0, is_logarithmic=False),
        Parameter("body_angular_damping", "1/s", 0.0, 1000.0, 0.0, is_logarithmic=False),
    )
}
# Fitted with them, so that the noise of the camera is not taken for that of the motors.
TRACKER = {
    parameter.key: parameter
    for parameter in (
        Parameter("tracker_noise_mm", "mm", 1e-3, 100.0, 0.5),
        Parameter("tracker_noise_rad", "rad", 1e-4, 3.0, 0.01),
    )
}
ALL = PARAMETERS | TRACKER
NOISES = ("linear_noise_stddev", "angular_noise_stddev")
NAMES = (*PARAMETERS, BIAS)


def chosen(text: str | None) -> list[str]:
    """Return the parameters of a comma-separated list; all of them without one.

    Raises:
        CalibrationError: One of them is none.
    """
    if text is None:
        return list(NAMES)
    names = [name.strip() for name in text.split(",") if name.strip()]
    unknown = [name for name in names if name not in NAMES]
    if unknown or not names:
        what = f"no parameter {', '.join(unknown)}" if unknown else "no parameter in the list"
        raise CalibrationError(f"--parameters: {what}; expected some of {', '.join(NAMES)}")
    return list(dict.fromkeys(names))


def start_values(settings: dict[str, Any]) -> dict[str, float]:
    """Return the values of a category's entry, which has all keys."""
    return {key: float(settings[key]) for key in PARAMETERS}


def start_bias(settings: dict[str, Any]) -> tuple[int, int]:
    """Return the range of the bias of a category's entry, which has all keys."""
    low, high = settings[BIAS]
    return round(low), round(high)
