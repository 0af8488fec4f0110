"""A batch with seeds of one's own choice, called from Python, which says in a manifest what was done."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pogosim
from pogosim.batch.configurations.seeds import listed_seeds
from pogosim.batch.errors import BatchError, at_least, given
from pogosim.batch.result_files.manifests import CAMPAIGN, CAMPAIGN_VERSION, check_campaign, write_json
from pogosim.batch.runner import PogobotBatchRunner
from pogosim.outputs import PathLike


@dataclass(frozen=True)
class LocalCampaignResult:
    """What a campaign has done.

    Attributes:
        outputs: Files of results, each once, in the order of the combinations.
        manifest_path: `pogobatch_run.json`, in the folder of the results.
        task_count: Number of runs: combinations times seeds.
        combination_count: Number of combinations of options.
        seeds: Seeds of the runs of each combination.
        effective_jobs: Number of runs at the same time, at most.
        retained_temp_dir: Folder with the files of single runs; None: they are removed.
        replaced: A map for each run that failed and was done with another seed: `combination_ordinal`, `logical_run`,
            `seed` (its own), `retry_attempt`, `replacement_seed` and `error` (of its first attempt; empty if an
            interrupted call did it).
    """

    outputs: list[str]
    manifest_path: Path
    task_count: int
    combination_count: int
    seeds: tuple[int, ...]
    effective_jobs: int
    retained_temp_dir: Path | None
    replaced: tuple[Mapping[str, Any], ...] = ()


class LocalCampaignError(BatchError):
    """Runs failed again and again. The results have all others.

    Attributes:
        campaign_dir: Folder with what the failed runs have left: their configurations and logs, and the finished runs,
            which the same call does not do again.
        failures: A map for each failed run: `ok` (False), `combination_ordinal` (from 0 on), `logical_run` (from 0 on),
            `seed` (of its first attempt), `attempts` and `error`.
        result: What has been done nevertheless.
    """

    def __init__(
        self, message: str, campaign_dir: Path, failures: Sequence[Mapping[str, Any]], result: LocalCampaignResult
    ) -> None:
        super().__init__(message)
        self.campaign_dir = campaign_dir
        self.failures = list(failures)
        self.result = result


def run_local_campaign(
    config_path: PathLike,
    simulator_binary: PathLike,
    *,
    seeds: Iterable[int],
    output_dir: PathLike,
    temp_base: PathLike,
    backend: str = "multiprocessing",
    jobs: int = 0,
    retries: int = 5,
    retry_new_seed: bool = True,
    keep_temp: bool = False,
    isolated: bool = False,
    progress: bool = False,
    gui: bool = False,
    simulator_output: str = "normal",
    only_output: str | None = None,
    save_states: float | None = None,
) -> LocalCampaignResult:
    """Run a program with every combination of the options in a configuration, once for each seed.

    This is `pogobatch run`. The files of results have the columns `run` (0, 1, ... in the order of the seeds), `seed`,
    `retry_attempt`, and those of `result_new_columns`. Bytes depend neither on `jobs` nor on `backend`.

    Args:
        config_path: YAML file with options (`batch_options` and others).
        simulator_binary: Program compiled for Pogosim, or a Python file that behaves like one.
        seeds: Seeds of the runs of each combination: different whole numbers from 0 to 2^32-1.
        output_dir: Folder of the results, which is made.
        temp_base: Folder for files of single runs. Finished runs of an unfinished campaign are kept there.
        backend: "multiprocessing", "sequential" or "dask".
        jobs: Runs at the same time; 0: one per processor.
        retries: How many times a failed run is repeated.
        retry_new_seed: With another seed, see `pogosim.batch.configurations.seeds`; False: with the same one.
        keep_temp: Keep the folders of single runs, each with its `pogobatch_task.json`.
        isolated: Each run is a process of its own; else, one process may do many, one after the other.
        progress: Say how many runs are done, also where there is no terminal.
        gui: Let each run open its window.
        simulator_output: "normal": warnings of simulators are shown; "quiet": they are not; "verbose": simulators and
            robots also print what they usually do into the logs of their runs.
        only_output: Do only combinations whose results have this name, or path.
        save_states: Save the state of each run after this wall-clock time each, in s: the same call goes on from there
            when it was ended. None: never.

    Raises:
        BatchError: It cannot be done. The message is one line.
        LocalCampaignError: Runs failed.
    """
    runner = PogobotBatchRunner(
        str(given.path("config_path", config_path)),
        None,
        str(given.path("simulator_binary", simulator_binary)),
        str(given.path("temp_base", temp_base)),
        str(given.path("output_dir", output_dir)),
        backend=backend,
        keep_temp=keep_temp,
        isolated=isolated,
        save_states=save_states,
        retries=retries,
        gui=gui,
        only_output=only_output or "",
        workers=at_least(0, jobs, "jobs") or None,
        seeds=listed_seeds(seeds, "seeds"),
        retry_new_seed=retry_new_seed,
        with_seeds=True,
        progress=progress,
        simulator_output=simulator_output,
    )
    return run_campaign(runner)


def run_campaign(runner: PogobotBatchRunner) -> LocalCampaignResult:
    """Do all runs of a batch, and write down what was done.

    Raises:
        BatchError: It cannot be done.
        LocalCampaignError: Runs failed.
    """
    path = Path(runner.output_dir) / CAMPAIGN
    check_campaign(path)
    runner.run_all()
    done = entries_of(runner)
    write_json(path, {"schema_version": CAMPAIGN_VERSION, "executor": "local", **done})
    failures, count = done["failures"], done["task_count"]
    folder = runner.temporary.path
    result = LocalCampaignResult(
        runner.generated,
        path,
        count,
        runner.combination_count,
        tuple(done["seeds"]),
        done["jobs"],
        folder if runner.keep_temp or failures else None,
        tuple(done["replaced"]),
    )
    if failures:
        first = failures[0]
        raise LocalCampaignError(
            f"{len(failures)} of {count} runs failed, first run {first['logical_run']} with seed {first['seed']}: "
            f"{first['error']}; what they left is in {folder}, and the same call does only them",
            folder,
            failures,
            result,
        )
    return result


def entries_of(runner: PogobotBatchRunner) -> dict[str, Any]:
    """Return what a batch has done, for its manifest."""
    count = runner.combination_count * runner.runs
    return {
        "config": runner.multi_config_file,
        "task_count": count,
        "combinations": runner.combination_count,
        "seeds": list(runner.seeds),
        "backend": runner.workers.name,
        "jobs": min(runner.workers.at_once, count),
        "retry_new_seed": runner.policy.retry_new_seed,
        "outputs": runner.generated,
        "failures": [
            {
                "ok": False,
                "combination_ordinal": failure.combination,
                "logical_run": failure.task.run,
                "seed": failure.task.seed,
                "attempts": failure.outcome.attempts,
                "error": failure.outcome.problem,
            }
            for failure in sorted(runner.failures, key=lambda failure: (failure.combination, failure.task.run))
        ],
        "replaced": [
            {
                "combination_ordinal": run.combination,
                "logical_run": run.task.run,
                "seed": run.task.seed,
                "retry_attempt": run.replacement,
                "replacement_seed": run.task.seed_of(run.replacement),
                "error": run.problem,
            }
            for run in runner.replaced
        ],
        "pogosim_version": pogosim.__version__,
    }
