"""The environments of examples/learning are as Gymnasium and PettingZoo expect, and policies can be learnt in them."""

from __future__ import annotations

import math
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from commanded_robots import OBSERVATIONS
from gym_env import LightSeeker
from gymnasium.utils.env_checker import check_env
from parallel_env import Gathering
from pettingzoo.test import parallel_api_test, parallel_seed_test
from pogosim.extras import installing
from running import ROOT, example, run
from train import TASKS, Learnt, Trainer, figure_of, learn, linear, main

LEFT, RIGHT = np.array([0.0, 1.0], np.float32), np.array([1.0, 0.0], np.float32)


@pytest.fixture(autouse=True)
def _simulator_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


@pytest.fixture
def seeker() -> Iterator[LightSeeker]:
    """One robot that looks for light."""
    env = LightSeeker(episode_steps=20)
    yield env
    env.close()


def test_light_seeker_is_an_environment_of_gymnasium(seeker: LightSeeker) -> None:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*not have a spec|.*render")
        check_env(seeker)


def test_gathering_is_an_environment_of_pettingzoo(capsys: pytest.CaptureFixture[str]) -> None:
    env = Gathering(robots=3, episode_steps=10)
    parallel_api_test(env, num_cycles=25)
    env.close()
    parallel_seed_test(lambda: Gathering(robots=3, episode_steps=10), num_cycles=25)
    assert "Passed Parallel API test" in capsys.readouterr().out


def test_warning_of_several_environments_is_passed_on_once(caplog: pytest.LogCaptureFixture) -> None:
    envs = [LightSeeker() for _ in range(3)]
    for env in envs:
        env._robots._settings["parameters.never_there"] = 1
        env.reset(seed=1)
        env.close()
    assert caplog.text.count("never_there") == 1


def test_equal_seeds_give_equal_episodes_and_others_do_not(seeker: LightSeeker) -> None:
    def episode(seed: int) -> list[float]:
        first, _ = seeker.reset(seed=seed)
        seeker.action_space.seed(1)
        steps = [seeker.step(seeker.action_space.sample()) for _ in range(20)]
        assert [step[3] for step in steps] == [False] * 19 + [True]
        return [*first, *(value for step in steps for value in (*step[0], step[1]))]

    assert episode(1) == episode(1) != episode(2)


def placed(seeker: LightSeeker, x_mm: float, heading_rad: float) -> pogosim.Simulation:
    seeker.reset(seed=3)
    simulation = seeker._robots.simulation
    assert simulation is not None
    simulation.set_pose(0, x_mm, 564.0, heading_rad)
    return simulation


def test_actions_are_motor_powers(seeker: LightSeeker) -> None:
    for action, turned_rad, ahead_mm in ((RIGHT, 4.0, None), (LEFT, -4.0, None), (RIGHT + LEFT, 0.0, 100.0)):
        simulation = placed(seeker, 400.0, 0.0)
        for _ in range(5):
            seeker.step(action)
        error_rad = float(simulation.headings[0]) - turned_rad
        assert math.remainder(error_rad, 2.0 * math.pi) == pytest.approx(0.0, abs=0.4)
        if ahead_mm is not None:
            assert float(simulation.positions[0, 0]) == pytest.approx(400.0 + ahead_mm, abs=10.0)


WRONG: list[Any] = [
    None,
    0.5,
    [0],
    [1, 2, 3],
    [[1, 2]],
    [np.nan, 0],
    [0, np.inf],
    [1e300, 0],
    "ab",
    ["a", "b"],
    [None, 1],
    [1j, 0],
    {},
]


@pytest.mark.parametrize("action", WRONG, ids=repr)
def test_action_that_is_no_two_numbers_is_refused_and_nothing_moves(seeker: LightSeeker, action: Any) -> None:
    seeker.reset(seed=1)
    simulation = seeker._robots.simulation
    assert simulation is not None
    message = "the action of robot 0: expected the powers of the left motor and of the right motor, finite numbers from"
    with pytest.raises(ValueError, match=message):
        seeker.step(action)
    assert simulation.steps == 0
    seeker.step(RIGHT)
    assert simulation.steps == 20


def test_actions_of_a_swarm_are_those_of_its_agents() -> None:
    env = Gathering(robots=2)
    env.reset(seed=1)
    wrong: list[tuple[Any, str]] = [
        ({"robot_0": [1, 0], "robot_1": [np.nan, 0]}, "the action of robot 1: .*found \\[nan, 0]"),
        ({"robot_0": [1, 0], "robot_1": [1]}, "the action of robot 1: .*found \\[1]"),
        ({"robot_0": None, "robot_1": [1, 0]}, "the action of robot 0: .*found None"),
        ({"robot_0": [1, 0]}, "from each of the agents robot_0, robot_1, found robot_0"),
        ({"robot_0": [1, 0], "robot_1": [1, 0], "robot_2": [1, 0]}, "found robot_0, robot_1, robot_2"),
        ([[1, 0], [1, 0]], "found \\[\\["),
        (None, "found None"),
    ]
    for actions, message in wrong:
        with pytest.raises(ValueError, match=message):
            env.step(actions)
    assert env._robots.simulation is not None
    assert env._robots.simulation.steps == 0
    env.close()


