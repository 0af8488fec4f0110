"""A policy in floats, and one in whole numbers, in the same form: as types, constants and expressions of C."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pogosim.policy.c_functions import OF_FLOATS, OF_INTEGERS
from pogosim.policy.c_text import Array
from pogosim.policy.fixed_arithmetic import Affine, FixedLayer, FixedNetwork
from pogosim.policy.network import Dense, Gru, Layer, Network, Numbers
from pogosim.policy.policy import Policy
from pogosim.policy.tanh_table import ARGUMENT_BITS, LARGEST, ONE, TABLE

RANGE = "Inputs are cut to this range."


@dataclass(frozen=True)
class ScalingInC:
    """How inputs or outputs are scaled.

    Attributes:
        arrays: Constants.
        lines: Statements for the element i; `SOURCE` stands for the array of values before. Empty: nothing is done.
    """

    arrays: tuple[Array, ...]
    lines: tuple[str, ...]


@dataclass(frozen=True)
class LayerInC:
    """A layer.

    Attributes:
        source: The layer in floats.
        weights: Shape (rows, values before).
        recurrent_weights: Shape (rows, units); None in a dense layer.
        sum_bias: What sums begin with.
        function: What makes values of the sums, @next_... in C.
        is_output: Whether its values are the outputs.
        shift: Bits by which sums are shifted; None: they are not.
        arguments: More arguments of the function.
    """

    source: Layer
    weights: Numbers
    recurrent_weights: Numbers | None
    sum_bias: Numbers
    function: str
    is_output: bool = False
    shift: Numbers | None = None
    arguments: str = ""


@dataclass(frozen=True)
class Form:
    """A policy.

    Attributes:
        types: Types of "value" (inputs and outputs), "weight", "number" (values between layers) and "sum".
        functions: All functions of its arithmetic, by their names.
        inputs: What makes scaled[i] of inputs[i].
        layers: From the inputs to the outputs.
        outputs: What makes outputs[i] of the last layer's values.
        tables: Constants of functions, by the name that they are called by.
    """

    types: Mapping[str, str]
    functions: Mapping[str, str]
    inputs: ScalingInC
    layers: tuple[LayerInC, ...]
    outputs: ScalingInC
    tables: Mapping[str, Array]


def float_layer(layer: Layer) -> LayerInC:
    """Return a layer in floats."""
    if isinstance(layer, Gru):
        return LayerInC(layer, layer.weights, layer.recurrent_weights, layer.sum_bias, "gru")
    recurrent = None if isinstance(layer, Dense) else layer.recurrent_weights
    return LayerInC(layer, layer.weights, recurrent, layer.bias, layer.activation)


def float_form(network: Network) -> Form:
    """Return a policy in floats."""
    arrays = [
        Array("float", "@input_offset", network.input_offset),
        Array("float", "@input_scale", network.input_scale),
    ]
    given = "inputs[i]"
    if network.has_range:
        low, high = network.input_ends
        arrays = [Array("float", "@input_low", low, RANGE), Array("float", "@input_high", high), *arrays]
        given = "@cut(inputs[i], @input_low[i], @input_high[i])"
    output_arrays = (
        Array("float", "@output_scale", network.output_scale),
        Array("float", "@output_offset", network.output_offset),
    )
    return Form(
        dict.fromkeys(("value", "weight", "number", "sum"), "float"),
        OF_FLOATS,
        ScalingInC(tuple(arrays), (f"scaled[i] = ({given} - @input_offset[i]) * @input_scale[i];",)),
        tuple(map(float_layer, network.layers)),
        ScalingInC(output_arrays, ("outputs[i] = SOURCE[i] * @output_scale[i] + @output_offset[i];",)),
        {},
    )


def fixed_layer(layer: FixedLayer) -> LayerInC:
    """Return a layer in whole numbers."""
    recurrent = layer.recurrent_weights if layer.source.state_units else None
    arguments = f"{layer.new_bits - ARGUMENT_BITS}, " if isinstance(layer.source, Gru) else ""
    return LayerInC(
        layer.source,
        layer.weights,
        recurrent,
        layer.bias,
        layer.function,
        is_output=layer.is_output,
        shift=layer.shift,
        arguments=arguments,
    )


def affine_arrays(name: str, made: Affine) -> tuple[Array, ...]:
    """Return the constants of an affine map."""
    return (
        Array("int32_t", f"@{name}_factor", made.factor),
        Array("int32_t", f"@{name}_addend", made.addend),
        Array("uint8_t", f"@{name}_shift", made.shift),
    )


def fixed_form(fixed: FixedNetwork) -> Form:
    """Return a policy in whole numbers."""
    ends = (Array("int32_t", "@input_low", fixed.input_low, RANGE), Array("int32_t", "@input_high", fixed.input_high))
    input_lines = (
        "int32_t const above = @cut(inputs[i], @input_low[i], @input_high[i]) - @input_low[i];",
        "int32_t const sum = above * @input_factor[i] + @input_addend[i];",
        "scaled[i] = (int16_t)@shifted(sum, @input_shift[i]);",
    )
    outputs = ScalingInC((), ())
    if fixed.output_map is not None:
        output_lines = (
            "int32_t const sum = SOURCE[i] * @output_factor[i] + @output_addend[i];",
            "outputs[i] = @shifted(sum, @output_shift[i]);",
        )
        outputs = ScalingInC(affine_arrays("output", fixed.output_map), output_lines)
    table = Array("int16_t", "@tanh_table", TABLE, f"tanh from 0 to {LARGEST}, times {ONE}")
    return Form(
        {"value": "int32_t", "weight": f"int{fixed.bits}_t", "number": "int16_t", "sum": "int32_t"},
        OF_INTEGERS,
        ScalingInC((*ends, *affine_arrays("input", fixed.input_map)), input_lines),
        tuple(map(fixed_layer, fixed.layers)),
        outputs,
        {"@tanh_table[": table},
    )


def form_of(policy: Policy) -> Form:
    """Return a policy in the numbers that it computes in."""
    return float_form(policy.network) if policy.fixed is None else fixed_form(policy.fixed)
