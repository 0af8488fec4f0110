"""Reads what programs and libraries of macOS say about themselves: Mach-O files for 64-bit processors."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

# <mach-o/loader.h> and <mach-o/nlist.h>
MAGIC, UNIVERSAL = 0xFEEDFACF, 0xCAFEBABE
PROCESSORS = {"macos-x86_64": 0x01000007, "macos-arm64": 0x0100000C}
SYMBOLS, NAME, RPATH, LEAST_MACOS, BUILD_VERSION = 0x2, 0xD, 0x8000001C, 0x24, 0x32
SIGNATURE = 0x1D
LIBRARIES = {0xC, 0x80000018, 0x8000001F, 0x20, 0x80000023}
OF_DEBUGGER, WHERE, IN_SECTION, ABSOLUTE, EXTERNAL, PRIVATE = 0xE0, 0x0E, 0x0E, 0x02, 0x01, 0x10


class MachO(NamedTuple):
    """What a file says."""

    name: str
    macos: tuple[int, int]
    libraries: list[str]
    rpaths: list[str]
    shown: set[str]
    used: list[tuple[str, str]]  # a symbol, and the library it is from
    is_signed: bool = False


def part_for(content: bytes, processor: int) -> bytes:
    """Return the file for a processor; raises ValueError if there is none."""
    if struct.unpack_from(">I", content)[0] == UNIVERSAL:
        (count,) = struct.unpack_from(">I", content, 4)
        for i in range(count):
            kind, _, offset, size, _ = struct.unpack_from(">5I", content, 8 + 20 * i)
            if kind == processor:
                return content[offset : offset + size]
    elif struct.unpack_from("<2I", content) == (MAGIC, processor):
        return content
    raise ValueError("it is no file of macOS for this processor")


def text_at(content: bytes, place: int) -> str:
    """Return a text that ends with a zero."""
    return content[place : content.index(b"\0", place)].decode()


def commands(content: bytes) -> Iterator[tuple[int, int]]:
    """Yield the kind and the place of each load command."""
    place = 32
    for _ in range(struct.unpack_from("<I", content, 16)[0]):
        kind, size = struct.unpack_from("<2I", content, place)
        yield kind, place
        place += size


def read(path: Path, processor: int) -> MachO:
    """Read a file; raises ValueError if it is none for this processor."""
    content = part_for(path.read_bytes(), processor)
    found = MachO("", (0, 0), [], [], set(), [])
    symbols = (0, 0, 0)
    for kind, place in commands(content):
        if kind in LIBRARIES:
            found.libraries.append(text_at(content, place + struct.unpack_from("<I", content, place + 8)[0]))
        elif kind == NAME:
            found = found._replace(name=text_at(content, place + struct.unpack_from("<I", content, place + 8)[0]))
        elif kind == RPATH:
            found.rpaths.append(text_at(content, place + struct.unpack_from("<I", content, place + 8)[0]))
        elif kind in (LEAST_MACOS, BUILD_VERSION):
            (version,) = struct.unpack_from("<I", content, place + (8 if kind == LEAST_MACOS else 12))
            found = found._replace(macos=(version >> 16, version >> 8 & 0xFF))
        elif kind == SIGNATURE:
            found = found._replace(is_signed=True)
        elif kind == SYMBOLS:
            symbols = struct.unpack_from("<3I", content, place + 8)
    table, count, names = symbols
    for i in range(count):
        name, kind, _, description, _ = struct.unpack_from("<IBBHQ", content, table + 16 * i)
        if kind & OF_DEBUGGER or not kind & EXTERNAL:
            continue
        symbol = text_at(content, names + name)
        if kind & WHERE in (IN_SECTION, ABSOLUTE):
            if not kind & PRIVATE:
                found.shown.add(symbol)
        elif 0 < description >> 8 <= len(found.libraries):
            found.used.append((symbol, found.libraries[(description >> 8) - 1]))
        else:
            found.used.append((symbol, ""))
    return found
