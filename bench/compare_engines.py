"""Compare how swarms move with each physics engine: run_and_tumble in several arenas, over seeds.

    .venv/bin/python bench/compare_engines.py [--robots 300] [--seeds 6] [--time-step 0.01] [disk annulus H ...]

Prints a table in Markdown: means over the seeds, with the standard deviation between them. docs/physics.md explains it.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path

try:
    import numpy as np
    import numpy.typing as npt
    import pogosim
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"compare_engines.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, check_built, seconds

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "run_and_tumble" / "run_and_tumble.so"
RADIUS_MM = 26.5
CONTACT_MM = 1.5  # robots with a smaller gap are in contact
DURATION_S = 60.0
START_S = 10.0  # not counted: robots leave their first places
INTERVAL_S = 0.5
LAG_S = 10.0  # of displacements
COLUMNS = (
    "contacts per robot",
    "way in 10 s, mm",
    "distance from the middle, mm",
    "deepest overlap, mm",
    "processor s",
)


def positions_mm(engine: str, arena: str, seed: int, robots: int, time_step_s: float) -> npt.NDArray[np.float64]:
    """Where the robots are from START_S to DURATION_S: (times, robots, 2)."""
    settings = {
        "simulation_time": 2 * DURATION_S,
        "time_step": time_step_s,
        "physics_engine": engine,
        "objects.robots.nb": robots,
        "objects.robots.radius": RADIUS_MM,
        "arena_surface": robots * 1e4,
        "arena_file": str(ROOT / "arenas" / f"{arena}.csv"),
        "enable_data_logging": False,
    }
    places = []
    with pogosim.Simulation(str(PROGRAM), ROOT / "conf" / "simple.yaml", seed=seed, set=settings) as simulation:
        for _ in range(round(DURATION_S / INTERVAL_S)):
            simulation.step(round(INTERVAL_S / time_step_s))
            places.append(np.array(simulation.positions))
    return np.array(places)[round(START_S / INTERVAL_S) :]


def figures(engine: str, arena: str, seed: int, robots: int, time_step_s: float) -> list[float]:
    """The figures of one run, in the order of COLUMNS."""
    begin_s = time.process_time()
    places = positions_mm(engine, arena, seed, robots, time_step_s)
    spent_s = time.process_time() - begin_s
    first, second = np.triu_indices(robots, 1)
    gaps_mm = np.linalg.norm(places[:, first] - places[:, second], axis=-1) - 2 * RADIUS_MM
    lag = round(LAG_S / INTERVAL_S)
    ways_mm2 = ((places[lag:] - places[:-lag]) ** 2).sum(axis=-1)
    from_middle_mm = np.linalg.norm(places - places.mean(axis=(0, 1)), axis=-1)
    contacts = float((gaps_mm < CONTACT_MM).sum(axis=1).mean()) / robots
    return [contacts, float(np.sqrt(ways_mm2.mean())), float(from_middle_mm.mean()), float(-gaps_mm.min()), spent_s]


def with_spread(mean: float, spread: float) -> str:
    """Return a mean and its standard deviation, which has two digits: 1100.3 ± 4.2."""
    decimals = max(0, 1 - math.floor(math.log10(spread))) if spread > 0 else 3
    return f"{mean:.{decimals}f} ± {spread:.{decimals}f}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("arenas", nargs="*", default=["disk", "annulus", "H"], help="files in arenas/, without .csv")
    parser.add_argument("--robots", type=at_least_one, default=300)
    parser.add_argument("--seeds", type=at_least_one, default=6)
    parser.add_argument("--time-step", type=seconds, default=0.01, help="s")
    options = parser.parse_args()
    check_built(parser, PROGRAM)
    for arena in options.arenas:
        if not (ROOT / "arenas" / f"{arena}.csv").is_file():
            parser.error(f"there is no arena {arena} in arenas/")
    print("| arena | engine |" + "|".join(f" {name} " for name in COLUMNS) + "|")
    print("|---" * (len(COLUMNS) + 2) + "|")
    for arena in options.arenas:
        for engine in ("box2d", "disk"):
            runs = [
                figures(engine, arena, seed, options.robots, options.time_step) for seed in range(1, options.seeds + 1)
            ]
            cells = map(with_spread, np.mean(runs, 0), np.std(runs, 0))
            print(f"| {arena} | {engine} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
