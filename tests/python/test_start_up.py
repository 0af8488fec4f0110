"""What a start reads: nothing that the run does not need, and nothing again that has not changed."""

from __future__ import annotations

import ast
import logging
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pogosim
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from pogosim.command.main import COMMANDS
from pogosim.reports.command import ANALYSES
from pogosim.simple_yaml import simple_yaml
from pogosim.yaml_1_2 import dump_yaml
from running import ROOT, build_folder, example, write_scene

HANABI = ROOT / "examples" / "hanabi" / "hanabi.so"
LARGE_PACKAGES = ("yaml", "elftools", "pandas", "pyarrow", "tempfile", "importlib.metadata")
NO_ROWS: dict[str, Any] = {"enable_data_logging": False}


@pytest.fixture(autouse=True)
def _installation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A configuration of three robots, in the working folder."""
    monkeypatch.chdir(tmp_path)
    return write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv")})


def state_after(simulation: pogosim.Simulation, steps: int = 30) -> int:
    simulation.step(steps)
    return simulation.state_hash


def state_of_new(configuration: Path, seed: int = 1, **settings: Any) -> int:
    with pogosim.Simulation(HANABI, configuration, seed=seed, set=NO_ROWS | settings) as simulation:
        return state_after(simulation)


# ---- Processes


@pytest.mark.skipif(sys.platform != "linux", reason="only its dynamic linker tells what it loads")
@pytest.mark.parametrize("has_rows", [False, True])
def test_only_a_run_with_rows_loads_arrow(scene: Path, has_rows: bool) -> None:
    command = [str(example("hanabi")), "-c", str(scene), "-g", "--set", f"enable_data_logging={str(has_rows).lower()}"]
    environment = {**os.environ, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": "linker"}
    subprocess.run(command, env=environment, check=True, capture_output=True, cwd=scene.parent)
    (log,) = scene.parent.glob("linker.*")
    loaded = log.read_text(encoding="utf-8", errors="replace")
    assert "libpogosim" in loaded
    assert ("libarrow" in loaded) == has_rows
    assert ("libpogosim_tables" in loaded) == has_rows


@pytest.mark.skipif(sys.platform != "linux", reason="its dynamic linker takes another library")
def test_a_missing_module_of_tables_is_told_and_needed_for_rows_alone(scene: Path, tmp_path: Path) -> None:
    alone = tmp_path / "alone"
    alone.mkdir()
    for library in (build_folder() / "src").glob("libpogosim.so*"):
        (alone / library.name).write_bytes(library.read_bytes())
    for has_rows, code in ((False, 0), (True, 2)):
        run = subprocess.run(
            [example("hanabi"), "-c", scene, "-g", "-q", "--set", f"enable_data_logging={str(has_rows).lower()}"],
            env={**os.environ, "LD_LIBRARY_PATH": str(alone)},
            capture_output=True,
            text=True,
            cwd=scene.parent,
        )
        assert run.returncode == code, run.stderr
        assert ("cannot write the data file 'data.feather' (data_filename): the module" in run.stderr) == has_rows


# ---- Python


def test_a_run_in_python_imports_no_large_package(scene: Path) -> None:
    code = f"""if True:
        import sys, pogosim
        settings = {{"simulation_time": 1.5, "objects.robots.nb": 2, "initial_formation": "random"}}
        with pogosim.Simulation({str(HANABI)!r}, {str(scene)!r}, seed=1, set=settings) as simulation:
            simulation.run()
            simulation.reset(2)
        print([name for name in {LARGE_PACKAGES!r} if name in sys.modules])
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"


# What is not imported by what: a command that explains itself, or a module whose work needs none of it yet.
FOR_NUMBERS = ("numpy", "pandas", "pyarrow", "matplotlib", "scipy", "shapely", "PIL", "asyncio", "multiprocessing")
NOT_LOADED = {
    "pogosim": FOR_NUMBERS,
    "pogosim.watch": FOR_NUMBERS,
    "pogosim.simulation.errors": FOR_NUMBERS,
    "pogosim.simulation": FOR_NUMBERS,
    "pogosim.reports.command_lines": FOR_NUMBERS,
    "pogosim.utils": ("pandas", "matplotlib", "scipy", "shapely"),
    "pogosim.scene": ("pandas", "scipy", "shapely"),
    "pogosim.watch.server": ("pandas", "scipy", "shapely"),
}


def loaded_by(code: str, modules: Sequence[str]) -> list[str]:
    """Return which modules a piece of code has loaded."""
    tell = f"\nimport sys\nprint([name for name in {list(modules)!r} if name in sys.modules], file=sys.stderr)"
    run = subprocess.run([sys.executable, "-c", code + tell], capture_output=True, text=True, check=True)
    return list(ast.literal_eval(run.stderr.splitlines()[-1]))


