"""The spots table of TrackMate, as it exports it: three more header rows, the last with units, and many more columns.

J.-Y. Tinevez et al., "TrackMate: an open and extensible platform for single-particle tracking", Methods 115, 2017.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

MARK = "POSITION_X"  # a column that all its tables of spots have
OF_SPOTS = {"x": "POSITION_X", "y": "POSITION_Y", "time": "POSITION_T", "frame": "FRAME", "id": "TRACK_ID"}
UNITS = {
    **dict.fromkeys(("pixel", "pixels", "px"), "px"),
    **dict.fromkeys(("micron", "microns", "um", "\u00b5m", "\u03bcm"), "um"),
    **dict.fromkeys(("inch", "inches", "in"), "inch"),
    **dict.fromkeys(("s", "sec", "second", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec"), "ms"),
    **dict.fromkeys(("frame", "frames"), "frame"),
    **{name: name for name in ("mm", "cm", "m")},
}


def encoding_of(path: Path) -> str:
    """Return the encoding of a CSV file: UTF-8, or that of Windows if TrackMate wrote the sign of microns there."""
    with path.open("rb") as file:
        start = file.readline() + file.readline() + file.readline() + file.readline()
    try:
        start.decode()
    except UnicodeDecodeError:
        return "latin-1" if MARK.encode() in start else "utf-8-sig"
    return "utf-8-sig"


def spots(table: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, str]]:
    """Return the columns that are needed of a table of spots, and their units where it says them.

    Spots that belong to no track have no id. Times that count frames are left out, since there is a column of frames.
    """
    columns = {name: table[own] for name, own in OF_SPOTS.items() if own in table}
    rows = pd.DataFrame(columns)
    is_number = pd.to_numeric(rows["x"], errors="coerce").notna().to_numpy()
    heads = int(is_number.argmax()) if is_number.any() else len(rows)
    units: dict[str, str] = {}
    if heads:
        said = rows.iloc[heads - 1].astype(str).str.strip().str.strip("()").str.lower()
        units = {str(name): UNITS[text] for name, text in said.items() if text in UNITS}
    if units.get("time") == "frame" and "frame" in rows:
        rows = rows.drop(columns="time")
        units.pop("time")
    rows = rows.iloc[heads:].reset_index(drop=True)
    if "id" in rows:
        rows["id"] = rows["id"].replace({"None": np.nan, "": np.nan})
    return rows, units
