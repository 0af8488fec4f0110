"""What drives robots besides a program in C: arrays of this process, and scripts; from the configuration on."""

from __future__ import annotations

import gc
import logging
import math
import re
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
import yaml
from conftest import Compile
from project import CLEAN
from running import ROOT, SHARED, build_folder, compile_program, ran, run, write_scene

ALONE: dict[str, Any] = {
    "arena_file": "arenas/square.csv",
    "arena_surface": 4e6,
    "simulation_time": 10,
    "objects.robots.nb": 2,
    "objects.robots.poses": [[500, 500, 0], [500, 1500, 0]],
    "objects.robots.msg_success_rate": {"type": "static", "rate": 1.0},
}
HOST = {**ALONE, "objects.robots.brain": "host"}


def hosted(folder: Path, settings: dict[str, Any]) -> Any:
    return pogosim.Simulation(None, write_scene(folder, settings), seed=1)


def test_robots_move_by_the_powers_of_the_array(tmp_path: Path) -> None:
    with hosted(tmp_path, HOST) as sim:
        brain = sim.brain("robots")
        assert (len(brain), brain.motors.shape, brain.motors.dtype) == (2, (2, 3), np.int32)
        brain.motors[0, :2] = 1023
        brain.motors[1, :2] = (-1023, 1023)  # the right wheel backwards, the left one forwards: clockwise
        sim.run(2.0)
        assert sim.positions[0] == pytest.approx([500 + 200, 500], abs=3)
        assert sim.positions[1] == pytest.approx([500, 1500], abs=0.01)
        turned = math.remainder(float(sim.headings[1]) - 8.0, 2 * math.pi)
        assert abs(turned) < 0.1
        brain.motors[:] = 0
        sim.step(5)
        before = sim.positions.copy()
        sim.step(100)
        assert np.array_equal(sim.positions, before)


