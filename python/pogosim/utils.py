"""Reading the data file of a run, and helpers shared by the other tools."""

from __future__ import annotations

import contextlib
import functools
import logging
import os
import warnings
from collections.abc import Hashable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow
from pyarrow import feather

from pogosim.arguments import Arguments
from pogosim.damaged_files import damage_told
from pogosim.deferred import pandas as pd
from pogosim.errors import DamagedFileError
from pogosim.outputs import PathLike
from pogosim.recover import RecoverError, Unfinished, is_complete, read_unfinished
from pogosim.several_files import files_that_fit, is_pattern, join_files
from pogosim.table_formats import CSV, format_in
from pogosim.table_metadata import NoMetadataWarning, are_of_runs, metadata_of, parse_facts, shared
from pogosim.table_metadata import parse_configuration as parse_configuration
from pogosim.tables import read_other
from pogosim.varied import OBJECTS, plain
from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml

given = Arguments()


def load_dataframe(path: PathLike | Sequence[PathLike]) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Read a data file, or several.

    The file of an active or killed run is read up to its last complete rows, with a warning (RuntimeWarning). A file
    that says nothing of its run is read with a NoMetadataWarning.

    Args:
        path: Feather, Parquet or CSV file, written by the simulator or by a batch of runs. Several files, as a list or
            as a pattern such as "results/*.feather" (`**` also searches subfolders), are joined, see
            `pogosim.several_files.join_files`: they get columns with their number, seed and varied parameters. Parts of
            a run that went on from a saved state are one run; a later part alone is read as it is.

    Returns:
        The rows (one per object and save time; lengths in mm, times in s, angles in rad), and the
        metadata of the file. All metadata are strings, except:
        "configuration": a dictionary; empty if the file has none or it cannot be parsed.
        "resolved_configuration": a dictionary of every key with its value in the run, defaults
        included; not there if the file has none.
        "objects": a dictionary with a list for each category, of what the objects of its entries have; not there if
        the file has none.
        "arena_polygons": a list of outlines, each an array of shape (corners, 2) with x and y in mm (files of
        simulators up to 0.10 have them in units of 100 mm, which is recognised by the positions of the robots);
        it remains a string if it is not a list of polygons.
        "combinations": of a batch, a list with a dictionary per combination of options.
        "files": of several files, the list of their names.
        The `attrs` of the dataframe are a copy of the metadata, with lists in place of arrays. All that is selected
        from the dataframe shares them. Where pandas saved them with a dataframe (`to_feather`, `to_parquet`), they are
        its metadata.

    Raises:
        FileNotFoundError: There is no such file, or none that fits the pattern.
        OSError: A file cannot be read.
        ValueError: What was given is no path, or an empty list. An earlier part of a run that went on from a saved
            state is not among several files. A file is damaged, or neither a complete Feather file
            nor an unfinished one of the simulator (`pogosim.errors.DamagedFileError`).
    """
    if isinstance(path, Iterable) and not isinstance(path, (str, bytes, os.PathLike)):
        files = [given.path(f"path[{number}]", file) for number, file in enumerate(path)]
        rows, metadata = join_files([(file, *load_file(file)) for file in files])
    elif is_pattern(one := given.path("path", path)):
        rows, metadata = join_files([(file, *load_file(file)) for file in files_that_fit(one)])
    else:
        rows, metadata = load_file(one)
    rows.attrs = attributes(metadata)
    return rows, metadata


def attributes(metadata: dict[str, Any]) -> dict[Hashable | None, Any]:
    """Return metadata as the `attrs` of a dataframe."""
    return {name: shared(plain(value)) for name, value in metadata.items()}


def load_file(path: Path, warns: bool = True) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Read one data file: what `load_dataframe` does with it, and without its warning if that is not wanted."""
    table = read_table(path, warns)
    with damage_told(path):
        rows = table.to_pandas()
    metadata = parsed_metadata(table.schema)
    is_told_of = format_in(path) == CSV  # when it was read
    if warns and not is_told_of and not are_of_runs(metadata_of(table.schema)):
        warn_of_no_metadata(path)
    if "arena_polygons" in metadata:
        metadata["arena_polygons"] = in_millimetres(metadata["arena_polygons"], rows)
    return rows, metadata


def warn_of_no_metadata(path: Path) -> None:
    """Warn (NoMetadataWarning) that a file says nothing of its run."""
    warnings.warn(
        f"{path} has no metadata of a run, so configuration and arena are unknown; a dataframe of load_dataframe "
        "keeps them in its attrs, and to_feather and to_parquet of pandas save these",
        NoMetadataWarning,
        stacklevel=4,
    )


def parsed_metadata(schema: pyarrow.Schema) -> dict[str, Any]:
    """Return the metadata of a table as `load_dataframe` does, but outlines in the unit of the file."""
    return parsed(metadata_of(schema))


def parsed(metadata: dict[str, Any]) -> dict[str, Any]:
    """Parse the texts that metadata of a run or of a batch are, in their place; returns them."""
    metadata["configuration"] = parse_configuration(metadata.get("configuration", ""))
    if "resolved_configuration" in metadata:
        metadata["resolved_configuration"] = parse_configuration(metadata["resolved_configuration"])
    if "arena_polygons" in metadata:
        metadata["arena_polygons"] = parse_polygons(metadata["arena_polygons"])
    if OBJECTS in metadata:
        metadata[OBJECTS] = parse_facts(metadata[OBJECTS])
    if "combinations" in metadata:
        metadata["combinations"] = parse_combinations(metadata["combinations"])
    return metadata


