"""What all analyses have in common: reading the data, writing tables, and what they say when it cannot be done."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pyarrow

from pogosim.analysis.robot_sizes import DifferentRobotsWarning
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.command.parser import complain, warn, warnings_told
from pogosim.errors import AnalysisError, ToolError
from pogosim.fonts import without_tex
from pogosim.lines import say
from pogosim.outputs import OutputError, leads_to, told
from pogosim.periodic import AmbiguousStepsWarning
from pogosim.several_files import files_that_fit, is_pattern
from pogosim.utils import load_dataframe

# What pandas, numpy and the libraries behind the analyses raise for values that no run has.
STRANGE_DATA = (
    *(ArithmeticError, IndexError, KeyError, MemoryError, RuntimeError, TypeError, ValueError),
    pyarrow.ArrowException,
)

OUTPUT_FOLDERS = ("arenas", "stats", "traces")
OUTPUT_SUFFIXES = (".csv", ".gif", ".json", ".pdf", ".pkl", ".png", ".txt")


def read_runs(options: argparse.Namespace, prog: str) -> list[Trajectories]:
    """Read the runs that the options name. A file of a killed run is read as far as it goes, with a warning.

    Raises:
        AnalysisError: There is nothing to analyse, or a file is damaged.
        OSError: A file cannot be read.
    """
    files = options.input[0] if len(options.input) == 1 else options.input
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            rows, metadata = load_dataframe(files)
            runs = trajectories_of(rows, metadata, options.category)
        except AnalysisError as error:
            raise AnalysisError(f"cannot analyse {' '.join(options.input)}: {error}") from error
        except (ToolError, OSError):
            raise
        except STRANGE_DATA as error:
            raise AnalysisError(unfit(error)) from error
        finally:
            for warning in caught:
                warn(prog, warning.message)
    if options.rc is not None:
        runs = [replace(run, sizes=run.sizes.with_reach(options.rc)) for run in runs]
    return runs


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


def labelled(table: pd.DataFrame, run: Trajectories) -> pd.DataFrame:
    """Return a table with the labels of its run as first columns."""
    labels = pd.DataFrame({name: [value] * len(table) for name, value in run.labels.items()}, index=table.index)
    return pd.concat([labels, table], axis=1)


def reported(prog: str, options: argparse.Namespace, work: Callable[[argparse.Namespace, str], None]) -> int:
    """Do an analysis, and say in one line where its results are, or what is wrong. Returns the exit code."""
    try:
        with warnings_told(prog, AmbiguousStepsWarning, DifferentRobotsWarning), without_tex():
            work(options, prog)
        say(f"written to {options.output_dir}")
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        # Nothing fits a pattern; otherwise, what is written has no name.
        return complain(prog, str(error) if error.errno is None else told(error, options.output_dir))
    except STRANGE_DATA as error:
        return complain(prog, unfit(error))
    return 0


def unfit(error: Exception) -> str:
    """Return what is said of data for which a library has raised something, in a line."""
    return f"the data cannot be analysed: {str(error) or type(error).__name__}".splitlines()[0]
