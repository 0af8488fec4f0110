"""A report of a data file, as the command line asks for it."""

from __future__ import annotations

import argparse
import contextlib
import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import pogosim
from pogosim.analysis.quantities import Quantity, quantities_of
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.command.parser import warn
from pogosim.errors import AnalysisError, PictureError, ToolError
from pogosim.film.replay import DEFAULT_TAIL_S, replay_page
from pogosim.fonts import any_characters, rendered, without_tex
from pogosim.lines import counted, say
from pogosim.outputs import partial_output
from pogosim.picture.figure import draw, title
from pogosim.picture.loading import sayings
from pogosim.picture.options import cannot_read
from pogosim.picture.swarm import Recording, read_recording
from pogosim.reports.each_run import for_each_run
from pogosim.reports.groups import by_combination
from pogosim.reports.options import STRANGE_DATA, unfit
from pogosim.run_report.facts import command_of, configuration_name, configurations_of, facts_of
from pogosim.run_report.figures import figure_of
from pogosim.run_report.page import Report, page_of
from pogosim.run_report.thinning import thinned
from pogosim.run_report.warnings_of_run import log_of, warnings_of
from pogosim.utils import load_dataframe

MOST_FIGURES = 24
MOST_ROWS = 400  # of the table of numbers
LONGEST_S = 30.0  # that a replay takes at the speed it begins with
SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0)
STATE_DPI = 80.0
MOST_TRAIL_STEPS = 100_000  # robots times records

BANDS_OF_ONE = "Curves are means over the robots, bands the middle half of them; the order is one number of all robots."
BANDS_OF_RUNS = (
    "Curves are means over runs, of each run's mean over its robots; bands are their 95 % confidence intervals."
)


@dataclass(frozen=True)
class Computed:
    """What a report needs of all runs of a file."""

    runs: list[Trajectories]
    metadata: dict[str, Any]
    quantities: dict[str, tuple[list[Trajectories], list[Quantity]]]  # by name: of the runs that have it


