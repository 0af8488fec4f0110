"""Searches whose configurations and scripts were written for the original simulator."""

from __future__ import annotations

import json
from argparse import Namespace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from batches import run_main, script
from pogosim.errors import OptimizeError
from pogosim.optimize.execution import workers_of
from pogosim.optimize.settings import Settings, settings_from
from pogosim.pogoptim import main
from running import example, scene
from searches import OBJECTIVE, SPACE, history, search, summary, write_search

# Returns the fitness and features, under the name that is tried first for a map.
PAIR = """
def compute_objective(df):
    p = df.attrs["resolved_configuration"]["parameters"]
    return 1.0 - p["a"] ** 2, [(p["a"] + 1.0) / 2.0, p["b"] / 20]

def objective_fn(df):
    raise ValueError("the other one")
"""
THEIRS: dict[str, Any] = {
    "algorithm": "mapelites",
    "budget": 12,
    "seed": 3,
    "runs": 2,
    "retries": 2,
    "retry_new_seed": True,
    "temp_base": "scratch",
    "keep_temp": True,
    "output_dir": "found",
    "parallelism": {"candidate_jobs": 2, "batch_jobs": 1},
    "objective": {"path": "theirs.py", "func": "compute_objective"},
    "qd": {"shape": [4, 4], "batch": 4, "init_samples": 6, "features_domain": [[0, 1], [0.0, 1.0]]},
    "final_runs": 0,
}


def theirs(folder: Path, changes: dict[str, Any], *more: str, program: Path | None = None, lines: str = PAIR) -> Any:
    """Run a search with a configuration of others in a folder."""
    (folder / "conf").mkdir(parents=True, exist_ok=True)
    (folder / "conf" / "theirs.py").write_text(lines)
    section = {key: value for key, value in {**THEIRS, **changes}.items() if value is not None}
    (folder / "conf" / "space.yaml").write_text(yaml.safe_dump(scene({**SPACE, "optimization": section})))
    words = ["-c", "conf/space.yaml", "-S", str(program or example("helloworld")), *more]
    return run_main(folder, words, main)


def settings(section: Any = None, **options: Any) -> Settings:
    """Return the settings of a section and of the command line; warnings are errors."""
    return settings_from(section, options, ".".join, pytest.fail)


def test_search_of_others_runs_as_it_is(tmp_path: Path) -> None:
    result = theirs(tmp_path, {})
    assert result.code == 0
    said = [line for line in result.errors.splitlines() if "[WARNING]" in line]
    assert ["never read by the program" in line for line in said] == [True], said
    assert (tmp_path / "scratch").is_dir()
    table = history(tmp_path, "found")
    assert list(pd.read_csv(tmp_path / "found" / "opt_history.csv").columns) == [
        *("eval", "fitness", "best_so_far", "u_internal", "values", "timestamp", "generation", "features", "problem"),
        *("status", "base_seeds", "effective_seeds", "max_retry_attempt", "error"),
    ]
    assert set(table["status"]) == {"success"}
    assert table["base_seeds"].tolist() == table["effective_seeds"].tolist() == ["[0, 1]"] * 12
    entries = summary(tmp_path, "found")
    expected = {
        "status": "complete",
        "optimizer": "mapelites",
        "budget": 12,
        "successful_evaluations": 12,
        "failed_evaluations": 0,
        "seed": 3,
        "seed_block_offset": 0,
        "runs": 2,
        "parallelism": {"candidate_jobs": 2, "batch_jobs": 1},
    }
    assert {key: entries[key] for key in expected} == expected
    assert entries["settings"]["retry_new_seed"] is True
    assert {"best_fitness", "best_values", "files", "qd"} <= set(entries)
    assert entries["qd"]["ranges"] == [[0, 1], [0, 1]]


