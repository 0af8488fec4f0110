"""The variables of a firmware: where they are in a robot's memory, and their types, from debug information (DWARF)."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from elftools.common.exceptions import ELFError
from elftools.dwarf.die import DIE
from elftools.elf.elffile import ELFFile

from pogosim.simulation.errors import SimulationError
from pogosim.simulation.user_data import attribute, numpy_type, type_behind

USER_DATA = "mydata"
USER_DATA_OF_ROBOTS = "myuserdata"  # what `mydata` of programs is on robots
_AT_ADDRESS = 0x03  # DW_OP_addr
_POINTER_BYTES = 4


class Variable(NamedTuple):
    """A variable at an address that is the same for the whole run."""

    address: int
    type: np.dtype[Any]

    def values(self, memory: npt.NDArray[np.uint8]) -> npt.NDArray[Any]:
        """Return its values. `memory`: its bytes in each robot, shape (robots, size)."""
        base, shape = self.type.subdtype or (self.type, ())
        return np.ascontiguousarray(memory).view(base).reshape(len(memory), *shape)


def _address(entry: DIE) -> int | None:
    location = attribute(entry, "location")
    is_one_place = isinstance(location, list) and len(location) == 1 + _POINTER_BYTES and location[0] == _AT_ADDRESS
    return int.from_bytes(bytes(location[1:]), "little") if is_one_place else None


def _declaration(entry: DIE) -> DIE:
    """Return the entry that has a variable's name and type, which may be another one."""
    while "DW_AT_name" not in entry.attributes and (
        reference := next(
            (name for name in ("DW_AT_specification", "DW_AT_abstract_origin") if name in entry.attributes), ""
        )
    ):
        entry = entry.get_DIE_from_attribute(reference)
    return entry


def _variables_below(entry: DIE) -> Iterator[DIE]:
    for child in entry.iter_children():
        if child.tag == "DW_TAG_variable":
            yield child
        elif child.tag in ("DW_TAG_subprogram", "DW_TAG_lexical_block", "DW_TAG_namespace"):
            yield from _variables_below(child)


def _read(file: Path) -> dict[str, Variable]:
    variables: dict[str, Variable] = {}
    with file.open("rb") as stream:
        elf = ELFFile(stream)
        if not elf.has_dwarf_info():
            return {}
        for unit in elf.get_dwarf_info().iter_CUs():
            for entry in _variables_below(unit.get_top_DIE()):
                address, declared = _address(entry), _declaration(entry)
                name = (attribute(declared, "name") or b"").decode(errors="replace")
                # The linker gives variables that it has left out the address 0, where the program begins.
                if address and name and "DW_AT_type" in declared.attributes:
                    shown = USER_DATA if name == USER_DATA_OF_ROBOTS else name
                    variables.setdefault(shown, Variable(address, numpy_type(type_behind(declared))))
    return variables


@functools.lru_cache(maxsize=16)
def _of_version(file: Path, version: tuple[int, ...]) -> dict[str, Variable]:  # noqa: ARG001 -- for the cache
    return _read(file)


def variables_of(file: Path) -> dict[str, Variable]:
    """Return the variables of a firmware by name; `mydata` is USERDATA. If several have a name, it is the first one.

    Raises:
        SimulationError: The file cannot be read, or has no debug information.
    """
    try:
        status = file.stat()
        found = _of_version(file, (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns))
    except (OSError, ELFError) as error:
        raise SimulationError(f"{file} cannot be read: {error}") from None
    except (RecursionError, ValueError, KeyError, AttributeError):  # of a reader that meets what no compiler writes
        raise SimulationError(f"{file} has damaged debug information: compile it again") from None
    if not found:
        raise SimulationError(f"{file} has no debug information: compile it with -g")
    return found
