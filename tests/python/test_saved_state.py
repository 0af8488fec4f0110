"""A run goes on from a copy of its state as it went on then: `Simulation.save` and `Simulation.restore`."""

from __future__ import annotations

import copy
import pickle
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from firmwares import firmware_of, text
from pogosim.simulation import ConfigurationError, SavedState, Simulation, SimulationError
from running import ROOT, SHARED, compile_text, write_scene

NO_FILES = {"enable_data_logging": False}
# For examples that have none of their own name.
SIMPLE = ROOT / "conf" / "simple.yaml"
CONFIGURATIONS = {"lighthouse_localization": "lighthouse", "walls": "walls_and_membranes"}
PROGRAMS = sorted(path.stem for path in (ROOT / "examples").glob("*/*.so"))

State = list[Any]


@pytest.fixture(autouse=True)
def _folders_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


def state_of(simulation: Simulation) -> State:
    """All that can be seen of a run."""
    arrays = (
        *(simulation.positions, simulation.headings, simulation.velocities, simulation.angular_velocities),
        *(simulation.leds, simulation.ticks, simulation.messages_sent, simulation.messages_received),
        *(simulation.light_map, simulation.light_levels, simulation.alive),
    )
    try:
        user_data = repr(simulation.user_data.tolist())  # not the bytes between its members
    except SimulationError:  # there is none
        user_data = ""
    lamps = [(lamp.is_on, lamp.intensity, lamp.position) for lamp in simulation.lamps]
    return [
        *(simulation.time, simulation.state_hash, dict(simulation.parameters), lamps, user_data),
        *(np.ascontiguousarray(array).tobytes() for array in arrays),
    ]


