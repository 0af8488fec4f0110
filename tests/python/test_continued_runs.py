"""Parts of a run that went on from a saved state: which count, and their rows as those of one run."""

from __future__ import annotations

import random
import shutil
import warnings
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest
import yaml
from pogosim.continued import ContinuedError, Part, counted_parts, in_order, join_parts, parts_of
from pogosim.tables import read_other
from pogosim.utils import load_dataframe
from running import example, run
from test_command import command, refusal

ONE_FILE = "data.[cfp]*[rtv]"  # data.feather, but not data.1.feather or data.csv.yaml


def write_part(path: Path, first: int, rows: range, finished: bool = True) -> None:
    """Write a part, whose rows are their numbers."""
    metadata = {b"configuration": b"x", **({b"continued_after_rows": b"%d" % first} if first else {})}
    schema = pa.schema([("row", pa.int64())], metadata)
    with path.open("wb") as file:
        if finished:
            with pa.ipc.new_file(file, schema) as writer:
                writer.write_table(pa.table([list(rows)], schema=schema))
        else:
            file.write(b"ARROW1\0\0")
            writer = pa.ipc.new_stream(file, schema)
            for row in rows:
                writer.write_table(pa.table([[row]], schema=schema))
            file.write(b"\xff\xff\xff\xff\x10")


def test_rows_of_parts_are_joined(tmp_path: Path) -> None:
    """Also where a part saved no state, or was killed while it began."""
    data = tmp_path / "data.feather"
    write_part(tmp_path / "data.1.feather", 0, range(12), finished=False)
    write_part(tmp_path / "data.2.feather", 10, range(10, 30))
    write_part(tmp_path / "data.3.feather", 10, range(10, 25), finished=False)
    (tmp_path / "data.10.feather").write_bytes(b"ARROW1\0\0")
    write_part(data, 20, range(20, 40))
    assert [path.name for path in parts_of(data)][-2:] == ["data.10.feather", "data.feather"]
    join_parts(data)
    table = pa.feather.read_table(data)
    assert table.column("row").to_pylist() == list(range(40))
    assert table.schema.metadata == {b"configuration": b"x"}
    join_parts(data)
    (tmp_path / "data.1.feather").unlink()
    write_part(data, 20, range(20, 40))
    with pytest.raises(ContinuedError, match="the first 10 rows of the run are missing"):
        join_parts(data)


def test_parts_that_end_before_the_state_do_not_count() -> None:
    first, early, last = (Part(Path(f"data.{i}.feather"), 0, end) for i, end in enumerate((30, 10, 50)))
    going_on = Part(last.path, 20, 50)
    assert counted_parts([first, early, going_on]) == [(first, 20), (going_on, None)]


@pytest.mark.parametrize(
    "names", [["data.2.feather", "data.10.feather", "data.feather"], ["first.feather", "then.feather", "last.feather"]]
)
def test_parts_are_in_the_order_of_their_numbers_or_else_of_their_states(names: list[str]) -> None:
    parts = [Part(Path(name), begin) for name, begin in zip(names, (0, 5, 7), strict=True)]
    for _ in range(10):
        random.shuffle(parts)
        assert [parts[place].path.name for place in in_order(parts)] == names


