"""A policy as a header in C for programs of robots.

C99 and later, C++ as well; no memory is allocated, and no C library is needed but memcpy() and memset().
"""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass, field

import numpy as np

import pogosim
from pogosim.policy.c_parts import ADD_PRODUCT, OF_FLOAT_LAYER, OF_FLOATS, OF_INTEGER_LAYER, OF_INTEGERS, needed
from pogosim.policy.c_text import Array, literal
from pogosim.policy.errors import PolicyError
from pogosim.policy.fixed_point import ARGUMENT_BITS, MOST_SUM, MOST_VALUE, ONE, Affine, FixedLayer
from pogosim.policy.network import NAME, Dense, Gru, Layer, Network, Numbers
from pogosim.policy.policy import Policy
from pogosim.policy.tanh_table import TABLE
from pogosim.policy.test_vector import TestVector

WIDTH = 120
MOST_WEIGHTS = 1 << 18  # several times as many as a robot has memory for
RANGE = "Inputs are cut to this range."
FLOAT_TOLERANCE = 1e-4  # of the greatest output: compilers may contract operations
# Multiplications of a call of a function, at most.
MULTIPLICATIONS = {
    "float": {"tanh": 11, "sigmoid": 11, "gru": 35},
    "fixed": {"tanh": 1, "sigmoid": 1, "gru": 5},
}
RESERVED = re.compile(
    "alignas|alignof|and|asm|auto|bool|break|case|catch|char|class|const|constexpr|continue|default|delete|do|double|else"
    "|enum|explicit|export|extern|false|float|for|friend|goto|if|inline|int|long|main|mutable|namespace|new|not|nullptr"
    "|operator|or|private|protected|public|register|restrict|return|short|signed|sizeof|static|struct|switch|template"
    "|this|throw|true|try|typedef|typename|union|unsigned|using|virtual|void|volatile|while|xor"
)


@dataclass(frozen=True)
class Header:
    """An exported policy.

    Attributes:
        text: The header.
        constant_bytes: Weights, biases, tables and the test vector.
        state_bytes: What a robot remembers, in USERDATA.
        stack_bytes: Arrays of a call.
        multiplications: In a call, at most.
    """

    text: str
    constant_bytes: int
    state_bytes: int
    stack_bytes: int
    multiplications: int


@dataclass
class Parts:
    """What a header is made of, as it is put together.

    Attributes:
        arrays: Constants.
        functions: Names of the functions that are needed.
        body: Lines of the step.
        locals: Arrays of the step, with their bytes.
        state: Members of the state, with their bytes.
        sums: Greatest number of sums of a layer.
        multiplications: In a call, at most.
    """

    arrays: list[Array] = field(default_factory=list)
    functions: set[str] = field(default_factory=set)
    body: list[str] = field(default_factory=list)
    locals: list[tuple[str, int]] = field(default_factory=list)
    state: list[tuple[str, int]] = field(default_factory=list)
    sums: int = 0
    multiplications: int = 0


def checked_prefix(name: str) -> str:
    """Return what all names of a header begin with.

    Raises:
        PolicyError: It is no name in C.
    """
    if not NAME.fullmatch(name) or RESERVED.fullmatch(name) or name.endswith("_"):
        raise PolicyError(
            f"--name {name}: expected a name as in C, such as policy, for functions such as policy_step()"
        )
    return name


