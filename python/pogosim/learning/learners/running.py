"""What learners have in common: the result, the command line, and the saved policy."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.command.parser import Parser, complain, guarded, warn, whole
from pogosim.extras import installing
from pogosim.learning.perceptron import Perceptron, perceptron_of
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.learning.tasks import TASKS, BenchmarkTask, Controller, scores, task_of
from pogosim.lines import say
from pogosim.outputs import OutputError, partial_output, real_output
from pogosim.simulation import ConfigurationError, SimulationError

Array = npt.NDArray[Any]
TEST_EPISODES = 16
FIRST_TEST_SEED = 2**30  # seeds of episodes: those below are for learning
MOST_SEED = 2**31 - 2  # of CMA-ES
INTERRUPTED = 130  # exit code


class NotYetError(Exception):
    """There is nothing to write yet."""


@dataclass(frozen=True)
class Generation:
    """What a learner tells now and then.

    Attributes:
        episodes: Those that it has used until now.
        scores: What the policies have reached that it has tried since it last told, from 0 to 1. Shape (any,).
        weights: The policy that it would give if it ended now.
    """

    episodes: int
    scores: Array
    weights: Array


# Takes a task, a number of episodes, a seed, and options of environments.
Learner = Callable[..., Iterator[Generation]]


@dataclass(frozen=True)
class Learnt:
    """What came out.

    Attributes:
        weights: The policy.
        tested: Scores of the policy in the test episodes. Shape (TEST_EPISODES,).
        episodes: How many had been used at each test.
        curve: Mean score in each test of the policy that the learner would have given then.
    """

    weights: Array
    tested: Array
    episodes: list[int]
    curve: list[float]


def learning_seeds(seed: int) -> Iterator[int]:
    """Give seeds of episodes to learn from, never those of test episodes."""
    generator = np.random.default_rng(seed)
    while True:
        yield int(generator.integers(FIRST_TEST_SEED))


def trials(network: Perceptron, candidates: Array, seeds: Iterator[int], episodes: int) -> tuple[Controller, list[int]]:
    """Let each candidate be tried in the same episodes; returns the policies of all runs, and their seeds.

    Args:
        network: The shape of policies.
        candidates: Their weights. Shape (candidates, weights).
        seeds: Those of episodes.
        episodes: How many each is tried in. Candidate i has the runs from i * episodes on.
    """
    by_run = np.repeat(candidates, episodes, axis=0)[:, None]
    return partial(network.act, by_run), [*islice(seeds, episodes)] * len(candidates)


def tested(task: BenchmarkTask, seed: int, policy_for: Callable[[SwarmEnv], Controller], **options: Any) -> Array:
    """Return the scores in episodes that nothing is learnt from. Shape (TEST_EPISODES,).

    Args:
        task: The task.
        seed: Which episodes: equal seeds give the same.
        policy_for: Gives what the robots of an environment do.
        **options: Those of environments.
    """
    first = FIRST_TEST_SEED + TEST_EPISODES * seed
    with task.make_env(runs=TEST_EPISODES, **options) as env:
        return scores(env, policy_for(env), range(first, first + TEST_EPISODES))


def require(package: str) -> None:
    """Check that an optional package is there.

    Raises:
        ConfigurationError: It is missing; says how to install it.
    """
    if importlib.util.find_spec(package) is None:
        raise ConfigurationError(
            f"this learner needs the Python package '{package}'; install it: {installing('optimize')}"
        )


def learn(
    learner: Learner,
    task: BenchmarkTask,
    budget: int,
    seed: int,
    tell: Callable[[str], None] = say,
    tests: int = 1,
    keep: Callable[[Generation], None] = lambda _now: None,
    **options: Any,
) -> Learnt:
    """Let a learner learn, and test what it has learnt.

    Args:
        learner: As in the modules beside this one.
        task: What is learnt.
        budget: Episodes that it may use.
        seed: Equal ones give equal results.
        tell: What is called with a line for each generation.
        tests: How often the policy is tested, at equal distances, the last time at the end. The learner does not know.
        keep: What is called with each generation, for those that are interrupted.
        **options: Those of environments.

    Raises:
        ConfigurationError: The budget is too small.
    """
    found = Learnt(np.empty(0), np.empty(0), [], [])
    now = None

    def test(now: Generation) -> Learnt:
        scores = tested(task, seed, lambda env: partial(perceptron_of(env).act, now.weights), **options)
        curve = [*found.curve, float(scores.mean())]
        return Learnt(now.weights, scores, [*found.episodes, now.episodes], curve)

    for now in learner(task, budget, seed, **options):
        keep(now)
        tell(f"episodes {now.episodes:6d}: mean {now.scores.mean():.4f}, best {now.scores.max():.4f}")
        if now.episodes * tests >= budget * (len(found.curve) + 1):
            found = test(now)
    if now is None:
        raise ConfigurationError(f"--budget: {budget} episodes are too few for a generation of this learner")
    return found if found.episodes[-1:] == [now.episodes] else test(now)


def ended(prog: str, run: Callable[[], int | None]) -> int:
    """Run a command; says in one line what keeps it from its end. Returns the exit code: 0, 2, 130 if interrupted."""
    try:
        return guarded(prog, run)
    except SimulationError as error:
        return complain(prog, error)
    except KeyboardInterrupt:
        complain(prog, "interrupted")
        return INTERRUPTED


def add_search_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a search."""
    add = parser.add_argument
    add("--budget", type=whole(1), default=2000, metavar="N", help="episodes of a search (default: %(default)s)")
    add(
        "--seed",
        type=whole(0, MOST_SEED),
        default=1,
        metavar="N",
        help="equal ones give equal results (default: %(default)s)",
    )


