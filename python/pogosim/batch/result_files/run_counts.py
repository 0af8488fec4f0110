"""How many runs there are of each number, in memory that grows with what is told apart, not with the numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise, repeat


@dataclass(frozen=True)
class RunCounts:
    """A step function of the number of a run.

    Attributes:
        steps: Numbers at which the count changes, in ascending order, each with the count from there on. It is 0 before
            the first and from the last one on.
    """

    steps: tuple[tuple[int, int], ...] = ()

    @staticmethod
    def of(ranges: Iterable[tuple[int, int]]) -> RunCounts:
        """Return the counts of ranges, each of which has its first number, but not its last."""
        changes: Counter[int] = Counter()
        for first, end in ranges:
            changes[first] += 1
            changes[end] -= 1
        steps, count = [], 0
        for number in sorted(number for number, change in changes.items() if change):
            count += changes[number]
            steps.append((number, count))
        return RunCounts(tuple(steps))

    def joined(self, other: RunCounts, by: Callable[[int, int], int]) -> RunCounts:
        """Return the counts that a function makes of two; of 0 and 0, it makes 0."""
        own, others = dict(self.steps), dict(other.steps)
        steps: list[tuple[int, int]] = []
        count = own_count = other_count = 0
        for number in sorted({*own, *others}):
            own_count, other_count = own.get(number, own_count), others.get(number, other_count)
            if by(own_count, other_count) != count:
                count = by(own_count, other_count)
                steps.append((number, count))
        return RunCounts(tuple(steps))

    @property
    def total(self) -> int:
        """How many runs there are."""
        return sum(count * (end - first) for (first, count), (end, _) in pairwise(self.steps))

    @property
    def end(self) -> int:
        """The number after the greatest one; 0 if there are none."""
        return self.steps[-1][0] if self.steps else 0

    def numbers(self) -> Iterator[int]:
        """Yield the numbers in ascending order, each as often as it counts."""
        for (first, count), (end, _) in pairwise(self.steps):
            if count:
                for number in range(first, end):
                    yield from repeat(number, count)


def gaps(whole: range, taken: Iterable[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Yield what is left of a range without others, in ascending order; each has its first number, but not its last.

    Args:
        whole: The range.
        taken: The others, sorted.
    """
    at = whole.start
    for first, end in taken:
        if first >= whole.stop:
            break
        if first > at:
            yield at, first
        at = max(at, end)
    if at < whole.stop:
        yield at, whole.stop
