"""The supervisor: programs and hosts that see and change the whole world (pogosim/world.h, `Simulation.objects`)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pogosim
import pytest
from conftest import Compile
from pogosim.utils import load_dataframe
from running import ROOT, run, run_shipped, write_scene

PUCK = {"type": "passive_object", "nb": 2, "geometry": "disk", "radius": 20.0}
LAMP = {"type": "static_light", "geometry": "disk", "radius": 100.0, "x": 564.0, "y": 564.0, "value": 1000}
SETTINGS = {"objects.pucks": PUCK, "objects.light": LAMP, "objects.robots.nb": 3}
ROBOT = 0  # objects in the order of SCENE: three robots, two pucks
PUCK_1 = 4


@pytest.fixture
def sim(hosted: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[pogosim.Simulation]:
    """A run of three robots and two pucks under a lamp."""
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    scene = write_scene(tmp_path, {**SETTINGS, "arena_file": str(ROOT / "arenas" / "disk.csv")})
    with pogosim.Simulation(hosted, scene) as simulation:
        yield simulation


# ---- The example


def test_example_counts_pucks_and_one_robot_breaks_down(tmp_path: Path) -> None:
    result = run_shipped("supervisor", tmp_path / "a")
    assert (result.code, result.errors) == (0, "")
    rows = result.frame()
    # All rows of a moment have the same count, which never falls; fitness is pucks per minute.
    of_time = rows.groupby("time")
    assert (of_time["found"].nunique() == 1).all()
    found = of_time["found"].first()
    assert found.is_monotonic_increasing
    assert found.iloc[0] == 0
    assert found.iloc[-1] > 20
    # Whatever is found, a robot was told.
    assert rows.groupby("time")["meals"].sum().tolist() == found.tolist()
    assert of_time["fitness"].first().iloc[-1] == pytest.approx(found.iloc[-1], rel=0.01)
    # Robot 0 is out of order from 20 s to 40 s.
    first = rows[(rows["robot_category"] == "robots") & (rows["robot_id"] == 0)].set_index("time")
    off = first.loc[20.5:39.5]
    assert off["pogobot_ticks"].nunique() == 1
    assert (off["led_rgb"] == 0).all()
    assert first.loc[41:, "pogobot_ticks"].is_monotonic_increasing
    assert first["pogobot_ticks"].iloc[-1] > off["pogobot_ticks"].iloc[0] + 1000
    others = rows[(rows["robot_category"] == "robots") & (rows["robot_id"] == 1)].set_index("time")
    assert (others.loc[20.5:39.5, "led_rgb"] != 0).all()


def test_example_gives_the_same_bytes_again_and_is_not_touched(tmp_path: Path) -> None:
    files = []
    for name in ("a", "b"):
        changes = {"simulation_time": 25.0, "data_filename": "data.feather", "console_filename": "console.txt"}
        result = run_shipped("supervisor", tmp_path / name, changes)
        assert result.code == 0, result.text
        files.append((tmp_path / name / "data.feather").read_bytes())
        assert b"touched" not in (result.table().schema.metadata or {})
    assert files[0] == files[1]


# ---- Calls that are refused

OUTSIDE = ["user_init", "user_step", "send", "end"]


@pytest.mark.parametrize("place", OUTSIDE)
def test_robot_that_looks_at_the_world_is_refused(program: Compile, tmp_path: Path, place: str) -> None:
    result = run(program("supervisor.c"), tmp_path, {"parameters": {"place": place}})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert "pogosim_world_object_count(): robots do not see the world; call it in callback_global_setup" in line


@pytest.mark.parametrize(
    ("column", "message"),
    [
        ("early", 'pogosim_world_set_column("fitness"): columns are declared after callback_global_setup'),
        ("unknown", "pogosim_world_set_column(): the data file has no column 'unknown' of the program"),
        ("text", "pogosim_world_set_column(): the column 'text' was declared as string: only columns of numbers"),
        (
            "small",
            "the column 'small' was declared as int8, which 200 is not: expected a whole number from -128 to 127",
        ),
        ("flag", "the column 'flag' was declared as bool: expected 0 or 1, found 200"),
    ],
)
def test_wrong_column_is_refused(program: Compile, tmp_path: Path, column: str, message: str) -> None:
    result = run(program("supervisor.c"), tmp_path, {"parameters": {"column": column}})
    assert result.code == 2
    (line,) = result.errors.splitlines()
    assert message in line


def test_columns_without_a_data_file_do_nothing(program: Compile, tmp_path: Path) -> None:
    settings = {"enable_data_logging": False, "parameters": {"column": "unknown"}}
    result = run(program("supervisor.c"), tmp_path, settings)
    assert (result.code, result.errors) == (0, "")


def test_columns_that_the_supervisor_never_sets_are_told(program: Compile, tmp_path: Path) -> None:
    result = run(program("supervisor.c"), tmp_path, {})
    assert (result.code, result.errors) == (0, "")
    assert "the columns 'fitness', 'text', 'small', 'flag' of the data file are empty" in result.output


# ---- Python


def test_objects_are_those_of_the_data_file(sim: pogosim.Simulation) -> None:
    rows = sim.to_dataframe()
    assert [found.category for found in sim.objects] == rows["robot_category"].tolist()
    assert [found.id for found in sim.objects] == rows["robot_id"].tolist()
    np.testing.assert_allclose([found.position for found in sim.objects], rows[["x", "y"]], rtol=1e-6)
    np.testing.assert_allclose([found.heading for found in sim.objects], rows["angle"], rtol=1e-6)
    assert [found.robot for found in sim.objects] == [0, 1, 2, None, None]
    assert [found.index for found in sim.objects.of("pucks")] == [3, 4]
    assert [found.index for found in sim.objects[-2:]] == [3, 4]


def test_puck_is_moved_and_a_wall_is_no_place(sim: pogosim.Simulation) -> None:
    puck = sim.objects[PUCK_1]
    puck.move(600, 300, 1.5)
    assert puck.position == (600, 300)
    assert puck.heading == pytest.approx(1.5)
    puck.move(610, 300)
    assert puck.heading == pytest.approx(1.5)
    with pytest.raises(pogosim.ConfigurationError, match="is inside a wall or outside the arena"):
        puck.move(1, 1)
    with pytest.raises(pogosim.ConfigurationError, match="expected a finite number"):
        puck.move(math.nan, 300)
    assert puck.position == (610, 300)


def test_killed_robot_stands_still_until_it_is_revived(sim: pogosim.Simulation) -> None:
    sim.step(50)
    sim.objects[1].kill()
    assert sim.alive.tolist() == [True, False, True]
    assert not sim.leds[1].any()
    ticks, place = sim.ticks.copy(), sim.positions.copy()
    sim.step(50)
    assert sim.ticks[1] == ticks[1]
    np.testing.assert_array_equal(sim.positions[1], place[1])
    assert (sim.ticks[[0, 2]] > ticks[[0, 2]]).all()
    age = int(sim.user_data["age"][1])
    sim.objects[1].revive()
    assert sim.objects[1].is_alive
    sim.step(50)
    assert sim.ticks[1] > ticks[1] + 20
    assert sim.user_data["age"][1] > age + 20
    assert sim.leds[1, 0, 0] == sim.user_data["age"][1]
    with pytest.raises(pogosim.ConfigurationError, match="object 4 of category 'pucks' runs no program"):
        sim.objects[PUCK_1].kill()


def test_lamp_is_switched_dimmed_and_moved_at_once(sim: pogosim.Simulation) -> None:
    (lamp,) = sim.lamps
    assert (lamp.category, lamp.is_on, lamp.intensity, lamp.position) == ("light", True, 1.0, (564.0, 564.0))
    lit = sim.light_map > 0
    assert lit.any()
    lamp.intensity = 0.5
    assert set(np.unique(sim.light_map)) == {0, 500}
    lamp.is_on = False
    assert not sim.light_map.any()
    lamp.is_on, lamp.intensity, lamp.position = True, 1.0, (300.0, 564.0)
    moved = sim.light_map > 0
    assert moved.sum() == pytest.approx(lit.sum(), rel=0.05)
    assert np.argwhere(moved)[:, 1].mean() < np.argwhere(lit)[:, 1].mean() - 10
    sim.objects[ROBOT].move(300, 564)
    assert sim.objects[ROBOT].light == 1000
    for wrong in (-1.0, math.nan, math.inf):
        with pytest.raises(pogosim.ConfigurationError, match="intensity: expected a finite number of at least 0"):
            lamp.intensity = wrong
    with pytest.raises(pogosim.ConfigurationError, match="x: expected a finite number, found nan"):
        lamp.position = (math.nan, 0.0)
    assert lamp.intensity == 1.0


def test_column_set_from_python_stands_in_the_rows(sim: pogosim.Simulation) -> None:
    sim.set_column("table_1", 7.0, obj=PUCK_1)
    sim.set_column("steps_of_all", -3)
    sim.run(until_s=0.1)
    last = sim.to_dataframe().tail(5)
    assert last["table_1"].tolist()[:3] == [2.0, 2.0, 2.0]  # the robots' own
    assert last["table_1"].isna().tolist() == [False, False, False, True, False]
    assert last["table_1"].iloc[4] == 7.0
    assert last["steps_of_all"].tolist()[3:] == [-3, -3]
    with pytest.raises(pogosim.ConfigurationError, match="has no column 'fitness' of the program"):
        sim.set_column("fitness", 1.0)
    with pytest.raises(pogosim.ConfigurationError, match="expected a whole number from -2147483648 to 2147483647"):
        sim.set_column("steps_of_all", 0.5)
    with pytest.raises(pogosim.ConfigurationError, match="there is no object 5: the run has 5"):
        sim.set_column("table_1", 1.0, obj=5)
    with pytest.raises(pogosim.ConfigurationError, match="there is no object -1"):
        sim.set_column("table_1", 1.0, obj=-1)


def test_what_does_not_exist_is_an_error(sim: pogosim.Simulation) -> None:
    with pytest.raises(IndexError):
        sim.objects[5]
    with pytest.raises(IndexError):
        sim.lamps[1]
    with pytest.raises(pogosim.ConfigurationError, match="no objects have the category 'walls'; there are"):
        sim.objects.of("walls")


def test_data_file_says_that_a_host_switched_something(hosted: Path, tmp_path: Path) -> None:
    scene = write_scene(tmp_path, {**SETTINGS, "arena_file": str(ROOT / "arenas" / "disk.csv")})
    file = tmp_path / "rows.feather"
    with pogosim.Simulation(hosted, scene, data_file=file) as simulation:
        simulation.step(50)
        simulation.objects[0].kill()
        simulation.lamps[0].is_on = False
        simulation.run()
    _, metadata = load_dataframe(file)
    expected = "2 times from t = 0.5000 s on: robots switched off or on once, lamps set once"
    assert metadata["touched"] == expected


def test_slips_of_the_pen_are_errors(sim: pogosim.Simulation) -> None:
    with pytest.raises(pogosim.ConfigurationError, match="is_on: expected True or False, found 'off'"):
        sim.lamps[0].is_on = "off"  # type: ignore[assignment]
    with pytest.raises(AttributeError):
        sim.lamps[0].on = False  # type: ignore[attr-defined]
    with pytest.raises(AttributeError):
        sim.objects[0].pose = (1, 2)  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="read-only"):
        sim.alive[0] = False