def course(simulation: Simulation, steps: int = 60) -> list[State]:
    """What is seen after each tenth of these steps."""
    return [state_of(simulation) for _ in range(10) if simulation.step(steps // 10) > 0]


def scene_of(folder: Path, settings: Mapping[str, object] | None = None) -> Path:
    """A configuration without files."""
    return write_scene(folder, {"arena_file": str(ROOT / "arenas" / "disk.csv"), **NO_FILES, **(settings or {})})


def program_of(folder: Path, step: str, init: str = "", globals_: str = "") -> Path:
    return compile_text(folder, text(textwrap.dedent(step), init, globals_), flags=SHARED)


def expect_same_course(simulation: Simulation, before: int = 50, steps: int = 60) -> None:
    """After `before` steps, what follows is what follows in a run that is not saved, as often as wanted."""
    simulation.step(before)
    saved = simulation.save()
    first = course(simulation, steps)
    for _ in range(2):
        simulation.restore(saved)
        assert course(simulation, steps) == first
    simulation.reset()
    simulation.step(before)
    assert course(simulation, steps) == first


@pytest.mark.parametrize("name", PROGRAMS)
def test_examples_go_on_as_they_did(name: str) -> None:
    own = ROOT / "conf" / f"{CONFIGURATIONS.get(name, name)}.yaml"
    settings = {**NO_FILES, "save_video_period": -1, "seed": 7, "physics_engine": "auto"}
    if name == "question":
        settings["parameters.question"] = ""
    program = ROOT / "examples" / name / f"{name}.so"
    with Simulation(program, own if own.exists() else SIMPLE, set=settings) as simulation:
        expect_same_course(simulation)


def test_robots_that_wait_in_the_middle_go_on_there(tmp_path: Path) -> None:
    """Each on a stack of its own, which has changed in the meantime."""
    step = """
    int places[200];
    for (int i = 0; i < 200; i++) { places[i] = rand(); }
    msleep(1 + rand() % 400);
    for (int i = 0; i < 200; i++) { mydata->count += (uint32_t)places[i]; }
    pogobot_led_setColor((uint8_t)(mydata->count % 25), 0, 0);
    pogobot_motor_set(motorL, rand() % 2 == 0 ? motorFull : motorHalf);
    pogobot_motor_set(motorR, motorHalf);"""
    program = program_of(tmp_path, step, "srand((unsigned)pogobot_helper_getRandSeed());")
    with Simulation(program, scene_of(tmp_path, {"objects.robots.nb": 30, "simulation_time": 100})) as simulation:
        expect_same_course(simulation, 130, 300)


def test_programs_of_the_sdk_go_on_in_their_loops(tmp_path: Path) -> None:
    source = """#include "pogobot.h"
    static int turns = 0;
    int main(void) {
        pogobot_init();
        for (int i = 0;; i++) {
            turns += i;
            pogobot_led_setColor((uint8_t)(turns % 25), (uint8_t)(i % 25), 0);
            pogobot_motor_set(motorL, i % 3 == 0 ? motorFull : motorHalf);
            msleep(30 + pogobot_helper_getid() % 7);
        }
    }"""
    program = compile_text(tmp_path, source, flags=SHARED, package="pogosim-sdk")
    with Simulation(program, scene_of(tmp_path)) as simulation:
        simulation.step(50)
        saved = simulation.save()
        first = [
            array.copy() for _ in range(5) if simulation.step(10) for array in (simulation.leds, simulation.positions)
        ]
        simulation.restore(saved)
        again = [
            array.copy() for _ in range(5) if simulation.step(10) for array in (simulation.leds, simulation.positions)
        ]
        for one, other in zip(first, again, strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("memory", ["own", "shared"])
@pytest.mark.parametrize("threads", [1, 2])
def test_variables_of_the_program_are_those_of_then(memory: str, threads: int, tmp_path: Path) -> None:
    globals_ = """
    static uint32_t calls = 5;
    static char table[3000];
    POGO_SHARED static uint32_t of_all = 0;"""
    step = """
    static uint32_t local = 1;
    calls += 1 + pogobot_helper_getid(); local *= 3; of_all++;
    table[(calls * 7) % sizeof(table)]++;
    mydata->count = calls + local + of_all + (uint32_t)table[(calls * 3) % sizeof(table)];"""
    program = program_of(tmp_path, step, "", globals_)
    scene = scene_of(tmp_path, {"objects.robots.nb": 20, "robot_memory": memory, "threads": threads})
    with Simulation(program, scene) as simulation:
        expect_same_course(simulation)


def test_contacts_go_on_to_the_bit(tmp_path: Path) -> None:
    """In a crowd that pushes, with periodic borders: contacts keep what they have pushed with."""
    step = """
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, rand() % 3 == 0 ? motorHalf : motorFull);"""
    settings = {
        "arena_file": str(ROOT / "arenas" / "square.csv"),
        "objects.robots.nb": 200,
        "arena_surface": 6.5e5,
        "boundary_condition": "periodic",
    }
    with Simulation(program_of(tmp_path, step), scene_of(tmp_path, settings)) as simulation:
        expect_same_course(simulation, 100, 90)


def test_all_kinds_of_brains_go_on(tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path / "robot", text("mydata->level += 3; pogobot_motor_set(motorL, rand() % 1024);"))
    robot = {"type": "pogobot", "nb": 4, "geometry": "disk", "radius": 26.5}
    script = [{"time_s": 0.1 * i, "motors": [50 * i, 500, 0], "message": f"m{i}"} for i in range(20)]
    objects = {
        "robots": robot,
        "emulated": robot | {"brain": str(firmware)},
        "scripted": robot | {"brain": {"script": script}},
        "hosted": robot | {"brain": "host"},
    }
    program = program_of(tmp_path, "mydata->count += (uint32_t)rand();")
    with Simulation(program, scene_of(tmp_path, {"objects": objects})) as simulation:
        motors = simulation.brain("hosted").motors

        def go_on() -> list[State]:
            seen = []
            for turn in range(10):
                motors[:] = 100 * turn
                simulation.step(7)
                seen.append(
                    [
                        *state_of(simulation),
                        simulation.firmware_variable("mydata", "emulated", firmware=firmware)["level"].tolist(),
                    ]
                )
            return seen

        simulation.step(33)
        motors[:] = [1, 2, 3]
        saved = simulation.save()
        first = go_on()
        simulation.restore(saved)
        assert motors.tolist() == [[1, 2, 3]] * 4
        assert go_on() == first


@pytest.mark.parametrize("brain", ["firmware", "host", "script"])
def test_runs_without_a_program_go_on(brain: str, tmp_path: Path) -> None:
    firmware = firmware_of(tmp_path / "robot", text("mydata->level += 3; pogobot_motor_set(motorL, rand() % 1024);"))
    script = [{"time_s": 0.1 * i, "motors": [50 * i, 500, 0]} for i in range(20)]
    of_robots = {"firmware": str(firmware), "host": "host", "script": {"script": script}}[brain]
    scene = scene_of(tmp_path, {"objects.robots.nb": 5, "objects.robots.brain": of_robots})
    with Simulation(firmware if brain == "firmware" else None, scene) as simulation:
        if brain == "host":
            simulation.brain("robots").motors[:] = [500, 800, 0]
        simulation.step(30)
        saved = simulation.save()
        first = course(simulation)
        simulation.restore(saved)
        assert course(simulation) == first


def test_what_a_host_has_changed_is_undone(tmp_path: Path) -> None:
    globals_ = "static float gain = 1.0f;"
    source = text("mydata->share = gain;", "", globals_).replace(
        "pogobot_start", 'init_float_from_configuration(&gain, "gain", 1.0f); pogobot_start'
    )
    source = source.replace("int main", "static void setup(void) { init_from_configuration(gain); }\nint main")
    source = source.replace(
        'init_float_from_configuration(&gain, "gain", 1.0f); ', "SET_CALLBACK(callback_global_setup, setup); "
    )
    program = compile_text(tmp_path, source, flags=SHARED)
    lamp = {"type": "static_light", "geometry": "disk", "radius": 100, "x": 500, "y": 500, "value": 500}
    settings = {"parameters": {"gain": 2.0}, "objects.lamp": lamp}
    with Simulation(program, scene_of(tmp_path, settings), set={"parameters.gain": 2.0}) as simulation:
        simulation.step(20)
        positions = simulation.positions
        saved = simulation.save()
        before, course_before = state_of(simulation), course(simulation)
        simulation.restore(saved)
        simulation.parameters["gain"] = 5.0
        simulation.set_pose(0, 300.0, 300.0)
        simulation.objects[1].kill()
        simulation.lamps[0].is_on = False
        simulation.step(10)
        assert simulation.user_data["share"].max() == 5.0
        simulation.restore(saved)
        assert state_of(simulation) == before
        assert np.shares_memory(simulation.positions, positions)
        assert course(simulation) == course_before
        simulation.restore(saved)
        simulation.reset()
        assert simulation.parameters["gain"] == 2.0


def test_many_states_of_one_run(tmp_path: Path) -> None:
    """A tree of futures: each branch with other random numbers of the host."""
    program = program_of(tmp_path, "pogobot_motor_set(motorL, rand() % 1024);")
    with Simulation(program, scene_of(tmp_path)) as simulation:
        states = []
        for _ in range(10):
            states.append((simulation.save(), state_of(simulation)))
            simulation.step(10)
        for saved, seen in reversed(states):
            simulation.restore(saved)
            assert state_of(simulation) == seen


def test_run_that_is_over_goes_on_again(tmp_path: Path) -> None:
    with Simulation(program_of(tmp_path, ""), scene_of(tmp_path, {"simulation_time": 1.0})) as simulation:
        saved = simulation.save()
        assert simulation.run() == 100
        assert simulation.is_over
        simulation.restore(saved)
        assert not simulation.is_over
        assert simulation.run() == 100


def test_run_that_its_program_has_ended_is_over_again(tmp_path: Path) -> None:
    program = program_of(tmp_path, "if (current_time_milliseconds() >= 300) { stop_simulation(); }")
    with Simulation(program, scene_of(tmp_path)) as simulation:
        before = simulation.save()
        steps = simulation.run()
        assert simulation.is_over
        over = simulation.save()
        for _ in range(2):
            simulation.restore(before)
            assert not simulation.is_over
            assert simulation.run() == steps
            simulation.restore(before)
            simulation.restore(over)
            assert simulation.is_over
            assert simulation.step(5) == 0


# ---- What is refused


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"enable_data_logging": True}, r"it writes a data file \(enable_data_logging: false\)"),
        ({"message_log": "messages.feather"}, r"it writes a log of messages \(message_log\)"),
        ({"save_video_period": 1.0, "frames_name": "f{:.3f}.png"}, r"it saves pictures \(save_video_period: -1\)"),
        ({"physics_engine": "box2d"}, r"its physics engine \(box2d\) cannot be copied"),
    ],
)
def test_runs_that_cannot_be_saved_say_why(
    settings: dict[str, object], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with Simulation(program_of(tmp_path, ""), scene_of(tmp_path), set=settings) as simulation:
        with pytest.raises(ConfigurationError, match=f"the state of this run cannot be saved: {said}"):
            simulation.save()
        assert simulation.step(5) == 5


@pytest.mark.parametrize(
    ("step", "said"),
    [
        (
            "kept = malloc(10); free(kept);",
            r"the program allocates memory \('malloc'\), which is not copied: use arrays",
        ),
        ('char t[] = "a b"; strtok(t, " ");', r"the program uses 'strtok', which may have a state of its own"),
    ],
)
def test_programs_whose_state_is_elsewhere_are_refused(step: str, said: str, tmp_path: Path) -> None:
    program = program_of(tmp_path, f"char* volatile kept; (void)kept; {step}")
    with Simulation(program, scene_of(tmp_path)) as simulation, pytest.raises(ConfigurationError, match=said):
        simulation.save()


@pytest.mark.parametrize(
    ("globals_", "step", "said"),
    [
        (
            'static std::string words = "more than fifteen letters";',
            "words += 'x';",
            "which may have a state of its own",
        ),
        ("static std::vector<int> numbers;", "numbers.push_back(1);", "the program (allocates memory|uses)"),
        ("", "try { throw 5; } catch (int i) { msleep(300); mydata->n = i; }", "which may have a state of its own"),
        ("static thread_local int count;", "mydata->n = ++count;", r"each thread has its own 'count' \(thread_local\)"),
    ],
)
@pytest.mark.parametrize("flags", [(), ("-ftls-model=initial-exec",)])
def test_programs_in_cpp_whose_state_is_elsewhere_are_refused(
    globals_: str, step: str, said: str, flags: tuple[str, ...], tmp_path: Path
) -> None:
    source = f"""#include <string>
    #include <vector>
    #include "pogobase.h"
    struct USERDATA {{ int n; }};
    DECLARE_USERDATA(USERDATA)
    REGISTER_USERDATA(USERDATA)
    {globals_}
    static void user_step() {{ {step} }}
    int main() {{ pogobot_init(); pogobot_start(nullptr, user_step); return 0; }}"""
    program = compile_text(tmp_path, source, "main.cpp", flags=(*SHARED, *flags))
    with Simulation(program, scene_of(tmp_path)) as simulation:
        simulation.step(20)
        with pytest.raises(ConfigurationError, match=said):
            simulation.save()


@pytest.mark.parametrize(
    ("flags", "said"), [((), r"its own 't' \(thread_local\)"), (("-Wl,-x",), "whose symbols were stripped")]
)
def test_variables_of_threads_are_refused_by_any_name(flags: tuple[str, ...], said: str, tmp_path: Path) -> None:
    source = text("mydata->count += (uint32_t)++t;", "", "static __thread int t;")
    program = compile_text(tmp_path, source, flags=(*SHARED, *flags))
    with Simulation(program, scene_of(tmp_path)) as simulation, pytest.raises(ConfigurationError, match=said):
        simulation.save()


def test_robot_that_waits_in_a_comparison_is_not_saved(tmp_path: Path) -> None:
    """qsort() of the C library sorts in memory that it has allocated."""
    globals_ = """static int order(void const* a, void const* b) {
        msleep(1);
        return *(int const*)a - *(int const*)b;
    }"""
    step = "int values[400] = {3, 1}; qsort(values, 400, sizeof(int), order);"
    with Simulation(program_of(tmp_path, step, "", globals_), scene_of(tmp_path)) as simulation:
        simulation.step(20)
        with pytest.raises(ConfigurationError, match="a robot waits in the middle of a program that uses 'qsort'"):
            simulation.save()


def test_programs_that_sort_go_on(tmp_path: Path) -> None:
    globals_ = "static int order(void const* a, void const* b) { return *(int const*)a - *(int const*)b; }"
    step = "int v[3] = {rand() % 9, rand() % 9, 4}; qsort(v, 3, sizeof(int), order); mydata->count += (uint32_t)v[1];"
    with Simulation(program_of(tmp_path, step, "", globals_), scene_of(tmp_path)) as simulation:
        expect_same_course(simulation)


def test_parameters_set_the_variables_that_they_set_then(tmp_path: Path) -> None:
    """A program may ask for its parameter late: until then, there is no variable to set."""
    step = 'if (pogobot_ticks == 20) { init_uint32_from_configuration(&late, "late", 1); } mydata->count = late;'
    program = program_of(tmp_path, step, "", "static uint32_t late;")
    with Simulation(program, scene_of(tmp_path), set={"parameters.late": 5}) as simulation:
        simulation.step(10)
        state = simulation.save()
        before = course(simulation)
        simulation.parameters["late"] = 7
        simulation.restore(state)
        with pytest.raises(ConfigurationError, match="late"):
            simulation.parameters["late"] = 7
        assert course(simulation) == before


def test_texts_of_scanf_that_are_kept_are_refused(tmp_path: Path) -> None:
    globals_ = "#include <stdio.h>\nstatic char* word;"
    for step, is_saved in (('sscanf("a b", "%*s %8ms", &word);', False), ('sscanf("7", "%u", &mydata->count);', True)):
        program = program_of(tmp_path, step, "", globals_)
        with Simulation(program, scene_of(tmp_path)) as simulation:
            if is_saved:
                expect_same_course(simulation)
                continue
            with pytest.raises(ConfigurationError, match=r"may allocate memory \('.*sscanf' with '%8ms'\)"):
                simulation.save()


def test_texts_of_scanf_are_refused(tmp_path: Path) -> None:
    step = 'char* word = NULL; if (sscanf("a b", "%ms", &word) == 1) { free(word); }'
    program = program_of(tmp_path, step, "", "#include <stdio.h>")
    with (
        Simulation(program, scene_of(tmp_path)) as simulation,
        pytest.raises(ConfigurationError, match=r"may allocate memory \('.*sscanf' with 'free'\)"),
    ):
        simulation.save()


def test_objects_of_cpp_without_a_heap_go_on(tmp_path: Path) -> None:
    source = """#include "pogobase.h"
    struct USERDATA { int n; };
    DECLARE_USERDATA(USERDATA)
    REGISTER_USERDATA(USERDATA)
    struct Base { virtual ~Base() {} virtual int next() = 0; };
    struct Counter : Base { int n = 3; int next() override { return n += 7; } };
    static Counter counter;
    static int first() { static Counter own; return own.next(); }
    static void user_step() { Base& base = counter; mydata->n = base.next() + first(); }
    int main() { pogobot_init(); pogobot_start(nullptr, user_step); return 0; }"""
    program = compile_text(tmp_path, source, "main.cpp", flags=SHARED)
    with Simulation(program, scene_of(tmp_path)) as simulation:
        expect_same_course(simulation)


def test_state_of_another_run_is_refused(tmp_path: Path) -> None:
    program = program_of(tmp_path, "")
    scene = scene_of(tmp_path)
    with Simulation(program, scene) as simulation, Simulation(program, scene) as other:
        saved = simulation.save()
        with pytest.raises(ConfigurationError, match="the state is that of another run"):
            other.restore(saved)
        simulation.reset()
        with pytest.raises(ConfigurationError, match="the state is that of another run, or of this simulation before"):
            simulation.restore(saved)
        simulation.end()
        with pytest.raises(ConfigurationError, match="the run has ended: reset it"):
            simulation.save()


def test_what_is_no_state_is_refused(tmp_path: Path) -> None:
    with Simulation(program_of(tmp_path, ""), scene_of(tmp_path)) as simulation:
        saved = simulation.save()
        for wrong in (None, 3, b"state", simulation):
            with pytest.raises(ConfigurationError, match=r"state: expected what save\(\) has returned"):
                simulation.restore(wrong)  # type: ignore[arg-type]
        for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError, match="in memory of this process"):
                duplicate(saved)


