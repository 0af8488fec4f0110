"""`pogosim doctor`: tries what works on this machine, and says what is missing for what."""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from pogobot_simulator import DISTRIBUTION, MEND, OTHER, metadata_of

import pogosim
from pogosim.command.display_check import check_window
from pogosim.command.finding import Finding
from pogosim.command.parser import Parser
from pogosim.command.run import COMPILERS
from pogosim.errors import ToolError
from pogosim.extras import installing
from pogosim.installation import PACKAGE, Installation, InstallationError, find_installation
from pogosim.lines import say
from pogosim.system_packages import FOR_ROBOTS, how_to_install

PROGRAM = """#include "pogobase.h"
typedef struct { int n; } USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
void user_init(void) {}
void user_step(void) { mydata->n++; }
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""
CONFIGURATION = """arena_file: arenas/disk.csv
simulation_time: 0.5
data_filename: data.feather
console_filename: console.txt
objects: {robots: {type: pogobot, nb: 3}}
"""


def first_line(*command: str) -> str:
    """Return the first line that a command prints; raises OSError if it cannot be run, or fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise OSError(f"{command[0]} fails: {last_line(done)}")
    return done.stdout.strip().splitlines()[0] if done.stdout.strip() else ""


def last_line(done: subprocess.CompletedProcess[str]) -> str:
    """Return the last line that a command has printed."""
    lines = (done.stdout + done.stderr).strip().splitlines()
    return lines[-1] if lines else f"exit code {done.returncode}"


def others_of_that_name() -> list[str]:
    """Return where other programs by the name of pogosim are: packages that Python or pip could find, and the command.

    One of them may be this program, installed by the name that it had before.
    """
    places = [Path(folder or ".", "pogosim") for folder in sys.path]
    others = [str(place) for place in places if is_package(place) and not (place / "simulation").is_dir()]
    folders = [Path(folder or ".") for folder in sys.path]
    others += [str(found) for folder in folders if folder.is_dir() for found in metadata_of(OTHER, folder)]
    for name in ("pogosim", "pogobatch"):
        command = shutil.which(name)
        if command and b"pogobot_simulator" not in Path(command).read_bytes():
            others.append(command)
    return list(dict.fromkeys(others))


def is_package(place: Path) -> bool:
    """Tell whether a folder is a package other than this one. A folder of scripts is none: Python takes ours."""
    return (place / "__init__.py").is_file() and place.resolve() != PACKAGE


def check_name(found: Installation) -> Finding:  # noqa: ARG001
    """Look for the program on PyPI that has the same name."""
    others = others_of_that_name()
    if others:
        advice = f"see docs/other_pogosim.md: {MEND}"
        return Finding("Name", False, f"another program named pogosim is installed: {', '.join(others)}", advice)
    return Finding("Name", True, f"this Pogosim is the only one, in {PACKAGE}")


def check_c(found: Installation) -> Finding:
    """Compile and run a program in C."""
    return check_programs(found, "C programs", ".c", how_to_install("gcc"))


def check_cpp(found: Installation) -> Finding:
    """Compile and run a program in C++."""
    return check_programs(found, "C++ programs", ".cpp", how_to_install("g++"))


