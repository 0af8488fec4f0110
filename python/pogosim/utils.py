"""Reading the data file of a run, and what the other tools share."""

from __future__ import annotations

import ast
import json
import logging
import warnings
from pathlib import Path
from typing import Any, Union

import matplotlib.pyplot as plt
import pandas as pd
import pyarrow
import yaml
from pyarrow import feather

from pogosim.recover import RecoverError, read_unfinished

PathLike = Union[str, "Path"]


def load_dataframe(path: PathLike) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Read a data file.

    A file whose run goes on or was killed is read as far as it goes, with a warning (RuntimeWarning).

    Args:
        path: Feather file, written by the simulator or by a batch of runs.

    Returns:
        The rows (one per object and save time; lengths in mm, times in s, angles in rad), and the
        metadata of the file. All metadata are texts, except "configuration": a dictionary, empty
        if the file has none or it cannot be parsed. YAML texts such as 1.0e6 stay texts there
        (PyYAML follows YAML 1.1, which wants 1.0e+6).

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The file is not a complete Feather file, nor an unfinished one of the simulator.
    """
    table = read_table(Path(path))
    metadata: dict[str, Any] = {
        key.decode("utf-8", "replace"): value.decode("utf-8", "replace")
        for key, value in (table.schema.metadata or {}).items()
    }
    metadata["configuration"] = parse_configuration(metadata.get("configuration", ""))
    return table.to_pandas(), metadata


def read_table(path: Path) -> pyarrow.Table:
    """Read a data file as load_dataframe does, with its types and metadata as they stand in the file."""
    try:
        return feather.read_table(path, memory_map=False)
    except pyarrow.ArrowInvalid as error:
        try:
            unfinished = read_unfinished(path)
        except RecoverError:
            raise ValueError(f"{path} is not a complete Feather file: {error}") from error
        hint = f"to make a complete file of it: pogosim-recover {path}"
        if not unfinished.says_so:
            raise ValueError(f"{path} is not a complete Feather file: it was cut off; {hint}") from error
    warnings.warn(
        f"{path} is incomplete: its run has not ended, or it was killed. Read: {unfinished.up_to}; {hint}",
        RuntimeWarning,
        stacklevel=3,
    )
    return unfinished.table


def parse_configuration(text: str) -> dict[str, Any]:
    """Parse a configuration kept in a data file: YAML, else JSON, else a Python literal.

    Returns:
        The configuration; empty if the text is no map in any of the three.
    """
    for parse in (yaml.safe_load, json.loads, ast.literal_eval):
        try:
            value = parse(text)
        except (yaml.YAMLError, ValueError, SyntaxError, TypeError, RecursionError, MemoryError):
            continue
        if isinstance(value, dict):
            return value
    return {}


def init_logging(verbose: bool = False) -> None:
    """Log to the standard error, from information upwards; from debug upwards if verbose."""
    logging.basicConfig(
        level=logging.DEBUG if verbose else logging.INFO,
        format="[%(asctime)s] [%(levelname)s] %(message)s",
        force=True,
    )


def save_figure(path: PathLike, dpi: int = 300) -> None:
    """Save the current figure, at `dpi` dots per inch, and close it. Parent folders are created."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    plt.savefig(path, dpi=dpi, bbox_inches="tight")
    plt.close()
