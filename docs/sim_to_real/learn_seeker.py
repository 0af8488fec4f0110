"""Learns a policy for `main.c`: CMA-ES finds weights that lead robots to the light, whatever robots the film allows.

    python learn_seeker.py seeker.so --calibration measured/calibration.json

Each candidate drives a swarm of its own, all swarms at once by arrays. policy.npz has the best weights, for `pogosim
export-policy`, and observations.npz what robots have seen with them, for the ranges of the inputs.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

try:
    import cma
    import numpy as np
    import numpy.typing as npt
    from pogosim.calibration import intervals_of
    from pogosim.errors import ToolError
    from pogosim.learning import SwarmEnv
    from pogosim.policy import Dense, Policy, network_of
    from pogosim.simulation import SimulationError
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"learn_seeker.py: {missing}; run it with the Python that has Pogosim", file=sys.stderr)
    sys.exit(2)

HIDDEN = 6
CANDIDATES = 16
KEPT = 200  # observations
FULL_COUNTS, DIFFERENCE_COUNTS = 32767, 3000  # ranges of the light and of differences; sensors do not leave them
FULL_POWER = 1023

Floats = npt.NDArray[np.float64]


def environment(program: Path, configuration: Path, calibration: Path, runs: int) -> SwarmEnv:
    """Return runs in which Python drives the robots, each episode with other ones that fit to the film."""
    return SwarmEnv(
        program,
        configuration,
        observation=[
            ("user_data.light", 0, FULL_COUNTS),
            ("user_data.ahead", -DIFFERENCE_COUNTS, DIFFERENCE_COUNTS),
            ("user_data.right", -DIFFERENCE_COUNTS, DIFFERENCE_COUNTS),
        ],
        actions=[(f"user_data.motor_{side}", -FULL_POWER, FULL_POWER) for side in ("right", "left")],
        reward=f"user_data.light / {FULL_COUNTS}",
        end=20.0,
        randomize=intervals_of(calibration),
        set={"parameters.is_commanded": True},
        runs=runs,
    )


def layers_of(weights: Floats, inputs: int, outputs: int) -> list[Floats]:
    """Return weights and biases of both layers. Shapes (..., units, inputs) and (..., units) for weights (..., all)."""
    ends = np.cumsum([HIDDEN * inputs, HIDDEN, outputs * HIDDEN])
    first, bias, second, last_bias = np.split(weights, ends, axis=-1)
    before = weights.shape[:-1]
    return [first.reshape(*before, HIDDEN, inputs), bias, second.reshape(*before, outputs, HIDDEN), last_bias]


def episodes(env: SwarmEnv, weights: Floats, seed: int) -> tuple[Floats, npt.NDArray[np.float32]]:
    """Let each policy drive a run. Returns the mean light of each, 0 to 1, and all that was seen, as policies see it.

    Args:
        env: It.
        weights: Shape (runs, weights).
        seed: All runs begin alike.
    """
    first, bias, second, last_bias = layers_of(weights, len(env.inputs), len(env.outputs))
    observation, _ = env.reset(seed=[seed] * len(env))
    seen, light = [], np.zeros(len(env))
    for _ in range(env.episode_steps):
        seen.append(observation.copy())
        units = np.tanh(observation @ first.swapaxes(1, 2) + bias[:, None])
        observation, reward, *_ = env.step(np.clip(units @ second.swapaxes(1, 2) + last_bias[:, None], -1, 1))
        light += reward.mean(axis=1) / env.episode_steps
    return light, np.concatenate(seen, axis=1)


def learn(env: SwarmEnv, generations: int, seed: int) -> Floats:
    """Return the weights that a search has found."""
    size = HIDDEN * (len(env.inputs) + 1) + len(env.outputs) * (HIDDEN + 1)
    search = cma.CMAEvolutionStrategy(size * [0.0], 0.5, {"popsize": len(env), "seed": 1 + seed, "verbose": -9})
    for generation in range(generations):
        candidates = np.array(search.ask())
        light, _ = episodes(env, candidates, seed=1000 * seed + generation)
        search.tell(list(candidates), list(-light))
        if generation % 5 == 4 or generation == generations - 1:
            print(f"generation {generation + 1:2}: light {light.mean():.3f}, best {light.max():.3f}")
    return np.asarray(search.mean)


def save(env: SwarmEnv, weights: Floats, folder: Path) -> float:
    """Write the policy, and observations of a run with it. Returns its light in episodes of their own, 0 to 1."""
    first, bias, second, last_bias = layers_of(weights, len(env.inputs), len(env.outputs))
    layers = [Dense(first, bias, "tanh"), Dense(second, last_bias, "hardtanh")]
    network = network_of(layers, **env.policy_arrays())
    Policy(network).save(folder / "policy.npz")
    found = [episodes(env, np.tile(weights, (len(env), 1)), seed=1_000_000 + one) for one in range(3)]
    seen = np.concatenate([one.reshape(-1, len(env.inputs)) for _, one in found])
    random = np.random.default_rng(1)
    kept = np.concatenate([random.choice(seen, KEPT, replace=False), [seen.min(axis=0), seen.max(axis=0)]])
    counts = np.rint(kept / network.input_scale + network.input_offset).astype(np.int32)
    np.savez(folder / "observations.npz", observations=counts)
    return float(np.mean([light.mean() for light, _ in found]))


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("program", type=Path, help="the shared object that `make sim` makes of main.c")
    parser.add_argument("--calibration", type=Path, required=True, help="calibration.json of `pogosim calibrate -o`")
    parser.add_argument("-c", "--config", type=Path, default=Path("swarm.yaml"), help="default: %(default)s")
    parser.add_argument("--generations", type=int, default=30, help="of CMA-ES, default: %(default)s")
    parser.add_argument("--seed", type=int, default=0, help="default: %(default)s")
    options = parser.parse_args()
    try:
        with environment(options.program, options.config, options.calibration, CANDIDATES) as env:
            light = save(env, learn(env, options.generations, options.seed), Path())
    except (ToolError, SimulationError) as error:
        print(f"learn_seeker.py: {error}", file=sys.stderr)
        return 2
    print(f"light in episodes that it was not learnt in: {light:.3f}; written: policy.npz, observations.npz")
    return 0


if __name__ == "__main__":
    sys.exit(main())
