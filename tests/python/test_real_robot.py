"""The same sources are programs of real robots: gnu99, -DREAL_ROBOT, with `make bin` and the robots' compiler.

The SDK is a stand-in (robot_sdk.py): its functions do nothing, but names, types, compiler and C library are in earnest.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from project import compiled, copy_template, made, make, sentence, write
from robot_sdk import FLAGS, STUB, TRIPLE, call, make_sdk, need
from running import PROGRAMS, ROOT, build_folder, compiler

INTERFACE = sorted((ROOT / "src" / "interface").glob("*.c"))
FOLDERS = sorted({path.parent for path in [*ROOT.glob("examples/*/main.c*"), ROOT / "template_prj" / "main.c"]})
WARNINGS = ["-Wall", "-Wextra", "-Werror"]
ROBOT = f"{TRIPLE}-gcc"
TOOLCHAINS = {ROBOT: FLAGS} | {name: [] for name in (compiler("gcc"), compiler("clang", "clang-14")) if name}
# Functions of the C library that need no operating system.
LIBC = {
    *("printf", "puts", "putchar", "snprintf", "rand", "srand", "abs", "qsort", "memcpy", "memmove", "memset"),
    *("memcmp", "strcmp", "strlen", "strncpy", "_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail"),
    *("sinf", "cosf", "tanf", "asinf", "acosf", "atanf", "atan2f", "sqrtf", "expf", "logf", "powf", "fabsf", "fmodf"),
    *("floorf", "ceilf", "roundf", "hypotf", "fminf", "fmaxf", "lroundf"),
}


def compile_object(name: str, source: Path, output: Path) -> Path:
    options: list[str | Path] = ["-DREAL_ROBOT", *TOOLCHAINS[name], *WARNINGS, "-I", ROOT / "include", "-I", STUB]
    if source.suffix == ".cpp":
        name = name.replace("gcc", "g++").replace("clang", "clang++")
        options += ["-std=gnu++20", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"]
    else:
        options += ["-std=gnu99"]
    call(need(name), *options, "-c", source, "-o", output)
    return output


def symbols(path: Path, *options: str) -> set[str]:
    return {line.split()[-1] for line in call("nm", *options, path).splitlines()}


def interface_functions() -> set[str]:
    """Names of the functions that the interface layer's headers declare for robots."""
    headers = [ROOT / "include" / "pogosim" / name for name in ("pogosim.h", "colormaps.h")]
    return set(re.findall(r"^(?:void|bool|uint32_t) (\w+)\(", "".join(path.read_text() for path in headers), re.M))


@pytest.fixture(scope="module")
def sdk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_sdk(tmp_path_factory.mktemp("sdk") / "pogobot-sdk")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project that has Pogosim's tree, which need not be built, as a link."""
    folder = copy_template(tmp_path / "swarm")
    (folder / "pogosim").mkdir()
    (folder / "pogosim" / "include").symlink_to(ROOT / "include")
    (folder / "pogosim" / "src").symlink_to(ROOT / "src")
    return folder


@pytest.mark.parametrize("name", TOOLCHAINS)
@pytest.mark.parametrize("folder", FOLDERS, ids=lambda path: path.name)
def test_program_compiles_for_the_robot_and_asks_for_nothing_but_the_sdk(
    name: str, folder: Path, tmp_path: Path
) -> None:
    sources = [*INTERFACE, *folder.glob("*.c"), *folder.glob("*.cpp")]
    objects = [compile_object(name, source, tmp_path / f"{number}.o") for number, source in enumerate(sources)]
    own = set().union(*(symbols(built, "--defined-only") for built in objects))
    wanted = set().union(*(symbols(built, "-u") for built in objects))
    sdk = set(re.findall(r"\b(\w+)\(", (STUB / "pogobot.h").read_text()))
    # Arithmetic that the processor has no instruction for: __divsf3, __extendsfdf2, ...
    arithmetic = {symbol for symbol in wanted if re.fullmatch(r"__[a-z]+[sd][fi]([sd][fi])?[23]?", symbol)}
    assert wanted - arithmetic - own - sdk - LIBC == set()
    # Single precision only, but for printf: the processor computes with neither, and double takes much longer.
    assert {symbol for symbol in arithmetic if "df" in symbol} <= {"__extendsfdf2"}


