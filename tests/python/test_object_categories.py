"""Files without the column robot_category (data_logger_fields): their configuration says which objects are robots."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from batches import batch, write_options
from pogosim.analysis.motion import speed
from pogosim.analysis.trajectories import trajectories_of
from pogosim.calibration.reading import read_track_table
from pogosim.errors import AnalysisError, CalibrationError
from pogosim.object_categories import UnknownCategoriesError, with_categories
from pogosim.picture.swarm import read_recording
from pogosim.utils import load_dataframe
from running import example, run

DISK = {"geometry": "disk", "radius": 10}
BOXES = {"type": "passive_object", "nb": 4, **DISK}
MIXED: dict[str, Any] = {
    "initial_formation": "random",
    "objects": {
        "lamp": {"type": "static_light", "geometry": "global", "value": 10},
        "boxes": BOXES,
        "walls": {"type": "pogowall", "geometry": "arena"},
        "beacons": {"type": "pogobject", "nb": 2, **DISK},
        "ring": {"type": "membrane", "nb": 1, "geometry": "disk", "radius": 60},
        "robots": {"type": "pogobot", "nb": 3, "radius": 26.5},
        "more": {"type": "active_object", "nb": 2, **DISK},
        "none": {"type": "passive_object", "nb": 0, **DISK},
    },
}
FIELDS = {"data_logger_fields": ["time", "robot_id", "x", "y"]}


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
def test_categories_are_those_that_the_run_would_have_written(tmp_path: Path, boundary: str) -> None:
    settings = {**MIXED, "boundary_condition": boundary, "arena_file": "arenas/square.csv"}
    if boundary == "periodic":
        settings["arena_surface"] = 2.0e6
    rows, metadata = load_dataframe(run(example("helloworld"), tmp_path, settings).folder / "data.feather")
    assert rows["robot_category"].nunique() == (6 if boundary == "solid" else 5)
    told = with_categories(rows.drop(columns="robot_category"), metadata)
    assert told["robot_category"].tolist() == rows["robot_category"].tolist()


def test_passive_objects_do_not_count_as_robots(tmp_path: Path) -> None:
    settings = {**MIXED, **FIELDS, "simulation_time": 1.0}
    data = run(example("run_and_tumble"), tmp_path, settings).folder / "data.feather"
    (own,) = trajectories_of(*load_dataframe(data))
    assert set(own.category) == {"robots"}
    assert own.robot_id.tolist() == [2, 3, 4]
    assert np.nanmean(speed(own)) > 10.0
    (boxes,) = trajectories_of(*load_dataframe(data), category="boxes")
    assert boxes.robot_id.tolist() == [65532, 65533, 65534, 65535]
    categories = read_recording(data).last.rows.groupby("robot_category")["robot_id"].nunique()
    assert categories.to_dict() == {"boxes": 4, "beacons": 2, "ring": 1, "robots": 3, "more": 2}
    assert read_track_table(data, "robots", print).rows["id"].nunique() == 3


def test_more_objects_than_ids_of_robots_are_numbered_from_their_count_down() -> None:
    objects = {"boxes": {**BOXES, "nb": 70_000}, "robots": {"type": "pogobot", "nb": 2}}
    rows = pd.DataFrame({"robot_id": [0, 1, 2, 70_001]})
    told = with_categories(rows, {"configuration": {"objects": objects}})["robot_category"].tolist()
    assert told == ["robots", "robots", "boxes", "boxes"]


def test_the_only_category_that_is_recorded_needs_no_ids() -> None:
    rows = pd.DataFrame({"time": [0.0, 1.0], "x": [0.0, 1.0], "y": 0.0})
    configuration = {"objects": {"boxes": BOXES, "preys": {"type": "pogobot"}}}
    for metadata, name in (
        ({"configuration": {**configuration, "data_logger_category": ["preys"]}}, "preys"),
        ({"configuration": {"objects": {"preys": {"type": "pogobot"}}}}, "preys"),
        ({}, "robots"),
    ):
        assert trajectories_of(rows, metadata)[0].category.tolist() == [name]


def test_combinations_of_a_batch_have_numbers_of_objects_of_their_own(tmp_path: Path) -> None:
    columns = {"result_new_columns": ["objects.boxes.nb"], "objects.boxes.nb": {"batch_options": [1, 2]}}
    objects = {"objects.boxes": {"type": "passive_object", "nb": 1, **DISK}, "objects.robots.nb": 2}
    write_options(tmp_path, {**objects, **columns, **FIELDS, "initial_formation": "random"})
    assert batch(tmp_path).code == 0
    (data,) = (tmp_path / "results").glob("*.feather")
    runs = trajectories_of(*load_dataframe(data))
    assert [own.robot_id.tolist() for own in runs] == [[0, 1], [0, 1]]
    assert len(trajectories_of(*load_dataframe(data), category="boxes")[1].robot_id) == 2


@pytest.mark.parametrize(
    ("rows", "objects", "given", "words"),
    [
        ({"robot_id": [0, 9]}, {"boxes": BOXES, "robots": {"nb": 3}}, None, "none of its objects has the id 9"),
        ({"robot_id": [0, 1]}, {"boxes": BOXES, "robots": {}}, None, "does not say how many objects"),
        (
            {"x": [0.0, 1.0]},
            {"boxes": BOXES, "robots": {"nb": 3}},
            None,
            "and no column robot_id, so nothing says",
        ),
        ({"robot_id": [0, 1]}, {"boxes": BOXES, "robots": {"nb": 3}}, {"preys": {}}, "different categories"),
        (
            {"robot_id": [0, 1], "run": [0, 1], "objects.preys.nb": [None, 2.0]},
            {"boxes": BOXES, "robots": {"nb": 3}},
            None,
            "different categories",
        ),
    ],
)
def test_rows_whose_categories_nothing_says_are_refused(
    rows: dict[str, Any], objects: dict[str, Any], given: dict[str, Any] | None, words: str, tmp_path: Path
) -> None:
    metadata: dict[Any, Any] = {
        "resolved_configuration": {"objects": objects},
        "configuration": {"objects": given or objects},
    }
    frame = pd.DataFrame({"time": [0.0, 1.0], "x": 0.0, "y": 0.0, **rows})
    with pytest.raises(UnknownCategoriesError, match="record robot_category, too"):
        with_categories(frame, metadata)
    with pytest.raises(AnalysisError, match=words):
        trajectories_of(frame, metadata)
    frame.attrs = {**metadata}
    frame.to_feather(tmp_path / "y.feather")
    with warnings.catch_warnings(), pytest.raises(ValueError, match=words):
        read_recording(tmp_path / "y.feather", run=0 if "run" in rows else None)
    with pytest.raises(CalibrationError, match=words):
        read_track_table(tmp_path / "y.feather", "robots", print)
