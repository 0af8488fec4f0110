"""What analyses cost: time, processor time and memory of each `pogosim analyze`, for a batch and for one long run.

    .venv/bin/python bench/analyses.py [analyses ...] [--rows N ...] [--jobs N]

Makes the data with examples/run_and_tumble (./build.sh): 30 files of 20 robots with 126 600 rows in all, and files of
one run of 100 robots with so many rows (a million). Times include the start of the command, all tables and figures.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from options import at_least_one, check_built

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble"
ANALYSES = ("locomotion", "neighbors", "network", "coverage", "collective", "arena")
RUNS = 30
TIMES = 211


@dataclass(frozen=True)
class Data:
    """Data files."""

    name: str
    rows: int
    pattern: str


def make_run(file: Path, seed: int, robots: int, times: int) -> None:
    """Make a data file of robots on 10^4 mm^2 each, saved at so many times, 0.1 s apart."""
    settings = {
        "objects.robots.nb": robots,
        "arena_surface": 1e4 * robots,
        "simulation_time": 0.1 * (times - 1),
        "save_data_period": 0.1,
        "data_filename": file,
        "enable_console_logging": "false",
        "save_video_period": -1,
    }
    command = [str(PROGRAM), "-c", str(ROOT / "conf" / "simple.yaml"), "-g", "-q", "-nr", "-s", str(seed)]
    subprocess.run([*command, *(f"--set={key}={value}" for key, value in settings.items())], cwd=ROOT, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)  # fmt: skip


def make_data(folder: Path, rows: list[int]) -> list[Data]:
    """Make all data files."""
    (folder / "runs").mkdir()
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        list(threads.map(lambda seed: make_run(folder / "runs" / f"{seed}.feather", seed, 20, TIMES), range(RUNS)))
    data = [Data(f"{RUNS} runs", RUNS * 20 * TIMES, str(folder / "runs" / "*.feather"))]
    for count in rows:
        file = folder / f"{count}.feather"
        make_run(file, 1, 100, max(count // 100, 1))
        data.append(Data("one run", max(count // 100, 1) * 100, str(file)))
    return data


def measure(analysis: str, data: Data, folder: Path, jobs: int) -> tuple[float, float, float]:
    """Do an analysis. Returns seconds, seconds of processor time, and the largest memory of a process in MB."""
    command = [sys.executable, "-m", "pogosim", "analyze", analysis, "-i", data.pattern, "-o", str(folder / analysis)]
    begin = time.perf_counter()
    process = subprocess.Popen([*command, "--jobs", str(jobs)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{' '.join(command)} ends with exit code {process.returncode}")
    per_mb = 1e6 if sys.platform == "darwin" else 1e3
    return time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / per_mb


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("analyses", nargs="*", metavar="ANALYSIS", help=f"of {', '.join(ANALYSES)}; all without")
    parser.add_argument("--rows", type=at_least_one, nargs="*", default=[1_000_000], help="of long runs (a million)")
    parser.add_argument("--jobs", type=at_least_one, default=1, help="of analyses (%(default)s)")
    options = parser.parse_args()
    if unknown := sorted(set(options.analyses) - set(ANALYSES)):
        parser.error(f"there is no analysis {', '.join(unknown)}; there are {', '.join(ANALYSES)}")
    check_built(parser, PROGRAM)
    if find_spec("pogosim") is None:
        parser.error("no module named 'pogosim'; run it with .venv/bin/python, which ./build.sh makes")
    print(f"{'analysis':<10}  {'data':<7}  {'rows':>10}  {'s':>5}  {'processor s':>11}  {'MB':>6}")
    with tempfile.TemporaryDirectory() as name:
        for data in make_data(Path(name), options.rows):
            for analysis in options.analyses or ANALYSES:
                seconds, used_s, most_mb = measure(analysis, data, Path(name), options.jobs)
                rows = f"{data.rows:,}".replace(",", " ")
                print(f"{analysis:<10}  {data.name:<7}  {rows:>10}  {seconds:5.3g}  {used_s:11.3g}  {most_mb:6.0f}",
                      flush=True)  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
