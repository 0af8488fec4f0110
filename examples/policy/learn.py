"""Learns the network of the example: CMA-ES searches weights that lead robots to light fast.

    .venv/bin/python examples/policy/learn.py               # half a minute; writes phototaxis.npz and observations.npz

Each candidate drives a swarm of its own, all swarms at once by arrays. observations.npz has what robots of the best one
have seen, for the ranges of the inputs.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

try:
    import cma
    import numpy as np
    import numpy.typing as npt
    import pogosim
    from pogosim.policy import Dense, Network, Policy, network_of
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"learn.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

FOLDER = Path(__file__).resolve().parent
CONFIGURATION = FOLDER.parents[1] / "conf" / "policy.yaml"
HIDDEN = 6
INPUTS = ("light", "ahead", "right")  # sensor counts
OUTPUTS = ("motor_right", "motor_left")
DECISION_STEPS = 4  # time steps of 0.01 s from one decision to the next
DECISIONS = 300
FULL_POWER = 1023
KEPT = 200  # observations

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int32]


def observe(photosensors: npt.NDArray[np.int16]) -> Integers:
    """Return the inputs of the network, as main.c computes them. Shapes (..., 3): back, front left and front right."""
    back, left, right = np.moveaxis(photosensors.astype(np.int32), -1, 0)
    return np.stack([(back + left + right) // 3, (left + right) // 2 - back, right - left], axis=-1)


def network_with(weights: Floats) -> Network:
    """Return the network that has these weights, all in a row."""
    count = len(INPUTS)
    ends = np.cumsum([HIDDEN * count, HIDDEN, len(OUTPUTS) * HIDDEN])
    first, bias, second, last_bias = np.split(weights, ends)
    layers = [
        Dense(first.reshape(HIDDEN, count).astype(np.float32), bias.astype(np.float32), "tanh"),
        Dense(second.reshape(len(OUTPUTS), HIDDEN).astype(np.float32), last_bias.astype(np.float32), "hardtanh"),
    ]
    return network_of(
        layers,
        input_names=INPUTS,
        output_names=OUTPUTS,
        input_offset=[15000, 0, 0],
        input_scale=[1 / 15000, 1 / 1000, 1 / 1000],
        output_scale=FULL_POWER,
    )


def drive(runs: pogosim.VectorSimulation, policies: list[Policy]) -> tuple[Floats, Integers]:
    """Let each policy drive a swarm. Returns the mean light of each swarm, 0 to 1, and what robots of the first saw."""
    brain = runs.brain("robots")
    runs.step(DECISION_STEPS)  # sensors are read at the first tick
    light = np.zeros(len(policies))
    seen: list[Integers] = []
    for _ in range(DECISIONS):
        observations = observe(brain.photosensors)
        seen.append(observations[0])
        for run, policy in enumerate(policies):
            brain.motors[run, :, :2] = np.rint(policy.step(observations[run]))
        runs.step(DECISION_STEPS)
        light += observations[..., 0].mean(axis=1) / 32767 / DECISIONS
    return light, np.concatenate(seen)


def learn(generations: int, folder: Path, population: int = 16) -> float:
    """Search, and write the best network and observations into a folder. Returns its score."""
    size = len(INPUTS) * HIDDEN + HIDDEN + HIDDEN * len(OUTPUTS) + len(OUTPUTS)
    options = {"popsize": population, "seed": 1, "verbose": -9}
    settings = {"objects.robots.brain": "host", "simulation_time": 1e6, "enable_data_logging": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of cma
        search = cma.CMAEvolutionStrategy(size * [0.0], 0.5, options)
        with pogosim.VectorSimulation(None, CONFIGURATION, seeds=range(population), set=settings) as runs:
            for generation in range(generations):
                runs.reset(seeds=population * [generation])  # the same start for all
                candidates = search.ask()
                light, _ = drive(runs, [Policy(network_with(weights)) for weights in candidates])
                search.tell(candidates, list(-light))
                print(f"generation {generation + 1}: light {light.mean():.3f}, best {light.max():.3f}")
            best = Policy(network_with(search.mean))
            runs.reset(seeds=range(1000, 1000 + population))
            light, seen = drive(runs, population * [best])
    best.save(folder / "phototaxis.npz")
    chosen = np.random.default_rng(1).choice(len(seen), KEPT, replace=False)
    ends = [seen.argmin(axis=0), seen.argmax(axis=0)]
    kept = np.concatenate([seen[chosen], *(seen[rows] for rows in ends)])
    np.savez_compressed(folder / "observations.npz", observations=kept.astype(np.int16))
    return float(light.mean())


def main() -> None:
    """Learn, and write the result beside this program."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--generations", type=int, default=14, help="of CMA-ES (default: %(default)s)")
    options.add_argument("--folder", type=Path, default=FOLDER, help="where the files are written")
    chosen = options.parse_args()
    print(f"light on runs that it was not learnt in: {learn(chosen.generations, chosen.folder):.3f}")


if __name__ == "__main__":
    main()