@pytest.mark.parametrize("command", ["--help", "--version", *(f"{name} --help" for name in COMMANDS.own)])
def test_commands_explain_themselves_without_large_packages(command: str) -> None:
    code = f"from pogosim.command.main import main\ntry: main({command.split()!r})\nexcept SystemExit: pass"
    assert loaded_by(code, FOR_NUMBERS) == []


@pytest.mark.parametrize("analysis", ANALYSES.own)
def test_analyses_explain_themselves_without_large_packages(analysis: str) -> None:
    arguments = ["analyze", analysis, "--help"]
    code = f"from pogosim.command.main import main\ntry: main({arguments!r})\nexcept SystemExit: pass"
    assert loaded_by(code, FOR_NUMBERS) == []


@pytest.mark.parametrize("module", NOT_LOADED)
def test_modules_import_no_package_that_they_may_not_need(module: str) -> None:
    assert loaded_by(f"import {module}", NOT_LOADED[module]) == []


def test_a_deferred_package_is_imported_when_it_is_used() -> None:
    code = "from pogosim.deferred import pandas as pd"
    assert loaded_by(code, ["pandas"]) == []
    assert loaded_by(f"{code}\nassert len(pd.DataFrame()) == 0", ["pandas"]) == ["pandas"]


SIMPLE_VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(),
    st.text(alphabet="aAeEyYnNoOfFsS01_/.+-~:# "),
    st.sampled_from(["yes", "On", "NULL", "~", "1e3", "0x1F", ".nan", "=", "<<", "o...", "disk", "arenas/disk.csv"]),
)


@given(SIMPLE_VALUES)
def test_simple_values_are_written_as_pyyaml_writes_them(value: Any) -> None:
    text = simple_yaml(value)
    assert text is None or text == dump_yaml(value, is_flow=True).strip()


@pytest.mark.parametrize(
    "value", [None, True, 50, 0.25, -3.0, "disk", "arenas/disk.csv", "/tmp/rows.feather", "two_words"]
)
def test_usual_values_need_no_pyyaml(value: Any) -> None:
    assert simple_yaml(value) is not None


def test_texts_that_end_in_dots_keep_them() -> None:
    for text in ("o...", "...", "a b..."):
        assert yaml.safe_load(dump_yaml(text)) == text


# ---- Resets


SETS_OF_KEYS: dict[str, dict[str, Any]] = {
    "how many robots": {"objects.robots.nb": 5},
    "speed": {"objects.robots.max_linear_speed": 40.0},
    "shape": {"objects.robots.radius": 20.0},
    "time step": {"time_step": 0.005},
    "duration": {"simulation_time": 1.0},
    "arena": {"arena_file": str(ROOT / "arenas" / "square.csv")},
    "arena's size": {"arena_surface": 5e5},
    "boundary": {"arena_file": str(ROOT / "arenas" / "square.csv"), "boundary_condition": "periodic"},
    "formation": {"initial_formation": "disk"},
    "messages": {
        "objects.robots.communication_radius": 200.0,
        "objects.robots.msg_success_rate": {"type": "static", "rate": 0.5},
    },
    "noise": {"objects.robots.linear_noise_stddev": 0.1},
    "engine": {"physics_engine": "disk"},
    "a lamp": {"objects.lamp": {"type": "static_light", "light_mode": "static", "geometry": "global", "value": 200}},
    "a pillar": {"objects.pillar": {"type": "passive_object", "geometry": "disk", "radius": 30.0}},
    "a parameter": {"parameters.turn_duration": 200},
    "another brain": {"objects.robots.brain": "host"},
    "a list": {"objects.robots.temporal_noise_stddev": 0.01, "data_logger_fields": ["time", "x", "y"]},
}


@pytest.mark.parametrize("name", SETS_OF_KEYS)
def test_reset_with_other_keys_is_a_new_simulation_with_them(scene: Path, name: str) -> None:
    keys = SETS_OF_KEYS[name]
    expected = [state_of_new(scene, seed, **keys) for seed in (1, 2)]
    assert state_of_new(scene) != expected[1]
    with pogosim.Simulation(HANABI, scene, seed=1, set=NO_ROWS) as simulation:
        before = state_after(simulation)
        simulation.reset(set=keys)
        assert state_after(simulation) == expected[0]
        simulation.reset(2)  # the keys stay
        assert state_after(simulation) == expected[1]
    with pogosim.Simulation(HANABI, scene, seed=1, set=NO_ROWS) as simulation:
        assert state_after(simulation) == before


def test_rows_of_a_reset_with_other_keys_are_those_of_a_new_simulation(scene: Path) -> None:
    keys = {"objects.robots.nb": 4, "save_data_period": 0.2}
    with pogosim.Simulation(HANABI, scene, seed=1) as simulation:
        simulation.run()
        simulation.reset(7, keys)
        simulation.run()
        found = simulation.to_dataframe()
    with pogosim.Simulation(HANABI, scene, seed=7, set=keys) as simulation:
        simulation.run()
        assert simulation.to_dataframe().equals(found)


