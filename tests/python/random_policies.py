"""Policies with random weights, and what exact arithmetic says that they do."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from pogosim.policy import Dense, Elman, Gru, Network, network_of
from pogosim.policy.network import Layer

Floats = npt.NDArray[np.float64]

INPUTS = 3
LOW, HIGH = 0, 3000  # range of the inputs
Kind = tuple[str, int, str]  # kind of layer, units, activation

PLAIN: tuple[Kind, ...] = (("dense", 8, "tanh"), ("dense", 2, "hardtanh"))
LINEAR: tuple[Kind, ...] = (("dense", 6, "relu"), ("dense", 5, "sigmoid"), ("dense", 2, "identity"))
ELMAN: tuple[Kind, ...] = (("elman", 6, "tanh"), ("dense", 2, "tanh"))
GATED: tuple[Kind, ...] = (("gru", 5, ""), ("elman", 4, "sigmoid"), ("dense", 2, "hardtanh"))
ALL = {"plain": PLAIN, "linear": LINEAR, "elman": ELMAN, "gated": GATED}


def sigmoid(x: Floats) -> Floats:
    return np.exp(-np.logaddexp(0.0, -x))


ACTIVATE: dict[str, Callable[[Floats], Floats]] = {
    "identity": lambda x: x,
    "relu": lambda x: np.maximum(x, 0),
    "hardtanh": lambda x: np.clip(x, -1, 1),
    "tanh": np.tanh,
    "sigmoid": sigmoid,
}


def random_network(kinds: Sequence[Kind], seed: int = 0, size: float = 0.5) -> Network:
    """Return a policy whose weights are normally distributed, of this standard deviation."""
    random = np.random.default_rng(seed)

    def some(*shape: int) -> npt.NDArray[np.float32]:
        return random.normal(0, size, shape).astype(np.float32)

    layers: list[Layer] = []
    before = INPUTS
    for kind, units, activation in kinds:
        if kind == "gru":
            layers.append(Gru(some(3 * units, before), some(3 * units, units), some(3 * units), some(3 * units)))
        elif kind == "elman":
            layers.append(Elman(some(units, before), some(units, units), some(units), activation))
        else:
            layers.append(Dense(some(units, before), some(units), activation))
        before = units
    return network_of(
        layers,
        input_offset=1000,
        input_scale=1e-3,
        output_scale=1000,
        output_offset=-3,
        input_low=LOW,
        input_high=HIGH,
    )


def observations(count: int, seed: int = 1) -> npt.NDArray[np.int64]:
    """Return whole inputs in their range. Shape (count, inputs)."""
    return np.random.default_rng(seed).integers(LOW, HIGH + 1, (count, INPUTS))


def exact_step(network: Network, observation: npt.ArrayLike, state: Floats) -> tuple[Floats, Floats]:
    """Return the outputs and the next state, in floats of 64 bits and with the functions of NumPy."""
    values = (np.asarray(observation, float) - network.input_offset) * network.input_scale.astype(float)
    states: list[Floats] = []
    begin = 0
    for layer in network.layers:
        weights = layer.weights.astype(float)
        sums = values @ weights.T + layer.bias
        if isinstance(layer, Dense):
            values = ACTIVATE[layer.activation](sums)
            continue
        own = state[..., begin : begin + layer.units]
        begin += layer.units
        recurrent = own @ layer.recurrent_weights.T.astype(float)
        if isinstance(layer, Elman):
            values = ACTIVATE[layer.activation](sums + recurrent)
        else:
            units = layer.units
            recurrent = recurrent + layer.recurrent_bias
            gates = sigmoid(sums[..., : 2 * units] + recurrent[..., : 2 * units])
            new = np.tanh(sums[..., 2 * units :] + gates[..., :units] * recurrent[..., 2 * units :])
            values = (1 - gates[..., units:]) * new + gates[..., units:] * own
        states.append(values)
    outputs = values * network.output_scale.astype(float) + network.output_offset
    return outputs, np.concatenate(states, axis=-1) if states else state
