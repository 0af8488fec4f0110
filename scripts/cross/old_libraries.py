"""Makes what a compiler of today links against to get programs that run with C and C++ libraries of years ago.

    python scripts/cross/old_libraries.py FOLDER                                       # for this machine
    python scripts/cross/old_libraries.py FOLDER --compiler aarch64-linux-gnu-g++      # for another one

A program asks for each function of the C library by a version, that of the library that was there when it was linked,
and does not start with an older library. In FOLDER, a compiler that is called with `-L FOLDER` finds, in place of its
own:

- the C library with those functions and versions only that were there in glibc 2.27 (2018). It is a list of names,
  without code: a program that runs meets the library of its machine;
- the parts of the C library until glibc 2.34, libpthread.so.0 and others, with their functions (former_parts.txt):
  before glibc 2.30, a program that asks libc.so.6 for one of them does not start;
- the C++ library of gcc 8, in the same way; what our code needs of newer ones comes from the compiler's static library
  and becomes part of the program. Compilers for old distributions do the same (Red Hat's gcc-toolset);
- newer_functions.c and start_of_executable.c, the little of newer C libraries that is needed all the same.

The libraries that are read are those of the compiler itself, which must be gcc.
"""

from __future__ import annotations

import argparse
import re
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from elftools.elf.elffile import ELFFile

# The newest version of each series that programs may ask for.
NEWEST = {"GLIBC": (2, 27), "GLIBCXX": (3, 4, 25), "CXXABI": (1, 3, 11), "GCC": (7, 0, 0)}
STUBS = ("libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1")
# What the compiler finds first, and links to the libraries above.
SCRIPTS = ("libc.so", "libm.so", "libstdc++.so", "libgcc_s.so")
# Kinds of variables in libraries: their kinds in assembly language, and the sections that they are in.
VARIABLES = {"STT_OBJECT": ("object", ".bss"), "STT_TLS": ("tls_object", '.tbss, "awT", %nobits')}


def fail(message: str, before: str = "") -> NoReturn:
    """End the program with exit code 2 and one line, after what another program has said."""
    sys.stderr.write(f"{before}old_libraries.py: {message}\n")
    raise SystemExit(2) from None


def former_parts() -> dict[str, list[str]]:
    """Return the functions of each former part of the C library, by the name of its file."""
    lines = Path(__file__).with_name("former_parts.txt").read_text(encoding="utf-8").splitlines()
    words = " ".join(line for line in lines if not line.startswith("#")).split()
    parts: dict[str, list[str]] = {}
    for word in words:
        if word.endswith(":"):
            names = parts.setdefault(word.rstrip(":"), [])
        else:
            names.append(word)
    return parts


class Symbol(NamedTuple):
    """A function or variable that a library exports."""

    name: str
    version: str
    kind: str  # "STT_FUNC", "STT_OBJECT", ..., as in its library
    size: int  # in bytes


def version_number(version: str) -> tuple[str, tuple[int, ...]]:
    """Return the series of a version and its number: ("GLIBC", (2, 17)); no number for other names."""
    series, _, number = version.partition("_")
    return series, tuple(map(int, number.split("."))) if re.fullmatch(r"\d+(\.\d+)*", number) else ()


def is_old(version: str) -> bool:
    """Tell whether a program may ask for this version."""
    series, number = version_number(version)
    return number != () and series in NEWEST and number <= NEWEST[series]


def exported(library: Path) -> list[Symbol]:
    """Return what a library exports, with the newest version of each name that programs may ask for."""
    newest: dict[str, Symbol] = {}
    with library.open("rb") as file:
        elf = ELFFile(file)
        symbols: Any = elf.get_section_by_name(".dynsym")
        versions: Any = elf.get_section_by_name(".gnu.version")
        definitions: Any = elf.get_section_by_name(".gnu.version_d")
        names = {entry["vd_ndx"]: next(auxiliaries).name for entry, auxiliaries in definitions.iter_versions()}
        for index, symbol in enumerate(symbols.iter_symbols()):
            number = versions.get_symbol(index)["ndx"]
            version = names.get(number & 0x7FFF, "") if isinstance(number, int) else ""
            if symbol["st_shndx"] in ("SHN_UNDEF", "SHN_ABS") or not is_old(version):
                continue
            found = Symbol(symbol.name, version, symbol["st_info"]["type"], symbol["st_size"])
            known = newest.get(found.name)
            if known is None or version_number(known.version) < version_number(version):
                newest[found.name] = found
    return sorted(newest.values())


def assembly(symbols: list[Symbol]) -> str:
    """Return a program in assembly language that defines these symbols, and nothing else."""
    lines = []
    for index, symbol in enumerate(symbols):
        label = f"pogosim_stub_{index}"
        kind, section = VARIABLES.get(symbol.kind, ("function", ".text"))
        lines += [
            f".section {section}",
            f".globl {label}",
            f".type {label}, %{kind}",
            f".symver {label}, {symbol.name}@@{symbol.version}",
            f"{label}: .zero {max(symbol.size, 4)}",
            f".size {label}, {max(symbol.size, 4)}",
        ]
    return "\n".join([*lines, '.section .note.GNU-stack, "", %progbits', ""])


