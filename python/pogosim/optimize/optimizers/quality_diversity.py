"""Quality-diversity searches: the best candidate in each cell of a grid of features.

MAP-Elites: J.-B. Mouret and J. Clune, "Illuminating search spaces by mapping elites", arXiv:1504.04909, 2015. CMA-ME:
M. C. Fontaine et al., "Covariance matrix adaptation for the rapid illumination of behavior space", GECCO 2020. CMA-MAE:
M. C. Fontaine and S. Nikolaidis, "Covariance matrix adaptation MAP-annealing", GECCO 2023. Archives and emitters are
those of pyribs: B. Tjanaka et al., "pyribs: a bare-bones Python library for quality diversity optimization", GECCO
2023.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pogosim.errors import OptimizeError
from pogosim.optimize.optimizers.base import Answer, Floats, imported, penalised
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space


def mutated(points: Floats, probability: float, eta: float, random: np.random.Generator) -> Floats:
    """Return mutated copies of points of the unit cube.

    Args:
        points: Points, shape (points, variables), from 0 to 1.
        probability: That a coordinate changes. At least one coordinate of each point does.
        eta: Crowding degree, 0 or more: the higher, the smaller the changes.
        random: Where chance comes from.
    """
    count, dimensions = points.shape
    chosen = random.random(points.shape) < probability
    chosen[np.arange(count), random.integers(dimensions, size=count)] = True
    u = random.random(points.shape)
    power = 1.0 / (eta + 1.0)
    down = (2.0 * u + (1.0 - 2.0 * u) * (1.0 - points) ** (eta + 1.0)) ** power - 1.0
    up = 1.0 - (2.0 * (1.0 - u) + (2.0 * u - 1.0) * points ** (eta + 1.0)) ** power
    moved = np.where(u <= 0.5, down, up)
    return np.clip(points + np.where(chosen, moved, 0.0), 0.0, 1.0)


WIDENED = 0.1  # share of their spread by which ranges go beyond the features of the first candidates
LEARNING_RATE = 0.01  # of CMA-MAE
EVALUATION = "evaluation"  # field of the archive: number of the evaluation


@dataclass(frozen=True)
class Elite:
    """The best candidate in a cell.

    Attributes:
        cell: Its place in the grid, from 0 on along each feature.
        number: Number of its evaluation, from 1 on.
    """

    cell: tuple[int, ...]
    number: int


def feature_ranges(features: Floats, settings: Settings) -> list[tuple[float, float]]:
    """Return the range of each feature: that of the settings; 0 to 1 if all features are; else what was seen.

    Args:
        features: Features of the first candidates, of shape (candidates, features).
        settings: See `qd_ranges`, `qd_features_domain`, `qd_shape`.

    Raises:
        OptimizeError: The settings are for another number of features.
    """
    count = features.shape[1]
    if len(settings.qd_shape) != count:
        example = ",".join(["20"] * count)
        place = settings.place_of("qd_shape")
        raise OptimizeError(f"{place}: there are {count} features, so expected as many numbers, such as {example}")
    if known := settings.qd_features_domain or settings.qd_ranges:
        if len(known) != count:
            name = settings.place_of("qd_features_domain" if settings.qd_features_domain else "qd_ranges")
            example = ",".join(["0:1"] * count)
            raise OptimizeError(f"{name}: there are {count} features, so expected as many, such as {example}")
        return list(known)
    if features.min() >= 0.0 and features.max() <= 1.0:
        return [(0.0, 1.0)] * count
    low, high = features.min(axis=0), features.max(axis=0)
    margin = np.where(high > low, WIDENED * (high - low), 0.5)
    return [(float(a), float(b)) for a, b in zip(low - margin, high + margin, strict=True)]


class MapElites:
    """Random points first, then mutations of elites.

    Attributes:
        archive: The grid; None until there is a candidate.
        ranges: Least and greatest value of each feature in the grid.
    """

    needs_features = True

    def __init__(self, space: Space, settings: Settings) -> None:
        self.archives: Any = imported("ribs.archives", settings.optimizer)
        self.space = space
        self.settings = settings
        self.random = np.random.default_rng(settings.seed)
        self.archive: Any = None
        self.ranges: list[tuple[float, float]] = []
        self.first: list[Answer] = []

    def begin(self, answer: Answer) -> None:
        """Keep the initial values for the archive, which is made when their features and others are known."""
        self.first = [answer]

    def ask(self) -> Floats:
        """Return the next points."""
        if self.archive is not None:
            return self.emitted()
        return self.random.random((self.settings.qd_init_samples, len(self.space.variables)))

    def tell(self, answers: Sequence[Answer]) -> None:
        """Put the points into the archive."""
        answers, self.first = [*self.first, *answers], []
        known = [answer for answer in answers if answer.judgement.fitness is not None]
        if not known:
            return
        if self.archive is None:
            self.ranges = feature_ranges(features_of(known), self.settings)
            self.start(known)
            self.add(known)
        else:
            self.learn(answers, known)

    def start(self, known: Sequence[Answer]) -> None:  # noqa: ARG002
        """Make the archive, once there are ranges."""
        self.archive = self.grid()

    def grid(self, **more: Any) -> Any:
        """Return an empty archive."""
        return self.archives.GridArchive(
            solution_dim=len(self.space.variables),
            dims=self.settings.qd_shape,
            ranges=self.ranges,
            seed=self.settings.seed,
            extra_fields={EVALUATION: ((), np.int64)},
            **more,
        )

    def add(self, answers: Sequence[Answer], points: Floats | None = None) -> Any:
        """Put points into the archive; returns what it says of each."""
        return self.archive.add(
            points_of(answers) if points is None else points,
            [answer.judgement.fitness for answer in answers],
            features_of(answers),
            **{EVALUATION: [answer.number for answer in answers]},
        )

    def emitted(self) -> Floats:
        """Return the next points, from those in the archive."""
        parents = self.archive.sample_elites(self.settings.qd_batch)["solution"]
        return mutated(parents, self.settings.qd_mut_pb, self.settings.qd_eta, self.random)

    def learn(self, answers: Sequence[Answer], known: Sequence[Answer]) -> None:  # noqa: ARG002
        """Take a generation after the first one."""
        self.add(known)

    def elites(self) -> list[Elite]:
        """Return the elites, cell by cell."""
        if self.archive is None:
            return []
        data = self.archive.data(["index", EVALUATION])
        cells = self.archive.int_to_grid_index(data["index"])
        found = zip(cells.tolist(), data[EVALUATION].tolist(), strict=True)
        return sorted((Elite(tuple(cell), number) for cell, number in found), key=lambda elite: elite.cell)


class CmaMe(MapElites):
    """An evolution strategy that is rewarded for what improves the archive."""

    ranker = "2imp"
    restart_rule = "no_improvement"

    def start(self, known: Sequence[Answer]) -> None:
        """Make the archive and the emitter."""
        super().start(known)
        self.emitter = self.emitter_for(self.archive)
        self.asked: Floats = np.empty((0, len(self.space.variables)))

    def emitter_for(self, archive: Any) -> Any:
        """Return the evolution strategy. It knows no bounds: its points are folded into the unit cube."""
        emitters = imported("ribs.emitters", self.settings.optimizer)
        return emitters.EvolutionStrategyEmitter(
            archive,
            x0=self.space.init,
            sigma0=self.settings.sigma0,
            ranker=self.ranker,
            restart_rule=self.restart_rule,
            batch_size=self.settings.popsize or self.settings.qd_batch,
            seed=self.settings.seed,
        )

    def emitted(self) -> Floats:
        """Return the next points of the evolution strategy."""
        self.asked = self.emitter.ask()
        return folded(self.asked)

    def learn(self, answers: Sequence[Answer], known: Sequence[Answer]) -> None:
        """Reward the points that improved the archive; those that failed rank last."""
        said = self.add(known)
        self.reward(answers, known, said)

    def reward(self, answers: Sequence[Answer], known: Sequence[Answer], said: Any) -> None:
        """Tell the evolution strategy what its points did to the archive."""
        if len(answers) < len(self.asked):
            return  # the end of the search
        # Those that failed did nothing for the archive, and are worse than all: the strategy moves away from them.
        has_failed = np.array([answer.judgement.fitness is None for answer in answers])
        features = np.empty((len(answers), len(self.ranges)))
        features[has_failed] = np.mean(self.ranges, axis=1)
        features[~has_failed] = features_of(known)
        status, value = np.zeros(len(answers), dtype=np.int32), np.empty(len(answers))
        status[~has_failed], value[~has_failed] = said["status"], said["value"]
        value[has_failed] = np.min(said["value"]) - 1.0
        numbers = {EVALUATION: [answer.number for answer in answers]}
        self.emitter.tell(self.asked, penalised(answers), features, {"status": status, "value": value}, **numbers)


class CmaMae(CmaMe):
    """CMA-ME with an archive whose thresholds rise slowly, so that it does not leave good cells too early."""

    ranker = "imp"
    restart_rule = "basic"

    def start(self, known: Sequence[Answer]) -> None:
        """Make the archive of the best, and the one that rewards."""
        MapElites.start(self, known)
        fitness = [answer.judgement.fitness for answer in known if answer.judgement.fitness is not None]
        # Below all that is to come, or a new cell with a candidate worse than the first ones would be no improvement.
        least = min(fitness) - (max(fitness) - min(fitness))
        self.rising = self.grid(learning_rate=LEARNING_RATE, threshold_min=least)
        self.add_rising(known)
        self.emitter = self.emitter_for(self.rising)
        self.asked = np.empty((0, len(self.space.variables)))

    def add_rising(self, answers: Sequence[Answer]) -> Any:
        """Put points into the archive that rewards."""
        best, self.archive = self.archive, self.rising
        try:
            return self.add(answers)
        finally:
            self.archive = best

    def learn(self, answers: Sequence[Answer], known: Sequence[Answer]) -> None:
        """Reward the points that improved the rising archive."""
        self.add(known)
        self.reward(answers, known, self.add_rising(known))


def points_of(answers: Sequence[Answer]) -> Floats:
    """Return points, of shape (answers, variables)."""
    return np.array([answer.point for answer in answers])


def features_of(answers: Sequence[Answer]) -> Floats:
    """Return features, of shape (answers, features)."""
    return np.array([list(answer.judgement.features.values()) for answer in answers])


def folded(points: Floats) -> Floats:
    """Return points of space folded into the unit cube, as in a kaleidoscope: 1.1 and -0.9 become 0.9.

    So an optimiser that knows no bounds sees a function that goes on beyond them, without jumps.
    """
    inside: Floats = 1.0 - np.abs(1.0 - np.mod(points, 2.0))
    return inside
