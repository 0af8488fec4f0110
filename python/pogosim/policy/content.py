"""Content of the files that policies and observations come from."""

from __future__ import annotations

from pathlib import Path

from pogosim.policy.errors import PolicyError

MOST_BYTES = 1 << 28  # of a file, and of what is unpacked from it


def check_file(file: Path) -> None:
    """Check that a file has an end, and is not far too large.

    Raises:
        PolicyError: It is a pipe, a socket or a device, or has more than MOST_BYTES.
        OSError: There is no such file, or it is a folder.
    """
    size = file.stat().st_size
    if not (file.is_file() or file.is_dir()):
        raise PolicyError(f"{file} is not a file, but a pipe, a socket or a device; expected a file")
    if size > MOST_BYTES:
        raise PolicyError(f"{file} has {size} bytes; expected {MOST_BYTES} at most")


def content_of(file: Path) -> bytes:
    """Read a file. See check_file() for its errors."""
    check_file(file)
    return file.read_bytes()
