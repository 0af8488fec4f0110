"""A stand-in for the Pogobot SDK, laid out like the real one, so that firmware is compiled and linked in earnest.

Its header is tests/programs/sdk_stub/pogobot.h; the functions behind it do nothing. The C library is Debian's picolibc.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from running import PROGRAMS, compiler

STUB = PROGRAMS / "sdk_stub"
TRIPLE = "riscv64-unknown-elf"
PICOLIBC = Path("/usr/lib/picolibc") / TRIPLE
CPU_FLAGS = ["-march=rv32im", "-mabi=ilp32"]
# The options of the SDK, as far as they matter here.
FLAGS = [*CPU_FLAGS, "-Os", "-fno-builtin", "--specs=picolibc.specs"]

VARIABLES = f"""TRIPLE=riscv64-unknown-elf
CPU=vexriscv
CPUFLAGS={" ".join(CPU_FLAGS)} -D__vexriscv__
ROM_BASE=0x260000
SPIFLASH_BASE=0x200000
"""
COMMON = """CC = $(TRIPLE)-gcc -std=gnu99
CFLAGS = -Os $(CPUFLAGS) -g3 -Wall -Werror -Wstrict-prototypes -fno-builtin -fexceptions --specs=picolibc.specs
define compile
$(CC) -c $(CFLAGS) $(1) $< -o $@
endef
"""
LINKER_SCRIPT = """ENTRY(_start)
MEMORY {
    sram (rwx) : ORIGIN = 0, LENGTH = 128K
    rom (rx) : ORIGIN = 0x260000, LENGTH = 64K
}
SECTIONS {
    .text : { KEEP(*(.text.start)) *(.text .text.*) *(.rodata .rodata.* .srodata .srodata.*) } > rom
    .data : { *(.data .data.* .sdata .sdata.*) } > sram AT > rom
    .bss : { *(.bss .bss.* .sbss .sbss.* COMMON) } > sram
    /DISCARD/ : { *(.eh_frame) }
}
"""
START = """
static int put(char c, FILE* file) { (void)c; (void)file; return 0; }
static FILE console = FDEV_SETUP_STREAM(put, NULL, NULL, _FDEV_SETUP_WRITE);
FILE* const stdout = &console;
int main(void);
__attribute__((section(".text.start"))) void _start(void) { main(); for (;;) {} }
"""


def need(program: str) -> str:
    """Return a program of the robots' toolchain, which ./test.sh installs."""
    assert compiler(program), f"{program} is missing: apt-get install gcc-{TRIPLE} picolibc-{TRIPLE}"
    return program


def call(*command: str | Path) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(str(part) for part in command)}\n{done.stderr}"
    return done.stdout


def definitions() -> str:
    """C code with a function for each that the header declares."""
    header = re.sub(r"//.*", "", (STUB / "pogobot.h").read_text())
    declared = re.findall(r"^(\w+) (\w+)\(([^)]*)\);", header, re.MULTILINE)
    assert len(declared) > 30
    functions = []
    for result, name, parameters in declared:
        unused = "".join(f" (void){parameter};" for parameter in re.findall(r"(\w+)(?:,|$)", parameters))
        body = unused.replace(" (void)void;", "") + ("" if result == "void" else " return 0;")
        functions.append(f"{result} {name}({parameters}) {{{body} }}\n")
    return '#include "pogobot.h"\n' + "".join(functions)


def make_sdk(folder: Path) -> Path:
    """Make an SDK with tools/, includes/ and libs/."""
    for name in ("tools", "includes", "libs"):
        (folder / name).mkdir(parents=True)
    (folder / "includes" / "pogobot.h").write_text((STUB / "pogobot.h").read_text())
    (folder / "tools" / "variables.mak").write_text(VARIABLES)
    (folder / "tools" / "common.mak").write_text(COMMON)
    (folder / "tools" / "linker.ld").write_text(LINKER_SCRIPT)
    terminal = folder / "tools" / "serial_terminal.sh"
    terminal.write_text('#!/bin/sh\necho "terminal $*"\n')
    terminal.chmod(0o755)

    gcc = need(f"{TRIPLE}-gcc")
    source = folder / "pogobot.c"
    source.write_text(definitions() + START)
    call(gcc, *FLAGS, "-Wall", "-Werror", f"-I{folder / 'includes'}", "-c", source, "-o", folder / "pogobot.o")
    call(f"{TRIPLE}-ar", "rc", folder / "libs" / "libpogobot.a", folder / "pogobot.o")
    variant = call(gcc, *FLAGS, "-print-multi-directory").strip()
    libc = PICOLIBC / "lib" / variant / "libc.a"
    assert libc.exists(), f"{libc} is missing: apt-get install picolibc-{TRIPLE}"
    (folder / "libs" / "libc.a").symlink_to(libc)
    (folder / "libs" / "libcompiler_rt.a").symlink_to(call(gcc, *FLAGS, "-print-libgcc-file-name").strip())
    return folder
