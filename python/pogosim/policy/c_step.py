"""The step of an exported policy: its constants, its lines, and what it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from pogosim.policy.c_forms import Form, LayerInC
from pogosim.policy.c_functions import multiplications_in, multiplications_of, needed
from pogosim.policy.c_text import BYTES, Array
from pogosim.policy.network import Gru


@dataclass
class Variables:
    """Arrays of variables side by side.

    Attributes:
        lines: Their declarations.
        size: Bytes that they take.
    """

    lines: list[str] = field(default_factory=list)
    size: int = 0

    def add(self, kind: str, name: str, count: int) -> None:
        """Add an array."""
        self.lines.append(f"    {kind} {name}[{count}];")
        self.size += BYTES[kind] * count


@dataclass
class Step:
    """A step of a policy, as it is put together.

    Attributes:
        arrays: Constants.
        body: Lines that compute.
        local: Variables of a call.
        state: What is remembered from one call to the next.
        functions: Those that are called.
        multiplications: In a call, at most.
    """

    arrays: list[Array] = field(default_factory=list)
    body: list[str] = field(default_factory=list)
    local: Variables = field(default_factory=Variables)
    state: Variables = field(default_factory=Variables)
    functions: list[str] = field(default_factory=list)
    multiplications: int = 0

    def add_loop(self, count: int, lines: Sequence[str], form: Form) -> None:
        """Add statements for each i below a count."""
        inner = [f"        {line}" for line in lines]
        self.body += [f"    for (uint16_t i = 0; i < {count}; i++) {{", *inner, "    }"]
        self.multiplications += count * multiplications_in("\n".join(lines), form.functions)

    def add_product(self, weights: str, shape: tuple[int, int], values: str, sums: str, form: Form) -> None:
        """Add weights, an array of this shape, times values to sums."""
        self.body.append(f"    @add_product({weights}, {values}, {shape[0]}, {shape[1]}, {sums});")
        self.multiplications += shape[0] * shape[1] * multiplications_of("add_product", form.functions)


def add_layer(step: Step, number: int, layer: LayerInC, before: str, form: Form) -> str:
    """Add a layer behind the array with the values before; returns the array with its own."""
    source = layer.source
    units = source.units
    target = "outputs" if layer.is_output else f"layer_{number}"
    if source.state_units:
        step.state.add(form.types["number"], target, units)
        target = f"state->{target}"
    elif not layer.is_output:
        step.local.add(form.types["number"], target, units)

    rows, columns = layer.weights.shape
    comment = f"Layer {number}: {rows} rows of {columns}"
    step.arrays.append(Array(form.types["weight"], f"@weights_{number}", layer.weights.reshape(-1), comment))
    recurrent = f"@recurrent_weights_{number}"
    if layer.recurrent_weights is not None:
        step.arrays.append(Array(form.types["weight"], recurrent, layer.recurrent_weights.reshape(-1)))
    step.arrays.append(Array(form.types["sum"], f"@bias_{number}", layer.sum_bias))
    if layer.shift is not None:
        step.arrays.append(Array("int8_t", f"@shift_{number}", layer.shift))

    step.body += [
        f"    // Layer {number}: {source.label}",
        f"    memcpy(sums, @bias_{number}, sizeof(@bias_{number}));",
    ]
    step.add_product(f"@weights_{number}", (rows, columns), before, "sums", form)
    if isinstance(source, Gru):
        step.add_product(recurrent, (2 * units, units), target, "sums", form)
        step.add_product(f"{recurrent} + {2 * units * units}", (units, units), target, f"sums + {3 * units}", form)
    elif source.state_units:
        step.add_product(recurrent, (units, units), target, "sums", form)
    shift = "" if layer.shift is None else f"@shift_{number}, "
    step.body.append(f"    @next_{layer.function}(sums, {shift}{units}, {layer.arguments}{target});")
    step.multiplications += units * multiplications_of(f"next_{layer.function}", form.functions)
    return target


def step_of(form: Form) -> Step:
    """Return the step of a policy."""
    step = Step(arrays=[*form.inputs.arrays])
    inputs, outputs = form.layers[0].weights.shape[1], form.layers[-1].source.units
    step.local.add(form.types["number"], "scaled", inputs)
    step.add_loop(inputs, form.inputs.lines, form)
    values = "scaled"
    for number, layer in enumerate(form.layers):
        values = add_layer(step, number, layer, values, form)
    step.arrays += form.outputs.arrays
    if form.outputs.lines:
        step.add_loop(outputs, [line.replace("SOURCE", values) for line in form.outputs.lines], form)
    step.local.add(form.types["sum"], "sums", max(len(layer.sum_bias) for layer in form.layers))
    step.functions = needed("\n".join(step.body), form.functions)
    text = "\n".join(step.functions)
    step.arrays += [table for name, table in form.tables.items() if name in text]
    return step


def state_type(step: Step) -> list[str]:
    """Return the type of what a recurrent policy remembers."""
    if not step.state.lines:
        return []
    return [
        "",
        "// What the policy of a robot remembers: a member of its USERDATA.",
        "typedef struct {",
        *step.state.lines,
        "} @state_t;",
    ]


def functions_of(step: Step) -> list[str]:
    """Return the functions that reset and step a policy."""
    inside = [*step.local.lines, *step.body, "}"]
    if not step.state.lines:
        return [
            "// Computes the outputs for these inputs.",
            "static inline void @step(@value_t const inputs[], @value_t outputs[]) {",
            *inside,
        ]
    return [
        "// Lets the policy of a robot forget: its initial state. Call it in user_init().",
        "static inline void @reset(@state_t* state) {",
        "    memset(state, 0, sizeof(*state));",
        "}",
        "",
        "// Computes the outputs for these inputs, and remembers: once for each decision, at equal intervals.",
        "static inline void @step(@state_t* state, @value_t const inputs[], @value_t outputs[]) {",
        *inside,
    ]
