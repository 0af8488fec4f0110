"""The data file: columns, rows, types, metadata."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from conftest import Compile
from running import Run, compile_text, example, run

NB = 7
BUILT_IN = ["time", "robot_category", "robot_id", "pogobot_ticks", "x", "y", "angle"]
OTHERS = {"type": "pogobot", "nb": 2, "geometry": "disk", "radius": 26.5}


def columns(program: Compile, folder: Path, *arguments: str, **settings: object) -> Run:
    result = run(program("columns.c"), folder, {"objects.robots.nb": NB, **settings}, arguments)
    said = [line for line in result.errors.splitlines() if "data_set_value_float16(): value is -1000000" not in line]
    assert (result.code, said) == (0, [])
    return result


def hello(folder: Path, **settings: object) -> Run:
    result = run(example("helloworld"), folder, settings)
    assert (result.code, result.errors) == (0, "")
    return result


def times(frame: pd.DataFrame) -> list[float]:
    return [round(float(t), 4) for t in frame["time"].unique()]


# ---- Columns ----


def test_columns_have_the_names_order_and_types_of_the_format(program: Compile, tmp_path: Path) -> None:
    schema = columns(program, tmp_path).table().schema
    assert [(field.name, str(field.type)) for field in schema] == [
        ("time", "double"),
        ("robot_category", "string"),
        ("robot_id", "int32"),
        ("pogobot_ticks", "int64"),
        ("x", "float"),
        ("y", "float"),
        ("angle", "float"),
        ("i8", "int8"),
        ("i16", "int16"),
        ("i32", "int32"),
        ("i64", "int64"),
        ("f64", "double"),
        ("text", "string"),
        ("flag", "bool"),
        ("f16", "halffloat"),
        ("f32", "float"),
        ("never_set", "int32"),
    ]


TURNING = """
#include "pogobase.h"

DECLARE_USERDATA(int);
REGISTER_USERDATA(int);

static void init(void) { main_loop_hz = 50; }

// 2 rad/s, to the right and to the left.
static void step(void) {
    pogobot_motor_set(pogobot_helper_getid() % 2 == 0 ? motorL : motorR, motorFull);
    pogobot_led_setColor(255, 0, 128);
}

