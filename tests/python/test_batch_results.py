"""What a batch writes: rows, columns, metadata, and the same bytes whichever worker did the runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from batches import batch, batch_apart, ended, results, write_options
from conftest import Compile
from pogosim.batch.errors import BatchError
from pogosim.batch.result_files.parts import Part
from pogosim.batch.result_files.results import write_results
from pogosim.batch.runs.run_data import ROWS_PER_BATCH, RunFile, read_run
from pogosim.utils import load_dataframe
from pyarrow import feather, ipc
from running import ROOT, example, run_command


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the results of two combinations, three runs each."""
    folder = tmp_path_factory.mktemp("done")
    write_options(folder)
    result = batch(folder, "-r", "3")
    assert (result.code, result.errors) == (0, "")
    return folder


def test_rows_are_those_of_single_runs_with_run_and_new_columns(done: Path, tmp_path: Path) -> None:
    expected = []
    for nb in (2, 3):
        for seed in range(3):
            arguments = ["-c", str(done / "many.yaml"), "-g", "-q", "-s", str(seed)]
            arguments += ["--set", f"objects.robots.nb={nb}", "--set", "data_filename=one.feather"]
            assert run_command(example("helloworld"), tmp_path, arguments).code == 0
            frame = load_dataframe(tmp_path / "one.feather")[0]
            expected.append(frame.assign(run=seed, **{"objects.robots.nb": nb, "arena_file": "disk"}))
    rows, _ = load_dataframe(done / "results" / "result.feather")
    pd.testing.assert_frame_equal(rows, pd.concat(expected, ignore_index=True), check_flags=False)
    assert str(rows["run"].dtype) == "int64"


def test_metadata_are_the_options_and_what_is_true_of_all_runs(done: Path) -> None:
    rows, metadata = load_dataframe(done / "results" / "result.feather")
    assert metadata["configuration"]["objects"]["robots"]["nb"] == {"batch_options": [2, 3], "default_option": 3}
    with ipc.open_file(done / "results" / "result.feather") as reader:
        assert reader.schema.metadata[b"configuration"].decode() == (done / "many.yaml").read_text()
    assert metadata["program_version"].startswith("v")
    assert metadata["arena_polygons"][0].shape[1] == 2
    resolved = metadata["resolved_configuration"]
    assert resolved["objects"]["robots"]["radius"] == 26.5
    assert "nb" not in resolved["objects"]["robots"]
    assert not {"seed", "data_filename"} & set(resolved)
    assert [entry["columns"]["objects.robots.nb"] for entry in metadata["combinations"]] == [2, 3]
    assert sum(entry["rows"] for entry in metadata["combinations"]) == len(rows)
    assert rows.attrs["configuration"] == metadata["configuration"]


def test_nothing_but_the_results_is_left(done: Path) -> None:
    assert sorted(path.name for path in done.iterdir()) == ["many.yaml", "results"]
    assert [path.name for path in (done / "results").iterdir()] == ["result.feather"]


@pytest.mark.parametrize("backend", [["-j", "1"], ["-j", "5"], ["--backend", "sequential"]])
def test_bytes_do_not_depend_on_which_worker_does_the_runs(backend: list[str], done: Path, tmp_path: Path) -> None:
    write_options(tmp_path)
    result = batch(tmp_path, "-r", "3", *backend)
    assert (result.code, result.errors) == (0, "")
    assert results(tmp_path) == results(done)


def test_dask_writes_the_same_bytes(done: Path, tmp_path: Path) -> None:
    write_options(tmp_path)
    result = batch_apart(tmp_path, "-r", "3", "--backend", "ray")
    assert (result.code, result.errors) == (0, "pogobatch: --backend ray is replaced by --backend dask\n")
    assert results(tmp_path) == results(done)


