"""The comparison of two files, as the command line asks for it."""

from __future__ import annotations

import argparse
import math
import statistics
from pathlib import Path

from pogosim.command.parser import warn, warnings_told
from pogosim.comparison import figure
from pogosim.comparison.batches import Distributions, Numbers, compare_numbers, numbers_of
from pogosim.comparison.configurations import Source, differences, source_of
from pogosim.comparison.outcome import Outcome, as_json, lines
from pogosim.comparison.rows import RowsCompared, compare_rows
from pogosim.errors import AnalysisError, ToolError
from pogosim.lines import say, say_text
from pogosim.outputs import real_output
from pogosim.picture.options import cannot_read
from pogosim.reports.options import STRANGE_DATA


def compare_files(options: argparse.Namespace, prog: str) -> int:
    """Compare two files, and say how they differ. Returns the exit code: 0 equal, 1 different.

    Raises:
        ToolError: They cannot be compared.
        OSError: A file cannot be written.
    """
    with warnings_told(prog, RuntimeWarning):
        sources = read(options.a), read(options.b)
        rows, notes = rows_of(sources, options)
        found = None
        if options.output is not None or not (rows is not None and rows.is_equal):
            found, more = numbers_compared(sources, options, prog)
            notes += more
    if rows is None and (found is None or not (can_tell(found) or any(found.only_in))):
        raise ToolError(" ".join([f"{options.a} and {options.b} cannot be compared.", *notes]))
    keys = differences(*sources)
    outcome = Outcome(sources, keys, rows, found, options.level, options.test, options.tolerance, notes)
    if options.json:
        say_text(as_json(outcome))
    elif options.quiet:
        say(outcome.verdict)
    else:
        say(*lines(outcome, options.most))
    return int(outcome.differ)


def read(name: str) -> Source:
    """Look into a file.

    Raises:
        ToolError: It cannot be read; says why.
    """
    try:
        return source_of(name)
    except OSError as error:
        raise ToolError(cannot_read(name, error)) from error
    except ToolError:
        raise
    except STRANGE_DATA as error:
        raise named(name, error) from error


def named(name: str, error: Exception) -> ToolError:
    """Return an error that names a file."""
    text = (str(error) or type(error).__name__).splitlines()[0]
    return ToolError(text if name in text else f"cannot read '{name}': {text}")


def can_tell(found: Distributions) -> bool:
    """Tell whether distributions can be compared: some number is there in several runs of both."""
    return any(min(own.runs) > 1 for own in found.numbers)


def rows_of(sources: tuple[Source, Source], options: argparse.Namespace) -> tuple[RowsCompared | None, list[str]]:
    """Compare the rows of two files, or say why they are not compared.

    Raises:
        ToolError: A file cannot be read.
    """
    a, b = sources
    if options.no_rows:
        return None, []
    if not (a.is_one_file and b.is_one_file):
        return None, ["Rows are not compared: those of several files have no order in common."]
    if a.seeds and b.seeds and a.seeds != b.seeds and min(a.runs, b.runs) > 1:
        return None, ["Rows are not compared: the seeds differ."]
    try:
        rows = compare_rows(Path(a.name), Path(b.name), options.tolerance)
    except OSError as error:
        raise ToolError(cannot_read(str(error.filename or a.name), error)) from error
    except ToolError:
        raise
    except STRANGE_DATA as error:
        raise ToolError(f"the rows of {a.name} and {b.name} cannot be compared: {error}".splitlines()[0]) from error
    seeds_differ = bool(a.seeds and b.seeds and a.seeds != b.seeds)
    return rows, ["The seeds differ, so rows do, too."] * (seeds_differ and not rows.is_equal)


def numbers_compared(
    sources: tuple[Source, Source], options: argparse.Namespace, prog: str
) -> tuple[Distributions | None, list[str]]:
    """Compare the distributions of numbers, and draw them if the options ask for it; or say why that cannot be done.

    Raises:
        ToolError: A file cannot be read, or lacks the category that the options name, or what is to be drawn.
        OSError: The figure cannot be written.
    """
    with_curves = options.output is not None
    if max(own.runs for own in sources) < 2 and not with_curves and options.category is None:
        return None, ["Distributions are not compared: each file has one run."]
    try:
        a, b = (numbers_in(own.name, options.category, with_curves) for own in sources)
    except AnalysisError as error:
        if with_curves or options.category is not None:
            raise
        return None, [f"Distributions are not compared: {error}."]
    found = compare_numbers(a, b, options.test)
    drawn_notes = []
    if with_curves:
        drawn = figure.draw(a, b, (options.a, options.b), found)
        if drawn is None:
            warn(prog, f"{options.output} is not drawn: no number is in both files")
        else:
            figure.write(drawn, real_output(options.output))
            drawn_notes = [f"Figure of the numbers over time: {options.output}"]
    notes = [*notes_on_durations(a, b), *drawn_notes]
    if not can_tell(found) and not any(found.only_in):
        notes.append("Distributions are not tested: that needs two runs in each file.")
    return found, notes


def notes_on_durations(a: Numbers, b: Numbers) -> list[str]:
    """Say if runs of the two files end at different times, so that their means and ends are not of the same time."""
    ends_s = [statistics.median(own.ends_s) for own in (a, b)]
    if math.isclose(*ends_s, rel_tol=0.01):
        return []
    each = " (medians)" if len(a.ends_s) > 1 else ""
    return [
        f"Runs of a end at {ends_s[0]:.6g} s, those of b at {ends_s[1]:.6g} s{each}: means and ends are not of the "
        "same time."
    ]


def numbers_in(name: str, category: str | None, with_curves: bool) -> Numbers:
    """Compute the numbers of a file.

    Raises:
        ToolError: It cannot be read; an AnalysisError if it has nothing to compute them from.
    """
    try:
        return numbers_of(name, category, with_curves)
    except AnalysisError as error:
        raise AnalysisError(f"{name}: {error}") from error
    except OSError as error:
        raise ToolError(cannot_read(name, error)) from error
    except ToolError:
        raise
    except STRANGE_DATA as error:
        raise named(name, error) from error
