"""Policies in .npz files of NumPy: arrays by name, which the table of docs/policy_export.md describes.

`OF_LAYER` and `SCALING` are all names.
"""

from __future__ import annotations

import io
import re
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.nearest_name import unknown
from pogosim.policy.content import MOST_BYTES, content_of
from pogosim.policy.errors import PolicyError
from pogosim.policy.network import KINDS, Layer, Network, network_of

OF_LAYER = ("weights", "bias", "activation", "kind", "recurrent_weights", "recurrent_bias")
NUMBERS = ("input_offset", "input_scale", "output_scale", "output_offset", "input_low", "input_high")
SCALING = ("input_names", "output_names", *NUMBERS, "decision_s")
# What NumPy raises for files that are damaged, or no archives of arrays.
WRONG_FILE = (
    ValueError,  # also of texts that are not UTF-8
    EOFError,
    KeyError,
    TypeError,
    SyntaxError,
    NotImplementedError,  # a compression that zipfile does not know
    RuntimeError,  # an archive with a password
    MemoryError,
    OverflowError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)

Arrays = dict[str, npt.NDArray[Any]]


def read_arrays(file: Path) -> Arrays:
    """Read the arrays of a .npz file, by name.

    Raises:
        PolicyError: It is no such file, is damaged, or holds Python objects, which are not read.
        OSError: It cannot be read.
    """
    content = content_of(file)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            size = sum(member.file_size for member in archive.infolist())
            members = [name.removesuffix(".npy") for name in archive.namelist()]
        if size > MOST_BYTES:
            raise PolicyError(f"{file} has {size} bytes of arrays; expected {MOST_BYTES} at most")
        if twice := next((name for name in members if members.count(name) > 1), None):
            raise PolicyError(f"{file} has two arrays {twice!r}; expected one of each name")
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
    except PolicyError:
        raise
    except WRONG_FILE as error:
        said = " ".join(str(error).split()) or type(error).__name__
        raise PolicyError(f"{file} is damaged, or no .npz file of NumPy (numpy.savez): {said[:200]}") from None
    if wrong := next((name for name, array in found.items() if not isinstance(array, np.ndarray)), None):
        raise PolicyError(f"{file}: {wrong} is no array of NumPy; expected a file of numpy.savez")
    return found


def text(array: npt.NDArray[Any], place: str) -> str:
    """Return the text in an array without dimensions."""
    if array.dtype.kind != "U" or array.ndim != 0:
        raise PolicyError(f"{place}: expected a text, found an array of {array.dtype} of shape {array.shape}")
    return str(array)


def texts(array: npt.NDArray[Any], place: str) -> tuple[str, ...]:
    """Return the texts in an array of one dimension."""
    if array.dtype.kind != "U" or array.ndim != 1:
        raise PolicyError(f"{place}: expected texts in a row, found an array of {array.dtype} of shape {array.shape}")
    return tuple(str(one) for one in array)


def scaling_in(arrays: Mapping[str, npt.NDArray[Any]], place: str) -> dict[str, Any]:
    """Return the arguments of network_of() that say how inputs and outputs are scaled."""
    found: dict[str, Any] = {name: arrays[name] for name in (*NUMBERS, "decision_s") if name in arrays}
    for name in ("input_names", "output_names"):
        if name in arrays:
            found[name] = texts(arrays[name], f"{place}: {name}")
    return found


def layer_in(arrays: Mapping[str, npt.NDArray[Any]], place: str) -> Layer:
    """Return the layer with these arrays, by the part of their names behind `layerN_`.

    Raises:
        PolicyError: One is missing, or is another layer's.
    """
    kind = text(arrays["kind"], f"{place}_kind") if "kind" in arrays else "dense"
    if kind not in KINDS:
        raise PolicyError(f"{place}_kind: {unknown('kind of layer', kind, KINDS, 'expected dense, elman or gru')}")
    parts = [part.name for part in fields(KINDS[kind])]
    if lacking := [part for part in parts if part in ("weights", "recurrent_weights") and part not in arrays]:
        raise PolicyError(f"{place}_{lacking[0]} is missing; a layer of the kind {kind} has it")
    if more := sorted(arrays.keys() - {*parts, "kind"}):
        raise PolicyError(f"{place}_{more[0]}: a layer of the kind {kind} has no {more[0]}")
    zeros = np.zeros(np.shape(arrays["weights"])[:1], np.float32)
    found: dict[str, Any] = {"bias": zeros, "recurrent_bias": zeros, "activation": np.array("identity"), **arrays}
    found["activation"] = text(found["activation"], f"{place}_activation")
    return KINDS[kind](**{part: found[part] for part in parts})


def network_in(arrays: Mapping[str, npt.NDArray[Any]], place: str) -> Network:
    """Return the policy that arrays with the names above describe.

    Raises:
        PolicyError: An array is missing, unknown or wrong.
    """
    layers: dict[int, dict[str, npt.NDArray[Any]]] = {}
    for name, array in arrays.items():
        if name in SCALING:
            continue
        found = re.fullmatch(r"layer(0|[1-9]\d{0,3})_(\w+)", name, re.ASCII)
        if found is None or found[2] not in OF_LAYER:
            known = [*SCALING, *(f"layer{found[1] if found else 0}_{part}" for part in OF_LAYER)]
            hint = "expected layer0_weights and others, as docs/policy_export.md lists them"
            raise PolicyError(f"{place}: {unknown('array', name, known, hint)}")
        layers.setdefault(int(found[1]), {})[found[2]] = array
    if not layers:
        raise PolicyError(f"{place} has no array layer0_weights; expected a policy, as docs/policy_export.md describes")
    if lacking := sorted(set(range(max(layers) + 1)) - layers.keys()):
        raise PolicyError(f"{place}: layer{lacking[0]}_weights is missing, but there is layer {max(layers)}")
    made = [layer_in(layers[number], f"{place}: layer{number}") for number in sorted(layers)]
    return network_of(made, **scaling_in(arrays, place), place=place)


def read_npz(file: Path) -> Network:
    """Read a policy.

    Raises:
        PolicyError: The file is damaged, or holds no policy.
        OSError: It cannot be read.
    """
    return network_in(read_arrays(file), str(file))


def arrays_of(network: Network) -> Arrays:
    """Return a policy as arrays with the names above."""
    made: Arrays = {name: getattr(network, name) for name in NUMBERS if not name.startswith(("input_l", "input_h"))}
    made |= {"input_low": network.input_range[:, 0], "input_high": network.input_range[:, 1]}
    made |= {"input_names": np.array(network.input_names), "output_names": np.array(network.output_names)}
    if not np.isnan(network.decision_s):
        made["decision_s"] = np.array(network.decision_s)
    for number, layer in enumerate(network.layers):
        for part in OF_LAYER:
            if hasattr(layer, part):
                made[f"layer{number}_{part}"] = np.asarray(getattr(layer, part))
    return made


def write_npz(file: str | Path, network: Network) -> None:
    """Write a policy, the same bytes each time.

    Raises:
        OSError: It cannot be written.
    """
    with zipfile.ZipFile(file, "w") as archive:
        for name, array in arrays_of(network).items():
            content = io.BytesIO()
            np.save(content, array, allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (2000, 1, 1, 0, 0, 0)), content.getvalue())
