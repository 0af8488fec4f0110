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
INTERVAL_S = 0.4  # whole steps of 1, 5, 10 and 16 ms
LAG_S = 10.0  # of displacements
AREA_MM2 = 1e4  # of the arena, per robot
COLUMNS = (
    "contacts per robot",
    "displacement in 10 s, mm",
    "distance from the middle, mm",
    "deepest overlap, mm",
    "processor s",
)
WALL_COLUMNS = ("robots at the wall, %", "deepest in the wall, mm")


def positions_mm(engine: str, arena: str, seed: int, robots: int, time_step_s: float) -> npt.NDArray[np.float64]:
    """Where the robots are from START_S to DURATION_S: (times, robots, 2)."""
    settings = {
        "simulation_time": 2 * DURATION_S,
        "time_step": time_step_s,
        "physics_engine": engine,
        "objects.robots.nb": robots,
        "objects.robots.radius": RADIUS_MM,
        "arena_surface": robots * AREA_MM2,
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
    return [*movement(places), time.process_time() - begin_s]


def movement(places: npt.NDArray[np.float64]) -> list[float]:
    """The figures of a run without its time. `places`: as positions_mm() returns them."""
    robots = places.shape[1]
    first, second = np.triu_indices(robots, 1)
    gaps_mm = np.linalg.norm(places[:, first] - places[:, second], axis=-1) - 2 * RADIUS_MM
    lag = round(LAG_S / INTERVAL_S)
    ways_mm2 = ((places[lag:] - places[:-lag]) ** 2).sum(axis=-1)
    from_middle_mm = np.linalg.norm(places - places.mean(axis=(0, 1)), axis=-1)
    contacts = float((gaps_mm < CONTACT_MM).sum(axis=1).mean()) / robots
    return [contacts, float(np.sqrt(ways_mm2.mean())), float(from_middle_mm.mean()), float(-gaps_mm.min())]


def wall_gaps_mm(places: npt.NDArray[np.float64], corners_mm: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Gaps between robots and the outer wall, a convex polygon of shape (n, 2): (times, robots)."""
    edges = np.roll(corners_mm, -1, axis=0) - corners_mm
    inward = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    inward *= np.sign(((corners_mm.mean(axis=0) - corners_mm) * inward).sum(axis=1))[:, None]
    gaps = np.full(places.shape[:2], np.inf)
    for corner, normal in zip(corners_mm, inward, strict=True):
        gaps = np.minimum(gaps, (places - corner) @ normal)
    return gaps - RADIUS_MM


def step_figures(engine: str, time_step_s: float, seed: int, robots: int) -> list[float]:
    """The figures of one run in the disk: those of COLUMNS but the time, and those of WALL_COLUMNS."""
    places = positions_mm(engine, "disk", seed, robots, time_step_s)
    corners = np.loadtxt(ROOT / "arenas" / "disk.csv", delimiter=",")
    x, y = corners.T
    area = abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2.0
    corners_mm = (corners - corners.min(axis=0)) * math.sqrt(robots * AREA_MM2 / area)
    gaps_mm = wall_gaps_mm(places, corners_mm)
    return [*movement(places), 100.0 * float((gaps_mm < CONTACT_MM).mean()), max(0.0, float(-gaps_mm.min()))]


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
