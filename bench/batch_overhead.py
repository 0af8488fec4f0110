"""What share of a batch's time is spent in simulators.

    .venv/bin/python bench/batch_overhead.py --runs 500

Runs hanabi with 20 robots for 5 s of simulated time, many times, with pogobatch on all cores: short runs, so that
starting them, keeping their data and joining it weigh most. Prints the share of wall-clock time (of all workers, from
the start of the batch to the complete file of results) in which a simulator was running.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

try:
    import yaml
    from pogosim.pogobatch import PogobotBatchRunner
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"batch_overhead.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "hanabi" / "hanabi"
FLOOR = 0.8

WORLD = {
    "arena_file": str(ROOT / "arenas" / "disk.csv"),
    "arena_surface": 2.0e5,  # mm2
    "simulation_time": 5.0,
    "time_step": 0.01,
    "save_data_period": 1.0,
    "initial_formation": "random",
    "data_filename": "data.feather",
    "objects": {
        "robots": {"type": "pogobot", "nb": 20},
        "global_light": {
            "type": "static_light",
            "light_mode": "static",
            "geometry": "global",
            "value": 200,
            "photo_start_at": 0.5,
            "photo_start_duration": 0.5,
            "photo_start_value": 32767,
        },
    },
}


def measure(runs: int, workers: int) -> tuple[float, float, int]:
    """Do a batch; returns its wall-clock time, that of its simulators together (in s), and the bytes of its results."""
    with tempfile.TemporaryDirectory() as folder:
        configuration = Path(folder) / "short.yaml"
        configuration.write_text(yaml.safe_dump(WORLD, sort_keys=False))
        started_s = time.monotonic()
        runner = PogobotBatchRunner(
            str(configuration), runs, str(PROGRAM), f"{folder}/tmp", f"{folder}/results", workers=workers
        )
        with contextlib.redirect_stdout(io.StringIO()):
            (output,) = runner.run_all()
        wall_s = time.monotonic() - started_s
        if runner.failures:
            raise RuntimeError(f"{len(runner.failures)} runs failed: {runner.failures[0].outcome.problem}")
        return wall_s, runner.simulator_s, Path(output).stat().st_size


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the share. The exit code is 1 if it is below the floor."""
    parser = argparse.ArgumentParser(description="Share of a batch's time that is spent in simulators.")
    parser.add_argument("--runs", type=at_least_one, default=10_000, help="number of runs (default %(default)s)")
    parser.add_argument(
        "--workers", type=at_least_one, default=os.cpu_count() or 1, help="runs at the same time (all cores)"
    )
    options = parser.parse_args(arguments)
    check_built(parser, PROGRAM)
    wall_s, simulator_s, size = measure(options.runs, options.workers)
    share = simulator_s / (wall_s * options.workers)
    print(
        f"{options.runs} runs, {options.workers} workers: {wall_s:.1f} s, {1000 * wall_s / options.runs:.1f} ms per run"
    )
    each_ms = 1000 * simulator_s / options.runs
    print(f"in simulators: {100 * share:.1f} % ({each_ms:.1f} ms per run); {size} bytes of results")
    return 0 if share >= FLOOR else 1


if __name__ == "__main__":
    sys.exit(main())
