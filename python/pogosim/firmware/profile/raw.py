"""The profile of a run, a JSON file that the simulator writes with `--profile FILE` at the end of a run with firmware.

    {
      "version": 1,
      "firmware": "/path/firmware.elf",
      "clock_hz": 21000000, "cycle_factor": 1.0, "loop_hz": 60,     loop_hz 0: the program has no main loop
      "memory_bytes": 131072,
      "program_bytes": 13040, "variable_bytes": 64,                 code and constants; data and bss
      "deepest_stack_bytes": 712, "heap_bytes": 0,
      "robots": [{"id": 0, "category": "robots"}],                  those that were profiled
      "ticks": [{"robot": 0, "tick": 0, "begin_s": 0.0, "cycles": 12345, "miss_cycles": 180,
                 "call_us": 31.5}],
      "functions": ["main", "user_step", "__muldf3"],               the numbers below are places in this list
      "lines": [{"function": 1, "file": "main.c", "line": 84, "cycles": 5000, "instructions": 900}],
      "stacks": [{"frames": [0, 1, 2], "cycles": 3000, "call_us": 0.0, "calls": 12}],
      "spans": [{"robot": 0, "name": 1, "begin_us": 0.0, "duration_us": 12.5, "depth": 1}]
    }

- `ticks` has one entry per finished tick of a profiled robot; `call_us` is time in functions of the robots' library,
  which comes on top of the cycles. `miss_cycles` are those of the cycles in which the processor waits for code that is
  not in its instruction cache; without the key, none.
- `lines` and `stacks` cover the same ticks. The file of a line is "" where it is not known. Frames of a stack go from
  the outermost function to the innermost one, whose own cycles and time these are; `calls` counts how often it was
  called along this path.
- `spans` are calls of the first ticks, for a trace: in each step of the run, robot by robot.
- Cycles are counted as the processor does, before `cycle_factor`, by which the simulator multiplies them. Reading does
  it once: everything in a Profile is in cycles of the clock. Further keys are allowed, and ignored.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pogosim.errors import ToolError

VERSION = 1
LONGEST_FOUND = 40  # characters of a wrong value in a message

Value = TypeVar("Value")


class ProfileError(ToolError):
    """There is no profile, or it holds nothing to report; says where, what was expected, and what to do."""


@dataclass(frozen=True)
class Robot:
    """A robot that was profiled."""

    identifier: int
    category: str


@dataclass(frozen=True)
class Tick:
    """A finished tick of a robot's main loop.

    Attributes:
        robot: Id of the robot.
        number: Which of its ticks; the first is 0.
        begin_s: When it began, s of simulated time.
        cycles: Cycles of the clock that its code took, 0 or more.
        call_us: Time in functions of the robots' library, besides, us.
        miss_cycles: Those of the cycles in which it waited for code that was not in the instruction cache.
    """

    robot: int
    number: int
    begin_s: float
    cycles: float
    call_us: float
    miss_cycles: float = 0.0


@dataclass(frozen=True)
class Line:
    """What the code of one line of a source file took, in all ticks.

    Attributes:
        function: Place of its function in Profile.functions.
        file: Source file; "" where it is not known.
        number: Line of the file, 1 or more; 0 where it is not known.
        cycles: Cycles of the clock.
        instructions: Instructions that were executed.
    """

    function: int
    file: str
    number: int
    cycles: float
    instructions: float


@dataclass(frozen=True)
class Stack:
    """What the innermost function of a path of calls took itself, in all ticks.

    Attributes:
        frames: Places in Profile.functions, outermost first; at least one.
        cycles: Cycles of the clock.
        call_us: Time in functions of the robots' library, us.
        calls: How often it was called along this path.
    """

    frames: tuple[int, ...]
    cycles: float
    call_us: float
    calls: float


@dataclass(frozen=True)
class Span:
    """A call from its begin to its end.

    Attributes:
        robot: Id of the robot.
        function: Place in Profile.functions.
        begin_us: When it began, us.
        duration_us: How long it took, us.
        depth: Calls around it, 0 for the outermost one.
    """

    robot: int
    function: int
    begin_us: float
    duration_us: float
    depth: int


@dataclass(frozen=True)
class Profile:
    """A profile; see the description of the file at the top."""

    firmware: str
    clock_hz: float
    cycle_factor: float
    loop_hz: float
    memory_bytes: int
    program_bytes: int
    variable_bytes: int
    deepest_stack_bytes: int
    heap_bytes: int
    robots: tuple[Robot, ...]
    ticks: tuple[Tick, ...]
    functions: tuple[str, ...]
    lines: tuple[Line, ...]
    stacks: tuple[Stack, ...]
    spans: tuple[Span, ...]

    @property
    def budget_cycles(self) -> float | None:
        """Cycles between the begins of two ticks; None if the program has no main loop."""
        return self.clock_hz / self.loop_hz if self.loop_hz > 0 else None

    def cycles_during(self, time_us: float) -> float:
        """Return the cycles of the clock that go by in a time."""
        return time_us * self.clock_hz / 1e6

    def cost(self, counted: Tick | Stack) -> float:
        """Return all that something took, in cycles: of its code, and those that go by in the robots' library."""
        return counted.cycles + self.cycles_during(counted.call_us)


