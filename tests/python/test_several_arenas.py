"""Files of runs in different arenas, read together: each run keeps its own arena."""

from __future__ import annotations

from pathlib import Path

from pogosim.analysis.trajectories import trajectories_of
from pogosim.utils import load_dataframe
from swarms import brownian_walk, metadata_of, rows_of, write_rows


def test_each_run_keeps_its_arena_and_its_borders(tmp_path: Path) -> None:
    rows = rows_of(500.0 + brownian_walk(3, 2, 1.0))
    files = [
        write_rows(tmp_path / f"{side:g}_{periodic}.feather", rows, metadata_of(side, periodic))
        for side, periodic in ((1000.0, False), (2000.0, True), (3000.0, True))
    ]
    runs = trajectories_of(*load_dataframe(files))
    assert [(run.arena.size_mm.tolist(), run.arena.is_periodic) for run in runs] == [
        ([1000.0, 1000.0], False),
        ([2000.0, 2000.0], True),
        ([3000.0, 3000.0], True),
    ]


def test_combinations_of_several_batches_keep_their_arenas(tmp_path: Path) -> None:
    files = []
    for number, sides in enumerate(((500.0, 600.0), (700.0, 800.0))):
        arenas = {f"arena{n}": metadata_of(side)["arena_polygons"] for n, side in enumerate(sides)}
        entries = [{"columns": {"arena_file": name}, "arena_polygons": polygons} for name, polygons in arenas.items()]
        for entry in entries:
            entry["arena_polygons"] = [[{"x": x, "y": y} for x, y in polygon] for polygon in entry["arena_polygons"]]
        parts = [rows_of(brownian_walk(3, 2, 1.0)).assign(run=0, arena_file=name) for name in arenas]
        metadata = metadata_of(nb=10 + number) | {"combinations": entries}
        del metadata["arena_polygons"]
        for part in parts:
            files.append(tmp_path / f"{number}_{part['arena_file'][0]}.feather")
            write_rows(files[-1], part, metadata)
    runs = trajectories_of(*load_dataframe(files))
    sizes = {(run.labels["objects.robots.nb"], run.arena.name): run.arena.size_mm[0] for run in runs}
    assert sizes == {(10, "arena0"): 500.0, (10, "arena1"): 600.0, (11, "arena0_2"): 700.0, (11, "arena1_2"): 800.0}
