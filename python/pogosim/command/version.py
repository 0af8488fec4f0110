"""`pogosim --version`: the version, and what the library was built of and with, as it says itself."""

from __future__ import annotations

import ctypes
import json
import platform
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pogosim
from pogosim.installation import Installation, InstallationError, find_installation
from pogosim.lines import say, say_error

UNKNOWN = "unknown"
WRONG_USAGE = 2
# Names of lines and of keys: of the library, then of what is around it.
OF_LIBRARY = ("commit", "compiler", "engines", "Arrow")


def library_file(found: Installation) -> Path:
    """Return the file of the simulator's library."""
    return found.library / ("libpogosim.dylib" if sys.platform == "darwin" else "libpogosim.so")


def build_info(file: Path | str) -> dict[str, str]:
    """Return what a library says of its build, see pogosim_build_info() in host.h.

    Raises:
        OSError: It cannot be loaded.
    """
    try:
        function = ctypes.CDLL(str(file)).pogosim_build_info
    except AttributeError:  # of a version before 0.11.0
        return {}
    function.restype = ctypes.c_char_p
    lines = function().decode(errors="replace").splitlines()
    return {name: value for name, _, value in (line.partition(": ") for line in lines)}


def commit_of(checkout: Path) -> str | None:
    """Return the commit of a checkout, as the build asks for it; None if the folder is none, or git is not there."""
    if not (checkout / ".git").exists():
        return None
    command = ["git", "-C", str(checkout), "describe", "--always", "--tags", "--dirty"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def found_here() -> tuple[dict[str, str], str | None]:
    """Return what is known of this version, by name, and what does not go together; None if all does."""
    facts = {"version": pogosim.__version__, **dict.fromkeys(OF_LIBRARY, UNKNOWN)}
    of_python = {"Python": platform.python_version()}
    try:
        found = find_installation()
        facts |= build_info(library_file(found)) | {"library": str(library_file(found))}
    except (InstallationError, OSError) as error:
        return facts | of_python, f"no library: {error}"
    facts |= of_python
    if found.version != pogosim.__version__:
        return facts, f"the library is of version {found.version}, and this package of {pogosim.__version__}"
    now = commit_of(found.folder)
    if now is None:
        return facts, None
    facts["checkout"] = now
    if now != facts["commit"]:
        return facts, f"the library was built at {facts['commit']}, and {found.folder} is at {now}: build it again"
    return facts, None


def as_json(facts: dict[str, str]) -> str:
    """Return it as one JSON object, with keys in lower case; the engines are a list."""
    values: dict[str, object] = {name.lower(): value for name, value in facts.items()}
    values["engines"] = [] if facts["engines"] == UNKNOWN else facts["engines"].split(", ")
    return json.dumps(values)


def main(arguments: Sequence[str] = ()) -> int:
    """Print it; returns the exit code, which is 2 for other arguments than --json."""
    if list(arguments) not in ([], ["--json"]):
        say_error(f"pogosim: --version is followed by nothing or --json, found '{' '.join(arguments)}'")
        return WRONG_USAGE
    facts, problem = found_here()
    if arguments:
        say(as_json(facts))
    else:
        say(f"pogosim {facts.pop('version')}", *(f"{name}: {value}" for name, value in facts.items()))
    if problem:
        say_error(f"pogosim: warning: {problem}")
    return 0
