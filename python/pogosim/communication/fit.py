"""Fitting a law of reception to measurements, with CMA-ES.

N. Hansen, S. D. Mueller, P. Koumoutsakos, "Reducing the time complexity of the derandomized evolution strategy with
covariance matrix adaptation (CMA-ES)", Evolutionary Computation 11(1), 2003; the package `cma`.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pogosim.communication.fit_settings import Bounds, FitSettings
from pogosim.communication.measurements import Measurements
from pogosim.communication.reception_law import LAWS, Law, parameter_names

Floats = npt.NDArray[np.float64]

# Bounds that are as far apart as this are searched by orders of magnitude.
LOGARITHMIC_FROM = 1000.0
POPULATION = 50
SIGMA = 0.3


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
