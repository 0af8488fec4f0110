"""`pogosim.learning.SwarmEnv`: what policies see and do, what they get, and when episodes begin and end."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from pogosim.learning import Quantity, SwarmArrays, SwarmEnv
from pogosim.utils import load_dataframe
from running import example, scene, write_scene
from swarm_envs import ROBOTS, SETTINGS, any_actions, are_equal, history, hosted_env

EXACT = {"objects.robots.linear_noise_stddev": 0.0, "objects.robots.angular_noise_stddev": 0.0}


def placed(*poses: list[float]) -> dict[str, Any]:
    """Return changes of the scene: robots without noise, in these poses."""
    return EXACT | {"objects.robots.nb": None, "objects.robots.poses": list(poses)}


def test_observation_is_what_the_brain_of_a_single_run_measures(tmp_path: Path) -> None:
    names = ("photosensors", "acceleration", "angular_velocity", "battery_mv")
    observation = [Quantity(name, -1e5, 1e5, is_scaled=False) for name in names]
    with hosted_env(observation=observation, runs=2) as env:
        seen = history(env, 5, 4)
        seeds = env.reset(seed=5)[1]["seed"]
        actions = [any_actions(env, step) for step in range(4)]
    assert env.inputs[-2:] == ("angular_velocity[2]", "battery_mv")
    path = write_scene(tmp_path, SETTINGS | {"objects.robots.brain": "host", "enable_data_logging": False})
    for run, seed in enumerate(seeds.tolist()):
        with pogosim.Simulation(None, path, seed=seed, set={"simulation_time": 1.1}) as sim:
            brain = sim.brain("robots")
            for step in range(4):
                brain.motors[:, :2] = np.rint(1023 * actions[step][run].astype(np.float32))
                sim.step(10)
                columns = [getattr(brain, name).reshape(ROBOTS, -1) for name in names]
                assert np.array_equal(np.hstack(columns).astype(np.float32), seen[1 + 5 * step][run])


def test_scaled_numbers_are_linear_from_minus_one_to_one_and_cut() -> None:
    with hosted_env(observation=[("x", 400, 800), Quantity("y", 0, 600, is_scaled=False)]) as env:
        env.reset(seed=1)
        for robot, place in enumerate(((400, 250), (700, 550), (900, 700))):
            env.runs[0].set_pose(robot, *map(float, place))
        observation, *_ = env.step(np.zeros((1, ROBOTS, 2)))
        assert observation[0] == pytest.approx(np.array([[-1, 250], [0.5, 550], [1, 600]]), abs=0.01)
        assert (env.observation_low.tolist(), env.observation_high.tolist()) == ([-1, 0], [1, 600])


def test_robot_at_full_power_gets_its_speed() -> None:
    with hosted_env(placed([500, 500, 0]), reward="speed / 100", end=5.0) as env:
        env.reset(seed=1)
        begin = env.swarm.positions[0, 0].copy()
        rewards = [env.step(np.ones((1, 1, 2)))[1][0, 0] for _ in range(20)]
        way_mm = np.hypot(*(env.swarm.positions[0, 0] - begin))
    assert rewards[-1] == pytest.approx(1.0, abs=0.01)
    assert 10 * sum(rewards) == pytest.approx(way_mm, rel=0.05)  # 0.1 s each


def test_actions_are_cut_scaled_and_rounded() -> None:
    actions = [("motors", -1023, 1023), "back_motor", Quantity("leds", 0, 255, is_scaled=False)]
    with hosted_env(actions=actions) as env:
        env.reset(seed=1)
        wanted = np.zeros((1, ROBOTS, 2 + 1 + 15))
        wanted[0, 0, :3] = [0.5, -7, 2]
        wanted[0, 0, 3:] = np.arange(15) + 0.4
        env.step(wanted)
        brain = env.runs.brain("robots")
        assert brain.motors[0, 0].tolist() == [512, -1023, 1023]
        assert brain.leds[0, 0].ravel().tolist() == list(range(15))
        assert np.array_equal(env.swarm.leds[0, 0], brain.leds[0, 0])


def test_messages_are_heard_with_the_mean_of_their_bytes() -> None:
    with hosted_env(
        placed([500, 500, 0], [600, 500, 0]),
        observation=["messages", Quantity("message(3)", 0, 255, is_scaled=False)],
        actions=[Quantity("message(2)", 0, 255, is_scaled=False)],
        runs=2,
    ) as env:
        env.reset(seed=1)
        for step in range(5):
            sent = np.random.default_rng(step).integers(0, 256, (2, 2, 2))
            observation, *_ = env.step(sent)
            assert np.array_equal(observation[..., 4:6], sent[:, ::-1])
            assert not observation[..., 6].any()  # messages have two bytes
            heard = (observation[..., :4] + 1) * 10
            assert heard.sum(axis=-1) == pytest.approx(np.ones((2, 2)))
            assert heard[:, 0, 0] == pytest.approx(np.ones(2))  # the other is in front
            assert heard[:, 1, 2] == pytest.approx(np.ones(2))  # behind


def test_payload_is_the_mean_over_the_messages_of_all_neighbours() -> None:
    changes = placed([500, 500, 0], [600, 500, 0], [500, 600, 0])
    observation = [Quantity("message(1)", 0, 255, is_scaled=False)]
    with hosted_env(changes, observation=observation, actions=["message(1)"]) as env:
        env.reset(seed=1)
        seen = env.step(np.array([[[-1.0], [1.0], [0.2]]]))[0]
    assert seen[0, 0, 0] == pytest.approx((255 + 153) / 2)  # one in front, one at the right


def test_column_that_is_observed_is_that_of_the_data_file(tmp_path: Path) -> None:
    data = tmp_path / "data.feather"
    with SwarmEnv(
        example("learning"),
        scene(SETTINGS),
        observation=[Quantity("column.light", 0, 1, is_scaled=False), ("user_data.observation", -1, 1)],
        actions=[("user_data.action", -1, 1)],
        reward="column.light",
        end=2.0,
        decision_s=0.2,
        set={"data_filename": str(data), "parameters.is_commanded": True},
    ) as env:
        env.reset(seed=4)
        seen, rewards = [], []
        for step in range(9):
            observation, reward, *_ = env.step(any_actions(env, step))
            seen.append(observation[0, :, 0].copy())
            rewards.append(reward[0])
            assert np.array_equal(observation[0, :, 1:], env.runs[0].user_data["observation"])
    rows = load_dataframe(data)[0].pivot(index="time", columns="robot_id", values="light")
    assert rows.index[1:10].to_numpy() == pytest.approx(0.2 * np.arange(1, 10))
    assert np.array_equal(rows.to_numpy(np.float32)[1:10], np.array(seen))
    assert np.array_equal(np.array(rewards, dtype=np.float32), np.array(seen))
    assert len(np.unique(seen)) > 5


def test_rows_are_recorded_only_if_a_column_is_used() -> None:
    options: dict[str, Any] = {"observation": [("user_data.observation", -1, 1)], "end": 1.0}
    options |= {"actions": [("user_data.action", -1, 1)]}
    for reward, is_recorded in (("light", False), ("column.light", True)):
        with SwarmEnv(example("learning"), scene(SETTINGS), reward=reward, **options) as env:
            env.reset(seed=1)
            assert bool(env.runs[0].columns) == is_recorded


def test_runs_write_no_data_file_unless_a_column_is_used(tmp_path: Path) -> None:
    options: dict[str, Any] = {"observation": [("user_data.observation", -1, 1)], "end": 1.0}
    options |= {"actions": [("user_data.action", -1, 1)], "set": {"data_filename": str(tmp_path / "data.feather")}}
    for reward, is_written in (("light", False), ("column.light", True)):
        with SwarmEnv(example("learning"), scene(SETTINGS), reward=reward, **options) as env:
            env.reset(seed=1)
        assert (tmp_path / "data.feather").exists() == is_written


def hosted_program_env(hosted: Path, **options: Any) -> SwarmEnv:
    usual = {"observation": [("user_data.gain", 0, 100)], "actions": [("parameters.gain", 0, 4)], "reward": "x"}
    return SwarmEnv(hosted, scene(SETTINGS), **(usual | {"end": 1.0} | options))


def test_parameter_is_the_mean_of_what_the_robots_ask_for(hosted: Path) -> None:
    observation = [Quantity("user_data.gain", 0, 100, is_scaled=False)]
    with hosted_program_env(hosted, observation=observation, runs=2) as env:
        env.reset(seed=1)
        seen = env.step(np.array([[[0.0], [0.5], [-0.5]], [[1.0], [1.0], [-1.0]]]))[0]
        assert seen[..., 0] == pytest.approx(np.repeat([[2.0], [8 / 3]], ROBOTS, axis=1))


def test_members_of_user_data_are_read_and_written(hosted: Path) -> None:
    observation = [("user_data.estimate.mean", 0, 1), "user_data.estimate.known", ("user_data.levels", -8, 8)]
    actions = [("user_data.levels", -10, 10), ("user_data.estimate.mean", 0, 1)]
    with hosted_program_env(hosted, observation=observation, actions=actions, runs=2) as env:
        first = env.reset(seed=1)[0]
        assert first[0, 0].tolist() == [0.0, 1.0, 0.0, -0.375, 0.0]
        seen = env.step(np.tile([0.26, -0.5, 1.0, -1.0], (2, ROBOTS, 1)))[0]
        assert seen[1, 2].tolist() == [-1.0, 1.0, 0.375, -0.625, 1.0]
        assert env.runs[1].user_data["levels"].tolist() == [[3, -5, 10]] * ROBOTS


def test_program_that_ends_its_run_terminates_the_episode(hosted: Path) -> None:
    with hosted_program_env(hosted, set={"parameters.fail_at_tick": 20, "parameters.failure": "success"}) as env:
        env.reset(seed=1)
        ends = [env.step(np.zeros((1, ROBOTS, 1)))[2:4] for _ in range(4)]
    assert [bool(terminated[0]) for terminated, _ in ends] == [False, False, False, True]
    assert not any(truncated[0] for _, truncated in ends)


def test_program_that_crashes_is_an_error_and_the_environment_goes_on(hosted: Path) -> None:
    with hosted_program_env(hosted, set={"parameters.fail_at_tick": 20}) as env:
        env.reset(seed=1)
        with pytest.raises(pogosim.ProgramFailedError, match=r"run 0: .*segmentation fault"):
            for _ in range(10):
                env.step(np.zeros((1, ROBOTS, 1)))
        env.reset(seed=1)
        env.step(np.zeros((1, ROBOTS, 1)))


def test_equal_seeds_give_equal_bytes_whatever_the_runs_and_threads() -> None:
    randomize = {"objects.robots.linear_noise_stddev": [0, 0.3]}
    options: dict[str, Any] = {"randomize": randomize, "end": 0.5}
    with hosted_env(runs=3, threads=2, **options) as env:
        first, again, other = (history(env, seed, 12) for seed in (7, 7, 8))
        assert are_equal(first, again)
        assert not are_equal(first, other)
    for run in range(3):
        with hosted_env(threads=1, **options) as env:
            env.reset(seed=7 + run)
            observation = env.reset(seed=7 + run)[0]
            assert np.array_equal(observation[0], first[0][run])
            for step in range(12):
                actions = np.random.default_rng(step).uniform(-1.0, 1.0, (3, ROBOTS, 2))[run : run + 1]
                observation, reward, *_ = env.step(actions)
                assert np.array_equal(observation[0], first[1 + 5 * step][run])
                assert np.array_equal(reward[0], first[2 + 5 * step][run])


def test_seeds_of_each_run_may_be_given() -> None:
    with hosted_env(runs=3, randomize={"objects.robots.linear_noise_stddev": [0, 0.3]}) as env:
        _, info = env.reset(seed=[4, 9, 4])
        assert info["seed"][0] == info["seed"][2] != info["seed"][1]
        drawn = info["randomized"]["objects.robots.linear_noise_stddev"]
        assert drawn[0] == drawn[2] != drawn[1]
        hashes = [sim.state_hash for sim in env.runs]
        assert hashes[0] == hashes[2] != hashes[1]
        _, after = env.reset(seed=[9], which=[2])
        assert after["seed"].tolist() == [info["seed"][0], info["seed"][1], info["seed"][1]]


def test_end_of_an_episode_is_its_time_or_a_condition_or_a_function() -> None:
    still = np.zeros((2, ROBOTS, 2))
    with hosted_env(end=0.35, runs=2, autoreset="Disabled") as env:
        env.reset(seed=1)
        assert [bool(env.step(still)[3].all()) for _ in range(4)] == [False, False, False, True]
        assert env.episode_steps == 4
    for end in (["x > 700 and not y < 100", 5.0], [5.0, lambda swarm: (swarm.positions[..., 0] > 700).any(axis=1)]):
        with hosted_env(end=end, runs=2, autoreset="Disabled") as env:
            env.reset(seed=1)
            for sim in env.runs:
                for robot in range(ROBOTS):
                    sim.set_pose(robot, 300.0 + 100 * robot, 500.0)
            env.runs[1].set_pose(1, 750.0, 500.0)
            _, _, terminated, truncated, _ = env.step(still)
            assert (terminated.tolist(), truncated.tolist()) == ([False, True], [False, False])
    with hosted_env({"simulation_time": 0.55}, end="x < 0") as env:
        assert env.episode_steps == 5


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_autoreset_is_as_gymnasium_says(mode: str) -> None:
    with hosted_env(end=0.3, autoreset=mode, observation=[("x", 0, 1000)]) as env:
        first = env.reset(seed=1)[0].copy()
        seed = env.reset(seed=1)[1]["seed"][0]
        moving = np.ones((1, ROBOTS, 2))
        steps = [env.step(moving) for _ in range(2)]
        _, reward, terminated, truncated, info = env.step(moving)
        assert (terminated.tolist(), truncated.tolist()) == ([False], [True])
        assert not any(step[3][0] for step in steps)
        assert reward.shape == (1, ROBOTS)
        if mode == "SameStep":
            assert not np.array_equal(info["final_obs"], first)
            assert info["final_info"]["seed"][0] == seed != info["seed"][0]
            assert env.runs[0].steps == 0
        else:
            assert "final_obs" not in info
            assert env.runs[0].steps == 30
        if mode == "NextStep":
            _, reward, _, truncated, info = env.step(moving)
            assert (reward.tolist(), truncated.tolist()) == ([[0.0] * ROBOTS], [False])
            assert info["seed"][0] != seed
            assert env.runs[0].steps == 0
        if mode == "Disabled":
            with pytest.raises(pogosim.SimulationError, match="episode of run 0 is over: reset it"):
                env.step(moving)
            env.reset()
        assert env.step(moving)[3].tolist() == [False]


def test_only_runs_that_are_over_begin_anew_and_the_others_go_on() -> None:
    ends = lambda swarm: swarm.time_s == [0.2, 0.3]  # noqa: E731
    with hosted_env(end=ends, runs=2) as env:
        env.reset(seed=1)
        steps = []
        for step in range(6):
            env.step(any_actions(env, step))
            steps.append([sim.steps for sim in env.runs])
    assert np.array_equal(steps, [[10, 10], [20, 20], [0, 30], [10, 0], [20, 10], [0, 20]])


def test_state_that_was_saved_goes_on_as_it_did() -> None:
    randomize = {"objects.robots.linear_noise_stddev": [0, 0.3]}
    options: dict[str, Any] = {"observation": ["photosensors", "messages"], "actions": ["motors", "message(2)"]}
    with hosted_env(end=0.8, runs=2, randomize=randomize, **options) as env:
        env.reset(seed=1)
        for step in range(5):
            before = env.step(any_actions(env, step))[0].copy()
        state = env.save()

        def after() -> list[Any]:
            found = []
            for step in range(3):  # the third one ends the episodes
                observation, *rest, info = env.step(any_actions(env, step))
                found += [observation.copy(), *rest, info["seed"]]
            return found

        first = after()
        assert np.array_equal(env.restore(state), before)
        assert are_equal(first, after())
        assert first[-2].all()
        env.step(any_actions(env, 0))  # others begin
        with pytest.raises(pogosim.ConfigurationError, match=r"run 0: .*state"):
            env.restore(state)


def test_reward_may_be_a_function_of_all_runs() -> None:
    def reward(swarm: SwarmArrays) -> Any:
        assert swarm["light"].shape == (2, ROBOTS)
        assert swarm["photosensors"].shape == (2, ROBOTS, 3)
        assert np.array_equal(swarm["photosensors[1]"], swarm["photosensors"][..., 1])
        assert swarm.velocities.shape == (2, ROBOTS, 2)
        assert np.array_equal(swarm["angle"], np.arctan2(np.sin(swarm.headings), np.cos(swarm.headings)))
        return -swarm.positions[..., 0].std(axis=1)

    with hosted_env(reward=reward, runs=2) as env:
        env.reset(seed=1)
        found = env.step(any_actions(env, 1))[1]
        expected = -env.runs.positions[..., 0].std(axis=1)
        assert np.array_equal(found, np.repeat(expected[:, None], ROBOTS, axis=1).astype(np.float64))


def test_category_is_a_part_of_the_robots() -> None:
    changes = {"objects.others": {"type": "pogobot", "nb": 2, "brain": "host"}, "objects.robots.nb": 4}
    for category, rows in (("robots", slice(0, 4)), ("others", slice(4, 6))):
        with hosted_env(changes | {"objects.robots.brain": "host"}, category=category, runs=2) as env:
            env.reset(seed=1)
            env.step(any_actions(env, 1))
            order = [env.runs[0].categories[index] for index in env.runs[0].robot_categories]
            own = np.array(order) == category
            assert np.array_equal(env.swarm.positions, env.runs.positions[:, own])
            assert env.swarm["light"].shape == (2, rows.stop - rows.start)


DOMAINS: list[tuple[Any, Any]] = [
    ([0.1, 0.2], lambda value: 0.1 <= value <= 0.2),
    ([0.1, 0.2, 0.3], lambda value: value in (0.1, 0.2, 0.3)),
    ({"type": "float", "min": 1e-3, "max": 1.0, "log": True}, lambda value: 1e-3 <= value <= 1.0),
    ({"type": "int", "min": 0, "max": 2}, lambda value: value in (0, 1, 2)),
    ({"type": "int", "min": 1, "max": 3, "log": True}, lambda value: value in (1, 2, 3)),
    ({"type": "categorical", "choices": [0.5, 0.25]}, lambda value: value in (0.5, 0.25)),
    ({"type": "normal", "mean": 0.5, "stddev": 0.01}, lambda value: abs(value - 0.5) < 0.1),
    (lambda generator: generator.beta(2, 2), lambda value: 0 <= value <= 1),
]


@pytest.mark.parametrize(("domain", "fits"), DOMAINS, ids=[f"domain_{index}" for index in range(len(DOMAINS))])
def test_keys_are_drawn_for_each_episode(domain: Any, fits: Any) -> None:
    key = "objects.robots.linear_noise_stddev"
    with hosted_env(randomize={key: domain}, runs=12) as env:
        drawn = [env.reset(seed=1)[1]["randomized"][key] for _ in range(2)]
        assert np.array_equal(*drawn)
        assert all(map(fits, drawn[0].tolist()))
        assert len(set(drawn[0].tolist())) > 1


def test_robots_are_what_was_drawn() -> None:
    key = "objects.robots.max_linear_speed"
    with hosted_env(placed([500, 500, 0]), randomize={key: [20, 80]}, runs=6, reward="speed", end=5.0) as env:
        drawn = env.reset(seed=1)[1]["randomized"][key]
        for _ in range(20):
            speeds = env.step(np.ones((6, 1, 2)))[1][:, 0]
        assert speeds == pytest.approx(drawn, rel=0.01)
        assert len(set(drawn.tolist())) == 6


def test_domains_are_those_of_searches_and_may_be_of_one_value() -> None:
    from pogosim.learning.randomization import draw_of

    generator = np.random.default_rng(1)
    whole = draw_of("x", {"type": "int", "min": 1, "max": 3, "init": 2})
    assert {whole(generator) for _ in range(60)} == {1, 2, 3}
    chosen = draw_of("x", {"choices": ["a", "b"]})
    assert {chosen(generator) for _ in range(60)} == {"a", "b"}
    assert draw_of("x", [0.2, 0.2])(generator) == 0.2


def test_intervals_are_uniform_and_logarithms_too() -> None:
    from pogosim.learning.randomization import draw_of

    generator = np.random.default_rng(1)
    uniform = draw_of("x", [0.0, 0.3])
    found = np.array([uniform(generator) for _ in range(4000)])
    assert (found.mean(), found.std()) == pytest.approx((0.15, 0.3 / math.sqrt(12)), rel=0.05)
    log = draw_of("x", {"type": "float", "min": 0.01, "max": 100, "log": True})
    assert np.median([log(generator) for _ in range(4000)]) == pytest.approx(1.0, rel=0.2)


def test_drawn_values_may_be_words_and_maps() -> None:
    walls = [{"type": "static", "rate": 0.5}, {"type": "static", "rate": 1.0}]
    randomize = {"initial_formation": ["random", "disk"], "objects.robots.msg_success_rate": walls}
    with hosted_env(randomize=randomize, runs=8) as env:
        drawn = env.reset(seed=2)[1]["randomized"]
    assert set(drawn["initial_formation"].tolist()) == {"random", "disk"}
    assert all(rate in walls for rate in drawn["objects.robots.msg_success_rate"])


def test_configuration_may_be_a_file_or_a_map(tmp_path: Path) -> None:
    found = []
    for configuration in (write_scene(tmp_path, SETTINGS), scene(SETTINGS)):
        with SwarmEnv(
            None, configuration, observation=["photosensors"], actions=["motors"], reward="light", end=1.0
        ) as env:
            found.append(history(env, 1, 3))
    assert are_equal(*found)


def test_temporary_files_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    env = hosted_env()
    assert list(tmp_path.iterdir())
    env.close()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(pogosim.ConfigurationError):
        hosted_env(actions=["motor"])
    assert list(tmp_path.iterdir()) == []


def test_policy_says_what_its_numbers_are(tmp_path: Path) -> None:
    with hosted_env(observation=[("photosensors", 0, 1000), Quantity("light", 0, 2000, is_scaled=False)]) as env:
        arrays = env.policy_arrays()
        assert arrays["input_names"].tolist() == ["photosensors_0", "photosensors_1", "photosensors_2", "light"]
        seen = np.array([0.0, 250.0, 1000.0, 1500.0])
        scaled = (seen - arrays["input_offset"]) * arrays["input_scale"]
        assert scaled == pytest.approx([-1.0, -0.5, 1.0, 1500.0])
        powers = np.array([1, -0.5]) * arrays["output_scale"] + arrays["output_offset"]
        assert powers == pytest.approx([1023, -511.5])
        np.savez(tmp_path / "policy.npz", allow_pickle=False, weights=np.eye(2), **arrays)
        assert np.array_equal(env.check_policy(tmp_path / "policy.npz")["weights"], np.eye(2))
        assert env.check_policy(arrays) is arrays


def test_picture_is_that_of_the_run() -> None:
    with hosted_env(runs=2) as env:
        env.reset(seed=1)
        assert np.array_equal(env.render(1, 60, 40), env.runs[1].render(60, 40))
        assert repr(env) == "<pogosim.learning.SwarmEnv of 2 runs of 3 robots 'robots': 3 inputs, 2 outputs>"
