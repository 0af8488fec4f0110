"""Policies do in floats, and within a proven bound in whole numbers, what exact arithmetic says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import random_policies
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pogosim.policy import Dense, Policy, PolicyError, float_arithmetic, network_of, tanh_table
from pogosim.policy.choices import ACTIVATIONS, NUMBERS
from pogosim.policy.fixed_arithmetic import MOST_VALUE, Integers, fixed_step
from pogosim.policy.quantization import TABLE_ERROR
from pogosim.policy.tanh_table import ONE
from random_policies import ALL, Kind, exact_step, observations, random_network

OF_ELMAN = ("hardtanh", "tanh", "sigmoid")


@st.composite
def chains(draw: st.DrawFn) -> tuple[Kind, ...]:
    """Draw up to three layers; values that are not bounded come from bounded ones."""
    made: list[Kind] = []
    for _ in range(draw(st.integers(1, 3))):
        kind = draw(st.sampled_from(("dense", "dense", "elman", "gru")))
        units = draw(st.integers(1, 6))
        made.append((kind, units, draw(st.sampled_from(OF_ELMAN if kind == "elman" else ACTIVATIONS))))
    return tuple(made)


@given(chains(), st.integers(0, 10**6), st.sampled_from((0.05, 0.5, 3.0)))
@settings(max_examples=60, deadline=None)
def test_floats_are_those_of_exact_arithmetic_but_for_their_digits(
    kinds: Sequence[Kind], seed: int, size: float
) -> None:
    network = random_network(kinds, seed, size)
    policy = Policy(network)
    rows = observations(20, seed)
    for _ in range(3):
        before = np.zeros((20, network.state_units)) if policy.state is None else policy.state.astype(float)
        exact, _ = exact_step(network, rows, before)
        found = policy.step(rows)
        largest = 1000 * max(1.0, float(np.abs(exact / 1000).max()))
        assert np.abs(found - exact).max() < 1e-5 * size * largest + 2e-6 * largest


@given(chains(), st.integers(0, 10**6), st.sampled_from((0.05, 0.5, 3.0)), st.sampled_from(("int8", "int16")))
@settings(max_examples=100, deadline=None)
def test_whole_numbers_are_within_their_bound_of_exact_arithmetic(
    kinds: Sequence[Kind], seed: int, size: float, numbers: str
) -> None:
    network = random_network(kinds, seed, size)
    try:
        policy = Policy(network, numbers=numbers)
    except PolicyError as error:  # relu after relu with large weights
        assert re.search("layer .* too large|values of a layer may reach|outputs may reach", str(error))
        assume(False)  # hypothesis fails if too many are refused
    assert policy.fixed is not None
    rows = observations(50, seed)
    rows[:8] = np.stack(np.meshgrid(*[[random_policies.LOW, random_policies.HIGH]] * 3), axis=-1).reshape(8, 3)
    for _ in range(3):
        before = np.zeros((50, network.state_units)) if policy.state is None else policy.state / ONE
        exact, _ = exact_step(network, rows, before)
        off = np.abs(policy.step(rows) - exact).max(axis=0)
        assert (off <= policy.fixed.error_bound).all()


@pytest.mark.parametrize("numbers", ["int8", "int16"])
@pytest.mark.parametrize("name", ALL)
def test_bound_of_the_error_is_not_far_above_errors_that_there_are(name: str, numbers: str) -> None:
    policy = Policy(random_network(ALL[name]), numbers=numbers)
    assert policy.fixed is not None
    rows = observations(2000)
    exact, _ = exact_step(policy.network, rows, np.zeros((2000, policy.network.state_units)))
    off = np.abs(policy.step(rows) - exact).max(axis=0)
    assert (policy.fixed.error_bound < 20 * off).all()


class Watched(Integers):
    """Whole numbers; the largest of all that is computed of them is kept."""

    largest = 0.0

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        """Compute something element by element."""
        return watched(getattr(ufunc, method)(*map(plain, inputs), **options))

    def __array_function__(self, function: Any, types: Any, inputs: Any, options: Any) -> Any:
        """Compute something else, such as np.where()."""
        return watched(function(*map(plain, inputs), **options))


def plain(value: Any) -> Any:
    """Return arrays without the watch."""
    if isinstance(value, list | tuple):
        return type(value)(map(plain, value))
    return np.asarray(value) if isinstance(value, np.ndarray) else value


def watched(value: Any) -> Any:
    """Return arrays under the watch."""
    if isinstance(value, list):
        return [watched(one) for one in value]
    if value.dtype.kind in "if" and value.size:
        Watched.largest = max(Watched.largest, float(abs(value).max()))
    return value.view(Watched)


@given(chains(), st.integers(0, 10**6), st.sampled_from((0.5, 3.0, 12.0)), st.sampled_from(("int8", "int16")))
@settings(max_examples=60, deadline=None)
def test_no_sum_product_or_value_leaves_its_type(kinds: Sequence[Kind], seed: int, size: float, numbers: str) -> None:
    """All numbers on the way are looked at, for inputs at the ends of their ranges and in between."""
    try:
        policy = Policy(random_network(kinds, seed, size), numbers=numbers)
    except PolicyError:
        assume(False)
    fixed = policy.fixed
    assert fixed is not None
    ends = np.array(np.meshgrid(*[[random_policies.LOW, random_policies.HIGH]] * 3)).reshape(3, 8).T
    rows = np.concatenate([observations(40, seed), ends])
    state = np.zeros((len(rows), fixed.source.state_units), np.int64)
    Watched.largest = 0.0
    for _ in range(3):
        outputs, state = fixed_step(fixed, rows.view(Watched), state.view(Watched))
        assert isinstance(outputs, Watched)
        assert np.abs(plain(state)).max(initial=0) <= ONE
    assert 0 < Watched.largest < 2**31


def test_tables_of_tanh_and_sigmoid_are_within_their_errors() -> None:
    arguments = np.arange(-MOST_VALUE, MOST_VALUE + 1)
    tanh = tanh_table.tanh_of(arguments) / ONE
    assert np.abs(tanh - np.tanh(arguments / 4096)).max() <= TABLE_ERROR["tanh"] < 2e-4
    sigmoid = tanh_table.sigmoid_of(arguments) / ONE
    assert np.abs(sigmoid - random_policies.sigmoid(arguments / 2048)).max() <= TABLE_ERROR["sigmoid"] < 2e-4
    assert (np.diff(tanh) >= 0).all()
    assert (np.diff(sigmoid) >= 0).all()


def test_functions_of_floats_need_no_library_and_are_exact_to_their_digits() -> None:
    x = np.concatenate([np.linspace(-120, 120, 100_001), [0.0, -0.0, 1e30, -1e30, 1e-30]]).astype(np.float32)
    with np.errstate(over="ignore"):
        assert np.abs(float_arithmetic.tanh(x) - np.tanh(x.astype(float))).max() < 2e-7
        assert np.abs(float_arithmetic.sigmoid(x) - random_policies.sigmoid(x.astype(float))).max() < 2e-7


@pytest.mark.parametrize("numbers", ["float", "int16", "int8"])
@pytest.mark.parametrize("name", ALL)
def test_swarms_and_runs_are_stepped_as_their_robots_alone(name: str, numbers: str) -> None:
    network = random_network(ALL[name])
    together = Policy(network, numbers=numbers)
    rows = observations(2 * 5 * 3).reshape(3, 2, 5, random_policies.INPUTS)  # steps, runs, robots
    alone = [Policy(network, numbers=numbers) for _ in range(10)]
    for step in rows:
        outputs = together.step(step)
        assert outputs.shape == (2, 5, 2)
        expected = [policy.step(row) for policy, row in zip(alone, step.reshape(10, -1), strict=True)]
        np.testing.assert_array_equal(outputs.reshape(10, 2), expected)


def test_reset_forgets_everything_or_some_runs() -> None:
    network = random_network(ALL["gated"])
    policy = Policy(network)
    rows = observations(4).reshape(2, 2, 3)
    first = policy.step(rows)
    second = policy.step(rows)
    assert not np.array_equal(first, second)
    policy.reset(np.array([True, False]))
    third = policy.step(rows)
    np.testing.assert_array_equal(third[0], first[0])
    assert not np.array_equal(third[1], first[1])
    policy.reset()
    np.testing.assert_array_equal(policy.step(rows[0]), first[0])


@pytest.mark.parametrize(
    ("observation", "said"),
    [
        (
            [1, 2],
            r"observation: expected numbers of shape \(..., 3\): x0, x1, x2; found an array of int64 of shape \(2,\)",
        ),
        ("abc", r"observation: expected numbers of shape \(..., 3\): x0, x1, x2; found an array of <U3 of shape \(\)"),
        ([[1, 2, 3], [1, np.nan, 3]], r"observation\[1, 1\]: expected a finite number, found nan"),
    ],
)
def test_observation_of_another_policy_is_refused(observation: object, said: str) -> None:
    with pytest.raises(PolicyError, match=said):
        Policy(random_network(ALL["plain"])).step(observation)  # type: ignore[arg-type]


def test_swarm_of_another_size_is_refused_until_the_policy_forgets() -> None:
    policy = Policy(random_network(ALL["elman"]))
    policy.step(observations(4))
    with pytest.raises(
        PolicyError, match=r"with \(4,\) in front, as in the last step, found \(5, 3\); reset\(\) begins anew"
    ):
        policy.step(observations(5))
    policy.reset()
    assert policy.step(observations(5)).shape == (5, 2)


@pytest.mark.parametrize("numbers", NUMBERS)
def test_inputs_beyond_their_range_count_as_its_ends(numbers: str) -> None:
    policy = Policy(random_network(ALL["plain"]), numbers=numbers)
    np.testing.assert_array_equal(policy.step([9999.0, -1e18, 5]), policy.step([3000, 0, 5]))


def test_inputs_are_cut_to_the_range_of_observations_only_where_the_policy_has_none() -> None:
    layers = [Dense(np.eye(3), np.zeros(3), "identity")]
    network = network_of(layers, input_low=[np.nan, -5, np.nan], input_high=[np.nan, 5, np.nan])
    np.testing.assert_array_equal(Policy(network).step([-1e6, 1e6, 1e30]), np.array([-1e6, 5, 1e30], np.float32))
    for numbers in NUMBERS:
        policy = Policy(network, numbers=numbers, calibration=[[0, -1, -30], [100, 1, 30]])
        np.testing.assert_array_equal(policy.network.input_range, [[0, 100], [-5, 5], [-30, 30]])
        np.testing.assert_array_equal(policy.step([-(10**6), 10**6, 10**9]), [0, 5, 30])


@given(chains(), st.integers(0, 10**6), st.sampled_from(("int8", "int16")))
@settings(max_examples=30, deadline=None)
def test_floats_and_whole_numbers_agree_beyond_the_range_as_within(
    kinds: Sequence[Kind], seed: int, numbers: str
) -> None:
    network = random_network(kinds, seed, 0.3)
    whole, floats = Policy(network, numbers=numbers), Policy(network)
    assert whole.fixed is not None
    rows = observations(40, seed) * 10 - 15000
    off = np.abs(whole.step(rows) - floats.step(rows)).max(axis=0)
    assert (off <= whole.fixed.error_bound * 1.001 + 0.01).all()


def test_biases_and_scales_of_the_last_linear_layer_are_exact_where_they_can_be() -> None:
    layer = Dense(np.array([[2.0, -1.0]], np.float32), np.array([0.5], np.float32), "identity")
    network = network_of([layer], input_scale=1 / 16, output_scale=32, input_low=0, input_high=100)
    policy = Policy(network, numbers="int16")
    assert policy.step([48, 16]).tolist() == [32 * (2 * 3 - 1) + 16]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"input_scale": 1e-9}, r"the input x0 is scaled to .*steps of the numbers of 16 bits"),
        ({"input_scale": 1e6}, r"the input x0 is scaled to .*; in whole numbers, it may be 32767 at most"),
        ({"input_high": 1e8}, r"the input x0 ranges from 0 to 100000000; in whole numbers it may range over 1048576"),
        ({"output_scale": 1e9}, r"layer 1: outputs may reach|layer 1: weights are too large"),
        (
            {"input_low": np.nan, "input_high": np.nan},
            r"the range of the input x0 is unknown; expected observations of a run",
        ),
    ],
)
def test_what_whole_numbers_cannot_hold_is_refused(changes: dict[str, float], said: str) -> None:
    layers = (
        Dense(np.full((4, 2), 0.5, np.float32), np.zeros(4, np.float32), "tanh"),
        Dense(np.full((1, 4), 5.0, np.float32), np.zeros(1, np.float32), "identity"),
    )
    fine = {"input_low": 0, "input_high": 1000, "input_scale": 1e-3}
    assert Policy(network_of(layers, **fine), numbers="int8").fixed is not None  # type: ignore[arg-type]
    with pytest.raises(PolicyError, match=said):
        Policy(network_of(layers, **(fine | changes)), numbers="int8")  # type: ignore[arg-type]


@pytest.mark.parametrize("activation", ["relu", "identity"])
def test_recurrent_layer_that_may_grow_is_for_floats_alone(activation: str) -> None:
    network = random_network((("elman", 3, activation), ("dense", 1, "tanh")))
    assert Policy(network).step([1, 2, 3]).shape == (1,)
    with pytest.raises(PolicyError, match=f"layer 0: a recurrent layer with {activation} may grow without bounds"):
        Policy(network, numbers="int16")


def test_unknown_format_is_refused() -> None:
    with pytest.raises(PolicyError, match="numbers: expected one of float, int16, int8, found 'int4'"):
        Policy(random_network(ALL["plain"]), numbers="int4")
