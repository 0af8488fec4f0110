"""Evolution in the swarm itself: robots send their best weights by infrared, and try mutations of what they hear.

    .venv/bin/python -m pogosim.learning.learners.embodied phototaxis --budget 1000 -o policy.npz

R. A. Watson, S. G. Ficici and J. B. Pollack, "Embodied evolution: distributing an evolutionary algorithm in a
population of robots", Robotics and Autonomous Systems 39, 2002; messages that hold whole genomes are those of
N. Bredeche, J.-M. Montanier, W. Liu and A. F. T. Winfield, "Environment-driven distributed evolutionary adaptation in a
population of autonomous robots", Mathematical and Computer Modelling of Dynamical Systems 18, 2012. Small swarms need
champions that robots keep: E. Haasdijk, A. E. Eiben and G. Karafotias, "On-line evolution of robot controllers by an
encapsulated evolution strategy", CEC 2010.

Each robot keeps the best weights that it has tried, one byte each, and how it fared with them as far as it can know: no
robot knows a score. It sends both all the time, while it acts by others: a mutation of the best that it knows, its own
or what it has heard. It tries these for some episodes, and gives up as soon as they are worse. What a robot knows of
others is what it has received: one message, with its limits of length, range and collisions.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.learners.running import Generation, learning_seeds, main
from pogosim.learning.perceptron import Perceptron, perceptron_of
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.learning.tasks import BEACON, FULL, BenchmarkTask

Array = npt.NDArray[Any]
LARGEST = 4.0  # weight that a byte can be
FIRST, MUTATION = 1.0, 0.5  # standard deviations of weights
TRIALS = 8  # episodes after which weights may be the best
ARRIVAL = 0.5  # share of an episode that does not count: robots come from where they were put


def as_genes(weights: Array) -> npt.NDArray[np.uint8]:
    """Return weights as bytes: 0 is -LARGEST, 255 is LARGEST."""
    return np.rint(np.clip(weights / LARGEST + 1, 0, 2) / 2 * FULL).astype(np.uint8)


def as_weights(genes: Array) -> Array:
    """Return the weights that bytes are."""
    return (genes / FULL * 2 - 1) * LARGEST


class Swarm:
    """Robots with genomes, in an environment in which each message ends with a genome and how its sender fared with it.

    Attributes:
        env: The environment, of one run.
        network: The shape of all policies.
        tried: The genome by which each robot acts. Shape (robots, weights).
        fares: How it has fared with it in each episode, from 0 to 1: a list for each robot.
        known: The best genome of each other robot that each has heard last, and its own best one. Shape (robots,
            robots, weights).
        worth: How these fared, as a byte; -1: nothing heard, or none yet. Shape (robots, robots).
    """

    def __init__(self, task: BenchmarkTask, seed: int, **options: Any) -> None:
        with task.make_env(**options) as plain:
            self.network: Perceptron = perceptron_of(plain)
            said = [place for place, name in enumerate(plain.outputs) if name == BEACON[0]]
            self._order = [*(place for place in range(len(plain.outputs)) if place not in said), *said]
        self._length = len(said) + 1 + self.network.size
        others = [action for action in task.actions if action != BEACON]
        speaking = replace(task, actions=[*others, (f"message({self._length})", 0, FULL)])
        self.env: SwarmEnv = speaking.make_env(**options)
        self._task = task
        self._generator = np.random.default_rng(seed)
        robots = self.env.robots
        self.tried = as_genes(self._generator.normal(0, FIRST, (robots, self.network.size)))
        self.fares: list[list[float]] = [[] for _ in range(robots)]
        self.known = np.zeros((robots, robots, self.network.size), np.uint8)
        self.worth = np.full((robots, robots), -1)
        for robot in range(robots):
            self.known[robot, robot] = self.tried[robot]
        self._row_of_id = {int(robot): row for row, robot in enumerate(self.env.swarm.runs[0].robot_ids)}

    def live(self, seed: int) -> float:
        """Live for an episode; returns its score."""
        env, everyone = self.env, np.arange(self.env.robots)
        weights = as_weights(self.tried)
        told = np.concatenate([self.worth[everyone, everyone, None].clip(0), self.known[everyone, everyone]], axis=-1)
        message = told[None] / FULL * 2 - 1
        fared, counted, score = np.zeros(env.robots), 0, 0.0
        observation, _ = env.reset(seed=[seed])
        for step in range(env.episode_steps):
            acts = self.network.act(weights, observation)
            observation, reward, *_ = env.step(np.concatenate([acts[..., self._order], message], axis=-1))
            if step >= ARRIVAL * env.episode_steps:
                fared += self._task.felt(observation, acts)[0]
                counted += 1
            score += float(reward.mean())
            self._listen()
        for fares, fare in zip(self.fares, fared / counted, strict=True):
            fares.append(float(fare))
        return score / env.episode_steps

    def _listen(self) -> None:
        """Keep the genomes of the messages since the last step."""
        brain = self.env.swarm.brain
        messages = brain.received
        payloads = brain.received_bytes[messages["offset"][:, None] + np.arange(self._length)]
        senders = [self._row_of_id[sender] for sender in messages["sender"].tolist()]
        # In the order of their arrival: the last one of a sender stays.
        self.known[messages["robot"], senders] = payloads[:, -self.network.size :]
        self.worth[messages["robot"], senders] = payloads[:, -self.network.size - 1]
        brain.clear_received()

    def choose(self) -> None:
        """Let each robot judge what it has tried, and choose what it tries next."""
        for robot, fares in enumerate(self.fares):
            worth = round(float(np.mean(fares)) * FULL)
            is_worse = worth <= self.worth[robot, robot]
            if not is_worse and len(fares) < TRIALS:
                continue
            if not is_worse:
                self.known[robot, robot], self.worth[robot, robot] = self.tried[robot], worth
            best = self.known[robot, np.argmax(self.worth[robot])]
            self.tried[robot] = as_genes(self._generator.normal(as_weights(best), MUTATION))
            fares.clear()

    @property
    def best(self) -> Array:
        """The weights with which any robot has fared best."""
        robot = int(np.argmax(np.diagonal(self.worth)))
        return as_weights(self.known[robot, robot])


def embodied(task: BenchmarkTask, budget: int, seed: int, **options: Any) -> Iterator[Generation]:
    """Let a swarm evolve; tells each episode."""
    swarm, seeds = Swarm(task, seed, **options), learning_seeds(seed)
    with swarm.env:
        for episode in range(1, budget + 1):
            score = swarm.live(next(seeds))
            swarm.choose()
            yield Generation(episode, np.array([score]), swarm.best)


if __name__ == "__main__":
    sys.exit(main(embodied, "embodied", __doc__ or ""))
