"""One run inside this process."""

from __future__ import annotations

import io
import logging
import math
import threading
from collections.abc import Iterator, Mapping, MutableMapping
from multiprocessing.util import Finalize
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import shown
from pogosim.firmware import is_firmware
from pogosim.lines import printable
from pogosim.nearest_name import advice
from pogosim.outputs import PathLike
from pogosim.simple_yaml import simple_yaml
from pogosim.simulation.arrays import NO_BODY, Columns, RunState, writable
from pogosim.simulation.brain import Brain
from pogosim.simulation.current_run import CurrentRun, write_copy
from pogosim.simulation.errors import ConfigurationError, NoVariableError, SimulationError, given
from pogosim.simulation.forked import check_process, is_forked
from pogosim.simulation.library import OK, OVER, Strict, Turn, check, error_of_step, in_words_of_python, library
from pogosim.simulation.links import cut_links, links_of, make_link
from pogosim.simulation.objects import Lamps, Objects, WorldObject, object_state
from pogosim.simulation.saved_state import SavedState
from pogosim.varied import leaves

if TYPE_CHECKING:
    import pandas as pd

    from pogosim.simulation.firmware_variables import Variable
    from pogosim.watch.live import LiveRun
    from pogosim.watch.notebook import RunView

# PyYAML, elftools and pandas are imported where they are used: a short run takes less time than importing one of them.

MOST_SEED = 2**32 - 1
MOST_PIXELS = 16384  # of a side of a picture: kMostPixels of src/config/scenario.hpp
MOST_STEPS = 2**62  # of one call, which stops at the end of the run anyway
CLOSED = "the simulation is closed: make another one"
SLICE_S = 0.05  # of wall-clock time, after which Ctrl-C is looked for
LEVELS = {"D": logging.DEBUG, "I": logging.INFO, "W": logging.WARNING, "E": logging.ERROR}
logger = logging.getLogger("pogosim")
robot_logger = logging.getLogger("pogosim.robots")


def yaml_text(name: str, value: Any) -> str:
    """Return a value as YAML in one line.

    Raises:
        ConfigurationError: YAML cannot represent it.
    """
    plain = given.value(name, value)
    text = simple_yaml(plain)
    if text is None:
        from pogosim.yaml_1_2 import dump_yaml

        text = dump_yaml(plain, is_flow=True).strip()
    return text


