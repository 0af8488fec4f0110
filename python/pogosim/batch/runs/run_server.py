"""Processes that have loaded a program, and do its runs one after the other (src/app/run_server.hpp)."""

from __future__ import annotations

import contextlib
import logging
import os
import shutil
import socket
import struct
import subprocess
import tempfile
import threading
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path

from pogosim.batch.runs.identity import is_executable_program
from pogosim.batch.runs.run import FRAMES, RunSettings
from pogosim.batch.runs.run_log import CONFIGURATION, LOG
from pogosim.batch.runs.running import start_simulator

GREETING = b"pogosim run server 1\n"
LONGEST_START_S = 10.0  # until the greeting; constructors of the program may take for ever
LONGEST_END_S = 10.0  # destructors, too
MOST_RUNS = 1000  # of one process, so that what a run may leave behind does not add up
SIZE = struct.Struct("=I")
CODE = struct.Struct("=i")
NOT_REPEATED = -1  # kNotRepeated of run_server.hpp

Watching = Callable[[subprocess.Popen[bytes], Path], AbstractContextManager[None]]

log = logging.getLogger("pogobatch")


class ServerLostError(Exception):
    """A run did not end well, or the server did not: it is of no use any more."""


class NotServedError(ServerLostError):
    """The program serves no runs: an older one, or one whose runs need a process of their own."""


def not_watched(process: subprocess.Popen[bytes], log: Path) -> AbstractContextManager[None]:  # noqa: ARG001
    """Let a process run meanwhile."""
    return contextlib.nullcontext()


