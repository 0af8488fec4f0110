"""A run goes on in another process, from a file: `--save-state`, `--at` and `--from-state`."""

from __future__ import annotations

import random
import re
import shutil
import signal
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pytest
import yaml
from firmwares import OF_ROBOTS, firmware_of, text, without_program
from pogosim.recover import read_unfinished
from pogosim.utils import load_dataframe
from running import ROOT, Run, Settings, compile_text, example, run, run_command, start, wait_for_rows, write_scene

CONFIGURATIONS = {"lighthouse_localization": "lighthouse", "walls": "walls_and_membranes"}
EXAMPLES = sorted(path.name for path in (ROOT / "examples").iterdir() if (path / path.name).exists())
OF_SDK = {"heartbeat_sdk", "question"}

HASH = re.compile(r"state after step (\d+): ([0-9a-f]{16})")

WANDER = """
    mydata->count += (uint32_t)rand() % 100;
    if (mydata->count % 7 == 0) { pogobot_led_setColor((uint8_t)(mydata->count % 25), 0, 3); }
    if (mydata->count % 11 == 0) { pogobot_infrared_sendShortMessage_omni((uint8_t *)&mydata->count, 4); }
    pogobot_motor_set(motorL, (uint16_t)(rand() % 1024));
    pogobot_motor_set(motorR, motorHalf);"""


def program_of(folder: Path, step: str = WANDER, init: str = "", globals_: str = "") -> Path:
    """Compile a program whose robots do this in each step."""
    folder.mkdir(parents=True, exist_ok=True)
    return compile_text(folder, text(textwrap.dedent(step), init, globals_))


def hashes(result: Run) -> dict[int, str]:
    """Hash of the run after each step that has one."""
    return {int(step): value for step, value in HASH.findall(result.output)}


def rows_after(frame: pd.DataFrame, time_s: float) -> pd.DataFrame:
    return frame[frame.time > time_s + 1e-9].reset_index(drop=True)


def expect_same_course(
    program: Path, folder: Path, settings: Settings, time_s: float, arguments: Sequence[str] = ()
) -> None:
    """A run of which the state was saved goes on as it did, and as one that ended there."""
    hashed = ["--hash", "1", *arguments]
    whole = run(program, folder / "whole", settings, [*hashed, "--save-state", "at.state", "--at", str(time_s)])
    assert whole.code == 0, whole.text
    ended = {**settings, "simulation_time": time_s}
    first = run(program, folder / "first", ended, [*hashed, "--save-state", "end.state"])
    assert first.code == 0, first.text
    for number, state in enumerate([folder / "whole" / "at.state", folder / "first" / "end.state"]):
        for threads in (1, 3):
            place = folder / f"on-{number}-{threads}"
            rest = run(program, place, {**settings, "threads": threads}, [*hashed, "--from-state", str(state)])
            assert rest.code == 0, rest.text
            last = hashes(first)
            expected = {step: value for step, value in hashes(whole).items() if step not in last}
            assert expected
            assert hashes(rest) == expected
            after = rows_after(whole.frame(), time_s)
            assert len(after) > 0
            pd.testing.assert_frame_equal(rest.frame(), after)
            joined = pd.concat([first.frame(), rest.frame()], ignore_index=True)
            pd.testing.assert_frame_equal(joined, whole.frame())


@pytest.mark.parametrize("name", [name for name in EXAMPLES if name not in OF_SDK])
def test_examples_go_on_in_another_process(name: str, tmp_path: Path) -> None:
    time_s = random.Random(name).randrange(20, 480) / 100
    own = ROOT / "conf" / f"{CONFIGURATIONS.get(name, name)}.yaml"
    settings = yaml.safe_load((own if own.exists() else ROOT / "conf" / "simple.yaml").read_text())
    settings |= {
        "simulation_time": 5.0,
        "seed": 7,
        "GUI": False,
        "save_video_period": -1,
        "save_data_period": 0.1,
        "data_filename": "data.feather",
        "enable_data_logging": True,
        "physics_engine": "auto",
    }
    for key in ("data_logger_fields", "enable_console_logging", "console_filename", "threads"):
        settings.pop(key, None)
    runs = {}
    for folder, seconds in (("whole", 5.0), ("first", time_s), ("rest", 5.0)):
        place = tmp_path / folder
        place.mkdir()
        (place / "conf.yaml").write_text(yaml.safe_dump({**settings, "simulation_time": seconds}, sort_keys=False))
        for file in (ROOT / "conf").glob("*.csv"):
            shutil.copy(file, place)
        state = {"whole": [], "first": ["--save-state", "../x"], "rest": ["--from-state", "../x"]}[folder]
        threads = [] if folder != "rest" else ["--set", "threads=3"]
        runs[folder] = run_command(
            example(name), place, ["-c", "conf.yaml", "-g", "--hash", "1", "-nr", *state, *threads]
        )
        assert runs[folder].code == 0, runs[folder].text
    expected = {step: value for step, value in hashes(runs["whole"]).items() if step not in hashes(runs["first"])}
    assert len(expected) > 10
    assert hashes(runs["rest"]) == expected
    # A column has another type where its cells before were empty.
    pd.testing.assert_frame_equal(runs["rest"].frame(), rows_after(runs["whole"].frame(), time_s), check_dtype=False)


