"""Which machine a program or a shared object is for, as its first bytes say."""

from __future__ import annotations

import platform
import struct
from pathlib import Path

# <elf.h>, <mach-o/loader.h>. Universal files of macOS are for several processors.
OF_ELF = {3: "x86", 40: "ARM", 62: "x86-64", 183: "ARM64", 243: "RISC-V"}
OF_MACH_O = {0x01000007: "x86-64", 0x0100000C: "ARM64"}
ELF, MACH_O, UNIVERSAL = b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe"
OTHERS = {UNIVERSAL: "macOS", b"MZ": "Windows", b"\0asm": "WebAssembly"}
LONGEST = 20  # bytes that are looked at
# Processors that run programs of others, too.
ALSO = {"x86-64": "x86", "ARM64": "ARM"}


def machine_of(beginning: bytes) -> str | None:
    """Return the machine that a file is for, such as "macOS on ARM64"; None if it is no machine code.

    Args:
        beginning: Its first bytes, `LONGEST` or more.
    """
    if beginning.startswith(ELF) and len(beginning) >= LONGEST:
        order = ">" if beginning[5] == 2 else "<"
        (processor,) = struct.unpack_from(f"{order}H", beginning, 18)
        return f"Linux on {OF_ELF.get(processor, 'another processor')}"
    if beginning.startswith(MACH_O) and len(beginning) >= LONGEST:
        (processor,) = struct.unpack_from("<I", beginning, 4)
        return f"macOS on {OF_MACH_O.get(processor, 'another processor')}"
    return next((name for magic, name in OTHERS.items() if beginning.startswith(magic)), None)


def machine_of_file(path: Path) -> str | None:
    """Return the same of a file.

    Raises:
        OSError: It cannot be read.
    """
    with path.open("rb") as file:
        return machine_of(file.read(LONGEST))


def this_machine() -> str:
    """Return the same of this machine."""
    system, processor = platform.system(), platform.machine().lower()
    names = {"x86_64": "x86-64", "amd64": "x86-64", "aarch64": "ARM64", "arm64": "ARM64"}
    return f"{'macOS' if system == 'Darwin' else system} on {names.get(processor, processor)}"


def runs_here(machine: str, here: str) -> bool:
    """Tell whether files for a machine may run on another one.

    Macs translate each other's programs, and a universal file may be for this one.
    """
    system, _, processor = here.partition(" on ")
    if system == "macOS":
        return machine.startswith("macOS")
    return machine in (here, f"{system} on {ALSO.get(processor, processor)}")


def of_another_machine(path: Path) -> str | None:
    """Return what is said of a file for another machine; None if it may be for this one, or is no machine code.

    Raises:
        OSError: It cannot be read.
    """
    machine, here = machine_of_file(path), this_machine()
    if machine is None or runs_here(machine, here):
        return None
    return f"{path} is for {machine}, and this is {here}: compile it here (make sim)"
