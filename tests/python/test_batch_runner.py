"""The class behind pogobatch does other batches when it is extended."""

from __future__ import annotations

import inspect
import shutil
from pathlib import Path
from typing import Any

import pytest
from batches import write_options
from pogosim.pogobatch import BatchError, PogobotBatchRunner, PogobotLauncher
from pogosim.utils import load_dataframe
from running import example

PROGRAM = str(example("helloworld"))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with many.yaml."""
    write_options(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_arguments_and_methods_have_the_names_that_scripts_expect() -> None:
    parameters = inspect.signature(PogobotBatchRunner).parameters
    assert list(parameters)[:11] == [
        "multi_config_file",
        "runs",
        "simulator_binary",
        "temp_base",
        "output_dir",
        "backend",
        "keep_temp",
        "verbose",
        "retries",
        "gui",
        "only_output",
    ]
    defaults = {name: parameter.default for name, parameter in parameters.items()}
    assert (defaults["backend"], defaults["retries"], defaults["gui"]) == ("multiprocessing", 5, False)


def test_all_runs_return_one_file_per_combination(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    runner = PogobotBatchRunner("many.yaml", 2, PROGRAM, "tmp", "results")
    assert runner.list_outputs() == ["results/result.feather"]
    assert runner.run_all() == ["results/result.feather"] * 2
    assert runner.failures == []
    assert len(load_dataframe(folder / "results" / "result.feather")[0].groupby(["run", "objects.robots.nb"])) == 4
    assert "Found 2 combination(s)" in capsys.readouterr().out


class Extended(PogobotBatchRunner):
    """Other combinations, columns, seeds, names and configurations."""

    def get_combinations(self, config: dict[str, Any]) -> list[dict[str, Any]]:
        """Take the last combination only, and a larger one."""
        *_, last = super().get_combinations(config)
        larger = {**last, "objects": {"robots": {**last["objects"]["robots"], "nb": 5}}}
        return [last, larger]

    def compute_output_filename(self, comb_config: dict[str, Any]) -> str:
        """Name files by the number of robots."""
        return f"{self.output_dir}/swarm_of_{comb_config['objects']['robots']['nb']}.feather"

    def compute_new_columns(self, comb_config: dict[str, Any]) -> dict[str, Any]:
        """Add a column that is no key."""
        return {"robots_per_m2": comb_config["objects"]["robots"]["nb"] / comb_config["arena_surface"] * 1e6}

    def compute_seed(self, comb_config: dict[str, Any], run: int) -> int:  # noqa: ARG002
        """Count from 100."""
        return 100 + run

    def write_temp_yaml(self, comb_config: dict[str, Any]) -> str:
        """Save more often."""
        return super().write_temp_yaml({**comb_config, "save_data_period": 0.05})

    def run_launcher_for_combination(self, temp_config_path: str, output_file: str) -> str:
        """Leave some combinations out."""
        if output_file.endswith("_3.feather"):
            return output_file
        return super().run_launcher_for_combination(temp_config_path, output_file)


def test_every_part_can_be_replaced(folder: Path) -> None:
    runner = Extended("many.yaml", 2, PROGRAM, "tmp", "results", keep_temp=True)
    assert runner.run_all() == ["results/swarm_of_3.feather", "results/swarm_of_5.feather"]
    assert [path.name for path in (folder / "results").iterdir()] == ["swarm_of_5.feather"]
    rows, _ = load_dataframe(folder / "results" / "swarm_of_5.feather")
    assert set(rows["robots_per_m2"]) == {5.0}
    assert rows["time"].nunique() == 21
    kept = (folder / "tmp").glob("done_*/*.feather")
    assert sorted(load_dataframe(path)[1]["configuration"]["seed"] for path in kept) == [100, 101]


def test_one_combination_can_be_run_alone(folder: Path) -> None:
    runner = PogobotBatchRunner("many.yaml", 3, PROGRAM, "tmp", "results")
    first, _ = runner.get_combinations(runner.configuration.entries)
    path = runner.write_temp_yaml(first)
    assert runner.run_launcher_for_combination(path, "alone/first.feather") == "alone/first.feather"
    rows, _ = load_dataframe(folder / "alone" / "first.feather")
    assert set(rows["run"]) == {0, 1, 2}
    assert set(rows["objects.robots.nb"]) == {2}


def test_combination_run_alone_is_run_again_when_the_program_has_changed(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_options(folder, {"objects.robots.nb": 2})
    program = Path(shutil.copy(PROGRAM, folder / "program"))
    launcher = PogobotLauncher(1, "many.yaml", "one.feather", str(program), keep_temp=True)
    done = []
    for change in (b"", b"", b"changed"):
        with program.open("ab") as file:
            file.write(change)
        launcher.launch_all()
        done.append("1 of 1 runs are done already" in capsys.readouterr().out)
    assert done == [False, True, False]


def test_launcher_runs_one_configuration_with_chosen_seeds(folder: Path) -> None:
    write_options(folder, {"objects.robots.nb": 4})
    assert PogobotLauncher(2, "many.yaml", "one.feather", PROGRAM).launch_all(seeds=[7, 8]) == "one.feather"
    rows, _ = load_dataframe(folder / "one.feather")
    assert rows.groupby("run")["robot_id"].nunique().to_dict() == {0: 4, 1: 4}
    with pytest.raises(BatchError, match="expected 2 seeds"):
        PogobotLauncher(2, "many.yaml", "one.feather", PROGRAM).launch_all(seeds=[7])


@pytest.mark.parametrize(
    "wrong",
    [
        {"runs": 0},
        {"runs": True},
        {"runs": None},
        {"runs": 2, "seeds": [1, 2, 3]},
        {"seeds": [2, 2], "runs": None},
        {"retries": -1},
        {"backend": "none"},
        {"workers": 0},
        {"seed_from": "x"},
    ],
)
def test_wrong_argument_is_an_error(wrong: dict[str, Any], folder: Path) -> None:
    arguments: dict[str, Any] = {"runs": 1, **wrong}
    with pytest.raises(BatchError, match=r"expected|twice"):
        PogobotBatchRunner(str(folder / "many.yaml"), simulator_binary="x", temp_base="t", output_dir="o", **arguments)
