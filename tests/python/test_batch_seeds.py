"""Seeds of a batch: which are asked for and by what, and which replace those of runs that failed."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from batches import batch, results, run_main, script, subcommand, write_options
from pogosim.batch.configurations.seeds import LARGEST, listed_seeds, replacements, seeds_between
from pogosim.batch.errors import BatchError
from pogosim.pogobatch import main
from pogosim.utils import load_dataframe
from running import example

ONE = {"objects.robots.nb": 2, "result_new_columns": []}


def runs_in(folder: Path, name: str = "results/result.feather") -> list[list[int]]:
    """Return run, seed and retry attempt of all runs."""
    rows, _ = load_dataframe(folder / name)
    return rows[["run", "seed", "retry_attempt"]].drop_duplicates().to_numpy().tolist()


def test_seeds_are_those_of_the_command_line_and_runs_are_numbered_from_zero(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    for options, seeds in ((["--seeds", "7:9"], [7, 8, 9]), (["--seed", "5"], [5]), (["-r", "2"], [0, 1]), ([], [0])):
        assert subcommand(tmp_path, "run", *options).code == 0
        assert runs_in(tmp_path) == [[run, seed, 0] for run, seed in enumerate(seeds)]


@pytest.mark.parametrize(("seeds", "found"), [(3, [0, 1, 2]), ("4:5", [4, 5])])
def test_seeds_of_the_configuration_count_where_the_command_line_says_nothing(
    seeds: int | str, found: list[int], tmp_path: Path
) -> None:
    write_options(tmp_path, {**ONE, "_rundr": {"version": 1, "seeds": seeds}})
    assert subcommand(tmp_path, "run").code == 0
    assert runs_in(tmp_path) == [[run, seed, 0] for run, seed in enumerate(found)]
    assert subcommand(tmp_path, "run", "--seed", "9").code == 0
    assert runs_in(tmp_path) == [[0, 9, 0]]
    assert batch(tmp_path).code == 0
    assert sorted(set(load_dataframe(tmp_path / "results" / "result.feather")[0]["run"])) == list(range(len(found)))


def test_rows_are_those_of_single_runs_with_the_same_seeds(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    assert subcommand(tmp_path, "run", "--seeds", "7:8").code == 0
    rows, _ = load_dataframe(tmp_path / "results" / "result.feather")
    write_options(tmp_path, {**ONE, "simulation_time": 1.0})
    for run, seed in enumerate((7, 8)):
        assert subcommand(tmp_path, "task", "--seed", str(seed), folder_of=str(seed)).code == 0
        single, _ = load_dataframe(tmp_path / str(seed) / "frames" / "data.feather")
        own = rows[rows["run"] == run].drop(columns=["run", "seed", "retry_attempt"]).reset_index(drop=True)
        pd.testing.assert_frame_equal(own, single, check_flags=False)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--seeds", "5"], "--seeds: expected the first and the last seed, such as 0:9, both from 0 to 4294967295"),
        (["--seeds", "5:4"], "--seeds: the first seed is greater than the last; expected 4:5; found '5:4'"),
        (["--seeds", "0:4294967296"], "found '0:4294967296'"),
        (["--seeds", "-1:4"], "expected one argument"),
        (["--seeds=-1:4"], "found '-1:4'"),
        (["--seeds", "0:4294967295"], "4294967296 seeds are more than 10000000; make several batches"),
        (["--seed", "-1"], "--seeds: expected whole numbers from 0 to 4294967295; found -1"),
        (["--seed", "x"], "argument --seed: invalid int value: 'x'"),
        (["--seed", "1", "--seeds", "0:1"], "not allowed with argument"),
        (["-r", "2", "--seeds", "0:1"], "not allowed with argument"),
        (["-r", "0"], "--runs: expected a whole number of at least 1; found 0"),
        (["--seed-from", "config", "--seed", "3"], "--seed-from config goes with --runs"),
    ],
)
def test_wrong_seeds_are_refused(options: list[str], said: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    for result in (subcommand(tmp_path, "run", *options), batch(tmp_path, *options)):
        assert result.code == 2
        assert said in result.errors
        assert results(tmp_path) == {}


def test_replacement_seeds_follow_all_seeds_and_no_two_attempts_share_one() -> None:
    assert replacements(range(4), 3) == [(4 + r, 8 + r, 12 + r) for r in range(4)]
    assert replacements([10, 3, 7], 2) == [(11, 14), (12, 15), (13, 16)]
    every = [*range(50), *(seed for own in replacements(range(50), 5) for seed in own)]
    assert sorted(every) == list(range(300))
    assert replacements([LARGEST - 1], 5) == [(LARGEST,)]
    assert replacements([LARGEST], 5) == [()]


def test_run_that_fails_has_another_seed_which_its_row_says(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    program = script(tmp_path / "flaky", '[ "$seed" = 1 ] || [ "$seed" = 4 ] && exit 3')
    result = subcommand(tmp_path, "run", "-r", "3", program=program)
    assert (result.code, result.errors.count("\n")) == (0, 1)
    assert runs_in(tmp_path) == [[0, 0, 0], [1, 7, 2], [2, 2, 0]]
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert metadata["combinations"][0]["seeds"] == [0, 7, 2]
    assert metadata["combinations"][0]["failed_runs"] == []

    assert subcommand(tmp_path, "run", "--seed", "7", folder_of="seven").code == 0
    seven, _ = load_dataframe(tmp_path / "seven" / "result.feather")
    own = rows[rows["run"] == 1].reset_index(drop=True)
    pd.testing.assert_frame_equal(own[["time", "x", "y"]], seven[["time", "x", "y"]], check_flags=False)


def test_replaced_runs_are_told_with_the_reason_of_the_first(tmp_path: Path) -> None:
    write_options(tmp_path)
    lines = 'case "$seed" in 1|4|6) echo "[2026-01-01 12:00:00.000] [error] robot $seed broke"; exit 3;; esac'
    program = script(tmp_path / "flaky", lines)
    result = subcommand(tmp_path, "run", "-r", "3", "--json", "--keep-temp", program=program)
    assert result.code == 0
    assert (
        "2 of 6 runs failed and were done with other seeds (retry_attempt > 0); the first: run 1 of "
        "results/result.feather, seed 1, is now that of seed 7: exit code 3: [error] robot 1 broke\n"
    ) in result.errors
    told = json.loads(result.output)
    own = {"logical_run": 1, "seed": 1, "retry_attempt": 2, "replacement_seed": 7}
    error = "exit code 3: [error] robot 1 broke"
    assert told["replaced"] == [{"combination_ordinal": number, **own, "error": error} for number in (0, 1)]
    assert (told["ok"], told["failures"]) == (True, [])
    assert json.loads((tmp_path / "results" / "pogobatch_run.json").read_text())["replaced"] == told["replaced"]
    # The same call does nothing, and has them nevertheless; only the reason has gone.
    again = subcommand(tmp_path, "run", "-r", "3", "--json", "--keep-temp", program=program)
    assert "2 of 6 runs failed and were done with other seeds" in again.errors
    assert [entry["error"] for entry in json.loads(again.output)["replaced"]] == ["", ""]
    assert json.loads(subcommand(tmp_path, "run", "-r", "3", "--json", folder_of="others").output)["replaced"] == []


def test_same_seed_again_leaves_no_trace_in_the_results(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    assert subcommand(tmp_path, "run", "-r", "3", "-t", "other", folder_of="undisturbed").code == 0
    undisturbed = (tmp_path / "undisturbed" / "result.feather").read_bytes()
    program = script(tmp_path / "flaky", '[ "$seed" = 1 ] && mkdir "$0.tried" 2>/dev/null && kill -SEGV $$')
    assert subcommand(tmp_path, "run", "-r", "3", "--retry-same-seed", program=program).code == 0
    assert (tmp_path / "flaky.tried").exists()
    assert results(tmp_path)["result.feather"] == undisturbed


def test_flags_repeat_with_the_same_seed_unless_asked_for_another(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    program = script(tmp_path / "flaky", '[ "$seed" = 1 ] && exit 3')
    assert batch(tmp_path, "-r", "2", "-R", "2", program=program).code == 3
    replaced = batch(tmp_path, "-r", "2", "-R", "2", "--retry-new-seed", program=program)
    assert (replaced.code, replaced.errors) == (
        0,
        "pogobatch: 1 of 2 runs failed and was done with another seed; the first: run 1 of "
        "results/result.feather, seed 1, is now that of seed 3: exit code 3\n",
    )
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert "seed" not in rows
    assert metadata["combinations"][0]["seeds"] == [0, 3]


def test_replaced_runs_count_when_the_same_command_continues_and_only_then(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    (tmp_path / "broken").touch()
    lines = '[ "$seed" = 1 ] && exit 3; [ -e "$(dirname $0)/broken" ] && [ $((seed % 3)) = 0 ] && exit 4'
    program = script(tmp_path / "flaky", lines)
    failed = subcommand(tmp_path, "run", "-r", "3", "-R", "2", "--keep-temp", program=program)
    assert failed.code == 3
    assert "run 0 of results/result.feather, seed 0, failed 3 times: exit code 4" in failed.errors
    (tmp_path / "broken").unlink()
    again = subcommand(tmp_path, "run", "-r", "3", "-R", "2", "--keep-temp", program=program)
    assert again.code == 0
    assert "2 of 3 runs are done already" in again.output
    assert runs_in(tmp_path) == [[0, 0, 0], [1, 4, 1], [2, 2, 0]]
    # With more runs, the replacement is another seed: 4 would be run 4's own.
    more = subcommand(tmp_path, "run", "-r", "5", "-R", "2", "--keep-temp", program=program)
    assert "2 of 5 runs are done already" in more.output
    assert runs_in(tmp_path) == [[0, 0, 0], [1, 6, 1], [2, 2, 0], [3, 3, 0], [4, 4, 0]]


def test_run_without_room_for_another_seed_is_tried_once(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    result = subcommand(tmp_path, "run", "--seed", str(LARGEST), program=script(tmp_path / "broken", "exit 5"))
    assert result.code == 3
    assert f"run 0 of results/result.feather, seed {LARGEST}, failed 1 time: exit code 5" in result.errors
    assert subcommand(tmp_path, "run", "--seed", str(LARGEST)).code == 0
    assert runs_in(tmp_path) == [[0, LARGEST, 0]]


def test_lists_of_seeds_are_whole_numbers_each_once() -> None:
    assert list(listed_seeds(np.array([3, 1]), "seeds")) == [3, 1]
    assert listed_seeds(range(5, 2, -1), "seeds") == range(5, 2, -1)
    for wrong in ([1.5], [True], ["1"], [-1], [2**32], [], [1, 2, 1], "12", 5, range(-1, 2)):
        with pytest.raises(BatchError, match=r"^seeds: "):
            listed_seeds(wrong, "seeds")  # type: ignore[arg-type]
    with pytest.raises(BatchError, match="seed 1 is there twice"):
        listed_seeds([1, 2, 1], "seeds")
    assert seeds_between(" 3 : 4 ", "seeds") == range(3, 5)


def test_column_of_the_seed_is_that_of_the_run(tmp_path: Path) -> None:
    write_options(tmp_path, {**ONE, "result_new_columns": ["seed", "arena_file"]})
    result = subcommand(tmp_path, "run", "--seeds", "8:9")
    assert result.code == 0
    assert result.errors.count("the column 'seed' has that of each run") == 1
    assert runs_in(tmp_path) == [[0, 8, 0], [1, 9, 0]]


def test_python_file_is_run_by_the_python_that_runs_now(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    program = tmp_path / "program.py"
    program.write_text(
        "import os, sys\n"
        f"open({str(tmp_path / 'python')!r}, 'w').write(sys.executable)\n"
        f"os.execv({str(example('helloworld'))!r}, ['helloworld', *sys.argv[1:]])\n"
    )
    assert run_main(tmp_path, ["run", "-c", "many.yaml", "-S", "program.py", "-o", "results"], main).code == 0
    assert runs_in(tmp_path) == [[0, 0, 0]]
    assert Path((tmp_path / "python").read_text()).samefile(sys.executable)


def test_configuration_that_is_refused_for_one_seed_is_tried_with_another(tmp_path: Path) -> None:
    write_options(tmp_path, ONE)
    refused = script(tmp_path / "refused", '[ "$seed" -lt 2 ] && { echo "Error: $2: no place for robots"; exit 2; }')
    assert subcommand(tmp_path, "run", "-r", "2", program=refused).code == 0
    assert runs_in(tmp_path) == [[0, 2, 1], [1, 3, 1]]
    same = subcommand(tmp_path, "run", "-r", "2", "--retry-same-seed", program=refused)
    assert same.errors.count("failed 1 time: exit code 2") == 2