@dataclass(frozen=True)
class Entry:
    """An object of the file, and its place there: "profile.json: ticks[3]"."""

    place: str
    values: Mapping[str, Any]

    def get(self, key: str, expected: str, is_right: Callable[[Any], bool]) -> Any:
        """Return a value that is as expected.

        Raises:
            ProfileError: It is missing, or something else.
        """
        if key not in self.values:
            raise ProfileError(f"{self.place} has no '{key}', {expected}; expected a profile that the simulator wrote")
        if not is_right(value := self.values[key]):
            raise ProfileError(f"{self.place}, '{key}': expected {expected}, found {shown(value)}")
        return value

    def number(self, key: str) -> float:
        """Return a number of 0 or more."""
        return float(self.get(key, "a number of 0 or more", is_number))

    def positive(self, key: str) -> float:
        """Return a number above 0."""
        return float(self.get(key, "a number above 0", lambda value: is_number(value) and value > 0))

    def whole(self, key: str) -> int:
        """Return a whole number of 0 or more."""
        return int(self.get(key, "a whole number of 0 or more", is_whole))

    def text(self, key: str) -> str:
        """Return a text."""
        return str(self.get(key, "a text", lambda value: isinstance(value, str)))

    def place_in(self, key: str, names: tuple[str, ...]) -> int:
        """Return a place in the list of functions."""
        expected = f"a place in 'functions', of which there are {len(names)}"
        return int(self.get(key, expected, lambda value: is_whole(value) and value < len(names)))

    def places_in(self, key: str, names: tuple[str, ...]) -> tuple[int, ...]:
        """Return one or more places in the list of functions."""
        expected = f"a list of places in 'functions', of which there are {len(names)}"

        def is_right(value: Any) -> bool:
            return is_list_of(value, int) and value != [] and all(is_whole(one) and one < len(names) for one in value)

        return tuple(self.get(key, expected, is_right))

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of texts."""
        return tuple(self.get(key, "a list of texts", lambda found: is_list_of(found, str)))

    def entries(self, key: str, read: Callable[[Entry], Value]) -> tuple[Value, ...]:
        """Return a list of objects, each of which is read by a function."""
        found = self.get(key, "a list of objects", lambda value: is_list_of(value, dict))
        return tuple(read(Entry(f"{self.place}: {key}[{place}]", value)) for place, value in enumerate(found))


def is_number(value: Any) -> bool:
    """Tell whether a value of JSON is a finite number of 0 or more."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value >= 0


def is_whole(value: Any) -> bool:
    """Tell whether a value of JSON is a whole number of 0 or more."""
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def is_list_of(value: Any, kind: type) -> bool:
    """Tell whether a value of JSON is a list, all of whose values are of a type."""
    return isinstance(value, list) and all(isinstance(one, kind) for one in value)


