"""How many steps the environments of examples/learning make per second, and how much of it is between time steps.

.venv/bin/python bench/environments.py
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "examples" / "learning"))

try:
    import numpy as np
    from commanded_robots import DECISION_STEPS
    from gym_env import LightSeeker
    from parallel_env import Gathering
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"environments.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

STEPS, RESETS, ROUNDS = 1000, 50, 5
ACTION = np.array([1.0, 0.9], np.float32)


def measure(env: Any, action: Any) -> tuple[float, float, float]:
    """Return the processor time of a reset, of a step, and of the simulator's part of it, in s; the best of rounds."""
    found = []
    for _ in range(ROUNDS):
        start = time.thread_time()
        for seed in range(RESETS):
            env.reset(seed=seed)
        reset = time.thread_time()
        for _ in range(STEPS):
            env.step(action)
        step = time.thread_time()
        env.reset(seed=RESETS - 1)
        simulation = env._robots.simulation
        simulation.user_data["action"] = ACTION
        bare = time.thread_time()
        simulation.step(STEPS * DECISION_STEPS)
        end = time.thread_time()
        found.append(((reset - start) / RESETS, (step - reset) / STEPS, (end - bare) / STEPS))
    reset_s, step_s, bare_s = np.min(found, axis=0)
    return reset_s, step_s, bare_s


def main() -> None:
    """Measure both environments."""
    argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0]).parse_args()
    for env in (LightSeeker(episode_steps=STEPS), Gathering(episode_steps=STEPS)):
        action = dict.fromkeys(env.possible_agents, ACTION) if isinstance(env, Gathering) else ACTION
        env.reset(seed=0)
        reset_s, step_s, bare_s = measure(env, action)
        share = 100 * (1 - bare_s / step_s)
        print(f"{type(env).__name__:12s} {1 / step_s:6.0f} steps per s, {share:.0f} % of it between time steps", end="")
        print(f"; reset {reset_s * 1e3:.1f} ms")
        env.close()


if __name__ == "__main__":
    main()
