"""`pogosim.learning` has the interfaces of Gymnasium and PettingZoo, as their own checkers understand them."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import FlattenObservation, RecordEpisodeStatistics
from pettingzoo.test import parallel_api_test, parallel_seed_test
from pogosim.learning import GymnasiumEnv, GymnasiumVectorEnv, PettingZooEnv, SwarmEnv
from swarm_envs import ROBOTS, hosted_env

RANDOMIZE = {"objects.robots.linear_noise_stddev": [0, 0.3]}


@pytest.fixture(autouse=True)
def _no_remarks() -> Iterator[None]:
    """Gymnasium would like to know more: it warns of environments that are not registered, and of pictures."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*not have a spec|.*render")
        yield


def env_of(changes: dict[str, Any] | None = None, **options: Any) -> SwarmEnv:
    usual = {"observation": ["photosensors", "messages"], "actions": ["motors", "message(2)"], "end": 0.5}
    return hosted_env(changes, **(usual | {"reward": "light / 1000", "randomize": RANDOMIZE} | options))


@pytest.mark.parametrize(("each", "robots"), [("run", ROBOTS), ("robot", 1)])
def test_environment_of_gymnasium_passes_its_check(each: str, robots: int) -> None:
    env = GymnasiumEnv(env_of({"objects.robots.nb": robots}), each)
    check_env(env)
    shape = (7,) if each == "robot" else (robots, 7)
    assert env.observation_space.shape == shape
    assert env.metadata["render_fps"] == 10
    env.close()


def test_environment_of_gymnasium_can_be_registered() -> None:
    gymnasium.register("pogosim/Test-v0", entry_point=lambda **options: GymnasiumEnv(env_of(**options)))
    env = gymnasium.make("pogosim/Test-v0", end=0.3)
    env.reset(seed=1)
    env.action_space.seed(1)
    assert [env.step(env.action_space.sample())[3] for _ in range(3)] == [False, False, True]
    env.close()


def test_environment_of_pettingzoo_passes_its_checks(capsys: pytest.CaptureFixture[str]) -> None:
    env = PettingZooEnv(env_of())
    parallel_api_test(env, num_cycles=25)
    env.close()
    parallel_seed_test(lambda: PettingZooEnv(env_of()), num_cycles=25)
    assert "Passed Parallel API test" in capsys.readouterr().out


def test_agents_of_pettingzoo_are_the_robots_of_the_run() -> None:
    env = PettingZooEnv(env_of())
    first, infos = env.reset(seed=3)
    with env_of(autoreset="Disabled") as arrays:
        observation, info = arrays.reset(seed=3)
        assert infos["robot_2"]["seed"] == info["seed"][0]
        assert np.array_equal([first[agent] for agent in env.agents], observation[0])
        actions = np.random.default_rng(1).uniform(-1, 1, (ROBOTS, 4))
        for step in range(5):
            seen, rewards, terminated, truncated, _ = env.step(dict(zip(env.possible_agents, actions, strict=True)))
            observation, reward, *_ = arrays.step(actions[None])
            assert np.array_equal(list(seen.values()), observation[0])
            assert list(rewards.values()) == reward[0].tolist()
            assert not any(terminated.values())
            assert list(truncated.values()) == [step == 4] * ROBOTS
    assert env.agents == []
    assert env.step({}) == ({}, {}, {}, {}, {})
    env.reset()
    for wrong in ({"robot_0": actions[0]}, None, [1]):
        with pytest.raises(ValueError, match="actions: expected a map from each of the agents robot_0, robot_1, rob"):
            env.step(wrong)  # type: ignore[arg-type]
    env.close()


