"""Starting batches as a user does, and what is needed to disturb them."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml
from pogosim.pogobatch import main
from running import Run, example, ran, scene

COMMAND = [sys.executable, "-m", "pogosim.pogobatch"]
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

# Two combinations in one file of results.
OPTIONS: dict[str, object] = {
    "simulation_time": 1.0,
    "objects.robots.nb": {"batch_options": [2, 3], "default_option": 3},
    "result_new_columns": ["objects.robots.nb", "arena_file"],
}


def write_options(folder: Path, changes: dict[str, object] | None = None) -> Path:
    """Write many.yaml in a folder, which is made; None takes a key out."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "many.yaml"
    entries: dict[str, Any] = scene({**OPTIONS, **(changes or {})})
    path.write_text(yaml.safe_dump(entries, sort_keys=False))
    return path


def arguments(program: Path, *more: str) -> list[str]:
    """Return a command line for many.yaml."""
    return [*COMMAND, "-c", "many.yaml", "-S", str(program), "-t", "tmp", "-o", "results", *more]


def batch(folder: Path, *more: str, program: Path | None = None) -> Run:
    """Run a batch in a folder with many.yaml, in this process, which saves its start."""
    return run_main(folder, arguments(program or example("helloworld"), *more)[len(COMMAND) :])


def run_main(folder: Path, options: list[str], command: Callable[[list[str]], int] = main) -> Run:
    """Run a command in this process, in a folder."""
    output, errors = io.StringIO(), io.StringIO()
    here = Path.cwd()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    try:
        os.chdir(folder)
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            try:
                code = command(options)
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else 1
    finally:
        os.chdir(here)
        for number, handler in handlers.items():
            signal.signal(number, handler)
    return Run(code, output.getvalue(), errors.getvalue(), folder)


def subcommand(folder: Path, name: str, *more: str, program: Path | None = None, folder_of: str = "results") -> Run:
    """Run a subcommand that does runs, in a folder with many.yaml, in this process."""
    options = ["-c", "many.yaml", "-S", str(program or example("helloworld")), "-o", folder_of]
    return run_main(folder, [name, *options, *(["-t", "tmp"] if name == "run" else []), *more])


def batch_apart(folder: Path, *more: str, program: Path | None = None) -> Run:
    """Run a batch in a folder with many.yaml, in a process of its own."""
    return ended(arguments(program or example("helloworld"), *more), folder)


def ended(command: list[str], folder: Path) -> Run:
    """Run a command to its end."""
    return ran(folder, *command, env=ENVIRONMENT)


def start_batch(folder: Path, *more: str, program: Path | None = None) -> subprocess.Popen[str]:
    """Start a batch, to be disturbed."""
    return subprocess.Popen(
        arguments(program or example("helloworld"), *more),
        cwd=folder,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def script(path: Path, lines: str, program: Path | None = None) -> Path:
    """Write a program that runs some shell commands before it becomes the simulator; $seed is the seed of the run."""
    seed = 'seed=$(echo "$*" | sed "s/.*--seed \\([0-9]*\\).*/\\1/")'
    path.write_text(f'#!/bin/sh\n{seed}\n{lines}\nexec {program or example("helloworld")} "$@"\n')
    path.chmod(0o755)
    return path


def simulators_in(folder: Path) -> list[int]:
    """Return the ids of the processes that work for a batch in a folder: its simulators, not itself."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_bytes()
        except OSError:
            continue
        if str(folder / "tmp" / "sim_").encode() in command:
            found.append(int(process.name))
    return found


def saved_states(folder: Path) -> list[Path]:
    """Return the states of unfinished runs somewhere below a folder, also while finished ones are removed there."""
    found = []
    for place, _, files in os.walk(folder):
        for file in (Path(place, name) for name in files if name.endswith(".state")):
            with contextlib.suppress(FileNotFoundError):
                if file.stat().st_size > 0:
                    found.append(file)
    return found


def wait_until_gone(folder: Path) -> None:
    """Wait until no simulator of a batch is left."""
    for _ in range(600):
        if not simulators_in(folder):
            return
        time.sleep(0.05)
    raise AssertionError(f"orphans: {simulators_in(folder)}")


def wait_for_simulators(folder: Path, process: subprocess.Popen[str]) -> list[int]:
    """Wait until simulators of a batch run, or it has ended."""
    while process.poll() is None:
        if found := simulators_in(folder):
            return found
        time.sleep(0.01)
    return []


def results(folder: Path) -> dict[str, bytes]:
    """Return the bytes of all results."""
    return {path.name: path.read_bytes() for path in sorted((folder / "results").glob("**/*")) if path.is_file()}
