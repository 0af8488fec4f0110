"""A run that goes on in a thread of its own, while viewers look at it and steer it.

The thread makes the steps that are due, then looks at the run and tells every viewer what has changed. All that viewers
ask for is done by it, between two steps, so a run gives the same bytes with viewers and without, unless they steer.
"""

from __future__ import annotations

import contextlib
import logging
import math
import queue
import threading
import time
import weakref
from collections import deque
from collections.abc import Callable
from ctypes import byref, c_int
from dataclasses import dataclass
from typing import Any

import numpy as np

from pogosim.lines import printable_lines
from pogosim.simulation import ProgramFailedError, Simulation, SimulationError
from pogosim.simulation.library import check, library
from pogosim.watch.commands import Command, RefusedError
from pogosim.watch.frames import NO_COLUMN, Column, light_message
from pogosim.watch.looking import Look, look_at
from pogosim.watch.pace import PERIOD_S, Pace
from pogosim.watch.stage import Stage, lamp_data, link_data, plain_numbers
from pogosim.watch.values import column_names, object_values, values_of_robot
from pogosim.watch.viewer import Viewer

DETAILS_S = 0.2  # from one telling of details to the next
MOST_LINES = 100  # that are told at a time, and to a new viewer
MOST_CHARACTERS_OF_LINE = 500
CLOSED = "the simulation is closed"
LOOKS_ON = "this page looks on: only one with the address for steering can do this"

logger = logging.getLogger("pogosim")


@dataclass(frozen=True)
class Status:
    """What all viewers are told of a run."""

    is_playing: bool = False
    speed: float = 1.0  # times real time that is wanted; infinite: as fast as it goes
    is_over: bool = False
    is_closed: bool = False
    problem: str = ""

    def message(self) -> dict[str, Any]:
        """Return it as a message."""
        return {
            "kind": "status",
            "playing": self.is_playing,
            "speed": self.speed if math.isfinite(self.speed) else None,
            "over": self.is_over,
            "closed": self.is_closed,
            "problem": self.problem,
        }


