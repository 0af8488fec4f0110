"""How many runs a batch does per second, and what a run costs beside its simulation.

    .venv/bin/python bench/batch_runs.py [-o build/bench] [--runs 300] [--robots 20 100] [--seconds 5 40]

For each number of robots of run_and_tumble and each simulated time, measures

- the simulation alone: one run after the other in one process (`pogosim.Simulation.reset`), without rows;
- a batch whose workers do many runs each, from its start to the complete file of results;
- the same batch with a process for each run (`--isolated`).

Processor time changes least with other work on the machine: compare its ratios. Prints a table; with -o, also writes
batches.csv, batches.md and batches.png.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

try:
    import matplotlib.pyplot as plt
    import pandas as pd
    import pogosim
    import yaml
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
    from pogosim.pogobatch import PogobotBatchRunner
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"batch_runs.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built, seconds

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble"
AREA_PER_ROBOT_MM2 = 1e4
WARM_UP = 5  # runs

COLUMNS = {
    "robots": "robots",
    "simulated_s": "simulated s",
    "workers": "workers",
    "simulation_ms": "simulation, ms",
    "run_ms": "run of a batch, ms",
    "isolated_ms": "in a process each, ms",
    "runs_per_s": "runs per s",
    "isolated_runs_per_s": "in a process each",
}


def scene(robots: int, simulated_s: float) -> dict[str, object]:
    """Return a configuration."""
    return {
        "arena_file": str(ROOT / "arenas" / "disk.csv"),
        "arena_surface": AREA_PER_ROBOT_MM2 * robots,
        "simulation_time": simulated_s,
        "save_data_period": 1.0,
        "initial_formation": "random",
        "objects": {"robots": {"type": "pogobot", "nb": robots}},
    }


def processor_s() -> float:
    """Return the processor time of this process and of the children that have ended."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


@contextlib.contextmanager
def written(robots: int, simulated_s: float) -> Iterator[Path]:
    """Have the configuration in a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "short.yaml"
        path.write_text(yaml.safe_dump(scene(robots, simulated_s), sort_keys=False))
        yield path


def simulation_ms(path: Path, runs: int) -> float:
    """Return the processor time of a run, with its reset, in one process."""
    with pogosim.Simulation(f"{PROGRAM}.so", path, seed=0, set={"enable_data_logging": False}) as simulation:
        begin_s = 0.0
        for seed in range(-WARM_UP, runs):
            begin_s = time.process_time() if seed == 0 else begin_s
            simulation.reset(abs(seed))
            simulation.run()
        return (time.process_time() - begin_s) / runs * 1e3


def batch(path: Path, runs: int, workers: int, isolated: bool) -> tuple[float, float]:
    """Do a batch. Returns its wall-clock time in s, and the processor time of a run in ms.

    Raises:
        RuntimeError: Runs failed.
    """
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        begin_s, used_s = time.monotonic(), processor_s()
        runner = PogobotBatchRunner(
            str(path), runs, str(PROGRAM), f"{folder}/tmp", f"{folder}/results", workers=workers, isolated=isolated
        )
        runner.run_all()
        wall_s, each_ms = time.monotonic() - begin_s, (processor_s() - used_s) / runs * 1e3
    if runner.failures:
        raise RuntimeError(f"{len(runner.failures)} runs failed: {runner.failures[0].outcome.problem}")
    return wall_s, each_ms


def measure(robots: int, simulated_s: float, workers: int, runs: int) -> dict[str, float]:
    """Measure one line of the table."""
    with written(robots, simulated_s) as path:
        batch(path, WARM_UP, workers, isolated=False)  # imports, and what the system keeps in memory
        wall_s, run_ms = batch(path, runs, workers, isolated=False)
        isolated_s, isolated_ms = batch(path, runs, workers, isolated=True)
        return {
            "robots": robots,
            "simulated_s": simulated_s,
            "workers": workers,
            "simulation_ms": simulation_ms(path, runs),
            "run_ms": run_ms,
            "isolated_ms": isolated_ms,
            "runs_per_s": runs / wall_s,
            "isolated_runs_per_s": runs / isolated_s,
        }


def as_markdown(rows: pd.DataFrame) -> str:
    """Return the table; times in ms are of the processor, per run."""
    lines = [f"| {' | '.join(COLUMNS.values())} |", "|---" * len(COLUMNS) + "|"]
    for row in rows.to_dict("records"):
        simulation = row["simulation_ms"]
        cells = [f"{row['robots']:.0f}", f"{row['simulated_s']:g}", f"{row['workers']:.0f}", f"{simulation:.1f}"]
        cells += [f"{row[name]:.1f} ({row[name] / simulation:.1f})" for name in ("run_ms", "isolated_ms")]
        cells += [f"{row[name]:.0f}" for name in ("runs_per_s", "isolated_runs_per_s")]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def draw(rows: pd.DataFrame, path: Path) -> None:
    """Draw what a run costs with the most workers, as dots: a logarithmic axis has no zero for bars to begin at."""
    workers = rows["workers"].max()
    most = rows[rows["workers"] == workers]
    names = [f"{row.robots:.0f} robots,\n{row.simulated_s:g} s" for row in most.itertuples()]
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    parts = (
        ("simulation_ms", "simulation with its reset", "o"),
        ("run_ms", "run of a batch", "s"),
        ("isolated_ms", "in a process each", "D"),
    )
    for number, (column, label, marker) in enumerate(parts):
        places = [place + (number - 1) * 0.2 for place in range(len(most))]
        axes.plot(places, most[column], marker, markersize=8, label=label)
        for place, value in zip(places, most[column], strict=True):
            axes.annotate(f"{value:.3g}", (place, value), (0, 7), textcoords="offset points", ha="center", size="small")
    axes.set_xticks(range(len(most)), names)
    axes.set(yscale="log", ylabel="processor time per run, ms")
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(axis="y", color="0.9")
    axes.margins(y=0.15)
    axes.legend(loc="upper left", title=f"{workers:.0f} worker{'' if workers == 1 else 's'}")
    figure.savefig(path, dpi=120)


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, help="folder for the table and the figure")
    parser.add_argument("--runs", type=at_least_one, default=300, help="runs of each batch (default %(default)s)")
    parser.add_argument("--robots", type=at_least_one, nargs="+", default=[20, 100])
    parser.add_argument("--seconds", type=seconds, nargs="+", default=[5.0, 40.0], help="of simulated time")
    parser.add_argument("--workers", type=at_least_one, nargs="+", default=[1, os.cpu_count() or 1])
    options = parser.parse_args()
    check_built(parser, PROGRAM, Path(f"{PROGRAM}.so"))
    if options.output is not None:
        try:
            options.output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            parser.error(f"--output: cannot make the folder {options.output}: {error.strerror}")
    rows = pd.DataFrame(
        [
            measure(robots, simulated_s, workers, options.runs)
            for robots in options.robots
            for simulated_s in options.seconds
            for workers in dict.fromkeys(options.workers)
        ]
    )
    table = as_markdown(rows)
    print(table, end="")
    if options.output is not None:
        rows.to_csv(options.output / "batches.csv", index=False)
        (options.output / "batches.md").write_text(table)
        draw(rows, options.output / "batches.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