def checked_file(name: str, ending: str) -> Path:
    """Return where to write.

    Raises:
        OutputError: There is no folder for it, or its name ends otherwise.
        OSError: It cannot be looked at.
    """
    if not name.endswith(ending):
        raise OutputError(f"{name} does not end in {ending}")
    return real_output(name)


@contextlib.contextmanager
def written_in_any_case(prog: str, name: str | None, ending: str, write: Callable[[Path], str]) -> Iterator[None]:
    """Write a file when the block ends, also if it is interrupted or fails: learning takes long.

    Args:
        prog: Name of the command, for what is said of a file that is not all of it.
        name: The file, which must be possible to write before the block begins; None: nothing is written.
        ending: How its name must end.
        write: Writes what there is, and returns what it is, in words; empty: nothing yet, and no file is left.

    Raises:
        OutputError, OSError: It cannot be written.
    """
    if name is None:
        yield
        return
    file = checked_file(name, ending)
    try:
        with partial_output(file):
            raise NotYetError  # it can be written, so its name is free again
    except NotYetError:
        pass
    try:
        yield
    except BaseException:
        with contextlib.suppress(NotYetError), partial_output(file) as unfinished:
            what = write(unfinished)
            if not what:
                raise NotYetError from None
            warn(prog, f"{name} has {what}")
        raise
    with partial_output(file) as unfinished:
        write(unfinished)


def main(learner: Learner, name: str, about: str, arguments: Sequence[str] | None = None) -> int:
    """Run the command line of a learner; returns the exit code.

    Args:
        learner: What learns.
        name: That of its module.
        about: Its text; the first line is for --help.
        arguments: Those of the command line; None: the process's.
    """
    prog = f"python -m pogosim.learning.learners.{name}"
    parser = Parser(prog=prog, description=about.partition("\n")[0], allow_abbrev=False)
    parser.add_argument("task", metavar="TASK", help=f"one of {', '.join(TASKS)}")
    add_search_options(parser)
    parser.add_argument("-o", "--output", metavar="FILE.npz", help="where the policy is written")
    options = parser.parse_args(arguments)

    def run() -> None:
        task = task_of(options.task)
        generations: list[Generation] = []

        def save(file: Path) -> str:
            if not generations:
                return ""
            with task.make_env() as env:
                perceptron_of(env).save(generations[-1].weights, env, file)
            return f"the policy after {generations[-1].episodes} episodes"

        with written_in_any_case(prog, options.output, ".npz", save):
            found = learn(learner, task, options.budget, options.seed, keep=generations.append)
            say(f"test: {found.tested.mean():.4f} +- {found.tested.std():.4f}")

    return ended(prog, run)
