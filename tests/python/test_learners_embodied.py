"""Embodied evolution: robots know of others what they have heard, and nothing else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from pogosim.learning.learners.embodied import LARGEST, MUTATION, TRIALS, Swarm, as_genes, as_weights
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
    swarm = swarm_at(400, 500, 600)
    own = np.diagonal(swarm.worth)
    with swarm.env:
        swarm.worth[range(3), range(3)] = [51, 102, 255]
        swarm.live(1)
    has_heard = np.array([[1, 1, 0], [1, 1, 1], [0, 1, 1]], dtype=bool)  # the one in the middle hides the others
    assert ((swarm.worth >= 0) == has_heard).all()
    for robot, other in np.argwhere(has_heard):
        assert (swarm.known[robot, other] == swarm.known[other, other]).all()
        assert swarm.worth[robot, other] == own[other]


def test_robots_try_mutations_of_the_best_that_they_have_heard() -> None:
    # The last one fares best, and is too far away from the first one.
    swarm = swarm_at(200, 450, 700, felt=lambda seen, _act: np.broadcast_to([0.2, 0.4, 1.0], seen.shape[:2]))
    first = swarm.tried.copy()
    with swarm.env:
        for episode in range(TRIALS):
            swarm.live(episode)
            swarm.choose()
            assert (swarm.tried == first).all() == (episode + 1 < TRIALS)
        assert np.diagonal(swarm.worth).tolist() == [51, 102, 255]
        assert (swarm.best == as_weights(first[2])).all()
        for _ in range(2):  # once to hear of it, and once to choose by it
            swarm.live(9)
            swarm.choose()
    assert ((swarm.worth >= 0) == [[1, 1, 0], [1, 1, 1], [0, 1, 1]]).all()
    for robot, parent in ((0, 1), (1, 2), (2, 2)):
        away = np.abs(as_weights(swarm.tried[robot]) - as_weights(first[parent]))
        assert 0 < away.max() < 5 * MUTATION
        assert away.mean() < MUTATION


def test_robots_out_of_each_others_range_mutate_their_own() -> None:
    swarm = swarm_at(150, 550, 950)
    first = swarm.tried.copy()
    with swarm.env:
        for episode in range(TRIALS + 1):
            swarm.live(episode)
            swarm.choose()
    assert ((swarm.worth >= 0) == np.eye(3, dtype=bool)).all()
    for robot in range(3):
        assert np.abs(as_weights(swarm.tried[robot]) - as_weights(first[robot])).max() < 5 * MUTATION


def test_what_is_worse_is_given_up_at_once_and_what_is_better_is_kept() -> None:
    swarm = swarm_at(550)
    first = swarm.tried[0].copy()
    with swarm.env:
        swarm.worth[0, 0] = 128
        swarm.fares[0] = [0.4]
        swarm.choose()
        assert (swarm.known[0, 0] == first).all()
        challenger = swarm.tried[0].copy()
        assert (challenger != first).any()
        swarm.fares[0] = [0.6, 0.7]
        swarm.choose()
        assert (swarm.tried[0] == challenger).all()  # is tried on
        swarm.fares[0] = [0.6] * TRIALS
        swarm.choose()
    assert (swarm.known[0, 0] == challenger).all()
    assert swarm.worth[0, 0] == round(0.6 * FULL)
