"""`make emu`: programs become firmware for the emulated processor, with the robots' compiler and without their SDK."""

from __future__ import annotations

import re
import shutil
import struct
from pathlib import Path

import pytest
from firmwares import add_pogosim, project_of
from project import compiled, copy_template, made, make, sentence, write
from robot_sdk import CPU_FLAGS, TRIPLE, call, make_sdk, need
from running import PROGRAMS, ROOT, Run

EMU = ROOT / "src" / "emu"
MEMORY_BYTES = 128 * 1024
EXAMPLES = sorted({path.parent for path in ROOT.glob("examples/*/main.c*")})
OF_SDK = sorted({path.parent for path in (PROGRAMS / "sdk").glob("*/main.c*")})
# Registers are no part of the library: such a program does not link, see below.
REGISTERS = {"10_registers"}
SINGLE = [PROGRAMS / name for name in ("sample.c", "console.c", "waits.c", "endless.c", "magnetometer_sdk.c")]
SINGLE.append(ROOT / "python" / "pogosim" / "calibration" / "protocol.c")
# unimp: an instruction that no processor has.
ILLEGAL = bytes.fromhex("731000c0")
EXECUTABLE, RISC_V, LOADED = 2, 243, 1
PRINTS = """#include "pogobot.h"
int main(void) {
    USES
    for (;;) { msleep(10); }
}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    need(f"{TRIPLE}-gcc")
    return add_pogosim(copy_template(tmp_path / "swarm"))


def firmware_of(folder: Path) -> Path:
    return folder / "build" / "emu" / "firmware.elf"


def symbols(firmware: Path) -> dict[str, int]:
    """Addresses of all symbols; none is undefined."""
    assert call(f"{TRIPLE}-nm", "-u", firmware) == ""
    lines = (line.split() for line in call(f"{TRIPLE}-nm", firmware).splitlines())
    return {name: int(address, 16) for address, _, name in lines}


def check_firmware(firmware: Path) -> dict[str, int]:
    """Check that a file is a program for the robots' processor that fits into its memory; return its symbols."""
    file = firmware.read_bytes()
    assert file[:6] == b"\177ELF\1\1"  # 32 bits, little-endian
    kind, machine, _, entry, headers, _, flags = struct.unpack_from("<HHIIIII", file, 16)
    assert (kind, machine, flags) == (EXECUTABLE, RISC_V, 0)  # neither compressed code nor floating-point registers
    size, count = struct.unpack_from("<HH", file, 42)
    for number in range(count):
        segment = struct.unpack_from("<IIIIII", file, headers + number * size)
        virtual, physical, _, in_memory = segment[2:]
        if segment[0] == LOADED:
            assert virtual == physical
            assert 0 <= physical <= physical + in_memory <= MEMORY_BYTES
    names = symbols(firmware)
    assert names["_start"] == entry == 0
    assert "main" in names
    assert names["__bss_end"] <= names["__heap_start"] <= names["__heap_end"] < names["__stack_top"] == MEMORY_BYTES
    return names


def built(folder: Path, *arguments: str) -> dict[str, int]:
    """Build a firmware without warnings; return its symbols."""
    result = made(folder, "emu", *arguments)
    assert result.errors == ""
    return check_firmware(firmware_of(folder))


# ---- Programs


