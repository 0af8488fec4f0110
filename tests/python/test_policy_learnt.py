"""A policy of an environment for learning goes through one file into C, and does on robots what it did in training."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from in_process import pogosim as command
from pogosim.policy import Dense, Policy, network_of
from pogosim.policy.choices import NUMBERS
from pogosim.policy.errors import PolicyError
from pogosim.policy.npz_file import OF_LAYER, SCALING
from running import ROOT
from swarm_envs import hosted_env

STEPS = 12
RANGE = 560, 700  # sensor counts: robots see less and more
PROGRAM = """#include <stdio.h>
#include "policy.h"
int main(void) {
    policy_value_t inputs[POLICY_INPUTS], outputs[POLICY_OUTPUTS];
    if (!policy_self_test()) { return 1; }
    while (fread(inputs, sizeof(inputs), 1, stdin) == 1) {
        policy_step(inputs, outputs);
        fwrite(outputs, sizeof(outputs), 1, stdout);
    }
    return 0;
}
"""


@pytest.mark.parametrize("numbers", NUMBERS)
def test_exported_policy_acts_as_in_the_environment(numbers: str, tmp_path: Path) -> None:
    """Also where robots see more than the ranges of the environment."""
    random = np.random.default_rng(1)
    slope, bias = random.normal(0, 0.6, (2, 3)), random.normal(0, 0.3, 2)
    seen, written = [], []
    with hosted_env(observation=[("photosensors", *RANGE)], runs=2) as env:
        layers = [Dense(slope, bias, "hardtanh")]
        Policy(network_of(layers, **env.policy_arrays())).save(tmp_path / "policy.npz")
        assert env.check_policy(tmp_path / "policy.npz")["layer0_weights"] == pytest.approx(slope)
        observation, _ = env.reset(seed=1)
        for _ in range(STEPS):
            seen.append(env.swarm["photosensors"].copy())
            observation, *_ = env.step(np.clip(observation @ slope.T + bias, -1, 1))
            written.append(env.swarm.brain.motors[..., :2].astype(float))

    result = command(tmp_path, "export-policy", "policy.npz", "--numbers", numbers, "-o", "policy.h", "--no-cycles")
    assert (result.code, result.errors) == (0, "")
    (tmp_path / "main.c").write_text(PROGRAM)
    subprocess.run(["cc", "-O2", "-Wall", "-Werror", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    policy = Policy.load(tmp_path / "policy.npz", numbers=numbers)
    given = np.array(seen).astype(policy.dtype)
    done = subprocess.run([tmp_path / "main"], input=given.tobytes(), capture_output=True, check=True, timeout=60)
    acted = np.frombuffer(done.stdout, policy.dtype).reshape(STEPS, 2, 3, 2).astype(float)

    bound = 0.01 if policy.fixed is None else policy.fixed.error_bound
    assert (abs(acted - np.array(written)) <= 0.5 + bound).all()
    assert given.min() < RANGE[0] < RANGE[1] < given.max()
    assert 0.1 < (abs(acted) == 1023).mean() < 0.9


def test_time_between_decisions_goes_with_a_policy(tmp_path: Path) -> None:
    with hosted_env(decision_s=0.25) as env:
        arrays = env.policy_arrays()
        units = len(env.inputs)
        Policy(network_of([Dense(np.ones((2, units)), np.zeros(2), "hardtanh")], **arrays)).save(
            tmp_path / "policy.npz"
        )
    assert Policy.load(tmp_path / "policy.npz").network.decision_s == 0.25
    command(tmp_path, "export-policy", "policy.npz", "-o", "policy.h", "--no-cycles")
    header = (tmp_path / "policy.h").read_text()
    assert "#define POLICY_DECISION_MS 250 " in header
    assert "Call policy_step() every 0.25 s" in " ".join(header.replace("//", "").split())
    with (
        hosted_env(decision_s=0.1) as env,
        pytest.raises(pogosim.ConfigurationError, match=r"decides every 0.25 s, and the environment every 0.1 s"),
    ):
        env.check_policy(tmp_path / "policy.npz")


@pytest.mark.parametrize("decision_s", [0.0, -1.0, np.inf, [0.1, 0.2], "0.1", True])
def test_wrong_times_between_decisions_are_refused(decision_s: Any) -> None:
    with pytest.raises(PolicyError, match="decision_s: expected a time in seconds above 0"):
        network_of([Dense(np.ones((1, 1)), np.zeros(1), "tanh")], decision_s=decision_s)


def test_two_policies_of_one_name_do_not_compile_together(tmp_path: Path) -> None:
    for name, weight in (("one", 1.0), ("two", 2.0)):
        Policy(network_of([Dense(np.full((1, 1), weight), np.zeros(1), "tanh")])).save(tmp_path / f"{name}.npz")
        assert command(tmp_path, "export-policy", f"{name}.npz", "-o", f"{name}.h", "--no-cycles").code == 0
    for first, second, said in (("one", "one", ""), ("one", "two", "another policy named policy is included")):
        (tmp_path / "main.c").write_text(
            f'#include "{first}.h"\n#include "{second}.h"\nint main(void) {{ return !policy_self_test(); }}\n'
        )
        compiler = ["cc", "-Wall", "-Wno-unused", "main.c", "-o", "main"]
        done = subprocess.run(compiler, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert (done.returncode == 0) == (said == "")
        assert said in done.stderr


@pytest.mark.parametrize("name", ["float.h", "math.h", "pogobase.h"])
def test_a_policy_does_not_take_the_name_of_a_header_of_c_or_of_robots(name: str, tmp_path: Path) -> None:
    Policy(network_of([Dense(np.ones((1, 1)), np.zeros(1), "tanh")])).save(tmp_path / "policy.npz")
    result = command(tmp_path, "export-policy", "policy.npz", "-o", name, "--no-cycles")
    assert result.code == 2
    said = f"{name} would hide the header <{name}> of C or robots; choose another name"
    assert result.errors == f"pogosim export-policy: {said}\n"
    assert not (tmp_path / name).exists()


def test_page_has_all_arrays_of_a_file() -> None:
    rows = re.findall(
        r"^\| (`(?:layer0|input|output|decision)_.*?) \|", (ROOT / "docs" / "policy_export.md").read_text(), re.M
    )
    named = re.findall(r"`(\w+)`", "".join(rows))
    assert sorted(named) == sorted([*(f"layer0_{part}" for part in OF_LAYER), *SCALING])
