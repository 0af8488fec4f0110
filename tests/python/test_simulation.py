"""Runs inside of this process: pogosim.Simulation and pogosim.VectorSimulation."""

from __future__ import annotations

import copy
import gc
import io
import logging
import math
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from PIL import Image
from pogosim.simulation.library import in_words_of_python
from pogosim.utils import load_dataframe
from running import PROGRAMS, ROOT, SHARED, compile_program, compiler, example, run, write_scene

HANABI = ROOT / "examples" / "hanabi" / "hanabi.so"
TUMBLE = ROOT / "examples" / "run_and_tumble" / "run_and_tumble.so"
SIMPLE = ROOT / "conf" / "simple.yaml"


@pytest.fixture(autouse=True)
def _folders_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A configuration of three robots and 2 s."""
    return write_scene(tmp_path, {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5})


def state(simulation: pogosim.Simulation) -> tuple[bytes, ...]:
    """All that a run looks like."""
    arrays = (simulation.positions, simulation.headings, simulation.velocities, simulation.leds, simulation.ticks)
    return tuple(np.ascontiguousarray(array).tobytes() for array in arrays)


def alone(hosted: Path, seed: int, steps: int) -> tuple[bytes, ...]:
    with pogosim.Simulation(hosted, SIMPLE, seed=seed) as simulation:
        simulation.step(steps)
        return state(simulation)


def test_rows_are_those_of_the_command_line(hosted: Path, scene: Path, tmp_path: Path) -> None:
    executable = compile_program(tmp_path / "hosted", PROGRAMS / "hosted.c", flags=("-g",))
    on_command_line = run(executable, tmp_path, {"save_data_period": 0.5}).frame()
    with pogosim.Simulation(hosted, scene) as simulation:
        assert simulation.run() == 200
        assert simulation.is_over
        assert simulation.to_dataframe().equals(on_command_line)


def test_interleaved_runs_of_two_programs_are_what_each_is_alone() -> None:
    expected = [alone(HANABI, 1, 300), alone(TUMBLE, 2, 300), alone(TUMBLE, 3, 300)]
    runs = [pogosim.Simulation(*of) for of in ((HANABI, SIMPLE), (TUMBLE, SIMPLE), (TUMBLE, SIMPLE))]
    for simulation, seed in zip(runs, (1, 2, 3), strict=True):
        simulation.reset(seed)
    for steps in (1, 2, 3) * 50:
        for simulation in runs:
            simulation.step(steps)
    assert [state(simulation) for simulation in runs] == expected
    for simulation in runs:
        simulation.close()


def test_runs_on_threads_are_what_each_is_alone() -> None:
    seeds = range(6)
    with pogosim.VectorSimulation(TUMBLE, SIMPLE, seeds, threads=3) as runs:
        for _ in range(20):
            assert runs.step(10) == [10] * len(seeds)
        assert [state(simulation) for simulation in runs] == [alone(TUMBLE, seed, 200) for seed in seeds]
        assert runs.positions.shape == (6, 100, 2)
        assert not runs.is_over.any()
        runs.reset()
        assert [simulation.seed for simulation in runs] == list(seeds)
        assert {simulation.time for simulation in runs} == {0.0}


def test_each_run_has_variables_of_its_own(hosted: Path, scene: Path) -> None:
    runs = [pogosim.Simulation(hosted, scene) for _ in range(2)]
    runs[0].step(100)
    runs[1].step(50)
    last = [simulation.to_dataframe()["steps_of_all"].iloc[-1] for simulation in runs]
    assert last[0] > 1.5 * last[1] > 0
    runs[0].reset()
    assert runs[0].to_dataframe()["steps_of_all"].tolist() == [0, 0, 0]
    for simulation in runs:
        simulation.close()


def test_c_library_of_the_robots_is_their_own(sim: pogosim.Simulation) -> None:
    """Whatever process they run in: srand(7) has given all of them the same numbers, which are not those of libc."""
    sim.step(20)
    numbers = sim.user_data["numbers"]
    assert len(set(numbers[:, 0])) == 1
    assert len(set(numbers[:, 1])) == 1
    libc = subprocess.run(
        [sys.executable, "-c", "import ctypes; c = ctypes.CDLL(None); c.srand(7); print(c.rand())"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert int(libc.stdout) != numbers[0, 0]


def test_arrays_are_views_that_go_with_the_run(sim: pogosim.Simulation) -> None:
    positions, leds = sim.positions, sim.leds
    before = positions.copy()
    sim.step(50)
    assert not np.array_equal(positions, before)
    assert leds[:, 0, 0].tolist() == sim.user_data["age"].tolist() == [31, 31, 31]
    assert leds.shape == (3, 5, 3)
    assert (sim.ticks == 31).all()
    for array in (positions, leds, sim.headings, sim.velocities, sim.angular_velocities, sim.light_map, sim.radii):
        assert not array.flags.writeable
        assert not array.flags.owndata
    with pytest.raises(ValueError, match="read-only"):
        positions[0] = 0
    speeds = np.hypot(*sim.velocities.T)
    assert (speeds > 0).all()
    assert sim.robot_ids.tolist() == [0, 1, 2]
    assert sim.categories == ["robots"]
    assert sim.radii.tolist() == [26.5] * 3


def test_arrays_outlive_the_run(hosted: Path, scene: Path) -> None:
    simulation = pogosim.Simulation(hosted, scene)
    simulation.step(10)
    positions, data = simulation.positions, simulation.user_data
    copy = positions.copy()
    simulation.reset()
    simulation.step(30)
    simulation.close()
    del simulation
    gc.collect()
    assert np.array_equal(positions, copy)
    assert data["state"].tolist() == [7, 7, 7]
    with pytest.raises(ValueError, match="read-only"):
        data["state"] = 8


def test_user_data_have_the_types_of_the_program(sim: pogosim.Simulation) -> None:
    sim.step(10)
    data = sim.user_data
    names = ("gain", "age", "levels", "estimate", "state", "numbers", "name", "self")
    assert data.dtype.names == names
    assert data["levels"].tolist() == [[0, -3, 0]] * 3
    assert data["estimate"]["mean"].tolist() == [0.5] * 3
    assert data["estimate"]["known"].all()
    assert bytes(data["name"][0]).startswith(b"abc\0")
    assert len(set(data["self"].tolist())) == 3
    data["age"][1] = 100
    sim.step(20)
    assert sim.leds[1, 0, 0] > 100 > sim.leds[0, 0, 0]


def test_parameters_set_in_the_run_take_effect_at_once_and_in_later_ones(sim: pogosim.Simulation) -> None:
    sim.step(10)
    assert sim.user_data["gain"].tolist() == [1.0] * 3
    sim.parameters["gain"] = 2.5
    sim.parameters["table"] = [3.0, np.float64(4.0)]
    sim.step(50)
    assert sim.user_data["gain"].tolist() == [2.5] * 3
    assert sim.to_dataframe()["table_1"].iloc[-1] == 4.0
    sim.reset()
    sim.step(10)
    assert sim.user_data["gain"].tolist() == [2.5] * 3
    assert dict(sim.parameters) == {"gain": 2.5, "table": [3.0, 4.0]}


def test_parameters_that_a_map_gave_are_among_those_that_were_set(hosted: Path, scene: Path) -> None:
    settings = {"parameters.table": [0.0, 1.0], "parameters": {"gain": 2.5, "fail": {"at": 7}}}
    with pogosim.Simulation(hosted, scene, set=settings) as simulation:
        assert dict(simulation.parameters) == {"gain": 2.5, "fail.at": 7}
        simulation.step(10)
        assert simulation.user_data["gain"].tolist() == [2.5] * 3
        simulation.parameters["gain"] = 3.5
        simulation.reset()
        simulation.step(10)
        assert simulation.user_data["gain"].tolist() == [3.5] * 3
        assert dict(simulation.parameters) == {"gain": 3.5, "fail.at": 7}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("gain", "fast", r"^set: parameters.gain: expected a number.*, found 'fast'"),
        ("table", [1.0], r"^set: parameters.table: expected a list of at least 2 numbers, found 1"),
        ("gian", 1.0, r"parameters.gian: the program has not read it into a global variable or USERDATA"),
        ("local", 1.0, r"parameters.local: the program has not read it into a global variable or USERDATA"),
    ],
)
def test_wrong_parameters_are_refused_and_change_nothing(
    name: str, value: Any, message: str, sim: pogosim.Simulation
) -> None:
    with pytest.raises(pogosim.ConfigurationError, match=message):
        sim.parameters[name] = value
    assert dict(sim.parameters) == {}
    sim.step(10)
    assert sim.user_data["gain"].tolist() == [1.0] * 3


def test_program_that_exits_with_success_ends_its_run(hosted: Path, scene: Path, tmp_path: Path) -> None:
    file = tmp_path / "rows.feather"
    settings = {"parameters.fail_at_tick": 60, "parameters.failure": "success"}
    with pogosim.Simulation(hosted, scene, set=settings, data_file=file) as sim:
        done = sim.step(1000)
        assert 90 < done < 110  # ticks of 16 ms, steps of 10 ms
        assert sim.is_over
        assert sim.step() == 0
        rows, _ = load_dataframe(file)
        assert rows["time"].unique().tolist() == [0.0, 0.5]
        sim.reset()
        assert sim.step(10) == 10


@pytest.mark.parametrize(
    ("failure", "kind", "message"),
    [
        ("crash", pogosim.ProgramFailedError, "failed in user_step of robot #1 .*segmentation fault at address 0x8"),
        ("loop", pogosim.ProgramFailedError, "did not return within 0.2 s of processor time"),
        ("exit", pogosim.ConfigurationError, r"called exit\(5\)"),
        ("refuse", pogosim.ConfigurationError, "parameters.failure: expected something else"),
    ],
)
def test_failure_ends_one_run_and_no_other(
    failure: str, kind: type[Exception], message: str, hosted: Path, scene: Path, tmp_path: Path
) -> None:
    file = tmp_path / "rows.feather"
    settings = {"parameters.fail_at_tick": 60, "parameters.failure": failure, "user_code_timeout": 0.2}
    other = pogosim.Simulation(hosted, scene, seed=5)
    other.step(30)
    handlers = [signal.getsignal(number) for number in signal.valid_signals()]
    failing = pogosim.Simulation(hosted, scene, set=settings, data_file=file)
    with pytest.raises(kind, match=message):
        failing.run()
    assert failing.is_over
    with pytest.raises(pogosim.SimulationError, match="the run has failed: reset it"):
        failing.step()
    rows, metadata = load_dataframe(file)  # complete
    assert rows["time"].unique().tolist() == [0.0, 0.5]
    assert metadata["resolved_configuration"]["parameters"]["failure"] == failure
    assert [signal.getsignal(number) for number in signal.valid_signals()] == handlers
    other.step(70)
    with pogosim.Simulation(hosted, scene, seed=5) as undisturbed:
        undisturbed.step(100)
        assert state(other) == state(undisturbed)
    failing.reset()
    assert failing.step(10) == 10
    failing.close()
    other.close()


def test_crashes_on_threads_are_those_of_their_runs(hosted: Path, scene: Path) -> None:
    settings = {"parameters.failure": "crash", "save_data_period": -1}
    runs = [
        pogosim.Simulation(hosted, scene, set={**settings, "parameters.fail_at_tick": 5 + 7 * i if i % 2 else -1})
        for i in range(8)
    ]
    errors: dict[int, str] = {}

    def go(index: int) -> None:
        try:
            runs[index].run()
        except pogosim.ProgramFailedError as error:
            errors[index] = str(error)

    threads = [threading.Thread(target=go, args=(index,)) for index in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(errors) == [1, 3, 5, 7]
    for index, message in errors.items():
        assert f"tick {5 + 7 * index}" in message
    for simulation in runs:
        simulation.close()


def test_picture_is_that_of_a_frame_of_the_same_moment(hosted: Path, scene: Path, tmp_path: Path) -> None:
    frames = {"frames_name": str(tmp_path / "f{:07.4f}.png"), "save_video_period": 0.5}
    size = {"window_width": 300, "window_height": 200}
    with pogosim.Simulation(hosted, scene, set={**frames, **size}) as sim:
        sim.run(0.5)
        picture = sim.render(300, 200)
        assert picture.shape == (200, 300, 3)
        assert picture.dtype == np.uint8
        assert np.array_equal(np.asarray(Image.open(io.BytesIO(sim._repr_png_() or b"")))[..., :3], sim.render())
        before = sim.state_hash
        sim.render(1, 1)
        assert sim.state_hash == before
    assert np.array_equal(np.asarray(Image.open(tmp_path / "f00.5000.png"))[..., :3], picture)
    assert sim._repr_png_() is None


def test_pictures_show_robots_where_they_are(hosted: Path, scene: Path) -> None:
    with pogosim.Simulation(hosted, scene) as sim:
        first = sim.render()
        assert len(np.unique(first.reshape(-1, 3), axis=0)) > 3
        assert np.array_equal(sim.render(), first)
        sim.set_pose(1, 500.0, 520.0)
        assert not np.array_equal(sim.render(), first)


@pytest.mark.parametrize("size", [(0, 100), (100, -1), (20_000, 10), (10.5, 10), ("a", 10), (True, 10)])
def test_pictures_of_no_size_are_refused(size: tuple[Any, Any], sim: pogosim.Simulation) -> None:
    with pytest.raises(pogosim.ConfigurationError, match=r"(width|height): expected an integer"):
        sim.render(*size)


def test_poses_can_be_set(sim: pogosim.Simulation) -> None:
    sim.step(10)
    sim.set_pose(1, 500.0, 520.0, math.pi)
    assert sim.positions[1].tolist() == [500.0, 520.0]
    assert sim.headings[1] == pytest.approx(math.pi)
    assert sim.velocities[1].tolist() == [0.0, 0.0]
    sim.step(2)
    assert np.hypot(*(sim.positions[1] - (500.0, 520.0))) < 5
    sim.set_pose(1, 480.0, 520.0, 7.0)
    assert sim.headings[1] == pytest.approx(7.0 - 2.0 * math.pi)
    sim.set_pose(1, 480.0, 520.0)
    for robot, x, y, message in (
        (1, 0.0, 0.0, "is inside a wall or outside the arena"),
        (1, math.nan, 0.0, "x: expected a finite number, found nan"),
        (3, 500.0, 500.0, "there is no robot 3: the run has 3"),
        (-1, 500.0, 500.0, "there is no robot -1: the run has 3"),
    ):
        with pytest.raises(pogosim.ConfigurationError, match=message):
            sim.set_pose(robot, x, y, 0.0)


def test_messages_and_lines_of_robots_go_to_the_loggers(
    hosted: Path, scene: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO)
    with pogosim.Simulation(hosted, scene, set={"parameters.gian": 3, "simulation_tme": 1}) as simulation:
        assert ("pogosim.robots", logging.INFO, "[ROBOT #2] [PRINTF] hello from 2") in caplog.record_tuples
        warnings = [message for name, level, message in caplog.record_tuples if (name, level) == ("pogosim", 30)]
        assert "unknown key 'simulation_tme'" in warnings[0]
        simulation.end()
    assert "parameters never read by the program: gian" in caplog.text


def test_warning_is_not_repeated_after_each_reset(hosted: Path, scene: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    with pogosim.Simulation(hosted, scene, set={"parameters.gian": 3}) as simulation:
        for seed in range(3):
            simulation.reset(seed=seed)
    lines = [message for name, _, message in caplog.record_tuples if name == "pogosim"]
    assert sum("parameters never read" in line for line in lines) == 1
    assert caplog.text.count("hello from 2") == 4


def test_messages_speak_of_the_argument_not_of_options(
    hosted: Path, scene: Path, caplog: pytest.LogCaptureFixture
) -> None:
    settings = {"parameters.gian": 3, "objects.robots.raduis": 3}
    pogosim.Simulation(hosted, scene, set=settings).close()
    assert "set: unknown key 'objects.robots.raduis' is ignored" in caplog.text
    assert "parameters never read by the program: gian (set" in caplog.text
    assert "--set" not in caplog.text
    assert in_words_of_python("a (--set) and 6 more (-v lists them)") == "a (set) and 6 more"
    with pytest.raises(pogosim.ConfigurationError, match=r"^set: seed: .*\nset: objects\.robots\.nb: "):
        pogosim.Simulation(hosted, scene, set={"objects.robots.nb": "x", "seed": -4})


def test_warning_of_many_runs_is_passed_on_once(hosted: Path, scene: Path, caplog: pytest.LogCaptureFixture) -> None:
    settings = {"parameters.gian": 3}
    with pogosim.VectorSimulation(hosted, scene, seeds=range(6), threads=3, set=settings) as runs:
        runs.reset()
    assert caplog.text.count("parameters never read by the program: gian") == 1
    warned: set[str] = set()
    for _ in range(3):
        pogosim.Simulation(hosted, scene, set=settings, warned=warned).close()
    assert caplog.text.count("parameters never read by the program: gian") == 2
    assert "Wparameters never read by the program: gian (--set)" in warned
    pogosim.Simulation(hosted, scene, set={"parameters.gain2": 3}, warned=warned).close()
    assert caplog.text.count("parameters never read by the program: gain2") == 1
    wrong: Any = ["gian"]
    with pytest.raises(pogosim.ConfigurationError, match="warned: expected a set, which may be empty, found"):
        pogosim.Simulation(hosted, scene, warned=wrong)


def test_what_cannot_be_run_is_one_clear_message(hosted: Path, scene: Path, tmp_path: Path) -> None:
    text = tmp_path / "text.so"
    text.write_text("text")
    other = tmp_path / "other.so"
    source = tmp_path / "other.c"
    source.write_text("int one = 1;\n")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", other, source], check=True)
    elsewhere = tmp_path / "elsewhere.so"
    code = other.read_bytes()
    elsewhere.write_bytes(code[:18] + b"\x16\x00" + code[20:])  # S/390
    cases = [
        (tmp_path / "absent.so", scene, "the program '.*absent.so' cannot be read: No such file"),
        (tmp_path, scene, "is a folder"),
        (text, scene, "is no shared object"),
        (elsewhere, scene, "is for another processor: make it on this machine"),
        (other, scene, "is no program for Pogosim"),
        (Path("/bin/true"), scene, "is an executable: name the shared object"),
        (hosted, tmp_path / "absent.yaml", "absent.yaml"),
    ]
    for of_program, configuration, message in cases:
        with pytest.raises(pogosim.ConfigurationError, match=message):
            pogosim.Simulation(of_program, configuration)
    with pytest.raises(pogosim.ConfigurationError, match=r"objects\.robots\.nb: expected an integer"):
        pogosim.Simulation(hosted, scene, set={"objects.robots.nb": "many"})
    with pytest.raises(pogosim.ConfigurationError, match="seed: expected an integer from 0 to 4294967295"):
        pogosim.Simulation(hosted, scene, seed=2**32)
    with pytest.raises(pogosim.ConfigurationError, match="unknown key"):
        pogosim.Simulation(hosted, scene, set={"simulation_tme": 1}, strict=True)
    with pytest.raises(pogosim.ConfigurationError, match=r"^set: unknown key 'simulation_tme'; did you mean '\w+'\?$"):
        pogosim.Simulation(hosted, scene, set={"simulation_tme": 1}, strict_set=True)


def test_executable_stands_for_the_shared_object_beside_it() -> None:
    with pogosim.Simulation(example("hanabi"), SIMPLE, seed=1) as simulation:
        assert simulation.program == HANABI


def test_program_that_was_built_again_is_loaded_by_the_next_run(hosted: Path, scene: Path, tmp_path: Path) -> None:
    source = (PROGRAMS / "hosted.c").read_text()
    copy = tmp_path / "changing.so"
    copy.write_bytes(hosted.read_bytes())
    simulation = pogosim.Simulation(copy, scene)
    simulation.step(10)
    changed = tmp_path / "changed.c"
    changed.write_text(source.replace('strcpy(mydata->name, "abc")', 'strcpy(mydata->name, "xyz")'))
    compile_program(copy, changed, flags=SHARED)
    simulation.step(10)
    assert bytes(simulation.user_data["name"][0]).startswith(b"abc")
    simulation.reset()
    assert bytes(simulation.user_data["name"][0]).startswith(b"xyz")
    simulation.close()


def test_type_of_user_data_is_that_of_the_program_that_runs(hosted: Path, scene: Path, tmp_path: Path) -> None:
    copy = tmp_path / "changing.so"
    copy.write_bytes(hosted.read_bytes())
    with pogosim.Simulation(copy, scene) as simulation:
        assert simulation.user_data.dtype["gain"] == np.float32
        changed = tmp_path / "changed.c"
        changed.write_text((PROGRAMS / "hosted.c").read_text().replace("    float gain;", "    int32_t gain;"))
        compile_program(copy, changed, flags=SHARED)
        simulation.reset()
        assert simulation.user_data.dtype["gain"] == np.int32


@pytest.mark.parametrize(
    "name", [name for names in (("gcc",), ("clang", "clang-14")) if (name := compiler(*names)) is not None]
)
def test_each_compiler_tells_the_type_of_user_data(name: str, scene: Path, tmp_path: Path) -> None:
    built = compile_program(tmp_path / "built.so", PROGRAMS / "hosted.c", compiler=name, flags=SHARED)
    with pogosim.Simulation(built, scene) as simulation:
        assert simulation.user_data.dtype["gain"] == np.float32


CLASSES = """#include "pogobase.h"
#include <array>
#include <map>
#include <string>
#include <vector>
struct Origin { float depth; };
struct Base : Origin { int32_t id; };
struct Tag { uint8_t id; };
struct Root { int32_t root; };
struct Part : virtual Root { virtual ~Part() = default; int32_t own = 12; };
struct USERDATA : Base, Tag {
    uint32_t count;
    std::array<std::array<int16_t, 2>, 3> numbers;
    std::vector<int> list;
    std::string name;
    std::map<int, int> seen;
    unsigned low : 3, high : 5;
    union { uint32_t word; uint8_t bytes[4]; };
    struct { int16_t x, y; };
    Part part;
    static inline int total = 3;
    bool known;
};
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static void user_init() {
    mydata->depth = 0.5f;
    mydata->Base::id = -3;
    mydata->Tag::id = 200;
    mydata->numbers = {{{1, 2}, {3, 4}, {5, -6}}};
    mydata->word = 0x01020304;
    mydata->y = -4;
    mydata->low = 5;
    mydata->known = true;
}
static void user_step() { mydata->count = uint32_t(mydata->Base::id) + mydata->low; }
int main() { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
"""


@pytest.mark.parametrize("version", [4, 5])
@pytest.mark.parametrize(
    "name", [name for names in (("g++",), ("clang++", "clang++-14")) if (name := compiler(*names)) is not None]
)
def test_user_data_of_classes_have_the_members_of_their_base_classes(
    name: str, version: int, scene: Path, tmp_path: Path
) -> None:
    source = tmp_path / "classes.cpp"
    source.write_text(CLASSES)
    flags = ["-std=gnu++20", *SHARED, f"-gdwarf-{version}"]
    with pogosim.Simulation(
        compile_program(tmp_path / "it.so", source, compiler=name, flags=flags), scene
    ) as simulation:
        data = simulation.user_data
        # Without bit-fields, static members and the address of virtual functions.
        assert data.dtype.names == (
            *("depth", "id", "Tag::id", "count", "numbers", "list", "name", "seen"),
            *("word", "bytes", "x", "y", "part", "known"),
        )
        assert data["depth"].tolist() == [0.5] * 3
        assert data["id"].tolist() == [-3] * 3
        assert data["Tag::id"].tolist() == [200] * 3
        assert data["numbers"][0].tolist() == [[1, 2], [3, 4], [5, -6]]
        assert [data.dtype[member].kind for member in ("list", "name", "seen")] == ["V"] * 3
        assert data["bytes"][0].tolist() == [4, 3, 2, 1]
        assert data["y"].tolist() == [-4] * 3
        assert data["part"]["own"].tolist() == [12] * 3
        assert data["known"].all()
        data["id"][1] = 100
        simulation.step(10)
        assert data["count"].tolist() == [2, 105, 2]


def test_program_without_debug_information_has_no_user_data_type(scene: Path, tmp_path: Path) -> None:
    plain = compile_program(tmp_path / "plain.so", PROGRAMS / "hosted.c", flags=("-shared", "-fPIC"))
    with (
        pogosim.Simulation(plain, scene) as simulation,
        pytest.raises(pogosim.SimulationError, match="no debug information about USERDATA: compile it with -g"),
    ):
        simulation.user_data  # noqa: B018


def test_closed_simulations_say_so(hosted: Path, scene: Path) -> None:
    simulation = pogosim.Simulation(hosted, scene)
    folder = simulation.data_file.parent
    assert folder.is_dir()
    simulation.close()
    simulation.close()
    assert not folder.exists()
    assert "closed" in repr(simulation)
    for use in (simulation.step, simulation.reset, lambda: simulation.positions):
        with pytest.raises(pogosim.SimulationError, match="the simulation is closed: make another one"):
            use()


def test_second_thread_in_one_simulation_is_an_error(hosted: Path, scene: Path) -> None:
    with pogosim.Simulation(hosted, scene, set={"simulation_time": 1e6, "save_data_period": -1}) as simulation:
        stop = threading.Event()

        def step_on() -> None:
            while not stop.is_set():
                simulation.step(2000)

        thread = threading.Thread(target=step_on)
        thread.start()
        try:
            with pytest.raises(pogosim.SimulationError, match="in use by another thread"):
                for _ in range(100000):
                    simulation.step()
        finally:
            stop.set()
            thread.join()


def test_ctrl_c_interrupts_python_and_leaves_the_run_usable(hosted: Path, scene: Path) -> None:
    code = (
        "import os, signal, threading, pogosim\n"
        "settings = {'simulation_time': 1e7, 'save_data_period': -1}\n"
        f"s = pogosim.Simulation({str(hosted)!r}, {str(scene)!r}, set=settings)\n"
        "threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "try:\n    s.run()\nexcept KeyboardInterrupt:\n    t = s.time\n    s.step(5)\n    print('ok', s.time > t > 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout) == (0, "ok True\n"), done.stderr


def test_handlers_installed_between_steps_hold_and_crashes_of_robots_stay_errors(hosted: Path, scene: Path) -> None:
    code = (
        "import faulthandler, os, signal, time, pogosim\n"
        "settings = {'parameters.fail_at_tick': 60, 'parameters.failure': 'crash'}\n"
        f"s = pogosim.Simulation({str(hosted)!r}, {str(scene)!r}, set=settings)\n"
        "s.step()\n"
        "faulthandler.enable()\n"
        "signal.signal(signal.SIGALRM, lambda *_: print('alarm', flush=True))\n"
        "time.sleep(0.01)\n"
        "s.step()\n"
        "signal.raise_signal(signal.SIGALRM)\n"
        "try:\n    s.run()\nexcept pogosim.ProgramFailedError:\n    print('failed', flush=True)\n"
        "child = os.fork()\n"
        "if child == 0:\n    signal.raise_signal(signal.SIGFPE)\n"
        "print(os.WTERMSIG(os.waitpid(child, 0)[1]) == signal.SIGFPE, flush=True)\n"
        "signal.raise_signal(signal.SIGSEGV)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout) == (-signal.SIGSEGV, "alarm\nfailed\nTrue\n"), done.stderr
    assert done.stderr.count("Fatal Python error: Segmentation fault") == 1


ALARMS = """
import os, signal, sys, threading, time, pogosim
settings = {'simulation_time': 1e7, 'save_data_period': -1}
sim = pogosim.Simulation(sys.argv[1], sys.argv[2], set=settings)

class Alarm(Exception):
    pass

def ring(*_):
    raise Alarm

signal.signal(signal.SIGALRM, ring)
"""


@pytest.mark.parametrize("steps", [1, 2000])
def test_alarm_of_the_host_rings_while_steps_are_made(hosted: Path, scene: Path, steps: int) -> None:
    code = (
        f"{ALARMS}rung = 0\n"
        "for turn in range(300):\n"
        "    try:\n"
        "        end_s = time.monotonic() + 30\n"
        "        signal.setitimer(signal.ITIMER_REAL, 0.003 + turn * 1e-5)\n"
        f"        while time.monotonic() < end_s: sim.step({steps})\n"
        "    except Alarm:\n"
        "        rung += 1\n"
        "print(rung)\n"
    )
    command = [sys.executable, "-c", code, str(hosted), str(scene)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert (done.returncode, done.stdout) == (0, "300\n"), done.stderr


def test_alarm_of_the_host_interrupts_what_waits_after_a_step(hosted: Path, scene: Path) -> None:
    code = (
        f"{ALARMS}into, out = os.pipe()\n"
        "sim.step(1)\n"
        "signal.setitimer(signal.ITIMER_REAL, 0.2)\n"
        "threading.Timer(20, os.write, (out, b'x')).start()\n"
        "try:\n    os.read(into, 1)\nexcept Alarm:\n    print('interrupted', flush=True)\n"
        "os._exit(0)\n"
    )
    command = [sys.executable, "-c", code, str(hosted), str(scene)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout) == (0, "interrupted\n"), done.stderr


def test_alarm_without_a_handler_ends_the_process_as_elsewhere(hosted: Path, scene: Path) -> None:
    code = (
        f"{ALARMS}signal.signal(signal.SIGALRM, signal.SIG_DFL)\nsignal.setitimer(signal.ITIMER_REAL, 0.2)\nsim.run()\n"
    )
    command = [sys.executable, "-c", code, str(hosted), str(scene)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout) == (-signal.SIGALRM, "")


def test_many_runs_one_after_the_other_leave_nothing_behind(hosted: Path, scene: Path) -> None:
    def open_files() -> int:
        return len(list(Path("/proc/self/fd").iterdir()))

    def mapped() -> int:
        return Path("/proc/self/maps").read_text().count("memfd:hosted.so")

    for _ in range(3):
        pogosim.Simulation(hosted, scene).close()
    gc.collect()
    files, programs = open_files(), mapped()
    for seed in range(30):
        with pogosim.Simulation(hosted, scene, seed=seed) as simulation:
            simulation.step(5)
    gc.collect()
    assert (open_files(), mapped()) == (files, programs)


@pytest.mark.parametrize("use", ["close", "reset", "end"])
def test_simulation_in_use_cannot_be_ended_by_another_thread(hosted: Path, scene: Path, use: str) -> None:
    settings = {"simulation_time": 1e6, "save_data_period": -1}
    with pogosim.Simulation(hosted, scene, set=settings) as simulation:
        begun = threading.Event()

        def go() -> None:
            begun.set()
            simulation.step(20000)

        thread = threading.Thread(target=go)
        thread.start()
        begun.wait()
        refused = 0
        while thread.is_alive() and refused < 100:
            try:
                getattr(simulation, use)()
                break  # before the thread had it, or after
            except pogosim.SimulationError as error:
                assert "in use by another thread" in str(error)
                refused += 1
        thread.join()
        if refused == 100:
            assert simulation.steps == 20000


def test_each_inside_of_each_is_refused_instead_of_waiting_for_ever(hosted: Path, scene: Path) -> None:
    with (
        pogosim.VectorSimulation(hosted, scene, seeds=range(2), threads=1) as runs,
        pogosim.VectorSimulation(hosted, scene, seeds=range(2), threads=2) as others,
    ):
        inner: list[Callable[[pogosim.Simulation], Any]] = [
            lambda _: runs.step(1),
            lambda _: runs.reset(),
            lambda _: runs.close(),
            lambda _: runs.each(lambda sim: sim.time),
            lambda _: others.each(lambda _: runs.step(1)),
        ]
        for function in inner:
            with pytest.raises(pogosim.SimulationError, match=r"run 0: .*cannot be called by a function") as caught:
                runs.each(function)
            assert "\n" not in str(caught.value)
        assert runs.each(lambda _: len(others.step(1))) == [2, 2]
        assert runs.step(1) == [1, 1]


def test_failure_of_one_of_many_comes_when_all_are_ready(hosted: Path, scene: Path) -> None:
    runs = pogosim.VectorSimulation(hosted, scene, seeds=range(4), threads=3, set={"simulation_time": 30})
    with runs:
        runs[0].parameters["fail_at_tick"] = 3
        with pytest.raises(pogosim.ProgramFailedError):
            runs.step(2000)
        assert [run.steps for run in runs][1:] == [2000] * 3
        with pytest.raises(pogosim.SimulationError, match="seeds: expected 4, one for each run, found 1"):
            runs.reset([1])
        with pytest.raises(pogosim.SimulationError, match="seed: expected an integer from 0"):
            runs.reset([1, 2, 3, 2**32])
        assert [run.steps for run in runs][1:] == [2000] * 3
    with pytest.raises(pogosim.SimulationError, match="closed"):
        runs.step()


def test_ctrl_c_while_many_step_stops_all_of_them() -> None:
    code = (
        "import os, signal, threading, pogosim\n"
        f"with pogosim.VectorSimulation({str(HANABI)!r}, {str(SIMPLE)!r}, seeds=range(4), threads=3,"
        " set={'simulation_time': 1e6, 'save_data_period': -1}) as runs:\n"
        "    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "    try:\n"
        "        runs.step(10**8)\n"
        "    except KeyboardInterrupt:\n"
        "        print('interrupted', runs.step(2))\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stdout) == (0, "interrupted [2, 2, 2, 2]\n"), ended.stderr


@pytest.mark.parametrize("steps", [2**31, 2**63, 2**64 + 3])
def test_more_steps_than_there_are_go_to_the_end(sim: pogosim.Simulation, steps: int) -> None:
    assert sim.step(steps) == sim.step_count
    assert sim.is_over


@pytest.mark.parametrize(("until_s", "steps"), [(1e17, 200), (math.inf, 200), (-math.inf, 0), (-1.0, 0), (0.5, 50)])
def test_run_goes_as_far_as_the_run_has_time(sim: pogosim.Simulation, until_s: float, steps: int) -> None:
    assert sim.run(until_s) == steps


def test_numbers_that_are_none_are_refused(sim: pogosim.Simulation) -> None:
    with pytest.raises(pogosim.ConfigurationError, match="until_s"):
        sim.run(math.nan)
    with pytest.raises(pogosim.ConfigurationError, match=r"steps: expected an integer of at least 0, found 1\.5"):
        sim.step(1.5)  # type: ignore[arg-type]
    with pytest.raises(pogosim.ConfigurationError, match="heading: expected a finite number, found nan"):
        sim.set_pose(0, 500, 500, math.nan)
    with pytest.raises(pogosim.ConfigurationError, match="expected finite numbers"):
        sim.set_pose(0, 1e12, 500)


@pytest.mark.parametrize("seed", [-1, 2**32, 2**64])
def test_seed_out_of_range_is_refused_and_the_run_goes_on(hosted: Path, scene: Path, seed: int) -> None:
    with pytest.raises(pogosim.ConfigurationError, match="seed: expected an integer from 0 to 4294967295"):
        pogosim.Simulation(hosted, scene, seed=seed)
    with pogosim.Simulation(hosted, scene, seed=5) as simulation:
        simulation.step(3)
        with pytest.raises(pogosim.ConfigurationError, match="seed: expected"):
            simulation.reset(seed)
        assert simulation.step(2) == 2


def test_simulations_are_not_copied(sim: pogosim.Simulation) -> None:
    with pytest.raises(TypeError, match="cannot be copied or pickled"):
        copy.copy(sim)


@pytest.mark.parametrize("key", ["data_filename", "message_log"])
def test_program_is_not_overwritten(hosted: Path, scene: Path, tmp_path: Path, key: str) -> None:
    own = tmp_path / "own.so"
    own.write_bytes(hosted.read_bytes())
    with pytest.raises(pogosim.ConfigurationError, match="the run would overwrite its program"):
        pogosim.Simulation(own, scene, set={key: str(own)})
    assert own.read_bytes() == hosted.read_bytes()


def test_parameter_that_the_next_run_refuses_can_be_mended(sim: pogosim.Simulation) -> None:
    sim._settings["parameters.gain"] = "much"
    with pytest.raises(pogosim.ConfigurationError, match="expected a number"):
        sim.reset()
    with pytest.raises(pogosim.SimulationError, match="the last reset failed"):
        sim.step()
    sim.parameters["gain"] = 3.0
    sim.reset()
    sim.step(10)
    assert sim.user_data["gain"].tolist() == [3.0] * 3


def test_error_says_which_of_many_runs_has_failed(hosted: Path, scene: Path) -> None:
    with pogosim.VectorSimulation(hosted, scene, seeds=range(3), set={"simulation_time": 30}) as runs:
        runs[2].parameters["fail_at_tick"] = 3
        with pytest.raises(pogosim.ProgramFailedError, match=r"^run 2: .*robot #1"):
            runs.step(100)
        runs[2].reset()
        assert runs.step(1)[2] == 1