def shown(value: Any) -> str:
    """Return a wrong value as JSON, cut if it is long."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST_FOUND else f"{text[:LONGEST_FOUND]}..."


def read_json(file: Path, called: str) -> Entry:
    """Read the object of a JSON file, which has a name in messages.

    Raises:
        ProfileError: It is something else.
        OSError: It cannot be read.
    """
    wanted = "expected a profile (JSON) that the simulator wrote with --profile"
    try:
        values = json.loads(file.read_bytes())
    except UnicodeDecodeError:
        raise ProfileError(f"{called} is not text in UTF-8; {wanted}") from None
    except json.JSONDecodeError as error:
        raise ProfileError(f"{called}:{error.lineno}: it is not JSON ({error.msg}); {wanted}") from None
    except (RecursionError, ValueError):
        raise ProfileError(f"{called} is not JSON that can be read; {wanted}") from None
    if not isinstance(values, dict) or "version" not in values or "stacks" not in values:
        raise ProfileError(f"{called} is JSON, but no profile: it has no 'version' and 'stacks'; {wanted}")
    if values["version"] != VERSION:
        raise ProfileError(
            f"{called}: its version is {shown(values['version'])}, expected {VERSION}; make the profile again"
        )
    return Entry(called, values)


def read_profile(file: Path, called: str = "") -> Profile:
    """Read the profile of a run.

    Args:
        file: The profile.
        called: What messages call it; empty: its path.

    Raises:
        ProfileError: It is something else, or has no ticks.
        OSError: It cannot be read.
    """
    entry = read_json(file, called or str(file))
    factor = entry.positive("cycle_factor")
    names = entry.texts("functions")
    profile = Profile(
        firmware=entry.text("firmware"),
        clock_hz=entry.positive("clock_hz"),
        cycle_factor=factor,
        loop_hz=entry.number("loop_hz"),
        memory_bytes=entry.whole("memory_bytes"),
        program_bytes=entry.whole("program_bytes"),
        variable_bytes=entry.whole("variable_bytes"),
        deepest_stack_bytes=entry.whole("deepest_stack_bytes"),
        heap_bytes=entry.whole("heap_bytes"),
        robots=entry.entries("robots", lambda one: Robot(one.whole("id"), one.text("category"))),
        ticks=entry.entries("ticks", lambda one: read_tick(one, factor)),
        functions=names,
        lines=entry.entries("lines", lambda one: read_line(one, names, factor)),
        stacks=entry.entries("stacks", lambda one: read_stack(one, names, factor)),
        spans=entry.entries("spans", lambda one: read_span(one, names)),
    )
    if not profile.ticks:
        raise ProfileError(
            f"{entry.place}: no tick ended, so there is nothing to report: the run was shorter than a tick, or the "
            "program does not come back to its main loop (pogobot_start)"
        )
    return profile


def read_tick(entry: Entry, factor: float) -> Tick:
    """Read a tick."""
    return Tick(
        entry.whole("robot"),
        entry.whole("tick"),
        entry.number("begin_s"),
        factor * entry.number("cycles"),
        entry.number("call_us"),
        factor * entry.number("miss_cycles") if "miss_cycles" in entry.values else 0.0,
    )


def read_line(entry: Entry, names: tuple[str, ...], factor: float) -> Line:
    """Read a line."""
    return Line(
        entry.place_in("function", names),
        entry.text("file"),
        entry.whole("line"),
        factor * entry.number("cycles"),
        entry.number("instructions"),
    )


def read_stack(entry: Entry, names: tuple[str, ...], factor: float) -> Stack:
    """Read a stack."""
    return Stack(
        entry.places_in("frames", names),
        factor * entry.number("cycles"),
        entry.number("call_us"),
        entry.number("calls"),
    )


def read_span(entry: Entry, names: tuple[str, ...]) -> Span:
    """Read a span."""
    return Span(
        entry.whole("robot"),
        entry.place_in("name", names),
        entry.number("begin_us"),
        entry.number("duration_us"),
        entry.whole("depth"),
    )
