"""Reading the data file of a run, and what the other tools share."""

from __future__ import annotations

import ast
import json
import logging
from pathlib import Path
from typing import Any, Union

import matplotlib.pyplot as plt
import pandas as pd
import pyarrow
import yaml
from pyarrow import feather

PathLike = Union[str, "Path"]


def load_dataframe(path: PathLike) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Read a data file.

    Args:
        path: Feather file, written by the simulator or by a batch of runs.

    Returns:
        The rows (one per object and save time; lengths in mm, times in s, angles in rad), and the
        metadata of the file. All metadata are texts, except "configuration": a dictionary, empty
        if the file has none or it cannot be parsed. YAML texts such as 1.0e6 stay texts there
        (PyYAML follows YAML 1.1, which wants 1.0e+6).

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The file is not a complete Feather file.
    """
    path = Path(path)
    try:
        table = feather.read_table(path, memory_map=False)
    except pyarrow.ArrowInvalid as error:
        raise ValueError(f"{path} is not a complete Feather file: {error}") from error
    metadata: dict[str, Any] = {
        key.decode("utf-8", "replace"): value.decode("utf-8", "replace")
        for key, value in (table.schema.metadata or {}).items()
    }
    metadata["configuration"] = parse_configuration(metadata.get("configuration", ""))
    return table.to_pandas(), metadata


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
