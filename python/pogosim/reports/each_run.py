"""Work that is done for one run after the other, or for several at the same time, with a progress bar on a terminal."""

from __future__ import annotations

import argparse
import multiprocessing
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Generic, NoReturn, TypeVar

from tqdm import tqdm

from pogosim.analysis.progress import telling
from pogosim.analysis.trajectories import Run

S = TypeVar("S")
T = TypeVar("T")


def for_each_run(
    work: Callable[[S], T], runs: Sequence[S], options: argparse.Namespace, what: str, passes: int = 1
) -> list[T]:
    """Do some work for each run.

    Args:
        work: A function of a run, or of a run and what else belongs to it. If --jobs asks for several processes, it
            and what it returns are pickled: a function of a module, or a `functools.partial` of one.
        runs: The runs, each perhaps with what else belongs to it.
        options: Those of the command line; `jobs` is the number of processes, 1 without it.
        what: What is computed, for the progress bar.
        passes: How many times the work goes through the rows of a run, for the progress bar.

    Returns:
        What the function returns, in the order of the runs. Its warnings are given here.
    """
    jobs = min(getattr(options, "jobs", 1), len(runs))
    with Bar(what, [passes * rows_in(run) for run in runs]) as bar:
        return list(bar.after_each(results_of(work, runs, jobs)))


def results_of(work: Callable[[S], T], runs: Sequence[S], jobs: int) -> Iterator[T]:
    """Yield what a function returns for each run, done by so many processes; gives its warnings."""
    if jobs < 2:
        yield from map(work, runs)
        return
    # A process that begins anew, since a copy of this one could wait forever for a lock of another library's thread.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        for result, messages in pool.map(Watched(work), runs):
            for message in messages:
                warnings.warn(message, stacklevel=2)
            yield result


def rows_in(run: object) -> int:
    """Return how many rows a run has, perhaps with what else belongs to it; 1 for anything else."""
    first = run[0] if isinstance(run, tuple) else run
    return int(first.present.sum()) if isinstance(first, Run) else 1


class Bar:
    """A bar on a terminal that says how many rows are done, also within a run.

    Args:
        what: What is done.
        counts: Rows of each run, each as many times as they are read.
    """

    def __init__(self, what: str, counts: Sequence[int]) -> None:
        self.counts = counts
        self.bar: tqdm[NoReturn] = tqdm(
            desc=what, total=sum(counts), unit="row", unit_scale=True, leave=False, disable=None
        )
        self.begin = self.end = 0  # of the run that is being done
        self.now = 0

    def __enter__(self) -> Bar:
        self.told = telling(self.read)
        self.told.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self.told.__exit__(None, None, None)
        self.bar.close()

    def read(self, rows: int) -> None:
        """Go on by rows of the run that is being done, not beyond its end."""
        self.go_to(min(self.now + rows, self.end))

    def expect(self, rows: int) -> None:
        """Expect so many rows from now on."""
        self.end = self.bar.total = rows

    def go_to(self, place: int) -> None:
        """Go on to a number of rows."""
        self.bar.update(place - self.now)
        self.now = place

    def after_each(self, results: Iterable[T]) -> Iterator[T]:
        """Yield the results of the runs, and go on to the end of each one when its own is there."""
        source = iter(results)
        for count in self.counts:
            self.end += count
            yield next(source)
            self.go_to(self.end)
        yield from source  # none: lets it end


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
