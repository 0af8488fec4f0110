"""Runs that are started one by one, each in a folder of its own, and merged into files of results."""

from __future__ import annotations

import contextlib
import json
import operator
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import tracemalloc
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from batches import COMMAND, ENVIRONMENT, results, run_main, script, subcommand, write_options
from pogosim.batch.completeness import less
from pogosim.batch.result_files.run_counts import RunCounts, gaps
from pogosim.pogobatch import PogobatchError, TaskError, discover_task_artifacts, execute_task, merge_task_artifacts
from pogosim.utils import load_dataframe
from pyarrow import feather
from running import ROOT, Run, example
from yaml import safe_load

PROGRAM = str(example("helloworld"))
MOST = 2**63 - 1


def task(folder: Path, seed: int, *more: str, into: str | None = None) -> Run:
    """Do one run of many.yaml."""
    return subcommand(folder, "task", "--seed", str(seed), *more, folder_of=into or f"tasks/{seed}")


def merge(folder: Path, *words: str, into: str = "results") -> Run:
    """Merge runs in a folder."""
    return run_main(folder, ["merge", *words, "-o", into])


def manifest_of(folder: Path) -> dict[str, Any]:
    """Return the manifest of a run."""
    entries: dict[str, Any] = json.loads((folder / "pogobatch_task.json").read_text())
    return entries


def change(folder: Path, **entries: Any) -> None:
    """Change entries of the manifest of a run; None takes one out."""
    kept = {**manifest_of(folder), **entries}
    text = json.dumps({name: value for name, value in kept.items() if value is not None})
    (folder / "pogobatch_task.json").write_text(text)


def test_task_is_a_run_with_the_defaults_in_a_folder_of_its_own(tmp_path: Path) -> None:
    write_options(tmp_path, {"_rundr": {"seeds": 9}})
    result = task(tmp_path, 7, "--run-index", "2", "--retry-attempt", "1", "--json")
    folder = tmp_path / "tasks" / "7"
    assert sorted(path.name for path in folder.iterdir()) == [
        *("frames", "log.txt", "pogobatch_effective.yaml", "pogobatch_task.json")
    ]
    effective = safe_load((folder / "pogobatch_effective.yaml").read_text())
    assert effective["objects"]["robots"]["nb"] == 3
    assert not {"pogobatch", "_rundr"} & set(effective)
    told = json.loads(result.output)
    manifest = manifest_of(folder)
    assert told == {
        "operation": "task",
        "ok": True,
        "config": "many.yaml",
        "output_dir": "tasks/7",
        **manifest,
    }
    expected = {
        "schema_version": 2,
        "seed": 7,
        "logical_run": 2,
        "retry_attempt": 1,
        "combination_ordinal": 0,
        "result_filename": "result.feather",
        "extra_columns": {"objects.robots.nb": 3, "arena_file": "disk"},
        "batch_choices": {},
        "data_file": "frames/data.feather",
    }
    assert {name: manifest[name] for name in expected} == expected
    assert len(manifest["config_hash"]) == 64
    assert len(load_dataframe(folder / "frames" / "data.feather")[0]) == 33
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "tasks"]


def test_failed_task_leaves_its_log_and_no_manifest(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 7).code == 0
    broken = script(tmp_path / "broken", "echo last words; exit 3")
    result = subcommand(tmp_path, "task", "--seed", "7", "--json", folder_of="tasks/7", program=broken)
    assert result.code == 3
    entries = json.loads(result.output)
    assert (entries["ok"], entries["error"]) == (False, "the run with seed 7 failed: exit code 3: last words")
    left = sorted(path.name for path in (tmp_path / "tasks" / "7").iterdir())
    assert left == ["frames", "log.txt", "pogobatch_effective.yaml"]
    assert not any((tmp_path / "tasks" / "7" / "frames").iterdir())
    with pytest.raises(TaskError, match="exit code 3"):
        execute_task(tmp_path / "many.yaml", broken, seed=1, output_dir=tmp_path / "api")


