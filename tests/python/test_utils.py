from __future__ import annotations

import json
import logging
import math
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from pogosim.utils import init_logging, load_dataframe, parse_configuration, save_figure
from pyarrow import feather
from running import example, run


def write(path: Path, metadata: dict[str, str]) -> Path:
    table = pa.table({"time": pa.array([0.0, 1.5], pa.float32()), "x": pa.array([10.0, None], pa.float32())})
    feather.write_feather(table.replace_schema_metadata(metadata), path, compression="zstd")
    return path


def test_rows_come_back_as_pandas_reads_them(tmp_path: Path) -> None:
    path = write(tmp_path / "a.feather", {"program_version": "v1"})
    frame, _ = load_dataframe(path)
    pd.testing.assert_frame_equal(frame, pd.read_feather(path))
    assert frame["time"].dtype == np.float32


def test_path_may_be_a_text(tmp_path: Path) -> None:
    frame, _ = load_dataframe(str(write(tmp_path / "a.feather", {"program_version": "v1"})))
    assert len(frame) == 2


def test_all_metadata_come_back_and_the_configuration_is_a_dictionary(tmp_path: Path) -> None:
    metadata = {"program_version": "v1.2.3", "configuration": "seed: 7\nobjects:\n  robots: {nb: 3}\n", "é": "ü"}
    _, read = load_dataframe(write(tmp_path / "a.feather", metadata))
    assert read["program_version"] == "v1.2.3"
    assert read["é"] == "ü"
    assert read["configuration"] == {"seed": 7, "objects": {"robots": {"nb": 3}}}


def test_file_without_metadata_has_an_empty_configuration(tmp_path: Path) -> None:
    frame = pd.DataFrame({"x": [1.0]})
    table = pa.Table.from_pandas(frame).replace_schema_metadata(None)
    feather.write_feather(table, tmp_path / "a.feather")
    with pytest.warns(RuntimeWarning, match=r"a\.feather has no metadata of a run"):
        _, read = load_dataframe(tmp_path / "a.feather")
    assert read == {"configuration": {}}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a: 1\nb: [x, 2.5]", {"a": 1, "b": ["x", 2.5]}),
        ("arena_surface: 1.0e6", {"arena_surface": 1.0e6}),
        ('{"a": true,\t"b": null}', {"a": True, "b": None}),
        ("{'a': 'one ' 'text'}", {"a": "one text"}),  # a Python literal only
        ("{'a' 'b': 1, []: 2}", {}),
        ("[" * 100_000, {}),
        ("- " * 100_000, {}),
        ("{a: " * 100_000, {}),
        ("", {}),
        ("just a text", {}),
        ("- a\n- list", {}),
        ("a: [1", {}),
        ("a: !!python/object:os.system {}", {}),
        ("\x00", {}),
    ],
)
def test_configuration_is_read_as_yaml_json_or_literal_and_else_empty(text: str, expected: object) -> None:
    assert parse_configuration(text) == expected


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("2.22e6", 2.22e6),
        ("1e3", 1000.0),
        ("1E+3", 1000.0),
        ("-.5e-3", -0.0005),
        ("5.", 5.0),
        ("1.0e+6", 1.0e6),
        ("-.INF", -math.inf),
        ("+7", 7),
        ("010", 10),
        ("0x1F", 31),
        ("-0x1f", -31),
        ("0o17", 15),
    ],
)
def test_numbers_come_back_as_the_simulator_reads_them(text: str, number: float) -> None:
    value = parse_configuration(f"a: {text}\nb: [{text}]")
    assert value == {"a": number, "b": [number]}
    assert type(value["a"]) is type(number)


@pytest.mark.parametrize("text", ["1:30", "1_000", "0b11", "2024-01-01", "2024-13-45", "=", "1e", ".", "1.2.3"])
def test_texts_that_are_no_numbers_to_the_simulator_stay_texts(text: str) -> None:
    assert parse_configuration(f"a: {text}") == {"a": text}


def test_numbers_in_quotes_are_texts() -> None:
    assert parse_configuration("a: '2.22e6'") == {"a": "2.22e6"}


