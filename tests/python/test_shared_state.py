"""pogosim-shared-state finds the variables that simulated robots share by mistake, and no others."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from running import PROGRAMS, ROOT, Run, compile_program, compiler, pkg_config, ran

CASES = PROGRAMS / "shared_state"
C_FILES = ["cases.c", "elsewhere.c", "cases.h"]
COMPILERS = [
    (name, files)
    for names, files in (
        (("gcc",), C_FILES),
        (("clang", "clang-14"), C_FILES),
        (("g++",), ["cases.cpp"]),
        (("clang++", "clang++-14"), ["cases.cpp"]),
    )
    if (name := compiler(*names))
]
EXAMPLES = sorted(ROOT.glob("examples/*/main.c*"))

Found = set[tuple[str, int, str, int]]  # file, line, name, bytes


def check(program: Path, *options: str, folder: Path = CASES) -> Run:
    (tool,) = pkg_config("--variable=shared_state")
    command = [tool, *options, str(program)]
    return ran(folder, *command, timeout=60)


def found_by_tool(report: str) -> Found:
    line = re.compile(r"^([^:\n]+):(\d+):(?:\d+:)? warning: '([^']+)'.*?\((\d+) bytes?\)", re.MULTILINE)
    return {(file, int(number), name, int(size)) for file, number, name, size in line.findall(report)}


def marked_in_source(files: list[str]) -> Found:
    return {
        (file, number, mark[1], int(mark[2]))
        for file in files
        for number, line in enumerate((CASES / file).read_text().splitlines(), start=1)
        if (mark := re.search(r"// found: (\S+) (\d+)$", line))
    }


def build(folder: Path, source: str, *flags: str) -> Path:
    file = folder / "main.c"
    file.write_text(f'#include "pogobase.h"\n{source}\nint main(void) {{ return 0; }}\n')
    return compile_program(folder / "program", file, flags=["-g", "-O0", *flags])


@pytest.mark.parametrize("options", ["-O0", "-O2", "-Os -gdwarf-4"])
@pytest.mark.parametrize(("name", "files"), COMPILERS, ids=lambda part: part if isinstance(part, str) else "")
def test_every_kind_of_variable_is_told_apart(name: str, files: list[str], options: str, tmp_path: Path) -> None:
    sources = [CASES / file for file in files if not file.endswith(".h")]
    flags = ["-g", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *options.split()]
    program = compile_program(tmp_path / "program", *sources, compiler=name, flags=flags)
    expected = marked_in_source(files)
    assert len(expected) > 10
    assert found_by_tool(check(program).errors) == expected


def links(folder: Path, name: str, flags: list[str]) -> bool:
    """Whether the compiler has what these flags need: its sanitizers are packages of their own."""
    source = folder / "empty.c"
    source.write_text("int main(void) { return 0; }\n")
    language = "c++" if "++" in name else "c"
    command = [name, "-x", language, *flags, str(source), "-o", str(folder / "empty")]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.parametrize("sanitizers", ["address,undefined", "thread"])
@pytest.mark.parametrize(("name", "files"), COMPILERS, ids=lambda part: part if isinstance(part, str) else "")
def test_variables_of_sanitizers_are_not_the_programs(
    name: str, files: list[str], sanitizers: str, tmp_path: Path
) -> None:
    sources = [CASES / file for file in files if not file.endswith(".h")]
    flags = ["-g", "-O1", f"-fsanitize={sanitizers}"]
    if not links(tmp_path, name, flags):
        pytest.skip(f"{name} comes without -fsanitize={sanitizers} here")
    program = compile_program(tmp_path / "program", *sources, compiler=name, flags=flags)
    assert found_by_tool(check(program).errors) == marked_in_source(files)


@pytest.mark.parametrize("main", EXAMPLES, ids=lambda path: path.parent.name)
def test_robots_of_the_examples_share_nothing_by_mistake(main: Path, tmp_path: Path) -> None:
    sources = sorted([*main.parent.glob("*.c"), *main.parent.glob("*.cpp")], key=lambda path: path != main)
    flags = ["-std=gnu++20" if main.suffix == ".cpp" else "-std=gnu11", "-g", f"-I{main.parent}"]
    package = "pogosim-sdk" if '#include "pogobot.h"' in main.read_text() else "pogosim"
    program = compile_program(tmp_path / "program", *sources, flags=flags, package=package)
    assert (check(program, "-Werror=shared-state").text, check(program).code) == ("", 0)


def test_warning_reads_like_a_compilers(tmp_path: Path) -> None:
    program = build(tmp_path, "int32_t total;\nvoid count(void);\nvoid count(void) { static bool seen; seen = !seen; }")
    result = check(program, folder=tmp_path)
    assert (result.code, result.output) == (0, "")
    shared = "is shared by all simulated robots; real robots cannot share it [-Wshared-state]"
    assert result.errors.splitlines() == [
        f"main.c:2:9: warning: 'total' (4 bytes) {shared}",
        f"main.c:4:32: warning: 'seen' in count() (1 byte) {shared}",
        "Move it to USERDATA, read it in global_setup with init_from_configuration(), "
        "or mark it POGO_SHARED if sharing is intended. With 'robot_memory: own' in its configuration, each robot has "
        "its own.",
    ]


def test_constant_set_by_the_first_robot_is_named_as_that(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(
        '#include "pogobase.h"\nuint16_t first();\nuint16_t first() {\n'
        "static uint16_t const id = pogobot_helper_getid();\nreturn id; }\nint main() { return first(); }\n"
    )
    result = check(compile_program(tmp_path / "program", source, flags=["-g"]), folder=tmp_path)
    assert "main.cpp:4:23: warning: 'id' in first() (2 bytes) is set once, by the first robot" in result.errors


def test_shared_state_can_be_an_error_or_be_ignored(tmp_path: Path) -> None:
    program = build(tmp_path, "int32_t total;")
    result = check(program, "-Werror=shared-state", folder=tmp_path)
    assert result.code == 1
    assert "main.c:2:9: error: 'total'" in result.errors
    for options in (["-Wno-shared-state"], ["--ignore", str(tmp_path)], ["--ignore", "."]):
        assert (check(program, "-Werror=shared-state", *options, folder=tmp_path).text) == ""
    assert check(program, "--ignore", str(tmp_path / "mai"), folder=tmp_path).errors != ""


def test_tool_says_what_it_cannot_read(tmp_path: Path) -> None:
    (tool,) = pkg_config("--variable=shared_state")
    program = build(tmp_path, "int32_t total;", "-g0")
    assert "program: no debug information; compile and link with -g" in check(program).errors
    unlinked = tmp_path / "main.o"
    subprocess.run(["cc", "-g", *pkg_config("--cflags"), "-c", tmp_path / "main.c", "-o", unlinked], check=True)
    assert "main.o: not linked yet" in check(unlinked).errors
    assert "nowhere: No such file or directory" in check(tmp_path / "nowhere").errors
    assert "main.c: no debug information" in check(tmp_path / "main.c").errors
    assert "unknown argument '-W'" in check(program, "-W").errors
    assert "no program specified" in subprocess.run([tool], capture_output=True, text=True, check=False).stderr
    assert {check(program, *options).code for options in ([], ["-W"])} == {2}
    assert check(program, "--help").output.startswith("Usage: pogosim-shared-state [options] PROGRAM")


def test_mark_changes_nothing_in_what_a_variable_is(tmp_path: Path) -> None:
    program = build(
        tmp_path,
        "POGO_SHARED static int32_t numbers[3] = {1, 2};\nint32_t* get(void);\n"
        "int32_t* get(void) { POGO_SHARED static int32_t zero; return &numbers[zero]; }",
    )
    assert check(program).text == ""
