"""A policy in floats of 32 bits, step by step as the exported C computes it: the same operations in the same order.

So the results are the same bits, unless a compiler contracts a multiplication and an addition into one operation
(-ffp-contract=off keeps it from that). Functions work on arrays of shape (..., values).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from pogosim.policy.network import Dense, Elman, Floats, Gru, Layer, Network

LEAST_EXPONENT = -87.0  # exp() of anything below is taken for that of it: a normal float
# 2^f = sum of f^k ln(2)^k / k!, in the order in which Horner's method takes them; exact to 1e-8 for f from -1 to 1/2.
POWER_OF_TWO = tuple(np.float32(np.log(2.0) ** k / float(np.prod(np.arange(1.0, k + 1)))) for k in range(8, -1, -1))
LOG2_E = np.float32(1.0 / np.log(2.0))
ONE = np.float32(1.0)


def exp_of_negative(x: Floats) -> Floats:
    """Return exp(x) of numbers up to 0."""
    y = np.where(x > LEAST_EXPONENT, x, np.float32(LEAST_EXPONENT)) * LOG2_E
    whole = (y - np.float32(0.5)).astype(np.int32)  # towards 0, so the nearest one
    fraction = y - whole.astype(np.float32)
    power = np.full_like(fraction, POWER_OF_TWO[0])
    for coefficient in POWER_OF_TWO[1:]:
        power = power * fraction + coefficient
    two_to_whole = ((whole + 127) << 23).astype(np.uint32).view(np.float32)
    return np.asarray(power * two_to_whole)


def tanh(x: Floats) -> Floats:
    """Return the hyperbolic tangent, within 2e-7."""
    e = exp_of_negative(np.float32(-2.0) * np.abs(x))
    size = (ONE - e) / (ONE + e)
    return np.where(x < 0, -size, size)


def sigmoid(x: Floats) -> Floats:
    """Return 1 / (1 + exp(-x)), within 2e-7."""
    e = exp_of_negative(-np.abs(x))
    share = ONE / (ONE + e)
    return np.where(x < 0, e * share, share)


def relu(x: Floats) -> Floats:
    """Return the positive part."""
    return np.where(x > 0, x, np.float32(0.0))


def hardtanh(x: Floats) -> Floats:
    """Cut to -1 to 1."""
    return np.where(x < -ONE, -ONE, np.where(x > ONE, ONE, x))


def identity(x: Floats) -> Floats:
    """Return the numbers themselves."""
    return x


ACTIVATE: dict[str, Callable[[Floats], Floats]] = {
    "identity": identity,
    "relu": relu,
    "hardtanh": hardtanh,
    "tanh": tanh,
    "sigmoid": sigmoid,
}


def cut(x: Floats, least: Floats, most: Floats) -> Floats:
    """Cut numbers to ranges. Shapes (..., values), (values,), (values,)."""
    return np.where(x < least, least, np.where(x > most, most, x))


def add_product(sums: Floats, weights: Floats, values: Floats) -> Floats:
    """Return sums + weights values, added one after the other. Shapes (..., rows), (rows, columns), (..., columns)."""
    for column, of_column in enumerate(weights.T):
        sums = sums + of_column * values[..., column, None]
    return sums


def start(bias: Floats, values: Floats) -> Floats:
    """Return the bias for each of the arrays of values."""
    return np.broadcast_to(bias, (*values.shape[:-1], len(bias)))


def dense(layer: Dense, values: Floats) -> Floats:
    """Return what a dense layer gives."""
    return ACTIVATE[layer.activation](add_product(start(layer.bias, values), layer.weights, values))


def elman(layer: Elman, values: Floats, state: Floats) -> Floats:
    """Return the next state of an Elman layer."""
    sums = add_product(start(layer.bias, values), layer.weights, values)
    return ACTIVATE[layer.activation](add_product(sums, layer.recurrent_weights, state))


def gru(layer: Gru, values: Floats, state: Floats) -> Floats:
    """Return the next state of a GRU."""
    units = layer.units
    sums = np.array(start(layer.sum_bias, values))
    sums[..., : 3 * units] = add_product(sums[..., : 3 * units], layer.weights, values)
    gates, old = sums[..., : 2 * units], sums[..., 3 * units :]
    both = sigmoid(add_product(gates, layer.recurrent_weights[: 2 * units], state))
    reset, keep = both[..., :units], both[..., units:]
    remembered = add_product(old, layer.recurrent_weights[2 * units :], state)
    candidate = tanh(sums[..., 2 * units : 3 * units] + reset * remembered)
    return candidate + keep * (state - candidate)


def next_of(layer: Layer, values: Floats, state: Floats) -> Floats:
    """Return what a layer gives, which is its next state if it is recurrent. `state` is not used otherwise."""
    if isinstance(layer, Dense):
        return dense(layer, values)
    return elman(layer, values, state) if isinstance(layer, Elman) else gru(layer, values, state)


def step(network: Network, observation: npt.NDArray[np.float32], state: Floats) -> tuple[Floats, Floats]:
    """Return the outputs and the next state.

    Args:
        network: The policy.
        observation: Shape (..., inputs), in their units.
        state: Shape (..., values that are remembered).
    """
    inside = cut(observation, *network.input_ends) if network.has_range else observation
    values = (inside - network.input_offset) * network.input_scale
    states = network.split_state(state)
    for number, layer in enumerate(network.layers):
        values = next_of(layer, values, states[number])
        if layer.state_units:
            states[number] = values
    return values * network.output_scale + network.output_offset, np.concatenate(states, axis=-1)