def test_a_reset_that_fails_leaves_the_keys_as_they_were(scene: Path) -> None:
    expected = state_of_new(scene, **{"objects.robots.nb": 4})
    with pogosim.Simulation(HANABI, scene, seed=1, set=NO_ROWS) as simulation:
        simulation.reset(set={"objects.robots.nb": 4})
        for wrong in ({"objects.robots.nb": "many"}, {"objects.robots.radius": 1e5}):
            with pytest.raises(pogosim.ConfigurationError, match=next(iter(wrong))):
                simulation.reset(2, wrong)
        simulation.reset(1)
        assert state_after(simulation) == expected


def test_the_data_file_stays_in_its_place(scene: Path) -> None:
    with pogosim.Simulation(HANABI, scene, seed=1, data_file="rows.feather") as simulation:
        expected = state_after(simulation)
        simulation.reset(set={"data_filename": "rows.feather"})
        with pytest.raises(pogosim.ConfigurationError, match="data_filename cannot be changed"):
            simulation.reset(set={"data_filename": "others.feather"})
        assert state_after(simulation) == expected


def replace(file: Path, old: str, new: str) -> None:
    """Change a text in a file, whose size and times stay as they were."""
    status = file.stat()
    text = file.read_text(encoding="utf-8")
    assert len(old) == len(new)
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns))


def test_reset_reads_a_configuration_that_has_changed(scene: Path) -> None:
    with pogosim.Simulation(HANABI, scene, seed=1, set=NO_ROWS) as simulation:
        before = state_after(simulation)
        replace(scene, "nb: 3", "nb: 4")
        simulation.reset()
        assert len(simulation.positions) == 4
        replace(scene, "nb: 4", "nb: 3")
        simulation.reset()
        assert state_after(simulation) == before
        scene.write_text("arena_file: [", encoding="utf-8")
        with pytest.raises(pogosim.ConfigurationError, match="not valid YAML"):
            simulation.reset()


def test_reset_reads_a_model_that_has_changed_and_one_that_comes_before(tmp_path: Path, scene: Path) -> None:
    folder = tmp_path / "below"
    folder.mkdir()
    configuration = folder / scene.name
    scene.rename(configuration)
    model = folder / "small.yaml"
    model.write_text("radius: 20.0\n", encoding="utf-8")
    settings = NO_ROWS | {"objects.robots.robot_model": "small.yaml", "objects.robots.geometry": "disk"}
    text = configuration.read_text(encoding="utf-8")
    configuration.write_text(text.replace("radius: 26.5", "body_friction: 0.2"), encoding="utf-8")
    with pogosim.Simulation(HANABI, configuration, seed=1, set=settings) as simulation:
        assert simulation.radii[0] == 20.0
        replace(model, "20.0", "21.0")
        simulation.reset()
        assert simulation.radii[0] == 21.0
        (tmp_path / "small.yaml").write_text("radius: 22.0\n", encoding="utf-8")  # the working folder comes first
        simulation.reset()
        assert simulation.radii[0] == 22.0
        (tmp_path / "small.yaml").unlink()
        simulation.reset()
        assert simulation.radii[0] == 21.0
        model.unlink()
        with pytest.raises(pogosim.ConfigurationError, match=r"small\.yaml"):
            simulation.reset()


def test_reset_reads_an_arena_that_has_changed(tmp_path: Path, scene: Path) -> None:
    arena = tmp_path / "box.csv"
    arena.write_text("0,0\n400,0\n400,400\n0,400\n", encoding="utf-8")
    settings = NO_ROWS | {"arena_file": "box.csv", "arena_surface": 4e5}
    with pogosim.Simulation(HANABI, scene, seed=1, set=settings) as simulation:
        before = state_after(simulation)
        arena.write_text("0,0\n800,0\n800,400\n0,400\n", encoding="utf-8")
        simulation.reset()
        assert state_after(simulation) != before
        assert state_of_new(scene, arena_file="box.csv", arena_surface=4e5) != before


def test_a_configuration_that_is_known_still_warns(scene: Path, caplog: pytest.LogCaptureFixture) -> None:
    settings = {"objects.robots.radus": 1, "data_filename": "rows.feather"}
    found = []
    for _ in range(3):
        caplog.clear()
        with caplog.at_level(logging.DEBUG, "pogosim"), pogosim.Simulation(HANABI, scene, seed=1, set=settings):
            found.append([record.getMessage() for record in caplog.records])
    assert any("unknown key 'objects.robots.radus'" in line for line in found[0])
    assert found[0] == found[1] == found[2]


def test_a_working_folder_is_part_of_what_is_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    states = []
    for width in (400, 800):
        folder = tmp_path / str(width)
        folder.mkdir()
        (folder / "box.csv").write_text(f"0,0\n{width},0\n{width},400\n0,400\n", encoding="utf-8")
        write_scene(folder, {"arena_file": "box.csv"})
        monkeypatch.chdir(folder)
        states.append(state_of_new(Path(next(folder.glob("*.yaml")).name)))
    assert states[0] != states[1]
