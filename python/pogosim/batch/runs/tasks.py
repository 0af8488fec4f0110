"""From the configuration of a combination to its runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.configuration import Configuration, dump_configuration
from pogosim.batch.configurations.seeds import replacements
from pogosim.batch.errors import BatchError
from pogosim.batch.runs.identity import config_hash, run_key, world_digest
from pogosim.batch.runs.run import RunSettings, Task
from pogosim.batch.runs.run_files import outputs_of, with_files_beside, with_places
from pogosim.table_formats import FEATHER, format_of
from pogosim.yaml_1_2 import plain


@dataclass
class Combination:
    """What is done with one combination of options."""

    output: str
    columns: dict[str, Any]
    entries: dict[str, Any]
    tasks: list[Task] = field(default_factory=list)
    name: str = ""  # of the output, in the folder of the results
    seeds: str = ""  # "A:B" of all its runs, also those that are left to other parts of a batch; empty: no such range

    @cached_property
    def config_hash(self) -> str:
        """What manifests know it by."""
        return config_hash(self.entries)


def check_logs_data(entries: dict[str, Any], configuration: Configuration) -> None:
    """Check that runs write data.

    Raises:
        BatchError: They do not; says where that stands.
    """
    if plain(entries.get("enable_data_logging")) is False:
        where = configuration.where(("enable_data_logging",))
        raise BatchError(f"{where}: is false, so runs write no data to join; set it to true")


def tasks_of(
    entries: dict[str, Any], seeds: Sequence[int], settings: RunSettings, digests: dict[Path, str]
) -> list[Task]:
    """Return the runs of a configuration, one per seed; `digests` are of files that configurations name."""
    outputs = outputs_of(entries)
    world = with_files_beside(with_places(entries, list(outputs)), settings.configuration_folder)
    if format_of(outputs["data_filename"]) != FEATHER:  # that of the results is another matter
        outputs["data_filename"] = f"{Path(outputs['data_filename']).stem}.feather"
    text = dump_configuration(world) if world else ""
    digest = world_digest(world, settings.folders, digests)
    policy = settings.policy
    others = replacements(seeds, policy.retries) if policy.retry_new_seed else [()] * len(seeds)
    return [
        Task(
            key=run_key(digest, settings.program_digest, seed),
            run=run,
            seed=seed,
            text=text,
            outputs=tuple(outputs.items()),
            settings=settings,
            replacements=others[run],
        )
        for run, seed in enumerate(seeds)
    ]
