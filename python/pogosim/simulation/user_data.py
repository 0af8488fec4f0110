"""The type of a program's USERDATA, from its debug information (DWARF), as a NumPy type."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from elftools.common.exceptions import ELFError
from elftools.dwarf.die import DIE
from elftools.elf.elffile import ELFFile

from pogosim.simulation.errors import NoVariableError, SimulationError

# DWARF, version 5, 7.8: encodings of base types.
BOOLEAN, FLOAT, SIGNED, SIGNED_CHAR, UNSIGNED, UNSIGNED_CHAR = 0x02, 0x04, 0x05, 0x06, 0x07, 0x08
KINDS = {BOOLEAN: "b", FLOAT: "f", SIGNED: "i", SIGNED_CHAR: "i", UNSIGNED: "u", UNSIGNED_CHAR: "u"}
WRAPPERS = ("DW_TAG_typedef", "DW_TAG_const_type", "DW_TAG_volatile_type", "DW_TAG_atomic_type")
STRUCTURES = ("DW_TAG_structure_type", "DW_TAG_class_type")


def attribute(entry: DIE, name: str) -> Any:
    """Return the value of an attribute; None if there is none."""
    found = entry.attributes.get(f"DW_AT_{name}")
    return found.value if found else None


def type_behind(entry: DIE) -> DIE:
    """Return the type that an entry refers to, without typedefs and qualifiers."""
    behind = entry.get_DIE_from_attribute("DW_AT_type")
    while behind.tag in WRAPPERS:
        behind = behind.get_DIE_from_attribute("DW_AT_type")
    return behind


def array_type(entry: DIE) -> np.dtype[Any]:
    """Return the type of a C array, of one dimension or more."""
    shape = []
    for child in entry.iter_children():
        if child.tag == "DW_TAG_subrange_type":
            count, bound = attribute(child, "count"), attribute(child, "upper_bound")
            shape.append(count if count is not None else (bound + 1 if isinstance(bound, int) else 0))
    return np.dtype((numpy_type(type_behind(entry)), tuple(shape)))


class Member(NamedTuple):
    """A member of a structure."""

    name: str
    type: np.dtype[Any]
    offset: int


def is_part(entry: DIE) -> bool:
    """Return whether an entry is a member in the memory of an object, or a base class."""
    is_data = entry.tag in ("DW_TAG_member", "DW_TAG_inheritance")
    return is_data and not any(attribute(entry, name) for name in ("external", "declaration", "artificial", "bit_size"))


def members_of(entry: DIE) -> list[Member]:
    """Return the members of a struct, class or union, except bit-fields.

    Those of base classes and of structures without a name count as its own. One of a base class with the name of
    another member begins with the name of its class, "Base::id".
    """
    parts = [child for child in entry.iter_children() if is_part(child)]
    names = {attribute(part, "name") for part in parts}
    members: list[Member] = []
    for part in parts:
        offset = attribute(part, "data_member_location")
        if offset is None and entry.tag == "DW_TAG_union_type":
            offset = 0
        if not isinstance(offset, int):
            continue  # a virtual base class: its place is known at run time
        kind = type_behind(part)
        if name := attribute(part, "name"):
            members.append(Member(name.decode(), numpy_type(kind), offset))
            continue
        for inner in members_of(kind):
            is_hidden = inner.name.encode() in names
            full_name = f"{(attribute(kind, 'name') or b'').decode()}::{inner.name}" if is_hidden else inner.name
            names.add(inner.name.encode())
            members.append(Member(full_name, inner.type, offset + inner.offset))
    return members


def structure_type(entry: DIE) -> np.dtype[Any]:
    """Return the type of a struct or class: of std::array that of its only member, of other library classes bytes."""
    members = members_of(entry)
    size = attribute(entry, "byte_size")
    if any(member.name.startswith(("_M_", "__")) for member in members):
        is_array = len(members) == 1 and members[0].type.subdtype is not None
        return members[0].type if is_array else np.dtype(f"V{size}")
    return np.dtype(
        {
            "names": [member.name for member in members],
            "formats": [member.type for member in members],
            "offsets": [member.offset for member in members],
            "itemsize": size,
        }
    )


def numpy_type(entry: DIE) -> np.dtype[Any]:
    """Return the NumPy type of a C type. Pointers are unsigned integers; what has no NumPy type is raw bytes."""
    size = attribute(entry, "byte_size")
    if entry.tag in STRUCTURES:
        return structure_type(entry)
    if entry.tag == "DW_TAG_array_type":
        return array_type(entry)
    if entry.tag == "DW_TAG_enumeration_type":
        return np.dtype(f"u{size}" if "DW_AT_type" not in entry.attributes else numpy_type(type_behind(entry)))
    if entry.tag in ("DW_TAG_pointer_type", "DW_TAG_reference_type"):
        return np.dtype(f"u{size or 8}")
    kind = KINDS.get(attribute(entry, "encoding"))
    if entry.tag == "DW_TAG_base_type" and kind is not None and size <= 8:
        return np.dtype(bool if kind == "b" and size == 1 else f"{kind}{size}")
    return np.dtype(f"V{size or 0}")


def declared_user_data(file: ELFFile) -> DIE | None:
    """Return the type that REGISTER_USERDATA of a program names; None if no unit of it says so."""
    for unit in file.get_dwarf_info().iter_CUs():
        for entry in unit.get_top_DIE().iter_children():
            if entry.tag == "DW_TAG_variable" and attribute(entry, "name") == b"pogo_user_data_type":
                pointer = type_behind(entry)
                if "DW_AT_type" in pointer.attributes:
                    return type_behind(pointer)
    return None


@functools.lru_cache(maxsize=64)
def type_in(program: Path, version: tuple[int, ...]) -> np.dtype[Any] | None:  # noqa: ARG001 -- for the cache
    """Return the type of USERDATA as a file has it; None if it does not say.

    Reading it takes ten times as long as beginning a run, so it is read once for each version of the file.
    """
    with program.open("rb") as stream:
        file = ELFFile(stream)
        entry = declared_user_data(file) if file.has_dwarf_info() else None
        return numpy_type(entry) if entry is not None else None


def user_data_type(program: Path, size_bytes: int) -> np.dtype[Any]:
    """Return the type of one robot's USERDATA.

    Args:
        program: Shared object with debug information (compiled with `-g`, as `make sim` does).
        size_bytes: What the simulator says of its size.

    Raises:
        NoVariableError: The program has no user data.
        SimulationError: It has no debug information about them.
    """
    if size_bytes == 0:
        raise NoVariableError(f"{program} has no user data (REGISTER_USERDATA); use columns of the data file")
    try:
        status = program.stat()
        found = type_in(program, (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns))
    except (OSError, ELFError) as error:
        raise SimulationError(f"{program} cannot be read: {error}") from None
    if found is None:
        raise SimulationError(f"{program} has no debug information about USERDATA: compile it with -g")
    if found.itemsize != size_bytes:
        raise SimulationError(f"{program} has been built again since this run began: reset it")
    return found
