"""Policies in .pt files: the state_dict() of a PyTorch module that is a chain of layers.

The file is an archive of raw arrays and of a pickle that says what they are. It is read without PyTorch, and nothing in
it is executed: the pickle may name tensors and nothing else. The layers are those with weights, in the order of the
module: nn.Linear, nn.RNN(Cell) and nn.GRU(Cell), of one layer and one direction. What is between them is not in the
file: activations are given.
"""

from __future__ import annotations

import functools
import io
import math
import pickle
import pickletools
import struct
import zipfile
import zlib
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.policy.content import MOST_BYTES, content_of
from pogosim.policy.errors import PolicyError
from pogosim.policy.network import Dense, Elman, Gru, Layer, Network, network_of

STORAGES = {"FloatStorage": "f4", "DoubleStorage": "f8", "HalfStorage": "f2", "LongStorage": "i8", "IntStorage": "i4"}
RECURRENT = ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
SAVE = "save it by torch.save(module.state_dict(), FILE)"
WRONG_PICKLE = (
    pickle.UnpicklingError,
    ValueError,
    EOFError,
    KeyError,
    IndexError,
    TypeError,
    AttributeError,
    MemoryError,
    OverflowError,
    RecursionError,
    NotImplementedError,
    RuntimeError,
    ImportError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)


@dataclass(frozen=True)
class Kind:
    """The type of the numbers of a stored array, as NumPy names it."""

    code: str


def tensor(
    storage: npt.NDArray[Any], offset: int, shape: Sequence[int], stride: Sequence[int], *_: Any
) -> npt.NDArray[Any]:
    """Return a tensor in a stored array, as PyTorch's pickles ask for it: a view, which takes no memory of its own.

    Raises:
        ValueError: It is not within the array.
    """
    sizes, steps = [int(size) for size in shape], [int(step) for step in stride]
    if len(sizes) != len(steps) or min([int(offset), *sizes, *steps], default=0) < 0:
        raise ValueError("a tensor has a wrong shape")
    last = int(offset) + sum((size - 1) * step for size, step in zip(sizes, steps, strict=True))
    if math.prod(sizes) > len(storage) or (math.prod(sizes) > 0 and last >= len(storage)):
        raise ValueError("a tensor is larger than its data")
    if not math.prod(sizes):
        return np.zeros(sizes, storage.dtype)
    width = storage.itemsize
    return np.lib.stride_tricks.as_strided(
        storage[int(offset) :], sizes, [step * width for step in steps], writeable=False
    )


def parameter(data: npt.NDArray[Any], *_: Any) -> npt.NDArray[Any]:
    """Return the tensor of a parameter."""
    return data


class Reader(pickle.Unpickler):
    """Reads the pickle of a state_dict; anything in it that is no tensor is refused."""

    def __init__(self, content: bytes, stored: Callable[[str, str], npt.NDArray[Any]]) -> None:
        """Prepare to read.

        Args:
            content: The pickle.
            stored: Returns a stored array, by its key and its type.
        """
        super().__init__(io.BytesIO(content))
        self.stored = stored

    def find_class(self, module: str, name: str) -> Any:
        """Return what a name in the pickle stands for here."""
        if module == "torch" and name in STORAGES:
            return Kind(STORAGES[name])
        known = {
            ("collections", "OrderedDict"): OrderedDict,
            ("torch._utils", "_rebuild_tensor_v2"): tensor,
            ("torch._utils", "_rebuild_parameter"): parameter,
        }
        if (module, name) not in known:
            raise PolicyError(f"it holds {module}.{name}, not tensors alone: {SAVE}")
        return known[module, name]

    def persistent_load(self, pid: Any) -> npt.NDArray[Any]:
        """Return a stored array."""
        what, kind, key, *_ = pid
        if what != "storage" or not isinstance(kind, Kind):
            raise PolicyError("it holds numbers of a type that is not read; expected floats of 16, 32 or 64 bits")
        return self.stored(str(key), kind.code)


def check_memo(content: bytes) -> None:
    """Check that a pickle does not ask for more places to remember its objects in than it can have objects.

    Raises:
        ValueError: It does, or is damaged.
    """
    for opcode, argument, _ in pickletools.genops(content):
        if opcode.name in ("PUT", "BINPUT", "LONG_BINPUT") and int(argument or 0) > len(content):
            raise ValueError(f"its pickle has {len(content)} bytes and an object numbered {argument}")