def test_template_becomes_firmware(project: Path) -> None:
    result = made(project, "clean", "emu")
    said = "for robots of category 'robots': pogosim run build/emu/firmware.elf -c <conf>"
    assert result.output.splitlines()[-1] == f"Built build/emu/firmware.elf {said}"
    assert re.search(r"text\s+data\s+bss.*\n(\s+\d+){4}.*firmware\.elf", result.output)
    names = check_firmware(firmware_of(project))
    assert {"pogobot_ticks", "myuserdata", "pogobot_led_setColor", "uart_write"} <= names.keys()
    # Only what is used.
    assert {"default_walls_user_init", "hsv_to_rgb", "read_page_flash", "_master_mute"} & names.keys() == set()
    assert not (project / "build" / "bin").exists()
    assert {path.name for path in project.iterdir()} & {"swarm", "swarm.so"} == set()


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda path: path.name)
def test_example_becomes_firmware(folder: Path, tmp_path: Path) -> None:
    sources = [path for path in folder.iterdir() if path.suffix in {".c", ".cpp", ".h"}]
    project = project_of(tmp_path / folder.name, *sources)
    for header in ROOT.glob("examples/*/*.h"):  # one example includes a header of another
        (tmp_path / header.parent.name).mkdir(exist_ok=True)
        shutil.copy(header, tmp_path / header.parent.name)
    names = built(project)
    uses_layer = any('"pogobase.h"' in path.read_text() for path in sources)
    assert ("pogobot_ticks" in names) == uses_layer


def test_most_examples_use_the_loop() -> None:
    assert len(EXAMPLES) > 25
    assert sum('"pogobase.h"' in (folder / "main.c").read_text() for folder in EXAMPLES) > len(EXAMPLES) - 3


@pytest.mark.parametrize(
    "folder", [path for path in OF_SDK if path.name not in REGISTERS] + [PROGRAMS / "two_files"], ids=lambda p: p.name
)
def test_program_of_others_becomes_firmware(folder: Path, tmp_path: Path) -> None:
    made(project_of(tmp_path / "program", *folder.iterdir()), "emu")  # their warnings are theirs
    check_firmware(firmware_of(tmp_path / "program"))


@pytest.mark.parametrize("source", SINGLE, ids=lambda path: path.stem)
def test_program_of_the_tests_becomes_firmware(source: Path, tmp_path: Path) -> None:
    made(project_of(tmp_path / "program", source), "emu")
    check_firmware(firmware_of(tmp_path / "program"))


def test_registers_of_the_hardware_do_not_link(tmp_path: Path) -> None:
    [folder] = [path for path in OF_SDK if path.name in REGISTERS]
    refused = make(project_of(tmp_path / "registers", *folder.iterdir()), "emu")
    assert refused.code == 2
    assert "undefined reference to `timer0_value_read'" in refused.errors
    assert not firmware_of(tmp_path / "registers").exists()


def test_program_for_the_robots_alone_has_no_loop_of_ours(project: Path) -> None:
    own = "uint32_t pogobot_ticks; pogobot_ticks++;"
    write(project, {"main.c": PRINTS.replace("USES", f"static {own}")})
    assert {"main_loop_hz", "_global_timer", "timer_main_loop"} & built(project).keys() == set()


def test_c_library_is_there(project: Path) -> None:
    uses = r"""
    srand(3);
    float const x = sqrtf((float)rand()) + powf(2.0f, 0.3f) + (float)sin(rand());
    char* const text = malloc(100);
    snprintf(text, 100, "%.3f %lu %ld %5s", (double)x, (unsigned long)rand(), (long)rand(), "text");
    printf("%s %e %d\n", text, strtod(text, NULL), getchar());
    puts(text), putchar('x'), fprintf(stderr, "%d\n", memcmp(text, "a", 1));
    usleep(3), sleep(1), free(text);
    if (rand()) abort();
    exit(1);
    """
    program = PRINTS.replace("USES", uses).replace('#include "pogobot.h"', '#include "pogobot.h"\n#include <math.h>')
    write(project, {"main.c": program.replace("#include <math.h>", "#include <math.h>\n#include <unistd.h>")})
    names = built(project)
    assert {"uart_write", "stdout", "stderr", "sbrk", "vfprintf", "sin"} <= names.keys()


