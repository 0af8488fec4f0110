"""The test by which an exported policy checks itself on the robot."""

from __future__ import annotations

import numpy as np

from pogosim.policy.c_text import literal
from pogosim.policy.example_steps import ExampleSteps
from pogosim.policy.policy import Policy

FLOAT_TOLERANCE = 1e-4  # of the greatest output: compilers may contract operations


def self_test(policy: Policy, examples: ExampleSteps) -> list[str]:
    """Return the function with which a robot checks that the policy does there what it did when it was exported."""
    network = policy.network
    steps = len(examples.inputs)
    argument = "&state, " if network.is_recurrent else ""
    state = ["    @state_t state;", "    @reset(&state);"] if network.is_recurrent else []
    if policy.fixed is None:
        tolerance = max(FLOAT_TOLERANCE * float(np.abs(examples.outputs).max()), FLOAT_TOLERANCE / 100)
        wrong = "!(difference > -@TOLERANCE && difference < @TOLERANCE)".replace(
            "@TOLERANCE", literal(tolerance, "float")
        )
        check = [
            "            float const difference = outputs[i] - @test_outputs[step][i];",
            f"            if ({wrong}) {{",
        ]
    else:
        check = ["            if (outputs[i] != @test_outputs[step][i]) {"]
    return [
        "// Whether this program and this processor give the outputs that were there when the policy was exported.",
        "static inline bool @self_test(void) {",
        "    @value_t outputs[@@OUTPUTS];",
        *state,
        f"    for (uint16_t step = 0; step < {steps}; step++) {{",
        f"        @step({argument}@test_inputs[step], outputs);",
        f"        for (uint16_t i = 0; i < {network.outputs}; i++) {{",
        *check,
        "                return false;",
        "            }",
        "        }",
        "    }",
        "    return true;",
        "}",
    ]