class RunServer:
    """A process that does runs of one program, in a folder that they have one after the other.

    Args:
        command: The start of the program's command line, which every run has.
        settings: What all runs have in common.
        start: The start of a command line with which the process ends when this one does.
        running: Lets the process be ended with the batch while it starts.

    Attributes:
        process: The process.
        folder: The folder of its runs.
        configuration: The configuration in it.
        log: The log of the last run.
        outputs: The folder for what a run writes, empty before each.
        why_copies: Why each run has a copy of the process; empty: all are done in this one.

    Raises:
        NotServedError: The program serves no runs.
        OSError: It cannot be started.
    """

    def __init__(
        self, command: Sequence[str], settings: RunSettings, start: Sequence[str], running: Watching = not_watched
    ) -> None:
        temporary = settings.temporary
        self.command = tuple(command)
        self.settings = settings
        self.served = 0  # runs
        self.written = ""  # into the configuration
        self.stream, other = socket.socketpair()
        with contextlib.ExitStack() as failed:
            failed.callback(self.stream.close)
            prefix = f"sim_server_try0_{temporary.batch}_"  # as folders of runs, see TemporaryFolder.remove_leftovers
            self.folder = Path(tempfile.mkdtemp(prefix=prefix, dir=temporary.path))
            failed.callback(shutil.rmtree, self.folder, ignore_errors=True)
            self.configuration, self.log = str(self.folder / CONFIGURATION), self.folder / LOG
            self.outputs = self.folder / FRAMES
            self.outputs.mkdir()
            with other, self.log.open("wb") as output:
                # Its command line is what ps shows; a server takes those of its runs.
                named = [*start, *command, "-c", self.configuration]
                self.process = start_simulator(named, settings, output, [other.fileno()], serves_at=other.fileno())
            failed.callback(self.process.wait)
            failed.callback(self.process.kill)
            self.stream.settimeout(LONGEST_START_S)
            try:
                with running(self.process, self.log):
                    is_served = self.received(len(GREETING)) == GREETING
                    self.why_copies = self.line()
            except ServerLostError:
                raise NotServedError from None
            if not is_served or self.log.stat().st_size > 0:
                raise NotServedError  # what constructors print belongs into the log of each run
            self.stream.settimeout(None)
            failed.pop_all()

    def received(self, count: int) -> bytes:
        """Return so many bytes of the stream.

        Raises:
            ServerLostError: There are fewer.
        """
        content = b""
        while len(content) < count:
            try:
                part = self.stream.recv(count - len(content))
            except OSError:
                part = b""
            if not part:
                raise ServerLostError
            content += part
        return content

    def line(self) -> str:
        """Return the next line of the stream, without its end."""
        content = b""
        while (byte := self.received(1)) != b"\n":
            content += byte
        return content.decode(errors="replace")

    def configure(self, text: str) -> None:
        """Let runs have a configuration from now on."""
        if text != self.written:
            self.written = ""
            Path(self.configuration).write_text(text)
            self.written = text

    def run(self, arguments: Sequence[str]) -> None:
        """Do a run to its end. What it has written is in the folder.

        Args:
            arguments: The end of its command line.

        Raises:
            ServerLostError: It did not end well.
        """
        words = b"".join(os.fsencode(word) + b"\0" for word in [str(self.log), *self.command[1:], *arguments])
        try:
            self.stream.sendall(SIZE.pack(len(words)) + words)
        except OSError:
            raise ServerLostError from None
        (code,) = CODE.unpack(self.received(CODE.size))
        self.served += 1
        if code == NOT_REPEATED:
            raise NotServedError
        if code != 0:
            raise ServerLostError

    def clear(self) -> None:
        """Remove what a run has written, as far as it was not moved elsewhere."""
        with os.scandir(self.outputs) as entries:
            for entry in entries:
                if entry.is_dir(follow_symlinks=False):
                    shutil.rmtree(entry.path)
                else:
                    Path(entry.path).unlink()

    def close(self) -> None:
        """Let the process end, which does nothing now, and remove the folder."""
        self.stream.close()
        try:
            self.process.wait(LONGEST_END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class RunServers:
    """The servers of this process that do nothing now, to be used again."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.idle: list[RunServer] = []
        self.refused: set[tuple[str, ...]] = set()  # commands and digests of programs that serve no runs
        self.told: set[str] = set()

    def taken(
        self,
        command: Sequence[str],
        settings: RunSettings,
        start: Callable[[], Sequence[str]],
        running: Watching = not_watched,
    ) -> RunServer | None:
        """Return a server that is free, a new one if there is none; None: the program serves no runs.

        Raises:
            OSError: None can be started.
        """
        program = (*command, settings.program_digest)
        with self.lock:
            if program in self.refused:
                return None
            for server in self.idle:
                if server.command == tuple(command) and server.settings == settings:
                    self.idle.remove(server)
                    if server.outputs.is_dir():  # a worker that stays from batch to batch: the folder may be gone
                        return server
                    server.close()
                    break
        try:
            if not is_executable_program(Path(command[0])):
                raise NotServedError
            server = RunServer(command, settings, start(), running)
        except NotServedError:
            self.refuse(command, settings)
            return None
        self.tell(server.why_copies)
        return server

    def refuse(self, command: Sequence[str], settings: RunSettings) -> None:
        """Note that a program serves no runs."""
        program = (*command, settings.program_digest)
        with self.lock:
            if program not in self.refused:
                log.debug("each run is a process of its own: %s cannot do several", command[0])
            self.refused.add(program)

    def tell(self, why_copies: str) -> None:
        """Say once how the runs of a program are done."""
        with self.lock:
            if why_copies not in self.told:
                self.told.add(why_copies)
                if why_copies:
                    log.debug("each run is a copy of a process: %s", why_copies)
                else:
                    log.debug("a process does many runs, one after the other")

    def give_back(self, server: RunServer) -> None:
        """Keep a server for the next run."""
        if server.served >= MOST_RUNS:
            server.close()
            return
        with self.lock:
            self.idle.append(server)

    def close(self) -> None:
        """End all that do nothing now."""
        with self.lock:
            servers, self.idle = self.idle, []
            self.refused.clear()
            self.told.clear()
        for server in servers:
            server.close()
