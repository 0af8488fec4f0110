"""How many robot-steps an environment for learning makes per second, with a policy in NumPy, beside VMAS and JaxMARL.

    .venv/bin/python bench/learning.py [--runs 256] [--robots 20] [--steps 100] [--threads N]
                                       [--vmas PYTHON] [--jaxmarl PYTHON]

A `SwarmEnv` of many runs: a policy multiplies what the robots see (three light sensors; with communication also the
messages that they heard) with a matrix, and gives them powers of motors, and a message of 4 bytes to send at every
decision. The robots, on 10^4 mm2 each, have bodies; time steps are of 16 ms. VMAS (Bettini et al., "VMAS: A Vectorized
Multi-Agent Simulator for Collective Robot Learning", DARS 2022) does the same with its scenario `flocking`, whose steps
are of 0.1 s, if PYTHON, the program, has the package `vmas`, which is not one of those that Pogosim needs. JaxMARL
(Rutherford et al., "JaxMARL: Multi-Agent RL Environments and Algorithms in JAX", NeurIPS 2024) does so with its
scenario `simple_spread`, also of 0.1 s: as many landmarks as agents, each of which sees all others. Policy and steps
are compiled as one loop, and compiling does not count.

Times are processor time, with one thread each, so that other work on the machine counts less; with --threads, they are
wall-clock time, and each simulator has so many threads. The rows take turns, and the best of ROUNDS counts.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

try:
    import numpy as np
    from pogosim.learning import SwarmEnv
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"learning.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one

STEP_S = 0.016
AREA_PER_ROBOT_MM2 = 1e4
ROUNDS = 3

VMAS = """
import sys, time
import torch, vmas
runs, robots, steps, threads = map(int, sys.argv[1:])
now_s = time.perf_counter if threads else time.process_time
torch.set_num_threads(max(1, threads))
env = vmas.make_env("flocking", num_envs=runs, device="cpu", continuous_actions=True, seed=1, n_agents=robots)
seen = env.reset()
matrix = torch.rand(seen[0].shape[1], env.get_agent_action_size(env.agents[0])) - 0.5
with torch.no_grad():
    for _ in range(2):
        seen = env.step([torch.tanh(own @ matrix) for own in seen])[0]
    start_s = now_s()
    for _ in range(steps):
        seen = env.step([torch.tanh(own @ matrix) for own in seen])[0]
print(now_s() - start_s, env.world.dt)
"""

JAXMARL = """
import os, sys, time
runs, robots, steps, threads = map(int, sys.argv[1:])
now_s = time.perf_counter if threads else time.process_time
os.environ["XLA_FLAGS"] = f"--xla_cpu_multi_thread_eigen={str(threads > 1).lower()} "
os.environ["XLA_FLAGS"] += f"intra_op_parallelism_threads={max(1, threads)}"
os.environ["JAX_PLATFORMS"] = "cpu"
import jax, jax.numpy as jnp
from jaxmarl import make
env = make("MPE_simple_spread_v3", num_agents=robots, num_landmarks=robots, action_type="Continuous", max_steps=10**9)
keys = jax.random.split(jax.random.PRNGKey(1), runs)
seen, state = jax.vmap(env.reset)(keys)
shape = (seen[env.agents[0]].shape[-1], env.action_space(env.agents[0]).shape[0])
matrix = jax.random.uniform(keys[0], shape) - 0.5

def step(carry, _):
    keys, seen, state = carry
    actions = {agent: jax.nn.sigmoid(seen[agent] @ matrix) for agent in env.agents}
    keys = jax.vmap(lambda key: jax.random.split(key)[0])(keys)
    seen, state, reward, _, _ = jax.vmap(env.step_env)(keys, state, actions)
    return (keys, seen, state), reward[env.agents[0]].mean()