def layer_parts(parts: Parts, number: int, layer: Layer, source: str, before: int, fixed: FixedLayer | None) -> str:
    """Add a layer; returns the name of the array with its values.

    Args:
        parts: What is added to.
        number: Which layer it is.
        layer: The layer.
        source: The array with the values before.
        before: How many these are.
        fixed: The layer in whole numbers; None: in floats.
    """
    units = layer.units
    is_gru = isinstance(layer, Gru)
    value = "float" if fixed is None else "int16_t"
    name = f"layer_{number}"
    is_output = fixed is not None and fixed.most == MOST_SUM
    if layer.kind != "dense":
        parts.state.append((f"{value} {name}[{units}];", units * (4 if fixed is None else 2)))
        target = f"state->{name}"
    elif is_output:
        target = "outputs"
    else:
        parts.locals.append((f"{value} {name}[{units}];", units * (4 if fixed is None else 2)))
        target = name
    add_constants(parts, number, layer, fixed)
    parts.sums = max(parts.sums, (4 if is_gru else 1) * units)
    weights, recurrent = f"@weights_{number}", f"@recurrent_weights_{number}"
    rows = (3 if is_gru else 1) * units
    parts.body += [
        f"    // Layer {number}: {units} {'GRU' if is_gru else getattr(layer, 'activation', '')}",
        f"    memcpy(sums, @bias_{number}, sizeof(@bias_{number}));",
        f"    @add_product({weights}, {source}, {rows}, {before}, sums);",
    ]
    parts.multiplications += rows * before
    if isinstance(layer, Gru):
        parts.body += [
            f"    @add_product({recurrent}, {target}, {2 * units}, {units}, sums);",
            f"    @add_product({recurrent} + {2 * units * units}, {target}, {units}, {units}, sums + {3 * units});",
        ]
        activation = "gru"
    else:
        if layer.kind == "elman":
            parts.body.append(f"    @add_product({recurrent}, {target}, {units}, {units}, sums);")
        activation = "outputs" if is_output else layer.activation
    parts.multiplications += rows * units if layer.kind != "dense" else 0
    parts.multiplications += units * MULTIPLICATIONS["float" if fixed is None else "fixed"].get(activation, 0)
    parts.functions.add(activation)
    shift = "" if fixed is None else f"@shift_{number}, "
    new = f"{fixed.new_bits - ARGUMENT_BITS}, " if fixed is not None and is_gru else ""
    parts.body.append(f"    @next_{activation}(sums, {shift}{units}, {new}{target});")
    return target


def add_constants(parts: Parts, number: int, layer: Layer, fixed: FixedLayer | None) -> None:
    """Add the weights and biases of a layer, and the shifts of one in whole numbers."""
    matrices: tuple[Numbers, Numbers | None]
    bias: Numbers
    if fixed is None:
        bias = layer.bias
        if isinstance(layer, Gru):
            units = layer.units
            bias = np.concatenate([layer.bias, layer.recurrent_bias[2 * units :]])
            bias[: 2 * units] += layer.recurrent_bias[: 2 * units]
        recurrent = None if isinstance(layer, Dense) else layer.recurrent_weights
        matrices, sum_type = (layer.weights, recurrent), "float"
    else:
        matrices = (fixed.weights, fixed.recurrent_weights if fixed.recurrent_weights.size else None)
        bias, sum_type = fixed.bias, "int32_t"
    shape = f"{matrices[0].shape[0]} rows of {matrices[0].shape[1]}"
    parts.arrays.append(Array("@weight_t", f"@weights_{number}", matrices[0].reshape(-1), f"Layer {number}: {shape}"))
    if matrices[1] is not None:
        parts.arrays.append(Array("@weight_t", f"@recurrent_weights_{number}", matrices[1].reshape(-1)))
    parts.arrays.append(Array(sum_type, f"@bias_{number}", bias))
    if fixed is not None:
        parts.arrays.append(Array("int8_t", f"@shift_{number}", fixed.shift))


def affine_arrays(name: str, made: Affine) -> list[Array]:
    """Return the constants of an affine map."""
    return [
        Array("int32_t", f"@{name}_factor", made.factor),
        Array("int32_t", f"@{name}_addend", made.addend),
        Array("uint8_t", f"@{name}_shift", made.shift),
    ]


def float_parts(policy: Policy) -> Parts:
    """Return the parts of a policy in floats."""
    network = policy.network
    parts = Parts()
    given = "inputs[i]"
    if network.has_range:
        low, high = network.input_ends
        parts.arrays += [Array("float", "@input_low", low, RANGE), Array("float", "@input_high", high)]
        parts.functions.add("cut")
        given = "@cut(inputs[i], @input_low[i], @input_high[i])"
    parts.arrays += [
        Array("float", "@input_offset", network.input_offset),
        Array("float", "@input_scale", network.input_scale),
    ]
    parts.locals.append((f"float scaled[{network.inputs}];", 4 * network.inputs))
    parts.body += [
        f"    for (uint16_t i = 0; i < {network.inputs}; i++) {{",
        f"        scaled[i] = ({given} - @input_offset[i]) * @input_scale[i];",
        "    }",
    ]
    source, before = "scaled", network.inputs
    for number, layer in enumerate(network.layers):
        source = layer_parts(parts, number, layer, source, before, None)
        before = layer.units
    parts.arrays += [
        Array("float", "@output_scale", network.output_scale),
        Array("float", "@output_offset", network.output_offset),
    ]
    parts.body += [
        f"    for (uint16_t i = 0; i < {network.outputs}; i++) {{",
        f"        outputs[i] = {source}[i] * @output_scale[i] + @output_offset[i];",
        "    }",
    ]
    parts.multiplications += network.inputs + network.outputs
    parts.locals.append((f"float sums[{parts.sums}];", 4 * parts.sums))
    return parts


