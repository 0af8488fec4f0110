"""Writes what zig links to in place of macOS's C++ library, which it has not.

zig has a newer one of its own, and would put a copy of it into each file that it links. A program's exceptions would
then be others than ours, and each copy would count its own. So we link to /usr/lib/libc++.1.dylib, as Apple's compiler
does, by a text that lists what it offers (.tbd, of which Apple's kits consist too).

What it has on the oldest macOS that our wheels are for is known from pyarrow's wheel for that system: the symbols that
its files take from it. libcpp_symbols.txt has what ours need beyond them. When the linker does not find another one, it
may be added if that macOS has it, or else the code has to do without.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from cross.mach_o import PROCESSORS, read

LIBRARY = "/usr/lib/libc++.1.dylib"
STUB = "libc++.1.tbd"
ALSO = Path(__file__).with_name("libcpp_symbols.txt")


def offered(target: str, files: Iterable[Path]) -> set[str]:
    """Return the symbols that some files for a target take from macOS's C++ library, and those of `ALSO`."""
    lines = ALSO.read_text(encoding="utf-8").splitlines()
    symbols = {line for line in lines if line and not line.startswith("#")}
    for path in files:
        symbols |= {symbol for symbol, library in read(path, PROCESSORS[target]).used if library == LIBRARY}
    return symbols


def write_stub(target: str, pyarrow: Path, folder: Path) -> None:
    """Write the stub into a folder.

    Args:
        target: of `PROCESSORS`.
        pyarrow: folder of that package for it.
        folder: where to write.
    """
    machine = f"{target.removeprefix('macos-')}-macos"
    files = sorted(path for path in pyarrow.rglob("*") if path.suffix in (".dylib", ".so"))
    symbols = ", ".join(f"'{symbol}'" for symbol in sorted(offered(target, files)))
    (folder / STUB).write_text(
        f"""--- !tapi-tbd
tbd-version: 4
targets: [ {machine} ]
install-name: '{LIBRARY}'
exports:
  - targets: [ {machine} ]
    symbols: [ {symbols} ]
...
""",
        encoding="utf-8",
    )
