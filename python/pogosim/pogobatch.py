"""Many runs of a program, with every combination of the options in a configuration, joined into files of results.

    pogobatch run -c conf/batch/test.yaml -S ./examples/hanabi/hanabi --seeds 0:9 -t tmp -o results

`python -m pogosim.pogobatch` is the same command, and `run_local_campaign` the same in Python. Extend
`PogobotBatchRunner` for anything else.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from pogosim.batch.campaign import LocalCampaignError, LocalCampaignResult, run_local_campaign
from pogosim.batch.command_line import main
from pogosim.batch.configurations.options import expand_batch_options
from pogosim.batch.configurations.paths import get_by_dotted_path, set_in_dict
from pogosim.batch.configurations.sweeps import (
    build_combinations,
    compute_extra_columns,
    compute_result_filename,
    count_combinations,
    expand_combinations,
    make_rundra_sweep_config,
    resolve_batch_defaults,
)
from pogosim.batch.errors import BatchError
from pogosim.batch.merging import discover_task_artifacts, merge_task_artifacts
from pogosim.batch.runner import PogobotBatchRunner
from pogosim.batch.single_task import TaskArtifact, TaskError, execute_task
from pogosim.command.main import pogobatch

PogobatchError = BatchError  # its name in scripts written for the original simulator

__all__ = [
    "BatchError",
    "LocalCampaignError",
    "LocalCampaignResult",
    "PogobatchError",
    "PogobotBatchRunner",
    "PogobotLauncher",
    "TaskArtifact",
    "TaskError",
    "build_combinations",
    "compute_extra_columns",
    "compute_result_filename",
    "count_combinations",
    "discover_task_artifacts",
    "execute_task",
    "expand_batch_options",
    "expand_combinations",
    "get_by_dotted_path",
    "main",
    "make_rundra_sweep_config",
    "merge_task_artifacts",
    "resolve_batch_defaults",
    "run_local_campaign",
    "set_in_dict",
]


class PogobotLauncher:
    """Several runs of one configuration, without looking at its options, into one file.

    Args:
        num_instances: Number of runs, at least 1.
        base_config_path: Configuration.
        combined_output_path: File of results.
        simulator_binary: Program compiled for Pogosim.
        temp_base: Folder for temporary files.
        backend: As for `PogobotBatchRunner`; so are the following.
        keep_temp: See there.
        retries: See there.
        gui: See there.

    Raises:
        BatchError: An argument is wrong, or the configuration cannot be read.
    """

    def __init__(
        self,
        num_instances: int,
        base_config_path: str,
        combined_output_path: str,
        simulator_binary: str,
        temp_base: str = "tmp",
        backend: str = "multiprocessing",
        keep_temp: bool = False,
        retries: int = 5,
        gui: bool = False,
    ) -> None:
        self.path = base_config_path
        self.output = combined_output_path
        self.runner = PogobotBatchRunner(
            base_config_path,
            num_instances,
            simulator_binary,
            temp_base,
            ".",
            backend=backend,
            keep_temp=keep_temp,
            retries=retries,
            gui=gui,
        )

    def launch_all(self, seeds: Sequence[int] | None = None) -> str:
        """Do all runs; returns the file of results.

        Args:
            seeds: Seed of each run; None: 0, 1, ...

        Raises:
            BatchError: They cannot be done.
        """
        if seeds is not None and len(seeds) < self.runner.runs:
            raise BatchError(f"expected {self.runner.runs} seeds, one per run; found {len(seeds)}")
        self.runner.seeds = range(self.runner.runs) if seeds is None else seeds
        return self.runner.run_launcher_for_combination(self.path, self.output)


if __name__ == "__main__":
    sys.exit(pogobatch())
