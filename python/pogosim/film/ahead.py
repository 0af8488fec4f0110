"""What one thread makes while another uses what was made before."""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Generator, Iterable
from typing import TypeVar

Item = TypeVar("Item")

PATIENCE_S = 0.1  # after which the thread looks whether something is still wanted


def made_ahead(items: Iterable[Item], most: int) -> Generator[Item, None, None]:
    """Yield items that a thread makes meanwhile, at most so many before they are wanted; an error comes in its turn.

    Args:
        items: What the thread iterates over. It ends soon after nothing more is wanted.
        most: At least 1.
    """
    made: queue.Queue[tuple[Item] | BaseException | None] = queue.Queue(most)
    is_wanted = threading.Event()
    is_wanted.set()

    def put(item: tuple[Item] | BaseException | None) -> None:
        is_made = False
        while not is_made and is_wanted.is_set():
            with contextlib.suppress(queue.Full):
                made.put(item, timeout=PATIENCE_S)
                is_made = True

    def make() -> None:
        try:
            for item in items:
                put((item,))
                if not is_wanted.is_set():
                    return
            put(None)
        except BaseException as error:
            put(error)

    thread = threading.Thread(target=make, name="pogosim-made-ahead", daemon=True)
    thread.start()
    try:
        while (item := made.get()) is not None:
            if isinstance(item, BaseException):
                raise item
            yield item[0]
    finally:
        is_wanted.clear()
        thread.join()
