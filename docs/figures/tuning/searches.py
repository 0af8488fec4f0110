"""Running pogoptim as users do, and what a scene says of it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
import yaml
from matplotlib.figure import Figure
from pictures import ROOT
from validation.experiment import changed


@dataclass(frozen=True)
class Claim:
    """Something that a scene says, and whether it is so."""

    text: str
    is_true: bool

    @property
    def line(self) -> str:
        """One line for the page."""
        return f"{self.text}: {'yes' if self.is_true else 'NO'}"


@dataclass(frozen=True)
class Outcome:
    """What a scene gives."""

    lines: tuple[str, ...]  # numbers
    claims: tuple[Claim, ...]
    figure: Figure | None = None
    tables: tuple[pd.DataFrame, ...] = ()

    @property
    def quoted(self) -> list[str]:
        """What the page quotes."""
        return [*self.lines, *(claim.line for claim in self.claims)]


@dataclass(frozen=True)
class Found:
    """A search that is done.

    Attributes:
        folder: Folder of its results.
        summary: Its summary.json.
        history: Its opt_history.feather.
    """

    folder: Path
    summary: Mapping[str, Any] = field(repr=False)
    history: pd.DataFrame = field(repr=False)

    @property
    def fresh_mean(self) -> float:
        """Mean fitness of the best candidate on fresh seeds."""
        return float(self.summary["best_fresh"]["mean"])


def search(
    program: Path, configuration: Path, folder: Path, options: list[str], changes: Mapping[str, object] | None = None
) -> Found:
    """Run pogoptim.

    Args:
        program: Compiled for Pogosim.
        configuration: Names of files in it count from the project's folder.
        folder: For its results; must not be there yet.
        options: Options of the command line.
        changes: Values of dotted keys that differ from the file.

    Raises:
        CalledProcessError: It fails.
    """
    folder.mkdir(parents=True)
    path = folder / "searched.yaml"
    entries = yaml.safe_load(configuration.read_text(encoding="utf-8"))
    path.write_text(yaml.safe_dump(changed(entries, changes or {}), sort_keys=False), encoding="utf-8")
    command = [sys.executable, "-m", "pogosim", "optimize", "-c", str(path), "-S", str(program), *options]
    command += ["-o", str(folder), "-t", str(folder / "tmp")]
    subprocess.run(command, cwd=ROOT, check=True, stderr=subprocess.PIPE)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return Found(folder, summary, pd.read_feather(folder / "opt_history.feather"))


def example(name: str) -> Path:
    """Return the program of an example.

    Raises:
        FileNotFoundError: It is not built.
    """
    path = ROOT / "examples" / name / name
    if not path.is_file():
        raise FileNotFoundError(f"{path} is not there")
    return path
