"""Dataframes of load_dataframe that pandas saves again: all that is known of their run comes back with them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pogosim.analysis.motion import speed
from pogosim.analysis.trajectories import trajectories_of
from pogosim.locomotion import main as analyze_locomotion
from pogosim.utils import load_dataframe
from pyarrow import feather
from swarms import metadata_of, rows_of, write_rows

SAVES: dict[str, Callable[[pd.DataFrame, Path], Any]] = {
    "to_feather": lambda rows, path: rows.to_feather(path),
    "to_parquet": lambda rows, path: rows.to_parquet(path),
    "write_feather": lambda rows, path: feather.write_feather(rows, str(path)),
}


@pytest.fixture
def periodic(tmp_path: Path) -> Path:
    """A robot that drives at 80 mm/s across the border of a periodic arena, in rows of 1 s."""
    x = np.mod(900.0 + 80.0 * np.arange(6), 1000.0)
    position = np.stack([x, np.full(6, 500.0)], axis=1)[:, None, :]
    combinations = [{"columns": {"a": 0}, "arena_polygons": [[{"x": 0, "y": 0}, {"x": 9, "y": 0}, {"x": 9, "y": 9}]]}]
    metadata = {**metadata_of(periodic=True), "combinations": combinations}
    return write_rows(tmp_path / "run.feather", rows_of(position), metadata)


def same(first: Any, second: Any) -> bool:
    """Tell whether metadata are the same, arrays by their values."""
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[key], second[key]) for key in first)
    if isinstance(first, list):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, np.ndarray):
        return isinstance(second, np.ndarray) and np.array_equal(first, second)
    return type(first) is type(second) and bool(first == second)


@pytest.mark.parametrize("save", SAVES)
def test_metadata_come_back_from_what_pandas_saves(periodic: Path, tmp_path: Path, save: str) -> None:
    rows, metadata = load_dataframe(periodic)
    for copy in ("once", "twice"):
        SAVES[save](rows, tmp_path / copy)
        rows, again = load_dataframe(tmp_path / copy)
        assert same(metadata, again)
    assert same(metadata["arena_polygons"], trajectories_of(rows)[0].arena.polygons)


@pytest.mark.parametrize("save", SAVES)
def test_speeds_in_a_periodic_arena_are_the_same_after_pandas_saved_the_rows(
    periodic: Path, tmp_path: Path, save: str
) -> None:
    rows, _ = load_dataframe(periodic)
    SAVES[save](rows[rows["time"] > 0.5].reset_index(drop=True), tmp_path / "y.feather")
    (run,) = trajectories_of(*load_dataframe(tmp_path / "y.feather"))
    assert np.nanmean(speed(run)) == pytest.approx(80.0)


@pytest.mark.parametrize("attributes", [None, {"note": 1}])
def test_file_without_metadata_of_a_run_is_read_with_one_warning(tmp_path: Path, attributes: object) -> None:
    table = pa.Table.from_pandas(rows_of(np.full((2, 1, 2), 5.0)), preserve_index=False)
    saved = json.dumps({**json.loads(table.schema.metadata[b"pandas"]), "attributes": attributes})
    others = {"PANDAS_ATTRS": "[", "note": "1"}
    path = tmp_path / "bare.feather"
    feather.write_feather(table.replace_schema_metadata({"pandas": saved, **others} if attributes else None), str(path))
    with pytest.warns(RuntimeWarning, match=r"bare\.feather has no metadata of a run") as caught:
        _, metadata = load_dataframe(path)
    assert [warning.filename for warning in caught] == [__file__]
    assert metadata["configuration"] == {}


def test_attrs_that_are_no_metadata_of_ours_are_taken_as_they_are(tmp_path: Path) -> None:
    rows = rows_of(np.full((2, 1, 2), 5.0))
    rows.attrs = {"configuration": "seed: 7", "arena_polygons": [[1, 2], [3]], "combinations": {"a": 1}, "note": [1]}
    rows.to_feather(tmp_path / "y.feather")
    _, metadata = load_dataframe(tmp_path / "y.feather")
    assert metadata == {**rows.attrs, "configuration": {"seed": 7}}


def test_an_analysis_of_rows_without_metadata_says_so_once(
    periodic: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows, _ = load_dataframe(periodic)
    rows.attrs = {}
    rows.to_feather(tmp_path / "bare.feather")
    assert analyze_locomotion(["-i", str(tmp_path / "bare.feather"), "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().err.count("has no metadata of a run, so configuration and arena are unknown") == 1
