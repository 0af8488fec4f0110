"""What is wrong with an environment for learning is told in a line that names it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from pogosim.learning import GymnasiumEnv, GymnasiumVectorEnv, PettingZooEnv, Quantity, SwarmEnv
from running import example, scene
from swarm_envs import ROBOTS, SETTINGS, hosted_env


def refusal(error: pytest.ExceptionInfo[BaseException]) -> str:
    """Return the message of an error, one line."""
    message = str(error.value)
    assert len(message.splitlines()) == 1, message
    return message


WRONG_ARGUMENTS: list[tuple[dict[str, Any], str]] = [
    ({"observation": []}, 'observation: expected a list of names, such as ["photosensors"], found []'),
    ({"observation": "light"}, "observation: expected a list of names"),
    ({"observation": [1]}, "observation: expected a name, (name, low, high) or a Quantity, found 1"),
    ({"observation": [("light", 1)]}, "observation: expected a name, (name, low, high) or a Quantity"),
    ({"observation": [("light", 1, np.nan)]}, "observation: light: expected a finite number, found nan"),
    ({"observation": [("light", 5, 5)]}, "observation: light: expected low < high, found 5 and 5"),
    ({"observation": [Quantity("light", 0, 1, is_scaled=1)]}, "light: is_scaled: expected True or False, found 1"),  # type: ignore[arg-type]
    ({"observation": ["light", "light"]}, "observation: 'light' is there twice"),
    (
        {"observation": ["photosensor"]},
        "observation: the robots have no value 'photosensor'; did you mean 'photosensors'?",
    ),
    ({"observation": ["photosensors[3]"]}, "observation: 'photosensors[3]': photosensors has 3 entries, from 0"),
    ({"observation": ["message(0)"]}, "observation: 'message(0)': a message has 1 to 382 bytes"),
    ({"observation": ["x"]}, "observation: 'x' needs a range: ('x', low, high)"),
    ({"observation": ["user_data.observation"]}, "the robots have no value 'user_data.observation'; known are x, y"),
    ({"actions": ["motor"]}, "actions: there is no action 'motor'; did you mean 'motors'?"),
    ({"actions": ["message(383)"]}, "actions: 'message(383)': a message has 1 to 382 bytes"),
    ({"actions": ["parameters.gain"]}, "actions: 'parameters.gain' needs a range"),
    ({"actions": None}, "actions: expected a list of names"),
    ({"reward": 3}, 'reward: expected a function, or an expression such as "light", found 3'),
    (
        {"reward": "-mesages_sent"},
        "reward: '-mesages_sent', character 2: there is no value 'mesages_sent': expected one",
    ),
    ({"reward": "-mesages_sent"}, "; did you mean 'messages_sent'?"),
    ({"reward": "light +"}, "reward: 'light +', character 8: expected a value or a number"),
    ({"reward": "light light"}, "reward: 'light light', character 7: expected 'and', 'or', an operator or the end"),
    ({"reward": "(light"}, "reward: '(light', character 7: expected ')'"),
    ({"reward": "x" + "+1" * 500}, "character 1: an expression has at most 1000 characters, found 1001"),
    ({"reward": "-" * 200 + "x"}, "there are too many brackets"),
    ({"reward": "photosensors"}, "there is no value 'photosensors'"),
    ({"end": -1.0}, "end: expected a time above 0 s, found -1.0"),
    ({"end": [np.inf]}, "end: expected a time above 0 s, found inf"),
    ({"end": {}}, "end: expected a time (s), a condition or a function, found {}"),
    ({"end": "x >"}, "end: 'x >', character 4: expected a value or a number"),
    ({"randomize": [1]}, "randomize: expected a map from keys of the configuration to what is drawn, found [1]"),
    ({"randomize": {"seed": 3}}, "randomize: seed: expected an interval [low, high], a list of values"),
    ({"randomize": {"seed": [3, 1]}}, "randomize: seed: expected low <= high, found [3, 1]"),
    ({"randomize": {"seed": []}}, "randomize: seed: expected at least one value to choose from, found []"),
    (
        {"randomize": {"k": {"type": "flot"}}},
        "randomize: k.type: expected int, float, categorical or normal, found 'fl",
    ),
    ({"randomize": {"k": {"type": "int", "min": 1}}}, "randomize: k: max: expected a whole number, found nothing"),
    ({"randomize": {"k": {"type": "int", "maxx": 3}}}, "randomize: k: unknown key 'maxx'; did you mean 'max'?"),
    (
        {"randomize": {"k": {"type": "float", "min": 0, "max": 3, "log": True}}},
        "randomize: k: log: true needs a min above 0, found 0",
    ),
    (
        {"randomize": {"k": {"type": "normal", "mean": 0}}},
        "randomize: k: a domain of type normal needs the key 'stddev",
    ),
    (
        {"randomize": {"k": {"type": "normal", "mean": 0, "stddev": -1}}},
        "randomize: k.stddev: expected a number of at least 0, found -1.0",
    ),
    ({"runs": 0}, "runs: expected an integer from 1 to 100000, found 0"),
    ({"decision_s": 0.015}, "decision_s: expected a multiple of time_step, 0.01 s, found 0.015 s"),
    ({"decision_s": 0}, "decision_s: expected a multiple of time_step, 0.01 s, found 0 s"),
    ({"decision_s": "1"}, "decision_s: expected a finite number, found '1'"),
    ({"end": "x < 0", "decision_s": 20.0}, "simulation_time: expected at least decision_s, 20 s"),
    ({"set": {"objects.robots.raduis": 20}}, "set: unknown key 'objects.robots.raduis'; did you mean 'radius'?"),
    ({"category": "robot"}, "unknown category 'robot' (known: robots, lamp); did you mean 'robots'?"),
    ({"autoreset": "next"}, "autoreset: expected 'NextStep', 'SameStep' or 'Disabled', found 'next'"),
    ({"set": {"objects.robots.nb": 0}}, "category 'robots' has no robots"),
]


@pytest.mark.parametrize(("options", "message"), WRONG_ARGUMENTS, ids=[message[:60] for _, message in WRONG_ARGUMENTS])
def test_wrong_argument_is_named_with_what_is_expected(options: dict[str, Any], message: str) -> None:
    with pytest.raises(pogosim.ConfigurationError) as error:
        hosted_env(**options)
    assert message in refusal(error)


def test_argument_that_does_not_exist_is_one_of_the_environment() -> None:
    with pytest.raises(TypeError, match=r"SwarmEnv\.__init__\(\) got an unexpected keyword argument 'thread'"):
        hosted_env(thread=2)


def test_configuration_that_is_none_is_refused() -> None:
    for configuration, message in (
        (3, "configuration: expected the path of a file"),
        ({"objects": {1j}}, "configuration.objects: expected text, a number"),
        ("never/there.yaml", "never/there.yaml"),
    ):
        with pytest.raises(pogosim.ConfigurationError) as error:
            SwarmEnv(None, configuration, observation=["light"], actions=["motors"], reward="light")  # type: ignore[arg-type]
        assert message in refusal(error)


def learning_env(**options: Any) -> SwarmEnv:
    usual: dict[str, Any] = {"observation": ["light"], "actions": [("user_data.action", -1, 1)], "reward": "light"}
    return SwarmEnv(example("learning"), scene(SETTINGS), end=1.0, **(usual | options))


def test_program_where_a_host_is_needed_is_said_so() -> None:
    with pytest.raises(pogosim.ConfigurationError) as error:
        learning_env(actions=["motors"])
    assert refusal(error) == (
        "actions: 'motors' is written by a host, and a program drives the robots of category 'robots': pass None in "
        "place of the program, or name a member of its user data; known are user_data.observation, user_data.action, "
        "user_data.messages, user_data.forward_dir"
    )
    for options, message in (
        ({"observation": ["photosensors"]}, "the robots have no value 'photosensors'; known are"),
        ({"observation": [("user_data.observatoin", -1, 1)]}, "did you mean 'user_data.observation'?"),
        ({"observation": ["user_data.observation"]}, "'user_data.observation' needs a range"),
        ({"observation": [("column.lihgt", 0, 1)]}, "did you mean 'column.light'?"),
    ):
        with pytest.raises(pogosim.ConfigurationError) as error:
            learning_env(**options)
        assert message in refusal(error)
    with pytest.raises(pogosim.SimulationError):
        SwarmEnv("never_there.so", scene(SETTINGS), observation=["light"], actions=["motors"], reward="light")


def test_column_that_a_function_uses_needs_rows() -> None:
    def reward(swarm: Any) -> Any:
        return swarm["column.light"]

    with learning_env(reward=reward) as env:
        env.reset(seed=1)
        with pytest.raises(pogosim.ConfigurationError, match=r"swarm: the robots have no value 'column\.light'"):
            env.step(np.zeros((1, ROBOTS, 2)))
    with learning_env(reward=reward, set={"enable_data_logging": True}) as env:
        env.reset(seed=1)
        assert env.step(np.zeros((1, ROBOTS, 2)))[1].shape == (1, ROBOTS)


def test_action_on_a_parameter_that_the_program_has_not_read_is_refused() -> None:
    with learning_env(actions=[("parameters.gain", -1, 1)]) as env:
        env.reset(seed=1)
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.step(np.zeros((1, ROBOTS, 1)))
        assert refusal(error).startswith("actions: parameters.gain: the program has not read it")


@pytest.mark.parametrize("is_commanded", [False, True])
def test_actions_that_the_program_overwrites_are_told_once(
    is_commanded: bool, caplog: pytest.LogCaptureFixture
) -> None:
    with learning_env(set={"parameters.is_commanded": is_commanded}, runs=2) as env:
        for _ in range(2):
            env.reset(seed=1)
            env.step(np.full((2, ROBOTS, 2), 0.25))
    told = [message for message in caplog.messages if "user_data.action" in message]
    assert len(told) == int(not is_commanded)
    assert not told or told[0].startswith("actions: user_data.action: the program has written other numbers there")


WRONG_ACTIONS: list[tuple[Any, str]] = [
    (None, "expected numbers of shape (2, 3, 2), found None"),
    ("ab", "expected numbers of shape (2, 3, 2), found 'ab'"),
    ([[1, 2], [3]], "expected numbers of shape (2, 3, 2), found [[1, 2], [3]]"),
    (np.zeros((2, 3, 2), complex), "expected numbers of shape (2, 3, 2)"),
    (0.5, "expected the shape (2, 3, 2): runs, robots, numbers (motors[0], motors[1]); found ()"),
    (np.zeros((2, 3, 3)), "found (2, 3, 3)"),
    (np.zeros((3, 2)), "found (3, 2)"),
    (np.full((2, 3, 2), np.nan), "expected finite numbers, found nan for run 0, robot 0, motors[0]"),
    (np.where(np.arange(12).reshape(2, 3, 2) == 9, np.inf, 0), "found inf for run 1, robot 1, motors[1]"),
]


@pytest.mark.parametrize(("actions", "message"), WRONG_ACTIONS, ids=[message[-40:] for _, message in WRONG_ACTIONS])
def test_wrong_actions_are_refused_and_nothing_moves(actions: Any, message: str) -> None:
    with hosted_env(runs=2) as env:
        with pytest.raises(pogosim.SimulationError, match="reset the environment before its first step"):
            env.step(np.zeros((2, 3, 2)))
        env.reset(seed=1)
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.step(actions)
        assert refusal(error).startswith("actions: ")
        assert message in refusal(error)
        assert [sim.steps for sim in env.runs] == [0, 0]
        env.step(np.full((2, 3, 2), 1e300))  # cut
        assert (env.runs.brain("robots").motors[..., :2] == 1023).all()


WRONG_REWARDS: list[tuple[Any, str]] = [
    (lambda swarm: np.where(swarm["light"] >= 0, np.nan, 0), "reward: expected finite numbers, found nan for run 0"),
    (lambda _: np.full((2, 3), np.inf), "found inf for run 0, robot 0 at t = 0.1 s"),
    (lambda _: np.zeros((3, 2)), "reward: expected numbers of shape (2, 3), for each robot of each run, or (2,)"),
    (lambda _: 1.0, "for each run; found an array of shape ()"),
    (lambda _: None, "found NoneType"),
    (lambda _: [[1], [1, 2]], "found list"),
    (lambda swarm: swarm["lights"], "swarm: the robots have no value 'lights'; did you mean 'light'?"),
    ("1 / (x - x)", "reward: expected finite numbers, found inf for run 0, robot 0 at t = 0.1 s"),
]


@pytest.mark.parametrize(("reward", "message"), WRONG_REWARDS, ids=[message[:50] for _, message in WRONG_REWARDS])
def test_reward_that_is_no_number_of_each_robot_is_refused(reward: Any, message: str) -> None:
    with hosted_env(reward=reward, runs=2) as env:
        env.reset(seed=1)
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.step(np.zeros((2, 3, 2)))
        assert message in refusal(error)


WRONG_ENDS: list[tuple[Any, str]] = [
    (lambda _: np.zeros(2), "found numbers of shape (2,): compare them with something"),
    (lambda swarm: swarm.time_s, "found numbers of shape (2,)"),
    (lambda _: np.array([np.nan, 0.0]), "found numbers of shape (2,)"),
    (lambda swarm: swarm["light"] > 0, "found an array of shape (2, 3): say whether any or all robots count, with"),
    (lambda _: np.zeros(5, bool), "found an array of shape (5,)"),
    (lambda _: True, "found an array of shape ()"),
    (lambda _: None, "found NoneType"),
    (lambda _: [[True], [True, False]], "found list"),
]


@pytest.mark.parametrize(("end", "message"), WRONG_ENDS, ids=[message[:50] for _, message in WRONG_ENDS])
def test_end_that_is_no_truth_value_of_each_run_is_refused(end: Any, message: str) -> None:
    with hosted_env(end=end, runs=2) as env:
        env.reset(seed=1)
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.step(np.zeros((2, 3, 2)))
        assert refusal(error).startswith("end: expected booleans of shape (2,), one for each run; ")
        assert message in refusal(error)


def test_value_that_is_missing_is_refused_where_a_policy_sees_it() -> None:
    robots = {"objects.walls": {"type": "pogowall", "geometry": "arena"}, "objects.robots.brain": "host"}
    with hosted_env(robots, category="walls", observation=[("x", 0, 1000)], actions=["led"]) as env:
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.reset(seed=1)
        assert "run 0, robot 0, x" in refusal(error)
        message = "observation: expected finite numbers, found nan for run 0, robot 0, x at t = 0 s: every robot needs"
        assert message in refusal(error)


def test_seeds_and_runs_that_are_not_there_are_refused() -> None:
    with hosted_env(runs=2) as env:
        for arguments, message in (
            ({"seed": -1}, "seed: expected an integer of at least 0, found -1"),
            ({"seed": 1.5}, "seed: expected an integer of at least 0, found 1.5"),
            ({"seed": [1]}, "seed: expected 2, one for each run, found 1"),
            ({"which": [2]}, "which: there is no run 2: the environment has 2"),
        ):
            with pytest.raises(pogosim.ConfigurationError) as error:
                env.reset(**arguments)
            assert message in refusal(error)
        with pytest.raises(pogosim.ConfigurationError, match=r"state: expected what save\(\) has returned, found 3"):
            env.restore(3)  # type: ignore[arg-type]


def test_key_that_is_drawn_and_unknown_is_refused_with_the_nearest_one() -> None:
    with hosted_env(randomize={"objects.robots.linear_noise_stdev": [0, 0.3]}) as env:
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.reset(seed=1)
        assert refusal(error) == (
            "run 0: set: unknown key 'objects.robots.linear_noise_stdev'; did you mean 'linear_noise_stddev'?"
        )


def test_keys_of_the_configuration_may_be_for_other_programs() -> None:
    unknown = {"objects.robots.raduis": 20}
    with hosted_env(unknown) as env:
        env.reset(seed=1)
    with pytest.raises(pogosim.ConfigurationError, match=r"unknown key 'objects\.robots\.raduis'"):
        hosted_env(unknown, strict=True)


def test_value_that_is_drawn_and_wrong_is_told_with_its_key_and_the_next_episode_may_be_right() -> None:
    key = "objects.robots.linear_noise_stddev"
    with (
        hosted_env(randomize={key: [-1.0, 0.1]}, runs=8) as env,
        pytest.raises(pogosim.ConfigurationError, match=rf"run \d: .*{key}"),
    ):
        env.reset(seed=1)
    with hosted_env(randomize={"objects.robots.nb": {"choices": [4]}}) as env:
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.reset(seed=1)
        assert refusal(error) == (
            "run 0 has 4 robots in category 'robots' since its reset, and had 3: arrays need the same robots in all "
            "episodes, so do not draw their number"
        )


def test_fractions_that_are_drawn_for_integers_are_refused_with_what_to_write() -> None:
    key = "objects.robots.message_queue_size"
    with hosted_env(randomize={key: [2, 9]}, runs=2) as env:
        for _ in range(2):
            with pytest.raises(pogosim.ConfigurationError) as error:
                env.reset(seed=1)
            assert refusal(error).startswith(f"randomize: {key}: expected integers, found ")
            assert refusal(error).endswith(": write {'type': 'int', 'min': 2, 'max': 9}")
    with hosted_env(randomize={key: lambda _: 4.5}) as env:
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.reset(seed=1)
        assert refusal(error) == f"randomize: {key}: expected integers, found 4.5"
    of_integers = {"type": "int", "min": 2, "max": 9}
    with hosted_env(randomize={key: of_integers, "objects.robots.linear_noise_stddev": [0, 0.3]}) as env:
        assert env.reset(seed=1)[1]["randomized"][key].dtype.kind == "i"


def test_category_whose_number_of_robots_was_drawn_is_named() -> None:
    others = {"objects.others": {"type": "pogobot", "nb": 1, "brain": "host"}}
    with hosted_env(others, randomize={"objects.others.nb": {"choices": [2]}}) as env:
        with pytest.raises(pogosim.ConfigurationError) as error:
            env.reset(seed=1)
        assert "run 0 has 2 robots in category 'others' since its reset, and had 1: arrays" in refusal(error)


def test_maps_in_set_are_told_how_to_be_written() -> None:
    for objects in (
        {"robots": {"linear_noise_stddev": 0.1}},
        {"robots": {"radius": 20, "nb": 3}, "lamp": {"value": 3}},
    ):
        with pytest.raises(pogosim.ConfigurationError) as error:
            hosted_env(set={"objects": objects})
        key = f"objects.robots.{next(iter(objects['robots']))}"
        assert refusal(error) == (
            f"set: objects: a map replaces all categories: write the keys one by one, such as {key!r}"
        )


def test_mistake_in_a_map_is_told_as_one_of_the_map() -> None:
    for changes, options, message in (
        (
            {"objects.robots.raduis": 20},
            {"strict": True},
            "configuration: unknown key 'objects.robots.raduis'; did you mean 'radius'? (strict)",
        ),
        (
            {"objects.robots.radius": "x"},
            {},
            "configuration: objects.robots.radius: expected a number from 0.001 to 1000000 (mm), found 'x'",
        ),
    ):
        with pytest.raises(pogosim.ConfigurationError) as error:
            hosted_env(changes, **options)
        assert refusal(error) == message


WRONG_POLICIES: list[tuple[dict[str, Any], str]] = [
    ({"input_names": ["light", "x"]}, "is for another observation: its input 1 is 'x', and that of the environment "),
    ({"input_names": ["light"]}, "is for another observation: it has 1 inputs (light), and the environment has 2"),
    ({"output_names": ["led_0", "motors_1"]}, "is for other actions: its output 0 is 'led_0', and that of the env"),
    ({"input_scale": np.array([1.0, 1.0])}, "is for other ranges: its input_scale is [1.0, 1.0], and that of the"),
    ({"input_names": None}, "has no array input_names: save it with **env.policy_arrays()"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG_POLICIES, ids=[message[:40] for _, message in WRONG_POLICIES])
def test_policy_for_another_environment_is_refused(changes: dict[str, Any], message: str, tmp_path: Path) -> None:
    with hosted_env(observation=["light", "photosensors[1]"]) as env:
        arrays = {name: array for name, array in (env.policy_arrays() | changes).items() if array is not None}
        np.savez(tmp_path / "policy.npz", **arrays)
        for policy in (arrays, tmp_path / "policy.npz"):
            with pytest.raises(pogosim.ConfigurationError) as error:
                env.check_policy(policy)
            assert message in refusal(error)


def test_file_that_is_no_policy_is_refused(tmp_path: Path) -> None:
    (tmp_path / "text.npz").write_text("weights")
    np.save(tmp_path / "one.npy", np.zeros(2))
    with hosted_env() as env:
        for name, message in (
            ("text.npz", "is damaged, or no .npz file of NumPy"),
            ("one.npy", "is damaged, or no .npz file of NumPy"),
            ("none.npz", "cannot be read: No such file or directory"),
        ):
            with pytest.raises(pogosim.ConfigurationError) as error:
                env.check_policy(tmp_path / name)
            assert f"{name} {message}" in refusal(error)


@pytest.mark.parametrize("first", [GymnasiumEnv, GymnasiumVectorEnv, PettingZooEnv])
@pytest.mark.parametrize("second", [GymnasiumEnv, GymnasiumVectorEnv, PettingZooEnv])
def test_environment_has_one_interface(first: Any, second: Any) -> None:
    with hosted_env() as env:
        with pytest.raises(pogosim.ConfigurationError, match="render_mode"):
            first(env, render_mode="ansi")
        assert (env.interface, env.autoreset) == ("", "NextStep")  # one that was refused drives nothing
        first(env)
        with pytest.raises(pogosim.ConfigurationError) as error:
            second(env)
        assert refusal(error) == f"env: a {first.__name__} drives this SwarmEnv: make another one"


def test_interfaces_refuse_environments_that_they_cannot_be_of() -> None:
    with hosted_env(runs=2) as two, hosted_env() as one:
        for make, message in (
            (lambda: GymnasiumEnv(two), "env: expected a SwarmEnv with runs=1, found 2: use GymnasiumVectorEnv"),
            (lambda: PettingZooEnv(two), "env: expected a SwarmEnv with runs=1, found 2"),
            (lambda: GymnasiumEnv(3), "env: expected a SwarmEnv, found 3"),  # type: ignore[arg-type]
            (lambda: GymnasiumVectorEnv(3), "env: expected a SwarmEnv, found 3"),  # type: ignore[arg-type]
            (lambda: GymnasiumEnv(one, each="robot"), "each='robot': expected one robot 'robots', found 3: use Petti"),
            (lambda: GymnasiumVectorEnv(two, each="swarm"), "each: expected 'run' or 'robot', found 'swarm'"),
            (lambda: GymnasiumEnv(one, render_mode="ansi"), "render_mode: expected None, 'rgb_array' or 'human'"),
        ):
            with pytest.raises(pogosim.ConfigurationError) as error:
                make()
            assert message in refusal(error)
        envs = GymnasiumVectorEnv(two)
        for mask, message in (
            (np.array([True, False, True, True, True, True]), "options['reset_mask']: robots of a run begin together"),
            ([True] * 6, "options['reset_mask']: expected an array of 6 booleans, found"),
        ):
            with pytest.raises(pogosim.ConfigurationError) as error:
                envs.reset(options={"reset_mask": mask})
            assert message in refusal(error)


@pytest.mark.parametrize(
    ("observation", "said"),
    [
        (
            ["photosensors", "photosensors[0]"],
            "observation: 'photosensors[0]' is there twice; expected each number once",
        ),
        (["photosensors[1]", "messages", "photosensors"], "observation: 'photosensors[1]' is there twice; expected "),
    ],
)
def test_a_number_is_observed_once(observation: list[str], said: str) -> None:
    with pytest.raises(pogosim.ConfigurationError, match=re.escape(said)):
        hosted_env(observation=observation)
