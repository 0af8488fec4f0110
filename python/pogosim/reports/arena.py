"""`pogosim analyze arena`: the arenas of a data file: size, area, room for robots, and how much of them was visited."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import shapely
from matplotlib.figure import Figure
from shapely import affinity

from pogosim.analysis.arena import Floats
from pogosim.analysis.snapshots import snapshots_of
from pogosim.analysis.trajectories import Run
from pogosim.analysis.walls import distance_to_walls
from pogosim.command.parser import warn
from pogosim.errors import AnalysisError
from pogosim.geometry.arena_file import Outline
from pogosim.geometry.drawing import draw
from pogosim.geometry.validity import Room, problems, room_for
from pogosim.reports.coverage import with_arenas
from pogosim.reports.each_run import for_each_run
from pogosim.reports.figures import save
from pogosim.reports.options import labelled, open_runs, output_folder, write_table


def outline_of(run: Run) -> Outline:
    """Return the arena of a run as the arena tools take it."""
    return Outline(tuple(run.arena.polygons), run.arena.name, run.arena.is_periodic)


def room_of(run: Run) -> Room | None:
    """Return the room that an arena has for robots; None if it is periodic or its walls cross."""
    outline = outline_of(run)
    return None if outline.periodic or problems(outline) else room_for(outline, run.radius_mm)


def places_of(run: Run) -> tuple[dict[float, Floats], float]:
    """Return where robots were, and how near to a wall.

    Returns:
        The cells of a tenth of a radius with a robot at some save time, shape (n, 2), by the radius of robots in mm:
        places that are nearly the same count once. And the least distance to a wall, mm.
    """
    cells = {float(radius_mm): np.zeros((0, 2)) for radius_mm in np.unique(run.sizes.radius_mm)}
    to_wall = np.inf
    for own in snapshots_of(run):
        radius = run.sizes.radius_mm[own.robot]
        for radius_mm, known in cells.items():
            new = np.unique(np.floor(own.position_mm[radius == radius_mm] / (0.1 * radius_mm)), axis=0)
            cells[radius_mm] = np.unique(np.concatenate([known, new]), axis=0)
        to_wall = min(to_wall, float(np.nanmin(distance_to_walls(run.arena, own.position_mm), initial=np.inf)))
    return cells, to_wall


def visited_mm2(run: Run, cells: Mapping[float, Floats]) -> float:
    """Return the area of the floor that bodies of robots covered at some save time, mm2, given cells of `places_of`."""
    same_area = np.sqrt(np.pi / (16.0 * np.sin(np.pi / 16.0)))  # of a polygon with 32 corners
    disks = [
        shapely.buffer(shapely.points((own + 0.5) * 0.1 * radius_mm), same_area * radius_mm, quad_segs=8)
        for radius_mm, own in cells.items()
    ]
    covered = shapely.union_all(np.concatenate(disks))
    if run.arena.is_periodic:
        width, height = run.arena.size_mm
        shifts = [(x, y) for x in (-width, 0.0, width) for y in (-height, 0.0, height)]
        covered = shapely.union_all([affinity.translate(covered, *shift) for shift in shifts])
    return float(covered.intersection(run.arena.shape()).area)


def row_of_run(run_and_room: tuple[Run, Room | None]) -> pd.DataFrame:
    """Return `row_of` a run and the room that its arena has."""
    return row_of(*run_and_room)


def row_of(run: Run, room: Room | None) -> pd.DataFrame:
    """Return what there is to say about the arena of a run, as a table of one row."""
    arena = run.arena
    floor = arena.shape()
    width, height = arena.size_mm
    cells, to_wall = places_of(run)
    return pd.DataFrame(
        {
            "arena": [arena.name],
            "is_periodic": [arena.is_periodic],
            "width_mm": [width],
            "height_mm": [height],
            "area_mm2": [floor.area],
            "perimeter_mm": [np.nan if arena.is_periodic else floor.length],
            "holes": [len(arena.polygons) - 1],
            "room_share": [np.nan if room is None else room.share],
            "robots": [len(run.robot_id)],
            "robots_area_share": [np.pi * float(np.sum(run.sizes.radius_mm**2)) / floor.area],
            "visited_share": [visited_mm2(run, cells) / floor.area],
            "least_wall_distance_mm": [np.nan if arena.is_periodic else to_wall],
        }
    )


def drawn(run: Run, room: Room | None) -> Figure:
    """Draw the arena of a run with the places of its robots at the end."""
    outline = outline_of(run)
    heading = f"{run.arena.name}: {run.arena.area_mm2:.6g} mm²" + (", periodic" if outline.periodic else "")
    figure = draw(outline, room, heading)
    end = run.at(-1)
    last = end.position_mm[end.is_there]
    figure.axes[0].scatter(
        last[:, 0], last[:, 1], s=12, color="#2a6f97", label=f"robots at {run.time_s[-1]:g} s", zorder=3
    )
    for legend in figure.legends:
        legend.remove()
    figure.legend(loc="outside lower right", fontsize=8, frameon=False, ncols=2)
    return figure


def analyze(options: argparse.Namespace, prog: str) -> None:
    """Write the table and the figures."""
    runs = with_arenas(open_runs(options, prog), options)
    known = [run for run in runs if run.arena.polygons]
    if not known:
        raise AnalysisError(f"{' '.join(options.input)} has no arena_polygons; give a configuration with -c")
    if len(known) < len(runs):
        warn(prog, f"{len(runs) - len(known)} runs have no arena and are left out")
    folder = output_folder(options)
    rooms = [room_of(run) for run in known]
    rows = for_each_run(row_of_run, list(zip(known, rooms, strict=True)), options, "arenas")
    tables, figures = [], set()
    for run, room, row in zip(known, rooms, rows, strict=True):
        tables.append(labelled(row, run))
        if run.arena.name not in figures:
            figures.add(run.arena.name)
            for problem in problems(outline_of(run)):
                warn(prog, f"{run.arena.name}: {problem}")
            save(drawn(run, room), folder / f"arena_{run.arena.name}.pdf")
    write_table(pd.concat(tables, ignore_index=True), Path(folder, "arenas.csv"), options.input)
