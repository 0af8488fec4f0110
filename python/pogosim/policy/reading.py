"""Reading a policy from a file, by its ending, and scaling it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from pogosim.policy.errors import PolicyError
from pogosim.policy.network import Network, check_input_scaling, checked_range, names, vector
from pogosim.policy.npz_file import SCALING, read_arrays, read_npz, scaling_in

ENDINGS = (".npz", ".onnx", ".pt", ".pth")


def read_policy(file: Path, activation: str | None = None, output_activation: str | None = None) -> Network:
    """Read a policy.

    Args:
        file: An .npz, .onnx or .pt file.
        activation: Between the layers of a .pt file.
        output_activation: That of the last layer of a .pt file; None: the identity.

    Raises:
        PolicyError: The file is damaged or no policy, or a package that it needs is missing.
        OSError: It cannot be read.
    """
    if file.suffix not in ENDINGS:
        raise PolicyError(f"{file} does not end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}; expected a policy")
    if file.suffix in (".pt", ".pth"):
        from pogosim.policy.torch_file import read_pt

        return read_pt(file, activation, output_activation or "identity")
    if activation or output_activation:
        raise PolicyError(f"{file} says itself what its activations are; expected --activation for .pt files alone")
    if file.suffix == ".onnx":
        from pogosim.policy.onnx_file import read_onnx

        return read_onnx(file)
    return read_npz(file)


def with_scaling(network: Network, file: Path) -> Network:
    """Return a policy whose inputs and outputs are scaled as a file says, and by its own scaling behind that.

    Args:
        network: The policy.
        file: An .npz file with names, scales and ranges, as in a policy, but without layers.

    Raises:
        PolicyError: It is damaged, has other arrays, or they do not fit the policy.
        OSError: It cannot be read.
    """
    arrays = read_arrays(file)
    place = str(file)
    if wrong := [name for name in arrays if name not in SCALING]:
        raise PolicyError(f"{place} has an array '{wrong[0]}'; expected {', '.join(SCALING)} alone")
    given = scaling_in(arrays, place)
    inputs, outputs = network.inputs, network.outputs
    offset = vector(given.get("input_offset", 0.0), inputs, f"{place}: input_offset").astype(float)
    scale = vector(given.get("input_scale", 1.0), inputs, f"{place}: input_scale").astype(float)
    output_scale = vector(given.get("output_scale", 1.0), outputs, f"{place}: output_scale").astype(float)
    output_offset = vector(given.get("output_offset", 0.0), outputs, f"{place}: output_offset").astype(float)
    check_input_scaling(offset, scale, place)
    scaled = replace(
        network,
        input_offset=vector(offset + network.input_offset / scale, inputs, f"{place}: input_offset"),
        input_scale=vector(scale * network.input_scale, inputs, f"{place}: input_scale"),
        output_scale=vector(network.output_scale * output_scale, outputs, f"{place}: output_scale"),
        output_offset=vector(network.output_offset * output_scale + output_offset, outputs, f"{place}: output_offset"),
    )
    check_input_scaling(scaled.input_offset, scaled.input_scale, f"{place}: with the scaling of the policy")
    if "input_names" in given:
        scaled = replace(scaled, input_names=names(given["input_names"], inputs, "input", place))
    if "output_names" in given:
        scaled = replace(scaled, output_names=names(given["output_names"], outputs, "output", place))
    if "input_low" in given or "input_high" in given:
        ranges = checked_range(given.get("input_low", np.nan), given.get("input_high", np.nan), inputs, place)
    else:
        ends = np.sort(network.input_range / scale[:, None] + offset[:, None], axis=1)
        ranges = checked_range(ends[:, 0], ends[:, 1], inputs, place)
    return replace(scaled, input_range=ranges)
