"""Firmware: the machine code of robots' programs, which the simulator runs on emulated processors."""

from __future__ import annotations

from pathlib import Path

_MAGIC = b"\x7fELF"
_MACHINE = 18  # its place in the header
_RISC_V = 243


def is_firmware(file: Path) -> bool:
    """Tell whether a file is an ELF file for RISC-V. What else is wrong with it, the simulator says.

    Raises:
        OSError: The file cannot be read.
    """
    if not file.is_file():
        return False
    with file.open("rb") as stream:
        header = stream.read(_MACHINE + 2)
    return header.startswith(_MAGIC) and header[_MACHINE : _MACHINE + 1] == bytes([_RISC_V])
