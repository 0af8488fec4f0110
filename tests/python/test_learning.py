"""The environments of examples/learning are as their page says, and policies can be learnt in them."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pogosim
import pytest
from environments import OBSERVATIONS, gathering, light_seeker
from pogosim.extras import installing
from pogosim.learning import SwarmEnv
from running import ROOT, example, run
from train import TASKS, Learnt, figure_of, learn, linear, main

LEFT, RIGHT = np.array([[[1.0, 0.0]]]), np.array([[[0.0, 1.0]]])  # where the robot turns


@pytest.fixture
def seeker() -> Iterator[SwarmEnv]:
    """One robot that looks for light."""
    with light_seeker() as env:
        yield env


def placed(seeker: SwarmEnv, x_mm: float, heading_rad: float) -> pogosim.Simulation:
    seeker.reset(seed=3)
    simulation = seeker.runs[0]
    simulation.set_pose(0, x_mm, 564.0, heading_rad)
    return simulation


def test_actions_are_motor_powers(seeker: SwarmEnv) -> None:
    for action, turned_rad, ahead_mm in ((RIGHT, 4.0, None), (LEFT, -4.0, None), (RIGHT + LEFT, 0.0, 100.0)):
        simulation = placed(seeker, 400.0, 0.0)
        for _ in range(5):
            seeker.step(action)
        error_rad = float(simulation.headings[0]) - turned_rad
        assert math.remainder(error_rad, 2.0 * math.pi) == pytest.approx(0.0, abs=0.4)
        if ahead_mm is not None:
            assert float(simulation.positions[0, 0]) == pytest.approx(400.0 + ahead_mm, abs=10.0)


def test_robots_see_where_the_lamp_is(seeker: SwarmEnv) -> None:
    """It is 400 mm to the right of the robot, in the picture."""
    ahead, right = (OBSERVATIONS.index(name) for name in ("light ahead", "light to the right"))
    for heading_rad, signs in ((0.0, (1, 0)), (np.pi, (-1, 0)), (-np.pi / 2, (0, 1)), (np.pi / 2, (0, -1))):
        placed(seeker, 400.0, heading_rad)
        observation, reward, *_ = seeker.step(np.zeros((1, 1, 2)))
        seen = observation[0, 0]
        assert [0 if abs(side) < 0.2 else np.sign(side) for side in seen[[ahead, right]]] == list(signs)
        assert seen[0] == pytest.approx(30000 / 32767 * (1 - 400 / 900), abs=0.03)
        assert reward[0, 0] == pytest.approx(1 - 400 / 900, abs=0.01)


def test_robots_that_are_near_each_other_hear_each_other_and_are_rewarded() -> None:
    still = np.zeros((1, 2, 2))
    with gathering(robots=2) as env:
        env.reset(seed=1)
        simulation = env.runs[0]
        simulation.set_pose(0, 500.0, 500.0, 0.0)
        simulation.set_pose(1, 600.0, 500.0, 0.0)
        for _ in range(10):
            observation, reward, *_ = env.step(still)
        assert reward[0] == pytest.approx(np.exp([-0.5, -0.5]), abs=0.01)
        heard = [OBSERVATIONS[3 + int(np.argmax(values[3:]))] for values in observation[0]]
        assert heard == ["heard in front", "back"]
        simulation.set_pose(1, 900.0, 500.0, 0.0)
        for _ in range(10):
            observation, reward, *_ = env.step(still)
        assert reward[0, 0] == pytest.approx(np.exp(-2.0), abs=0.01)
        assert observation[0, 0, 3:].max() < 0.05


def trained(threads: int) -> Learnt:
    return learn(TASKS["light"], generations=4, candidates=8, end=10.0, threads=threads)


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
    actions = linear(np.array(weights))(np.array([[[0.5, 0.1, 0.25, 0, 0, 0, 0]]]))
    assert actions.tolist() == [[[0.25, 0.75]]]


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


def test_each_run_may_have_weights_of_its_own() -> None:
    weights = np.random.default_rng(1).normal(size=(3, 16))
    observations = np.random.default_rng(2).normal(size=(3, 4, 7))
    together = linear(weights)(observations)
    alone = [linear(weights[run])(observations[run : run + 1])[0] for run in range(3)]
    assert together == pytest.approx(np.array(alone))


@pytest.mark.parametrize(("package", "name"), [("gymnasium", "GymnasiumVectorEnv"), ("pettingzoo", "PettingZooEnv")])
def test_missing_package_is_named_with_how_to_install_it(package: str, name: str, tmp_path: Path) -> None:
    (tmp_path / f"{package}.py").write_text("raise ImportError\n")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r})\nfrom pogosim.learning import SwarmEnv, {name}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 1
    advice = f"this environment needs the Python package '{package}'; install it: {installing('learning')}"
    assert done.stderr.splitlines()[-1] == f"ImportError: {advice}"