def check_programs(found: Installation, purpose: str, suffix: str, advice: str) -> Finding:
    """Compile and run a program, the only check that counts."""
    command = COMPILERS[suffix].command()
    if shutil.which(command[0]) is None:
        return Finding(purpose, False, f"the compiler '{command[0]}' is not installed", advice)
    with tempfile.TemporaryDirectory(prefix="pogosim-doctor-") as folder:
        source = Path(folder, f"main{suffix}")
        source.write_text(PROGRAM)
        Path(folder, "test.yaml").write_text(CONFIGURATION)
        done = subprocess.run(
            [*command, source, "-o", "main", *found.compiler_flags],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            return Finding(purpose, False, f"a test program does not compile: {last_line(done)}", advice)
        done = subprocess.run(
            ["./main", "-c", "test.yaml", "-g", "-q"], cwd=folder, capture_output=True, text=True, check=False
        )
    if done.returncode != 0:
        reinstall = (
            f"{shlex.quote(sys.executable)} -m pip install '{required_arrow()}'" if "libarrow" in done.stderr else ""
        )
        return Finding(purpose, False, f"a test program does not run: {last_line(done)}", reinstall)
    return Finding(purpose, True, f"compiled and ran a test program with {first_line(*command, '--version')}")


def required_arrow() -> str:
    """Return the requirement of Arrow of this installation, as pip takes it: a wheel needs one minor version."""
    try:
        words = importlib.metadata.requires(DISTRIBUTION) or []
    except importlib.metadata.PackageNotFoundError:
        words = []
    return max((word for word in words if word.startswith("pyarrow")), key=lambda word: "==" in word, default="pyarrow")


def check_make(found: Installation) -> Finding:  # noqa: ARG001
    """Look for make."""
    if shutil.which("make") is None:
        return Finding("Projects", False, "make is not installed", how_to_install("make"))
    return Finding("Projects", True, first_line("make", "--version"))


def check_shared_state(found: Installation) -> Finding:
    """Try the tool that finds variables shared by mistake."""
    purpose = "Shared variables"
    if not found.shared_state.is_file():
        advice = how_to_install("libdw's headers") + ", then build it again"
        return Finding(purpose, False, "this Pogosim has no pogosim-shared-state", advice)
    done = subprocess.run([found.shared_state, "--help"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return Finding(purpose, False, f"pogosim-shared-state does not run: {last_line(done)}", how_to_install("libdw"))
    return Finding(purpose, True, "checked at every make sim")


def check_films(found: Installation) -> Finding:  # noqa: ARG001
    """Look for ffmpeg."""
    if shutil.which("ffmpeg") is None:
        return Finding("Films", False, "ffmpeg is not installed", how_to_install("ffmpeg"))
    version = " ".join(first_line("ffmpeg", "-version").split()[:3])
    encoders = subprocess.run(["ffmpeg", "-hide_banner", "-encoders"], capture_output=True, text=True, check=False)
    lacking = [name for name in ("libx264", "libvpx-vp9") if name not in encoders.stdout]
    if lacking:
        return Finding("Films", False, f"{version} has no {' and no '.join(lacking)}", "only some formats work")
    return Finding("Films", True, f"{version}, mp4, webm and gif")


def check_batches(found: Installation) -> Finding:  # noqa: ARG001
    """Import what batches need, and count processors."""
    processors = importlib.import_module("pogosim.batch.workers.backends").processors
    return Finding("Batches", True, f"{processors()} runs at the same time, one per processor")


def check_clusters(found: Installation) -> Finding:  # noqa: ARG001
    """Say what batches on several machines can use. A job script that runs pogobatch needs no package."""
    slurm = "SLURM's sbatch is there" if shutil.which("sbatch") else "no sbatch of SLURM"
    scripts = f"job scripts need nothing more; {slurm}"
    lacking = [
        name for name in ("distributed", "dask_jobqueue", "cryptography") if importlib.util.find_spec(name) is None
    ]
    if lacking:
        optional = f"optional, for --slurm and --jobqueue: {installing('slurm')}"
        return Finding("Clusters", True, scripts, optional)
    return Finding("Clusters", True, f"{scripts}; --slurm and --jobqueue work")


def check_searches(found: Installation) -> Finding:  # noqa: ARG001
    """Look whether all optimisers of pogoptim can work."""
    needs = {"ribs": "mapelites, cma_me, cma_mae", "optuna": "tpe"}
    lacking = [name for name in needs if importlib.util.find_spec(name) is None]
    if not lacking:
        return Finding("Searches", True, "all optimisers of pogoptim work")
    without = ", ".join(needs[name] for name in lacking)
    return Finding("Searches", False, f"without the optimisers {without}", installing("optimize"))


def check_robots(found: Installation) -> Finding:  # noqa: ARG001
    """Look for the robots' compiler and SDK."""
    name = "riscv64-unknown-elf-gcc"
    if shutil.which(name) is None:
        advice = how_to_install(FOR_ROBOTS)
        return Finding("Real robots", False, f"their compiler, {name}, is not installed", advice)
    sdk = os.environ.get("POGO_SDK")
    if not sdk:
        return Finding(
            "Real robots", False, f"{name} is there, POGO_SDK is not set", "export POGO_SDK=<folder of the SDK>"
        )
    if not Path(sdk, "tools", "variables.mak").is_file():
        return Finding("Real robots", False, f"there is no Pogobot SDK in POGO_SDK={sdk}", "set POGO_SDK to its folder")
    return Finding("Real robots", True, f"{first_line(name, '--version')}; SDK in {sdk}")


# By purpose, what is most important first.
CHECKS: dict[str, Callable[[Installation], Finding | list[Finding]]] = {
    "Name": check_name,
    "C programs": check_c,
    "C++ programs": check_cpp,
    "Projects": check_make,
    "Shared variables": check_shared_state,
    "Window": check_window,
    "Films": check_films,
    "Batches": check_batches,
    "Clusters": check_clusters,
    "Searches": check_searches,
    "Real robots": check_robots,
}


def checked(purpose: str, found: Installation) -> list[Finding]:
    """Check one thing. What keeps the check itself from working is a finding, too."""
    try:
        findings = CHECKS[purpose](found)
    except (ImportError, OSError, ToolError, ValueError) as error:
        return [Finding(purpose, False, f"it cannot be checked: {error}")]
    return findings if isinstance(findings, list) else [findings]


def show(finding: Finding) -> None:
    """Print a finding as one line, and a second one with the advice."""
    mark = "ok" if finding.is_fine else "missing"
    say(f"{finding.purpose:17} {mark:8} {finding.found}")
    if finding.advice:
        say(f"{'':27}{finding.advice}")


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim doctor") -> int:
    """Run the command. Returns its exit code: 0 programs in C can be compiled and run, 2 they cannot."""
    Parser(
        prog=prog,
        description="Tries what works on this machine, and says what is missing for what. "
        "Exit code: 0 if C programs can be compiled and run, otherwise 2.",
    ).parse_args(arguments)
    python = platform.python_version()
    try:
        found = find_installation()
    except InstallationError as error:
        say(f"Pogosim {pogosim.__version__}, Python {python}")
        show(Finding("Simulator", False, str(error)))
        return 2
    say(f"Pogosim {found.version} in {found.folder}, Python {python}, {platform.platform(terse=True)}")
    can_run = False
    for purpose in CHECKS:
        for finding in checked(purpose, found):
            show(finding)
            can_run = can_run or (finding.is_fine and finding.purpose == "C programs")
    return 0 if can_run else 2