def test_cpp_program_has_its_constructors_called(project: Path) -> None:
    program = """#include "pogobase.h"
struct Shape {
    virtual ~Shape() {}
    virtual int corners() = 0;
};
struct Square : Shape {
    int n;
    Square() : n(rand()) { printf("new\\n"); }
    int corners() override { return n; }
};
static Square square;
struct USERDATA { Shape* shape; int count = 5; };
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void user_init(void) { mydata->shape = new Square[2]; }
void user_step(void) { printf("%d %d\\n", mydata->shape->corners(), square.corners()); delete mydata->shape; }
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); }
"""
    write(project, {"main.cpp": program})
    names = built(project)
    assert names["__init_array_end"] > names["__init_array_start"]


def test_library_of_pogoutils_include_dir_is_in_the_firmware(project: Path) -> None:
    library = project.parent / "utils" / "src" / "util"
    library.mkdir(parents=True)
    (library / "sums.h").write_text("int sum_of(int a, int b);\n")
    (library / "sums.c").write_text('#include "sums.h"\nint sum_of(int a, int b) { return a + b; }\n')
    main = project / "main.c"
    text = main.read_text().replace('#include "pogobase.h"', '#include "pogobase.h"\n#include "util/sums.h"', 1)
    main.write_text(text.replace("pogobot_init();", "pogobot_init();\n    srand(sum_of(rand(), 1));", 1))
    assert "sums.c" in compiled(made(project, "emu", "POGOUTILS_INCLUDE_DIR=../utils/src"))


# ---- The library


def include_all() -> str:
    """Return C code with all headers that a program may include."""
    says_something = {"csr.h", "mem.h", "common.h"}  # registers
    not_included = {"pogobot.h", "pogosim_sdk_program.h", "pogosim_hardware.h", "pogobot_old_names.h", *says_something}
    sdk = ROOT / "include" / "sdk"
    names = [str(path.relative_to(sdk)) for path in sorted(sdk.rglob("*.h")) if path.name not in not_included]
    assert len(names) > 15
    return '#include "pogobot.h"\n' + "".join(f"#include <{name}>\n" for name in names)


def compile_text(folder: Path, text: str, *options: str, suffix: str = ".c") -> Path:
    """Compile a text as `make emu` does, with all warnings."""
    source = folder / f"main{suffix}"
    source.write_text(text)
    includes = [f"-I{EMU}", f"-I{ROOT / 'include'}", f"-I{ROOT / 'include' / 'sdk'}"]
    program, standard = ("g++", "gnu++20") if suffix == ".cpp" else ("gcc", "gnu99")
    flags = [f"-std={standard}", "--specs=picolibc.specs", *CPU_FLAGS, "-DREAL_ROBOT", *includes]
    warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    call(f"{TRIPLE}-{program}", *flags, *warnings, *options, "-c", source, "-o", folder / "main.o")
    return folder / "main.o"


def test_each_function_of_the_headers_is_a_symbol_that_no_processor_executes(tmp_path: Path) -> None:
    listing = tmp_path / "functions.txt"
    compile_text(tmp_path, include_all(), "-aux-info", str(listing))
    places = "|".join(re.escape(str(folder)) for folder in (EMU, ROOT / "include"))
    declared = set()
    for where, what in re.findall(r"^/\* (\S+):\d+:N[CF] \*/ extern (.*);", listing.read_text(), re.MULTILINE):
        if re.match(places, where):
            declared |= {name for name in re.findall(r"(\w+) \(", what) if name != "__attribute__"}
    assert {"pogobot_motor_set", "magn_check", "slip_send_message", "uart_write", "msleep", "usleep"} <= declared

    assembled = tmp_path / "stubs.o"
    call(f"{TRIPLE}-gcc", *CPU_FLAGS, "-c", EMU / "stubs.S", "-o", assembled)
    lines = call(f"{TRIPLE}-readelf", "-sW", assembled).splitlines()
    functions = {line.split()[7]: line.split()[2:7] for line in lines if re.search(r" (GLOBAL|WEAK) ", line)}
    of_libc = {"abort"}
    assert declared == set(functions) - of_libc
    assert {tuple(found[:2]) for found in functions.values()} == {("4", "FUNC")}
    sections = [found[4] for found in functions.values()]
    assert len(set(sections)) == len(sections)
    call(f"{TRIPLE}-objcopy", "-O", "binary", "--only-section=.text.msleep", assembled, tmp_path / "code")
    assert (tmp_path / "code").read_bytes() == ILLEGAL


