"""What all Python tests share: modules beside them, test programs compiled once, and a display."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pogosim
import pytest
from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/python", "bench", "docs/figures", "examples/learning")]

from chromium import CHROMIUM  # noqa: E402
from display import Display, open_display  # noqa: E402
from running import PROGRAMS, SHARED, compile_program  # noqa: E402

Compile = Callable[[str], Path]

# Windows are opened on a display of their own, see display.py.
for name in ("DISPLAY", "WAYLAND_DISPLAY"):
    os.environ.pop(name, None)

# Programs inherit what is ignored: SIGHUP under nohup, SIGINT and SIGQUIT in the background of a shell.
for number in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2):
    if signal.getsignal(number) == signal.SIG_IGN:
        signal.signal(number, signal.SIG_DFL)


# Files that take longest, ten minutes to one on a busy machine: if one of them starts last, all processors but one wait
# for its end. Those of wheel and same_bytes are much longer where ccache has nothing.
LONGEST = [
    *("pictures", "docs", "optimize_resume", "site", "same_bytes", "headers", "calibration", "batch_slurm"),
    *("wheel", "tuning_numbers", "extending", "literal_names", "batch_runs", "gdb", "message_layout"),
    *("matplotlib_settings", "graph_reports", "same_as_firmware", "signals", "window_input"),
    *("shared_variables", "parameter_study", "validation", "threads", "window", "compare_brains", "firmware"),
    *("replay", "emu", "shared_state", "real_robot", "optimize_others", "misbehaviour", "mixed_scene"),
    *("collective", "optimize_initial", "command", "simulation_ends", "communication_tools"),
]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Start with the files that take longest."""
    order = {f"test_{name}": place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: order.get(item.path.stem, len(order)))


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Compile:
    """Return a function from the name of a file in tests/programs to the program, compiled at the first call."""
    compiled: dict[str, Path] = {}

    def compile_once(name: str) -> Path:
        if name not in compiled:
            source = PROGRAMS / name
            compiled[name] = compile_program(tmp_path_factory.mktemp(source.stem) / source.stem, source)
        return compiled[name]

    return compile_once


@pytest.fixture(scope="session")
def hosted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shared object of tests/programs/hosted.c, whose robots drive in circles."""
    return compile_program(tmp_path_factory.mktemp("hosted") / "hosted.so", PROGRAMS / "hosted.c", flags=SHARED)


@pytest.fixture
def sim(hosted: Path, scene: Path) -> Iterator[pogosim.Simulation]:
    """A run of that program in a scene, which is a fixture of the file."""
    with pogosim.Simulation(hosted, scene) as simulation:
        yield simulation


@pytest.fixture(scope="module")
def display() -> Iterator[Display]:
    """One X server for all tests that leave it alone."""
    with open_display() as opened:
        yield opened


@pytest.fixture(scope="module")
def window_program(program: Compile) -> Path:
    return program("window.c")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A Chromium without a window."""
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()
