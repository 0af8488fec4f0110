"""A policy in whole numbers, step by step as the exported C computes it.

Values of layers are integers of 16 bits, which stand for value / 2^fraction_bits; weights are of 8 or 16 bits, each
row with an exponent of its own; sums are of 32 bits. No sum, product or value leaves its type: quantization.py chooses
the numbers so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from pogosim.policy.network import Elman, Gru, Layer, Network
from pogosim.policy.tanh_table import ARGUMENT_BITS, ONE, VALUE_BITS, sigmoid_of, tanh_of

Integers = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

MOST_VALUE = 32767
MOST_SUM = (1 << 30) - 1  # leaves room for rounding


@dataclass(frozen=True)
class Affine:
    """Integers times factors: (value * factor + addend) >> shift. All have the shape (values,)."""

    factor: Integers
    addend: Integers
    shift: Integers


@dataclass(frozen=True)
class FixedLayer:
    """A layer in whole numbers.

    Attributes:
        source: The layer in floats.
        weights: Shape (rows, values before), of 8 or 16 bits; rows are those of the source.
        recurrent_weights: Shape (rows, units); without rows in a dense layer.
        bias: What sums begin with. Shape (sums,): (units,), of a GRU (4 units,): reset, keep, new, remembered.
        shift: By how much the sums are shifted to the right; to the left, if negative. Shape (sums,).
        function: What makes values of the sums: "gru", or one of FUNCTIONS.
        new_bits: Fraction bits of the parts of a GRU's new value, before tanh.
    """

    source: Layer
    weights: Integers
    recurrent_weights: Integers
    bias: Integers
    shift: Integers
    function: str
    new_bits: int = 0

    @property
    def is_output(self) -> bool:
        """Whether its values are the outputs, scaled already."""
        return self.function == OUTPUTS


@dataclass(frozen=True)
class FixedNetwork:
    """A policy in whole numbers.

    Attributes:
        source: The policy in floats.
        bits: Bits of a weight, 8 or 16.
        input_low: Inputs are cut to this at least. Shape (inputs,).
        input_high: And to this at most. Shape (inputs,).
        input_map: What makes values of the first layer of inputs, from which input_low is subtracted.
        layers: From the inputs to the outputs.
        output_map: What makes outputs of the last layer's values; None: they are the outputs.
        error_bound: How far outputs are off at most, in their units. Shape (outputs,).
    """

    source: Network
    bits: int
    input_low: Integers
    input_high: Integers
    input_map: Affine
    layers: tuple[FixedLayer, ...]
    output_map: Affine | None
    error_bound: Floats = field(repr=False)


def scaled(sums: Integers, shift: Integers, most: int) -> Integers:
    """Return sums shifted to the right, rounded, and cut to a size; shapes (..., sums), (sums,)."""
    right, left = np.maximum(shift, 0), np.maximum(-shift, 0)
    cut = np.clip(sums, -(most >> left), most >> left) << left
    shifted = (sums + ((1 << right) >> 1)) >> right
    return np.where(shift < 0, cut, np.clip(shifted, -most, most))


def applied(made: Affine, values: Integers) -> Integers:
    """Return an affine map of integers."""
    return (values * made.factor + made.addend) >> made.shift


@dataclass(frozen=True)
class Function:
    """What makes values of whole sums: an activation, or what gives outputs.

    Attributes:
        of: Returns values of arguments, which are sums with fewer bits.
        argument_bits: Fraction bits of arguments; None: as many as fit.
        value_bits: Fraction bits of values; None: those of arguments.
        most: Arguments are cut to this size.
        slope: Greatest slope, by which errors of arguments are multiplied at most.
    """

    of: Callable[[Integers], Integers]
    argument_bits: int | None = None
    value_bits: int | None = None
    most: int = MOST_VALUE
    slope: float = 1.0

    def values_of(self, sums: Integers, shift: Integers) -> Integers:
        """Return values of sums that are shifted to arguments. Shapes (..., sums), (sums,)."""
        return self.of(scaled(sums, shift, self.most))


def same(values: Integers) -> Integers:
    """Return the numbers themselves."""
    return values


def positive(values: Integers) -> Integers:
    """Return the positive parts."""
    return np.maximum(values, 0)


OUTPUTS = "outputs"  # sums of a last layer without an activation, which have the scale of the outputs
FUNCTIONS = {
    "identity": Function(same),
    "relu": Function(positive),
    "hardtanh": Function(same, VALUE_BITS, most=ONE),
    "tanh": Function(tanh_of, ARGUMENT_BITS, VALUE_BITS),
    "sigmoid": Function(sigmoid_of, ARGUMENT_BITS - 1, VALUE_BITS, slope=0.25),
    OUTPUTS: Function(same, 0, most=MOST_SUM),
}


def product(weights: Integers, values: Integers) -> Integers:
    """Return weights times values. Shapes (rows, values), (..., values)."""
    # Floats of 64 bits hold every sum exactly, and their products are much faster than those of integers.
    return (values.astype(np.float64) @ weights.T.astype(np.float64)).astype(np.int64)


def halved(values: Integers) -> Integers:
    """Return products of values and shares of 1, with the fraction bits of values again, rounded."""
    return (values + ONE // 2) >> VALUE_BITS


def fixed_gru_step(layer: FixedLayer, values: Integers, state: Integers) -> Integers:
    """Return the next state of a GRU."""
    units = layer.source.units
    own, of_state = product(layer.weights, values), product(layer.recurrent_weights, state)
    gates = own[..., : 2 * units] + of_state[..., : 2 * units]
    sums = layer.bias + np.concatenate([gates, own[..., 2 * units :], of_state[..., 2 * units :]], axis=-1)
    reset, keep, new, old = np.split(scaled(sums, layer.shift, MOST_VALUE), 4, axis=-1)
    both = new + halved(sigmoid_of(reset) * old)
    candidate = tanh_of(scaled(both, np.array(layer.new_bits - ARGUMENT_BITS), MOST_VALUE))
    return candidate + halved(sigmoid_of(keep) * (state - candidate))


def fixed_layer_step(layer: FixedLayer, values: Integers, state: Integers) -> Integers:
    """Return what a layer gives, which is its next state if it is recurrent."""
    if isinstance(layer.source, Gru):
        return fixed_gru_step(layer, values, state)
    sums = layer.bias + product(layer.weights, values)
    if isinstance(layer.source, Elman):
        sums = sums + product(layer.recurrent_weights, state)
    return FUNCTIONS[layer.function].values_of(sums, layer.shift)


def fixed_step(network: FixedNetwork, observation: Integers, state: Integers) -> tuple[Integers, Integers]:
    """Return the outputs and the next state, the very numbers that the exported C computes.

    Args:
        network: The policy.
        observation: Whole numbers, cut to the range of the inputs. Shape (..., inputs).
        state: Shape (..., values that are remembered).
    """
    values = applied(network.input_map, observation - network.input_low)
    states = network.source.split_state(state)
    for number, layer in enumerate(network.layers):
        values = fixed_layer_step(layer, values, states[number])
        if layer.source.state_units:
            states[number] = values
    if network.output_map is not None:
        values = applied(network.output_map, values)
    return values, np.concatenate(states, axis=-1)
