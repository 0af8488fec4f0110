"""Fitting a law of reception to measurements, with CMA-ES.

N. Hansen, S. D. Mueller, P. Koumoutsakos, "Reducing the time complexity of the derandomized evolution strategy with
covariance matrix adaptation (CMA-ES)", Evolutionary Computation 11(1), 2003; the package `cma`.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from pogosim.communication.measurements import Measurements
from pogosim.communication.reception_law import LAWS, Law, parameter_names

Floats = npt.NDArray[np.float64]
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
# Bounds that are as far apart as this are searched by orders of magnitude.
LOGARITHMIC_FROM = 1000.0

OBJECTIVES = ("r2", "huber")
POPULATION = 50
SIGMA = 0.3


class FitError(Exception):
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


@dataclass(frozen=True)
class Fit:
    """A law that was fitted.

    Attributes:
        law: The law with its parameters.
        loss: Value of the objective per row of the measurements.
        evaluations: How many sets of parameters were tried.
    """

    law: Law
    loss: float
    evaluations: int


def huber(residual: Floats, delta: float) -> Floats:
    """Return Huber's loss: r^2 / 2 up to |r| = delta, and delta (|r| - delta / 2) beyond.

    P. J. Huber, "Robust estimation of a location parameter", Annals of Mathematical Statistics 35(1), 1964.

    Args:
        residual: Any shape.
        delta: Where the loss becomes linear, above 0; inf: never.
    """
    size = np.abs(residual)
    with np.errstate(invalid="ignore"):
        return np.where(size <= delta, 0.5 * size**2, delta * (size - 0.5 * delta))


def scaled(u: Floats, bounds: Bounds) -> Floats:
    """Return the parameter within its bounds that an unbounded variable stands for: a sigmoid, 0 in the middle."""
    low, high = bounds
    share = 0.5 * (1.0 + np.tanh(0.5 * u))
    if low > 0.0 and high / low >= LOGARITHMIC_FROM:
        value: Floats = np.exp(np.log(low) + share * np.log(high / low))
    else:
        value = low + share * (high - low)
    return np.clip(value, low, high)


def fit(measurements: Measurements, settings: FitSettings | None = None) -> Fit:
    """Fit a law to measurements.

    Args:
        measurements: What was measured; at least one row.
        settings: How.

    Raises:
        FitError: The settings contradict each other or the law.
    """
    settings = settings or FitSettings()
    settings.check()
    names = parameter_names(LAWS[settings.law])
    free = [name for name in names if name not in settings.fixed]

    delta = settings.huber_delta if settings.objective == "huber" else math.inf
    messages = (measurements.message_bytes, measurements.send_probability, measurements.cluster_size)

    def parameters(variables: Floats) -> dict[str, Floats]:
        """Return the parameters, each of shape (points, 1), of variables of shape (points, free parameters)."""
        found = {name: scaled(variables[:, [i]], settings.bounds_of(name)) for i, name in enumerate(free)}
        fixed = {name: np.full((len(variables), 1), value) for name, value in settings.fixed.items()}
        return found | fixed

    def losses(variables: Floats) -> Floats:
        predicted = LAWS[settings.law].equation(*messages, **parameters(variables))
        mean: Floats = huber(measurements.success - predicted, delta).mean(axis=1)
        return mean

    best, evaluations = search(losses, len(free), settings) if free else (np.empty(0), 1)
    found = parameters(best[None, :])
    law = LAWS[settings.law](**{name: float(found[name].item()) for name in names})
    return Fit(law, float(losses(best[None, :])[0]), evaluations)


def search(losses: Callable[[Floats], Floats], count: int, settings: FitSettings) -> tuple[Floats, int]:
    """Return the best point that CMA-ES finds from several starts, and how many were tried.

    The first search starts in the middle of the bounds, the others at random. With one variable only, a second one that
    nothing depends on is added: the package needs two.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of packages that cma would like to have
        import cma

    random = np.random.default_rng(settings.seed)
    best, best_loss, evaluations = np.zeros(count), math.inf, 0
    for start in range(settings.restarts + 1):
        x0 = np.zeros(max(count, 2)) if start == 0 else random.normal(0.0, 1.5, max(count, 2))
        options = {
            "popsize": POPULATION,
            "seed": settings.seed + start,
            "verbose": -9,
            "maxiter": 2000,
            "tolfun": 1e-12,
        }
        strategy = cma.CMAEvolutionStrategy(x0, SIGMA, options)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            while not strategy.stop():
                points = strategy.ask()
                strategy.tell(points, losses(np.asarray(points)[:, :count]).tolist())
        result = strategy.result
        evaluations += int(result.evaluations)
        if result.fbest < best_loss:
            best, best_loss = np.asarray(result.xbest[:count], dtype=float), float(result.fbest)
    return best, evaluations
