"""Learn policies for the environments with CMA-ES, and draw how their returns grow.

    .venv/bin/python examples/learning/train.py                  # both; about a minute on two processors
    .venv/bin/python examples/learning/train.py gathering -g 60  # one, for 60 generations

Writes learning.png, and prints the weights for the parameter `policy` of the program. A policy is linear: each motor
gets a bias and a weighted sum of the observation, limited to -1 to 1. CMA-ES (N. Hansen and A. Ostermeier, "Completely
derandomized self-adaptation in evolution strategies", Evolutionary Computation 9, 2001) searches the 16 weights that
give the highest return. Equal seeds give equal results, whatever the number of threads.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

try:
    import cma
    import numpy as np
    import numpy.typing as npt
    from environments import ACTIONS, OBSERVATIONS, gathering, light_seeker
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator
    from pogosim.learning import SwarmEnv
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"train.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

Array = npt.NDArray[Any]
# Observations, shape (runs, robots, 7), to actions, shape (runs, robots, 2), in [-1, 1].
Policy = Callable[[Array], Array]

SHAPE = (len(ACTIONS), 1 + len(OBSERVATIONS))
TEST_SEEDS = range(10_000, 10_010)  # episodes that no candidate is chosen by


def linear(weights: Array) -> Policy:
    """Return the policy with these weights, as the program has it. Shape (16,), or (runs, 16): one for each run."""
    by_run = np.atleast_2d(weights).reshape(-1, *SHAPE)
    bias, slope = by_run[:, None, :, 0], by_run[..., 1:]
    return lambda observations: np.clip(observations @ slope.swapaxes(1, 2) + bias, -1.0, 1.0)


def random_policy(seed: int) -> Policy:
    """Return the policy that does anything."""
    random = np.random.default_rng(seed)
    return lambda observations: random.uniform(-1.0, 1.0, (*observations.shape[:2], len(ACTIONS)))


def returns(env: SwarmEnv, policy: Policy, seeds: Sequence[int]) -> Array:
    """Return the sums of rewards of an episode in each run, means over the robots. Shape (runs,)."""
    observation, _ = env.reset(seed=seeds)
    total = np.zeros(len(env))
    for _ in range(env.episode_steps):
        observation, reward, *_ = env.step(policy(observation))
        total += reward.mean(axis=1)
    return total


@dataclass(frozen=True)
class Task:
    """What is learnt.

    Attributes:
        name: On the command line.
        title: In the figure.
        make_env: Makes an environment, with options of its own.
        by_hand: Weights that a person would choose.
    """

    name: str
    title: str
    make_env: Callable[..., SwarmEnv]
    by_hand: tuple[float, ...]


TASKS = {
    task.name: task
    for task in (
        # Turn to the brighter side, see examples/learning/main.c.
        Task("light", "one robot looks for light", light_seeker, (0.5, 0, 0, -1, 0, 0, 0, 0, 0.5, 0, 0, 1, 0, 0, 0, 0)),
        # Turn to the side with more neighbours.
        Task(
            "gathering", "eight robots gather", gathering, (0.5, 0, 0, 0, 0, -1, -0.5, 1, 0.5, 0, 0, 0, 0, 1, 0.5, -1)
        ),
    )
}


@dataclass(frozen=True)
class Learnt:
    """What came out.

    Attributes:
        weights: The policy after the last generation.
        curve: Returns of the test episodes after each generation, and before the first. Shape (generations + 1, seeds).
        by_hand: Returns of the hand-written policy. Shape (seeds,).
        by_chance: Returns of the policy that does anything.
    """

    weights: Array
    curve: Array
    by_hand: Array
    by_chance: Array


def learn(
    task: Task, generations: int, seed: int = 1, candidates: int = 12, episodes: int = 2, **options: Any
) -> Learnt:
    """Search the weights: one call of the policy for all episodes of all candidates.

    Args:
        task: What is learnt.
        generations: How often candidates are judged.
        seed: Seed of the search.
        candidates: Number of candidates in each generation.
        episodes: By whose mean return each is judged, the same for all of a generation.
        **options: Those of environments, such as `end` and `threads`.
    """
    size = SHAPE[0] * SHAPE[1]
    search = cma.CMAEvolutionStrategy(np.zeros(size), 0.5, {"seed": seed, "popsize": candidates, "verbose": -9})
    with (
        task.make_env(runs=candidates * episodes, **options) as env,
        task.make_env(runs=len(TEST_SEEDS), **options) as test,
    ):
        curve = [returns(test, linear(search.mean), TEST_SEEDS)]
        for generation in range(generations):
            found = search.ask()
            seeds = [episodes * generation + episode for episode in range(episodes)] * candidates
            judged = returns(env, linear(np.repeat(found, episodes, axis=0)), seeds)
            search.tell(found, list(-judged.reshape(candidates, episodes).mean(axis=1)))
            curve.append(returns(test, linear(search.mean), TEST_SEEDS))
        by_chance = returns(test, random_policy(TEST_SEEDS[0]), TEST_SEEDS)
        by_hand = returns(test, linear(np.array(task.by_hand)), TEST_SEEDS)
    return Learnt(np.array(search.mean), np.array(curve), by_hand, by_chance)


def draw(axes: Axes, title: str, found: Learnt) -> None:
    """Draw returns by generation: mean and standard deviation over the test episodes."""
    generations = np.arange(len(found.curve))
    for label, colour, values in (
        ("learnt", "tab:blue", found.curve),
        ("written by hand", "tab:green", np.broadcast_to(found.by_hand, found.curve.shape)),
        ("random actions", "tab:gray", np.broadcast_to(found.by_chance, found.curve.shape)),
    ):
        mean, spread = values.mean(axis=1), values.std(axis=1)
        axes.plot(generations, mean, color=colour, label=label)
        axes.fill_between(generations, mean - spread, mean + spread, color=colour, alpha=0.2, linewidth=0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set(title=title, xlabel="generation", xlim=(0, generations[-1]), ylim=(0, None))


def figure_of(results: dict[str, Learnt]) -> Figure:
    """Draw the learning curves of tasks side by side."""
    figure = Figure(figsize=(4.2 * len(results), 3.4), layout="constrained")
    for axes, (name, found) in zip(figure.subplots(1, len(results), squeeze=False)[0], results.items(), strict=True):
        draw(axes, TASKS[name].title, found)
    figure.axes[0].set_ylabel("return of an episode")
    figure.axes[0].legend(loc="lower right", frameon=False)
    return figure


def summary(name: str, found: Learnt) -> list[str]:
    """Return lines with the returns of the test episodes, and the weights."""
    returns = {"random": found.by_chance, "by hand": found.by_hand, "learnt": found.curve[-1]}
    lines = [f"{name:10s} {policy:8s} {of.mean():5.1f} +- {of.std():.1f}" for policy, of in returns.items()]
    return [*lines, f"{name:10s} policy: [{', '.join(f'{weight:.2f}' for weight in found.weights)}]"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("tasks", nargs="*", metavar="TASK", help=f"of {', '.join(TASKS)}; without: all")
    parser.add_argument("-g", "--generations", type=int, default=20, help="default: %(default)s")
    parser.add_argument("-s", "--seed", type=int, default=1, help="of the search; default: %(default)s")
    parser.add_argument("-o", "--output", type=Path, default=Path("learning.png"), help="default: %(default)s")
    options = parser.parse_args(arguments)
    if unknown := sorted(set(options.tasks) - set(TASKS)):
        parser.error(f"no task is called {', '.join(unknown)}; there are {', '.join(TASKS)}")
    if options.generations < 1 or options.seed < 1:
        parser.error("--generations and --seed: expected integers from 1 on")
    if not options.output.parent.is_dir():
        parser.error(f"--output: there is no folder {options.output.parent}")
    results = {}
    for name in options.tasks or TASKS:
        results[name] = learn(TASKS[name], options.generations, options.seed)
        print(*summary(name, results[name]), sep="\n", flush=True)
    figure_of(results).savefig(options.output, dpi=110)
    return 0


if __name__ == "__main__":
    sys.exit(main())
