"""Time to consensus of the voter model on the complete graph, against the number of robots.

In an update, a random one of N robots adopts the opinion of a random other one. The number n of robots with one of two
opinions then makes a fair random walk that ends at 0 or N, and from n on this takes, on average,

    T = (N - 1) / N * ((N - n) * sum_{k=1}^{n} 1 / (N - k) + n * sum_{k=n+1}^{N-1} 1 / k)

times N updates: from one half on, about N ln 2. This solves the equation of a birth-death process with the
probabilities n (N - n) / (N (N - 1)) in either direction (Sood, Antal and Redner, Physical Review E 77, 041121, 2008,
give the limit -N (x ln x + (1 - x) ln(1 - x)) with x = n / N).

Robots update at once, each with a small probability p per tick, and N updates are 1 / p ticks. Two updates that cancel
in a tick make them slower by a factor of about 1 / (1 - p / 2). The Markov chain of this process gives the exact
distribution of the times.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy import stats

from .agreement import FALSE_ALARM, Comparison, Values, relative
from .experiment import Outcome, batch, compile_program

NAME = "voter"
SIZES = {8: 1000, 16: 1000, 32: 500, 64: 300}  # runs
QUICK_SIZES = {8: 150, 32: 150}
UPDATE_PROBABILITY = 0.05
MARGIN = 0.005  # relative: what the factor for updates that cancel leaves over
COLOURS = {8: "#5b8c5a", 16: "#d98200", 32: "#1b6ca8", 64: "#a8321b"}


def theory_time(robots: int) -> float:
    """Mean time to consensus from one half on, in units of N updates, as if robots updated one by one."""
    n = robots // 2
    one, other = np.arange(1, n + 1), np.arange(n + 1, robots)
    total = (robots - n) * (1.0 / (robots - one)).sum() + n * (1.0 / other).sum()
    return float((robots - 1) / robots * total)


def chain(robots: int) -> Values:
    """Transition matrix of the number of robots with an opinion, for robots that all update in a tick."""
    matrix = np.zeros((robots + 1, robots + 1))
    for n in range(robots + 1):
        gained = stats.binom.pmf(np.arange(robots - n + 1), robots - n, UPDATE_PROBABILITY * n / (robots - 1))
        lost = stats.binom.pmf(np.arange(n + 1), n, UPDATE_PROBABILITY * (robots - n) / (robots - 1))
        matrix[n] = np.convolve(lost[::-1], gained)
    return matrix


def chain_consensus(robots: int, ticks: int) -> Values:
    """Probability that all agree after 0, 1, ..., ticks ticks, from one half on. Shape (ticks + 1,)."""
    matrix = chain(robots)
    state = np.zeros(robots + 1)
    state[robots // 2] = 1.0
    agreed = [0.0]
    for _ in range(ticks):
        state = state @ matrix
        agreed.append(state[0] + state[-1])
    return np.array(agreed)


def consensus_ticks(program: Path, robots: int, runs: int) -> Values:
    """Run robots. Returns the ticks to consensus of each run."""
    changes = {"objects.robots.nb": robots, "parameters.nb_robots": robots}
    rows = batch(program, NAME, runs, changes)[NAME]
    ticks = rows.groupby("run")["consensus_tick"].max()
    assert len(ticks) == runs
    assert (ticks > 0).all(), "a run ended before all agreed"
    return np.asarray(ticks.to_numpy(dtype=float))


def distribution(robots: int, ticks: Values) -> Comparison:
    """Compare the distribution of times with the chain's: largest distance (Dvoretzky, Kiefer, Wolfowitz; Massart)."""
    last = int(ticks.max())
    ours = np.searchsorted(np.sort(ticks), np.arange(last + 1), side="right") / len(ticks)
    distance = np.abs(ours - chain_consensus(robots, last)).max()
    allowed = np.sqrt(np.log(2.0 / FALSE_ALARM) / (2.0 * len(ticks)))
    name = f"{robots} robots, distribution of times against the Markov chain"
    return Comparison(name, np.array([distance]), np.zeros(1), np.zeros(1), 1, np.array([allowed]))


def draw(ticks: dict[int, Values], times: dict[int, Values]) -> Figure:
    """Draw mean times against the number of robots, and the distributions."""
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    every = np.arange(4, 101, 2)
    left.plot(every, [theory_time(int(robots)) for robots in every], color="0.3", linewidth=1, label="theory")
    left.plot(every, every * np.log(2.0), color="0.3", linestyle=":", linewidth=1, label="N ln 2")
    for robots, sample in times.items():
        error = sample.std(ddof=1) / np.sqrt(len(sample))
        left.errorbar(robots, sample.mean(), error, fmt="o", color=COLOURS[robots], markersize=4)
    left.set(xscale="log", yscale="log", xlabel="robots N", ylabel="mean time to consensus (N updates)")
    left.legend(fontsize=8)
    for robots, sample in ticks.items():
        tick = np.arange(int(sample.max()) + 1)
        agreed = chain_consensus(robots, len(tick) - 1)
        scale = UPDATE_PROBABILITY / robots
        right.plot(scale * tick, 1.0 - agreed, color="0.3", linewidth=0.8)
        left_over = 1.0 - np.arange(1, len(sample) + 1) / len(sample)
        right.step(scale * np.sort(sample), left_over, where="post", color=COLOURS[robots], label=f"N = {robots}")
    right.set(xlabel="time / N", ylabel="share of runs without consensus", xlim=(0.0, 3.0))
    right.legend(fontsize=8)
    return figure


def measure(folder: Path, quick: bool) -> Outcome:
    """Run, compare, draw."""
    program = compile_program(NAME, folder)
    ticks = {
        robots: consensus_ticks(program, robots, runs) for robots, runs in (QUICK_SIZES if quick else SIZES).items()
    }
    updates_per_tick = UPDATE_PROBABILITY * (1.0 - UPDATE_PROBABILITY / 2.0)
    times = {robots: updates_per_tick * sample for robots, sample in ticks.items()}
    means = [
        relative(f"{robots} robots, mean time / theory", sample[:, None], [theory_time(robots)], MARGIN)
        for robots, sample in times.items()
    ]
    counted = ", ".join(f"{len(sample)} runs of {robots} robots" for robots, sample in ticks.items())
    tables = tuple(pd.DataFrame({str(robots): sample}) for robots, sample in ticks.items())
    distributions = [distribution(robots, sample) for robots, sample in ticks.items()]
    return Outcome(counted, draw(ticks, times), tables, (*means, *distributions))
