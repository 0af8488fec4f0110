"""Columns of the data file in runs inside of this process: pogosim.Simulation.columns."""

from __future__ import annotations

import gc
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pogosim
import pytest
from running import PROGRAMS, ROOT, SCENE, SHARED, compile_program, write_scene

TYPES = {
    "small": np.int8,
    "negative": np.int16,
    "steps": np.int32,
    "large": np.int64,
    "single": np.float32,
    "exact": np.float64,
    "half": np.float16,
    "is_odd": np.bool_,
}


@pytest.fixture(autouse=True)
def _folders_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shared object of tests/programs/saved_columns.c."""
    return compile_program(
        tmp_path_factory.mktemp("columns") / "columns.so", PROGRAMS / "saved_columns.c", flags=SHARED
    )


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A configuration of three robots and 2 s, with rows every half second."""
    arena = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5}
    # Objects without a program have rows, too, before those of robots.
    balls = {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 20.0}
    return write_scene(tmp_path, {**arena, "objects": {"balls": balls, "robots": SCENE["objects"]["robots"]}})


@pytest.fixture
def sim(program: Path, scene: Path) -> Iterator[pogosim.Simulation]:
    """A run of that program in it."""
    with pogosim.Simulation(program, scene) as simulation:
        yield simulation


def last_rows(sim: pogosim.Simulation) -> pd.DataFrame:
    """The rows of robots at the last save."""
    rows = sim.to_dataframe()
    last: pd.DataFrame = rows[(rows["robot_category"] == "robots") & (rows["time"] == rows["time"].max())]
    return last.set_index("robot_id")


@pytest.mark.parametrize("time_s", [0.0, 0.3, 0.5, 1.49, 2.0])
def test_columns_are_the_rows_of_the_last_save(sim: pogosim.Simulation, time_s: float) -> None:
    sim.run(until_s=time_s)
    rows = last_rows(sim)
    assert sim.columns.time == rows["time"].iloc[0] == math.floor(2 * time_s) / 2
    assert list(sim.columns) == [*TYPES, "name of it"]
    for name, values in sim.columns.items():
        in_file = rows[name].reindex(sim.robot_ids)
        given = values.tolist() if isinstance(values, np.ndarray) else values
        assert given == [None if pd.isna(value) else value for value in in_file], name


def test_types_are_those_of_the_program_and_what_is_missing_is_masked(sim: pogosim.Simulation) -> None:
    sim.run(until_s=1)
    assert {name: sim.columns[name].dtype.type for name in TYPES} == TYPES
    assert sim.columns["negative"].tolist() == [-1000, None, -1002]
    assert sim.columns["large"].tolist() == [2**40, None, 2**40]
    assert sim.columns["half"][0] == np.float16(0.1)
    assert np.isnan(np.asarray(sim.columns["exact"])).tolist() == [False, True, False]
    assert sim.columns["steps"].tolist() == [62, 62, 62]
    assert sim.columns["name of it"] == ["röt,\n0", None, "\N{REPLACEMENT CHARACTER}2"]


def test_robots_without_a_row_have_no_values(sim: pogosim.Simulation) -> None:
    assert sim.columns["steps"].tolist() == [0, 0, None]
    assert sim.columns["name of it"][2] is None
    sim.run(until_s=0.5)
    assert sim.columns["steps"].mask.tolist() == [False] * 3


def test_columns_are_views_that_go_with_the_run_and_outlive_it(program: Path, scene: Path) -> None:
    simulation = pogosim.Simulation(program, scene)
    steps, columns = simulation.columns["steps"], simulation.columns
    simulation.step(49)
    assert steps[0] == 0
    simulation.step(1)
    assert steps.tolist() == [31, 31, 31]  # the mask, too
    assert not steps.flags.owndata
    for part in (steps, steps.mask):
        with pytest.raises(ValueError, match="read-only"):
            part[0] = 1
    simulation.reset()
    simulation.run()
    simulation.close()
    del simulation
    gc.collect()
    assert steps.tolist() == columns["steps"].tolist() == [31, 31, 31]


def test_unknown_columns_are_refused_with_those_that_there_are(sim: pogosim.Simulation, scene: Path) -> None:
    with pytest.raises(KeyError, match="no column 'step' to the data file; there are small, negative, steps, large"):
        sim.columns["step"]
    assert "step" not in sim.columns
    assert len(sim.columns) == 9
    assert repr(sim.columns).startswith("<columns at t = 0 s: small, ")
    with pogosim.Simulation(sim.program, scene, set={"enable_data_logging": False}) as without_rows:
        assert math.isnan(without_rows.columns.time)
        with pytest.raises(KeyError, match=r"records no rows \(enable_data_logging: false\)"):
            without_rows.columns["steps"]
    with pytest.raises(pogosim.SimulationError, match="closed"):
        without_rows.columns  # noqa: B018


def test_columns_left_out_of_the_file_are_there(program: Path, scene: Path) -> None:
    with pogosim.Simulation(program, scene, set={"data_logger_fields": ["time", "steps"]}) as simulation:
        assert simulation.columns["large"][0] == 2**40


def test_runs_without_robots_have_empty_columns(program: Path, scene: Path) -> None:
    with pogosim.Simulation(program, scene, set={"objects.robots.nb": 0}) as simulation:
        assert simulation.light_levels.shape == (0,)
        for values in simulation.columns.values():
            assert len(values) == 0


def test_columns_of_many_runs_are_stacked(program: Path, scene: Path) -> None:
    with pogosim.VectorSimulation(program, scene, seeds=range(4)) as runs:
        runs.step(100)
        steps = runs.column("steps")
        assert steps.shape == (4, 3)
        assert runs.column("small").mask[:, 1].all()
        assert runs.column("name of it")[3][0] == "röt,\n0"
        runs.step(100)
        assert (steps == 62).all()
        with pytest.raises(KeyError, match="there are small"):
            runs.column("tall")
