"""The subcommands of pogobatch: plan and run, what they print as JSON, and the maps of a configuration for them."""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

import pandas as pd
import pytest
from batches import (
    COMMAND,
    ENVIRONMENT,
    batch,
    results,
    run_main,
    script,
    subcommand,
    wait_for_simulators,
    write_options,
)
from pogosim.batch.command_line import main, parser
from pogosim.batch.runs.run_files import with_files_beside
from pogosim.batch.subcommands import SUBCOMMANDS, subparser
from pogosim.utils import load_dataframe
from running import ROOT, Run, example
from yaml import safe_load

TAKEN_OUT: dict[str, object] = {"result_new_columns": None}
CHOSEN: dict[str, object] = {**TAKEN_OUT, "pogobatch": {"result_new_columns": ["objects.robots.nb", "arena_file"]}}


def report(run: Run) -> dict[str, Any]:
    """Return the JSON that a command has printed, which is all of its output."""
    assert run.output.count("\n") == 1, run.output
    entries: dict[str, Any] = json.loads(run.output)
    return entries


def plan(folder: Path, *options: str) -> Run:
    """Plan a batch of many.yaml."""
    return run_main(folder, ["plan", "-c", "many.yaml", *options])


def test_run_has_the_rows_of_the_flags_and_two_columns_more(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path, "-r", "2").code == 0
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert sorted(results(tmp_path)) == ["result.feather"]
    result = subcommand(tmp_path, "run", "-r", "2", folder_of="more")
    assert (result.code, result.errors) == (0, "")
    assert result.output.splitlines()[-1] == " - more/result.feather"
    more, told = load_dataframe(tmp_path / "more" / "result.feather")
    assert list(more.columns[-5:]) == ["run", "seed", "retry_attempt", "objects.robots.nb", "arena_file"]
    pd.testing.assert_frame_equal(more.drop(columns=["seed", "retry_attempt"]), rows, check_flags=False)
    manifest = json.loads(told.pop("pogobatch_manifest"))
    assert (manifest["schema_version"], manifest["task_count"], len(manifest["config_hashes"])) == (1, 4, 2)
    assert told.keys() == metadata.keys()
    assert str({**told, "arena_polygons": 0}) == str({**metadata, "arena_polygons": 0})


def test_bytes_of_run_do_not_depend_on_who_does_the_runs(tmp_path: Path) -> None:
    write_options(tmp_path)
    written = []
    for options in (["-j", "0"], ["--jobs", "1"], ["--workers", "3"], ["--backend", "sequential"]):
        assert subcommand(tmp_path, "run", "--seeds", "3:5", *options).code == 0
        written.append(results(tmp_path)["result.feather"])
    assert len(set(written)) == 1


