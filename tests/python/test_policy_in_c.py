"""Exported policies compute on computers, in C and C++, and on emulated robots what they compute in Python."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from firmwares import firmware_in, project_of, run_firmware
from pogosim.policy import Dense, Policy, PolicyError, fixed_arithmetic, float_arithmetic, network_of
from pogosim.policy.c_functions import OF_FLOATS, OF_INTEGERS
from pogosim.policy.c_header import header_of
from pogosim.policy.c_text import BYTES
from pogosim.policy.choices import ACTIVATIONS, NUMBERS
from pogosim.policy.example_steps import example_steps
from random_policies import ALL, INPUTS, observations, random_network
from running import compiler

STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wfloat-conversion", "-Wshadow", "-Werror")
COMPILERS = [  # gcc and g++ build the project; clang is tried where it is installed
    ("gcc", ["-std=c99", "-O2"]),
    ("gcc", ["-std=c11", "-ffp-contract=off", "-fsanitize=undefined", "-fno-sanitize-recover"]),
    ("g++", ["-x", "c++", "-std=c++17", "-O2"]),
    *((name, ["-std=c11", "-O2", "-ffp-contract=off"]) for name in [compiler("clang", "clang-14")] if name),
]
POLICIES = [(name, numbers) for name in ALL for numbers in NUMBERS]
ROWS = 40

READER = """
static int read_{prefix}(FILE* file) {{
    {prefix}_value_t inputs[{inputs}], outputs[{upper}_OUTPUTS];
    {reset}
    if (!{prefix}_self_test()) {{ return 1; }}
    for (int row = 0; row < {rows}; row++) {{
        if (fread(inputs, sizeof(inputs), 1, file) != 1) {{ return 2; }}
        {prefix}_step({argument}inputs, outputs);
        fwrite(outputs, sizeof(outputs), 1, stdout);
    }}
    return 0;
}}
"""


def prefix_of(name: str, numbers: str) -> str:
    return f"{name}_{numbers}"


@pytest.fixture(scope="module")
def headers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all policies, each with names of its own, as headers."""
    folder = tmp_path_factory.mktemp("headers")
    for name, numbers in POLICIES:
        policy = Policy(random_network(ALL[name]), numbers=numbers)
        prefix = prefix_of(name, numbers)
        (folder / f"{prefix}.h").write_text(header_of(policy, example_steps(policy, None), prefix, "random.npz").text)
    return folder


def rows_for(numbers: str) -> npt.NDArray[np.generic]:
    """Inputs in their range, and far beyond it."""
    rows = observations(ROWS)
    rows[3] = 10**6
    rows[4] = -(10**6)
    return rows.astype(np.float32 if numbers == "float" else np.int32)


def expected(name: str, numbers: str) -> npt.NDArray[np.generic]:
    policy = Policy(random_network(ALL[name]), numbers=numbers)
    return np.array([policy.step(row) for row in rows_for(numbers)])