@pytest.mark.parametrize("mode", list(AutoresetMode), ids=lambda mode: mode.name)
def test_vector_environment_does_what_that_of_gymnasium_does_with_single_ones(mode: AutoresetMode) -> None:
    theirs = SyncVectorEnv([lambda: GymnasiumEnv(env_of()) for _ in range(3)], autoreset_mode=mode)
    ours = GymnasiumVectorEnv(env_of(runs=3, autoreset=mode), each="run")
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert ours.metadata["autoreset_mode"] == theirs.metadata["autoreset_mode"]
    assert data_equivalence(theirs.reset(seed=5), ours.reset(seed=5), exact=True)
    ours.action_space.seed(1)
    for _ in range(13):
        actions = ours.action_space.sample()
        *expected, expected_infos = theirs.step(actions)
        *found, infos = ours.step(actions)
        assert data_equivalence(expected, found, exact=True)
        assert data_equivalence(expected_infos, infos)
        is_over = found[2] | found[3]
        if mode is AutoresetMode.DISABLED and is_over.any():
            mask = {"reset_mask": is_over}
            assert data_equivalence(theirs.reset(options=dict(mask)), ours.reset(options=dict(mask)), exact=True)
    theirs.close()
    ours.close()


def test_robots_of_all_runs_are_environments_of_their_own() -> None:
    envs = GymnasiumVectorEnv(env_of(runs=2, autoreset="SameStep"))
    assert (envs.num_envs, envs.single_observation_space.shape) == (2 * ROBOTS, (7,))
    with env_of(runs=2, autoreset="SameStep") as arrays:
        first, infos = envs.reset(seed=1)
        observation, info = arrays.reset(seed=1)
        assert np.array_equal(first, observation.reshape(-1, 7))
        assert np.array_equal(infos["seed"], np.repeat(info["seed"], ROBOTS))
        envs.action_space.seed(1)
        for step in range(6):
            actions = envs.action_space.sample()
            seen, rewards, terminated, truncated, infos = envs.step(actions)
            observation, reward, ends, _, info = arrays.step(actions.reshape(2, ROBOTS, 4))
            assert np.array_equal(seen, observation.reshape(-1, 7))
            assert np.array_equal(rewards, reward.ravel())
            assert np.array_equal(terminated, np.repeat(ends, ROBOTS))
            assert ("final_obs" in infos) == truncated.all() == (step == 4)
            if step == 4:
                assert np.array_equal(np.stack(infos["final_obs"]), info["final_obs"].reshape(-1, 7))
    envs.close()


def test_wrappers_of_gymnasium_work() -> None:
    envs = RecordEpisodeStatistics(FlattenObservation(GymnasiumVectorEnv(env_of(runs=2), each="run")))
    envs.reset(seed=1)
    envs.action_space.seed(1)
    for _ in range(5):
        observation, *_, infos = envs.step(envs.action_space.sample())
    assert observation.shape == (2, ROBOTS * 7)
    assert infos["episode"]["l"].tolist() == [5, 5]
    envs.close()


def test_pictures_are_those_of_the_runs() -> None:
    single = GymnasiumEnv(env_of(), render_mode="rgb_array")
    single.reset(seed=1)
    picture = single.render()
    assert picture is not None
    assert np.array_equal(picture, single.swarm_env.runs[0].render())
    many = GymnasiumVectorEnv(env_of(runs=2), render_mode="rgb_array")
    many.reset(seed=1)
    pictures = many.render()
    assert pictures is not None
    assert np.array_equal(pictures[0], picture)
    assert len(pictures) == 2
    for env in (GymnasiumEnv(env_of()), PettingZooEnv(env_of()), GymnasiumVectorEnv(env_of())):
        assert env.render() is None
        env.close()
    single.close()
    many.close()


def test_person_sees_the_run_in_real_time(monkeypatch: pytest.MonkeyPatch) -> None:
    import urllib.request

    opened: list[str] = []
    waits_s: list[float] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    clock = SimpleNamespace(monotonic=lambda: 5.0 + sum(waits_s), sleep=waits_s.append)
    monkeypatch.setattr("pogosim.learning.human_view.time", clock)
    env = GymnasiumEnv(env_of(end=1.0), render_mode="human")
    env.reset(seed=1)
    for _ in range(4):
        env.step(np.zeros((ROBOTS, 4), np.float32))
    assert waits_s == pytest.approx([0.1] * 4)
    waits_s.append(0.25)  # the learner takes its time
    for _ in range(2):
        env.step(np.zeros((ROBOTS, 4), np.float32))
    assert waits_s[-2:] == pytest.approx([0.0, 0.1])
    env.reset()
    (address,) = opened
    with urllib.request.urlopen(address) as page:
        assert b"Pogosim" in page.read()
    env.close()
