"""How well learners do the tasks, beside random actions and policies written by hand.

    .venv/bin/python -m pogosim.learning.benchmark
    .venv/bin/python -m pogosim.learning.benchmark --tasks phototaxis,coverage --budget 500 --seeds 5 -o scores.csv

Each policy is tested in episodes that nothing is learnt from; in those of a seed, all policies are. A table in Markdown
has the mean over the seeds, and its 95 % confidence interval by Student's t.
"""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.arguments import shown
from pogosim.command.parser import Parser, whole
from pogosim.confidence import mean_over_runs
from pogosim.learning.learners.cma_es import cma_es
from pogosim.learning.learners.embodied import embodied
from pogosim.learning.learners.map_elites import map_elites
from pogosim.learning.learners.ppo import ppo
from pogosim.learning.learners.running import (
    MOST_SEED,
    Learner,
    add_search_options,
    ended,
    learn,
    require,
    tested,
    written_in_any_case,
)
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.learning.tasks import TASKS, BenchmarkTask, Controller, task_of
from pogosim.lines import say
from pogosim.nearest_name import advice
from pogosim.simulation import ConfigurationError

LEARNERS: dict[str, Learner] = {"cma_es": cma_es, "ppo": ppo, "embodied": embodied, "map_elites": map_elites}
PACKAGES = {"map_elites": "ribs"}  # optional ones that learners need
TESTS = 10  # of each search, at equal distances


@dataclass(frozen=True)
class Result:
    """What a policy did in the test episodes of a seed.

    Attributes:
        task: Name of the task.
        policy: "random", "by hand", or the learner's name.
        seed: That of the search and of the test episodes.
        episodes: Those that it was learnt from until then.
        score: Mean over the test episodes, from 0 to 1.
    """

    task: str
    policy: str
    seed: int
    episodes: int
    score: float


@contextlib.contextmanager
def named(learner: str) -> Iterator[None]:
    """Say which learner it is that something is wrong with."""
    try:
        yield
    except ConfigurationError as error:
        raise ConfigurationError(f"{learner}: {error}") from None


def random_actions(env: SwarmEnv, seed: int) -> Controller:
    """Return the policy that does anything."""
    generator = np.random.default_rng(seed)
    return lambda observation: generator.uniform(-1.0, 1.0, (*observation.shape[:2], len(env.outputs)))


def results(
    task: BenchmarkTask, learners: Sequence[str], budget: int, seed: int, **options: Any
) -> Iterator[list[Result]]:
    """Test random actions, the policy by hand, and what each learner learns; of each a list, the last test last.

    Args:
        task: The task.
        learners: Names of learners.
        budget: Episodes that each may use.
        seed: That of searches and test episodes.
        **options: Those of environments.

    Raises:
        ConfigurationError: The budget is too small, or a learner lacks a package.
    """
    by_chance = tested(task, seed, lambda env: random_actions(env, seed), **options)
    yield [Result(task.name, "random", seed, 0, float(by_chance.mean()))]
    by_hand = tested(task, seed, lambda _env: task.by_hand, **options)
    yield [Result(task.name, "by hand", seed, 0, float(by_hand.mean()))]
    for name in learners:
        with named(name):
            found = learn(LEARNERS[name], task, budget, seed, lambda _line: None, TESTS, **options)
        tests = zip(found.episodes, found.curve, strict=True)
        yield [Result(task.name, name, seed, episodes, score) for episodes, score in tests]


def table(found: Sequence[Result]) -> list[str]:
    """Return the lines of a table in Markdown: a row for each task and policy, in the order of the results."""
    rows = pd.DataFrame(found)
    by_policy = rows.groupby(["task", "policy", "seed"], sort=False).last()  # the last test of each
    means = mean_over_runs(by_policy["score"].unstack("seed"))
    episodes = by_policy["episodes"].groupby(["task", "policy"]).max()
    lines = ["| task | policy | score | 95 % interval | episodes |", "|---|---|---|---|---|"]
    for key in dict.fromkeys(zip(rows["task"], rows["policy"], strict=True)):
        mean = means.loc[key]
        interval = f"{mean['low']:.3f} to {mean['high']:.3f}" if mean["runs"] > 1 else "of one seed: none"
        lines.append(f"| {key[0]} | {key[1]} | {mean['mean']:.3f} | {interval} | {episodes[key]} |")
    return lines


def names_in(what: str, text: str, known: Sequence[str]) -> list[str]:
    """Return names that are separated by commas, each once.

    Raises:
        ConfigurationError: One is not known; names the nearest.
    """
    names = list(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in known:
            raise ConfigurationError(f"{what}: there is no {shown(name)}{advice(name, known)}")
    return names


def check_packages(learners: Sequence[str]) -> None:
    """Check that the optional packages of learners are there, before anything is learnt.

    Raises:
        ConfigurationError: One is missing.
    """
    for name in learners:
        with named(name):
            if name in PACKAGES:
                require(PACKAGES[name])


def measure(
    tasks: Sequence[str],
    learners: Sequence[str],
    budget: int,
    seeds: Sequence[int],
    tell: Callable[[str], None] = say,
    keep: Callable[[list[Result]], None] = lambda _tests: None,
    **options: Any,
) -> list[Result]:
    """Let all learners do all tasks.

    Args:
        tasks: Names of tasks.
        learners: Names of learners.
        budget: Episodes of a search.
        seeds: Each repeats all.
        tell: What is called with a line for each policy.
        keep: What is called with its results, for measurements that are interrupted.
        **options: Those of environments.

    Raises:
        ConfigurationError: The budget is too small, or a learner lacks a package.
    """
    check_packages(learners)
    found: list[Result] = []
    for name in tasks:
        for seed in seeds:
            start_s = time.perf_counter()
            for tests in results(task_of(name), learners, budget, seed, **options):
                keep(tests)
                now_s = time.perf_counter()
                tell(f"{name}, seed {seed}: {tests[-1].policy} {tests[-1].score:.3f}, {now_s - start_s:.1f} s")
                found += tests
                start_s = now_s
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    prog = "python -m pogosim.learning.benchmark"
    parser = Parser(prog=prog, description=(__doc__ or "").partition("\n")[0], allow_abbrev=False)
    add = parser.add_argument
    add("--tasks", default=",".join(TASKS), metavar="A,B", help="default: %(default)s")
    add("--learners", default=",".join(LEARNERS), metavar="A,B", help="default: %(default)s")
    add_search_options(parser)
    add(
        "--seeds",
        type=whole(1, 1000),
        default=3,
        metavar="N",
        help="searches of each, with --seed, the next, ... (default: %(default)s)",
    )
    add("-o", "--output", metavar="FILE.csv", help="where each result is written in a row")
    options = parser.parse_args(arguments)

    def run() -> None:
        tasks = names_in("--tasks", options.tasks, [*TASKS])
        learners = names_in("--learners", options.learners, [*LEARNERS])
        found: list[Result] = []

        def save(file: Path) -> str:
            pd.DataFrame(found).to_csv(file, index=False)
            return f"{len(found)} results" if found else ""

        if options.seed + options.seeds - 1 > MOST_SEED:
            most = MOST_SEED + 1 - options.seeds
            raise ConfigurationError(f"--seed: expected {most} at most for {options.seeds} seeds")
        seeds = range(options.seed, options.seed + options.seeds)
        with written_in_any_case(prog, options.output, ".csv", save):
            measure(tasks, learners, options.budget, seeds, keep=found.extend)
            say("", *table(found))

    return ended(prog, run)


if __name__ == "__main__":
    sys.exit(main())
