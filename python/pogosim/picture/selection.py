"""Which rows of a data file are drawn: those of one run, with columns that hold what they should."""

from __future__ import annotations

from typing import Any

import numpy as np

from pogosim.deferred import pandas as pd
from pogosim.errors import PictureError
from pogosim.picture.colouring import is_internal
from pogosim.run_columns import RUN, is_one_run, tells_runs_apart
from pogosim.shapes import Floats

# Columns of the file that pictures use, by what they hold.
NUMBERS = ("time", "x", "y", "angle")
INTEGERS = ("led_rgb", "subpart_id")
USED = {*NUMBERS, *INTEGERS, "robot_category", "robot_id", RUN}


def checked(rows: pd.DataFrame) -> pd.DataFrame:
    """Leave out columns that have the name of one of the simulator's, but other values.

    Raises:
        PictureError: A column that the picture needs does not hold what it should, or stands there several times.
    """
    twice = sorted({str(name) for name in rows.columns[rows.columns.duplicated()]} & USED)
    if twice:
        raise PictureError(f"it has several columns {', '.join(twice)}")
    for name in NUMBERS:
        if name in rows and not pd.api.types.is_float_dtype(rows[name]) | pd.api.types.is_integer_dtype(rows[name]):
            raise PictureError(f"its column {name} does not hold numbers")
    for name in ("robot_category", "robot_id"):
        kinds = {"string", "categorical", "integer", "floating", "integer-na", "empty"}
        if name in rows and pd.api.types.infer_dtype(rows[name], skipna=True) not in kinds:
            raise PictureError(f"its column {name} does not hold {'names' if name == 'robot_category' else 'numbers'}")
    rows = rows.loc[:, [not is_internal(name) for name in rows.columns]]
    strange = [name for name in INTEGERS if name in rows and not pd.api.types.is_integer_dtype(rows[name])]
    rows = rows.drop(columns=strange)
    if "robot_category" in rows:
        rows = rows.assign(robot_category=rows["robot_category"].astype(object).fillna("unnamed").astype(str))
    return rows


def numbers_runs(rows: pd.DataFrame, metadata: dict[str, Any]) -> bool:
    """Tell whether there is a column run that numbers runs, as batches write it, and is not the program's own."""
    return RUN in rows and pd.api.types.is_integer_dtype(rows[RUN]) and not is_one_run(rows, metadata)


def one_run(
    rows: pd.DataFrame, metadata: dict[str, Any], run: int | None, combination: int | None
) -> tuple[pd.DataFrame, list[Floats], str]:
    """Choose the rows of one run, of a file of one or of several.

    Args:
        rows: All rows of the file, in its order.
        metadata: Those of the file.
        run: Number in the column run; None: the lowest.
        combination: Combination of a batch, from 0 on; None: the first.

    Returns:
        The rows; the outlines of the arena, none if the file does not say; and what else is in the file, if nothing
        was chosen: empty, or words to be shown.

    Raises:
        PictureError: There is no such run or combination, or the metadata are not those of a run.
    """
    several = numbers_runs(rows, metadata)
    combinations = told_combinations(rows, metadata)
    if combination is not None and not 0 <= combination < len(combinations):
        numbers = f"0 to {len(combinations) - 1}" if combinations else "none"
        raise PictureError(f"it has no combination {combination} (there are {numbers})")
    polygons = metadata.get("arena_polygons", [])
    left_out = ""
    if combinations:
        with_rows = [number for number, entry in enumerate(combinations) if entry["rows"]]
        chosen = combination if combination is not None else next(iter(with_rows), 0)
        start = sum(int(entry["rows"]) for entry in combinations[:chosen])
        rows = rows.iloc[start : start + int(combinations[chosen]["rows"])]
        polygons = combinations[chosen].get("arena_polygons", polygons)
        if combination is None and len(combinations) > 1:
            left_out = f"{len(combinations)} combinations of options; --combination chooses another one"
    if several:
        runs = np.unique(rows[RUN].to_numpy())
        if run is not None and run not in runs:
            raise PictureError(f"it has no run {run}, only {runs[0]} to {runs[-1]}")
        rows = rows[rows[RUN] == (run if run is not None else runs.min())]
        rows, others = of_first_parameters(rows)
        left_out = left_out or others
    elif run not in (None, 0):
        raise PictureError(f"it has no run {run}: no column run numbers several runs")
    return rows, checked_polygons(polygons), left_out


def of_first_parameters(rows: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """Take the rows of the first seed and parameters, of those of runs with one number; and tell of the others."""
    varied = [name for name in map(str, rows.columns) if name != RUN and tells_runs_apart(name)]
    varied = [name for name in varied if rows[name].nunique(dropna=False) > 1]
    if not varied:
        return rows, ""
    first = rows[varied].iloc[0]
    is_same = (rows[varied].eq(first) | (rows[varied].isna() & first.isna())).all(axis=1)
    shown = ", ".join(f"{name} {first[name]}" for name in varied)
    return rows[
        is_same
    ], f"several runs of this number; that of {shown} is drawn (read its file alone to choose another)"


def told_combinations(rows: pd.DataFrame, metadata: dict[str, Any]) -> list[dict[str, Any]]:
    """Return what a batch says of its combinations; empty unless that fits the rows."""
    combinations = metadata.get("combinations")
    if not isinstance(combinations, list):
        return []
    counts = [entry.get("rows") for entry in combinations]
    fits = all(isinstance(count, int) and count >= 0 for count in counts) and sum(counts) == len(rows)
    return combinations if fits else []


def checked_polygons(polygons: list[Floats] | str) -> list[Floats]:
    """Return outlines of the arena that can be drawn; raises PictureError if they cannot."""
    if isinstance(polygons, str):
        raise PictureError("its metadata 'arena_polygons' is not a list of polygons")
    if not all(np.isfinite(polygon).all() for polygon in polygons):
        raise PictureError("its metadata 'arena_polygons' has corners that are not finite numbers")
    if polygons and (np.ptp(polygons[0], axis=0) <= 0).any():
        raise PictureError("its metadata 'arena_polygons' has an outer wall without width or height")
    return polygons