def test_powers_beyond_the_range_are_warned_of_once(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with hosted(tmp_path, HOST) as sim:
        sim.brain("robots").motors[1, 0] = 5000
        sim.step(20)
    assert caplog.messages == ["brain of category 'robots': motors[1, 0] is 5000, expected -1023 to 1023; 1023 is used"]


def test_arrays_may_be_assigned(tmp_path: Path) -> None:
    with hosted(tmp_path, HOST) as sim:
        brain = sim.brain("robots")
        kept = brain.motors
        brain.motors = np.array([[1, 2, 3], [4, 5, 6]])
        brain.motors += 1
        brain.leds = 9
        brain.leds //= 2
        assert brain.motors is kept
        assert kept.tolist() == [[2, 3, 4], [5, 6, 7]]
        assert (brain.leds == 4).all()
        with pytest.raises(ValueError, match="could not broadcast"):
            brain.motors = np.zeros((3, 3))


def test_policy_of_arrays_drives_a_thousand_robots(tmp_path: Path) -> None:
    many = {**HOST, "objects.robots.nb": 1000, "arena_surface": 4e7, "simulation_time": 2}
    del many["objects.robots.poses"]
    with hosted(tmp_path, many) as sim:
        brain = sim.brain("robots")
        while sim.step(2):
            brain.motors[:, :2] = np.where(np.arange(1000)[:, None] % 2 == 0, [1023, 511], [511, 1023])
        assert sim.ticks.min() > 100
        turned = brain.angular_velocity[:, 2]
        assert np.median(turned[::2]) == pytest.approx(1.0, rel=0.05)  # counter-clockwise from above: to the left
        assert np.median(turned[1::2]) == pytest.approx(-1.0, rel=0.05)


def test_messages_go_out_once_and_are_received_with_sender_and_face(tmp_path: Path) -> None:
    near = {**HOST, "objects.robots.poses": [[500, 500, 0], [600, 500, math.pi]]}
    with hosted(tmp_path, near) as sim:
        brain = sim.brain("robots")
        brain.send(0, b"hello")
        brain.send(1, b"", face=2)  # away from the other one
        sim.step(10)
        assert list(brain.send_length) == [-1, -1]
        (message,) = brain.received
        assert (message["robot"], message["sender"], message["face"]) == (1, 0, 0)
        assert brain.payload(message) == b"hello"
        assert list(brain.received_count) == [0, 1]
        brain.clear_received()
        sim.step(10)
        assert len(brain.received) == 0
        with pytest.raises(pogosim.ConfigurationError, match="up to 382 bytes"):
            brain.send(0, b"x" * 383)
        with pytest.raises(pogosim.ConfigurationError, match="an integer from 0 to 1"):
            brain.send(2, b"x")
        with pytest.raises(pogosim.ConfigurationError, match="an integer from -1 to 3"):
            brain.send(0, b"x", face=4)
        with pytest.raises(pogosim.ConfigurationError, match='expected bytes, such as b"x", found'):
            brain.send(0, "x")
        with pytest.raises(AttributeError):
            brain.motor = 3
        brain.send(0, b"ab")
        sim.step(5)
        brain.send(0, b"c")
        sim.step(5)
        assert [brain.payload(message) for message in brain.received] == [b"ab", b"c"]


def test_messages_that_no_room_was_made_for_are_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    poses = [[500, 500, 0], [600, 500, math.pi]]
    near = {**HOST, "objects.robots.poses": poses, "objects.robots.message_queue_size": 2}
    with hosted(tmp_path, near) as sim:
        brain = sim.brain("robots")
        for _ in range(20):
            brain.send(0, b"a")
            sim.step(4)
        assert len(brain.received) == 4
        sim.end()
    assert "the host makes room by clear_received()" in caplog.text


def test_sensors_are_those_of_the_robots(tmp_path: Path) -> None:
    lamp = {"type": "static_light", "geometry": "global", "value": 1234}
    with hosted(tmp_path, {**HOST, "objects.lamp": lamp}) as sim:
        brain = sim.brain("robots")
        brain.motors[0, :2] = (-1023, 1023)
        brain.leds[1, 0] = (1, 2, 3)
        sim.step(100)
        assert np.array_equal(brain.photosensors, np.full((2, 3), 1234))
        assert brain.angular_velocity[0, 2] == pytest.approx(-4.0, rel=0.02)
        assert brain.angular_velocity[1, 2] == 0
        assert brain.battery_mv[0] == 4200
        assert tuple(sim.leds[1, 0]) == (1, 2, 3)


def test_arrays_are_views_that_outlive_the_brain(tmp_path: Path) -> None:
    sim = hosted(tmp_path, HOST)
    motors = sim.brain("robots").motors
    motors[:] = 7
    assert np.array_equal(sim.brain("robots").motors, motors)
    sim.close()
    del sim
    gc.collect()
    assert motors.sum() == 6 * 7  # the memory is still there


def test_arrays_of_the_run_before_a_reset_cannot_be_written(tmp_path: Path) -> None:
    with hosted(tmp_path, HOST) as sim:
        brain = sim.brain("robots")
        names = ("motors", "leds", "send_bytes", "send_length", "send_face")
        before = [getattr(brain, name) for name in names]
        assert brain.motors is before[0]
        sim.reset()
        for array in before:
            with pytest.raises(ValueError, match="read-only"):
                array[:] = 1
        brain.motors[:, :2] = 1023  # those of the new run
        sim.run(1.0)
        assert sim.positions[0] == pytest.approx([600, 500], abs=3)


def test_categories_of_one_run_may_have_different_brains(tmp_path: Path) -> None:
    text = """
    #include "pogobase.h"
    typedef struct { int heard; } USERDATA;
    REGISTER_USERDATA(USERDATA)
    static void user_init(void) {}
    static void user_step(void) {
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            message_t message;
            pogobot_infrared_recover_next_message(&message);
            mydata->heard += message.header.payload_length;
        }
        pogobot_led_setColor((uint8_t)mydata->heard, 0, 0);
    }
    int main(void) { pogobot_init(); pogobot_start(user_init, user_step, "listeners"); return 0; }
    """
    (tmp_path / "listen.c").write_text(text)
    program = compile_program(tmp_path / "listen.so", tmp_path / "listen.c", flags=SHARED)
    script = [{"time_s": 1, "message": "abc", "led": [9, 8, 7]}]
    rate = {"type": "static", "rate": 1.0}
    near = {"type": "pogobot", "msg_success_rate": rate}
    settings = {
        **HOST,
        "objects.robots.nb": 1,
        "objects.robots.poses": [[500, 500, 0]],
        "objects.actors": {**near, "poses": [[600, 500, 0]], "brain": {"script": script}},
    }
    listener = {**near, "poses": [[550, 590, -1.57]]}
    with pogosim.Simulation(program, write_scene(tmp_path, {**settings, "objects.listeners": listener})) as sim:
        sim.run(0.9)
        assert len(sim.brain("robots").received) == 0
        sim.run(1.2)
        (message,) = sim.brain("robots").received
        assert sim.brain("robots").payload(message) == b"abc"
        assert tuple(sim.leds[1, 0]) == (9, 8, 7)
        assert sim.leds[2, 0, 0] in (3, 6)  # the program has heard it, too, through one face or two


ENTRY = {"type": "pogobot", "geometry": "disk", "radius": 26.5}


def test_entries_of_one_category_are_one_table(tmp_path: Path) -> None:
    entries = [
        {**ENTRY, "nb": 2, "brain": "host"},
        {**ENTRY, "nb": 0, "brain": "host"},
        {**ENTRY, "nb": 3, "brain": "host"},
    ]
    with hosted(tmp_path, {"arena_surface": 4e6, "objects": {"robots": entries}}) as sim:
        brain = sim.brain("robots")
        assert len(brain) == 5
        brain.motors[:] = [1000, 1000, 0]
        before = sim.positions.copy()
        sim.run(1.0)
        assert (np.linalg.norm(sim.positions - before, axis=1) > 10).all()
    apart = [entries[0], {**ENTRY, "nb": 1, "brain": {"script": []}}, entries[2]]
    message = error_of(tmp_path, {"arena_surface": 4e6, "objects": {"robots": apart}})
    assert "category 'robots': its entries with brain: host have others between them" in message


def test_category_without_robots_has_empty_arrays(tmp_path: Path) -> None:
    settings = {"objects": {"robots": {**ENTRY, "nb": 0, "brain": "host"}}}
    with hosted(tmp_path, settings) as sim:
        brain = sim.brain("robots")
        assert brain.motors.shape == (0, 3)
        assert brain.leds.shape == (0, 5, 3)
        assert sim.step(3)
        assert len(brain.received) == 0


def test_script_of_a_file_moves_robots_at_its_times(tmp_path: Path) -> None:
    (tmp_path / "dance.yaml").write_text(
        "script:\n  - {time_s: 0, motors: [1023, 1023, 0]}\n  - {time_s: 2, motors: [0, 0, 0]}\n"
    )
    with hosted(tmp_path, {**ALONE, "objects.robots.brain": {"script": "dance.yaml"}}) as sim:
        sim.run(5.0)
        assert sim.positions[0] == pytest.approx([700, 500], abs=4)
        sim.end()
        kept = sim.data_file
        assert kept.exists()


def test_run_does_not_overwrite_its_script(program: Compile, tmp_path: Path) -> None:
    script = "script: [{time_s: 0}]\n"
    (tmp_path / "s.yaml").write_text(script)
    settings = {**ALONE, "objects.robots.brain": {"script": "s.yaml"}, "data_filename": "s.yaml"}
    result = run(program("sample.c"), tmp_path, settings)
    assert result.code == 2
    assert "is the same file as the script 's.yaml', which the run would overwrite" in result.errors
    assert (tmp_path / "s.yaml").read_text() == script


def error_of(folder: Path, settings: dict[str, Any]) -> str:
    with pytest.raises(pogosim.ConfigurationError) as error:
        hosted(folder, settings)
    return str(error.value)


def test_each_mistake_of_a_configuration_has_its_line(tmp_path: Path) -> None:
    said = error_of(tmp_path, {**ALONE, "time_step": -1, "objects.robots.radius": -1})
    assert len(said.splitlines()) == 2, said
    assert ["time_step" in line for line in said.splitlines()] == [True, False]
    assert "\\n" not in said


def test_mistakes_are_told(tmp_path: Path) -> None:
    assert "category 'robots' needs a program, and none is given" in error_of(tmp_path, ALONE)
    brain = "objects.robots.brain"
    assert "did you mean 'host'?" in error_of(tmp_path, {**ALONE, brain: "hosts"})
    assert "there is no file 'none.yaml'" in error_of(tmp_path, {**ALONE, brain: {"script": "none.yaml"}})
    assert "time_s" in error_of(tmp_path, {**ALONE, brain: {"script": [{"motors": [1, 2, 3]}]}})
    late = {"script": [{"time_s": 2}, {"time_s": 1}]}
    assert "in the order of their times" in error_of(tmp_path, {**ALONE, brain: late})
    absent = {"script": [{"time_s": 0, "led": [1, 2, 3], "led_id": 1}]}
    message = error_of(tmp_path, {**ALONE, brain: absent, "objects.robots.leds": [{"place": "centre"}]})
    assert "the script sets LED 1, but these robots have 1 LED" in message
    (tmp_path / "more.yaml").write_text("script: []\nscripts: []\n")
    assert "and nothing else" in error_of(tmp_path, {**ALONE, brain: {"script": "more.yaml"}})
    long = {"script": [{"time_s": 0, "message": "x" * 383}]}
    assert "expected up to 382 bytes, found 383" in error_of(tmp_path, {**ALONE, brain: long})
    strong = {"script": [{"time_s": 0, "motors": [5000, 0, 0]}]}
    assert "from -1023 to 1023" in error_of(tmp_path, {**ALONE, brain: strong})
    for settings, category, message in (
        (HOST, "robot", "there is no category 'robot'; a host drives robots$"),
        ({**ALONE, brain: {"script": []}}, "robots", "is not driven by the host: .*; no category has 'brain: host'$"),
    ):
        with hosted(tmp_path, settings) as sim, pytest.raises(pogosim.ConfigurationError, match=message):
            sim.brain(category)


@pytest.mark.parametrize(
    ("brain", "message"),
    [
        ("dance.yaml", r"found 'dance.yaml'; did you mean brain: {script: dance.yaml}\?"),
        ({"time_s": 0, "motors": [5, 5]}, "motors: expected a list of three powers, .*, found a list of 2$"),
        ({"time_s": 0, "led": [5, 5, 5, 5]}, "led: expected a list of red, .*, found a list of 4$"),
        ({"time_s": 0, "motors": [0.5, -1, 0]}, r"if you meant shares of full power, write \[512, -1023, 0\]"),
        ({"time_s": 0, "led_id": 2}, "led_id: says which LED `led` colours, and there is no `led`; add one"),
    ],
)
def test_mistakes_in_scripts_are_told(tmp_path: Path, brain: object, message: str) -> None:
    script = brain if isinstance(brain, str) else {"script": [brain]}
    assert re.search(message, error_of(tmp_path, {**ALONE, "objects.robots.brain": script}))


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ([], r": objects\.robots\.brain: the script is empty, so these robots do nothing"),
        (
            [{"time_s": 10, "motors": [9, 9, 0]}],
            r"the script begins at 10 s, but the run ends at 10 s \(simulation_time\)",
        ),
        ([{"time_s": 0, "motors": [1, 1, 0]}], r"if you meant shares of full power, write \[1023, 1023, 0\]"),
        ([{"time_s": 9, "motors": [2, 1, 0]}, {"time_s": 11, "motors": [0, 0, 0]}], None),
        (
            [{"time_s": 0, "motors": [2, 1, 0]}, {"time_s": 2500, "motors": [0, 0, 0]}],
            r"the script goes on until 2500 s, far beyond the end .* \(simulation_time: 10\); times are in s, not in",
        ),
        ([{"time_s": 0}], r"objects\.robots\.brain\.script\.0: has a time and nothing else, so it does nothing"),
        (
            [{"time_s": 1, "motors": [2, 1, 0]}, {"time_s": 1, "motors": [9, 9, 0]}],
            r"brain\.script\.1: replaces at once what an entry before it sets, which has the same time",
        ),
        ([{"time_s": 1, "motors": [2, 1, 0]}, {"time_s": 1, "led": [9, 9, 0]}], None),
        (
            [{"time_s": 1, "led": [2, 1, 0], "led_id": 1}, {"time_s": 1, "led": [9, 9, 0], "led_id": 2}],
            None,
        ),
        (
            [{"time_s": 1, "motors": [0, 0, 9]}],
            r"gives power to the back motor, which these robots do not have",
        ),
    ],
)
def test_script_that_does_nothing_is_warned_of(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, entries: list[Any], message: str | None
) -> None:
    with hosted(tmp_path, {**ALONE, "objects.robots.brain": {"script": entries}}):
        texts = [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]
    assert bool(texts) == (message is not None)
    assert message is None or re.search(message, "".join(texts))