@pytest.mark.parametrize("suffix", [".c", ".cpp"])
@pytest.mark.parametrize("first", ["pogobot.h", "pogobase.h"])
def test_all_headers_compile_in_both_languages(first: str, suffix: str, tmp_path: Path) -> None:
    text = include_all().replace("pogobot.h", first, 1) + "int main(void) { return 0; }\n"
    compile_text(tmp_path, text.replace("#include <math.h>\n", ""), suffix=suffix)


def test_types_are_those_of_the_robot(tmp_path: Path) -> None:
    text = """#include "pogobot.h"
#ifdef SIMULATOR
#error "on a robot, SIMULATOR is not defined"
#endif
_Static_assert(sizeof(time_reference_t) == 4, "the counter alone");
_Static_assert(sizeof(message_t) == 8 + 382 && sizeof(short_message_t) == 4 + 382, "messages");
uint8_t* mute(void);
uint8_t* mute(void) { return &_master_mute; }
void (*recover(void))(message_t*);
void (*recover(void))(message_t*) { return pogobot_infrared_recover_next_message; }
"""
    wanted = call(f"{TRIPLE}-nm", "-u", compile_text(tmp_path, text, "-std=gnu11")).split()
    assert set(wanted) == {"U", "_master_mute", "pogobot_infrared_recover_next_message"}


def test_packets_may_be_sent_as_with_both_sdks(project: Path) -> None:
    uses = """
    uint8_t data[9] = {0};
    if (slip_send_message(&slip_send_descriptor, data, 9) == SLIP_NO_ERROR) { _master_mute = 1; }
    slip_send_message(&slip_send_descriptor, data, 9, 1);
    if (is_muted()) { spiBeginErase4(0); }
    """
    declared = (
        '#include "slip.h"\n#include "spi.h"\nextern const slip_send_descriptor_s slip_send_descriptor;\nint main'
    )
    write(project, {"main.c": PRINTS.replace("USES", uses).replace("int main", declared)})
    assert {"slip_send_message", "_master_mute", "slip_send_descriptor", "spiBeginErase4"} <= built(project).keys()


# ---- make


def options(result: Run, source: str) -> set[str]:
    """Options with which a file was compiled, but for folders."""
    (line,) = (line for line in result.output.splitlines() if re.search(rf" {source} -o", line))
    return {word for word in line.split() if word.startswith("-") and not word.startswith("-I")}


def test_code_is_compiled_as_for_a_robot(project: Path, tmp_path: Path) -> None:
    sdk = make_sdk(tmp_path / "sdk")
    result = made(project, "emu", "CFLAGS=-O0", "CC=no-such-compiler")
    emulated = options(result, "main.c")
    assert "-flto" not in options(result, r"\S*runtime.c")
    wanted = "-DREAL_ROBOT -DROBOT_CATEGORY=robots -march=rv32im -mabi=ilp32 -D__vexriscv__ -std=gnu99 -Os -g3"
    assert {*wanted.split(), "-fno-builtin", "-flto", "-ffunction-sections", "-fdata-sections"} <= emulated
    of_sdk = options(made(project, "bin", f"POGO_SDK={sdk}"), "main.c")
    assert {option for option in of_sdk ^ emulated if not option.startswith("-W")} == {
        *("-fexceptions", "-fomit-frame-pointer", "-fno-stack-protector")
    }


def test_only_what_changed_is_compiled_again(project: Path) -> None:
    everything = {"main.c", "main_loop.c", "colormaps.c", "runtime.c"}
    assert compiled(made(project, "emu")) == everything
    again = made(project, "emu")
    assert (compiled(again), "-o build" in again.output) == (set(), False)
    assert "Built build/emu/firmware.elf" in again.output
    (project / "main.c").write_text((project / "main.c").read_text().replace("HELLO", "GOOD MORNING"))
    assert compiled(made(project, "emu")) == {"main.c"}
    assert b"GOOD MORNING" in firmware_of(project).read_bytes()
    assert compiled(made(project, "clean", "emu")) == everything


