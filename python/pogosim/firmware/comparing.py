"""The same program as a program in C and as firmware, step by step: the first tick and variable that differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation import Simulation
from pogosim.simulation.errors import NoVariableError
from pogosim.simulation.firmware_variables import USER_DATA

# What the simulator says of robots in both runs.
STATE = ("ticks", "leds", "positions", "headings", "messages_sent", "messages_received")
PROGRAM = "program"  # the default of `brain`
# Two runs cannot write one file, and messages would name a data file that is in a temporary folder.
IN_BOTH = {"parameters": {}, "enable_data_logging": False, "message_log": "", "flash_state.output_file": ""}
_POINTERS_FROM = 2**32  # addresses of a process are above those of a robot


@dataclass(frozen=True)
class Difference:
    """Where a robot's program and its firmware differ first in one variable.

    Attributes:
        time_s: Time after the step that made them differ.
        tick: `pogobot_ticks` of the robot in the run of the program.
        robot: Its id.
        name: "mydata.count", "leds", ...
        program: Value in the run of the program.
        firmware: Value in the run of the firmware.
    """

    time_s: float
    tick: int
    robot: int
    name: str
    program: Any
    firmware: Any


def flattened(values: npt.NDArray[Any], name: str) -> Iterator[tuple[str, npt.NDArray[Any]]]:
    """Yield the numbers in a structured array by name: "mydata.pose.x". Others, such as padding, are left out."""
    if values.dtype.names is not None:
        for field in values.dtype.names:
            yield from flattened(values[field], f"{name}.{field}")
    elif values.dtype.kind in "biuf":
        yield name, values


def differing(program: npt.NDArray[Any], firmware: npt.NDArray[Any], tolerance: float = 0.0) -> npt.NDArray[np.bool_]:
    """Return which robots differ in a variable. Pointers, which always do, count as equal.

    Args:
        program: Shape (robots, ...).
        firmware: The same shape.
        tolerance: Floating-point numbers may differ by this share of their size, and by this much. 0 or more.
    """
    if program.shape != firmware.shape:
        return np.ones(len(program), dtype=bool)
    unequal = program != firmware
    if program.dtype.kind == "f" and firmware.dtype.kind == "f":
        unequal &= ~np.isclose(program, firmware, rtol=tolerance, atol=tolerance, equal_nan=True)
    if program.dtype.kind == "u" and program.dtype.itemsize > firmware.dtype.itemsize:
        unequal &= program < _POINTERS_FROM
    found: npt.NDArray[np.bool_] = unequal.reshape(len(program), -1).any(axis=1)
    return found


def variables(
    simulation: Simulation, is_chosen: npt.NDArray[np.bool_], user_data: npt.NDArray[Any] | None
) -> dict[str, npt.NDArray[Any]]:
    """Return what is compared of the chosen robots, by name; `user_data` is theirs, None: they have none."""
    found = {name: getattr(simulation, name)[is_chosen] for name in STATE}
    if user_data is not None:
        found.update(flattened(user_data, USER_DATA))
    return found


@dataclass(frozen=True)
class Entry:
    """An entry of a category, which has several if it is a list.

    Attributes:
        number: Its place in `Simulation.categories`.
        key: What says what drives its robots, "objects.robots.brain" or "objects.robots.0.brain".
        brain: The value of that key.
    """

    number: int
    key: str
    brain: Any

    @property
    def is_program(self) -> bool:
        """Whether the program in C drives its robots."""
        return bool(self.brain == PROGRAM)


def numbers_of(simulation: Simulation, category: str) -> list[int]:
    """Return the places in `simulation.categories` of the entries of a category, in the order of the configuration."""
    return [number for number, name in enumerate(simulation.categories) if name == category]


def entries_of(simulation: Simulation, category: str) -> list[Entry]:
    """Return the entries of a category that have robots; `simulation` records rows, and with them its configuration."""
    found = simulation.to_dataframe().attrs["resolved_configuration"]["objects"].get(category)
    listed = found if isinstance(found, list) else [found]
    numbers = numbers_of(simulation, category)
    above = f"objects.{category}"
    return [
        Entry(number, f"{above}.{place}.brain" if found is listed else f"{above}.brain", entry.get("brain", PROGRAM))
        for place, (number, entry) in enumerate(zip(numbers, listed, strict=bool(numbers)))
        if number in simulation.robot_categories
    ]


class Comparison:
    """Two runs of one configuration, in lockstep.

    Attributes:
        without_user_data: Why there is no USERDATA to compare; empty: there is, or nothing has been compared yet.
    """

    def __init__(
        self, program: Path, firmware: Path, configuration: Path, category: str, settings: Mapping[str, Any]
    ) -> None:
        """Build both runs, up to time 0.

        Args:
            program: Shared object of the program in C.
            firmware: ELF file of the same program.
            configuration: YAML file.
            category: Whose robots run the firmware in one of the runs.
            settings: Values for keys of the configuration, such as {"seed": 1}.

        Raises:
            SimulationError: One of them cannot be run.
        """
        common = {**settings, **IN_BOTH}
        warned: set[str] = set()
        self._program = Simulation(program, configuration, set=common, warned=warned)
        seed = self._program.seed
        recorded = {**common, "enable_data_logging": True}
        with Simulation(program, configuration, seed=seed, set=recorded, warned=warned) as recording:
            entries = entries_of(recording, category)
            recording.discard()
        brain = {"firmware": str(firmware.resolve()), "random": "simulator"}
        # An unknown category is told by the simulator.
        keys = [entry.key for entry in entries if entry.is_program] if entries else [f"objects.{category}.brain"]
        brains = dict.fromkeys(keys, brain)
        self._firmware = Simulation(program, configuration, seed=seed, set={**common, **brains}, warned=warned)
        self._file = firmware
        self._category = category
        of_robots = self._program.robot_categories
        self._is_chosen = np.isin(of_robots, [entry.number for entry in entries if entry.is_program])
        self._is_of_category = np.isin(of_robots, numbers_of(self._program, category))
        self.found: dict[str, Difference] = {}
        self.tolerance = 0.0
        self.without_user_data = ""

    def __enter__(self) -> Comparison:
        """Close both runs at the end of the block."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close both runs."""
        self._program.close()
        self._firmware.close()

    @property
    def robots(self) -> int:
        """How many robots are compared."""
        return int(np.count_nonzero(self._is_chosen))

    @property
    def time_s(self) -> float:
        """Up to where they were compared."""
        return float(self._program.time)

    def run(self, until_s: float, most: int) -> list[Difference]:
        """Make steps until a time (s), the end of the run, or so many differences; return these, the first one first.

        Raises:
            SimulationError: A run has failed.
        """
        self._look()
        while (
            self._program.time < until_s and len(self.found) < most and self._program.step() and self._firmware.step()
        ):
            self._look()
        return sorted(self.found.values(), key=lambda difference: difference.time_s)[:most]

    def _user_data(self) -> tuple[npt.NDArray[Any] | None, npt.NDArray[Any] | None]:
        """Return USERDATA of the chosen robots in both runs; None if one of them has none, which is kept."""
        if self.without_user_data:
            return None, None
        try:
            of_program = self._program.user_data[self._is_chosen]
        except NoVariableError:
            self.without_user_data = "the program has none"
            return None, None
        try:
            of_firmware = self._firmware.firmware_variable(USER_DATA, self._category, firmware=self._file)
        except NoVariableError:
            self.without_user_data = "the robots' compiler leaves out what the program only writes"
            return None, None
        return of_program, of_firmware[self._is_chosen[self._is_of_category]]

    def _look(self) -> None:
        of_program, of_firmware = self._user_data()
        in_program = variables(self._program, self._is_chosen, of_program)
        in_firmware = variables(self._firmware, self._is_chosen, of_firmware)
        for name, values in in_program.items():
            if name in self.found or name not in in_firmware:
                continue
            unequal = differing(values, in_firmware[name], self.tolerance)
            if unequal.any():
                robot = int(np.argmax(unequal))
                self.found[name] = Difference(
                    float(self._program.time),
                    int(in_program["ticks"][robot]),
                    int(self._program.robot_ids[self._is_chosen][robot]),
                    name,
                    values[robot],
                    in_firmware[name][robot],
                )