def test_robots_see_where_the_lamp_is(seeker: LightSeeker) -> None:
    """It is 400 mm to the right of the robot, in the picture."""
    ahead, right = (OBSERVATIONS.index(name) for name in ("light ahead", "light to the right"))
    for heading_rad, signs in ((0.0, (1, 0)), (np.pi, (-1, 0)), (-np.pi / 2, (0, 1)), (np.pi / 2, (0, -1))):
        placed(seeker, 400.0, heading_rad)
        observation = seeker.step(np.zeros(2, np.float32))[0]
        assert [0 if abs(side) < 0.2 else np.sign(side) for side in observation[[ahead, right]]] == list(signs)
        assert observation[0] == pytest.approx(30000 / 32767 * (1 - 400 / 900), abs=0.03)


def test_robots_that_are_near_each_other_hear_each_other_and_are_rewarded() -> None:
    env = Gathering(robots=2)
    env.reset(seed=1)
    still = {agent: np.zeros(2, np.float32) for agent in env.agents}
    simulation = env._robots.simulation
    assert simulation is not None
    simulation.set_pose(0, 500.0, 500.0, 0.0)
    simulation.set_pose(1, 600.0, 500.0, 0.0)
    for _ in range(10):
        observations, rewards, *_ = env.step(still)
    assert rewards == pytest.approx({agent: np.exp(-0.5) for agent in env.agents}, abs=0.01)
    heard = {agent: OBSERVATIONS[3 + int(np.argmax(values[3:]))] for agent, values in observations.items()}
    assert heard == {"robot_0": "heard in front", "robot_1": "back"}
    simulation.set_pose(1, 900.0, 500.0, 0.0)
    for _ in range(10):
        observations, rewards, *_ = env.step(still)
    assert rewards["robot_0"] == pytest.approx(np.exp(-2.0), abs=0.01)
    assert observations["robot_0"][3:].max() < 0.05
    env.close()


def trained(threads: int) -> Learnt:
    with Trainer(TASKS["light"], threads, episode_steps=50) as trainer:
        return learn(trainer, generations=4, candidates=8)


def test_a_few_generations_are_better_than_chance_whatever_the_threads() -> None:
    found = trained(threads=2)
    assert found.curve.shape == (5, 10)
    assert found.curve[-1].mean() > found.by_chance.mean() + 2.0
    assert found.by_hand.mean() > found.by_chance.mean() + 2.0
    again = trained(threads=1)
    assert np.array_equal(found.curve, again.curve)
    assert np.array_equal(found.by_chance, again.by_chance)
    assert len(figure_of({"light": found}).axes[0].lines) == 3


def test_robots_with_the_weights_do_without_python(tmp_path: Path) -> None:
    """The policy of the program is the one of train.py: robots of both gather at the lamp."""
    weights = list(TASKS["light"].by_hand)
    settings = {
        "simulation_time": 20.0,
        "objects.robots.nb": 6,
        "objects.lamp": {
            "type": "static_light", "light_mode": "gradient", "geometry": "disk", "radius": 1200.0,
            "x": 800.0, "y": 564.0, "value": 30000, "edge_value": 0, "gradient_radius": 900.0,
        },
    }  # fmt: skip
    bright = run(example("learning"), tmp_path / "policy", {**settings, "parameters.policy": weights}).frame()
    still = run(example("learning"), tmp_path / "still", {**settings, "parameters.policy": [0.0] * 16}).frame()
    assert bright["light"].iloc[-6:].mean() > 0.75 > 0.6 > still["light"].iloc[-6:].mean()
    actions = linear(np.array(weights))(np.array([[0.5, 0.1, 0.25, 0, 0, 0, 0]]))
    assert actions.tolist() == [[0.75, 0.25]]


def test_policy_with_too_few_weights_is_refused(tmp_path: Path) -> None:
    result = run(example("learning"), tmp_path, {"parameters.policy": [1.0, 2.0]})
    assert result.code == 2
    assert len(result.errors.splitlines()) == 1
    assert "parameters.policy" in result.errors


def test_command_line_refuses_what_it_does_not_know(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, message in (
        (["flight"], "no task is called flight; there are light, gathering"),
        (["-g", "0"], "expected integers from 1 on"),
    ):
        with pytest.raises(SystemExit, match="2"):
            main(arguments)
        assert message in capsys.readouterr().err


def test_missing_packages_are_named_with_how_to_install_them(tmp_path: Path) -> None:
    for package in ("gymnasium", "pettingzoo"):
        folder = tmp_path / package
        folder.mkdir()
        (folder / f"{package}.py").write_text("raise ImportError\n")
        code = f"import runpy, sys; sys.path.insert(0, {str(folder)!r}); sys.argv = ['train.py']; "
        code += f"sys.path.insert(0, {str(ROOT / 'examples/learning')!r}); "
        code += f"runpy.run_path({str(ROOT / 'examples/learning/train.py')!r}, run_name='__main__')"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        advice = f"this environment needs the Python package '{package}'; install it: {installing('learning')}"
        assert done.stderr == f"train.py: {advice}\n"
