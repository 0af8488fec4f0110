"""What the simulator reads of programs on macOS. zig, of the package ziglang, makes some here, for both processors."""

from __future__ import annotations

import shutil
import struct
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from running import ROOT, build_folder

SOURCES = ROOT / "tests" / "mach_o"
PROCESSORS = {"arm64": "aarch64", "x86_64": "x86_64"}
MOST_S = 300


def zig(*words: str | Path) -> None:
    """Run zig; its cache is kept from run to run of the tests."""
    result = subprocess.run(
        [sys.executable, "-m", "ziglang", *words], capture_output=True, text=True, check=False, timeout=MOST_S
    )
    assert result.returncode == 0, result.stderr


def made(folder: Path, processor: str, source: str, *options: str) -> Path:
    """Compile and link a program of tests/mach_o for macOS."""
    program = folder / f"{processor}.so"
    target = ["-target", f"{PROCESSORS[processor]}-macos.12.0"]
    zig("cc", *target, "-O1", *options, f"-I{ROOT}/include", "-o", program, SOURCES / source)
    return program


def read(program: Path, processor: str, *more: str) -> list[str]:
    """Return the lines of mach_o_reader."""
    reader = build_folder() / "tests" / "mach_o_reader"
    result = subprocess.run(
        [reader, program, processor, *more], capture_output=True, text=True, check=False, timeout=MOST_S
    )
    assert (result.returncode, result.stderr) == (0, "")
    return result.stdout.splitlines()


def write_universal(file: Path, parts: Mapping[str, Path]) -> None:
    """Put programs for several processors into one file, as lipo does."""
    kinds = {"arm64": (0x0100000C, 0), "x86_64": (0x01000007, 3)}
    page_bits = 14
    head, body = struct.pack(">2I", 0xCAFEBABE, len(parts)), b""
    for name, part in parts.items():
        content = part.read_bytes()
        offset = (1 << page_bits) + len(body)
        head += struct.pack(">5I", *kinds[name], offset, len(content), page_bits)
        body += content + bytes(-len(content) % (1 << page_bits))
    file.write_bytes(head.ljust(1 << page_bits, b"\0") + body)


def of_kind(lines: list[str], kind: str) -> set[str]:
    """Return the lines that begin with a word, without it."""
    return {line[len(kind) + 1 :] for line in lines if line.startswith(f"{kind} ")}


def threads_in(lines: list[str], beginning: str) -> int:
    """Return how many bytes each thread has, the linker's padding included, from the line that begins so."""
    (line,) = (line for line in lines if line.startswith(f"{beginning}threads "))
    return int(line.split()[5])


def sizes(variables: set[str], owner: str) -> dict[str, int]:
    """Return the bytes of the variables of an owner, by name. Each may reach to the next one, which is aligned."""
    return {line.split()[0]: int(line.split()[1]) for line in variables if line.endswith(f" {owner}")}


@pytest.fixture(scope="module", params=PROCESSORS)
def processor(request: pytest.FixtureRequest) -> str:
    """Each kind of Mac."""
    return str(request.param)


@pytest.fixture(scope="module")
def program(processor: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shared object with variables of all kinds."""
    return made(tmp_path_factory.mktemp("mach_o"), processor, "program.c", "-shared")


def test_variables_are_found_with_their_sizes_and_those_of_threads_apart(program: Path, processor: str) -> None:
    lines = read(program, processor)
    variables = of_kind(lines, "variable")
    assert "of_all 4 shared" in variables
    of_threads, own = sizes(variables, "thread"), sizes(variables, "robots")
    assert set(of_threads) == {"of_thread", "buffer_of_thread"}
    assert 4 <= of_threads["of_thread"] <= 16
    assert 24 <= of_threads["buffer_of_thread"] <= 32
    assert {"steps", "sums", "gain", "robot_step.calls"} <= set(own)
    assert 4 <= own["steps"] <= 8
    assert 40 <= own["sums"] <= 48
    assert not {"table", "names"} & {line.split()[0] for line in variables}
    assert 28 <= threads_in(lines, "known 1 static 1 ") <= 48


def test_functions_texts_and_what_is_used_of_libraries_are_found(program: Path, processor: str) -> None:
    lines = read(program, processor)
    assert "problem " in lines
    assert {"robot_step 1", "before_constructors 1"} <= of_kind(lines, "function")
    assert of_kind(lines, "text") == {"gain"}
    assert {"sscanf", "sin", "strlen"} <= of_kind(lines, "import")
    assert not {"_tlv_bootstrap", "dyld_stub_binder"} & of_kind(lines, "import")
    assert "/usr/lib/libSystem.B.dylib" in of_kind(lines, "library")
    (build,) = of_kind(lines, "build")
    assert len(build) == 32


def test_variables_of_inline_functions_and_templates_are_those_that_all_copies_share(
    processor: str, tmp_path: Path
) -> None:
    program = made(tmp_path, processor, "inline_variable.cpp", "-shared", "-std=c++20")
    assert of_kind(read(program, processor), "copies") == {"of_all_files", "_Z11of_templateIiE"}


def test_a_program_without_symbols_of_its_static_variables_is_known_for_it(processor: str, tmp_path: Path) -> None:
    lines = read(made(tmp_path, processor, "program.c", "-shared", "-Wl,-x"), processor)
    # The static variables of threads have no name any more, but their memory is counted.
    assert 28 <= threads_in(lines, "known 1 static 0 ") <= 48
    assert set(sizes(of_kind(lines, "variable"), "thread")) == {"of_thread"}


def test_files_that_are_no_programs_are_refused_with_a_reason(program: Path, processor: str, tmp_path: Path) -> None:
    executable = tmp_path / "main.c"
    executable.write_text("int main(void) { return 0; }\n")
    target = f"{PROCESSORS[processor]}-macos.12.0"
    zig("cc", "-target", target, "-o", tmp_path / "main", executable)
    assert "problem is an executable" in read(tmp_path / "main", processor)[0]
    zig("cc", "-target", target, "-c", "-o", tmp_path / "main.o", executable)
    assert "problem is no shared object" in read(tmp_path / "main.o", processor)[0]
    other = next(name for name in PROCESSORS if name != processor)
    assert "problem is for another processor" in read(program, other)[0]
    assert "problem is no shared object" in read(Path(sys.executable), processor)[0]
    (tmp_path / "cut").write_bytes(program.read_bytes()[:-4000])
    assert "problem is cut off" in read(tmp_path / "cut", processor)[0]
    (tmp_path / "empty").write_bytes(b"")
    assert "problem is no shared object" in read(tmp_path / "empty", processor)[0]


def test_of_a_universal_file_the_part_for_the_processor_is_read(tmp_path: Path) -> None:
    parts = {}
    for name in PROCESSORS:
        parts[name] = made(tmp_path, name, "program.c", "-shared")
    universal = tmp_path / "universal.so"
    write_universal(universal, parts)
    for name, part in parts.items():
        assert read(universal, name) == read(part, name)
    shutil.copy(parts["arm64"], universal)
    assert "problem is for another processor" in read(universal, "x86_64")[0]


def test_damaged_files_are_read_without_harm(program: Path, processor: str) -> None:
    (line,) = read(program, processor, "500")
    words = line.split()
    assert int(words[2]) == 500, "a part is missing in each file that is cut off"
    assert int(words[4]) < 500, "some changes are of no consequence"