def test_archive_of_others_has_the_elites_of_ours(tmp_path: Path) -> None:
    assert theirs(tmp_path, {"keep_temp": False}).code == 0
    ours = pd.read_csv(tmp_path / "found" / "archive.csv")
    own = pd.read_csv(tmp_path / "found" / "qd_archive.csv")
    assert list(own.columns) == ["fitness", "feature_0", "feature_1", "u_0", "u_1", "u_2", "values"]
    assert own["fitness"].tolist() == ours["fitness"].tolist()
    assert own["values"].tolist() == ours["values"].tolist()
    a = np.array([json.loads(text)["parameters.a"] for text in own["values"]])
    np.testing.assert_allclose(own["feature_0"], (a + 1.0) / 2.0)
    np.testing.assert_allclose(own["u_0"], (a + 1.0) / 2.0)
    assert not (tmp_path / "scratch").exists()


def test_candidates_with_features_outside_their_domain_have_failed(tmp_path: Path) -> None:
    assert theirs(tmp_path, {}, "--qd-features-domain", "0:0.6,0:1").code == 0
    table = history(tmp_path, "found")
    features = np.array([list(json.loads(text).values()) for text in table["features"]])
    is_outside = features[:, 0] > 0.6
    assert 0 < is_outside.sum() < 12
    assert (table["status"] == np.where(is_outside, "failed", "success")).all()
    assert table["fitness"].isna().tolist() == is_outside.tolist()
    said = table["error"][is_outside]
    assert said.str.fullmatch(r"feature 1 is 0\.\d+, outside its domain from 0 to 0\.6").all()
    assert summary(tmp_path, "found")["failed_evaluations"] == is_outside.sum()
    assert summary(tmp_path, "found")["qd"]["ranges"] == [[0, 0.6], [0, 1]]


@pytest.mark.parametrize("wrong", ["float('nan')", "float('inf')", "None", "'far'"])
def test_features_that_are_not_finite_fail_their_candidate(wrong: str, tmp_path: Path) -> None:
    lines = PAIR.replace('p["b"] / 20]', f'{wrong} if p["b"] > 10 else 0.5]')
    assert theirs(tmp_path, {}, lines=lines).code == 0
    table = history(tmp_path, "found")
    b = np.array([json.loads(text)["parameters.b"] for text in table["values"]])
    assert (table["status"] == np.where(b > 10, "failed", "success")).all()


def test_search_without_a_success_has_a_summary_that_says_so(tmp_path: Path) -> None:
    result = theirs(tmp_path, {"budget": 8}, "--qd-features-domain", "5:6,5:6")
    assert result.code == 3
    entries = summary(tmp_path, "found")
    assert (entries["status"], entries["successful_evaluations"], entries["failed_evaluations"]) == ("failed", 0, 8)


def test_map_of_the_objective_names_its_function_and_is_found_beside_the_configuration(tmp_path: Path) -> None:
    for number, objective in enumerate(({"path": "theirs.py"}, {"path": "conf/theirs.py"})):
        assert theirs(tmp_path / str(number), {"objective": objective}).code == 0
    both = theirs(tmp_path, {"objective": "theirs.py", "budget": 8})
    assert "ValueError: the other one" in both.errors
    named = theirs(tmp_path / "named", {"objective": {"path": "theirs.py", "func": "objective_fn"}, "budget": 8})
    assert "ValueError: the other one" in named.errors
    assert (
        theirs(
            tmp_path / "cli", {"objective": {"path": "theirs.py", "func": "f"}}, "--objective-func", "compute_objective"
        ).code
        == 0
    )
    missing = theirs(tmp_path / "missing", {"objective": {"path": "theirs.py", "func": "nothing"}})
    assert (missing.code, missing.errors.count("has no function nothing")) == (2, 1)


