"""`pogosim analyze locomotion`: how fast, how far and how straight robots move, and where."""

from __future__ import annotations

import argparse
import functools
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from pogosim.analysis.density import count_outside
from pogosim.analysis.trajectories import Run
from pogosim.command.parser import warn
from pogosim.lines import counted
from pogosim.reports.each_run import for_each_run
from pogosim.reports.groups import by_combination, group_names
from pogosim.reports.heat_maps import arenas_of, draw_heat_maps
from pogosim.reports.locomotion_figures import RunTables, draw_all
from pogosim.reports.locomotion_tables import (
    agent_table,
    autocorrelation_table,
    is_evenly_spaced,
    joined,
    msd_per_agent_table,
    msd_table,
    peclet_table,
    run_row,
    time_table,
)
from pogosim.reports.options import open_runs, output_folder, write_table
from pogosim.reports.traces import draw_traces, film_traces

FRAMES = 120

UNITS = {"mm_s": "mm/s", "rad_s": "rad/s", "mm2_s": "mm²/s", "mm": "mm", "s": "s"}


def tables_of(stored: Run, window_s: float, characteristic_length_mm: float | None) -> RunTables:
    """Compute all tables of a run, with the sliding window of speeds and the length of the Peclet number."""
    run = stored.whole()
    agents, msd = agent_table(run), msd_table(run)
    peclet, correlations = peclet_table(run, characteristic_length_mm), autocorrelation_table(run)
    return RunTables(
        run=stored,
        agents=agents,
        over_time=time_table(run, window_s),
        peclet=peclet,
        msd=msd,
        correlations=correlations,
        summary=run_row(run, agents, msd, correlations, peclet),
        msd_per_agent=msd_per_agent_table(run),
        positions=int(run.present.sum()),
        outside=count_outside(run.arena, run.position_mm.reshape(-1, 2)),
        is_evenly_spaced=is_evenly_spaced(run),
        has_headings=bool(np.isfinite(run.heading_rad).any()),
    )


def warn_of_what_is_left_out(tables: Sequence[RunTables], prog: str) -> None:
    """Say in one line each what could not be computed, and for how many."""
    runs = len(tables)
    robots = sum(len(own.run.robot_id) for own in tables)
    if single := robots - sum(len(own.agents) for own in tables):
        warn(prog, f"{single} of {robots} robots have one position only: no speeds or displacements of them")
    if outside := sum(own.outside for own in tables):
        there = sum(own.positions for own in tables)
        warn(prog, f"{outside} of {there} positions are outside of the arena: they are not in the heat maps")
    if uneven := sum(not own.is_evenly_spaced for own in tables):
        warn(
            prog, f"{uneven} of {runs} runs have unevenly spaced save times: no autocorrelations or averages over them"
        )
    if blind := sum(not own.has_headings for own in tables):
        warn(prog, f"{blind} of {runs} runs have no headings (column angle): no angular velocities")
    if missing := sum(int(own.peclet["peclet"].isna().sum()) for own in tables):
        warn(prog, f"{missing} of {robots} robots ended near their starting points: no Peclet number for them")


def summary_text(tables: Sequence[RunTables], names: Sequence[str]) -> str:
    """Return the means of all runs of each combination as text."""
    lines = []
    for group, runs in by_combination([own.run for own in tables], tables, names).items():
        rows = pd.concat([own.summary for own in runs], ignore_index=True)
        count = len(rows)
        last = max(float(own.run.time_s[-1]) for own in runs)
        robots = f"{rows['robots'].min()} to {rows['robots'].max()}"
        if rows["robots"].nunique() == 1:
            robots = str(rows["robots"].iloc[0])
        swarm = f"{robots} robot{'' if robots == '1' else 's'}"
        lines += [f"{group}: {counted(count, 'run')}, {swarm}, until {last:g} s"]
        for column in rows.columns[list(rows.columns).index("mean_speed_mm_s") :]:
            lines.append(f"  {words(column):42} {mean_text(rows[column])}")
        lines.append("")
    return "\n".join(lines)


def words(column: str) -> str:
    """Return the name of a column in words, with its unit."""
    for suffix, unit in UNITS.items():
        if column.endswith(f"_{suffix}"):
            return f"{column.removesuffix(f'_{suffix}').replace('_', ' ')} ({unit})"
    return column.replace("_", " ")


def mean_text(values: pd.Series[float]) -> str:
    """Return the mean over runs, and their standard deviation."""
    known = values.dropna()
    if known.empty:
        return "unknown"
    if len(known) == 1 or not np.isfinite(known).all():
        return f"{known.mean():.4g}"
    return f"{known.mean():.4g} (standard deviation of runs {known.std():.2g})"


def write_tables(tables: Sequence[RunTables], folder: Path, inputs: Sequence[str]) -> None:
    """Write all tables in the folder stats."""
    parts = {
        "speed_agent_stats": [own.agents for own in tables],
        "speed_time_stats": [own.over_time for own in tables],
        "peclet": [own.peclet for own in tables],
        "msd_per_agent": [own.msd_per_agent for own in tables],
        "msd_time_stats": [own.msd for own in tables],
        "autocorrelation": [own.correlations for own in tables],
        "runs": [own.summary for own in tables],
    }
    for name, own in parts.items():
        write_table(joined(own), folder / "stats" / f"{name}.csv", inputs)


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Do the analysis."""
    folder = output_folder(options)
    runs = open_runs(options, prog)
    settings = {"window_s": options.window, "characteristic_length_mm": options.characteristic_length}
    found = for_each_run(functools.partial(tables_of, **settings), runs, options, "locomotion")
    tables = [replace(own, run=run) for own, run in zip(found, runs, strict=True)]  # not the copies of other processes
    warn_of_what_is_left_out(tables, prog)
    names = group_names(runs)
    write_tables(tables, folder, options.input)
    (folder / "SUMMARY.txt").write_text(summary_text(tables, names), encoding="utf-8")
    draw_all(tables, names, folder)
    draw_heat_maps(runs, folder, options.bins)
    arenas = arenas_of(runs)
    for name, own in arenas.items() if len(arenas) > 1 else ():
        here = [one for one in tables if any(one.run is run for run in own)]
        draw_all(here, group_names(own), folder / "arenas" / name)
    draw_traces(runs, names, folder, options.steps)
    if options.gif:
        film_traces(runs, names, folder, options.steps, FRAMES)
