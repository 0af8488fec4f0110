"""A policy as data: the layers of a small neural network, and how its inputs and outputs are scaled.

    normalised input = (input, cut to its range - input_offset) * input_scale
    output           = value of the last layer * output_scale + output_offset

An input whose range is unknown is not cut.
Inputs are in units of the robot's functions, such as counts of a photosensor; so are outputs, such as powers of motors.
Numbers are floats of 32 bits, as on the robot.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pogosim.nearest_name import unknown
from pogosim.policy.choices import ACTIVATIONS
from pogosim.policy.errors import PolicyError

Floats = npt.NDArray[np.float32]
Numbers = npt.NDArray[Any]  # of layers: floats of 32 bits once they are checked

MOST_UNITS = 4096  # of a layer
MOST_FLOAT = float(np.finfo(np.float32).max)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")  # a name in C


class Units:
    """What all kinds of layers have.

    Attributes:
        kind: Name of the kind.
        gates: Rows of weights for each unit.
        bias: Shape (gates units,).
    """

    kind: ClassVar[str]
    gates: ClassVar[int] = 1
    bias: Numbers

    @property
    def units(self) -> int:
        """Values that the layer gives."""
        return len(self.bias) // self.gates

    @property
    def state_units(self) -> int:
        """Values that the layer remembers: all that it gives, or none."""
        return self.units


@dataclass(frozen=True)
class Dense(Units):
    """A layer whose units see all values before it: activation(weights x + bias).

    Attributes:
        weights: Shape (units, values before).
        bias: Shape (units,).
        activation: One of ACTIVATIONS.
    """

    weights: Numbers
    bias: Numbers
    activation: str
    kind = "dense"

    @property
    def state_units(self) -> int:
        """Values that the layer remembers."""
        return 0

    @property
    def label(self) -> str:
        """The layer in two words."""
        return f"{self.units} {self.activation}"


@dataclass(frozen=True)
class Elman(Units):
    """A recurrent layer: h becomes activation(weights x + recurrent_weights h + bias), and is what it gives.

    Attributes:
        weights: Shape (units, values before).
        recurrent_weights: Shape (units, units).
        bias: Shape (units,).
        activation: One of ACTIVATIONS.
    """

    weights: Numbers
    recurrent_weights: Numbers
    bias: Numbers
    activation: str
    kind = "elman"

    @property
    def label(self) -> str:
        """The layer in a few words."""
        return f"{self.units} {self.activation} (Elman)"


@dataclass(frozen=True)
class Gru(Units):
    """A gated recurrent layer, with the parameters of PyTorch's nn.GRU.

    It gives h, which becomes n + z (h - n), where

        r = sigmoid(W_r x + b_r + U_r h + c_r)        z = sigmoid(W_z x + b_z + U_z h + c_z)
        n = tanh(W_n x + b_n + r (U_n h + c_n))

    In a network, c_r and c_z are 0, and b_r and b_z the sums of both: `network_of` adds them.

    Attributes:
        weights: W_r, W_z and W_n below each other. Shape (3 units, values before).
        recurrent_weights: U, likewise. Shape (3 units, units).
        bias: b, likewise. Shape (3 units,).
        recurrent_bias: c, likewise. Shape (3 units,).
    """

    weights: Numbers
    recurrent_weights: Numbers
    bias: Numbers
    recurrent_bias: Numbers
    kind = "gru"
    gates = 3

    @property
    def sum_bias(self) -> Numbers:
        """What the sums of r, z, W_n x and U_n h begin with, in a network. Shape (4 units,)."""
        return np.concatenate([self.bias, self.recurrent_bias[2 * self.units :]])

    @property
    def label(self) -> str:
        """The layer in two words."""
        return f"{self.units} GRU"


Layer = Dense | Elman | Gru
KINDS: Mapping[str, type[Layer]] = {kind.kind: kind for kind in (Dense, Elman, Gru)}


@dataclass(frozen=True)
class Network:
    """A policy.

    Attributes:
        layers: From the inputs to the outputs.
        input_names: What the inputs are, names in C.
        output_names: What the outputs are, names in C.
        input_offset: Shape (inputs,).
        input_scale: Shape (inputs,).
        output_scale: Shape (outputs,).
        output_offset: Shape (outputs,).
        input_range: Least and greatest value of each input, in its unit, to which it is cut; NaN where they are
            unknown. Shape (inputs, 2).
        decision_s: Simulated seconds from one call to the next, as it was trained; NaN: unknown.
    """

    layers: tuple[Layer, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    input_offset: Floats
    input_scale: Floats
    output_scale: Floats
    output_offset: Floats
    input_range: Floats = field(repr=False)
    decision_s: float = np.nan

    @property
    def inputs(self) -> int:
        """Number of inputs."""
        return len(self.input_names)

    @property
    def outputs(self) -> int:
        """Number of outputs."""
        return len(self.output_names)

    @cached_property
    def has_range(self) -> bool:
        """Whether the range of an input is known."""
        return not np.isnan(self.input_range).all()

    @cached_property
    def input_ends(self) -> tuple[Floats, Floats]:
        """What inputs are cut to: their range, or all floats of 32 bits where it is unknown. Shapes (inputs,)."""
        everything = np.array([-MOST_FLOAT, MOST_FLOAT], np.float32)
        low, high = np.where(np.isnan(self.input_range), everything, self.input_range).T
        return low, high

    @property
    def state_units(self) -> int:
        """Values that are remembered."""
        return sum(layer.state_units for layer in self.layers)

    @property
    def is_recurrent(self) -> bool:
        """Whether a layer remembers something from one call to the next."""
        return self.state_units > 0

    def split_state(self, state: npt.NDArray[Any]) -> list[npt.NDArray[Any]]:
        """Return what each layer remembers, shape (..., its values), of all values, shape (..., values)."""
        ends = np.cumsum([layer.state_units for layer in self.layers])
        return np.split(state, ends[:-1], axis=-1)

    def describe(self) -> str:
        """Return the policy in a line: "3 inputs, 8 tanh, 2 hardtanh"."""
        inputs = f"{self.inputs} input{'s' * (self.inputs != 1)}"
        return ", ".join([inputs, *(layer.label for layer in self.layers)])


def network_of(
    layers: Sequence[Layer],
    *,
    input_names: Sequence[str] | None = None,
    output_names: Sequence[str] | None = None,
    input_offset: npt.ArrayLike = 0.0,
    input_scale: npt.ArrayLike = 1.0,
    output_scale: npt.ArrayLike = 1.0,
    output_offset: npt.ArrayLike = 0.0,
    input_low: npt.ArrayLike = np.nan,
    input_high: npt.ArrayLike = np.nan,
    decision_s: npt.ArrayLike = np.nan,
    place: str = "the policy",
) -> Network:
    """Make a policy of its layers, and check it.

    Args:
        layers: From the inputs to the outputs; at least one.
        input_names: Names of the inputs, as in C; None: x0, x1, ...
        output_names: Names of the outputs, likewise; None: y0, y1, ...
        input_offset: Offset of each input, or one for all.
        input_scale: Scale of each input, or one for all; not 0.
        output_scale: Scale of each output, or one for all.
        output_offset: Offset of each output, or one for all.
        input_low: Least value of each input, or one for all; NaN: unknown.
        input_high: Greatest value, likewise.
        decision_s: Time from one decision to the next, in seconds, above 0; NaN: unknown.
        place: Where the policy is from, for messages.

    Raises:
        PolicyError: Shapes do not fit, a number is not finite, a name is no name, or an activation is unknown.
    """
    if not layers:
        raise PolicyError(f"{place} has no layers; expected one at least")
    checked: list[Layer] = []
    before = None
    for number, layer in enumerate(layers):
        checked.append(checked_layer(layer, before, f"{place}: layer {number}"))
        before = checked[-1].units
    inputs, outputs = checked[0].weights.shape[1], checked[-1].units
    offset = vector(input_offset, inputs, f"{place}: input_offset")
    scale = vector(input_scale, inputs, f"{place}: input_scale")
    check_input_scaling(offset, scale, place)
    return Network(
        tuple(checked),
        names(input_names, inputs, "input", place),
        names(output_names, outputs, "output", place),
        offset,
        scale,
        vector(output_scale, outputs, f"{place}: output_scale"),
        vector(output_offset, outputs, f"{place}: output_offset"),
        checked_range(input_low, input_high, inputs, place),
        checked_decision(decision_s, place),
    )


def checked_decision(decision_s: npt.ArrayLike, place: str) -> float:
    """Return the time between decisions, in seconds; NaN if it is unknown.

    Raises:
        PolicyError: It is no such time.
    """
    found = np.asarray(decision_s)
    if found.size != 1 or found.dtype.kind not in "iuf" or not (np.isnan(found) or 0 < found < np.inf).all():
        raise PolicyError(f"{place}: decision_s: expected a time in seconds above 0, found {decision_s!r}")
    return float(found.reshape(()))


def checked_layer(layer: Layer, before: int | None, place: str) -> Layer:
    """Check a layer after one of `before` units (None: the first); returns it with floats of 32 bits.

    Raises:
        PolicyError: Shapes do not fit, or it has something else than finite numbers.
    """
    gates = layer.gates
    weights = numbers(layer.weights, f"{place}: weights")
    if weights.ndim != 2 or 0 in weights.shape or len(weights) % gates:
        rows = "(units, inputs)" if gates == 1 else f"({gates} units, inputs)"
        raise PolicyError(f"{place}: weights have the shape {weights.shape}; expected {rows}")
    rows, columns = weights.shape
    units = rows // gates
    if max(units, columns) > MOST_UNITS:
        raise PolicyError(f"{place} has {units} units with {columns} inputs; expected {MOST_UNITS} of each at most")
    if before is not None and columns != before:
        raise PolicyError(
            f"{place}: weights have the shape {weights.shape}, which takes {columns} values; the layer before gives "
            f"{before}. Weights are of shape (units, inputs): transposed?"
        )
    bias = shaped(layer.bias, (rows,), f"{place}: bias")
    if isinstance(layer, Dense):
        return Dense(weights, bias, activation(layer.activation, place))
    recurrent = shaped(layer.recurrent_weights, (rows, units), f"{place}: recurrent_weights")
    if isinstance(layer, Elman):
        return Elman(weights, recurrent, bias, activation(layer.activation, place))
    recurrent_bias = shaped(layer.recurrent_bias, (rows,), f"{place}: recurrent_bias")
    added = np.where(np.arange(rows) < 2 * units, recurrent_bias, np.float32(0.0))
    return Gru(weights, recurrent, numbers(bias.astype(float) + added, f"{place}: bias"), recurrent_bias - added)


def activation(name: str, place: str) -> str:
    """Return the name of an activation.

    Raises:
        PolicyError: There is none of that name.
    """
    if name not in ACTIVATIONS:
        everything = f"expected one of {', '.join(ACTIVATIONS)}"
        raise PolicyError(f"{place}: {unknown('activation', name, ACTIVATIONS, everything)}")
    return name


def numbers(values: npt.ArrayLike, place: str) -> Floats:
    """Return an array of finite floats of 32 bits.

    Raises:
        PolicyError: They are something else.
    """
    found = np.asarray(values)
    if found.dtype.kind not in "fiu":
        raise PolicyError(f"{place}: expected numbers, found an array of {found.dtype}")
    with np.errstate(over="ignore", invalid="ignore"):
        made = found.astype(np.float32)
    if not np.isfinite(made).all():
        index = [int(one) for one in np.argwhere(~np.isfinite(made))[0]]
        raise PolicyError(f"{place}{index or ''}: expected a finite number of 32 bits, found {found[tuple(index)]}")
    return made


def shaped(values: npt.ArrayLike, shape: tuple[int, ...], place: str) -> Floats:
    """Return an array of finite floats of this shape.

    Raises:
        PolicyError: They are something else.
    """
    found = numbers(values, place)
    if found.shape != shape:
        raise PolicyError(f"{place} has the shape {found.shape}; expected {shape}")
    return found


def vector(values: npt.ArrayLike, length: int, place: str) -> Floats:
    """Return as many finite numbers, of one for all or one for each.

    Raises:
        PolicyError: They are something else.
    """
    found = numbers(values, place)
    if found.shape not in ((), (length,)):
        raise PolicyError(f"{place} has the shape {found.shape}; expected ({length},), or one number for all")
    return np.array(np.broadcast_to(found, (length,)))


def check_input_scaling(offset: Floats, scale: Floats, place: str) -> None:
    """Check that there are inputs which are scaled to -1 and 1. Shapes (inputs,).

    Raises:
        PolicyError: A scale is 0, or so small that these inputs are no floats of 32 bits.
    """
    if not scale.all():
        raise PolicyError(f"{place}: input_scale[{int(np.argmin(np.abs(scale)))}] is 0; leave that input out instead")
    largest = np.abs(offset.astype(float)) + 1 / np.abs(scale.astype(float))
    wrong = int(np.argmax(largest))
    if largest[wrong] > MOST_FLOAT:
        raise PolicyError(
            f"{place}: input_scale[{wrong}] is {scale[wrong]:g} and input_offset[{wrong}] {offset[wrong]:g}: inputs "
            f"scaled to -1 or 1 reach {largest[wrong]:.3g}; expected floats of 32 bits, {MOST_FLOAT:.2g} at most"
        )


def names(given: Sequence[str] | None, count: int, what: str, place: str) -> tuple[str, ...]:
    """Return the names of inputs or outputs; numbers for names where there are none.

    Raises:
        PolicyError: There are too few or too many, or they are no names in C, or two are the same.
    """
    if given is None:
        return tuple(f"{'x' if what == 'input' else 'y'}{number}" for number in range(count))
    found = tuple(str(name) for name in given)
    if len(found) != count:
        raise PolicyError(f"{place}: {what}_names has {len(found)} names; expected one for each of the {count} {what}s")
    for number, name in enumerate(found):
        if not NAME.fullmatch(name):
            raise PolicyError(
                f"{place}: {what}_names[{number}] is {name!r}; expected a name as in C: a letter, then up to 62 "
                "letters, digits or _"
            )
        if name.upper() in {other.upper() for other in found[:number]}:
            raise PolicyError(f"{place}: {what}_names has {name!r} twice, in capitals; expected different names")
    return found


def checked_range(low: npt.ArrayLike, high: npt.ArrayLike, inputs: int, place: str) -> Floats:
    """Return the ranges of inputs, shape (inputs, 2); NaN where they are unknown.

    Raises:
        PolicyError: One is empty, or has one end only.
    """
    ends = []
    for name, values in (("input_low", low), ("input_high", high)):
        found = np.asarray(values)
        if found.dtype.kind not in "fiu" or found.shape not in ((), (inputs,)):
            what = f"an array of {found.dtype} of shape {found.shape}"
            raise PolicyError(f"{place}: {name}: expected {inputs} numbers, or one for all, found {what}")
        with np.errstate(over="ignore"):
            ends.append(np.broadcast_to(found.astype(np.float32), (inputs,)))
    made = np.stack(ends, axis=1)
    for number, (least, most) in enumerate(made):
        is_known = not (np.isnan(least) and np.isnan(most))
        if is_known and not (np.isfinite([least, most]).all() and least < most):
            raise PolicyError(
                f"{place}: input {number} ranges from {least:g} to {most:g}; expected two finite numbers, of which "
                "input_low is the smaller one"
            )
    return made
