"""What learners have in common: the result, the command line, and the saved policy."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy.typing as npt

from pogosim.learning.perceptron import perceptron_of
from pogosim.learning.tasks import TASKS, BenchmarkTask, scores, task_of
from pogosim.simulation import ConfigurationError, SimulationError

Array = npt.NDArray[Any]
TEST_SEEDS = range(1_000_000, 1_000_016)  # episodes that nothing is learnt from


@dataclass(frozen=True)
class Generation:
    """What a learner tells now and then.

    Attributes:
        episodes: Those that it has used until now.
        scores: Of the policies that it has tried since it last told, each from 0 to 1. Shape (any,).
        weights: The policy that it would give if it ended now.
    """

    episodes: int
    scores: Array
    weights: Array


# Of a task, a number of episodes, a seed, and options of environments.
Learner = Callable[..., Iterator[Generation]]


@dataclass(frozen=True)
class Learnt:
    """What came out.

    Attributes:
        weights: The policy.
        episodes: How many were used, after each generation.
        curve: Mean score of the policies tried in each generation.
        tested: Scores of the policy in the test episodes.
    """

    weights: Array
    tested: Array
    episodes: list[int] = field(default_factory=list)
    curve: list[float] = field(default_factory=list)


def tested(task: BenchmarkTask, weights: Array, **options: Any) -> Array:
    """Return the scores of a policy in the test episodes."""
    with task.make_env(runs=len(TEST_SEEDS), **options) as env:
        network = perceptron_of(env)
        return scores(env, lambda observation: network.act(weights, observation), TEST_SEEDS)


def learn(
    learner: Learner, task: BenchmarkTask, budget: int, seed: int, say: Callable[[str], None] = print, **options: Any
) -> Learnt:
    """Let a learner learn, and test what it has learnt.

    Args:
        learner: As in the modules beside this one.
        task: What is learnt.
        budget: Episodes that it may use.
        seed: Equal ones give equal results.
        say: What is called with a line for each generation.
        **options: Those of environments.
    """
    episodes: list[int] = []
    curve: list[float] = []
    weights = None
    for now in learner(task, budget, seed, **options):
        weights = now.weights
        episodes.append(now.episodes)
        curve.append(float(now.scores.mean()))
        say(f"episodes {now.episodes:6d}: mean {curve[-1]:.4f}, best {now.scores.max():.4f}")
    if weights is None:
        raise ConfigurationError(f"--budget: {budget} episodes are too few for a generation of this learner")
    return Learnt(weights, tested(task, weights, **options), episodes, curve)


def count(text: str) -> int:
    """Return an integer of the command line, from 1 on."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"expected an integer from 1 on, found {text!r}")
    return value


count.__name__ = "integer"


def main(learner: Learner, about: str, arguments: Sequence[str] | None = None) -> int:
    """Run the command line of a learner; returns the exit code."""
    parser = argparse.ArgumentParser(description=about.partition("\n")[0])
    parser.add_argument("task", metavar="TASK", help=f"one of {', '.join(TASKS)}")
    parser.add_argument("--budget", type=count, default=2000, help="episodes (default: %(default)s)")
    parser.add_argument("--seed", type=count, default=1, help="equal ones give equal results (default: %(default)s)")
    parser.add_argument("-o", "--output", type=Path, help="where the policy is written: an .npz file")
    options = parser.parse_args(arguments)
    try:
        task = task_of(options.task)
        found = learn(learner, task, options.budget, options.seed)
        print(f"test: {found.tested.mean():.4f} +- {found.tested.std():.4f}")
        if options.output is not None:
            with task.make_env() as env:
                perceptron_of(env).save(found.weights, env, options.output)
    except (ConfigurationError, SimulationError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    return 0
