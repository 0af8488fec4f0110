"""Policies in .onnx files, by the optional package `onnx`: a chain of the operators below, from one input to an output.

Numbers that are added or multiplied before the first layer scale the inputs, behind the last one the outputs. What has
been read is compared with what the package computes from the file, so that nothing is misunderstood in silence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.extras import installing
from pogosim.policy import float_arithmetic
from pogosim.policy.content import check_file
from pogosim.policy.errors import PolicyError
from pogosim.policy.network import Dense, Elman, Gru, Layer, Network, network_of

if TYPE_CHECKING:
    from onnx import GraphProto, ModelProto, NodeProto

ACTIVATION = {"Tanh": "tanh", "Sigmoid": "sigmoid", "Relu": "relu"}
# What does not change the numbers of a vector; the comparison at the end finds those that do.
SHAPE_ONLY = ("Identity", "Flatten", "Reshape", "Squeeze", "Unsqueeze", "Transpose", "Cast")
ELEMENTWISE = ("Add", "Sub", "Mul", "Div")
# Sizes of vectors, and what recurrent layers begin with; the comparison at the end finds states that are not 0.
BESIDE = ("Constant", "ConstantOfShape", "Shape", "Gather", "Slice", "Concat", "Expand", *SHAPE_ONLY)
OPERATORS = ("Gemm", "MatMul", *ELEMENTWISE, *ACTIVATION, "Clip", "RNN", "GRU", *SHAPE_ONLY)
COMPARED = 8  # random inputs
TOLERANCE = 1e-4  # of the greatest output

Floats = npt.NDArray[np.float64]


@dataclass
class Chain:
    """What has been read so far: inputs * factor + addend, layers, then values * factor + addend.

    Attributes:
        file: The file.
        constants: Arrays by name.
        layers: From the inputs on.
        is_open: Whether the last layer may still get a bias and an activation.
        before: Factor and addend of the inputs.
        behind: Factor and addend of the last layer's values.
    """

    file: Path
    constants: dict[str, npt.NDArray[Any]]
    layers: list[Layer] = field(default_factory=list)
    is_open: bool = False
    before: tuple[Floats, Floats] = field(default_factory=lambda: (np.ones(()), np.zeros(())))
    behind: tuple[Floats, Floats] = field(default_factory=lambda: (np.ones(()), np.zeros(())))

    def refused(self, node: NodeProto, problem: str) -> PolicyError:
        """Return the error about a node."""
        name = f" '{node.name}'" if node.name else ""
        return PolicyError(f"{self.file}: {node.op_type}{name} {problem}")

    def constant(self, node: NodeProto, place: int, what: str) -> npt.NDArray[Any]:
        """Return a constant input of a node.

        Raises:
            PolicyError: It is no constant.
        """
        name = node.input[place] if place < len(node.input) else ""
        if name not in self.constants:
            raise self.refused(node, f"has {what} that are not constant in the file; expected numbers")
        return np.asarray(self.constants[name])

    def row(self, node: NodeProto, place: int, what: str, size: int | None) -> Floats:
        """Return a constant input of a node, for a vector of that size (None: any). Shape (), if it is one number.

        Raises:
            PolicyError: It is no constant, or of another size.
        """
        found = self.constant(node, place, what).astype(float).reshape(-1)
        if found.size == 1:
            return found.reshape(())
        if size is not None and found.size != size:
            raise self.refused(node, f"has {found.size} {what} for {size} values; expected as many, or one")
        if not found.size:
            raise self.refused(node, f"has no {what}; expected numbers")
        return found

    @property
    def width(self) -> int | None:
        """Size of the vector that has been followed so far; None: unknown."""
        if self.layers:
            return self.layers[-1].units
        sizes = [part.size for part in self.before if part.ndim]
        return sizes[0] if sizes else None

    def add(self, layer: Layer, node: NodeProto) -> None:
        """Add a layer.

        Raises:
            PolicyError: Values before it are scaled, which only inputs may be.
        """
        if self.layers and not is_nothing(self.behind):
            raise self.refused(
                node, "is behind numbers that scale the values of a layer; expected that of inputs alone"
            )
        if self.width not in (None, columns := layer.weights.shape[1]):
            raise self.refused(node, f"has weights for {columns} values; what is before it gives {self.width}")
        self.layers.append(layer)
        self.is_open = isinstance(layer, Dense)


def is_nothing(map_: tuple[Floats, Floats]) -> bool:
    """Tell whether a factor is 1 and an addend 0."""
    return bool((map_[0] == 1).all() and (map_[1] == 0).all())


def attributes(node: NodeProto) -> dict[str, Any]:
    """Return the attributes of a node."""
    import onnx

    return {one.name: onnx.helper.get_attribute_value(one) for one in node.attribute}


def elementwise(chain: Chain, node: NodeProto, vector: str) -> None:
    """Add, subtract, multiply by or divide by numbers: a bias, or the scale of inputs or outputs."""
    place = list(node.input).index(vector)
    number = chain.row(node, 1 - place, "operands", chain.width)
    if place == 1 and node.op_type in ("Sub", "Div"):
        raise chain.refused(node, "has the vector as its second operand; expected it as the first one")
    if node.op_type == "Div" and not number.all():
        raise chain.refused(node, "divides by 0")
    sign = -1.0 if node.op_type == "Sub" else 1.0
    layer = chain.layers[-1] if chain.layers else None
    is_sum = node.op_type in ("Add", "Sub")
    if is_sum and chain.is_open and isinstance(layer, Dense) and is_nothing(chain.behind):
        chain.layers[-1] = replace(layer, bias=layer.bias + sign * number)
        return
    factor, addend = chain.behind if chain.layers else chain.before
    if is_sum:
        made = (factor, addend + sign * number)
    else:
        by = 1.0 / number if node.op_type == "Div" else number
        made = (factor * by, addend * by)
    if chain.layers:
        chain.behind = made
    else:
        chain.before = made


def activate(chain: Chain, node: NodeProto) -> None:
    """Give the last layer its activation."""
    name = ACTIVATION.get(node.op_type, "hardtanh")
    if node.op_type == "Clip":
        given = attributes(node)
        ends = [
            np.asarray(given[key]) if key in given else chain.constant(node, place, "ends")
            for place, key in ((1, "min"), (2, "max"))
        ]
        if [float(end.reshape(-1)[0]) if end.size == 1 else None for end in ends] != [-1.0, 1.0]:
            raise chain.refused(node, "cuts to other ends than -1 and 1")
    layer = chain.layers[-1] if chain.layers else None
    if not (isinstance(layer, Dense) and chain.is_open and is_nothing(chain.behind)):
        raise chain.refused(node, "is not directly behind Gemm, or MatMul and Add")
    chain.layers[-1] = replace(layer, activation=name)
    chain.is_open = False


def dense(chain: Chain, node: NodeProto) -> None:
    """Add a layer that multiplies by weights."""
    weights = chain.constant(node, 1, "weights")
    if weights.ndim != 2:
        raise chain.refused(node, f"has weights of shape {weights.shape}; expected a matrix")
    given = attributes(node)
    is_transposed = bool(given.get("transB", 0))
    if given.get("transA", 0) or given.get("alpha", 1.0) != 1.0 or given.get("beta", 1.0) != 1.0:
        raise chain.refused(node, "has transA, alpha or beta other than 0, 1 and 1")
    rows = weights if is_transposed else weights.T
    bias = np.zeros(len(rows))
    if node.op_type == "Gemm" and len(node.input) > 2 and node.input[2]:
        bias = np.broadcast_to(chain.row(node, 2, "biases", len(rows)), bias.shape)
    chain.add(Dense(rows, bias, "identity"), node)


def recurrent(chain: Chain, node: NodeProto) -> None:
    """Add a recurrent layer."""
    given = attributes(node)
    gates = 3 if node.op_type == "GRU" else 1
    if given.get("direction", b"forward") != b"forward" or "clip" in given:
        raise chain.refused(node, "has another direction than forward, or clip")
    known = {"GRU": [b"Sigmoid", b"Tanh"], "RNN": [b"Tanh"]}[node.op_type]
    if list(given.get("activations", known)) != known:
        raise chain.refused(node, f"has other activations than {' and '.join(name.decode() for name in known)}")
    if node.op_type == "GRU" and given.get("linear_before_reset", 0) != 1:
        raise chain.refused(node, "has linear_before_reset 0; expected 1, as in PyTorch")
    weights, matrix = chain.constant(node, 1, "weights"), chain.constant(node, 2, "recurrent weights")
    units = matrix.shape[-1] if matrix.ndim else 0
    rows = gates * units
    if weights.ndim != 3 or weights.shape[:2] != (1, rows) or matrix.shape != (1, rows, units) or not rows:
        raise chain.refused(
            node,
            f"has weights of shapes {weights.shape} and {matrix.shape}; expected (1, {gates} units, inputs) and "
            f"(1, {gates} units, units)",
        )
    both = np.zeros(2 * rows)
    if len(node.input) > 3 and node.input[3]:
        both = np.broadcast_to(chain.row(node, 3, "biases", 2 * rows), both.shape)
    if node.op_type == "RNN":
        chain.add(Elman(weights[0], matrix[0], both[:rows] + both[rows:], "tanh"), node)
        return
    order = np.r_[units : 2 * units, :units, 2 * units : rows]  # ONNX: keep, reset, new
    chain.add(Gru(weights[0][order], matrix[0][order], both[:rows][order], both[rows:][order]), node)


def follow(chain: Chain, node: NodeProto, vector: str) -> None:
    """Read a node that the vector goes through.

    Raises:
        PolicyError: It is of another operator, or has parameters that are not read.
    """
    if node.op_type in ELEMENTWISE:
        elementwise(chain, node, vector)
    elif node.op_type in ("Gemm", "MatMul", "RNN", "GRU"):
        if node.input[0] != vector:
            raise chain.refused(node, "has the vector as another operand than the first one; expected weights there")
        (dense if node.op_type in ("Gemm", "MatMul") else recurrent)(chain, node)
    elif node.op_type in (*ACTIVATION, "Clip"):
        activate(chain, node)
    elif node.op_type not in SHAPE_ONLY:
        raise chain.refused(node, f"is no operator of a policy; expected {', '.join(OPERATORS)}")


def chain_of(graph: GraphProto, file: Path) -> Chain:
    """Read a graph.

    Raises:
        PolicyError: It is no chain, or has other operators.
    """
    from onnx import numpy_helper

    constants = {one.name: numpy_helper.to_array(one) for one in graph.initializer}
    chain = Chain(file, constants)
    inputs = [one.name for one in graph.input if one.name not in constants]
    if not inputs or not graph.output:
        raise PolicyError(f"{file} has no input or no output; expected a policy")
    vectors = {inputs[0]}
    for node in graph.node:
        if node.op_type == "Constant":
            values = [one.t for one in node.attribute if one.name == "value"]
            constants.update((node.output[0], numpy_helper.to_array(one)) for one in values)
            continue
        taken = [name for name in node.input if name in vectors]
        if not taken or node.op_type == "Shape":
            if node.op_type not in BESIDE:
                raise chain.refused(node, f"is not on the way from {inputs[0]!r}, and computes no size or state")
            continue
        follow(chain, node, taken[0])
        vectors = {name for name in node.output if name}
    if graph.output[0].name not in vectors:
        raise PolicyError(f"{file}: its output {graph.output[0].name!r} is not the end of a chain of layers")
    return chain


def keep_what_is_needed(graph: GraphProto) -> None:
    """Leave out what the first output does not depend on, such as the value of an actor and critic."""
    needed = {one.name for one in graph.output[:1]}
    kept: list[NodeProto] = []
    for node in reversed(graph.node):  # each is behind those that it takes from: the checker has looked
        if not needed.isdisjoint(node.output):
            needed.update(node.input)
            kept.insert(0, node)
    del graph.node[:], graph.output[1:]
    graph.node.extend(kept)


def read_onnx(file: Path) -> Network:
    """Read a policy.

    Raises:
        PolicyError: The package is missing, the file is damaged, or it is no policy.
        OSError: It cannot be read.
    """
    try:
        import onnx
    except ModuleNotFoundError as error:
        if error.name != "onnx":
            raise
        raise PolicyError(f"{file} needs the Python package 'onnx'; install it: {installing('policy')}") from None
    check_file(file)
    try:
        model = onnx.load(file)
        onnx.checker.check_model(model)
    except OSError:
        raise
    except Exception as error:  # of protobuf, of the checker, and others
        raise PolicyError(f"{file} is damaged, or no ONNX file: {short(error)}") from None
    keep_what_is_needed(model.graph)
    with np.errstate(all="ignore"):  # network_of() refuses what is not finite
        chain = chain_of(model.graph, file)
    if not chain.layers:
        raise PolicyError(f"{file} has no layers; expected one at least")
    (factor, addend), (output_factor, output_addend) = chain.before, chain.behind
    if not factor.all():
        raise PolicyError(f"{file} multiplies an input by 0; leave that input out instead")
    with np.errstate(all="ignore"):
        offset = -addend / factor
    network = network_of(
        chain.layers,
        input_offset=offset,
        input_scale=factor,
        output_scale=output_factor,
        output_offset=output_addend,
        place=str(file),
    )
    compare(network, model, file)
    return network


def short(error: Exception) -> str:
    """Return what an error says, in a line."""
    return (" ".join(str(error).split()) or type(error).__name__)[:200]


def fed(model: ModelProto, network: Network, row: Sequence[float], file: Path) -> dict[str, npt.NDArray[Any]]:
    """Return the inputs of the file for an observation: other inputs, such as a state, are 0."""
    constants = {one.name for one in model.graph.initializer}
    found: dict[str, npt.NDArray[Any]] = {}
    for one in model.graph.input:
        if one.name in constants:
            continue
        shape = [size.dim_value or 1 for size in one.type.tensor_type.shape.dim]
        if not found:
            if int(np.prod(shape)) == 1 and shape:
                shape[-1] = network.inputs  # a size that the file leaves open
            if int(np.prod(shape)) != network.inputs:
                raise PolicyError(
                    f"{file}: its input has the shape {shape}; expected one observation of {network.inputs}"
                )
        values = np.asarray(row, np.float32) if not found else np.zeros(int(np.prod(shape)), np.float32)
        found[one.name] = values.reshape(shape)
    return found


def compare(network: Network, model: ModelProto, file: Path) -> None:
    """Compare what was read with what the package computes from the file.

    Raises:
        PolicyError: They differ, or the package cannot compute it.
    """
    from onnx.reference import ReferenceEvaluator

    rows = np.random.default_rng(1).uniform(-1, 1, (COMPARED, network.inputs)) / network.input_scale
    observed = (rows + network.input_offset).astype(np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        found, _ = float_arithmetic.step(network, observed, np.zeros((COMPARED, network.state_units), np.float32))
    for row, ours in zip(observed, found, strict=True):
        inputs = fed(model, network, row, file)
        try:
            answer: Any = ReferenceEvaluator(model).run(None, inputs)
            theirs = np.asarray(answer[0], float).reshape(-1)
        except Exception as error:  # whatever the file makes the package do
            raise PolicyError(f"{file} cannot be evaluated by the package onnx: {short(error)}") from None
        if theirs.shape != ours.shape or not np.allclose(ours, theirs, atol=TOLERANCE * max(1.0, np.abs(theirs).max())):
            raise PolicyError(
                f"{file} computes something else than its layers seem to say ({network.describe()}): expected a chain "
                "of layers for one observation"
            )
