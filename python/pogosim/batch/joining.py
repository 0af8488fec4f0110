"""The files of results of a batch: combinations with the same one are joined in it."""

from __future__ import annotations

import logging
from collections.abc import Generator, Sequence

from pogosim.batch.errors import cannot
from pogosim.batch.reports import Failure
from pogosim.batch.results import Part, RunFile, check_output, write_results
from pogosim.batch.run import Outcome
from pogosim.batch.tasks import Combination
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


def removing_stale(outputs: Sequence[str], outcomes: Generator[Outcome, None, None]) -> Generator[Outcome, None, None]:
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


def join(combinations: Sequence[Combination], failures: Sequence[Failure], text: str) -> bool:
    """Write one file of results. Returns whether there was anything to write.

    Args:
        combinations: Those whose results are in it, at least one.
        failures: Runs that are missing.
        text: Configuration of the batch.

    Raises:
        BatchError: It cannot be written.
    """
    failed = {failure.task.key for failure in failures}
    parts = [
        Part(
            combination.columns,
            [RunFile(task.result, task.run, task.seed) for task in combination.tasks if task.key not in failed],
            [task.run for task in combination.tasks if task.key in failed],
        )
        for combination in combinations
    ]
    output = combinations[0].output
    if not any(part.runs for part in parts):
        log.error("%s is not written: none of its runs ended well", output)
        return False
    written = write_results(output, parts, text)
    of_each = f" ({', '.join(map(str, written.rows))})" if len(written.rows) > 1 else ""
    log.debug("Created %s with %d rows%s", output, sum(written.rows), of_each)
    return True
