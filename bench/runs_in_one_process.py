"""Short runs in one process, against one process for each.

    .venv/bin/python bench/runs_in_one_process.py [number of runs, 1000 without it]

Each run has 20 robots of run_and_tumble and 5 s, and writes its rows. Both ways use all processors.
On a busy machine, compare the processor time.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from pathlib import Path

try:
    import pogosim
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"runs_in_one_process.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble"
CONFIGURATION = ROOT / "conf" / "simple.yaml"
SETTINGS = {"objects.robots.nb": 20, "simulation_time": 5, "arena_surface": 2e5}


def run_process(seed: int, folder: Path) -> int:
    """Make one run in a process of its own. Returns the number of rows."""
    file = folder / f"{seed}.feather"
    outputs = {"data_filename": file, "enable_console_logging": "false", "save_video_period": -1}
    settings = [word for key, value in (SETTINGS | outputs).items() for word in ("--set", f"{key}={value}")]
    command = [str(PROGRAM), "-c", str(CONFIGURATION), "-g", "-q", "-nr", "-s", str(seed), *settings]
    subprocess.run(command, check=True, capture_output=True)
    return file.stat().st_size


def run_inside(seed: int, folder: Path) -> int:
    """Make one run in this process."""
    file = folder / f"{seed}.feather"
    with pogosim.Simulation(f"{PROGRAM}.so", CONFIGURATION, seed=seed, set=SETTINGS, data_file=file) as simulation:
        simulation.run()
    return file.stat().st_size


def processor_s() -> float:
    """Processor time of this process and of those that have ended."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def seconds(function: Callable[[int, Path], int], runs: int) -> tuple[float, float]:
    """Return how long so many runs take, and their processor time."""
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(cpu_count()) as threads:
        begin, used = time.perf_counter(), processor_s()
        list(threads.map(lambda seed: function(seed, Path(name)), range(runs)))
        return time.perf_counter() - begin, processor_s() - used


def main() -> None:
    """Measure both ways."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("runs", nargs="?", type=at_least_one, default=1000, help="number of runs (default %(default)s)")
    runs = parser.parse_args().runs
    check_built(parser, PROGRAM, Path(f"{PROGRAM}.so"))
    for name, function in (("one process each", run_process), ("one process", run_inside)):
        seconds(function, 10)  # programs and libraries are in memory then
        duration_s, used_s = seconds(function, runs)
        each_ms, used_ms = duration_s / runs * 1e3, used_s / runs * 1e3
        print(f"{name:18s}{duration_s:8.2f} s; per run {each_ms:7.2f} ms, processor {used_ms:.2f} ms")


if __name__ == "__main__":
    main()
