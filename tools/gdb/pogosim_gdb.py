"""How gdb shows the simulator's types, and functions that find another robot's data. For gdb 9 or later.

gdb reads this file by itself where it lies beside the library it debugs, `<build>/src/libpogosim.so.VERSION-gdb.py`, if
it may: `add-auto-load-safe-path <build>`. Or say `source tools/gdb/pogosim_gdb.py`. See docs/debugging.md.

Members are shown as gdb finds them, so new ones need nothing here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import gdb
import gdb.printing

Children = Iterator[tuple[str, gdb.Value]]

NONE = 0xFFFFFFFF  # kNone of world.hpp


def members(value: gdb.Value) -> Children:
    """Names and values of all members, those of base classes first."""
    for field in value.type.strip_typedefs().fields():
        if field.is_base_class:
            yield from members(value[field])
        elif hasattr(field, "bitpos") and field.name:  # static members have none
            yield field.name, value[field]


def elements(value: gdb.Value) -> list[gdb.Value]:
    """Elements of a std::vector or std::array, with libstdc++'s or libc++'s names."""
    names = {name for name, _ in members(value)}
    if "_M_elems" in names:
        array = value["_M_elems"]
    elif "__elems_" in names:
        array = value["__elems_"]
    else:
        first, last = vector_range(value)
        return [(first + i).dereference() for i in range(int(last - first))]
    low, high = array.type.strip_typedefs().range()
    return [array[i] for i in range(low, high + 1)]


def vector_range(value: gdb.Value) -> tuple[gdb.Value, gdb.Value]:
    """Return the first element of a std::vector and one past its last, as pointers."""
    if "_M_impl" in {name for name, _ in members(value)}:
        return value["_M_impl"]["_M_start"], value["_M_impl"]["_M_finish"]
    return value["__begin_"], value["__end_"]


def size_of(value: gdb.Value) -> int:
    """Elements of a std::vector."""
    first, last = vector_range(value)
    return int(last - first)


def hex_colour(value: gdb.Value) -> str:
    """Return a colour as in pages of the web: #ff8000."""
    return "#" + "".join(f"{int(value[channel]) & 0xFF:02x}" for channel in "rgb")


class Vec2Printer:
    """(12.5, -3)."""

    def __init__(self, value: gdb.Value) -> None:
        self.value = value

    def to_string(self) -> str:
        return f"({float(self.value['x']):g}, {float(self.value['y']):g})"


class RgbPrinter:
    """#ff8000."""

    def __init__(self, value: gdb.Value) -> None:
        self.value = value

    def to_string(self) -> str:
        return hex_colour(self.value)


class LedsPrinter:
    """Head, front, right, back, left: #ff0000 #000000 ..."""

    def __init__(self, value: gdb.Value) -> None:
        self.value = value

    def to_string(self) -> str:
        return " ".join(hex_colour(led) for led in elements(self.value))


class MembersPrinter:
    """A sentence, then all members."""

    def __init__(self, value: gdb.Value) -> None:
        self.value = value

    def to_string(self) -> str:
        raise NotImplementedError

    def children(self) -> Children:
        yield from members(self.value)


class ControllerPrinter(MembersPrinter):
    """All members; the robot's devices are elsewhere, see $device()."""

    def to_string(self) -> str:
        return "controller"


class ArraysPrinter(MembersPrinter):
    """A structure of arrays: their common length, then the arrays. `set print elements` limits what is shown."""

    def to_string(self) -> str:
        columns = [member for name, member in members(self.value) if is_vector(member.type) and name != "written"]
        sizes = sorted({size_of(member) for member in columns})  # Bodies::written is a list of its own
        what = name_of(self.value.type).rsplit("::", 1)[-1].lower()
        return f"{sizes[0]} {what}" if len(sizes) == 1 else f"{what} in arrays of different length: {sizes}"


class WorldPrinter(MembersPrinter):
    """Step, time and how many there are of everything; then the members that are no arrays."""

    def to_string(self) -> str:
        step = int(self.value["step"])
        counts = []
        for name, member in members(self.value):
            if is_vector(member.type):
                counts.append(f"{size_of(member)} {name}")
            elif name_of(member.type) in ARRAYS:
                counts.append(ArraysPrinter(member).to_string())
        time_s = step * float(self.value["time_step_s"])
        return f"world at step {step}, t = {time_s:g} s: {', '.join(counts)}"

    def children(self) -> Children:
        for name, member in members(self.value):
            if member.type.strip_typedefs().code in PLAIN or name_of(member.type) == "pogosim::Mailboxes":
                yield name, member


