"""Evolution in the swarm itself: robots send their weights by infrared, and take over mutations of what they hear.

    .venv/bin/python -m pogosim.learning.learners.embodied phototaxis --budget 1000 -o policy.npz

R. A. Watson, S. G. Ficici and J. B. Pollack, "Embodied evolution: distributing an evolutionary algorithm in a
population of robots", Robotics and Autonomous Systems 39, 2002; messages that hold whole genomes are those of
N. Bredeche, J.-M. Montanier, W. Liu and A. F. T. Winfield, "Environment-driven distributed evolutionary adaptation in a
population of autonomous robots", Mathematical and Computer Modelling of Dynamical Systems 18, 2012.

Each robot has weights of its own, one byte each, for a life, which is an episode. All the time, it sends them, and how
it has fared in this life as far as it can know: no robot knows a score. At the end, a robot that has heard of one that
fared better takes over a mutation of its weights; otherwise, it keeps its own. What a robot knows of others is what it
has received: one message, with its limits of length, range and collisions.
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
MUTATION = 0.2  # standard deviation


def as_genes(weights: Array) -> npt.NDArray[np.uint8]:
    """Return weights as bytes: 0 is -LARGEST, 255 is LARGEST."""
    return np.rint(np.clip(weights / LARGEST + 1, 0, 2) / 2 * FULL).astype(np.uint8)


def as_weights(genes: Array) -> Array:
    """Return the weights that bytes are."""
    return (genes / FULL * 2 - 1) * LARGEST


class Swarm:
    """Robots with genomes, in an environment in which each message ends with how the sender fares, and its genome.

    Attributes:
        env: The environment, of one run.
        network: The shape of all policies.
        genes: Those of each robot. Shape (robots, weights).
        heard: The genome that each robot has last heard of each other in this life, and its own. Shape (robots,
            robots, weights).
        felt: How these fared, as a byte; -1: nothing heard. Shape (robots, robots).
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
        self.genes = as_genes(self._generator.normal(0, 1.0, (robots, self.network.size)))
        self.heard = np.zeros((robots, robots, self.network.size), np.uint8)
        self.felt = np.full((robots, robots), -1)
        self._row_of_id = {int(robot): row for row, robot in enumerate(self.env.swarm.runs[0].robot_ids)}

    def live(self, seed: int) -> float:
        """Live for an episode; returns its score."""
        env, everyone = self.env, np.arange(self.env.robots)
        self.felt[:] = -1
        self.heard[everyone, everyone] = self.genes
        weights, genes = as_weights(self.genes), self.genes[None] / FULL * 2 - 1
        score, fared = 0.0, np.zeros((1, env.robots))
        observation, _ = env.reset(seed=[seed])
        for step in range(env.episode_steps):
            acts = self.network.act(weights, observation)
            said = 2 * fared[..., None] / max(1, step) - 1
            observation, reward, *_ = env.step(np.concatenate([acts[..., self._order], said, genes], axis=-1))
            fared += self._task.felt(observation, acts)
            score += float(reward.mean())
            self._listen()
        self.felt[everyone, everyone] = np.rint(fared[0] / env.episode_steps * FULL)
        return score / env.episode_steps

    def _listen(self) -> None:
        """Keep the genomes of the messages since the last step."""
        brain = self.env.swarm.brain
        messages = brain.received
        payloads = brain.received_bytes[messages["offset"][:, None] + np.arange(self._length)]
        senders = [self._row_of_id[sender] for sender in messages["sender"].tolist()]
        # In the order of their arrival: the last one of a sender stays.
        self.heard[messages["robot"], senders] = payloads[:, -self.network.size :]
        self.felt[messages["robot"], senders] = payloads[:, -self.network.size - 1]
        brain.clear_received()

    def breed(self) -> Array:
        """Let each robot choose its genome for the next life; returns that which fared best in this one."""
        everyone = np.arange(self.env.robots)
        own = self.felt[everyone, everyone]
        best = np.argmax(self.felt, axis=1)
        mutants = self._generator.normal(as_weights(self.heard[everyone, best]), MUTATION)
        is_better = self.felt[everyone, best] > own
        champion = self.genes[np.argmax(own)].copy()
        self.genes = np.where(is_better[:, None], as_genes(mutants), self.genes)
        return as_weights(champion)


def embodied(task: BenchmarkTask, budget: int, seed: int, **options: Any) -> Iterator[Generation]:
    """Let a swarm evolve; tells each life."""
    swarm, seeds = Swarm(task, seed, **options), learning_seeds(seed)
    with swarm.env:
        for life in range(budget):
            score = swarm.live(next(seeds))
            yield Generation(life + 1, np.array([score]), swarm.breed())


if __name__ == "__main__":
    sys.exit(main(embodied, "embodied", __doc__ or ""))
