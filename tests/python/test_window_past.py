"""The window goes back in time, and pauses by a condition: its keys, its panel and its log."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from conftest import Compile
from display import Display, Picture, Shown, differ, shown, wait_for
from window_pictures import PLACES, settled

# Robots that drive in circles. No step is due for years: each is asked for.
SCENE: dict[str, object] = {
    "arena_file": "arenas/square.csv",
    "simulation_time": 1.0e4,
    "time_step": 0.05,
    "objects.robots.nb": 2,
    "objects.robots.poses": [[600, 300, 0], [700, 600, 1]],
    "GUI_speed_up": 1.0e-9,
}
WITHOUT_DATA: dict[str, object] = {**SCENE, "enable_data_logging": False}
BESIDE_PANELS = np.s_[:, 250:]
GO_ON = (115, 101)  # the button in the panel "Run"
CONDITION = (170, 479)  # the field, while the section "View" is open
INSPECTOR = np.s_[20:300, 660:700]  # some of the pixels of its panel, beside the time and the robots
FIELD = np.s_[469:490, 105:235]  # its pixels


def beside(picture: Picture) -> npt.NDArray[np.uint8]:
    return picture[BESIDE_PANELS]


def steps(window: Shown, count: int) -> list[Picture]:
    """Make steps one by one; returns the pictures before them and after each."""
    window.keys("space")
    pictures = [settled(window)]
    for number in range(count):
        window.keys("s")
        wait_to_see_another(window, pictures[-1], f"step {number}")
        pictures.append(settled(window))
    return pictures


def wait_to_see_another(window: Shown, before: Picture, what: str) -> None:
    window.wait_for_picture(lambda picture: differ(beside(picture), beside(before)), what)


def wait_to_see(window: Shown, wanted: Picture, what: str) -> None:
    window.wait_for_picture(lambda picture: not differ(beside(picture), beside(wanted)), what)


def click_into_condition(window: Shown) -> None:
    """What is typed afterwards goes into the field, whose cursor is seen; earlier keys are those of the window."""
    before = window.shot()
    window.click(*PLACES["header View"])
    window.wait_for_picture(lambda picture: differ(picture[FIELD], before[FIELD]), "the section")
    click_into_field(window)


def click_into_field(window: Shown) -> None:
    before = window.shot()
    window.click(*CONDITION)
    window.wait_for_picture(lambda picture: differ(picture[FIELD], before[FIELD]), "the field's cursor")


def test_moments_are_seen_again_and_the_run_goes_on_from_one(
    display: Display, program: Compile, tmp_path: Path
) -> None:
    with shown(display, program("hosted.c"), tmp_path, WITHOUT_DATA) as window:
        seen = steps(window, 4)
        for key, moment in (("comma", 3), ("comma", 2), ("period", 3), ("End", 4), ("comma", 3), ("comma", 2)):
            window.keys(key)
            wait_to_see(window, seen[moment], f"moment {moment} after {key}")
        window.click(*GO_ON)
        wait_for(lambda: "went back to t = 0.0" in window.text(), "the way back")
        wait_to_see(window, seen[2], "the run at that moment")
        for moment in (3, 4):
            window.keys("s")
            wait_to_see(window, seen[moment], f"the same step {moment} again")


def test_run_with_a_data_file_cannot_go_back(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, SCENE) as window:
        seen = steps(window, 2)
        window.keys("comma")
        wait_to_see(window, seen[1], "the moment before")
        looking_back = settled(window)
        window.click(*GO_ON)  # a button that is off
        window.keys("End")
        wait_to_see(window, seen[2], "the newest moment")
        assert differ(looking_back[:, :250], seen[1][:, :250])  # the reason is in the panel


def test_run_pauses_when_a_condition_becomes_true(display: Display, window_program: Path, tmp_path: Path) -> None:
    settings = {**WITHOUT_DATA, "GUI_speed_up": 1.0, "view.pause_when": "x > 640 and x < 690 and speed > 1"}
    with shown(display, window_program, tmp_path, settings) as window:
        wait_for(lambda: "paused at t = " in window.text(), "the pause")
        assert "robot 0: x = 64" in window.text()
        before = settled(window)
        assert not differ(settled(window), before)


def test_condition_is_typed_into_the_panel(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, {**WITHOUT_DATA, "GUI_speed_up": 1.0}) as window:
        click_into_condition(window)
        window.keys("s", "p", "e", "e", "d", "space", "greater", "l", "BackSpace", "1", "Return")
        wait_for(lambda: "paused at t = " in window.text(), "the pause")
        assert "robot 0: speed = " in window.text()


def test_condition_that_makes_no_sense_is_told(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, WITHOUT_DATA) as window:
        click_into_condition(window)
        window.keys("l", "Return")
        wait_for(lambda: "pause_when: " in window.text(), "what is wrong")


def test_keys_edit_the_condition(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, WITHOUT_DATA) as window:
        click_into_condition(window)
        window.keys("a", "b", "c", "Home", "Delete", "x", "Return")
        wait_for(lambda: "'xbc', character 1: there is no value 'xbc'" in window.text(), "the first name")
        click_into_field(window)
        window.keys("ctrl+a", "n", "Return")
        wait_for(lambda: "'n', character 1: there is no value 'n'" in window.text(), "the second name")


def test_values_of_a_robot_that_is_selected_later_are_not_those_of_the_past(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, WITHOUT_DATA) as window:
        seen = steps(window, 2)
        height, width = seen[-1].shape[:2]
        scale = 0.95 * min(width, height) / 1000
        window.click(width / 2 + 100 * scale, height / 2 - 200 * scale)  # robot 0, which has hardly moved
        window.wait_for_picture(lambda picture: differ(picture[INSPECTOR], seen[-1][INSPECTOR]), "the inspector")
        window.keys("comma")
        window.wait_for_picture(lambda picture: not differ(picture[INSPECTOR], seen[-1][INSPECTOR]), "no inspector")
        window.keys("End")
        window.wait_for_picture(lambda picture: differ(picture[INSPECTOR], seen[-1][INSPECTOR]), "the inspector")
