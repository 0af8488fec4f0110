"""The commands of Pogosim. Before they import the package `pogosim`, they look whether it is this one, and all there.

PyPI has another program by the name of pogosim, with a package of that name (docs/other_pogosim.md), and this one had
that name before. pip knows of no conflict: it puts both into one folder, where the last one replaces files of the
other, and uninstalling one removes files of both. This module has a name of its own, so it stays as it is.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

DISTRIBUTION = "pogobot_simulator"  # pogobot-simulator, as folders of metadata have it
OTHER = "pogosim"
FOLDER = Path(__file__).resolve().parents[1]
WRONG_USAGE = 2
MEND = f"{sys.executable} -m pip uninstall pogosim pogobot-simulator, then install the one that you want"


def metadata_of(name: str, folder: Path) -> list[Path]:
    """Return the metadata of the distributions of a name that are installed in a folder; usually one or none."""
    found = (path for path in folder.iterdir() if path.name.startswith((f"{name}-", f"{name}.egg")))
    return sorted(path for path in found if path.suffix in (".dist-info", ".egg-info"))


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
    own = [recorded(found) for found in metadata_of(DISTRIBUTION, metadata.parent)]
    return [
        path
        for files in own
        for path, digest in files.items()
        if theirs.get(path, digest) != digest and hash_of(metadata.parent / path) == theirs[path]
    ]


def told(metadata: Path) -> str:
    """Return the name and the version of another distribution, and what it is."""
    name = metadata.name.removesuffix(".dist-info").removesuffix(".egg-info").replace("-", " ", 1)
    is_older = "pogosim/simulation/__init__.py" in recorded(metadata)
    return f"'{name}', {'this program by its former name' if is_older else 'another program'},"


def beside(folder: Path) -> str | None:
    """Return what is wrong if a distribution named pogosim is installed in the folder of this package; else None."""
    for metadata in metadata_of(OTHER, folder):
        return f"{told(metadata)} is installed in the same folder, {folder}, and may remove files of this one: {MEND}"
    return None


def mixed(folder: Path) -> str | None:
    """Return what is wrong if the package `pogosim` in a folder is partly that of another distribution; else None."""
    for metadata in metadata_of(OTHER, folder):
        if files := replaced(metadata):
            return (
                f"{told(metadata)} has replaced {len(files)} files of this one in {folder}, such as {files[0]}: {MEND}"
            )
    return None


def obstacle(folder: Path = FOLDER) -> str | None:
    """Return why commands cannot work, in one line: the package that they would import is another. None if they can."""
    own = folder / "pogosim" / "__init__.py"
    if not own.is_file():
        return f"files are missing in {own.parent}: uninstalling 'pogosim' has removed files of this one, too: {MEND}"
    spec = importlib.util.find_spec("pogosim")
    found = spec and spec.origin
    if found and not own.samefile(found):
        return f"Python finds another package named pogosim first, {found}: see PYTHONPATH and pip list, or {MEND}"
    return mixed(folder)


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
