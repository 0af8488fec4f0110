"""Policies are read from files of NumPy, PyTorch and ONNX, and what is wrong with one is told in a line."""

from __future__ import annotations

import builtins
import pickle
import re
import sys
import tracemalloc
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
import random_policies
from onnx import TensorProto, helper, numpy_helper
from pogosim.policy import Policy, PolicyError, network_of
from pogosim.policy.calibration import check_whole, read_observations, with_ranges
from pogosim.policy.network import Dense
from pogosim.policy.npz_file import arrays_of, read_npz
from pogosim.policy.onnx_file import read_onnx
from pogosim.policy.reading import read_policy, with_scaling
from pogosim.policy.torch_file import read_pt
from random_policies import ALL, random_network
from running import ROOT

MADE = ROOT / "tests" / "policies"  # by PyTorch, see make_files.py there
TORCH = ["plain", "gru", "rnn"]


def one_layer(**changes: Any) -> dict[str, Any]:
    """Return the arrays of a policy with 3 inputs and 2 outputs; those that are None are left out."""
    arrays = {"layer0_weights": np.ones((2, 3)), "layer0_bias": np.zeros(2), "layer0_activation": "tanh", **changes}
    return {name: array for name, array in arrays.items() if array is not None}


def refused(file: Path) -> str:
    with pytest.raises(PolicyError) as told:
        read_policy(file, "tanh" if file.suffix == ".pt" else None)
    said = str(told.value)
    assert "\n" not in said
    assert said.startswith(str(file))
    return said.removeprefix(str(file))


# ---- .npz ----


@pytest.mark.parametrize("name", ALL)
def test_policy_comes_back_from_its_file(name: str, tmp_path: Path) -> None:
    network = random_network(ALL[name])
    Policy(network).save(tmp_path / "a.npz")
    Policy(network).save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    read = read_npz(tmp_path / "a.npz")
    for key, array in arrays_of(network).items():
        np.testing.assert_array_equal(array, arrays_of(read)[key])


