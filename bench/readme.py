"""Runs the benchmarks that bench/README.md quotes, and writes what they print into the page.

    ./build.sh && cmake -DPOGOSIM_BUILD_BENCH=ON build/release && cmake --build build/release
    .venv/bin/python bench/readme.py                 # all; some minutes
    .venv/bin/python bench/readme.py lamps batches   # some

The last line of each says how busy the machine was. Only ratios between measurements of one machine mean anything.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "docs" / "figures"))

from options import check_built
from quotes import quote

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "bench" / "README.md"
DRIVERS = ROOT / "build" / "release" / "bench"
SCENES: dict[str, Sequence[str]] = {
    "large": ("bench_large", "70000", "random", "70000", "chessboard", "1000000", "random", "1000000", "chessboard"),
    "lamps": ("bench_light",),
    "layers": ("bench_draw",),
    "batches": ("batch_overhead.py", "--runs", "500"),
    "runs": ("runs_in_one_process.py", "500"),
    "variables": ("own_variables.py",),
}


def busyness() -> str:
    """Say how busy the machine is."""
    return f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors"


def measured(command: Sequence[str]) -> list[str]:
    """Run a benchmark; returns what it prints.

    Raises:
        SystemExit: It cannot be run, and says why. Exit code 1 is that of a batch with much overhead.
    """
    name, *arguments = command
    program = [sys.executable, str(ROOT / "bench" / name)] if name.endswith(".py") else [str(DRIVERS / name)]
    done = subprocess.run([*program, *arguments], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}")
    return [line.rstrip() for line in done.stdout.splitlines() if line.strip()]


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCENES)}; without: all")
    options = parser.parse_args()
    if unknown := sorted(set(options.names) - set(SCENES)):
        parser.error(f"no benchmark is called {', '.join(unknown)}; there are {', '.join(SCENES)}")
    names = options.names or list(SCENES)
    check_built(parser, *(DRIVERS / SCENES[name][0] for name in names if not SCENES[name][0].endswith(".py")))
    for name in names:
        lines = [*measured(SCENES[name]), busyness()]
        print(name, *lines, sep="\n", flush=True)
        quote(PAGE, name, lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
