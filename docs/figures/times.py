"""Times that pages quote. They depend on the machine, so each ends with a line that says when and where.

Measure on a machine that does nothing else: .venv/bin/python docs/figures/all.py --times
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

import tuning
from pictures import ROOT, Picture, drawn_on
from pogosim import __version__
from quotes import Quote, paragraph, processor

STAMP = re.compile(r"^Measured on (\d{4}-\d\d-\d\d) with v(\d+\.\d+\.\d+): (.+)$")
BENCH = "build/release/bench/bench_"
PYTHON = sys.executable
# Measured beside environments if these are a Python that has them; they are none of our packages.
OTHERS = tuple(
    word
    for option, variable in (("--vmas", "VMAS_PYTHON"), ("--jaxmarl", "JAXMARL_PYTHON"))
    if variable in os.environ
    for word in (option, os.environ[variable])
)


def stamp() -> str:
    """Return the line that says when, with what and where times are measured now; see STAMP."""
    today = datetime.now(timezone.utc).date().isoformat()
    glibc, _, compiler = drawn_on()["Platform"].rpartition(" glibc ")[2].partition(" ")
    compiler = compiler.replace("GNU", "gcc")  # as CMake calls it
    machine = f"{processor()}, {os.cpu_count()} processors"
    return f"Measured on {today} with v{__version__}: {machine}, glibc {glibc}, {compiler}"


@dataclass(frozen=True)
class Times:
    """Times on a page, and what measures them: its lines, and pictures by their names."""

    quote: str
    measure: Callable[[Path], tuple[list[str], dict[str, Picture]]]

    def measured(self, folder: Path) -> dict[str, Picture | Quote]:
        """Measure, in a folder."""
        lines, pictures = self.measure(folder)
        return {self.quote: Quote((*lines, stamp())), **pictures}


def run(*command: str) -> list[str]:
    """Run a command in the project's folder; return the lines it prints."""
    try:
        done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    except FileNotFoundError:
        sys.exit(
            f"{command[0]} is missing: cmake -DPOGOSIM_BUILD_BENCH=ON build/release && cmake --build build/release"
        )
    return [line.rstrip() for line in done.stdout.splitlines() if line.strip()]


def printed(*command: str) -> Callable[[Path], tuple[list[str], dict[str, Picture]]]:
    """Measure with a command that prints the lines."""
    return lambda _folder: (run(*command), {})


def throughput(folder: Path) -> tuple[list[str], dict[str, Picture]]:
    """Measure a search of pogoptim."""
    return tuning.SCENES["throughput"](folder, False).quoted, {}


def swarms(folder: Path) -> tuple[list[str], dict[str, Picture]]:
    """Measure the example programs, and draw their costs."""
    run(PYTHON, "bench/table.py", "-o", str(folder))
    picture = Picture((folder / "performance.png").read_bytes(), "", is_exact=False)
    return aligned((folder / "table.md").read_text().splitlines()), {"performance.png": picture}


def batches(folder: Path) -> tuple[list[str], dict[str, Picture]]:
    """Measure batches of short runs, and draw what a run costs."""
    run(PYTHON, "bench/batch_runs.py", "-o", str(folder))
    picture = Picture((folder / "batches.png").read_bytes(), "", is_exact=False)
    return aligned((folder / "batches.md").read_text().splitlines()), {"batches.png": picture}


def added_megabytes(packages: list[str]) -> int:
    """Return what installing Debian packages takes on a system without any, by apt."""
    with tempfile.TemporaryDirectory() as folder:
        (status := Path(folder, "status")).touch()
        command = ["apt-get", "-o", f"Dir::State::status={status}", "--no-install-recommends", "--assume-no", "install"]
        done = subprocess.run(
            [*command, *packages], env={**os.environ, "LC_ALL": "C"}, stdout=subprocess.PIPE, text=True, check=False
        )
    found = re.search(r"operation, ([\d.,]+) (k|M|G)B of additional", done.stdout)
    if found is None:
        sys.exit(f"apt-get does not say how large {' '.join(packages)} are: {done.stdout[-300:]}")
    return round(float(found[1].replace(",", "")) * {"k": 1e-3, "M": 1.0, "G": 1e3}[found[2]])


def first_start(folder: Path) -> tuple[list[str], dict[str, Picture]]:
    """Do what a new user does, in a copy of the tree: ./demo.sh, with nothing compiled before."""
    tree = folder / "pogosim"
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(tree)], check=True)
    environment = {**os.environ, "CCACHE_DISABLE": "1", "POGOSIM_PACKAGES": "skip"}
    before, start_s = os.times(), time.monotonic()
    subprocess.run(["./demo.sh"], cwd=tree, env=environment, check=True, stdout=subprocess.DEVNULL)
    after, wall_clock_s = os.times(), time.monotonic() - start_s
    used_s = after.children_user + after.children_system - before.children_user - before.children_system
    sizes = {
        name: int(run("du", "-sm", str(place))[0].split()[0])
        for name, place in (("all", tree), (".venv", tree / ".venv"))
    }
    asked = ["bash", "-c", ". scripts/bootstrap.sh; echo $apt_packages; dpkg-query -Wf '${Essential} ${Package}\\n'"]
    packages, *known = run(*asked)
    essential = [line.split()[1] for line in known if line.startswith("yes ")] + ["apt"]
    system = added_megabytes([*essential, *packages.split()]) - added_megabytes(essential)
    minutes, used = f"{wall_clock_s / 60:.0f} minutes", f"{used_s / 60:.0f} minutes of processor time"
    text = (
        f"The first `./demo.sh` takes {minutes} on {os.cpu_count()} processors ({used}) and uses "
        f"{round(sizes['all'], -1)} MB of disk space, {round(sizes['.venv'], -1)} MB of it for Python packages. On a "
        f"fresh Debian, {round(system, -1)} MB of system packages are installed as well."
    )
    return list(paragraph(text).lines), {}


def aligned(table: list[str]) -> list[str]:
    """Return a table of Markdown as columns of a code block."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table if not line.startswith("|---")]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


TIMES = {
    "analyses": Times("../bench/README.md: analyses", printed(PYTHON, "bench/analyses.py")),
    "batches": Times("performance.md: batches", batches),
    "draw": Times("../bench/README.md: draw", printed(f"{BENCH}draw")),
    "films": Times("pictures.md: films", printed(PYTHON, "bench/films.py")),
    "first_start": Times("../README.md: first_start", first_start),
    "environments": Times("learning.md: environments", printed(PYTHON, "bench/learning.py", *OTHERS)),
    "large": Times("../bench/README.md: large", printed(f"{BENCH}large")),
    "light": Times("../bench/README.md: light", printed(f"{BENCH}light")),
    "machine": Times("performance.md: machine", printed(f"{BENCH}machine")),
    "million": Times("performance.md: million", printed(f"{BENCH}run_and_tumble", "--runs", "1", "1000000")),
    "own_variables": Times("../bench/README.md: own_variables", printed(PYTHON, "bench/own_variables.py")),
    "swarms": Times("performance.md: swarms", swarms),
    "throughput": Times("optimization.md: throughput", throughput),
    "watching": Times("live.md: watching", printed(PYTHON, "bench/watching.py")),
}
