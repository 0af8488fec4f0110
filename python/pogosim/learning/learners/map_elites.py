"""MAP-Elites searches policies that behave in different ways, the best one of each way.

    .venv/bin/python -m pogosim.learning.learners.map_elites aggregation --budget 2000 -o policy.npz

J.-B. Mouret and J. Clune, "Illuminating search spaces by mapping elites", arXiv:1504.04909, 2015, by pyribs
(B. Tjanaka et al., GECCO 2023), with the mutation of V. Vassiliades and J.-B. Mouret, "Discovering the elite
hypervolume by leveraging interspecies correlation", GECCO 2018. The behaviours are those of the task.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from pogosim.learning.learners.running import Generation, learning_seeds, main, require, trials
from pogosim.learning.perceptron import perceptron_of
from pogosim.learning.tasks import BenchmarkTask, means

CANDIDATES, EPISODES = 8, 4
CELLS = (8, 8)
FIRST, MUTATION = 1.0, 0.5  # standard deviations of weights
BETWEEN = 0.2  # that of steps towards another elite, as a share of its distance


def map_elites(task: BenchmarkTask, budget: int, seed: int, **options: Any) -> Iterator[Generation]:
    """Search weights; tells each batch of candidates, and the best elite.

    Raises:
        ConfigurationError: The package ribs is missing.
    """
    require("ribs")
    from ribs.archives import GridArchive
    from ribs.emitters import IsoLineEmitter

    each = CANDIDATES * EPISODES
    with task.make_env(runs=each, **options) as env:
        network = perceptron_of(env)
        ranges = [(behaviour.low, behaviour.high) for behaviour in task.behaviours]
        archive = GridArchive(solution_dim=network.size, dims=CELLS, ranges=ranges, seed=seed)
        first = np.random.default_rng(seed).normal(0.0, FIRST, (4 * CANDIDATES, network.size))
        emitter = IsoLineEmitter(
            archive, iso_sigma=MUTATION, line_sigma=BETWEEN, x0=np.zeros(network.size), batch_size=CANDIDATES, seed=seed
        )
        seeds = learning_seeds(seed)
        for generation in range(budget // each):
            begin = generation * CANDIDATES
            found = first[begin : begin + CANDIDATES] if begin < len(first) else emitter.ask()
            measured = means(env, *trials(network, found, seeds, EPISODES), task.behaviours)
            mean = measured.reshape(CANDIDATES, EPISODES, -1).mean(axis=1)
            archive.add(found, mean[:, 0], mean[:, 1:])
            yield Generation((generation + 1) * each, mean[:, 0], archive.best_elite["solution"])


if __name__ == "__main__":
    sys.exit(main(map_elites, "map_elites", __doc__ or ""))
