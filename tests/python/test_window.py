"""The window on a real display: keys, mouse, panels, and what happens when the display is not there or goes away."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from display import Display, Picture, Shown, differ, ended, forwarded, open_display, pixel_of, shown, wait_for
from PIL import Image
from running import Run, build_folder, run, run_command, write_scene
from window_pictures import FOLDER, PICTURES, PLACES, difference, settled, take

# The first step is not due for years: the window shows time 0.
STILL: dict[str, object] = {"GUI_speed_up": 1.0e-6, "simulation_time": 10.0}
LONG: dict[str, object] = {"simulation_time": 1.0e4, "GUI_speed_up": 1.0}
# Four robots in a square of 1 m, at 0.76 pixels per mm: their pixels are known. Two of them hear each other.
FOUR: dict[str, object] = {
    "arena_file": "arenas/square.csv",
    "objects.robots.nb": 4,
    "objects.robots.poses": [[250, 250, 0], [340, 250, 1], [250, 750, 2], [600, 750, 3]],
}
FLOOR = (0x12, 0x15, 0x1C)
RED = (210, 0, 0)


def colour_at(picture: Picture, x_mm: float, y_mm: float) -> tuple[int, ...]:
    x, y = pixel_of(x_mm, y_mm)
    return tuple(int(value) for value in picture[round(y), round(x)])


def press(window: Shown, key: str, what: str) -> Picture:
    """Press a key that changes the picture; return the new one."""
    before = window.shot()
    window.keys(key)
    return window.wait_for_picture(lambda picture: differ(picture, before), what)


def test_window_changes_no_byte_of_the_data_file(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {"simulation_time": 100.0, "objects.robots.nb": 20}
    settings |= {"GUI": True, "GUI_speed_up": 100.0}
    run(window_program, tmp_path / "alone", settings)
    with shown(display, window_program, tmp_path / "shown", settings, ["--close-at-end"]) as window:
        window.keys("F2", "F5", "F7", "F4", "F3", "F6", "F8", "F9", "F1")
        assert window.end()[0] == 0
    alone = (tmp_path / "alone/data.feather").read_bytes()
    assert (tmp_path / "shown/data.feather").read_bytes() == alone


def test_window_has_the_size_and_the_title_of_the_configuration(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**STILL, "window_width": 640, "window_height": 480}) as window:
        assert window.size() == (640, 480)
        assert "Pogosim v" in display.xdotool("getwindowname", window.window)


def test_robots_are_drawn_where_they_are_in_the_colour_of_their_led(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        window.keys("F9")  # no panels
        picture = window.wait_for_picture(lambda picture: colour_at(picture, 240, 240) == RED, "a red robot")
        assert colour_at(picture, 330, 250) == (0, 210, 0)
        assert colour_at(picture, 250, 740) == (0, 0, 210)
        assert colour_at(picture, 500, 500) == FLOOR


@pytest.mark.parametrize(
    "key", ["F1", "F2", "F5", "F6", "F7", "F8", "F9", "plus", "minus", "KP_Add", "KP_Subtract", *"lvdt"]
)
def test_key_changes_the_picture(display: Display, window_program: Path, tmp_path: Path, key: str) -> None:
    # A light that is not even, and robots that have left trails.
    lamp = {"type": "static_light", "geometry": "disk", "radius": 200, "value": 1000, "x": 500, "y": 500}
    settings = {**LONG, **FOUR, "objects.lamp": lamp, "show_trajectory_traces": True}
    with shown(display, window_program, tmp_path, settings) as window:
        time.sleep(0.5)
        window.keys("space")
        time.sleep(0.5)
        before = window.shot()
        after = press(window, key, f"an effect of {key}")
        if key not in ("plus", "minus", "KP_Add", "KP_Subtract", "F5", "F2"):
            window.keys(key)
            window.wait_for_picture(lambda picture: not differ(picture, before), f"{key} to undo itself")
        assert differ(before, after)


def test_pause_holds_the_time_and_s_advances_one_step(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR, "save_data_period": 0.01}) as window:
        window.keys("space")
        time.sleep(0.5)
        before = window.shot()
        time.sleep(0.5)
        assert not differ(window.shot(), before)
        press(window, "s", "a step")
        press(window, "S", "another step")
        time.sleep(0.3)
        ended(window)
    times = np.unique(Run(0, "", "", tmp_path).frame()["time"])
    assert np.allclose(np.diff(times), 0.01, atol=1e-6)


def test_zero_shows_the_whole_arena_again(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        window.keys("F9")
        time.sleep(0.4)
        start = window.shot()
        window.keys("plus", "plus", "Left", "Up", "KP_6")
        window.wait_for_picture(lambda picture: differ(picture, start), "another view")
        window.drag((300, 300), (500, 350), button=3)
        window.keys("0")
        window.wait_for_picture(lambda picture: not differ(picture, start), "the whole arena")


def test_wheel_zooms_around_the_mouse(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        window.keys("F9")
        x, y = pixel_of(240, 240)
        window.move_mouse(x, y)
        time.sleep(0.3)
        before = window.shot()
        for _ in range(6):
            display.xdotool("click", "4")

        def red_length(picture: Picture) -> int:
            """Pixels of the red chord through the place of the mouse."""
            is_red = (picture[round(y)] == RED).all(axis=-1)
            left = np.flatnonzero(~is_red[: round(x)])[-1]
            right = round(x) + np.flatnonzero(~is_red[round(x) :])[0]
            return int(right - left)

        wanted = 1.1**6 * red_length(before)
        picture = window.wait_for_picture(lambda picture: abs(red_length(picture) - wanted) < 3, "a closer view")
        assert tuple(picture[round(y), round(x)]) == RED


def test_right_drag_moves_the_view_with_the_mouse(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        window.keys("F9")
        x, y = pixel_of(240, 240)
        window.drag((400, 300), (500, 380), button=3)
        window.wait_for_picture(lambda picture: tuple(picture[round(y) + 80, round(x) + 100]) == RED, "a moved view")


def test_resized_window_shows_the_whole_arena(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        for width, height in ((500, 900), (1200, 300), (40, 40), (1, 1), (640, 640)):
            display.xdotool("windowsize", window.window, str(width), str(height))
            time.sleep(0.3)
        window.keys("F9")
        scale = 0.95 * 640 / 1000
        pixel = round(320 + (240 - 500) * scale)
        window.wait_for_picture(lambda picture: tuple(picture[pixel, pixel]) == RED, "the robot in the smaller picture")
        ended(window)


def test_click_selects_a_robot_and_calls_its_callback(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR, "parameters.drives": False}) as window:
        before = window.shot()
        window.click(*pixel_of(250, 250))
        window.wait_for_picture(lambda picture: differ(picture, before), "the inspector")
        time.sleep(0.3)
        window.click(*pixel_of(250, 250))  # deselects
        time.sleep(0.3)
        window.click(*pixel_of(250, 250))
        time.sleep(0.5)
        text = ended(window)
    assert [line.split("] ", 2)[-1] for line in text.splitlines() if "clicked" in line] == [
        "[ROBOT #0] [PRINTF] clicked 1 times",
        "[ROBOT #0] [PRINTF] clicked 2 times",
    ]
    table = Run(0, "", "", tmp_path).table()
    assert b"touched" in table.schema.metadata


def test_dragged_robot_is_where_it_was_dropped(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "parameters.drives": False, "save_data_period": 0.01}
    with shown(display, window_program, tmp_path, settings) as window:
        window.drag(pixel_of(250, 250), pixel_of(450, 500))
        time.sleep(0.3)
        ended(window)
    result = Run(0, "", "", tmp_path)
    rows = result.frame()
    last = rows[rows["robot_id"] == 0].iloc[-1]
    assert (last["x"], last["y"]) == pytest.approx((450, 500), abs=3)
    others = rows[rows["robot_id"] != 0].groupby("robot_id")[["x", "y"]]
    assert (others.last() - others.first()).abs().to_numpy().max() < 0.1
    assert b"touched" in result.table().schema.metadata


def test_robot_cannot_be_dragged_out_of_the_arena(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "parameters.drives": False, "save_data_period": 0.01}
    with shown(display, window_program, tmp_path, settings) as window:
        window.drag(pixel_of(250, 250), (2, 2))
        time.sleep(0.3)
        ended(window)
    rows = Run(0, "", "", tmp_path).frame()
    assert rows[["x", "y"]].to_numpy().min() > 26
    assert rows[["x", "y"]].to_numpy().max() < 974


def test_untouched_run_says_nothing_of_touching(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}) as window:
        window.click(*pixel_of(500, 500))  # the floor
        window.drag(pixel_of(500, 500), pixel_of(600, 600))
        ended(window)
    assert b"touched" not in Run(0, "", "", tmp_path).table().schema.metadata


@pytest.mark.parametrize(("key", "seed"), [("r", 1), ("R", 2)])
def test_restart_begins_again_with_the_same_or_the_next_seed(
    display: Display, window_program: Path, tmp_path: Path, key: str, seed: int
) -> None:
    # Initial poses are drawn from the seed.
    settings: Mapping[str, object] = {**STILL, "objects.robots.nb": 10}
    with shown(display, window_program, tmp_path / "shown", settings) as window:
        window.keys("shift+r" if key == "R" else key, "k")
        wait_for(lambda: f"restarted with seed {seed}" in window.text(), "the restart")
        window.find_window()
        ended(window)
    run(window_program, tmp_path / "alone", {**settings, "seed": seed, "simulation_time": 0.0})
    poses = [Run(0, "", "", tmp_path / name).frame()[["x", "y", "angle"]] for name in ("shown", "alone")]
    assert poses[0].equals(poses[1])


def test_closing_the_window_ends_the_run_with_complete_data(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}) as window:
        display.close(window.window)
        code, text = window.end()
    assert code == 0, text
    assert len(Run(0, "", "", tmp_path).table()) >= 4


def test_window_answers_while_user_code_is_busy(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "parameters.busy_ms": 5000, "parameters.busy_at": 1}
    with shown(display, window_program, tmp_path, settings) as window:
        press(window, "F1", "the help")
        ended(window)
        # It could not have been shown later: nothing moves on before the step is over.


def test_closing_ends_a_step_that_never_returns(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "parameters.busy_ms": 100_000_000, "parameters.busy_at": 1, "user_code_timeout": 1.0}
    with shown(display, window_program, tmp_path, settings) as window:
        window.keys("Escape")
        code, text = window.end()
    assert code in (3, 130), text
    assert len(Run(0, "", "", tmp_path).table()) == 4


def test_restarted_window_shows_what_the_one_before_showed(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    lamp = {"type": "static_light", "geometry": "disk", "radius": 200, "value": 1000, "x": 500, "y": 500}
    settings = {**STILL, **FOUR, "objects.lamp": lamp, "window_width": 500}
    with shown(display, window_program, tmp_path, settings) as window:
        display.xdotool("windowsize", window.window, "620", "640")
        window.keys("F5", "F5", "F6", "F7", "F8", "plus", "Right", "space")
        before = settled(window)
        window.keys("r", "k")
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")
        window.find_window()
        assert not differ(settled(window), before)


def test_restart_finds_its_files_when_the_program_has_left_its_folder(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR, "parameters.leaves_folder": True}) as window:
        window.keys("r", "k")
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")
        window.find_window()


def test_run_goes_on_when_it_cannot_be_restarted(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}) as window:
        (tmp_path / "scene.yaml").write_text("simulation_time: ten\n")
        window.keys("r")
        wait_for(lambda: "cannot restart: scene.yaml:1" in window.text(), "the reason")
        (tmp_path / "scene.yaml").unlink()
        window.keys("R")
        wait_for(lambda: "'scene.yaml' is not a file that can be read again" in window.text(), "the reason")
        seen = window.shot()
        wait_for(lambda: differ(window.shot(), seen), "the run to go on")
        ended(window)
    assert len(Run(0, "", "", tmp_path).table()) > 4


def test_restart_ends_a_step_that_never_returns(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "parameters.busy_ms": 100_000_000, "parameters.busy_at": 1, "user_code_timeout": 1.0}
    with shown(display, window_program, tmp_path, settings) as window:
        window.keys("r", "k")
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")


def test_ctrl_c_while_the_files_of_a_run_are_completed_prevents_its_restart(
    display: Display, window_program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow = tmp_path / "bin" / "ffmpeg"  # takes its time at the end of a film
    slow.parent.mkdir()
    slow.write_text(f"#!/bin/sh\n'{shutil.which('ffmpeg')}' \"$@\"\ncode=$?\ntouch completing\nsleep 4\nexit $code\n")
    slow.chmod(0o755)
    monkeypatch.setenv("PATH", f"{slow.parent}:{os.environ['PATH']}")
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}, ["--video", "run.mp4"]) as window:
        window.keys("r", "k")
        wait_for((tmp_path / "completing").exists, "the end of the film")
        window.process.send_signal(2)
        code, text = window.end()
    assert code == 130, text
    assert "restarted" not in text
    assert (tmp_path / "run.mp4").exists()
    assert len(Run(0, "", "", tmp_path).table()) > 0


def test_window_stays_open_at_the_end_with_complete_data(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**FOUR, "simulation_time": 1.0, "GUI_speed_up": 0}) as window:
        wait_for(lambda: "over at t = 1.0000 s; the window stays open" in window.text(), "the end")
        data = (tmp_path / "data.feather").read_bytes()
        assert data.endswith(b"ARROW1")
        assert window.process.poll() is None
        time.sleep(0.5)
        before = window.shot()
        press(window, "F2", "trails of where robots have been")
        window.keys("F2")
        window.wait_for_picture(lambda picture: not differ(picture, before), "no trails")
        press(window, "space", "the word that the run is over")
        window.keys("F12")
        wait_for((tmp_path / "screenshot-001.png").exists, "the screenshot")
        ended(window)
    assert (tmp_path / "data.feather").read_bytes() == data


def test_closing_the_window_after_the_end_says_nothing_of_an_early_end(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, {**FOUR, "simulation_time": 0.5, "GUI_speed_up": 0}) as window:
        wait_for(lambda: "the window stays open" in window.text(), "the end")
        display.close(window.window)
        code, text = window.end()
    assert code == 0, text
    assert "by closing the window" not in text


def test_ctrl_c_after_the_end_closes_the_window(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**FOUR, "simulation_time": 0.5, "GUI_speed_up": 0}) as window:
        wait_for(lambda: "the window stays open" in window.text(), "the end")
        window.process.send_signal(2)
        code, text = window.end()
    assert code == 0, text


@pytest.mark.parametrize(("key", "files"), [("k", ["data.1.feather", "data.feather"]), ("o", ["data.feather"])])
def test_restart_asks_what_becomes_of_the_finished_file(
    display: Display, window_program: Path, tmp_path: Path, key: str, files: list[str]
) -> None:
    with shown(display, window_program, tmp_path, {**FOUR, "simulation_time": 0.5, "GUI_speed_up": 0}) as window:
        wait_for(lambda: "the window stays open" in window.text(), "the end")
        first = (tmp_path / "data.feather").read_bytes()
        press(window, "r", "the question")
        time.sleep(0.3)
        assert "restarted" not in window.text()
        window.keys(key)
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")
        wait_for(lambda: window.text().count("the window stays open") == 2, "the second end")
        window.find_window()
        ended(window)
    assert sorted(path.name for path in tmp_path.glob("*.feather")) == files
    assert (tmp_path / files[0]).read_bytes() == first


def test_restart_can_be_thought_better_of(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}) as window:
        window.keys("r")
        time.sleep(0.3)
        window.keys("Escape")
        time.sleep(0.3)
        assert window.process.poll() is None
        assert "restarted" not in ended(window)


def test_watching_a_run_again_keeps_the_file_of_the_first_time(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    settings = {**FOUR, "simulation_time": 0.5, "GUI_speed_up": 0}
    run(window_program, tmp_path, settings)
    first = (tmp_path / "data.feather").read_bytes()
    for number in (1, 2):
        with shown(display, window_program, tmp_path, settings) as window:
            wait_for(lambda: "the window stays open" in window.text(), "the end")
            text = ended(window)
        assert f"'data.feather' of an earlier run is now 'data.{number}.feather'" in text
    assert (tmp_path / "data.1.feather").read_bytes() == first
    run(window_program, tmp_path, settings)  # without a window it is overwritten
    assert len(list(tmp_path.glob("*.feather"))) == 3


def test_run_that_cannot_start_leaves_the_file_of_the_first_time(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    settings = {**FOUR, "simulation_time": 0.5}
    run(window_program, tmp_path, settings)
    before = sorted((path.name, path.read_bytes()) for path in tmp_path.glob("*.feather"))
    write_scene(tmp_path, {**settings, "GUI": True, "objects.robots.nb": 10000})
    command = [str(window_program), "-c", "scene.yaml", "--close-at-end"]
    result = subprocess.run(
        command, cwd=tmp_path, env=display.environment, capture_output=True, text=True, check=False, timeout=120
    )
    assert result.returncode == 2
    assert "of an earlier run is now" not in result.stdout + result.stderr
    assert sorted((path.name, path.read_bytes()) for path in tmp_path.glob("*.feather")) == before


def test_screenshot_shows_what_the_window_shows(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**STILL, **FOUR}) as window:
        time.sleep(0.5)
        seen = window.shot()
        window.keys("F12")
        file = tmp_path / "screenshot-001.png"
        wait_for(file.exists, "the screenshot")
        with Image.open(file) as picture:
            assert not differ(np.asarray(picture.convert("RGB")), seen)
        assert "screenshot-001.png" in ended(window)


def test_run_goes_on_when_the_display_goes_away(window_program: Path, tmp_path: Path) -> None:
    settings = {**FOUR, "simulation_time": 4.0, "GUI_speed_up": 1.0}
    with open_display() as display, shown(display, window_program, tmp_path, settings) as window:
        display.go_away()
        code, text = window.end()
    assert code == 0, text
    assert "the display is gone" in text
    assert Run(0, "", "", tmp_path).frame()["time"].max() == pytest.approx(4.0)


def test_window_is_not_black_through_ssh(display: Display, window_program: Path, tmp_path: Path) -> None:
    """The X server has the extension for shared memory, and refuses its use."""
    with (
        forwarded(display) as remote,
        shown(remote, window_program, tmp_path, {**LONG, **FOUR}) as window,
    ):
        assert len(np.unique(window.shot().reshape(-1, 3), axis=0)) > 10
        ended(window)


def test_without_a_display_the_run_goes_on_without_a_window(window_program: Path, tmp_path: Path) -> None:
    write_scene(tmp_path, {"GUI": True, "GUI_speed_up": 0.001})
    result = run_command(window_program, tmp_path, ["-c", "scene.yaml"])
    assert result.code == 0
    assert "no window: there is no display" in result.text
    assert "docs/displays.md" in result.text
    assert result.frame()["time"].max() == pytest.approx(2.0)


@pytest.mark.parametrize("name", [":4242", "nonsense"])
def test_display_that_cannot_be_reached_is_none(window_program: Path, tmp_path: Path, name: str) -> None:
    write_scene(tmp_path, {"GUI": True, "GUI_speed_up": 0.001})
    done = subprocess.run(
        [str(window_program), "-c", "scene.yaml"],
        cwd=tmp_path,
        env={**os.environ, "DISPLAY": name},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "the run has no window: the display" in done.stdout + done.stderr


def test_long_run_with_the_plot_does_not_end_early(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**LONG, **FOUR, "save_data_period": 0.01, "GUI_speed_up": 0, "simulation_time": 300.0}
    with shown(display, window_program, tmp_path, settings, ["--close-at-end"]) as window:
        window.click(*PLACES["header View"])
        time.sleep(0.3)
        window.click(*PLACES["plot"])
        assert window.end()[0] == 0, window.text()


def test_ctrl_c_ends_a_paused_run(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**LONG, **FOUR}) as window:
        window.keys("space")
        window.process.send_signal(2)
        code, text = window.end()
    assert code == 130, text
    assert len(Run(0, "", "", tmp_path).table()) >= 4


def test_library_needs_nothing_of_sdl() -> None:
    """The window is in a module of its own, which only a run with a window loads."""
    library = build_folder() / "src" / "libpogosim.so"
    needed = subprocess.run(["ldd", str(library)], capture_output=True, text=True, check=True).stdout
    assert "SDL" not in needed
    assert "X11" not in needed


def test_libraries_are_not_looked_for_in_the_working_folder() -> None:
    """An empty entry of the path within a library stands for it."""
    folder = build_folder() / "src"
    for file in [*folder.glob("*.so"), folder / "pogosim-without-program"]:
        said = subprocess.run(["readelf", "-d", str(file)], capture_output=True, text=True, check=True).stdout
        for path in re.findall(r"\(R(?:UN)?PATH\).*\[(.*)\]", said):
            assert all(entry.startswith(("/", "$ORIGIN")) for entry in path.split(":")), f"{file}: {path}"


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_window_looks_as_in_the_stored_picture(
    display: Display, window_program: Path, tmp_path: Path, name: str
) -> None:
    seen = take(display, window_program, tmp_path, name)
    with Image.open(FOLDER / f"{name}.png") as stored:
        share = difference(seen, np.asarray(stored))
    Image.fromarray(seen).save(tmp_path / f"{name}.png")
    assert share < 5e-5, f"{share:.4%} of the pixels of {tmp_path / name}.png differ from {FOLDER / name}.png"
