"""Optimisers without a simulator: functions whose greatest value is known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from pogosim.errors import OptimizeError
from pogosim.optimize.objective import Judgement
from pogosim.optimize.optimizers.base import Answer, Optimizer
from pogosim.optimize.optimizers.quality_diversity import CmaMe, MapElites, folded, mutated
from pogosim.optimize.optimizers.table import OPTIMIZERS, optimizer_for
from pogosim.optimize.optimizers.tpe import Tpe
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space, Variable

Function = Callable[[Sequence[float]], float | None]


def space_of(*domains: dict[str, Any]) -> Space:
    """Return a space with some variables."""
    return Space({f"x{i}": {"optimization_domain": domain} for i, domain in enumerate(domains)})


def reals(count: int, init: float = 0.2) -> Space:
    """Return a space of real numbers from 0 to 1."""
    return space_of(*[{"type": "float", "min": 0, "max": 1, "init": init}] * count)


def searched(
    optimizer: Optimizer, function: Function, evaluations: int, features: Function | None = None
) -> list[Answer]:
    """Search, and return all answers."""
    answers: list[Answer] = []
    while len(answers) < evaluations:
        points = optimizer.ask()[: evaluations - len(answers)]
        assert points.min() >= 0.0
        assert points.max() <= 1.0
        new: list[Answer] = []
        for point in points:
            fitness = function(point)
            named = {"first": float(point[0]), "last": float(point[-1])} if features is None else {}
            new.append(
                Answer(len(answers) + len(new) + 1, point, Judgement(fitness, named if fitness is not None else {}))
            )
        optimizer.tell(new)
        answers += new
    return answers


def best(answers: Sequence[Answer]) -> float:
    """Return the greatest fitness."""
    return max(answer.judgement.fitness for answer in answers if answer.judgement.fitness is not None)


def made(name: str, space: Space, **settings: Any) -> Optimizer:
    """Return an optimiser."""
    return optimizer_for(space, Settings(optimizer=name, **settings))


def hill(point: Sequence[float]) -> float:
    """Greatest, 1, in the inner point (0.7, 0.7, ...)."""
    return 1.0 - float(((np.asarray(point) - 0.7) ** 2).sum())


def slope(point: Sequence[float]) -> float:
    """Greatest, 1, in a corner."""
    return float(np.mean(point))


@pytest.mark.parametrize("name", OPTIMIZERS.own)
def test_search_is_the_same_for_the_same_seed_and_another_one_for_another(name: str) -> None:
    settings = {"qd_init_samples": 10, "qd_batch": 6, "qd_shape": (5, 5)}
    points = [
        [answer.point.tolist() for answer in searched(made(name, reals(2), seed=seed, **settings), hill, 40)]
        for seed in (1, 1, 2)
    ]
    assert points[0] == points[1] != points[2]


@pytest.mark.parametrize("name", OPTIMIZERS.own)
def test_search_goes_on_when_candidates_fail(name: str) -> None:
    def fails_left(point: Sequence[float]) -> float | None:
        return None if point[0] < 0.5 else hill(point)

    settings = {"qd_init_samples": 10, "qd_batch": 6, "qd_shape": (5, 5)}
    answers = searched(made(name, reals(2, init=0.9), **settings), fails_left, 60)
    assert 0 < sum(answer.judgement.fitness is None for answer in answers) < 60


@pytest.mark.parametrize("name", OPTIMIZERS.own)
def test_search_goes_on_when_all_candidates_fail(name: str) -> None:
    settings = {"qd_init_samples": 10, "qd_batch": 6, "qd_shape": (5, 5)}
    assert len(searched(made(name, reals(2), **settings), lambda _: None, 60)) == 60


# ---- CMA-ES ----


@pytest.mark.parametrize("dimensions", [1, 2, 4])
def test_evolution_strategy_climbs_a_hill(dimensions: int) -> None:
    values = [best(searched(made("cmaes", reals(dimensions), seed=seed), hill, 60 * dimensions)) for seed in range(5)]
    assert min(values) > 0.999


@pytest.mark.parametrize("dimensions", [1, 3])
def test_evolution_strategy_reaches_corners(dimensions: int) -> None:
    values = [best(searched(made("cmaes", reals(dimensions), seed=seed), slope, 60 * dimensions)) for seed in range(5)]
    assert min(values) > 0.99
    assert max(values) == 1.0


def test_evolution_strategy_starts_again_elsewhere_when_it_has_converged() -> None:
    # A low hill beside the start, a higher one far away.
    def two_hills(point: Sequence[float]) -> float:
        x = float(point[0])
        return max(0.5 - abs(x - 0.1), 1.0 - 5.0 * abs(x - 0.9))

    values = [
        best(searched(made("cmaes", reals(1, init=0.1), seed=seed, sigma0=0.1), two_hills, 400)) for seed in range(5)
    ]
    assert np.median(values) > 0.9  # it starts again by chance


def test_evolution_strategy_finds_whole_numbers_and_choices() -> None:
    space = space_of(
        {"type": "int", "min": 0, "max": 9, "init": 2},
        {"choices": list("abcd")},
        {"type": "float", "min": 0, "max": 1, "init": 0.1},
    )

    def fitness(point: Sequence[float]) -> float:
        values = space.values_at(point)
        return float(-abs(values["x0"] - 7) / 10 - (values["x1"] != "c") - (values["x2"] - 0.6) ** 2)

    values = [best(searched(made("cmaes", space, seed=seed), fitness, 200)) for seed in range(5)]
    assert np.median(values) > -0.001
    assert min(values) > -0.2


def test_population_is_that_of_the_literature_or_as_asked_for() -> None:
    assert [len(made("cmaes", reals(d)).ask()) for d in (1, 3, 10)] == [4, 7, 10]
    assert len(made("cmaes", reals(3), popsize=12).ask()) == 12


def test_evolution_strategy_moves_away_from_failures() -> None:
    def fails_right(point: Sequence[float]) -> float | None:
        return None if point[0] > 0.5 else float(point[0])

    for seed in range(3):
        answers = searched(made("cmaes", reals(1), seed=seed), fails_right, 80)
        late = [answer.judgement.fitness for answer in answers[-40:]]
        assert sum(fitness is None for fitness in late) < 30
        assert best(answers) > 0.49


def test_restart_has_twice_the_population() -> None:
    optimizer = made("cmaes", reals(1), popsize=4, sigma0=0.01)
    sizes = {4}
    for _ in range(400):
        points = optimizer.ask()
        sizes.add(len(points))
        if len(sizes) > 1:
            break
        optimizer.tell([Answer(1, point, Judgement(hill(point), {})) for point in points])
    assert sizes == {4, 8}


@pytest.mark.parametrize("name", ["cma_me", "cma_mae"])
def test_strategies_that_fill_archives_learn_even_if_some_candidates_fail(name: str) -> None:
    count = 0

    def every_tenth_fails(point: Sequence[float]) -> float | None:
        nonlocal count
        count += 1
        return None if count % 10 == 0 else hill(point)

    def score(function: Function) -> tuple[float, int]:
        optimizer = made(name, reals(4), qd_shape=(10, 10), qd_init_samples=50, qd_batch=32)
        answers = searched(optimizer, function, 1500)
        assert isinstance(optimizer, CmaMe)
        elites = [answers[elite.number - 1].judgement.fitness or 0.0 for elite in optimizer.elites()]
        return sum(elites), optimizer.emitter.itrs + optimizer.emitter.restarts

    undisturbed, steps = score(hill)
    disturbed, steps_with_failures = score(every_tenth_fails)
    assert min(steps, steps_with_failures) > 40
    assert disturbed > 0.9 * undisturbed


# ---- Others ----


def test_random_points_are_uniform_and_independent() -> None:
    points = np.array([answer.point for answer in searched(made("random", reals(2)), hill, 4000)])
    cells = np.histogram2d(points[:, 0], points[:, 1], bins=5, range=[[0, 1], [0, 1]])[0]
    # Chi-squared with 24 degrees of freedom: 51.2 has the probability 0.001.
    assert float(((cells - 160.0) ** 2 / 160.0).sum()) < 51.2


def test_parzen_estimator_finds_the_right_choices_among_many() -> None:
    space = space_of(*[{"choices": list("abcde")}] * 5)

    def right(point: Sequence[float]) -> float:
        return float(sum(value == "d" for value in space.values_at(point).values()))

    by_tpe = [best(searched(made("tpe", space, seed=seed), right, 80)) for seed in range(3)]
    by_chance = [best(searched(made("random", space, seed=seed), right, 80)) for seed in range(3)]
    assert min(by_tpe) >= max(by_chance)
    assert max(by_tpe) == 5


def begun(optimizer: Optimizer, space: Space, fitness: float | None) -> None:
    """Let an optimiser ask for its first points, and tell it what came out at the initial values, and nothing else."""
    optimizer.ask()
    features = {} if fitness is None else {"first": 0.25, "last": 0.75}
    optimizer.begin(Answer(1, space.init, Judgement(fitness, features)))
    optimizer.tell([])


@pytest.mark.parametrize("fitness", [1.5, None])
def test_parzen_estimator_knows_the_initial_values(fitness: float | None) -> None:
    space = space_of(
        {"type": "int", "min": 0, "max": 9, "init": 2},
        {"choices": list("abcd"), "init": "c"},
        {"type": "float", "min": 1, "max": 100, "log": True, "init": 10},
    )
    optimizer = made("tpe", space, popsize=3)
    begun(optimizer, space, fitness)
    assert isinstance(optimizer, Tpe)
    trial = optimizer.study.trials[-1]
    assert (trial.params, trial.state.name) == (
        {"x0": 2, "x1": 2, "x2": pytest.approx(0.5)},
        "FAIL" if fitness is None else "COMPLETE",
    )
    assert len(optimizer.ask()) == 3


@pytest.mark.parametrize("name", ["mapelites", "cma_me", "cma_mae"])
def test_initial_values_are_in_the_archive_unless_they_failed(name: str) -> None:
    for fitness, count in ((1.5, 1), (None, 0)):
        space = reals(2)
        optimizer = made(name, space, qd_shape=(4, 4), qd_init_samples=3)
        begun(optimizer, space, fitness)
        assert isinstance(optimizer, MapElites)
        assert [(elite.cell, elite.number) for elite in optimizer.elites()] == [((1, 3), 1)] * count


@pytest.mark.parametrize("name", ["mapelites", "cma_me", "cma_mae"])
def test_quality_diversity_search_fills_the_grid_with_the_best_of_each_cell(name: str) -> None:
    optimizer = made(name, reals(2), qd_shape=(6, 6), qd_init_samples=30, qd_batch=20)
    answers = searched(optimizer, hill, 800)
    assert isinstance(optimizer, MapElites)
    assert optimizer.ranges == [(0.0, 1.0), (0.0, 1.0)]
    elites = optimizer.elites()
    assert len(elites) >= 0.6 * 36
    for elite in elites:
        same = [a for a in answers if tuple(np.minimum((a.point * 6).astype(int), 5)) == elite.cell]
        assert answers[elite.number - 1].judgement.fitness == pytest.approx(best(same), abs=1e-12)


def test_ranges_of_features_are_as_seen_unless_they_are_from_0_to_1() -> None:
    def answers(scale: float) -> list[Answer]:
        rows = [(0.2 * scale, -1.0 * scale), (0.4 * scale, 3.0 * scale)]
        return [Answer(i + 1, np.array([0.5]), Judgement(1.0, {"a": a, "b": b})) for i, (a, b) in enumerate(rows)]

    optimizer = made("mapelites", reals(1))
    optimizer.tell(answers(10.0))
    assert isinstance(optimizer, MapElites)
    np.testing.assert_allclose(optimizer.ranges, [(1.8, 4.2), (-14.0, 34.0)])
    given = made("mapelites", reals(1), qd_ranges=((0.0, 5.0), (-1.0, 1.0)))
    given.tell(answers(10.0))
    assert isinstance(given, MapElites)
    assert given.ranges == [(0.0, 5.0), (-1.0, 1.0)]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"qd_shape": (5,)}, "--qd-shape: there are 2 features, so expected as many numbers, such as 20,20"),
        ({"qd_ranges": ((0.0, 1.0),)}, "--qd-ranges: there are 2 features, so expected as many, such as 0:1,0:1"),
    ],
)
def test_grid_for_another_number_of_features_is_one_line(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(OptimizeError) as error:
        searched(made("mapelites", reals(2), **settings), hill, 100)
    assert str(error.value) == message


def test_mutation_stays_in_the_cube_changes_something_and_is_smaller_the_more_crowded() -> None:
    random = np.random.default_rng(1)
    points = random.random((2000, 3))
    spread = []
    for eta in (1.0, 20.0, 100.0):
        moved = mutated(points, 0.2, eta, random)
        assert moved.min() >= 0.0
        assert moved.max() <= 1.0
        assert ((moved != points).any(axis=1)).mean() > 0.999
        changed = moved != points
        # One at least, and each of the others with the probability 0.2.
        assert changed.mean() == pytest.approx(1.0 / 3.0 + 2.0 / 3.0 * 0.2, abs=0.02)
        spread.append(np.abs(moved - points)[changed].mean())
    assert spread[0] > 2.0 * spread[1] > 4.0 * spread[2]


def test_folding_is_reflection_at_the_walls() -> None:
    points = np.array([[-0.1, 0.0, 0.3, 1.0, 1.1, 2.3, -1.9]])
    np.testing.assert_allclose(folded(points), [[0.1, 0.0, 0.3, 1.0, 0.9, 0.3, 0.1]])


def test_unknown_optimiser_is_one_line() -> None:
    with pytest.raises(
        OptimizeError, match=r"^--optimizer: expected one of cmaes, random, mapelites, .*; found 'sgd'$"
    ):
        made("sgd", reals(1))


def test_name_of_a_variable_is_its_dotted_path() -> None:
    assert Variable(("a", "b"), reals(1).variables[0].domain).name == "a.b"
