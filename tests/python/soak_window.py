"""Press random keys and move the mouse at random in the window of a running program, for as long as you like.

    .venv/bin/python tests/python/soak_window.py --minutes 30 --build build/asan --compiler clang

The program is compiled for the library in the build folder; the sanitizers of that library are used for it, too. A run
that the keys end or restart is started again. The first run that fails ends the soak, with exit code 1.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import sys
import tempfile
import time
from pathlib import Path

from display import HEIGHT, WIDTH, Display, Shown, open_display, shown
from running import PROGRAMS, compile_program

KEYS = [f"F{i}" for i in (1, 2, 3, 4, 5, 6, 7, 8, 9, 11)]
KEYS += ["space", "s", "S", "Left", "Right", "Up", "Down", "plus", "minus", "0", "KP_Add", "KP_Subtract", "KP_0", "q"]
RARE_KEYS = ["r", "R", "k", "o", "F12", "Escape"]
SCENE: dict[str, object] = {
    "simulation_time": 60.0,
    "GUI_speed_up": 2.0,
    "show_communication_channels": True,
    "objects.robots.nb": 40,
    "objects.blocks": {"type": "passive_object", "geometry": "rectangle", "nb": 5},
    "objects.ring": {"type": "membrane", "geometry": "disk", "radius": 120, "nb": 1, "serialize_dot_pose": True},
    "objects.lamp": {"type": "orbiting_static_light", "geometry": "disk", "radius": 200, "orbit_radius": 300},
}
FAILURE = re.compile(r"Sanitizer|runtime error|failed|Error:")


def act(window: Shown, display: Display, chance: random.Random) -> str:
    """Do one thing that a user could do; return what."""
    x, y = chance.randrange(-20, 900), chance.randrange(-20, 900)
    x2, y2 = chance.randrange(-20, 900), chance.randrange(-20, 900)
    kind = chance.choices(["key", "rare", "click", "drag", "wheel", "size", "hide"], [50, 1, 20, 15, 8, 3, 1])[0]
    if kind in ("key", "rare"):
        key = chance.choice(KEYS if kind == "key" else RARE_KEYS)
        window.keys(*[key] * chance.randrange(1, 4))
        return key
    if kind == "click":
        window.move_mouse(x, y)
        display.xdotool("click", str(chance.choice([1, 1, 1, 2, 3])))
    elif kind == "drag":
        button = str(chance.choice([1, 1, 2, 3]))
        window.move_mouse(x, y)
        display.xdotool("mousedown", button)
        window.move_mouse((x + x2) / 2, (y + y2) / 2)
        window.move_mouse(x2, y2)
        display.xdotool("mouseup", button)
    elif kind == "wheel":
        window.move_mouse(x, y)
        display.xdotool("click", "--repeat", str(chance.randrange(1, 20)), "--delay", "5", str(chance.choice([4, 5])))
    elif kind == "size":
        width, height = chance.choice([(1, 1), (40, 30), (300, 200), (800, 800), (WIDTH, HEIGHT), (2000, 90)])
        display.xdotool("windowsize", window.window, str(width), str(height))
    else:
        display.xdotool("windowunmap", window.window)
        time.sleep(0.3)
        display.xdotool("windowmap", window.window)
        display.xdotool("windowfocus", window.window)
    return f"{kind} at {x}, {y}"


def soak_one_run(window: Shown, display: Display, chance: random.Random, end: float) -> str:
    """Act until the program or the time ends. What went wrong, empty when nothing did."""
    done: list[str] = []
    while window.process.poll() is None and time.monotonic() < end:
        done.append(act(window, display, chance))
        if len(done) % 50 == 0:  # a restarted program has another window
            found = display.xdotool("search", "--onlyvisible", "--name", "Pogosim").split()
            if found:
                window.window = found[-1]
                display.xdotool("windowfocus", window.window)
    code = window.process.poll()
    text = window.text()
    if code not in (None, 0) or FAILURE.search(text):
        return f"exit code {code} after {', '.join(done[-20:])}\n{text[-8000:]}"
    return ""


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", default="build/release", help="folder of the library")
    parser.add_argument("--compiler", help="of the program: that of the library")
    options = parser.parse_args()
    os.environ["POGOSIM_BUILD_DIR"] = options.build
    cache = (Path(options.build) / "CMakeCache.txt").read_text()
    sanitizer = re.search(r"^POGOSIM_SANITIZE:\w+=(address|thread)$", cache, re.MULTILINE)
    flags = []
    if sanitizer:
        names = {"address": "address,undefined", "thread": "thread"}[sanitizer[1]]
        flags = [f"-fsanitize={names}", "-fsanitize-link-c++-runtime", "-lstdc++"]
    os.environ.setdefault("ASAN_OPTIONS", "detect_leaks=0")
    chance = random.Random(options.seed)
    end = time.monotonic() + 60.0 * options.minutes
    runs = 0
    with tempfile.TemporaryDirectory() as folder, open_display() as display:
        program = compile_program(
            Path(folder) / "window", PROGRAMS / "window.c", compiler=options.compiler, flags=["-g", *flags]
        )
        while time.monotonic() < end:
            runs += 1
            with shown(display, program, Path(folder) / str(runs), SCENE) as window:
                if problem := soak_one_run(window, display, chance, end):
                    print(f"run {runs}: {problem}")
                    return 1
    print(f"{runs} runs in {options.minutes:g} minutes, seed {options.seed}: nothing failed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
