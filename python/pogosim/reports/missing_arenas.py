"""Arenas for data files that do not have them: from a configuration (-c) and a folder of arena files (--arenas-dir)."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pogosim.analysis.arena import Arena
from pogosim.analysis.errors import AnalysisError
from pogosim.analysis.robot_sizes import sizes_of
from pogosim.analysis.trajectories import Trajectories, setting_of, with_arenas_told_apart
from pogosim.batch.option_words import OptionsError
from pogosim.batch.options import single_value
from pogosim.geometry.arena_file import ArenaError, read_arena, scaled
from pogosim.utils import parse_configuration


def with_arenas(runs: list[Trajectories], options: argparse.Namespace) -> list[Trajectories]:
    """Return the runs, those without an arena with that of the configuration.

    Raises:
        AnalysisError: There is no configuration, or it has no arena.
        OSError: A file cannot be read.
    """
    if options.config is None:
        return runs
    configuration = parse_configuration(Path(options.config).read_text(encoding="utf-8", errors="replace"))
    if not configuration:
        raise AnalysisError(f"{options.config} is not a configuration in YAML")
    return with_arenas_told_apart(
        [run if run.arena.polygons else with_arena(run, configuration, options) for run in runs]
    )


def with_arena(run: Trajectories, configuration: Mapping[str, Any], options: argparse.Namespace) -> Trajectories:
    """Return a run with the arena that a configuration says, and its robots' sizes."""

    def value(name: str) -> Any:
        try:
            return single_value(run.labels.get(name, configuration.get(name)))  # of a batch
        except OptionsError as error:
            raise AnalysisError(f"{options.config}: {name}: {error}") from None

    metadata = {"configuration": configuration}
    if value("arena_file") is None:
        raise AnalysisError(f"{options.config} has no arena_file")
    surface = value("arena_surface")
    if surface != "file":
        try:
            surface = float(surface)
        except (TypeError, ValueError):
            surface = 0.0
        if not 0.0 < surface < float("inf"):
            found = value("arena_surface")
            raise AnalysisError(f"{options.config}: expected arena_surface in mm2, or 'file', found {found}")
    path = Path(options.arenas_dir) / Path(str(value("arena_file"))).with_suffix(".csv").name
    try:
        outline = scaled(read_arena(path), None if surface == "file" else surface, stretch=bool(value("arena_stretch")))
    except ArenaError as error:
        raise AnalysisError(str(error)) from error
    is_periodic = outline.periodic or str(value("boundary_condition")).lower() == "periodic"
    sizes = sizes_of(run.category, lambda path: setting_of(path, run.labels, metadata))
    return replace(
        run,
        arena=Arena(path.stem, list(outline.polygons), is_periodic),
        sizes=sizes if options.rc is None else sizes.with_reach(options.rc),
    )