def test_states_may_outlive_their_run(tmp_path: Path) -> None:
    simulation = Simulation(program_of(tmp_path, ""), scene_of(tmp_path))
    saved = simulation.save()
    simulation.close()
    with pytest.raises(SimulationError, match="closed"):
        simulation.restore(saved)
    assert isinstance(saved, SavedState)
    del simulation
    del saved


def test_failed_run_stays_failed(tmp_path: Path) -> None:
    program = program_of(tmp_path, "if (pogobot_ticks == 20) { *(volatile int*)8 = 1; }")
    with Simulation(program, scene_of(tmp_path)) as simulation:
        saved = simulation.save()
        with pytest.raises(pogosim.ProgramFailedError):
            simulation.run()
        with pytest.raises(ConfigurationError, match="the run has failed: reset it"):
            simulation.restore(saved)


def test_links_that_a_host_cuts_after_a_restore_have_not_broken(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Whatever another branch has cut before."""
    caplog.set_level("INFO", logger="pogosim")
    poses = [[300, 300, 0], [400, 300, 0], [300, 600, 0], [400, 600, 0], [300, 800, 0], [400, 800, 0]]
    robots = {"type": "pogobot", "brain": "host", "poses": poses}
    settings: dict[str, Any] = {**NO_FILES, "objects": {"robots": robots}}
    with Simulation(None, write_scene(tmp_path, settings), seed=1) as simulation:
        simulation.link(0, 1, kind="rod")
        simulation.link(2, 3, kind="rod")
        simulation.link(4, 5, kind="rod", breaking_force=1e-3)
        simulation.step(1)
        saved = simulation.save()
        simulation.cut(0)
        simulation.step(1)
        simulation.restore(saved)
        simulation.cut(1)
        simulation.brain("robots").motors[4, :2] = -1023
        simulation.brain("robots").motors[5, :2] = 1023
        simulation.step(30)
        assert simulation.links["is_cut"].tolist() == [False, True, True]
    broken = [record.getMessage() for record in caplog.records if "has broken" in record.getMessage()]
    assert len(broken) == 1
    assert "object 4 of 'robots' to object 5" in broken[0]


def test_many_runs_go_back_together_or_some_of_them() -> None:
    program, settings = ROOT / "examples" / "hanabi" / "hanabi.so", {**NO_FILES, "objects.robots.nb": 5}
    with pogosim.VectorSimulation(program, SIMPLE, seeds=range(3), set=settings) as runs:
        runs.step(50)
        states = runs.save()
        runs.step(40)
        after = [simulation.state_hash for simulation in runs]
        runs.restore(states)
        assert [simulation.steps for simulation in runs] == [50, 50, 50]
        runs.step(40)
        assert [simulation.state_hash for simulation in runs] == after
        runs.restore([states[2]], which=2)
        assert [simulation.steps for simulation in runs] == [90, 90, 50]
        (only,) = runs.save(which=[False, True, False])
        runs.restore([only, states[0]], which=[1, 0])
        assert [simulation.steps for simulation in runs] == [50, 90, 50]
        for wrong, which, told in (
            (states[:2], None, "states: expected 3, one for each run, found 2"),
            (None, None, "states: expected 3, one for each run, found None"),
            ([states[0], states[0]], [0, 0], "each run can be named once only"),
            ([states[0]], 7, "there is no run 7"),
            ([states[0]], 1, "another run"),
            ([5], 1, "run 1: state: expected what save"),
        ):
            with pytest.raises(ConfigurationError, match=told):
                runs.restore(wrong, which=which)  # type: ignore[arg-type]
