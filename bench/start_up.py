"""What it costs to begin a short run: a process, a simulation inside Python, and one that is reset.

    .venv/bin/python bench/start_up.py [number of runs, 100 without it]

Processor time (user and system, in ms) of 20 robots of run_and_tumble, the median of all runs. A run of one step is all
start.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

try:
    import pogosim
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"start_up.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble"
CONFIGURATION = ROOT / "conf" / "simple.yaml"
SETTINGS = {"objects.robots.nb": 20, "arena_surface": 2e5}
OUTPUTS = {"enable_console_logging": "false", "save_video_period": -1}
ONE_STEP, FIVE_SECONDS = {"simulation_time": 0.01}, {"simulation_time": 5}
NO_ROWS = {"enable_data_logging": "false"}
IMPORT = "import pogosim; pogosim.Simulation"


def used_ms(usage: resource.struct_rusage) -> float:
    """Return the processor time of a process."""
    return 1e3 * (usage.ru_utime + usage.ru_stime)


def process_ms(command: list[str]) -> float:
    """Run a command, whose output is not shown, and return its processor time."""
    actions = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    process = os.posix_spawn(command[0], command, os.environ, file_actions=actions)
    _, status, usage = os.wait4(process, 0)
    if status != 0:
        raise RuntimeError(f"{' '.join(command)} failed")
    return used_ms(usage)


def command_of(*settings: Mapping[str, object]) -> list[str]:
    """Return a command that makes a run."""
    together: dict[str, object] = SETTINGS | OUTPUTS
    for some in settings:
        together |= some
    words = [word for key, value in together.items() for word in ("--set", f"{key}={value}")]
    return [str(PROGRAM), "-c", str(CONFIGURATION), "-g", "-q", "-nr", "-s", "1", *words]


def show(name: str, measured_ms: Iterable[float]) -> None:
    """Print the median."""
    print(f"{name:44s}{statistics.median(measured_ms):8.2f}", flush=True)


def call_ms(function: Callable[..., object], *arguments: object) -> float:
    """Return the processor time of a call, of all threads of this process."""
    before = used_ms(resource.getrusage(resource.RUSAGE_SELF))
    function(*arguments)
    return used_ms(resource.getrusage(resource.RUSAGE_SELF)) - before


def show_calls(runs: int) -> None:
    """Print what simulations in this process cost."""

    def opened(**settings: Any) -> pogosim.Simulation:
        return pogosim.Simulation(
            f"{PROGRAM}.so", CONFIGURATION, seed=1, set=SETTINGS | FIVE_SECONDS | {"save_video_period": -1} | settings
        )

    def another() -> None:
        opened().close()

    another()
    show("Simulation(...) and close(), not the first", (call_ms(another) for _ in range(runs)))
    for has_rows in (True, False):
        with opened(enable_data_logging=has_rows) as simulation:
            what = "with rows" if has_rows else "without rows"
            show(f"reset(seed), {what}", (call_ms(simulation.reset, seed) for seed in range(runs)))
            speeds = ({"objects.robots.max_linear_speed": 50 + number} for number in range(runs))
            show(f"reset(seed, set), {what}", (call_ms(simulation.reset, 1, speed) for speed in speeds))


def main() -> None:
    """Measure all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("runs", nargs="?", type=at_least_one, default=100, help="number of runs (default %(default)s)")
    runs = parser.parse_args().runs
    check_built(parser, PROGRAM, Path(f"{PROGRAM}.so"))
    with tempfile.TemporaryDirectory() as folder:
        rows = {"data_filename": f"{folder}/rows.feather"}
        for name, settings in (
            ("process of one step, without rows", ONE_STEP | NO_ROWS),
            ("process of one step, with rows", ONE_STEP | rows),
            ("process of 5 s, without rows", FIVE_SECONDS | NO_ROWS),
            ("process of 5 s, with rows", FIVE_SECONDS | rows),
        ):
            command = command_of(settings)
            show(name, (process_ms(command) for _ in range(runs)))
    few = max(1, runs // 5)
    arguments = f"({f'{PROGRAM}.so'!r}, {str(CONFIGURATION)!r})"
    for code in ("import numpy", IMPORT, f"{IMPORT}{arguments}.close()"):
        shown = code.removeprefix("import pogosim; ").replace(arguments, "(...)")
        show(f"python -c '{shown}'", (process_ms([sys.executable, "-c", code]) for _ in range(few)))
    show_calls(runs)


if __name__ == "__main__":
    main()
