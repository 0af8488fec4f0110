"""The simulators that run for a batch, and a look at those that take long: blocked ones say so in their log alone."""

from __future__ import annotations

import logging
import os
import subprocess
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from pogosim.batch.runs.run import RunSettings
from pogosim.lines import printable

# In a line of the log of a run whose robot waits in wall-clock time (src/process/blocked_watch.cpp).
BLOCKED = "for 2 s of wall-clock time"  # at once, or in short calls
LOOK_EVERY_S = 2.0
FIRST_LINE_S = 60.0  # after this time without a run that ends, and twice, four times, ... as long
LONGEST_LOG = 1_000_000  # bytes at the end of a log that are searched

# Makes a program serve runs, see pogosim.batch.runs.run_server. Only the one that is started for it has it.
SERVE = "POGOSIM_SERVE_RUNS"

log = logging.getLogger("pogobatch")


def start_simulator(
    command: Sequence[str],
    settings: RunSettings,
    output: IO[bytes],
    kept_open: Sequence[int] = (),
    serves_at: int | None = None,
) -> subprocess.Popen[bytes]:
    """Start a process that does one run, or many.

    Args:
        command: Its command line.
        settings: What all runs have in common.
        output: Where it prints.
        kept_open: Descriptors of open files that it gets, too.
        serves_at: That of them by which it is told of many runs; None: it does one.

    Raises:
        OSError: It cannot be started.
    """
    inherited = {name: value for name, value in os.environ.items() if name != SERVE}
    serving = {} if serves_at is None else {SERVE: str(serves_at)}
    return subprocess.Popen(
        command,
        cwd=settings.working_folder,
        env=inherited | settings.environment | serving,
        pass_fds=kept_open,
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=subprocess.STDOUT,
        start_new_session=True,  # Ctrl-C reaches the batch alone
    )


@dataclass(eq=False)
class Running:
    """A simulator that runs."""

    process: subprocess.Popen[bytes]
    log: Path
    saves_state: bool = False  # when it is asked to end
    started_s: float = field(default_factory=time.monotonic)


class Watch:
    """Looks at running simulators every other second, and says once that one is blocked."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.running: set[Running] = set()
        self.thread: threading.Thread | None = None
        self.begin()

    def begin(self) -> None:
        """Begin another batch."""
        self.has_told = False
        self.last_end_s = time.monotonic()
        self.silence_s = FIRST_LINE_S

    def add(self, process: subprocess.Popen[bytes], log_file: Path, saves_state: bool = False) -> Running:
        """Take a simulator that has started."""
        running = Running(process, log_file, saves_state)
        with self.lock:
            self.running.add(running)
            if self.thread is None:
                self.thread = threading.Thread(target=self.look, name="watching over runs", daemon=True)
                self.thread.start()
        return running

    def remove(self, running: Running) -> None:
        """Forget a simulator that has ended."""
        with self.lock:
            self.running.discard(running)
            self.last_end_s = time.monotonic()
            self.silence_s = FIRST_LINE_S

    def look(self) -> None:
        """Look at all simulators, again and again."""
        while True:
            time.sleep(LOOK_EVERY_S)
            with self.lock:
                oldest_first = sorted(self.running, key=lambda own: own.started_s)
            if oldest_first:
                self.look_at(oldest_first)

    def look_at(self, oldest_first: list[Running]) -> None:
        """Say what is to be said of simulators, at least one."""
        self.tell_blocked(oldest_first)
        oldest = oldest_first[0]
        silent_s = time.monotonic() - max(self.last_end_s, oldest.started_s)
        if silent_s >= self.silence_s:
            self.silence_s *= 2.0
            log.info("no run has ended for %.0f s; the log of the oldest one: %s", silent_s, oldest.log)

    def tell_blocked(self, running: list[Running]) -> None:
        """Say once that a run is blocked."""
        for own in running:
            if self.has_told:
                return
            if time.monotonic() - own.started_s >= LOOK_EVERY_S and (line := blocked_line(own.log)):
                self.has_told = True
                log.warning("a run is blocked, and goes on: %s (its log: %s)", line, own.log)


def blocked_line(log_file: Path) -> str:
    """Return what the log of a run says of a robot that blocks it; empty if it says nothing."""
    try:
        with log_file.open("rb") as file:
            file.seek(max(0, log_file.stat().st_size - LONGEST_LOG))
            lines = file.read(LONGEST_LOG).decode(errors="replace").splitlines()
    except OSError:
        return ""
    found = next((line for line in lines if BLOCKED in line), "")
    return printable(found.removeprefix("pogosim: warning: "))
