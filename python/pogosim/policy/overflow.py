"""Whether numbers of a policy in floats may overflow: the largest sizes of values are followed through its layers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pogosim.policy.errors import PolicyError
from pogosim.policy.network import Dense, Elman, Gru, Layer, Network

Floats = npt.NDArray[np.float64]

MOST_SIZE = 3e38  # below the greatest float of 32 bits, with room for rounding
BOUNDED = ("hardtanh", "tanh", "sigmoid")  # activations that give -1 to 1


def grown(recurrent_weights: Floats, sizes: Floats) -> Floats:
    """Return the sizes up to which values grow that are added to their own products; infinite without a limit.

    Args:
        recurrent_weights: Shape (units, units).
        sizes: What is added in each step. Shape (units,).
    """
    gain = np.abs(recurrent_weights)
    if np.abs(np.linalg.eigvals(gain)).max() >= 1:
        return np.full_like(sizes, np.inf)
    return np.asarray(np.linalg.solve(np.eye(len(gain)) - gain, sizes))


def sizes_in(layer: Layer, before: Floats) -> tuple[Floats, Floats]:
    """Return the largest sizes of the sums of a layer and of the values that it gives, in all steps.

    Args:
        layer: The layer.
        before: Sizes of the values before. Shape (values,).
    """
    sums = np.abs(layer.weights.astype(float)) @ before + np.abs(layer.bias.astype(float))
    ones = np.ones(layer.units)
    if isinstance(layer, Dense):
        return sums, ones if layer.activation in BOUNDED else sums
    recurrent = np.abs(layer.recurrent_weights.astype(float))
    if isinstance(layer, Elman) and layer.activation not in BOUNDED:
        values = grown(recurrent, sums)
        return values, values
    sums = sums + recurrent @ ones
    return sums + (np.abs(layer.recurrent_bias.astype(float)) if isinstance(layer, Gru) else 0.0), ones


def check_fits(place: str, sizes: Floats) -> None:
    """Check that numbers of these sizes are floats of 32 bits.

    Raises:
        PolicyError: They may be larger.
    """
    if sizes.max() > MOST_SIZE:
        raise PolicyError(
            f"{place} may reach {sizes.max():.3g} for inputs in range, and overflow; expected {MOST_SIZE:.2g} at most: "
            "scale the policy's values to about -1 to 1"
        )


def check_overflow(network: Network) -> str | None:
    """Check that no number of a policy in floats can overflow, for all inputs in their ranges.

    Inputs of which no range is known count as scaled to -1 to 1 at most.

    Returns:
        What may overflow in the end all the same, for a warning: a recurrent layer that adds up its values.

    Raises:
        PolicyError: A number may overflow.
    """
    offset, scale = network.input_offset.astype(float)[:, None], np.abs(network.input_scale.astype(float))[:, None]
    distance = np.where(np.isnan(network.input_range), 1 / scale, np.abs(network.input_range.astype(float) - offset))
    check_fits("an input minus input_offset", distance)
    values = (distance * scale).max(axis=1)
    check_fits("an input after scaling", values)
    for number, layer in enumerate(network.layers):
        sums, values = sizes_in(layer, values)
        if not np.isfinite(sums).all():
            return f"layer {number} adds up what it remembers, and may grow until its numbers overflow"
        check_fits(f"a sum of layer {number}", sums)
    products = values * np.abs(network.output_scale.astype(float))
    check_fits("an output", products + np.abs(network.output_offset.astype(float)))
    return None