@pytest.mark.parametrize(("name", "flags"), COMPILERS, ids=lambda part: part if isinstance(part, str) else part[0])
def test_native_program_gives_the_same_bytes_as_python(
    headers: Path, name: str, flags: list[str], tmp_path: Path
) -> None:
    """All headers in one program, without warnings, and without undefined behaviour as gcc's sanitizer finds it."""
    text = ["#include <stdio.h>", *(f'#include "{prefix_of(*one)}.h"' for one in POLICIES)]
    for one in POLICIES:
        prefix = prefix_of(*one)
        is_recurrent = one[0] in ("elman", "gated")
        reset = f"{prefix}_state_t state; {prefix}_reset(&state);" if is_recurrent else ""
        argument = "&state, " if is_recurrent else ""
        text.append(
            READER.format(prefix=prefix, upper=prefix.upper(), inputs=INPUTS, rows=ROWS, reset=reset, argument=argument)
        )
    calls = " || ".join(f"read_{prefix_of(*one)}(stdin)" for one in POLICIES)
    text.append(f"int main(void) {{ return {calls}; }}\n")
    (tmp_path / "main.c").write_text("\n".join(text))
    subprocess.run([name, *flags, *STRICT, f"-I{headers}", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    given = b"".join(rows_for(numbers).tobytes() for _, numbers in POLICIES)
    done = subprocess.run([tmp_path / "main"], input=given, capture_output=True, check=True, timeout=60)
    assert done.stdout == b"".join(expected(*one).tobytes() for one in POLICIES)


ROBOT = """#include "pogobase.h"
#include <string.h>
INCLUDES
typedef struct { uint8_t tick; STATES } USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
static int32_t const rows[ROW_COUNT][3] = {ROW_VALUES};
void user_init(void) {}
void user_step(void) {
    if (mydata->tick >= ROW_COUNT) { return; }
    int32_t const* row = rows[mydata->tick++];
    CALLS
}
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""
CALL = """{{
        {prefix}_value_t inputs[3];
        for (int i = 0; i < 3; i++) {{ inputs[i] = ({prefix}_value_t)row[i]; }}
        {prefix}_value_t outputs[2];
        uint32_t bits[2];
        {prefix}_step({argument}inputs, outputs);
        memcpy(bits, outputs, sizeof(bits));
        printf("{prefix} %d %lu %lu\\n", {prefix}_self_test(), (unsigned long)bits[0], (unsigned long)bits[1]);
    }}"""
TICKS = 8


def test_emulated_robot_gives_the_same_bits_as_python(headers: Path, tmp_path: Path) -> None:
    rows = observations(TICKS)
    states, calls = [], []
    for one in POLICIES:
        prefix = prefix_of(*one)
        is_recurrent = one[0] in ("elman", "gated")
        states.append(f"{prefix}_state_t {prefix};" if is_recurrent else "")  # USERDATA begin as zeros, as the state
        calls.append(CALL.format(prefix=prefix, argument=f"&mydata->{prefix}, " if is_recurrent else ""))
    text = (
        ROBOT.replace("INCLUDES", "\n".join(f'#include "{prefix_of(*one)}.h"' for one in POLICIES))
        .replace("STATES", " ".join(states))
        .replace("ROW_VALUES", ", ".join("{" + ", ".join(map(str, row)) + "}" for row in rows))
        .replace("ROW_COUNT", str(TICKS))
        .replace("CALLS", "\n".join(calls))
    )
    source = tmp_path / "main.c"
    source.write_text(text)
    firmware = firmware_in(project_of(tmp_path / "project", source, *headers.glob("*.h")))
    result = run_firmware(firmware, tmp_path, {"simulation_time": 0.5, "objects.robots.nb": 1})
    assert result.code == 0, result.text
    lines = [line.split("[PRINTF] ")[1].split() for line in result.robot_lines]
    assert len(lines) == TICKS * len(POLICIES)
    for place, (name, numbers) in enumerate(POLICIES):
        policy = Policy(random_network(ALL[name]), numbers=numbers)
        for tick, row in enumerate(rows):
            prefix, is_right, *bits = lines[tick * len(POLICIES) + place]
            assert (prefix, is_right) == (prefix_of(name, numbers), "1")
            wanted = policy.step(row).astype(policy.dtype).view(np.uint32)
            assert [int(one) for one in bits] == wanted.tolist(), (name, numbers, tick)


@pytest.mark.parametrize("numbers", NUMBERS)
def test_self_test_finds_a_changed_weight(numbers: str, tmp_path: Path) -> None:
    policy = Policy(random_network(ALL["plain"]), numbers=numbers)
    text = header_of(policy, example_steps(policy, None), "policy", "a").text
    changed, count = re.subn(r"(policy_weights_0\[24\] = \{\s+)[^,]+,", r"\g<1>0,", text)
    assert count == 1
    for content, code in ((text, 0), (changed, 1)):
        (tmp_path / "policy.h").write_text(content)
        (tmp_path / "main.c").write_text('#include "policy.h"\nint main(void) { return !policy_self_test(); }\n')
        subprocess.run(["gcc", "main.c", "-o", "main"], cwd=tmp_path, check=True)
        assert subprocess.run([tmp_path / "main"], check=False).returncode == code


def test_sizes_in_the_header_are_those_of_its_arrays(tmp_path: Path) -> None:
    policy = Policy(random_network(ALL["gated"]), numbers="int8")
    header = header_of(policy, example_steps(policy, None), "policy", "a")
    assert header.state_bytes == 2 * (5 + 4)
    assert f"#define POLICY_CONSTANT_BYTES {header.constant_bytes} " in header.text
    (tmp_path / "policy.h").write_text(header.text)
    (tmp_path / "main.c").write_text(
        '#include "policy.h"\n_Static_assert(sizeof(policy_state_t) == POLICY_STATE_BYTES, "");\n'
        "int main(void) { return policy_self_test(); }\n"
    )
    subprocess.run(["gcc", "-c", "-O0", "main.c"], cwd=tmp_path, check=True)
    listed = subprocess.run(["nm", "-S", "main.o"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    sizes = [int(line.split()[1], 16) for line in listed.splitlines() if line.split()[-2] == "r"]
    assert sum(sizes) == header.constant_bytes
    body = header.text[header.text.index("void policy_step(") :].partition("\n}")[0]
    arrays = re.findall(r"^    (\w+) \w+\[(\d+)\];$", body, re.MULTILINE)
    assert [kind for kind, _ in arrays] == ["int16_t", "int16_t", "int32_t"]  # scaled inputs, the last layer, sums
    assert sum(BYTES[kind] * int(count) for kind, count in arrays) == header.stack_bytes


def test_inputs_and_outputs_may_have_any_name_in_c(tmp_path: Path) -> None:
    layer = Dense(np.ones((5, 5)), np.zeros(5), "tanh")
    names = ["count", "Counts", "inputs", "S", "while"]
    policy = Policy(network_of([layer], input_names=names, output_names=names, input_low=0, input_high=9))
    (tmp_path / "policy.h").write_text(header_of(policy, example_steps(policy, None), "policy", "a").text)
    (tmp_path / "main.c").write_text(
        '#include "policy.h"\nint main(void) { return POLICY_INPUT_COUNT + POLICY_OUTPUT_WHILE + POLICY_OUTPUTS; }\n'
    )
    subprocess.run(["gcc", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "main"], check=False).returncode == 0 + 4 + 5


@pytest.mark.parametrize("prefix", ["int", "while", "int8"])
def test_names_may_begin_with_any_word(prefix: str, tmp_path: Path) -> None:
    """A word of C, too: all names go on behind it."""
    policy = Policy(random_network(ALL["gated"]), numbers="int8")
    text = header_of(policy, example_steps(policy, None), prefix, "a").text
    assert f"a member `{prefix}_state_t {prefix}_state;` in USERDATA" in text
    (tmp_path / "policy.h").write_text(text)
    (tmp_path / "main.c").write_text(
        f'#include "policy.h"\nint main(void) {{ {prefix}_state_t {prefix}_state; {prefix}_reset(&{prefix}_state); '
        f"return !{prefix}_self_test(); }}\n"
    )
    subprocess.run(["gcc", *STRICT, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    subprocess.run([tmp_path / "main"], check=True)


@pytest.mark.parametrize(
    ("name", "numbers", "count"),
    [
        # inputs, weights, function of each unit, weights, function, outputs
        ("plain", "float", 3 + 3 * 8 + 8 * 11 + 8 * 2 + 2 * 0 + 2),
        ("plain", "int16", 3 + 3 * 8 + 8 * 2 + 8 * 2 + 2 * 1 + 2),
        ("linear", "int8", 3 + 3 * 6 + 6 * 1 + 6 * 5 + 5 * 2 + 5 * 2 + 2 * 1),
        ("elman", "float", 3 + (3 + 6) * 6 + 6 * 11 + 6 * 2 + 2 * 11 + 2),
        ("gated", "float", 3 + (3 + 5) * 15 + 5 * 35 + (5 + 4) * 4 + 4 * 11 + 4 * 2 + 2),
        # of a GRU: the shift of four sums and of their total, three of the table, and two products
        ("gated", "int16", 3 + (3 + 5) * 15 + 5 * (4 + 1 + 3 + 2) + (5 + 4) * 4 + 4 * 2 + 4 * 2 + 2 * 1 + 2),
    ],
)
def test_multiplications_are_those_of_the_emitted_functions(name: str, numbers: str, count: int) -> None:
    policy = Policy(random_network(ALL[name]), numbers=numbers)
    header = header_of(policy, example_steps(policy, None), "policy", "a")
    assert header.multiplications == count
    assert f"#define POLICY_MULTIPLICATIONS {count} " in header.text


def test_each_activation_is_in_all_tables() -> None:
    assert [*float_arithmetic.ACTIVATE] == [*ACTIVATIONS]
    assert [*fixed_arithmetic.FUNCTIONS] == [*ACTIVATIONS, fixed_arithmetic.OUTPUTS]
    assert {f"next_{name}" for name in ACTIVATIONS} <= OF_FLOATS.keys() & OF_INTEGERS.keys()


def test_functions_that_a_policy_does_not_call_are_left_out() -> None:
    network = network_of([Dense(np.ones((1, 1)), np.zeros(1), "tanh")])
    policy = Policy(network)
    text = header_of(policy, example_steps(policy, None), "policy", "a").text
    found = re.findall(r"^static inline \w+ policy_(\w+)\(", text, re.MULTILINE)
    assert found == ["exp_of_negative", "tanh", "add_product", "next_tanh", "step", "self_test"]


@pytest.mark.parametrize("activation", ["identity", "relu"])
def test_policy_whose_results_overflow_is_refused(activation: str) -> None:
    """Without a warning of NumPy: pytest would make it an error."""
    layers = [Dense(np.full((3, 3), 3e38), np.zeros(3), activation) for _ in range(2)]
    policy = Policy(network_of(layers, output_names=["left", "right", "led"]))
    said = r"the output left is (inf|-inf|nan) for the inputs [^;]*: numbers overflow on the way; expected weights and"
    with pytest.raises(PolicyError, match=said):
        example_steps(policy, np.array([[1, 2, 3], [4, 5, 6]]))


@pytest.mark.parametrize("name", ["", "a b", "1a", "a_", "x" * 64, "é"])
def test_prefix_that_is_no_name_in_c_is_refused(name: str) -> None:
    policy = Policy(random_network(ALL["plain"]))
    with pytest.raises(PolicyError, match="expected a name as in C"):
        header_of(policy, example_steps(policy, None), name, "a")
