"""What a file of a policy says of the environment that it is for: names, scales and ranges of inputs and outputs.

They are the arrays of that name in the table of docs/policy_export.md.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.learning.quantities import Scaling
from pogosim.policy.errors import PolicyError
from pogosim.policy.npz_file import read_arrays
from pogosim.simulation.errors import ConfigurationError, given

Arrays = dict[str, Any]  # of NumPy, by their names: arguments of network_of()

NAMES = {"input": "observation", "output": "actions"}  # the argument of an environment that they are from
NUMBERS = ("input_offset", "input_scale", "output_offset", "output_scale", "input_low", "input_high")


def name_in_c(feature: str) -> str:
    """Return the name of a number as C has it: "photosensors_0" of "photosensors[0]"."""
    return re.sub(r"\W+", "_", feature).strip("_")


def check_distinct(what: str, features: Sequence[str]) -> None:
    """Check that numbers of a policy have names of their own in C, where case does not count.

    Raises:
        ConfigurationError: Two have the same.
    """
    seen: dict[str, str] = {}
    for feature in features:
        other = seen.setdefault(name_in_c(feature).upper(), feature)
        if other is not feature:
            both = f"{feature!r} is there twice" if other == feature else f"{other!r} and {feature!r} are one name in C"
            raise ConfigurationError(f"{what}: {both}; expected each number once")


def policy_arrays(observation: Scaling, actions: Scaling, decision_s: float) -> Arrays:
    """Return the arrays that say what the numbers of a policy are, and how far apart its decisions."""
    return {
        "input_names": np.array([name_in_c(name) for name in observation.features]),
        "output_names": np.array([name_in_c(name) for name in actions.features]),
        "input_offset": observation.middle,
        "input_scale": np.float32(1) / observation.half,
        "input_low": observation.own_low,
        "input_high": observation.own_high,
        "output_offset": actions.middle,
        "output_scale": actions.half,
        "decision_s": np.array(decision_s),
    }


def arrays_of(policy: Any) -> tuple[str, Mapping[str, Any]]:
    """Return what messages call a policy, and its arrays.

    Args:
        policy: The path of an .npz file, or arrays by their names.

    Raises:
        ConfigurationError: It is neither, or the file cannot be read.
    """
    if isinstance(policy, Mapping):
        return "policy", policy
    file = given.path("policy", policy)
    try:
        return str(file), read_arrays(file)
    except PolicyError as error:
        raise ConfigurationError(str(error)) from None
    except OSError as error:
        raise ConfigurationError(f"{file} cannot be read: {error.strerror}") from None


def check_names(what: str, kind: str, found: Sequence[str], expected: Sequence[str]) -> None:
    """Check that a policy has the inputs or outputs of an environment.

    Raises:
        ConfigurationError: It has others; names the first that differs.
    """
    begin = f"{what} is for other {NAMES[kind]}" if kind == "output" else f"{what} is for another {NAMES[kind]}"
    if len(found) != len(expected):
        raise ConfigurationError(
            f"{begin}: it has {len(found)} {kind}s ({', '.join(found)}), and the environment has {len(expected)} "
            f"({', '.join(expected)})"
        )
    for index, (own, other) in enumerate(zip(found, expected, strict=True)):
        if own != other:
            raise ConfigurationError(f"{begin}: its {kind} {index} is {own!r}, and that of the environment {other!r}")


def is_close(found: Any, expected: npt.NDArray[Any], tolerance: Any) -> bool:
    """Tell whether an array has the numbers expected, but for rounding: a 100000th of each, or the tolerance."""
    array = np.asarray(found)
    if array.dtype.kind not in "biuf" or array.shape != expected.shape:
        return False
    return bool((abs(array - expected) <= np.maximum(1e-5 * abs(expected), tolerance)).all())


def check_policy(policy: Any, arrays: Arrays) -> Mapping[str, Any]:
    """Check that a policy is for an environment, and return its arrays.

    Args:
        policy: The path of an .npz file, or arrays by their names.
        arrays: What `policy_arrays` says of the environment.

    Raises:
        ConfigurationError: Its inputs or outputs are others, or scaled in another way; or it does not say what they
            are.
    """
    what, found = arrays_of(policy)
    for kind in NAMES:
        name = f"{kind}_names"
        if name not in found:
            raise ConfigurationError(f"{what} has no array {name}: save it with **env.policy_arrays()")
        own = [str(one) for one in np.atleast_1d(found[name])]
        check_names(what, kind, own, arrays[name].tolist())
    # Offsets near 0 are rounded by as much as their range is wide.
    tolerances = {"input_offset": 1e-5 / arrays["input_scale"], "output_offset": 1e-5 * arrays["output_scale"]}
    for name in NUMBERS:
        if name in found and not is_close(found[name], arrays[name], tolerances.get(name, 0.0)):
            raise ConfigurationError(
                f"{what} is for other ranges: its {name} is {shown(np.asarray(found[name]).tolist())}, and that "
                f"of the environment {shown(arrays[name].tolist())}"
            )
    if "decision_s" in found and not is_close(found["decision_s"], arrays["decision_s"], 0.0):
        raise ConfigurationError(
            f"{what} decides every {shown(np.asarray(found['decision_s']).tolist())} s, and the environment every "
            f"{arrays['decision_s']:.6g} s (decision_s)"
        )
    return found
