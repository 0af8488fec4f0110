"""Many runs at once, on threads."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager
from contextvars import ContextVar, copy_context
from types import TracebackType
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.firmware import is_firmware
from pogosim.outputs import PathLike
from pogosim.simulation.arrays import RunState, chosen_rows
from pogosim.simulation.errors import ConfigurationError, SimulationError, given
from pogosim.simulation.forked import check_process, is_forked
from pogosim.simulation.library import OK, OVER
from pogosim.simulation.many_runs import ManyRuns, RunThreads, all_held
from pogosim.simulation.objects import chosen_index
from pogosim.simulation.run import CLOSED, MOST_STEPS, Simulation, checked_seed
from pogosim.simulation.saved_state import SavedState
from pogosim.simulation.vector_brain import VectorBrain

MOST_THREADS = 1024
MOST_RUNS = 100_000

T = TypeVar("T")

# The vectors whose `each` has called the code of this thread, which must not wait for their threads again.
callers: ContextVar[tuple[VectorSimulation, ...]] = ContextVar("callers", default=())


def checked_seeds(seeds: Any) -> list[int | None]:
    """Return seeds, one for each run.

    Raises:
        ConfigurationError: They are none.
    """
    try:
        found = list(itertools.islice(iter(seeds), MOST_RUNS + 1))
    except TypeError:
        raise given.refused("seeds", "a list of integers, one for each run", seeds) from None
    if len(found) > MOST_RUNS:
        raise ConfigurationError(f"seeds: expected {MOST_RUNS} runs at most, found more")
    return [checked_seed(seed) for seed in found]


def call_with_run(function: Callable[[Simulation], T], simulation: Simulation, index: int) -> T:
    """Call a function with a run; errors of runs say which one it was."""
    try:
        return function(simulation)
    except SimulationError as error:
        raise type(error)(f"run {index}: {error}") from None


def present(simulation: Simulation) -> RunState:
    """Return the present run of a simulation."""
    return simulation._run


def alike(arrays: list[npt.NDArray[Any]]) -> list[npt.NDArray[Any]]:
    """Return arrays that can be stacked.

    Raises:
        SimulationError: There are none, or runs have different numbers of robots.
    """
    shapes = {array.shape for array in arrays}
    if len(shapes) != 1:
        found = " and ".join(str(shape[0]) for shape in sorted(shapes)) or "no runs"
        raise SimulationError(f"arrays of all runs need the same number of robots in each, found {found}")
    return arrays


class VectorSimulation:
    """Runs of one program with different seeds, stepped together on several threads.

        with pogosim.VectorSimulation("examples/hanabi/hanabi.so", "conf/simple.yaml", seeds=range(8)) as runs:
            runs.step(100)
            print(runs.positions.shape)  # (8, robots, 2)

    What each run gives does not depend on the others, nor on the number of threads. `runs[3]` is one of them.
    """

    def __init__(
        self,
        program: PathLike | None,
        configuration: PathLike,
        seeds: Sequence[int] | range,
        *,
        threads: int | None = None,
        **options: Any,
    ) -> None:
        """Begin one run for each seed.

        Args:
            program: As of `Simulation`.
            configuration: As of `Simulation`.
            seeds: One for each run.
            threads: How many runs go on at a time; None: one for each processor.
            **options: As of `Simulation`, the same for all. A warning of several runs is passed on once.
        """
        chosen_seeds = checked_seeds(seeds)
        count = os.cpu_count() or 1 if threads is None else given.integer("threads", threads, 1, MOST_THREADS)
        options.setdefault("warned", set())
        self._threads = ThreadPoolExecutor(count, thread_name_prefix="pogosim")
        self._process = os.getpid()
        self._is_closed = False
        self.simulations: list[Simulation] = []
        self._stepping = RunThreads(min(count, max(1, len(chosen_seeds))))
        self._many = ManyRuns([])
        self._brains: dict[str, VectorBrain] = {}
        begun = [
            self._threads.submit(Simulation, program, configuration, seed=seed, **options) for seed in chosen_seeds
        ]
        try:
            wait(begun)
            self.simulations = [run.result() for run in begun]
        except BaseException:
            self._threads.shutdown(cancel_futures=True)
            for run in begun:
                if not run.cancelled() and run.exception() is None:
                    run.result().discard()
            raise

    def each(self, function: Callable[[Simulation], T]) -> list[T]:
        """Call a function with each run, on the threads.

        Returns:
            What it returned, in order. If it raises an exception for some runs, the others go on, and the first of
            these exceptions comes when all are ready. After Ctrl-C, runs that step stop between two time steps.
        """
        self._check_open()
        if not callable(function):
            raise given.refused("function", "a function of a Simulation", function)
        return self._each(function, range(len(self)))

    def _each(self, function: Callable[[Simulation], T], chosen: Sequence[int]) -> list[T]:
        """Call a function with each of some runs."""
        self._check_outside("each, step, reset, save and restore")
        context = copy_context()
        context.run(callers.set, (*callers.get(), self))
        calls = [
            self._threads.submit(context.copy().run, call_with_run, function, self.simulations[index], index)
            for index in chosen
        ]
        try:
            wait(calls)
        except BaseException:
            for call in calls:
                call.cancel()
            self._pause(calls)
            raise
        return [call.result() for call in calls]

    def _check_open(self) -> None:
        check_process(self._process)  # a forked child has none of the threads
        if self._is_closed:
            raise SimulationError(CLOSED)

    def _check_outside(self, what: str) -> None:
        if self in callers.get():
            raise SimulationError(
                f"{what} of a VectorSimulation cannot be called by a function that its each calls: it would wait for "
                "itself; use the simulation that the function is given"
            )

    def _pause(self, calls: list[Future[T]]) -> None:
        """Let runs stop between two time steps; none is in use afterwards."""
        for simulation in self.simulations:
            simulation._current.should_pause = True
        try:
            wait(calls)
        finally:
            for simulation in self.simulations:
                simulation._current.should_pause = False

    def step(self, steps: int = 1, which: npt.ArrayLike | None = None) -> list[int]:
        """Go on with all of them, see `Simulation.step`: one call of the library for all. Returns the steps of each.

        If some runs fail, the others go on, and the first of the errors comes when all are ready. After Ctrl-C, runs
        stop between two time steps.

        Args:
            steps: How many.
            which: The runs that go on, as of `reset`; None: all.
        """
        steps = min(given.integer("steps", steps, least=0), MOST_STEPS)
        waiting = None if which is None else np.setdiff1d(np.arange(len(self)), self._chosen(which))
        check_process(self._process)
        self._check_outside("each, step, reset, save and restore")
        runs = self._runs()
        failed: dict[int, SimulationError] = {}
        with self._all_held():
            exchanges = [array for brain in self._brains.values() for array in brain._exchanges(runs)]
            turns = runs.turns
            turns["left"], turns["status"] = steps, OK
            if waiting is not None:
                turns["status"][waiting] = OVER
            is_first = True
            while is_first or ((turns["left"] > 0) & (turns["status"] == OK)).any():
                is_first = False
                try:
                    failed |= self._stepping.step(runs, exchanges)
                finally:
                    for run in np.flatnonzero(turns["has_messages"]).tolist():
                        self.simulations[run]._pass_messages_on()
            for brain in self._brains.values():
                brain._note_step(runs)
        if failed:
            run = min(failed)
            raise type(failed[run])(f"run {run}: {failed[run]}")
        if waiting is not None:
            turns["left"][waiting] = steps
        return [steps - left for left in turns["left"].tolist()]

    def _all_held(self) -> AbstractContextManager[None]:
        """Hold the locks of all simulations in a `with` block, see `all_held`."""
        return all_held([(simulation._lock, simulation._current.is_shared) for simulation in self.simulations])

    def _runs(self) -> ManyRuns:
        """Return the present runs; after a reset of one, there are others."""
        if self._is_closed:
            raise SimulationError(CLOSED)
        states = [simulation._current.run for simulation in self.simulations]
        if states != self._many.states:
            self._many = ManyRuns(
                [call_with_run(present, simulation, index) for index, simulation in enumerate(self.simulations)]
            )
        return self._many

    def brain(self, category: str) -> VectorBrain:
        """Return the arrays that drive the robots of a category in all runs, see `VectorBrain`.

        Raises:
            ConfigurationError: There is no such category, something else drives its robots, or runs have different
                numbers of them.
        """
        name = given.text("category", category)
        self._runs()  # raises if they are closed
        if name not in self._brains:
            sizes = {len(simulation.brain(name)) for simulation in self.simulations}
            if len(sizes) != 1:
                found = " and ".join(map(str, sorted(sizes))) or "no runs"
                raise ConfigurationError(f"the brains of all runs need the same number of robots, found {found}")
            self._brains[name] = VectorBrain(self._runs, name, *sizes)
        return self._brains[name]

    def reset(
        self,
        seeds: Sequence[int] | range | None = None,
        which: npt.ArrayLike | None = None,
        set: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None,  # noqa: A002 -- as of Simulation.reset
    ) -> None:
        """Begin some of them again, or all.

            runs.reset(which=runs.is_over)

        Args:
            seeds: One for each run that begins again; None: their own.
            which: An index, an array of indices, or an array of booleans, one for each run; None: all.
            set: As of `Simulation.reset`, the same for all runs that begin again, or a list with one for each.

        Raises:
            ConfigurationError: There are more or fewer seeds or maps than runs, no run of an index, or one is there
                twice.
        """
        self._check_open()
        chosen = self._chosen(which)
        maps: list[Any] = list(set) if isinstance(set, list | tuple) else [set] * len(chosen)
        if len(maps) != len(chosen):
            raise ConfigurationError(f"set: expected {len(chosen)} maps, one for each run, found {len(maps)}")
        new_seeds = [None] * len(chosen) if seeds is None else checked_seeds(seeds)
        if len(new_seeds) != len(chosen):
            raise ConfigurationError(f"seeds: expected {len(chosen)}, one for each run, found {len(new_seeds)}")
        begin = {
            id(self.simulations[run]): (seed, settings)
            for run, seed, settings in zip(chosen, new_seeds, maps, strict=True)
        }
        self._each(lambda simulation: simulation.reset(*begin[id(simulation)]), chosen)

    def save(self, which: npt.ArrayLike | None = None) -> list[SavedState]:
        """Copy the states of some of them, or of all, see `Simulation.save`. `which`: as of `reset`. In their order.

        Raises:
            ConfigurationError: A run cannot be saved, there is no run of an index, or one is there twice.
        """
        self._check_open()
        return self._each(Simulation.save, self._chosen(which))

    def restore(self, states: Sequence[SavedState], which: npt.ArrayLike | None = None) -> None:
        """Go on from states of these runs, see `Simulation.restore`.

            states = runs.save()
            runs.restore(states)

        Args:
            states: One for each run that goes back, its own.
            which: As of `reset`.

        Raises:
            ConfigurationError: There are more or fewer states than runs, one is of another run, there is no run of an
                index, or one is there twice. When a state is of another run, all others are restored.
        """
        self._check_open()
        chosen = self._chosen(which)
        found = list(states) if isinstance(states, Sequence) else None
        if found is None or len(found) != len(chosen):
            told = shown(states) if found is None else str(len(found))
            raise ConfigurationError(f"states: expected {len(chosen)}, one for each run, found {told}")
        state_of = {id(self.simulations[run]): state for run, state in zip(chosen, found, strict=True)}
        self._each(lambda simulation: simulation.restore(state_of[id(simulation)]), chosen)

    def _chosen(self, which: npt.ArrayLike | None) -> list[int]:
        """Return the indices of the runs that an argument chooses, each once; None: all."""
        if which is None:
            return list(range(len(self)))
        chosen: list[int] = chosen_rows("which", which, len(self), "run", "the simulation has").tolist()
        if len(set(chosen)) < len(chosen):
            raise ConfigurationError("which: each run can be named once only")
        return chosen

    @property
    def positions(self) -> npt.NDArray[Any]:
        """Positions of all robots, mm. Shape (runs, robots, 2); a copy. All runs must have as many robots."""
        return self._read("bodies.position", lambda simulation: simulation.positions)

    @property
    def headings(self) -> npt.NDArray[Any]:
        """Headings of all robots, rad, clockwise on the screen, not wrapped. Shape (runs, robots); a copy."""
        return self._read("bodies.heading", lambda simulation: simulation.headings)

    @property
    def velocities(self) -> npt.NDArray[Any]:
        """Velocities of all robots in the last step, mm/s. Shape (runs, robots, 2); a copy."""
        return self._read("bodies.velocity", lambda simulation: simulation.velocities)

    @property
    def angular_velocities(self) -> npt.NDArray[Any]:
        """Angular velocities of all robots in the last step, rad/s. Shape (runs, robots); a copy."""
        return self._read("bodies.angular_velocity", lambda simulation: simulation.angular_velocities)

    @property
    def light_levels(self) -> npt.NDArray[np.float64]:
        """Light at each robot, as of `Simulation.light_levels`. Shape (runs, robots); a copy."""
        return self._read("light_levels", lambda simulation: simulation.light_levels)

    @property
    def messages_sent(self) -> npt.NDArray[Any]:
        """Messages that each robot has sent. Shape (runs, robots); a copy."""
        return self._read("robots.messages_sent", lambda simulation: simulation.messages_sent)

    @property
    def messages_received(self) -> npt.NDArray[Any]:
        """Messages that each robot has taken out of its queue. Shape (runs, robots); a copy."""
        return self._read("robots.messages_received", lambda simulation: simulation.messages_received)

    @property
    def user_data(self) -> npt.NDArray[Any]:
        """USERDATA of all robots, as of `Simulation.user_data`. Shape (runs, robots); a copy.

        What is written to it reaches no robot: write to `runs[3].user_data`.

        Raises:
            SimulationError: The program has no user data, or was compiled without `-g`.
        """
        program = self.simulations[0].program if self.simulations else None
        if program is not None and is_firmware(program):
            return np.stack(alike([simulation.user_data for simulation in self.simulations]))
        return self._read("robots.user_data", lambda simulation: simulation.user_data)

    @property
    def leds(self) -> npt.NDArray[Any]:
        """Colours of the LEDs, as of `Simulation.leds`. Shape (runs, robots, 5, 3); a copy."""
        return self._read("robots.led", lambda simulation: simulation.leds)

    def _read(self, name: str, of_one: Callable[[Simulation], npt.NDArray[Any]]) -> npt.NDArray[Any]:
        """Return an array of all runs, by one call of the library."""
        check_process(self._process)
        if not self.simulations:
            return np.stack(alike([]))
        runs = self._runs()
        like = of_one(self.simulations[0])
        into = np.empty((len(self.simulations), *like.shape), dtype=like.dtype)
        try:
            runs.read(name, into)
        except ConfigurationError:
            return np.stack(alike([of_one(simulation) for simulation in self.simulations]))
        return into

    def column(self, name: str) -> Any:
        """Return a column that the program has added to the data file, at the last save of each run.

        Args:
            name: As of `Simulation.columns`.

        Returns:
            A masked array of shape (runs, robots), a copy; of strings, a list for each run.

        Raises:
            KeyError: There is no such column.
        """
        first = self.simulations[0].columns[name] if self.simulations else None
        if not isinstance(first, np.ndarray):
            return [simulation.columns[name] for simulation in self.simulations] or np.ma.stack(alike([]))
        values = self._read(f"columns.{name}", lambda simulation: simulation.columns[name].data)
        absent = self._read(f"columns_absent.{name}", lambda simulation: simulation.columns[name].mask)
        return np.ma.MaskedArray(values, absent)

    @property
    def is_over(self) -> npt.NDArray[np.bool_]:
        """Which runs are over. Shape (runs,)."""
        check_process(self._process)
        if self._is_closed or any(simulation._current.run is None for simulation in self.simulations):
            return np.array([simulation.is_over for simulation in self.simulations])
        over = np.empty(len(self.simulations))
        self._runs().read("is_over", over)
        return over.astype(bool)

    def close(self) -> None:
        """End all runs.

        Raises:
            SimulationError: Another thread uses one of them; none is closed then.
        """
        self._check_outside("close")
        if not is_forked(self._process) and not self._is_closed:
            with self._all_held():
                pass
        self._is_closed = True
        for simulation in self.simulations:
            simulation.close()
        self._many = ManyRuns([])
        self._stepping.close()
        self._threads.shutdown(wait=not is_forked(self._process))

    def __len__(self) -> int:
        return len(self.simulations)

    def __iter__(self) -> Iterator[Simulation]:
        return iter(self.simulations)

    def __getitem__(self, index: int) -> Simulation:
        return self.simulations[chosen_index(index, len(self), "run")]

    def __enter__(self) -> VectorSimulation:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
