"""The observations by which an exported policy checks itself on the robot, and what it answers to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.policy.errors import PolicyError
from pogosim.policy.policy import Policy

STEPS = 4  # one after the other, so that a recurrent policy remembers something


@dataclass(frozen=True)
class ExampleSteps:
    """Inputs and outputs of some steps from the initial state on.

    Attributes:
        inputs: Shape (steps, inputs), of the policy's type.
        outputs: Shape (steps, outputs), of the policy's type.
    """

    inputs: npt.NDArray[Any]
    outputs: npt.NDArray[Any]


def example_steps(policy: Policy, observations: npt.NDArray[np.float64] | None) -> ExampleSteps:
    """Return steps of a policy, its test vector.

    Args:
        policy: Its state is reset.
        observations: Those of a run, from which some are taken, shape (observations, inputs); None: values are drawn
            from the ranges of the inputs, or where these are unknown, from -1 to 1 after scaling.

    Raises:
        PolicyError: An output is not finite.
    """
    if observations is not None:
        chosen = observations[np.linspace(0, len(observations) - 1, STEPS).astype(int)]
    else:
        ranges = policy.network.input_range.astype(float)
        scale, offset = policy.network.input_scale.astype(float), policy.network.input_offset.astype(float)
        scaled = np.array([[-1.0], [1.0]]) / scale + offset
        ends = np.where(np.isnan(ranges.T), scaled, ranges.T)
        chosen = ends[0] + np.random.default_rng(1).random((STEPS, policy.network.inputs)) * (ends[1] - ends[0])
    inputs = chosen.astype(np.float32) if policy.fixed is None else np.rint(chosen).astype(np.int64).astype(np.int32)
    policy.reset()
    outputs = np.array([policy.step(row) for row in inputs])
    policy.reset()
    if not np.isfinite(outputs).all():
        step, index = (int(one) for one in np.argwhere(~np.isfinite(outputs))[0])
        name, given = policy.network.output_names[index], ", ".join(f"{value:g}" for value in inputs[step])
        raise PolicyError(
            f"the output {name} is {outputs[step, index]} for the inputs {given}: numbers overflow on the way; "
            "expected weights and scales whose results are floats of 32 bits"
        )
    return ExampleSteps(inputs, outputs)
