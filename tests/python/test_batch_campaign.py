"""Batches from Python: run_local_campaign, and plain functions of combinations, as scripts of others call them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from batches import results, script, write_options
from pogosim import pogobatch
from pogosim.batch.execution import Execution
from pogosim.pogobatch import (
    LocalCampaignError,
    LocalCampaignResult,
    PogobatchError,
    build_combinations,
    compute_extra_columns,
    compute_result_filename,
    count_combinations,
    expand_combinations,
    make_rundra_sweep_config,
    resolve_batch_defaults,
    run_local_campaign,
)
from pogosim.utils import load_dataframe
from running import example

PROGRAM = str(example("helloworld"))
NB = {"batch_options": [2, 3], "default_option": 3}


def campaign(folder: Path, seeds: Any = range(2), program: str | Path = PROGRAM, **more: Any) -> LocalCampaignResult:
    """Run a campaign of many.yaml in a folder."""
    return run_local_campaign(
        folder / "many.yaml", program, seeds=seeds, output_dir=folder / "results", temp_base=folder / "tmp", **more
    )


def test_result_says_what_was_done(tmp_path: Path) -> None:
    write_options(tmp_path)
    done = campaign(tmp_path, seeds=[5, 2], jobs=1)
    assert done == LocalCampaignResult(
        outputs=[str(tmp_path / "results" / "result.feather")],
        manifest_path=tmp_path / "results" / "pogobatch_run.json",
        task_count=4,
        combination_count=2,
        seeds=(5, 2),
        effective_jobs=1,
        retained_temp_dir=None,
    )
    assert json.loads(done.manifest_path.read_text())["seeds"] == [5, 2]
    rows, _ = load_dataframe(done.outputs[0])
    assert rows[["run", "seed"]].drop_duplicates().to_numpy().tolist() == [[0, 5], [1, 2]]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many.yaml", "results"]
    kept = campaign(tmp_path, seeds=[5], jobs=0, keep_temp=True, only_output="result.feather")
    assert kept.retained_temp_dir == tmp_path / "tmp"
    assert 1 <= kept.effective_jobs <= 2


def test_campaign_writes_the_bytes_of_the_subcommand_whatever_does_the_runs(tmp_path: Path) -> None:
    write_options(tmp_path)
    campaign(tmp_path, progress=True)
    first = results(tmp_path)["result.feather"]
    for more in ({"backend": "sequential"}, {"jobs": 3}, {"simulator_output": "verbose"}, {"retry_new_seed": False}):
        campaign(tmp_path, **more)
        assert results(tmp_path)["result.feather"] == first


def test_runs_that_ended_before_their_manifests_were_written_are_done_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else a merge of the kept folders would lack them: it finds runs by their manifests."""
    write_options(tmp_path)

    def end(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched, pytest.raises(KeyboardInterrupt):
        patched.setattr(Execution, "keep_manifest", end)
        campaign(tmp_path, backend="sequential", keep_temp=True)
    campaign(tmp_path, keep_temp=True)
    manifests = [json.loads(path.read_text()) for path in tmp_path.glob("tmp/*/pogobatch_task.json")]
    runs = {(entries["seed"], entries["batch_choices"]["objects.robots.nb"]) for entries in manifests}
    assert runs == {(0, 2), (0, 3), (1, 2), (1, 3)}
    assert len(manifests) == len(runs)


def test_failures_are_an_error_that_lists_them_and_the_results_have_the_others(tmp_path: Path) -> None:
    write_options(tmp_path)
    program = script(tmp_path / "broken", '[ "$seed" = 1 ] && exit 3')
    with pytest.raises(LocalCampaignError, match="2 of 4 runs failed, first run 1 with seed 1: exit code 3") as caught:
        campaign(tmp_path, retries=0, program=program)
    assert isinstance(caught.value, PogobatchError)
    assert caught.value.campaign_dir == tmp_path / "tmp"
    assert len(list(caught.value.campaign_dir.glob("sim_1_try0_*"))) == 2
    failure = {"ok": False, "logical_run": 1, "seed": 1, "attempts": 1, "error": "exit code 3"}
    assert caught.value.failures == [{"combination_ordinal": number, **failure} for number in (0, 1)]
    rows, metadata = load_dataframe(tmp_path / "results" / "result.feather")
    assert set(rows["run"]) == {0}
    assert [entry["failed_runs"] for entry in metadata["combinations"]] == [[1], [1]]
    assert caught.value.result.outputs == [str(tmp_path / "results" / "result.feather")]


def test_runs_with_other_seeds_are_listed(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2})
    program = script(tmp_path / "broken", '[ "$seed" = 1 ] && kill -SEGV $$')
    done = campaign(tmp_path, program=program)
    assert done.replaced == (
        {
            "combination_ordinal": 0,
            "logical_run": 1,
            "seed": 1,
            "retry_attempt": 1,
            "replacement_seed": 3,
            "error": "killed by SIGSEGV",
        },
    )
    assert "1 of 2 runs failed and was done with another seed (retry_attempt > 0)" in caplog.text


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"seeds": []}, "seeds: expected whole numbers from 0 to 4294967295; found none"),
        ({"seeds": [1, 1]}, "seeds: seed 1 is there twice"),
        ({"seeds": None}, "seeds: expected whole numbers from 0 to 4294967295, such as range(10); found None"),
        ({"seeds": "configured"}, "seeds: expected whole numbers"),
        ({"seeds": [2**32]}, "found 4294967296"),
        ({"jobs": -1}, "jobs: expected a whole number of at least 0; found -1"),
        ({"retries": -1}, "--retries: expected a whole number of at least 0"),
        ({"backend": "cluster"}, "--backend: expected one of multiprocessing, sequential, dask"),
        ({"simulator_output": "loud"}, "simulator_output: expected one of normal, quiet, verbose; found 'loud'"),
        ({"only_output": "none.feather"}, "no combination has the output 'none.feather'"),
        ({"program": "nothing"}, "the simulator nothing does not exist"),
    ],
)
def test_wrong_arguments_are_refused_before_anything_is_written(
    wrong: dict[str, Any], said: str, tmp_path: Path
) -> None:
    write_options(tmp_path)
    with pytest.raises(PogobatchError) as caught:
        campaign(tmp_path, **wrong)
    assert said in str(caught.value)
    assert results(tmp_path) == {}


