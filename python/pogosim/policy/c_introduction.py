"""The comments and names at the top of an exported policy: how it is used, and what its inputs and outputs are."""

from __future__ import annotations

import textwrap

import numpy as np

import pogosim
from pogosim.policy.policy import Policy

WIDTH = 120


def introduction(policy: Policy, prefix: str, source: str) -> list[str]:
    """Return the comment at the top."""
    upper = prefix.upper()
    network = policy.network
    kind = "floats of 32 bits" if policy.fixed is None else f"whole numbers; weights of {policy.fixed.bits} bits"
    state = f"&mydata->{prefix}_state, " if network.is_recurrent else ""
    of_user_data = f"a member `{prefix}_state_t {prefix}_state;` in USERDATA, and " if network.is_recurrent else ""
    init = [f"//         {prefix}_reset(&mydata->{prefix}_state);"] if network.is_recurrent else []
    values = ", ".join(network.input_names)
    text = (
        f"The policy of {source} as C for robots: {network.describe()}; {kind}. Made by `pogosim export-policy` of "
        f"Pogosim {pogosim.__version__}; change the policy, and export it again."
    )
    note = (
        "Inputs and outputs are floats."
        if policy.fixed is None
        else "Inputs and outputs are whole numbers. No sum or product leaves its type, whatever the inputs are."
    )
    if not np.isnan(network.decision_s):
        note += (
            f" Call {prefix}_step() every {network.decision_s:.6g} s ({upper}_DECISION_MS, in milliseconds): its "
            "decisions were that far apart in training."
        )
    return [
        *(f"// {line}" for line in textwrap.wrap(text, WIDTH - 3)),
        "//",
        *(
            f"// {line}"
            for line in textwrap.wrap(f"In a program with {of_user_data}this header behind pogobase.h:", WIDTH - 3)
        ),
        "//",
        "//     void user_init(void) {",
        f"//         if (!{prefix}_self_test()) {{ pogobot_led_setColor(255, 0, 0); }}  // not what was exported",
        *init,
        "//     }",
        "//     void user_step(void) {",
        *(
            f"//         {line}"
            for line in textwrap.wrap(
                f"{prefix}_value_t const inputs[{upper}_INPUTS] = {{{values}}};",
                WIDTH - 12,
                subsequent_indent="    ",
            )
        ),
        f"//         {prefix}_value_t outputs[{upper}_OUTPUTS];",
        f"//         {prefix}_step({state}inputs, outputs);",
        f"//         ... outputs[{upper}_OUTPUT_{network.output_names[0].upper()}] ...",
        "//     }",
        "//",
        *(f"// {line}" for line in textwrap.wrap(f"{note} Their scales are at their names, below.", WIDTH - 3)),
    ]


def decision_time(policy: Policy) -> list[str]:
    """Return the time between decisions as a constant; nothing if it is unknown."""
    decision_s = policy.network.decision_s
    if np.isnan(decision_s):
        return []
    return [f"#define @@DECISION_MS {round(1000 * decision_s)}  // from one decision to the next, in training"]


def enumeration(names: tuple[str, ...], what: str, comments: list[str]) -> list[str]:
    """Return the places of inputs or outputs as an enum, and how many there are: a name that no place can have."""
    rows = [f"    @@{what}_{name},".upper() for name in names]
    width = max(map(len, rows))
    made = [f"{row:{width}}  // {comment}" for row, comment in zip(rows, comments, strict=True)]
    return ["enum {", *made, f"    @@{what}S".upper(), "};"]


def comments_of_inputs(policy: Policy) -> list[str]:
    """Return what is said of each input."""
    network, fixed = policy.network, policy.fixed
    made = []
    for index, name in enumerate(network.input_names):
        text = f"{name}: scaled by ({name} - {network.input_offset[index]:.6g}) * {network.input_scale[index]:.6g}"
        if fixed is not None:
            text += f", cut to {fixed.input_low[index]} to {fixed.input_high[index]}"
        elif not np.isnan(network.input_range[index, 0]):
            least, most = network.input_range[index]
            text += f", cut to {least:.6g} to {most:.6g}"
        made.append(text)
    return made


def comments_of_outputs(policy: Policy) -> list[str]:
    """Return what is said of each output."""
    network, fixed = policy.network, policy.fixed
    made = []
    for index, name in enumerate(network.output_names):
        text = f"{name}: value * {network.output_scale[index]:.6g} + {network.output_offset[index]:.6g}"
        if fixed is not None:
            what = " in a step" if network.is_recurrent else ""
            text += f", within {fixed.error_bound[index]:.3g} of exact arithmetic{what}"
        made.append(text)
    return made
