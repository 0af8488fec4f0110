"""How many rows have been read: a function that shows it is called with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Tell = Callable[[int], None]

told: ContextVar[Tell | None] = ContextVar("told", default=None)


@contextmanager
def telling(tell: Tell) -> Iterator[None]:
    """Have a function called with the number of rows whenever some have been read, until the end of the block."""
    token = told.set(tell)
    try:
        yield
    finally:
        told.reset(token)


def rows_read(count: int) -> None:
    """Tell that so many rows have been read."""
    tell = told.get()
    if tell is not None:
        tell(count)
