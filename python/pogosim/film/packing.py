"""Tables of a run as few bytes: numbers as 16 bits, steps in time, then deflate.

A table of shape (t, n) is stored object by object as differences from one time to the next, modulo 65536; low bytes
first, then high bytes, which are mostly equal. Readers of the page undo it, see recorded_run.js.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.deferred import pandas as pd
from pogosim.errors import PictureError
from pogosim.picture.colouring import Scale, holds_numbers, label_of, numbers_of, scale_of, swatches_of
from pogosim.shapes import Floats

MISSING = 65535  # the code of no value
LEVELS = 65534  # the highest of quantised numbers
MAX_NUMBERS = 4096  # different numbers of a column that are kept as they are
MAX_TEXT = 1_000_000  # characters of all different names of a column

Codes = npt.NDArray[np.uint16]


@dataclass
class Packer:
    """Tables one behind the other."""

    tables: list[bytes] = field(default_factory=list)

    def add(self, codes: Codes) -> int:
        """Add a table of shape (t, n); returns its number."""
        steps = np.diff(codes.T, axis=1, prepend=np.uint16(0)).astype(np.uint16).ravel()
        self.tables.append((steps & 0xFF).astype(np.uint8).tobytes() + (steps >> 8).astype(np.uint8).tobytes())
        return len(self.tables) - 1

    def packed(self) -> str:
        """Return all tables, compressed, as text (base64)."""
        return base64.b64encode(zlib.compress(b"".join(self.tables), 9)).decode("ascii")


def quantised(values: Floats, low: float, high: float) -> Codes:
    """Codes 0 to 65534 of numbers between two limits; 65535 where there is none. Any shape."""
    span = high - low if high > low else 1.0
    known = np.isfinite(values)
    share = np.clip((np.where(known, values, low) - low) / span, 0.0, 1.0)
    return np.where(known, np.round(share * LEVELS), MISSING).astype(np.uint16)


def hex_colour(colour: Floats) -> str:
    """Return a colour of shape (3,), 0 to 1, as #rrggbb."""
    return "#" + "".join(f"{round(255 * float(channel)):02x}" for channel in colour)


def encode_column(values: pd.Series[Any], name: str) -> tuple[Codes, dict[str, Any]]:
    """Encode a column of a data file.

    Args:
        values: Shape (rows,).
        name: Name of the column.

    Returns:
        Codes, shape (rows,), and what they mean: "values" (exact numbers) or "low" and "high" (quantised ones), with
        "scale": name of the colours and limits; or "labels" with their "colours".

    Raises:
        PictureError: The column cannot be shown.
    """
    if holds_numbers(values):
        return encode_numbers(values, name)
    present = values.notna().to_numpy()
    try:
        codes, labels = pd.factorize(values.map(label_of, na_action="ignore"), sort=True)
    except TypeError as error:
        raise PictureError(f"its column {name} holds neither numbers nor names") from error
    if len(labels) >= MISSING or sum(map(len, labels)) > MAX_TEXT:
        raise PictureError(f"its column {name} has too many different values ({len(labels)})")
    colours = [hex_colour(colour) for colour in swatches_of(len(labels))]
    return np.where(present, codes, MISSING).astype(np.uint16), {
        "name": name,
        "labels": list(labels),
        "colours": colours,
    }


def encode_numbers(values: pd.Series[Any], name: str) -> tuple[Codes, dict[str, Any]]:
    """Encode a column of numbers, exactly if there are few different ones. Returns as encode_column()."""
    numbers = numbers_of(values)
    known = np.isfinite(numbers)
    scale = scale_of(name, numbers)
    colours = {"name": name, "from": scale.low, "to": scale.high, "shades": "angle" if is_angle(scale) else "number"}
    different = np.unique(numbers[known])
    if len(different) <= MAX_NUMBERS:
        codes = np.where(known, np.searchsorted(different, np.where(known, numbers, 0.0)), MISSING)
        return codes.astype(np.uint16), {**colours, "values": [plain_number(value, values) for value in different]}
    low, high = float(different[0]), float(different[-1])
    return quantised(numbers, low, high), {**colours, "low": low, "high": high}


def is_angle(scale: Scale) -> bool:
    """Tell whether colours go around the circle."""
    return bool((scale.low, scale.high) == (-np.pi, np.pi))


def plain_number(value: float, values: pd.Series[Any]) -> float | int:
    """Return a number as short as it can be written: whole, or with the digits that its type has."""
    if float(value).is_integer() and abs(value) < 2**53:
        return int(value)
    return float(str(np.float32(value))) if values.dtype == np.float32 else float(value)
