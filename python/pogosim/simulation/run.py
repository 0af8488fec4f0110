"""One run inside this process."""

from __future__ import annotations

import logging
import math
import operator
import os
import shutil
import tempfile
import threading
import warnings
import weakref
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from ctypes import byref, c_double, c_int64, c_void_p
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.outputs import PathLike
from pogosim.simulation.arrays import array_of
from pogosim.simulation.columns import Columns
from pogosim.simulation.errors import ConfigurationError, SimulationError
from pogosim.simulation.library import OVER, OpenRun, check, library, open_run
from pogosim.simulation.objects import Lamps, Objects, WorldObject, check_object
from pogosim.simulation.user_data import user_data_type
from pogosim.yaml_1_2 import dump_yaml

if TYPE_CHECKING:
    import pandas as pd

NO_BODY = 2**32 - 1
MOST_SEED = 2**32 - 1
CLOSED = "the simulation is closed: make another one"
SLICE_S = 0.05  # of wall-clock time, after which Ctrl-C is looked for
LEVELS = {"D": logging.DEBUG, "I": logging.INFO, "W": logging.WARNING, "E": logging.ERROR}
logger = logging.getLogger("pogosim")
robot_logger = logging.getLogger("pogosim.robots")


def plain(value: Any) -> Any:
    """Return a value without types of NumPy."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return {plain(key): plain(item) for key, item in value.items()}
    return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def yaml_text(value: Any) -> str:
    """Return a value as YAML in one line."""
    return dump_yaml(plain(str(value) if isinstance(value, Path) else value), is_flow=True).strip()


def settings_of(values: Mapping[str, Any]) -> list[str]:
    """Return the texts that `--set` would take."""
    return [f"{key}={yaml_text(value)}" for key, value in values.items()]


class Parameters(MutableMapping[str, Any]):
    """Values under `parameters` of the configuration that `set` gave, or that were set since, by name (dots: in maps).

    Setting one gives the program's variable the value at once, and every later `reset` begins with it.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __getitem__(self, name: str) -> Any:
        return self._simulation._parameter_values[name]

    def __setitem__(self, name: str, value: Any) -> None:
        self._simulation._set_parameter(name, value)

    def __delitem__(self, name: str) -> None:
        raise TypeError("a parameter cannot be removed")

    def __iter__(self) -> Iterator[str]:
        return iter(self._simulation._parameter_values)

    def __len__(self) -> int:
        return len(self._simulation._parameter_values)

    def __repr__(self) -> str:
        return f"Parameters({dict(self)!r})"


