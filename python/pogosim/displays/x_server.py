"""Whether anything answers where DISPLAY leads."""

from __future__ import annotations

import enum
import re
import socket
from pathlib import Path

from pogosim.displays.surroundings import Surroundings

FIRST_PORT = 6000  # of display 0
LONGEST_S = 3.0  # that a connection may take
NAME = re.compile(r"(?P<host>[^:/]*|\[.*\])(/(unix|tcp))?:(?P<number>\d{1,5})(\.\d+)?")


class Answer(enum.Enum):
    """What came of a connection to an X server."""

    NO_NAME = "DISPLAY is no name of a display"
    NOTHING = "nothing answers"
    CONNECTS = "something takes the connection"


def numbered(display: str) -> tuple[str, int] | None:
    """Return the host ("": this machine) and the number that DISPLAY names; None if it is no name of a display."""
    found = NAME.fullmatch(display)
    if found is None:
        return None
    host = found["host"].strip("[]")
    return "" if host == "unix" else host, int(found["number"])


def answer_of(here: Surroundings) -> Answer:
    """Connect to the X server that DISPLAY names. It takes at most a few seconds, as when a firewall drops packets."""
    display = here.value("DISPLAY")
    path, _, _ = display.rpartition(":")
    if path.startswith("/"):  # a socket of macOS
        return Answer.CONNECTS if Path(path).exists() or Path(display).exists() else Answer.NOTHING
    address = numbered(display)
    if address is None:
        return Answer.NO_NAME
    host, number = address
    connects = connects_by_tcp(host, FIRST_PORT + number) if host else connects_here(here.x_socket(number))
    return Answer.CONNECTS if connects else Answer.NOTHING


def connects_by_tcp(host: str, port: int) -> bool:
    """Tell whether a port takes a connection."""
    try:
        with socket.create_connection((host, port), LONGEST_S):
            return True
    except (OSError, OverflowError, UnicodeError):
        return False


def connects_here(file: Path) -> bool:
    """Tell whether a socket of this machine takes a connection; Linux has a second one whose name is no file."""
    for name in (str(file), f"\0{file}"):
        with socket.socket(socket.AF_UNIX) as connection:
            connection.settimeout(LONGEST_S)
            try:
                connection.connect(name)
            except OSError:
                continue
            return True
    return False