@pytest.fixture(scope="module", params=["feather", "csv", "parquet"])
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run in one go, and the same run in three parts; the first two go on after their states."""
    return make_runs(tmp_path_factory.mktemp("runs"), request.param)


def make_runs(place: Path, kind: str, seed: int = 3, name: str = "") -> Path:
    """Do the runs, in the folders whole and parts."""
    settings = {"objects.robots.nb": 5, "data_filename": f"data.{kind}", "message_log": "log.feather", "seed": seed}
    program = example("naming_game")

    def do(where: str, *more: str, end_s: float) -> None:
        done = run(program, place / f"{where}{name}", {**settings, "simulation_time": end_s}, more)
        assert done.code == 0, done.text

    do("whole", end_s=6.0)
    do("parts", "--save-state", "a", "--at", "2", end_s=3.0)
    do("parts", "--save-state", "b", "--at", "4", "--from-state", "a", end_s=5.0)
    do("parts", "--from-state", "b", end_s=6.0)
    return place


def expect_one_run(rows: pd.DataFrame, metadata: dict[str, object], whole: Path) -> None:
    """Rows and metadata are those of the run that was never interrupted, as of a list of files."""
    expected, of_whole = load_dataframe([whole])
    assert len(expected) > 100
    pd.testing.assert_frame_equal(rows, expected)
    assert set(metadata) == set(of_whole)
    assert {key for key in metadata if str(metadata[key]) != str(of_whole[key])} == {"files"}


def test_parts_of_a_run_are_read_as_one_run(folder: Path) -> None:
    (whole,) = (folder / "whole").glob(ONE_FILE)
    names = [f"data.1{whole.suffix}", f"data.2{whole.suffix}", whole.name]
    files = [folder / "parts" / name for name in names]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        expect_one_run(*load_dataframe(files), whole)
        expect_one_run(*load_dataframe(files[::-1]), whole)
        expect_one_run(*load_dataframe(folder / "parts" / f"data*{whole.suffix}"), whole)
        alone, _ = load_dataframe(files[-1])
    assert alone["time"].min() > 4.0


def test_part_that_is_given_twice_counts_once(folder: Path) -> None:
    (whole,) = (folder / "whole").glob(ONE_FILE)
    parts = folder / "parts"
    files = [parts / f"data.1{whole.suffix}", parts / f"data.2{whole.suffix}", parts / whole.name]
    for again in files:
        rows, metadata = load_dataframe([*files, parts / ".." / "parts" / again.name])
        expect_one_run(rows, metadata, whole)


def test_message_logs_of_parts_are_read_as_one(tmp_path: Path) -> None:
    make_runs(tmp_path, "feather")
    expect_one_run(*load_dataframe(tmp_path / "parts" / "log*.feather"), tmp_path / "whole" / "log.feather")


def test_missing_part_is_one_error(folder: Path) -> None:
    (last,) = (folder / "parts").glob(ONE_FILE)
    begin = r"the first \d+ rows of the run are missing: give its earlier parts, too, such as data\.1"
    for found in ("1", "2"):
        with pytest.raises(ContinuedError, match=begin):
            load_dataframe([last.with_name(f"data.{found}{last.suffix}"), last])


def test_parts_of_several_runs_are_told_apart(tmp_path: Path) -> None:
    """By their seeds, and those of the same seed by their folders and names; one that was repeated counts once."""
    make_runs(tmp_path, "feather")
    make_runs(tmp_path, "feather", seed=4, name="_of_another")
    files = sorted(tmp_path.glob("parts*/data*.feather"))
    rows, _ = load_dataframe(files)
    whole = [tmp_path / name / "data.feather" for name in ("whole", "whole_of_another")]
    pd.testing.assert_frame_equal(rows, load_dataframe(whole)[0])
    shutil.copy(tmp_path / "parts" / "data.2.feather", tmp_path / "parts" / "data.1.5.feather")
    shutil.copytree(tmp_path / "parts", tmp_path / "copy")
    with pytest.warns(RuntimeWarning, match="hold the same rows"):
        rows, metadata = load_dataframe(sorted([*files, *tmp_path.glob("copy/data*.feather")]))
    assert rows["run"].unique().tolist() == [0, 1, 2]
    assert len(metadata["files"]) == 10


def test_state_from_before_the_first_row(tmp_path: Path) -> None:
    settings = {"objects.robots.nb": 3, "save_data_period": 0.5, "simulation_time": 2.0}
    program = example("helloworld")
    assert run(program, tmp_path, settings, ["--save-state", "a", "--at", "0.1"]).code == 0
    assert run(program, tmp_path, settings, ["--from-state", "a"]).code == 0
    parts = parts_of(tmp_path / "data.feather")
    assert len(parts) == 2
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows, _ = load_dataframe(parts)
    assert rows["run"].unique().tolist() == [0]
    assert rows["time"].is_monotonic_increasing


def test_files_that_are_no_parts_are_runs_as_before(tmp_path: Path) -> None:
    for number, seed in enumerate((1, 2)):
        table = pa.table({"time": [0.0, 1.0]})
        metadata = {"configuration": yaml.safe_dump({"seed": seed}), "program_version": "v1"}
        pa.feather.write_feather(table.replace_schema_metadata(metadata), str(tmp_path / f"{number}.feather"))
    assert load_dataframe(tmp_path / "*.feather")[0]["run"].tolist() == [0, 0, 1, 1]


# ---- pogosim join ----


def table_in(path: Path) -> pa.Table:
    """Read a file with its metadata."""
    other = read_other(path)
    return pa.feather.read_table(path, memory_map=False) if other is None else other


def test_joined_file_is_that_of_the_uninterrupted_run(folder: Path, tmp_path: Path) -> None:
    """Rows, types, metadata and their order, in any format; rows of earlier parts after the states are not in it."""
    (whole,) = (folder / "whole").glob(ONE_FILE)
    parts = [folder / "parts" / name for name in (whole.name, f"data.2{whole.suffix}", f"data.1{whole.suffix}")]
    expected = table_in(whole)
    for ending in (".feather", ".csv", ".parquet"):
        output = tmp_path / f"joined{ending}"
        result = command(tmp_path, "join", *map(str, parts), "-o", output.name)
        assert (result.code, result.errors) == (0, "")
        assert result.output == f"joined{ending}: {expected.num_rows} rows, up to t = 6 s, of 3 parts\n"
        joined = table_in(output)
        assert joined.equals(expected)
        assert list((joined.schema.metadata or {}).items()) == list((expected.schema.metadata or {}).items())
    (tmp_path / "joined.feather").rename(tmp_path / "run.feather")
    result = command(tmp_path, "analyze", "coverage", "-i", "run.feather", "-o", "results")
    assert result.code == 0, result.errors


def test_message_logs_are_joined(tmp_path: Path) -> None:
    make_runs(tmp_path, "feather")
    parts = [f"parts/{name}" for name in ("log.1.feather", "log.2.feather", "log.feather")]
    result = command(tmp_path, "join", *parts, "-o", "log.feather")
    assert result.code == 0, result.errors
    assert table_in(tmp_path / "log.feather").equals(table_in(tmp_path / "whole" / "log.feather"))


def test_killed_parts_are_joined(tmp_path: Path) -> None:
    """Those without rows of the run are said; where the last one was killed, the metadata say it."""
    write_part(tmp_path / "data.1.feather", 0, range(12), finished=False)
    write_part(tmp_path / "data.2.feather", 10, range(10, 30))
    (tmp_path / "data.3.feather").write_bytes(b"ARROW1\0\0")
    write_part(tmp_path / "data.feather", 10, range(10, 25), finished=False)
    names = sorted(path.name for path in tmp_path.glob("*.feather"))
    result = command(tmp_path, "join", *names, "-o", "all.feather")
    assert (result.code, result.errors) == (0, "")
    assert result.output.splitlines() == [
        "all.feather: 25 rows, of 2 parts",
        "data.3.feather: not needed, other parts have its rows",
        "data.2.feather: not needed, other parts have its rows",
    ]
    assert table_in(tmp_path / "all.feather").column("row").to_pylist() == list(range(25))


def test_what_cannot_be_joined_is_said_in_one_line(tmp_path: Path) -> None:
    write_part(tmp_path / "data.1.feather", 0, range(12))
    write_part(tmp_path / "data.feather", 10, range(10, 30))
    write_part(tmp_path / "other.feather", 40, range(40, 50))
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}

    def said(*arguments: str) -> str:
        return refusal(command(tmp_path, "join", *arguments)).removeprefix("pogosim join: ")

    missing = "goes on from a saved state, and the first 10 rows of the run are missing"
    assert said("data.feather", "-o", "x.feather").startswith(f"data.feather {missing}")
    assert said("data.1.feather", "-o", "x.feather") == "no run goes on from a saved state in data.1.feather"
    assert "the first 40 rows of the run are missing" in said("data.1.feather", "other.feather", "-o", "x.feather")
    assert "is one of the parts" in said("data.1.feather", "data.feather", "-o", "data.feather")
    assert said("no.feather", "-o", "x.feather") == "no.feather: no such file or directory"
    assert "its format is unknown" in said("data.1.feather", "data.feather", "-o", "x.png")
    assert "required: -o/--output" in said("data.1.feather", "data.feather")
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_parts_of_other_runs_are_told(tmp_path: Path) -> None:
    make_runs(tmp_path, "feather")
    make_runs(tmp_path, "feather", seed=4, name="_of_another")
    parts = ["parts/data.1.feather", "parts_of_another/data.2.feather"]
    line = refusal(command(tmp_path, "join", *parts, "-o", "x.feather"))
    assert line.endswith(f"{parts[0]} and {parts[1]} are not of one run: seed is 3 in the one, and 4 in the other")