class MailboxesPrinter:
    """How many messages wait and how many were dropped; then the queues that are not empty, by index of the robot."""

    def __init__(self, value: gdb.Value) -> None:
        self.queues = elements(value["queues_"])
        self.dropped = sum(int(dropped) for dropped in elements(value["dropped_"]))

    def to_string(self) -> str:
        waiting = sum(int(queue["waiting"]) for queue in self.queues)
        return f"{len(self.queues)} mailboxes, {waiting} messages, {self.dropped} dropped"

    def children(self) -> Children:
        for robot, queue in enumerate(self.queues):
            if waiting := int(queue["waiting"]):
                yield f"[{robot}]", gdb.Value(waiting)


PLAIN = {gdb.TYPE_CODE_INT, gdb.TYPE_CODE_FLT, gdb.TYPE_CODE_BOOL, gdb.TYPE_CODE_ENUM}
ARRAYS = {"pogosim::Bodies", "pogosim::Robots"}
PRINTERS: dict[str, Callable[[gdb.Value], object]] = {
    "pogosim::Vec2": Vec2Printer,
    "pogosim::Rgb": RgbPrinter,
    "pogosim::Controller": ControllerPrinter,
    "pogosim::World": WorldPrinter,
    "pogosim::Mailboxes": MailboxesPrinter,
    "pogosim::Devices": ArraysPrinter,
    **dict.fromkeys(ARRAYS, ArraysPrinter),
}
LEDS = re.compile(r"std::(\w+::)*array<pogosim::Rgb, ")


def name_of(value_type: gdb.Type) -> str:
    """Name of a type without const, references and aliases."""
    return value_type.unqualified().strip_typedefs().name or ""


def is_vector(value_type: gdb.Type) -> bool:
    """Tell whether a type is a std::vector whose elements have addresses."""
    name = name_of(value_type)
    return re.match(r"std::(\w+::)*vector<(?!bool)", name) is not None


class Printers(gdb.printing.PrettyPrinter):
    """All of them; `info pretty-printer` lists them."""

    def __init__(self) -> None:
        super().__init__("pogosim", [gdb.printing.SubPrettyPrinter(name) for name in [*PRINTERS, "pogosim::Leds"]])

    def __call__(self, value: gdb.Value) -> object | None:
        name = name_of(value.type)
        found = "pogosim::Leds" if LEDS.match(name) else name
        enabled = {printer.name for printer in self.subprinters if printer.enabled}
        if found not in enabled:
            return None
        return LedsPrinter(value) if found == "pogosim::Leds" else PRINTERS[found](value)


def context() -> gdb.Value:
    """Return the context of the selected thread, which names the robot whose program is running."""
    try:
        found = gdb.parse_and_eval("'pogosim::context'")
        world = int(found["world"])
    except gdb.error as problem:
        raise gdb.GdbError(f"There is no running simulation here ({problem}). Stop in a program's function.") from None
    if world == 0:
        raise gdb.GdbError("No robot is running yet. Stop in a program's function: break user_step")
    return found


def index_of(robot: int) -> int:
    """Return the index into World::robots of the robot with this id."""
    ids = elements(context()["world"].dereference()["robots"]["id"])
    for index, robot_id in enumerate(ids):
        if int(robot_id) == robot:
            return index
    raise gdb.GdbError(f"There is no robot #{robot}: ids are {int(min(ids))} to {int(max(ids))}.")


def controller_of(robot: int) -> gdb.Value:
    """Return the controller of the robot with this id: controllers are an array, and the context points into it."""
    found = context()
    running = int(found["robot"])
    if running == NONE:
        raise gdb.GdbError("A callback of the whole run is running. Stop in a robot's function: break user_step")
    return (found["controller"] + (index_of(robot) - running)).dereference()


class World(gdb.Function):
    """$world(): the simulated world."""

    def __init__(self) -> None:
        super().__init__("world")

    def invoke(self) -> gdb.Value:
        return context()["world"].dereference()