def test_category_chooses_the_controller_and_must_have_one(project: Path) -> None:
    text = (project / "main.c").read_text()
    (project / "main.c").write_text(
        text.replace(
            "pogobot_start(user_init, user_step);",
            """
    pogobot_start(user_init, user_step, "leaders");""",
        )
    )
    failed = make(project, "emu")
    assert failed.code == 2
    assert "This program has no pogobot_start() for robots of category 'robots' (ROBOT_CATEGORY)" in failed.errors
    assert not firmware_of(project).exists()
    result = made(project, "emu", "ROBOT_CATEGORY=leaders")
    assert "for robots of category 'leaders'" in result.output
    words = make(project, "emu", "ROBOT_CATEGORY=my robots")
    assert "ROBOT_CATEGORY must be one word, found 'my robots'" in words.errors


@pytest.mark.parametrize(("kib", "fits"), [(105, True), (126, False)])
def test_program_that_is_too_large_for_the_robot_is_refused(kib: int, fits: bool, project: Path) -> None:
    uses = f"static char text[{kib * 1024}]; printf(text); text[rand()] = 1;"
    write(project, {"main.c": PRINTS.replace("USES", uses)})
    result = make(project, "emu")
    advice = "code, data and 2 KiB of stack need more than its 128 KiB of memory"
    assert (result.code, f"the program does not fit into the robot: {advice}" in result.errors) == (
        0 if fits else 2,
        not fits,
    )
    assert firmware_of(project).exists() == fits


def test_place_of_pogosim_and_project_may_have_blanks(tmp_path: Path) -> None:
    pogosim = tmp_path / "John Doe" / "my pogosim"
    shutil.copytree(ROOT / "include", pogosim / "include")
    for name in ("emu", "interface"):
        shutil.copytree(ROOT / "src" / name, pogosim / "src" / name)
    folder = copy_template(tmp_path / "John Doe" / "swarm")
    made(folder, "emu", f"POGOSIM_DIR={pogosim}")
    assert compiled(made(folder, "emu", f"POGOSIM_DIR={pogosim}")) == set()
    (folder / "pogosim").symlink_to(pogosim)
    built(folder)


def test_build_folder_may_be_elsewhere(project: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    made(project, "emu", f"BUILD_DIR={elsewhere}")
    check_firmware(elsewhere / "emu" / "firmware.elf")
    assert not (project / "build").exists()


def test_what_is_missing_is_one_clear_line(project: Path, tmp_path: Path) -> None:
    need(f"{TRIPLE}-gcc")
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in ("make", "sh", "pkg-config"):
        (tools / tool).symlink_to(shutil.which(tool) or "")
    path = {"PATH": str(tools)}
    without = sentence(make(project, "emu", environment=path))
    advice = "is not installed: apt-get install gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf"
    assert without == f"The compiler for robots, riscv64-unknown-elf-gcc, {advice}"

    # A compiler that knows no picolibc says the name that it was asked for.
    (tools / f"{TRIPLE}-gcc").write_text('#!/bin/sh\necho "${1#*=}"\n')
    (tools / f"{TRIPLE}-gcc").chmod(0o755)
    advice = "picolibc, is not installed: apt-get install picolibc-riscv64-unknown-elf"
    assert sentence(make(project, "emu", environment=path)) == f"The C library for robots, {advice}"

    (project / "main.c").unlink()
    assert sentence(make(project, "emu")) == "There is no .c or .cpp file in this folder"
    shutil.rmtree(project / "pogosim")
    assert sentence(make(project, "emu")) == "Pogosim is not found: make emu POGOSIM_DIR=<its folder>"
    assert "Rename the folder" in sentence(make(copy_template(tmp_path / "emu"), "emu"))
