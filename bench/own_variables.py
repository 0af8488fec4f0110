"""What it costs that robots have variables of their own, and that they wait in the middle of their programs.

    .venv/bin/python bench/own_variables.py [number of robots, 1000 without it]

Robots with 4 kB of variables drive and blink for 30 s, on one thread and without rows. Their variables are in USERDATA,
or globals with `robot_memory: own`, or those of a program for the robots' SDK. The runs take turns; of each kind, the
one that has used least processor time counts.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from options import at_least_one, check_built

ROOT = Path(__file__).resolve().parents[1]
KINDS = {"USERDATA": "pogosim", "GLOBALS": "pogosim", "SDK": "pogosim-sdk"}
TURNS = 5
SECONDS = 30  # simulated
WORLD = """
arena_file: {root}/arenas/disk.csv
arena_surface: {surface_mm2}
simulation_time: {seconds}
time_step: 0.01
initial_formation: random
enable_data_logging: false
robot_memory: {memory}
objects: {{robots: {{type: pogobot, nb: {robots}}}}}
"""


def compiled(folder: Path, kind: str) -> Path:
    """Compile the program of one kind."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(ROOT / "build" / "release")}
    asked = ["pkg-config", "--cflags", "--libs", KINDS[kind]]
    flags = subprocess.run(asked, env=environment, check=True, capture_output=True, text=True).stdout.split()
    source = str(ROOT / "bench" / "own_variables.c")
    subprocess.run(["cc", "-O2", f"-DIN_{kind}", source, "-o", str(folder / kind), *flags], check=True)
    return folder / kind


def processor_s(program: Path, robots: int, seconds: float) -> float:
    """Return the processor time of a run."""
    memory = "auto" if program.name != "GLOBALS" else "own"
    text = WORLD.format(root=ROOT, surface_mm2=1e4 * robots, seconds=seconds, memory=memory, robots=robots)
    (program.parent / "world.yaml").write_text(text)
    command = [str(program), "-c", "world.yaml", "-g", "-q", "-nr"]
    process = subprocess.Popen(command, cwd=program.parent, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(command)}: failed")
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Measure the kinds by turns."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "robots", nargs="?", type=at_least_one, default=1000, help="number of robots (default %(default)s)"
    )
    robots = parser.parse_args().robots
    check_built(parser, ROOT / "build" / "release" / "pogosim.pc")
    for tool in ("cc", "pkg-config"):
        if shutil.which(tool) is None:
            parser.error(f"{tool} is not installed (Debian, Ubuntu: apt install gcc pkg-config)")
    with tempfile.TemporaryDirectory() as name:
        programs = {kind: compiled(Path(name), kind) for kind in KINDS}
        start_s = {kind: processor_s(program, robots, 0.01) for kind, program in programs.items()}
        least_s = dict.fromkeys(KINDS, float("inf"))
        for _ in range(TURNS):
            for kind, program in programs.items():
                least_s[kind] = min(least_s[kind], processor_s(program, robots, SECONDS) - start_s[kind])
    steps = SECONDS / 0.01 * robots
    for kind, run_s in least_s.items():
        times = run_s / least_s["USERDATA"]
        print(f"{kind:10s}{run_s:7.2f} s; {run_s / steps * 1e6:6.3f} us per robot and step, {times:5.2f} times")


if __name__ == "__main__":
    main()
