"""Work that is done for one run after the other, or for several at the same time, with a progress bar on a terminal."""

from __future__ import annotations

import argparse
import multiprocessing
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Generic, TypeVar

from tqdm import tqdm

S = TypeVar("S")
T = TypeVar("T")


def for_each_run(work: Callable[[S], T], runs: Sequence[S], options: argparse.Namespace, what: str) -> list[T]:
    """Do some work for each run.

    Args:
        work: A function of a run, or of a run and what else belongs to it. If --jobs asks for several processes, it
            and what it returns are pickled: a function of a module, or a `functools.partial` of one.
        runs: The runs, each perhaps with what else belongs to it.
        options: Those of the command line; `jobs` is the number of processes, 1 without it.
        what: What is computed, for the progress bar.

    Returns:
        What the function returns, in the order of the runs. Its warnings are given here.
    """
    jobs = min(getattr(options, "jobs", 1), len(runs))
    if jobs < 2:
        return list(shown(map(work, runs), len(runs), what))
    # A process that begins anew, since a copy of this one could wait forever for a lock of another library's thread.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        found = []
        for result, messages in shown(pool.map(Watched(work), runs), len(runs), what):
            found.append(result)
            for message in messages:
                warnings.warn(message, stacklevel=2)
        return found


def shown(results: Iterable[T], count: int, what: str) -> Iterator[T]:
    """Return the results, and say on a terminal how many of so many are there."""
    return iter(tqdm(results, desc=what, total=count, unit="run", leave=False, disable=None))


class Watched(Generic[S, T]):
    """A function of a run, which also returns the warnings that it gives."""

    def __init__(self, work: Callable[[S], T]) -> None:
        self.work = work

    def __call__(self, run: S) -> tuple[T, list[Warning]]:
        """Do the work."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = self.work(run)
        return result, [warning.message for warning in caught if isinstance(warning.message, Warning)]
