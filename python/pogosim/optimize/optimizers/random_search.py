"""Random search: every point independent of all others, uniform in the unit cube.

J. Bergstra and Y. Bengio, "Random search for hyper-parameter optimization", JMLR 13, 2012.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pogosim.optimize.optimizers.base import Answer, Floats
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space

POPULATION = 20


class RandomSearch:
    """Independent, uniform points."""

    def __init__(self, space: Space, settings: Settings) -> None:
        self.shape = (settings.popsize or POPULATION, len(space.variables))
        self.random = np.random.default_rng(settings.seed)

    def begin(self, answer: Answer) -> None:
        """Learn nothing."""

    def ask(self) -> Floats:
        """Return the next points."""
        return self.random.random(self.shape)

    def tell(self, answers: Sequence[Answer]) -> None:
        """Learn nothing."""
