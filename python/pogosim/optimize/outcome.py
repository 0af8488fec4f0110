"""The end of a search: the best candidate and the initial values run on fresh seeds, and all is written down."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.errors import cannot
from pogosim.batch.rows import Finished
from pogosim.batch.runs.attempts import command_of_users
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
        write_summary(
            folder, {**summary_of(search, "failed"), "files": {"history": HISTORY, "history_table": HISTORY_TABLE}}
        )
        search.journal.finish(len(search.history))
        return False
    warn_if_flat(search)
    outcome = fresh_runs(folder, search, best)
    archive = write_archive(folder, search, configuration)
    summary: dict[str, Any] = {
        **summary_of(search, "complete"),
        "best_eval": best.number,
        "best_fitness": best.fitness,
        "best_values": best.values,
        "best_fresh": as_entries(outcome.best),
        "initial_values": search.initial.values,
        "initial_fitness": search.initial.fitness,
        "initial_fresh": as_entries(outcome.initial),
        "gain": as_entries(outcome.gain),
        **({} if archive is None else {"qd": archive}),
        "workers": search.runs.workers.count,
        "wall_clock_s": round(wall_clock_s, 3),
        "simulator_s": round(simulator_s, 3),
        "files": {
            "history": HISTORY,
            "history_table": HISTORY_TABLE,
            "best_config": BEST,
            "convergence": CONVERGENCE,
            **({} if outcome.best is None else {"best_results": BEST_ROWS}),
        },
    }
    write_summary(folder, summary)
    search.journal.finish(len(search.history))
    draw_convergence(folder / CONVERGENCE, search.history, outcome.best, outcome.initial)
    tell(search, best, outcome)
    if archive is not None:
        cells = f"{archive['cells_filled']} of {math.prod(archive['shape'])} cells"
        log.info("Archive: %s filled; see %s and %s", cells, folder / ARCHIVE, folder / ELITES)
    log.info("Written to %s; run it: %s", folder, command_of_users(search.runs.program, folder / BEST))
    return True


def summary_of(search: Search, status: str) -> dict[str, Any]:
    """Return what a summary says of any search."""
    settings = search.settings
    failed = sum(e.fitness is None for e in search.history)
    return {
        "status": status,
        "optimizer": settings.optimizer,
        "max_evals": settings.max_evals,
        "budget": settings.max_evals,
        "evaluations": len(search.history),
        "successful_evaluations": len(search.history) - failed,
        "failed": failed,
        "failed_evaluations": failed,
        "runs": settings.runs,
        "seed": settings.seed,
        "seeds": settings.seeds,
        "seed_block_offset": settings.first_seed,
        "parallelism": {"candidate_jobs": settings.candidate_jobs, "batch_jobs": settings.batch_jobs},
        "settings": {name: value for name, value in asdict(settings).items() if name != "places"},
    }


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


def tell(search: Search, best: Evaluation, outcome: Outcome) -> None:
    """Say what the best candidate is, and whether it is better than the initial values."""
    if outcome.best is None:
        log.info("Done. Best fitness: %.6g, in the search", best.fitness)
    else:
        seeds = f"{len(outcome.best.seeds)} fresh seed{'s' if len(outcome.best.seeds) != 1 else ''}"
        log.info(
            "Done. Best fitness: %s; %.6g in the search", with_interval(outcome.best, f" on {seeds}"), best.fitness
        )
    if best.values == search.initial.values:
        log.warning("the best values are the initial ones: no candidate was better")
    elif outcome.initial is not None and outcome.gain is not None:
        in_search = search.initial.fitness
        log.info(
            "Initial values: %s; %.6g in the search", with_interval(outcome.initial, " on the same seeds"), in_search
        )
        log.info("Gain: %s", with_interval(outcome.gain, ", the mean difference seed by seed"))
        warn_of_gain(outcome.gain)
    log.info("Best values: %s", as_json(best.values))


def with_interval(fresh: FreshRuns, what: str) -> str:
    """Return a mean with what it is of, and its confidence interval if there is one."""
    interval = f" (95 % interval {fresh.low:.6g} to {fresh.high:.6g})" if np.isfinite(fresh.low) else ""
    return f"{fresh.mean:.6g}{what}{interval}"


def warn_of_gain(gain: FreshRuns) -> None:
    """Say so if the best candidate is not clearly better than the initial values."""
    if not np.isfinite(gain.low):
        log.warning("one fresh run says nothing of chance: --final-runs 10 gives an interval of the gain")
    elif gain.high < 0.0:
        log.warning(
            "the best values are worse than the initial ones: the search has taken luck for fitness; raise --runs"
        )
    elif gain.low <= 0.0:
        log.warning(
            "the interval of the gain contains 0: tuning may have gained nothing; more --final-runs make the interval "
            "narrower, more --runs and --max-evals the search better"
        )


def as_entries(fresh: FreshRuns | None) -> dict[str, Any] | None:
    """Return what fresh runs say, for the summary; no interval: null."""
    if fresh is None:
        return None
    low, high = (value if np.isfinite(value) else None for value in (fresh.low, fresh.high))
    return {
        "mean": fresh.mean,
        "low_95": low,
        "high_95": high,
        "seeds": list(fresh.seeds),
        "fitness": list(fresh.fitness),
    }


@dataclass(frozen=True)
class Outcome:
    """Results of the runs on fresh seeds; None where no run could be judged.

    Attributes:
        best: Fresh runs of the best candidate.
        initial: Fresh runs of the initial values, with the same seeds.
        gain: Difference of the two, seed by seed, on those seeds that both have.
    """

    best: FreshRuns | None = None
    initial: FreshRuns | None = None

    @property
    def gain(self) -> FreshRuns | None:
        """See above. Chance that the seeds have in common, such as the first places of robots, is not in it."""
        if self.best is None or self.initial is None:
            return None
        before = dict(zip(self.initial.seeds, self.initial.fitness, strict=True))
        after = dict(zip(self.best.seeds, self.best.fitness, strict=True))
        return averaged({seed: value - before[seed] for seed, value in after.items() if seed in before})


def averaged(values: Mapping[int, float]) -> FreshRuns | None:
    """Return values of seeds with their mean and its confidence interval; None if there are none."""
    if not values:
        return None
    row = mean_over_runs(pd.DataFrame([values])).iloc[0]
    return FreshRuns(list(values), list(values.values()), float(row["mean"]), float(row["low"]), float(row["high"]))


def fresh_runs(folder: Path, search: Search, best: Evaluation) -> Outcome:
    """Run the best candidate and the initial values on the same fresh seeds, and judge each run alone.

    The greatest of many noisy values is too great: only runs that had no part in choosing the candidate say what it
    does.
    """
    seeds = search.settings.fresh_seeds
    path = folder / BEST_ROWS
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise cannot("remove", path, error) from None
    if not seeds:
        return Outcome()
    is_initial = search.initial.values == best.values
    candidates = {"best candidate": best}
    if search.initial.fitness is None:
        log.warning("the initial values have failed, so there is nothing to compare the best ones with")
    elif not is_initial:
        candidates["initial values"] = search.initial
    names = list(candidates)
    configurations = [search.space.configuration(candidate.values) for candidate in candidates.values()]
    kept = [(path, best_text(search, best)), None]
    found = {
        names[finished.number]: judged(search, finished, seeds, names[finished.number])
        for finished in search.runs.rows_of(configurations, [seeds] * len(names), lambda number: kept[number])
    }
    first = found["best candidate"]
    return Outcome(first, first if is_initial else found.get("initial values"))


def judged(search: Search, finished: Finished, seeds: Sequence[int], name: str) -> FreshRuns | None:
    """Judge each fresh run of a candidate; None, with a warning, if there are none."""
    if finished.rows is None:
        log.warning("no fresh runs of the %s: %s", name, finished.problem)
        return None
    # Runs of a batch are numbered 0, 1, ...; each has all combinations of the options that remain.
    said = {
        seed: search.objective.judge(finished.rows[finished.rows[RUN] == run].reset_index(drop=True))
        for run, seed in enumerate(seeds)
    }
    fitness = {seed: judgement.fitness for seed, judgement in said.items() if judgement.fitness is not None}
    if len(fitness) < len(seeds):
        problem = next(judgement.problem for judgement in said.values() if judgement.problem)
        failed = len(seeds) - len(fitness)
        log.warning("%d of %d fresh runs of the %s have failed: %s", failed, len(seeds), name, problem)
    return averaged(fitness)
