"""Looks at the files that scripts/check_macos.sh has built, of which none can be run on Linux.

    PYTHONPATH=scripts python -m cross.check_mach_o macos-arm64 FILES

Each file must be for the processor and the version of macOS. The libraries that it names must be there, or the
system's; what it takes from our libraries must be in them; and names of C++ must not be shown.
"""

from __future__ import annotations

import argparse
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

# <mach-o/loader.h> and <mach-o/nlist.h>
MAGIC, UNIVERSAL = 0xFEEDFACF, 0xCAFEBABE
PROCESSORS = {"macos-x86_64": 0x01000007, "macos-arm64": 0x0100000C}
SYMBOLS, NAME, RPATH, LEAST_MACOS, BUILD_VERSION = 0x2, 0xD, 0x8000001C, 0x24, 0x32
LIBRARIES = {0xC, 0x80000018, 0x8000001F, 0x20, 0x80000023}
OF_DEBUGGER, WHERE, IN_SECTION, ABSOLUTE, EXTERNAL, PRIVATE = 0xE0, 0x0E, 0x0E, 0x02, 0x01, 0x10
OLDEST_MACOS = (12, 0)
SYSTEM = ("/usr/lib/", "/System/Library/")


class MachO(NamedTuple):
    """What a file says."""

    name: str
    macos: tuple[int, int]
    libraries: list[str]
    rpaths: list[str]
    shown: set[str]
    used: list[tuple[str, str]]  # a symbol, and the library it is from


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


def problems_of(path: Path, file: MachO, others: dict[str, MachO]) -> Iterator[str]:
    """Yield what is wrong with a file. `others`: all files, by file name."""
    if file.macos < (11, 0) or file.macos > OLDEST_MACOS:
        yield f"it is for macOS {file.macos[0]}.{file.macos[1]} and later, expected 11 or {OLDEST_MACOS[0]}"
    if file.name and not file.name.startswith("@rpath/"):
        yield f"it is looked for as {file.name}, expected @rpath/..."
    for library in file.libraries:
        if not library.startswith(SYSTEM) and Path(library).name not in others:
            yield f"it needs {library}, which is neither the system's nor there"
        if library.startswith("@rpath/") and not file.rpaths and "/Frameworks/" not in library:
            yield f"it needs {library}, and has no rpath"
    for symbol, library in file.used:
        there = others.get(Path(library).name)
        if library == "":
            yield f"it uses {symbol} of no library"
        elif there is not None and symbol not in there.shown:
            yield f"it uses {symbol}, which {library} does not have"
    if path.name.startswith("libpogosim."):
        for symbol in sorted(symbol for symbol in file.shown if symbol.startswith("__Z")):
            yield f"it shows {symbol}"


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="Looks at files that were built for macOS.")
    parser.add_argument("target", choices=PROCESSORS, help="the machine")
    parser.add_argument("--with", dest="others", type=Path, nargs="*", default=[], help="libraries that they may need")
    parser.add_argument("files", type=Path, nargs="+", help="what to look at")
    options = parser.parse_args()
    processor = PROCESSORS[options.target]
    files = {}
    for path in [*options.others, *options.files]:
        try:
            files[path] = read(path, processor)
        except (ValueError, struct.error) as error:
            raise SystemExit(f"check_mach_o.py: {path}: {error}") from None
    others = {Path(file.name or path).name: file for path, file in files.items()}
    failed = 0
    for path in options.files:
        problems = list(problems_of(path, files[path], others))
        failed += len(problems)
        print(f"{path}: {'; '.join(problems[:20]) or 'as expected'}")
    raise SystemExit(1 if failed else 0)


if __name__ == "__main__":
    main()
