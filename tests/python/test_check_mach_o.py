"""What scripts/cross says of files for macOS, written here by hand, and what it lets ours take from the system."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from running import ROOT

CHECK = ROOT / "scripts" / "cross" / "check_mach_o.py"
ARM64, X86_64 = 0x0100000C, 0x01000007
LIBCPP = "/usr/lib/libc++.1.dylib"
SYSTEM = "/usr/lib/libSystem.B.dylib"
MACOS_12 = 12 << 16


def text_command(kind: int, text: str, numbers: int = 0) -> bytes:
    """Return a load command that has a text after its numbers (dylib_command: 3, rpath_command: 0)."""
    start = 12 + 4 * numbers
    body = text.encode() + b"\0"
    body += bytes(-(start + len(body)) % 8)
    return struct.pack("<3I", kind, start + len(body), start) + bytes(4 * numbers) + body


def written(
    file: Path,
    name: str = "@rpath/libx.dylib",
    libraries: Sequence[str] = (SYSTEM,),
    rpaths: Sequence[str] = (),
    shown: Sequence[str] = (),
    used: Sequence[tuple[str, int]] = (),
    macos: int = MACOS_12,
    processor: int = ARM64,
    signed: bool = True,
) -> Path:
    """Write a library of macOS, and return its file.

    Args:
        file: where to write.
        name: by which others look for it.
        libraries: that it needs.
        rpaths: where it looks for them.
        shown: symbols that others may use.
        used: symbols of its libraries, each with the number of the library, from 1; 0: of none.
        macos: oldest version that it is for.
        processor: ARM64 or X86_64.
        signed: whether it says where its signature is.
    """
    commands = [text_command(0xD, name, 3)]
    commands += [text_command(0xC, library, 3) for library in libraries]
    commands += [text_command(0x8000001C, rpath) for rpath in rpaths]
    commands.append(struct.pack("<6I", 0x32, 24, 1, macos, macos, 0))
    commands += [struct.pack("<4I", 0x1D, 16, 0, 0)] if signed else []
    table, names = b"", b"\0"
    for symbol, kind, section, library in [
        *((symbol, 0x0F, 1, 0) for symbol in shown),
        *((symbol, 0x01, 0, library) for symbol, library in used),
    ]:
        table += struct.pack("<IBBHQ", len(names), kind, section, library << 8, 0)
        names += symbol.encode() + b"\0"
    place = 32 + sum(map(len, commands)) + 24
    symbols = len(shown) + len(used)
    commands.append(struct.pack("<6I", 0x2, 24, place, symbols, place + len(table), len(names)))
    head = struct.pack("<8I", 0xFEEDFACF, processor, 0, 6, len(commands), sum(map(len, commands)), 0, 0)
    file.write_bytes(head + b"".join(commands) + table + names)
    return file


def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
    """Run Python with the modules of scripts/."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "scripts")}
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, check=False, timeout=60, env=environment
    )


def said_of(*words: str | Path) -> str:
    """Return what check_mach_o says of a file, without its path; all must be as its exit code says."""
    result = run(CHECK, "macos-arm64", *words)
    assert result.stderr == ""
    (line,) = result.stdout.splitlines()
    said = line.partition(": ")[2]
    assert result.returncode == (0 if said == "as expected" else 1)
    return said


def test_a_file_that_finds_all_that_it_uses_is_as_expected(tmp_path: Path) -> None:
    libraries = (SYSTEM, LIBCPP, "@rpath/libother.dylib")
    used = (("_printf", 1), ("___cxa_throw", 2), ("_other", 3))
    file = written(
        tmp_path / "libpogosim.dylib", "@rpath/libpogosim.dylib", libraries, ("@loader_path",), ("_pogosim",), used
    )
    other = written(tmp_path / "libother.1.dylib", "@rpath/libother.dylib", shown=("_other",))
    assert said_of("--movable", file, "--with", other) == "as expected"


@pytest.mark.parametrize(
    ("problem", "changed"),
    [
        ("it is for macOS 13.1 and later, expected 11 or 12", {"macos": 13 << 16 | 1 << 8}),
        ("it is looked for as '/tmp/libx.dylib', expected @rpath/...", {"name": "/tmp/libx.dylib"}),
        ("it is looked for as '', expected @rpath/...", {"name": ""}),
        ("it is not signed, and Macs with Apple silicon load no such file", {"signed": False}),
        ("it looks for libraries in /tmp/lib, expected @loader_path/...", {"rpaths": ("/tmp/lib",)}),
        (
            "it needs /opt/libfar.dylib, which is neither the system's nor there",
            {"libraries": (SYSTEM, "/opt/libfar.dylib")},
        ),
        ("it needs @rpath/libother.dylib, and has no rpath", {"libraries": ("@rpath/libother.dylib",)}),
        ("it uses _far of no library", {"used": (("_far", 0),)}),
        (
            "it uses _far, which @rpath/libother.dylib does not have",
            {"libraries": ("@rpath/libother.dylib",), "rpaths": ("@loader_path/..",), "used": (("_far", 1),)},
        ),
    ],
)
def test_each_problem_is_said(problem: str, changed: dict[str, object], tmp_path: Path) -> None:
    file = written(tmp_path / "libx.dylib", **changed)  # type: ignore[arg-type]
    other = written(tmp_path / "libother.dylib", "@rpath/libother.dylib", shown=("_other",))
    assert said_of("--movable", file, "--with", other) == problem


def test_our_library_shows_no_names_of_cpp_and_uses_the_systems_library_of_it(tmp_path: Path) -> None:
    file = tmp_path / "libpogosim.dylib"
    assert said_of(written(file)) == f"it does not use {LIBCPP}, so exceptions would be of two kinds"
    assert said_of(written(file, libraries=(LIBCPP,), shown=("__ZN7pogosim3runEv",))) == "it shows __ZN7pogosim3runEv"


def test_of_many_problems_the_first_are_said(tmp_path: Path) -> None:
    said = said_of(written(tmp_path / "libx.dylib", used=[(f"_far{i}", 0) for i in range(25)]))
    assert said.count("of no library") == 20
    assert said.endswith("; 5 more")


def test_files_for_others_are_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "short").write_bytes(b"\xcf\xfa")
    for file in (written(tmp_path / "x86", processor=X86_64), Path(sys.executable), tmp_path / "short"):
        result = run(CHECK, "macos-arm64", file)
        assert result.returncode == 1
        assert result.stderr.startswith(f"check_mach_o.py: {file}: ")
        assert result.stderr.count("\n") == 1


def test_our_files_may_take_from_the_systems_library_of_cpp_what_those_of_arrow_take(tmp_path: Path) -> None:
    arrow = tmp_path / "pyarrow"
    arrow.mkdir()
    used = (("___cxa_throw", 1), ("_printf", 2), ("__ZNSt3__14coutE", 1))
    written(arrow / "libarrow.dylib", libraries=(LIBCPP, SYSTEM), used=used)
    write = "import sys; from pathlib import Path; from cross.system_libcpp import write_stub; "
    result = run("-c", write + "write_stub('macos-arm64', Path(sys.argv[1]), Path(sys.argv[2]))", arrow, tmp_path)
    assert result.returncode == 0, result.stderr
    stub = (tmp_path / "libc++.1.tbd").read_text()
    assert f"install-name: '{LIBCPP}'" in stub
    assert {"'___cxa_throw'", "'__ZNSt3__14coutE'"} <= set(stub.replace(",", " ").split())
    assert "_printf" not in stub
