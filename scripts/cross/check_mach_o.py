"""Looks at files that were built for macOS, of which none can be run on Linux.

    python scripts/cross/check_mach_o.py macos-arm64 FILES --with LIBRARIES

Each file must be for the processor and the version of macOS, and for arm64 signed. The libraries that it names must be
there, or the system's; what it takes from our libraries must be in them; and names of our C++ must not be shown.
make_wheel.py looks at the files of a wheel so, which moreover must work in any folder.
"""

from __future__ import annotations

import argparse
import struct
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

if not __package__:  # called by its path
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from cross.mach_o import PROCESSORS, MachO, read
from cross.system_libcpp import LIBRARY as LIBCPP

OLDEST_MACOS = (12, 0)
SYSTEM = ("/usr/lib/", "/System/Library/")
BESIDE = ("@loader_path/", "@executable_path/")
MOST_SHOWN = 20


def problems_of(target: str, path: Path, file: MachO, others: dict[str, MachO], movable: bool = False) -> Iterator[str]:
    """Yield what is wrong with a file.

    Args:
        target: of `PROCESSORS`.
        path: its path.
        file: what it says.
        others: all files, by file name.
        movable: whether it must work in any folder.
    """
    if file.macos < (11, 0) or file.macos > OLDEST_MACOS:
        yield f"it is for macOS {file.macos[0]}.{file.macos[1]} and later, expected 11 or {OLDEST_MACOS[0]}"
    if target == "macos-arm64" and not file.is_signed:
        yield "it is not signed, and Macs with Apple silicon load no such file"
    # Programs are linked with libraries, and load the shared objects of other programs by their paths.
    if path.suffix == ".dylib" and not file.name.startswith("@rpath/"):
        yield f"it is looked for as '{file.name}', expected @rpath/..."
    for rpath in file.rpaths:
        if movable and not (rpath + "/").startswith(BESIDE):
            yield f"it looks for libraries in {rpath}, expected @loader_path/..."
    for library in file.libraries:
        if not library.startswith(SYSTEM) and Path(library).name not in others:
            yield f"it needs {library}, which is neither the system's nor there"
        if library.startswith("@rpath/") and not file.rpaths:
            yield f"it needs {library}, and has no rpath"
    for symbol, library in file.used:
        there = others.get(Path(library).name)
        if library == "":
            yield f"it uses {symbol} of no library"
        elif there is not None and symbol not in there.shown:
            yield f"it uses {symbol}, which {library} does not have"
    if path.name.startswith("libpogosim"):
        if LIBCPP not in file.libraries:
            yield f"it does not use {LIBCPP}, so exceptions would be of two kinds"
        # Templates of Arrow's headers are shown; such symbols of several libraries are one at run time.
        for symbol in sorted(symbol for symbol in file.shown if symbol.startswith("__Z") and "pogosim" in symbol):
            yield f"it shows {symbol}"


def check(target: str, files: Iterable[Path], libraries: Iterable[Path], movable: bool = False) -> bool:
    """Print what is wrong with files, and return whether all are as expected; ends the program if one is no such file.

    Args:
        target: of `PROCESSORS`.
        files: what to look at.
        libraries: others that they may need, beside each other and the system's.
        movable: whether they must work in any folder.
    """
    files, read_files = list(files), {}
    for path in [*libraries, *files]:
        try:
            read_files[path] = read(path, PROCESSORS[target])
        except (ValueError, struct.error) as error:
            raise SystemExit(f"check_mach_o.py: {path}: {error}") from None
    others = {Path(file.name or path).name: file for path, file in read_files.items()}
    are_as_expected = True
    for path in files:
        problems = list(problems_of(target, path, read_files[path], others, movable))
        are_as_expected &= not problems
        more = [f"{len(problems) - MOST_SHOWN} more"] if len(problems) > MOST_SHOWN else []
        print(f"{path}: {'; '.join([*problems[:MOST_SHOWN], *more]) or 'as expected'}")
    return are_as_expected


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(
        description="Says of files that were built for macOS whether a Mac would load them: processor, version, "
        "signature, libraries and symbols. Exit code 1 if not.",
        epilog="example: python scripts/cross/check_mach_o.py macos-arm64 first/first --with lib/libpogosim.dylib",
    )
    parser.add_argument("target", choices=PROCESSORS, help="the machine")
    parser.add_argument(
        "--with", dest="libraries", type=Path, nargs="*", default=[], help="libraries that they may need"
    )
    parser.add_argument("--movable", action="store_true", help="they must work in any folder")
    parser.add_argument("files", type=Path, nargs="+", help="what to look at")
    options = parser.parse_args()
    raise SystemExit(0 if check(options.target, options.files, options.libraries, options.movable) else 1)


if __name__ == "__main__":
    main()