class RunningRobot(gdb.Function):
    """$robot(): id of the robot whose program is running, as pogobot_helper_getid() answers. -1: none."""

    # Reads memory only. A call of the program's functions in a condition of a breakpoint is not safe before gdb 15 when
    # there are threads, and Arrow starts one.
    def __init__(self) -> None:
        super().__init__("robot")

    def invoke(self) -> int:
        found = context()
        running = int(found["robot"])
        if running == NONE:
            return -1
        first, _ = vector_range(found["world"]["robots"]["id"])
        return int((first + running).dereference())


class Ticks(gdb.Function):
    """$ticks(): pogobot_ticks of that robot. Conditions may have it before the library is loaded."""

    def __init__(self) -> None:
        super().__init__("ticks")

    def invoke(self) -> gdb.Value:
        context()
        return gdb.parse_and_eval("(unsigned int)pogobot_ticks")


class Controller(gdb.Function):
    """$controller(ID): the controller of a robot. What it keeps while another robot's program runs."""

    def __init__(self) -> None:
        super().__init__("controller")

    def invoke(self, robot: gdb.Value) -> gdb.Value:
        return controller_of(int(robot))


class Device(gdb.Function):
    """$device(ID, "motors"): what World::devices has of a robot, as of its last tick."""

    def __init__(self) -> None:
        super().__init__("device")

    def invoke(self, robot: gdb.Value, name: gdb.Value) -> gdb.Value:
        return elements(context()["world"].dereference()["devices"][name.string()])[index_of(int(robot))]


def user_data_type() -> gdb.Type | None:
    """Return the type of the program's user data: REGISTER_USERDATA leaves a constant of it with every compiler."""
    registered = gdb.lookup_static_symbol("pogo_user_data_type")
    return registered.type.target().unqualified() if registered else None


def registered_type() -> gdb.Type:
    """Return the type of the program's user data."""
    if found := user_data_type():
        return found
    try:
        gdb.parse_and_eval("&REGISTER_USERDATA_once")
    except gdb.error:
        raise gdb.GdbError(
            "The program has no USERDATA. With pogobot.h or robot_memory: own, print the variables of the robot "
            "that runs by their names."
        ) from None
    raise gdb.GdbError("The program has no user data with debug information: compile it with -g.")


class UserData(gdb.Function):
    """$data(ID): the user data of any robot, as *mydata is that of the robot whose program is running."""

    def __init__(self) -> None:
        super().__init__("data")

    def invoke(self, robot: gdb.Value) -> gdb.Value:
        pointer = registered_type().pointer()
        return controller_of(int(robot))["user_data"].cast(pointer).dereference()


class MyData(gdb.Function):
    """$mydata(): the pointer mydata with its type, which debug information of clang does not have."""

    def __init__(self) -> None:
        super().__init__("mydata")

    def invoke(self) -> gdb.Value:
        pointer = registered_type().pointer()
        return gdb.parse_and_eval("&'pogosim_mydata'").cast(pointer.pointer()).dereference()


def is_declared(name: str, kind: gdb.Type) -> bool:
    """Tell whether debug information has the type of a variable. The library itself declares it as a void pointer."""
    declared = gdb.lookup_global_symbol(name)
    return declared is not None and declared.type.strip_typedefs().target().unqualified() == kind


def name_mydata(_: object = None) -> None:
    """Let `mydata` mean the variable with its type. Conditions may have it before the library is loaded."""
    kind = user_data_type()
    if not kind or is_declared("mydata", kind):  # by hand
        gdb.execute("macro undef mydata")
    elif is_declared("pogosim_mydata", kind):  # what DECLARE_USERDATA calls it
        gdb.execute("macro define mydata pogosim_mydata")
    else:
        # Conditions may be read as C, which needs "struct" and has no namespaces, before the program runs.
        name = re.sub(r"^(\w+ )?(.*[:<].*)$", r"'\2'", str(kind))
        gdb.execute(f"macro define mydata (({name}*)$mydata())")


gdb.printing.register_pretty_printer(gdb.current_objfile(), Printers(), replace=True)
for function in (World, RunningRobot, Ticks, Controller, Device, UserData, MyData):
    function()
name_mydata()
gdb.events.new_objfile.connect(name_mydata)
