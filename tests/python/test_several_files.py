"""Several data files are read as one table, with what distinguishes their runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import yaml
from batches import batch, write_options
from pogosim.analysis.trajectories import trajectories_of
from pogosim.picture.swarm import read_recording
from pogosim.several_files import natural_order
from pogosim.utils import load_dataframe
from pyarrow import feather

SQUARE = "- [{x: 0, y: 0}, {x: 10, y: 0}, {x: 10, y: 10}]\n"


def write(path: Path, configuration: dict[str, object], rows: int = 2, polygons: str = SQUARE) -> Path:
    """Write a data file as a run does."""
    table = pa.table({"time": pa.array(np.arange(rows), pa.float32()), "robot_id": pa.array([0] * rows, pa.int32())})
    metadata = {"configuration": yaml.safe_dump(configuration), "arena_polygons": polygons, "program_version": "v1"}
    feather.write_feather(table.replace_schema_metadata(metadata), str(path))
    return path


def world(seed: int, **robots: object) -> dict[str, object]:
    return {"seed": seed, "data_filename": f"{seed}.feather", "objects": {"robots": {"type": "pogobot", **robots}}}


def test_files_of_a_pattern_get_columns_with_number_seed_and_varied_parameters(tmp_path: Path) -> None:
    for seed in (2, 10):
        write(tmp_path / f"{seed}.feather", world(seed, nb=seed * 5, radius=26.5))
    rows, metadata = load_dataframe(tmp_path / "*.feather")
    assert list(rows.columns) == ["time", "robot_id", "run", "seed", "objects.robots.nb"]
    assert rows[["run", "seed", "objects.robots.nb"]].to_numpy().tolist() == [[0, 2, 10]] * 2 + [[1, 10, 50]] * 2
    assert rows.index.tolist() == [0, 1, 2, 3]
    assert metadata["files"] == [str(tmp_path / "2.feather"), str(tmp_path / "10.feather")]
    assert metadata["configuration"] == {"objects": {"robots": {"type": "pogobot", "radius": 26.5}}}
    assert metadata["program_version"] == "v1"
    assert [polygon.shape for polygon in metadata["arena_polygons"]] == [(3, 2)]


def test_files_of_a_list_keep_its_order_and_keys_that_some_lack_are_null(tmp_path: Path) -> None:
    first = write(tmp_path / "a.feather", world(1, nb=3, poses=[[1, 2]]))
    second = write(tmp_path / "b.feather", world(1, nb=3), polygons="[]")
    rows, metadata = load_dataframe([second, str(first)])
    assert rows["objects.robots.poses"].tolist()[2:] == ["[[1, 2]]"] * 2
    assert rows["objects.robots.poses"].isna().tolist() == [True, True, False, False]
    assert "arena_polygons" not in metadata
    assert load_dataframe([first])[0]["seed"].tolist() == [1, 1]


def test_copies_of_a_run_are_told(tmp_path: Path) -> None:
    write(tmp_path / "1.feather", world(1))
    write(tmp_path / "2.feather", world(2))
    write(tmp_path / "1.5.feather", world(3), rows=3)  # a name of another run, of another seed
    load_dataframe(tmp_path / "*.feather")
    write(tmp_path / "1.1.feather", world(1), rows=3)
    with pytest.warns(RuntimeWarning, match=r"1\.feather and .*1\.1\.feather are of the same seed.*one was kept"):
        load_dataframe([tmp_path / "1.feather", tmp_path / "1.1.feather"])
    write(tmp_path / "copy.feather", world(2))
    with pytest.warns(RuntimeWarning, match=r"2\.feather and .*copy\.feather .* hold the same rows"):
        load_dataframe([tmp_path / "2.feather", tmp_path / "copy.feather"])


def test_file_whose_name_looks_like_a_pattern_is_that_file(tmp_path: Path) -> None:
    write(tmp_path / "[1].feather", world(7))
    write(tmp_path / "1.feather", world(8))
    assert load_dataframe(tmp_path / "[1].feather")[1]["configuration"]["seed"] == 7


def test_pattern_without_a_file_and_an_empty_list_are_errors(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no file fits the pattern '.*\*\.feather'"):
        load_dataframe(tmp_path / "*.feather")
    with pytest.raises(ValueError, match="the list is empty"):
        load_dataframe([])


def test_attributes_of_the_dataframe_are_the_metadata_and_survive_pandas(tmp_path: Path) -> None:
    path = write(tmp_path / "a.feather", world(1))
    rows, metadata = load_dataframe(path)
    assert rows.attrs["configuration"] == metadata["configuration"]
    assert rows.attrs["arena_polygons"] == [[[0, 0], [10, 0], [10, 10]]]
    joined = pd.concat([rows, load_dataframe(path)[0]])
    assert joined[joined["time"] > 0].attrs["program_version"] == "v1"
    rows.to_parquet(tmp_path / "a.parquet")
    metadata["configuration"]["seed"] = 2
    assert rows.attrs["configuration"]["seed"] == 1


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["10", "9", "1"], ["1", "9", "10"]),
        (["b2", "b10", "a3"], ["a3", "b2", "b10"]),
        (["x1y10", "x1y9", "x01y1"], ["x01y1", "x1y9", "x1y10"]),
    ],
)
def test_numbers_in_names_sort_by_value(names: list[str], expected: list[str]) -> None:
    assert sorted(names, key=natural_order) == expected


def write_batch(
    path: Path, seeds: list[list[int]] | None = None, failed: list[int] | None = None, **more: object
) -> Path:
    """Write the results of a batch of two runs for each list of seeds (None: one list, seeds are run numbers)."""
    failed = failed or []
    runs = [run for run in range(2 + len(failed)) if run not in failed]
    entries: list[dict[str, object]] = [
        {"columns": {}, "runs": 2, "rows": 4, "failed_runs": failed, **({"seeds": own} if own else {})}
        for own in seeds or [[]]
    ]
    table = pa.table(
        {
            "time": [0.0, 1.0] * 2 * len(entries),
            "robot_id": pa.array([0] * 4 * len(entries), pa.int32()),
            "x": [1.0, 2.0, 3.0, 4.0] * len(entries),
            "y": [1.0] * 4 * len(entries),
            "run": pa.array(np.repeat(runs, 2).tolist() * len(entries), pa.int64()),
        }
    )
    metadata = {"program_version": "v1", "configuration": yaml.safe_dump({"seed": 7, **more})}
    feather.write_feather(
        table.replace_schema_metadata({**metadata, "combinations": yaml.safe_dump(entries)}), str(path)
    )
    return path


def test_runs_of_batches_with_other_seeds_are_told_apart_by_their_seeds(tmp_path: Path) -> None:
    files = [write_batch(tmp_path / f"{first}.feather", [[first, first + 1]]) for first in (10, 20)]
    rows, metadata = load_dataframe(files)
    assert rows[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[0, 10], [1, 11], [0, 20], [1, 21]]
    assert rows["seed"].dtype == np.int64
    runs = trajectories_of(rows, metadata)
    assert [own.labels for own in runs] == [{"run": run, "seed": run + first} for run in (0, 1) for first in (10, 20)]
    assert all(own.position_mm.shape == (2, 1, 2) for own in runs)


def test_runs_of_a_batch_have_the_seeds_of_their_combination(tmp_path: Path) -> None:
    first = write_batch(tmp_path / "a.feather", [[1, 2], [3, 4]], more=1)
    second = write_batch(tmp_path / "b.feather", failed=[1])
    rows, _ = load_dataframe([first, second])
    assert rows["seed"].tolist() == [1, 1, 2, 2, 3, 3, 4, 4, 0, 0, 2, 2]


def test_runs_that_nothing_tells_apart_are_said(tmp_path: Path) -> None:
    files = [write_batch(tmp_path / f"{name}.feather") for name in "ab"]
    with pytest.warns(
        RuntimeWarning, match=r"a\.feather and .*b\.feather have runs of the same number, seed and"
    ) as said:
        load_dataframe(files)
    assert len(said) == 1
    load_dataframe([files[0], write_batch(tmp_path / "c.feather", time_step=0.1)])  # a parameter tells them apart


def test_picture_of_several_batches_draws_one_run(tmp_path: Path) -> None:
    for first in (10, 20):
        write_batch(tmp_path / f"{first}.feather", [[first, first + 1]])
    recording = read_recording(str(tmp_path / "*.feather"))
    assert recording.last.rows["x"].tolist() == [1.0, 2.0]
    assert "that of seed 10 is drawn" in recording.left_out


def test_batches_with_seeds_from_their_configurations_are_independent_samples(tmp_path: Path) -> None:
    for seed in (1, 2):
        write_options(tmp_path / str(seed), {"seed": seed, "objects.robots.nb": 2})
        assert batch(tmp_path / str(seed), "-r", "2", "--seed-from", "config").code == 0
    rows, metadata = load_dataframe(str(tmp_path / "*" / "results" / "*.feather"))
    runs = trajectories_of(rows, metadata)
    assert len(runs) == 4
    assert len({own.labels["seed"] for own in runs}) == 4
