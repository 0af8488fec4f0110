"""How to fit a law of reception."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pogosim.communication.reception_law import LAWS, parameter_names
from pogosim.errors import ToolError

Bounds = tuple[float, float]

# Where the parameters are looked for, by law. Those of the article's equation are the ones of its authors' fit.
BOUNDS: dict[str, dict[str, Bounds]] = {
    "dynamic": {
        "alpha": (0.01, 2.01),
        "beta": (math.exp(-15.0), math.exp(3.0)),
        "gamma": (0.1, 8.0),
        "delta": (0.1, 8.0),
        "zeta": (0.01, 0.5),
        "theta": (0.001, 10.0),
    },
    "power": {"alpha": (1e-12, 1.0), "beta": (0.1, 8.0), "gamma": (0.1, 8.0), "delta": (0.1, 8.0)},
}
OBJECTIVES = ("r2", "huber")


class FitError(ToolError):
    """The fit that was asked for is not possible; says why."""


@dataclass(frozen=True)
class FitSettings:
    """How to fit.

    Attributes:
        law: "dynamic", the article's equation, or "power", the older four-parameter law.
        objective: "r2": least squares, which is the greatest R2. "huber": squares up to `huber_delta`, and linear
            beyond, so that single strange measurements count for less.
        huber_delta: Residual from which Huber's loss is linear, above 0. From 1 on, it is least squares.
        bounds: Least and greatest value of parameters, in place of BOUNDS.
        fixed: Parameters that are not fitted, and their values.
        seed: Seed of the search, 1 to 2^32 - 1. The same one gives the same parameters.
        restarts: How many more searches from other points; the best one counts.
    """

    law: str = "dynamic"
    objective: str = "r2"
    huber_delta: float = 0.1
    bounds: Mapping[str, Bounds] = field(default_factory=dict)
    fixed: Mapping[str, float] = field(default_factory=dict)
    seed: int = 42
    restarts: int = 2

    def bounds_of(self, name: str) -> Bounds:
        """Return the bounds of a parameter."""
        return self.bounds.get(name, BOUNDS[self.law][name])

    def check(self) -> None:
        """Raise FitError if the fit is not possible."""
        names = parameter_names(LAWS[self.law])
        for name in [*self.bounds, *self.fixed]:
            if name not in names:
                raise FitError(f"the law '{self.law}' has no parameter {name}; it has {', '.join(names)}")
        for name, (low, high) in self.bounds.items():
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise FitError(f"the bounds {low:g}:{high:g} of {name} are empty; the first must be the smaller one")
        both = sorted(set(self.bounds) & set(self.fixed))
        if both:
            raise FitError(f"{', '.join(both)} cannot be fixed and have bounds at the same time")
