"""Archives of flash memory, made and taken apart byte by byte, as docs/flash.md says."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

from pogosim.flash_archive import checksum_of

PAGE = 256
PAGES = 5888
FLASH = PAGE * PAGES
EMPTY = bytes.fromhex("5047464c4153480001000000170000000000")


@dataclass
class Record:
    """One robot's record."""

    identifier: int
    category: str = "robots"
    directions: tuple[int, int, int] = (0, 1, 0)
    powers: tuple[int, int, int] = (512, 512, 0)
    pages: dict[int, bytes] = field(default_factory=dict)  # those that are not blank

    @property
    def body(self) -> bytes:
        """All bytes but the checksum."""
        name = self.category.encode(errors="surrogateescape")
        flash = bytearray(b"\xff" * FLASH)
        for page, data in self.pages.items():
            flash[page * PAGE : (page + 1) * PAGE] = data
        head = struct.pack("<HH", self.identifier, len(name)) + name
        return head + struct.pack("<3B3H", *self.directions, *self.powers) + bytes(flash)


def checksum(data: bytes) -> int:
    """Return FNV-1a of 64 bits, byte by byte: slow, but simple enough to be right."""
    value = 14695981039346656037
    for byte in data:
        value = ((value ^ byte) * 1099511628211) % 2**64
    return value


def archive(records: Sequence[Record], count: int | None = None) -> bytes:
    """Return an archive; `count`: what it says of its records, if that is wrong."""
    head = b"PGFLASH\0" + struct.pack("<HII", 1, FLASH, len(records) if count is None else count)
    bodies = [record.body for record in records]
    return head + b"".join(body + struct.pack("<Q", checksum_of(body[:-FLASH], body[-FLASH:])) for body in bodies)


def mark(identifier: int, page: int) -> bytes:
    """Return what tests/programs/flash.c writes to a page."""
    return struct.pack("<HH", identifier, page).ljust(PAGE, bytes([(identifier + page) % 256]))


def written(identifier: int, category: str = "robots") -> Record:
    """Return the record that the kind `write` of the program leaves."""
    pages = {page: mark(identifier, page) for page in (0, PAGES - 1)}
    return Record(identifier, category, (1, 0, 1), (500, 600, (700 + identifier) % 65536), pages)
