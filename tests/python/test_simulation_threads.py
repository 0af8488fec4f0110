"""pogosim.Simulation used by several threads at once: reads are answered, and nothing is read that was freed."""

from __future__ import annotations

import contextlib
import inspect
import logging
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from pogosim.simulation.library import PROTOTYPES, library
from running import ROOT, write_scene
from threads_of_a_run import SPECIAL, look_at, names_of

SCRIPT = Path(__file__).with_name("threads_of_a_run.py")
# Values for arguments of methods, by their names.
ARGUMENTS: dict[str, Any] = {
    "steps": 2,
    "until_s": 0.5,
    "seed": 7,
    "robot": 0,
    "x": 500.0,
    "y": 500.0,
    "heading": 0.5,
    "name": "steps_of_all",
    "value": 1.0,
    "obj": 0,
    "category": "robots",
    "file": "copy.feather",
    "state": None,
    "a": 0,
    "b": 1,
    "kind": "rod",
    "links": [],
    "set": None,
    "width": 40,
    "height": 30,
}


@pytest.fixture(autouse=True)
def _folders_of_the_tree(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A configuration of three robots, a ball and a lamp, 2 s."""
    robots = {"type": "pogobot", "nb": 3, "geometry": "disk", "radius": 26.5, "communication_radius": 80}
    balls = {"type": "passive_object", "nb": 1, "geometry": "disk", "radius": 20.0}
    lamps = {"type": "static_light", "geometry": "disk", "radius": 300, "value": 1000, "light_mode": "static"}
    objects = {"robots": robots, "balls": balls, "lamps": {**lamps, "x": 500, "y": 500}}
    arena = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5}
    return write_scene(tmp_path, {**arena, "objects": objects})


def use(thing: object, name: str) -> None:
    """Read a property and what is in it, or call a method."""
    found = getattr(thing, name)
    if name in SPECIAL or not callable(found):
        look_at(thing, name)
        return
    parameters = inspect.signature(found).parameters.values()
    found(*(ARGUMENTS[one.name] for one in parameters if one.kind is one.POSITIONAL_OR_KEYWORD))


def in_another_thread(function: Callable[[], object]) -> None:
    """Call a function, and wait for it; errors of the simulation are none of ours."""

    def call() -> None:
        with contextlib.suppress(pogosim.SimulationError):  # in use by the thread that waits
            function()

    thread = threading.Thread(target=call)
    thread.start()
    thread.join(timeout=60)
    assert not thread.is_alive()


@pytest.mark.parametrize("disturbance", ["reset", "close"])
# While there is a view, threads wait for each other, see test_live_run.py.
@pytest.mark.parametrize("name", [name for name in names_of(pogosim.Simulation) if name != "view"])
def test_run_is_kept_until_the_last_call_that_uses_it_returns(
    name: str, disturbance: str, hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before each call of the library, another thread ends the run that the call is about."""
    reader, freed, calls = threading.current_thread(), set[int](), list[Any]()
    simulation = pogosim.Simulation(hosted, scene)

    def watched(real: Any) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            if threading.current_thread() is reader:
                in_another_thread(getattr(simulation, disturbance))
            calls.append(real)
            assert not arguments or getattr(arguments[0], "value", None) not in freed
            return real(*arguments)

        return call

    for function in PROTOTYPES:
        if function.startswith("pogosim_run") and not function.endswith(("open", "close")):
            monkeypatch.setattr(library(), function, watched(getattr(library(), function)))
    simulation._run._run._close = lambda pointer: freed.add(pointer.value or 0)
    try:
        use(simulation, name)
    except (pogosim.SimulationError, FileNotFoundError) as error:
        # A program drives these robots, and the run writes rows, so it has no state to go back to.
        assert disturbance == "close" or name in ("brain", "firmware_variable", "save", "restore"), error
    finally:
        simulation.close()
        monkeypatch.undo()
    assert calls or name in ("configuration", "data_file", "parameters", "program")
    assert len(freed) <= 1


@pytest.mark.parametrize("disturbance", ["reset", "step", "run", "close"])
def test_threads_look_at_a_simulation_whatever_another_one_does_with_it(
    disturbance: str, hosted: Path, scene: Path
) -> None:
    ended = subprocess.run(
        [sys.executable, SCRIPT, hosted, scene, disturbance, "2"],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.returncode, ended.stderr) == (0, ""), ended.stdout + ended.stderr


def test_reads_are_answered_while_another_thread_runs(sim: pogosim.Simulation) -> None:
    sim.parameters["gain"] = 2.0
    thread = threading.Thread(target=sim.run)
    times = [0.0]
    thread.start()
    while thread.is_alive():
        times.append(sim.time)
        assert sim.objects[0].category == "robots"
    thread.join()
    assert sim.is_over
    assert (np.diff([*times, sim.time]) >= 0.0).all()


def test_reset_in_another_thread_shows_the_end_of_a_run_or_the_beginning_of_the_next(sim: pogosim.Simulation) -> None:
    sim.step(10)
    stop = threading.Event()
    seen: set[int] = set()

    def look() -> None:
        while not stop.is_set():
            seen.add(sim.steps)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        for _ in range(5):
            sim.reset()
            sim.step(10)
    finally:
        stop.set()
        thread.join()
    assert seen <= set(range(11))


def test_handler_of_messages_may_look_at_the_run_that_sends_them(
    sim: pogosim.Simulation, caplog: pytest.LogCaptureFixture
) -> None:
    """It is called in the middle of step()."""
    times = []

    class Handler(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            del record
            times.append(sim.time)
            with pytest.raises(pogosim.SimulationError, match="in use"):
                sim.step()

    handler = Handler()
    caplog.set_level(logging.DEBUG)
    logging.getLogger("pogosim").addHandler(handler)
    try:
        sim.reset()
        sim.end()
    finally:
        logging.getLogger("pogosim").removeHandler(handler)
    assert times
