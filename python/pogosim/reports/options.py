"""What all analyses have in common: reading the data, writing tables, and what they say when it cannot be done."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import pandas as pd
import pyarrow

from pogosim.analysis.robot_sizes import DifferentRobotsWarning
from pogosim.analysis.stored_runs import ReadAsAWhole, StoredRun, runs_of
from pogosim.analysis.trajectories import Run, Trajectories, trajectories_of
from pogosim.command.parser import complain, warn, warnings_told
from pogosim.errors import AnalysisError, ToolError
from pogosim.fonts import without_tex
from pogosim.lines import say
from pogosim.outputs import OutputError, leads_to, told
from pogosim.periodic import AmbiguousStepsWarning
from pogosim.reports.each_run import Bar
from pogosim.several_files import files_that_fit, is_pattern
from pogosim.utils import load_dataframe

# What pandas, numpy and the libraries behind the analyses raise for values that no run has.
STRANGE_DATA = (
    *(ArithmeticError, IndexError, KeyError, MemoryError, RuntimeError, TypeError, ValueError),
    pyarrow.ArrowException,
)

R = TypeVar("R", bound=Run)

OUTPUT_FOLDERS = ("arenas", "stats", "traces")
OUTPUT_SUFFIXES = (".csv", ".gif", ".json", ".pdf", ".pkl", ".png", ".txt")


def open_runs(options: argparse.Namespace, prog: str) -> list[Run]:
    """Find the runs that the options name. Rows of a complete Feather or Parquet file stay in it, in others in memory.

    Rows of several files, of CSV files, and of those in which the rows of a run are not in the order of time, are read
    into memory by `read_runs`.

    Raises:
        AnalysisError: See `read_runs`.
        OSError: See `read_runs`.
    """
    runs = stored_runs(options, prog)
    return list(read_runs(options, prog)) if runs is None else with_reach(runs, options)


def stored_runs(options: argparse.Namespace, prog: str) -> list[StoredRun] | None:
    """Return the runs of a file whose rows can stay in it; None for others.

    Raises:
        AnalysisError: There is nothing to analyse.
    """
    if len(options.input) > 1 or is_pattern(options.input[0]):
        return None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            with Bar("rows", [0]) as bar:
                runs = runs_of(Path(options.input[0]), options.category, bar.expect)
        except AnalysisError:
            tell_warnings(caught, prog)
            raise
        except (ReadAsAWhole, OSError, *STRANGE_DATA):  # reading all of it says what is wrong
            return None
    tell_warnings(caught, prog)
    return runs


def tell_warnings(caught: Sequence[warnings.WarningMessage], prog: str) -> None:
    """Print warnings as lines of a command."""
    for warning in caught:
        warn(prog, warning.message)


def with_reach(runs: Sequence[R], options: argparse.Namespace) -> list[R]:
    """Return the runs with the reach that the options name."""
    if options.rc is None:
        return list(runs)
    return [replace(run, sizes=run.sizes.with_reach(options.rc)) for run in runs]


def read_runs(options: argparse.Namespace, prog: str) -> list[Trajectories]:
    """Read the runs that the options name into memory.

    A file of a killed run is read as far as it goes, with a warning.

    Raises:
        AnalysisError: There is nothing to analyse.
        DamagedFileError: A file is damaged.
        OSError, *STRANGE_DATA: A file cannot be read.
    """
    files = options.input[0] if len(options.input) == 1 else options.input
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            rows, metadata = load_dataframe(files)
            runs = trajectories_of(rows, metadata, options.category)
        finally:
            tell_warnings(caught, prog)
    return with_reach(runs, options)


def output_folder(options: argparse.Namespace) -> Path:
    """Make the folder for the output.

    Raises:
        OutputError: It cannot be one, or has an input whose name is that of a table or a figure.
    """
    folder = Path(options.output_dir)
    for name in options.input:
        if Path(name).suffix in OUTPUT_SUFFIXES and Path(name).resolve().is_relative_to(folder.resolve()):
            raise OutputError(f"{name} is an input that might be overwritten; choose another folder with -o")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise OutputError(f"{folder} is a file; -o wants a folder") from None
    except OSError as error:
        raise OutputError(f"cannot make the folder {folder}: {(error.strerror or str(error)).lower()}") from error
    refuse_links_to_inputs(folder, options.input)
    return folder


def refuse_links_to_inputs(folder: Path, inputs: Sequence[str]) -> None:
    """Raise OutputError if an output of an analysis could be written over an input, under another name of it."""
    files = [file for name in inputs for file in (files_that_fit(name) if is_pattern(name) else [Path(name)])]
    own = [path for path in folder.iterdir() if not path.is_dir()]
    own += [path for name in OUTPUT_FOLDERS for path in Path(folder, name).rglob("*") if not path.is_dir()]
    for path in own:
        if path.suffix in OUTPUT_SUFFIXES and any(leads_to(path, file) for file in files):
            raise OutputError(f"{path} leads to an input, which might be overwritten; choose another folder with -o")


def write_table(table: pd.DataFrame, path: Path, inputs: Sequence[str]) -> None:
    """Write a table as CSV.

    Raises:
        OutputError: It would take the place of an input.
    """
    if any(leads_to(path, name) for name in inputs):
        raise OutputError(f"{path} is an input; choose another folder with -o")
    path.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(path, index=False)


def labelled(table: pd.DataFrame, run: Run) -> pd.DataFrame:
    """Return a table with the labels of its run as first columns."""
    labels = pd.DataFrame({name: [value] * len(table) for name, value in run.labels.items()}, index=table.index)
    return pd.concat([labels, table], axis=1)


def reported(prog: str, options: argparse.Namespace, work: Callable[[argparse.Namespace, str], None]) -> int:
    """Do an analysis, and say in one line where its results are, or what is wrong. Returns the exit code."""
    try:
        with warnings_told(prog, AmbiguousStepsWarning, DifferentRobotsWarning), without_tex():
            work(options, prog)
        say(f"written to {options.output_dir}")
    except AnalysisError as error:
        return complain(prog, unfit(error, options.input))
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        # Nothing fits a pattern; otherwise, what is written has no name.
        return complain(prog, str(error) if error.errno is None else told(error, options.output_dir))
    except STRANGE_DATA as error:
        return complain(prog, unfit(error, options.input))
    return 0


def unfit(error: Exception, names: Sequence[str], task: str = "analyse") -> str:
    """Return why something cannot be done with the data of some files, in a line that names them."""
    told = str(error) or type(error).__name__
    told = told if isinstance(error, ToolError) else told.splitlines()[0]
    return told if any(name in told for name in names) else f"cannot {task} {' '.join(names)}: {told}"