def test_data_file_of_a_run_is_opened_when_the_run_has_ended_and_when_it_is_joined(
    done: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[Path] = []
    memory_map = pa.memory_map

    def counted(path: str) -> pa.MemoryMappedFile:
        opened.append(Path(path))
        return memory_map(path)

    monkeypatch.setattr(pa, "memory_map", counted)
    write_options(tmp_path)
    assert batch(tmp_path, "-r", "3", "--backend", "sequential").code == 0
    assert opened[:6] == opened[6:]
    assert len(set(opened)) == 6
    assert results(tmp_path) == results(done)


def test_output_is_that_of_the_article(tmp_path: Path) -> None:
    """The commands of the article word for word, with shorter runs."""
    for name in ("arenas", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    for name in ("test.yaml", "batch/test.yaml"):
        path = tmp_path / "conf" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text((ROOT / "conf" / name).read_text().replace("simulation_time: 50.0", "simulation_time: 1.0"))
    command = "PATH={}:$PATH; pogobatch -c conf/{} -S ./examples/hanabi/hanabi -r {} -t tmp -o results"
    scripts = ROOT / ".venv" / "bin"
    (tmp_path / "results").mkdir()
    one = ended(["bash", "-c", command.format(scripts, "test.yaml", 10)], tmp_path)
    assert (one.code, one.errors) == (0, "")
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert rows.groupby("run").size().to_dict() == dict.fromkeys(range(10), 100)
    assert metadata["configuration"]["seed"] == 0

    (tmp_path / "results" / "result_50.feather").write_bytes((tmp_path / "results" / "result.feather").read_bytes())
    many = ended(["bash", "-c", command.format(scripts, "batch/test.yaml", 2)], tmp_path)
    assert (many.code, many.errors) == (0, "")
    lines = many.output.splitlines()
    outputs = [f"results/result_{nb}.feather" for nb in (50, 100, 150)]
    assert lines[0] == "Found 6 combination(s) to run."
    assert lines[1:] == ["Batch run completed. Generated output files:", *(f" - {output}" for output in outputs)]
    rows, metadata = load_dataframe(tmp_path / outputs[0])
    assert rows.groupby(["arena_file", "run"], sort=False).size().index.tolist() == [
        (arena, run) for arena in ("disk", "arena8") for run in (0, 1)
    ]
    assert "arena_polygons" not in metadata
    assert [len(entry["arena_polygons"]) for entry in metadata["combinations"]] == [1, 1]


def test_seeds_from_the_configuration_are_all_different_and_others_than_the_numbers(tmp_path: Path) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2, "seed": {"batch_options": [1, 2]}, "result_new_columns": ["seed"]})
    result = batch(tmp_path, "-r", "3", "--seed-from", "config", "--keep-temp")
    assert (result.code, result.errors) == (0, "")
    found = [load_dataframe(path)[1]["configuration"]["seed"] for path in (tmp_path / "tmp").glob("done_*/*.feather")]
    assert len(set(found)) == 6
    assert all(seed > 2 for seed in found)
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert rows.groupby(["seed", "run"]).ngroups == 6
    assert {seed for entry in metadata["combinations"] for seed in entry["seeds"]} == set(found)


def test_warnings_of_runs_are_shown_once(tmp_path: Path) -> None:
    path = write_options(tmp_path, {"parameters": {"never_read": 1}})
    line = 1 + path.read_text().splitlines().index("  never_read: 1")
    result = batch(tmp_path, "-r", "3")
    assert result.code == 0
    assert result.errors == (
        f"pogobatch: warning of a run: parameters never read by the program: never_read (many.yaml:{line})\n"
    )


def test_kept_folders_have_the_files_of_the_article_and_the_name_of_the_data_file_is_free(tmp_path: Path) -> None:
    write_options(tmp_path, {"data_filename": "elsewhere/swarm.arrow", "enable_console_logging": True})
    result = batch(tmp_path, "--keep-temp")
    assert (result.code, result.errors) == (0, "")
    folders = list((tmp_path / "tmp").glob("sim_0_try0_*"))
    assert len(folders) == 2
    for folder in folders:
        names = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
        assert {"test.yaml", "frames/swarm.arrow", "frames/console.txt"} <= names
    again = batch(tmp_path, "--keep-temp")
    assert "2 of 2 runs are done already" in again.output


def test_values_and_runs_added_to_a_batch_that_was_kept_are_the_only_new_ones(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path, "-r", "2", "--keep-temp").code == 0
    more = {"objects.robots.nb": {"batch_options": [2, 3, 4], "default_option": 3}}
    write_options(tmp_path, dict(more))
    added = batch(tmp_path, "-r", "3", "--keep-temp")
    assert "4 of 9 runs are done already" in added.output
    kept = (tmp_path / "results" / "result.feather").read_bytes()

    write_options(tmp_path / "anew", dict(more))
    assert batch(tmp_path / "anew", "-r", "3").code == 0
    assert (tmp_path / "anew" / "results" / "result.feather").read_bytes() == kept


def test_results_of_values_added_in_a_batch_of_their_own_are_read_together(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path, "-r", "2").code == 0
    more = {"objects.robots.nb": {"batch_options": [4]}, "result_filename_format": "more.feather"}
    write_options(tmp_path, dict(more))
    assert "done already" not in batch(tmp_path, "-r", "2").output
    rows, _ = load_dataframe([tmp_path / "results" / name for name in ("result.feather", "more.feather")])
    robots = rows[rows["time"] == 0].groupby(["objects.robots.nb", "run"]).size()
    assert robots.to_dict() == {(nb, run): nb for nb in (2, 3, 4) for run in (0, 1)}
    assert not {"seed", "result_filename_format"} & set(rows.columns)