def test_arena_comes_back_as_arrays_of_corners(tmp_path: Path) -> None:
    text = "- [{x: 0, y: 0}, {x: 1e3, y: 0}, {x: 0, y: 2.5}]\n- [{x: 1, y: 2}, {x: 3, y: 4}]\n"
    _, read = load_dataframe(write(tmp_path / "a.feather", {"arena_polygons": text}))
    outer, hole = read["arena_polygons"]
    np.testing.assert_array_equal(outer, [[0, 0], [1000, 0], [0, 2.5]])
    np.testing.assert_array_equal(hole, [[1, 2], [3, 4]])


@pytest.mark.parametrize("text", ["[1, 2]", "[[{x: 1}]]", "[[", "{a: 1}", "5", "none", "[[]]", "[[{x: a, y: 1}]]"])
def test_arena_that_is_no_list_of_polygons_stays_a_text(tmp_path: Path, text: str) -> None:
    _, read = load_dataframe(write(tmp_path / "a.feather", {"arena_polygons": text}))
    assert read["arena_polygons"] == text


@given(st.text())
def test_no_text_breaks_the_parser_of_configurations(text: str) -> None:
    assert isinstance(parse_configuration(text), dict)


def test_missing_file_is_a_file_not_found_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load_dataframe(tmp_path / "none.feather")


@pytest.mark.parametrize("content", [b"", b"not a table, but long enough to hold a footer"])
def test_file_of_another_kind_is_refused_by_name(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.feather"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"a\.feather is not a complete Feather file"):
        load_dataframe(path)


def test_truncated_file_is_refused_by_name(tmp_path: Path) -> None:
    path = write(tmp_path / "a.feather", {})
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(ValueError, match=r"a\.feather is not a complete Feather file"):
        load_dataframe(path)


def test_figure_is_saved_in_a_new_folder_and_closed(tmp_path: Path) -> None:
    plt.switch_backend("agg")
    plt.figure()
    plt.plot([0, 1], [0, 1])
    save_figure(tmp_path / "new" / "a.png", dpi=50)
    assert (tmp_path / "new" / "a.png").read_bytes().startswith(b"\x89PNG")
    assert plt.get_fignums() == []


@pytest.mark.parametrize(("verbose", "level"), [(False, logging.INFO), (True, logging.DEBUG)])
def test_verbose_logging_starts_at_debug(verbose: bool, level: int) -> None:
    root = logging.getLogger()
    handlers, before = root.handlers[:], root.level
    try:
        init_logging(verbose)
        assert root.level == level
    finally:
        root.handlers[:] = handlers
        root.setLevel(before)


@pytest.mark.parametrize("unit_mm", [1.0, 100.0])
def test_arenas_of_earlier_simulators_are_converted_to_millimetres(unit_mm: float, tmp_path: Path) -> None:
    side = 1000.0 / unit_mm
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    polygons = "[[" + ", ".join(f"{{x: {x}, y: {y}}}" for x, y in corners) + "]]"
    rows = {"x": [100.0, 900.0, math.nan], "y": [500.0, 40.0, math.nan]}
    table = pa.table(rows).replace_schema_metadata({"arena_polygons": polygons})
    feather.write_feather(table, tmp_path / "old.feather")
    (polygon,) = load_dataframe(tmp_path / "old.feather")[1]["arena_polygons"]
    assert polygon.max() == 1000.0


def test_small_arenas_with_robots_outside_remain_as_they_are(tmp_path: Path) -> None:
    polygons = "[[{x: 0, y: 0}, {x: 10, y: 0}, {x: 0, y: 10}]]"
    table = pa.table({"x": [5.0, 5000.0], "y": [5.0, 5000.0]}).replace_schema_metadata({"arena_polygons": polygons})
    feather.write_feather(table, tmp_path / "small.feather")
    assert load_dataframe(tmp_path / "small.feather")[1]["arena_polygons"][0].max() == 10.0


def test_selections_share_the_metadata_of_a_dataframe(tmp_path: Path) -> None:
    rows, metadata = load_dataframe(run(example("helloworld"), tmp_path).folder / "data.feather")
    assert rows["x"].attrs["configuration"] is rows.attrs["configuration"]
    assert rows.attrs["configuration"] == metadata["configuration"]
    assert rows.attrs["configuration"] is not metadata["configuration"]
    for dump in (yaml.safe_dump, yaml.dump):
        assert yaml.safe_load(dump(rows.attrs["arena_polygons"])) == rows.attrs["arena_polygons"]
    assert json.loads(json.dumps(rows.attrs["configuration"])) == metadata["configuration"]