int main(void) {
    pogobot_init();
    pogobot_start(init, step);
    return 0;
}
"""


def test_values_of_columns_are_in_the_ranges_that_the_page_gives(tmp_path: Path) -> None:
    settings: dict[str, object] = {
        "simulation_time": 8.0,
        "data_logger_led": True,
        "objects.robots.nb": 4,
        "objects.ball": {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 20},
        "objects.ring": {"type": "membrane", "nb": 1, "geometry": "disk", "radius": 60, "serialize_dot_pose": True},
    }
    result = run(compile_text(tmp_path, TURNING), tmp_path, settings)
    assert result.code == 0, result.errors
    frame = result.frame()
    side_mm = np.sqrt(4e6 / np.pi)  # the bounding box of a disk of 1e6 mm2

    assert frame["time"].between(0, 8).all()
    assert frame["time"].is_monotonic_increasing
    assert set(frame["robot_category"]) == {"robots", "ball", "ring"}
    assert frame["robot_id"].between(0, 65535).all()
    assert (frame.loc[frame["robot_category"] == "ball", "pogobot_ticks"]).isna().all()
    assert frame.loc[frame["robot_category"] == "robots", "pogobot_ticks"].between(0, 401).all()
    for axis in ("x", "y"):
        assert frame[axis].between(0, side_mm).all()
    headings = frame.loc[frame["robot_category"] != "ring", "angle"]
    assert (-np.pi < headings).all()
    assert (headings <= np.float32(np.pi)).all()
    assert frame.loc[frame["robot_category"] == "ring", "angle"].isna().all()
    assert set(frame["subpart_id"]) == {-1, *range(100)}
    lit = frame[(frame["time"] > 0) & (frame["robot_category"] == "robots")]
    assert set(lit["led_rgb"]) == {0xFF0080}
    assert set(frame.loc[frame["robot_category"] == "ball", "led_rgb"]) == {0}

    # Several turns were made, and the angle is the heading of each moment.
    robots = frame[frame["robot_category"] == "robots"]
    for robot in range(4):
        rows = robots[robots["robot_id"] == robot]
        turned = np.unwrap(rows["angle"].to_numpy(float))
        rate = 2.0 if robot % 2 == 0 else -2.0  # rad/s: twice max_angular_speed
        np.testing.assert_allclose(turned - turned[0], rate * rows["time"].to_numpy(float), atol=0.05)


def test_pandas_reads_the_file(program: Compile, tmp_path: Path) -> None:
    result = columns(program, tmp_path)
    frame = pd.read_feather(tmp_path / "data.feather")
    assert list(frame.columns[: len(BUILT_IN)]) == BUILT_IN
    pd.testing.assert_frame_equal(frame, result.frame())


def cells(table: pa.Table, robot: int) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = table.to_pylist()
    return [row for row in rows if row["robot_id"] == robot]


def test_values_at_the_ends_of_their_ranges_come_back(program: Compile, tmp_path: Path) -> None:
    table = columns(program, tmp_path).table()
    low = {"i8": -(2**7), "i16": -(2**15), "i32": -(2**31), "i64": -(2**63), "f64": -1e308, "text": "", "flag": False}
    high = {"i8": 2**7 - 1, "i16": 2**15 - 1, "i32": 2**31 - 1, "i64": 2**63 - 1, "f64": 0.1, "flag": True}
    for row in cells(table, 0):
        assert {name: row[name] for name in low} == low
        assert row["f16"] == -np.inf
        assert row["f32"] == -1e6
    for row in cells(table, 1):
        assert {name: row[name] for name in high} == high
        assert row["text"] == 'h\u00e9, "quoted"\n'
        assert row["f16"] == np.float16(1 / 3)
        assert row["f32"] == np.float32(1 / 3)


def test_cell_that_is_not_set_is_null_and_nothing_of_other_rows_leaks_into_it(program: Compile, tmp_path: Path) -> None:
    table = columns(program, tmp_path).table()
    names = [field.name for field in table.schema][len(BUILT_IN) :]
    for row in cells(table, 2):
        assert [row[name] for name in names] == [None] * len(names)
    assert [row["i32"] for row in cells(table, 5)] == list(range(1, 22))
    assert all(row["i64"] is None for row in cells(table, 5))
    assert table.column("never_set").null_count == table.num_rows


def test_fields_choose_columns_and_values_for_the_others_are_ignored(program: Compile, tmp_path: Path) -> None:
    result = columns(program, tmp_path, data_logger_fields=["f16", "time", "robot_id", "x", "i32"])
    assert list(result.frame().columns) == ["time", "robot_id", "x", "i32", "f16"]


def test_categories_choose_rows(program: Compile, tmp_path: Path) -> None:
    both = {"objects.robots.nb": 2, "objects.others": OTHERS}
    frame = columns(program, tmp_path, **both).frame()
    first = frame[frame["time"] == 0]
    assert list(zip(first["robot_category"], first["robot_id"], strict=True)) == [
        ("robots", 0),
        ("robots", 1),
        ("others", 2),
        ("others", 3),
    ]
    only = columns(program, tmp_path, **both, data_logger_category=["others"]).frame()
    assert set(only["robot_category"]) == {"others"}
    assert len(only) == 2 * 21


def test_export_disabled_by_a_robot_leaves_out_its_row_and_no_other(program: Compile, tmp_path: Path) -> None:
    frame = columns(program, tmp_path, **{"parameters.hide_odd_robots": True}).frame()
    assert frame.groupby("robot_id").size().to_dict() == {0: 21, 2: 21, 4: 21, 6: 21}


# ---- Rows ----


@pytest.mark.parametrize(
    ("period", "end", "expected"),
    [
        (1.0, 5.0, [0, 1, 2, 3, 4, 5]),
        (0.25, 2.0, [0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2]),
        (0.7, 3.5, [0, 0.7, 1.4, 2.1, 2.8, 3.5]),
        (0.7, 3.0, [0, 0.7, 1.4, 2.1, 2.8]),
        (0.1, 0.3, [0, 0.1, 0.2, 0.3]),
        (0.01, 0.05, [0, 0.01, 0.02, 0.03, 0.04, 0.05]),
        (100.0, 2.0, [0]),
        (2.0, 2.0, [0, 2]),
        (-1, 2.0, [0]),
        (0, 2.0, [0]),
        (1.0, 0.0, [0]),
    ],
)
def test_rows_stand_at_exact_multiples_of_the_period(
    tmp_path: Path, period: float, end: float, expected: list[float]
) -> None:
    frame = hello(tmp_path, save_data_period=period, simulation_time=end).frame()
    assert times(frame) == expected
    assert frame["robot_id"].tolist() == [0, 1, 2] * len(expected)


def test_rows_do_not_drift_in_a_long_run(tmp_path: Path) -> None:
    frame = hello(tmp_path, simulation_time=1000.0, save_data_period=1.0, **{"objects.robots.nb": 1}).frame()
    np.testing.assert_array_equal(frame["time"], np.arange(1001, dtype=np.float32))


@pytest.mark.parametrize(("step", "period"), [(0.003, 0.1), (0.016, 0.05), (0.015, 0.25)])
def test_with_steps_that_do_not_divide_the_period_rows_follow_it_within_a_step(
    tmp_path: Path, step: float, period: float
) -> None:
    frame = hello(tmp_path, time_step=step, save_data_period=period, simulation_time=10.0).frame()
    found = np.array([float(t) for t in frame["time"].unique()])
    late = found - np.arange(len(found)) * period
    assert late.min() > -1e-5
    assert late.max() < step + 1e-5
    assert len(found) >= 10.0 / period


def test_step_longer_than_a_tick_is_shortened_with_a_warning(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {"time_step": 0.1, "simulation_time": 10.0})
    assert result.code == 0
    assert "time_step reduced from 0.1 s to 0.016 s" in result.errors
    assert result.errors.count("\n") == 1
    assert result.frame()["pogobot_ticks"].max() == pytest.approx(625, abs=2)


def test_robots_of_60_hz_tick_every_16_ms(tmp_path: Path) -> None:
    frame = hello(tmp_path, simulation_time=48.5, save_data_period=0.5).frame()
    at_start = frame.loc[frame["time"] == 0, "pogobot_ticks"]
    after_1_s = frame.loc[frame["time"] == 1, "pogobot_ticks"]
    after_48_5_s = frame.loc[frame["time"] == 48.5, "pogobot_ticks"]
    assert (at_start == 0).all()
    assert after_1_s.between(62, 64).all()
    assert after_48_5_s.between(2970, 3090).all()


@pytest.mark.parametrize("rows_per_batch", [1, 7, 63, 64])
def test_size_of_the_batches_changes_no_row(tmp_path: Path, rows_per_batch: int) -> None:
    whole = hello(tmp_path / "whole")
    cut = hello(tmp_path / "cut", data_logger_flush_row_count=rows_per_batch)
    assert len(whole.frame()) == 63
    assert cut.frame().equals(whole.frame())


def test_without_logging_nothing_is_written(tmp_path: Path) -> None:
    hello(tmp_path, enable_data_logging=False)
    assert [path.name for path in tmp_path.iterdir()] == ["scene.yaml"]


def test_folders_of_the_file_are_made_and_an_old_file_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "a" / "b" / "data.feather"
    for end in (2.0, 1.0):
        hello(tmp_path, data_filename="a/b/data.feather", simulation_time=end)
        assert pd.read_feather(path)["time"].max() == end


# ---- Metadata ----


def metadata(result: Run) -> dict[str, str]:
    return {key.decode(): value.decode() for key, value in result.table().schema.metadata.items()}


def test_metadata_hold_the_whole_configuration_with_what_was_decided(tmp_path: Path) -> None:
    settings = {"parameters": {"of_mine": [1, 2], "deep.er": {"x": "yes"}}, "result_filename_format": "r.feather"}
    result = run(example("helloworld"), tmp_path, settings)
    assert result.code == 0
    assert result.errors.count("\n") == 1  # helloworld reads no such parameters
    saved = metadata(result)
    configuration = yaml.safe_load(saved["configuration"])
    asked = yaml.safe_load((tmp_path / "scene.yaml").read_text())
    assert {key: configuration[key] for key in asked} == asked
    assert configuration["GUI"] is False
    assert configuration["progress_bar"] is False
    assert 0.1 <= configuration["mm_to_pixels"] <= 10
    assert saved["program_version"].startswith("v")


def test_unknown_keys_stay_in_the_saved_configuration(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {"laboratory": "room 3"})
    assert yaml.safe_load(metadata(result)["configuration"])["laboratory"] == "room 3"


@pytest.mark.parametrize("arena", ["disk", "annulus", "squarewithHole", "star", "H"])
def test_polygons_enclose_the_asked_area_in_mm_and_hold_all_robots(tmp_path: Path, arena: str) -> None:
    result = hello(tmp_path, arena_file=f"arenas/{arena}.csv", arena_surface=5.0e5, simulation_time=0.1)
    polygons = [
        np.array([[p["x"], p["y"]] for p in corners]) for corners in yaml.safe_load(metadata(result)["arena_polygons"])
    ]
    outer, *holes = [abs(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1])) / 2 for p in polygons]
    assert outer - sum(holes) == pytest.approx(5.0e5, rel=1e-3)
    frame = result.frame()
    assert frame["x"].between(0, polygons[0][:, 0].max()).all()
    assert frame["y"].between(0, polygons[0][:, 1].max()).all()


# ---- Outputs that fail ----


@pytest.mark.parametrize("path", ["/dev/full", "/dev/null/data.feather", ".", "scene.yaml/data.feather"])
def test_output_that_cannot_be_written_ends_with_2_and_names_the_path(tmp_path: Path, path: str) -> None:
    result = run(example("helloworld"), tmp_path, {"data_filename": path})
    assert result.code == 2
    assert f"cannot write the data file '{path}' (data_filename)" in result.errors


def test_limit_on_the_size_of_files_is_an_error_that_names_it(tmp_path: Path) -> None:
    program = tmp_path / "limited"
    program.write_text(f"#!/bin/sh\nulimit -f 8\nexec '{example('helloworld')}' \"$@\"\n")
    program.chmod(0o755)
    result = run(program, tmp_path, {"simulation_time": 50.0, "save_data_period": 0.02, "objects.robots.nb": 20})
    assert result.code == 2
    assert "cannot write the data file 'data.feather' (data_filename): File too large" in result.errors


def test_disk_that_fills_up_during_the_run_ends_it_with_2(tmp_path: Path) -> None:
    # The first batches go out long before the end.
    settings = {"data_filename": "/dev/full", "data_logger_flush_row_count": 5, "simulation_time": 50.0}
    result = run(example("helloworld"), tmp_path, settings)
    assert result.code == 2
    assert "No space left on device" in result.errors
    assert "/dev/full" in result.errors
