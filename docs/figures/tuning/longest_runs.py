"""run_and_tumble gets the farthest with the longest runs: a search must find the end of the range.

The displacement of a random walk grows with its persistence, as long as runs are short compared with the arena. So the
optimum of `run_duration_max` in conf/optim/simple.yaml, from 10 to 1000 ms, is 1000. The search begins at 50. With its
usual first step, CMA-ES needs more evaluations than these for one or two in ten seeds; so it takes longer steps.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pictures import ROOT

from .searches import Claim, Outcome, example, search

NAME = "longest_runs"
VARIABLE = "parameters.run_duration_max"
EVALUATIONS = 20
ENOUGH_MS = 900
FIRST_STEP = 0.5
SEEDS = 10
QUICK_SEEDS = 1
QUICK = {"objects.robots.nb": 30, "simulation_time": 30.0}


def measure(folder: Path, quick: bool) -> Outcome:
    """Search with several seeds of the optimiser."""
    options = [
        "--optimizer",
        "cmaes",
        "--sigma0",
        str(FIRST_STEP),
        "--runs",
        "1",
        "--max-evals",
        str(EVALUATIONS),
        "--final-runs",
        "0",
    ]
    best, first = [], []
    for seed in range(QUICK_SEEDS if quick else SEEDS):
        found = search(
            example("run_and_tumble"),
            ROOT / "conf" / "optim" / "simple.yaml",
            folder / str(seed),
            [*options, "--seed", str(seed)],
            QUICK if quick else {},
        )
        best.append(found.summary["best_values"][VARIABLE])
        is_enough = found.history[VARIABLE] > ENOUGH_MS
        first.append(int(found.history["eval"][is_enough].min()) if is_enough.any() else EVALUATIONS + 1)
    lines = (
        f"best run_duration_max of {len(best)} searches: {', '.join(map(str, sorted(best)))} ms",
        f"evaluations until one is above {ENOUGH_MS} ms: median {np.median(first):g}, at most {max(first)}",
    )
    return Outcome(lines, (Claim(f"all above {ENOUGH_MS} ms in {EVALUATIONS} evaluations", min(best) > ENOUGH_MS),))
