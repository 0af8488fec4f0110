"""`pogosim.learning.tasks` and learners: scores that are known, policies that improve, and wrong arguments."""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pogosim.learning.learners import cma_es, embodied, map_elites, ppo
from pogosim.learning.learners.running import TEST_EPISODES, Generation, Learner, learn, main
from pogosim.learning.perceptron import perceptron_of
from pogosim.learning.tasks import TASKS, BenchmarkTask, means, scene, scores
from pogosim.policy import Policy
from pogosim.policy.errors import PolicyError
from pogosim.policy.reading import read_policy

STAY: dict[str, Any] = {"end": 0.4, "threads": 1}
# The optimum is known: a red head, 1.
RED = replace(
    TASKS["majority"],
    configuration=scene({"nb": 1}),
    reward=lambda swarm: swarm.leds[:, :, 0, 0] / 255,
    felt=lambda _seen, act: (act[..., 1] + 1) / 2,
    randomize={},
)


def score_of_idle(name: str, poses: list[list[float]], **changes: object) -> float:
    """Return the score of robots that stay in these poses."""
    settings = {"objects.robots.nb": None, "objects.robots.poses": poses, **changes}
    with TASKS[name].make_env(set=settings, **STAY) as env:
        return float(scores(env, lambda seen: np.zeros((*seen.shape[:2], len(env.outputs))), [1])[0])


def test_score_of_aggregation_is_that_of_distances() -> None:
    assert score_of_idle("aggregation", [[400, 500, 0], [600, 500, 0]]) == pytest.approx(math.exp(-1), abs=1e-4)


def test_score_of_coverage_is_the_share_of_disks() -> None:
    assert score_of_idle("coverage", [[564, 564, 0]]) == pytest.approx(math.pi * 0.15**2, rel=0.02)
    assert score_of_idle("coverage", [[364, 564, 0], [764, 564, 0]]) == pytest.approx(2 * math.pi * 0.15**2, rel=0.02)


def test_score_of_phototaxis_is_the_light() -> None:
    for value in (250, 1000):
        uniform = {"objects.lamp.light_mode": "static", "objects.lamp.radius": 3000, "objects.lamp.value": value}
        assert score_of_idle("phototaxis", [[564, 564, 0]], **uniform) == pytest.approx(value / 1000, abs=2e-3)


@pytest.mark.parametrize("red", [-1.0, 1.0])
def test_policy_that_always_says_the_same_is_right_half_of_the_time(red: float) -> None:
    with TASKS["majority"].make_env(runs=8, threads=1) as env:
        same = np.broadcast_to([0.0, red, 0, 0], (8, env.robots, 4))
        found = scores(env, lambda _seen: same, range(8))
    # The first command takes effect a tick later, and the light changes between two decisions.
    np.testing.assert_allclose(found, 0.5, atol=0.02)


def test_score_of_majority_is_the_share_of_robots_that_are_right() -> None:
    task = TASKS["majority"]
    is_bright: list[Any] = []

    def knows(_seen: Any) -> Any:
        is_bright.append(env.swarm["light"] > 500)
        red = np.where(is_bright[-1], 1.0, -1.0)
        red[:, :3] *= -1  # three of ten are always wrong
        return np.stack([np.zeros_like(red), red, -red, -red], axis=-1)

    with task.make_env(runs=8, threads=1) as env:
        found = means(env, knows, range(8), task.behaviours)
    np.testing.assert_allclose(found[:, 0], 0.7, atol=0.02)
    np.testing.assert_allclose(found[:, 1], 0.5, atol=0.03)  # red robots
    np.testing.assert_allclose(found[:, 2], 0.3, atol=0.01)  # of another opinion than most
    begins = [int(np.argmax(light)) for light in np.array(is_bright)[..., 0].T]
    assert len(set(begins)) > 4  # bright from a time that cannot be known


def test_behaviours_of_motion_are_speed_and_company() -> None:
    settings = {"objects.robots.nb": None, "objects.robots.poses": [[400, 500, 0], [550, 500, 0], [900, 500, 0]]}
    task = TASKS["aggregation"]
    with task.make_env(set=settings, **STAY) as env:
        (idle,) = means(env, lambda seen: np.zeros((*seen.shape[:2], 3)), [1], task.behaviours)
    assert idle[1] == pytest.approx(0, abs=1e-6)
    assert idle[2] == pytest.approx(1 / 3)  # two of the three have one of their two others within 200 mm


def test_what_a_robot_knows_of_its_reward() -> None:
    bright, dark = [[[0.5, 0.5, 0.5, -1, 0, -1, -1, -1]]], [[[-0.5, -0.5, -0.5, -1, -1, -1, -1, -1]]]
    red = np.array([[[0.0, 1.0, 0.0, 0.0]]])
    felt = {
        name: [float(task.felt(np.array(seen), red)[0, 0]) for seen in (bright, dark)] for name, task in TASKS.items()
    }
    assert felt == {
        "phototaxis": [0.75, 0.25],
        "aggregation": [0.125, 0.0],
        "coverage": [0.875, 1.0],
        "majority": [1.0, 0.0],
    }


@pytest.mark.parametrize("name", TASKS)
def test_policies_by_hand_are_better_than_chance(name: str) -> None:
    random = np.random.default_rng(1)
    with TASKS[name].make_env(runs=8, threads=1) as env:
        by_hand = scores(env, TASKS[name].by_hand, range(8))
        by_chance = scores(env, lambda seen: random.uniform(-1, 1, (*seen.shape[:2], len(env.outputs))), range(8))
    assert by_hand.mean() > by_chance.mean() + 0.04
    assert 0 <= by_hand.min() <= by_hand.max() <= 1