@pytest.mark.parametrize("name", TOOLCHAINS)
def test_sample_of_the_whole_interface_compiles_for_the_robot(name: str, tmp_path: Path) -> None:
    # Callbacks and what else only the simulator has is not even looked at.
    source = tmp_path / "main.c"
    source.write_text((PROGRAMS / "sample.c").read_text().replace("#include <math.h>\n", ""))
    built = compile_object(name, source, tmp_path / "object.o")
    assert not {symbol for symbol in symbols(built) if symbol.startswith(("callback", "data_", "init_", "pogosim_"))}


# ---- The code


STEP = """
    USER.ticks++;
    USER.level += USER.table[USER.ticks % 4].gain * 0.5f;
    USER.message.payload[3] = (uint8_t)USER.ticks;
    pogobot_imu_read(USER.acceleration, &USER.level);
    for (uint8_t i = 0; i < 4; i++) { USER.table[i].from = &USER.table[(i + 1) % 4]; }
"""
DATA = """
    typedef struct entry { float gain; struct entry* from; } entry;
    typedef struct { uint32_t ticks; float level; entry table[4]; message_t message; float acceleration[3]; } data;
"""


def code_of_step(folder: Path, declared: str, user: str) -> str:
    """Disassemble user_step with its relocations; addresses and what comes before are left out."""
    source = folder / "main.c"
    step = STEP.replace("USER", user)
    source.write_text(f'#include "pogobase.h"\n{DATA}\n{declared}\nvoid user_step(void) {{ {step} }}\n')
    built = compile_object(ROBOT, source, folder / "main.o")
    return call(f"{TRIPLE}-objdump", "-dr", "--no-show-raw-insn", "--disassemble=user_step", built)


def test_user_data_cost_what_a_global_costs(tmp_path: Path) -> None:
    pogosim = code_of_step(tmp_path, "DECLARE_USERDATA(data)", "(*mydata)")
    assert code_of_step(tmp_path, "extern data myuserdata;", "myuserdata") == pogosim
    # All accesses are to addresses inside of the object; .LC0 is the constant 0.5.
    named = set(re.findall(r"R_RISCV_(?:HI20|LO12_[IS])\s+([\w.]+)", pogosim))
    assert named - {".LC0"} == {"myuserdata"}
    # A pointer costs more; so the comparison can tell.
    assert code_of_step(tmp_path, "extern data* pointer;", "(*pointer)") != pogosim


def test_interface_adds_no_code_to_a_program(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        '#include "pogobase.h"\ntypedef struct { int n; } T;\nDECLARE_USERDATA(T)\nREGISTER_USERDATA(T);\n'
    )
    assert symbols(compile_object(ROBOT, source, tmp_path / "main.o")) == {"myuserdata"}


def test_interface_consists_of_its_documented_functions(tmp_path: Path) -> None:
    declared = interface_functions()
    assert {"pogo_main_loop_step", "hsv_to_rgb", "clear_IR_buffers"} <= declared
    defined = {
        line.split()[-1]
        for source in INTERFACE
        for line in call(f"{TRIPLE}-nm", compile_object(ROBOT, source, tmp_path / "layer.o")).splitlines()
        if " T " in line
    }
    assert defined <= declared | {"_pogobot_start"}
    assert {"pogo_main_loop_step", "hsv_to_rgb", "clear_IR_buffers", "_pogobot_start"} <= defined


@pytest.mark.parametrize("source", INTERFACE, ids=lambda path: path.name)
def test_interface_needs_no_double_precision(source: Path, tmp_path: Path) -> None:
    wanted = symbols(compile_object(ROBOT, source, tmp_path / "layer.o"), "-u")
    assert not {symbol for symbol in wanted if re.search(r"^__.*df", symbol)}
    # ... which a file with double in it does.
    double = tmp_path / "double.c"
    double.write_text("double half(double x);\ndouble half(double x) { return x * 0.5; }\n")
    assert "__muldf3" in symbols(compile_object(ROBOT, double, tmp_path / "double.o"), "-u")


# ---- make bin


def listing(firmware: Path) -> dict[str, int]:
    """Addresses of all symbols of a firmware."""
    lines = (line.split() for line in call(f"{TRIPLE}-nm", "--defined-only", firmware).splitlines())
    return {name: int(address, 16) for address, _, name in lines}


