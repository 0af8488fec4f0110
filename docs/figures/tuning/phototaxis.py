"""CMA-ES against random search, on robots that gather in light.

Both search the three parameters of conf/optim/phototaxis.yaml with the same number of evaluations. What they have found
is judged by runs with fresh seeds, and the two samples of searches are compared by their ranks: H. B. Mann and
D. R. Whitney, "On a test of whether one of two random variables is stochastically larger than the other", Annals of
Mathematical Statistics 18, 1947.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from pictures import ROOT
from scipy import stats

from .searches import Claim, Found, Outcome, example, search

NAME = "phototaxis"
OPTIMIZERS = {"cmaes": ("CMA-ES", "#1b6ca8"), "random": ("random search", "#d98200")}
SEEDS = 10
QUICK_SEEDS = 1
EVALUATIONS = 150
FINAL_RUNS = 20
QUICK_EVALUATIONS = 36  # the initial values, and five generations
QUICK_FINAL_RUNS = 20
QUICK = {"objects.robots.nb": 12, "simulation_time": 60.0, "optimization.runs": 1}
LEVEL = 0.05


def best_so_far(searches: list[Found]) -> pd.DataFrame:
    """Return the best fitness up to each evaluation, a column for each search."""
    return pd.DataFrame({str(i): found.history["best_so_far"] for i, found in enumerate(searches)})


def draw(found: dict[str, list[Found]]) -> Figure:
    """Draw the best fitness so far (median and quartiles), and what the best candidates do with fresh seeds."""
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(2, 1), sharey=True)
    for i, (name, searches) in enumerate(found.items()):
        label, colour = OPTIMIZERS[name]
        best = best_so_far(searches)
        low, middle, high = (best.quantile(share, axis=1) for share in (0.25, 0.5, 0.75))
        number = best.index + 1
        left.fill_between(number, low, high, step="post", color=colour, alpha=0.2, linewidth=0)
        left.step(number, middle, where="post", color=colour, label=label)
        fresh = [search.fresh_mean for search in searches]
        right.plot(np.full(len(fresh), i) + np.linspace(-0.1, 0.1, len(fresh)), fresh, ".", color=colour)
        right.plot([i - 0.2, i + 0.2], [np.median(fresh)] * 2, color=colour)
    left.set(xlabel="evaluation", ylabel="brightness at the robots", title="best so far, in the search")
    left.legend(loc="lower right", fontsize="small")
    labels = [OPTIMIZERS[name][0] for name in found]
    right.set(xticks=range(len(found)), xticklabels=labels, xlim=(-0.5, len(found) - 0.5), title="with fresh seeds")
    return figure


def measure(folder: Path, quick: bool) -> Outcome:
    """Search with several seeds of both optimisers."""
    evaluations, final_runs = (QUICK_EVALUATIONS, QUICK_FINAL_RUNS) if quick else (EVALUATIONS, FINAL_RUNS)
    found: dict[str, list[Found]] = {name: [] for name in OPTIMIZERS}
    for seed in range(QUICK_SEEDS if quick else SEEDS):
        for name, searches in found.items():
            options = ["--optimizer", name, "--seed", str(seed), "--max-evals", str(evaluations)]
            options += ["--final-runs", str(final_runs)]
            path = ROOT / "conf" / "optim" / "phototaxis.yaml"
            changes = QUICK if quick else {}
            searches.append(search(example("phototaxis"), path, folder / f"{name}_{seed}", options, changes))
    fresh = {name: np.array([search.fresh_mean for search in searches]) for name, searches in found.items()}
    promised = {name: np.array([s.summary["best_fitness"] for s in searches]) for name, searches in found.items()}
    lines = tuple(
        f"{OPTIMIZERS[name][0]}, {len(values)} searches: brightness {np.median(values):.3f} with fresh seeds (median; "
        f"{values.min():.3f} to {values.max():.3f}), {np.median(promised[name]):.3f} in the search"
        for name, values in fresh.items()
    )
    tables = (pd.DataFrame(fresh), *(best_so_far(searches) for searches in found.values()))
    if quick:  # so few searches tell nothing about ranks
        gain = found["cmaes"][0].summary["gain"]
        claim = Claim(f"CMA-ES gains on the initial values: {gain['mean']:.2f}", gain["low_95"] > 0.0)
    else:
        test = stats.mannwhitneyu(fresh["cmaes"], fresh["random"], alternative="greater", method="exact")
        claim = Claim(f"CMA-ES is better, p = {test.pvalue:.2g} below {LEVEL}", bool(test.pvalue < LEVEL))
    return Outcome(lines, (claim,), draw(found), tables)
