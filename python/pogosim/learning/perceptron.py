"""Policies of learners: perceptrons with one hidden layer, many of them at once, which `export-policy` can read."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.learning.swarm_env import SwarmEnv
from pogosim.policy import Dense, Policy, network_of

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class Perceptron:
    """The shape of a network: tanh(W2 tanh(W1 x + b1) + b2).

    Attributes:
        inputs: Numbers that it sees.
        hidden: Units between; 0: none, so tanh(W x + b).
        outputs: Numbers that it gives, from -1 to 1.
    """

    inputs: int
    hidden: int
    outputs: int

    @property
    def shapes(self) -> list[tuple[int, int]]:
        """Units of each layer, and numbers that each sees, with the bias."""
        widths = [self.inputs, *([self.hidden] if self.hidden else []), self.outputs]
        return [(units, before + 1) for before, units in pairwise(widths)]

    @property
    def size(self) -> int:
        """How many weights there are."""
        return sum(units * before for units, before in self.shapes)

    def layers(self, weights: Array) -> list[Array]:
        """Return the matrices of weights in a row, shape (..., size): each (..., units, before), the bias last."""
        ends = np.cumsum([units * before for units, before in self.shapes])[:-1]
        parts = np.split(weights, ends, axis=-1)
        return [part.reshape(*part.shape[:-1], *shape) for part, shape in zip(parts, self.shapes, strict=True)]

    def act(self, weights: Array, observation: Array) -> Array:
        """Return actions, shape (..., outputs).

        Args:
            weights: Shape (size,), or (runs, 1, size), one policy for each run, or (runs, robots, size).
            observation: Shape (runs, robots, inputs).
        """
        values = observation
        for matrix in self.layers(weights):
            values = np.tanh(np.einsum("...ub,...b->...u", matrix[..., :-1], values) + matrix[..., -1])
        return values

    def save(self, weights: Array, env: SwarmEnv, file: Path) -> None:
        """Write a policy into an .npz file, with what its inputs and outputs are.

        Raises:
            PolicyError: Weights are not finite, or too large.
            OSError: It cannot be written.
        """
        dense = [Dense(matrix[:, :-1], matrix[:, -1], "tanh") for matrix in self.layers(np.asarray(weights))]
        Policy(network_of(dense, **env.policy_arrays())).save(file)


def perceptron_of(env: SwarmEnv, hidden: int = 6) -> Perceptron:
    """Return the shape of a network for an environment."""
    return Perceptron(len(env.inputs), hidden, len(env.outputs))