def state_dict_in(content: bytes) -> dict[str, npt.NDArray[Any]]:
    """Return the tensors of a file, by name, in their order.

    Raises:
        PolicyError: It holds something else.
        Exception: One of WRONG_PICKLE, if it is damaged.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if sum(member.file_size for member in archive.infolist()) > MOST_BYTES:
            raise PolicyError(f"it has more than {MOST_BYTES} bytes")
        pickles = [name for name in archive.namelist() if name.endswith("/data.pkl")]
        if len(pickles) != 1:
            raise PolicyError(f"it is no file of PyTorch: {SAVE}")
        folder = pickles[0].removesuffix("data.pkl")
        order = archive.read(f"{folder}byteorder") if f"{folder}byteorder" in archive.namelist() else b"little"
        sign = ">" if order.strip() == b"big" else "<"

        @functools.cache
        def stored(key: str, code: str) -> npt.NDArray[Any]:
            return np.frombuffer(archive.read(f"{folder}data/{key}"), sign + code)

        content = archive.read(pickles[0])
        check_memo(content)
        found = Reader(content, stored).load()
    if not isinstance(found, dict) or not all(
        isinstance(name, str) and isinstance(array, np.ndarray) for name, array in found.items()
    ):
        raise PolicyError(f"it is no state_dict, which has tensors by name: {SAVE}")
    return dict(found)


def read_state_dict(file: Path) -> dict[str, npt.NDArray[Any]]:
    """Read the tensors of a .pt file, by name, in their order.

    Raises:
        PolicyError: The file is damaged, or holds something else.
        OSError: It cannot be read.
    """
    content = content_of(file)
    if not zipfile.is_zipfile(io.BytesIO(content)):
        raise PolicyError(f"{file} is damaged, or no file of PyTorch 1.6 or later: {SAVE}")
    try:
        return state_dict_in(content)
    except PolicyError as error:
        raise PolicyError(f"{file}: {error}") from None
    except WRONG_PICKLE as error:
        said = " ".join(str(error).split()) or type(error).__name__
        raise PolicyError(f"{file} is damaged: {said[:200]}") from None


def modules_in(tensors: dict[str, npt.NDArray[Any]]) -> dict[str, dict[str, npt.NDArray[Any]]]:
    """Return the tensors by module and by their name in it, such as weight; numbers of layers (_l0) are left out."""
    found: dict[str, dict[str, npt.NDArray[Any]]] = {}
    for name, array in tensors.items():
        module, _, own = name.rpartition(".")
        found.setdefault(module, {})[own.removesuffix("_l0")] = array
    return found


def layer_of(module: str, tensors: dict[str, npt.NDArray[Any]], activation: str, file: Path) -> Layer:
    """Return the layer with these tensors.

    Raises:
        PolicyError: It is of a kind that is not read.
    """
    place = f"{file}: {module or 'the module'}"
    if "weight" in tensors and tensors["weight"].ndim == 2 and not tensors.keys() - {"weight", "bias"}:
        weights = tensors["weight"]
        return Dense(weights, tensors.get("bias", np.zeros(len(weights), np.float32)), activation)
    if "weight_ih" in tensors and "weight_hh" in tensors and not tensors.keys() - set(RECURRENT):
        weights, recurrent = tensors["weight_ih"], tensors["weight_hh"]
        bias = tensors.get("bias_ih", np.zeros(len(weights), np.float32))
        recurrent_bias = tensors.get("bias_hh", np.zeros(len(weights), np.float32))
        gates = len(recurrent) / recurrent.shape[1] if recurrent.ndim == 2 and recurrent.shape[1] else 0
        if gates == 1 and np.shape(bias) == np.shape(recurrent_bias):
            return Elman(weights, recurrent, bias + recurrent_bias, "tanh")
        if gates == 3:
            return Gru(weights, recurrent, bias, recurrent_bias)
        if gates == 4:
            raise PolicyError(f"{place} is an LSTM; expected nn.Linear, nn.RNN or nn.GRU")
    own = ", ".join(f"{name} {tuple(array.shape)}" for name, array in tensors.items())
    raise PolicyError(
        f"{place} has {own}, which is no nn.Linear, and no nn.RNN or nn.GRU of one layer and one direction"
    )


def read_pt(file: Path, activation: str | None, output_activation: str) -> Network:
    """Read a policy.

    Args:
        file: A state_dict that PyTorch has saved.
        activation: That of all nn.Linear but the last layer; None: there must be none.
        output_activation: That of the last layer, if it is nn.Linear.

    Raises:
        PolicyError: The file is damaged, has other layers, or the activation is not given.
        OSError: It cannot be read.
    """
    modules = list(modules_in(read_state_dict(file)).items())
    layers: list[Layer] = []
    for number, (module, tensors) in enumerate(modules):
        is_last = number == len(modules) - 1
        own = output_activation if is_last else activation
        if own is None and "weight" in tensors:
            raise PolicyError(
                f"{file} does not say what is between its layers; expected --activation NAME, that of all but the last"
            )
        layers.append(layer_of(module, tensors, own or "identity", file))
    return network_of(layers, place=str(file))
