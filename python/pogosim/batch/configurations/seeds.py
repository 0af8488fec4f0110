"""Seeds of the runs of a batch: which ones are asked for, and which ones replace those of runs that failed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from pogosim.arguments import shown, without_numpy
from pogosim.batch.errors import BatchError

LARGEST = 2**32 - 1
RANGE = re.compile(r"\s*(\d{1,10})\s*:\s*(\d{1,10})\s*")
MOST = 10_000_000  # of one batch


def seeds_between(text: str, name: str) -> range:
    """Return the seeds that "A:B" stands for: A, A + 1, ..., B.

    Raises:
        BatchError: It has another form, or leaves no seed.
    """
    found = RANGE.fullmatch(text)
    first, last = (int(found[1]), int(found[2])) if found else (1, 0)
    if found and last < first <= LARGEST:
        raise BatchError(
            f"{name}: the first seed is greater than the last; expected {last}:{first}; found {shown(text)}"
        )
    if not first <= last <= LARGEST:
        raise BatchError(
            f"{name}: expected the first and the last seed, such as 0:9, both from 0 to {LARGEST}; found {shown(text)}"
        )
    return checked(range(first, last + 1), name)


def seeds_up_to(count: int, name: str) -> range:
    """Return the seeds 0, 1, ... of so many runs.

    Raises:
        BatchError: They are too few or too many.
    """
    if count < 1:
        raise BatchError(f"{name}: expected a whole number of at least 1; found {count}")
    return checked(range(count), name)


def range_text(seeds: Sequence[int]) -> str:
    """Return "A:B" for the seeds A, A + 1, ..., B; empty if they are others."""
    first = seeds[0] if seeds else 0
    return f"{first}:{seeds[-1]}" if seeds and all(seed == first + i for i, seed in enumerate(seeds)) else ""


def checked(seeds: range, name: str) -> range:
    """Return seeds of one batch, unless they are too many."""
    if len(seeds) > MOST:
        raise BatchError(f"{name}: {len(seeds)} seeds are more than {MOST}; make several batches")
    return seeds


def listed_seeds(seeds: Iterable[int] | str, name: str) -> Sequence[int]:
    """Return seeds that a caller gives: whole numbers from 0 to 2^32-1, each once, at least one.

    Raises:
        BatchError: They are others.
    """
    if isinstance(seeds, range) and seeds and 0 <= min(seeds[0], seeds[-1]) <= max(seeds[0], seeds[-1]) <= LARGEST:
        return checked(seeds, name)
    expected = f"{name}: expected whole numbers from 0 to {LARGEST}"
    if isinstance(seeds, (str, bytes)) or not isinstance(without_numpy(seeds), Iterable):
        raise BatchError(f"{expected}, such as range(10); found {shown(seeds)}")
    found = [without_numpy(seed) for seed in seeds]
    for seed in found:
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed <= LARGEST:
            raise BatchError(f"{expected}; found {shown(seed)}")
    if not found:
        raise BatchError(f"{expected}; found none")
    known: set[int] = set()
    for seed in found:
        if seed in known:
            raise BatchError(f"{name}: seed {seed} is there twice; its runs would be the same")
        known.add(seed)
    return found


def replacements(seeds: Sequence[int], retries: int) -> list[tuple[int, ...]]:
    """Return the seeds of the second, third, ... attempt of each run, after failures.

    The replacement `a` = 1, 2, ... of run `r` of `n` is max(seeds) + 1 + (a - 1) n + r: the seeds that follow all those
    of the batch, so no two attempts have the same one. With the seeds 0 to n - 1, that is r + a n. There are none above
    2^32 - 1: such a run has fewer attempts.
    """
    first, count = max(seeds) + 1, len(seeds)
    return [
        tuple(seed for seed in (first + run + a * count for a in range(retries)) if seed <= LARGEST)
        for run in range(count)
    ]