@pytest.mark.parametrize("wrong", [5, None, "", b"x", ["a"], "a\0b"])
def test_arguments_of_another_kind_are_refused_by_name(wrong: Any, tmp_path: Path) -> None:
    write_options(tmp_path)
    paths = dict.fromkeys(("config_path", "simulator_binary", "output_dir", "temp_base"), "x")
    for name in paths:
        with pytest.raises(PogobatchError, match=rf"^{name}: expected the path of a file"):
            run_local_campaign(**{**paths, name: wrong}, seeds=[1])
    for function in (pogobatch.build_combinations, lambda path: pogobatch.discover_task_artifacts([path])):
        with pytest.raises(PogobatchError, match="expected the path of a file"):
            function(wrong)
    functions = (expand_combinations, count_combinations, resolve_batch_defaults, compute_result_filename)
    for read in (*functions, compute_extra_columns):
        with pytest.raises(PogobatchError, match=r"^config: expected a map of keys and values"):
            read(wrong)


@pytest.mark.parametrize("wanted", ["normal", "quiet", "verbose"])
def test_simulators_print_what_is_asked_for(wanted: str, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    write_options(tmp_path, {"objects.robots.nb": 2, "parameters": {"never_read": 1}})
    campaign(tmp_path, seeds=[0], simulator_output=wanted, keep_temp=True, jobs=1)
    (log,) = (tmp_path / "tmp").glob("sim_*/log.txt")
    assert ("[PRINTF]" in log.read_text()) == (wanted == "verbose")
    assert ("never read by the program" in caplog.text) == (wanted != "quiet")


def test_combinations_are_counted_without_making_them() -> None:
    alternatives = {"batch_hierarchical_options": {"default": {}, "low": {"y": {"batch_options": [1, 2]}}, "high": {}}}
    config = {
        "a": {"batch_options": [1, 2, {"b": {"batch_options": [3, 4]}}]},
        "list": [{"batch_options_range": {"start": 0, "stop": 5, "step": 1}}, 7],
        "objects": {"robots": alternatives},
        "pogobatch": {"result_new_columns": ["a"]},
        "_rundr": {"seeds": 3},
    }
    combinations = expand_combinations(config)
    assert count_combinations(config) == len(combinations) == 4 * 5 * 3
    assert combinations[0]["list"] == [0, 7]
    assert not {"pogobatch", "_rundr"} & set(combinations[0])
    assert compute_extra_columns(combinations[0]) == {"a": 1}
    assert "pogobatch" in config
    huge = {str(number): {"batch_options": list(range(10))} for number in range(30)}
    assert count_combinations(huge) == 10**30
    with pytest.raises(PogobatchError, match=r"^a: batch_options: expected a list"):
        count_combinations({"a": {"batch_options": 5}})
    with pytest.raises(PogobatchError, match="more than 1000000"):
        expand_combinations(huge)


def test_file_and_map_have_the_same_combinations(tmp_path: Path) -> None:
    path = write_options(tmp_path)
    found = build_combinations(path)
    assert [entries["objects"]["robots"]["nb"] for entries in found] == [2, 3]
    with pytest.raises(PogobatchError, match=r"many\.yaml:\d+: objects\.robots\.nb: batch_options"):
        build_combinations(write_options(tmp_path, {"objects.robots.nb": {"batch_options": 5}}))
    with pytest.raises(PogobatchError, match="cannot read the configuration"):
        build_combinations(tmp_path / "nothing.yaml")


def test_defaults_are_those_of_a_single_run() -> None:
    config = {
        "a": {"batch_options": [1, 2], "default_option": 2},
        "b": [{"batch_options": [5], "default_option": {"c": {"default_option": 6}}}],
        "objects": {
            "robots": {
                "nb": 5,
                "batch_hierarchical_options": {"name": "density", "default": {"nb": 10}, "low": {"nb": 2}},
            }
        },
        "tuned": {"optimization_domain": {"type": "int", "min": 0, "max": 9, "init": 4}},
        "pogobatch": {"result_filename_format": "{a}_{objects.robots}.feather", "result_new_columns": ["density"]},
    }
    found = resolve_batch_defaults(config)
    assert (found["a"], found["b"], found["tuned"], found["density"]) == (2, [{"c": 6}], 4, "default")
    assert found["objects"] == {"robots": {"nb": 10}}
    assert compute_result_filename(found) == "2_default.feather"
    assert compute_extra_columns(found) == {"density": "default"}
    with pytest.raises(PogobatchError, match="a: has batch_options and no default_option"):
        resolve_batch_defaults({"a": {"batch_options": [1]}})
    with pytest.raises(PogobatchError, match="has no alternative 'default'"):
        resolve_batch_defaults({"a": {"batch_hierarchical_options": {"low": {}}}})
    with pytest.raises(PogobatchError, match="result_filename_format: there is no key 'b'"):
        compute_result_filename({"result_filename_format": "{b}.feather"})
    with pytest.raises(PogobatchError, match="result_new_columns: expected a list"):
        compute_extra_columns({"result_new_columns": 5})


def test_sweep_has_its_options_and_says_results_and_seeds_in_maps() -> None:
    config = {"nb": NB, "result_new_columns": ["nb"], "pogobatch": {"rundra": {"sync": {}}}}
    swept = make_rundra_sweep_config(config, "3:9")
    assert swept == {
        "nb": NB,
        "pogobatch": {"rundra": {"sync": {}}, "result_new_columns": ["nb"]},
        "_rundr": {"version": 1, "seeds": "3:9"},
    }
    assert expand_combinations(swept) == expand_combinations({"nb": NB, "result_new_columns": ["nb"]})
    assert make_rundra_sweep_config(swept)["_rundr"]["seeds"] == "3:9"
    for wrong in (None, 0, True, "9:3", 1.5):
        with pytest.raises(PogobatchError):
            make_rundra_sweep_config(config, wrong)  # type: ignore[arg-type]


def test_public_names_are_documented() -> None:
    for name in pogobatch.__all__:
        assert (getattr(pogobatch, name).__doc__ or "").strip(), name
