"""CMA-ES, the evolution strategy that adapts the covariance matrix of its steps, restarted when it has converged.

N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, 2016; the package `cma`. Restarts with twice the
population: A. Auger and N. Hansen, "A restart CMA evolution strategy with increasing population size", CEC 2005.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from pogosim.optimize.optimizers.base import Answer, Floats, default_population, penalised
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space

# Smallest step of variables with few values: it reaches the neighbouring value even when the others have converged.
LEAST_STEPS = 0.3
PENALTY = 4.0  # at a distance of 1 from the cube, in units of the spread of fitness in a generation
SMALLEST_STEP = 1e-4  # of the unit cube: the search has converged


class CmaEs:
    """CMA-ES in the unit cube.

    A point beyond a wall is evaluated at the nearest point of the cube, and loses fitness with the square of its
    distance from there: optima on walls are reached, and the distribution does not drift away (section B.5 of the
    tutorial).
    """

    def __init__(self, space: Space, settings: Settings) -> None:
        self.random = np.random.default_rng(settings.seed)
        self.sigma0 = settings.sigma0
        self.least_steps = np.array([LEAST_STEPS * variable.domain.step for variable in space.variables])
        popsize = settings.popsize or max(4, min(default_population(len(space.variables)), settings.max_evals))
        self.strategy = self.started(space.init, popsize)
        self.asked: list[Floats] = []
        self.outside = np.zeros(0)  # squared distance of each from the cube

    def started(self, point: Floats, popsize: int) -> Any:
        """Return a search that starts at a point."""
        import cma  # takes a second

        options = {
            "seed": int(self.random.integers(1, 2**31)),
            "popsize": popsize,
            "minstd": np.maximum(self.least_steps, 1e-12),
            "tolx": SMALLEST_STEP,
            "verbose": -9,
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return cma.CMAEvolutionStrategy(point, self.sigma0, options)

    def begin(self, answer: Answer) -> None:
        """Learn nothing: the first points are drawn around it."""

    def ask(self) -> Floats:
        """Return the next generation."""
        self.asked = self.strategy.ask()
        points = np.array(self.asked)
        inside: Floats = np.clip(points, 0.0, 1.0)
        self.outside = ((points - inside) ** 2).sum(axis=1)
        return inside

    def tell(self, answers: Sequence[Answer]) -> None:
        """Adapt the distribution; start again elsewhere, with twice the population, when it has converged."""
        if len(answers) < len(self.asked):
            return  # the end of the search
        fitness = penalised(answers)
        loss = PENALTY * (np.ptp(fitness) + np.finfo(float).tiny) * self.outside
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.strategy.tell(self.asked, list(loss - fitness))
        if self.strategy.stop():
            self.strategy = self.started(self.random.random(len(self.least_steps)), 2 * self.strategy.popsize)
