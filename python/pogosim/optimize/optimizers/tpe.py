"""The tree-structured Parzen estimator of Optuna, for many categorical variables.

J. Bergstra, R. Bardenet, Y. Bengio, B. Kegl, "Algorithms for hyper-parameter optimization", NeurIPS 2011; T. Akiba et
al., "Optuna: a next-generation hyperparameter optimization framework", KDD 2019.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from pogosim.optimize.domain import Categorical, Whole
from pogosim.optimize.optimizers.base import Answer, Floats, default_population, imported
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space, Variable


class Tpe:
    """Optuna's sampler; points of one generation do not know each other's fitness, and keep away from each other."""

    def __init__(self, space: Space, settings: Settings) -> None:
        self.optuna: Any = imported("optuna", "tpe")
        self.optuna.logging.set_verbosity(self.optuna.logging.ERROR)
        self.variables = space.variables
        self.popsize = settings.popsize or default_population(len(space.variables))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # constant_liar is called experimental
            sampler = self.optuna.samplers.TPESampler(seed=settings.seed, constant_liar=True)
            self.study = self.optuna.create_study(direction="maximize", sampler=sampler)
        self.distributions = {variable.name: self.distribution_of(variable) for variable in self.variables}
        self.trials: list[Any] = []

    def distribution_of(self, variable: Variable) -> Any:
        """Return what Optuna chooses for a variable: the number of a choice, or a position from 0 to 1."""
        kinds = self.optuna.distributions
        domain = variable.domain
        if isinstance(domain, Categorical):
            return kinds.CategoricalDistribution(range(len(domain.choices)))
        if isinstance(domain, Whole) and not domain.is_log:
            return kinds.IntDistribution(domain.low, domain.high)
        return kinds.FloatDistribution(0.0, 1.0)

    def begin(self, answer: Answer) -> None:
        """Add the initial values to what Optuna knows."""
        start = zip(self.variables, answer.point, strict=True)
        states = self.optuna.trial.TrialState
        trial = self.optuna.trial.create_trial(
            params={variable.name: coordinate_of(variable, x) for variable, x in start},
            distributions=self.distributions,
            value=answer.judgement.fitness,
            state=states.FAIL if answer.judgement.fitness is None else states.COMPLETE,
        )
        self.study.add_trial(trial)

    def ask(self) -> Floats:
        """Return the next generation."""
        self.trials = [self.study.ask(self.distributions) for _ in range(self.popsize)]
        points = [
            [position_of(variable, trial.params[variable.name]) for variable in self.variables] for trial in self.trials
        ]
        return np.array(points)

    def tell(self, answers: Sequence[Answer]) -> None:
        """Tell Optuna; failed points are no use to it."""
        for trial, answer in zip(self.trials, answers, strict=False):
            if answer.judgement.fitness is None:
                self.study.tell(trial, state=self.optuna.trial.TrialState.FAIL)
            else:
                self.study.tell(trial, answer.judgement.fitness)


def coordinate_of(variable: Variable, position: float) -> float | int:
    """Return what Optuna knows a position from 0 to 1 as."""
    domain = variable.domain
    if isinstance(domain, Categorical):
        return domain.number_at(position)
    if isinstance(domain, Whole) and not domain.is_log:
        return domain.value_at(position)
    return float(position)


def position_of(variable: Variable, coordinate: float) -> float:
    """Return the position from 0 to 1 of what Optuna chose."""
    domain = variable.domain
    if isinstance(domain, Categorical) or (isinstance(domain, Whole) and not domain.is_log):
        return domain.position_of(int(coordinate))
    return float(coordinate)
