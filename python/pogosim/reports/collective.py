"""`pogosim analyze collective`: order, structure and flow of a swarm, as tables, figures and summaries."""

from __future__ import annotations

import argparse
import functools
import pickle
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from pogosim.analysis.milling import centre_of_arena
from pogosim.analysis.motion import speed
from pogosim.analysis.trajectories import Run
from pogosim.command.parser import warn
from pogosim.errors import ToolError
from pogosim.lines import counted
from pogosim.reports.collective_figures import draw_metric, draw_vorticity_fields
from pogosim.reports.collective_metrics import METRICS, Metric
from pogosim.reports.collective_swarm import Settings, Swarm, Vortices
from pogosim.reports.each_run import for_each_run
from pogosim.reports.groups import by_combination
from pogosim.reports.options import labelled, open_runs, output_folder, write_table

MAX_BINS = 100_000


def settings_of(options: argparse.Namespace, runs: Sequence[Run]) -> Settings:
    """Return the settings that the options name, and those that are the same for all runs.

    Raises:
        ToolError: Options contradict each other.
        AnalysisError: Data lack what an option needs.
    """
    for name in ("gr", "aligncorr"):
        if getattr(options, f"{name}_rmax") / getattr(options, f"{name}_dr") > MAX_BINS:
            raise ToolError(f"--{name}-dr is too small for --{name}-rmax: there would be more than {MAX_BINS} bins")
    for run in runs:
        if options.direction == "heading":
            run.need_columns(["angle"])
        if options.milling_center == "arena":
            centre_of_arena(run.arena)
    known, total = 0, 0.0
    for run in runs:
        square = speed(run.whole()) ** 2
        known, total = known + int(np.isfinite(square).sum()), total + float(np.nansum(square))
    mean_square = total / known if known else 0.0
    return Settings(
        direction=options.direction,
        min_speed_mm_s=options.min_speed,
        psi_k=options.psi_k,
        gr_rmax_mm=options.gr_rmax,
        gr_dr_mm=options.gr_dr,
        sk_shape=(options.sk_nx, options.sk_ny),
        v2_ref_mm2_s2=options.v2_ref or mean_square or None,
        vorticity_shape=(options.vort_nx, options.vort_ny),
        milling_centre=options.milling_center,
        correlation_rmax_mm=options.aligncorr_rmax,
        correlation_dr_mm=options.aligncorr_dr,
        fluctuations=options.aligncorr_fluctuations,
        # A robot turns with this vorticity if it circles at half the reach.
        vorticity_range=float(f"{4.0 * np.sqrt(mean_square) / runs[0].reach_mm:.1g}") or 1.0,
    )


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Read the runs, and write everything."""
    runs = open_runs(options, prog)
    settings = settings_of(options, runs)
    folder = output_folder(options)
    first = {name: own[0] for name, own in by_combination(runs, runs).items()}
    found = for_each_run(functools.partial(tables_of, settings=settings), runs, options, "collective")
    tables = {metric.key: [own[metric.key] for own, _ in found] for metric in METRICS}
    fields = {name: found[number][1] for name, own in first.items() for number, run in enumerate(runs) if run is own}
    warn_of_missing(prog, runs, tables)
    joined = {metric.key: joined_table(runs, tables[metric.key]) for metric in METRICS}
    for metric in METRICS:
        if not options.no_csv:
            write_table(joined[metric.key], folder / f"{metric.key}.csv", options.input)
        draw_metric(metric, runs, tables[metric.key], folder)
    draw_vorticity_fields(first, fields, folder)
    write_summaries(folder, runs, tables)
    if not options.no_extended_infos:
        write_details(folder, runs, settings)
        with (folder / "metrics.pkl").open("wb") as file:
            pickle.dump(joined, file, protocol=4)


def tables_of(run: Run, settings: Settings) -> tuple[dict[str, pd.DataFrame], Vortices]:
    """Return the tables of all metrics of a run, empty for those that need an arena that is not known, and its flow."""
    swarm = Swarm(run.whole(), settings)
    tables = {
        metric.key: metric.compute(swarm) if run.arena.polygons or not metric.needs_arena else pd.DataFrame()
        for metric in METRICS
    }
    return tables, swarm.vortices


def joined_table(runs: Sequence[Run], tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return the tables of all runs as one, with the labels of the runs."""
    return pd.concat([labelled(table, run) for run, table in zip(runs, tables, strict=True)], ignore_index=True)