def test_folder_with_another_run_is_refused_and_stays_as_it_is(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 7, into="one").code == 0
    before = {path: path.read_bytes() for path in (tmp_path / "one").rglob("*") if path.is_file()}
    refused = task(tmp_path, 9, into="one")
    assert (refused.code, refused.errors) == (
        2,
        "pogobatch task: one has another run already, with the seed 7, not 9; choose another folder with -o, or "
        "replace that run with --force\n",
    )
    write_options(tmp_path, {"objects.robots.nb": 5})
    other = task(tmp_path, 7, into="one")
    assert (other.code, "with the extra columns {" in other.errors) == (2, True), other.errors
    assert {path: path.read_bytes() for path in (tmp_path / "one").rglob("*") if path.is_file()} == before
    with pytest.raises(PogobatchError, match="has another run already"):
        execute_task(tmp_path / "many.yaml", PROGRAM, seed=9, output_dir=tmp_path / "one")
    # The same run is done again, also with a configuration that has been corrected.
    write_options(tmp_path, {"simulation_time": 0.5})
    assert task(tmp_path, 7, "--run-index", "1", into="one").code == 0
    assert manifest_of(tmp_path / "one")["logical_run"] == 1
    assert task(tmp_path, 9, "--force", into="one").code == 0
    assert manifest_of(tmp_path / "one")["seed"] == 9
    change(tmp_path / "one", schema_version=99)
    assert task(tmp_path, 3, into="one").code == 0


@pytest.mark.parametrize(
    ("changes", "options", "said"),
    [
        (
            {"objects.robots.nb": {"batch_options": [2, 3]}},
            [],
            "objects.robots.nb: has batch_options and no default_option, which a single run takes; add it",
        ),
        ({"enable_data_logging": False}, [], "enable_data_logging: is false"),
        ({"result_filename_format": "{x}.feather"}, [], "result_filename_format: there is no key 'x'"),
        ({}, ["--seed", "4294967296"], "--seed: expected whole numbers from 0 to 4294967295; found 4294967296"),
        ({}, ["--run-index", "-1"], f"--run-index: expected a whole number from 0 to {MOST}; found -1"),
        (
            {},
            ["--run-index", str(MOST + 1)],
            f"--run-index: expected a whole number from 0 to {MOST}; found {MOST + 1}",
        ),
        ({}, ["--retry-attempt", "-1"], f"--retry-attempt: expected a whole number from 0 to {MOST}; found -1"),
        ({}, ["--retry-attempt", "1" * 20], f"--retry-attempt: expected a whole number from 0 to {MOST}; found 111"),
        ({}, ["-S", "/bin/ls"], "/bin/ls is not a simulator"),
        ({}, ["-o", "many.yaml"], "cannot use many.yaml"),
        ({}, ["-c", "none.yaml"], "cannot read the configuration none.yaml"),
    ],
)
def test_task_that_cannot_be_done_is_one_line(
    changes: dict[str, object], options: list[str], said: str, tmp_path: Path
) -> None:
    write_options(tmp_path, changes)
    result = task(tmp_path, 1, *options)
    assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
    assert said in result.errors
    assert not (tmp_path / "tasks" / "1" / "pogobatch_task.json").exists()


def test_greatest_number_of_a_run_can_be_merged(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 7, "--run-index", str(MOST), "--retry-attempt", str(MOST)).code == 0
    assert merge(tmp_path, "tasks").code == 0
    (name,) = results(tmp_path)
    assert set(load_dataframe(tmp_path / "results" / name)[0]["run"]) == {MOST}


def test_columns_of_a_manifest_that_say_which_run_it_is_are_left_out_with_a_warning(tmp_path: Path) -> None:
    write_options(tmp_path)
    for seed in (7, 8):
        assert task(tmp_path, seed, "--run-index", str(seed)).code == 0
    assert merge(tmp_path, "tasks").errors == ""
    expected = results(tmp_path)
    own = manifest_of(tmp_path / "tasks" / "7")["extra_columns"]
    change(tmp_path / "tasks" / "7", extra_columns={**own, "run": 7, "seed": 7, "retry_attempt": 0})
    assert merge(tmp_path, "tasks").errors == ""  # nothing is lost
    change(tmp_path / "tasks" / "7", extra_columns={**own, "run": "a", "seed": 8})
    change(tmp_path / "tasks" / "8", extra_columns={**own, "retry_attempt": 5})
    merged = merge(tmp_path, "tasks")
    assert (merged.code, merged.errors.count("\n")) == (0, 1)
    assert merged.errors.endswith(
        "tasks/7/pogobatch_task.json: extra_columns: left out: run, seed, and those of 1 more manifest; columns of "
        "results with these names say which run a row is of\n"
    )
    assert results(tmp_path) == expected


def test_refused_value_is_named_with_the_line_of_the_user(tmp_path: Path) -> None:
    text = write_options(tmp_path, {"objects.robots.nb": "many"}).read_text()
    line = text.splitlines().index("    nb: many") + 1
    result = task(tmp_path, 1)
    assert result.code == 3
    assert f"Error: many.yaml:{line}: objects.robots.nb: expected an integer" in result.errors


