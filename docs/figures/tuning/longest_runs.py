"""run_and_tumble gets the farthest with the longest runs: a search must find the end of the range.

The displacement of a random walk grows with its persistence, as long as runs are short compared with the arena. So the
optimum of `run_duration_max` in conf/optim/simple.yaml, from 10 to 1000 ms, is 1000. The search begins at 50.
"""

from __future__ import annotations

from pathlib import Path

from pictures import ROOT

from .searches import Claim, Outcome, example, search

NAME = "longest_runs"
VARIABLE = "parameters.run_duration_max"
EVALUATIONS = 20
ENOUGH_MS = 900
RUNS = 5  # as in the article
USUAL_SEED = 42  # of pogoptim, if none is given
OTHER_SEEDS = 10
QUICK = {"objects.robots.nb": 30, "simulation_time": 30.0}


def measure(folder: Path, quick: bool) -> Outcome:
    """Search with several seeds of the optimiser."""
    options = [
        "--optimizer",
        "cmaes",
        "--runs",
        str(1 if quick else RUNS),
        "--max-evals",
        str(EVALUATIONS),
        "--final-runs",
        "0",
    ]
    best, first = [], []
    for seed in (USUAL_SEED, *(() if quick else range(OTHER_SEEDS))):
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
    lines = [f"best run_duration_max: {best[0]} ms; above {ENOUGH_MS} ms from evaluation {first[0]} on"]
    if not quick:
        others = sorted(best[1:])
        enough = sum(value > ENOUGH_MS for value in others)
        lines.append(f"{enough} of {len(others)} searches with other seeds end above {ENOUGH_MS} ms")
        lines.append(f"their results: {', '.join(map(str, others))} ms")
    claim = Claim(f"the article's example is above {ENOUGH_MS} ms in {EVALUATIONS} evaluations", best[0] > ENOUGH_MS)
    return Outcome(tuple(lines), (claim,))
