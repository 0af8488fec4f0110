"""Searches as a user starts them: what they find, write and say."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from batches import run_main, script
from pogosim.batch.runs.attempts import command_of_users
from pogosim.confidence import mean_over_runs
from pogosim.pogoptim import main
from pogosim.utils import load_dataframe
from project import CLEAN
from running import build_folder, example, ran, run_command, write_scene
from searches import OBJECTIVE, history, options, search, summary, write_search

SIMULATING = CLEAN | {"POGOSIM_DIR": str(build_folder())}

# Chance that depends on the seed of the run alone: the same for all candidates that have the same seeds.
NOISY = """
import numpy as np
def objective_fn(df):
    return float(np.mean([rows["x"].iloc[0] for _, rows in df.groupby("run")]))
"""


def test_search_finds_the_best_values_and_says_so(tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, "--max-evals", "60", "--final-runs", "2")
    assert result.code == 0
    table = history(tmp_path)
    assert table["eval"].tolist() == list(range(1, 61))
    assert table["best_so_far"].tolist() == table["fitness"].cummax().tolist()
    assert table["fitness"].max() > 0.99
    entries = summary(tmp_path)
    assert entries["best_values"]["parameters.b"] == pytest.approx(12, abs=1)
    assert entries["best_values"]["parameters.c"] == "green"
    assert (entries["best_fitness"], entries["evaluations"]) == (table["fitness"].max(), 60)
    lines = [line.partition("] ")[2] for line in result.errors.splitlines()]
    assert lines[0] == "[INFO] Objective: obj.py, objective_fn"
    assert lines[1] == "[INFO] Starting the search: CMAES | dim=3 | max_evals=60 (normalised space)"
    first = table["fitness"][:8]
    numbers = "/".join(f"{value:.6g}" for value in (first.max(), first.mean(), first.min()))
    assert f"[INFO] gen 001: pop=8  f[best/mean/min]=[{numbers}]  best_so_far={first.max():.6g}" in lines
    assert lines[-2] == f"[INFO] Best values: {json.dumps(entries['best_values'])}"


def test_folder_of_a_search_has_all_that_it_found(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "8", "--final-runs", "3", "-r", "2").code == 0
    folder = tmp_path / "opt_out"
    assert {path.name for path in folder.iterdir()} == {
        "best_config.yaml",
        "best_results.feather",
        "fitness_vs_eval.pdf",
        "fitness_vs_eval.png",
        "opt_history.csv",
        "opt_history.feather",
        "search.jsonl",
        "summary.json",
    }
    assert not (tmp_path / "tmp").exists()
    rows, metadata = load_dataframe(folder / "best_results.feather")
    assert sorted(rows["run"].unique()) == [0, 1, 2]
    assert (rows["arena_file"] == "disk").all()
    assert metadata["configuration"] == yaml.safe_load((folder / "best_config.yaml").read_text())
    assert metadata["combinations"][0]["seeds"] == [2, 3, 4]
    table = pd.read_feather(folder / "opt_history.feather")
    csv = history(tmp_path)
    np.testing.assert_allclose(table["fitness"], csv["fitness"])
    assert [json.loads(text) for text in csv["values"]] == [
        {f"parameters.{name}": row[f"parameters.{name}"] for name in "abc"} for row in table.to_dict("records")
    ]


def test_best_configuration_runs_in_the_simulator_as_it_is(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "4", "--final-runs", "0").code == 0
    result = run_command(example("helloworld"), tmp_path, ["-c", "opt_out/best_config.yaml", "-g", "-s", "0"])
    assert result.code == 0
    assert not (tmp_path / "opt_out" / "best_results.feather").exists()
    parameters = load_dataframe(tmp_path / "data.feather")[1]["configuration"]["parameters"]
    assert {f"parameters.{name}": value for name, value in parameters.items()} == summary(tmp_path)["best_values"]


def test_search_needs_no_program_where_the_simulator_needs_none(tmp_path: Path) -> None:
    """The command that it tells at the end runs what it has found."""
    brain = {"script": [{"time_s": 0, "motors": [500, 500, 0]}]}
    speed = {"optimization_domain": {"type": "float", "min": 10, "max": 100}}
    scene = {"simulation_time": 0.5, "objects.robots.brain": brain, "objects.robots.max_linear_speed": speed}
    write_scene(tmp_path, scene)
    words = ["-c", "scene.yaml", "--max-evals", "2", "--final-runs", "0", "-o", "opt_out"]
    result = run_main(tmp_path, words, main)
    assert result.code == 0, result.errors
    (command,) = re.findall(r"run it: pogosim (.*)$", result.errors, re.MULTILINE)
    done = ran(tmp_path, sys.executable, "-m", "pogosim", *command.split(), "-g", "-q", env=SIMULATING)
    assert (done.code, done.errors) == (0, "")
    write_scene(tmp_path, scene | {"objects.robots.brain": "program"})
    refused = run_main(tmp_path, [*words[:-1], "other"], main)
    assert refused.code == 2
    assert "-S/--simulator-binary; category 'robots' needs a program, and none is given: " in refused.errors


def test_command_of_a_search_names_what_pogosim_run_takes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    best = Path("out") / "best_config.yaml"
    for name in ("robot.elf", "my program", "own.py"):
        Path(name).touch()
    assert command_of_users("robot.elf", best) == "pogosim run robot.elf -c out/best_config.yaml"
    assert command_of_users("my program", best) == "pogosim run 'my program' -c out/best_config.yaml"
    assert command_of_users("own.py", best) == "python own.py -c out/best_config.yaml"


def test_history_and_results_are_the_same_whatever_the_number_of_workers(tmp_path: Path) -> None:
    for workers in ("1", "3"):
        write_search(tmp_path / workers, objective=NOISY)
        assert search(tmp_path / workers, "--max-evals", "12", "-r", "2", "-j", workers, "--final-runs", "2").code == 0
    one, three = (tmp_path / workers / "opt_out" for workers in ("1", "3"))
    pd.testing.assert_frame_equal(history(one.parent), history(three.parent))
    for name in ("best_config.yaml", "best_results.feather", "fitness_vs_eval.png"):
        assert (one / name).read_bytes() == (three / name).read_bytes()


def test_dask_does_the_runs_of_a_search(tmp_path: Path) -> None:
    for backend in ("sequential", "dask"):
        write_search(tmp_path / backend, objective=NOISY)
        more = ("--backend", backend, "--seeds", "fresh")
        assert search(tmp_path / backend, "--max-evals", "9", "--final-runs", "2", *more).code == 0
    pd.testing.assert_frame_equal(history(tmp_path / "sequential"), history(tmp_path / "dask"))


# ---- Noise ----


def test_all_candidates_have_the_same_seeds_unless_told_otherwise(tmp_path: Path) -> None:
    write_search(tmp_path, objective=NOISY)
    for seeds in ("common", "fresh"):
        assert search(tmp_path, "--max-evals", "8", "--seeds", seeds, "-o", seeds, "--final-runs", "2").code == 0
    # No program reads the parameters: what differs is chance alone.
    assert history(tmp_path, "common")["fitness"].nunique() == 1
    assert history(tmp_path, "fresh")["fitness"].nunique() == 8


def test_mean_on_fresh_seeds_is_reported_with_its_interval(tmp_path: Path) -> None:
    write_search(tmp_path, objective=NOISY)
    result = search(tmp_path, "--max-evals", "4", "-r", "2", "--final-runs", "5")
    fresh = summary(tmp_path)["best_fresh"]
    assert fresh["seeds"] == [2, 3, 4, 5, 6]
    rows, _ = load_dataframe(tmp_path / "opt_out" / "best_results.feather")
    starts = [own["x"].iloc[0] for _, own in rows.groupby("run")]
    np.testing.assert_allclose(fresh["fitness"], starts)
    row = mean_over_runs(pd.DataFrame([starts])).iloc[0]
    assert (fresh["mean"], fresh["low_95"], fresh["high_95"]) == pytest.approx((row["mean"], row["low"], row["high"]))
    said = (
        f"Done. Best fitness: {row['mean']:.6g} on 5 fresh seeds (95 % interval {row['low']:.6g} to {row['high']:.6g})"
    )
    assert said in result.errors


def test_fresh_seeds_are_those_that_no_candidate_had(tmp_path: Path) -> None:
    write_search(tmp_path, objective=NOISY)
    assert search(tmp_path, "--max-evals", "5", "-r", "2", "--seeds", "fresh", "--final-runs", "3").code == 0
    assert summary(tmp_path)["best_fresh"]["seeds"] == [10, 11, 12]


def test_search_in_which_nothing_makes_a_difference_says_so(tmp_path: Path) -> None:
    write_search(tmp_path, objective="def objective_fn(df): return 24")
    result = search(tmp_path, "--max-evals", "8", "--final-runs", "1")
    assert result.code == 0
    assert "[WARNING] all candidates have the same fitness, 24: does the objective depend on" in result.errors
    assert "does the program read parameters.a, parameters.b, parameters.c?" in result.errors


def test_search_replaces_an_earlier_one_as_a_whole_and_says_so(tmp_path: Path) -> None:
    write_search(tmp_path)
    assert search(tmp_path, "--max-evals", "8", "--optimizer", "mapelites", "--qd-init-samples", "5").code == 0
    assert (tmp_path / "opt_out" / "archive.csv").exists()
    result = search(tmp_path, "--max-evals", "4", "--final-runs", "0")
    assert "An earlier search in opt_out is finished; the results of this one replace it" in result.errors
    left = {path.name for path in (tmp_path / "opt_out").iterdir()}
    assert not any(name.startswith(("archive", "elites", "best_results")) for name in left)


def test_same_candidate_is_not_run_twice(tmp_path: Path) -> None:
    few = {"parameters": {"b": {"optimization_domain": {"type": "int", "min": 1, "max": 3}}}}
    write_search(tmp_path, few, "def objective_fn(df): return 1.0")
    counted = script(tmp_path / "counted", 'echo x >> "$(dirname "$0")/runs"')
    assert (
        search(tmp_path, "--max-evals", "30", "--final-runs", "0", "--optimizer", "random", program=counted).code == 0
    )
    assert len(history(tmp_path)) == 30
    assert len((tmp_path / "runs").read_text().split()) == 3


# ---- What remains ----


def test_candidate_has_all_combinations_of_the_options_that_remain(tmp_path: Path) -> None:
    changes: dict[str, object] = {
        "objects.robots.nb": {"batch_options": [1, 2], "default_option": 1},
        "result_new_columns": ["objects.robots.nb"],
        "parameters": {"b": {"optimization_domain": {"type": "int", "min": 1, "max": 3}}},
    }
    write_search(
        tmp_path, changes, "def objective_fn(df): return float(df['objects.robots.nb'].sum()) / df['run'].nunique()"
    )
    assert search(tmp_path, "--max-evals", "2", "-r", "3", "--final-runs", "2").code == 0
    rows, _ = load_dataframe(tmp_path / "opt_out" / "best_results.feather")
    times = rows["time"].nunique()
    # One robot with the value 1, and two with 2, at each time.
    assert history(tmp_path)["fitness"].tolist() == [5.0 * times] * 2
    assert summary(tmp_path)["best_fresh"]["fitness"] == [5.0 * times] * 2
    kept = yaml.safe_load((tmp_path / "opt_out" / "best_config.yaml").read_text())
    assert kept["objects"]["robots"]["nb"] == {"batch_options": [1, 2], "default_option": 1}


def test_choice_of_an_alternative_is_a_parameter(tmp_path: Path) -> None:
    alternatives = {"name": "kind", "default": {}, "few": {"nb": 1}, "many": {"nb": 4}}
    changes = {"parameters": {}, "objects.robots.nb": 1, "objects.robots.batch_hierarchical_options": alternatives}
    write_search(tmp_path, changes, "def objective_fn(df): return float(df['robot_id'].nunique())")
    assert search(tmp_path, "--max-evals", "8", "--final-runs", "1").code == 0
    assert summary(tmp_path)["best_values"] == {"kind": "many"}
    result = run_command(example("helloworld"), tmp_path, ["-c", "opt_out/best_config.yaml", "-g", "-q"])
    assert result.code == 0
    assert load_dataframe(tmp_path / "data.feather")[0]["robot_id"].nunique() == 4


def test_settings_stand_in_the_configuration_and_the_command_line_comes_first(tmp_path: Path) -> None:
    section = {
        "algorithm": "random",
        "budget": 6,
        "seed": 5,
        "output_dir": "there",
        "cmaes": {"popsize": 3},
        "final_runs": 0,
    }
    write_search(tmp_path, {"optimization": {**section, "colour": 1, "qd": {"sel_pb": 0.5}}})
    result = search(tmp_path, "--max-evals", "5")
    assert result.code == 0
    assert "space.yaml:" in result.errors
    assert "optimization.colour: unknown key, which has no effect; known are algorithm, budget" in result.errors
    assert "optimization.qd.sel_pb: has no effect here" in result.errors
    entries = summary(tmp_path, "there")
    assert (entries["optimizer"], entries["evaluations"], entries["seed"]) == ("random", 5, 5)
    assert history(tmp_path, "there")["generation"].tolist() == [1, 1, 1, 1, 2]


def test_quality_diversity_search_leaves_an_archive(tmp_path: Path) -> None:
    write_search(tmp_path)
    more = ["--qd-init-samples", "12", "--qd-batch", "6", "--qd-shape", "4,5", "--final-runs", "2"]
    assert search(tmp_path, "--optimizer", "mapelites", "--max-evals", "30", *more).code == 0
    folder = tmp_path / "opt_out"
    table = pd.read_csv(folder / "archive.csv")
    features = pd.DataFrame([json.loads(text) for text in history(tmp_path)["features"]])
    cells = np.minimum((features[["a", "b"]].to_numpy() * [4, 5]).astype(int), [3, 4])
    # The best of each cell is there, and no other.
    best = history(tmp_path).assign(x=cells[:, 0], y=cells[:, 1]).groupby(["x", "y"])["fitness"].max()
    found = table.set_index(["cell_1", "cell_2"])["fitness"]
    np.testing.assert_allclose(found.sort_index(), best.sort_index(), rtol=1e-6)
    assert found.sort_index().index.tolist() == best.sort_index().index.tolist()
    entries = summary(tmp_path)["qd"]
    assert (entries["cells_filled"], entries["coverage"]) == (len(best), len(best) / 20)
    assert (folder / "archive.png").exists()
    row = table.iloc[-1]
    result = run_command(example("helloworld"), tmp_path, ["-c", str(folder / row["config"]), "-g", "-q"])
    assert result.code == 0
    parameters = load_dataframe(tmp_path / "data.feather")[1]["configuration"]["parameters"]
    assert parameters["b"] == json.loads(row["values"])["parameters.b"]


# ---- Failures ----


def test_failed_candidates_are_marked_said_once_and_the_search_goes_on(tmp_path: Path) -> None:
    lines = OBJECTIVE.replace(
        "def objective_fn(df):", "def objective_fn(df):\n    if parameters(df)['a'] < 0: raise ValueError('left')"
    )
    write_search(tmp_path, objective=lines)
    result = search(tmp_path, "--max-evals", "21", "--final-runs", "1")
    assert result.code == 0
    table = history(tmp_path)
    failed = table["fitness"].isna()
    assert 0 < failed.sum() < 21
    assert table["problem"][failed].str.contains("ValueError: left").all()
    assert (table["problem"].notna() == failed).all()
    assert result.errors.count("ValueError: left") == 1
    assert summary(tmp_path)["failed"] == failed.sum()


def test_candidate_whose_run_fails_has_failed(tmp_path: Path) -> None:
    write_search(tmp_path)
    broken = script(tmp_path / "broken", 'grep -q "c: red" "$2" && exit 3')
    assert search(tmp_path, "--max-evals", "14", "-R", "0", "--final-runs", "1", program=broken).code == 0
    table = history(tmp_path)
    is_red = table["values"].str.contains("red")
    assert (table["fitness"].isna() == is_red).all()
    assert (table["problem"][is_red] == "a run failed: exit code 3").all()


def test_search_in_which_all_candidates_fail_ends_with_exit_code_3(tmp_path: Path) -> None:
    write_search(tmp_path, objective="def objective_fn(df): return float('nan')")
    result = search(tmp_path, "--max-evals", "4")
    assert result.code == 3
    assert "[ERROR] all 4 candidates have failed; see the column problem of opt_out/opt_history.csv" in result.errors
    assert result.errors.count("the objective returned nan") == 1
    assert history(tmp_path)["problem"].tolist() == ["the objective returned nan"] * 4


def test_search_of_a_program_that_writes_no_data_is_one_line(tmp_path: Path) -> None:
    write_search(tmp_path, {"enable_data_logging": False})
    result = search(tmp_path, "--max-evals", "4")
    assert result.code == 2
    assert "enable_data_logging: is false, so runs write no data to join; set it to true" in result.errors


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--max-evals", "0"], "--max-evals: expected a whole number from 1 to 10000000, found 0"),
        (["--runs", "-1"], "--runs: expected a whole number from 1 to 10000000, found -1"),
        (["--sigma0", "0"], "--sigma0: expected a number from 1e-06 to 10, found 0.0"),
        (["--popsize", "1"], "--popsize: expected a whole number from 2 to 100000, found 1"),
        (["--seed", "-1"], "--seed: expected a whole number from 0 to 4294967295, found -1"),
        (["--seeds", "other"], "--seeds: expected common, fresh or blocks, found 'other'"),
        (
            ["--optimizer", "sgd"],
            "--optimizer: expected one of cmaes, random, mapelites, cma_me, cma_mae, tpe; found 'sgd'",
        ),
        (["--qd-shape", "4,x"], "--qd-shape: expected the number of cells along each feature, such as 48,48"),
        (["--qd-ranges", "1:0"], "--qd-ranges: expected the least and the greatest value of each feature"),
        (["--backend", "gpu"], "--backend: expected one of multiprocessing, sequential, dask; found 'gpu'"),
        (["-O", "none.py"], "--objective: none.py does not exist; expected a Python file with a function objective_fn"),
        (["--objective-func", "mine"], "--objective: obj.py has no function mine"),
        (["-S", "none"], "the simulator none does not exist; expected a program compiled for Pogosim"),
        (["-c", "none.yaml"], "cannot read the configuration none.yaml: No such file or directory"),
        (["-o", "obj.py"], "--output-dir: obj.py is not a folder; choose another one with -o"),
        (["-j", "0"], "--workers: expected a whole number of at least 1; found 0"),
    ],
)
def test_wrong_option_is_one_line(more: list[str], message: str, tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, *more)
    assert result.code == 2
    errors = [line for line in result.errors.splitlines() if "[ERROR]" in line]
    assert len(errors) == 1
    assert message in errors[0]
    assert "Traceback" not in result.errors
    assert not (tmp_path / "opt_out" / "opt_history.csv").exists()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"parameters": {"a": 1}}, "space.yaml: nothing to optimise: no key has an optimization_domain"),
        (
            {"parameters": {"a": {"optimization_domain": {"type": "int", "min": 3, "max": 1}}}},
            "parameters.a: optimization_domain: expected min below max, found 3 and 1",
        ),
        ({"optimization": 5}, "optimization: expected a map of settings, found 5"),
        (
            {"optimization": {"budget": "many"}},
            "optimization.budget: expected a whole number from 1 to 10000000, found 'many'",
        ),
    ],
)
def test_wrong_configuration_is_one_line_with_its_place(
    changes: dict[str, object], message: str, tmp_path: Path
) -> None:
    write_search(tmp_path, changes)
    result = search(tmp_path, "--max-evals", "4")
    assert result.code == 2
    assert message in result.errors
    assert "space.yaml:" in result.errors


def test_missing_options_are_one_line(tmp_path: Path) -> None:
    write_search(tmp_path)
    result = search(tmp_path, "--no-such-option")
    assert result.code == 2
    assert len(result.errors.splitlines()) == 1


def test_default_objective_comes_with_a_warning(tmp_path: Path) -> None:
    write_search(tmp_path)
    arguments = [word for word in options("--max-evals", "2", "--final-runs", "1") if word not in ("-O", "obj.py")]
    result = run_main(tmp_path, arguments, main)
    assert result.code == 0
    assert "[WARNING] No objective script provided; DEFAULT fitness = mean MSD" in result.errors


@pytest.mark.parametrize(
    ("changes", "more", "message"),
    [
        ({"parameters": {"a": {"optimization_domain": {"typ": "float", "max": 1}}}}, [], "unknown key 'typ'"),
        ({}, ["--optimizer", "mapelites"], "needs the Python package 'ribs'"),
        ({}, ["--optimizer", "tpe"], "needs the Python package 'optuna'"),
    ],
)
def test_wrong_domain_and_missing_package_are_told_before_pandas_is_imported(
    changes: dict[str, object], more: list[str], message: str, tmp_path: Path
) -> None:
    write_search(tmp_path, changes)
    for package in ("ribs", "optuna"):
        (tmp_path / f"{package}.py").write_text("raise ImportError\n")
    code = "import sys; sys.path.insert(0, '.'); from pogosim.optimize.command import main; "
    code += f"assert main({options(*more)!r}) == 2; print('pandas' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout == "False\n", done.stderr
    assert message in done.stderr