def test_file_beside_the_configuration_is_found_as_by_a_single_run(tmp_path: Path) -> None:
    path = write_options(tmp_path / "conf", {"arena_file": "mine.csv"})
    (tmp_path / "conf" / "mine.csv").write_text("0,0\n3,0\n3,1\n0,1\n")
    path.rename(tmp_path / "conf" / "my.yaml")
    write_options(tmp_path)
    result = batch(tmp_path, "-c", "conf/my.yaml")
    assert (result.code, result.errors) == (0, "")
    assert set(load_dataframe(tmp_path / "results" / "result.feather")[0]["arena_file"]) == {"mine"}


def test_combinations_that_no_column_tells_apart_are_warned_of(tmp_path: Path) -> None:
    write_options(tmp_path, {"result_new_columns": ["arena_file"], "result_filename_format": "all.feather"})
    result = batch(tmp_path)
    assert result.code == 0
    (line,) = result.errors.splitlines()
    assert line == (
        "pogobatch: results/all.feather: no column tells its combinations apart; add to result_new_columns: "
        "objects.robots.nb"
    )


@pytest.mark.parametrize(
    ("values", "cells"),
    [
        (["m/s", "rad/s"], ["m/s", "rad/s"]),
        (["a/net.json", "b/net.json"], ["a/net.json", "b/net.json"]),
        (["a/net.json", "b/other.json"], ["net", "other"]),
        (["./x/one", "./y/two"], ["one", "two"]),
    ],
)
def test_values_that_differ_are_told_apart_by_their_column(values: list[str], cells: list[str], tmp_path: Path) -> None:
    options = {"parameters": {"p": {"batch_options": values}}, "objects.robots.nb": 1, "simulation_time": 0.1}
    write_options(
        tmp_path, {**options, "result_new_columns": ["parameters.p"], "result_filename_format": "all.feather"}
    )
    result = batch(tmp_path, "-r", "1")
    assert result.code == 0
    assert "no column tells" not in result.errors, result.errors
    rows = load_dataframe(tmp_path / "results" / "all.feather")[0]
    assert list(dict.fromkeys(rows["parameters.p"])) == cells


def test_value_with_a_slash_makes_no_folder(tmp_path: Path) -> None:
    write_options(
        tmp_path,
        {
            "parameters": {"p": {"batch_options": ["m/s", "rad/s"]}},
            "result_filename_format": "r_{parameters.p}.feather",
        },
    )
    listed = batch(tmp_path, "--list-outputs")
    assert listed.output.split() == ["results/r_m_s.feather", "results/r_rad_s.feather"]


def test_column_of_an_alternative_is_proposed_as_it_has_to_be_written(tmp_path: Path) -> None:
    alternatives = {"few": {"type": "pogobot", "nb": 2}, "one": {"type": "pogobot", "nb": 2, "radius": 20}}
    changes = {"objects.robots": {"batch_hierarchical_options": alternatives}, "result_filename_format": "all.feather"}
    write_options(tmp_path, {**changes, "result_new_columns": ["arena_file"], "objects.robots.nb": None})
    result = batch(tmp_path, "-r", "1")
    assert "no column tells its combinations apart; add to result_new_columns: " in result.errors
    proposed = result.errors.split("add to result_new_columns: ")[1].splitlines()[0].split(", ")
    assert "objects.robots" in proposed
    for column in proposed:
        write_options(tmp_path, {**changes, "result_new_columns": [column], "objects.robots.nb": None})
        assert "no column" not in batch(tmp_path, "-r", "1").errors, column


def test_outputs_are_listed_and_chosen_by_name_or_path(tmp_path: Path) -> None:
    write_options(tmp_path, {"result_filename_format": "r{objects.robots.nb}.feather"})
    listed = batch(tmp_path, "--list-outputs")
    assert (listed.code, listed.text) == (0, "results/r2.feather\nresults/r3.feather\n")
    for name in ("r3.feather", "results/r3.feather", str(tmp_path / "results" / "r3.feather")):
        chosen = batch(tmp_path, "--only-output", name)
        assert (chosen.code, chosen.errors) == (0, "")
        assert list(results(tmp_path)) == ["r3.feather"]
    none = batch(tmp_path, "--only-output", "r4.feather")
    assert none.code == 1
    assert none.errors.count("\n") == 1


# ---- Joining ----


def run_file(path: Path, number: int, **columns: pa.Array) -> RunFile:
    table = pa.table({"time": pa.array(np.arange(3), pa.float32()), **columns})
    feather.write_feather(table.replace_schema_metadata({"configuration": "{}"}), str(path))
    return read_run(path, number, number)


