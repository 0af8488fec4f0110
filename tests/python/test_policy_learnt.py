"""A policy of an environment for learning goes through one file into C, and does on robots what it did in training."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from in_process import pogosim as command
from pogosim.policy import Dense, Policy, network_of
from pogosim.policy.choices import NUMBERS
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


def test_page_has_all_arrays_of_a_file() -> None:
    rows = re.findall(r"^\| (`(?:layer0|input|output)_.*?) \|", (ROOT / "docs" / "policy_export.md").read_text(), re.M)
    named = re.findall(r"`(\w+)`", "".join(rows))
    assert sorted(named) == sorted([*(f"layer0_{part}" for part in OF_LAYER), *SCALING])
