"""How runs are done, whichever they are: as a process of their own, again after a failure, from saved states."""

from __future__ import annotations

from dataclasses import dataclass

from pogosim.batch.errors import BatchError, at_least

QUIET = ("-nr", "-q")  # a simulator prints warnings and errors only
MOST_SECONDS = 1e6  # between states


@dataclass(frozen=True)
class RunPolicy:
    """How runs are done, as options say.

    Args:
        retries: How many times a failed run is repeated.
        retry_new_seed: Repeat it with another seed, see `pogosim.batch.configurations.seeds`; else, with the same one.
        gui: Let each run open its window.
        is_isolated: Each run is a process of its own; else, one process may do many, one after the other.
        save_every_s: Wall-clock time, in s, after which the state of each run is saved, to go on from; None: never.
        says: What a simulator is asked to print, into the log of its run.

    Raises:
        BatchError: A number is out of its range.
    """

    retries: int = 5
    retry_new_seed: bool = False
    gui: bool = False
    is_isolated: bool = False
    save_every_s: float | None = None
    says: tuple[str, ...] = QUIET

    def __post_init__(self) -> None:
        if self.save_every_s is not None and not 0.0 <= self.save_every_s <= MOST_SECONDS:
            raise BatchError(
                f"--save-states: expected a time from 0 to {MOST_SECONDS:.0f} s; found {self.save_every_s:g}"
            )
        at_least(0, self.retries, "--retries")
