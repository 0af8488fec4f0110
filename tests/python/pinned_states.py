"""How the states of six examples develop: `--hash`, pinned in pinned_states.json for a compiler and its libraries.

    .venv/bin/python tests/python/pinned_states.py    # pins what they are now

Do that when results change on purpose, and say in CHANGELOG.md why they do.
"""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
from pathlib import Path

from running import ROOT, build_folder, example

FILE = Path(__file__).with_name("pinned_states.json")
PERIOD_STEPS = 100
STEPS = 1000
# Motion, messages, light, collisions with walls and membranes, and phases that messages couple.
EXAMPLES = {
    "run_and_tumble": "simple",
    "hanabi": "simple",
    "phototaxis": "phototaxis",
    "push_sum": "push_sum",
    "moving_oscillators": "moving_oscillators",
    "walls": "walls_and_membranes",
}
LINE = re.compile(r"state after step (\d+): ([0-9a-f]{16})$", re.MULTILINE)


def toolchain() -> str:
    """Return what the bits of a result may depend on: processor, compiler, C library and Box2D."""
    (found,) = build_folder().glob("CMakeFiles/*/CMakeCXXCompiler.cmake")
    settings = dict(re.findall(r'^set\((\w+) "([^"]*)"\)$', found.read_text(), re.MULTILINE))
    compiler = f"{settings['CMAKE_CXX_COMPILER_ID']} {settings['CMAKE_CXX_COMPILER_VERSION']}"
    library = next(iter((build_folder() / "src").glob("libpogosim.*")))
    listing = subprocess.run(["ldd", library], capture_output=True, text=True, check=False).stdout
    box2d = re.search(r"(\S*libbox2d\S*) \(", listing)
    physics = Path(os.path.realpath(box2d[1])).name if box2d else "Box2D"
    return ", ".join([platform.machine(), compiler, " ".join(platform.libc_ver()), physics])


def states(name: str) -> list[str]:
    """Run an example, and return its hashes."""
    settings = [f"simulation_time={STEPS / 100}", "time_step=0.01", "enable_data_logging=false", "save_video_period=-1"]
    settings.append("enable_console_logging=false")
    command = [
        str(example(name)),
        "-c",
        f"conf/{EXAMPLES[name]}.yaml",
        "-g",
        "-nr",
        "-s",
        "1",
        "--hash",
        str(PERIOD_STEPS),
    ]
    command += [word for setting in settings for word in ("--set", setting)]
    output = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [found[1] for found in LINE.findall(output)]


def pinned() -> dict[str, dict[str, list[str]]]:
    """Return the hashes of each example, for each toolchain."""
    found: dict[str, dict[str, list[str]]] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.is_file() else {}
    return found


def main() -> None:
    """Pin the present states for this toolchain, and forget those of others: they are not known."""
    FILE.write_text(
        json.dumps({toolchain(): {name: states(name) for name in EXAMPLES}}, indent=1) + "\n", encoding="utf-8"
    )
    print(f"pinned in {FILE.relative_to(ROOT)} for {toolchain()}")


if __name__ == "__main__":
    main()
