"""The same program as a program in C and as firmware, step by step: the first tick and variable that differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation import Simulation

# What the simulator says of robots in both runs.
STATE = ("ticks", "leds", "positions", "headings", "messages_sent", "messages_received")
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
        tolerance: By which share of their size floating-point numbers may differ, 0 or more.
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
    simulation: Simulation, is_chosen: npt.NDArray[np.bool_], user_data: npt.NDArray[Any]
) -> dict[str, npt.NDArray[Any]]:
    """Return what is compared of the chosen robots, by name; `user_data` is that of these robots."""
    found = {name: getattr(simulation, name)[is_chosen] for name in STATE}
    found.update(flattened(user_data, "mydata"))
    return found


class Comparison:
    """Two runs of one configuration, in lockstep."""

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
        common = {**settings, "parameters": {}}
        brain = {"firmware": str(firmware.resolve()), "random": "simulator"}
        self._program = Simulation(program, configuration, set=common)
        self._firmware = Simulation(
            program, configuration, seed=self._program.seed, set={**common, f"objects.{category}.brain": brain}
        )
        self._file = firmware
        self._category = category
        chosen = self._program.categories.index(category) if category in self._program.categories else -1
        self._is_chosen = self._program.robot_categories == chosen
        self.found: dict[str, Difference] = {}
        self.tolerance = 0.0

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
        return sorted(self.found.values(), key=lambda difference: difference.time_s)

    def _look(self) -> None:
        in_program = variables(self._program, self._is_chosen, self._program.user_data[self._is_chosen])
        of_firmware = self._firmware.firmware_variable("mydata", self._category, firmware=self._file)
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
