"""`pogosim analyze coverage`: how evenly robots share their arena, and how much of it is within their reach."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from pogosim.analysis.arena import Arena
from pogosim.analysis.coverage import coverage_over_time
from pogosim.analysis.robot_sizes import sizes_of
from pogosim.analysis.trajectories import Run, setting_of, with_arenas_told_apart
from pogosim.confidence import mean_over_runs
from pogosim.errors import AnalysisError
from pogosim.fonts import literal
from pogosim.geometry.arena_file import ArenaError
from pogosim.geometry.configured import arena_of, read_entries
from pogosim.reports.each_run import for_each_run
from pogosim.reports.figures import draw_bands, draw_over_time, drawn_by_combination, from_zero, save, save_over_time
from pogosim.reports.groups import by_arena, group_names, group_of
from pogosim.reports.options import open_runs, output_folder, write_table
from pogosim.reports.voronoi_diagram import draw_diagrams
from pogosim.scene import read_periodic


def with_arenas(runs: list[Run], options: argparse.Namespace) -> list[Run]:
    """Return the runs, those without an arena with that of the configuration.

    Raises:
        ToolError: There is no configuration, or it has no arena.
        OSError: A file cannot be read.
    """
    if options.config is None:
        return runs
    entries = read_entries(Path(options.config))
    return with_arenas_told_apart([run if run.arena.polygons else with_arena(run, entries, options) for run in runs])


def with_arena(run: Run, configuration: Mapping[str, Any], options: argparse.Namespace) -> Run:
    """Return a run with the arena that a configuration says, and its robots' sizes.

    Raises:
        ArenaError: It says none.
        OSError: A file cannot be read.
    """
    entries = {**configuration, **run.labels}  # of a batch
    for name, expected in (("arena_file", "a file"), ("arena_surface", "an area in mm2, or 'file'")):
        if entries.get(name) is None:
            raise ArenaError(f"{options.config} has no {name}; expected {expected}")
    path = Path(options.arenas_dir) / Path(str(entries["arena_file"])).with_suffix(".csv").name
    _, outline = arena_of(entries, Path(options.config), path)
    sizes = sizes_of(run.category, lambda path: setting_of(path, run.labels, {"configuration": configuration}))
    return replace(
        run,
        arena=Arena(path.stem, list(outline.polygons), outline.periodic or read_periodic(entries)),
        sizes=sizes if options.rc is None else sizes.with_reach(options.rc),
    )


TABLE = "voronoi_metrics_per_arena.csv"
POISSON_CV = np.sqrt(0.280)  # Gilbert 1962, see `coverage_over_time`

AREA_PANELS = {"mean_area": "mean area of cells (mm²)", "std_area": "standard deviation of areas (mm²)"}


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Compute everything, then write tables and figures."""
    runs = with_arenas(of_number(open_runs(options, prog), options), options)
    try:
        tables = for_each_run(coverage_over_time, runs, options, "coverage")
    except AnalysisError as error:
        raise AnalysisError(f"cannot analyse {' '.join(options.input)}: {error}") from error
    folder = output_folder(options)
    write_table(pd.concat([named(table, run) for run, table in zip(runs, tables, strict=True)]), folder / TABLE,
                options.input)  # fmt: skip
    for arena, (own_runs, own_tables) in by_arena(runs, tables).items():
        suffix = f"__arena_{arena}"
        save_over_time(own_runs, own_tables, AREA_PANELS, folder / f"voronoi_areas{suffix}")
        save_over_time(own_runs, own_tables, {"coverage_ratio": "coverage ratio"}, folder / f"coverage_ratio{suffix}")
        save_variation(own_runs, own_tables, folder / f"voronoi_cv{suffix}")
        save(draw_diagrams(own_runs[0]), folder / f"voronoi_diagram{suffix}")
    save_mean_of_arenas(runs, tables, folder, options.input)


def of_number(runs: list[Run], options: argparse.Namespace) -> list[Run]:
    """Return the runs that --run asks for."""
    if options.run is None:
        return runs
    chosen = [run for run in runs if str(run.labels.get("run")) == str(options.run)]
    if not chosen:
        there = ", ".join(sorted({str(run.labels.get("run")) for run in runs}))
        raise AnalysisError(f"cannot analyse {' '.join(options.input)}: it has no run {options.run}; it has {there}")
    return chosen


def named(table: pd.DataFrame, run: Run) -> pd.DataFrame:
    """Return a table with the run, the arena, and further labels of its combination."""
    labels = {name: value for name, value in run.labels.items() if name not in ("run", "arena_file")}
    table = table.assign(arena_name=run.arena.name, **{name: [value] * len(table) for name, value in labels.items()})
    table.insert(0, "run", run.labels.get("run", 0))
    return table


def save_variation(runs: Sequence[Run], tables: Sequence[pd.DataFrame], path: Path) -> None:
    """Save a figure of the coefficient of variation over time, with that of independent robots."""

    def draw(axes: Axes, groups: dict[str, list[pd.DataFrame]], colours: Mapping[str, Any] | None) -> None:
        draw_over_time(axes, groups, "cv_area", "coefficient of variation of areas", colours)
        line = axes.axhline(POISSON_CV, color="0.4", linestyle=":", label="independent positions (Poisson)")
        from_zero(axes)
        axes.legend(handles=None if colours is None else [line], frameon=False, fontsize="small")

    save(drawn_by_combination(runs, tables, [draw]), path)


def save_mean_of_arenas(
    runs: Sequence[Run], tables: Sequence[pd.DataFrame], folder: Path, inputs: Sequence[str]
) -> None:
    """Save the coefficient of variation over time: averaged over the runs in each arena, then over arenas."""
    rest = [name for name in group_names(runs) if name != "arena_file"]
    curves: dict[str, dict[str, list[pd.Series[Any]]]] = {}
    firsts: dict[str, Run] = {}  # a run of each combination, in whichever arena
    for run, table in zip(runs, tables, strict=True):
        name = group_of(run, rest) if rest else "all"
        labels = {label: run.labels.get(label) for label in rest}
        firsts.setdefault(name, replace(run, arena=runs[0].arena, labels=labels))
        arenas = curves.setdefault(name, {})
        arenas.setdefault(run.arena.name, []).append(table.set_index("time")["cv_area"])
    means = {name: [pd.concat(own, axis=1).mean(axis=1) for own in arenas.values()] for name, arenas in curves.items()}
    count = len({run.arena.name for run in runs})
    over = f"mean over {count} arenas" if count > 1 else f"arena {literal(runs[0].arena.name)}"

    def draw(axes: Axes, groups: dict[str, list[list[pd.Series[Any]]]], colours: Mapping[str, Any] | None) -> None:
        draw_bands(axes, {name: own for name, (own,) in groups.items()}, colours)
        axes.set(xlabel="time (s)", ylabel=f"coefficient of variation of areas\n({over})")
        from_zero(axes)

    figure = drawn_by_combination(list(firsts.values()), list(means.values()), [draw])
    save(figure, folder / "cv_mean_across_arenas_over_time")
    parts = [
        mean_over_runs(pd.concat(own, axis=1, ignore_index=True)).rename_axis("time").reset_index().assign(group=name)
        for name, own in means.items()
    ]
    table = pd.concat(parts).rename(columns={"runs": "n_arenas", "group": "combination"})
    write_table(table, folder / "cv_mean_across_arenas_over_time.csv", inputs)
