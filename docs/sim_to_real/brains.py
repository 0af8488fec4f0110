"""Moves the same robots by a policy in Python, in C and as firmware, and says how far apart they are.

    python brains.py seeker.so build/emu/firmware.elf -c real.yaml

All begin alike, and draw the same noise. Prints how far the median robot is from where it is as a program in C, and
draws brains.png.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

try:
    import numpy as np
    import numpy.typing as npt
    import pogosim
    from matplotlib.figure import Figure
    from pogosim.errors import ToolError
    from pogosim.policy import Policy
    from pogosim.simulation import SimulationError
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"brains.py: {missing}; run it with the Python that has Pogosim", file=sys.stderr)
    sys.exit(2)

IN_C = "program in C"
BEFORE_CONTACTS_S = 2.0  # most robots meet later
COLOURS = ("#1f6f8b", "#c0392b", "#d9a441", "#5b8c5a", "#7d5ba6")

Floats = npt.NDArray[np.float64]


def places_of(simulation: pogosim.Simulation, policy: Policy | None = None) -> tuple[Floats, Floats, Floats]:
    """Run to the end; a policy, if any, decides in Python, in each time step.

    Returns:
        Times, s, shape (times,); places, mm, shape (times, robots, 2); the mean light that robots see, sensor counts.
    """
    times, places, light = [], [], []
    with simulation:
        while True:
            times.append(simulation.time)
            places.append(simulation.positions.copy())
            light.append(simulation.light_levels.mean())
            if policy is not None and simulation.time > 0:  # sensors are read at the first tick
                robots = simulation.user_data
                seen = np.stack([robots["light"], robots["ahead"], robots["right"]], axis=-1)
                powers = np.rint(policy.step(seen))
                robots["motor_right"], robots["motor_left"] = powers[:, 0], powers[:, 1]
            if not simulation.step():
                return np.array(times), np.array(places), np.array(light)


def runs_of(options: argparse.Namespace) -> dict[str, tuple[Floats, Floats, Floats]]:
    """Run all brains."""
    observations = np.load("observations.npz")["observations"]

    def simulation(settings: dict[str, Any]) -> pogosim.Simulation:
        unrecorded = settings | {"enable_data_logging": False}
        return pogosim.Simulation(options.program, options.config, seed=options.seed, set=unrecorded)

    firmware = {"objects.robots.brain": {"firmware": str(options.firmware.resolve()), "random": "simulator"}}
    found = {
        IN_C: places_of(simulation({})),
        "firmware": places_of(simulation(firmware)),
        "firmware that takes time": places_of(simulation(firmware | {"objects.robots.cpu_time": "counted"})),
    }
    for numbers in (options.numbers, "float"):
        policy = Policy.load("policy.npz", numbers=numbers, calibration=observations)
        found[f"Python, {numbers}"] = places_of(simulation({"parameters.is_commanded": True}), policy)
    return found


def draw(runs: dict[str, tuple[Floats, Floats, Floats]], apart_mm: dict[str, Floats]) -> Figure:
    """Draw paths of the program in C, the light that robots see, and how far the others are from it."""
    figure = Figure(figsize=(10, 3.6), layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=[1, 1.1, 1.1])
    places = runs[IN_C][1]
    for robot in range(places.shape[1]):
        left.plot(*places[:, robot].T, color=COLOURS[0], linewidth=0.8, alpha=0.7)
    left.plot(*places[0].T, ".", color="#b8b2a3")
    left.plot(*places[-1].T, "o", color="#2b2b2b", markersize=4)
    left.set_aspect("equal")
    left.invert_yaxis()
    left.axis("off")
    for (name, (time_s, _, light)), colour in zip(runs.items(), COLOURS, strict=True):
        middle.plot(time_s, light, color=colour, linewidth=1, label=name)
        if name != IN_C and apart_mm[name].any():
            is_apart = apart_mm[name] > 0
            right.semilogy(time_s[is_apart], apart_mm[name][is_apart], color=colour, linewidth=1, label=name)
    middle.set(xlabel="time, s", ylabel="mean light at the robots, sensor counts")
    right.set(xlabel="time, s", ylabel="distance from the program in C, mm")
    middle.legend(frameon=False, fontsize=8)
    right.legend(frameon=False, fontsize=8)
    return figure


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("program", type=Path, help="the shared object that `make sim` makes")
    parser.add_argument("firmware", type=Path, help="what `make emu` makes")
    parser.add_argument("-c", "--config", type=Path, default=Path("swarm.yaml"), help="default: %(default)s")
    parser.add_argument("--numbers", default="int16", help="those of the export, default: %(default)s")
    parser.add_argument("--seed", type=int, default=1, help="default: %(default)s")
    options = parser.parse_args()
    try:
        runs = runs_of(options)
    except (ToolError, SimulationError, OSError) as error:
        print(f"brains.py: {error}", file=sys.stderr)
        return 2
    time_s, of_program, _ = runs[IN_C]
    apart_mm = {
        name: np.median(np.hypot(*np.moveaxis(run[1] - of_program, -1, 0)), axis=1) for name, run in runs.items()
    }
    near = int(np.searchsorted(time_s, BEFORE_CONTACTS_S - 1e-9))
    print(f"{'':24}  after {time_s[near]:g} s, mm  after {time_s[-1]:g} s, mm  light in the end")
    for name, (_, _, light) in runs.items():
        print(f"{name:24}  {apart_mm[name][near]:<14.2g}  {apart_mm[name][-1]:<14.2g}   {light[-1]:.0f}")
    draw(runs, apart_mm).savefig("brains.png", dpi=90)
    return 0


if __name__ == "__main__":
    sys.exit(main())