def fixed_parts(policy: Policy) -> Parts:
    """Return the parts of a policy in whole numbers."""
    fixed = policy.fixed
    assert fixed is not None
    network = policy.network
    parts = Parts(functions={"scaled"})
    parts.arrays = [
        Array("int32_t", "@input_low", fixed.input_low, RANGE),
        Array("int32_t", "@input_high", fixed.input_high),
        *affine_arrays("input", fixed.input_map),
    ]
    parts.locals.append((f"int16_t scaled[{network.inputs}];", 2 * network.inputs))
    parts.body += [
        f"    for (uint16_t i = 0; i < {network.inputs}; i++) {{",
        "        int32_t const above = @cut(inputs[i], @input_low[i], @input_high[i]) - @input_low[i];",
        "        int32_t const sum = above * @input_factor[i] + @input_addend[i];",
        "        scaled[i] = (int16_t)@shifted(sum, @input_shift[i]);",
        "    }",
    ]
    source, before = "scaled", network.inputs
    for number, layer in enumerate(fixed.layers):
        source = layer_parts(parts, number, layer.source, source, before, layer)
        before = layer.source.units
    if fixed.output_map is not None:
        parts.arrays += affine_arrays("output", fixed.output_map)
        parts.body += [
            f"    for (uint16_t i = 0; i < {network.outputs}; i++) {{",
            f"        int32_t const sum = {source}[i] * @output_factor[i] + @output_addend[i];",
            "        outputs[i] = @shifted(sum, @output_shift[i]);",
            "    }",
        ]
        parts.multiplications += network.outputs
    parts.multiplications += network.inputs
    if parts.functions & {"tanh", "sigmoid", "gru"}:
        parts.arrays.append(Array("int16_t", "@tanh_table", TABLE, "tanh from 0 to 8, times 16384"))
    parts.locals.append((f"int32_t sums[{parts.sums}];", 4 * parts.sums))
    return parts


def functions_of(parts: Parts, is_fixed: bool) -> list[str]:
    """Return the functions that the step calls."""
    activations = parts.functions - {"cut", "scaled", "gru", "outputs"}
    if not is_fixed:
        layers = [OF_FLOAT_LAYER.format(activation=name) for name in sorted(activations)]
        return [*needed(parts.functions, OF_FLOATS), ADD_PRODUCT, *layers]
    layers = [
        OF_INTEGER_LAYER.format(
            activation=name,
            function="identity" if name == "hardtanh" else name,
            most=ONE if name == "hardtanh" else MOST_VALUE,
        )
        for name in sorted(activations)
    ]
    return [*needed(parts.functions, OF_INTEGERS), ADD_PRODUCT, *layers]


def enumeration(names: tuple[str, ...], what: str, comments: list[str]) -> list[str]:
    """Return the places of inputs or outputs as an enum, and how many there are: a name that no place can have."""
    rows = [f"    @@{what}_{name},".upper() for name in names]
    width = max(map(len, rows))
    made = [f"{row:{width}}  // {comment}" for row, comment in zip(rows, comments, strict=True)]
    return ["enum {", *made, f"    @@{what}S".upper(), "};"]


def comments_of_inputs(policy: Policy) -> list[str]:
    """Return what is said of each input."""
    network, fixed = policy.network, policy.fixed
    made = []
    for index, name in enumerate(network.input_names):
        text = f"{name}: scaled by ({name} - {network.input_offset[index]:.6g}) * {network.input_scale[index]:.6g}"
        if fixed is not None:
            text += f", cut to {fixed.input_low[index]} to {fixed.input_high[index]}"
        elif not np.isnan(network.input_range[index, 0]):
            least, most = network.input_range[index]
            text += f", cut to {least:.6g} to {most:.6g}"
        made.append(text)
    return made


