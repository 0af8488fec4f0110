"""What an optimiser is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space

if TYPE_CHECKING:
    from pogosim.optimize.objective import Judgement  # which imports pandas
import importlib
from typing import Any

from pogosim.errors import OptimizeError
from pogosim.extras import installing

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Answer:
    """An evaluated point.

    Attributes:
        number: Number of the evaluation, from 1 on.
        point: Where in the unit cube, of shape (variables,).
        judgement: What came out.
    """

    number: int
    point: Floats
    judgement: Judgement


class Optimizer(Protocol):
    """A search in the unit cube, for the greatest fitness.

    Whatever is random in it comes from `settings.seed`, and it must not depend on time or on the machine: a search is
    continued by asking and telling everything again. The order is: ask, begin, tell, ask, tell, ...

    A class with an attribute `needs_features = True` is told the features of candidates, too.
    """

    def __init__(self, space: Space, settings: Settings) -> None: ...

    def begin(self, answer: Answer) -> None:
        """Take what came out at `space.init`, which is evaluated together with the first points that are asked for."""
        ...

    def ask(self) -> Floats:
        """Return the points of the next generation, of shape (points, variables), each coordinate from 0 to 1."""
        ...

    def tell(self, answers: Sequence[Answer]) -> None:
        """Take what came out, in the order of the points; of the last generation, only the first ones may be there."""
        ...


def penalised(answers: Sequence[Answer]) -> Floats:
    """Return the fitness of all points, where failed ones are worse than any other."""
    known = [answer.judgement.fitness for answer in answers if answer.judgement.fitness is not None]
    worst, best = (min(known), max(known)) if known else (0.0, 0.0)
    failed = worst - (best - worst) - 1.0
    return np.array([failed if a.judgement.fitness is None else a.judgement.fitness for a in answers])


def default_population(dimensions: int) -> int:
    """Return the usual number of points per generation: 4 + 3 ln d, rounded down.

    N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, 2016, table 1.
    """
    return 4 + int(3 * np.log(dimensions))


def imported(name: str, optimizer: str) -> Any:
    """Import a package.

    Raises:
        OptimizeError: It is not installed; says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise OptimizeError(
            f"--optimizer {optimizer} needs the Python package '{package}'; install it: {installing('optimize')}"
        ) from None