class Simulation:
    """A run of a program, which goes on as far as it is told to.

    Any number of them can exist at the same time, of the same program or others; each result is what it would be alone.
    A simulation is for one thread at a time, and `step` lets other threads of Python run.

        with pogosim.Simulation("examples/hanabi/hanabi.so", "conf/simple.yaml", seed=3) as sim:
            sim.step(100)
            print(sim.time, sim.positions.mean(axis=0))

    Messages of the simulator go to the logger "pogosim", lines that robots print to "pogosim.robots".

    Attributes:
        program: The shared object.
        configuration: The YAML file.
        parameters: Values under `parameters`; they can be set during the run, see `Parameters`.
    """

    def __init__(
        self,
        program: PathLike,
        configuration: PathLike,
        *,
        seed: int | None = None,
        set: Mapping[str, Any] | None = None,  # noqa: A002 -- the name of the option
        data_file: PathLike | None = None,
        strict: bool = False,
    ) -> None:
        """Build the world and run the program up to time 0.

        Args:
            program: Shared object, as `make sim` makes beside the executable (`hanabi.so` for `hanabi`); for an
                executable, the shared object beside it is taken.
            configuration: YAML file. Nothing is drawn, and no console file written, unless `set` says so.
            seed: 0 to 2^32 - 1; None: that of the configuration, or a random one.
            set: Values for keys of the configuration, such as {"objects.robots.nb": 50}.
            data_file: Where the rows go; None: to a temporary file, for `to_dataframe`.
            strict: Unknown keys are errors.

        Raises:
            ConfigurationError: The program or the configuration is missing or wrong.
            ProgramFailedError: The program crashed at its start.
            SimulationError: There is no simulator, or one of another version.
        """
        self.program = shared_object(Path(program))
        self.configuration = Path(configuration)
        self.parameters = Parameters(self)
        self._remove_folder: Callable[[], object] = bool
        self._should_pause = False
        check_seed(seed)
        if data_file is None:
            folder = tempfile.mkdtemp(prefix="pogosim-")
            self._remove_folder = weakref.finalize(self, remove_own_folder, folder, os.getpid())
            self.data_file = Path(folder) / "data.feather"
        else:
            self.data_file = Path(data_file)
        self._settings: dict[str, Any] = {
            "enable_console_logging": False,
            "save_video_period": -1,
            "data_filename": str(self.data_file),
            **(set or {}),
        }
        self._strict = strict
        self._lock = threading.Lock()
        self._is_closed = False
        self._open(seed)

    def _open(self, seed: int | None) -> None:
        self._handle: OpenRun | None = open_run(
            self.program, self.configuration, settings_of(self._settings), seed, self._strict
        )
        self._is_over = self._has_failed = False
        self._arrays: dict[str, npt.NDArray[Any]] = {}
        self._slices: dict[str, Any] = {}
        self._parameter_values = {
            key.removeprefix("parameters."): value
            for key, value in self._settings.items()
            if key.startswith("parameters.")
        }
        self._pass_messages_on()

    # ---- The run

    def step(self, steps: int = 1) -> int:
        """Go on by so many time steps, or to the end of the run.

        Returns:
            How many steps were made: fewer when the simulated time is over, or the program has ended the run.

        Raises:
            ProgramFailedError: The program crashed, or did not return. The run is over then.
            ConfigurationError: The program refused its configuration, or the data file cannot be written.
            KeyboardInterrupt: Ctrl-C. The run can go on afterwards.
        """
        steps = operator.index(steps)
        if steps < 0:
            raise ConfigurationError(f"steps: expected at least 0, found {steps}")
        made = 0
        with self._busy():
            run = self._run
            if self._has_failed:
                raise SimulationError("the run has failed: reset it")
            # One more than are left: the step that finds the run over.
            steps = min(steps, self.step_count - self.steps + 1)
            while made < steps and not self._is_over and not self._should_pause:
                done = c_int64()
                try:
                    status = check(library().pogosim_run_step(run, steps - made, SLICE_S, byref(done)))
                    self._is_over = status == OVER
                except SimulationError:
                    self._is_over = self._has_failed = True
                    raise
                finally:
                    made += done.value
                    self._pass_messages_on()
        return made

    def run(self, until_s: float = math.inf) -> int:
        """Go on until this simulated time, or the end of the run. Returns how many steps were made."""
        if math.isnan(until_s):
            raise ConfigurationError("until_s: expected a time (s), found nan")
        last = min(max(until_s / self.time_step, 0.0), float(self.step_count))
        return self.step(max(0, round(last) - self.steps))

    def end(self) -> None:
        """End the run: `callback_robot_end`, and a complete data file."""
        with self._busy():
            self._end()

    def _end(self) -> None:
        try:
            check(library().pogosim_run_end(self._run))
        finally:
            self._is_over = True
            self._pass_messages_on()

    def reset(self, seed: int | None = None) -> None:
        """Begin again: the program is loaded anew, with variables as new, and the parameters set so far.

        Args:
            seed: Of the new run; None: that of this one.
        """
        if self._is_closed:
            raise SimulationError(CLOSED)
        check_seed(seed)
        with self._busy():
            self._close_run()
            self._open(self._seed if seed is None else seed)

    def close(self) -> None:
        """End the run. Its memory is freed as soon as no array of it is left."""
        with self._busy():
            self._is_closed = True
            try:
                self._close_run()
            finally:
                self._remove_folder()

    def _close_run(self) -> None:
        if self._handle is None:
            return
        self._seed = self.seed
        try:
            self._end()
        finally:
            self._arrays.clear()
            self._slices.clear()
            self._handle = None

    def __enter__(self) -> Simulation:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __reduce__(self) -> str:
        raise TypeError("a simulation cannot be copied or pickled: make another one")

    def __repr__(self) -> str:
        state = "closed" if self._handle is None else f"t = {self.time:g} s of {self.step_count * self.time_step:g} s"
        return f"<pogosim.Simulation of {self.program.name}, {self.configuration.name}: {state}>"

    # ---- What it is like now

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._number("time")

    @property
    def steps(self) -> int:
        """Time steps since the beginning."""
        return int(self._number("step"))

    @property
    def step_count(self) -> int:
        """Time steps of the whole run."""
        return int(self._number("step_count"))

    @property
    def time_step(self) -> float:
        """Length of a time step, s."""
        return self._number("time_step")

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return int(self._number("seed"))

    @property
    def is_over(self) -> bool:
        """Whether the simulated time is over, or the run has ended early."""
        return self._is_over

    @property
    def categories(self) -> list[str]:
        """Names of the categories, in the order of the configuration."""
        text: bytes = library().pogosim_run_categories(self._run)
        return text.decode().split("\n") if text else []

    @property
    def robot_ids(self) -> npt.NDArray[Any]:
        """What `pogobot_helper_getid()` answers. Shape (robots,); as below, robots are objects that run the program."""
        return self._array("robots.id")

    @property
    def robot_categories(self) -> npt.NDArray[Any]:
        """Index into `categories`. Shape (robots,)."""
        return self._array("robots.category")

    @property
    def positions(self) -> npt.NDArray[Any]:
        """Positions of the robots, mm. Shape (robots, 2); read-only, and always those of now."""
        return self._of_robots("bodies.position")

    @property
    def headings(self) -> npt.NDArray[Any]:
        """Headings of the robots, rad, clockwise on the screen, not wrapped. Shape (robots,); read-only."""
        return self._of_robots("bodies.heading")

    @property
    def velocities(self) -> npt.NDArray[Any]:
        """Velocities of the robots, mm/s. Shape (robots, 2); read-only."""
        return self._of_robots("bodies.velocity")

    @property
    def angular_velocities(self) -> npt.NDArray[Any]:
        """Angular velocities of the robots, rad/s, clockwise on the screen. Shape (robots,); read-only."""
        return self._of_robots("bodies.angular_velocity")

    @property
    def radii(self) -> npt.NDArray[Any]:
        """Radii of the robots' bounding disks, mm. Shape (robots,); read-only."""
        return self._of_robots("bodies.radius")

    @property
    def leds(self) -> npt.NDArray[Any]:
        """Colours of the LEDs, 0 to 255. Shape (robots, 5, 3): head, front, right, back, left; red, green, blue."""
        return self._array("robots.led")

    @property
    def ticks(self) -> npt.NDArray[Any]:
        """`pogobot_ticks` of the robots. Shape (robots,); read-only."""
        return self._array("robots.ticks")

    @property
    def messages_sent(self) -> npt.NDArray[Any]:
        """Messages that each robot has sent. Shape (robots,); read-only."""
        return self._array("robots.messages_sent")

    @property
    def messages_received(self) -> npt.NDArray[Any]:
        """Messages that each robot has taken out of its queue. Shape (robots,); read-only."""
        return self._array("robots.messages_received")

    @property
    def light_map(self) -> npt.NDArray[Any]:
        """Light on the floor, sensor counts. Shape (rows, columns), the first row along the top; read-only."""
        return self._array("light")

    @property
    def light_levels(self) -> npt.NDArray[np.float64]:
        """Light at each robot, sensor counts, mean of its sensors, without noise. Shape (robots,); -1: no body."""
        levels = np.empty(len(self.robot_ids))
        library().pogosim_run_light_levels(self._run, levels.ctypes.data)
        return levels

    @property
    def state_hash(self) -> int:
        """Equal for runs in the same state: poses, LEDs, light, counts of messages, clocks, random streams."""
        found: int = library().pogosim_run_hash(self._run)
        return found

    @property
    def columns(self) -> Columns:
        """Columns that the program has added to the data file, at its last save: `sim.columns["heard"]`.

        A mapping by name, see `Columns`. What robots give with `data_set_value_*` is known when rows are saved
        (`save_data_period`), and `sim.columns.time` is when that was.
        """
        return Columns(self._run, self._handle)

    @property
    def user_data(self) -> npt.NDArray[Any]:
        """USERDATA of the robots, as a structured array: `sim.user_data["age"]`. Shape (robots,).

        It is the robots' own memory, and can be written. Its type comes from the program's debug information.

        Raises:
            SimulationError: The program has no user data, or was compiled without `-g`.
        """
        if "user_data" not in self._slices:
            raw = self._array("robots.user_data")
            kind = user_data_type(self.program, int(self._number("user_data_bytes")))
            self._slices["user_data"] = writable(raw).view(kind)
        found: npt.NDArray[Any] = self._slices["user_data"]
        return found

    # ---- What can be changed

    def set_pose(self, robot: int, x: float, y: float, heading: float | None = None) -> None:
        """Put a robot elsewhere, at rest.

        Args:
            robot: Its index, from 0.
            x: mm.
            y: mm, downwards.
            heading: rad, clockwise on the screen; None: as before.

        Raises:
            ConfigurationError: There is no such robot, it has no body, or the place is in a wall.
        """
        count = len(self.robot_ids)
        if not 0 <= robot < count:
            raise ConfigurationError(f"there is no robot {robot}: the run has {count}")
        angle = float(self.headings[robot]) if heading is None else heading
        with self._busy():
            check(library().pogosim_run_set_pose(self._run, robot, x, y, angle))

    @property
    def objects(self) -> Objects:
        """All objects, in the order of the configuration: robots, passive objects, walls. See `WorldObject`."""
        return Objects(self)

    @property
    def lamps(self) -> Lamps:
        """All lamps, in the order of the configuration. See `Lamp`."""
        return Lamps(self)

    @property
    def alive(self) -> npt.NDArray[np.bool_]:
        """Whether each robot is switched on. Shape (robots,); read-only copy: objects have `kill()` and `revive()`."""
        alive = np.ones(len(self.robot_ids), dtype=np.bool_)
        for state in (found._state() for found in self.objects):
            if state.robot != NO_BODY:
                alive[state.robot] = state.is_alive
        alive.flags.writeable = False
        return alive

    def set_column(self, name: str, value: float, obj: int | WorldObject | None = None) -> None:
        """Set a column that the program has declared: its value in all rows from now on.

        Args:
            name: Of the column, as in `data_add_column_double`.
            value: A number that the type of the column has.
            obj: An object or its index, for its rows only; None: for all objects. Values that the program's
                callback_export_data sets stand.

        Raises:
            ConfigurationError: There is no such column or object, no data file, or it is not a value of its type.
        """
        index = -1
        if obj is not None:
            index = obj.index if isinstance(obj, WorldObject) else operator.index(obj)
            check_object(self, index)
        with self._busy():
            check(library().pogosim_run_set_column(self._run, index, name.encode(), float(value)))

    def _set_parameter(self, name: str, value: Any) -> None:
        with self._busy():
            if self._handle is not None or self._is_closed:  # else the last reset failed, perhaps because of this one
                check(library().pogosim_run_set_parameter(self._run, name.encode(), yaml_text(value).encode()))
        self._settings[f"parameters.{name}"] = plain(value)
        self._parameter_values[name] = plain(value)

    # ---- Rows

    def to_dataframe(self) -> pd.DataFrame:
        """Return the rows recorded so far, as `pogosim.utils.load_dataframe` does."""
        from pogosim.utils import load_dataframe  # pandas takes most of a second, which runs without rows need not wait

        with self._busy():
            check(library().pogosim_run_save(self._run))
        if not self.data_file.exists():
            raise SimulationError("the run records no rows (enable_data_logging: false)")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # the run goes on
            rows, _ = load_dataframe(self.data_file)
        return rows

    def save_data(self, file: PathLike) -> None:
        """Copy the complete data file of a run that is over."""
        self.end()
        shutil.copyfile(self.data_file, file)

    # ---- Inside

    @property
    def _run(self) -> c_void_p:
        if self._handle is None:
            raise SimulationError(
                CLOSED if self._is_closed else "the last reset failed: mend what it said, and reset again"
            )
        return self._handle.pointer

    def _busy(self) -> Busy:
        return Busy(self._lock)

    def _number(self, name: str) -> float:
        value = c_double()
        check(library().pogosim_run_number(self._run, name.encode(), byref(value)))
        return value.value

    def _array(self, name: str) -> npt.NDArray[Any]:
        if name not in self._arrays:
            self._arrays[name] = array_of(self._run, name, self._handle)
        return self._arrays[name]

    def _of_robots(self, name: str) -> npt.NDArray[Any]:
        """Return rows of an array of bodies: a view if the bodies of the robots stand in a row, which is usual."""
        values = self._array(name)
        if "bodies" not in self._slices:
            body = self._array("robots.body")
            first = int(body[0]) if len(body) else 0
            in_a_row = bool(np.array_equal(body, np.arange(first, first + len(body))))
            self._slices["bodies"] = slice(first, first + len(body)) if in_a_row else body
        rows = self._slices["bodies"]
        if isinstance(rows, slice):
            return values[rows]
        copy = np.full((len(rows), *values.shape[1:]), np.nan, dtype=values.dtype)
        has_body = rows != NO_BODY
        copy[has_body] = values[rows[has_body]]
        return copy

    def _pass_messages_on(self) -> None:
        text: bytes = library().pogosim_run_messages(self._run)
        for line in text.decode("utf-8", "replace").split("\n") if text else ():
            if line[:1] == "P":
                robot_logger.info("%s", line[1:])
            else:
                logger.log(LEVELS.get(line[:1], logging.INFO), "%s", line[1:])