def test_script_and_firmware_exclude_each_other(tmp_path: Path) -> None:
    both = {"script": [{"time_s": 0, "motors": [9, 9, 0]}], "firmware": "robot.elf"}
    message = "objects.robots.brain: a script and a firmware exclude each other; remove one of them"
    assert message in error_of(tmp_path, {**ALONE, "objects.robots.brain": both})


def test_motors_and_faces_that_a_model_lacks_are_told_to_the_host(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with hosted(tmp_path, {**HOST, "objects.robots.faces": [{"angle_deg": 0}]}) as sim:
        brain = sim.brain("robots")
        brain.motors[1] = [5, 5, 5]
        brain.send(0, b"x", face=3)
        sim.step(20)
        assert caplog.text.count("motors[:, 2]: the robots' model has no such motor; its power moves nothing") == 1
        assert caplog.text.count("send_face: the robots' model has no face 3; nothing is sent") == 1
        assert np.linalg.norm(sim.velocities[1]) > 0.0


def test_program_that_no_category_needs_is_told(program: Compile, tmp_path: Path) -> None:
    idle = "no category needs the program: all robots follow scripts"
    script = {"script": [{"time_s": 0, "motors": [9, 9, 0]}]}
    settings = {**ALONE, "simulation_time": 0.1, "objects.robots.brain": script}
    assert run(program("sample.c"), tmp_path, settings).text.count(f"{idle} (brain: {{script: ...}})\n") == 1
    driven = {"type": "pogobot", "nb": 1}
    assert idle not in run(program("sample.c"), tmp_path, {**settings, "objects.driven": driven}).text


def test_walls_that_a_periodic_arena_leaves_out_have_no_brain(tmp_path: Path) -> None:
    walls = {"type": "pogowall", "geometry": "arena", "brain": "host"}
    with hosted(tmp_path, {**HOST, "boundary_condition": "periodic", "objects.walls": walls}) as sim:
        message = r"there is no category 'walls' \(walls are not created in a periodic arena\); a host drives robots$"
        with pytest.raises(pogosim.ConfigurationError, match=message):
            sim.brain("walls")


def test_command_line_has_no_host(program: Compile, tmp_path: Path) -> None:
    result = run(program("sample.c"), tmp_path, HOST)
    assert result.code == 2
    assert "there is no host on the command line; run it from Python" in result.errors


def test_data_file_keeps_a_script_whole(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("script: [{time_s: 1, motors: [1, 2, 3], led: [4, 5, 6]}]\n")
    result = run(program("sample.c"), tmp_path, {**ALONE, "objects.robots.brain": {"script": "s.yaml"}})
    assert result.code == 0, result.text
    kept = yaml.safe_load(result.table().schema.metadata[b"resolved_configuration"])
    (entry,) = kept["objects"]["robots"]["brain"]["script"]
    assert (entry["motors"], entry["led"]) == ([1, 2, 3], [4, 5, 6])


def test_data_file_repeats_a_script_without_colours(program: Compile, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("script: [{time_s: 1, motors: [1, 2, 0]}, {time_s: 2, led: [4, 5, 6]}]\n")
    result = run(program("sample.c"), tmp_path, {**ALONE, "objects.robots.brain": {"script": "s.yaml"}})
    again = (result.table().schema.metadata or {})[b"resolved_configuration"]
    repeated = run(program("sample.c"), tmp_path, yaml.safe_load(again), ["--check-config"])
    assert (repeated.code, repeated.errors) == (0, "")


def test_assigned_powers_must_be_whole(tmp_path: Path) -> None:
    with hosted(tmp_path, HOST) as sim:
        brain = sim.brain("robots")
        brain.motors = np.full(brain.motors.shape, 512.0)
        assert (brain.motors == 512).all()
        for wrong in (0.8, math.nan, math.inf, 1e10, 2**40, "12", [0.5, 0, 0], Fraction(1, 2), 1 + 1j):
            with pytest.raises(pogosim.ConfigurationError, match=r"brain\.motors takes whole numbers from -1023"):
                brain.motors = wrong
        assert (brain.motors == 512).all()
        brain.leds = [255, 0.0, 7]
        for bad in (300, -1, [300, 0, 0], 0.5, math.inf, np.full(brain.leds.shape, 256)):
            with pytest.raises(pogosim.ConfigurationError, match=r"brain\.leds takes whole numbers from 0 to 255"):
                brain.leds = bad
        assert (brain.leds == [255, 0, 7]).all()
        for flags in (True, [[True, False, True]]):
            with pytest.raises(pogosim.ConfigurationError, match=r"brain\.motors takes whole numbers .*, found True;"):
                brain.motors = flags


def test_advice_to_scale_is_for_what_has_a_scale(tmp_path: Path) -> None:
    with hosted(tmp_path, HOST) as sim:
        brain = sim.brain("robots")
        said = {}
        for name in ("motors", "leds", "send_bytes", "send_length", "send_face"):
            with pytest.raises(pogosim.ConfigurationError) as error:
                setattr(brain, name, 0.5)
            said[name] = str(error.value)
        assert said["motors"].endswith("found 0.5; scale and round what is from 0 to 1, such as np.rint(1023 * values)")
        assert said["leds"].endswith("such as np.rint(255 * values)")
        assert said["send_bytes"] == "brain.send_bytes takes whole numbers from 0 to 255, found 0.5"
        assert said["send_length"] == "brain.send_length takes whole numbers from -1 to 382, found 0.5"
        assert said["send_face"] == "brain.send_face takes whole numbers from -1 to 3, found 0.5"


def test_examples_of_the_page_run(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "brains.md").read_text()
    (scene,) = re.findall(r"^    # conf\.yaml\n((?:    .*\n)+)", page, re.MULTILINE)
    entries = yaml.safe_load(scene)
    entries["objects"]["robots"]["nb"] = 20
    square = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "arena_surface": 3e5, "simulation_time": 1}
    files = {"data_filename": "", "enable_console_logging": False}
    (tmp_path / "conf.yaml").write_text(yaml.safe_dump({**entries, **square, **files}))
    policy, receiving = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    told = "print(sorted({tuple(led) for led in sim.leds[:, 0].tolist()}))\n"
    (tmp_path / "example.py").write_text(policy + receiving + f"    {told}")
    done = ran(tmp_path, sys.executable, "example.py", env=CLEAN | {"POGOSIM_DIR": str(build_folder())})
    assert (done.code, done.output) == (0, "[(0, 0, 0), (255, 0, 0)]\n"), done.text