@pytest.mark.parametrize("memory", ["own", "shared"])
@pytest.mark.parametrize("threads", [1, 3])
def test_variables_go_on_at_other_addresses(memory: str, threads: int, tmp_path: Path) -> None:
    """Pointers to variables, functions and texts lead to the same in the other process."""
    globals_ = """
    static uint32_t table[500];
    POGO_SHARED static uint32_t of_all = 0;
    static uint32_t *place = table;
    static uint32_t *ring[3] = {table, table + 7, table + 11};
    static void left(void) { pogobot_motor_set(motorL, motorFull); pogobot_motor_set(motorR, motorHalf); }
    static void right(void) { pogobot_motor_set(motorR, motorFull); pogobot_motor_set(motorL, motorHalf); }
    static void (*turn)(void) = left;
    static void (*colour)(uint8_t, uint8_t, uint8_t) = pogobot_led_setColor;"""
    step = """
    static char const *word = "abc";
    place = &table[(place - table + 1 + rand() % 3) % 500];
    *place += (uint32_t)rand() % 9 + of_all++ % 2;
    *ring[rand() % 3] += 1;
    if (*place % 3 == 0) { turn = turn == left ? right : left; }
    turn();
    word = word[0] == 'a' ? "xyz" : "abc";
    colour((uint8_t)(*place % 25), (uint8_t)(table[7] % 25), (uint8_t)word[0] % 25);"""
    program = program_of(tmp_path / "program", step, globals_=globals_)
    settings = {"robot_memory": memory, "objects.robots.nb": 12, "threads": threads}
    expect_same_course(program, tmp_path, settings, 0.73)