def version_script(symbols: list[Symbol]) -> str:
    """Return the script that tells the linker which versions there are."""
    versions = sorted({symbol.version for symbol in symbols}, key=version_number)
    return "".join(f"{version} {{ }};\n" for version in versions) + "OTHERS { local: *; };\n"


class Compiler:
    """A compiler of C++, gcc's."""

    def __init__(self, command: str) -> None:
        try:
            self.command = shlex.split(command)
        except ValueError as error:
            fail(f"the compiler {command!r} is no command line: {error}")
        if "clang" in command or not command.strip():
            fail(f"the compiler is {command!r}; expected a gcc, such as aarch64-linux-gnu-g++")

    def output(self, words: Sequence[str | Path]) -> str:
        """Return what a command prints; ends the program in one line if it fails or is not there."""
        try:
            result = subprocess.run(words, capture_output=True, text=True, check=False)
        except OSError as error:
            fail(f"cannot run {words[0]!r}: {error.strerror}")
        if result.returncode != 0:
            fail(f"{' '.join(map(str, words))} failed, see above", result.stderr)
        return result.stdout.strip()

    def run(self, *words: str | Path) -> str:
        """Run it, and return what it prints; ends the program in one line if it fails."""
        return self.output([*self.command, *words])

    def file(self, name: str) -> Path:
        """Return the path of one of its libraries; ends the program if it has none."""
        path = Path(self.run(f"-print-file-name={name}"))
        if not path.is_absolute():
            fail(f"{' '.join(self.command)} has no {name}; expected a gcc with its libraries")
        return path.resolve()


def make_stub(folder: Path, name: str, symbols: list[Symbol], compiler: Compiler) -> None:
    """Make a library FOLDER/stubs/NAME that exports these symbols and has no code."""
    stubs = folder / "stubs"
    stubs.mkdir(parents=True, exist_ok=True)
    source, script = stubs / f"{name}.s", stubs / f"{name}.map"
    source.write_text(assembly(symbols), encoding="utf-8")
    script.write_text(version_script(symbols), encoding="utf-8")
    options = ["-nostdlib", "-shared", f"-Wl,-soname,{name}", f"-Wl,--version-script,{script}"]
    compiler.run(*options, source, "-o", stubs / name)


def make_newer_functions(folder: Path, compiler: Compiler) -> Path:
    """Make a static library of what the old ones lack, and return it."""
    library = folder / "libnewer_functions.a"
    library.unlink(missing_ok=True)
    for name in ("newer_functions", "start_of_executable"):
        source, code = Path(__file__).with_name(f"{name}.c"), folder / f"{name}.o"
        compiler.run("-x", "c", "-O2", "-fPIC", "-Wall", "-Wextra", "-Werror", "-c", source, "-o", code)
        compiler.output([compiler.run("-print-prog-name=ar"), "rc", library, code])
    return library


def make_old_libraries(folder: Path, command: str) -> None:
    """Make all libraries in a folder, for a compiler given as the words of a command line.

    Ends the program in one line if the compiler is none, or the folder cannot be made. The linker scripts, by which the
    linker finds the others, come last: half a folder offers nothing.
    """
    if refused := sorted(set(str(folder)) & set('",')):
        fail(f"the path {folder} has {' and '.join(refused)} in it, which linkers cannot take")
    compiler = Compiler(command)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        fail(f"cannot make the folder {folder}: {error.strerror}")
    for script in SCRIPTS:
        (folder / script).unlink(missing_ok=True)
    parts = former_parts()
    moved = {function for functions in parts.values() for function in functions}
    for name in STUBS:
        symbols = exported(compiler.file(name))
        if name == "libc.so.6":
            for part, functions in parts.items():
                make_stub(folder, part, [symbol for symbol in symbols if symbol.name in functions], compiler)
            symbols = [symbol for symbol in symbols if symbol.name not in moved]
        make_stub(folder, name, symbols, compiler)
    stubs = folder / "stubs"
    newer = make_newer_functions(stubs, compiler)
    former = " ".join(f'"{stubs / name}"' for name in parts)
    nonshared = compiler.file("libc_nonshared.a")
    loaders = sorted(compiler.file("libc.so.6").parent.glob("ld-linux-*.so.*"))
    if not loaders:
        fail(f"there is no ld-linux-*.so.* beside {compiler.file('libc.so.6')}")
    texts = (
        f'GROUP ( "{newer}" "{stubs}/libc.so.6" "{nonshared}" {former} AS_NEEDED ( "{loaders[0]}" ) )',
        f'INPUT ( "{stubs}/libm.so.6" )',
        f'INPUT ( "{stubs}/libstdc++.so.6" "{compiler.file("libstdc++.a")}" )',
        f'GROUP ( "{stubs}/libgcc_s.so.1" -lgcc )',
    )
    for name, text in zip(SCRIPTS, texts, strict=True):
        (folder / name).write_text(f"/* {Path(__file__).name} */\n{text}\n", encoding="utf-8")


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="Makes libraries to link against for machines with older ones.")
    parser.add_argument("folder", type=Path, help="where to make them")
    parser.add_argument("--compiler", default="g++", help="compiler of C++ that will link (%(default)s)")
    options = parser.parse_args()
    if not options.folder.name:
        parser.error(f"the folder is {str(options.folder)!r}; expected the name of a folder of its own")
    make_old_libraries(options.folder.resolve(), options.compiler)


if __name__ == "__main__":
    main()
