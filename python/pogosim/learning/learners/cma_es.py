"""CMA-ES searches the weights of a policy.

    .venv/bin/python -m pogosim.learning.learners.cma_es phototaxis --budget 2000 -o policy.npz

N. Hansen and A. Ostermeier, "Completely derandomized self-adaptation in evolution strategies", Evolutionary Computation
9, 2001. All candidates of a generation are judged in the same episodes, at once.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from pogosim.learning.learners.running import Generation, learning_seeds, main, trials
from pogosim.learning.perceptron import perceptron_of
from pogosim.learning.tasks import BenchmarkTask, scores

CANDIDATES, EPISODES = 16, 2


def cma_es(task: BenchmarkTask, budget: int, seed: int, **options: Any) -> Iterator[Generation]:
    """Search weights; tells each generation."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of matplotlib, which cma may lack
        import cma

    each = CANDIDATES * EPISODES
    with task.make_env(runs=each, **options) as env:
        network = perceptron_of(env)
        search = cma.CMAEvolutionStrategy(
            np.zeros(network.size), 0.5, {"seed": seed + 1, "popsize": CANDIDATES, "verbose": -9}
        )
        seeds = learning_seeds(seed)
        for generation in range(budget // each):
            found = np.array(search.ask())
            judged = scores(env, *trials(network, found, seeds, EPISODES))
            mean = judged.reshape(CANDIDATES, EPISODES).mean(axis=1)
            search.tell(list(found), list(-mean))
            yield Generation((generation + 1) * each, mean, np.array(search.mean))


if __name__ == "__main__":
    sys.exit(main(cma_es, "cma_es", __doc__ or ""))