def checked_settings(values: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return the settings that a caller gives, as plain values.

    Raises:
        ConfigurationError: They are no map from keys to values of YAML.
    """
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise given.refused("set", "a map from keys to values", values)
    settings = {}
    for key, value in values.items():
        name = given.text("a key of set", key)
        if not name or "=" in name:
            raise given.refused("a key of set", "the name of a key, such as 'objects.robots.nb'", key)
        settings[name] = given.value(name, value)
    return settings


def settings_of(values: Mapping[str, Any]) -> list[str]:
    """Return the settings as arguments of `--set`."""
    return [f"{key}={yaml_text(key, value)}" for key, value in values.items()]


def parameters_in(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values under `parameters` in settings, by name: those of a map, and those that follow one by one."""
    found: dict[str, Any] = {}
    for key, value in settings.items():
        if key == "parameters":
            found = dict(leaves(value))
        elif key.startswith("parameters."):
            found[key.removeprefix("parameters.")] = value
    return found


class Parameters(MutableMapping[str, Any]):
    """Values under `parameters` of the configuration that `set` gave, or that were set since, by name (dots: in maps).

    Setting one gives the program's variable the value at once, and every later `reset` begins with it.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __getitem__(self, name: str) -> Any:
        known = self._simulation._parameter_values
        if not isinstance(name, str) or name not in known:
            raise KeyError(
                f"the parameter {shown(name)} was not set here; those that were: {', '.join(known) or 'none'}. "
                "What the configuration file says is not among them"
            )
        return known[name]

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
    """A run of a program, advanced step by step.

    Any number of them can exist at the same time, of the same program or others; each result is what it would be alone.
    One thread at a time may step, reset, change or close a simulation. Other threads may read it at any time; reads are
    answered between two time steps. `step` releases the GIL.

        with pogosim.Simulation("examples/hanabi/hanabi.so", "conf/simple.yaml", seed=3) as sim:
            sim.step(100)
            print(sim.time, sim.positions.mean(axis=0))

    Messages of the simulator go to the logger "pogosim", lines that robots print to "pogosim.robots". A warning that
    comes again after a reset is not repeated.

    Attributes:
        program: The shared object; None: there is none.
        configuration: The YAML file.
        data_file: Where the rows go. None of the three can be set.
    """

    _FIXED = frozenset({"program", "configuration", "data_file"})

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._FIXED and name in vars(self):
            raise AttributeError(f"{name} of a simulation cannot be set: make another simulation")
        super().__setattr__(name, value)

    def __init__(
        self,
        program: PathLike | None,
        configuration: PathLike,
        *,
        seed: int | None = None,
        set: Mapping[str, Any] | None = None,  # noqa: A002 -- the name of the option
        data_file: PathLike | None = None,
        strict: bool = False,
        strict_set: bool = False,
        warned: set[str] | None = None,
    ) -> None:
        """Build the world and run the program up to time 0.

        Args:
            program: Shared object, as `make sim` makes beside the executable (`hanabi.so` for `hanabi`); for an
                executable, the shared object beside it is taken. The ELF file of a firmware (`make emu`) drives the
                robots of all categories that need a program. None: no category of the configuration needs one
                (`brain: host`, a script or a firmware).
            configuration: YAML file. Nothing is drawn, and no console file written, unless `set` says so.
            seed: 0 to 2^32 - 1; None: that of the configuration, or a random one.
            set: Values for keys of the configuration, such as {"objects.robots.nb": 50}.
            data_file: Where the rows go; None: to a temporary file, for `to_dataframe`.
            strict: Unknown keys are errors.
            strict_set: Unknown keys of `set` are errors, here and in `reset`, even if those of the file are not.
            warned: Warnings that are not passed on again, and to which those that are passed on are added: simulations
                that share a set pass each warning on once. None: a set of its own.

        Raises:
            ConfigurationError: The program or the configuration is missing or wrong.
            ProgramFailedError: The program crashed at its start.
            SimulationError: There is no simulator, or one of another version.
        """
        self.program = None if program is None else shared_object(given.path("program", program))
        self.configuration = given.path("configuration", configuration)
        self._strict = Strict(given.boolean("strict", strict), given.boolean("strict_set", strict_set))
        settings = checked_settings(set)
        seed = checked_seed(seed)
        if data_file is None and "data_filename" in settings:
            data_file = settings["data_filename"]
        self._current = CurrentRun(checked_warned(warned))
        self._lock = self._current.lock
        self._is_closed = False
        self._live: LiveRun | None = None  # from the first view on
        self._turn = Turn()
        self._finish = Finalize(self, self._current.finish, exitpriority=0)
        try:
            is_temporary = data_file is None
            self.data_file = (
                self._current.make_folder() / "data.feather" if is_temporary else given.path("data_file", data_file)
            )
            self._settings: dict[str, Any] = {
                "enable_console_logging": False,
                "save_video_period": -1,
                "data_filename": str(self.data_file),
                **settings,
            }
            self._open(seed)
        except BaseException:
            self._finish()
            raise

    def _open(self, seed: int | None) -> None:
        self._current.open(self.program, self.configuration, settings_of(self._settings), seed, self._strict)
        self._seed = self.seed
        self._parameter_values = parameters_in(self._settings)
        self._pass_messages_on()

    # ---- The run

    def step(self, steps: int = 1) -> int:
        """Advance by `steps` time steps, or to the end of the run.

        Returns:
            How many steps were made: fewer when the simulated time is over, or the program has ended the run.

        Raises:
            ProgramFailedError: The program crashed, or did not return. The run is over then.
            ConfigurationError: The program refused its configuration, or the data file cannot be written.
            KeyboardInterrupt: Ctrl-C. The run can go on afterwards.
        """
        if type(steps) is not int or not 0 <= steps <= MOST_STEPS:
            steps = min(given.integer("steps", steps, least=0), MOST_STEPS)
        with self._busy():
            run, turn = self._run, self._turn  # `run` lives until the library's functions return
            turn.left, status = steps, OK
            while status == OK and not self._current.should_pause:
                try:
                    status = library().pogosim_run_take_turn(run.known_pointer, turn, SLICE_S)
                finally:
                    if turn.has_messages:
                        self._pass_messages_on()
                if status not in (OK, OVER):
                    raise error_of_step(status, library().pogosim_host_error())
                if not turn.left:
                    break
            return steps - int(turn.left)

    def run(self, until_s: float = math.inf) -> int:
        """Go on until this simulated time, or the end of the run. Returns how many steps were made."""
        until = given.number("until_s", until_s, "a time (s)")
        if math.isnan(until):
            raise given.refused("until_s", "a time (s)", until)
        last = min(max(until / self.time_step, 0.0), float(self.step_count))
        return self.step(max(0, round(last) - self.steps))

    def end(self) -> None:
        """End the run: `callback_robot_end`, and a complete data file."""
        with self._busy():
            self._end()

    def _end(self) -> None:
        try:
            check(library().pogosim_run_end(self._run.pointer))
        finally:
            self._pass_messages_on()

    def reset(self, seed: int | None = None, set: Mapping[str, Any] | None = None) -> None:  # noqa: A002 -- its name
        """Start again with a freshly loaded program, whose variables are reset, and the parameters set so far.

        Arrays that were kept (`user_data`, those of a `Brain`) belong to the run before: writing to them raises
        ValueError, so ask for them again. Other threads that look at the simulation meanwhile see the end of that run.

        Args:
            seed: Seed of the new run; None: that of this one.
            set: Values for keys of the configuration, which hold from now on, besides those that were set before. The
                run is the same as that of a new simulation with all of them.

        Raises:
            ConfigurationError: The configuration is wrong. Reset it again: keys of this `set` are as they were before.
        """
        check_process(self._current.process)
        seed = checked_seed(seed)
        new_settings = checked_settings(set)
        if new_settings.get("data_filename", str(self.data_file)) != str(self.data_file):
            raise ConfigurationError("set: data_filename cannot be changed by reset: make another simulation")
        with self._busy():
            if self._is_closed:
                raise SimulationError(CLOSED)
            try:
                if self._current.run is not None:
                    self._current.run.retire()
                    self._end()
                    self._current.when_ended()
                old_settings, self._settings = self._settings, {**self._settings, **new_settings}
                try:
                    self._open(self._seed if seed is None else seed)
                except BaseException:
                    self._settings = old_settings
                    raise
            except BaseException:
                self._current.abandon()
                raise

    def save(self) -> SavedState:
        """Return a copy of the state, from which `restore` goes on, as often as wanted.

        The copy has poses, velocities, LEDs, messages under way, clocks, random streams, and the program's variables,
        user data and robots that wait in the middle. A run of 20 robots takes a fraction of a millisecond for it.

        Raises:
            ConfigurationError: The run writes files, whose rows would go back in time (`enable_data_logging: false`
                does without), moves bodies with Box2D, or its program allocates memory or uses a library that may have
                a state of its own. The run goes on.
        """
        with self._busy():
            return SavedState(self._run, self._settings, self._parameter_values)

    def restore(self, state: SavedState) -> None:
        """Go on from a state that `save` returned: what follows is, to the bit, what followed then.

        Arrays that were kept show the state; parameters are those of then, too.

        Raises:
            ConfigurationError: It is the state of another run, or of this one before a `reset`.
        """
        with self._busy():
            if not isinstance(state, SavedState):
                raise given.refused("state", "what save() has returned", state)
            check(library().pogosim_run_restore_state(self._run.pointer, state.pointer))
            self._run.restored += 1
            self._settings, self._parameter_values = dict(state.settings), dict(state.parameters)

    def close(self) -> None:
        """End the run. Its memory is freed as soon as no array of it is left."""
        if is_forked(self._current.process):  # a forked child: its parent goes on
            self._is_closed = True
            return
        with self._busy():
            self._is_closed = True
            try:
                if self._current.run is not None:
                    self._end()
            finally:
                self._current.clean_up()
                self._finish.cancel()
                if self._live is not None:
                    self._live.wake()

    def discard(self) -> None:
        """Close a run that was made in vain: the archive of flash memory stays as it is."""
        run = self._current.run  # stays until the call is over, whatever another thread does
        if run is not None:
            library().pogosim_run_leave_archive(run.pointer)
        self.close()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __reduce__(self) -> str:
        raise TypeError("a simulation cannot be copied or pickled: make another one")

    def __repr__(self) -> str:
        run = self._current.run
        if run is None or self._is_closed or is_forked(self._current.process):
            state = "closed"
        else:
            state = f"t = {run.number('time'):g} s of {run.number('step_count') * run.number('time_step'):g} s"
        of = self.configuration.name if self.program is None else f"{self.program.name}, {self.configuration.name}"
        return f"<pogosim.Simulation of {of}: {state}>"

    # ---- What it is like now

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._run.number("time")

    @property
    def steps(self) -> int:
        """Time steps since the beginning."""
        return int(self._run.number("step"))

    @property
    def step_count(self) -> int:
        """Time steps of the whole run."""
        return int(self._run.number("step_count"))

    @property
    def time_step(self) -> float:
        """Length of a time step, s."""
        return self._run.number("time_step")

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return int(self._run.number("seed"))

    @property
    def is_over(self) -> bool:
        """Whether the simulated time is over, or the run has ended early."""
        check_process(self._current.process)
        run = self._current.run
        return run is None or bool(run.number("is_over"))

    @property
    def categories(self) -> list[str]:
        """Names of the categories, in the order of the configuration."""
        return self._run.names("pogosim_run_categories")

    @property
    def robot_ids(self) -> npt.NDArray[Any]:
        """What `pogobot_helper_getid()` answers. Shape (robots,); as below, robots are objects that run the program."""
        return self._run.array("robots.id")

    @property
    def robot_categories(self) -> npt.NDArray[Any]:
        """Index into `categories`. Shape (robots,)."""
        return self._run.array("robots.category")

    @property
    def positions(self) -> npt.NDArray[Any]:
        """Positions of the robots, mm. Shape (robots, 2); read-only, and always those of now."""
        return self._run.of_robots("bodies.position")

    @property
    def headings(self) -> npt.NDArray[Any]:
        """Headings of the robots, rad, clockwise on the screen, not wrapped. Shape (robots,); read-only."""
        return self._run.of_robots("bodies.heading")

    @property
    def velocities(self) -> npt.NDArray[Any]:
        """Velocities of the robots, mm/s: displacements in the last step by its duration. Shape (robots, 2); read-only.

        0 for a robot that has just been moved by hand or by a program. A robot whose motors press it against a wall
        bounces by a millimetre (`wall_restitution`): take the mean of some steps.
        """
        return self._run.of_robots("bodies.velocity")

    @property
    def angular_velocities(self) -> npt.NDArray[Any]:
        """Angular velocities of the robots, rad/s, clockwise on the screen, likewise. Shape (robots,); read-only."""
        return self._run.of_robots("bodies.angular_velocity")

    @property
    def radii(self) -> npt.NDArray[Any]:
        """Radii of the robots' bounding disks, mm. Shape (robots,); read-only."""
        return self._run.of_robots("bodies.radius")

    @property
    def leds(self) -> npt.NDArray[Any]:
        """Colours of the LEDs, 0 to 255. Shape (robots, 5, 3): head, front, right, back, left; red, green, blue."""
        return self._run.array("robots.led")

    @property
    def ticks(self) -> npt.NDArray[Any]:
        """`pogobot_ticks` of the robots. Shape (robots,); read-only."""
        return self._run.array("robots.ticks")

    @property
    def messages_sent(self) -> npt.NDArray[Any]:
        """Messages that each robot has sent. Shape (robots,); read-only."""
        return self._run.array("robots.messages_sent")

    @property
    def messages_received(self) -> npt.NDArray[Any]:
        """Messages that each robot has taken out of its queue. Shape (robots,); read-only."""
        return self._run.array("robots.messages_received")

    @property
    def magnetometer(self) -> npt.NDArray[Any]:
        """What each robot's program has read last of its magnetometer, counts; 0 before. Shape (robots, 3)."""
        return self._run.array("robots.magnetometer")

    @property
    def magnetometer_samples(self) -> npt.NDArray[Any]:
        """How often each robot's program has read new data of its magnetometer. Shape (robots,)."""
        return self._run.array("robots.magnetometer_samples")

    @property
    def light_map(self) -> npt.NDArray[Any]:
        """Light on the floor, sensor counts. Shape (rows, columns), the first row along the top; read-only."""
        return self._run.array("light")

    @property
    def light_levels(self) -> npt.NDArray[np.float64]:
        """Light at each robot, sensor counts, mean of its sensors, without noise. Shape (robots,); -1: no body."""
        return self._run.light_levels()

    @property
    def state_hash(self) -> int:
        """Equal for runs in the same state: poses, LEDs, light, counts of messages, clocks, random streams."""
        run = self._run
        found: int = library().pogosim_run_hash(run.pointer)
        return found

    @property
    def columns(self) -> Columns:
        """Columns that the program has added to the data file, at its last save: `sim.columns["heard"]`.

        A mapping by name, see `Columns`. What robots give with `data_set_value_*` is known when rows are saved
        (`save_data_period`), and `sim.columns.time` is when that was.
        """
        return Columns(self._run)

    @property
    def links(self) -> npt.NDArray[Any]:
        """Links between bodies, those that are cut included: `sim.links["tension_n"]`.

        A structured array of shape (links,), a copy of now, in the order in which they were made. Its fields:

        - kind: "spring", "rod" or "hinge".
        - a, b: indices in `objects`; b is -1 for a place in the arena.
        - robot_a, robot_b: rows in arrays of robots, such as `positions`; -1: none.
        - end_a_mm, end_b_mm: shape (links, 2); from the centre of the object, ahead and to its right, or a place.
        - rest_mm, stiffness_n_m, damping_n_s_m, breaking_n, least_rad, most_rad: as `link` takes them, the force and
          the angles infinite where there is no limit.
        - length_mm: distance of its ends.
        - tension_n: force in the last step, positive when it pulls; of a hinge, its magnitude.
        - is_cut: whether it does nothing any more.
        """
        return links_of(self._run)

    @property
    def user_data(self) -> npt.NDArray[Any]:
        """USERDATA of the robots, as a structured array: `sim.user_data["age"]`. Shape (robots,).

        It is the robots' own memory, and can be written. Its type comes from the program's debug information. Robots
        that something else drives have zeros. That of a firmware is a copy, which cannot be written, and zero for
        robots that do not run it.

        Raises:
            SimulationError: The program has no user data, or was compiled without `-g`.
        """
        run, program = self._run, self.program
        if program is None:
            raise SimulationError("the simulation has no program, and so no user data")
        if is_firmware(program):
            return self._user_data_of_firmware(program)

        from pogosim.simulation.user_data import user_data_type

        def typed() -> npt.NDArray[Any]:
            kind = user_data_type(program, int(run.number("user_data_bytes")))
            return writable(run.array("robots.user_data")).view(kind)

        return run.kept_writable("user_data", typed)

    def _user_data_of_firmware(self, program: Path) -> npt.NDArray[Any]:
        from pogosim.simulation.firmware_variables import USER_DATA, variables_of

        user_data = variables_of(program).get(USER_DATA)
        if user_data is None:
            raise NoVariableError(f"{program} has no user data (REGISTER_USERDATA)")
        found = self._memory_of(program, user_data)[0]
        found.flags.writeable = False
        return found

    def _memory_of(self, firmware: Path, variable: Variable) -> tuple[npt.NDArray[Any], npt.NDArray[np.bool_]]:
        """Return a variable of all robots, 0 for those that do not run the firmware, and which do."""
        with self._busy():
            memory, runs_it = self._run.firmware_bytes(
                firmware, len(self.robot_categories), variable.address, variable.type.itemsize
            )
        return variable.values(memory), runs_it

    def firmware_variable(
        self, name: str, category: str = "robots", *, firmware: PathLike | None = None
    ) -> npt.NDArray[Any]:
        """Return a copy of a variable of robots that run firmware. Shape (robots of the category, ...).

        Zero for robots of the category that something else drives, where its entries differ.

        Args:
            name: A variable that is not on the stack, such as "opinion"; "mydata" is USERDATA, a structured array.
            category: A category whose robots run firmware.
            firmware: Its ELF file; None: `program`.

        Raises:
            ConfigurationError: An argument is of a wrong type, there is no such category, or no robot of it runs this
                firmware.
            SimulationError: The file has no such variable, or no debug information.
        """
        check_process(self._current.process)
        name, category = given.text("name", name), given.text("category", category)
        file = self.program if firmware is None else given.path("firmware", firmware)
        if file is None:
            raise SimulationError("the simulation has no program: name the firmware")
        from pogosim.simulation.firmware_variables import variables_of

        known = variables_of(file)
        if name not in known:
            own = [other for other in known if not other.startswith("_") and not other.isupper()]  # not the library's
            raise NoVariableError(f"{file} has no variable {shown(name)}{advice(name, own)}")
        if category not in self.categories:
            raise ConfigurationError(f"there is no category {shown(category)}{advice(category, self.categories)}")
        entries = [number for number, name in enumerate(self.categories) if name == category]
        of_category = np.isin(self.robot_categories, entries)
        values, runs_it = self._memory_of(file, known[name])
        if of_category.any() and not (of_category & runs_it).any():
            raise ConfigurationError(f"category {shown(category)} does not run the firmware {file}")
        return values[of_category]

    def brain(self, category: str) -> Brain:
        """Return the arrays that drive the robots of a category whose configuration says `brain: host`, see `Brain`.

        Raises:
            ConfigurationError: There is no such category, or something else drives its robots.
        """
        return Brain(lambda: self._run, category)

    # ---- Pictures

    def render(self, width: int = 800, height: int = 800) -> npt.NDArray[np.uint8]:
        """Draw the world now, as frames and films show it. Needs no display.

            plt.imshow(sim.render())

        What is drawn beside the arena and its objects (time, scale bar, communication channels, light levels, trails)
        follows the configuration, such as `show_communication_channels`.

        Args:
            width: Pixels, 1 to `MOST_PIXELS` (16384). The whole arena is in the middle of the picture.
            height: Pixels, likewise.

        Returns:
            Red, green and blue, 0 to 255. Shape (height, width, 3), the first row along the top; a copy.

        Raises:
            ConfigurationError: A size is out of range.
        """
        columns = given.integer("width", width, 1, MOST_PIXELS)
        rows = given.integer("height", height, 1, MOST_PIXELS)
        picture = np.empty((rows, columns, 3), np.uint8)
        with self._busy():
            check(library().pogosim_run_draw(self._run.pointer, columns, rows, picture.ctypes.data))
        return picture

    def _repr_png_(self) -> bytes | None:
        """Return the picture that a notebook shows for a run where there is no live view; None: it is closed."""
        return self._png(800)

    def _png(self, size_px: int) -> bytes | None:
        """Return a square picture; None: the run is closed."""
        if self._current.run is None or self._is_closed:
            return None
        from PIL import Image

        file = io.BytesIO()
        Image.fromarray(self.render(size_px, size_px)).save(file, "PNG")
        return file.getvalue()

    def view(self, height_px: int = 560) -> RunView:
        """Return a live view of the run for a notebook, which goes on in a thread of its own while it plays.

        `sim` as the last line of a cell shows one, too. There may be several of one run. What a cell does with the run,
        such as `sim.step(100)`, and what the view does take turns, step by step; arrays are those of the picture.

        Args:
            height_px: 200 to 4000.

        Raises:
            SimulationError: The Python package anywidget is not installed, or the simulation is closed.
            ConfigurationError: The height is out of range.
        """
        check_process(self._current.process)
        _ = self._run  # raises if it is closed
        from pogosim.watch.notebook import RunView

        return RunView(self, given.integer("height_px", height_px, 200, 4000))

    @property
    def _live_run(self) -> LiveRun:
        """The thread that goes on with the run for its views."""
        if self._live is None:
            from pogosim.watch.live import LiveRun

            self._live = LiveRun(self)
        return self._live

    def _ipython_display_(self) -> None:
        """Show the run in the last line of a cell of a notebook: a live view, or else a picture."""
        from pogosim.watch.in_notebooks import show

        show(self)

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
        number = given.integer("robot", robot)
        count = int(self._run.number("robot_count"))
        if not 0 <= number < count:
            raise ConfigurationError(f"there is no robot {shown(number)}: the run has {count}")
        place = given.finite("x", x), given.finite("y", y)
        angle = float(self.headings[number]) if heading is None else given.finite("heading", heading)
        with self._busy():
            check(library().pogosim_run_set_pose(self._run.pointer, number, *place, angle))

    @property
    def parameters(self) -> Parameters:
        """Values under `parameters`; they can be set during the run, see `Parameters`."""
        return Parameters(self)

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
        run = self._run
        alive = np.ones(int(run.number("robot_count")), dtype=np.bool_)
        for state in (object_state(run, index) for index in range(int(run.number("object_count")))):
            if state.robot != NO_BODY:
                alive[state.robot] = state.is_alive
        alive.flags.writeable = False
        return alive

    def set_column(self, name: str, value: float, obj: int | WorldObject | None = None) -> None:
        """Set a column that the program has declared: its value in all rows from now on.

        Args:
            name: Name of the column, as in `data_add_column_double`.
            value: A number that the type of the column has.
            obj: An object or its index, for its rows only; None: for all objects. Values that the program's
                callback_export_data sets stand.

        Raises:
            ConfigurationError: There is no such column or object, no data file, or it is not a value of its type.
        """
        index = -1
        if obj is not None:
            index = given.integer("obj", obj.index if isinstance(obj, WorldObject) else obj)
            count = len(self.objects)
            if not 0 <= index < count:
                raise ConfigurationError(f"there is no object {shown(index)}: the run has {count}")
        column = given.text("name", name)
        number = float(value) if isinstance(value, (bool, np.bool_)) else given.number(column, value)
        with self._busy():
            check(library().pogosim_run_set_column(self._run.pointer, index, column.encode(), number))

    def link(
        self,
        a: WorldObject | int,
        b: WorldObject | int | tuple[float, float],
        kind: str = "spring",
        *,
        end_a: tuple[float, float] | None = None,
        end_b: tuple[float, float] | None = None,
        length: float | None = None,
        stiffness: float = 0.0,
        damping: float = 0.0,
        breaking_force: float = math.inf,
        limits: tuple[float, float] | None = None,
    ) -> int:
        """Link two objects, or an object and a place in the arena. The link holds from the next step on.

        Args:
            a: An object or its index in `objects`.
            b: Another one; or a place, mm.
            kind: "spring", "rod" or "hinge".
            end_a: Where it is attached, mm from the centre of `a`: ahead and to its right. None: its centre; of a hinge
                between two objects, halfway between their centres.
            end_b: The same of `b`, if that is an object.
            length: At rest, mm, at least 0; None: as far apart as its ends are now. A hinge has none.
            stiffness: N/m, of a spring, at least 0.
            damping: N s/m, of a spring, against changes of its length, at least 0. A spring needs one of both.
            breaking_force: N, above 0: a larger force cuts it.
            limits: Least and greatest angle of a hinge, rad, by which `b` may turn against `a`, clockwise on the
                screen, from how it stands now. At most and at least 0.

        Returns:
            Its index in `links`.

        Raises:
            ConfigurationError: A value is out of its range; an object has no body, is a membrane, is fixed as the other
                end is, or is linked to itself; a rod or a hinge misses its ends by more than 1 mm.
        """
        with self._busy():
            return make_link(
                self._run,
                a,
                b,
                kind,
                end_a=end_a,
                end_b=end_b,
                length=length,
                stiffness=stiffness,
                damping=damping,
                breaking_force=breaking_force,
                limits=limits,
            )

    def cut(self, links: int | npt.ArrayLike) -> None:
        """Cut links, for good. They keep their place in `links`.

        Args:
            links: An index, an array of indices, or an array of booleans, one for each link.

        Raises:
            ConfigurationError: There is no link of an index; none is cut.
        """
        with self._busy():
            cut_links(self._run, links)

    def _set_parameter(self, name: str, value: Any) -> None:
        name = given.text("a parameter", name)
        key = f"parameters.{name}"
        plain = given.value(key, value)
        with self._busy():
            if self._current.run is not None or self._is_closed:  # else the last reset failed, perhaps because of this
                text = yaml_text(key, plain).encode()
                check(library().pogosim_run_set_parameter(self._run.pointer, name.encode(), text))
            self._settings.pop(key, None)  # it comes after a map `parameters`
            self._settings[key] = plain
            self._parameter_values[name] = plain

    # ---- Rows

    def to_dataframe(self) -> pd.DataFrame:
        """Return the rows recorded so far, as `pogosim.utils.load_dataframe` does."""
        with self._busy():
            check(library().pogosim_run_save(self._run.pointer))
            self._check_data_file()
            # pandas takes most of a second, for which runs without rows, and what is refused, need not wait.
            from pogosim import utils

            rows, metadata = utils.load_file(self.data_file, warns=False)  # the run goes on
        rows.attrs = utils.attributes(metadata)
        return rows

    def save_data(self, file: PathLike) -> None:
        """End the run, and write its rows and metadata to another file.

        Args:
            file: Its ending says the format, as that of `data_file`: .feather, .arrow, .ipc, .parquet or .csv, which
                has its metadata beside it. An existing file is replaced.

        Raises:
            ConfigurationError: It has another ending, is the data file itself, or cannot be written.
            SimulationError: There are no rows.
        """
        path = given.path("file", file)
        with self._busy():
            self._end()
            self._check_data_file()
            write_copy(self.data_file, path)

    def _check_data_file(self) -> None:
        if self.data_file.exists():
            return
        if math.isnan(self._run.number("save_time")):
            raise SimulationError("the run records no rows (enable_data_logging: false)")
        raise SimulationError(
            f"the data file {printable(self.data_file)} is not there any more: another program has removed or renamed "
            "it, or this one has changed its folder (os.chdir)"
        )

    # ---- Inside

    @property
    def _run(self) -> RunState:
        run = self._current.run
        if run is None:
            check_process(self._current.process)
            raise SimulationError(
                CLOSED if self._is_closed else "the last reset failed or was interrupted: reset again"
            )
        return run

    def _busy(self) -> threading.Lock:
        """Return the lock for a `with` block.

        A second thread gets an error instead of wrong results; while a view goes on with the run, threads wait.

        Acquiring and releasing a threading.Lock is atomic, so Ctrl-C cannot leave it locked.
        """
        check_process(self._current.process)
        if self._lock.locked() and not self._current.is_shared:
            raise SimulationError("the simulation is in use by another thread: give each thread one of its own")
        return self._lock

    def _pass_messages_on(self) -> None:
        run = self._run
        text: bytes = library().pogosim_run_messages(run.pointer)
        for line in text.decode("utf-8", "replace").split("\n") if text else ():
            if line[:1] == "P":
                robot_logger.info("%s", line[1:])
            elif line[:1] != "W" or self._current.is_new(line):
                logger.log(LEVELS.get(line[:1], logging.INFO), "%s", in_words_of_python(line[1:]))


def checked_seed(seed: Any) -> int | None:
    """Return a seed.

    Raises:
        ConfigurationError: It is none.
    """
    return None if seed is None else given.integer("seed", seed, least=0, most=MOST_SEED)


def checked_warned(warned: Any) -> set[str]:
    """Return a set of warnings.

    Raises:
        ConfigurationError: It is none.
    """
    if warned is not None and not isinstance(warned, set):
        raise given.refused("warned", "a set, which may be empty", warned)
    return set() if warned is None else warned


def shared_object(program: Path) -> Path:
    """Return the shared object of a program: itself, or the one beside an executable."""
    if program.suffix == ".so" or not program.name:  # as of "." and "/"
        return program
    beside = program.with_name(program.name + ".so")
    try:
        return beside if beside.is_file() else program
    except OSError:  # a name that is too long, which is refused later
        return program