def has_values(metric: Metric, table: pd.DataFrame) -> bool:
    """Say whether a table has anything to draw."""
    return any(name in table and bool(np.isfinite(table[name].astype(float)).any()) for name in metric.curves)


def warn_of_missing(prog: str, runs: Sequence[Run], tables: dict[str, list[pd.DataFrame]]) -> None:
    """Say once which metrics have no values, and why."""
    without = sum(not run.arena.polygons for run in runs)
    if without:
        names = ", ".join(metric.key for metric in METRICS if metric.needs_arena)
        warn(prog, f"{without} of {len(runs)} runs do not say what the arena is: without {names}")
    arenas = [run for run in runs if run.arena.polygons] or runs
    empty = [
        metric.key
        for metric in METRICS
        if not any(has_values(metric, table) for table in tables[metric.key]) and not (metric.needs_arena and without)
    ]
    if empty:
        robots, times = max(len(run.robot_id) for run in arenas), max(len(run.time_s) for run in arenas)
        warn(
            prog, f"no values of {', '.join(empty)}: too few robots ({robots}) or times ({times}), or robots that stand"
        )


# ---- Summaries, as text ----


def write_summaries(folder: Path, runs: Sequence[Run], tables: Mapping[str, Sequence[pd.DataFrame]]) -> None:
    """Write what all runs have in common, and what the runs of each combination have."""
    numbers = [
        {
            (metric.key, name): value
            for metric in METRICS
            if not tables[metric.key][index].empty
            for name, value in metric.summary(tables[metric.key][index]).items()
        }
        for index in range(len(runs))
    ]
    write(folder / "SUMMARY_global.txt", [f"{'All ' * (len(runs) > 1)}{counted(len(runs), 'run')}", *lines(numbers)])
    per_arena: list[str] = []
    for name, members in by_combination(runs, numbers).items():
        per_arena += [f"{name}: {counted(len(members), 'run')}", *lines(members), ""]
    write(folder / "SUMMARY_per_arena.txt", per_arena[:-1])


def write_details(folder: Path, runs: Sequence[Run], settings: Settings) -> None:
    """Write what the numbers mean."""
    write(folder / "SUMMARY_metric_details.txt", details(runs, settings))


def lines(numbers: Sequence[Mapping[tuple[str, str], float]]) -> list[str]:
    """Return a line for each number: mean over runs, standard deviation, and how many runs have it."""
    text = []
    for key, name in dict.fromkeys(entry for own in numbers for entry in own):
        values = np.array([own.get((key, name), np.nan) for own in numbers])
        values = values[np.isfinite(values)]
        if not len(values):
            text.append(f"  {key}: {name}: no value")
            continue
        spread = f" +- {values.std(ddof=1):.4g}" if len(values) > 1 else ""
        text.append(f"  {key}: {name} = {values.mean():.4g}{spread} ({counted(len(values), 'run')})")
    return text


def details(runs: Sequence[Run], settings: Settings) -> list[str]:
    """Return what each metric is, and the settings it was computed with."""
    reach = ", ".join(f"{value:g}" for value in sorted({run.reach_mm for run in runs}))
    text = [
        "Values: mean over runs +- standard deviation over runs. Lengths in mm, times in s, y downwards.",
        f"Neighbours are at most {reach} mm apart. Directions: {settings.direction}.",
        f"v2_ref = {settings.v2_ref_mm2_s2 or float('nan'):g} mm2/s2; psi_k: k = {settings.psi_k}; "
        f"milling about {'the centre of mass' if settings.milling_centre == 'cm' else 'the centre of the arena'}; "
        f"C(r) of {'fluctuations' if settings.fluctuations else 'whole vectors'}.",
        "",
    ]
    return text + [f"{metric.key}: {metric.title}" for metric in METRICS]


def write(path: Path, text: Sequence[str]) -> None:
    """Write lines of text."""
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
