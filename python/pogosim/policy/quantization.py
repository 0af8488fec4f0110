"""Makes whole numbers of a policy, for robots whose processor has no floating-point unit.

Everything is derived from the range of the inputs, which are cut to it: intervals of integers are followed through the
layers, and exponents are chosen such that no sum, product or value can leave its type. So nothing can overflow,
whatever the robot senses. Errors are followed likewise: `error_bound` holds for every input in the range, against the
same policy in exact arithmetic; for recurrent policies, for a step from the same state.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pogosim.policy.errors import PolicyError
from pogosim.policy.fixed_arithmetic import (
    FUNCTIONS,
    MOST_SUM,
    MOST_VALUE,
    OUTPUTS,
    Affine,
    FixedLayer,
    FixedNetwork,
    Floats,
    Integers,
    applied,
    scaled,
)
from pogosim.policy.network import Dense, Elman, Gru, Layer, Network
from pogosim.policy.tanh_table import ARGUMENT_BITS, ONE, VALUE_BITS

MOST_INTEGER = (1 << 31) - 1
MOST_SHIFT = 30
MOST_LEFT_SHIFT = 12  # arguments are then cut to 7 (tanh) or 14 (sigmoid)
BEYOND = 2e-6  # what tanh and sigmoid still change beyond that
MOST_SPAN = 1 << 20  # of an input: more would leave too few bits for its factor
FEWEST_STEPS = 16  # of an input's range: fewer tell too little


@dataclass
class Values:
    """What is known of a layer's values: integers between two ends, and how far what they stand for is off at most.

    Attributes:
        low: Shape (values,).
        high: Shape (values,).
        bits: Bits of the fraction.
        error: Shape (values,).
    """

    low: Integers
    high: Integers
    bits: int
    error: Floats

    @property
    def size(self) -> Integers:
        """Greatest absolute values."""
        return np.maximum(np.abs(self.low), np.abs(self.high))


def whole_range(network: Network) -> tuple[Integers, Integers]:
    """Return the ends of the ranges of inputs as whole numbers.

    Raises:
        PolicyError: A range is unknown or too large.
    """
    low, high = np.floor(network.input_range[:, 0]).astype(float), np.ceil(network.input_range[:, 1]).astype(float)
    for name, least, most in zip(network.input_names, low, high, strict=True):
        if np.isnan(least):
            raise PolicyError(
                f"the range of the input {name} is unknown; expected observations of a run (--calibration FILE), or "
                "input_low and input_high in the policy"
            )
        if max(abs(least), abs(most)) > MOST_SUM or most - least > MOST_SPAN:
            raise PolicyError(
                f"the input {name} ranges from {least:.10g} to {most:.10g}; in whole numbers it may range over "
                f"{MOST_SPAN}: give it in a larger unit"
            )
    return low.astype(np.int64), high.astype(np.int64)


def affine(factor: Floats, addend: Floats, size: Integers) -> Affine:
    """Return value * factor + addend, for whole values of these sizes at most, as precisely as 32 bits allow."""
    shifts = np.zeros(len(factor), np.int64)
    for index, (own, added, most) in enumerate(zip(factor, addend, size, strict=True)):
        for shift in range(MOST_SHIFT, -1, -1):
            product = abs(round(math.ldexp(own, shift))) * max(int(most), 1)
            if max(product, product + abs(round(math.ldexp(added, shift))) + (1 << shift)) <= MOST_INTEGER:
                shifts[index] = shift
                break
        else:
            raise PolicyError("inputs or outputs are scaled to more than 2000 million, which 32 bits cannot hold")
    half = (1 << shifts) >> 1
    return Affine(
        np.rint(np.ldexp(factor, shifts)).astype(np.int64),
        np.rint(np.ldexp(addend, shifts)).astype(np.int64) + half,
        shifts,
    )


def affine_error(made: Affine, factor: Floats, size: Integers) -> Floats:
    """Return how far an affine map is off at most: by its factor, its addend and its rounding."""
    off = np.ldexp(made.factor.astype(float), -made.shift) - factor
    return np.asarray(np.abs(off) * size + np.ldexp(0.5, -made.shift) + 0.5)


def inputs_of(network: Network, low: Integers, high: Integers) -> tuple[Affine, Values]:
    """Return the map that scales inputs, and what is known of the scaled ones.

    Raises:
        PolicyError: A scaled input is too large, or hardly changes.
    """
    scale, offset = network.input_scale.astype(float), network.input_offset.astype(float)
    ends = np.stack([(low - offset) * scale, (high - offset) * scale])
    size = float(np.abs(ends).max())
    span = high - low
    for bits in range(VALUE_BITS, -1, -1):
        if math.ldexp(size, bits) > MOST_VALUE:
            continue
        made = affine(np.ldexp(scale, bits), np.ldexp(ends[0], bits), span)
        both = np.stack([applied(made, np.zeros_like(span)), applied(made, span)])
        if int(np.abs(both).max()) <= MOST_VALUE:
            break
    else:
        worst = network.input_names[int(np.abs(ends).max(axis=0).argmax())]
        raise PolicyError(
            f"the input {worst} is scaled to {size:.6g}; in whole numbers, it may be {MOST_VALUE} at most: choose "
            "input_offset and input_scale such that inputs are about -1 to 1"
        )
    for index, steps in enumerate(np.abs(both[1] - both[0])):
        if steps < FEWEST_STEPS:
            least, most = np.sort(ends[:, index])
            raise PolicyError(
                f"the input {network.input_names[index]} is scaled to {least:.3g} to {most:.3g}, {steps} steps of the "
                "numbers of 16 bits in which all inputs are: choose input_offset and input_scale such that inputs are "
                "about -1 to 1"
            )
    error = np.ldexp(affine_error(made, np.ldexp(scale, bits), span), -bits)
    return made, Values(both.min(axis=0), both.max(axis=0), bits, error)


def row_exponent(parts: Sequence[tuple[Floats, Values]], bias: float, bits: int) -> int:
    """Return the greatest exponent of a sum for which weights and the sum fit into their types, for all values.

    Args:
        parts: Weights, and the values that they multiply.
        bias: What the sum begins with.
        bits: Bits of a weight.

    Raises:
        PolicyError: There is none.
    """
    most = (1 << (bits - 1)) - 1
    for exponent in range(MOST_SHIFT, -MOST_LEFT_SHIFT - 1, -1):
        total = abs(round(math.ldexp(bias, exponent)))
        fits = True
        for weights, values in parts:
            rounded = np.abs(np.rint(np.ldexp(weights, exponent - values.bits)))
            fits = fits and bool((rounded <= most).all())
            total += int((rounded * values.size).sum()) if fits else 0
        if fits and total <= MOST_SUM:
            return exponent
    raise PolicyError("weights are too large for whole numbers: scale the policy's values to about -1 to 1")


@dataclass
class Sums:
    """Sums of a layer in whole numbers.

    Attributes:
        exponent: What sums are multiplied by, as a power of two. Shape (rows,).
        weights: For each part of the values, shape (rows, values).
        bias: Shape (rows,).
        low: Least sums. Shape (rows,).
        high: Greatest sums. Shape (rows,).
        error: How far what they stand for is off at most. Shape (rows,).
    """

    exponent: Integers
    weights: list[Integers]
    bias: Integers
    low: Integers
    high: Integers
    error: Floats


def sums_of(parts: Sequence[tuple[Floats, Values]], bias: Floats, bits: int) -> Sums:
    """Return the sums of weights times values, rounded so that they fit into 32 bits whatever the values are."""
    rows = [row_exponent([(w[row], values) for w, values in parts], bias[row], bits) for row in range(len(bias))]
    exponent = np.array(rows, np.int64)
    start = np.rint(np.ldexp(bias, exponent)).astype(np.int64)
    made = Sums(
        exponent, [], start, start.copy(), start.copy(), np.abs(bias - np.ldexp(start.astype(float), -exponent))
    )
    for weights, values in parts:
        rounded = np.rint(np.ldexp(weights, exponent[:, None] - values.bits))
        off = np.abs(weights - np.ldexp(rounded, values.bits - exponent[:, None]))
        made.error += np.abs(weights) @ values.error + off @ np.ldexp(values.size.astype(float), -values.bits)
        whole = rounded.astype(np.int64)
        positive: Integers = np.maximum(whole, 0)
        negative: Integers = np.minimum(whole, 0)
        made.low = np.asarray(made.low + positive @ values.low + negative @ values.high, np.int64)
        made.high = np.asarray(made.high + positive @ values.high + negative @ values.low, np.int64)
        made.weights.append(whole)
    return made


def shifted_error(sums: Sums, bits: int) -> Floats:
    """Return how far sums are off at most after they are shifted to so many fraction bits."""
    return sums.error + np.where(sums.exponent > bits, math.ldexp(0.5, -bits), 0.0)


def bits_that_fit(sums: Sums, most_bits: int) -> int:
    """Return how many fraction bits the values of sums can have so that they fit into 16 bits.

    Raises:
        PolicyError: They are too large.
    """
    size = np.maximum(np.abs(sums.low), np.abs(sums.high))
    for bits in range(most_bits, -1, -1):
        if int(scaled(size, sums.exponent - bits, MOST_SUM).max()) <= MOST_VALUE:
            return bits
    raise PolicyError(
        f"values of a layer may reach {float(np.ldexp(size.astype(float), -sums.exponent).max()):.3g}; in whole "
        f"numbers, {MOST_VALUE} at most: scale the policy's values to about -1 to 1, or use tanh"
    )


def table_error(name: str, exact: Callable[[Floats], Floats]) -> float:
    """Return how far the table of tanh or sigmoid is off at most: by trying all arguments, and beyond them."""
    function = FUNCTIONS[name]
    assert function.argument_bits is not None
    arguments = np.arange(-function.most, function.most + 1, dtype=np.int64)
    wanted = exact(np.ldexp(arguments.astype(float), -function.argument_bits))
    return float(np.abs(np.ldexp(function.of(arguments).astype(float), -VALUE_BITS) - wanted).max()) + BEYOND


TABLE_ERROR = {"tanh": table_error("tanh", np.tanh), "sigmoid": table_error("sigmoid", lambda x: 1 / (1 + np.exp(-x)))}


def function_error(name: str, sums: Sums, bits: int) -> Floats:
    """Return how far values are off at most that a function makes of sums with so many fraction bits."""
    return FUNCTIONS[name].slope * shifted_error(sums, bits) + TABLE_ERROR.get(name, 0.0)


def layer_of_sums(layer: Dense | Elman, sums: Sums, is_output: bool) -> tuple[FixedLayer, Values]:
    """Return a layer that has these sums, and what is known of its values.

    Raises:
        PolicyError: They are too large.
    """
    if is_output:
        size = float(np.ldexp(np.maximum(-sums.low, sums.high).astype(float), -sums.exponent).max())
        if size > MOST_SUM:
            raise PolicyError(f"outputs may reach {size:.3g}; expected {MOST_SUM} at most, see output_scale")
    name = OUTPUTS if is_output else layer.activation
    function = FUNCTIONS[name]
    bits = function.argument_bits if function.argument_bits is not None else bits_that_fit(sums, VALUE_BITS)
    value_bits = function.value_bits if function.value_bits is not None else bits
    shift = sums.exponent - bits
    check_shift(shift)
    recurrent = sums.weights[1] if len(sums.weights) > 1 else np.zeros((0, layer.units), np.int64)
    made = FixedLayer(layer, sums.weights[0], recurrent, sums.bias, shift, name)
    low, high = (function.values_of(ends, shift) for ends in (sums.low, sums.high))
    return made, Values(low, high, value_bits, function_error(name, sums, bits))


def check_shift(shift: Integers) -> None:
    """Check that sums need not be shifted too far.

    Raises:
        PolicyError: They do: weights are far too large.
    """
    if int(shift.min()) < -MOST_LEFT_SHIFT:
        raise PolicyError("weights are too large for whole numbers: scale the policy's values to about -1 to 1")


def remembered(units: int, least: int) -> Values:
    """Return what is known of the values that a recurrent layer remembers: all are possible, and they are exact."""
    return Values(np.full(units, least), np.full(units, ONE), VALUE_BITS, np.zeros(units))


def fixed_gru(layer: Gru, values: Values, bits: int) -> tuple[FixedLayer, Values]:
    """Return a GRU in whole numbers, and what is known of its values."""
    units = layer.units
    weights, recurrent = layer.weights.astype(float), layer.recurrent_weights.astype(float)
    bias = layer.bias.astype(float)
    gate, state = slice(0, 2 * units), remembered(units, -ONE)
    gates = sums_of([(weights[gate], values), (recurrent[gate], state)], bias[gate], bits)
    new = sums_of([(weights[2 * units :], values)], bias[2 * units :], bits)
    old = sums_of([(recurrent[2 * units :], state)], layer.recurrent_bias[2 * units :].astype(float), bits)
    new_bits = min(bits_that_fit(new, ARGUMENT_BITS), bits_that_fit(old, ARGUMENT_BITS))

    gate_bits = ARGUMENT_BITS - 1
    gate_error = function_error("sigmoid", gates, gate_bits)
    reset_error, keep_error = gate_error[:units], gate_error[units:]
    old_size = np.ldexp(np.maximum(np.abs(old.low), np.abs(old.high)).astype(float), -old.exponent) + old.error
    sum_error = shifted_error(new, new_bits) + shifted_error(old, new_bits) + old_size * reset_error
    sum_error += math.ldexp(0.5, -new_bits)
    new_error = sum_error + TABLE_ERROR["tanh"]
    error = new_error + (2.0 + new_error) * keep_error + math.ldexp(0.5, -VALUE_BITS)

    made = FixedLayer(
        layer,
        np.concatenate([gates.weights[0], new.weights[0]]),
        np.concatenate([gates.weights[1], old.weights[0]]),
        np.concatenate([gates.bias, new.bias, old.bias]),
        np.concatenate([gates.exponent - gate_bits, new.exponent - new_bits, old.exponent - new_bits]),
        "gru",
        new_bits,
    )
    check_shift(made.shift)
    return made, Values(state.low, state.high, VALUE_BITS, error)


def fixed_layer(layer: Layer, values: Values, bits: int, is_output: bool) -> tuple[FixedLayer, Values]:
    """Return a layer in whole numbers, and what is known of its values.

    Raises:
        PolicyError: Its weights are too large, or its values have no bounds.
    """
    if isinstance(layer, Gru):
        return fixed_gru(layer, values, bits)
    parts = [(layer.weights.astype(float), values)]
    if isinstance(layer, Elman):
        if layer.activation in ("identity", "relu"):
            raise PolicyError(
                f"a recurrent layer with {layer.activation} may grow without bounds, which whole numbers cannot; "
                "expected tanh, sigmoid or hardtanh, or --numbers float"
            )
        state = remembered(layer.units, 0 if layer.activation == "sigmoid" else -ONE)
        parts.append((layer.recurrent_weights.astype(float), state))
    return layer_of_sums(layer, sums_of(parts, layer.bias.astype(float), bits), is_output)


def gives_outputs(layer: Layer) -> bool:
    """Tell whether a last layer can have the scale of the outputs in its weights: one without an activation."""
    return isinstance(layer, Dense) and layer.activation == "identity"


def with_outputs_in_weights(network: Network) -> Layer:
    """Return a last layer that gives outputs, with their scale in its weights."""
    layer = network.layers[-1]
    scale, offset = network.output_scale.astype(float), network.output_offset.astype(float)
    return Dense(layer.weights.astype(float) * scale[:, None], layer.bias.astype(float) * scale + offset, "identity")


def quantized(network: Network, bits: int = 16) -> FixedNetwork:
    """Make whole numbers of a policy.

    Args:
        network: The policy.
        bits: Bits of a weight, 8 or 16.

    Raises:
        PolicyError: The range of an input is unknown, its numbers are too large, inputs hardly change, or the values of
            a layer have no bounds.
    """
    low, high = whole_range(network)
    input_map, values = inputs_of(network, low, high)
    layers: list[FixedLayer] = []
    is_scaled = gives_outputs(network.layers[-1])
    sources = (*network.layers[:-1], with_outputs_in_weights(network)) if is_scaled else network.layers
    for number, layer in enumerate(sources):
        try:
            made, values = fixed_layer(layer, values, bits, is_scaled and number == len(sources) - 1)
        except PolicyError as problem:
            raise PolicyError(f"layer {number}: {problem}") from None
        layers.append(made)
    output_map, error = (None, values.error) if is_scaled else outputs_of(network, values)
    bound = error * (1 + 1e-9) + 1e-9
    return FixedNetwork(network, bits, low, high, input_map, tuple(layers), output_map, bound)


def outputs_of(network: Network, values: Values) -> tuple[Affine, Floats]:
    """Return the map that scales the last layer's values to outputs, and how far these are off at most."""
    scale, offset = network.output_scale.astype(float), network.output_offset.astype(float)
    factor = np.ldexp(scale, -values.bits)
    made = affine(factor, offset, values.size)
    return made, np.abs(scale) * values.error + affine_error(made, factor, values.size)