def test_template_becomes_firmware(project: Path, sdk: Path) -> None:
    result = made(project, "clean", "bin", f"POGO_SDK={sdk}")
    assert "Built build/bin/firmware.bin for robots of category 'robots'\n" in result.output
    names = listing(project / "build" / "bin" / "firmware.elf")
    # Code where the robot starts, data in its memory, and only what is used.
    assert names["_start"] == 0x260000
    assert names["myuserdata"] < 128 * 1024
    unused = {"default_walls_user_init", "rainbow_colormap", "hsv_to_rgb"}
    assert unused & set(names) == set()
    image = (project / "build" / "bin" / "firmware.bin").read_bytes()
    assert 1000 < len(image) < 64 * 1024
    assert b"HELLO WORLD! I am robot %u" in image


def test_all_is_both_programs(project: Path, sdk: Path) -> None:
    shutil.rmtree(project / "pogosim")
    arguments = [f"POGOSIM_DIR={build_folder()}", f"POGO_SDK={sdk}"]
    made(project, "clean", "all", *arguments)
    assert (project / "swarm").exists()
    assert (project / "build" / "bin" / "firmware.bin").exists()
    again = made(project, *arguments)
    assert compiled(again) == set()


def test_installation_is_enough_for_firmware(sdk: Path, tmp_path: Path) -> None:
    call("cmake", "--install", build_folder(), "--prefix", tmp_path / "installed")
    project = copy_template(tmp_path / "swarm")
    made(project, "bin", f"POGO_SDK={sdk}", f"POGOSIM_DIR={tmp_path / 'installed'}")
    assert "user_step" in call(f"{TRIPLE}-objdump", "--dwarf=info", project / "build" / "bin" / "firmware.elf")
    made(project, "emu", f"POGOSIM_DIR={tmp_path / 'installed'}")
    assert (project / "build" / "emu" / "firmware.elf").exists()


CATEGORIES = """#include "pogobase.h"
typedef struct { int n; } USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
static void leader_step(void) { printf("I lead\\n"); }
static void follower_step(void) { printf("I follow\\n"); }
void user_init(void) { mydata->n = 1; }
int main(void) {
    pogobot_init();
    pogobot_start(user_init, leader_step, "leaders");
    pogobot_start(user_init, follower_step);
    SET_CALLBACK(callback_robot_end, nobody_defines_this);
    return current_robot_category_is("robots") && get_current_robot_category()[0] == 'r';
}
"""


def test_category_chooses_the_controller(project: Path, sdk: Path) -> None:
    write(project, {"main.c": CATEGORIES})
    image = project / "build" / "bin" / "firmware.bin"
    made(project, "bin", f"POGO_SDK={sdk}")
    assert (b"I follow" in image.read_bytes(), b"I lead" in image.read_bytes()) == (True, False)
    # The category is one of the options, so that its change is noticed.
    made(project, "bin", f"POGO_SDK={sdk}", "ROBOT_CATEGORY=leaders")
    assert (b"I follow" in image.read_bytes(), b"I lead" in image.read_bytes()) == (False, True)


def test_program_for_the_robots_alone_becomes_firmware_without_the_interface(project: Path, sdk: Path) -> None:
    write(
        project,
        {
            "main.c": '#include "pogobot.h"\nuint32_t pogobot_ticks;\nint main(void) { pogobot_init(); '
            "for (;;) { pogobot_ticks++; msleep(10); } }\n"
        },
    )
    made(project, "bin", f"POGO_SDK={sdk}")
    functions = listing(project / "build" / "bin" / "firmware.elf")
    assert "main" in functions
    assert "pogo_main_loop_step" not in functions


def test_category_that_no_controller_is_for_is_an_error(project: Path, sdk: Path) -> None:
    unknown = make(project, "bin", f"POGO_SDK={sdk}", "ROBOT_CATEGORY=robot")
    assert unknown.code == 2
    assert "This program has no pogobot_start() for robots of category 'robot' (ROBOT_CATEGORY)" in unknown.errors
    assert not (project / "build" / "bin" / "firmware.bin").exists()
    words = make(project, "bin", f"POGO_SDK={sdk}", "ROBOT_CATEGORY=my robots")
    assert "ROBOT_CATEGORY must be one word, found 'my robots'" in words.errors


