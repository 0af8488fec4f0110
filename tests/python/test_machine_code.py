"""Machine code tells which machine it is for."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

import pytest
from pogosim.machine_code import LONGEST, machine_of, machine_of_file, of_another_machine, runs_here, this_machine


def elf(processor: int, order: str = "<") -> bytes:
    """Return the beginning of a program of Linux."""
    return b"\x7fELF\x02" + bytes([1 if order == "<" else 2]) + bytes(10) + struct.pack(f"{order}2H", 2, processor)


@pytest.mark.parametrize(
    ("beginning", "machine"),
    [
        (elf(62), "Linux on x86-64"),
        (elf(183), "Linux on ARM64"),
        (elf(243), "Linux on RISC-V"),
        (elf(22, ">"), "Linux on another processor"),
        (struct.pack("<2I", 0xFEEDFACF, 0x0100000C) + bytes(12), "macOS on ARM64"),
        (struct.pack("<2I", 0xFEEDFACF, 0x01000007) + bytes(12), "macOS on x86-64"),
        (b"\xca\xfe\xba\xbe" + bytes(16), "macOS"),
        (b"MZ" + bytes(18), "Windows"),
        (b"\0asm" + bytes(16), "WebAssembly"),
        (b"#!/bin/sh\n" + bytes(10), None),
        (b"\x7fELF", None),
        (b"", None),
    ],
)
def test_the_first_bytes_say_the_machine(beginning: bytes, machine: str | None) -> None:
    assert len(beginning) <= LONGEST
    assert machine_of(beginning) == machine


@pytest.mark.parametrize(
    ("machine", "here", "runs"),
    [
        ("Linux on x86-64", "Linux on x86-64", True),
        ("Linux on x86", "Linux on x86-64", True),
        ("Linux on x86-64", "Linux on ARM64", False),
        ("Linux on ARM64", "Linux on x86-64", False),
        ("macOS on ARM64", "Linux on ARM64", False),
        ("macOS on x86-64", "macOS on ARM64", True),
        ("macOS", "macOS on ARM64", True),
        ("Linux on ARM64", "macOS on ARM64", False),
        ("Windows", "Linux on x86-64", False),
    ],
)
def test_programs_run_on_their_machines(machine: str, here: str, runs: bool) -> None:
    assert runs_here(machine, here) == runs


def test_programs_of_this_machine_are_for_it() -> None:
    program = Path(sys.executable)
    machine = machine_of_file(program)
    assert machine is not None
    assert runs_here(machine, this_machine())
    assert of_another_machine(program) is None
