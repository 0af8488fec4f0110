"""Searches that were interrupted: what they leave, and that they come to the same end."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pandas as pd
import pytest
from batches import ENVIRONMENT, ended, wait_until_gone
from searches import COMMAND, OBJECTIVE, history, options, search, write_search

QUALITY_DIVERSITY = ("--optimizer", "mapelites", "--qd-init-samples", "8", "--qd-batch", "5", "--qd-shape", "4,4")


def start(folder: Path, *more: str) -> subprocess.Popen[bytes]:
    """Start a search, to be disturbed."""
    command = [*COMMAND, *options(*more)]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def evaluations(folder: Path) -> int:
    """Return how many evaluations are written down."""
    path = folder / "opt_out" / "search.jsonl"
    return max(0, path.read_bytes().count(b"\n") - 1) if path.exists() else 0


def wait_for(folder: Path, process: subprocess.Popen[bytes], count: int) -> None:
    """Wait until some evaluations are written down, or the search has ended."""
    while process.poll() is None and evaluations(folder) < count:
        time.sleep(0.005)


def same_results(folder: Path, other: Path) -> None:
    """Check that two searches came to the same end."""
    pd.testing.assert_frame_equal(history(folder), history(other))
    for name in ("best_config.yaml", "best_results.feather", "fitness_vs_eval.png", "archive.csv"):
        one, two = folder / "opt_out" / name, other / "opt_out" / name
        assert one.exists() == two.exists()
        assert not one.exists() or one.read_bytes() == two.read_bytes(), name


@pytest.mark.parametrize(
    "more", [(), QUALITY_DIVERSITY, ("--optimizer", "tpe", "--seeds", "fresh"), ("--save-states", "0")]
)
def test_search_that_is_killed_at_random_moments_comes_to_the_same_end(more: tuple[str, ...], tmp_path: Path) -> None:
    options_ = ("--max-evals", "23", "--final-runs", "2", *more)
    for name in ("whole", "killed"):
        write_search(tmp_path / name)
    assert search(tmp_path / "whole", *options_).code == 0
    folder = tmp_path / "killed"
    chance = random.Random(str(more))
    kills = 0
    for count in sorted(chance.sample(range(1, 23), 2)):
        process = start(folder, *options_, "--resume")
        wait_for(folder, process, count)
        time.sleep(chance.uniform(0.0, 0.1))
        os.kill(process.pid, signal.SIGKILL)
        process.communicate()
        kills += process.returncode == -signal.SIGKILL
        wait_until_gone(folder)
    assert kills == 2
    result = search(folder, *options_, "--resume")
    assert result.code == 0
    assert "[INFO] Resuming: " in result.errors
    same_results(tmp_path / "whole", folder)
    assert not (folder / "tmp").exists()


def test_ctrl_c_ends_a_search_in_good_order(tmp_path: Path) -> None:
    write_search(tmp_path)
    process = start(tmp_path, "--max-evals", "200")
    wait_for(tmp_path, process, 3)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors.decode().splitlines()[-1].endswith("interrupted; the same command with --resume continues")
    wait_until_gone(tmp_path)


def test_longer_search_goes_on_where_a_shorter_one_ended(tmp_path: Path) -> None:
    for name in ("whole", "longer"):
        write_search(tmp_path / name)
    assert search(tmp_path / "whole", "--max-evals", "20", "--final-runs", "2").code == 0
    # Neither number is a multiple of the population of 7.
    assert search(tmp_path / "longer", "--max-evals", "11", "--final-runs", "2").code == 0
    assert search(tmp_path / "longer", "--max-evals", "20", "--final-runs", "2", "--resume").code == 0
    same_results(tmp_path / "whole", tmp_path / "longer")


def test_line_that_is_not_complete_does_not_count(tmp_path: Path) -> None:
    for name in ("whole", "torn"):
        write_search(tmp_path / name)
        assert search(tmp_path / name, "--max-evals", "10", "--final-runs", "2").code == 0
    path = tmp_path / "torn" / "opt_out" / "search.jsonl"
    path.write_bytes(path.read_bytes()[: -len(path.read_bytes()) // 3])
    assert not path.read_bytes().endswith(b"\n")
    assert search(tmp_path / "torn", "--max-evals", "10", "--final-runs", "2", "--resume").code == 0
    same_results(tmp_path / "whole", tmp_path / "torn")


def test_resuming_a_search_that_is_complete_does_it_not_again(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "6", "--final-runs", "2").code == 0
    before = pd.read_csv(tmp_path / "opt_out" / "opt_history.csv")  # with the times
    assert search(tmp_path, "--max-evals", "6", "--final-runs", "2", "--resume").code == 0
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "opt_out" / "opt_history.csv"), before)


def test_search_that_is_not_finished_is_not_overwritten_and_one_that_is_can_be(tmp_path: Path) -> None:
    write_search(tmp_path)
    process = start(tmp_path, "--max-evals", "200")
    wait_for(tmp_path, process, 8)
    process.kill()
    process.communicate()
    journal = tmp_path / "opt_out" / "search.jsonl"
    before = journal.read_bytes()
    result = search(tmp_path, "--max-evals", "4")
    assert result.code == 2
    assert "opt_out has a search that is not finished, with " in result.errors
    assert "--resume continues it; for another one, choose another folder with -o" in result.errors
    assert journal.read_bytes() == before
    assert search(tmp_path, "--max-evals", "4", "--final-runs", "1", "-o", "other").code == 0
    assert search(tmp_path, "--max-evals", "5", "--final-runs", "1", "-o", "other").code == 0
    assert len(history(tmp_path, "other")) == 5


def test_mistake_leaves_the_results_of_an_earlier_search(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "4", "--final-runs", "1").code == 0
    before = {path: path.read_bytes() for path in (tmp_path / "opt_out").iterdir()}
    for wrong in (["--optimizer", "sgd"], ["-S", "none"], ["-O", "none.py"]):
        assert search(tmp_path, *wrong).code == 2
    assert {path: path.read_bytes() for path in (tmp_path / "opt_out").iterdir()} == before


@pytest.mark.parametrize(
    ("more", "objective", "message"),
    [
        (["--seed", "1"], OBJECTIVE, "seed was 42, and is 1 now"),
        (["--optimizer", "random"], OBJECTIVE, "optimizer was cmaes, and is random now"),
        (["-r", "2"], OBJECTIVE, "runs was 1, and is 2 now"),
        ([], OBJECTIVE + "# changed", "the objective has changed"),
    ],
)
def test_another_search_is_not_resumed(more: list[str], objective: str, message: str, tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "4", "--final-runs", "1").code == 0
    write_search(tmp_path, objective=objective)
    result = search(tmp_path, "--max-evals", "6", "--resume", *more)
    assert result.code == 2
    assert f"--resume: opt_out has another search: {message}" in result.errors


def test_search_is_not_resumed_when_a_module_of_the_objective_has_changed(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "deep.py").write_text("WEIGHT = 1.0\n")
    (tmp_path / "helper.py").write_text("from lib.deep import WEIGHT\n")
    write_search(tmp_path, objective="import helper\n\ndef objective_fn(df): return helper.WEIGHT\n")
    command = [*COMMAND, *options("--max-evals", "3", "--optimizer", "random", "--final-runs", "1")]
    assert ended(command, tmp_path).code == 0
    resumed = ended([*command, "--resume"], tmp_path)
    assert resumed.code == 0, resumed.text
    for module in ("helper.py", "lib/deep.py"):
        path = tmp_path / module
        before = path.read_text()
        path.write_text(before + "# changed\n")
        result = ended([*command, "--resume"], tmp_path)
        path.write_text(before)
        assert result.code == 2
        assert f"--resume: opt_out has another search: the objective's module {module} has changed; " in result.errors


@pytest.mark.parametrize("line", ["no json\n", "[1, 2]\n", '{"number": 1}\n', '{"version": 99}\n'])
def test_file_that_is_no_journal_is_one_line_and_stays(line: str, tmp_path: Path) -> None:
    write_search(tmp_path)
    path = tmp_path / "opt_out" / "search.jsonl"
    path.parent.mkdir()
    path.write_text(line)
    for more in ([], ["--resume"]):
        result = search(tmp_path, "--max-evals", "4", *more)
        assert result.code == 2
        assert f"{path.relative_to(tmp_path)}:1: not a line of a search" in result.errors
        assert path.read_text() == line


def test_two_searches_do_not_write_into_one_folder(tmp_path: Path) -> None:
    write_search(tmp_path)
    process = start(tmp_path, "--max-evals", "500")
    wait_for(tmp_path, process, 1)
    result = search(tmp_path, "--max-evals", "4", "-t", "other")
    process.kill()
    process.communicate()
    assert result.code == 2
    assert "another search is writing to opt_out; wait for it, or choose another folder with -o" in result.errors


def test_journal_has_what_was_asked_and_what_came_out(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "5", "--final-runs", "1").code == 0
    first, *lines, last = map(json.loads, (tmp_path / "opt_out" / "search.jsonl").read_text().splitlines())
    assert (first["optimizer"], first["seed"], last) == ("cmaes", 42, {"end": 5})
    assert sorted(line["number"] for line in lines) == [1, 2, 3, 4, 5]
    table = history(tmp_path).set_index("eval")
    for line in lines:
        assert table["fitness"][line["number"]] == pytest.approx(line["fitness"])
        assert json.loads(table["values"][line["number"]]) == line["values"]
