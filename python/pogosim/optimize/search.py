"""A search: generation by generation, it asks an optimiser, evaluates, writes down, and tells the optimiser."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from pogosim.arguments import shown
from pogosim.batch.rows import RUN_FAILED, Runs, kind_of
from pogosim.errors import OptimizeError
from pogosim.optimize.history import Evaluation, Journal
from pogosim.optimize.objective import Judgement, Objective
from pogosim.optimize.optimizers.base import Answer, Floats, Optimizer
from pogosim.optimize.optimizers.table import OPTIMIZERS
from pogosim.optimize.settings import COMMON, Settings
from pogosim.optimize.variables import Space, Values, as_json

MOST_PROBLEMS = 10  # that are mentioned

# Settings that do not change what a search finds; and those that journals have only where they are not the usual ones.
IRRELEVANT = (
    *("retries", "backend", "output_dir", "temp_base", "keep_temp", "candidate_jobs", "batch_jobs"),
    "objective",  # its digest counts
    "places",
)
ADDED = ("retry_new_seed", "qd_features_domain", "objective_names", "own")

log = logging.getLogger("pogosim.optimize")


@dataclass
class Search:
    """A search, and what it has found so far.

    Attributes:
        space: What is searched.
        objective: What is maximised.
        settings: How.
        optimizer: Asked for candidates.
        runs: Does the runs of candidates.
        journal: Where evaluations are written down; those that are there are not done again.
        progress: Called after each evaluation.
        history: All evaluations, in the order of their numbers.
    """

    space: Space
    objective: Objective
    settings: Settings
    optimizer: Optimizer
    runs: Runs
    journal: Journal
    with_features: bool
    progress: Callable[[], None]
    history: list[Evaluation] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.judged: dict[str, Judgement] = {}  # by values; of use if all candidates have the same seeds
        self.feature_names: tuple[str, ...] | None = None
        self.problems: set[str] = set()

    @property
    def best(self) -> Evaluation | None:
        """The best evaluation so far, the first one of several; None if all have failed."""
        known = [evaluation for evaluation in self.history if evaluation.fitness is not None]
        return max(known, key=lambda evaluation: evaluation.fitness or 0.0, default=None)

    @property
    def initial(self) -> Evaluation:
        """The evaluation of the initial values, which is the first one."""
        return self.history[0]

    def generations(self) -> Iterator[None]:
        """Search until all evaluations are done; after each generation, others may look.

        The initial values are evaluated first, whatever the optimiser, together with its first generation.

        Raises:
            BatchError: Runs cannot be done.
            OptimizeError: The journal is that of another search, or the optimiser asks for no points.
            PackageFailedError: The optimiser, of another package, has failed.
        """
        generation = 0
        while len(self.history) < self.settings.max_evals:
            generation += 1
            is_first = generation == 1
            asked = self.asked()
            points = np.vstack([self.space.init, asked]) if is_first else asked
            evaluations = self.evaluated(generation, points[: self.settings.max_evals - len(self.history)])
            self.history += evaluations
            answers = [Answer(e.number, np.array(e.point), e.judgement) for e in evaluations]
            with OPTIMIZERS.calling(self.settings.optimizer):
                if is_first:
                    self.optimizer.begin(answers.pop(0))
                self.optimizer.tell(answers)
            self.say(generation, evaluations)
            yield

    def asked(self) -> Floats:
        """Return the points of the next generation.

        Raises:
            OptimizeError: The optimiser, which may be of another package, asks for none, or for something else.
            PackageFailedError: It has failed.
        """
        with OPTIMIZERS.calling(self.settings.optimizer):
            asked = self.optimizer.ask()
        columns = len(self.space.init)
        try:
            points = np.array(asked, dtype=float)
        except (TypeError, ValueError):
            found = shown(asked)
        else:
            outside = points[~((points >= 0.0) & (points <= 1.0))]
            found = f"{outside[0]:g} among them" if outside.size else f"an array of shape {points.shape}"
            if points.ndim == 2 and points.shape[1] == columns and points.size and not outside.size:
                return points
        raise OptimizeError(
            f"optimiser '{self.settings.optimizer}': ask() must return points, numbers of shape (points, {columns}), "
            f"each from 0 to 1; found {found}; update its package, or take another"
        )

    def evaluated(self, generation: int, points: Floats) -> list[Evaluation]:
        """Return the evaluations of points, in their order."""
        first = len(self.history) + 1
        todo: dict[int, Values] = {}
        done: dict[int, Evaluation] = {}
        same: dict[str, int] = {}  # the first point of each kind
        copies: dict[int, int] = {}
        for i, point in enumerate(points):
            values = self.space.values_at(point)
            known = self.journal.known.get(first + i)
            if known is not None:
                done[i] = self.recalled(known, point)
                continue
            text = as_json(values)
            if self.settings.seeds == COMMON and text in same:
                copies[i] = same[text]
            elif self.settings.seeds == COMMON and text in self.judged:
                done[i] = self.written(first + i, generation, point, values, self.judged[text])
            else:
                same[text] = i
                todo[i] = values
        for i, judgement in self.judgements(first, todo):
            done[i] = self.written(first + i, generation, points[i], todo[i], judgement)
        for i, original in copies.items():
            done[i] = self.written(first + i, generation, points[i], todo[original], done[original].judgement)
        return [self.consistent(done[i]) for i in range(len(points))]

    def judgements(self, first: int, todo: dict[int, Values]) -> Iterator[tuple[int, Judgement]]:
        """Yield the numbers of candidates and what is said of them, as soon as their runs are done."""
        order = list(todo)
        configurations = [self.space.configuration(todo[i]) for i in order]
        seeds = [self.settings.seeds_of(first + i) for i in order]
        for finished in self.runs.rows_of(configurations, seeds):
            if finished.rows is None:
                judgement = Judgement(None, {}, finished.problem)
            else:
                judgement = self.objective.judge(finished.rows, self.with_features)
                judgement = judgement.within(self.settings.qd_features_domain)
            yield order[finished.number], replace(judgement, seeds=finished.seeds, replacement=finished.replacement)

    def recalled(self, known: Evaluation, point: Floats) -> Evaluation:
        """Return an evaluation of the journal; the optimiser must have asked for the same point.

        Raises:
            OptimizeError: It did not.
        """
        if known.point != point.tolist():
            raise OptimizeError(
                f"--resume: evaluation {known.number} in {self.journal.path} was of another candidate: another version "
                "of the optimiser wrote it; start again in another folder with -o"
            )
        self.judged[as_json(known.values)] = known.judgement
        self.progress()
        return known

    def written(self, number: int, generation: int, point: Floats, values: Values, judgement: Judgement) -> Evaluation:
        """Write down an evaluation."""
        timestamp = time.strftime("%Y-%m-%dT%H:%M:%S")
        features = dict(judgement.features)
        fitness, problem = judgement.fitness, judgement.problem
        evaluation = Evaluation(
            number,
            generation,
            point.tolist(),
            values,
            fitness,
            features,
            problem,
            timestamp,
            self.settings.seeds_of(number),
            list(judgement.seeds),
            judgement.replacement,
        )
        self.journal.add(evaluation)
        self.judged[as_json(values)] = judgement
        self.progress()
        self.warn(problem)
        return evaluation

    def warn(self, problem: str) -> None:
        """Say why a candidate has failed, once for each reason."""
        kind = kind_of(problem) if problem.startswith(RUN_FAILED) else problem
        if not problem or kind in self.problems or len(self.problems) > MOST_PROBLEMS:
            return
        self.problems.add(kind)
        if len(self.problems) > MOST_PROBLEMS:
            log.warning("candidates fail for other reasons, too; see the column problem of the history")
        else:
            log.warning("a candidate has failed (others with the same problem are not mentioned): %s", problem)

    def consistent(self, evaluation: Evaluation) -> Evaluation:
        """Return an evaluation, which has failed if it has not the features that the first ones have."""
        if not self.with_features or evaluation.fitness is None:
            return evaluation
        names = tuple(evaluation.features)
        if self.feature_names is None:
            self.feature_names = names
        if names == self.feature_names:
            return evaluation
        problem = f"there are {len(names)} features ({', '.join(names)}), and others than those of the first candidate"
        self.warn(problem)
        return replace(evaluation, fitness=None, features={}, problem=problem)

    def say(self, generation: int, evaluations: Sequence[Evaluation]) -> None:
        """Say what came out of a generation."""
        known = [evaluation.fitness for evaluation in evaluations if evaluation.fitness is not None]
        failed = len(evaluations) - len(known)
        best = self.best
        log.info(
            "gen %03d: pop=%d  f[best/mean/min]=[%s]  best_so_far=%s%s",
            generation,
            len(evaluations),
            "/".join(f"{value:.6g}" for value in (max(known), float(np.mean(known)), min(known))) if known else "-/-/-",
            f"{best.fitness:.6g}" if best is not None else "-",
            f"  failed={failed}" if failed else "",
        )


def description_of(space: Space, settings: Settings, digests: dict[str, str]) -> dict[str, Any]:
    """Return what makes two searches the same, for the journal."""
    usual = Settings()
    same = {
        name: value
        for name, value in vars(settings).items()
        if name not in IRRELEVANT and not (name in ADDED and value == getattr(usual, name))
    }
    if settings.block != settings.runs:
        same["seeds per candidate"] = settings.block
    variables = json.loads(json.dumps({v.name: repr(v.domain) for v in space.variables}))
    return {**same, "variables": variables, **{f"{name} digest": text for name, text in digests.items()}}
