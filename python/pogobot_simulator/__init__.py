"""The commands of Pogosim. Before they import the package `pogosim`, they look whether it is this one, and all there.

PyPI has another program by the name of pogosim, with a package of that name (docs/other_pogosim.md), and this one had
that name before. pip knows of no conflict: it puts both into one folder, where the last one replaces files of the
other, and uninstalling one removes files of both. This module has a name of its own, so it stays as it is.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Sequence
from pathlib import Path

DISTRIBUTION = "pogobot_simulator"  # pogobot-simulator, as folders of metadata have it
OTHER = "pogosim"
FOLDER = Path(__file__).resolve().parents[1]
WRONG_USAGE = 2
MEND = f"{sys.executable} -m pip uninstall pogosim pogobot-simulator, then install the one that you want"


def metadata_of(name: str, folder: Path) -> list[Path]:
    """Return the metadata of the distributions of a name that are installed in a folder; usually one or none."""
    with os.scandir(folder) as entries:
        names = [entry.name for entry in entries if entry.name.startswith((f"{name}-", f"{name}.egg"))]
    return sorted(folder / file for file in names if file.endswith((".dist-info", ".egg-info")))


def recorded(metadata: Path) -> dict[str, str]:
    """Return the modules of the package `pogosim` that a distribution has installed, each with the hash of its content.

    Empty if there is no such record.
    """
    import csv

    try:
        text = (metadata / "RECORD").read_text(encoding="utf-8")
    except OSError:
        return {}
    rows = (row for row in csv.reader(text.splitlines()) if len(row) > 1)
    return {path: digest for path, digest, *_ in rows if path.startswith("pogosim/") and path.endswith(".py")}


def hash_of(file: Path) -> str:
    """Return the hash of a file, as in records; empty if it cannot be read."""
    import base64
    import hashlib

    try:
        digest = hashlib.sha256(file.read_bytes()).digest()
    except OSError:
        return ""
    return f"sha256={base64.urlsafe_b64encode(digest).rstrip(b'=').decode()}"


def replaced(metadata: Path) -> list[str]:
    """Return which modules of this package another distribution in the same folder has replaced by its own."""
    theirs = recorded(metadata)
    return [
        path
        for own in metadata_of(DISTRIBUTION, metadata.parent)
        for path, digest in recorded(own).items()
        if theirs.get(path, digest) != digest and hash_of(metadata.parent / path) == theirs[path]
    ]


def described(metadata: Path) -> str:
    """Return the name and the version of another distribution, and what it is."""
    name = metadata.name.removesuffix(".dist-info").removesuffix(".egg-info").replace("-", " ", 1)
    is_older = "pogosim/simulation/__init__.py" in recorded(metadata)
    return f"'{name}', {'this program by its former name' if is_older else 'another program'},"


def beside(others: Sequence[Path]) -> str | None:
    """Return what is wrong if distributions named pogosim are installed in the folder of this package; else None.

    Args:
        others: Their metadata.
    """
    if not others:
        return None
    folder = others[0].parent
    return f"{described(others[0])} is installed in the same folder, {folder}, and may remove files of this one: {MEND}"


def mixed(others: Sequence[Path]) -> str | None:
    """Return what is wrong if the package `pogosim` is partly that of another distribution; else None.

    Args:
        others: Metadata of distributions named pogosim in its folder.
    """
    for other in others:
        if files := replaced(other):
            count = f"{len(files)} files of this one in {other.parent}"
            return f"{described(other)} has replaced {count}, such as {files[0]}: {MEND}"
    return None


# Distributions named pogosim in the folder of this package, usually none. Listing site-packages takes time, so it is
# done once for a command and what it imports.
OTHERS = metadata_of(OTHER, FOLDER)


def obstacle() -> str | None:
    """Return why commands cannot work, in one line: the package that they would import is another. None if they can."""
    own = FOLDER / "pogosim" / "__init__.py"
    if not own.is_file():
        return f"files are missing in {own.parent}: uninstalling 'pogosim' has removed files of this one, too: {MEND}"
    spec = importlib.util.find_spec("pogosim")
    found = spec and spec.origin
    if found and not own.samefile(found):
        return f"Python finds another package named pogosim first, {found}: see PYTHONPATH and pip list, or {MEND}"
    return mixed(OTHERS)


def run(prog: str, function: str) -> int:
    """Run a command; returns its exit code, which is 2 if the package is not this one."""
    if problem := obstacle():
        print(f"{prog}: {problem}", file=sys.stderr)
        return WRONG_USAGE
    from pogosim.command import main

    code: int = getattr(main, function)()
    return code


def pogosim() -> int:
    """Run the command `pogosim`."""
    return run("pogosim", "pogosim_command")


def pogobatch() -> int:
    """Run the command `pogobatch`."""
    return run("pogobatch", "pogobatch")


def pogoptim() -> int:
    """Run the command `pogoptim`."""
    return run("pogoptim", "pogoptim")


def recover() -> int:
    """Run the command `pogosim-recover`."""
    return run("pogosim-recover", "recover")
