"""Headers of the robots' SDK by name: what is simulated runs, what is hardware does not compile and says what to do."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from running import ROOT, compile_text, compiler, pkg_config, run

HEADERS = [
    str(path.relative_to(ROOT / "include" / "sdk"))
    for path in sorted((ROOT / "include" / "sdk").rglob("*.h"))
    if path.name not in {"pogobot.h", "pogosim_sdk_program.h", "pogosim_hardware.h"}
]
COMPILERS = [
    (name, flags, suffix)
    for name, flags, suffix in [
        (compiler("gcc"), "-std=c11", ".c"),
        (compiler("clang", "clang-14"), "-std=c11", ".c"),
        (compiler("g++"), "-std=c++17", ".cpp"),
        (compiler("clang++", "clang++-14"), "-std=c++20", ".cpp"),
    ]
    if name
]
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]
WAYS = {
    "pogobase.h": '#include "pogobase.h"\n',
    "pogobot.h": '#include "pogobot.h"\n',
    "both": '#include "pogobase.h"\n#include "pogobot.h"\n',
}


def check_syntax(source: Path, text: str, name: str, flags: list[str]) -> str:
    """Compile a text without linking it; return what the compiler says."""
    source.write_text(text)
    command = [name, *flags, *pkg_config("--cflags"), "-c", str(source), "-o", str(source.with_suffix(".o"))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stderr


@pytest.mark.parametrize(("name", "standard", "suffix"), COMPILERS)
@pytest.mark.parametrize("way", sorted(WAYS))
def test_all_headers_may_be_included_in_every_language(
    name: str, standard: str, suffix: str, way: str, tmp_path: Path
) -> None:
    quiet = [header for header in HEADERS if header not in {"generated/csr.h", "hw/common.h"}]  # which say something
    text = WAYS[way] + "".join(f"#include <{header}>\n" for header in quiet) + "int main(void) { return 0; }\n"
    assert check_syntax(tmp_path / f"main{suffix}", text, name, [standard, *STRICT]) == ""


@pytest.mark.parametrize("header", [header for header in HEADERS if header != "magnetometer.h"])  # includes pogobot.h
def test_each_header_may_be_included_first_and_alone(header: str, tmp_path: Path) -> None:
    text = f'#include "{header}"\n#include "pogobase.h"\nint main(void) {{ return 0; }}\n'
    assert "error" not in check_syntax(tmp_path / "main.c", text, "cc", ["-std=c11", "-Wall"])


def hardware_functions() -> list[tuple[str, str]]:
    """All functions that are marked as not simulated, with their headers."""
    found = []
    for header in HEADERS:
        text = (ROOT / "include" / "sdk" / header).read_text()
        declared = re.findall(r"^[a-z]\w*[\w ]*\*? ?\b(\w+)\([^()]*\)\s+POGO_NO", text, re.MULTILINE)
        found += [(header, function) for function in declared]
    return found


def test_many_functions_are_hardware() -> None:
    assert len(hardware_functions()) > 50


@pytest.mark.parametrize(("name", "standard", "suffix"), COMPILERS)
def test_each_use_of_hardware_is_an_error_that_says_what_to_do(
    name: str, standard: str, suffix: str, tmp_path: Path
) -> None:
    functions = hardware_functions()
    uses = "".join(f"void use_{i}(void) {{ (void)&{function}; }}\n" for i, (_, function) in enumerate(functions))
    includes = "".join(f'#include "{header}"\n' for header in sorted({header for header, _ in functions}))
    text = f'#include "pogobase.h"\n{includes}{uses}int main(void) {{ return 0; }}\n'
    said = check_syntax(
        tmp_path / f"main{suffix}", text, name, [standard, "-fmax-errors=0" if "g" in name[0] else "-ferror-limit=0"]
    )
    for _, function in functions:
        (line,) = (line for line in said.splitlines() if re.search(rf"error: .*\W{function}\W.*unavailable", line))
        assert re.search(r"#ifndef SIMULATOR|call |simulated|DEADBEEF", line), line


def test_hardware_between_ifndef_simulator_compiles(tmp_path: Path) -> None:
    text = """#include "pogobase.h"
