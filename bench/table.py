"""Measure how fast swarms run: programs, engines, threads and numbers of robots, as one table and one figure.

    cmake -DPOGOSIM_BUILD_BENCH=ON build/release && cmake --build build/release
    .venv/bin/python bench/table.py -o build/bench [--robots 100 1000 10000 100000] [--programs run_and_tumble ...]

Writes table.csv (all measurements), table.md (what docs/performance.md shows) and performance.png (cost per robot
against their number) into the folder. Takes a quarter of an hour; with --robots 100 1000, some minutes. Only ratios
between measurements of one machine, with nothing else at work on it, mean anything.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

try:
    import matplotlib.pyplot as plt
    import pandas as pd
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"table.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one

ROOT = Path(__file__).resolve().parents[1]
PROGRAMS = ("run_and_tumble", "hanabi", "push_sum", "moving_oscillators", "phototaxis", "walls_and_membranes")
LARGE = 50_000  # robots of which one run is enough
COST = "us_per_robot_and_step"


def measure(program: str, engine: str, threads: int, robots: int) -> dict[str, object]:
    """Run one driver. Returns what it says, with what was asked of it.

    Raises:
        SystemExit: The driver is missing, or fails.
    """
    driver = ROOT / "build" / "release" / "bench" / f"bench_{program}"
    if not driver.exists():
        sys.exit(f"{driver} is missing; cmake -DPOGOSIM_BUILD_BENCH=ON build/release && cmake --build build/release")
    command = [str(driver), "--json", "--runs", "1" if robots >= LARGE else "3", str(robots)]
    command += ["--set", f"physics_engine={engine}", "--set", f"threads={threads}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return {"program": program, "engine": engine, "threads": threads, **json.loads(done.stdout)}


def asked(options: argparse.Namespace) -> list[tuple[str, str, int, int]]:
    """Return the measurements to make: program, engine, threads, robots."""
    return [
        (program, engine, threads, robots)
        for program in options.programs
        for engine in ("disk", "box2d")
        for threads in options.threads
        for robots in options.robots
        if not (engine == "box2d" and (threads > 1 or robots > options.most_box2d))
    ]


def cost_text(row: pd.Series[Any]) -> str:
    """Return the cost of a swarm, and how many times as fast as the real one it is."""
    speed = row["times_real_time"]
    return f"{row[COST]:.3f} ({speed:.0f})" if speed >= 100 else f"{row[COST]:.3f} ({speed:.2g})"


def as_markdown(rows: pd.DataFrame) -> str:
    """Return a table with one line for each program, engine and number of threads."""
    sizes = sorted(rows["robots"].unique())
    middle = 1000 if 1000 in sizes else sizes[0]
    lines = [
        f"| program | engine | threads | {' | '.join(map(str, sizes))} | robots, messages, physics | kB per robot |",
        "|---" * (len(sizes) + 5) + "|",
    ]
    for (program, engine, threads), group in rows.groupby(["program", "engine", "threads"], sort=False):
        of_size = group.set_index("robots")
        costs = [cost_text(of_size.loc[n]) if n in of_size.index else "" for n in sizes]
        usual = of_size.loc[middle if middle in of_size.index else of_size.index[0]]
        shares = ", ".join(f"{100 * usual[f'share_of_{stage}']:.0f}" for stage in ("robots", "messages", "physics"))
        cells = [f"{program}", f"{engine}", f"{threads}", *costs, f"{shares} %", f"{usual['kb_per_robot']:.1f}"]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def draw(rows: pd.DataFrame, path: Path) -> None:
    """Draw the cost per robot against their number, for one thread."""
    figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
    single = rows[rows["threads"] == 1]
    for number, program in enumerate(dict.fromkeys(single["program"])):
        for engine, style in (("disk", "o-"), ("box2d", "s--")):
            line = single[(single["program"] == program) & (single["engine"] == engine)]
            if not line.empty:
                axes.plot(line["robots"], line[COST], style, color=f"C{number}", label=f"{program}, {engine}")
    axes.set(xscale="log", yscale="log", xlabel="robots", ylabel="\u00b5s per robot and step, one thread")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}".replace(",", " ")))
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(which="both", alpha=0.3)
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path, dpi=120)


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("build/bench"), help="folder, default build/bench")
    parser.add_argument("--robots", type=at_least_one, nargs="+", default=[100, 1000, 10_000, 100_000])
    parser.add_argument("--programs", nargs="+", choices=PROGRAMS, default=PROGRAMS)
    parser.add_argument("--threads", type=at_least_one, nargs="+", default=[1, 2], help="of the disk engine")
    parser.add_argument(
        "--most-box2d", type=at_least_one, default=10_000, help="most robots that Box2D moves, default %(default)s"
    )
    options = parser.parse_args()
    try:
        options.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        parser.error(f"--output: cannot make the folder {options.output}: {error.strerror}")
    measurements = []
    for program, engine, threads, robots in asked(options):
        measurements.append(measure(program, engine, threads, robots))
        rows = pd.DataFrame(measurements)
        print(f"{program}, {engine}, threads {threads}, {robots} robots: {rows[COST].iloc[-1]:.3g} us", flush=True)
        rows.to_csv(options.output / "table.csv", index=False)
    (options.output / "table.md").write_text(as_markdown(rows))
    draw(rows, options.output / "performance.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
