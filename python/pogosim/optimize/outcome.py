"""The end of a search: the best candidate runs on seeds that the search has not seen, and all is written down."""

from __future__ import annotations

import logging
import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.batch.configuration import Configuration
from pogosim.batch.errors import cannot
from pogosim.confidence import mean_over_runs
from pogosim.optimize.archive import write_archive
from pogosim.optimize.history import Evaluation
from pogosim.optimize.plots import draw_convergence
from pogosim.optimize.results import (
    ARCHIVE,
    BEST,
    BEST_ROWS,
    CONVERGENCE,
    ELITES,
    HISTORY,
    HISTORY_TABLE,
    FreshRuns,
    configuration_text,
    write_history,
    write_summary,
    write_text,
)
from pogosim.optimize.search import Search
from pogosim.optimize.variables import as_json
from pogosim.run_columns import RUN

log = logging.getLogger("pogosim.optimize")


def refresh(folder: Path, search: Search) -> None:
    """Write down what has been found so far."""
    write_history(folder, search.history)
    best = search.best
    if best is not None:
        write_text(folder / BEST, best_text(search, best))


def best_text(search: Search, best: Evaluation) -> str:
    """Return the configuration of the best candidate."""
    notes = [
        f"The best of {len(search.history)} candidates of a search by {search.settings.optimizer}: evaluation "
        f"{best.number}, fitness {best.fitness:.6g}.",
        f"Values: {as_json(best.values)}",
    ]
    return configuration_text(search.space, best.values, search.runs.configuration.path.parent, notes)


def finish(folder: Path, search: Search, configuration: Configuration, wall_clock_s: float) -> bool:
    """Write all results, and say what the best one is. Returns whether there is one."""
    best = search.best
    simulator_s = search.runs.simulator_s
    if best is None:
        log.error("all %d candidates have failed; see the column problem of %s", len(search.history), folder / HISTORY)
        search.journal.finish(len(search.history))
        return False
    warn_if_flat(search)
    fresh = fresh_runs(folder, search, best)
    archive = write_archive(folder, search, configuration)
    summary: dict[str, Any] = {
        "optimizer": search.settings.optimizer,
        "max_evals": search.settings.max_evals,
        "evaluations": len(search.history),
        "failed": sum(e.fitness is None for e in search.history),
        "runs": search.settings.runs,
        "seed": search.settings.seed,
        "seeds": search.settings.seeds,
        "best_eval": best.number,
        "best_fitness": best.fitness,
        "best_values": best.values,
        "best_fresh": None if fresh is None else as_entries(fresh),
        **({} if archive is None else {"qd": archive}),
        "workers": search.runs.workers.count,
        "wall_clock_s": round(wall_clock_s, 3),
        "simulator_s": round(simulator_s, 3),
        "files": {
            "history": HISTORY,
            "history_table": HISTORY_TABLE,
            "best_config": BEST,
            "convergence": CONVERGENCE,
            **({} if fresh is None else {"best_results": BEST_ROWS}),
        },
    }
    write_summary(folder, summary)
    search.journal.finish(len(search.history))
    draw_convergence(folder / CONVERGENCE, search.history, fresh)
    tell(best, fresh)
    if archive is not None:
        cells = f"{archive['cells_filled']} of {math.prod(archive['shape'])} cells"
        log.info("Archive: %s filled; see %s and %s", cells, folder / ARCHIVE, folder / ELITES)
    log.info("Written to %s; run it: %s -c %s", folder, search.runs.program, folder / BEST)
    return True


def warn_if_flat(search: Search) -> None:
    """Warn if no parameter made a difference."""
    fitness = {e.fitness for e in search.history if e.fitness is not None}
    values = {as_json(e.values) for e in search.history}
    if len(fitness) == 1 and len(values) > 1:
        log.warning(
            "all candidates have the same fitness, %.6g: does the objective depend on what the parameters change, and "
            "does the program read %s?",
            fitness.pop(),
            ", ".join(variable.name for variable in search.space.variables),
        )


def tell(best: Evaluation, fresh: FreshRuns | None) -> None:
    """Say what the best candidate is."""
    if fresh is None:
        log.info("Done. Best fitness: %.6g, in the search", best.fitness)
    else:
        interval = f" (95 % interval {fresh.low:.6g} to {fresh.high:.6g})" if np.isfinite(fresh.low) else ""
        seeds = f"{len(fresh.seeds)} fresh seed{'s' if len(fresh.seeds) != 1 else ''}"
        log.info("Done. Best fitness: %.6g on %s%s; %.6g in the search", fresh.mean, seeds, interval, best.fitness)
    log.info("Best values: %s", as_json(best.values))


def as_entries(fresh: FreshRuns) -> dict[str, Any]:
    """Return what fresh runs say, for the summary; no interval: null."""
    low, high = (value if np.isfinite(value) else None for value in (fresh.low, fresh.high))
    return {
        "mean": fresh.mean,
        "low_95": low,
        "high_95": high,
        "seeds": list(fresh.seeds),
        "fitness": list(fresh.fitness),
    }


def fresh_runs(folder: Path, search: Search, best: Evaluation) -> FreshRuns | None:
    """Run the best candidate on fresh seeds, and judge each run alone; None if that cannot be done.

    The greatest of many noisy values is too great: only runs that had no part in choosing the candidate say what it
    does.
    """
    seeds = search.fresh_seeds()
    path = folder / BEST_ROWS
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise cannot("remove", path, error) from None
    if not seeds:
        return None
    configurations = [search.space.configuration(best.values)]
    text = best_text(search, best)
    (finished,) = search.runs.rows_of(configurations, [seeds], lambda _: (path, text))
    if finished.rows is None:
        log.warning("the best candidate has no fresh runs: %s", finished.problem)
        return None
    # Runs of a batch are numbered 0, 1, ...; each has all combinations of the options that remain.
    judged = {
        seed: search.objective.judge(finished.rows[finished.rows[RUN] == run].reset_index(drop=True))
        for run, seed in enumerate(seeds)
    }
    fitness = {seed: judgement.fitness for seed, judgement in judged.items() if judgement.fitness is not None}
    if len(fitness) < len(seeds):
        problem = next(judgement.problem for judgement in judged.values() if judgement.problem)
        log.warning("%d of %d fresh runs have failed: %s", len(seeds) - len(fitness), len(seeds), problem)
    if not fitness:
        return None
    row = mean_over_runs(pd.DataFrame([fitness])).iloc[0]
    return FreshRuns(list(fitness), list(fitness.values()), float(row["mean"]), float(row["low"]), float(row["high"]))
