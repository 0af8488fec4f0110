"""A run that goes on in a thread of its own: what viewers are told, what they may do, and that it changes no bytes."""

from __future__ import annotations

import functools
import gc
import math
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from live_client import Client, Picture, wait_for
from pogosim.watch.commands import COMMANDS, MOST_CHARACTERS, RefusedError, read_command
from pogosim.watch.live import LiveRun
from pogosim.watch.viewer import MOST_UNDER_WAY, Viewer
from running import ROOT, write_scene


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_scene(
        tmp_path,
        {
            "simulation_time": 5.0,
            "objects.robots.nb": 12,
            "objects.ball": {"type": "passive_object", "nb": 1, "geometry": "disk", "radius": 30, "x": 500, "y": 560},
            "objects.lamp": {"type": "static_light", "geometry": "global", "value": 100},
            "parameters": {"gain": 2.0, "flag": True, "name": "text", "inner": {"level": 3}},
        },
    )


@pytest.fixture
def live(sim: pogosim.Simulation) -> Iterator[LiveRun]:
    running = LiveRun(sim)
    yield running
    running.end()


class Watcher(Client):
    """A viewer in this process."""

    def __init__(
        self, live: LiveRun, *, may_steer: bool = True, answers: bool = True, stall_s: float = math.inf
    ) -> None:
        super().__init__()
        self.live, self.answers = live, answers
        self.viewer = Viewer(self._hear, may_steer=may_steer, stall_s=stall_s)
        live.join(self.viewer)
        wait_for(lambda: self.pictures)

    def _hear(self, message: dict[str, Any] | bytes) -> None:
        self.take(message)
        if isinstance(message, bytes) and message[0] == 1 and self.answers:
            self.viewer.was_shown(self.last.number)

    def do(self, name: str, /, **values: Any) -> None:
        self.live.do(self.viewer, read_command({"do": name, **values}))

    def refusal(self, count: int = 1) -> str:
        return str(wait_for(lambda: len(self.of_kind("refused")) >= count and self.of_kind("refused"))[-1]["message"])

    def has_column(self, expected: np.ndarray[Any, Any]) -> bool:
        """The last picture has these values of the robots, and none of the ball."""
        column = self.last.column
        return column is not None and np.array_equal(column[:12], expected) and bool(np.isnan(column[12]))


def assert_shows(picture: Picture, simulation: pogosim.Simulation, tolerance_mm: float) -> None:
    """The picture is that of the simulation now; codes have 16 bits."""
    robots = len(simulation.positions)
    np.testing.assert_allclose(picture.poses[:robots, :2], simulation.positions, atol=tolerance_mm)
    turn = picture.poses[:robots, 2] - simulation.headings
    np.testing.assert_allclose(np.cos(turn), 1.0, atol=1e-6)
    red, green, blue = simulation.leds[:, 0].astype(int).T
    assert picture.leds[:robots].tolist() == (red << 16 | green << 8 | blue).tolist()


