"""Many runs of a swarm as an environment for learning, of plain arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown, without_numpy
from pogosim.learning.actions import Actions
from pogosim.learning.configuration import ConfigurationFile, check_replaced
from pogosim.learning.policy_check import Arrays, check_distinct, check_policy, policy_arrays
from pogosim.learning.quantities import Scaling, check_finite, resolved
from pogosim.learning.randomization import Randomization
from pogosim.learning.reward_and_end import End, OfSwarm, Reward, time_limit
from pogosim.learning.swarm_arrays import SwarmArrays, find_value
from pogosim.outputs import PathLike
from pogosim.simulation import ConfigurationError, SavedState, SimulationError, VectorSimulation
from pogosim.simulation.arrays import chosen_rows
from pogosim.simulation.errors import given
from pogosim.simulation.run import checked_settings, checked_warned

Array = npt.NDArray[Any]
Info = dict[str, Any]

NEXT_STEP, SAME_STEP, DISABLED = "NextStep", "SameStep", "Disabled"  # values of gymnasium.vector.AutoresetMode
MOST_RUNS = 100_000
SIMULATION_SEEDS = 2**32  # there are so many, from 0
LOGGING = "enable_data_logging"


def autoreset_mode(value: Any) -> str:
    """Return a mode by its name, or of Gymnasium's `AutoresetMode`.

    Raises:
        ConfigurationError: It is none.
    """
    found = value.value if isinstance(value, Enum) else value
    if found not in (NEXT_STEP, SAME_STEP, DISABLED):
        raise given.refused("autoreset", f"{NEXT_STEP!r}, {SAME_STEP!r} or {DISABLED!r}", value)
    return str(found)


def time_steps_of(decision_s: float, time_step_s: float) -> int:
    """Return how many time steps there are from one decision to the next.

    Raises:
        ConfigurationError: The time is no multiple of the time step.
    """
    steps = round(decision_s / time_step_s)
    if steps < 1 or not math.isclose(steps * time_step_s, decision_s, rel_tol=1e-6):
        raise ConfigurationError(
            f"decision_s: expected a multiple of time_step, {time_step_s:g} s, found {decision_s:g} s"
        )
    return steps


def as_array(values: list[Any]) -> Array:
    """Return values of the runs as an array: of numbers, texts or truth values alone, or else of objects."""
    kinds = set(map(type, values))
    if kinds <= {int, float} or kinds in ({str}, {bool}):
        return np.array(values)
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array


@dataclass(frozen=True)
class EnvState:
    """What `SwarmEnv.save` returns, for `SwarmEnv.restore` of the same environment while these episodes last.

    Attributes:
        simulations: The states of the runs.
        episodes: Those of the episodes.
        steps: How many each episode has made. Shape (runs,).
        is_over: Which have ended. Shape (runs,).
    """

    simulations: list[SavedState]
    episodes: list[Episode]
    steps: npt.NDArray[np.int64]
    is_over: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Episode:
    """The episode of one run.

    Attributes:
        generator: What draws its seed and its values, and those of the next ones; None: not begun yet.
        seed: That of the simulation.
        drawn: What was drawn, by key of the configuration.
    """

    generator: np.random.Generator | None = None
    seed: int = 0
    drawn: Mapping[str, Any] = field(default_factory=dict)

    def copy(self) -> Episode:
        """Return another one in the same state."""
        generator = None
        if self.generator is not None:
            generator = np.random.default_rng()
            generator.bit_generator.state = self.generator.bit_generator.state
        return replace(self, generator=generator)


@dataclass(frozen=True)
class Task:
    """What a policy sees, does, and is to achieve, as `SwarmEnv` is told."""

    observation: Sequence[Any]
    actions: Sequence[Any]
    reward: str | OfSwarm
    end: Any
    category: str


class TaskOfRuns:
    """A task in runs: all names are looked up.

    Attributes:
        swarm: The robots.
        scaling: That of observations.
        actions: Where they go.
        reward: What a step is worth.
        end: Whether an episode is over before its time.
    """

    def __init__(self, task: Task, runs: VectorSimulation) -> None:
        """Look them up.

        Raises:
            ConfigurationError: Something is wrong.
        """
        self.swarm = SwarmArrays(runs, task.category)
        known = self.swarm.known
        self.scaling = Scaling(
            resolved("observation", task.observation, lambda name: find_value(known, name, "observation"))
        )
        check_distinct("observation", self.scaling.features)
        self.actions = Actions(self.swarm, task.actions)
        check_distinct("actions", self.actions.scaling.features)
        self.reward = Reward(task.reward, self.swarm)
        self.end = End(task.end, self.swarm)


class SwarmEnv:
    """Runs of a swarm, in which a policy of yours decides what the robots do, many at once.

        env = SwarmEnv(None, "conf.yaml", observation=["photosensors"], actions=["motors"], reward="light / 1000",
                       end=20.0, runs=16)
        observation, info = env.reset(seed=1)
        for _ in range(1000):
            observation, reward, terminated, truncated, info = env.step(policy(observation))

    Observations and actions have the shape (runs, robots, numbers), rewards (runs, robots), and ends (runs,). A step is
    `decision_s` of simulated time. Run i with seed s is what run 0 is with seed s + i, whatever the others and threads.

    Attributes:
        runs: The simulations.
        swarm: The robots as they are now, see `SwarmArrays`.
        inputs: Names of the numbers of an observation, such as "photosensors[0]".
        outputs: Names of the numbers of an action, such as "motors[1]".
        observation_low: The least that an observation may be. Shape (inputs,).
        observation_high: The greatest.
        action_low: The least that an action may be; what is below counts as this. Shape (outputs,).
        action_high: The greatest.
        decision_s: Time from one decision to the next, s.
        episode_steps: After so many steps an episode is truncated.
        autoreset: "NextStep", "SameStep" or "Disabled".
        interface: The class whose object drives it, such as "GymnasiumEnv"; empty: none.
    """

    def __init__(
        self,
        program: PathLike | None,
        configuration: PathLike | Mapping[str, Any],
        *,
        observation: Sequence[Any],
        actions: Sequence[Any],
        reward: str | OfSwarm,
        end: Any = None,
        randomize: Mapping[str, Any] | None = None,
        runs: int = 1,
        category: str = "robots",
        decision_s: float = 0.1,
        set: Mapping[str, Any] | None = None,  # noqa: A002 -- as of Simulation
        autoreset: Any = NEXT_STEP,
        threads: int | None = None,
        strict: bool = False,
        warned: set[str] | None = None,
    ) -> None:
        """Begin the runs; their episodes begin with `reset`.

        Args:
            program: Shared object of a program, as of `Simulation`; None: this process drives the robots (`brain:
                host`).
            configuration: A YAML file, or a map with what would stand in it.
            observation: What a policy sees of each robot: names, (name, low, high), or `Quantity`.
            actions: What it does with each robot, likewise.
            reward: What a step is worth: a function of a `SwarmArrays` that returns an array of shape (runs, robots) or
                (runs,), or an expression of values of a robot, such as "light / 1000" or "heard".
            end: When an episode ends: a time (s), which truncates it; a condition, such as "light > 900", which
                terminates it in runs where it is true of a robot; a function of a `SwarmArrays` that returns booleans
                of shape (runs,), which does so where they are true; or a list of these. Where none is a time, the
                `simulation_time` of the configuration is.
            randomize: Keys of the configuration that are drawn for each episode, see `draw_of` of `randomization`.
            runs: How many at once.
            category: That of the robots.
            decision_s: Time from one decision to the next, s: a multiple of `time_step`.
            set: Values for keys of the configuration, as of `Simulation`. Rows are recorded, to temporary files, only
                if a column is used, at each decision, unless `enable_data_logging` and `save_data_period` are set.
            autoreset: When an episode that is over begins anew, as Gymnasium has it: "NextStep", in the next step;
                "SameStep", at once, with the last observation in `info`; "Disabled", by `reset`.
            threads: How many runs go on at a time; None: one for each processor.
            strict: Unknown keys of the configuration are errors, as those of `set` and `randomize` always are.
            warned: As of `Simulation`.

        Raises:
            ConfigurationError: Something of this is wrong.
            ProgramFailedError: The program crashed at its start.
            SimulationError: There is no simulator.
        """
        self.autoreset = autoreset_mode(autoreset)
        self.interface = ""
        self._randomization = Randomization(randomize)
        self.decision_s = given.finite("decision_s", decision_s)
        task = Task(observation, actions, reward, end, given.text("category", category))
        limit_s = time_limit(end)
        if math.isfinite(limit_s) and "simulation_time" in (set or {}):
            raise ConfigurationError("set: simulation_time is that of `end` where this has a time: give one of them")
        changes = checked_settings(set)
        check_replaced(changes)
        settings = self._settings(program, task.category, limit_s) | changes
        count = given.integer("runs", runs, 1, MOST_RUNS)
        self._file = ConfigurationFile(configuration)
        self._warned = checked_warned(warned)
        try:
            self.runs = VectorSimulation(
                program,
                self._file.path,
                range(count),
                threads=threads,
                set=settings,
                strict=strict,
                strict_set=True,
                warned=self._warned,
            )
        except BaseException:
            self._file.close()
            raise
        try:
            self._task = self._task_of(task, may_have_columns=program is not None and LOGGING not in (set or {}))
            self._steps = time_steps_of(self.decision_s, self.runs[0].time_step)
            self.episode_steps = self._episode_steps(limit_s)
        except BaseException:
            self.close()
            raise
        self.swarm = self._task.swarm
        self.inputs, self.outputs = self._task.scaling.features, self._task.actions.scaling.features
        self.observation_low, self.observation_high = self._task.scaling.low, self._task.scaling.high
        self.action_low, self.action_high = self._task.actions.scaling.low, self._task.actions.scaling.high
        self._episodes = [Episode() for _ in range(count)]
        self._info: Info = {}
        self._has_begun = False
        self._episode_step = np.zeros(count, dtype=np.int64)
        self._is_over = np.zeros(count, dtype=np.bool_)
        self._is_halfway = np.zeros(count, dtype=np.bool_)  # a step has not ended
        self._observation = np.zeros((count, self.robots, len(self.inputs)), np.float32)

    def _settings(self, program: PathLike | None, category: str, limit_s: float) -> dict[str, Any]:
        settings: dict[str, Any] = {LOGGING: False, "save_data_period": self.decision_s}
        if program is None:
            settings[f"objects.{category}.brain"] = "host"
        if math.isfinite(limit_s):
            settings["simulation_time"] = limit_s + self.decision_s  # the end of a run is none of the episode
        return settings

    def _task_of(self, task: Task, *, may_have_columns: bool) -> TaskOfRuns:
        """Look up a task in the runs, which record rows from now on if it needs columns of them."""
        try:
            return TaskOfRuns(task, self.runs)
        except ConfigurationError:
            if not may_have_columns:
                raise
        self.runs.reset(set={LOGGING: True})
        return TaskOfRuns(task, self.runs)

    def _episode_steps(self, limit_s: float) -> int:
        if math.isfinite(limit_s):
            return max(1, math.ceil(limit_s / self.decision_s - 1e-9))
        steps = self.runs[0].step_count // self._steps
        if not steps:
            raise ConfigurationError(
                f"simulation_time: expected at least decision_s, {self.decision_s:g} s, where `end` has no time"
            )
        return steps

    @property
    def robots(self) -> int:
        """How many robots of the category each run has."""
        return self.swarm.robots

    def __len__(self) -> int:
        return len(self.runs)

    # ---- Episodes

    def reset(
        self, seed: int | Sequence[int] | None = None, which: npt.ArrayLike | None = None
    ) -> tuple[npt.NDArray[np.float32], Info]:
        """Begin episodes. Equal seeds give equal episodes, and equal ones after them.

        Args:
            seed: That of the first run, the second one gets the next, and so on; or a list with one for each run that
                begins. At least 0. None: each run goes on with its next episode, or a random one.
            which: An index, an array of indices, or an array of booleans, one for each run; None: all.

        Returns:
            Observations, shape (runs, robots, inputs): valid until the next step, which writes into this array. And
            `info`: "seed", those of the simulations, and "randomized", the values that were drawn by their keys; each
            an array with one for each run.

        Raises:
            ConfigurationError: An argument is wrong, or a value that was drawn cannot be used.
        """
        chosen = list(range(len(self))) if which is None else self._chosen(which)
        if seed is not None:
            seeds = self._seeds(seed, chosen)
            for run in chosen:
                self._episodes[run] = Episode(np.random.default_rng(seeds[run]))
        self._begin(chosen)
        return self._observe(), self._told()

    def _chosen(self, which: npt.ArrayLike) -> list[int]:
        return sorted(set(chosen_rows("which", which, len(self), "run", "the environment has").tolist()))

    def _seeds(self, seed: Any, chosen: list[int]) -> dict[int, int]:
        if isinstance(seed, list | tuple | range) or (isinstance(seed, np.ndarray) and seed.ndim):
            if len(seed) != len(chosen):
                raise ConfigurationError(f"seed: expected {len(chosen)}, one for each run, found {len(seed)}")
            return {run: given.integer("seed", one, least=0) for run, one in zip(chosen, seed, strict=True)}
        first = given.integer("seed", without_numpy(seed), least=0)
        return {run: first + run for run in chosen}

    def _begin(self, chosen: list[int]) -> None:
        """Begin an episode in some runs."""
        for run in chosen:
            generator = self._episodes[run].generator or np.random.default_rng()
            seed = int(generator.integers(SIMULATION_SEEDS))
            self._episodes[run] = Episode(generator, seed, self._randomization.drawn(generator))
        self._is_over[chosen] = True  # until it has begun
        begun = [self._episodes[run] for run in chosen]
        self.runs.reset([episode.seed for episode in begun], chosen, [episode.drawn for episode in begun])
        self._randomization.check_integers([episode.drawn for episode in begun], self._warned)
        self._task.actions.forget()
        self.swarm.after_step()
        for run in chosen:
            self.swarm.check_robots(run)
        self._episode_step[chosen], self._is_over[chosen], self._is_halfway[chosen] = 0, False, False
        self._info = self._new_info()
        self._has_begun = all(episode.generator is not None for episode in self._episodes)

    def step(
        self, actions: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], Info]:
        """Let robots act for `decision_s`.

        Args:
            actions: Shape (runs, robots, outputs), finite. What is beyond `action_low` and `action_high` is cut. In
                runs that begin anew in this step, nothing is done.

        Returns:
            Observations, shape (runs, robots, inputs), valid until the next step, which writes into this array; rewards
            (runs, robots); whether episodes have terminated (runs,), and whether they were truncated (runs,); and
            `info`, as of `reset`. With autoreset "SameStep", and only where episodes have ended: "final_obs", the
            observations before they began anew.

        Raises:
            ConfigurationError: Actions, observations or rewards are not finite numbers, or of another shape; or a
                function `end` returns no booleans of shape (runs,).
            SimulationError: An episode has not begun, or is over, or the last step was interrupted or failed: `reset`.
            ProgramFailedError: The program crashed, or did not return.
        """
        wanted = self._task.actions.checked(actions)
        begins_anew = self._is_over.copy()
        self._check_begun(begins_anew)
        try:
            return self._stepped(wanted, begins_anew)
        except BaseException:  # KeyboardInterrupt, too: runs may be at different times
            self._is_halfway[:] = True
            raise

    def _stepped(
        self, wanted: Array, begins_anew: npt.NDArray[np.bool_]
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], Info]:
        """Let robots act, and begin episodes anew."""
        self._task.actions.write(wanted)
        if not begins_anew.all():
            self.swarm.before_step()
            self.runs.step(self._steps, None if not begins_anew.any() else ~begins_anew)
            self._task.actions.tell_of_overwritten()
        if begins_anew.any():
            self._begin(np.flatnonzero(begins_anew).tolist())
        self.swarm.after_step()
        reward = self._task.reward.of_step(begins_anew)
        terminated, truncated = self._ends(begins_anew)
        observation = self._observe()
        is_over = terminated | truncated
        if self.autoreset != SAME_STEP or not is_over.any():
            return observation, reward, terminated, truncated, self._told()
        last = {"final_obs": observation.copy(), "final_info": self._told()}
        self._begin(np.flatnonzero(is_over).tolist())
        return self._observe(), reward, terminated, truncated, self._told() | last

    def _check_begun(self, begins_anew: npt.NDArray[np.bool_]) -> None:
        """Check that an episode of each run has begun, and is not over where nothing begins it anew."""
        if not self._has_begun:
            raise SimulationError("reset the environment before its first step")
        if self._is_halfway.any():
            run = int(np.argmax(self._is_halfway))
            raise SimulationError(f"the last step was interrupted or failed in run {run}: reset the environment")
        if self.autoreset == DISABLED and begins_anew.any():
            run = int(np.argmax(begins_anew))
            raise SimulationError(f"the episode of run {run} is over: reset it (autoreset is {DISABLED!r})")

    def _ends(self, begins_anew: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Count the step, and return which episodes have terminated, and which were truncated."""
        self._episode_step += ~begins_anew
        truncated = self._episode_step >= self.episode_steps
        has_stopped = self.runs.is_over & ~truncated  # the program has ended its run
        terminated = (self._task.end.is_reached() | has_stopped) & ~begins_anew
        self._is_over = terminated | truncated
        return terminated, truncated

    def _observe(self) -> npt.NDArray[np.float32]:
        """Write what robots observe now into the array of observations."""
        into = self._observation
        for quantity, part in self._task.scaling.parts():
            of_robots = self.swarm[quantity.name]
            into[..., part] = of_robots.reshape(*into.shape[:2], quantity.count)
        check_finite("observation", into, self.inputs, self.swarm.when, ": every robot needs a value at every step")
        self._task.scaling.to_policy(into)
        return into

    def _new_info(self) -> Info:
        """Return what is told of the present episodes."""
        drawn = [episode.drawn for episode in self._episodes]
        randomized = {key: as_array([of_run.get(key) for of_run in drawn]) for key in self._randomization.keys}
        seeds = np.array([episode.seed for episode in self._episodes])
        for array in (seeds, *randomized.values()):
            array.flags.writeable = False  # the same arrays are told at each step
        return {"seed": seeds, "randomized": randomized}

    def _told(self) -> Info:
        """Return what is told of the present episodes, in maps that may be changed."""
        return self._info | {"randomized": dict(self._info["randomized"])}

    # ---- Going back

    def save(self) -> EnvState:
        """Copy the state of all runs and episodes, from which `restore` goes on, as often as wanted.

        Raises:
            ConfigurationError: A run cannot be saved, see `Simulation.save`: it records rows, for example.
            SimulationError: The last step was interrupted or failed.
        """
        if self._is_halfway.any():
            raise SimulationError("the last step was interrupted or failed: reset the environment")
        episodes = [episode.copy() for episode in self._episodes]
        return EnvState(self.runs.save(), episodes, self._episode_step.copy(), self._is_over.copy())

    def restore(self, state: EnvState) -> npt.NDArray[np.float32]:
        """Go on from a state that `save` returned: what follows is, to the bit, what followed then.

        Returns:
            The observations of then, as of `reset`.

        Raises:
            ConfigurationError: It is the state of other runs, or an episode has begun since.
        """
        if not isinstance(state, EnvState):
            raise given.refused("state", "what save() has returned", state)
        self.runs.restore(state.simulations)
        self._episodes = [episode.copy() for episode in state.episodes]
        self._episode_step, self._is_over = state.steps.copy(), state.is_over.copy()
        self._is_halfway[:] = False
        self._info = self._new_info()
        self.swarm.after_step()
        return self._observe()

    # ---- Policies

    def policy_arrays(self) -> Arrays:
        """Return the arrays that say what inputs and outputs are.

        To save them with a policy: Policy(network_of(layers, **env.policy_arrays())).save("policy.npz").
        """
        return policy_arrays(self._task.scaling, self._task.actions.scaling, self.decision_s)

    def check_policy(self, policy: PathLike | Mapping[str, Any]) -> Mapping[str, Any]:
        """Check that a policy is for this observation and these actions, and return its arrays by their names.

        Args:
            policy: The path of an .npz file, or arrays.

        Raises:
            ConfigurationError: It is for others; names the first that differs.
        """
        return check_policy(policy, self.policy_arrays())

    # ---- Looking

    def render(self, run: int = 0, width: int = 800, height: int = 800) -> npt.NDArray[np.uint8]:
        """Draw a run now, see `Simulation.render`. Shape (height, width, 3)."""
        return self.runs[run].render(width, height)

    def close(self) -> None:
        """End all runs."""
        self.runs.close()
        self._file.close()

    def __reduce__(self) -> Any:
        raise TypeError("environments cannot be copied or pickled: save() copies their state")

    def __enter__(self) -> SwarmEnv:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return (
            f"<pogosim.learning.SwarmEnv of {len(self)} runs of {self.robots} robots {shown(self.swarm.category)}: "
            f"{len(self.inputs)} inputs, {len(self.outputs)} outputs>"
        )
