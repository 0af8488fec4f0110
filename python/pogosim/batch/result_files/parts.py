"""What a file of results is made of: the runs of combinations, and the columns that a batch adds to theirs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pogosim.batch.runs.run_data import RunFile
from pogosim.run_columns import RETRY, RUN, SEED


@dataclass(frozen=True)
class Part:
    """The runs of one combination."""

    columns: dict[str, Any]  # constant columns
    runs: Sequence[RunFile]
    failed: Sequence[int] = ()  # runs without a data file
    config_hash: str = ""  # see pogosim.batch.runs.identity

    @property
    def rows(self) -> int:
        """Number of rows of all runs."""
        return sum(run.rows for run in self.runs)


@dataclass(frozen=True)
class Format:
    """What a file of results has beside the rows of the runs.

    Attributes:
        run_columns: Names of the columns that say which run a row is of: some of run, seed and retry_attempt.
        with_manifest: Whether the metadata have an entry `pogobatch_manifest`.
    """

    run_columns: tuple[str, ...] = (RUN,)
    with_manifest: bool = False


PLAIN = Format()
WITH_SEEDS = Format((RUN, SEED, RETRY))
OF_CAMPAIGNS = Format((RUN, SEED, RETRY), with_manifest=True)