def test_columns_that_only_some_runs_have_are_null_in_the_others(tmp_path: Path) -> None:
    first = run_file(tmp_path / "a", 0, heard=pa.array([1, 2, 3], pa.int8()))
    second = run_file(tmp_path / "b", 1, flag=pa.array([True, False, True]), heard=pa.array([7, 8, 900], pa.int32()))
    parts = [Part({"p": 1, "q": "x"}, [first]), Part({"p": 2.5, "q": 3, "r": True}, [second])]
    write_results(str(tmp_path / "out.feather"), parts, "a: 1\n")
    table = feather.read_table(tmp_path / "out.feather")
    assert [(field.name, str(field.type)) for field in table.schema] == [
        ("time", "float"),
        ("heard", "int32"),
        ("flag", "bool"),
        ("run", "int64"),
        ("p", "double"),
        ("q", "string"),
        ("r", "bool"),
    ]
    assert table["flag"].to_pylist() == [None] * 3 + [True, False, True]
    assert table["q"].to_pylist() == ["x"] * 3 + ["3"] * 3
    assert table["r"].to_pylist() == [None] * 3 + [True] * 3


def test_rows_are_written_in_pieces_of_one_size_however_the_runs_are_cut(tmp_path: Path) -> None:
    total = 2 * ROWS_PER_BATCH + 10
    cuts = {"whole": [total], "pieces": [7, ROWS_PER_BATCH, 3, ROWS_PER_BATCH]}
    for name, sizes in cuts.items():
        table = pa.table({"time": pa.array(np.arange(total), pa.float32())})
        with ipc.new_file(str(tmp_path / name), table.schema.with_metadata({"configuration": "{}"})) as writer:
            start = 0
            for size in sizes:
                writer.write_table(table.slice(start, size).replace_schema_metadata({"configuration": "{}"}))
                start += size
        write_results(str(tmp_path / f"{name}.out"), [Part({}, [read_run(tmp_path / name, 0, 0)])], "")
    assert (tmp_path / "whole.out").read_bytes() == (tmp_path / "pieces.out").read_bytes()
    with ipc.open_file(str(tmp_path / "whole.out")) as reader:
        rows = [reader.get_batch(i).num_rows for i in range(reader.num_record_batches)]
        assert rows == [ROWS_PER_BATCH, ROWS_PER_BATCH, 10]
        assert reader.read_all()["time"].to_pylist() == list(range(total))


def test_program_with_a_column_that_the_batch_adds_is_refused(program: Compile, tmp_path: Path) -> None:
    write_options(tmp_path, {"result_new_columns": ["objects.robots.nb", "flag"], "flag": 1})
    result = batch(tmp_path, program=program("columns.c"))
    assert result.code == 2
    (error,) = [line for line in result.errors.splitlines() if "warning of a run" not in line]
    assert "writes a column 'flag', and result_new_columns adds one of that name" in error


def test_disk_that_fills_up_is_one_line_and_leaves_no_half_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = run_file(tmp_path / "a", 0)
    out = tmp_path / "out.feather"
    write_results(str(out), [Part({}, [run])], "")
    before = out.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(BatchError, match=r"^cannot write .*out\.feather: No space left on device; free space, then"):
        write_results(str(out), [Part({}, [run])], "other")
    assert out.read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "out.feather"]


def test_tasks_and_rows_are_said_to_those_that_ask(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path).code == 0
    result = batch(tmp_path, "-v")
    assert result.output.splitlines()[1:] == [
        "Batch run completed. Generated output files:",
        " - results/result.feather",
    ]
    lines = [line.removeprefix("pogobatch: ") for line in result.errors.splitlines()]
    tasks = [line for line in lines if line.startswith(f"Task: Config file {tmp_path}/tmp/combo_")]
    assert [line.partition(".yaml ")[2] for line in tasks] == ["-> Output: results/result.feather"] * 2
    assert "Removed stale result file: results/result.feather" in lines
    assert "Created results/result.feather with 55 rows (22, 33)" in lines


def test_earlier_results_stay_until_a_run_has_ended_well(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path).code == 0
    before = (tmp_path / "results" / "result.feather").read_bytes()
    write_options(tmp_path, {"arena_file": "arenas/dsik.csv"})
    result = batch(tmp_path, "-R", "0")
    assert result.code == 3
    assert result.output.endswith("Batch run ended without an output file.\n")
    assert (tmp_path / "results" / "result.feather").read_bytes() == before
    write_options(tmp_path, {"simulation_time": 0.5})
    assert batch(tmp_path).output.count("results/result.feather") == 1
    assert len((tmp_path / "results" / "result.feather").read_bytes()) < len(before)
