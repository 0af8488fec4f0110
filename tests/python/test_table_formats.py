"""The ending of a name says the format of a table, whichever program writes it; all formats hold the same."""

from __future__ import annotations

import csv
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pytest
from batches import batch, write_options
from pogosim import swarm_picture
from pogosim.command.recover import main as recover_command
from pogosim.table_formats import CSV, format_of
from pogosim.tables import table_writer, write_metadata_beside
from pogosim.utils import load_dataframe, read_table
from running import PROGRAMS, Run, compile_program, example, run, start, wait_for_rows

FORMATS = ("csv", "parquet")
LONG: dict[str, object] = {"simulation_time": 1.0e6, "save_data_period": 0.02}
NOT_THE_SAME = ("data_filename", "message_log")


@pytest.fixture(scope="module")
def columns(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_program(tmp_path_factory.mktemp("columns") / "columns", PROGRAMS / "column_names.c")


@pytest.fixture(scope="module")
def runs(columns: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same run in all formats."""
    folder = tmp_path_factory.mktemp("runs")
    for ending in ("feather", *FORMATS):
        names = {"data_filename": f"d.{ending}", "message_log": f"m.{ending}"}
        ended_well(run(columns, folder, {**names, "objects.robots.nb": 4}))
    return folder


def ended_well(result: Run) -> None:
    assert (result.code, result.errors) == (0, ""), result.text


def without_names(metadata: dict[str, object]) -> dict[str, object]:
    """Return what two runs have in common that write to different files."""
    plain: dict[str, object] = {}
    for key, value in metadata.items():
        if isinstance(value, dict):
            plain[key] = {name: entry for name, entry in value.items() if name not in NOT_THE_SAME}
        else:
            plain[key] = [polygon.tolist() for polygon in value] if isinstance(value, list) else value
    return plain


@pytest.mark.parametrize("name", ["d", "m"])
@pytest.mark.parametrize("ending", FORMATS)
def test_all_formats_hold_the_same_rows_types_and_metadata(runs: Path, ending: str, name: str) -> None:
    rows, metadata = load_dataframe(runs / f"{name}.feather")
    others, other_metadata = load_dataframe(runs / f"{name}.{ending}")
    assert len(rows) > 4
    pd.testing.assert_frame_equal(others, rows)
    assert without_names(other_metadata) == without_names(metadata)
    table, other_table = read_table(runs / f"{name}.feather"), read_table(runs / f"{name}.{ending}")
    assert other_table.schema.remove_metadata() == table.schema.remove_metadata()


def test_csv_is_what_other_readers_expect(runs: Path) -> None:
    rows = pd.read_csv(runs / "d.csv")
    assert list(rows.columns[:4]) == ["time", "robot_category", "robot_id", "pogobot_ticks"]
    assert rows["time"].tolist()[:8] == [0.0] * 4 + [0.1] * 4
    assert rows["number"].tolist()[:4] == [0, 100, 200, 300]
    assert rows["word"].tolist()[2] == 'a, "b"\nc'
    assert rows["word"].isna().tolist()[:2] == [True, True]


def test_parquet_is_what_other_readers_expect(runs: Path) -> None:
    pd.testing.assert_frame_equal(pd.read_parquet(runs / "d.parquet"), pd.read_feather(runs / "d.feather"))


# ---- CSV files that another program has changed ----


def changed(runs: Path, folder: Path, change: Callable[[pd.DataFrame], pd.DataFrame], **options: Any) -> Path:
    """Read the CSV file of the run with pandas, change it, and write it with pandas; returns the path."""
    path = folder / "d.csv"
    shutil.copy(runs / "d.csv.yaml", folder)
    change(pd.read_csv(runs / "d.csv")).to_csv(path, **{"index": False, **options})
    return path


def without_empty_texts(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows as pandas writes them to CSV: it does not tell an empty text from a missing one."""
    return rows.assign(word=rows["word"].where(rows["word"] != "", None))


CHANGES: dict[str, Callable[[pd.DataFrame], pd.DataFrame]] = {
    "nothing": lambda rows: rows,
    "order": lambda rows: rows[["x", *sorted(set(rows.columns) - {"x"})]],
    "column less": lambda rows: rows.drop(columns="pogobot_ticks"),
    "first column less": lambda rows: rows.drop(columns="time"),
    "column more": lambda rows: rows.assign(extra=1.5, own="2026-01-01", count=3)[
        ["extra", *rows.columns, "own", "count"]
    ],
    "rows less": lambda rows: rows[rows["time"] > 0.2].drop(columns="y"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_columns_of_a_changed_csv_have_their_types_by_name(runs: Path, tmp_path: Path, change: str) -> None:
    original = without_empty_texts(load_dataframe(runs / "d.csv")[0])
    rows = load_dataframe(changed(runs, tmp_path, CHANGES[change]))[0]
    expected = CHANGES[change](original).reset_index(drop=True)
    pd.testing.assert_frame_equal(rows, expected)


@pytest.mark.parametrize("options", [{"quoting": csv.QUOTE_ALL}, {"na_rep": "NA"}], ids=["quoted", "NA"])
def test_empty_cells_of_other_programs_are_missing_numbers(runs: Path, tmp_path: Path, options: dict[str, Any]) -> None:
    rows = load_dataframe(
        changed(runs, tmp_path, lambda rows: rows.assign(number=rows["number"].where(rows.index > 1)), **options)
    )[0]
    assert rows["number"].isna().tolist() == [True, True, *[False] * (len(rows) - 2)]
    assert rows["number"].tolist()[2:4] == [200, 300]


def test_index_that_pandas_writes_is_a_column_of_its_own(runs: Path, tmp_path: Path) -> None:
    rows = load_dataframe(changed(runs, tmp_path, CHANGES["nothing"], index=True))[0]
    assert rows.pop("Unnamed: 0").tolist() == list(range(len(rows)))
    pd.testing.assert_frame_equal(rows, without_empty_texts(load_dataframe(runs / "d.csv")[0]))
    picture = tmp_path / "d.png"
    assert swarm_picture.main([str(tmp_path / "d.csv"), str(picture), "--dpi", "20", "-q"]) == 0


def test_cells_of_integers_may_be_missing_and_integers_written_with_a_point(runs: Path, tmp_path: Path) -> None:
    path = changed(runs, tmp_path, lambda rows: rows.assign(robot_id=rows["robot_id"].where(rows.index != 3)))
    assert ",1.0," in path.read_text()
    table = read_table(path)
    assert str(table.schema.field("robot_id").type) == "int32"
    assert str(table.schema.field("even").type) == "bool"
    assert table.column("robot_id").to_pylist()[:5] == [0, 1, 2, None, 0]
    rows = load_dataframe(path)[0]
    assert rows["robot_id"].isna().tolist()[:5] == [False, False, False, True, False]
    assert str(rows["time"].dtype) == "float64"


def test_integers_that_another_program_made_larger_or_broken_are_kept(runs: Path, tmp_path: Path) -> None:
    path = changed(runs, tmp_path, lambda rows: rows.assign(robot_id=3_000_000_000, pogobot_ticks=0.5))
    rows = load_dataframe(path)[0]
    assert (rows["robot_id"].iloc[0], rows["pogobot_ticks"].iloc[0]) == (3_000_000_000, 0.5)


def test_cell_that_is_no_number_is_named(runs: Path, tmp_path: Path) -> None:
    path = changed(runs, tmp_path, lambda rows: rows.assign(x=rows["x"].astype(object).where(rows.index != 2, "a bit")))
    with pytest.raises(ValueError, match="row 3, column 'x': expected float, found 'a bit'"):
        load_dataframe(path)


def test_cells_that_are_not_separated_by_commas_are_told(runs: Path, tmp_path: Path) -> None:
    path = changed(runs, tmp_path, lambda rows: rows, sep=";", decimal=",")
    with pytest.raises(ValueError, match="names no column of the run, such as 'time'; separate cells by commas"):
        load_dataframe(path)


def test_csv_of_an_earlier_version_has_types_in_the_order_of_its_columns(runs: Path, tmp_path: Path) -> None:
    path = changed(runs, tmp_path, CHANGES["nothing"])
    shutil.copy(runs / "d.csv", path)
    beside = tmp_path / "d.csv.yaml"
    lines = beside.read_text().splitlines(keepends=True)
    kept = [line for line in lines if not line.startswith("column_names")]
    assert len(kept) == len(lines) - 1
    beside.write_text("".join(kept))
    pd.testing.assert_frame_equal(load_dataframe(path)[0], load_dataframe(runs / "d.feather")[0])


def test_name_of_a_column_may_have_any_character(tmp_path: Path) -> None:
    schema = pa.schema(
        [("a, b]", pa.int8()), ('"', pa.float32()), ("back\\slash", pa.int16()), ("two\nlines\x07", pa.int32())]
    )
    table = pa.Table.from_pylist([dict.fromkeys(schema.names, 1)], schema=schema)
    path = tmp_path / "d.csv"
    with path.open("wb") as file:
        writer = table_writer(file, CSV, schema)
        writer.write_table(table)
        writer.close()
    write_metadata_beside(path, CSV, schema)
    assert read_table(path).schema.remove_metadata() == schema


@pytest.mark.parametrize("ending", FORMATS)
def test_same_run_gives_the_same_bytes(columns: Path, tmp_path: Path, ending: str) -> None:
    for name in ("a", "b"):
        ended_well(run(columns, tmp_path / name, {"data_filename": f"d.{ending}"}))
    written = sorted(path.name for path in (tmp_path / "a").iterdir())
    assert written == ["d.csv", "d.csv.yaml", "scene.yaml"] if ending == "csv" else ["d.parquet", "scene.yaml"]
    for name in written:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize("name", ["d.xlsx", "d.feather.old", "d.h5"])
@pytest.mark.parametrize("key", ["data_filename", "message_log"])
def test_format_that_cannot_be_written_is_refused_with_those_that_can(tmp_path: Path, key: str, name: str) -> None:
    result = run(example("helloworld"), tmp_path, {key: name})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert line.startswith("Error: scene.yaml:")
    assert f"{key}: the format of '{name}' is unknown; expected a name that ends in .feather, .arrow or .ipc" in line
    assert ".parquet or .csv" in line
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scene.yaml"]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("d", "feather"),
        ("d.", "feather"),
        ("p_0.5", "feather"),
        ("d.ARROW", "feather"),
        ("d.ipc", "feather"),
        ("D.CSV", "csv"),
    ],
)
def test_names_of_every_kind_are_understood(tmp_path: Path, name: str, kind: str) -> None:
    assert format_of(name) == kind
    ended_well(run(example("helloworld"), tmp_path, {"data_filename": name}))
    assert len(load_dataframe(tmp_path / name)[0]) == 63


@pytest.mark.parametrize("ending", FORMATS)
def test_killed_run_leaves_its_rows_and_recover_gives_them_their_format(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"d.{ending}"
    process = start(example("helloworld"), tmp_path, {**LONG, "data_filename": path.name})
    wait_for_rows(path)
    process.kill()
    process.communicate()
    with pytest.warns(RuntimeWarning, match="is incomplete"):
        rows, _ = load_dataframe(path)
    assert len(rows) > 0
    assert recover_command([str(path)]) == 0
    recovered, metadata = load_dataframe(path)
    pd.testing.assert_frame_equal(recovered, rows)
    assert metadata["configuration"]["seed"] == 1
    assert "these are the rows that were saved" in metadata["recovered"]
    assert path.read_bytes().startswith(b"PAR1" if ending == "parquet" else b'"time"')
    assert recover_command([str(path)]) == 2  # complete


@pytest.mark.parametrize("ending", FORMATS)
def test_interrupted_run_has_a_complete_file(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"d.{ending}"
    process = start(example("helloworld"), tmp_path, {**LONG, "data_filename": path.name})
    wait_for_rows(path)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert f"The data file '{path.name}' contains all rows up to that point" in errors
    assert "simulated in" not in errors
    rows, metadata = load_dataframe(path)
    assert len(rows) > 3
    assert "incomplete" not in metadata


@pytest.mark.parametrize("ending", FORMATS)
def test_full_disk_leaves_the_rows_and_says_how_to_have_them(tmp_path: Path, ending: str) -> None:
    program = tmp_path / "limited"
    program.write_text(f"#!/bin/sh\nulimit -f 200\nexec '{example('helloworld')}' \"$@\"\n")
    program.chmod(0o755)
    result = run(program, tmp_path, {**LONG, "data_filename": f"d.{ending}"})
    assert result.code == 2
    assert f"pogosim-recover 'd.{ending}'" in result.errors
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"d.{ending}", "limited", "scene.yaml"]
    assert recover_command([str(tmp_path / f"d.{ending}")]) == 0
    assert len(load_dataframe(tmp_path / f"d.{ending}")[0]) > 0


def test_what_killed_runs_left_is_removed_and_files_of_users_are_not(tmp_path: Path) -> None:
    (tmp_path / "d.csv.pogosim-new").write_text('"time","robot_category"\n0,')
    (tmp_path / "d.parquet.pogosim-new").write_bytes(b"PAR1 and then it was killed")
    (tmp_path / "e.csv.pogosim-new").write_text("mine\n")
    for name in ("d.csv", "d.parquet", "e.csv"):
        ended_well(run(example("helloworld"), tmp_path, {"data_filename": name}))
    assert sorted(path.name for path in tmp_path.glob("*.pogosim-new")) == ["e.csv.pogosim-new"]
    assert (tmp_path / "e.csv.pogosim-new").read_text() == "mine\n"


@pytest.mark.parametrize("key", ["data_filename", "message_log"])
def test_file_of_a_user_in_the_place_of_the_metadata_is_refused(tmp_path: Path, key: str) -> None:
    (tmp_path / "d.csv.yaml").write_text("my: own\n")
    result = run(example("helloworld"), tmp_path, {key: "d.csv"})
    assert result.code == 2
    assert "its metadata belong in" in result.errors
    assert (tmp_path / "d.csv.yaml").read_text() == "my: own\n"
    same = run(example("helloworld"), tmp_path, {key: "scene.csv", "console_filename": "scene.csv.yaml"})
    assert same.code == 0  # no console file is written
    both = {key: "scene.csv", "console_filename": "scene.csv.yaml", "enable_console_logging": True}
    refused = run(example("helloworld"), tmp_path, both)
    assert refused.code == 2
    assert "(the metadata of the " in refused.errors


@pytest.mark.parametrize("key", ["data_filename", "message_log"])
def test_name_too_long_for_the_file_beside_it_is_refused_before_the_run(tmp_path: Path, key: str) -> None:
    longest = 255 - len(".csv.yaml.pogosim-new")
    for length, code in ((longest, 0), (longest + 1, 2)):
        result = run(example("helloworld"), tmp_path, {key: "d" * length + ".csv", "simulation_time": 1.0})
        assert result.code == code, result.text
        assert ("the name is too long for the file of metadata beside it; choose a shorter one" in result.text) == (
            code == 2
        )
        assert (tmp_path / ("d" * length + ".csv.yaml")).exists() == (code == 0)


def test_csv_without_its_metadata_is_read_with_a_warning(runs: Path, tmp_path: Path) -> None:
    path = tmp_path / "d.csv"
    path.write_bytes((runs / "d.csv").read_bytes())
    with pytest.warns(RuntimeWarning, match=r"there is no d\.csv\.yaml of a run beside it") as caught:
        rows, metadata = load_dataframe(path)
    assert caught[0].filename == __file__
    assert metadata == {"configuration": {}}
    assert rows["time"].tolist() == load_dataframe(runs / "d.csv")[0]["time"].tolist()


@pytest.mark.parametrize("content", [b"PAR1", b"PAR1 no table PAR1", b'"time","x"\n1\n'])
def test_damaged_files_say_so(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / ("d.parquet" if content.startswith(b"PAR1") else "d.csv")
    path.write_bytes(content)
    with pytest.raises(ValueError, match=f"{path.name} is damaged, or no data file"), pytest.MonkeyPatch.context() as m:
        m.setattr("warnings.warn", lambda *_, **__: None)
        load_dataframe(path)


@pytest.mark.parametrize("ending", FORMATS)
def test_results_of_a_batch_have_the_format_of_their_name(tmp_path: Path, ending: str) -> None:
    for form in ("feather", ending):
        write_options(tmp_path / form, {"result_filename_format": f"r.{form}", "data_filename": f"d.{form}"})
        result = batch(tmp_path / form, "-r", "2")
        assert (result.code, result.errors) == (0, "")
    rows, metadata = load_dataframe(tmp_path / "feather" / "results" / "r.feather")
    others, other_metadata = load_dataframe(tmp_path / ending / "results" / f"r.{ending}")
    pd.testing.assert_frame_equal(others, rows)
    assert other_metadata["combinations"] == metadata["combinations"]
    again = batch(tmp_path / ending, "-r", "1")  # replaces what an earlier batch wrote
    assert (again.code, again.errors) == (0, "")
    refused = batch(write_options(tmp_path / "wrong", {"result_filename_format": "r.xlsx"}).parent)
    assert refused.code == 2
    assert "result_filename_format: the format of 'r.xlsx' is unknown; expected a name that ends in" in refused.errors


@pytest.mark.parametrize("ending", FORMATS)
def test_pictures_are_drawn_from_all_formats(runs: Path, tmp_path: Path, ending: str) -> None:
    for form in ("feather", ending):
        assert swarm_picture.main([str(runs / f"d.{form}"), str(tmp_path / f"{form}.png"), "--dpi", "40", "-q"]) == 0
    assert (tmp_path / f"{ending}.png").read_bytes() == (tmp_path / "feather.png").read_bytes()
