"""What the scripts of the pictures in docs/ share: keeping a picture, and telling whether it is out of date.

A picture keeps, in texts of its PNG file, the number of rows it was drawn from and their hash, and where it was drawn.
So it can be compared with a run of today: the rows if the compiler and the C library are the same, since others may
round differently; the pixels if matplotlib is the same, too.
"""

from __future__ import annotations

import hashlib
import io
import platform
import re
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
MAX_MEAN_DIFFERENCE = 1.0  # of a colour channel, 0 to 255: fonts may be smoothed differently


@dataclass(frozen=True)
class Picture:
    """A picture, and what it shows."""

    image: bytes  # PNG
    data: str  # rows and hash of what was drawn, see fingerprint()
    is_exact: bool = True  # whether its pixels are compared, too


def fingerprint(*frames: pd.DataFrame) -> str:
    """Describe tables: "100 x 8 0123456789abcdef" each, rows times columns and a hash of all values and names."""
    texts = []
    for frame in frames:
        digest = hashlib.sha256()
        for name, column in frame.items():
            is_number = pd.api.types.is_numeric_dtype(column)
            values = column.to_numpy(dtype=float).tobytes() if is_number else "\n".join(map(str, column)).encode()
            digest.update(f"\n{name}\n".encode() + values)
        texts.append(f"{frame.shape[0]} x {frame.shape[1]} {digest.hexdigest()[:16]}")
    return ", ".join(texts)


def without_hashes(data: str) -> str:
    """Return the sizes of tables alone."""
    return re.sub(r" [0-9a-f]{16}\b", "", data)


def drawn_on() -> dict[str, str]:
    """Tell on what pictures are drawn here: what rounding may depend on, and what draws."""
    compiler = ""
    for build in sorted((ROOT / "build").glob("*/CMakeFiles/*/CMakeCXXCompiler.cmake")):
        found = dict(
            re.findall(r'^set\((CMAKE_CXX_COMPILER_(?:ID|VERSION)) "(.*)"\)$', build.read_text(), re.MULTILINE)
        )
        compiler = " ".join(found.values())
    return {
        "Platform": f"{platform.machine()} {' '.join(platform.libc_ver())} {compiler}",
        "Software": f"matplotlib {mpl.__version__}",
    }


def from_figure(figure: Figure, dpi: float, *frames: pd.DataFrame) -> Picture:
    """Draw a figure that shows these tables."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi)
    return Picture(buffer.getvalue(), fingerprint(*frames))


def keep(picture: Picture, path: Path) -> None:
    """Write a picture, with what it was drawn from and on."""
    texts = PngInfo()
    for key, value in {"Data": picture.data, **drawn_on()}.items():
        texts.add_text(key, value)
    with Image.open(io.BytesIO(picture.image)) as image:
        image.convert("RGB").save(path, pnginfo=texts, optimize=True)


def pixels(image: Image.Image) -> np.ndarray:
    """Colours of a picture. Shape (height, width, 3), 0 to 255."""
    return np.asarray(image.convert("RGB"), dtype=float)


def difference(path: Path, today: Picture) -> str:
    """Tell in what a kept picture differs from today's; empty if in nothing."""
    with Image.open(path) as kept:
        texts, colours = dict(kept.info), pixels(kept)
    here = drawn_on()
    same_platform = texts.get("Platform") == here["Platform"]
    was, is_now = texts.get("Data", "nothing"), today.data
    if not same_platform:
        was, is_now = without_hashes(was), without_hashes(is_now)
    if was != is_now:
        return f"{path.name} was drawn from {was}, now it would be {is_now}"
    if not today.is_exact or not same_platform or texts.get("Software") != here["Software"]:
        return ""
    with Image.open(io.BytesIO(today.image)) as drawn:
        now = pixels(drawn)
    if now.shape != colours.shape:
        return f"{path.name} has {colours.shape[1]} x {colours.shape[0]} pixels, now {now.shape[1]} x {now.shape[0]}"
    mean = float(np.abs(now - colours).mean())
    return f"{path.name} looks different (by {mean:.1f} of 255 on average)" if mean > MAX_MEAN_DIFFERENCE else ""
