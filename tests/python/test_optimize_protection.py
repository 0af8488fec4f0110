"""What searches do not lose: inputs, files beside their results, and results when something strange happens."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
from searches import OBJECTIVE, history, search, summary, write_search

QUICK = ("--max-evals", "4", "--final-runs", "1")
ARCHIVE = ("--optimizer", "mapelites", "--qd-init-samples", "3", "--qd-shape", "3,3")


# ---- Files of the user ----


@pytest.mark.parametrize("name", ["best_config.yaml", "opt_history.csv", "archive.pdf", "search.jsonl"])
def test_configuration_in_the_place_of_a_result_is_not_overwritten(name: str, tmp_path: Path) -> None:
    text = write_search(tmp_path).read_text()
    own = tmp_path / "own" / name
    own.parent.mkdir()
    own.write_text(text)
    result = search(tmp_path, *QUICK, "-c", f"own/{name}", "-o", "own")
    assert result.code == 2
    assert f"own/{name} is an input that own/{name} would replace; choose another folder with -o" in result.errors
    assert own.read_text() == text


def test_configuration_is_not_overwritten_through_a_link(tmp_path: Path) -> None:
    text = write_search(tmp_path).read_text()
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "best_config.yaml").symlink_to("../space.yaml")
    assert search(tmp_path, *QUICK, "-o", "own").code == 2
    assert (tmp_path / "space.yaml").read_text() == text


def test_files_beside_elites_stay_and_an_input_there_is_refused(tmp_path: Path) -> None:
    text = write_search(tmp_path).read_text()
    elites = tmp_path / "own" / "elites"
    elites.mkdir(parents=True)
    for name in ("thesis.txt", "conf.yaml", "07_07.yaml"):
        (elites / name).write_text(text)
    assert search(tmp_path, *QUICK, *ARCHIVE, "-c", "own/elites/conf.yaml", "-o", "own").code == 2
    assert search(tmp_path, *QUICK, *ARCHIVE, "-o", "own").code == 0
    assert {"thesis.txt", "conf.yaml"} < {path.name for path in elites.iterdir()}
    # What an earlier search has left there goes.
    table = pd.read_csv(tmp_path / "own" / "archive.csv")
    assert {f"elites/{path.name}" for path in elites.glob("0*.yaml")} == set(table["config"])


def test_search_in_which_all_fail_does_not_pass_off_earlier_results_as_its_own(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, *QUICK).code == 0
    write_search(tmp_path, objective="def objective_fn(df): raise ValueError")
    assert search(tmp_path, *QUICK).code == 3
    left = sorted(path.name for path in (tmp_path / "opt_out").iterdir())
    assert left == ["opt_history.csv", "opt_history.feather", "search.jsonl", "summary.json"]
    assert summary(tmp_path)["status"] == "failed"


# ---- Strange functions ----


def test_objective_may_have_dataclasses(tmp_path: Path) -> None:
    lines = """
from __future__ import annotations
from dataclasses import dataclass

@dataclass
class Weights:
    a: int = 3

def objective_fn(df):
    return Weights().a
