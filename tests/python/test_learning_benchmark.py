"""`python -m pogosim.learning.benchmark`: its table, its file, and wrong arguments."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from pogosim.learning import benchmark
from pogosim.learning.benchmark import LEARNERS, Result, main, measure, table
from pogosim.learning.learners.running import Generation
from pogosim.learning.perceptron import perceptron_of
from pogosim.learning.tasks import TASKS, BenchmarkTask

SHORT: dict[str, Any] = {"end": 0.4, "threads": 1}


def idle(task: BenchmarkTask, budget: int, _seed: int, **options: Any) -> Iterator[Generation]:
    """Return weights of 0 after each episode."""
    with task.make_env(**options) as env:
        size = perceptron_of(env).size
    for episode in range(1, budget + 1):
        yield Generation(episode, np.zeros(1), np.zeros(size))


def code_of(command: Callable[[], int]) -> int:
    """Return the exit code of a command line."""
    try:
        return command()
    except SystemExit as end:  # of its parser
        return int(end.code or 0)


def test_table_has_the_mean_of_the_last_tests_and_its_interval() -> None:
    found = [
        Result("coverage", "cma_es", seed, episodes, score)
        for seed, scores in ((1, (0.1, 0.5)), (2, (0.9, 0.7)))
        for episodes, score in zip((32, 64), scores, strict=True)
    ]
    # Student's t for two values: 12.706 x 0.1 on either side.
    assert table(found)[2:] == ["| coverage | cma_es | 0.600 | -0.671 to 1.871 | 64 |"]
    assert table(found[:2])[2:] == ["| coverage | cma_es | 0.500 | of one seed: none | 64 |"]


def test_all_learners_do_all_tasks_and_equal_seeds_give_equal_scores() -> None:
    said: list[str] = []
    found = measure([*TASKS], [*LEARNERS], 32, [3], said.append, **SHORT)
    again = measure([*TASKS], [*LEARNERS], 32, [3], said.append, **SHORT)
    assert found == again
    policies = ["random", "by hand", *LEARNERS]
    assert len(said) == 2 * len(TASKS) * len(policies)
    rows = table(found)[2:]
    assert [row.split(" | ")[:2] for row in rows] == [[f"| {task}", policy] for task in TASKS for policy in policies]
    assert all(0 <= result.score <= 1 for result in found)
    assert {result.episodes for result in found if result.policy in LEARNERS} >= {32}


def test_learner_of_ones_own_is_one_more_entry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(LEARNERS, "idle", idle)
    found = measure(["phototaxis"], ["idle"], 20, [1], lambda _line: None, **SHORT)
    tests = [result.episodes for result in found if result.policy == "idle"]
    assert tests == [*range(2, 21, 2)]  # ten, at equal distances


def test_file_has_each_test_in_a_row(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(LEARNERS, "idle", idle)
    file = tmp_path / "scores.csv"
    options = ["--tasks", "phototaxis", "--learners", "idle", "--budget", "2", "--seeds", "2", "-o", str(file)]
    assert main(options) == 0
    rows = pd.read_csv(file)
    assert [*rows] == ["task", "policy", "seed", "episodes", "score"]
    assert rows["seed"].tolist() == [1] * 4 + [2] * 4
    lines = capsys.readouterr().out.splitlines()
    last = rows[~rows.duplicated(["seed", "policy"], keep="last")]
    assert [line.rpartition(",")[0] for line in lines[:6]] == [
        f"phototaxis, seed {seed}: {policy} {score:.3f}"
        for policy, seed, score in zip(last["policy"], last["seed"], last["score"], strict=True)
    ]
    assert lines[6] == ""
    assert len(lines) == 7 + 2 + 3


def test_benchmark_that_is_interrupted_keeps_its_results(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_task: object, **_options: object) -> Iterator[Generation]:
        raise KeyboardInterrupt

    monkeypatch.setitem(LEARNERS, "interrupted", interrupted)
    file = tmp_path / "scores.csv"
    assert main(["--tasks", "phototaxis", "--learners", "interrupted", "--budget", "2", "-o", str(file)]) == 130
    assert pd.read_csv(file)["policy"].tolist() == ["random", "by hand"]
    warned, told = capsys.readouterr().err.splitlines()
    assert warned.endswith(f"warning: {file} has 2 results")
    assert told.endswith("interrupted")
    assert [*tmp_path.iterdir()] == [file]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--tasks", "coverage,fototaxis"], "--tasks: there is no 'fototaxis'; did you mean 'phototaxis'?"),
        (["--learners", "cma"], "--learners: there is no 'cma'"),
        (["--tasks", "phototaxis", "--budget", "5"], "cma_es: --budget: 5 episodes are too few for a generation "),
        (["--budget", "0"], "'0' is not a whole number of 1 or more"),
        (["--seeds", "0"], "'0' is not a whole number from 1 to 1000"),
        (["--seed", "2147483646", "--seeds", "2"], "--seed: expected 2147483645 at most for 2 seeds"),
        (["-o", "scores.txt"], "scores.txt does not end in .csv"),
        (["-o", "nowhere/scores.csv"], "nowhere/scores.csv cannot be written: there is no folder "),
    ],
)
def test_wrong_arguments_are_one_line(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert code_of(lambda: main(arguments)) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("python -m pogosim.learning.benchmark: ")
    assert said in line


def test_missing_package_is_told_before_anything_is_learnt(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    assert main([]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "map_elites: this learner needs the Python package 'ribs'; install it: " in printed.err
    assert benchmark.PACKAGES.keys() <= LEARNERS.keys()