#include "spi.h"
int main(void) {
#ifndef SIMULATOR
    spiBeginErase4(0);
#endif
    return 0;
}
"""
    assert check_syntax(tmp_path / "main.c", text, "cc", STRICT) == ""


@pytest.mark.parametrize("address", ["SPIFLASH_BASE", "ROM_BASE", "CSR_BASE"])
def test_address_of_the_memory_map_is_an_error(address: str, tmp_path: Path) -> None:
    text = f'#include "pogobase.h"\n#include <generated/mem.h>\nchar* p(void) {{ return (char*){address}; }}\n'
    assert "not simulated" in check_syntax(tmp_path / "main.c", text, "cc", [])


PROGRAM = """#include "pogobase.h"
#include "FifoBuffer.h"
#include "console.h"
#include "imu.h"
#include "irq.h"
#include "release.h"
#include "rgb.h"
#include "sleep.h"
#include "spi.h"
#include "system.h"
#include "uart.h"
#include <generated/git.h>
#include <generated/soc.h>
FifoBuffer_typedef(int, Numbers);
static void user_step(void) {
    float acc[3], gyro[3];
    int memory[3], first = 0, second = 0;
    uint8_t directions[3];
    Numbers numbers;
    Numbers* queue = &numbers;
    FifoBuffer_init(queue, 3, int, memory);
    for (int i = 1; i <= 4; i++) {
        FifoBuffer_write(queue, i);
    }
    int const full = FifoBuffer_is_full(queue);
    FifoBuffer_peek(queue, second, 1);
    FifoBuffer_read(queue, first);
    printf("queue %d %d %d %d %d\\n", full, first, second, FifoBuffer_count(queue), FifoBuffer_is_empty(queue));
    FifoBuffer_flush(queue);
    FifoBuffer_read(queue, first);
    printf("flushed %d %d\\n", first, FifoBuffer_is_empty(queue));
    printf("imu %d %d %.1f %d\\n", readAcc(acc), readGyro(gyro), (double)readTemp(), gyro[2] == 0.0f);
    printf("release %s %lu\\n", RELEASE_VERSION, (unsigned long)CONFIG_CLOCK_FREQUENCY);
    int const is_read = getMotorDirMem(directions);
    printf("directions %d %d%d%d serial %d\\n", is_read, directions[0], directions[1], directions[2], (int)getSerial());
    unsigned const interrupts = irq_getie();
    irq_setie(0);
    flush_cpu_icache();
    irq_setie(interrupts);
    rgb_set_led(1, 2, 3, 1);
    rgb_set_u32(0x040506);
    while (uart_read_nonblock()) {
        uart_read();
    }
    putsnonl("li");
    uart_write('n');
    uart_write('e');
    putchar('\\n');
    busy_wait(20);
    msleep(5);
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    return 0;
}
"""


@pytest.mark.parametrize("name", ["main.c", "main.cpp"])
def test_functions_of_drivers_that_are_simulated_do_what_they_say(name: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, PROGRAM, name=name)
    result = run(program, tmp_path, {"objects.robots.nb": 1, "simulation_time": 0.05})
    assert result.code == 0, result.text
    assert [line.removeprefix("[ROBOT #0] [PRINTF] ") for line in result.robot_lines][:6] == [
        "queue 1 2 3 2 0",
        "flushed 2 1",
        "imu 0 0 42.0 1",
        "release v2.7.1 21000000",
        "directions 0 010 serial 0",
        "line",
    ]


OLD = """#include "pogobot.h"
int main(void) {
    pogobot_init();
    uint8_t text[3] = "ab";
    message_t raw = {0};
    raw.header._emitting_power_list = pogobot_infrared_emitting_power_list(3, 3, 3, 3);
    raw.header.payload_length = 3;
    memcpy(raw.payload, text, 3);
    for (int i = 0; i < 20; i++) {
        bool b = pogobot_infrared_sendMessageAllDirection(0x1234, text, sizeof(text));
        uint32_t r = pogobot_infrared_sendMessageAllDirectionWithId(0x1234, text, 3);
        r += pogobot_infrared_sendMessageOneDirection(ir_left, 0x1234, text, 3);
        r += pogobot_infrared_sendMessageOnce(&raw);
        if (i == 0) { printf("%d %d\\n", b, (int)r); }
        msleep(20);
    }
    return 0;
}
"""


def test_names_before_2024_are_those_of_today_with_one_option_of_the_compiler(tmp_path: Path) -> None:
    flags = ["-include", "pogobot_old_names.h", "-Wall", "-Wextra", "-Werror"]
    program = compile_text(tmp_path, OLD, package="pogosim-sdk", flags=flags)
    result = run(program, tmp_path, {"objects.robots.nb": 1, "message_log": "log.feather"})
    assert result.robot_lines == ["[ROBOT #0] [PRINTF] 0 0"]
    log = result.frame("log.feather")
    assert len(log) == 20 * (1 + 4 + 1 + 1)
