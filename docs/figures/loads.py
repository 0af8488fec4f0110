"""What a tick of each example takes of a robot's processor: the table of docs/profiling.md, and a file of costs.

.venv/bin/python docs/figures/all.py loads
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

from pogosim.firmware.making import made_in
from pogosim.firmware.profile.function_costs import write_function_costs
from pogosim.firmware.profile.load import load_of
from pogosim.firmware.profile.raw import Profile, read_profile
from pogosim.installation import Installation, find_installation
from quotes import Quote

NAMES = ("profiling.md: loads", "firmware.md: costs")
WITH_COSTS = "push_sum"  # the example whose file is shown
ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
OF_TEMPLATE = ("Makefile", "robot.mk")
# Examples that are run with another configuration than that of their name.
CONFIGURATIONS = {
    "avoid_walls": "walls_and_membranes",
    "hanabi": "simple",
    "heartbeat_sdk": "heartbeat",
    "helloworld": "test",
    "lighthouse_localization": "lighthouse",
    "run_and_tumble": "simple",
    "walls": "walls_and_membranes",
}
SETTINGS = (
    "simulation_time=20",
    "seed=1",
    "parameters={}",
    "enable_data_logging=false",
    "enable_console_logging=false",
)


def sources() -> Iterator[Path]:
    """Yield the folders of the examples whose robots have a main loop."""
    for folder in sorted(EXAMPLES.iterdir()):
        if any('"pogobase.h"' in path.read_text() for path in folder.glob("main.c*")):
            yield folder


def project_of(example: Path, folder: Path, pogosim: Installation) -> Path:
    """Copy an example into a project, beside headers of others that it may include."""
    for header in EXAMPLES.glob("*/*.h"):
        (folder / header.parent.name).mkdir(exist_ok=True)
        shutil.copy(header, folder / header.parent.name)
    project = folder / example.name
    project.mkdir(exist_ok=True)
    sources = [path for path in example.iterdir() if path.suffix in {".c", ".cpp", ".h"}]
    for file in (*(pogosim.template / name for name in OF_TEMPLATE), *sources):
        shutil.copy(file, project)
    return project


def profile_of(example: Path, folder: Path, pogosim: Installation) -> Profile:
    """Profile the first robot of an example: in the second run of those that keep flash memory from one to the next."""
    firmware = made_in(project_of(example, folder, pogosim), example, pogosim)
    raw, flash = folder / f"{example.name}.json", folder / f"{example.name}.flash"
    configuration = ROOT / "conf" / f"{CONFIGURATIONS.get(example.name, example.name)}.yaml"
    command = [str(pogosim.without_program), "-c", str(configuration), "-g", "-q", "-nr", "--firmware", str(firmware)]
    command += ["--profile", str(raw)]
    keeps_flash = "flash_state:" in configuration.read_text()
    own_flash = (f"flash_state.{file}={flash}" for file in ("input_file", "output_file")) if keeps_flash else ()
    for setting in (*SETTINGS, *own_flash):
        command += ["--set", setting]
    for _ in range(2 if keeps_flash else 1):
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return read_profile(raw)


def percent(share: float) -> str:
    """Return a share of 1 as text, with two significant digits."""
    return f"{100 * share:.2g} %" if share < 1 else f"{100 * share:.0f} %"


def row(name: str, profile: Profile) -> str:
    """Return a row of the table."""
    load, budget = load_of(profile), profile.budget_cycles or 1.0
    used = profile.program_bytes + profile.variable_bytes + profile.deepest_stack_bytes + profile.heap_bytes
    shares = (percent(cycles / budget) for cycles in (load.mean, load.percentile, load.worst))
    return f"| [{name}](../examples/{name}) | {' | '.join(shares)} | {used / 1024:.0f} KiB |"


def draw(folder: Path) -> dict[str, Quote]:
    """Write the table and the file."""
    pogosim = find_installation()
    profiles = {example.name: profile_of(example, folder, pogosim) for example in sources()}
    rows = [row(name, profile) for name, profile in profiles.items()]
    costs = folder / "costs.yaml"
    write_function_costs(profiles[WITH_COSTS], costs)
    head = ("| example | mean | 95 % of the ticks at most | worst tick | memory |", "|---|---|---|---|---|")
    return {NAMES[0]: Quote((*head, *rows)), NAMES[1]: Quote(tuple(costs.read_text().splitlines()))}
