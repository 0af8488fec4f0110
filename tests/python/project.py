"""A copy of the project template, and make in it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from running import ROOT, Run, ran

TEMPLATE = ROOT / "template_prj"
# Another Pogosim or SDK of this machine must not be found instead of the one under test.
CLEAN = {
    name: value
    for name, value in os.environ.items()
    if not name.startswith(("POGO", "PKG_CONFIG", "MAKE", "CFLAGS", "CXXFLAGS"))
} | {
    "PKG_CONFIG_LIBDIR": "/nowhere",
    "LC_ALL": "C",
    "PATH": os.pathsep.join(
        folder for folder in os.environ["PATH"].split(os.pathsep) if not Path(folder, "pogosim").exists()
    ),
}


def copy_template(folder: Path, template: Path = TEMPLATE) -> Path:
    """Copy what the repository or an installation has of the template, without what was built in it."""
    shutil.copytree(template, folder, ignore=shutil.ignore_patterns("build", "frames", template.name))
    return folder


def make(folder: Path, *arguments: str, environment: dict[str, str] | None = None) -> Run:
    """Run make in a folder."""
    return ran(folder, "make", *arguments, env=CLEAN | (environment or {}))


def made(folder: Path, *arguments: str, environment: dict[str, str] | None = None) -> Run:
    """Run make, which must work."""
    result = make(folder, *arguments, environment=environment)
    assert result.code == 0, result.text
    return result


def compiled(result: Run) -> set[str]:
    """Names of the files that make had compiled."""
    return {Path(source).name for source in re.findall(r" (\S+\.(?:c|cpp)) -o", result.output)}


def sentence(result: Run) -> str:
    """Return the one line with which make gave up."""
    assert result.code == 2
    (line,) = result.errors.splitlines()
    found = re.fullmatch(r"[\w.]+:\d+: \*\*\* (.*)\.  Stop\.", line)
    assert found, line
    return found.group(1)


def write(folder: Path, files: dict[str, str], remove: Sequence[str] = ("main.c",)) -> None:
    """Replace the program of a project."""
    for name in remove:
        (folder / name).unlink()
    for name, text in files.items():
        (folder / name).write_text(text)