def test_manifest_says_what_was_done(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert subcommand(tmp_path, "run", "--seeds", "3:5", "-j", "1").code == 0
    assert sorted(results(tmp_path)) == ["pogobatch_run.json", "result.feather"]
    entries = json.loads((tmp_path / "results" / "pogobatch_run.json").read_text())
    expected = {
        "schema_version": 1,
        "executor": "local",
        "task_count": 6,
        "combinations": 2,
        "seeds": [3, 4, 5],
        "backend": "multiprocessing",
        "jobs": 1,
        "outputs": ["results/result.feather"],
        "failures": [],
    }
    assert {key: entries[key] for key in expected} == expected


@pytest.mark.parametrize("text", ["[1, 2]", '{"a": 1}', "", "x"])
def test_file_that_is_no_manifest_is_not_overwritten(text: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "pogobatch_run.json").write_text(text)
    result = subcommand(tmp_path, "run")
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert "results/pogobatch_run.json is there and was not written by pogobatch" in result.errors
    assert list(results(tmp_path)) == ["pogobatch_run.json"]


def test_plan_says_what_run_does_and_does_nothing(tmp_path: Path) -> None:
    write_options(tmp_path, CHOSEN)
    shown = plan(tmp_path, "--seeds", "3:4", "--show-tasks", "-o", "results")
    assert (shown.code, shown.errors) == (0, "")
    assert shown.output.splitlines() == [
        "2 combinations x 2 seeds: 4 runs",
        " - results/result.feather",
        "run 0 of results/result.feather, seed 3, objects.robots.nb: 2",
        "run 1 of results/result.feather, seed 4, objects.robots.nb: 2",
        "run 0 of results/result.feather, seed 3, objects.robots.nb: 3",
        "run 1 of results/result.feather, seed 4, objects.robots.nb: 3",
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["many.yaml"]
    entries = report(plan(tmp_path, "--seeds", "3:4", "-o", "results", "--json"))
    assert list(entries) == ["operation", "ok", "config", "combinations", "seeds", "task_count", "outputs", "tasks"]
    assert (entries["operation"], entries["ok"], entries["config"]) == ("plan", True, "many.yaml")
    assert (entries["combinations"], entries["seeds"], entries["task_count"]) == (2, [3, 4], 4)
    assert entries["tasks"][3] == {
        "combination_ordinal": 1,
        "logical_run": 1,
        "seed": 4,
        "output": "results/result.feather",
        "batch_choices": {"objects.robots.nb": 3},
    }
    done = report(subcommand(tmp_path, "run", "--seeds", "3:4", "--json"))
    for key in ("combinations", "seeds", "task_count", "outputs"):
        assert done[key] == entries[key]
    assert (done["operation"], done["ok"], done["manifest"]) == ("run", True, "results/pogobatch_run.json")


def test_parts_together_are_the_whole(tmp_path: Path) -> None:
    write_options(tmp_path)
    seeds = ("--seeds", "3:6")
    assert subcommand(tmp_path, "run", *seeds).code == 0
    counts = []
    for part in range(3):
        done = report(subcommand(tmp_path, "run", *seeds, "-t", f"jobs/{part}", "--part", f"{part}/3", "--json"))
        assert (done["part"], done["parts"]) == (part, 3)
        counts.append(done["task_count"])
    assert counts == [3, 3, 2]
    assert run_main(tmp_path, ["merge", "jobs", "-o", "merged", "-c", "many.yaml"]).code == 0
    assert (tmp_path / "merged" / "result.feather").read_bytes() == results(tmp_path)["result.feather"]
    again = subcommand(tmp_path, "run", *seeds, "-t", "jobs/1", "--part", "1/3")
    assert again.output.splitlines()[0].startswith("3 of 3 runs are done already, in ")
    shown = plan(tmp_path, *seeds, "--part", "2/3", "--show-tasks")
    assert [line for line in shown.output.splitlines() if line.startswith(("Part", "run"))] == [
        "Part 2 of 3: 2 runs",
        "run 2 of result.feather, seed 5, objects.robots.nb: 2",
        "run 1 of result.feather, seed 4, objects.robots.nb: 3",
    ]


def test_combinations_that_share_runs_have_them_all_after_a_merge(tmp_path: Path) -> None:
    names = {"batch_options": ["a.feather", "b.feather"], "default_option": "a.feather"}
    write_options(tmp_path, {"data_filename": names, "result_filename_format": "r_{data_filename}.feather"})
    seeds = ("--seeds", "0:2")
    assert subcommand(tmp_path, "run", *seeds).code == 0
    for part in range(2):
        assert subcommand(tmp_path, "run", *seeds, "-t", f"jobs/{part}", "--part", f"{part}/2").code == 0
    merged = run_main(tmp_path, ["merge", "jobs", "-o", "merged", "-c", "many.yaml"])
    assert (merged.code, merged.errors) == (0, "")
    whole = {name: content for name, content in results(tmp_path).items() if name.endswith(".feather")}
    assert {path.name: path.read_bytes() for path in (tmp_path / "merged").glob("*.feather")} == whole
    assert len(whole) == 2


def test_part_without_runs_is_done(tmp_path: Path) -> None:
    write_options(tmp_path)
    result = subcommand(tmp_path, "run", "--seeds", "3:3", "-t", "jobs/9", "--part", "9/10")
    assert result.code == 0
    assert "Part 9 of 10: 0 runs done" in result.output


@pytest.mark.parametrize("text", ["", "1", "3/3", "-1/3", "1/0", "a/b", "1/3/4", "1.0/3", "/3"])
def test_part_that_is_none_is_one_line(text: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    result = subcommand(tmp_path, "run", f"--part={text}")
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert result.errors.endswith(f"expected N/M with N from 0 to M - 1, such as 0/40 to 39/40; found '{text}'\n")


def test_part_with_failed_runs_says_so(tmp_path: Path) -> None:
    write_options(tmp_path)
    program = script(tmp_path / "fails", 'case $seed in 1[0-9]*) exit 4 ;; esac; [ "$seed" = 4 ] && exit 4')
    result = subcommand(tmp_path, "run", "--seeds", "3:6", "-R", "0", "--part", "1/2", program=program)
    assert result.code == 3
    assert result.errors.endswith("2 run(s) failed; the same command does them again, and only them\n")


def test_json_is_whole_however_many_runs_there_are_and_whatever_their_names(tmp_path: Path) -> None:
    columns = ["label"]
    write_options(
        tmp_path, {"label": {"batch_options": ["a\x1b[2J\u202e", "\U000e0001"]}, "result_new_columns": columns}
    )
    shown = plan(tmp_path, "-r", "500", "--json")
    entries = report(shown)
    assert (len(entries["tasks"]), entries["task_count"]) == (2000, 2000)
    assert entries["tasks"][0]["batch_choices"]["label"] == "a\x1b[2J\u202e"
    assert shown.output.isascii()


def printing_to(file: TextIO) -> Callable[[list[str]], int]:
    """Return the command, whose output goes to a file."""

    def command(words: list[str]) -> int:
        with contextlib.redirect_stdout(file):
            return main(words)

    return command


def test_plan_of_many_runs_keeps_none_of_them(tmp_path: Path) -> None:
    write_options(tmp_path)
    seeds = ["--seeds", "5:100004", "--part", "1/2"]
    tracemalloc.start()
    try:
        for more, lines in ([], 3), (["--show-tasks"], 100_003), (["--json"], 1):
            with (tmp_path / "output.txt").open("w") as file:
                before = tracemalloc.get_traced_memory()[0]
                tracemalloc.reset_peak()
                assert run_main(tmp_path, ["plan", "-c", "many.yaml", *seeds, *more], printing_to(file)).code == 0
                assert tracemalloc.get_traced_memory()[1] - before < 5e6, more
            with (tmp_path / "output.txt").open() as file:
                assert sum(1 for _ in file) == lines
    finally:
        tracemalloc.stop()
    entries = json.loads((tmp_path / "output.txt").read_text())
    assert entries["seeds"] == list(range(5, 100_005))
    assert [len(entries["tasks"]), entries["task_count"]] == [100_000, 100_000]
    assert entries["tasks"][50_000] == {
        "combination_ordinal": 1,
        "logical_run": 1,
        "seed": 6,
        "output": "result.feather",
        "batch_choices": {"objects.robots.nb": 3},
    }


def test_plan_with_a_wrong_seed_has_no_runs_in_its_json(tmp_path: Path) -> None:
    write_options(tmp_path, {"seed": {"batch_options": [1, "no"], "default_option": 1}})
    refused = plan(tmp_path, "-r", "2", "--seed-from", "config", "--json")
    assert (refused.code, report(refused)["ok"], "tasks" in report(refused)) == (2, False, False)
    assert "--seed-from config needs a whole number" in report(refused)["error"]


def test_plan_warns_and_refuses_as_run_does(tmp_path: Path) -> None:
    write_options(tmp_path, {"result_new_columns": []})
    said = "no column tells its combinations apart; add to result_new_columns: objects.robots.nb"
    assert said in plan(tmp_path).errors
    write_options(tmp_path, {"result_new_columns": ["objects.robots.number"]})
    assert (plan(tmp_path).code, subcommand(tmp_path, "run").code) == (2, 2)
    assert "there is no key 'objects.robots.number'" in plan(tmp_path).errors
    write_options(tmp_path)
    assert plan(tmp_path, "--only-output", "other.feather").code == 1


def test_plan_takes_the_options_of_run(tmp_path: Path) -> None:
    write_options(tmp_path, {"seed": 3})
    words = ["--seeds", "3:4", "-S", str(example("helloworld")), "-o", "results", "-t", "tmp", "-j", "2", "--keep-temp"]
    shown = plan(tmp_path, *words)
    assert (shown.code, shown.errors) == (0, "")
    assert shown.output.splitlines()[0] == "2 combinations x 2 seeds: 4 runs"
    assert [path.name for path in tmp_path.iterdir()] == ["many.yaml"]
    for wrong, said in ((["-S", "none"], "the simulator none does not exist"), (["-j", "-1"], "--jobs: expected a")):
        refused, run = plan(tmp_path, *words, *wrong), subcommand(tmp_path, "run", *wrong)
        assert (refused.code, run.code) == (2, 2)
        assert said in refused.errors
        assert said in run.errors
    derived = report(plan(tmp_path, "-r", "2", "--seed-from", "config", "--json"))
    assert subcommand(tmp_path, "run", "-r", "2", "--seed-from", "config").code == 0
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert {task["seed"] for task in derived["tasks"]} == set(rows["seed"])


def test_list_of_outputs_needs_no_program(tmp_path: Path) -> None:
    write_options(tmp_path)
    listed = run_main(tmp_path, ["-c", "many.yaml", "--list-outputs"])
    assert (listed.code, listed.output, listed.errors) == (0, "result.feather\n", "")


def test_json_of_failures_and_errors_says_what_is_wrong(tmp_path: Path) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    broken = script(tmp_path / "broken", '[ "$seed" = 1 ] && exit 3')
    failed = subcommand(tmp_path, "run", "-r", "2", "-R", "1", "--retry-same-seed", "--json", program=broken)
    entries = report(failed)
    assert (failed.code, entries["ok"], entries["outputs"]) == (3, False, ["results/result.feather"])
    (failure,) = entries["failures"]
    assert failure == {
        "ok": False,
        "combination_ordinal": 0,
        "logical_run": 1,
        "seed": 1,
        "attempts": 2,
        "error": "exit code 3",
    }
    assert "1 of 2 runs failed, first run 1 with seed 1: exit code 3; what they left is in" in entries["error"]
    assert json.loads((tmp_path / "results" / "pogobatch_run.json").read_text())["failures"] == [failure]

    wrong = subcommand(tmp_path, "run", "--json", "-c", "nothing.yaml")
    assert wrong.code == 2
    assert report(wrong) == {
        "operation": "run",
        "ok": False,
        "error": "cannot read the configuration nothing.yaml: No such file or directory",
    }
    flags = batch(tmp_path, "-r", "1", "--json")
    assert report(flags)["outputs"] == ["results/result.feather"]
    assert report(batch(tmp_path, "--list-outputs", "--json"))["outputs"] == ["results/result.feather"]


def test_progress_is_said_where_there_is_no_terminal(tmp_path: Path) -> None:
    write_options(tmp_path)
    result = subcommand(tmp_path, "run", "-r", "2", "--progress")
    said = [line.rpartition(";")[0] for line in result.errors.splitlines()]
    assert said == [f"pogobatch run: {n} of 4 runs are done" for n in (1, 2, 3, 4)]
    assert subcommand(tmp_path, "run", "-r", "2").errors == ""


def test_maps_for_batch_tools_do_what_they_say_and_reach_no_simulator(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert subcommand(tmp_path, "run", "-r", "2").code == 0
    plain = results(tmp_path)["result.feather"]
    maps = {
        "result_filename_format": "swarm_{objects.robots.nb}.feather",
        "result_new_columns": ["objects.robots.nb", "arena_file"],
        "rundra": {"sync": {"exclude": ["*.png"]}},
    }
    write_options(tmp_path, {**TAKEN_OUT, "pogobatch": maps, "_rundr": {"version": 1, "seeds": 2}})
    result = subcommand(tmp_path, "run", "--keep-temp", folder_of="mapped")
    assert (result.code, result.errors) == (0, "")
    written = [load_dataframe(tmp_path / "mapped" / f"swarm_{nb}.feather")[0] for nb in (2, 3)]
    (tmp_path / "plain.feather").write_bytes(plain)
    pd.testing.assert_frame_equal(
        pd.concat(written, ignore_index=True), load_dataframe(tmp_path / "plain.feather")[0], check_flags=False
    )
    folders = list((tmp_path / "tmp").glob("sim_*"))
    assert len(folders) == 4
    for folder in folders:
        assert not {"pogobatch", "_rundr"} & set(safe_load((folder / "test.yaml").read_text()))
    # The flags read them, too.
    assert batch(tmp_path, "--list-outputs").output.splitlines() == [f"results/swarm_{nb}.feather" for nb in (2, 3)]


def test_map_for_results_comes_before_the_top_level_with_a_warning(tmp_path: Path) -> None:
    own = {"result_filename_format": "map.feather"}
    text = write_options(tmp_path, {"result_filename_format": "top.feather", "pogobatch": own}).read_text()
    line = text.splitlines().index("result_filename_format: top.feather") + 1
    result = batch(tmp_path, "--list-outputs")
    assert result.output == "results/map.feather\n"
    assert result.errors == (
        f"pogobatch: many.yaml:{line}: result_filename_format: is not used: pogobatch.result_filename_format comes "
        "first; remove one of them\n"
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"pogobatch": 5}, "pogobatch: expected a map with result_filename_format"),
        ({"pogobatch": {"result_filename_fromat": "a.feather"}}, "did you mean 'result_filename_format'?"),
        ({"pogobatch": {"result_filename_format": 5}}, "pogobatch.result_filename_format: expected a name"),
        (
            {"pogobatch": {"result_new_columns": 5}, **TAKEN_OUT},
            "pogobatch.result_new_columns: expected a list",
        ),
        ({"pogobatsh": {}}, "did you mean 'pogobatch'?"),
        ({"_rundr": [1]}, "_rundr: expected a map with version and seeds, found [1]"),
        ({"_rundr": {"version": 2}}, "_rundr.version: expected 1, found 2"),
        ({"_rundr": {"version": True}}, "_rundr.version: expected 1, found True"),
        ({"_rundr": {"seeds": "5"}}, "_rundr.seeds: expected the first and the last seed"),
        ({"_rundr": {"seeds": 0}}, "_rundr.seeds: expected a whole number of at least 1; found 0"),
        ({"_rundr": {"seeds": 1.5}}, '_rundr.seeds: expected a number of seeds, or "A:B", found 1.5'),
        ({"_rundr": {"sedes": 5}}, "did you mean 'seeds'?"),
    ],
)
def test_wrong_maps_are_refused_with_their_place(changes: dict[str, object], said: str, tmp_path: Path) -> None:
    text = write_options(tmp_path, changes).read_text()
    for result in (batch(tmp_path), subcommand(tmp_path, "run"), plan(tmp_path)):
        assert (result.code, result.errors.count("\n")) == (2, 1), result.errors
        assert said in result.errors
        line = int(result.errors.split(":")[2])
        key = next(iter(changes))
        assert text.splitlines()[line - 1 :][0].strip().partition(":")[0] in (key, *str(changes).split("'"))


def test_unknown_keys_of_the_maps_are_said_and_empty_maps_will_do(tmp_path: Path) -> None:
    write_options(tmp_path, {"pogobatch": {"colour": "red"}, "_rundr": {"walltime": "1h"}})
    result = batch(tmp_path, "--list-outputs")
    assert result.code == 0
    assert "pogobatch.colour: unknown key, which has no effect" in result.errors
    assert "_rundr.walltime: unknown key, which has no effect" in result.errors
    write_options(tmp_path)
    with (tmp_path / "many.yaml").open("a") as file:
        file.write("pogobatch:\n_rundr:\n")
    assert (batch(tmp_path, "--list-outputs").errors, plan(tmp_path).code) == ("", 0)


def test_options_in_lists_are_combined_by_every_subcommand(tmp_path: Path) -> None:
    parameters = {"list": [1, {"batch_options": [2, 3], "default_option": 3}, [{"batch_options": [4, 5]}]]}
    write_options(
        tmp_path, {"objects.robots.nb": 2, "parameters": parameters, "result_new_columns": ["parameters.list"]}
    )
    assert report(plan(tmp_path, "--json"))["combinations"] == 4
    assert subcommand(tmp_path, "run").code == 0
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert rows["parameters.list"].unique().tolist() == [f"[1, {a}, [{b}]]" for a in (2, 3) for b in (4, 5)]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (
            ["cluster"],
            2,
            "pogobatch run --slurm (jobs of SLURM) or pogobatch run --scheduler tcp://... (workers of Dask)",
        ),
        (["cluster", "submit", "-c", "many.yaml", "--partition", "x"], 2, "the scheduler Rundra is not used here"),
        (["rum"], 2, "there is no subcommand 'rum'; did you mean 'run'?"),
        (["x", "-c", "many.yaml"], 2, "there is no subcommand 'x'; see pogobatch help"),
        (["help", "rum"], 2, "there is no subcommand 'rum'; did you mean 'run'?"),
        (["run"], 2, "the following arguments are required: -c/--config"),
        (
            ["run", "-c", "many.yaml"],
            2,
            "the following arguments are required: -S/--simulator-binary; category 'robots' needs a program, and none "
            "is given: ",
        ),
        (["task", "-c", "many.yaml"], 2, "the following arguments are required"),
        (["merge"], 2, "the following arguments are required: FOLDER"),
        (["plan", "--show"], 2, "required"),
        (["plan", "-c", "many.yaml", "--show"], 2, "unrecognized arguments: --show"),
        (["run", "-c", "many.yaml", "-S", "/bin/ls"], 2, "/bin/ls is not a simulator"),
        (
            ["run", "-c", "many.yaml", "-S", "x", "-j", "-1"],
            2,
            "--jobs: expected a whole number of at least 0; found -1",
        ),
    ],
)
def test_what_is_no_command_is_said(words: list[str], code: int, said: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    result = run_main(tmp_path, words)
    assert (result.code, result.output) == (code, "")
    assert said in result.errors


@pytest.mark.parametrize("words", [[], ["run"], ["task", "--seed", "3"]])
def test_scripts_need_no_program(words: list[str], tmp_path: Path) -> None:
    """Nor do categories without robots."""
    script = {"script": [{"time_s": 0, "motors": [500, 500, 0]}]}
    boxes = {"type": "passive_object", "nb": 1, "geometry": "disk", "radius": 10}
    write_options(tmp_path, {"objects.robots.brain": script, "objects.boxes": boxes})
    temporary = [] if "task" in words else ["-t", "tmp"]
    result = run_main(tmp_path, [*words, "-c", "many.yaml", "-o", "results", *temporary])
    assert result.code == 0, result.errors
    (data,) = (tmp_path / "results").rglob("*.feather")
    rows = pd.read_feather(data)
    robots = rows[rows["robot_category"] == "robots"]
    assert (robots.groupby("robot_id")["x"].nunique() > 5).all()


def test_missing_program_is_the_first_thing_said(tmp_path: Path) -> None:
    write_options(tmp_path, {"objects.robots.brain": "program"})
    result = run_main(tmp_path, ["-c", "many.yaml", "-o", "results", "-t", "tmp"])
    assert (result.code, result.output) == (1, "")
    assert "-S/--simulator-binary; category 'robots' needs a program, and none is given: " in result.errors


def test_robots_of_a_host_are_refused_by_batches(tmp_path: Path) -> None:
    write_options(tmp_path, {"objects.robots.brain": "host"})
    for words in ([], ["run"], ["task", "--seed", "3"]):
        temporary = [] if "task" in words else ["-t", "tmp"]
        result = run_main(tmp_path, [*words, "-c", "many.yaml", "-o", "results", *temporary])
        assert (result.code, result.output) == (2, "")
        assert "objects.robots.brain: host: there is no host on the command line; run it from Python" in result.errors
    assert not (tmp_path / "results").exists()


def test_batches_need_a_program_where_the_simulator_does(tmp_path: Path) -> None:
    """The brain may stand in the model of the robots, and categories without robots have none."""
    (tmp_path / "dancer.yaml").write_text("brain: {script: [{time_s: 0, motors: [500, 500, 0]}]}\n")
    write_options(
        tmp_path,
        {
            "boundary_condition": "periodic",
            "objects.robots.robot_model": "dancer.yaml",
            "objects.walls": {"type": "pogowall", "geometry": "arena"},
            "objects.others": {"type": "pogobot", "nb": 0},
        },
    )
    result = run_main(tmp_path, ["-c", "many.yaml", "-o", "results", "-t", "tmp"])
    assert result.code == 0, result.errors


def test_firmware_is_found_beside_the_configuration(tmp_path: Path) -> None:
    """Brains that are no files have names of files, too."""
    for name in ("robot.elf", "host", "program"):
        (tmp_path / name).touch()
    brains = ["robot.elf", {"firmware": "robot.elf"}, "host", "program", "elsewhere.elf"]
    found = with_files_beside({"objects": {"robots": [{"brain": brain} for brain in brains]}}, tmp_path)
    there = str(tmp_path / "robot.elf")
    assert [own["brain"] for own in found["objects"]["robots"]] == [there, {"firmware": there}, *brains[2:]]


def test_help_lists_subcommands_and_their_options(tmp_path: Path) -> None:
    shown = run_main(tmp_path, ["help"])
    assert shown.code == 0
    for name in SUBCOMMANDS:
        assert f"\n  {name} " in shown.output
        own = run_main(tmp_path, ["help", name])
        assert own.code == 0
        assert own.output.startswith(f"usage: pogobatch {name} ")
    assert "--show-tasks" in run_main(tmp_path, ["plan", "--help"]).output


def test_page_of_batches_has_every_option_of_the_subcommands() -> None:
    page = (ROOT / "docs" / "batches.md").read_text()
    for name in SUBCOMMANDS:
        for action in subparser(name, "pogobatch")._actions:
            for flag in action.option_strings:
                assert f"`{flag}" in page or flag in ("--help", "-h", "--verbose"), (name, flag)


def test_run_has_every_option_of_the_flags() -> None:
    flags = {flag for action in parser("pogobatch")._actions for flag in action.option_strings}
    own = {flag for action in subparser("run", "pogobatch")._actions for flag in action.option_strings}
    assert flags - own == {"--list-outputs", "-V", "--version"}
    assert own - flags == {"--jobs", "--part"}


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_interrupted_run_is_continued_by_the_same_command(tmp_path: Path) -> None:
    write_options(tmp_path, {"simulation_time": 300.0, "save_data_period": 10.0})
    words = ["run", "-c", "many.yaml", "-S", str(example("helloworld")), "-t", "tmp", "-o", "results", "--seeds", "4:9"]
    process = subprocess.Popen(
        [*COMMAND, *words], cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert wait_for_simulators(tmp_path, process)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    last = errors.splitlines()[-1]
    assert last.startswith("pogobatch run: interrupted")
    assert last.endswith("the same command continues")
    assert run_main(tmp_path, words).code == 0
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    assert rows[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[run, run + 4] for run in range(6)]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]
