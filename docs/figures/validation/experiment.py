"""Compiling a program of docs/validation, and running it in batches, as users do."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pandas as pd
import yaml
from matplotlib.figure import Figure
from pictures import DOCS, ROOT
from pogosim.utils import load_dataframe

from .agreement import Comparison

SOURCES = DOCS / "validation"


@dataclass(frozen=True)
class Outcome:
    """What a scene gives: its figure, the numbers that it shows, and comparisons."""

    runs: str  # how many of what, for the page
    figure: Figure
    tables: tuple[pd.DataFrame, ...]
    comparisons: tuple[Comparison, ...]

    @property
    def lines(self) -> list[str]:
        """What the page quotes."""
        return [self.runs, *(comparison.line for comparison in self.comparisons)]


@cache
def compiler_flags() -> tuple[str, ...]:
    """Ask pkg-config how to compile for the built library."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(ROOT / "build/release")}
    asked = ["pkg-config", "--cflags", "--libs", "pogosim"]
    return tuple(subprocess.run(asked, env=environment, check=True, capture_output=True, text=True).stdout.split())


def compile_program(name: str, folder: Path, sources: Path = SOURCES) -> Path:
    """Compile NAME.c of a folder into another one. Raises CalledProcessError if the compiler fails."""
    program = folder / name
    command = [
        "cc",
        "-std=c11",
        "-O1",
        "-g",
        "-Wall",
        "-Wextra",
        "-Wfloat-conversion",
        str(sources / f"{name}.c"),
        "-o",
        str(program),
    ]
    subprocess.run([*command, *compiler_flags()], check=True)
    return program


def changed(configuration: dict[str, object], changes: Mapping[str, object]) -> dict[str, object]:
    """Set values in a configuration by dotted keys, which must be there; returns it."""
    for path, value in changes.items():
        *parents, key = path.split(".")
        node: object = configuration
        for parent in parents:
            assert isinstance(node, dict)
            node = node[parent]
        assert isinstance(node, dict)
        assert key in node, path
        node[key] = value
    return configuration


def batch(
    program: Path, configuration: str, runs: int, changes: Mapping[str, object] | None = None
) -> dict[str, pd.DataFrame]:
    """Run docs/validation/CONFIGURATION.yaml with pogobatch.

    Args:
        program: Compiled; results go beside it.
        configuration: Name of the file.
        runs: Runs per combination, with the seeds 0, 1, ...
        changes: Values of dotted keys that differ from the file.

    Returns:
        The rows of each file of results, by its name without suffix.

    Raises:
        CalledProcessError: The batch fails, or a run.
    """
    settings = yaml.safe_load((SOURCES / f"{configuration}.yaml").read_text(encoding="utf-8"))
    path = program.parent / f"{configuration}.yaml"
    path.write_text(yaml.safe_dump(changed(settings, changes or {}), sort_keys=False), encoding="utf-8")
    results = program.parent / f"{configuration}_results"
    command = [sys.executable, "-m", "pogosim", "batch", "-c", str(path), "-S", str(program), "-r", str(runs)]
    command += ["-t", str(program.parent / "tmp"), "-o", str(results)]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE)
    frames = {file.stem: load_dataframe(file)[0] for file in sorted(results.glob("*.feather"))}
    for file in results.iterdir():
        file.unlink()
    return frames