def comments_of_outputs(policy: Policy) -> list[str]:
    """Return what is said of each output."""
    network, fixed = policy.network, policy.fixed
    made = []
    for index, name in enumerate(network.output_names):
        text = f"{name}: value * {network.output_scale[index]:.6g} + {network.output_offset[index]:.6g}"
        if fixed is not None:
            what = " in a step" if network.is_recurrent else ""
            text += f", within {fixed.error_bound[index]:.3g} of exact arithmetic{what}"
        made.append(text)
    return made


def introduction(policy: Policy, prefix: str, source: str) -> list[str]:
    """Return the comment at the top."""
    upper = prefix.upper()
    network = policy.network
    kind = "floats of 32 bits" if policy.fixed is None else f"whole numbers; weights of {policy.fixed.bits} bits"
    state = f"&mydata->{prefix}, " if network.is_recurrent else ""
    of_user_data = f"a member `{prefix}_state_t {prefix};` in USERDATA, and " if network.is_recurrent else ""
    init = [f"//         {prefix}_reset(&mydata->{prefix});"] if network.is_recurrent else []
    values = ", ".join(f"{name}" for name in network.input_names)
    text = (
        f"The policy of {source} as C for robots: {network.describe()}; {kind}. Made by `pogosim export-policy` of "
        f"Pogosim {pogosim.__version__}; change the policy, and export it again."
    )
    note = (
        "Inputs and outputs are floats."
        if policy.fixed is None
        else "Inputs and outputs are whole numbers. No sum or product leaves its type, whatever the inputs are."
    )
    return [
        *(f"// {line}" for line in textwrap.wrap(text, WIDTH - 3)),
        "//",
        *(
            f"// {line}"
            for line in textwrap.wrap(f"In a program with {of_user_data}this header behind pogobase.h:", WIDTH - 3)
        ),
        "//",
        "//     void user_init(void) {",
        f"//         if (!{prefix}_self_test()) {{ pogobot_led_setColor(255, 0, 0); }}  // not what was exported",
        *init,
        "//     }",
        "//     void user_step(void) {",
        *(
            f"//         {line}"
            for line in textwrap.wrap(
                f"{prefix}_value_t const inputs[{upper}_INPUTS] = {{{values}}};",
                WIDTH - 12,
                subsequent_indent="    ",
            )
        ),
        f"//         {prefix}_value_t outputs[{upper}_OUTPUTS];",
        f"//         {prefix}_step({state}inputs, outputs);",
        f"//         ... outputs[{upper}_OUTPUT_{network.output_names[0].upper()}] ...",
        "//     }",
        "//",
        *(f"// {line}" for line in textwrap.wrap(f"{note} Their scales are at their names, below.", WIDTH - 3)),
    ]


def self_test(policy: Policy, vector: TestVector) -> list[str]:
    """Return the function with which a robot checks that the policy does there what it did when it was exported."""
    network = policy.network
    steps = len(vector.inputs)
    argument = "&state, " if network.is_recurrent else ""
    state = ["    @state_t state;", "    @reset(&state);"] if network.is_recurrent else []
    if policy.fixed is None:
        tolerance = max(FLOAT_TOLERANCE * float(np.abs(vector.outputs).max()), FLOAT_TOLERANCE / 100)
        wrong = "!(difference > -@TOLERANCE && difference < @TOLERANCE)".replace(
            "@TOLERANCE", literal(tolerance, "float")
        )
        check = [
            "            float const difference = outputs[i] - @test_outputs[step][i];",
            f"            if ({wrong}) {{",
        ]
    else:
        check = ["            if (outputs[i] != @test_outputs[step][i]) {"]
    return [
        "// Whether this program and this processor give the outputs that were there when the policy was exported.",
        "static inline bool @self_test(void) {",
        "    @value_t outputs[@@OUTPUTS];",
        *state,
        f"    for (uint16_t step = 0; step < {steps}; step++) {{",
        f"        @step({argument}@test_inputs[step], outputs);",
        f"        for (uint16_t i = 0; i < {network.outputs}; i++) {{",
        *check,
        "                return false;",
        "            }",
        "        }",
        "    }",
        "    return true;",
        "}",
    ]


def check_size(network: Network) -> None:
    """Check that a policy is not far too large for a robot.

    Raises:
        PolicyError: It is.
    """
    weights = sum(
        layer.weights.size + (0 if isinstance(layer, Dense) else layer.recurrent_weights.size)
        for layer in network.layers
    )
    if weights > MOST_WEIGHTS:
        raise PolicyError(
            f"the policy has {weights} weights; expected {MOST_WEIGHTS} at most, which are already more than the "
            "128 KiB of a robot: train a smaller network"
        )


