"""The files of results of a batch: combinations with the same one are joined in it."""

from __future__ import annotations

import logging
from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import replace

from pogosim.batch.errors import cannot
from pogosim.batch.result_files.parts import PLAIN, Format, Part
from pogosim.batch.result_files.results import check_output, write_results
from pogosim.batch.runs.run import Outcome
from pogosim.batch.runs.run_data import RunFile
from pogosim.batch.runs.tasks import Combination
from pogosim.table_formats import CSV, format_of, metadata_path

log = logging.getLogger("pogobatch")


def remove_stale(output: str) -> None:
    """Remove results of an earlier batch.

    Raises:
        BatchError: They cannot be removed.
    """
    real = check_output(output)
    try:
        if real.exists():
            real.unlink()
            if format_of(real) == CSV:
                metadata_path(real).unlink(missing_ok=True)
            log.debug("Removed stale result file: %s", output)
    except OSError as error:
        raise cannot("remove", output, error) from None


def removing_stale(outputs: Iterable[str], outcomes: Generator[Outcome, None, None]) -> Generator[Outcome, None, None]:
    """Pass on what became of runs. The first one that ends well removes results of an earlier batch.

    Until then, they stay: a mistake in the configuration loses nothing.

    Raises:
        BatchError: They cannot be removed.
    """
    is_first = True
    try:
        for outcome in outcomes:
            if is_first and not outcome.problem:
                is_first = False
                for output in outputs:
                    remove_stale(output)
            yield outcome
    finally:
        outcomes.close()


def part_of(combination: Combination, finished: Mapping[str, RunFile], layout: Format) -> Part:
    """Return what a combination adds to a file of results, see `join`."""
    return Part(
        combination.columns,
        [replace(finished[task.key], run=task.run) for task in combination.tasks if task.key in finished],
        [task.run for task in combination.tasks if task.key not in finished],
        combination.config_hash if layout.with_manifest else "",
    )


def join(
    combinations: Sequence[Combination], finished: Mapping[str, RunFile], text: str, layout: Format = PLAIN
) -> bool:
    """Write one file of results. Returns whether there was anything to write.

    Args:
        combinations: Those whose results are in it, at least one.
        finished: Runs that are done, by key; others are missing in the results.
        text: Configuration of the batch.
        layout: What the file has beside the rows of the runs.

    Raises:
        BatchError: It cannot be written.
    """
    parts = [part_of(combination, finished, layout) for combination in combinations]
    output = combinations[0].output
    if not any(part.runs for part in parts):
        log.error("%s is not written: none of its runs ended well", output)
        return False
    write_results(output, parts, text, layout)
    rows = [part.rows for part in parts]
    log.debug("Created %s with %d rows%s", output, sum(rows), f" ({', '.join(map(str, rows))})" if rows[1:] else "")
    return True