def test_failed_runs_have_other_seeds_of_the_block_of_their_candidate(tmp_path: Path) -> None:
    write_search(tmp_path, objective=OBJECTIVE)
    first = Settings(seeds="blocks", seed=42).first_seed
    # The second run of the third candidate, once, and the first run of the fourth, twice.
    failing = [first + 2 * 6 + 1, first + 3 * 6, first + 3 * 6 + 2]
    tests = " || ".join(f'[ "$seed" = {seed} ]' for seed in failing)
    flaky = script(tmp_path / "flaky", f"{{ {tests}; }} && exit 3")
    blocks = ("--seeds", "blocks", "-r", "2", "-R", "2", "--max-evals", "5", "--final-runs", "2")
    assert search(tmp_path, *blocks, "--retry-new-seed", program=flaky).code == 0
    table = history(tmp_path)
    base = [json.loads(text) for text in table["base_seeds"]]
    assert base == [[first + 6 * k, first + 6 * k + 1] for k in range(5)]
    effective = [json.loads(text) for text in table["effective_seeds"]]
    assert effective[2] == [base[2][0], base[2][1] + 2]
    assert effective[3] == [base[3][0] + 4, base[3][1]]
    assert [effective[k] for k in (0, 1, 4)] == [base[k] for k in (0, 1, 4)]
    assert table["max_retry_attempt"].tolist() == [0, 0, 1, 2, 0]
    assert summary(tmp_path)["best_fresh"]["seeds"] == [first + 30, first + 31]
    assert summary(tmp_path)["seed_block_offset"] == first

    fresh = search(tmp_path, *blocks, "--retry-same-seed", "-o", "same", program=flaky)
    assert fresh.code == 0
    failed = history(tmp_path, "same")["status"] == "failed"
    assert failed.tolist() == [False, False, True, True, False]


def test_seeds_of_candidates_do_not_meet() -> None:
    for policy, retries, new_seed in (
        ("blocks", 3, True),
        ("blocks", 3, False),
        ("fresh", 2, True),
        ("fresh", 2, False),
    ):
        own = Settings(seeds=policy, runs=4, retries=retries, retry_new_seed=new_seed, max_evals=10, final_runs=5)
        used = [
            seed + attempt * own.runs
            for number in range(1, 11)
            for seed in own.seeds_of(number)
            for attempt in range(retries + 1 if new_seed else 1)
        ]
        assert len(set(used)) == len(used)
        assert not set(used) & set(own.fresh_seeds)
        assert max(*used, *own.fresh_seeds) < own.first_seed + own.seed_count <= 2**32
    common = Settings(runs=4, final_runs=2)
    assert (common.seeds_of(1), common.seeds_of(9), common.fresh_seeds) == ([0, 1, 2, 3], [0, 1, 2, 3], [4, 5])
    assert Settings(seeds="fresh", runs=2).seeds_of(3) == [4, 5]
    assert Settings(seeds="blocks", seed=1).first_seed != Settings(seeds="blocks", seed=2).first_seed
    assert max(Settings(seeds="blocks", seed=seed).first_seed for seed in range(40)) < 2**31


def test_command_line_comes_before_the_configuration_and_that_before_what_is_usual() -> None:
    usual = settings()
    assert (usual.temp_base, usual.keep_temp, usual.retry_new_seed) == ("tmp_opt", False, False)
    section = {"temp_base": "a", "keep_temp": True, "retry_new_seed": True, "parallelism": {"batch_jobs": 3}}
    own = settings(section)
    assert (own.temp_base, own.keep_temp, own.retry_new_seed, own.batch_jobs, own.candidate_jobs) == (
        "a",
        True,
        True,
        3,
        1,
    )
    over = settings(section, temp_base="b", keep_temp=False, retry_new_seed=False, batch_jobs=0, candidate_jobs=4)
    assert (over.temp_base, over.keep_temp, over.retry_new_seed) == ("b", False, False)
    assert (over.batch_jobs, over.candidate_jobs) == (0, 4)
    assert settings({"qd": {"features_domain": [[0, 1]]}}).qd_features_domain == ((0.0, 1.0),)
    assert settings(qd_features_domain="0:1,-2:3").qd_features_domain == ((0.0, 1.0), (-2.0, 3.0))


