"""A viewer of a live run, as a program: what it has been told, from messages as docs/live.md describes them."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

LEVELS = 65534
MISSING = 65535


@dataclass
class Picture:
    """What a frame shows. Arrays by object."""

    time_s: float
    number: int
    poses: npt.NDArray[np.float64]  # x, y (mm), heading (rad)
    leds: npt.NDArray[np.int64]
    column: npt.NDArray[np.float32] | None  # for colours
    heat: npt.NDArray[np.float32] | None  # for a heat map
    size: int  # bytes


@dataclass
class Client:
    """Takes messages of a run."""

    head: dict[str, Any] = field(default_factory=dict)
    status: dict[str, Any] = field(default_factory=dict)
    pictures: list[Picture] = field(default_factory=list)
    others: list[dict[str, Any]] = field(default_factory=list)
    light: npt.NDArray[np.uint8] | None = None

    @property
    def last(self) -> Picture:
        """What is seen now; waits for it where a new run has not been seen yet."""
        return wait_for(lambda: self.pictures)[-1]  # type: ignore[no-any-return]

    def take(self, message: dict[str, Any] | bytes) -> None:
        """Take a message."""
        if isinstance(message, bytes):
            self._take_bytes(message)
        elif message["kind"] == "head":
            self.head = message["head"]
            count = len(self.head["objects"])
            parts = self.head["membranes"]["dots"] if self.head["membranes"] else 0
            shapes = ((count, 3), (count, 2), (parts, 2), (count, 2), (count, 2))
            self._tables = [np.zeros(shape, np.uint16) for shape in shapes]
            self._columns = (0, 0)
            self.pictures = []  # a new list, for what has been seen is never forgotten while it is read
        elif message["kind"] == "status":
            self.status = message
        else:
            self.others.append(message)

    def _take_bytes(self, message: bytes) -> None:
        if message[0] == 2:
            self.light = np.frombuffer(message, np.uint8)[2:]
            return
        kind, *columns, number, time_s = struct.unpack_from("<HHHId", message)
        assert kind == 1
        poses, leds, parts, *values = self._tables
        for column, before, table in zip(columns, self._columns, values, strict=True):
            if column != before:
                table[:] = 0
        self._columns = tuple(columns)
        at = 18
        told = [table for column, table in zip(columns, values, strict=True) if column]
        for table in (poses, leds, parts, *told):
            at = changed(table, message, at)
        assert at == len(message)
        own, heat = (
            halves(table).view(np.float32) if column else None for column, table in zip(columns, values, strict=True)
        )
        codes = halves(leds).astype(int)
        self.pictures.append(Picture(time_s, number, self._decoded(poses), codes, own, heat, len(message)))

    def _decoded(self, codes: npt.NDArray[np.uint16]) -> npt.NDArray[np.float64]:
        (left, top), (right, bottom) = self.head["poseBox"]
        low, high = np.array([left, top, -np.pi]), np.array([right, bottom, np.pi])
        values = low + (high - low) * codes / LEVELS
        return np.where(codes == MISSING, np.nan, values)

    def of_kind(self, kind: str) -> list[dict[str, Any]]:
        """Return the messages of a kind."""
        return [message for message in self.others if message["kind"] == kind]


def changed(table: npt.NDArray[np.uint16], message: bytes, at: int) -> int:
    """Change the rows of a table that a message says; returns where its next table begins."""
    rows, columns = table.shape
    mask = np.unpackbits(np.frombuffer(message, np.uint8, (rows + 7) // 8, at), bitorder="little")[:rows].astype(bool)
    at += (rows + 7) // 8
    count = int(mask.sum())
    for column in range(columns):
        low, high = (np.frombuffer(message, np.uint8, count, at + part * count).astype(np.uint16) for part in (0, 1))
        table[mask, column] += low + 256 * high
        at += 2 * count
    return at


def halves(table: npt.NDArray[np.uint16]) -> npt.NDArray[np.uint32]:
    """Return 32 bits from their halves."""
    return (table[:, 0].astype(np.uint32) << 16 | table[:, 1]).astype(np.uint32)


def wait_for(what: Callable[[], Any], limit_s: float = 30.0) -> Any:
    """Wait until something is true; returns it."""
    end_s = time.monotonic() + limit_s
    while not (found := what()):
        assert time.monotonic() < end_s, "it has not happened in time"
        time.sleep(0.01)
    return found
