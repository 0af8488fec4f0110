"""The simulators that run for a batch: each a process of its own, or in a process that does many runs."""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from shutil import which
from typing import IO

from pogosim.batch.runs.run import RunSettings
from pogosim.batch.runs.run_log import LOG
from pogosim.batch.runs.run_server import NotServedError, RunServer, RunServers, ServerLostError
from pogosim.batch.runs.running import Running, Watch, start_simulator

SAVING_S = 10.0  # for the states of runs when the batch ends; batch systems wait 30 s for it

# Dies with the thread that starts it, whatever ends that one; and starts nothing if that has happened already.
WATCHED = ("setpriv", "--pdeathsig", "KILL", "sh", "-c", '[ "$PPID" = "$0" ] && exec "$@"')


@dataclass(frozen=True)
class Saving:
    """What a simulator that saves states is given in addition."""

    arguments: tuple[str, ...]
    lock: IO[bytes]  # of the folder, as long as the simulator lives
    goes_on: bool  # the log does, too


class StoppedError(Exception):
    """The batch ends; the run was not done."""


class Simulators:
    """The simulators of this process, so that they can be ended."""

    def __init__(self) -> None:
        self.watch = Watch()
        self.is_stopping = False
        self.slots: contextlib.AbstractContextManager[object] = contextlib.nullcontext()
        self.servers = RunServers()

    def begin(self, at_once: int) -> None:
        """Let this number of simulators run at the same time; others wait for their turn."""
        self.is_stopping = False
        self.watch.begin()
        self.slots = threading.BoundedSemaphore(at_once)

    def run(
        self, command: Sequence[str], folder: Path, settings: RunSettings, saving: Saving | None = None
    ) -> tuple[int, float]:
        """Run a program to its end, in a process of its own.

        Args:
            command: Its command line.
            folder: The folder of the run, where its log is written.
            settings: What all runs have in common.
            saving: How it saves its state; None: it does not.

        Returns:
            Its exit code, or minus the signal that ended it; and its wall-clock time in s.

        Raises:
            OSError: It cannot be started.
            StoppedError: The batch ends.
        """
        with self.slots:
            started_s = time.monotonic()
            code = self.run_now(command, folder / LOG, settings, saving)
            return code, time.monotonic() - started_s

    def run_now(self, command: Sequence[str], log: Path, settings: RunSettings, saving: Saving | None = None) -> int:
        """Do what `run` does, at once; returns the exit code."""
        if self.is_stopping:
            raise StoppedError
        with log.open("ab" if saving is not None and saving.goes_on else "wb") as output:
            kept_open = () if saving is None else (saving.lock.fileno(),)
            process = start_simulator([*watch(), *command], settings, output, kept_open)
        try:
            with self.running(process, log, saves_state=saving is not None):
                code = process.wait()
        except BaseException:
            if saving is not None:
                ask_to_end(process)
            end(process)
            raise
        if self.is_stopping:
            raise StoppedError
        return code

    @contextlib.contextmanager
    def server(self, command: Sequence[str], settings: RunSettings) -> Iterator[RunServer | None]:
        """Have a server of runs of a program; None: it serves none. A server that is lost meanwhile is ended.

        Args:
            command: The start of its command line, which every run has.
            settings: What all runs have in common.

        Raises:
            OSError: It cannot be started.
            StoppedError: The batch ends.
        """
        with self.slots:
            if self.is_stopping:
                raise StoppedError
            server = self.servers.taken(command, settings, watch, self.running)
            if self.is_stopping:
                if server is not None:
                    server.close()
                raise StoppedError
            try:
                yield server
            except BaseException as error:
                if server is not None:
                    end(server.process)
                    server.close()
                if self.is_stopping and isinstance(error, ServerLostError):
                    raise StoppedError from None
                if isinstance(error, NotServedError):
                    self.servers.refuse(command, settings)
                raise
            if server is not None:
                self.servers.give_back(server)

    @contextlib.contextmanager
    def running(self, process: subprocess.Popen[bytes], log: Path, saves_state: bool = False) -> Iterator[None]:
        """Let a process run meanwhile; it is killed if the batch ends."""
        running = self.watch.add(process, log, saves_state)
        try:
            if self.is_stopping:
                kill(process)
            yield
        finally:
            self.watch.remove(running)

    def stop(self) -> None:
        """End all simulators, and let none begin. Those that save states have some time for it."""
        self.is_stopping = True
        with self.watch.lock:
            saving = [running for running in self.watch.running if running.saves_state]
            for running in self.watch.running:
                kill(running.process, signal.SIGTERM if running.saves_state else signal.SIGKILL)
        if saving:
            timer = threading.Timer(SAVING_S, self.kill_all, [saving])
            timer.daemon = True
            timer.start()

    def kill_all(self, those: Sequence[Running]) -> None:
        """Kill simulators that still run."""
        with self.watch.lock:
            for running in those:
                if running in self.watch.running:
                    kill(running.process)

    def close(self) -> None:
        """End what waits for runs."""
        self.servers.close()


simulators = Simulators()
atexit.register(simulators.close)


def kill(process: subprocess.Popen[bytes], number: signal.Signals = signal.SIGKILL) -> None:
    """End a program and what it has started, by a signal."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, number)


def ask_to_end(process: subprocess.Popen[bytes]) -> None:
    """Let a program save its state, if it does not take long."""
    kill(process, signal.SIGTERM)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(SAVING_S)


def end(process: subprocess.Popen[bytes]) -> None:
    """End a program, and wait until it has ended."""
    kill(process)
    process.wait()


def watch() -> list[str]:
    """Return the start of a command line with which a program ends when this process does; empty where it cannot."""
    if sys.platform != "linux" or which(WATCHED[0]) is None:
        return []
    return [*WATCHED, str(os.getpid())]