def read_table(path: Path, warns: bool = True) -> pyarrow.Table:
    """Read a data file as load_dataframe does, keeping the types and metadata of the file.

    Raises:
        OSError: It cannot be read.
        DamagedFileError: It is damaged, or no data file.
        ValueError: It is no file.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise ValueError(f"{path} is not a file, but a pipe, a socket or a device; expected a data file")
    with damage_told(path):
        if (other := read_other(path)) is not None:
            return other
    try:
        with damage_told(path), path.open("rb") as file:
            table = feather.read_table(file, memory_map=False)
            table.validate(full=True)  # or damaged places of texts lead out of memory
            return table
    except DamagedFileError:
        unfinished = being_written(path)
        if unfinished is None:
            raise
    if warns:
        warnings.warn(
            f"{path} is incomplete: its run is still going on, or was killed. Read {unfinished.up_to}; "
            f"to recover it: pogosim-recover {path}",
            RuntimeWarning,
            stacklevel=4,
        )
    return unfinished.table


def being_written(path: Path) -> Unfinished | None:
    """Return the rows of a file whose run has not ended, or was killed; None for others."""
    if is_complete(path):
        return None
    try:
        unfinished = read_unfinished(path)
    except RecoverError:
        return None
    return unfinished if unfinished.says_so else None


def polygons_of(polygons: Any) -> list[npt.NDArray[np.float64]]:
    """Convert sequences of sequences of {x, y}, or of pairs as in `attrs`, to arrays of shape (corners, 2)."""
    return [
        np.array([[p["x"], p["y"]] if isinstance(p, dict) else p for p in polygon], dtype=np.float64)
        for polygon in polygons
    ]


def parse_polygons(stored: Any) -> Any:
    """Parse the polygons stored in a data file: YAML, a sequence of sequences of {x, y}; or as they are in `attrs`.

    Returns:
        Arrays of shape (corners, 2) in the unit of the file (mm); what was stored if it cannot be parsed.
    """
    try:
        arrays = outlines_in(stored) if isinstance(stored, str) else tuple(polygons_of(stored))
    except WRONG_VALUES:
        return stored
    return [array.copy() for array in arrays] if all(array.ndim == 2 for array in arrays) else stored


@functools.lru_cache(maxsize=8)
def outlines_in(text: str) -> tuple[npt.NDArray[np.float64], ...]:
    """Parse polygons; those of the last arenas are remembered, as many files are of one arena."""
    return tuple(polygons_of(parse_yaml(text) or []))


def in_millimetres(polygons: Any, rows: pd.DataFrame) -> Any:
    """Convert outlines in units of 100 mm, which simulators up to 0.10 write.

    They are taken for such if nine in ten positions are within the bounding box of the outlines that are 100 times as
    large, and not one in ten within that of those in the file.
    """
    has_outlines = isinstance(polygons, list) and polygons and all(isinstance(own, np.ndarray) for own in polygons)
    if not has_outlines or not {"x", "y"} <= set(rows.columns):
        return polygons
    try:
        return scaled(polygons, positions_within(polygons, rows))
    except (TypeError, ValueError):
        return polygons


def positions_within(polygons: list[npt.NDArray[np.float64]], rows: pd.DataFrame) -> npt.NDArray[np.int64]:
    """Count positions: all, those within the bounding box of outlines, and within one that is 100 times as large."""
    position = rows[["x", "y"]].to_numpy(dtype=float)
    position = position[np.isfinite(position).all(axis=1)]
    low, high = polygons[0].min(axis=0), polygons[0].max(axis=0)
    inside = [((position >= scale * low) & (position <= scale * high)).all(axis=1).sum() for scale in (1.0, 100.0)]
    return np.array([len(position), *inside])


def scaled(polygons: list[npt.NDArray[np.float64]], counts: npt.NDArray[np.int64]) -> list[npt.NDArray[np.float64]]:
    """Return outlines in millimetres, by what `positions_within` counts."""
    total, within, within_larger = counts
    if total == 0 or not (within_larger / total > 0.9 and within / total < 0.1):
        return polygons
    return [100.0 * polygon for polygon in polygons]


def parse_combinations(stored: Any) -> Any:
    """Parse what a batch says about its combinations: YAML, a sequence of maps; else what was stored."""
    try:
        combinations = parse_yaml(stored) if isinstance(stored, str) else stored
    except WRONG_VALUES:
        return stored
    if not isinstance(combinations, list) or not all(isinstance(entry, dict) for entry in combinations):
        return stored
    for entry in combinations:
        with contextlib.suppress(KeyError, TypeError, ValueError):
            entry["arena_polygons"] = polygons_of(entry["arena_polygons"])
    return combinations


def init_logging(verbose: bool = False) -> None:
    """Log to standard error at level INFO, or DEBUG if verbose."""
    logging.basicConfig(
        level=logging.DEBUG if verbose else logging.INFO,
        format="[%(asctime)s] [%(levelname)s] %(message)s",
        force=True,
    )


def save_figure(path: PathLike, dpi: int = 300) -> None:
    """Save the current figure, at `dpi` dots per inch, and close it. Parent folders are created."""
    import matplotlib.pyplot as plt  # takes a while

    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    plt.savefig(path, dpi=dpi, bbox_inches="tight")
    plt.close()