def test_kept_runs_merged_are_the_bytes_of_the_batch(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert subcommand(tmp_path, "run", "--seeds", "3:5", "--keep-temp").code == 0
    result = merge(tmp_path, "tmp", "-c", "many.yaml", into="merged")
    assert (result.code, result.errors) == (0, "")
    assert result.output.splitlines() == ["6 runs merged. Generated output files:", " - merged/result.feather"]
    assert (tmp_path / "merged" / "result.feather").read_bytes() == results(tmp_path)["result.feather"]


def test_tasks_are_merged_whatever_their_order_and_depth(tmp_path: Path) -> None:
    write_options(tmp_path, {"result_filename_format": "of_{objects.robots.nb}.feather"})
    for run, seed in enumerate((8, 7, 9)):
        assert task(tmp_path, seed, "--run-index", str(run), into=f"tasks/{'deep/' * run}{seed}").code == 0
    assert merge(tmp_path, "tasks", into="a").code == 0
    paths = [str(path) for path in sorted((tmp_path / "tasks").rglob("pogobatch_task.json"), reverse=True)]
    report = json.loads(merge(tmp_path, *paths, "--json", into="b").output)
    assert (report["operation"], report["ok"], report["task_count"]) == ("merge", True, 3)
    assert report["outputs"] == ["b/of_3.feather"]
    rows, metadata = load_dataframe(tmp_path / "a" / "of_3.feather")
    assert (tmp_path / "b" / "of_3.feather").read_bytes() == (tmp_path / "a" / "of_3.feather").read_bytes()
    assert rows[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[0, 8], [1, 7], [2, 9]]
    assert metadata["combinations"][0]["seeds"] == [8, 7, 9]
    assert metadata["configuration"]["objects"]["robots"]["nb"] == 3
    assert json.loads(metadata["pogobatch_manifest"])["task_count"] == 3


def test_runs_are_appended_to_results_that_are_there(tmp_path: Path) -> None:
    write_options(tmp_path)
    for seed in (4, 5):
        assert task(tmp_path, seed, "--run-index", str(seed)).code == 0
    assert merge(tmp_path, "tasks/4").code == 0
    assert merge(tmp_path, "tasks/5", "--append").code == 0
    appended, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert appended[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[4, 4], [5, 5]]
    assert [entry["seeds"] for entry in metadata["combinations"]] == [[4], [5]]
    assert json.loads(metadata["pogobatch_manifest"])["task_count"] == 2
    assert merge(tmp_path, "tasks/5").code == 0
    replaced, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert set(replaced["seed"]) == {5}


def test_other_seeds_of_one_configuration_are_merged_in_one_call_or_in_two(tmp_path: Path) -> None:
    write_options(tmp_path)
    for first, last in ((0, 1), (2, 3)):
        seeds = ("--seeds", f"{first}:{last}", "--keep-temp", "-t", f"kept{first}")
        assert subcommand(tmp_path, "run", *seeds, folder_of=f"own{first}").code == 0
    assert merge(tmp_path, "kept0", "kept2").code == 0
    assert merge(tmp_path, "kept2", "kept0", into="again").code == 0
    assert (tmp_path / "again" / "result.feather").read_bytes() == results(tmp_path)["result.feather"]
    assert merge(tmp_path, "kept0", into="two").code == 0
    assert merge(tmp_path, "kept2", "--append", into="two").code == 0
    for folder in ("results", "two"):
        rows, metadata = load_dataframe(tmp_path / folder / "result.feather")
        runs = rows[["objects.robots.nb", "run", "seed"]].drop_duplicates()
        assert sorted(map(tuple, runs.to_numpy().tolist())) == [(nb, seed, seed) for nb in (2, 3) for seed in range(4)]
        listed = [(entry.get("run_numbers", [0, 1]), entry.get("seeds", [0, 1])) for entry in metadata["combinations"]]
        mixed = [0, 2, 1, 3]  # by the number that they had
        one_by_one = [([0, 1], [0, 1])] * 2 + [([2, 3], [2, 3])] * 2
        assert listed == ([(mixed, mixed)] * 2 if folder == "results" else one_by_one)


def test_combinations_have_the_order_of_their_batch(tmp_path: Path) -> None:
    write_options(tmp_path)
    for seed in (1, 2):
        assert task(tmp_path, seed).code == 0
    for digests in (("a", "b"), ("b", "a")):
        for seed, digest in zip((1, 2), digests, strict=True):
            change(tmp_path / "tasks" / str(seed), combination_ordinal=2 - seed, config_hash=digest)
        assert merge(tmp_path, "tasks").code == 0
        _, metadata = load_dataframe(tmp_path / "results" / "result.feather")
        assert [entry["seeds"] for entry in metadata["combinations"]] == [[2], [1]]


def test_rows_of_a_batch_stay_when_tasks_are_appended(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert subcommand(tmp_path, "run", "--seeds", "3:4").code == 0
    before, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert task(tmp_path, 9, "--run-index", "2").code == 0
    assert merge(tmp_path, "tasks", "--append", "-c", "many.yaml").code == 0
    after, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert list(after.columns) == list(before.columns)
    assert after[: len(before)].equals(before)
    assert len(metadata["combinations"]) == 3
    assert "batch_options" in str(metadata["configuration"])


def kept(folder: Path, runs: int, into: str, changes: dict[str, object] | None = None) -> None:
    """Do a batch of many.yaml, whose runs stay in a folder."""
    write_options(folder, changes)
    assert subcommand(folder, "run", "-r", str(runs), "-t", into, "--keep-temp").code == 0


def folder_of(folder: Path, run: int, nb: int) -> Path:
    """Return the folder of a run that was kept."""
    manifests = [path.parent for path in folder.rglob("pogobatch_task.json")]
    (found,) = [
        path
        for path in manifests
        if (entries := manifest_of(path))["logical_run"] == run and entries["batch_choices"]["objects.robots.nb"] == nb
    ]
    return found


def test_runs_of_another_world_are_told_where_metadata_and_columns_do_not_tell_them(tmp_path: Path) -> None:
    kept(tmp_path, 2, "small")
    other: dict[str, object] = {"arena_surface": 2.0e6, "simulation_time": 0.5}
    kept(tmp_path, 2, "large", other)
    result = merge(tmp_path, "small", "large", "-c", "many.yaml")
    assert result.code == 0
    others, alike = result.errors.splitlines()
    assert others.startswith("pogobatch merge: many.yaml: 4 of 8 runs are of other configurations, the first in small/")
    assert others.endswith(
        ", which differs in arena_surface, simulation_time; the metadata of the results will not say so: merge these "
        "apart, with their own configuration"
    )
    assert alike.startswith("pogobatch merge: results/result.feather: no column tells apart its runs, which differ in ")
    assert set(alike.partition("differ in ")[2].split(", ")) == {"arena_surface", "simulation_time"}
    # Without -c, the configuration is that of the first run.
    assert merge(tmp_path, "small", "large").errors == f"{alike}\n"
    assert merge(tmp_path, "large", "-c", "many.yaml").errors == ""


def test_results_to_which_runs_of_another_world_are_appended_are_named(tmp_path: Path) -> None:
    kept(tmp_path, 1, "small")
    write_options(tmp_path, {"arena_surface": 2.0e6})
    assert task(tmp_path, 8, into="large").code == 0
    assert merge(tmp_path, "small").errors == ""
    result = merge(tmp_path, "large", "--append")
    assert (result.code, result.errors) == (
        0,
        "pogobatch merge: results/result.feather: no column tells apart its runs, which differ in arena_surface\n",
    )


def test_columns_that_tell_worlds_apart_need_no_warning(tmp_path: Path) -> None:
    columns: dict[str, object] = {"result_new_columns": ["objects.robots.nb", "arena_surface"]}
    kept(tmp_path, 1, "small", columns)
    kept(tmp_path, 1, "large", {**columns, "arena_surface": 2.0e6})
    assert merge(tmp_path, "small", "large").errors == ""


def test_missing_runs_are_named(tmp_path: Path) -> None:
    kept(tmp_path, 3, "tmp", {"_rundr": {"seeds": 3}})
    shutil.rmtree(folder_of(tmp_path / "tmp", 1, 3))
    said = "1 of 6 runs is missing, the first: run 1 of results/result.feather, objects.robots.nb: 3"
    result = merge(tmp_path, "tmp", "-c", "many.yaml")
    assert (result.code, result.errors) == (0, f"pogobatch merge: {said}\n")
    # Others of its number are there, so it is known without a configuration, too.
    assert merge(tmp_path, "tmp").errors == f"pogobatch merge: {said}\n"
    missing = {"output": "results/result.feather", "logical_run": 1, "batch_choices": {"objects.robots.nb": 3}}
    missing["combination_ordinal"] = 1
    for options in (["-c", "many.yaml"], []):
        report = json.loads(merge(tmp_path, "tmp", *options, "--json").output)
        assert (report["ok"], report["missing"]) == (True, [missing])
    # The configuration tells of combinations of which there are no runs; manifests, how many there are.
    shutil.rmtree(folder_of(tmp_path / "tmp", 0, 3))
    shutil.rmtree(folder_of(tmp_path / "tmp", 2, 3))
    without = merge(tmp_path, "tmp").errors
    assert without == "pogobatch merge: 3 of 6 runs are missing, the first: runs 0, 1, 2 of combination 1\n"
    whole = merge(tmp_path, "tmp", "-c", "many.yaml").errors
    assert whole == "pogobatch merge: 3 of 6 runs are missing, the first: runs 0, 1, 2, objects.robots.nb: 3\n"
    shutil.rmtree(folder_of(tmp_path / "tmp", 2, 2))
    last = merge(tmp_path, "tmp", "-c", "many.yaml").errors
    assert "4 of 6 runs are missing, the first: run 2 of results/result.feather, objects.robots.nb: 2" in last
    assert merge(tmp_path, "tmp", "-c", "many.yaml", "--append", into="more").errors == ""


def test_runs_of_a_part_that_was_not_done_are_missing(tmp_path: Path) -> None:
    write_options(tmp_path)
    for part in range(4):
        words = ("--seeds", "3:7", "--part", f"{part}/5", "-t", f"jobs/{part}")
        assert subcommand(tmp_path, "run", *words).code == 0
    # Run 4 of both combinations, of which no other run has the number.
    said = "2 of 10 runs are missing, the first: run 4 of results/result.feather, objects.robots.nb: 2"
    assert merge(tmp_path, "jobs", "-c", "many.yaml").errors == f"pogobatch merge: {said}\n"
    assert merge(tmp_path, "jobs").errors == f"pogobatch merge: {said}\n"
    # Manifests of earlier versions do not say it.
    for path in (tmp_path / "jobs").rglob("pogobatch_task.json"):
        change(path.parent, batch_seeds=None, batch_combinations=None)
    assert merge(tmp_path, "jobs", "-c", "many.yaml").errors == ""


@pytest.mark.parametrize("then", [("1:4", [2, 3]), ("0:4", [2, 3, 4])])
def test_parts_of_batches_that_share_runs_miss_nothing(then: tuple[str, list[int]], tmp_path: Path) -> None:
    for seeds, numbers in (("0:2", [2, 3]), then):
        write_options(tmp_path, {"objects.robots.nb": {"batch_options": numbers}})
        for part in ("0/2", "1/2"):
            assert subcommand(tmp_path, "run", "--seeds", seeds, "--part", part, "-t", "jobs").code == 0
    assert merge(tmp_path, "jobs", "-c", "many.yaml").errors == ""
    assert merge(tmp_path, "jobs").errors == ""


def test_runs_with_replaced_seeds_are_there(tmp_path: Path) -> None:
    write_options(tmp_path)
    program = script(tmp_path / "fails", '[ "$seed" = 4 ] && exit 4')
    for part in range(2):
        words = ("--seeds", "3:6", "--part", f"{part}/2", "-t", f"jobs/{part}")
        assert subcommand(tmp_path, "run", *words, program=program).code == 0
    assert {manifest_of(path.parent)["seed"] for path in tmp_path.rglob("pogobatch_task.json")} == {3, 5, 6, 8}
    assert merge(tmp_path, "jobs", "-c", "many.yaml").errors == ""


@pytest.mark.parametrize("seeds", [3, "", "3", "0:99999999999"])
def test_manifest_with_seeds_of_a_batch_that_are_none_is_refused(seeds: object, tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    change(tmp_path / "tasks" / "4", batch_seeds=seeds)
    result = merge(tmp_path, "tasks")
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert "pogobatch_task.json: batch_seeds: expected " in result.errors


def test_missing_runs_of_one_of_two_batches_with_other_seeds_are_named(tmp_path: Path) -> None:
    write_options(tmp_path)
    for seeds in ("0:1", "2:3"):
        assert subcommand(tmp_path, "run", "--seeds", seeds, "-t", seeds.replace(":", "-"), "--keep-temp").code == 0
    assert merge(tmp_path, "0-1", "2-3", "-c", "many.yaml").errors == ""
    shutil.rmtree(folder_of(tmp_path / "2-3", 1, 3))
    result = merge(tmp_path, "0-1", "2-3", "-c", "many.yaml")
    said = "1 of 8 runs is missing, the first: run 1 of results/result.feather, objects.robots.nb: 3"
    assert (result.code, result.errors) == (0, f"pogobatch merge: {said}\n")


@pytest.mark.parametrize(
    ("entries", "count", "wanted"),
    [
        ({"logical_run": 2_000_000_000}, 2 * 2_000_000_001 - 2, 2 * 2_000_000_001),
        ({"logical_run": MOST, "batch_seeds": "0:9999999"}, 2 * (MOST + 1) - 2, 2 * (MOST + 1)),
    ],
)
def test_missing_runs_are_counted_however_many_they_are(
    entries: dict[str, Any], count: int, wanted: int, tmp_path: Path
) -> None:
    kept(tmp_path, 1, "tmp")
    change(folder_of(tmp_path / "tmp", 0, 2), **entries)
    tracemalloc.start()
    try:
        merged = merge(tmp_path, "tmp", "-c", "many.yaml", "--json", into="merged")
        assert tracemalloc.get_traced_memory()[1] < 2e7
    finally:
        tracemalloc.stop()
    assert (merged.code, (tmp_path / "merged" / "result.feather").exists()) == (0, True)
    said = (
        f"{count} of {wanted} runs are missing, the first: runs 0, 1, 2 of merged/result.feather, objects.robots.nb: 2"
    )
    assert merged.errors.startswith(f"pogobatch merge: {said}\n")
    report = json.loads(merged.output)
    assert (report["missing_count"], len(report["missing"])) == (count, 1000)
    assert [run["logical_run"] for run in report["missing"]] == list(range(1000))


def test_combinations_without_runs_are_counted_however_many_they_are(tmp_path: Path) -> None:
    kept(tmp_path, 1, "tmp")
    change(folder_of(tmp_path / "tmp", 0, 2), batch_combinations=MOST)
    report = json.loads(merge(tmp_path, "tmp", "--json").output)
    assert (report["missing_count"], len(report["missing"])) == (MOST - 2, 1000)
    assert report["missing"][0]["combination_ordinal"] == 1


def test_results_are_there_even_if_missing_runs_cannot_be_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept(tmp_path, 1, "tmp")

    def out_of_memory(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("pogosim.batch.merging.missing_runs", out_of_memory)
    merged = merge(tmp_path, "tmp", "-c", "many.yaml", into="merged")
    assert (merged.code, (tmp_path / "merged" / "result.feather").exists()) == (2, True)


def test_counts_of_runs_are_those_of_counters() -> None:
    draws = random.Random(5)
    for _ in range(500):
        a, b = ([draws.randrange(8) for _ in range(draws.randrange(12))] for _ in range(2))
        first, second = (RunCounts.of((run, run + 1) for run in runs) for runs in (a, b))
        for by, expected in (
            (max, Counter(a) | Counter(b)),
            (operator.add, Counter(a) + Counter(b)),
            (less, Counter(a) - Counter(b)),
        ):
            found = first.joined(second, by)
            assert list(found.numbers()) == sorted(expected.elements())
            assert (found.total, found.end) == (expected.total(), max(expected, default=-1) + 1)
            assert found == RunCounts.of((run, run + 1) for run in expected.elements())
        taken = sorted((run, run + draws.randrange(1, 4)) for run in a)
        left = set(range(2, 9)) - {run for start, end in taken for run in range(start, end)}
        assert [run for start, end in gaps(range(2, 9), taken) for run in range(start, end)] == sorted(left)


def test_configuration_that_is_written_in_another_way_is_the_same(tmp_path: Path) -> None:
    (tmp_path / "conf" / "arenas").mkdir(parents=True)
    shutil.copy(ROOT / "arenas" / "disk.csv", tmp_path / "conf" / "arenas" / "mine.csv")
    path = write_options(tmp_path, {"arena_file": "arenas/mine.csv"})
    shutil.move(path, tmp_path / "conf" / "many.yaml")
    words = ["run", "-c", "conf/many.yaml", "-S", PROGRAM, "-r", "2", "-t", "tmp", "-o", "results", "--keep-temp"]
    assert run_main(tmp_path, words).code == 0
    for folder in (tmp_path / "tmp").glob("sim_*"):
        change(folder, config_hash="that of another program" if manifest_of(folder)["seed"] else None)
    text = (tmp_path / "conf" / "many.yaml").read_text()
    (tmp_path / "conf" / "many.yaml").write_text(f"# Mine\n{text}".replace("1000000.0", "1.0e6"))
    assert merge(tmp_path, "tmp", "-c", "conf/many.yaml").errors == ""


def test_run_that_would_count_twice_is_refused_and_results_stay(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    shutil.copytree(tmp_path / "tasks" / "4", tmp_path / "copy" / "4")
    twice = merge(tmp_path, "tasks", "copy")
    assert (twice.code, results(tmp_path)) == (2, {})
    assert "have the same seed, 4, of one configuration, which would count twice; leave one out" in twice.errors
    change(tmp_path / "copy" / "4", logical_run=1)
    assert "have the same seed, 4, of one configuration" in merge(tmp_path, "tasks", "copy").errors
    assert merge(tmp_path, "tasks").code == 0
    before = results(tmp_path)
    again = merge(tmp_path, "tasks", "--append")
    assert (again.code, results(tmp_path)) == (2, before)
    assert "results/result.feather has the run of tasks/4/frames/data.feather already, with seed 4" in again.errors


def test_manifests_of_the_first_version_can_be_read(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    change(tmp_path / "tasks" / "4", schema_version=1, task_uuid=None, config_hash=None, retry_attempt=None)
    assert merge(tmp_path, "tasks").code == 0
    assert set(load_dataframe(tmp_path / "results" / "result.feather")[0]["retry_attempt"]) == {0}


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"schema_version": 3}, "schema_version: expected 1 or 2, found 3"),
        ({"seed": "4"}, "seed: expected a whole number from 0 to 4294967295, found '4'"),
        ({"logical_run": True}, "logical_run: expected a whole number from 0 to 9223372036854775807, found True"),
        ({"data_file": None}, "data_file: expected a text, found nothing"),
        ({"data_file": "frames/none.feather"}, "cannot read tasks/4/frames/none.feather"),
        ({"data_file": "log.txt"}, "tasks/4/log.txt is damaged"),
        (
            {"result_filename": "../out.feather"},
            "result_filename: '../out.feather' is not in the folder of the results",
        ),
        ({"result_filename": "out.xyz"}, "result_filename: the format of 'out.xyz' is unknown"),
        ({"extra_columns": [1]}, "extra_columns: expected a map, found [1]"),
        ({"extra_columns": {"x": 5}}, "writes a column 'x'"),
        ({"extra_columns": {"a": "\ud800"}}, "extra_columns.a: expected text"),
        ({"extra_columns": {"a": 1 << 2000}}, "extra_columns.a: expected a number of at most 1024 bits"),
        ({"combination_ordinal": "x"}, "combination_ordinal: expected a whole number from 0 to 9223372036854775807"),
        ({"combination_ordinal": -1}, "combination_ordinal: expected a whole number from 0 to"),
        ({"retry_attempt": "x"}, "retry_attempt: expected a whole number from 0 to 9223372036854775807, found 'x'"),
        ({"retry_attempt": {}}, "retry_attempt: expected a whole number from 0"),
        ({"retry_attempt": 2**63}, "retry_attempt: expected a whole number from 0"),
        ({"logical_run": 2**63}, "logical_run: expected a whole number from 0"),
        ({"seed": 2**32}, "seed: expected a whole number from 0 to 4294967295, found 4294967296"),
        ({"seed": "4\n5"}, r"seed: expected a whole number from 0 to 4294967295, found '4\n5'"),
        ({"schema_version": True}, "schema_version: expected 1 or 2, found True"),
        ({"config_hash": 5}, "config_hash: expected a text, found 5"),
        ({"result_filename": "\ud800.feather"}, "result_filename: expected a text"),
        ({"data_file": "a\0b"}, "data_file: expected a text"),
        ({"data_file": "a\nb"}, r"cannot read tasks/4/a\nb: No such file or directory"),
        ({"data_file": "pipe"}, "tasks/4/pipe cannot be read: it is not a file"),
    ],
)
def test_wrong_manifest_is_one_line_and_nothing_is_written(entries: dict[str, Any], said: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    os.mkfifo(tmp_path / "tasks" / "4" / "pipe")
    change(tmp_path / "tasks" / "4", **entries)
    result = merge(tmp_path, "tasks")
    assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
    assert said in result.errors
    assert results(tmp_path) == {}
    assert not (tmp_path / "out.feather").exists()


def test_number_beyond_all_others_is_a_text_in_a_column(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    change(tmp_path / "tasks" / "4", extra_columns={"a": 2**1024 - 1, "b": 2**64})
    assert merge(tmp_path, "tasks").code == 0
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert (set(rows["a"]), set(rows["b"])) == ({str(2**1024 - 1)}, {2.0**64})


def test_pipe_in_the_place_of_a_manifest_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    os.mkfifo(tmp_path / "one" / "pogobatch_task.json")
    for place in ("one", "one/pogobatch_task.json"):
        result = merge(tmp_path, place)
        assert result.code == 2
        assert result.errors.endswith("one/pogobatch_task.json cannot be read: it is not a file\n")


def test_damaged_data_files_are_one_line_with_their_name(tmp_path: Path) -> None:
    write_options(tmp_path, {"simulation_time": 0.2})
    assert task(tmp_path, 4).code == 0
    data = tmp_path / "tasks" / "4" / "frames" / "data.feather"
    whole = data.read_bytes()
    told = set()
    for place in [*range(0, len(whole), 97), *range(len(whole) - 400, len(whole), 7)]:
        data.write_bytes(whole[:place] + bytes(byte ^ 0xFF for byte in whole[place : place + 5]) + whole[place + 5 :])
        result = merge(tmp_path, "tasks")
        if result.code == 0:
            continue
        assert (result.code, result.errors.count("\n")) == (2, 1), (place, result.errors)
        assert "cannot write" not in result.errors, place
        told.add(result.errors.partition(" is damaged: ")[0])
    assert told == {"pogobatch merge: tasks/4/frames/data.feather"}


@pytest.mark.parametrize("key", ["combinations", "pogobatch_manifest"])
def test_results_whose_metadata_are_damaged_are_not_appended_to(key: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    for seed in (4, 5):
        assert task(tmp_path, seed).code == 0
    assert merge(tmp_path, "tasks/4").code == 0
    path = tmp_path / "results" / "result.feather"
    for wrong in (b"{", b"- x", b"\xff", b"[1"):
        table = feather.read_table(path)
        feather.write_feather(table.replace_schema_metadata({**table.schema.metadata, key.encode(): wrong}), path)
        before = path.read_bytes()
        result = merge(tmp_path, "tasks/5", "--append")
        assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
        assert "does not say which runs it has" in result.errors
        assert path.read_bytes() == before


def test_what_cannot_be_merged_is_one_line(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert task(tmp_path, 4).code == 0
    (tmp_path / "empty").mkdir()
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "result.feather").write_text("mine")
    for words, said in (
        (["none"], "none does not exist"),
        (["empty"], "there is no pogobatch_task.json in empty"),
        (["many.yaml"], "many.yaml is no manifest of a run"),
        (["tasks", "-c", "none.yaml"], "cannot read the configuration none.yaml"),
        (["tasks"], "it will not be overwritten"),
    ):
        result = merge(tmp_path, *words)
        assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
        assert said in result.errors
    shutil.copy(tmp_path / "tasks" / "4" / "frames" / "data.feather", tmp_path / "results" / "result.feather")
    assert "has no columns run and seed" in merge(tmp_path, "tasks", "--append").errors
    with pytest.raises(PogobatchError, match="no runs to merge"):
        merge_task_artifacts([], tmp_path)


def test_functions_do_what_the_subcommands_do(tmp_path: Path) -> None:
    path = write_options(tmp_path)
    done = execute_task(path, PROGRAM, seed=4, output_dir=tmp_path / "tasks" / "4", run_index=1)
    assert done.data == tmp_path / "tasks" / "4" / "frames" / "data.feather"
    (found,) = discover_task_artifacts([tmp_path / "tasks"])
    assert found == done
    (output,) = merge_task_artifacts([found], tmp_path / "results", config_path=path)
    rows, metadata = load_dataframe(output)
    assert rows[["run", "seed", "retry_attempt"]].drop_duplicates().to_numpy().tolist() == [[1, 4, 0]]
    assert metadata["combinations"][0]["columns"] == {"objects.robots.nb": 3, "arena_file": "disk"}


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_interrupted_task_ends_its_simulator_and_has_no_manifest(tmp_path: Path) -> None:
    write_options(tmp_path, {"simulation_time": 1e6})
    words = ["task", "-c", "many.yaml", "-S", PROGRAM, "--seed", "1", "-o", "one"]
    process = subprocess.Popen([*COMMAND, *words], cwd=tmp_path, env=ENVIRONMENT, stderr=subprocess.PIPE, text=True)
    configuration = str(tmp_path / "one" / "pogobatch_effective.yaml")
    for _ in range(600):
        if processes_with(configuration):
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (130, "pogobatch task: interrupted\n")
    assert processes_with(configuration) == []
    assert not (tmp_path / "one" / "pogobatch_task.json").exists()


def processes_with(text: str) -> list[str]:
    """Return the processes whose command line has a text."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):
            if text.encode() in path.read_bytes():
                found.append(path.parent.name)
    return found


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_results_in_other_formats_are_merged_but_not_appended_to(suffix: str, tmp_path: Path) -> None:
    write_options(tmp_path, {"result_filename_format": f"all.{suffix}"})
    for seed in (1, 2):
        assert task(tmp_path, seed, "--run-index", str(seed)).code == 0
    assert merge(tmp_path, "tasks").code == 0
    rows, metadata = load_dataframe(tmp_path / "results" / f"all.{suffix}")
    assert rows[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[1, 1], [2, 2]]
    assert '"task_count": 2' in str(metadata["pogobatch_manifest"])
    result = merge(tmp_path, "tasks", "--append")
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert "--append needs results in Feather; join all runs anew, without it" in result.errors
