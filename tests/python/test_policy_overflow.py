"""Policies in floats whose numbers may overflow are not exported, however few of their inputs do so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from in_process import pogosim as command
from in_process import refusal
from pogosim.policy import Dense, Elman, Gru, Policy, network_of
from pogosim.policy.overflow import check_overflow, sizes_in
from random_policies import ALL, observations, random_network


def dense(weight: float, activation: str = "identity", inputs: int = 2, units: int = 2) -> Dense:
    return Dense(np.full((units, inputs), weight), np.zeros(units), activation)


def elman(weight: float, recurrent: float, activation: str) -> Elman:
    return Elman(np.full((2, 2), weight), np.full((2, 2), recurrent), np.zeros(2), activation)


@pytest.mark.parametrize(
    ("layers", "scaling", "said"),
    [
        ([dense(1e36)], {}, "a sum of layer 0 may reach 2e+39 for inputs in range, and overflow; expected 3e+38 at "),
        ([dense(1, "tanh"), dense(3e38)], {}, "a sum of layer 1 may reach 6e+38"),
        ([dense(1e20, "relu"), dense(1e20, "tanh")], {}, "a sum of layer 1 may reach 4e+43"),
        ([elman(1, 3e38, "tanh")], {}, "a sum of layer 0 may reach 6e+38"),
        ([elman(1e35, 0.499, "relu")], {}, "a sum of layer 0 may reach 1e+41"),
        (
            [Gru(np.ones((3, 2)), np.ones((3, 1)), np.zeros(3), np.full(3, 3.2e38))],
            {},
            "a sum of layer 0 may reach 3.2e+38",
        ),
        ([dense(1)], {"output_scale": 1e36}, "an output may reach 2e+39"),
        ([dense(1)], {"input_scale": 1e36}, "an input after scaling may reach 1e+39"),
        ([dense(1e-30)], {"input_offset": -2e38, "input_high": 2e38}, "an input minus input_offset may reach 4e+38"),
    ],
)
def test_policy_that_may_overflow_is_refused(
    layers: list[Any], scaling: dict[str, float], said: str, tmp_path: Path
) -> None:
    """Also if it does not do so in the observations that make the test vector."""
    network = network_of(layers, **{"input_low": 0, "input_high": 1000, **scaling})  # type: ignore[arg-type]
    Policy(network).save(tmp_path / "a.npz")
    np.save(tmp_path / "o.npy", np.array([[0, 0], [1e-9, 0]]))
    options = ("-o", "a.h", "--no-cycles", "--calibration", "o.npy")
    assert refusal(command(tmp_path, "export-policy", "a.npz", *options)).startswith(f"pogosim export-policy: {said}")
    assert not (tmp_path / "a.h").exists()


@pytest.mark.parametrize(("recurrent", "activation"), [(0.5, "relu"), (-0.51, "identity")])
def test_policy_that_adds_up_what_it_remembers_is_warned_of(recurrent: float, activation: str, tmp_path: Path) -> None:
    Policy(network_of([elman(1, recurrent, activation)], input_low=0, input_high=9)).save(tmp_path / "a.npz")
    result = command(tmp_path, "export-policy", "a.npz", "-o", "a.h", "--no-cycles")
    assert (result.code, result.errors) == (
        0,
        "pogosim export-policy: warning: layer 0 adds up what it remembers, and may grow until its numbers overflow\n",
    )


def test_inputs_without_a_range_count_as_scaled_to_one() -> None:
    assert check_overflow(network_of([dense(1e38)], input_offset=1e6, input_scale=1e-3)) is None


@given(st.sampled_from(list(ALL)), st.integers(0, 10**6), st.sampled_from((0.1, 1.0, 5.0)))
@settings(max_examples=40, deadline=None)
def test_values_stay_below_the_sizes_that_are_followed(name: str, seed: int, size: float) -> None:
    network = random_network(ALL[name], seed, size)
    assert check_overflow(network) is None
    values = np.full(3, 2.0)  # inputs after scaling
    for layer in network.layers:
        _, values = sizes_in(layer, values)
    policy = Policy(network)
    largest = values * 1000 + 3
    for row in observations(30, seed):
        assert (abs(policy.step(row)) <= largest * 1.0001).all()