"""
    write_search(tmp_path, objective=lines)
    assert search(tmp_path, *QUICK).code == 0
    assert history(tmp_path)["fitness"].tolist() == [3.0] * 4


def test_objective_that_changes_the_working_folder_changes_nothing_else(tmp_path: Path) -> None:
    write_search(tmp_path, objective=f"import os\n{OBJECTIVE}".replace("    p = ", "    os.chdir('/')\n    p = "))
    assert search(tmp_path, *QUICK).code == 0
    assert summary(tmp_path)["evaluations"] == 4


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        ("return 1.7e308", "the objective returned 1.7e+308"),
        ("return 10 ** 400", "the objective raised OverflowError: int too large to convert to float"),
        ("raise ValueError('\\udcff bad')", "the objective raised ValueError: \\udcff bad"),
        ("raise type('Own', (BaseException,), {})('mine')", "the objective raised Own: mine"),
    ],
)
def test_strange_objective_is_a_problem_of_its_candidate(body: str, problem: str, tmp_path: Path) -> None:
    write_search(tmp_path, objective=f"def objective_fn(df): {body}")
    result = search(tmp_path, *QUICK)
    assert result.code == 3
    assert "Traceback" not in result.errors
    assert history(tmp_path)["problem"].str.startswith(problem).all()


def test_features_may_have_the_names_of_columns(tmp_path: Path) -> None:
    names = OBJECTIVE.replace('"a":', '"fitness":').replace('"b": p', '"eval": p')
    write_search(tmp_path, objective=names)
    assert search(tmp_path, *QUICK, *ARCHIVE).code == 0
    table = pd.read_feather(tmp_path / "opt_out" / "opt_history.feather")
    assert table["eval"].tolist() == [1, 2, 3, 4]
    assert table["fitness"].tolist() == pytest.approx(history(tmp_path)["fitness"].tolist())
    features = [json.loads(text)["fitness"] for text in history(tmp_path)["features"]]
    assert table["user.fitness"].tolist() == pytest.approx(features)


def test_failures_of_runs_that_differ_in_values_only_are_said_once(tmp_path: Path) -> None:
    # The program wants a number for this key.
    choices = {"choices": ["abc", "def", "ghi", "jkl", "mno"]}
    write_search(
        tmp_path, {"objects.robots.radius": {"optimization_domain": choices}}, "def objective_fn(df): return 1"
    )
    result = search(tmp_path, "--max-evals", "8", "--optimizer", "random", "-R", "0")
    assert result.code == 3
    assert result.errors.count("a candidate has failed") == 1
    assert "space.yaml:" in result.errors
    assert "/sim_" not in result.errors


# ---- Strange numbers and texts ----


def test_choices_may_be_larger_than_columns_hold(tmp_path: Path) -> None:
    write_search(
        tmp_path,
        {"parameters": {"a": {"optimization_domain": {"choices": [10**20, 1]}}}},
        "def objective_fn(df): return 1",
    )
    assert search(tmp_path, *QUICK, "--optimizer", "random").code == 0
    table = pd.read_feather(tmp_path / "opt_out" / "opt_history.feather")
    assert set(table["parameters.a"]) <= {"1", str(10**20)}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"parameters": {"a": {"optimization_domain": {"type": "int", "min": 0, "max": 10**20}}}},
            "max: expected a whole number, found 100000000000000000000",
        ),
        ({"optimization": {"cmaes": {"sigma0": int("9" * 400)}}}, "expected a number from 1e-06 to 10, found 999"),
    ],
)
def test_number_that_is_too_large_is_one_line(changes: dict[str, object], message: str, tmp_path: Path) -> None:
    write_search(tmp_path, changes)
    result = search(tmp_path, *QUICK)
    assert result.code == 2
    assert message in result.errors


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('x: "a\0b"', "space.yaml is not valid YAML: unacceptable character #x0000"),
        ('x: "\\ud800"', "space.yaml: a value is no text in UTF-8 (such as \\ud800)"),
    ],
)
def test_text_that_no_file_can_have_is_one_line(line: str, message: str, tmp_path: Path) -> None:
    path = write_search(tmp_path)
    path.write_text(f"{path.read_text()}{line}\n")
    result = search(tmp_path, *QUICK)
    assert result.code == 2
    assert message in result.errors


@pytest.mark.parametrize(
    ("name", "value"), [("fitness", "abc"), ("features", None), ("values", [1, 2]), ("point", [None]), ("number", "1")]
)
def test_journal_with_a_wrong_entry_is_one_line(name: str, value: object, tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, *QUICK).code == 0
    path = tmp_path / "opt_out" / "search.jsonl"
    lines = path.read_text().splitlines()
    lines[1] = json.dumps({**json.loads(lines[1]), name: value})
    path.write_text("\n".join(lines) + "\n")
    result = search(tmp_path, "--max-evals", "6", "--resume")
    assert result.code == 2
    assert "opt_out/search.jsonl:2: not a line of a search; remove it" in result.errors


def test_journal_that_is_nested_without_end_is_one_line(tmp_path: Path) -> None:
    write_search(tmp_path)
    path = tmp_path / "opt_out" / "search.jsonl"
    path.parent.mkdir()
    path.write_text("[" * 200_000 + "\n")
    result = search(tmp_path, *QUICK, "--resume")
    assert result.code == 2
    assert "opt_out/search.jsonl:1: not a line of a search" in result.errors