def test_library_of_pogoutils_include_dir_is_in_the_firmware(project: Path, sdk: Path) -> None:
    library = project.parent / "utils" / "src" / "util"
    library.mkdir(parents=True)
    (library / "sums.h").write_text("int sum_of(int a, int b);\n")
    (library / "sums.c").write_text('#include "sums.h"\nint sum_of(int a, int b) { return a + b; }\n')
    main = project / "main.c"
    text = main.read_text().replace('#include "pogobase.h"', '#include "pogobase.h"\n#include "util/sums.h"', 1)
    main.write_text(text.replace("pogobot_init();", "pogobot_init();\n    srand(sum_of(rand(), 1));", 1))
    result = make(project, "bin", f"POGO_SDK={sdk}", f"POGOSIM_DIR={ROOT}", "POGOUTILS_INCLUDE_DIR=../utils/src")
    assert result.code == 0, result.text
    assert "sums.c" in compiled(result)


def test_cpp_program_becomes_firmware(project: Path, sdk: Path) -> None:
    header = (PROGRAMS / "two_files" / "userdata.h").read_text()
    count = (PROGRAMS / "two_files" / "count.c").read_text()
    main = (PROGRAMS / "two_files" / "main.c").read_text()
    write(project, {"main.cpp": main, "count.c": count, "userdata.h": header})
    made(project, "bin", f"POGO_SDK={sdk}")
    assert "myuserdata" in listing(project / "build" / "bin" / "firmware.elf")


def test_only_what_changed_is_compiled_for_the_robot_again(project: Path, sdk: Path) -> None:
    everything = {"main.c", "main_loop.c", "colormaps.c"}
    assert compiled(made(project, "bin", f"POGO_SDK={sdk}")) == everything
    assert compiled(made(project, "bin", f"POGO_SDK={sdk}")) == set()
    (project / "main.c").write_text((project / "main.c").read_text().replace("HELLO", "GOOD MORNING"))
    assert compiled(made(project, "bin", f"POGO_SDK={sdk}")) == {"main.c"}
    assert b"GOOD MORNING" in (project / "build" / "bin" / "firmware.bin").read_bytes()


def test_options_of_the_simulation_are_not_those_of_the_robot(project: Path, sdk: Path) -> None:
    built_with = made(project, "bin", f"POGO_SDK={sdk}", "CFLAGS=-O0 -DELSE", "CC=no-such-compiler").output
    assert "-DELSE" not in built_with
    assert "-march=rv32im -mabi=ilp32" in built_with


def test_connect_starts_the_terminal_of_the_sdk(project: Path, sdk: Path) -> None:
    refused = make(project, "connect", f"POGO_SDK={sdk}")
    assert (refused.code, "There is no build/bin/firmware.bin yet: make bin" in refused.errors) == (2, True)
    made(project, "bin", f"POGO_SDK={sdk}")
    started = made(project, "connect", f"POGO_SDK={sdk}", "TTY=/dev/ttyUSB7").output
    options = "--serial-boot --kernel build/bin/firmware.bin --kernel-adr 0x260000 --safe /dev/ttyUSB7"
    assert f"terminal {options}\n" in started
    other = made(project, "connect", f"POGO_SDK={sdk}", "TTY=/dev/ttyUSB7", "POGO_TERMINAL=echo other")
    assert f"other {options}\n" in other.output


def test_missing_sdk_or_compiler_is_one_clear_line(project: Path, sdk: Path, tmp_path: Path) -> None:
    absent = "There is no Pogobot SDK in ../../pogobot-sdk: get it, then make bin POGO_SDK=<its folder>"
    assert sentence(make(project, "bin")) == absent
    assert sentence(make(project, "connect")) == absent.replace("bin", "connect")

    # A PATH with make and what it needs, but no compiler for robots.
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in ("make", "sh", "pkg-config"):
        (tools / tool).symlink_to(shutil.which(tool) or "")
    without = make(project, "bin", f"POGO_SDK={sdk}", environment={"PATH": str(tools)})
    advice = "is not installed: apt-get install gcc-riscv64-unknown-elf"
    assert sentence(without) == f"The compiler for robots, riscv64-unknown-elf-gcc, {advice}"

    shutil.rmtree(project / "pogosim")
    nowhere = make(project, "bin", f"POGO_SDK={sdk}")
    assert sentence(nowhere) == "Pogosim is not found: make bin POGOSIM_DIR=<its folder>"
