"""Values of robots that a viewer may ask for: as colours of all of them, or of one robot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation import Simulation, SimulationError

MOST_ENTRIES = 16  # of an array of USERDATA that are shown
OWN = ("light", "speed", "messages_sent", "messages_received")


def user_data_of(simulation: Simulation) -> npt.NDArray[Any] | None:
    """Return USERDATA of the robots, shape (robots,); None where its type is not known."""
    try:
        found = simulation.user_data
    except SimulationError:
        return None
    return found if found.dtype.names else None


def is_number(kind: np.dtype[Any]) -> bool:
    """Tell whether a field of USERDATA holds one number or truth value."""
    return kind.kind in "biuf" and kind.shape == ()


def column_names(simulation: Simulation) -> list[str]:
    """Return the names of all values that colours can show, each once."""
    names = list(OWN)
    user_data = user_data_of(simulation)
    if user_data is not None:
        names += [name for name in user_data.dtype.names or () if is_number(user_data.dtype[name])]
    columns = simulation.columns
    names += [name for name in columns if isinstance(columns[name], np.ma.MaskedArray)]
    return list(dict.fromkeys(names))


def robot_values(simulation: Simulation, name: str) -> npt.NDArray[np.float32]:
    """Return a value of all robots, NaN where there is none. Shape (robots,)."""
    if name == "light":
        values: npt.NDArray[Any] = simulation.light_levels
    elif name == "speed":
        values = np.hypot(*simulation.velocities.T)
    elif name in OWN:
        values = getattr(simulation, name)
    elif name in simulation.columns:
        values = np.ma.filled(simulation.columns[name].astype(np.float64), np.nan)
    else:
        user_data = user_data_of(simulation)
        if user_data is None:
            return np.full(len(simulation.robot_ids), np.nan, np.float32)
        values = user_data[name]
    return np.asarray(values, dtype=np.float32)


def object_values(simulation: Simulation, name: str, robots: npt.NDArray[np.int64]) -> npt.NDArray[np.float32]:
    """Return a value of all objects; `robots`: the robot that each is, -1 for none. Shape (objects,)."""
    own = robot_values(simulation, name)
    values = np.full(len(robots), np.nan, np.float32)
    is_robot = robots >= 0
    values[is_robot] = own[robots[is_robot]]
    return values


def flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Return the parts of a value of USERDATA by their names, such as "pose.x" and "seen[2]"."""
    if isinstance(value, np.void) and value.dtype.names:
        for part in value.dtype.names:
            yield from flat(f"{name}.{part}" if name else part, value[part])
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "S" or value.size > MOST_ENTRIES:
            yield name, f"{value.size} values"
            return
        for place in np.ndindex(value.shape):
            yield from flat(f"{name}[{']['.join(map(str, place))}]", value[place])
    elif isinstance(value, bytes):
        yield name, value.split(b"\0")[0].decode("utf-8", "replace")
    elif isinstance(value, np.generic) and value.dtype.kind in "biuf":
        plain = value.item()
        yield name, plain if not isinstance(plain, float) or math.isfinite(plain) else str(plain)


def values_of_robot(simulation: Simulation, robot: int) -> dict[str, Any]:
    """Return what is known of a robot, as JSON has it."""
    values: dict[str, Any] = {
        "ticks": int(simulation.ticks[robot]),
        "light": round(float(simulation.light_levels[robot]), 1),
        "messages_sent": int(simulation.messages_sent[robot]),
        "messages_received": int(simulation.messages_received[robot]),
    }
    if simulation.magnetometer_samples[robot]:
        values["magnetometer"] = " ".join(map(str, simulation.magnetometer[robot].tolist()))
    columns = simulation.columns
    for name in columns:
        value = columns[name][robot]
        values[name] = str(value) if value is None or value is np.ma.masked else plain(value)
    user_data = user_data_of(simulation)
    if user_data is not None:
        values |= {
            f"{name} (USERDATA)" if name in values else name: value for name, value in flat("", user_data[robot])
        }
    return values


def plain(value: Any) -> Any:
    """Return a value of a column as JSON has it."""
    own = value.item() if isinstance(value, np.generic) else value
    return str(own) if isinstance(own, float) and not math.isfinite(own) else own
