"""Embodied evolution: robots know of others what they have heard, and nothing else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from pogosim.learning.learners.embodied import LARGEST, MUTATION, Swarm, as_genes, as_weights
from pogosim.learning.tasks import BEACON, FULL, TASKS

SHORT: dict[str, Any] = {"end": 4.0, "threads": 1}
HALF_A_BYTE = LARGEST / FULL


def swarm_at(*x_mm: float, felt: Any = TASKS["majority"].felt, **settings: object) -> Swarm:
    """Return a swarm of robots in a row, which do not move."""
    poses = [[x, 564, 0] for x in x_mm]
    place = {"objects.robots.nb": None, "objects.robots.poses": poses, **settings}
    return Swarm(replace(TASKS["majority"], felt=felt), 1, set=place, **SHORT)


def test_genes_are_weights_but_for_rounding() -> None:
    weights = np.linspace(-LARGEST, LARGEST, 1001)
    np.testing.assert_allclose(as_weights(as_genes(weights)), weights, atol=HALF_A_BYTE + 1e-9)
    assert as_genes(np.array([-9.0, 9.0])).tolist() == [0, FULL]
    every = np.arange(FULL + 1, dtype=np.uint8)
    assert (as_genes(as_weights(every)) == every).all()


@pytest.mark.parametrize("name", TASKS)
def test_message_has_what_the_policy_says_then_how_it_fares_and_its_weights(name: str) -> None:
    swarm = Swarm(TASKS[name], 1, **SHORT)
    with swarm.env:
        messages = [output for output in swarm.env.outputs if output.startswith("message")]
        assert len(messages) == (BEACON in TASKS[name].actions) + 1 + swarm.network.size


def test_what_is_heard_of_others_is_what_they_have_sent() -> None:
    swarm = swarm_at(400, 500, 600, felt=lambda seen, _act: np.broadcast_to([0.2, 0.4, 1.0], seen.shape[:2]))
    with swarm.env:
        swarm.live(1)
    has_heard = np.array([[1, 1, 0], [1, 1, 1], [0, 1, 1]], dtype=bool)  # the one in the middle hides the others
    assert ((swarm.felt >= 0) == has_heard).all()
    for robot, other in np.argwhere(has_heard):
        assert (swarm.heard[robot, other] == swarm.genes[other]).all()
        assert swarm.felt[robot, other] == [51, 102, 255][other]


def test_robots_out_of_each_others_range_learn_nothing() -> None:
    swarm = swarm_at(150, 550, 950)
    before = swarm.genes.copy()
    with swarm.env:
        for life in range(3):
            swarm.live(life)
            swarm.breed()
    assert ((swarm.felt >= 0) == np.eye(3, dtype=bool)).all()
    assert (swarm.genes == before).all()


def test_robots_take_over_mutations_of_the_best_that_they_have_heard() -> None:
    # The last one fares best, and is too far away from the first one.
    swarm = swarm_at(200, 450, 700, felt=lambda seen, _act: np.broadcast_to([0.2, 0.4, 1.0], seen.shape[:2]))
    before = swarm.genes.copy()
    with swarm.env:
        swarm.live(1)
    champion = swarm.breed()
    assert (as_genes(champion) == before[2]).all()
    assert (swarm.genes[2] == before[2]).all()
    for robot, parent in ((0, 1), (1, 2)):
        away = np.abs(as_weights(swarm.genes[robot]) - as_weights(before[parent]))
        assert 0 < away.max() < 5 * MUTATION
        assert away.mean() < MUTATION
