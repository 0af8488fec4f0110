"""What the tools check before they write a file."""

from __future__ import annotations

import contextlib
import glob
import os
import stat
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, Union

from pogosim.errors import ToolError

PARTIAL = ".pogosim-new"  # behind the name of a file that is not complete

PathLike = Union[str, "Path"]

KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
)


class OutputError(ToolError):
    """A file cannot be written there; says why."""


def told(error: OSError, place: PathLike) -> str:
    """Return what an error of the system says, with the file that it names, or else the place that was written to."""
    return f"{error.filename2 or error.filename or place}: {(error.strerror or str(error)).lower()}"


def leads_to(path: PathLike, other: PathLike) -> bool:
    """Tell whether two paths lead to one file, by whatever name, symbolic or hard link; there may be none yet."""
    try:
        return Path(path).samefile(other)
    except OSError:
        return os.path.realpath(path) == os.path.realpath(other)


def real_output(path: PathLike) -> Path:
    """Return where an output path leads, without symbolic links.

    Raises:
        OutputError: There is something that is not a regular file, or no folder for it.
        OSError: It cannot be looked at.
    """
    if not str(path):
        raise OutputError("the name of the output file is empty")
    real = Path(os.path.realpath(path))
    try:
        mode = real.stat().st_mode
    except FileNotFoundError:
        if str(path).endswith("/"):
            raise OutputError(f"{path} is the name of a folder, not of a file") from None
        if not real.parent.is_dir():
            raise OutputError(f"{path} cannot be written: there is no folder {real.parent}") from None
        return real
    except NotADirectoryError:
        raise OutputError(f"{path} cannot be written: {real.parent} is not a folder") from None
    if stat.S_ISREG(mode):
        return real
    kind = next((words for is_kind, words in KINDS if is_kind(mode)), "something else")
    raise OutputError(f"{path} is {kind}, not a file; choose another output")


def checked_output(
    name: str, source: str, endings: Sequence[str], wrong_ending: str = "", what: str = "output", of: str = ""
) -> Path:
    """Return where a tool is to write, without symbolic links.

    Args:
        name: The output.
        source: The file that it is made of.
        endings: How its name may end, in lower case, without the dot.
        wrong_ending: What is said of a name that ends otherwise; empty: that it does.
        what: What the output is.
        of: What the source is, before its name.

    Raises:
        OutputError: It would take the place of the source, ends otherwise, or is no file.
        OSError: It cannot be looked at.
    """
    if name and leads_to(name, source):
        own = name if what == "output" else f"the {what} {name}"
        raise OutputError(f"{own} would take the place of {of}{source}; name another {what}")
    path = real_output(name)
    if Path(name).suffix[1:].lower() not in endings:
        raise OutputError(wrong_ending or f"{name} does not end in .{' or .'.join(endings)}")
    return path


def results_folder(
    folder: Path, names: Iterable[str], inputs: Sequence[PathLike], lost: str = "is an input, which would be lost"
) -> None:
    """Make a folder for results.

    Args:
        folder: The folder.
        names: Names of the results in it.
        inputs: Files that are read.
        lost: What is said of a result in the place of one of them.

    Raises:
        OutputError: It is not a folder, or one of the results would take the place of an input.
        OSError: It cannot be made.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder} is not a folder; choose another one with -o")
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        real_output(folder / name)
        if any(leads_to(folder / name, path) for path in inputs):
            raise OutputError(f"{folder / name} {lost}; choose another folder with -o")
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{folder} cannot be written; choose another folder with -o")


@contextlib.contextmanager
def partial_output(path: Path) -> Iterator[Path]:
    """Give the name of a file beside an output; it takes the output's place if the block ends well, or else is removed.

    Args:
        path: As real_output() returns it.
    """
    partial = path.with_name(f"{path.name}.{os.getpid()}{PARTIAL}")
    try:
        partial.touch()
        yield partial
        if path.exists():
            partial.chmod(stat.S_IMODE(path.stat().st_mode))
        partial.replace(path)
    except OSError as error:
        # What is told is the output: errors of writing name no file, and that of a partial one says nothing to users.
        named = error.filename2 or error.filename  # of a copy, the target
        if named in (None, str(partial)) and error.errno is not None:
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        partial.unlink(missing_ok=True)


def lock(file: IO[bytes] | IO[str], patience_s: float = 0.0) -> bool:
    """Lock an open file until it is closed. Where there are no locks, True.

    Args:
        file: To be locked.
        patience_s: How long to try, s. A process that was killed may leave one that it was just starting, which has
            the lock for a moment more.

    Returns:
        Whether it is locked now; False if somewhere else it is.
    """
    end_s = time.monotonic() + patience_s
    while True:
        try:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() >= end_s:
                return False
            time.sleep(0.05)
            continue
        except (ImportError, OSError):
            pass  # no locks on this system, or file system
        return True


@contextlib.contextmanager
def locked_output(path: Path, name: PathLike) -> Iterator[None]:
    """Keep runs from writing a file meanwhile, where there are locks and the file is there.

    Args:
        path: As real_output() returns it.
        name: What errors call it.

    Raises:
        OutputError: A run is writing it.
    """
    try:
        file = path.open("rb")
    except (FileNotFoundError, PermissionError):
        yield
        return
    with file:
        is_locked = lock(file)
        # A run that has just ended may have replaced it.
        if not is_locked or not (path.exists() and os.path.samestat(path.stat(), os.fstat(file.fileno()))):
            raise OutputError(f"{name} is in use by another run; wait for it to finish, or choose another file")
        yield


def check_readable(names: Iterable[str]) -> None:
    """Open files, to find errors early. Folders, pipes and files of a pattern are checked later.

    Raises:
        OSError: One cannot be read.
    """
    for name in names:
        path = Path(name)
        if path.exists() and not path.is_file():
            continue  # opening a pipe would wait for a writer
        if glob.has_magic(name) and not path.exists():
            continue
        with path.open("rb"):
            pass
