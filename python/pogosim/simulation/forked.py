"""What holds of objects in a forked child of the process that has made them.

The child has copies of the objects, but none of their threads, and it shares their files with its parent. So an object
keeps `os.getpid()` of the process that makes it.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable

from pogosim.simulation.errors import SimulationError


def is_forked(process: int) -> bool:
    """Tell whether this process is another one than that which has made something."""
    return os.getpid() != process


def check_process(process: int) -> None:
    """Raise SimulationError in a child of the process that has made a run: both would write the same files."""
    if is_forked(process):
        raise SimulationError(
            f"the simulation belongs to process {process}, which has forked this one: make one of its own here"
        )


def call_in(process: int, function: Callable[..., object], *arguments: object) -> None:
    """Call a function in one process, and not in its children."""
    if not is_forked(process):
        function(*arguments)


def finalize_here(owner: object, function: Callable[..., object], *arguments: object) -> Callable[[], object]:
    """Return what calls a function once, and is called at the end of an object; in a forked child, it does nothing."""
    return weakref.finalize(owner, call_in, os.getpid(), function, *arguments)