go_on = jax.jit(lambda carry: jax.lax.scan(step, carry, length=steps))
carry, _ = jax.block_until_ready(go_on((keys, seen, state)))
start_s = now_s()
carry, reward = jax.block_until_ready(go_on(carry))
print(now_s() - start_s, env.dt)
"""


@dataclass(frozen=True)
class Row:
    """A row of the table.

    Attributes:
        name: What is measured.
        decision_s: Simulated time of a step, s.
        measure: Makes steps of all runs, and returns the time that they took, s.
    """

    name: str
    decision_s: float
    measure: Callable[[], float]


def scene(robots: int) -> dict[str, Any]:
    """Return the configuration of a run: robots under a lamp."""
    return {
        "arena_file": "arenas/square.csv",
        "arena_surface": robots * AREA_PER_ROBOT_MM2,
        "time_step": STEP_S,
        "initial_formation": "random",
        "objects": {
            "lamp": {"type": "static_light", "geometry": "disk", "radius": 1e4, "x": 0, "y": 0, "value": 500},
            "robots": {"type": "pogobot", "nb": robots},
        },
    }


def seconds_of(env: SwarmEnv, steps: int, now_s: Callable[[], float]) -> float:
    """Measure steps of an environment with its policy, by a clock."""
    matrix = np.random.default_rng(1).uniform(-0.5, 0.5, (len(env.inputs), len(env.outputs))).astype(np.float32)
    observation, _ = env.reset(seed=1)
    for step in range(2 + steps):
        if step == 2:
            start_s = now_s()
        observation, *_ = env.step(np.tanh(1.0 + observation @ matrix))
    return now_s() - start_s


def row(name: str, ticks: int, talks: bool, options: argparse.Namespace) -> Row:
    """Return a row of ours; `ticks`: from one decision to the next."""
    env = SwarmEnv(
        None,
        scene(options.robots),
        observation=[("photosensors", 0, 1000), *(["messages", "message(4)"] if talks else [])],
        actions=["motors", *(["message(4)"] if talks else [])],
        reward="photosensors[0] / 500",
        end=1e6,
        runs=options.runs,
        decision_s=ticks * STEP_S,
        threads=options.threads or 1,
    )
    clock = time.perf_counter if options.threads else time.process_time
    return Row(name, ticks * STEP_S, lambda: seconds_of(env, options.steps, clock))


def other_row(name: str, python: str, option: str, code: str, options: argparse.Namespace) -> Row:
    """Return the row of another simulator, in a process of the Python that has it."""
    steps = max(1, options.steps // 4)
    command = [python, "-c", code, *map(str, (options.runs, options.robots, steps, options.threads or 0))]

    def measure() -> float:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            said = done.stderr.strip().rpartition("\n")[2]
            sys.exit(f"learning.py: {option}: {python} cannot run {name}: {said}")
        seconds, decision_s = map(float, done.stdout.split()[-2:])
        assert np.isclose(decision_s, 0.1), f"the length of a step of {name}"
        return float(seconds * options.steps / steps)

    return Row(name, 0.1, measure)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--runs", type=at_least_one, default=256, help="runs at once, default %(default)s")
    parser.add_argument("--robots", type=at_least_one, default=20, help="robots of each run, default %(default)s")
    parser.add_argument("--steps", type=at_least_one, default=100, help="steps of each measurement")
    parser.add_argument("--threads", type=at_least_one, help="threads; default: one, by processor time")
    parser.add_argument("--vmas", metavar="PYTHON", help="a Python that has the package vmas, to measure beside")
    parser.add_argument("--jaxmarl", metavar="PYTHON", help="a Python that has the package jaxmarl, likewise")
    options = parser.parse_args()
    rows = [
        row("a decision each tick", 1, False, options),
        row("the same with messages", 1, True, options),
        row("a decision each 6 ticks", 6, False, options),
        row("the same with messages", 6, True, options),
        *([other_row("VMAS flocking", options.vmas, "--vmas", VMAS, options)] if options.vmas else []),
        *(
            [other_row("JaxMARL simple_spread", options.jaxmarl, "--jaxmarl", JAXMARL, options)]
            if options.jaxmarl
            else []
        ),
    ]
    best = np.min([[one.measure() for one in rows] for _ in range(ROUNDS)], axis=0)
    print(f"{options.runs} runs of {options.robots} robots   step, s  million robot-steps per s  robot-hours per s")
    for one, seconds in zip(rows, best.tolist(), strict=True):
        per_s = options.runs * options.robots * options.steps / seconds
        print(f"{one.name:23}  {one.decision_s:<7.3g}  {per_s / 1e6:<25.2f}  {per_s * one.decision_s / 3600:.1f}")


if __name__ == "__main__":
    main()