@pytest.mark.parametrize(
    ("learner", "task", "budget", "end_s"),
    [
        (cma_es.cma_es, RED, 320, 1.0),
        (ppo.ppo, RED, 320, 2.0),
        (map_elites.map_elites, RED, 480, 1.0),
        (embodied.embodied, replace(RED, configuration=scene({"nb": 6, "communication_radius": 1200})), 160, 2.0),
    ],
    ids=["cma_es", "ppo", "map_elites", "embodied"],
)
def test_learner_finds_a_known_optimum_and_repeats_itself(
    learner: Learner, task: BenchmarkTask, budget: int, end_s: float
) -> None:
    said: list[str] = []
    first = learn(learner, task, budget, 1, said.append, 8, end=end_s, threads=1)
    again = learn(learner, task, budget, 1, said.append, end=end_s, threads=1)
    assert len(first.tested) == TEST_EPISODES
    assert len(first.curve) == len(first.episodes) == 8
    assert first.episodes[-1] == budget
    assert first.curve[-1] == first.tested.mean()
    assert first.tested.mean() > max(0.85, first.curve[0])
    assert first.weights.tobytes() == again.weights.tobytes()
    assert first.tested.tobytes() == again.tested.tobytes()
    assert said[: len(said) // 2] == said[len(said) // 2 :]


def test_command_line_writes_a_policy_that_acts_alike(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "policy.npz"
    assert main(cma_es.cma_es, "cma_es", "About.", ["majority", "--budget", "32", "--seed", "2", "-o", str(file)]) == 0
    assert capsys.readouterr().out.startswith("episodes     32: mean 0.")
    with TASKS["majority"].make_env(threads=1) as env:
        found = env.check_policy(file)
        network = perceptron_of(env)
        parts = [found[f"layer{layer}_{part}"] for layer in (0, 1) for part in ("weights", "bias")]
        weights = np.concatenate([np.column_stack([parts[layer], parts[layer + 1]]).ravel() for layer in (0, 2)])
        seen, _ = env.reset(seed=3)
        acts = network.act(weights, seen[0])
        low, high = env.policy_arrays()["input_low"], env.policy_arrays()["input_high"]
        raw = low + (seen[0] + 1) / 2 * (high - low)
    outputs = Policy(read_policy(file)).step(raw)
    np.testing.assert_allclose(outputs, (acts + 1) / 2 * 255, atol=0.05)


def code_of(command: Callable[[], int]) -> int:
    """Return the exit code of a command line."""
    try:
        return command()
    except SystemExit as end:  # of its parser
        return int(end.code or 0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["fototaxis"], "there is no task 'fototaxis'; did you mean 'phototaxis'?"),
        (["phototaxis", "--budget", "3"], "--budget: 3 episodes are too few for a generation of this learner"),
        (["phototaxis", "--seed", "-1"], "'-1' is not a whole number from 0 to 2147483646; "),
        (["phototaxis", "-o", "policy.txt"], "policy.txt does not end in .npz"),
        (["phototaxis", "-o", "nowhere/policy.npz"], "nowhere/policy.npz cannot be written: there is no folder "),
    ],
)
def test_wrong_arguments_are_one_line(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert code_of(lambda: main(cma_es.cma_es, "cma_es", "About.", arguments)) == 2
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert line.startswith("python -m pogosim.learning.learners.cma_es: ")
    assert said in line
    assert printed.out == ""


@pytest.mark.parametrize(
    ("problem", "code"), [(PolicyError("weights are not finite"), 2), (KeyboardInterrupt(), 130), (OSError("full"), 2)]
)
def test_search_that_ends_early_says_so_in_one_line(
    problem: BaseException, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    def learner(*_task: object, **_options: object) -> Iterator[Generation]:
        raise problem

    assert main(learner, "own", "About.", ["phototaxis"]) == code
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("python -m pogosim.learning.learners.own: ")


@pytest.mark.parametrize("problem", [KeyboardInterrupt(), OSError("full")])
def test_search_that_ends_early_keeps_its_policy(
    problem: BaseException, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def learner(*_task: object, **_options: object) -> Iterator[Generation]:
        yield Generation(8, np.zeros(1), np.full(38, 0.5))
        raise problem

    file = tmp_path / "policy.npz"
    assert main(learner, "own", "About.", ["phototaxis", "-o", str(file)]) in (2, 130)
    assert capsys.readouterr().err.splitlines()[0].endswith(f"warning: {file} has the policy after 8 episodes")
    assert (Policy.load(file).network.layers[0].weights == 0.5).all()
    assert [*tmp_path.iterdir()] == [file]


def test_learner_without_its_package_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    assert main(map_elites.map_elites, "map_elites", "About.", ["phototaxis"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "map_elites: this learner needs the Python package 'ribs'; install it: " in line


def test_weights_that_are_no_numbers_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def learner(*_task: object, **_options: object) -> Iterator[Generation]:
        yield Generation(1, np.zeros(1), np.full(38, 1e300))

    file = tmp_path / "policy.npz"
    assert main(learner, "own", "About.", ["phototaxis", "-o", str(file)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("layer 0: weights[0, 0]: expected a finite number of 32 bits, found 1e+300")
    assert [*tmp_path.iterdir()] == []
