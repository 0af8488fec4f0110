"""PPO: its gradients and advantages, beside what they are by definition."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from pogosim.learning.learners import ppo
from pogosim.learning.learners.ppo import Adam, Samples, advantages, policy_loss, value_loss
from pogosim.learning.perceptron import Perceptron

Array = npt.NDArray[np.float64]
NETWORK = Perceptron(3, 4, 2)


def some_samples(seed: int) -> Samples:
    """Return samples whose actions are more or less probable than they were, so that some are limited."""
    random = np.random.default_rng(seed)
    count = 40
    return Samples(
        random.normal(size=(count, 3)),
        random.normal(size=(count, 2)),
        random.normal(-2.0, 1.0, count),
        random.normal(size=count),
        random.uniform(size=count),
    )


def differences(loss: Callable[[Array], float], parameters: Array, step: float = 1e-6) -> Array:
    """Return the gradient of a loss by finite differences."""
    steps = step * np.eye(len(parameters))
    return np.array([(loss(parameters + one) - loss(parameters - one)) / (2 * step) for one in steps])


@pytest.mark.parametrize("hidden", [0, 4])
def test_gradient_of_the_policy_is_that_of_finite_differences(hidden: int) -> None:
    network = Perceptron(3, hidden, 2)
    samples = some_samples(1)
    parameters = np.random.default_rng(2).normal(0, 0.5, network.size + 2)
    found = policy_loss(network, parameters, samples)[1]
    expected = differences(lambda changed: policy_loss(network, changed, samples)[0], parameters)
    np.testing.assert_allclose(found, expected, atol=1e-7)
    assert abs(found).max() > 0.01


def test_actions_that_are_much_more_probable_than_before_teach_nothing_more() -> None:
    parameters = np.zeros(NETWORK.size + 2)
    samples = some_samples(1)
    now = ppo.log_probability(samples.action, np.zeros((40, 2)), np.zeros(2))
    better = Samples(samples.observation, samples.action, now - 1.0, np.ones(40), samples.target)
    loss, slope = policy_loss(NETWORK, parameters, better)
    assert loss == pytest.approx(-(1 + ppo.CLIP))
    assert not slope.any()
    worse = Samples(samples.observation, samples.action, now - 1.0, -np.ones(40), samples.target)
    assert policy_loss(NETWORK, parameters, worse)[1].any()


def test_gradient_of_the_critic_is_that_of_finite_differences() -> None:
    network = Perceptron(3, 4, 1)
    samples = some_samples(3)
    weights = np.random.default_rng(4).normal(0, 0.5, network.size)
    found = value_loss(network, weights, samples)[1]
    expected = differences(lambda changed: value_loss(network, changed, samples)[0], weights)
    np.testing.assert_allclose(found, expected, atol=1e-8)


def test_advantages_are_the_discounted_sums_of_surprises() -> None:
    random = np.random.default_rng(5)
    rewards, values = random.uniform(size=(7, 2, 3)), random.uniform(size=(8, 2, 3))
    surprises = rewards + ppo.DISCOUNT * values[1:] - values[:-1]
    expected = [
        sum((ppo.DISCOUNT * ppo.TRACE) ** (later - step) * surprises[later] for later in range(step, 7))
        for step in range(7)
    ]
    np.testing.assert_allclose(advantages(rewards, values), expected)
    exact = np.cumsum(np.ones(7) * ppo.DISCOUNT ** np.arange(7))[::-1]
    np.testing.assert_allclose(advantages(np.ones(7), np.append(exact, 0.0)), 0.0, atol=1e-12)  # no surprise


def test_adam_goes_down_to_the_minimum_of_a_parabola() -> None:
    found = Adam(np.array([3.0, -2.0]))
    for step in range(2000):
        found.step(2 * (found.parameters - [1.0, 0.5]), 0.05 * (1 - step / 2000))
    np.testing.assert_allclose(found.parameters, [1.0, 0.5], atol=1e-3)
