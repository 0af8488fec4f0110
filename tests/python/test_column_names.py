"""Columns of programs that are named like those of the simulator or its tools."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from batches import batch, write_options
from pogosim.analysis.trajectories import trajectories_of
from pogosim.film.replay import replay_data
from pogosim.picture.swarm import read_recording
from pogosim.run_columns import KEYS, NAMES
from pogosim.swarm_picture import main
from pogosim.utils import load_dataframe
from running import PROGRAMS, ROOT, Run, compile_program, run

BUILT_IN = (
    *("time", "robot_category", "robot_id", "pogobot_ticks", "x", "y", "angle"),
    "subpart_id",  # not in each file
)
OF_RUNS = (*NAMES, "objects.robots.nb", "parameters.gain")
INTERNAL = (
    "object",
    "rgb_0",
    "speed",
    "frame",
    "id",
    "index",
    "level_0",
    "category",
    "theta",
    "row",
    "step",
    "arena",
    "seed.noise",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("columns")


def program(folder: Path, column: str) -> Path:
    """Return a program with an integer column of this name, 100 times the robot's id and more."""
    path = folder / f"program_{column}"
    return path if path.exists() else compile_program(path, PROGRAMS / "column_names.c", flags=[f'-DCOLUMN="{column}"'])


def recorded(folder: Path, column: str, seed: int = 1, **settings: Any) -> Run:
    result = run(program(folder, column), folder / f"{column}_{seed}", {"seed": seed, **settings})
    assert result.code == 0, result.text
    return result


@pytest.mark.parametrize("column", BUILT_IN)
def test_column_of_the_simulator_is_refused_also_where_the_file_has_none(folder: Path, column: str) -> None:
    result = run(program(folder, column), folder / column)
    assert result.code == 2
    assert result.errors == (
        f"Error: the user program adds the data column '{column}' (data_add_column_*), but the simulator has a column "
        "of that name: choose another name\n"
    )


def test_column_of_colours_warns_where_the_simulator_records_none(folder: Path) -> None:
    result = recorded(folder, "led_rgb")
    assert "tools take a column of that name for the colour of the head LED (0xRRGGBB): choose another" in result.errors
    refused = run(program(folder, "led_rgb"), folder / "led", {"data_logger_led": True})
    assert refused.code == 2
    assert "but the simulator has a column of that name: choose another name" in refused.errors


@pytest.mark.parametrize("column", OF_RUNS)
def test_column_that_tells_runs_apart_warns_and_only_one_run_can_be_read(folder: Path, column: str) -> None:
    first, second = recorded(folder, column), recorded(folder, column, seed=2)
    (line,) = first.errors.splitlines()
    assert f"[warning] the user program adds the data column '{column}' (data_add_column_*), but tools tell" in line
    assert line.endswith("choose another name")
    files = [first.folder / "data.feather", second.folder / "data.feather"]
    with pytest.raises(ValueError, match=re.escape(f"{files[0]}: its program writes a column '{column}'")) as told:
        load_dataframe(files)
    assert "choose another name in the program (data_add_column_*)" in str(told.value)
    (one,) = trajectories_of(load_dataframe(files[0])[0])
    assert one.position_mm.shape == (21, 3, 2)
    assert read_recording(files[0], color_by=column).last.rows["robot_id"].nunique() == 3


@pytest.mark.parametrize("column", OF_RUNS)
def test_batch_refuses_a_column_that_tells_runs_apart(folder: Path, tmp_path: Path, column: str) -> None:
    write_options(tmp_path)
    result = batch(tmp_path, "-r", "1", program=program(folder, column))
    assert result.code == 2
    assert f"writes a column '{column}', and" in result.errors
    assert "rename" in result.errors
    assert not (tmp_path / "results" / "result.feather").exists()


@pytest.mark.parametrize("column", INTERNAL)
def test_any_other_name_is_the_program_s_own(folder: Path, tmp_path: Path, column: str) -> None:
    runs = [recorded(folder, column, seed) for seed in (1, 2)]
    assert [result.errors for result in runs] == ["", ""]
    rows, _ = load_dataframe([result.folder / "data.feather" for result in runs])
    assert rows["run"].tolist() == [0] * 63 + [1] * 63
    assert [one.labels["run"] for one in trajectories_of(rows)] == [0, 1]
    data = runs[0].folder / "data.feather"
    recording = read_recording(data, color_by=column)
    values = recording.last.rows.groupby("robot_id")[column].first()
    assert (values // 100).tolist() == [0, 1, 2]
    assert recording.last.colouring is not None
    assert recording.last.colouring.name == column
    plain = recorded(folder, "plain")
    for name, own, shown in (("a.png", data, column), ("b.png", plain.folder / "data.feather", "plain")):
        assert main([str(own), str(tmp_path / name), "--color-by", shown, "--dpi", "30", "-q"]) == 0


@pytest.mark.parametrize("column", ["category", "LED", "object", "id"])
def test_page_has_a_choice_for_each_column(folder: Path, column: str) -> None:
    settings = {"data_logger_led": True} if column == "LED" else {}
    data = recorded(folder, column, **settings).folder / "data.feather"
    head = replay_data(read_recording(data), (0.0, 2.0))[0]
    names = [own["name"] for own in head["columns"]]
    assert len(set(names)) == len(names)
    assert column in names[1:]


def test_trails_are_those_of_the_robots_whatever_columns_there_are(folder: Path) -> None:
    own, plain = (read_recording(recorded(folder, name).folder / "data.feather").last for name in ("object", "plain"))
    for column in ("x", "y", "robot_id"):
        np.testing.assert_array_equal(own.rows[column], plain.rows[column])


def test_file_with_columns_of_our_own_names_is_drawn_without_them(folder: Path, tmp_path: Path) -> None:
    data = recorded(folder, "plain").folder / "data.feather"
    strange = tmp_path / "strange.feather"
    load_dataframe(data)[0].assign(**{"\0object": 7, "\0rgb_0": 8}).to_feather(strange)
    assert read_recording(strange).last.rows["robot_id"].nunique() == 3


def test_headings_of_an_imported_formation_are_not_a_column_of_the_program(folder: Path) -> None:
    for ending in ("feather", "csv"):
        fields = ["time", "robot_category", "robot_id", "x", "y", "angle", "theta"]
        settings: dict[str, Any] = {"data_filename": f"data.{ending}", "data_logger_fields": fields}
        source = recorded(folder, "theta", **settings).folder / f"data.{ending}"
        start = {"initial_formation": "imported", "formation_filename": str(source)}
        again = recorded(folder, "plain", seed=5, **{**start, "simulation_time": 0.1})
        expected = load_dataframe(source)[0].query("time == 0")["angle"].to_numpy()
        np.testing.assert_allclose(again.frame().query("time == 0")["angle"], expected, atol=1e-5)


def test_rule_is_the_same_for_the_simulator_and_the_tools() -> None:
    text = (ROOT / "src" / "tables" / "columns.cpp").read_text()
    for constant, names in (("kColumnsOfRuns", NAMES), ("kKeysOfRuns", KEYS)):
        found = re.search(rf"{constant}\{{(.*?)\}}", text, re.DOTALL)
        assert found is not None
        assert tuple(re.findall(r'"([^"]+)"', found[1])) == names
