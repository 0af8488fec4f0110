"""User code that blocks in wall-clock time is told while it blocks, and not disturbed."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from pogosim import Simulation
from running import PROGRAMS, Run, compile_program, write_scene

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")

LIMIT_S = 120
WARNING = re.compile(
    r"pogosim: warning: user_step of robot #1 of category 'robots', tick 5, t = [\d.]+ s, at \S*blocks\.c:(\d+) in "
    r"\w+\(\), has blocked for 2 s of wall-clock time, and the run with it\. "
)


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    flags = ["-std=gnu11", "-D_GNU_SOURCE", "-g", "-O0"]
    return compile_program(tmp_path_factory.mktemp("blocks") / "blocks", PROGRAMS / "blocks.c", flags=flags)


def start(program: Path, folder: Path, how: str, seconds: float = 3.0, **settings: object) -> subprocess.Popen[str]:
    """Start blocks.c, whose input and output are pipes."""
    write_scene(folder, {"parameters": {"how": how, "seconds": seconds}, "simulation_time": 1.0, **settings})
    pipe = subprocess.PIPE
    command = [str(program), "-c", "scene.yaml", "-g"]
    return subprocess.Popen(command, cwd=folder, stdin=pipe, stdout=pipe, stderr=pipe, text=True)


def end(process: subprocess.Popen[str], text: str | None = None) -> Run:
    """Return what a program said, without its summary."""
    output, errors = process.communicate(text, timeout=LIMIT_S)
    return Run(process.returncode, output, errors, Path())


def line_of(comment: str) -> int:
    lines = (PROGRAMS / "blocks.c").read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if line.endswith("// " + comment))


def test_call_that_blocks_is_told_with_its_line(blocks: Path, tmp_path: Path) -> None:
    calls = ["nanosleep", "many short ones", "select", "mutex", "pointer"]
    processes = {how: start(blocks, tmp_path / how.replace(" ", "_"), how) for how in calls}
    for how, process in processes.items():
        done = end(process)
        assert done.code == 0, done.errors
        warning = WARNING.match(done.errors)
        assert warning, done.errors
        assert int(warning[1]) == line_of("nanosleep" if how == "many short ones" else how)
        assert done.errors.count("\n") == 1, "it is said once"
        assert "interrupted" not in done.output, "the call takes its time"
        assert "result 0" not in done.output


def test_it_is_told_while_the_call_blocks(blocks: Path, tmp_path: Path) -> None:
    process = start(blocks, tmp_path, "read")
    assert process.stderr is not None
    line = process.stderr.readline()  # the call does not return before it gets a letter
    assert WARNING.match(line), line
    done = end(process, "x")
    assert (done.code, done.errors) == (0, "")
    assert "result 1" in done.output


def test_calls_that_block_in_each_step_are_told(blocks: Path, tmp_path: Path) -> None:
    done = end(start(blocks, tmp_path, "in many steps", 12.0))
    assert done.code == 0
    assert re.fullmatch(
        r"pogosim: warning: user_step of robot #\d of category 'robots', tick \d+, t = [\d.]+ s, at \S*blocks\.c:"
        rf"{line_of('nanosleep')} in \w+\(\), blocks again and again: for 2 s of wall-clock time by now, and the "
        r"run with it\. Robots wait .*\n",
        done.errors,
    ), done.errors


def test_short_calls_and_computing_are_not_told(blocks: Path, tmp_path: Path) -> None:
    calls = {"nanosleep": 1.0, "in many steps": 1.0, "compute": 4.0}
    for process in [start(blocks, tmp_path / how, how, s) for how, s in calls.items()]:
        done = end(process)
        assert (done.code, done.errors) == (0, "")


def test_time_in_which_the_process_is_stopped_does_not_count(blocks: Path, tmp_path: Path) -> None:
    process = start(blocks, tmp_path, "nanosleep", 1.5)
    time.sleep(1.0)
    process.send_signal(signal.SIGSTOP)
    time.sleep(4.0)
    process.send_signal(signal.SIGCONT)
    done = end(process)
    assert (done.code, done.errors) == (0, "")
    assert "interrupted" not in done.output


def test_slow_reader_of_the_output_is_not_told(blocks: Path, tmp_path: Path) -> None:
    process = start(blocks, tmp_path, "print")
    time.sleep(5.0)
    done = end(process)
    assert (done.code, done.errors) == (0, "")
    assert done.output.count("takes its time") == 3000


def test_workers_are_watched_too(blocks: Path, tmp_path: Path) -> None:
    many = {"objects.robots.nb": 300, "arena_surface": 1e7, "threads": 2}
    process = start(blocks, tmp_path, "nanosleep", **many)
    _, errors = process.communicate(timeout=LIMIT_S)
    assert process.returncode == 0, errors
    assert len(WARNING.findall(errors)) == 1, errors


def test_runs_inside_python_are_watched(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    flags = ["-std=gnu11", "-D_GNU_SOURCE", "-g", "-O0", "-shared", "-fPIC"]
    library = compile_program(tmp_path / "blocks.so", PROGRAMS / "blocks.c", flags=flags)
    configuration = write_scene(tmp_path, {"parameters": {"how": "nanosleep"}, "simulation_time": 1.0})
    for _ in range(2):
        with Simulation(library, configuration) as simulation:
            simulation.run()
        assert WARNING.search(capfd.readouterr().err), "once in each run"
    child = os.fork()
    if child == 0:
        with Simulation(library, configuration) as simulation:
            simulation.run()
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    assert WARNING.search(capfd.readouterr().err), "in a child, too"
