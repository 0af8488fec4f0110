"""Proximal policy optimisation: all robots share a policy, which learns from what each has seen, done and got.

    .venv/bin/python -m pogosim.learning.learners.ppo phototaxis --budget 2000 -o policy.npz

J. Schulman, F. Wolski, P. Dhariwal, A. Radford and O. Klimov, "Proximal policy optimization algorithms",
arXiv:1707.06347, 2017, in one file of NumPy alone, as S. Huang et al., "CleanRL", J. Machine Learning Research 23,
2022, have shown for PyTorch. Actions are normally distributed: their mean is the policy, their spread is learnt, too.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.learners.running import Generation, learning_seeds, main
from pogosim.learning.perceptron import Perceptron, perceptron_of
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.learning.tasks import BenchmarkTask

Array = npt.NDArray[np.float64]

EPISODES = 8  # between two updates
EPOCHS, BATCH = 10, 512  # passes through these, and samples of a step of the gradient
DISCOUNT, TRACE = 0.97, 0.95  # of rewards and of advantages, for each decision
CLIP = 0.2  # by which the probability of an action may grow or shrink in an update
LEARNING_RATE = 1e-2  # at first; falls to 0
LONGEST = 0.5  # Euclidean norm of a gradient
FIRST_SPREAD = 0.6  # standard deviation of actions, which are from -1 to 1
CRITIC_UNITS = 32


@dataclass(frozen=True)
class Samples:
    """What robots have seen and done.

    Attributes:
        observation: Shape (samples, inputs).
        action: Shape (samples, outputs).
        log_probability: That of the action when it was chosen. Shape (samples,).
        advantage: How much better it was than what was expected. Shape (samples,).
        target: What it was worth: rewards from then on, discounted. Shape (samples,).
    """

    observation: Array
    action: Array
    log_probability: Array
    advantage: Array
    target: Array

    def chosen(self, which: npt.NDArray[np.int64]) -> Samples:
        """Return some of them, with advantages of mean 0 and standard deviation 1."""
        some = [array[which] for array in vars(self).values()]
        some[3] = (some[3] - some[3].mean()) / (some[3].std() + 1e-8)
        return Samples(*some)


def first_weights(network: Perceptron, generator: np.random.Generator, last: float) -> Array:
    """Return weights to begin with: as small as a unit has many inputs, those of the last layer by a factor less."""
    layers = []
    for units, before in network.shapes:
        layers.append(generator.normal(0.0, 1 / np.sqrt(before), (units, before)))
        layers[-1][:, -1] = 0.0
    layers[-1] *= last
    return np.concatenate([layer.ravel() for layer in layers])


def gradient(network: Perceptron, weights: Array, observation: Array, slopes: Array) -> Array:
    """Return how the sum of outputs times slopes grows with each weight (backpropagation).

    Args:
        network: Its shape.
        weights: Shape (size,).
        observation: Shape (samples, inputs).
        slopes: Shape (samples, outputs).

    Returns:
        Shape (size,).
    """
    matrices = network.layers(weights)
    values = [observation]
    for matrix in matrices:
        values.append(np.tanh(values[-1] @ matrix[:, :-1].T + matrix[:, -1]))
    found = []
    for matrix, before, after in zip(matrices[::-1], values[-2::-1], values[:0:-1], strict=True):
        slopes = slopes * (1 - after**2)
        found.append(np.column_stack([slopes.T @ before, slopes.sum(axis=0)]))
        slopes = slopes @ matrix[:, :-1]
    return np.concatenate([layer.ravel() for layer in found[::-1]])


def log_probability(action: Array, mean: Array, log_spread: Array) -> Array:
    """Return the logarithm of the density of a normal distribution, without its constant. Shape (...,)."""
    found: Array = (-0.5 * ((action - mean) / np.exp(log_spread)) ** 2 - log_spread).sum(axis=-1)
    return found


def policy_loss(network: Perceptron, parameters: Array, samples: Samples) -> tuple[float, Array]:
    """Return the clipped loss of the policy, and its gradient.

    Args:
        network: The shape of the policy.
        parameters: Its weights, then the logarithms of the spreads of actions. Shape (size + outputs,).
        samples: What it is judged by.
    """
    weights, log_spread = parameters[: network.size], parameters[network.size :]
    mean = network.act(weights, samples.observation)
    ratio = np.exp(log_probability(samples.action, mean, log_spread) - samples.log_probability)
    gains, limited = ratio * samples.advantage, np.clip(ratio, 1 - CLIP, 1 + CLIP) * samples.advantage
    slope = np.where(gains <= limited, -gains, 0.0)[:, None] / len(ratio)  # of the loss, with log-probabilities
    away = (samples.action - mean) / np.exp(log_spread)
    of_weights = gradient(network, weights, samples.observation, slope * away / np.exp(log_spread))
    of_spread = (slope * (away**2 - 1)).sum(axis=0)
    return -float(np.minimum(gains, limited).mean()), np.concatenate([of_weights, of_spread])


def value_loss(network: Perceptron, weights: Array, samples: Samples) -> tuple[float, Array]:
    """Return half of the mean square error of the critic, and its gradient."""
    error = network.act(weights, samples.observation)[:, 0] - samples.target
    return float((error**2).mean() / 2), gradient(network, weights, samples.observation, error[:, None] / len(error))


class Adam:
    """Steps down a gradient (D. P. Kingma and J. Ba, "Adam", ICLR 2015); parameters change in place."""

    def __init__(self, parameters: Array) -> None:
        self.parameters = parameters
        self._mean, self._square = np.zeros_like(parameters), np.zeros_like(parameters)
        self._steps = 0

    def step(self, slope: Array, rate: float) -> None:
        """Go one step."""
        slope = slope * min(1.0, LONGEST / (float(np.linalg.norm(slope)) + 1e-12))
        self._steps += 1
        self._mean += 0.1 * (slope - self._mean)
        self._square += 0.001 * (slope**2 - self._square)
        mean, square = self._mean / (1 - 0.9**self._steps), self._square / (1 - 0.999**self._steps)
        self.parameters -= rate * mean / (np.sqrt(square) + 1e-5)


def advantages(rewards: Array, values: Array) -> Array:
    """Return generalised advantage estimates (Schulman et al., ICLR 2016).

    Args:
        rewards: Shape (steps, ...).
        values: What was expected before each step, and after the last: episodes end by time alone. Shape (steps + 1,
            ...).

    Returns:
        Shape (steps, ...).
    """
    found = np.zeros_like(rewards)
    later = np.zeros_like(rewards[0])
    for step in range(len(rewards) - 1, -1, -1):
        surprise = rewards[step] + DISCOUNT * values[step + 1] - values[step]
        later = surprise + DISCOUNT * TRACE * later
        found[step] = later
    return found


class Learning:
    """A policy that learns, with its critic.

    Attributes:
        env: Where it acts.
        actor: The shape of the policy.
        critic: That of the network that tells what an observation is worth.
        policy: Its weights, and logarithms of spreads.
        value: Those of the critic.
    """

    def __init__(self, env: SwarmEnv, seed: int) -> None:
        self.env = env
        self.actor = perceptron_of(env)
        self.critic = Perceptron(len(env.inputs), CRITIC_UNITS, 1)
        self._generator = np.random.default_rng(seed)
        weights = first_weights(self.actor, self._generator, 0.1)
        spread = np.full(self.actor.outputs, np.log(FIRST_SPREAD))
        self.policy = Adam(np.concatenate([weights, spread]))
        self.value = Adam(first_weights(self.critic, self._generator, 1.0))

    @property
    def weights(self) -> Array:
        """Those of the policy."""
        return self.policy.parameters[: self.actor.size]

    def play(self, seeds: list[int]) -> tuple[Array, Samples]:
        """Play an episode in each run; returns their scores, and what happened."""
        log_spread = self.policy.parameters[self.actor.size :]
        seen, done, rewards = [], [], []
        observation, _ = self.env.reset(seed=seeds)
        for _ in range(self.env.episode_steps):
            seen.append(observation.astype(np.float64))
            mean = self.actor.act(self.weights, seen[-1])
            done.append(self._generator.normal(mean, np.exp(log_spread)))
            observation, reward, *_ = self.env.step(done[-1])
            rewards.append(reward)
        all_seen, acts, got = np.array([*seen, observation]), np.array(done), np.array(rewards)
        values = self.critic.act(self.value.parameters, all_seen)[..., 0]
        better = advantages((1 - DISCOUNT) * got, values)  # so that values are from 0 to 1, as rewards are
        chosen = log_probability(acts, self.actor.act(self.weights, all_seen[:-1]), log_spread)
        samples = Samples(
            all_seen[:-1].reshape(-1, self.actor.inputs),
            acts.reshape(-1, self.actor.outputs),
            chosen.ravel(),
            better.ravel(),
            (better + values[:-1]).ravel(),
        )
        return got.mean(axis=(0, 2)), samples

    def update(self, samples: Samples, rate: float) -> None:
        """Learn from what happened."""
        count = len(samples.target)
        for _ in range(EPOCHS):
            shuffled = self._generator.permutation(count)
            for which in np.array_split(shuffled, max(1, count // BATCH)):
                some = samples.chosen(which)
                self.policy.step(policy_loss(self.actor, self.policy.parameters, some)[1], rate)
                self.value.step(value_loss(self.critic, self.value.parameters, some)[1], rate)


def ppo(task: BenchmarkTask, budget: int, seed: int, **options: Any) -> Iterator[Generation]:
    """Learn; tells each update."""
    with task.make_env(runs=EPISODES, **options) as env:
        learning, seeds = Learning(env, seed), learning_seeds(seed)
        updates = budget // EPISODES
        for update in range(updates):
            scores, samples = learning.play([*islice(seeds, EPISODES)])
            learning.update(samples, LEARNING_RATE * (1 - update / updates))
            yield Generation((update + 1) * EPISODES, scores, learning.weights.copy())


if __name__ == "__main__":
    sys.exit(main(ppo, "ppo", __doc__ or ""))
