"""The same sources compile for the real robots: gnu99, -DREAL_ROBOT, against declarations of the robots' SDK."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from running import PROGRAMS, ROOT, compiler

STUB = PROGRAMS / "sdk_stub"
INTERFACE = sorted((ROOT / "src" / "interface").glob("*.c"))
SOURCES = [*INTERFACE, *sorted(ROOT.glob("examples/*/main.c"))]
WARNINGS = ["-Wall", "-Wextra", "-Werror"]
# The flags of the SDK for the robots' processor.
RISCV = ["-march=rv32im", "-mabi=ilp32", "-Os", "-ffreestanding", "-fno-builtin", "-isystem", str(STUB / "libc")]
TOOLCHAINS = {
    name: flags
    for name, flags in {"gcc": [], "clang-14": [], "clang": [], "riscv64-unknown-elf-gcc": RISCV}.items()
    if compiler(name)
}
LIBC = {"printf", "puts", "putchar", "rand", "srand", "memcpy", "memset", "strcmp", "memcmp", "_GLOBAL_OFFSET_TABLE_"}
# Of single precision: the processor computes in software, and double takes several times as long.
LIBM = {"sinf", "cosf", "atan2f", "sqrtf", "fabsf", "fminf", "fmaxf"}


def compile_object(name: str, source: Path, output: Path, *flags: str) -> Path:
    includes = ["-I", str(ROOT / "include"), "-I", str(STUB)]
    command = [name, "-std=gnu99", "-DREAL_ROBOT", *TOOLCHAINS[name], *flags, *WARNINGS, *includes]
    done = subprocess.run([*command, "-c", str(source), "-o", str(output)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return output


def symbols(path: Path, *options: str) -> set[str]:
    listing = subprocess.run(["nm", *options, str(path)], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1] for line in listing.splitlines()}


@pytest.mark.parametrize("name", TOOLCHAINS)
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_source_compiles_for_the_robot_and_asks_for_nothing_but_the_sdk(
    name: str, source: Path, tmp_path: Path
) -> None:
    interface = {
        symbol
        for number, layer in enumerate(INTERFACE)
        for symbol in symbols(compile_object(name, layer, tmp_path / f"{number}.o"), "--defined-only")
    }
    sdk = set(re.findall(r"\b(\w+)\(", (STUB / "pogobot.h").read_text()))
    wanted = symbols(compile_object(name, source, tmp_path / "object.o"), "-u")
    # Arithmetic that the processor has no instruction for: __divsf3, __extendsfdf2, ...
    arithmetic = {symbol for symbol in wanted if re.fullmatch(r"__[a-z]+[sd][fi]([sd][fi])?[23]?", symbol)}
    assert wanted - arithmetic - interface - sdk - LIBC - LIBM == set()


@pytest.mark.parametrize("name", TOOLCHAINS)
def test_sample_of_the_whole_interface_compiles_for_the_robot(name: str, tmp_path: Path) -> None:
    # Callbacks and what else only the simulator has is not even looked at.
    source = tmp_path / "main.c"
    source.write_text((PROGRAMS / "sample.c").read_text().replace("#include <math.h>\n", ""))
    built = compile_object(name, source, tmp_path / "object.o")
    assert not {symbol for symbol in symbols(built) if symbol.startswith(("callback", "data_", "init_", "pogosim_"))}


def main_with_two_categories(folder: Path) -> Path:
    source = folder / "main.c"
    source.write_text("""
        #include "pogobase.h"
        typedef struct { int n; } USERDATA;
        DECLARE_USERDATA(USERDATA)
        REGISTER_USERDATA(USERDATA)
        void user_init(void) { mydata->n = 1; }
        void user_step(void) {}
        int main(void) {
            pogobot_init();
            pogobot_start(user_init, user_step);
            pogobot_start(default_walls_user_init, default_walls_user_step, "walls");
            SET_CALLBACK(callback_robot_end, nobody_defines_this);
            return current_robot_category_is("walls") && get_current_robot_category()[0] == 'w';
        }
    """)
    return source


@pytest.mark.parametrize("name", TOOLCHAINS)
def test_firmware_holds_the_program_of_its_own_category_only(name: str, tmp_path: Path) -> None:
    source = main_with_two_categories(tmp_path)
    robots = symbols(compile_object(name, source, tmp_path / "robots.o", "-O2"), "-u")
    walls = symbols(compile_object(name, source, tmp_path / "walls.o", "-O2", "-DROBOT_CATEGORY=walls"), "-u")
    assert "default_walls_user_init" not in robots
    assert "default_walls_user_init" in walls