def test_first_picture_is_that_of_the_run(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    assert watcher.last.time_s == 0.0
    assert_shows(watcher.last, sim, 0.02)
    head = watcher.head
    assert [own["name"] for own in head["categories"]] == ["robots", "ball"]
    assert len(head["objects"]) == 13
    assert (head["title"], head["periodic"]) == ("1\u00a0ball, 12\u00a0robots", False)
    assert watcher.last.leds[12] == 2**32 - 1  # the ball has none
    assert not watcher.status["playing"]


def test_steps_of_the_main_thread_are_seen(live: LiveRun, sim: pogosim.Simulation) -> None:
    """The array of positions in the next cell is that of the picture."""
    watcher = Watcher(live)
    sim.step(50)
    wait_for(lambda: watcher.last.time_s == sim.time)
    assert_shows(watcher.last, sim, 0.02)


def test_it_plays_at_the_speed_that_is_wanted_and_pauses(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    watcher.do("speed", value=0.5)
    watcher.do("play")
    began_s = time.monotonic()
    wait_for(lambda: sim.time >= 0.5)
    assert time.monotonic() - began_s >= 0.9  # never faster; slower on a busy machine
    live.pause()
    at = sim.steps
    time.sleep(0.2)
    assert sim.steps == at
    wait_for(lambda: watcher.last.time_s == sim.time)
    assert_shows(watcher.last, sim, 0.02)
    times = [picture.time_s for picture in watcher.pictures]
    assert times == sorted(times)


def test_played_run_has_the_bytes_of_one_without_viewers(hosted: Path, scene: Path, tmp_path: Path) -> None:
    file = tmp_path / "rows.feather"
    with pogosim.Simulation(hosted, scene, seed=4, data_file=file) as alone:
        alone.run()
        state = alone.state_hash
    expected = file.read_bytes()
    with pogosim.Simulation(hosted, scene, seed=4, data_file=file) as seen:
        live = LiveRun(seen)
        watchers = [Watcher(live) for _ in range(3)]
        watchers[0].do("select", object=2)
        watchers[1].do("columns", color_by="age", heat_map=None)
        watchers[0].do("speed", value=None)
        watchers[0].do("play")
        wait_for(lambda: seen.is_over)
        wait_for(lambda: watchers[2].status["over"])
        assert seen.state_hash == state
        live.end()
    assert file.read_bytes() == expected


def test_values_of_a_robot_are_told(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    sim.step(40)
    watcher.do("select", object=3)
    values = wait_for(lambda: watcher.of_kind("robot") and watcher.of_kind("robot")[-1]["values"])
    own = sim.user_data[3]
    assert values["age"] == own["age"]
    assert values["ticks"] == sim.ticks[3]
    assert (values["gain"], values["levels[1]"], values["estimate.mean"], values["name[0]"]) == (2.0, -3, 0.5, ord("a"))
    assert (values["estimate.known"], values["state"], values["light"]) == (True, 7, 100.0)
    assert "steps_of_all" in values  # its column
    watcher.do("select", object=12)  # the ball
    wait_for(lambda: watcher.of_kind("robot")[-1]["object"] == 12)
    assert watcher.of_kind("robot")[-1]["values"] == {}


def test_column_comes_with_frames(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    assert {"light", "speed", "messages_sent", "age", "gain", "steps_of_all"} <= set(watcher.head["columnNames"])
    assert "name" not in watcher.head["columnNames"]
    for name in ("age", "light", "age"):
        watcher.do("columns", color_by=name, heat_map=None)
        sim.step(7)
        wait_for(lambda: watcher.last.time_s == sim.time and watcher.last.column is not None)
        expected = sim.user_data["age"] if name == "age" else sim.light_levels
        wait_for(functools.partial(watcher.has_column, expected.astype(np.float32)))
    watcher.do("columns", color_by="age", heat_map="light")
    wait_for(lambda: watcher.last.heat is not None)
    heat = np.asarray(watcher.last.heat)
    np.testing.assert_array_equal(heat[:12], sim.light_levels.astype(np.float32))
    assert watcher.has_column(sim.user_data["age"].astype(np.float32))
    watcher.do("columns", color_by=None, heat_map=None)
    wait_for(lambda: watcher.last.column is None)
    watcher.do("columns", color_by="nothing", heat_map=None)
    assert "'nothing'" in watcher.refusal()


def test_robot_is_dragged_to_a_place_that_walls_leave_free(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    watcher.do("drag", object=0, x=500.0, y=300.0)
    wait_for(lambda: np.allclose(sim.positions[0], (500.0, 300.0)))
    wait_for(lambda: np.allclose(watcher.last.poses[0, :2], (500.0, 300.0), atol=0.02))
    watcher.do("drag", object=0, x=9000.0, y=300.0)
    wait_for(lambda: sim.positions[0][0] > 600.0)
    arena = np.array(watcher.head["polygons"][0])
    (left, top), (right, bottom) = arena.min(axis=0), arena.max(axis=0)
    radius, centre = (right - left) / 2.0, ((left + right) / 2.0, (top + bottom) / 2.0)
    assert np.hypot(*(sim.positions[0] - centre)) == pytest.approx(radius - 26.5, abs=5.0)
    for place in ({"object": 99, "x": 1, "y": 1}, {"object": -1, "x": 1, "y": 1}):
        watcher.do("drag", **place)
    assert wait_for(lambda: len(watcher.of_kind("refused")) == 2)


def test_parameters_and_lamps_are_set(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    (settings,) = watcher.of_kind("settings")
    assert settings["parameters"] == {"gain": 2.0, "flag": True, "inner.level": 3}
    watcher.do("set", name="gain", value=5.5)
    watcher.do("lamp", lamp=0, on=True, intensity=2.0)
    watcher.do("step", steps=3)
    wait_for(lambda: sim.steps == 3)
    assert set(sim.user_data["gain"].tolist()) == {5.5}
    assert set(sim.light_levels.tolist()) == {200.0}
    wait_for(lambda: watcher.of_kind("settings")[-1]["lamps"][0]["intensity"] == 2.0)
    watcher.do("set", name="name", value=1)
    assert "parameters.name" in watcher.refusal()
    watcher.do("lamp", lamp=7, on=True, intensity=1.0)
    assert "no lamp 7" in watcher.refusal(2)


def test_reset_starts_again_with_a_new_head(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    before = watcher.last.poses
    watcher.do("step", steps=30)
    wait_for(lambda: watcher.last.time_s > 0.2)
    watcher.do("reset", seed=9)
    wait_for(lambda: sim.seed == 9 and watcher.pictures and watcher.last.time_s == 0.0)
    assert_shows(watcher.last, sim, 0.02)
    assert not np.allclose(watcher.last.poses[:, :2], before[:, :2], equal_nan=True)
    sim.reset(3)  # by the notebook
    wait_for(lambda: watcher.of_kind("settings")[-1]["seed"] == 3)
    wait_for(lambda: watcher.pictures)
    assert_shows(watcher.last, sim, 0.02)


def test_restored_state_is_seen(hosted: Path, scene: Path) -> None:
    settings = {"enable_data_logging": False}
    with pogosim.Simulation(hosted, scene, set=settings) as simulation:
        live = LiveRun(simulation)
        watcher = Watcher(live)
        state = simulation.save()
        simulation.step(20)
        wait_for(lambda: watcher.last.time_s == simulation.time)
        simulation.restore(state)
        wait_for(lambda: watcher.last.time_s == 0.0)
        assert_shows(watcher.last, simulation, 0.02)
        live.end()


def test_end_of_the_run_is_told(live: LiveRun, sim: pogosim.Simulation) -> None:
    watcher = Watcher(live)
    sim.run()
    wait_for(lambda: watcher.status["over"])
    assert not watcher.status["playing"]
    watcher.do("play")
    assert "reset" in watcher.refusal()


def test_failure_of_the_program_is_told(hosted: Path, scene: Path) -> None:
    with pogosim.Simulation(hosted, scene, set={"parameters.fail_at_tick": 10}) as simulation:
        live = LiveRun(simulation)
        watcher = Watcher(live)
        live.play(math.inf)
        wait_for(lambda: watcher.status["problem"])
        assert "robot #1" in watcher.status["problem"]
        assert not watcher.status["playing"]
        assert isinstance(live.failure, pogosim.ProgramFailedError)
        watcher.do("reset")
        wait_for(lambda: watcher.last.time_s == 0.0)
        live.end()


def test_closed_simulation_is_told(sim: pogosim.Simulation) -> None:
    live = LiveRun(sim)
    watcher = Watcher(live)
    live.play()
    sim.close()
    wait_for(lambda: watcher.status["closed"])
    watcher.do("play")
    assert "closed" in watcher.refusal()
    live.end()


def test_reset_that_fails_is_told_and_can_be_tried_again(hosted: Path, scene: Path, tmp_path: Path) -> None:
    file = tmp_path / "rows.feather"
    with pogosim.Simulation(hosted, scene, data_file=file) as simulation:
        live = LiveRun(simulation)
        watcher = Watcher(live)
        moved = file.rename(tmp_path / "moved")
        file.mkdir()
        watcher.do("reset")
        wait_for(lambda: "rows.feather" in watcher.status["problem"])
        assert not watcher.status["closed"]
        assert isinstance(live.failure, pogosim.ConfigurationError)
        watcher.do("play")
        time.sleep(0.1)
        file.rmdir()
        watcher.do("reset", seed=5)
        wait_for(lambda: watcher.of_kind("settings")[-1]["seed"] == 5 and watcher.pictures)
        assert watcher.status["problem"] == ""
        assert live.failure is None
        assert moved.is_file()
        live.end()


def test_error_of_ours_is_told_and_ends_the_thread(
    live: LiveRun, sim: pogosim.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    watcher = Watcher(live)
    monkeypatch.setattr(live, "_look", lambda _: 1 / 0)
    sim.step(1)
    wait_for(lambda: not live.is_alive)
    assert "internal error: ZeroDivisionError" in watcher.status["problem"]
    assert watcher.status["closed"]


def test_simulation_that_is_not_kept_is_collected(hosted: Path, scene: Path) -> None:
    simulation = pogosim.Simulation(hosted, scene)
    live = LiveRun(simulation)
    live.play()
    time.sleep(0.1)
    del simulation
    gc.collect()
    wait_for(lambda: not live._thread.is_alive())


def test_viewer_that_does_not_answer_gets_no_more_frames(live: LiveRun, sim: pogosim.Simulation) -> None:
    silent, other = Watcher(live, answers=False), Watcher(live)
    for _ in range(4 * MOST_UNDER_WAY):
        sim.step(1)
        wait_for(lambda: other.last.time_s == sim.time)
    assert len(silent.pictures) == MOST_UNDER_WAY
    silent.viewer.was_shown(silent.last.number)
    silent.answers = True
    wait_for(lambda: silent.last.time_s == sim.time)  # the newest one, which had waited
    assert_shows(silent.last, sim, 0.02)


def test_viewer_of_a_busy_notebook_gets_frames_now_and_then(live: LiveRun, sim: pogosim.Simulation) -> None:
    silent = Watcher(live, answers=False, stall_s=0.05)
    for _ in range(3 * MOST_UNDER_WAY):
        sim.step(1)
        time.sleep(0.04)
    wait_for(lambda: silent.last.time_s == sim.time)
    assert len(silent.pictures) > MOST_UNDER_WAY
    assert_shows(silent.last, sim, 0.02)


def test_one_viewer_steers_at_a_time(sim: pogosim.Simulation) -> None:
    live = LiveRun(sim, one_steers=True)
    first, second, third = Watcher(live), Watcher(live), Watcher(live, may_steer=False)
    wait_for(lambda: first.status["viewers"] == 3)
    assert [own.status["steers"] for own in (first, second, third)] == [True, False, False]
    second.do("step", steps=1)
    assert "another viewer steers" in second.refusal()
    second.do("steer")
    wait_for(lambda: second.status["steers"] and not first.status["steers"])
    second.do("step", steps=1)
    wait_for(lambda: sim.steps == 1)
    third.do("steer")
    third.do("play")
    assert "looks on" in third.refusal(2)
    live.leave(second.viewer)
    wait_for(lambda: first.status["steers"])
    assert sim.steps == 1
    live.end()


def test_threads_of_the_user_and_the_view_take_turns(live: LiveRun, sim: pogosim.Simulation) -> None:
    """Without a view, a second thread that steps gets an error."""
    watcher = Watcher(live)
    live.play(0.2)
    made = []

    def step() -> None:
        for _ in range(30):
            made.append(sim.step(2))

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert len(made) == 60
    assert sum(made) <= sim.steps
    live.pause()
    wait_for(lambda: watcher.last.time_s == sim.time)
    assert_shows(watcher.last, sim, 0.02)


GOOD: dict[str, dict[str, Any]] = {
    "shown": {"frame": 3},
    "select": {"object": -1},
    "columns": {"color_by": None, "heat_map": None},
    "steer": {},
    "play": {},
    "pause": {},
    "step": {"steps": 10},
    "speed": {"value": 2.5},
    "drag": {"object": 1, "x": 2.0, "y": 3},
    "set": {"name": "gain", "value": True},
    "lamp": {"lamp": 0, "on": False, "intensity": 1.5},
    "reset": {},
}
BAD_VALUES: tuple[Any, ...] = (None, [], {}, "text", "", -5, 1e300, math.nan, math.inf, 2**70, "x" * 1000, True, 1.5)


def test_every_command_has_an_example() -> None:
    assert set(GOOD) == set(COMMANDS)
    for name, values in GOOD.items():
        assert read_command({"do": name, **values}).name == name


@pytest.mark.parametrize("name", GOOD)
def test_bad_values_of_commands_are_refused_or_within_their_range(name: str) -> None:
    for key in GOOD[name]:
        refused = 0
        for value in BAD_VALUES:
            try:
                read_command({"do": name, **GOOD[name], key: value})
            except RefusedError as error:
                refused += 1
                assert name in str(error)
                assert "\n" not in str(error)
        assert refused >= len(BAD_VALUES) - 3
        with pytest.raises(RefusedError):
            read_command({"do": name, **{own: value for own, value in GOOD[name].items() if own != key}})
    with pytest.raises(RefusedError):
        read_command({"do": name, **GOOD[name], "more": 1})


NONSENSE = (
    "",
    "{",
    "[]",
    "1",
    "null",
    '{"do": 1}',
    '{"do": "nothing"}',
    "[" * 1900,
    '{"do": "play", "x": 1}',
    b"x",
    5,
    None,
)


@pytest.mark.parametrize("message", [*NONSENSE, "x" * (MOST_CHARACTERS + 1)])
def test_messages_that_are_none_are_refused(message: Any) -> None:
    with pytest.raises(RefusedError):
        read_command(message)


def test_numbers_at_their_limits() -> None:
    assert read_command('{"do": "speed", "value": null}').values == {"value": None}
    assert read_command('{"do": "reset", "seed": 4294967295}').values == {"seed": 2**32 - 1}
    for text in ('{"do": "reset", "seed": 4294967296}', '{"do": "step", "steps": 0}', '{"do": "speed", "value": 0}'):
        with pytest.raises(RefusedError):
            read_command(text)


# ---- All that there is to be seen

CONFIGURATIONS = {"lighthouse_localization": "lighthouse", "walls": "walls_and_membranes"}
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*/*.so"))


@pytest.mark.parametrize("example", EXAMPLES)
def test_all_objects_of_examples_are_told(example: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    own = ROOT / "conf" / f"{CONFIGURATIONS.get(example, example)}.yaml"
    configuration = own if own.is_file() else ROOT / "conf" / "simple.yaml"
    settings = {"enable_data_logging": False}
    with pogosim.Simulation(ROOT / "examples" / example / f"{example}.so", configuration, set=settings) as simulation:
        simulation.step(20)
        live = LiveRun(simulation)
        watcher = Watcher(live)
        head, poses = watcher.head, watcher.last.poses
        low, high = np.array(head["poseBox"])
        assert len(head["objects"]) == len(simulation.objects)
        for (category, own_id), pose, told in zip(head["objects"], poses, simulation.objects, strict=True):
            assert (head["categories"][category]["name"], own_id) == (told.category, told.id)
            np.testing.assert_allclose(pose[:2], told.position, atol=max((high - low) / 6e4))
            if not head["categories"][category]["membrane"]:
                assert np.cos(pose[2] - told.heading) == pytest.approx(1.0, abs=1e-6)
        has_light = bool((simulation.light_map != simulation.light_map.flat[0]).any())
        assert wait_for(lambda: watcher.light is not None)
        assert watcher.light is not None
        assert not watcher.light.any() or has_light
        live.end()


def test_membranes_walls_and_links_are_told(hosted: Path, tmp_path: Path) -> None:
    membrane = {"type": "membrane", "nb": 1, "geometry": "disk", "radius": 150, "x": 900, "y": 900}
    scene = write_scene(
        tmp_path,
        {
            "arena_surface": 4.0e6,
            "objects.robots.nb": 3,
            "objects.skin": membrane,
            "objects.border": {"type": "pogowall", "geometry": "arena"},
        },
    )
    with pogosim.Simulation(hosted, scene) as simulation:
        simulation.link(0, 1, stiffness=5.0)
        live = LiveRun(simulation)
        watcher = Watcher(live)
        kinds = [watcher.head["categories"][category] for category, _ in watcher.head["objects"]]
        (group,) = watcher.head["membranes"]["groups"]
        assert kinds[group["object"]]["membrane"]
        assert group["count"] == watcher.head["membranes"]["dots"] > 10
        (wall,) = watcher.head["walls"]
        assert kinds[wall["object"]]["name"] == "border"
        assert len(wall["lines"][0]) > 3
        links = wait_for(lambda: watcher.of_kind("links"))[-1]["links"]
        assert (links["a"], links["b"], links["kind"], links["breaking"]) == ([0], [1], ["spring"], [None])
        assert links["stiffness"] == pytest.approx([5e-3])
        simulation.cut(0)
        wait_for(lambda: watcher.of_kind("links")[-1]["links"] is None)
        live.end()
