"""A batch that is open: what its runs have in common, and its folder for temporary files meanwhile."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.runs.identity import find_program, program_digest
from pogosim.batch.runs.run import RunSettings, Task
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.tasks import check_logs_data, tasks_of
from pogosim.batch.runs.temporary import TemporaryFolder


class OpenBatch:
    """A batch of runs of one program.

    Args:
        configuration: The file in which its runs begin; files that it names are searched beside it, too.
        program: Program compiled for Pogosim.
        temporary: Folder for temporary files.
        policy: How the runs are done.

    Attributes:
        settings: What all runs have in common.
        file_digests: Digests of the files that configurations name, as far as they are known.

    Raises:
        BatchError: The program cannot be used.
    """

    def __init__(
        self, configuration: Configuration, program: str, temporary: TemporaryFolder, policy: RunPolicy
    ) -> None:
        self.configuration = configuration
        self.temporary = temporary
        path, beside = find_program(program), configuration.path.absolute().parent
        self.settings = RunSettings(path, program_digest(path), beside, temporary, policy)
        self.file_digests: dict[Path, str] = {}

    @contextlib.contextmanager
    def held(self, written: Iterable[str] = ()) -> Iterator[None]:
        """Keep the folder for temporary files for this batch meanwhile.

        Args:
            written: Files in it that are removed at the end.

        Raises:
            BatchError: The same batch is open already, or the folder cannot be used.
        """
        with self.temporary.locked():
            self.temporary.remove_leftovers()
            try:
                yield
            finally:
                self.temporary.tidy(written)

    def tasks_of(self, entries: dict[str, Any], seeds: Sequence[int]) -> list[Task]:
        """Return the runs of a configuration, one per seed.

        Raises:
            BatchError: They would write no data.
        """
        check_logs_data(entries, self.configuration)
        return tasks_of(entries, seeds, self.settings, self.file_digests)

    def forget_runs(self) -> None:
        """Remove what single runs have left, when all are done and nothing needs their data files any more."""
        self.temporary.forget_finished_runs()
        self.temporary.remove_leftovers()  # of workers that were killed