def test_arrays_may_be_left_out(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", layer0_weights=[[1.0, 2.0]])
    policy = Policy.load(tmp_path / "a.npz")
    assert policy.step([3, 4]).tolist() == [11.0]
    assert (policy.network.input_names, policy.network.output_names) == (("x0", "x1"), ("y0",))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"layer0_weights": None}, ": layer0_weights is missing; a layer of the kind dense has it"),
        ({"layer0_weigths": np.ones(3)}, ": there is no array 'layer0_weigths'; did you mean 'layer0_weights'?"),
        (
            {"other": 1},
            ": there is no array 'other'; expected layer0_weights and others, as docs/policy_export.md lists",
        ),
        (
            {"layer0_weights": np.ones((3, 2, 1))},
            ": layer 0: weights have the shape (3, 2, 1); expected (units, inputs)",
        ),
        ({"layer0_weights": np.ones((0, 3))}, ": layer 0: weights have the shape (0, 3); expected (units, inputs)"),
        (
            {"layer0_weights": np.ones((5000, 1))},
            ": layer 0 has 5000 units with 1 inputs; expected 4096 of each at most",
        ),
        ({"layer0_bias": np.zeros(3)}, ": layer 0: bias has the shape (3,); expected (2,)"),
        ({"layer0_bias": [0, np.nan]}, ": layer 0: bias[1]: expected a finite number of 32 bits, found nan"),
        ({"layer0_bias": [0, 1e39]}, ": layer 0: bias[1]: expected a finite number of 32 bits, found 1e+39"),
        ({"layer0_bias": ["a", "b"]}, ": layer 0: bias: expected numbers, found an array of <U1"),
        ({"layer0_activation": "tanhh"}, ": layer 0: there is no activation 'tanhh'; did you mean 'tanh'?"),
        ({"layer0_activation": "swish"}, ": layer 0: there is no activation 'swish'; expected one of identity, relu, "),
        ({"layer0_activation": 3}, ": layer0_activation: expected a text, found an array of int64 of shape ()"),
        ({"layer0_kind": "lstm"}, ": layer0_kind: there is no kind of layer 'lstm'; expected dense, elman or gru"),
        ({"layer0_kind": "elman"}, ": layer0_recurrent_weights is missing; a layer of the kind elman has it"),
        (
            {"layer0_recurrent_weights": np.ones((2, 2))},
            ": layer0_recurrent_weights: a layer of the kind dense has no re",
        ),
        (
            {"layer1_weights": np.ones((2, 3))},
            ": layer 1: weights have the shape (2, 3), which takes 3 values; the layer",
        ),
        ({"layer2_weights": np.ones((2, 2))}, ": layer1_weights is missing, but there is layer 2"),
        ({"input_names": ["a", "b"]}, ": input_names has 2 names; expected one for each of the 3 inputs"),
        ({"input_names": ["a", "b", "c d"]}, ": input_names[2] is 'c d'; expected a name as in C"),
        ({"output_names": ["a", "A"]}, ": output_names has 'A' twice, in capitals; expected different names"),
        ({"output_names": [1, 2]}, ": output_names: expected texts in a row, found an array of int64 of shape (2,)"),
        ({"input_scale": [1, 0, 1]}, ": input_scale[1] is 0; leave that input out instead"),
        (
            {"input_scale": [1, 1e-44, 1]},
            ": input_scale[1] is 9.80909e-45 and input_offset[1] 0: inputs scaled to -1 or 1 reach 1.02e+44; "
            "expected floats of 32 bits, 3.4e+38 at most",
        ),
        ({"input_scale": 1e-38, "input_offset": -3e38}, ": input_scale[0] is 1e-38 and input_offset[0] -3e+38: inputs"),
        ({"input_offset": [1, 0]}, ": input_offset has the shape (2,); expected (3,), or one number for all"),
        ({"output_scale": np.inf}, ": output_scale: expected a finite number of 32 bits, found inf"),
        ({"input_low": 3, "input_high": 3}, ": input 0 ranges from 3 to 3; expected two finite numbers"),
        ({"input_low": 0}, ": input 0 ranges from 0 to nan; expected two finite numbers"),
        ({"input_low": "a"}, ": input_low: expected 3 numbers, or one for all, found an array of <U1 of shape ()"),
    ],
)
def test_wrong_array_is_named(changes: dict[str, Any], said: str, tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", **one_layer(**changes))
    assert refused(tmp_path / "a.npz").startswith(said)


def test_file_without_layers_and_other_files_are_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", input_scale=1)
    assert "has no array layer0_weights" in refused(tmp_path / "a.npz")
    (tmp_path / "b.npz").write_text("no archive")
    assert "is damaged, or no .npz file of NumPy" in refused(tmp_path / "b.npz")
    np.savez(tmp_path / "c.npz", layer0_weights=np.array([[object()]]))
    assert "Object arrays cannot be loaded" in refused(tmp_path / "c.npz")
    with zipfile.ZipFile(tmp_path / "d.npz", "w") as archive:
        archive.writestr("layer0_weights.npy", "no array")
    assert "layer0_weights" in refused(tmp_path / "d.npz")
    assert "does not end in .npz, .onnx, .pt or .pth" in refused(tmp_path / "a.txt")


def test_two_arrays_of_one_name_are_refused(tmp_path: Path) -> None:
    Policy(random_network(ALL["plain"])).save(tmp_path / "a.npz")
    with zipfile.ZipFile(tmp_path / "a.npz", "a") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr("layer0_bias.npy", archive.read("layer0_bias.npy"))
    assert refused(tmp_path / "a.npz") == " has two arrays 'layer0_bias'; expected one of each name"


def mutations(content: bytes, count: int) -> list[bytes]:
    """Return a file with some bytes changed, cut, or doubled."""
    random = np.random.default_rng(3)
    made = [content[: len(content) // 2], content[:40], b"", content + content]
    for _ in range(count):
        changed = bytearray(content)
        for place in random.integers(0, len(content), random.integers(1, 4)):
            changed[place] = random.integers(0, 256)
        made.append(bytes(changed))
    return made


@pytest.mark.parametrize("name", ["gated.npz", "plain.pt", "gru.pt", "plain.onnx", "gru.onnx"])
@pytest.mark.filterwarnings("ignore")  # of NumPy, about damaged headers
def test_damaged_file_is_read_or_refused_in_a_line(name: str, tmp_path: Path) -> None:
    source = MADE / name
    if name.endswith(".npz"):
        source = tmp_path / "whole.npz"
        Policy(random_network(ALL["gated"])).save(source)
    damaged = tmp_path / name
    refusals = 0
    for content in mutations(source.read_bytes(), 40 if name.endswith(".onnx") else 150):
        damaged.write_bytes(content)
        try:
            network = read_policy(damaged, "tanh" if name.endswith(".pt") else None)
        except PolicyError as error:
            assert "\n" not in str(error)
            refusals += 1
        else:
            Policy(network).step(np.zeros(network.inputs))
    assert refusals >= 4


# ---- .pt ----


@pytest.mark.parametrize("ending", [".pt", ".onnx"])
@pytest.mark.parametrize("name", TORCH)
def test_policy_of_pytorch_computes_what_pytorch_did(name: str, ending: str) -> None:
    policy = Policy(read_policy(MADE / f"{name}{ending}", "tanh" if (name, ending) == ("plain", ".pt") else None))
    answers = np.load(MADE / "answers.npz")
    found = np.array([policy.step(row) for row in answers["x"][0]])
    np.testing.assert_allclose(found, answers[name][0], rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("lstm", ": memory is an LSTM; expected nn.Linear, nn.RNN or nn.GRU"),
        ("batchnorm", ": 1 has weight (4,), bias (4,), running_mean (4,)"),
        ("whole", ": it holds torch.nn.modules.container.Sequential, not tensors alone: save it by torch.save(module."),
        ("old", " is damaged, or no file of PyTorch 1.6 or later: save it by torch.save(module.state_dict(), FILE)"),
    ],
)
def test_file_of_pytorch_with_something_else_is_refused(name: str, said: str) -> None:
    assert refused(MADE / f"{name}.pt").startswith(said)


def test_activation_of_a_pt_file_must_be_given() -> None:
    with pytest.raises(PolicyError, match="does not say what is between its layers; expected --activation NAME"):
        read_pt(MADE / "plain.pt", None, "identity")
    assert read_pt(MADE / "plain.pt", "relu", "hardtanh").describe() == "3 inputs, 8 relu, 2 hardtanh"
    with pytest.raises(PolicyError, match="says itself what its activations are"):
        read_policy(MADE / "plain.onnx", "tanh")


class Harmful:
    """Pickles that call a function when they are read."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (exec, ("raise SystemExit('executed')",))


@pytest.mark.parametrize("content", [Harmful(), {"0.weight": Harmful()}, [1, 2], {"a": "b"}, builtins.print])
def test_nothing_in_a_pt_file_is_executed(content: object, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.pt", "w") as archive:
        archive.writestr("a/data.pkl", pickle.dumps(content))
    assert re.match(": it holds builtins|: it is no state_dict|: it holds ", refused(tmp_path / "a.pt"))


def tensor_in(shape: tuple[int, ...], strides: tuple[int, ...]) -> bytes:
    """Return a pickle, as PyTorch writes it, of a state_dict whose weights are in a stored array of 6 numbers."""

    def numbers(values: tuple[int, ...]) -> bytes:
        return b"(" + b"".join(f"I{value}\n".encode() for value in values) + b"t"

    storage = b"(V" + b"storage\nctorch\nFloatStorage\nV0\nVcpu\nI6\ntQ"
    tensor = b"ctorch._utils\n_rebuild_tensor_v2\n(" + storage + b"I0\n" + numbers(shape) + numbers(strides) + b"tR"
    return b"\x80\x02(d" + b"V0.weight\n" + tensor + b"s."


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (tensor_in((3, 2), (2, 1)), ""),
        (tensor_in((2, 3), (1, 2)), ""),
        (tensor_in((16000, 16000), (0, 0)), " is damaged: a tensor is larger than its data"),
        (tensor_in((3, 3), (2, 1)), " is damaged: a tensor is larger than its data"),
        (b"\x80\x02Nr\x00\x00\x00\x08.", " is damaged: its pickle has 9 bytes and an object numbered 134217728"),
    ],
)
def test_small_pt_file_takes_little_memory(content: bytes, said: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.pt", "w") as archive:
        archive.writestr("a/data.pkl", content)
        archive.writestr("a/data/0", np.arange(6, dtype=np.float32).tobytes())
    tracemalloc.start()
    try:
        if said:
            assert refused(tmp_path / "a.pt").startswith(said)
        else:
            assert read_pt(tmp_path / "a.pt", None, "identity").layers[0].weights.sum() == 15
        assert tracemalloc.get_traced_memory()[1] < 10_000_000
    finally:
        tracemalloc.stop()


# ---- .onnx ----


def onnx_file(folder: Path, *nodes: Any, inputs: int = 3, outputs: int = 2, **constants: Any) -> Path:
    """Write a graph from x to y."""
    made = [numpy_helper.from_array(np.asarray(array, np.float32), name) for name, array in constants.items()]
    x = helper.make_tensor_value_info("x", TensorProto.FLOAT, ["batch", inputs])
    y = helper.make_tensor_value_info("y", TensorProto.FLOAT, ["batch", outputs])
    graph = helper.make_graph(list(nodes), "policy", [x], [y], made)
    onnx.save(helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8), folder / "a.onnx")
    return folder / "a.onnx"


WEIGHTS = np.arange(6.0).reshape(3, 2) / 10


def test_numbers_around_the_layers_scale_inputs_and_outputs(tmp_path: Path) -> None:
    file = onnx_file(
        tmp_path,
        helper.make_node("Sub", ["x", "mean"], ["a"]),
        helper.make_node("Div", ["a", "deviation"], ["b"]),
        helper.make_node("MatMul", ["b", "w"], ["c"]),
        helper.make_node("Add", ["c", "bias"], ["d"]),
        helper.make_node("Clip", ["d", "low", "high"], ["e"]),
        helper.make_node("Mul", ["e", "power"], ["y"]),
        mean=[1, 2, 3],
        deviation=[2, 4, 8],
        w=WEIGHTS,
        bias=[0.25, -0.25],
        low=-1,
        high=1,
        power=1023,
    )
    network = read_onnx(file)
    assert network.describe() == "3 inputs, 2 hardtanh"
    np.testing.assert_array_equal(network.input_offset, [1, 2, 3])
    np.testing.assert_array_equal(network.input_scale, [0.5, 0.25, 0.125])
    np.testing.assert_array_equal(network.output_scale, [1023, 1023])


@pytest.mark.parametrize(
    ("nodes", "said"),
    [
        (
            [("LSTM", ["x", "w3", "r3"], {"hidden_size": 2})],
            r"LSTM is no operator of a policy; expected Gemm, MatMul, Add",
        ),
        ([("Softmax", ["x"], {})], r"Softmax is no operator of a policy"),
        ([("Tanh", ["x"], {})], r"Tanh is not directly behind Gemm, or MatMul and Add"),
        ([("MatMul", ["x", "x"], {})], r"MatMul has weights that are not constant in the file"),
        ([("Gemm", ["x", "w"], {"alpha": 2.0})], r"Gemm has transA, alpha or beta other than 0, 1 and 1"),
        ([("Clip", ["x", "low", "high"], {})], r"Clip is not directly behind Gemm, or MatMul and Add"),
        ([("MatMul", ["x", "w"], {}), ("Clip", ["0", "low", "two"], {})], r"Clip cuts to other ends than -1 and 1"),
        ([("Sub", ["low", "x"], {}), ("MatMul", ["0", "w"], {})], r"Sub has the vector as its second operand"),
        ([("Div", ["x", "zero"], {}), ("MatMul", ["0", "w"], {})], r"Div divides by 0"),
        ([("Mul", ["x", "zero"], {}), ("MatMul", ["0", "w"], {})], r"multiplies an input by 0"),
        ([("MatMul", ["x", "w"], {}), ("Mul", ["0", "two"], {}), ("Tanh", ["1"], {})], r"Tanh is not directly behind"),
        (
            [("MatMul", ["x", "w"], {}), ("Mul", ["0", "two"], {}), ("MatMul", ["1", "v"], {})],
            r"MatMul is behind numbers that scale the values of a layer",
        ),
        (
            [("MatMul", ["x", "w"], {}), ("Add", ["0", "five"], {})],
            r"Add has 5 operands for 2 values; expected as many, or",
        ),
        (
            [("Mul", ["x", "five"], {}), ("Mul", ["0", "b2"], {}), ("MatMul", ["1", "w"], {})],
            r"Mul has 2 operands for 5 values; expected as many, or one",
        ),
        (
            [("Mul", ["x", "five"], {}), ("MatMul", ["0", "w"], {})],
            r"MatMul has weights for 3 values; what is before it gives 5",
        ),
        ([("Gemm", ["x", "w", "five"], {})], r"Gemm has 5 biases for 2 values; expected as many, or one"),
        ([("Gemm", ["x", "w", "none"], {})], r"Gemm has 0 biases for 2 values"),
        ([("MatMul", ["x", "w"], {}), ("Mul", ["0", "none"], {})], r"Mul has 0 operands for 2 values"),
        ([("Mul", ["x", "none"], {}), ("MatMul", ["0", "w"], {})], r"Mul has no operands; expected numbers"),
        (
            [("GRU", ["x", "r3", "w3"], {"hidden_size": 2, "linear_before_reset": 1})],
            r"GRU has weights of shapes \(1, 6, 2\) and \(1, 6, 3\); expected \(1, 3 units, inputs\) and",
        ),
        (
            [("GRU", ["x", "w3", "r3", "five"], {"hidden_size": 2, "linear_before_reset": 1})],
            r"GRU has 5 biases for 12 values",
        ),
        (
            [("Neg", ["w"], {}), ("MatMul", ["x", "0"], {})],
            r"Neg is not on the way from 'x', and computes no size or st",
        ),
        (
            [("MatMul", ["square", "x"], {})],
            r"MatMul has the vector as another operand than the first one; expected wei",
        ),
        ([("Identity", ["x"], {})], r"has no layers; expected one at least"),
        ([("MatMul", ["x", "w"], {}), ("Add", ["0", "0"], {})], r"Add has operands that are not constant"),
        ([("GRU", ["x", "w3", "r3"], {"hidden_size": 2})], r"GRU has linear_before_reset 0; expected 1, as in PyTorch"),
        ([("RNN", ["x", "w3", "r3"], {"direction": "reverse"})], r"RNN has another direction than forward, or clip"),
        ([("RNN", ["x", "w3", "r3"], {"activations": ["Relu"]})], r"RNN has other activations than Tanh"),
        (
            [("MatMul", ["x", "w"], {}), ("Cast", ["0"], {"to": 7}), ("Cast", ["1"], {"to": 1})],
            r"computes something else",
        ),
    ],
)
def test_graph_that_is_no_policy_is_refused_by_the_name_of_its_operator(
    nodes: list[tuple[str, list[str], dict[str, Any]]], said: str, tmp_path: Path
) -> None:
    made = [
        helper.make_node(kind, inputs, ["y" if place == len(nodes) - 1 else str(place)], **attributes)
        for place, (kind, inputs, attributes) in enumerate(nodes)
    ]
    constants: dict[str, Any] = {"w": WEIGHTS, "v": np.eye(2), "w3": np.ones((1, 6, 3)), "r3": np.ones((1, 6, 2))}
    constants |= {"five": np.arange(1, 6), "b2": [1, 2], "none": [], "square": np.eye(3)}
    file = onnx_file(tmp_path, *made, low=-1, high=1, two=2, zero=0, **constants)
    assert re.search(said, refused(file))


def test_what_the_output_does_not_depend_on_is_not_looked_at(tmp_path: Path) -> None:
    """Neither the value of an actor and critic, nor a loop of 2^40 steps that nothing takes from."""
    of_loop = [helper.make_tensor_value_info(name, kind, []) for name, kind in (("i", 7), ("c", 9), ("v", 1))]
    body = helper.make_graph(
        [helper.make_node("Identity", ["c"], ["d"]), helper.make_node("Identity", ["v"], ["u"])],
        "body",
        of_loop,
        [helper.make_tensor_value_info("d", 9, []), helper.make_tensor_value_info("u", 1, [])],
    )
    file = onnx_file(
        tmp_path,
        helper.make_node("Constant", [], ["steps"], value=numpy_helper.from_array(np.array(2**40))),
        helper.make_node("Constant", [], ["goes_on"], value=numpy_helper.from_array(np.array(True))),
        helper.make_node("Loop", ["steps", "goes_on", "low"], ["unused"], body=body),
        helper.make_node("MatMul", ["x", "v"], ["of_critic"]),
        helper.make_node("Softmax", ["of_critic"], ["value"]),
        helper.make_node("MatMul", ["x", "w"], ["y"]),
        w=WEIGHTS,
        v=np.ones((3, 1)),
        low=-1,
    )
    assert read_onnx(file).describe() == "3 inputs, 2 identity"


def test_package_onnx_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnx", None)
    assert re.match(
        r" needs the Python package 'onnx'; install it: .*pip install 'onnx>=", refused(MADE / "plain.onnx")
    )


# ---- scaling and calibration ----


def test_scaling_of_a_file_comes_before_that_of_the_policy(tmp_path: Path) -> None:
    layer = Dense(np.array([[1.0, 2.0]], np.float32), np.zeros(1, np.float32), "identity")
    network = network_of(
        [layer], input_offset=1, input_scale=2, output_scale=3, output_offset=4, input_low=0, input_high=2
    )
    np.savez(
        tmp_path / "s.npz", input_names=["a", "b"], input_offset=100, input_scale=0.5, output_scale=10, output_offset=1
    )
    scaled = with_scaling(network, tmp_path / "s.npz")
    inner = Policy(network).step((np.array([108.0, 112.0]) - 100) * 0.5)
    assert Policy(scaled).step([108, 112]) == pytest.approx(inner * 10 + 1)
    assert scaled.input_names == ("a", "b")
    np.testing.assert_array_equal(scaled.input_range, [[100, 104]] * 2)


def test_scaling_with_layers_or_of_another_policy_is_refused(tmp_path: Path) -> None:
    network = random_network(ALL["plain"])
    for arrays, said in (
        ({"layer0_weights": np.ones((2, 2))}, "has an array 'layer0_weights'; expected input_names, "),
        ({"input_scale": [1, 2]}, r"input_scale has the shape \(2,\); expected \(3,\)"),
        ({"input_scale": 0}, r"input_scale\[0\] is 0"),
        ({"input_scale": 1e-44}, r"s\.npz: input_scale\[0\] is 9\.80909e-45 and input_offset\[0\] 0: inputs scaled "),
        ({"input_scale": 5e-36}, r"s\.npz: with the scaling of the policy: input_scale\[0\] is 5e-39 and input_offset"),
    ):
        np.savez(tmp_path / "s.npz", **arrays)
        with pytest.raises(PolicyError, match=said):
            with_scaling(network, tmp_path / "s.npz")


def test_observations_are_read_from_arrays_and_columns(tmp_path: Path) -> None:
    network = network_of([Dense(np.ones((1, 2), np.float32), np.zeros(1, np.float32), "tanh")], input_names=["a", "b"])
    rows = np.arange(12).reshape(3, 2, 2)
    np.savez(tmp_path / "one.npz", whatever=rows)
    np.savez(tmp_path / "several.npz", observations=rows, rewards=np.zeros(3))
    np.save(tmp_path / "one.npy", rows)
    (tmp_path / "run.csv").write_text("time,b,a\n0,1,0\n1,3,2\n2,,\n")
    for name in ("one.npz", "several.npz", "one.npy"):
        np.testing.assert_array_equal(read_observations(tmp_path / name, network), rows.reshape(6, 2))
    np.testing.assert_array_equal(read_observations(tmp_path / "run.csv", network), [[0, 1], [2, 3]])


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (np.ones((4, 2)), r"expected observations of shape \(..., 3\), found an array of shape \(4, 2\)"),
        (np.ones((0, 3)), "has no observations"),
        ([[1, 2, 3], [1, np.inf, 3]], "input x1 is inf in observation 1; expected finite numbers"),
        ([[1, 2, 3], [1, 2, 1e39]], r"input x2 is 1e\+39 in observation 1; expected finite numbers of 32 bits"),
        (np.full((2, 3), "a"), "expected numbers, found an array of <U1"),
    ],
)
def test_wrong_observations_are_refused(rows: Any, said: str, tmp_path: Path) -> None:
    np.savez(tmp_path / "o.npz", rows)
    with pytest.raises(PolicyError, match=said):
        read_observations(tmp_path / "o.npz", random_network(ALL["plain"]))


def test_files_without_observations_are_refused(tmp_path: Path) -> None:
    network = random_network(ALL["plain"])
    np.savez(tmp_path / "o.npz", a=1, b=2)
    (tmp_path / "o.npy").write_text("x")
    (tmp_path / "o.csv").write_text("time,x0,x1\n0,1,2\n")
    (tmp_path / "o.feather").write_text("x")
    for name, said in (
        ("o.npz", "has no array 'observations', but a, b; expected an .npz or .npy file"),
        ("o.npy", "is damaged, or no .npy file"),
        ("o.csv", "has no column 'x2', the name of an input of the policy"),
        ("o.feather", "expected an .npz or .npy file"),
    ):
        with pytest.raises(PolicyError, match=said):
            read_observations(tmp_path / name, network)


def test_input_that_would_be_rounded_to_few_numbers_is_for_floats_alone() -> None:
    """Such as one of an environment that a robot has scaled to -1 to 1 by itself; a switch is 0 or 1."""
    network = network_of([Dense(np.ones((1, 1)), np.zeros(1), "tanh")], input_low=-1, input_high=1)
    assert Policy(network).step([0.3]) == pytest.approx(np.tanh(0.3))
    said = "the input x0 ranges from -1 to 1, which has few whole numbers; .* show observations of a run"
    with pytest.raises(PolicyError, match=said):
        Policy(network, numbers="int16")
    with pytest.raises(PolicyError, match="the input x0 ranges from -1 to 1, with fractions"):
        Policy(network, numbers="int16", calibration=[[0.0], [0.5]])
    assert Policy(network, numbers="int16", calibration=[[0], [1]]).step([1]) == 1


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([[0, 0, 7], [100, 100, 7]], "the input x2 is 7 in all 2 observations, so its range is unknown"),
        (
            [[0, 0, -0.5], [100, 100, 0.5]],
            "the input x2 ranges from -0.5 to 0.5, with fractions; a policy in whole num",
        ),
    ],
)
def test_ranges_that_observations_do_not_tell_are_refused(rows: Any, said: str) -> None:
    layer = Dense(np.ones((1, random_policies.INPUTS), np.float32), np.zeros(1, np.float32), "tanh")
    with pytest.raises(PolicyError, match=said):
        check_whole(with_ranges(network_of([layer]), np.array(rows, float)), np.array(rows, float))
