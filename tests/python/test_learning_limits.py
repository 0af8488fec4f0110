"""Environments for learning refuse what would be wrong in silence, and ask for a reset after a step that failed."""

from __future__ import annotations

import os
import pickle
from typing import Any

import numpy as np
import pogosim
import pogosim.learning
import pytest
from pogosim.learning import GymnasiumEnv, GymnasiumVectorEnv
from swarm_envs import hosted_env

REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"observation": [("x", 0, 1e-45)]}, "too wide or too narrow for numbers of 32 bits"),
    ({"observation": [("x", -1e39, 1e39)]}, "too wide or too narrow for numbers of 32 bits"),
    ({"observation": [("x", 1, 1 + 1e-15)]}, "too wide or too narrow for numbers of 32 bits"),
    ({"observation": ["photosensors[0][0]"]}, "the robots have no value 'photosensors[0][0]'"),
    ({"observation": ["photosensors[" + "1" * 5000 + "]"]}, "the robots have no value"),
    ({"actions": ["led", "leds"]}, "'led' and 'leds' are written to the same place"),
    ({"actions": ["message(3)", "message(2)"]}, "'message(3)' and 'message(2)' are written to the same place"),
    ({"actions": [("led", -300, 300)]}, "actions: led: expected a range within 0 to 255, found -300 to 300"),
    ({"actions": [("message(3)", 0, 1000)]}, "expected a range within 0 to 255, found 0 to 1000"),
    ({"randomize": {"time_step": [0.02, 0.025]}}, "randomize: time_step cannot be drawn"),
    ({"randomize": {"simulation_time": [1, 2]}}, "randomize: simulation_time cannot be drawn"),
    ({"randomize": {"seed": [1, 2]}}, "randomize: seed cannot be drawn"),
    ({"randomize": {"k": {"type": [1]}}}, "randomize: k.type: expected int, float"),
    ({"randomize": {"k": [-1e308, 1.7e308]}}, "the interval from -1e+308 to 1.7e+308 is too wide"),
    ({"randomize": {"k": {"type": "int", "min": -(10**30), "max": 1}}}, "randomize: k: min: expected a whole number"),
    ({"set": {"simulation_time": 5}}, "set: simulation_time is that of `end`"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED)
def test_what_cannot_be_kept_is_refused_at_once(options: dict[str, Any], message: str) -> None:
    with pytest.raises(pogosim.ConfigurationError) as error:
        hosted_env(**options)
    assert message in str(error.value)


def test_step_that_was_interrupted_demands_a_reset() -> None:
    calls = 0

    def reward(_swarm: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls == 2:
            raise KeyboardInterrupt
        return np.zeros(1)

    with hosted_env(reward=reward) as env:
        env.reset(seed=1)
        actions = np.zeros((1, env.robots, 2))
        env.step(actions)
        with pytest.raises(KeyboardInterrupt):
            env.step(actions)
        for call in (lambda: env.step(actions), env.save):
            with pytest.raises(pogosim.SimulationError, match="was interrupted or failed"):
                call()
        env.reset()
        env.step(actions)


def test_forked_child_leaves_the_configuration_of_its_parent() -> None:
    with hosted_env() as env:
        env.reset(seed=1)
        child = os.fork()
        if not child:
            env._file.close()
            os._exit(0)
        os.waitpid(child, 0)
        env.reset()


def test_environments_are_not_copied_and_info_is_read_only() -> None:
    with hosted_env() as env:
        with pytest.raises(TypeError, match="cannot be copied or pickled"):
            pickle.dumps(env)
        _, info = env.reset(seed=np.array(5))  # type: ignore[arg-type]
        with pytest.raises(ValueError, match="read-only"):
            info["seed"][0] = 1
        info.clear()
        *_, info = env.step(np.zeros((1, env.robots, 2)))
        assert set(info) == {"seed", "randomized"}
        for array in (env.swarm.positions, env.swarm["light"], env.swarm["photosensors"], env.swarm["x"]):
            with pytest.raises(ValueError, match="read-only"):
                array += 1


def test_names_of_the_package_are_listed() -> None:
    assert {"SwarmEnv", "GymnasiumEnv", "PettingZooEnv"} <= set(dir(pogosim.learning))


def test_interfaces_take_seeds_of_numpy_and_refuse_options_that_are_no_map() -> None:
    GymnasiumEnv(hosted_env()).reset(seed=np.int64(3))  # type: ignore[arg-type]
    with pytest.raises(pogosim.ConfigurationError, match="options: expected a map"):
        GymnasiumVectorEnv(hosted_env()).reset(options=[1])  # type: ignore[arg-type]


def test_policy_for_a_range_that_differs_a_little_is_refused() -> None:
    with hosted_env(observation=[("photosensors", -30000, 30000)]) as env:
        arrays = env.policy_arrays()
        env.check_policy(arrays)
        for changed in (arrays["input_scale"] * 1.01, arrays["input_scale"][:2], np.array(["a"])):
            with pytest.raises(pogosim.ConfigurationError, match="other ranges: its input_scale"):
                env.check_policy(arrays | {"input_scale": changed})