class LiveRun:
    """A run with its viewers. Methods may be called by any thread.

    Attributes:
        status: What all viewers are told.
        failure: Why the run, or its last reset, has failed; None: it has not.
        one_steers: Whether only one viewer may steer at a time; else all that may at all.
    """

    def __init__(self, simulation: Simulation, *, one_steers: bool = False) -> None:
        """Share the simulation with the thread of this run: other threads wait for it in place of an error."""
        self._wake = threading.Event()
        self._simulation = weakref.ref(simulation, lambda _: self._wake.set())
        simulation._current.is_shared = True
        self._requests: queue.SimpleQueue[Callable[[Simulation], None]] = queue.SimpleQueue()
        self._viewers: list[Viewer] = []
        self._stage: Stage | None = None
        self._columns: list[str] = []
        self._head: dict[str, Any] = {}
        self._shown_step = -1
        self._is_changed = True  # what is seen, without a step
        self._pace = Pace()
        self._details_at_s = 0.0
        self._light: np.ndarray[Any, Any] | None = None
        self._links: dict[str, Any] | None = None
        self._said: deque[str] = deque(maxlen=MOST_LINES)  # and not told yet
        self._last_said: deque[str] = deque(maxlen=MOST_LINES)
        self._is_ended = False
        self.status = Status()
        self.failure: Exception | None = None
        self.one_steers = one_steers
        self.steerer: Viewer | None = None
        self._thread = threading.Thread(target=self._go, name="pogosim-live", daemon=True)
        self._thread.start()

    # ---- For other threads

    def join(self, viewer: Viewer) -> None:
        """Let a viewer look from now on."""

        def add(simulation: Simulation) -> None:
            self._viewers.append(viewer)
            if self.one_steers and self.steerer is None and viewer.may_steer:
                self.steerer = viewer
            if self._stage is not None:
                self._greet(viewer, simulation)
            self._tell_status()

        self.request(add)

    def leave(self, viewer: Viewer) -> None:
        """Forget a viewer."""

        def remove(_: Simulation) -> None:
            with contextlib.suppress(ValueError):
                self._viewers.remove(viewer)
            if self.steerer is viewer:
                self.steerer = next((own for own in self._viewers if own.may_steer), None)
            if not self._viewers and not self.one_steers:
                self._set(is_playing=False)  # a cell that was run again has a run of its own
            self._tell_status()

        self.request(remove)

    @property
    def backlog(self) -> int:
        """How many requests wait."""
        return self._requests.qsize()

    def say(self, text: str) -> None:
        """Tell viewers a line that robots or the simulator have printed."""
        self._said.append(text[:MOST_CHARACTERS_OF_LINE])

    def request(self, action: Callable[[Simulation], None]) -> None:
        """Let the thread of this run do something between two steps, now."""
        self._requests.put(action)
        self._wake.set()

    def play(self, speed: float | None = None) -> None:
        """Go on; `speed`: times real time, None: that of before."""
        if speed is not None:
            self.set_speed(speed)
        self.request(lambda simulation: self._set(is_playing=not simulation.is_over))

    def set_speed(self, speed: float) -> None:
        """Let it go at another speed, times real time, once it plays."""
        self.request(lambda _: self._set(speed=speed))

    @property
    def is_alive(self) -> bool:
        """Whether the thread of this run goes on: until the simulation is closed, or `end`."""
        return self._thread.is_alive()

    def wake(self) -> None:
        """Let the thread see now how the simulation is: closed, perhaps."""
        self._wake.set()

    def pause(self) -> None:
        """Stop after the present step, and wait until that is done."""
        is_done = threading.Event()

        def stop(_: Simulation) -> None:
            self._set(is_playing=False)
            is_done.set()

        self.request(stop)
        while not is_done.wait(0.1) and self._thread.is_alive():
            pass

    def end(self) -> None:
        """End the thread, and wait for it: the simulation goes on without viewers."""
        self._is_ended = True
        self._wake.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    # ---- In the thread of this run

    def _go(self) -> None:
        next_s = time.perf_counter()
        while not self._is_ended:
            simulation = self._simulation()
            if simulation is None or not self._turn(simulation):
                break
            is_idle = not self._viewers and not self.status.is_playing
            del simulation
            now = time.perf_counter()
            next_s = max(next_s + PERIOD_S, now)
            self._wake.wait(None if is_idle else next_s - now)
            self._wake.clear()
        self._set(is_playing=False, is_closed=True)

    def _turn(self, simulation: Simulation) -> bool:
        """Do what is due; returns whether there is more to come."""
        try:
            self._follow(simulation)
            self._do_requests(simulation)
            self._follow(simulation)
            if self.status.is_playing:
                self._advance(simulation)
            self._show(simulation)
        except SimulationError as error:
            if self._stage is None or self._stage.run is simulation._current.run:
                self._fail(error)
            # else closed or reset by another thread meanwhile: the next turn sees how it is
        except Exception as error:  # viewers and the terminal are told, in place of a view that stands still
            logger.exception("the thread of a live run has failed")
            self._fail(error)
            return False
        return not simulation._is_closed

    def _fail(self, error: Exception) -> None:
        """Stop, and tell why."""
        self.failure = error
        told = str(error) if isinstance(error, SimulationError) else f"internal error: {error!r}"
        self._set(is_playing=False, problem=printable_lines(told))

    def _follow(self, simulation: Simulation) -> None:
        """Set the stage for a run that is new, perhaps by a reset."""
        run = simulation._current.run
        if run is None or simulation._is_closed:  # closed, or the last reset has failed
            self._stage = None
            self._set(is_playing=False, is_closed=simulation._is_closed)
            return
        if self._stage is not None and self._stage.run is run:
            return
        self._stage = Stage(simulation)
        self._columns = column_names(simulation)
        self._head = self._stage.head(self._columns)
        self._shown_step, self._light, self._links = -1, None, None
        self.failure = None
        self._set(is_over=simulation.is_over, is_closed=False, problem="")
        for viewer in self._viewers:
            self._greet(viewer, simulation)

    def _greet(self, viewer: Viewer, simulation: Simulation) -> None:
        """Tell a viewer all that it needs before its first frame."""
        assert self._stage is not None
        viewer.begin(self._head, self._stage.low, self._stage.high)
        self._tell_settings(viewer, simulation)
        viewer.tell(self._message_for(viewer))
        if self._last_said:
            viewer.tell({"kind": "said", "lines": list(self._last_said)})
        if self._light is not None:
            viewer.tell(light_message(self._light))
        if self._links is not None:
            viewer.tell({"kind": "links", "links": self._links})
        viewer.show(self._look(simulation))

    def _do_requests(self, simulation: Simulation) -> None:
        while True:
            try:
                action = self._requests.get_nowait()
            except queue.Empty:
                return
            action(simulation)

    def _advance(self, simulation: Simulation) -> None:
        if simulation._current.lock.locked():  # another thread steps
            self._pace.start()
            return
        steps = self._pace.steps(self.status.speed, simulation.time_step)
        began_s = time.perf_counter()
        made = simulation.step(steps) if steps else 0
        self._pace.made(made, time.perf_counter() - began_s)

    def _show(self, simulation: Simulation) -> None:
        """Tell viewers what has changed since they were told last."""
        if self._stage is None:
            return
        if simulation.is_over != self.status.is_over:
            self._set(is_over=simulation.is_over, is_playing=self.status.is_playing and not simulation.is_over)
        if not self._viewers:
            return
        step = simulation.steps
        if step != self._shown_step or self._is_changed:
            self._shown_step, self._is_changed = step, False
            look = self._look(simulation)
            for viewer in self._viewers:
                viewer.show(look)
        else:
            for viewer in self._viewers:
                viewer.show_late()
        now = time.perf_counter()
        if now - self._details_at_s >= DETAILS_S:
            self._details_at_s = now
            self._tell_details(simulation)

    def _look(self, simulation: Simulation) -> Look:
        assert self._stage is not None
        wanted = {name for viewer in self._viewers for name, _ in viewer.columns} - {""}
        columns = {name: object_values(simulation, name, self._stage.robots) for name in wanted}
        return look_at(self._stage.run, columns)

    def _tell_details(self, simulation: Simulation) -> None:
        """Tell what need not be told with each frame: values of single robots, light, links."""
        assert self._stage is not None
        of_objects: dict[int, dict[str, Any]] = {}
        for viewer in self._viewers:
            index = viewer.selected
            if 0 <= index < len(self._stage.robots):
                if index not in of_objects:
                    robot = int(self._stage.robots[index])
                    of_objects[index] = values_of_robot(simulation, robot) if robot >= 0 else {}
                viewer.tell_new({"kind": "robot", "object": index, "values": plain_numbers(of_objects[index])})
        self._tell_said()
        light = self._stage.light(simulation.light_map)
        if self._light is None or not np.array_equal(light, self._light):
            self._light = light
            self._tell(light_message(light))
        links = link_data(simulation.links)
        if links is not None or self._links is not None:
            if links != self._links:
                self._tell({"kind": "links", "links": links})
            self._links = links

    def _tell_said(self) -> None:
        lines = [self._said.popleft() for _ in range(len(self._said))]
        self._last_said.extend(lines)
        if lines:
            self._tell({"kind": "said", "lines": lines})

    # ---- What viewers ask for

    def do(self, viewer: Viewer, command: Command) -> None:
        """Do what a viewer asks for, soon. Viewers are told if it is refused."""

        def act(simulation: Simulation) -> None:
            try:
                self._check_steering(viewer, command)
                getattr(self, f"_do_{command.name}")(simulation, viewer, **command.values)
            except (RefusedError, SimulationError) as error:
                viewer.tell({"kind": "refused", "message": printable_lines(str(error))})

        if not self.is_alive:
            viewer.tell({"kind": "refused", "message": CLOSED})
        elif command.name == "shown":  # the next turn is soon enough
            self._requests.put(act)
        else:
            self.request(act)

    def _check_steering(self, viewer: Viewer, command: Command) -> None:
        if not command.steers:
            return
        if not viewer.may_steer:
            raise RefusedError(LOOKS_ON)
        if self.one_steers and self.steerer is not viewer:
            raise RefusedError("another viewer steers: press 'steer' to take over")
        if self.status.is_closed:
            raise RefusedError(CLOSED)

    def _do_shown(self, _: Simulation, viewer: Viewer, frame: int) -> None:
        viewer.was_shown(frame)

    def _do_select(self, _: Simulation, viewer: Viewer, object: int) -> None:  # noqa: A002 -- as in the message
        viewer.selected = object
        self._details_at_s = 0.0

    def _do_columns(self, _: Simulation, viewer: Viewer, color_by: str | None, heat_map: str | None) -> None:
        viewer.columns = (self._column(color_by), self._column(heat_map))
        self._is_changed = True

    def _column(self, name: str | None) -> Column:
        if name is None:
            return NO_COLUMN
        if name not in self._columns:
            raise RefusedError(f"the robots have no value {name!r} that colours could show")
        return name, self._columns.index(name) + 1

    def _do_steer(self, _: Simulation, viewer: Viewer) -> None:
        if not viewer.may_steer:
            raise RefusedError(LOOKS_ON)
        self.steerer = viewer
        self._tell_status()

    def _do_play(self, simulation: Simulation, _: Viewer) -> None:
        if simulation.is_over:
            raise RefusedError("the run is over: reset it to play it again")
        self._set(is_playing=True)

    def _do_pause(self, _: Simulation, __: Viewer) -> None:
        self._set(is_playing=False)

    def _do_step(self, simulation: Simulation, _: Viewer, steps: int) -> None:
        self._set(is_playing=False)
        try:
            simulation.step(steps)
        except ProgramFailedError as error:
            self._fail(error)

    def _do_speed(self, _: Simulation, __: Viewer, value: float | None) -> None:
        self._set(speed=math.inf if value is None else float(value))

    def _do_drag(self, simulation: Simulation, _: Viewer, object: int, x: float, y: float) -> None:  # noqa: A002
        if object < 0:
            raise RefusedError("no object is dragged")
        with simulation._busy():
            check(library().pogosim_run_drag_object(simulation._run.pointer, object, x, y, byref(c_int())))
        self._is_changed = True

    def _do_set(self, simulation: Simulation, _: Viewer, name: str, value: bool | float) -> None:
        assert self._stage is not None
        if name not in self._stage.parameters:
            raise RefusedError(f"the configuration has no number parameters.{name}")
        simulation.parameters[name] = value
        self._stage.parameters[name] = value
        for viewer in self._viewers:
            self._tell_settings(viewer, simulation)

    def _do_lamp(self, simulation: Simulation, _: Viewer, lamp: int, on: bool, intensity: float) -> None:
        if lamp >= len(simulation.lamps):
            raise RefusedError(f"there is no lamp {lamp}: the run has {len(simulation.lamps)}")
        simulation.lamps[lamp].is_on = on
        simulation.lamps[lamp].intensity = intensity
        self._details_at_s = 0.0
        for viewer in self._viewers:
            self._tell_settings(viewer, simulation)

    def _do_reset(self, simulation: Simulation, _: Viewer, seed: int | None) -> None:
        self._set(is_playing=False)
        try:
            simulation.reset(seed)
        except SimulationError as error:
            self._fail(error)

    # ---- Telling

    def _tell(self, message: dict[str, Any] | bytes) -> None:
        for viewer in self._viewers:
            viewer.tell(message)

    def _tell_settings(self, viewer: Viewer, simulation: Simulation) -> None:
        assert self._stage is not None
        viewer.tell(
            {
                "kind": "settings",
                "parameters": plain_numbers(self._stage.parameters),
                "lamps": lamp_data(simulation),
                "seed": simulation.seed,
            }
        )

    def _set(self, **changes: Any) -> None:
        was_playing = self.status.is_playing
        status = Status(**{**vars(self.status), **changes})
        if status == self.status:
            return
        self.status = status
        if status.is_playing and not was_playing:
            self._pace.start()
        self._tell_status()

    def _message_for(self, viewer: Viewer) -> dict[str, Any]:
        steers = viewer.may_steer and (not self.one_steers or self.steerer is viewer)
        return {
            **self.status.message(),
            "steers": steers,
            "maySteer": viewer.may_steer,
            "viewers": len(self._viewers),
        }

    def _tell_status(self) -> None:
        for viewer in list(self._viewers):
            viewer.tell(self._message_for(viewer))
