"""What became of the runs of a batch, and what its results say of them."""

from __future__ import annotations

import fcntl
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from pogosim.batch.configurations.combinations import combinations_of
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.errors import BatchError
from pogosim.batch.execution import Execution
from pogosim.batch.result_files.parts import Part
from pogosim.batch.result_files.results import replacement, write_results
from pogosim.batch.runs.run import Outcome, RunSettings, Task
from pogosim.batch.runs.run_data import read_run
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.tasks import Combination
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.utils import load_dataframe
from pyarrow import feather


def task(folder: Path, key: str, run: int = 0) -> Task:
    """Return a run whose data file would be in a folder."""
    temporary = TemporaryFolder(folder, "b", is_kept=False)
    temporary.done.mkdir(exist_ok=True)
    settings = RunSettings(Path("/p"), "", folder, temporary, RunPolicy(retries=0))
    return Task(key, run, run, "", (("data_filename", "d"),), settings)


def write_data(path: Path, *columns: str) -> Path:
    """Write the data file of a run."""
    table = pa.table({name: pa.array([1.0]) for name in ("time", *columns)})
    feather.write_feather(table.replace_schema_metadata({"configuration": "{}"}), str(path))
    return path


def take(execution: Execution, *outcomes: Outcome) -> None:
    """Let an execution take some outcomes."""

    def ended() -> Generator[Outcome, None, None]:
        yield from outcomes

    execution.take(ended(), len(outcomes))


def execution_of(folder: Path, combinations: list[Combination]) -> Execution:
    """Return the execution of combinations of an empty configuration."""
    path = folder / "many.yaml"
    path.write_text("{}")
    return Execution(combinations, "program", Configuration(path))


# ---- Runs ----


def test_failures_are_in_order_and_a_shared_run_is_one_of_the_first_combination(tmp_path: Path) -> None:
    shared, second, third = (task(tmp_path, key, run) for key, run in (("s", 0), ("b", 2), ("a", 1)))
    execution = execution_of(
        tmp_path, [Combination("x", {}, {}, [shared]), Combination("y", {}, {}, [shared, third, second])]
    )
    assert list(execution.tasks) == ["s", "a", "b"]
    take(execution, *(Outcome(key, "exit code 3", simulator_s=2.0) for key in ("b", "a", "s")))
    found = [(failure.output, failure.task.key) for failure in execution.failures]
    assert found == [("x", "s"), ("y", "a"), ("y", "b")]
    assert execution.simulator_s == 6.0


