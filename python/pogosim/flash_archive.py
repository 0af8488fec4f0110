"""Archives of robots' flash memory, the files of `flash_state`, as the simulator reads and writes them.

The layout is in src/sim/flash_archive.hpp.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from typing import BinaryIO

PAGE_BYTES = 256
PAGE_COUNT = 5888
FLASH_BYTES = PAGE_BYTES * PAGE_COUNT

SIGNATURE = b"PGFLASH\0"
VERSION = 1
BLANK = b"\xff" * PAGE_BYTES
LONGEST_CATEGORY = 65535  # bytes of its name
OLD_FLASH_BYTES = 65536  # of robots before version 3

HEAD = struct.Struct("<8sHII")
OWNER = struct.Struct("<HH")  # id, length of the category
MOTORS = struct.Struct("<3B3H")
CHECKSUM = struct.Struct("<Q")

FNV_OFFSET = 14695981039346656037
FNV_PRIME = 1099511628211
WORD = (1 << 64) - 1


class ArchiveError(ValueError):
    """A file is no archive, or damaged; says what is wrong, without the name of the file."""


@dataclass(frozen=True)
class Record:
    """What a robot keeps while it is off.

    Attributes:
        category: Its key under `objects`.
        identifier: Its id, 0 to 65535.
        directions: Stored directions of its motors: right, left, back.
        powers: Stored powers.
        flash: FLASH_BYTES bytes, page 0 first.
    """

    category: str
    identifier: int
    directions: tuple[int, int, int] = (0, 1, 0)
    powers: tuple[int, int, int] = (512, 512, 0)
    flash: bytes = BLANK * PAGE_COUNT

    def written_pages(self) -> list[int]:
        """Return the pages that are not blank."""
        starts = range(0, FLASH_BYTES, PAGE_BYTES)
        return [page for page, start in enumerate(starts) if self.flash[start : start + PAGE_BYTES] != BLANK]


def fnv_1a(data: bytes, start: int = FNV_OFFSET) -> int:
    """Return the 64-bit FNV-1a checksum of bytes, or go on with one."""
    return reduce(lambda checksum, byte: ((checksum ^ byte) * FNV_PRIME) & WORD, data, start)


# A blank page multiplies the checksum by a constant, and adds what its lowest byte alone decides.
BLANK_FACTOR = pow(FNV_PRIME, PAGE_BYTES, WORD + 1)
BLANK_ADDED = tuple((fnv_1a(BLANK, low) - low * BLANK_FACTOR) & WORD for low in range(256))


def checksum_of(head: bytes, flash: bytes) -> int:
    """Return the checksum of a record: of what stands before the flash memory, and of that."""
    checksum = fnv_1a(head)
    for start in range(0, len(flash), PAGE_BYTES):
        page = flash[start : start + PAGE_BYTES]
        if page == BLANK:
            checksum = (checksum * BLANK_FACTOR + BLANK_ADDED[checksum & 0xFF]) & WORD
        else:
            checksum = fnv_1a(page, checksum)
    return checksum


def head_of(record: Record) -> bytes:
    """Return the bytes of a record before the flash memory."""
    name = record.category.encode(errors="surrogateescape")
    return OWNER.pack(record.identifier, len(name)) + name + MOTORS.pack(*record.directions, *record.powers)


def bytes_of_head(count: int) -> bytes:
    """Return what an archive of so many records begins with; without records, that is all of it."""
    return HEAD.pack(SIGNATURE, VERSION, FLASH_BYTES, count)


def write_archive(file: BinaryIO, records: list[Record]) -> None:
    """Write an archive with these records, in their order."""
    file.write(bytes_of_head(len(records)))
    for record in records:
        head = head_of(record)
        file.write(head + record.flash + CHECKSUM.pack(checksum_of(head, record.flash)))


def read_head(file: BinaryIO) -> int:
    """Read what stands before the first record; returns the number of records.

    Raises:
        ArchiveError: It is not the head of an archive.
    """
    head = file.read(HEAD.size)
    if not head.startswith(SIGNATURE):
        raise ArchiveError("it is not an archive of flash memory: it does not begin with PGFLASH")
    if len(head) < HEAD.size:
        raise ArchiveError(f"it ends in its first {HEAD.size} bytes: it was cut, or is still being copied")
    _, version, flash_bytes, count = HEAD.unpack(head)
    if version != VERSION:
        raise ArchiveError(f"its version is {version}, expected {VERSION}")
    if flash_bytes != FLASH_BYTES:
        old = "; it is of robots before version 3" if flash_bytes == OLD_FLASH_BYTES else ""
        raise ArchiveError(f"its robots have {flash_bytes} bytes of flash memory, expected {FLASH_BYTES}{old}")
    return int(count)


def records_of(file: BinaryIO) -> Iterator[tuple[Record, bool]]:
    """Yield the records of an archive, and whether the checksum of each is right.

    Raises:
        ArchiveError: It is no archive, or it ends too early or too late, or has two records of one robot.
    """
    count = read_head(file)
    known = set()
    for number in range(1, count + 1):
        record, is_right = read_record(file, f"record {number} of {count}")
        owner = (record.category, record.identifier)
        if is_right and owner in known:
            raise ArchiveError(f"it has two records of robot #{record.identifier} of category '{record.category}'")
        if is_right:  # otherwise, whose record it is may be wrong, too
            known.add(owner)
        yield record, is_right
    if file.read(1):
        raise ArchiveError("bytes follow its last record")


def read_record(file: BinaryIO, part: str) -> tuple[Record, bool]:
    """Read a record; returns it, and whether its checksum is right.

    Raises:
        ArchiveError: The file ends in it, which is this part.
    """

    def read(size: int) -> bytes:
        data = file.read(size)
        if len(data) < size:
            raise ArchiveError(f"it ends in {part}: it was cut, or is still being copied")
        return data

    head = read(OWNER.size)
    identifier, length = OWNER.unpack(head)
    name = read(length)
    motors = read(MOTORS.size)
    flash = read(FLASH_BYTES)
    (checksum,) = CHECKSUM.unpack(read(CHECKSUM.size))
    right, left, back, *powers = MOTORS.unpack(motors)
    record = Record(
        category=name.decode(errors="surrogateescape"),
        identifier=identifier,
        directions=(right, left, back),
        powers=(powers[0], powers[1], powers[2]),
        flash=flash,
    )
    return record, checksum == checksum_of(head + name + motors, flash)