def test_jobs_of_candidates_and_of_their_runs_are_runs_at_the_same_time() -> None:
    arguments = Namespace(
        workers=None,
        scheduler=None,
        isolated=False,
        save_states=None,
        slurm=False,
        jobqueue=None,
        jobqueue_jobs=None,
        jobqueue_set=None,
        **dict.fromkeys(
            f"slurm_{name}" for name in ("jobs", "cores", "memory", "time", "partition", "account", "option", "wait")
        ),
    )
    assert workers_of(arguments, settings()).number is None
    assert workers_of(arguments, settings(candidate_jobs=4)).number is None
    assert workers_of(arguments, settings(candidate_jobs=4, batch_jobs=2)).number == 8
    arguments.workers = 3
    assert workers_of(arguments, settings(candidate_jobs=4, batch_jobs=2)).number == 3


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ({"objective": {"path": 5}}, "optimization.objective.path: expected a text, found 5"),
        ({"objective": 5}, "optimization.objective: expected a text, found 5"),
        ({"parallelism": {"candidate_jobs": 0}}, "optimization.parallelism.candidate_jobs: expected a whole number"),
        ({"parallelism": {"batch_jobs": -1}}, "optimization.parallelism.batch_jobs: expected a whole number from 0"),
        ({"keep_temp": "maybe"}, "optimization.keep_temp: expected true or false, found 'maybe'"),
        ({"retry_new_seed": 1}, "optimization.retry_new_seed: expected true or false, found 1"),
        ({"qd": {"features_domain": [[1, 0]]}}, "optimization.qd.features_domain: expected the least and the greatest"),
        ({"qd": {"features_domain": [0, 1]}}, "optimization.qd.features_domain: expected the least and the greatest"),
        (
            {"qd": {"features_domain": [[0, 1]], "ranges": [[0, 1]]}},
            "optimization.qd.ranges and optimization.qd.features_domain both say the range of features",
        ),
        ({"seeds": "some"}, "optimization.seeds: expected common, fresh or blocks, found 'some'"),
        ({"seeds": "blocks", "budget": 10**7, "runs": 100}, "optimization.budget: 10000000 times 100 runs need more"),
    ],
)
def test_wrong_settings_are_named(section: dict[str, Any], said: str) -> None:
    with pytest.raises(OptimizeError) as caught:
        settings(section)
    assert said in str(caught.value)


def test_messages_name_a_setting_by_where_it_stands(tmp_path: Path) -> None:
    with pytest.raises(OptimizeError, match=r"^optimization\.qd\.ranges and --qd-features-domain both say"):
        settings({"qd": {"ranges": [[0, 1]]}}, qd_features_domain="0:1")
    assert settings({"seeds": "fresh"}, seeds="common").place_of("seeds") == "--seeds"
    assert settings({"seeds": "fresh"}) == Settings(seeds="fresh")
    shape = theirs(tmp_path, {"qd": {**THEIRS["qd"], "shape": [4]}})
    assert (shape.code, "optimization.qd.shape: there are 2 features" in shape.errors) == (2, True), shape.errors
    unknown = theirs(tmp_path / "unknown", {"algorithm": "sgd"})
    assert "optimization.algorithm: expected one of cmaes, random" in unknown.errors


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ({"bugdet": 3}, "optimization.bugdet: unknown key; did you mean 'budget'?"),
        ({"Runs": 3}, "optimization.Runs: unknown key; did you mean 'runs'?"),
        ({"parallelism": {"batch_job": 1}}, "optimization.parallelism.batch_job: unknown key; did you mean "),
        ({"qd": {"bach": 1}}, "optimization.qd.bach: unknown key; did you mean 'qd.batch'?"),
        ({"init_samples": 9}, "optimization.init_samples: unknown key; did you mean 'qd_init_samples'?"),
        ({"qd": {"budget": 9}}, "optimization.qd.budget: unknown key; did you mean 'budget'?"),
        (
            {"objective": {"path": "x", "function": "f"}},
            "optimization.objective.function: unknown key; expected path and func",
        ),
    ],
)
def test_slip_in_a_key_is_an_error_since_another_search_would_begin(section: dict[str, Any], said: str) -> None:
    with pytest.raises(OptimizeError) as caught:
        settings(section)
    assert said in str(caught.value)