def header_of(policy: Policy, vector: TestVector, prefix: str, source: str) -> Header:
    """Return a policy as a header in C.

    Args:
        policy: The policy.
        vector: What it is checked by on the robot.
        prefix: What all names begin with, such as "policy".
        source: What the policy is from, for the comment at the top.

    Raises:
        PolicyError: The prefix is no name in C, or the policy is far too large.
    """
    checked_prefix(prefix)
    check_size(policy.network)
    is_fixed = policy.fixed is not None
    parts = fixed_parts(policy) if is_fixed else float_parts(policy)
    value = "int32_t" if is_fixed else "float"
    weight = "float" if policy.fixed is None else f"int{policy.fixed.bits}_t"
    arrays = [
        Array(array.kind.replace("@weight_t", weight), array.name, array.values, array.comment)
        for array in (
            *parts.arrays,
            Array(value, "@test_inputs", vector.inputs, "The test vector: inputs of steps from the initial state on"),
            Array(value, "@test_outputs", vector.outputs),
        )
    ]
    constant_bytes = sum(array.size for array in arrays)
    state_bytes, stack_bytes = (sum(size for _, size in members) for members in (parts.state, parts.locals))
    shown_source = re.sub(r"[^\w. -]", "_", source)
    lines = [
        *introduction(policy, prefix, shown_source),
        f"#ifndef {prefix.upper()}_H",
        f"#define {prefix.upper()}_H",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "#include <string.h>",
        "",
        "// clang-format off",
        "// Inputs, in this order:",
        *enumeration(policy.network.input_names, "input", comments_of_inputs(policy)),
        "// Outputs:",
        *enumeration(policy.network.output_names, "output", comments_of_outputs(policy)),
        "",
        f"#define @@CONSTANT_BYTES {constant_bytes}  // weights, biases, tables and test vector",
        f"#define @@STATE_BYTES {state_bytes}  // of each robot, in USERDATA",
        f"#define @@STACK_BYTES {stack_bytes}  // arrays of a step",
        f"#define @@MULTIPLICATIONS {parts.multiplications}  // of a step, at most",
        "",
        f"typedef {value} @value_t;  // of inputs and outputs",
        *state_type(parts),
        "",
        "// ---- Constants",
        "",
        *(line for array in arrays for line in array.lines()),
        "",
        "// ---- Functions of @step() alone",
        "",
        *"\n".join(functions_of(parts, is_fixed)).split("\n"),
        "// ---- Functions for programs",
        "",
        *steps(policy, parts),
        "",
        *self_test(policy, vector),
        "// clang-format on",
        "#endif",
        "",
    ]
    types = {"@weight_t": weight, "@number_t": "float", "@sum_t": "float"}
    if is_fixed:
        types |= {"@number_t": "int16_t", "@sum_t": "int32_t"}
    text = "\n".join(line.rstrip() for line in lines)
    for name, kind in types.items():
        text = text.replace(name, kind)
    text = text.replace("@@", f"{prefix.upper()}_").replace("@", f"{prefix}_")
    return Header(text, constant_bytes, state_bytes, stack_bytes, parts.multiplications)


def state_type(parts: Parts) -> list[str]:
    """Return the type of what a recurrent policy remembers."""
    if not parts.state:
        return []
    members = [f"    {text}" for text, _ in parts.state]
    return [
        "",
        "// What the policy of a robot remembers: a member of its USERDATA.",
        "typedef struct {",
        *members,
        "} @state_t;",
    ]


def steps(policy: Policy, parts: Parts) -> list[str]:
    """Return the functions that reset and step a policy."""
    arrays = [f"    {text}" for text, _ in parts.locals]
    if not policy.network.is_recurrent:
        head = [
            "// Computes the outputs for these inputs.",
            "static inline void @step(@value_t const inputs[], @value_t outputs[]) {",
        ]
        return [*head, *arrays, *parts.body, "}"]
    return [
        "// Lets the policy of a robot forget: its initial state. Call it in user_init().",
        "static inline void @reset(@state_t* state) {",
        "    memset(state, 0, sizeof(*state));",
        "}",
        "",
        "// Computes the outputs for these inputs, and remembers: once for each decision, at equal intervals.",
        "static inline void @step(@state_t* state, @value_t const inputs[], @value_t outputs[]) {",
        *arrays,
        *parts.body,
        "}",
    ]
