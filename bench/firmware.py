"""How fast robots run firmware: 100 robots with ticks of 5000 instructions at 60 Hz.

    .venv/bin/python bench/firmware.py

Needs ./build.sh and the robots' compiler (gcc-riscv64-unknown-elf, picolibc-riscv64-unknown-elf).
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import yaml
    from pogosim.errors import ToolError
    from pogosim.firmware.making import firmware_of
    from pogosim.installation import find_installation
except ImportError as missing:
    print(f"firmware.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

ROBOTS = 100
INSTRUCTIONS = 5000  # of a tick, about
SECONDS = 20.0
TICKS_PER_S = 62.5
PROGRAM = f"""#include "pogobase.h"
void user_init(void) {{}}
void user_step(void) {{
    uint32_t n = {INSTRUCTIONS // 2 - 100};
    asm volatile("1: addi %0, %0, -1\\n bnez %0, 1b" : "+r"(n));
    pogobot_motor_set(motorL, 500);
}}
int main(void) {{
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}}
"""


def measure() -> None:
    """Print a line for each way to count time.

    Raises:
        ToolError: The simulator or the robots' compiler is missing.
    """
    pogosim = find_installation()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "main.c").write_text(PROGRAM)
        with firmware_of(folder / "main.c", pogosim) as program:
            for cpu_time in ("off", "counted"):
                scene = {
                    "arena_file": "arenas/disk.csv",
                    "arena_surface": 1.0e4 * ROBOTS,
                    "simulation_time": SECONDS,
                    "enable_data_logging": False,
                    "GUI": False,
                    "objects": {
                        "robots": {
                            "type": "pogobot",
                            "nb": ROBOTS,
                            "brain": str(program.firmware),
                            "cpu_time": cpu_time,
                        }
                    },
                }
                (folder / "scene.yaml").write_text(yaml.safe_dump(scene))
                command = [str(pogosim.without_program), "-c", str(folder / "scene.yaml"), "-g", "-q"]
                begin = time.perf_counter()
                subprocess.run(command, check=True)
                wall_s = time.perf_counter() - begin
                instructions = ROBOTS * INSTRUCTIONS * TICKS_PER_S * SECONDS
                print(
                    f"cpu_time: {cpu_time:8} {SECONDS / wall_s:6.1f} x real time, "
                    f"{instructions / wall_s / 1e6:6.0f} million instructions per s"
                )


def main() -> int:
    """Run the command line; returns the exit code."""
    argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0]).parse_args()
    try:
        measure()
    except ToolError as error:
        print(f"firmware.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