def test_warnings_of_runs_are_shown_once_and_those_of_failed_ones_are_in_their_logs(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    tasks = [task(tmp_path, key) for key in "abc"]
    first, second = (read_run(write_data(tmp_path / f"{key}.feather"), 0, 0) for key in "ab")
    execution = execution_of(tmp_path, [Combination("x", {}, {}, tasks)])
    failed = Outcome("c", "exit code 3", log="other")
    take(execution, Outcome("a", log="w\nv", file=first), Outcome("b", log="v", file=second), failed)
    assert caplog.messages == ["warning of a run: w", "warning of a run: v"]


def test_failure_that_all_runs_would_have_ends_the_batch(tmp_path: Path) -> None:
    execution = execution_of(tmp_path, [Combination("x", {}, {}, [task(tmp_path, "a", 4)])])
    with pytest.raises(BatchError, match="run 4 with seed 4: full"):
        take(execution, Outcome("a", "full", is_fatal=True))


@pytest.mark.parametrize(("column", "constant"), [("run", "other"), ("p", "p")])
def test_columns_are_checked_of_runs_that_are_done_and_of_those_that_end(
    column: str, constant: str, tmp_path: Path
) -> None:
    runs = [task(tmp_path, key) for key in "ab"]
    execution = execution_of(tmp_path, [Combination("x", {constant: 1}, {}, runs)])
    write_data(runs[0].result_of(0))
    assert execution.waiting() == [runs[1]]
    file = read_run(write_data(runs[1].result_of(0), column), 0, 0)
    with pytest.raises(BatchError, match=f"program writes a column '{column}'"):
        take(execution, Outcome("b", file=file))
    with pytest.raises(BatchError, match=f"program writes a column '{column}'"):
        execution_of(tmp_path, [Combination("x", {constant: 1}, {}, runs)]).waiting()


# ---- Results ----


@pytest.mark.parametrize(("seeds", "shown"), [((0, 1), None), ((0, 7), [0, 7])])
def test_seeds_are_in_the_results_only_if_they_are_not_the_numbers_of_the_runs(
    seeds: tuple[int, ...], shown: list[int] | None, tmp_path: Path
) -> None:
    runs = [read_run(write_data(tmp_path / str(run)), run, seed) for run, seed in enumerate(seeds)]
    write_results(str(tmp_path / "out.feather"), [Part({"p": 1}, runs, failed=[2])], "")
    (combination,) = load_dataframe(tmp_path / "out.feather")[1]["combinations"]
    assert combination.get("seeds") == shown
    assert (combination["runs"], combination["rows"], combination["failed_runs"]) == (2, 2, [2])


def test_two_batches_do_not_write_one_file_at_once(tmp_path: Path) -> None:
    path = tmp_path / "out.feather"
    runs = [read_run(write_data(tmp_path / "a"), 0, 0)]
    with replacement(path) as file:
        with pytest.raises(BatchError, match=r"out\.feather is being written by another batch; wait for it"):
            write_results(str(path), [Part({}, runs)], "")
        file.write(b"first")
    assert path.read_bytes() == b"first"
    path.unlink()
    write_results(str(path), [Part({}, runs)], "")
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a", "out.feather"]


def test_file_that_another_batch_has_just_finished_is_not_written_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "out.feather"
    lock = fcntl.flock

    def finish_first(file: Any, how: int) -> None:
        (tmp_path / ".out.feather.pogobatch-new").replace(path)
        lock(file, how)

    monkeypatch.setattr("fcntl.flock", finish_first)
    with pytest.raises(BatchError, match=r"out\.feather has just been written by another batch"), replacement(path):
        pass
    assert path.read_bytes() == b""


# ---- Configurations ----


def read(folder: Path, text: str) -> Configuration:
    """Read a configuration."""
    path = folder / "many.yaml"
    path.write_text(text)
    return Configuration(path)


def test_merged_maps_lie_under_the_own_keys_of_a_map_and_warn_of_nothing(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    text = """
        base: &base {radius: 1, nb: 2}
        more: &more {nb: 5, mass: {batch_options: [3, 4]}}
        objects:
            robots: {<<: *base, nb: 7}
            lamps: {nb: 8, <<: *base, <<: *more}
    """
    configuration = read(tmp_path, text)
    assert [combination["objects"] for combination in combinations_of(configuration.entries)] == [
        {"robots": {"radius": 1, "nb": 7}, "lamps": {"radius": 1, "nb": 8, "mass": mass}} for mass in (3, 4) * 2
    ]
    assert caplog.messages == []


def test_categories_of_one_name_are_many_in_alternatives_too(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    text = """
        objects:
            robots: {nb: 1, nb: 2}
            batch_hierarchical_options:
                two: {lamp: {x: 1}, lamp: {x: 2}}
                three: {lamp: [{x: 1}, {x: 2}], lamp: {x: 3}}
        parameters: {batch_hierarchical_options: {one: {lamp: 1, lamp: 2}}}
    """
    combinations = combinations_of(read(tmp_path, text).entries)
    assert [combination["objects"]["lamp"] for combination in combinations] == [
        [{"x": 1}, {"x": 2}],
        [{"x": 1}, {"x": 2}, {"x": 3}],
    ]
    assert combinations[0]["parameters"] == {"lamp": 2}
    assert combinations[0]["objects"]["robots"] == {"nb": 2}
    *others, message = sorted(caplog.messages)
    assert len(others) == 1
    assert message.endswith("many.yaml:7: duplicate key 'lamp'; the last one is used")


def test_alternatives_may_be_merged_maps(tmp_path: Path) -> None:
    text = """
        low: &low {nb: 1}
        objects: {robots: {batch_hierarchical_options: {a: *low, b: {<<: *low, law: x}}}}
    """
    combinations = combinations_of(read(tmp_path, text).entries)
    assert [combination["objects"]["robots"] for combination in combinations] == [{"nb": 1}, {"nb": 1, "law": "x"}]