class Busy:
    """A simulation in use by one thread: a second one gets an error instead of wrong results."""

    def __init__(self, lock: threading.Lock) -> None:
        self._lock = lock

    def __enter__(self) -> None:
        if not self._lock.acquire(blocking=False):
            raise SimulationError("the simulation is in use by another thread: give each thread one of its own")

    def __exit__(self, *of_error: object) -> None:
        self._lock.release()


def writable(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return a view of the same memory that can be written."""
    interface = dict(array.__array_interface__)
    address, _ = interface["data"]
    interface["data"] = (address, False)
    holder = type("UserData", (), {"__array_interface__": interface, "owner": array})()
    return np.asarray(holder)


def check_seed(seed: int | None) -> None:
    """Raise ConfigurationError for what is no seed."""
    if seed is not None and not 0 <= operator.index(seed) <= MOST_SEED:
        raise ConfigurationError(f"seed: expected an integer from 0 to {MOST_SEED}, found {seed}")


def remove_own_folder(folder: str, process: int) -> None:
    """Remove a folder, but not at the end of a child process that the one that made it has forked."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


def shared_object(program: Path) -> Path:
    """Return the shared object of a program: itself, or the one beside an executable."""
    beside = program.with_name(program.name + ".so")
    return beside if program.suffix != ".so" and beside.is_file() else program
