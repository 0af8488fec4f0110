"""A whole search, from the command line to the results."""

from __future__ import annotations

import argparse
import contextlib
import logging
import time
from pathlib import Path

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.reports import Progress
from pogosim.batch.rows import Runs
from pogosim.batch.runs.run_files import found_beside
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.tasks import check_logs_data
from pogosim.batch.workers.backends import Workers
from pogosim.batch.workers.jobqueue_options import asked_jobs
from pogosim.errors import OptimizeError
from pogosim.optimize.history import JOURNAL, Journal
from pogosim.optimize.objective import Objective, load_objective
from pogosim.optimize.optimizers.base import Optimizer
from pogosim.optimize.outcome import finish, refresh
from pogosim.optimize.results import check_outputs, remove_stale
from pogosim.optimize.search import Search, description_of
from pogosim.optimize.settings import Settings
from pogosim.optimize.variables import Space, as_json

DONE = 0
NOTHING_FOUND = 3
REFRESHING = 20  # ratio of search time to the time for writing intermediate results

log = logging.getLogger("pogosim.optimize")


def objective_of(settings: Settings, beside: Path) -> Objective:
    """Return the objective functions: those of the file, or else the defaults, with a warning.

    Args:
        settings: They name the file.
        beside: Folder of the configuration, where the file is searched, too.

    Raises:
        OptimizeError: They cannot be had.
    """
    if settings.objective:
        path = found_beside(settings.objective, beside)
        objective = load_objective(path, settings.objective_func, settings.features_func, settings.objective_names)
        others = ", ".join(objective.others)
        advice = f" ({others} is there, too; --objective-func chooses)" if others else ""
        log.info("Objective: %s, %s%s", path, objective.name, advice)
        other = beside / settings.objective
        if other.is_file() and not other.samefile(path):
            log.warning("%s is not the objective, but %s of the working folder: both have this name", other, path)
        return objective
    for name in ("objective_func", "features_func"):
        if getattr(settings, name) is not None:
            raise OptimizeError(f"{settings.place_of(name)} goes with --objective FILE.py")
    log.warning(
        "No objective script provided; DEFAULT fitness = mean MSD (features default to [max MSD, std MSD]). "
        "Yours: --objective FILE.py"
    )
    return Objective()


def workers_of(arguments: argparse.Namespace, settings: Settings) -> Workers:
    """Return what does the runs; `parallelism` says how many at once on this machine, unless --workers does."""
    jobs = asked_jobs(arguments)
    number = arguments.workers
    if number is None and settings.batch_jobs and jobs is None:
        number = settings.candidate_jobs * settings.batch_jobs
    return Workers(settings.backend, number, arguments.scheduler, jobs)


def say_where_it_starts(space: Space) -> None:
    """Log the initial values, and the variables whose initial value the configuration does not give."""
    log.info("Evaluation 1, the initial values: %s", as_json(space.values_at(space.init)))
    if unsaid := [variable.name for variable in space.variables if not variable.has_init]:
        log.info(
            "Without init, these start in the middle of their range, or with the first choice: %s", ", ".join(unsaid)
        )


def optimize(
    arguments: argparse.Namespace, configuration: Configuration, settings: Settings, space: Space, optimizer: Optimizer
) -> int:
    """Do what the command line says; returns the exit code.

    Args:
        arguments: The command line.
        configuration: In which the search begins.
        settings: Those of the command line and of the configuration together.
        space: Variables of the configuration.
        optimizer: Searches in this space.

    Raises:
        OptimizeError, BatchError, OutputError: It cannot be done.
    """
    objective = objective_of(settings, configuration.path.absolute().parent)
    with_features = getattr(optimizer, "needs_features", False)
    if with_features and settings.qd_init_samples + 1 >= settings.max_evals:
        log.warning(
            "all evaluations but the first are random samples: %s is %d, and %s %d",
            settings.place_of("max_evals"),
            settings.max_evals,
            settings.place_of("qd_init_samples"),
            settings.qd_init_samples,
        )
    folder = Path(settings.output_dir)
    own_files = [] if objective.path is None else [str(objective.path)]
    check_outputs(folder, [arguments.config, arguments.simulator_binary, *own_files])
    check_logs_data(configuration.entries, configuration)
    runs = Runs(
        configuration,
        arguments.simulator_binary,
        settings.temp_base,
        settings.output_dir,
        workers_of(arguments, settings),
        RunPolicy(
            settings.retries,
            settings.retry_new_seed,
            is_isolated=arguments.isolated,
            save_every_s=arguments.save_states,
        ),
        settings.keep_temp,
    )
    digests = runs.digests | objective.digests
    journal = Journal(folder / JOURNAL, description_of(space, settings, digests), arguments.resume)
    started_s = time.monotonic()
    with contextlib.closing(journal), runs.opened():
        if journal.replaces:
            log.info("An earlier search in %s is finished; the results of this one replace it", folder)
        if journal.known:
            log.info("Resuming: %d evaluations are done already", len(journal.known))
        log.info(
            "Starting the search: %s | dim=%d | max_evals=%d (normalised space)",
            settings.optimizer.upper(),
            len(space.variables),
            settings.max_evals,
        )
        say_where_it_starts(space)
        progress = Progress(settings.max_evals, "evaluation")
        search = Search(space, objective, settings, optimizer, runs, journal, with_features, progress.update)
        try:
            with progress.beside(log, logging.getLogger("pogobatch")):
                due_s = 0.0
                for _ in search.generations():
                    began_s = time.monotonic()
                    if not due_s and not journal.known:
                        remove_stale(folder)
                    if began_s >= due_s:
                        refresh(folder, search)
                        # All is written each time, which takes longer and longer; the journal has every evaluation.
                        due_s = time.monotonic() + REFRESHING * (time.monotonic() - began_s)
                refresh(folder, search)
        finally:
            progress.close()
        is_found = finish(folder, search, configuration, time.monotonic() - started_s)
    return DONE if is_found else NOTHING_FOUND
