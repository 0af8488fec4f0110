"""Four tasks of swarms by which learners are compared: each has a score, and a policy written by hand.

Robots know what Pogobots know: their photosensors, and infrared messages by the face that hears them. The score of an
episode is the mean reward over its steps and robots, from 0 to 1: higher is better. All policies of a task are alike
in all robots, and have no memory but messages.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.learning.swarm_arrays import SwarmArrays
from pogosim.learning.swarm_env import SwarmEnv
from pogosim.nearest_name import advice
from pogosim.simulation import ConfigurationError

Array = npt.NDArray[Any]
Controller = Callable[[Array], Array]  # observations, shape (runs, robots, inputs), to actions (runs, robots, outputs)

ARENA_RADIUS_MM = 564.19  # of a disk of 1 m2, whose middle is as far from both axes
BRIGHTEST = 1000  # sensor counts at the lamp of phototaxis
NEAR_MM = 200.0
COVERED_MM = 150.0
GRID_MM = 25.0
DIM, BRIGHT, NOISE = 450, 550, 150  # sensor counts: what majority decides on
BRIGHT_S = 10.0  # half of an episode
FULL = 255  # of a byte


def scene(robots: Mapping[str, Any], **objects: Any) -> dict[str, Any]:
    """Return a configuration: robots anywhere in a round arena of 1 m2."""
    return {
        "arena_file": "arenas/disk.csv",
        "arena_surface": 1.0e6,
        "initial_formation": "random",
        "objects": {**objects, "robots": {"type": "pogobot", "communication_radius": 300, **robots}},
    }


def uniform_light(**lamp: Any) -> dict[str, Any]:
    """Return a lamp that lights all of the arena."""
    return {"type": "static_light", "geometry": "arena", "light_mode": "static", **lamp}


# ---- Rewards


def nearness(swarm: SwarmArrays) -> Array:
    """Return the mean of exp(-d / 200 mm) over the distances d of each robot to all others. Shape (runs, robots)."""
    places = swarm.positions.astype(np.float64)
    distances = np.hypot(*np.moveaxis(places[:, :, None] - places[:, None], -1, 0))
    near: Array = np.exp(-distances / NEAR_MM).sum(axis=-1)
    return (near - 1.0) / max(1, swarm.robots - 1)  # each is at distance 0 from itself


def points_of_arena() -> Array:
    """Return the points of a grid that are in the arena, mm. Shape (points, 2)."""
    axis = np.arange(GRID_MM / 2, 2 * ARENA_RADIUS_MM, GRID_MM)
    points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    inside: Array = points[np.hypot(*(points - ARENA_RADIUS_MM).T) <= ARENA_RADIUS_MM]
    return inside


POINTS = (points_of_arena() - ARENA_RADIUS_MM).astype(np.float32)  # from the middle, as are places below
SQUARES = np.einsum("pc,pc->p", POINTS, POINTS)


def covered(swarm: SwarmArrays) -> Array:
    """Return the share of the arena that is within 150 mm of a robot. Shape (runs,)."""
    places = (swarm.positions - ARENA_RADIUS_MM).astype(np.float32)
    # |p - q|^2 = |p|^2 + |q|^2 - 2 p q
    squared = SQUARES - 2 * (places @ POINTS.T) + np.einsum("nrc,nrc->nr", places, places)[..., None]
    share: Array = (squared.min(axis=1) <= COVERED_MM**2).mean(axis=1)
    return share


def is_red(swarm: SwarmArrays) -> Array:
    """Return whether the head is red: 0 or 1. Shape (runs, robots)."""
    red: Array = (swarm.leds[:, :, 0, 0] > FULL // 2).astype(np.float64)
    return red


def is_right(swarm: SwarmArrays) -> Array:
    """Return whether the head is red in bright light, and not in dim light: 0 or 1. Shape (runs, robots)."""
    right: Array = is_red(swarm) == (swarm["light"] > (DIM + BRIGHT) / 2)
    return right.astype(np.float64)


# ---- What a robot can know of its reward, from its observation and its action


def heard_by_each(observation: Array) -> Array:
    """Return how many messages all faces have heard, as a share of 8 each. Shape (runs, robots), from 0 to 1."""
    heard: Array = (observation[..., -4:] + 1).mean(axis=-1) / 2
    return heard


def light_felt(observation: Array, _action: Array) -> Array:
    """Return the mean of the three photosensors."""
    light: Array = (observation[..., :3].mean(axis=-1) + 1) / 2
    return light


def company(observation: Array, _action: Array) -> Array:
    """Return how much is heard of others."""
    return heard_by_each(observation)


def solitude(observation: Array, _action: Array) -> Array:
    """Return how little is heard of others."""
    return 1 - heard_by_each(observation)


def says_what_it_sees(observation: Array, action: Array) -> Array:
    """Return 1 where the head is red and the photosensors are bright, or neither; else 0."""
    agrees: Array = (action[..., 1] > 0) == (observation[..., :3].mean(axis=-1) > 0)
    return agrees.astype(np.float64)


# ---- How a swarm behaves


@dataclass(frozen=True)
class Behaviour:
    """A number that tells how a swarm behaves, not how well.

    Attributes:
        name: In words, with its unit.
        of: Gives it now, for each robot: shape (runs, robots).
        low: The least that is usual.
        high: The greatest.
    """

    name: str
    of: Callable[[SwarmArrays], Array]
    low: float
    high: float


def crowding(swarm: SwarmArrays) -> Array:
    """Return the share of the others within 200 mm. Shape (runs, robots)."""
    places = swarm.positions.astype(np.float64)
    is_near = np.hypot(*np.moveaxis(places[:, :, None] - places[:, None], -1, 0)) < NEAR_MM
    share: Array = (is_near.sum(axis=-1) - 1) / max(1, swarm.robots - 1)
    return share


def in_minority(swarm: SwarmArrays) -> Array:
    """Return the share of robots that decide otherwise than most. Shape (runs, robots), alike in a run."""
    red = is_red(swarm).mean(axis=1, keepdims=True)
    return np.broadcast_to(np.minimum(red, 1 - red), (len(swarm.runs), swarm.robots))


MOTION = (
    Behaviour("mean speed, mm/s", lambda swarm: swarm["speed"], 0.0, 100.0),
    Behaviour("share of the others within 200 mm", crowding, 0.0, 1.0),
)
OPINION = (
    Behaviour("share of robots that are red", is_red, 0.0, 1.0),
    Behaviour("share of robots in the minority", in_minority, 0.0, 0.5),
)


# ---- Policies written by hand


def to_light(observation: Array) -> Array:
    """Turn to the brighter side (Braitenberg, "Vehicles", 1984)."""
    turn = 5 * (observation[..., 2] - observation[..., 1])  # above 0: brighter on the right
    return np.stack([0.6 - turn, 0.6 + turn], axis=-1)


def to_others(observation: Array) -> Array:
    """Turn to the side where more robots are heard, and stop between them."""
    front, right, back, left = np.moveaxis(observation[..., :4] + 1, -1, 0)
    forwards, turn = front - back, right - left
    searches = 0.5 * (front + right + back + left == 0)
    motors = np.stack([searches + forwards - turn, searches + forwards + turn], axis=-1)
    return np.concatenate([motors, np.ones_like(motors[..., :1])], axis=-1)


def from_others(observation: Array) -> Array:
    """Go where fewer robots are heard: each repels the others (Howard, Mataric and Sukhatme, 2002)."""
    motors = -to_others(observation)[..., :2]
    return np.concatenate([motors, np.ones_like(motors[..., :1])], axis=-1)


def with_others(observation: Array) -> Array:
    """Say a mean of what is seen and what is heard, and decide by it (DeGroot, 1974)."""
    seen = 4 * observation[..., :3].mean(axis=-1)
    has_heard = (observation[..., 4:8] > -1).any(axis=-1)
    says = np.clip(np.where(has_heard, 0.2 * seen + 0.8 * observation[..., 3], seen), -1, 1)
    red = np.where(says > 0, 1.0, -1.0)
    return np.stack([says, red, -red, np.zeros_like(red)], axis=-1)


# ---- Tasks


@dataclass(frozen=True)
class BenchmarkTask:
    """A task, for any learner.

    Attributes:
        name: On command lines.
        title: In tables and figures.
        configuration: The scene.
        observation: As `SwarmEnv` takes it.
        actions: Likewise.
        reward: Likewise, from 0 to 1.
        by_hand: A policy that a person would write.
        felt: What a robot can know of its reward: of observations, shape (runs, robots, inputs), and actions (runs,
            robots, outputs), a number from 0 to 1 for each robot.
        behaviours: Two, by which swarms may differ.
        aim: What is known of the score from the literature, in words.
        randomize: As `SwarmEnv` takes it.
        end_s: Length of an episode, s.
        decision_s: Time from one decision to the next, s.
    """

    name: str
    title: str
    configuration: Mapping[str, Any]
    observation: Sequence[Any]
    actions: Sequence[Any]
    reward: Any
    by_hand: Controller
    felt: Callable[[Array, Array], Array]
    behaviours: tuple[Behaviour, Behaviour]
    aim: str
    randomize: Mapping[str, Any] = field(default_factory=dict)
    end_s: float = 20.0
    decision_s: float = 0.2

    def make_env(self, runs: int = 1, **options: Any) -> SwarmEnv:
        """Return an environment. `options`: as of `SwarmEnv`, such as `end`, `set` and `threads`."""
        return SwarmEnv(
            None,
            self.configuration,
            **{
                "observation": self.observation,
                "actions": self.actions,
                "reward": self.reward,
                "randomize": self.randomize,
                "end": self.end_s,
                "decision_s": self.decision_s,
                "runs": runs,
                **options,
            },
        )


BEACON = ("message(1)", 0, FULL)
HEARD = ("messages", 0, 8)
TASKS = {
    task.name: task
    for task in (
        BenchmarkTask(
            "phototaxis",
            "go to the light",
            scene(
                {"nb": 5, "photosensors_noise_stddev": 2},
                lamp={
                    "type": "static_light",
                    "geometry": "disk",
                    "radius": 1200,
                    "x": 800,
                    "y": 564,
                    "light_mode": "gradient",
                    "gradient_radius": 900,
                    "value": BRIGHTEST,
                    "edge_value": 0,
                },
            ),
            [("photosensors", 0, BRIGHTEST)],
            ["motors"],
            f"light / {BRIGHTEST}",
            to_light,
            light_felt,
            MOTION,
            "no published curve is comparable: they are of other lamps and arenas",
        ),
        BenchmarkTask(
            "aggregation",
            "gather in the dark",
            scene({"nb": 8}),
            [HEARD],
            ["motors", BEACON],
            nearness,
            to_others,
            company,
            MOTION,
            "Gauci et al. (2014) gather robots by a sensor of the line of sight, which Pogobots lack: not comparable",
        ),
        BenchmarkTask(
            "coverage",
            "spread over the arena",
            scene({"nb": 12}),
            [HEARD],
            ["motors", BEACON],
            covered,
            from_others,
            solitude,
            MOTION,
            "12 disks of 150 mm cover at most 0.85 of the arena, where none overlaps another or the wall",
        ),
        BenchmarkTask(
            "majority",
            "decide whether it is bright",
            scene(
                {"nb": 10, "photosensors_noise_stddev": NOISE},
                lamp=uniform_light(value=DIM),
                # One more for half of the episode, from a time that is drawn.
                other_lamp=uniform_light(
                    value=0, photo_start_at=0, photo_start_duration=BRIGHT_S, photo_start_value=BRIGHT - DIM
                ),
            ),
            [("photosensors", 0, DIM + BRIGHT), BEACON, HEARD],
            [BEACON, ("led", 0, FULL)],
            is_right,
            with_others,
            says_what_it_sees,
            OPINION,
            "one reading of a robot alone is right in 0.72 of cases, and "
            "the mean of one reading of each in 0.97 (normal distribution)",
            {"objects.other_lamp.photo_start_at": [0.0, BRIGHT_S]},
            2 * BRIGHT_S,
        ),
    )
}


def task_of(name: str) -> BenchmarkTask:
    """Return a task by its name.

    Raises:
        ConfigurationError: There is none; names the nearest.
    """
    if name not in TASKS:
        raise ConfigurationError(f"there is no task {shown(name)}{advice(name, TASKS)}")
    return TASKS[name]


def means(env: SwarmEnv, policy: Controller, seeds: Sequence[int], behaviours: Sequence[Behaviour] = ()) -> Array:
    """Return means over the steps and robots of one episode in each run: the score, then behaviours.

    Args:
        env: The environment.
        policy: What the robots do.
        seeds: One for each run.
        behaviours: What is measured besides.

    Returns:
        Shape (runs, 1 + behaviours).
    """
    observation, _ = env.reset(seed=seeds)
    total = np.zeros((len(env), 1 + len(behaviours)))
    for _ in range(env.episode_steps):
        observation, reward, *_ = env.step(policy(observation))
        values = [reward, *(behaviour.of(env.swarm) for behaviour in behaviours)]
        total += np.stack([value.mean(axis=1) for value in values], axis=-1)
    return total / env.episode_steps


def scores(env: SwarmEnv, policy: Controller, seeds: Sequence[int]) -> npt.NDArray[np.float64]:
    """Return the score of one episode in each run, see `means`. Shape (runs,)."""
    score: npt.NDArray[np.float64] = means(env, policy, seeds)[:, 0]
    return score
