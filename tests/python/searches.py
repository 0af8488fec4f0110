"""Starting searches as a user does, with objectives whose greatest value is known."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
import yaml
from batches import run_main
from pogosim.pogoptim import main
from running import Run, example, scene

COMMAND = [sys.executable, "-m", "pogosim.pogoptim"]

# Two real parameters and a choice, which no program reads: the objective finds them in the data file.
SPACE: dict[str, object] = {
    "simulation_time": 0.1,
    "enable_console_logging": False,
    "objects.robots.nb": 2,
    "parameters": {
        "a": {"optimization_domain": {"type": "float", "min": -1.0, "max": 1.0, "init": -0.5}},
        "b": {"optimization_domain": {"type": "int", "min": 1, "max": 20, "init": 3}},
        "c": {"optimization_domain": {"choices": ["red", "green"]}},
    },
}
# Greatest where a = 0.3, b = 12, c = green; and there 1.
OBJECTIVE = """
def parameters(df):
    return df.attrs["resolved_configuration"]["parameters"]

def objective_fn(df):
    p = parameters(df)
    return 1.0 - (p["a"] - 0.3) ** 2 - ((p["b"] - 12) / 20) ** 2 - (0.1 if p["c"] == "red" else 0.0)

def fd_fn(df):
    p = parameters(df)
    return {"a": (p["a"] + 1.0) / 2.0, "b": p["b"] / 20}
"""


def write_search(folder: Path, changes: Mapping[str, object] | None = None, objective: str = OBJECTIVE) -> Path:
    """Write space.yaml and obj.py in a folder, which is made; None takes a key out."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "space.yaml").write_text(yaml.safe_dump(scene({**SPACE, **(changes or {})}), sort_keys=False))
    (folder / "obj.py").write_text(objective)
    return folder / "space.yaml"


def options(*more: str, program: Path | None = None) -> list[str]:
    """Return the options of a search with space.yaml and obj.py."""
    return ["-c", "space.yaml", "-S", str(program or example("helloworld")), "-O", "obj.py", "-t", "tmp", *more]


def search(folder: Path, *more: str, program: Path | None = None) -> Run:
    """Run a search in a folder, in this process, which saves its start."""
    return run_main(folder, options(*more, program=program), main)


def history(folder: Path, output: str = "opt_out") -> pd.DataFrame:
    """Return all evaluations, without their times."""
    return pd.read_csv(folder / output / "opt_history.csv").drop(columns="timestamp")


def summary(folder: Path, output: str = "opt_out") -> dict[str, Any]:
    """Return the summary of a search."""
    entries: dict[str, Any] = json.loads((folder / output / "summary.json").read_text())
    return entries
