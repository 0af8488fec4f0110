"""Reading the data file of a run, and helpers shared by the other tools."""

from __future__ import annotations

import ast
import json
import logging
import re
import warnings
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow
import yaml
from pyarrow import feather

from pogosim.outputs import PathLike
from pogosim.recover import DAMAGED, RecoverError, is_complete, read_unfinished, reraise_system_error

INTEGER = "tag:yaml.org,2002:int"
FLOAT = "tag:yaml.org,2002:float"

# Tags that PyYAML (YAML 1.1) resolves and the simulator does not.
ONLY_IN_YAML_1_1 = (INTEGER, FLOAT, "tag:yaml.org,2002:timestamp", "tag:yaml.org,2002:value")


class ConfigurationLoader(yaml.SafeLoader):
    """YAML with the numbers of YAML 1.2, as the simulator reads them: 2.22e6 and 1e3 are numbers, 010 is ten."""

    # Resolvers that are added to a class are added to a copy of this.
    yaml_implicit_resolvers = {  # noqa: RUF012
        first: [(tag, pattern) for tag, pattern in resolvers if tag not in ONLY_IN_YAML_1_1]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }


def construct_integer(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> int:
    """Construct a decimal, hexadecimal (0x1F) or octal (0o17) integer."""
    text = loader.construct_scalar(node).lower()
    bases = {"0x": 16, "0o": 8}
    return int(text, bases.get(text.lstrip("+-")[:2], 10))


ConfigurationLoader.add_implicit_resolver(
    INTEGER, re.compile(r"[-+]?([0-9]+|0[xX][0-9a-fA-F]+|0o[0-7]+)$"), list("-+0123456789")
)
ConfigurationLoader.add_implicit_resolver(
    FLOAT,
    re.compile(
        r"""[-+]?([0-9]+\.[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$
        |[-+]?[0-9]+[eE][-+]?[0-9]+$
        |[-+]?\.(inf|Inf|INF)$
        |\.(nan|NaN|NAN)$""",
        re.VERBOSE,
    ),
    list("-+.0123456789"),
)
ConfigurationLoader.add_constructor(INTEGER, construct_integer)


def load_dataframe(path: PathLike) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Read a data file.

    The file of an active or killed run is read up to its last complete rows, with a warning (RuntimeWarning).

    Args:
        path: Feather file, written by the simulator or by a batch of runs.

    Returns:
        The rows (one per object and save time; lengths in mm, times in s, angles in rad), and the
        metadata of the file. All metadata are strings, except:
        "configuration": a dictionary; empty if the file has none or it cannot be parsed.
        "resolved_configuration": a dictionary of every key with its value in the run, defaults
        included; not there if the file has none.
        "arena_polygons": a list of outlines, each an array of shape (corners, 2) with x and y in mm;
        it remains a string if it is not a list of polygons.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The file is damaged, or neither a complete Feather file nor an unfinished one of the simulator.
    """
    table = read_table(Path(path))
    try:
        rows = table.to_pandas()
    except DAMAGED as error:
        raise ValueError(f"{path} is damaged: its rows cannot be read: {error}") from error
    metadata: dict[str, Any] = {
        key.decode("utf-8", "replace"): value.decode("utf-8", "replace")
        for key, value in (table.schema.metadata or {}).items()
    }
    metadata["configuration"] = parse_configuration(metadata.get("configuration", ""))
    if "resolved_configuration" in metadata:
        metadata["resolved_configuration"] = parse_configuration(metadata["resolved_configuration"])
    if "arena_polygons" in metadata:
        metadata["arena_polygons"] = parse_polygons(metadata["arena_polygons"])
    return rows, metadata


def read_table(path: Path) -> pyarrow.Table:
    """Read a data file as load_dataframe does, keeping the types and metadata of the file."""
    with path.open("rb") as file:
        try:
            return feather.read_table(file, memory_map=False)
        except DAMAGED as error:
            reraise_system_error(error)
            reason = error
    try:
        unfinished = read_unfinished(path)
    except RecoverError:
        raise ValueError(f"{path} is not a complete Feather file: {reason}") from reason
    hint = f"to recover it: pogosim-recover {path}"
    if is_complete(path):
        raise ValueError(
            f"{path} is damaged: {reason}; to save its first rows ({unfinished.up_to}): "
            f"pogosim-recover {path} -o another_file.feather"
        ) from reason
    if not unfinished.says_so:
        raise ValueError(f"{path} is not a complete Feather file: it is truncated; {hint}") from reason
    warnings.warn(
        f"{path} is incomplete: its run is still going on, or was killed. Read {unfinished.up_to}; {hint}",
        RuntimeWarning,
        stacklevel=3,
    )
    return unfinished.table


def parse_yaml(text: str) -> Any:
    """Parse YAML, with numbers as the simulator reads them."""
    return yaml.load(text, Loader=ConfigurationLoader)


def parse_polygons(text: str) -> list[npt.NDArray[np.float64]] | str:
    """Parse the polygons stored in a data file: YAML, a sequence of sequences of {x, y}.

    Returns:
        Arrays of shape (corners, 2) in the unit of the file (mm); the text itself if it cannot be parsed.
    """
    try:
        polygons = parse_yaml(text) or []
        arrays = [np.array([[p["x"], p["y"]] for p in polygon], dtype=np.float64) for polygon in polygons]
    except (yaml.YAMLError, KeyError, TypeError, ValueError, RecursionError):
        return text
    return arrays if all(array.ndim == 2 for array in arrays) else text


def parse_configuration(text: str) -> dict[str, Any]:
    """Parse the configuration stored in a data file: YAML, JSON or a Python literal.

    Returns:
        The configuration; empty if the text is not a map in any of the three.
    """
    for parse in (parse_yaml, json.loads, ast.literal_eval):
        try:
            value = parse(text)
        except (yaml.YAMLError, ValueError, SyntaxError, TypeError, RecursionError, MemoryError):
            continue
        if isinstance(value, dict):
            return value
    return {}


def init_logging(verbose: bool = False) -> None:
    """Log to standard error at level INFO, or DEBUG if verbose."""
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