@pytest.mark.parametrize("engine", ["disk", "auto"])
@pytest.mark.parametrize("periodic", [False, True])
def test_dense_swarms_go_on_with_their_contacts_and_messages(engine: str, periodic: bool, tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    settings = {
        "physics_engine": engine,
        "boundary_condition": "periodic" if periodic else "solid",
        "objects.robots.nb": 60,
        "arena_surface": 2.2e5,
        "objects.rods": {"type": "pogobot", "nb": 6, "geometry": "capsule", "body_width": 60, "body_height": 30},
    }
    for time_s in (0.31, 1.27):
        expect_same_course(program, tmp_path / str(time_s), settings, time_s)


def test_scripts_and_firmware_go_on(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    firmware = firmware_of(tmp_path / "robot", text(textwrap.dedent(WANDER)))
    settings = {
        "objects.emulated": {"type": "pogobot", "nb": 3, "brain": str(firmware)},
        "objects.scripted": {
            "type": "pogobot",
            "nb": 3,
            "brain": {"script": [{"time_s": t / 10, "motors": [500 * (t % 2), 500, 0]} for t in range(20)]},
        },
    }
    expect_same_course(program, tmp_path, settings, 0.95)
    expect_same_course(without_program(), tmp_path / "alone", {OF_ROBOTS: str(firmware)}, 0.95)


def test_message_logs_and_frames_go_on(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    settings = {"message_log": "log.feather", "save_video_period": 0.2, "window_width": 60, "window_height": 60}
    whole = run(program, tmp_path / "whole", settings)
    place = tmp_path / "parts"
    first = run(program, place, {**settings, "simulation_time": 1.1}, ["--save-state", "x"])
    rest = run(program, place, settings, ["--from-state", "x"])
    assert (whole.code, first.code, rest.code) == (0, 0, 0), rest.text
    logs = [pd.read_feather(place / name) for name in ("log.1.feather", "log.feather")]
    pd.testing.assert_frame_equal(pd.concat(logs, ignore_index=True), pd.read_feather(tmp_path / "whole/log.feather"))
    frames = {path.name: path.read_bytes() for path in (place / "frames").iterdir()}
    assert frames == {path.name: path.read_bytes() for path in (tmp_path / "whole" / "frames").iterdir()}


def test_earlier_rows_are_kept_and_the_metadata_say_from_when_the_others_are(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    run(program, tmp_path, {"simulation_time": 0.5}, ["--save-state", "x"])
    before = (tmp_path / "data.feather").read_bytes()
    second = run(program, tmp_path, {"simulation_time": 1.0}, ["--from-state", "x", "--save-state", "x"])
    assert "'data.feather' of an earlier run is now 'data.1.feather'" in second.output
    third = run(program, tmp_path, {}, ["--from-state", "x"])
    assert third.code == 0
    assert (tmp_path / "data.1.feather").read_bytes() == before
    metadata = third.table().schema.metadata
    assert metadata[b"continued_from_s"] == b"1"
    parts = [load_dataframe(tmp_path / name)[0] for name in ("data.1.feather", "data.2.feather", "data.feather")]
    whole = run(program, tmp_path / "whole", {})
    pd.testing.assert_frame_equal(pd.concat(parts, ignore_index=True), whole.frame())


def test_files_of_the_earlier_part_that_cannot_be_renamed_are_an_error(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    assert run(program, tmp_path / "first", {"simulation_time": 0.5}, ["--save-state", "x"]).code == 0
    process = start(program, tmp_path, {"simulation_time": 1e6})
    try:
        wait_for_rows(tmp_path / "data.feather")
        (tmp_path / "log.feather").write_text("earlier")
        line = refused(program, tmp_path, {"message_log": "log.feather"}, "--from-state", "first/x")
        assert "data.feather' of the earlier part cannot be renamed, and would be lost" in line
        assert (tmp_path / "log.feather").read_text() == "earlier"
    finally:
        process.kill()
        process.communicate(timeout=60)


def test_console_file_goes_on(tmp_path: Path) -> None:
    program = program_of(
        tmp_path / "program", 'if (mydata->count % 60 == 30) { printf("at %u\\n", (unsigned)mydata->count); }'
    )
    settings = {"enable_console_logging": True, "console_filename": "console.txt", "objects.robots.nb": 1}
    run(program, tmp_path, {**settings, "simulation_time": 1.0}, ["--save-state", "x"])
    run(program, tmp_path, settings, ["--from-state", "x"])
    printed = re.findall(r"at \d+", (tmp_path / "console.txt").read_text())
    assert printed == ["at 30", "at 90"]


def test_rows_with_the_times_of_the_original_go_on(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    expect_same_course(program, tmp_path, {"save_data_times": "original"}, 0.83)


def test_interrupted_run_saves_its_state(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    settings = {"simulation_time": 1e6, "save_data_period": 1.0}
    for number, which in enumerate([signal.SIGTERM, signal.SIGINT]):
        folder = tmp_path / str(number)
        write_scene(folder, settings)
        process = start(program, folder, settings, ["--save-state", "x"])
        wait_for_rows(folder / "data.feather")
        process.send_signal(which)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 130, errors
        first = load_dataframe(folder / "data.feather")[0]
        end_s = float(first.time.max()) + 3
        rest = run(program, folder, {**settings, "simulation_time": end_s}, ["--from-state", "x"])
        assert rest.code == 0, rest.text
        both = pd.concat([first, rest.frame()], ignore_index=True)
        whole = run(program, folder / "whole", {**settings, "simulation_time": end_s})
        pd.testing.assert_frame_equal(both, whole.frame())


def test_interrupted_run_whose_time_has_not_come_saves_its_state(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    process = start(program, tmp_path, {"simulation_time": 1e6}, ["--save-state", "x", "--at", "900000"])
    wait_for_rows(tmp_path / "data.feather")
    process.terminate()
    process.communicate(timeout=60)
    assert process.returncode == 130
    assert (tmp_path / "x").stat().st_size > 100


def test_state_that_is_due_while_robots_wait_is_that_of_a_later_step(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program", "if (mydata->count % 20 == 1) { msleep(405); }")
    settings = {"objects.robots.nb": 1, "save_data_period": 0.01}
    whole = run(program, tmp_path / "whole", settings, ["--save-state", "x", "--at", "0.25"])
    assert "a robot waits in the middle of its program" in whole.output
    rest = run(program, tmp_path / "rest", settings, ["--from-state", "../whole/x"])
    assert rest.code == 0, rest.text
    pd.testing.assert_frame_equal(rest.frame(), rows_after(whole.frame(), rest.frame().time.min() - 0.01))


def test_robots_that_wait_at_the_end_are_an_error_and_the_rows_are_complete(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program", "msleep(300);")
    result = run(program, tmp_path, {}, ["--save-state", "x"])
    assert result.code == 2
    assert "--save-state: 'x' was not written: at t = 2 s, a robot waits in the middle of its program" in result.errors
    assert result.frame().time.max() == 2.0
    assert not (tmp_path / "x").exists()


# Again and again.


def test_killed_run_goes_on_from_its_last_state(tmp_path: Path) -> None:
    """Also one that went on itself. Rows after the state are those that are written again."""
    program = program_of(tmp_path / "program")
    settings = {"simulation_time": 1e6, "save_data_period": 0.1}
    folder, chance = tmp_path / "parts", random.Random(3)
    for part in range(4):
        before_s = (folder / "x").stat().st_mtime if part else 0.0
        going_on = ["--from-state", "x"] if part else []
        process = start(program, folder, settings, ["--save-state", "x", "--save-state-every", "0.02", *going_on])
        wait_for_state(folder / "x", before_s)
        time.sleep(chance.uniform(0.0, 0.2))
        process.kill()
        process.communicate(timeout=60)
    end_s = float(read_unfinished(folder / "data.feather").table.to_pandas().time.max()) + 3
    last = run(program, folder, {**settings, "simulation_time": end_s}, ["--from-state", "x"])
    assert last.code == 0, last.text
    whole = run(program, tmp_path / "whole", {**settings, "simulation_time": end_s}).frame()
    parts = [read_unfinished(folder / f"data.{number}.feather").table for number in range(1, 5)]
    parts.append(last.table())
    firsts = [int((part.schema.metadata or {}).get(b"continued_after_rows", b"0")) for part in parts]
    assert firsts == sorted(firsts)
    assert firsts[1] > 0
    for i, (part, first) in enumerate(zip(parts, firsts, strict=True)):
        rows = part.to_pandas()
        pd.testing.assert_frame_equal(rows, whole[first : first + len(rows)].reset_index(drop=True))
        following = firsts[i + 1] if i + 1 < len(parts) else len(whole)
        assert first + len(rows) >= following  # rows are on the disk before the state is


@pytest.mark.parametrize("step", [WANDER, WANDER + "if (mydata->count > 3000) { stop_simulation(); }"])
def test_run_that_was_killed_at_its_very_end_ends_again_at_once(step: str, tmp_path: Path) -> None:
    program = program_of(tmp_path / "program", step)
    every = ["--save-state", "x", "--save-state-every", "0.1"]
    whole = run(program, tmp_path, {}, every)
    assert whole.code == 0, whole.text
    rows = len(whole.frame())
    again = run(program, tmp_path, {}, [*every, "--from-state", "x"])
    assert again.code == 0, again.text
    assert len(again.frame()) == 0
    assert again.table().schema.metadata[b"continued_after_rows"] == b"%d" % rows


def wait_for_state(file: Path, newer_than_s: float) -> None:
    """Wait until a state has been written."""
    for _ in range(6000):
        if file.exists() and file.stat().st_size > 0 and file.stat().st_mtime > newer_than_s:
            return
        time.sleep(0.01)
    raise AssertionError(f"{file} was not written")


def test_run_that_cannot_be_saved_goes_on_if_states_are_wanted_on_the_way(tmp_path: Path) -> None:
    every = ["--save-state", "x", "--save-state-every", "0"]
    waits = program_of(tmp_path / "waits", "msleep(300);")
    result = run(waits, tmp_path / "run", {}, every)
    assert result.code == 0, result.text
    assert result.frame().time.max() == 2.0
    allocates = program_of(
        tmp_path / "allocates",
        "if (!numbers) { numbers = malloc(100); } numbers[0]++;",
        globals_="#include <stdlib.h>\nstatic int *numbers = NULL;",
    )
    result = run(allocates, tmp_path / "run", {}, every)
    assert result.code == 0
    assert "the program allocates memory ('malloc')" in result.errors
    assert "it goes on without" in result.errors
    assert not (tmp_path / "run" / "x").exists()
    result = run(allocates, tmp_path / "run", {}, [*every, "--at", "1"])
    assert result.code == 2


def test_two_runs_cannot_write_one_state_after_it_was_written(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    every = ["--save-state", "../x", "--save-state-every", "0"]
    process = start(program, tmp_path / "first", {"simulation_time": 1e6}, every)
    try:
        wait_for_state(tmp_path / "x", 0.0)
        result = run(program, tmp_path / "second", {}, every)
        assert result.code == 2
        assert "--save-state: cannot write '../x': in use by another run" in result.errors
    finally:
        process.kill()
        process.communicate(timeout=60)


# What cannot be saved.


def refused(program: Path, folder: Path, settings: Settings, *arguments: str) -> str:
    """The one line that refuses a run, which has touched nothing."""
    before = sorted(path.name for path in folder.glob("*")) if folder.exists() else []
    result = run(program, folder, settings, arguments)
    assert result.code == 2, result.text
    after = [path.name for path in folder.glob("*")]
    assert sorted(after) == sorted({*before, "scene.yaml"})
    lines = [line for line in result.errors.splitlines() if line.startswith("Error: ")]
    assert len(lines) == 1, result.errors
    return lines[0]


def refused_with_and_without_run(program: Path, folder: Path, settings: Settings, *arguments: str) -> str:
    """The one line that refuses a run, and --check-config, too."""
    line = refused(program, folder, settings, *arguments)
    assert refused(program, folder, settings, *arguments, "--check-config") == line
    return line


def test_program_that_allocates_memory_is_told_why(tmp_path: Path) -> None:
    globals_ = "#include <stdlib.h>\nstatic int *numbers = NULL;"
    step = "if (!numbers) { numbers = malloc(100); } numbers[0]++;"
    program = program_of(tmp_path / "program", step, globals_=globals_)
    assert "the program allocates memory ('malloc')" in refused(program, tmp_path / "run", {}, "--save-state", "x")


def test_program_that_keeps_an_address_of_the_simulator_is_told_which(tmp_path: Path) -> None:
    globals_ = "static message_t *volatile latest = NULL;\nstatic void get(message_t *message) { latest = message; }"
    step = """
    uint8_t bytes[4] = {1, 2, 3, 4};
    pogobot_infrared_sendLongMessage_omniSpe(bytes, 4);"""
    program = program_of(tmp_path / "program", step, "msg_rx_fn = get;", globals_)
    result = run(program, tmp_path / "run", {"objects.robots.nb": 30, "arena_surface": 1e5}, ["--save-state", "x"])
    assert result.code == 2
    assert "the variable 'latest' has an address in memory that only this process has" in result.errors


def test_program_of_the_sdk_is_told_why(tmp_path: Path) -> None:
    program = example("heartbeat_sdk")
    assert "its robots wait in the middle of main()" in refused(program, tmp_path, {}, "--save-state", "x")


def test_box2d_is_told_why(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    line = refused(program, tmp_path / "run", {"physics_engine": "box2d"}, "--save-state", "x")
    assert "its physics engine (box2d) cannot be saved" in line


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A program and a state of it, of t = 0.5 s."""
    folder = tmp_path_factory.mktemp("saved")
    program = program_of(folder / "program")
    assert run(program, folder, {"simulation_time": 0.5}, ["--save-state", "x"]).code == 0
    return program, folder / "x"


def test_other_runs_are_refused_with_what_differs(saved: tuple[Path, Path], tmp_path: Path) -> None:
    program, state = saved

    def why(settings: Settings, *arguments: str, other: Path = program) -> str:
        return refused_with_and_without_run(other, tmp_path / "run", settings, "--from-state", str(state), *arguments)

    assert "'objects: robots: nb: 3' then, and 'objects: robots: nb: 4' now" in why({"objects.robots.nb": 4})
    assert "another configuration" in why({"parameters": {"a": 1}})
    assert "'parameters: a: 1' is new" in why({"parameters": {"a": 1}})
    assert "'time_step: 0.01' then, and 'time_step: 0.005' now" in why({"time_step": 0.005})
    assert "is of a run with seed 1, not 2: leave out --seed" in why({}, "-s", "2")
    assert "is of a run with seed 1, not 2: leave out --set seed" in why({}, "--set", "seed=2")
    assert "is of t = 0.5 s, and simulation_time is 0.5 s: set a longer one" in why({"simulation_time": 0.5})
    assert "--at 0.2 is before that" in why({}, "--save-state", "y", "--at", "0.2")
    other = program_of(tmp_path / "other", "pogobot_led_setColor(1, 2, 3);")
    assert "is of another build of 'prog': go on with that executable" in why({}, other=other)
    renamed = shutil.copy(other, tmp_path / "other" / "lights")
    assert "is of the program 'prog', and this is 'lights'" in why({}, other=Path(renamed))


@pytest.fixture
def versions(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Settings, str, bytes, bytes]:
    """Keys that name a file `x.csv`, ... of this kind, the name, and two contents of it."""
    kind = request.param
    if kind == "firmware":
        built = [firmware_of(tmp_path / name, text(f"pogobot_led_setColor({name}, 0, 0);")) for name in ("1", "2")]
        return {OF_ROBOTS: "fw.elf"}, "fw.elf", built[0].read_bytes(), built[1].read_bytes()
    if kind == "script":
        scripts = [yaml.safe_dump({"script": [{"time_s": 0, "motors": [power, 0, 0]}]}) for power in (500, 600)]
        return {OF_ROBOTS: {"script": "s.yaml"}}, "s.yaml", scripts[0].encode(), scripts[1].encode()
    if kind == "model":
        models = [yaml.safe_dump({"communication_radius": radius}) for radius in (80, 90)]
        return {"objects.robots.robot_model": "m.yaml"}, "m.yaml", models[0].encode(), models[1].encode()
    if kind == "arena":
        square = (ROOT / "arenas" / "square.csv").read_bytes()
        return {"arena_file": "a.csv"}, "a.csv", square, (ROOT / "arenas" / "disk.csv").read_bytes()
    if kind == "links":
        settings: Settings = {"links.rods": {"type": "rod", "between": ["robots"], "topology": "list", "file": "l.csv"}}
        return settings, "l.csv", b"a,b\n0,1\n", b"a,b\n1,2\n"
    table = (ROOT / "conf" / "example_magnetometer_reference.csv").read_bytes()
    rows = table.splitlines(keepends=True)
    settings = {"magnetometer": {"source": "csv", "csv": {"file": "t.csv", "harmonic_order": 3}}}
    return settings, "t.csv", table, b"".join(rows[:-1])


@pytest.mark.parametrize("versions", ["firmware", "script", "model", "arena", "links", "table"], indirect=True)
def test_files_are_those_that_the_run_has_read(versions: tuple[Settings, str, bytes, bytes], tmp_path: Path) -> None:
    """A file that was replaced while the run went on is another one: its own is taken."""
    named, name, first, second = versions
    settings = {"simulation_time": 1e6, "save_data_period": 1.0, "data_logger_flush_row_count": 100, **named}
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / name).write_bytes(first)
    process = start(example("helloworld"), folder, settings, ["--save-state", "x"])
    try:
        wait_for_rows(folder / "data.feather")
        (folder / "new").write_bytes(second)
        (folder / "new").replace(folder / name)
    finally:
        process.terminate()
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    end_s = float(load_dataframe(folder / "data.feather")[0].time.max()) + 3
    settings["simulation_time"] = end_s
    going_on = ("--from-state", "x")
    assert "'x' is of a" in refused_with_and_without_run(example("helloworld"), folder, settings, *going_on)
    (folder / name).write_bytes(first)
    result = run(example("helloworld"), folder, settings, [*going_on, "--check-config"])
    assert result.code == 0, result.text
    result = run(example("helloworld"), folder, settings, going_on)
    assert result.code == 0, result.text


def test_check_takes_a_state_that_fits_and_does_not_load_it(saved: tuple[Path, Path], tmp_path: Path) -> None:
    program, state = saved
    folder = tmp_path / "run"
    settings = {
        "simulation_time": 1.0,
        "message_log": "messages.feather",
        "enable_console_logging": True,
        "save_video_period": 0.1,
        "flash_state": {"input_file": "flash.bin", "output_file": "flash.bin"},
        "threads": 1,
    }
    folder.mkdir()
    (folder / "data.feather").write_bytes(b"of an earlier part")
    checked = run(program, folder, settings, ["--from-state", str(state), "--check-config"])
    assert (checked.code, checked.errors) == (0, "")
    assert checked.output == "scene.yaml: no mistakes found: 3 robots\n"
    assert sorted(path.name for path in folder.iterdir()) == ["data.feather", "scene.yaml"]
    result = run(program, folder, settings, ["--from-state", str(state)])
    assert result.code == 0, result.text


def test_check_compares_a_state_with_a_configuration_that_it_can_read(saved: tuple[Path, Path], tmp_path: Path) -> None:
    program, state = saved
    going_on = ("--from-state", str(state), "--check-config")
    line = refused(program, tmp_path, {"time_step": "fast"}, *going_on)
    assert "scene.yaml:" in line
    assert "time_step" in line
    assert "--from-state" not in line
    result = run(program, tmp_path, {"time_step": 0.005}, [*going_on, "--picture", "missing/start.png"])
    assert result.code == 2
    assert result.errors.count("Error: ") == 2
    assert "there is no folder" in result.errors
    assert "'time_step: 0.01' then, and 'time_step: 0.005' now" in result.errors


def test_files_that_are_no_states_are_refused(saved: tuple[Path, Path], tmp_path: Path) -> None:
    program, state = saved
    good = state.read_bytes()
    folder = tmp_path / "run"
    folder.mkdir()

    def why(content: bytes) -> str:
        (folder / "x").write_bytes(content)
        return refused(program, folder, {}, "--from-state", "x")

    assert "'x' is empty" in why(b"")
    assert "'x' is not the state of a run" in why(b"time,x,y\n")
    chance = random.Random(1)
    for size in [9, 30, len(good) - 1, *(chance.randrange(len(good)) for _ in range(10))]:
        assert "'x' is " in why(good[:size])
    assert "'x' is longer than the state that it begins with, by 1 byte" in why(good + b"0")
    assert "by 999 bytes" in why(good + bytes(999))
    for _ in range(10):
        damaged = bytearray(good)
        damaged[chance.randrange(30, len(good))] ^= 1 << chance.randrange(8)
        assert "'x' is damaged" in why(bytes(damaged))
    (folder / "x").unlink()
    for more in ((), ("--check-config",)):
        assert "'x' does not exist" in refused(program, folder, {}, "--from-state", "x", *more)


def test_files_that_would_be_lost_are_not_overwritten(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    assert "'notes.txt' is not the state of a run, and would be lost" in refused(
        program, folder, {}, "--save-state", "notes.txt"
    )
    assert (folder / "notes.txt").read_text() == "mine"
    assert "--save-state would overwrite 'scene.yaml'" in refused(program, folder, {}, "--save-state", "scene.yaml")
    for option in ("--at", "--save-state-every"):
        assert "expected a number of seconds, found 'nan'" in refused(
            program, folder, {}, "--save-state", "x", option, "nan"
        )
    assert "--at 9: the run ends at 2 s" in refused(program, folder, {}, "--save-state", "x", "--at", "9")


def test_two_runs_cannot_write_one_state(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    process = start(program, tmp_path / "first", {"simulation_time": 1e6}, ["--save-state", "../x"])
    try:
        wait_for_rows(tmp_path / "first" / "data.feather")
        result = run(program, tmp_path / "second", {}, ["--save-state", "../x"])
        assert result.code == 2
        assert "--save-state: cannot write '../x': in use by another run" in result.errors
    finally:
        process.kill()
        process.communicate(timeout=60)


def test_state_that_a_run_goes_on_from_is_none_of_its_files(saved: tuple[Path, Path], tmp_path: Path) -> None:
    program, state = saved
    (tmp_path / "x").write_bytes(state.read_bytes())
    (tmp_path / "rows.feather").symlink_to("x")
    for settings in (
        {"enable_console_logging": True, "console_filename": "x"},
        {"data_filename": "rows.feather"},
    ):
        longer = {"simulation_time": 1.0, **settings}
        message = refused_with_and_without_run(program, tmp_path, longer, "--from-state", "x")
        assert "--from-state: the run needs 'x' for something else, or would overwrite it" in message
        assert (tmp_path / "x").read_bytes() == state.read_bytes()


def test_what_a_killed_run_left_of_a_state_is_removed_by_the_next(tmp_path: Path) -> None:
    program = program_of(tmp_path / "program")
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "x.tmp.0123abcd").write_bytes(b"unfinished")
    (folder / "x.tmp.mine").write_bytes(b"mine")
    assert run(program, folder, {"simulation_time": 0.1}, ["--save-state", "x"]).code == 0
    assert sorted(path.name for path in folder.glob("x*")) == ["x", "x.tmp.mine"]
