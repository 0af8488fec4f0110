"""The terminal of `pogosim watch`: what is printed while a run is served, and the signals that end it."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import threading
from collections.abc import Iterator
from types import FrameType

from pogosim.errors import ToolError
from pogosim.lines import printable, say, say_error
from pogosim.watch.live import LiveRun

INTERRUPTED = 130
PATIENCE_S = 1.5  # before it is said that the end takes its time
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class OutputError(ToolError):
    """The standard output cannot be written."""


def print_out(*lines: str) -> None:
    """Print lines.

    Raises:
        OutputError: They cannot be written. Where there is no standard output, nothing is printed.
    """
    try:
        say(*lines)
    except OSError as error:
        raise OutputError(f"cannot write to the standard output: {error.strerror}") from None


class Told(logging.Handler):
    """Prints what robots and the simulator say, and tells it to viewers."""

    def __init__(self) -> None:
        """Keep lines until there is a live run."""
        super().__init__()
        self._live: LiveRun | None = None
        self._kept: list[str] = []

    def tell(self, live: LiveRun | None) -> None:
        """Tell lines to the viewers of a run from now on, and those that were kept; None: to none any more."""
        self._live = live
        if live is not None:
            for line in self._kept:
                live.say(line)
        self._kept.clear()

    def emit(self, record: logging.LogRecord) -> None:
        """Take a line. The run goes on where it cannot be printed."""
        text = printable(record.getMessage())
        is_robot = record.name == "pogosim.robots"
        line = text if is_robot or record.levelno < logging.WARNING else f"{record.levelname.lower()}: {text}"
        if is_robot:
            with contextlib.suppress(OSError):
                say(line)
        else:
            say_error(line)
        if self._live is not None:
            self._live.say(line)
        else:
            self._kept.append(line)


@contextlib.contextmanager
def told() -> Iterator[Told]:
    """Print lines of the logger "pogosim" until the end of the block."""
    handler = Told()
    logger = logging.getLogger("pogosim")
    before = logger.level, logger.propagate
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    logger.propagate = False
    try:
        yield handler
    finally:
        logger.removeHandler(handler)
        logger.level, logger.propagate = before


class Signals:
    """Ctrl-C, SIGTERM and SIGHUP, until the process ends: the first asks for the end, the next one kills.

    Attributes:
        is_wanted: Whether the end is wanted.
    """

    def __init__(self, prog: str) -> None:
        """Listen from now on; call it in the main thread."""
        self._prog = prog
        self._before = {number: signal.signal(number, self._hear) for number in SIGNALS}
        self.is_wanted = False

    def _hear(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        if self.is_wanted:
            say_error(f"{self._prog}: ended at once; the data file is not complete (pogosim recover makes it so)")
            os._exit(INTERRUPTED)
        self.is_wanted = True

    @contextlib.contextmanager
    def ending(self) -> Iterator[None]:
        """Say what is waited for if the block takes its time; the next signal kills."""
        self.is_wanted = True
        waited = f"{self._prog}: waiting for the robots' program to return; Ctrl-C ends it at once"
        timer = threading.Timer(PATIENCE_S, say_error, [waited])
        timer.daemon = True
        timer.start()
        try:
            yield
        finally:
            timer.cancel()

    def restore(self) -> None:
        """Let signals do again what they did before."""
        for number, handler in self._before.items():
            signal.signal(number, handler)