def test_log_says_which_function_of_which_file_is_maximised(tmp_path: Path) -> None:
    both = "def objective_fn(df): return 1.0\ndef compute_objective(df): return 2.0\n"
    changes = {"algorithm": "random", "budget": 1, "qd": None, "objective": "theirs.py"}
    other = "(compute_objective is there, too; --objective-func chooses)"
    first = theirs(tmp_path, changes, lines=both)
    assert f"conf/theirs.py, objective_fn {other}\n" in first.errors
    assert "of the working folder" not in first.errors
    named = theirs(tmp_path, {**changes, "objective": {"path": "theirs.py", "func": "compute_objective"}}, lines=both)
    assert "conf/theirs.py, compute_objective\n" in named.errors
    (tmp_path / "theirs.py").write_text("def compute_objective(df): return 3.0\n")
    here = theirs(tmp_path, changes, lines=both)
    assert "[INFO] Objective: theirs.py, compute_objective\n" in here.errors
    assert "conf/theirs.py is not the objective, but theirs.py of the working folder: both have" in here.errors


def test_unknown_keys_of_the_maps_are_named() -> None:
    warnings: list[str] = []
    section = {"parallelism": {"candidates": 2}, "colour": 1, "qd": {"algo_kwargs": {}}}
    settings_from(section, {}, ".".join, warnings.append)
    assert [text.partition(":")[0] for text in warnings] == [
        *("optimization.parallelism.candidates", "optimization.colour", "optimization.qd.algo_kwargs")
    ]


def test_wrong_number_of_domains_is_an_error(tmp_path: Path) -> None:
    result = theirs(tmp_path, {}, "--qd-features-domain", "0:1")
    assert result.code == 2
    assert "--qd-features-domain: there are 2 features, so expected as many, such as 0:1,0:1" in result.errors


def test_search_begun_before_there_were_seeds_in_its_journal_is_continued(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "8", "--final-runs", "2").code == 0
    whole = history(tmp_path)
    journal = tmp_path / "opt_out" / "search.jsonl"
    first, *lines = [json.loads(line) for line in journal.read_text().splitlines()]
    assert not {"retry_new_seed", "qd_features_domain", "keep_temp", "objective_names"} & set(first)
    for line in lines:
        for name in ("base_seeds", "effective_seeds", "replacement"):
            line.pop(name, None)
    journal.write_text("".join(json.dumps(line) + "\n" for line in (first, *lines[:5])))
    assert search(tmp_path, "--max-evals", "8", "--final-runs", "2", "--resume").code == 0
    table = history(tmp_path)
    pd.testing.assert_series_equal(table["fitness"], whole["fitness"])
    known = {line["number"] for line in lines[:5]}
    assert table["base_seeds"].tolist() == ["[]" if number in known else "[0]" for number in table["eval"]]


def test_objective_sees_the_seeds_of_its_runs(tmp_path: Path) -> None:
    lines = """
def objective_fn(df):
    runs = df[["run", "seed", "retry_attempt"]].drop_duplicates()
    return float(runs["run"].sum() + 10 * runs["seed"].sum() + 100 * runs["retry_attempt"].sum())
"""
    write_search(tmp_path, objective=lines)
    flaky = script(tmp_path / "flaky", '[ "$seed" = 1 ] && exit 3')
    more = ("--max-evals", "2", "-r", "2", "--retry-new-seed", "--final-runs", "2")
    assert search(tmp_path, *more, program=flaky).code == 0
    assert history(tmp_path)["fitness"].tolist() == [1.0 + 10.0 * 3 + 100.0] * 2
    rows = pd.read_feather(tmp_path / "opt_out" / "best_results.feather")
    assert rows[["run", "seed", "retry_attempt"]].drop_duplicates().to_numpy().tolist() == [[0, 12, 0], [1, 13, 0]]
