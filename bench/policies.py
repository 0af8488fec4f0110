"""How many robot-steps per second a policy in NumPy drives in many runs at once, beside VMAS.

    .venv/bin/python bench/policies.py [--runs 8 64 256] [--robots 20] [--steps 300] [--vmas PYTHON]

Each step, the policy is given what all robots of all runs see (three light sensors), multiplies it with a matrix, and
gives them powers of motors; the robots, of 22 % of the area, have bodies, and the time step is that of their decisions,
16 ms. VMAS (Bettini et al., "VMAS: A Vectorized Multi-Agent Simulator for Collective Robot Learning", DARS 2022) does
the same with the observations and actions of its scenario `flocking`, on the processor. It is measured if PYTHON, the
program, has the package `vmas`, which is not one of those that Pogosim needs. Times are wall-clock: both use all cores.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
    import pogosim
    import yaml
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"policies.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one

STEP_S = 0.016
AREA_PER_ROBOT_MM2 = 1e4
ROUNDS = 3  # the best counts
FULL = 1023
LIGHT_MAX = 1023.0

VMAS = """
import sys, time
import torch, vmas
runs, robots, steps, rounds = map(int, sys.argv[1:])
env = vmas.make_env("flocking", num_envs=runs, device="cpu", continuous_actions=True, seed=1, n_agents=robots)
seen = env.reset()
matrix = torch.rand(seen[0].shape[1], env.get_agent_action_size(env.agents[0])) - 0.5
best_s = float("inf")
with torch.no_grad():
    for _ in range(rounds):
        start_s = time.perf_counter()
        for _ in range(steps):
            seen = env.step([torch.tanh(own @ matrix) for own in seen])[0]
        best_s = min(best_s, time.perf_counter() - start_s)
print(runs * robots * steps / best_s)
"""


def scene(robots: int) -> dict[str, object]:
    """Return the configuration of a run: robots that a host drives, under a lamp."""
    return {
        "arena_file": "arenas/square.csv",
        "arena_surface": robots * AREA_PER_ROBOT_MM2,
        "simulation_time": 1e6,
        "time_step": STEP_S,
        "enable_data_logging": False,
        "initial_formation": "random",
        "objects": {
            "lamp": {"type": "static_light", "geometry": "disk", "radius": 1e4, "x": 0, "y": 0, "value": 500},
            "robots": {"type": "pogobot", "nb": robots, "brain": "host"},
        },
    }


def robot_steps_per_s(runs: int, robots: int, steps: int) -> float:
    """Measure our runs."""
    with tempfile.TemporaryDirectory() as folder:
        configuration = Path(folder) / "scene.yaml"
        configuration.write_text(yaml.safe_dump(scene(robots)))
        matrix = np.random.default_rng(1).uniform(-0.5, 0.5, (3, 2)).astype(np.float32)
        with pogosim.VectorSimulation(None, configuration, seeds=range(runs)) as simulation:
            brain = simulation.brain("robots")
            best_s = float("inf")
            for _ in range(ROUNDS):
                start_s = time.perf_counter()
                for _ in range(steps):
                    seen = brain.photosensors.astype(np.float32) / LIGHT_MAX
                    brain.motors[:, :, :2] = FULL * np.tanh(1.0 + seen @ matrix)
                    simulation.step()
                best_s = min(best_s, time.perf_counter() - start_s)
    return runs * robots * steps / best_s


def vmas_steps_per_s(python: str, runs: int, robots: int, steps: int) -> float:
    """Measure VMAS, in a process of the Python that has it."""
    command = [python, "-c", VMAS, *map(str, (runs, robots, steps, ROUNDS))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        last = done.stderr.strip().rsplit("\n", 1)[-1]
        sys.exit(f"policies.py: --vmas: {python} cannot run VMAS: {last}")
    return float(done.stdout)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--runs", type=at_least_one, nargs="+", default=[8, 64, 256], help="runs at once")
    parser.add_argument("--robots", type=at_least_one, default=20, help="robots of each run")
    parser.add_argument("--steps", type=at_least_one, default=300, help="steps of each measurement")
    parser.add_argument("--vmas", metavar="PYTHON", help="a Python that has the package vmas, to measure beside")
    options = parser.parse_args()
    print(f"runs  robots  million robot-steps per s{'  VMAS' if options.vmas else ''}")
    for runs in options.runs:
        own = robot_steps_per_s(runs, options.robots, options.steps) / 1e6
        beside = ""
        if options.vmas:
            beside = f"  {vmas_steps_per_s(options.vmas, runs, options.robots, options.steps) / 1e6:.3f}"
        print(f"{runs:<4}  {options.robots:<6}  {own:<25.2f}{beside}", flush=True)


if __name__ == "__main__":
    main()
