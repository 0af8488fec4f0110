"""A policy as a header in C for programs of robots.

C99 and later, C++ as well; no memory is allocated, and no C library is needed but memcpy() and memset().
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass

from pogosim.policy.c_forms import form_of
from pogosim.policy.c_introduction import (
    comments_of_inputs,
    comments_of_outputs,
    decision_time,
    enumeration,
    introduction,
)
from pogosim.policy.c_self_test import self_test
from pogosim.policy.c_step import functions_of, state_type, step_of
from pogosim.policy.c_text import Array
from pogosim.policy.errors import PolicyError
from pogosim.policy.example_steps import ExampleSteps
from pogosim.policy.network import NAME, Dense, Network
from pogosim.policy.policy import Policy

GUARD = "@content@"  # stands for a number that tells headers of one name apart
MOST_WEIGHTS = 1 << 18  # several times as many as a robot has memory for


@dataclass(frozen=True)
class Header:
    """An exported policy.

    Attributes:
        text: The header.
        constant_bytes: Weights, biases, tables and the test vector.
        state_bytes: What a robot remembers, in USERDATA.
        stack_bytes: Arrays of a call.
        multiplications: In a call, at most.
    """

    text: str
    constant_bytes: int
    state_bytes: int
    stack_bytes: int
    multiplications: int


def checked_prefix(name: str) -> str:
    """Return what all names of a header begin with.

    Raises:
        PolicyError: It is no name in C.
    """
    if not NAME.fullmatch(name) or name.endswith("_"):
        raise PolicyError(
            f"--name {name}: expected a name as in C, such as policy, for functions such as policy_step()"
        )
    return name


def check_size(network: Network) -> None:
    """Check that a policy is not far too large for a robot.

    Raises:
        PolicyError: It is.
    """
    weights = sum(
        layer.weights.size + (0 if isinstance(layer, Dense) else layer.recurrent_weights.size)
        for layer in network.layers
    )
    if weights > MOST_WEIGHTS:
        raise PolicyError(
            f"the policy has {weights} weights; expected {MOST_WEIGHTS} at most, which are already more than the "
            "128 KiB of a robot: train a smaller network"
        )


def header_of(policy: Policy, examples: ExampleSteps, prefix: str, source: str) -> Header:
    """Return a policy as a header in C.

    Args:
        policy: The policy.
        examples: The test vector: steps by which it is checked on the robot.
        prefix: What all names begin with, such as "policy".
        source: What the policy is from, for the comment at the top.

    Raises:
        PolicyError: The prefix is no name in C, or the policy is far too large.
    """
    checked_prefix(prefix)
    check_size(policy.network)
    form = form_of(policy)
    step = step_of(form)
    value = form.types["value"]
    arrays = [
        *step.arrays,
        Array(value, "@test_inputs", examples.inputs, "The test vector: inputs of steps from the initial state on"),
        Array(value, "@test_outputs", examples.outputs),
    ]
    constant_bytes = sum(array.size for array in arrays)
    lines = [
        *introduction(policy, prefix, re.sub(r"[^\w. -]", "_", source)),
        f"#ifndef {prefix.upper()}_H",
        f"#define {prefix.upper()}_H {GUARD}",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "#include <string.h>",
        "",
        "// clang-format off",
        "// Inputs, in this order:",
        *enumeration(policy.network.input_names, "input", comments_of_inputs(policy)),
        "// Outputs:",
        *enumeration(policy.network.output_names, "output", comments_of_outputs(policy)),
        "",
        f"#define @@CONSTANT_BYTES {constant_bytes}  // weights, biases, tables and test vector",
        f"#define @@STATE_BYTES {step.state.size}  // of each robot, in USERDATA",
        *decision_time(policy),
        f"#define @@STACK_BYTES {step.local.size}  // arrays of a step",
        f"#define @@MULTIPLICATIONS {step.multiplications}  // of a step, at most",
        "",
        f"typedef {value} @value_t;  // of inputs and outputs",
        *state_type(step),
        "",
        "// ---- Constants",
        "",
        *(line for array in arrays for line in array.lines()),
        "",
        "// ---- Functions of @step() alone",
        "",
        *"\n".join(step.functions).split("\n"),
        "// ---- Functions for programs",
        "",
        *functions_of(step),
        "",
        *self_test(policy, examples),
        "// clang-format on",
        f"#elif {prefix.upper()}_H != {GUARD}",
        f'#error "another policy named {prefix} is included: export one of them with another --name"',
        "#endif",
        "",
    ]
    text = "\n".join(line.rstrip() for line in lines)
    for name in ("weight", "number", "sum"):
        text = text.replace(f"@{name}_t", form.types[name])
    content = text.partition("#ifndef")[2]
    text = text.replace(GUARD, f"0x{zlib.crc32(content.encode()):08x}")
    text = text.replace("@@", f"{prefix.upper()}_").replace("@", f"{prefix}_")
    return Header(text, constant_bytes, step.state.size, step.local.size, step.multiplications)