@contextlib.contextmanager
def warnings_kept(into: list[str]) -> Iterator[None]:
    """Collect what the tools warn of (RuntimeWarning) as texts, each once."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RuntimeWarning)
        try:
            yield
        finally:
            texts = [str(own.message) for own in caught if issubclass(own.category, RuntimeWarning)]
            into += [text for text in dict.fromkeys(texts) if text not in into]
    for own in caught:
        if not issubclass(own.category, RuntimeWarning):
            warnings.warn(own.message, stacklevel=3)


@without_tex()
def make_report(path: Path, options: argparse.Namespace, prog: str) -> None:
    """Write the report that the options ask for, and say what it is.

    Args:
        path: The page, as real_output() returns it.
        options: Options of the command.
        prog: Name of the command.

    Raises:
        ToolError: There is nothing to report on; says why.
        OSError: A file cannot be read or written.
    """
    said: list[str] = []
    with sayings_of_data(options.data):
        with warnings_kept(said):
            computed = compute(options.data, options.category)
            configurations = configurations_of(options.data, computed.metadata)
        report = described(options, computed, configurations.repeating(computed.metadata))
        metadata, run_count = computed.metadata, len(computed.runs)
        del computed  # its rows
        if configurations.resolved and configurations.resolved != report.configuration:
            report.others.append(("Every key with its value in the run, defaults included", configurations.resolved))
        elif configurations.given != report.configuration:
            report.others.append(("The configuration as it was given", configurations.given))
    with sayings(options.data), warnings_kept(said):
        try:
            recording = read_recording(options.data, options.run, options.color_by, options.combination)
        except OSError as error:
            raise PictureError(cannot_read(options.data, error)) from error
        show_run(report, recording, options)
    for text in said:
        warn(prog, text)
    report.warnings = warnings_of(metadata, log_path(options), said)
    page = page_of(report).encode("utf-8")
    with partial_output(path) as partial:
        partial.write_bytes(page)
    if not options.quiet:
        figures = counted(len(report.figures), "figure")
        say(f"{options.output}: {counted(run_count, 'run')}, {figures}, {len(page) / 1e6:.2f} MB")


@contextlib.contextmanager
def sayings_of_data(data: str) -> Iterator[None]:
    """Turn what keeps a file from being analysed into a line that names it."""
    try:
        yield
    except AnalysisError as error:
        raise AnalysisError(unfit(error, [data], "report on")) from error
    except ToolError:
        raise
    except OSError as error:
        raise PictureError(cannot_read(data, error)) from error
    except STRANGE_DATA as error:
        raise AnalysisError(unfit(error, [data], "report on")) from error


def log_path(options: argparse.Namespace) -> Path | None:
    """Return the log to look into; None: none is known."""
    return log_of(Path(options.data)) if options.log is None else Path(options.log)


def compute(data: str, category: str | None) -> Computed:
    """Read a file, and compute its quantities run by run.

    Raises:
        AnalysisError, OSError, ValueError: It cannot be done.
    """
    rows, metadata = load_dataframe(data)
    runs = trajectories_of(rows, metadata, category)
    found: dict[str, tuple[list[Trajectories], list[Quantity]]] = {}
    for run, own in zip(runs, for_each_run(listed, runs, argparse.Namespace(), "report"), strict=True):
        for quantity in own:
            with_it, values = found.setdefault(quantity.name, ([], []))
            with_it.append(run)
            values.append(quantity)
    return Computed(runs, metadata, found)


def listed(run: Trajectories) -> list[Quantity]:
    """Return all quantities of a run that has any value of them."""
    return [quantity for quantity in quantities_of(run) if np.isfinite(quantity.over_time).any()]


def described(options: argparse.Namespace, computed: Computed, configuration: str) -> Report:
    """Return all of a report but the run that it shows."""
    runs, metadata = computed.runs, computed.metadata
    facts = facts_of(options.data, metadata, runs, options.program)
    known = dict(facts)
    lead = [known["objects"], known["arena"], known["time"].split(",")[0]]
    lead += [f"{len(runs)} runs"] if len(runs) > 1 else [f"seed {known['seed']}"] if "seed" in known else []
    command = command_of(options.data, metadata, runs, options.program) if configuration else ""
    shown = list(computed.quantities.values())
    numbers = rows_of_numbers(computed)
    left_out = f" Left out: {counted(len(shown) - MOST_FIGURES, 'column')}." if len(shown) > MOST_FIGURES else ""
    return Report(
        title=options.title or Path(options.data).name,
        lead=" \u00b7 ".join(lead),
        warnings=[],
        facts=facts,
        command=command,
        command_note=command_note(command, metadata, bool(configuration), options.program),
        state=b"",
        state_told="",
        replay="",
        replay_note="",
        figures=[figure_of(own, values) for own, values in shown[:MOST_FIGURES]],
        figures_note=(BANDS_OF_ONE if len(runs) == 1 else BANDS_OF_RUNS) + left_out,
        numbers_head=["", *(["combination"] if has_combinations(computed) else []), "mean over time", "at the end"],
        numbers=numbers[:MOST_ROWS],
        numbers_note=(
            "Means over the robots." if len(runs) == 1 else "Means over runs \u00b1 their standard deviation (runs)."
        )
        + (f" Left out: {len(numbers) - MOST_ROWS} more rows." if len(numbers) > MOST_ROWS else ""),
        configuration=configuration,
        configuration_name=configuration_name(options.data),
        footer=f"Made by Pogosim {pogosim.__version__} with pogosim report.",
    )


def command_note(command: str, metadata: dict[str, Any], has_configuration: bool, program: str | None) -> str:
    """Return what to know of the command that repeats a run."""
    if not has_configuration:
        return "The data file has no configuration, so no command can repeat it."
    if "files" in metadata:
        return "These are several files: each has its own configuration and seed, which a report of it alone tells."
    if not command:
        return "Its seeds do not follow each other, so no single command repeats all runs."
    if program is None:
        return "PROGRAM is the one that ran: data files do not say which (--program names it here)."
    return ""


def has_combinations(computed: Computed) -> bool:
    """Tell whether runs are of several combinations."""
    return len(by_combination(computed.runs, computed.runs)) > 1


def rows_of_numbers(computed: Computed) -> list[list[str]]:
    """Return a row for each quantity and combination: mean over time, and at the end."""
    rows = []
    several = has_combinations(computed)
    for runs, values in computed.quantities.values():
        for name, own in by_combination(runs, values).items():
            label = [own[0].label, name] if several else [own[0].label]
            rows.append([*label, spread([one.mean for one in own]), spread([one.final for one in own])])
    return rows


def spread(values: Sequence[float]) -> str:
    """Return mean and standard deviation of values of runs, and how many these are."""
    known = np.array([value for value in values if math.isfinite(value)])
    if not len(known):
        return "\u2013"
    if len(values) == 1:
        return f"{known[0]:.4g}"
    deviation = f" \u00b1 {known.std(ddof=1):.2g}" if len(known) > 1 else ""
    return f"{known.mean():.4g}{deviation} ({len(known)})"


def show_run(report: Report, recording: Recording, options: argparse.Namespace) -> None:
    """Add the picture of the end of a run, and its replay."""
    last = recording.until()
    times_s = recording.times_s
    share = MOST_TRAIL_STEPS / len(last.rows)
    tail_s = None if share >= 1.0 else max(share * float(times_s[-1] - times_s[0]), 1e-9)
    with any_characters():
        report.state = rendered(draw(last, tail_s), "png", STATE_DPI)
    told = " ".join(title(last, 1000.0).replace("\u00a0", " ").split())
    way = "the ways they went" if tail_s is None else f"the ways they went in the last {tail_s:.2g} s"
    report.state_told = f"{told}, with {way}"
    left_out = f"The data file holds {recording.left_out}. " if recording.left_out else ""
    if options.no_replay:
        report.replay_note = left_out
        return
    shorter = thinned(recording)
    times_s = shorter.recording.times_s
    span_s = float(times_s[0]), float(times_s[-1])
    begins = argparse.Namespace(
        color_by=options.color_by,
        links=False,
        speed=options.speed or speed_for(span_s[1] - span_s[0]),
        tail=DEFAULT_TAIL_S,
        view=(),
    )
    name = Path(options.data).name
    report.replay, _, warned = replay_page(shorter.recording, span_s, begins, name)
    of_run = f"run {options.run}" if options.run is not None else "the first run"
    which = f"It shows {of_run} of the file. " if options.run is not None or recording.left_out else ""
    thinning = f"To keep this page small, it has {shorter.told}. " if shorter.told else ""
    full = f"pogosim film {name} -o replay.html makes one with all records. " if shorter.told else ""
    report.replay_note = f"{left_out}{which}{thinning}{full}{''.join(f'{text}. ' for text in warned)}".strip()


def speed_for(duration_s: float) -> float:
    """Return the slowest speed from real time on at which a replay takes half a minute at most."""
    return next((speed for speed in SPEEDS if speed >= 1.0 and duration_s / speed <= LONGEST_S), SPEEDS[-1])
