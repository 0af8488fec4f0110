"""Looks at all that a `pogosim.Simulation` has while another thread resets, steps or closes it: a program of its own.

    python threads_of_a_run.py PROGRAM CONFIGURATION DISTURBANCE SECONDS

What there is to look at is found by looking, so whatever is new is used, too. A crash ends the process with a signal;
what is no error of the simulation is printed, and the exit code is 1.
"""

from __future__ import annotations

import contextlib
import logging
import sys
import threading
import time
import traceback
from typing import Any

import pogosim
from pogosim.simulation.arrays import Columns

SETTINGS: dict[str, Any] = {"simulation_time": 5, "parameters.gain": 1.0}
TIMES = 300  # of each, one after the other
SPECIAL = {"__repr__", "__len__", "__iter__"}


def names_of(kind: type) -> list[str]:
    """Names of the public properties and methods of a type of the package, and what `repr()` and the like call."""
    own = {name for of in kind.__mro__ if of.__module__.startswith("pogosim") for name in vars(of)}
    return sorted(name for name in own if name in SPECIAL or not name.startswith("_"))


def reads_of(kind: type) -> list[str]:
    """Those that only look."""
    return [name for name in names_of(kind) if name in SPECIAL or not callable(getattr(kind, name))]


def look_at(thing: object, name: str) -> None:
    """Read a property, and all that is in it."""
    value = getattr(thing, name)
    if name in SPECIAL:
        value = value()
    repr(value)
    if isinstance(value, Columns):
        repr(list(value.values()))
    elif type(value).__module__.startswith("pogosim") and hasattr(value, "__getitem__"):
        for item in list(value)[:2]:
            for own in reads_of(type(item)):
                look_at(item, own)


def disturbed(simulation: pogosim.Simulation, how: str, program: str, configuration: str) -> pogosim.Simulation:
    """Do what threads that look shall survive. Returns the simulation that goes on."""
    if how == "reset":
        simulation.reset(int(time.monotonic() * 1000) % 1000)
    elif how == "step":
        if simulation.step(50) < 50:
            simulation.reset()
    elif how == "run":
        simulation.run()
        simulation.reset()
    else:
        simulation.close()
        return pogosim.Simulation(program, configuration, set=SETTINGS)
    return simulation


def main(program: str, configuration: str, how: str, seconds: float) -> int:
    """Look on two threads while this one disturbs."""
    logging.disable()
    now = [pogosim.Simulation(program, configuration, set=SETTINGS)]
    stop = threading.Event()
    problems: list[str] = []
    names = reads_of(pogosim.Simulation)
    seen = dict.fromkeys(names, 0)

    def look(order: list[str]) -> None:
        while not stop.is_set():
            for name in order * TIMES if how == "close" else [name for name in order for _ in range(TIMES)]:
                try:
                    with contextlib.suppress(pogosim.SimulationError):  # closed
                        look_at(now[0], name)
                        seen[name] += 1
                except BaseException:
                    problems.append(f"{name}: {traceback.format_exc()}")
                    stop.set()
                if stop.is_set():
                    return

    threads = [threading.Thread(target=look, args=(order,)) for order in (names, names[::-1])]
    for thread in threads:
        thread.start()
    end = time.monotonic() + seconds
    try:
        while time.monotonic() < end and not stop.is_set():
            now[0] = disturbed(now[0], how, program, configuration)
    finally:
        stop.set()
        for thread in threads:
            thread.join()
        now[0].close()
    print(f"looked {sum(seen.values())} times")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3], float(sys.argv[4])))
