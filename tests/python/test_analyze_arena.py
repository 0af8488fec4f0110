from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pogosim.reports.command import analyze
from swarms import metadata_of, rows_of, write_rows


def analysed(folder: Path, rows: pd.DataFrame, **metadata: object) -> pd.DataFrame:
    write_rows(folder / "data.feather", rows, {**metadata_of(), **metadata})
    assert analyze("arena", ["-i", str(folder / "data.feather"), "-o", str(folder / "out")], "arena") == 0
    return pd.read_csv(folder / "out" / "arenas.csv")


def test_size_and_room_of_a_square(tmp_path: Path) -> None:
    (row,) = analysed(tmp_path, rows_of(np.array([[[500.0, 400.0]]]))).to_dict("records")
    assert (row["arena"], row["is_periodic"], row["holes"], row["robots"]) == ("square", False, 0, 1)
    assert (row["width_mm"], row["area_mm2"], row["perimeter_mm"]) == (1000.0, 1e6, 4000.0)
    # What a disk cannot cover are the corners of the square, less a quarter of the disk each.
    assert row["room_share"] == pytest.approx(1.0 - (4.0 - np.pi) * 26.5**2 / 1e6, abs=1e-5)
    assert row["visited_share"] == pytest.approx(np.pi * 26.5**2 / 1e6, rel=0.01)
    assert row["robots_area_share"] == pytest.approx(np.pi * 26.5**2 / 1e6)
    assert row["least_wall_distance_mm"] == pytest.approx(400.0)
    for suffix in (".pdf", ".png"):
        assert (tmp_path / "out" / f"arena_square{suffix}").stat().st_size > 1000


def test_a_straight_way_visits_a_stripe(tmp_path: Path) -> None:
    way = np.stack([np.arange(100.0, 901.0, 2.0), np.full(401, 500.0)], axis=1)[:, None, :]
    row = analysed(tmp_path, rows_of(way)).iloc[0]
    assert row["visited_share"] == pytest.approx((800.0 * 53.0 + np.pi * 26.5**2) / 1e6, rel=0.01)


def test_holes_count_as_walls(tmp_path: Path) -> None:
    hole = [[400.0, 400.0], [600.0, 400.0], [600.0, 600.0], [400.0, 600.0]]
    outer = metadata_of()["arena_polygons"][0]
    row = analysed(tmp_path, rows_of(np.array([[[370.0, 500.0]]])), arena_polygons=[outer, hole]).iloc[0]
    assert (row["holes"], row["area_mm2"], row["perimeter_mm"]) == (1, 1e6 - 200.0**2, 4800.0)
    assert row["least_wall_distance_mm"] == pytest.approx(30.0)


def test_a_robot_on_a_periodic_border_visits_both_sides(tmp_path: Path) -> None:
    row = analysed(tmp_path, rows_of(np.array([[[0.0, 0.0]]])), **metadata_of(periodic=True)).iloc[0]
    assert row["visited_share"] == pytest.approx(np.pi * 26.5**2 / 1e6, rel=0.01)
    assert row["is_periodic"]
    assert np.isnan(row["perimeter_mm"])
    assert np.isnan(row["room_share"])


def test_walls_that_cross_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bow = [[[0.0, 0.0], [100.0, 100.0], [100.0, 0.0], [0.0, 130.0]]]
    analysed(tmp_path, rows_of(np.array([[[10.0, 50.0]]])), arena_polygons=bow)
    assert "warning: square: the outer polygon crosses or touches itself" in capsys.readouterr().err


def test_data_without_an_arena_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_rows(tmp_path / "data.feather", rows_of(np.ones((2, 2, 2))), {})
    assert analyze("arena", ["-i", str(path), "-o", str(tmp_path)], "arena") == 2
    assert capsys.readouterr().err == f"arena: {path} has no arena_polygons; give a configuration with -c\n"
