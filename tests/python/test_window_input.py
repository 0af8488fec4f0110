"""What keys, mouse, buttons and switches of the window do, seen in its picture and in the data file."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from display import Display, Picture, Shown, differ, ended, pixel_of, shown, wait_for
from running import Run
from window_pictures import PLACES, settled

# Beside the panels: a red robot, and a green and a blue one that hear each other, with a lamp between those.
SCENE: dict[str, object] = {
    "arena_file": "arenas/square.csv",
    "simulation_time": 1.0e4,
    "save_data_period": 0.01,
    "show_lateral_LEDs": False,
    "objects.robots.nb": 3,
    "objects.robots.poses": [[500, 700, 0], [700, 700, 1], [700, 820, 2]],
    "objects.robots.communication_radius": 150,
    "objects.lamp": {
        "type": "static_light",
        "geometry": "disk",
        "radius": 150,
        "value": 1000,
        "light_mode": "gradient",
        "x": 700,
        "y": 760,
    },
}
# The first step is not due for years: the window shows time 0.
STILL: dict[str, object] = {**SCENE, "GUI_speed_up": 1.0e-6}
RUNNING: dict[str, object] = {**SCENE, "GUI_speed_up": 1.0}

FLOOR = (0x12, 0x15, 0x1C)
RED, GREEN = (210, 0, 0), (0, 210, 0)
LAMP = (0xFF, 0xD1, 0x66)

# Pixels of the panel "Run".
BUTTONS = {"pause": (52, 49), "step": (111, 49), "restart": (165, 49), "fastest": (168, 101), "max": (187, 101)}
SWITCHES = {
    "trails": (30, 193),
    "channels": (64, 219),
    "lateral LEDs": (30, 245),
    "light levels": (30, 271),
    "time and scale bar": (30, 297),
}
LAYERS = {"below": (43, 265), "above": (43, 285)}  # of channels, in the list that opens
ASIDE = (790, 400)  # over nothing

# Parts of the picture: rows, then columns.
SPEED = np.s_[91:113, 16:240]
TIME = np.s_[10:28, 715:790]
BESIDE_PANELS = np.s_[:, 250:]


def centre_of(picture: Picture, colour: tuple[int, int, int]) -> npt.NDArray[np.float64]:
    """Mean place (x, y) of the pixels of a colour; far away when there are none."""
    rows, columns = np.nonzero((picture == colour).all(axis=-1))
    return np.array([columns.mean(), rows.mean()]) if len(rows) else np.array([-1.0e6, -1.0e6])


def recorded_times(folder: Path) -> npt.NDArray[np.float64]:
    """Times at which the data file has rows, in steps of 0.01 s."""
    return np.unique(Run(0, "", "", folder).frame()["time"])


def with_panel(window: Shown) -> Picture:
    """Wait until the panel is there with all its lines."""
    lines = np.s_[41:57, 20:80], np.s_[160:176, 20:80]
    return window.wait_for_picture(lambda picture: all(picture[line].max() > 200 for line in lines), "a panel")


def opened(window: Shown) -> Picture:
    """Wait until the panel is there, and the picture stays the same."""
    with_panel(window)
    return settled(window)


def hide_panels(window: Shown) -> Picture:
    """Wait until only the floor is where the panel was."""
    opened(window)
    window.keys("F9")
    window.wait_for_picture(lambda picture: (picture[40:180, 40:240] == FLOOR).all(), "no panels")
    return settled(window)


def wait_for_centre(window: Shown, colour: tuple[int, int, int], place: npt.NDArray[np.float64], what: str) -> None:
    """Wait until a robot of a colour is at a pixel."""
    window.wait_for_picture(lambda picture: np.abs(centre_of(picture, colour) - place).max() < 1.0, what)


def open_switches(window: Shown) -> Picture:
    """Open the section View of the panel."""
    opened(window)
    window.click(*PLACES["header View"])
    window.wait_for_picture(lambda picture: picture[290:305, 50:160].max() > 200, "the switches")
    return settled(window)


def act(window: Shown, what: str, act: Callable[[], object], part: tuple[slice, slice]) -> Picture:
    """Do something, and wait until a part of the picture has changed and all of it stays the same."""
    before = settled(window)
    act()
    window.wait_for_picture(lambda picture: differ(picture[part], before[part]), what)
    return settled(window)


def test_each_key_of_the_view_moves_it_by_its_share(display: Display, window_program: Path, tmp_path: Path) -> None:
    """A key, and where it puts a point: the distance to the middle is scaled, then moved."""
    moves = {
        "Left": (1.0, (40, 0)),
        "Up": (1.0, (0, 40)),
        "Right": (1.0, (-40, 0)),
        "Down": (1.0, (0, -40)),
        "plus": (1.1, (0, 0)),
        "minus": (1 / 1.1, (0, 0)),
        "equal": (1.1, (0, 0)),
        "underscore": (1 / 1.1, (0, 0)),
    }
    keypad = {"KP_4": "Left", "KP_8": "Up", "KP_6": "Right", "KP_2": "Down", "KP_Add": "plus", "KP_Subtract": "minus"}
    moves |= {key: moves[same] for key, same in keypad.items()}
    with shown(display, window_program, tmp_path, STILL) as window:
        start = hide_panels(window)
        middle = np.array([400.0, 400.0])
        place = centre_of(start, GREEN)
        for key, (factor, motion) in moves.items():
            place = middle + factor * (place - middle) + motion
            window.keys(key)
            wait_for_centre(window, GREEN, place, f"{key} to move the view")
        for key in ("0", "KP_0"):
            window.keys("plus", "Left")
            window.wait_for_picture(lambda picture: differ(picture, start), "another view")
            window.keys(key)
            window.wait_for_picture(lambda picture: not differ(picture, start), f"{key} to show the whole arena")


@pytest.mark.parametrize("button", [2, 3])
def test_dragged_view_moves_as_far_as_the_mouse(
    display: Display, window_program: Path, tmp_path: Path, button: int
) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        start = centre_of(settled(window), GREEN)
        for motion in ((-130, -70), (60, 20)):
            window.drag((500, 500), (500 + motion[0], 500 + motion[1]), button=button)
            start = start + motion
            wait_for_centre(window, GREEN, start, "a moved view")
        # With the button up, the mouse moves nothing.
        window.move_mouse(300, 500)
        assert np.abs(centre_of(settled(window), GREEN) - start).max() < 1.0


def test_wheel_zooms_by_a_tenth_and_keeps_the_point_under_the_mouse(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        start = centre_of(settled(window), GREEN)
        mouse = np.array([620.0, 400.0])
        window.move_mouse(*mouse)
        for button, factor in (("4", 1.1), ("4", 1.1**2), ("5", 1.1), ("5", 1.0), ("5", 1 / 1.1)):
            display.xdotool("click", button)
            wait_for_centre(window, GREEN, mouse + factor * (start - mouse), "a zoomed view")


def test_wheel_and_buttons_over_a_panel_leave_the_view_alone(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        window.move_mouse(*ASIDE)
        start = centre_of(opened(window), GREEN)
        x, y = BUTTONS["step"]
        act(window, "the button to light up", lambda: window.move_mouse(x, y), np.s_[40:60, :246])
        display.xdotool("click", "4")
        window.drag((x, y), (x + 100, y + 20), button=3)
        assert np.abs(centre_of(settled(window), GREEN) - start).max() < 0.01


@pytest.mark.parametrize(("key", "start", "factor"), [("F3", 0.04, 0.8), ("F4", 0.002, 1.2)])
def test_each_press_of_a_speed_key_multiplies_the_speed(
    display: Display, window_program: Path, tmp_path: Path, key: str, start: float, factor: float
) -> None:
    """The panel then shows what it shows in a run that began with that speed."""
    presses = 12
    wanted_speed = start * factor**presses
    with shown(display, window_program, tmp_path / "wanted", {**STILL, "GUI_speed_up": wanted_speed}) as window:
        wanted = with_panel(window)[SPEED]
    with shown(display, window_program, tmp_path / "seen", {**STILL, "GUI_speed_up": start}) as window:
        assert differ(with_panel(window)[SPEED], wanted)
        window.keys(*[key] * presses)
        window.wait_for_picture(lambda picture: not differ(picture[SPEED], wanted), "the speed")
        time.sleep(0.3)
        assert not differ(window.shot()[SPEED], wanted)


def test_faster_key_lets_the_time_pass(display: Display, window_program: Path, tmp_path: Path) -> None:
    """A thousandth of real time becomes more than a thousand times real time: the run ends by itself."""
    settings = {**STILL, "GUI_speed_up": 1.0e-3, "simulation_time": 20.0, "save_data_period": 1.0}
    with shown(display, window_program, tmp_path, settings, ["--close-at-end"]) as window:
        window.keys(*["F4"] * 80)
        code, text = window.end()
    assert code == 0, text
    assert recorded_times(tmp_path).max() == pytest.approx(20.0)


@pytest.mark.parametrize("place", ["max", "fastest"])
def test_speed_of_the_panel_lets_the_time_pass(
    display: Display, window_program: Path, tmp_path: Path, place: str
) -> None:
    settings = {**STILL, "simulation_time": 20.0, "save_data_period": 1.0}
    with shown(display, window_program, tmp_path, settings, ["--close-at-end"]) as window:
        window.click(*BUTTONS[place])
        code, text = window.end()
    assert code == 0, text
    assert recorded_times(tmp_path).max() == pytest.approx(20.0)


@pytest.mark.parametrize("way", ["s", "S", "button"])
def test_each_press_of_step_is_one_step(display: Display, window_program: Path, tmp_path: Path, way: str) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:

        def step() -> None:
            if way == "button":
                window.click(*BUTTONS["step"])
            else:
                window.keys("shift+s" if way == "S" else way)

        for _ in range(3):
            act(window, "a step", step, TIME)
        ended(window)
    assert np.allclose(recorded_times(tmp_path), [0.0, 0.01, 0.02, 0.03], atol=1e-6)


@pytest.mark.parametrize("way", ["key", "button"])
def test_pause_holds_the_time_until_the_run_goes_on(
    display: Display, window_program: Path, tmp_path: Path, way: str
) -> None:
    with shown(display, window_program, tmp_path, RUNNING) as window:

        def switch() -> None:
            if way == "key":
                window.keys("space")
            else:
                window.click(*BUTTONS["pause"])

        first = window.shot()
        window.wait_for_picture(lambda picture: differ(picture[TIME], first[TIME]), "time to pass")
        switch()
        for _ in range(4):
            paused = settled(window)  # which a run that goes on never is
        switch()
        window.wait_for_picture(lambda picture: differ(picture[TIME], paused[TIME]), "the run to go on")
        ended(window)


def test_restart_button_restarts_with_the_same_seed(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        opened(window)
        before = window.shot()
        window.click(*BUTTONS["restart"])
        window.wait_for_picture(lambda picture: differ(picture[300:500], before[300:500]), "the question")
        window.keys("Return")  # keeps the files
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")
        window.find_window()
        ended(window)


def test_channels_are_off_then_below_then_above(display: Display, window_program: Path, tmp_path: Path) -> None:
    """Between two robots that hear each other, a lamp is above the lower links and below the upper ones."""
    x, y = (round(value) for value in pixel_of(700, 760))
    with shown(display, window_program, tmp_path, STILL) as window:
        off = hide_panels(window)
        assert tuple(off[y, x]) == LAMP
        beside = (y - 13, x)  # between the lamp and the rim of a robot
        below = act(window, "channels", lambda: window.keys("F5"), np.s_[:, :])
        assert tuple(below[y, x]) == LAMP
        assert differ(below[beside], off[beside])
        above = act(window, "channels above", lambda: window.keys("F5"), np.s_[:, :])
        assert tuple(above[y, x]) != LAMP
        assert differ(above[beside], off[beside])
        window.keys("F5")
        window.wait_for_picture(lambda picture: not differ(picture, off), "no channels")


@pytest.mark.parametrize(
    ("switch", "key"),
    [("trails", "F2"), ("lateral LEDs", "F6"), ("light levels", "F7"), ("time and scale bar", "F8")],
)
def test_switch_of_the_panel_does_what_its_key_does(
    display: Display, window_program: Path, tmp_path: Path, switch: str, key: str
) -> None:
    with shown(display, window_program, tmp_path, {**STILL, "show_trajectory_traces": True}) as window:
        window.keys(*["s"] * 70)
        open_switches(window)
        window.move_mouse(*ASIDE)
        before = settled(window)
        act(window, f"an effect of {switch}", lambda: window.click(*SWITCHES[switch]), BESIDE_PANELS)
        window.move_mouse(*ASIDE)
        window.keys(key)
        window.wait_for_picture(lambda picture: not differ(picture, before), f"{key} to undo it")


@pytest.mark.parametrize(("layer", "presses"), [("below", 1), ("above", 2)])
def test_layer_of_channels_in_the_panel_is_that_of_the_key(
    display: Display, window_program: Path, tmp_path: Path, layer: str, presses: int
) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        open_switches(window)
        act(window, "the layers", lambda: window.click(*SWITCHES["channels"]), np.s_[235:300, :246])
        before = settled(window)
        window.click(*LAYERS[layer])
        window.wait_for_picture(lambda picture: differ(picture[BESIDE_PANELS], before[BESIDE_PANELS]), "channels")
        chosen = settled(window)
        window.keys(*["F5"] * 3)  # once around
        settled(window)
        window.keys(*["F5"] * (3 - presses))
        window.wait_for_picture(
            lambda picture: not differ(picture[BESIDE_PANELS], before[BESIDE_PANELS]), "no channels"
        )
        window.keys(*["F5"] * presses)
        window.wait_for_picture(
            lambda picture: not differ(picture[BESIDE_PANELS], chosen[BESIDE_PANELS]), "the same channels"
        )


def test_collapsed_panel_uncovers_the_picture(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        window.move_mouse(*ASIDE)
        start = opened(window)
        title, below_title = np.s_[:36, :], np.s_[36:, :]
        arrow = (21, 20)
        act(window, "a collapsed panel", lambda: window.click(*arrow), below_title)
        window.move_mouse(*ASIDE)
        collapsed = settled(window)
        act(window, "an open panel", lambda: window.click(*arrow), below_title)
        window.move_mouse(*ASIDE)
        window.wait_for_picture(lambda picture: not differ(picture[below_title], start[below_title]), "an open panel")
        hidden = hide_panels(window)
        assert not differ(hidden[below_title], collapsed[below_title])
        assert differ(hidden[title], collapsed[title])


def test_moved_panel_works_at_its_new_place(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        opened(window)
        # Slowly: a panel sees the mouse once per picture.
        window.move_mouse(120, 20)
        settled(window)
        display.xdotool("mousedown", "1")
        settled(window)
        window.move_mouse(420, 120)
        window.wait_for_picture(lambda picture: picture[141:157, 320:500].max() > 200, "a moved panel")
        display.xdotool("mouseup", "1")
        moved = settled(window)
        x, y = BUTTONS["step"]
        window.click(x, y)  # no longer there
        act(window, "a step", lambda: window.click(x + 300, y + 100), TIME)
        window.keys("F9")
        window.wait_for_picture(lambda picture: picture[141:157, 320:500].max() < 50, "no panels")
        old_place = np.s_[:, :300]
        assert not differ(settled(window)[old_place], moved[old_place])
        ended(window)
    assert np.allclose(recorded_times(tmp_path), [0.0, 0.01], atol=1e-6)


def test_robot_keeps_its_place_under_the_hand(display: Display, window_program: Path, tmp_path: Path) -> None:
    """It moves as far as the mouse, wherever it is taken, and drives on when it is let go."""
    with shown(display, window_program, tmp_path, STILL) as window:
        place = centre_of(hide_panels(window), RED)
        x, y = pixel_of(500, 700)
        window.drag((x - 12, y + 9), (x - 12 + 90, y + 9 - 160))
        place += np.array([90, -160])
        wait_for_centre(window, RED, place, "the moved robot")
        window.keys(*["s"] * 40)
        window.wait_for_picture(
            lambda picture: np.abs(centre_of(picture, RED) - place).max() > 5.0, "the robot to drive on"
        )


def test_click_on_the_floor_or_once_more_selects_none(display: Display, window_program: Path, tmp_path: Path) -> None:
    with shown(display, window_program, tmp_path, STILL) as window:
        nothing = hide_panels(window)
        places = pixel_of(500, 700), pixel_of(700, 700)

        def has_rings(*wanted: bool) -> Callable[[Picture], bool]:
            """Whether there is something new around each robot, whose radius is 20 pixels."""
            parts = [np.s_[round(y) - 26 : round(y) + 26, round(x) - 26 : round(x) + 26] for x, y in places]
            return lambda picture: tuple(differ(picture[part], nothing[part]) for part in parts) == wanted

        floor = pixel_of(300, 850)
        for clicked, wanted in (
            (places[0], (True, False)),
            (places[1], (False, True)),
            (places[1], (False, False)),
            (places[0], (True, False)),
            (floor, (False, False)),
        ):
            window.click(*clicked)
            window.wait_for_picture(has_rings(*wanted), "the selection")


def test_restarted_window_has_the_selection_the_plot_and_the_speed(
    display: Display, window_program: Path, tmp_path: Path
) -> None:
    parts = {"robot": np.s_[520:558, 370:430], "plot": np.s_[600:780, 20:370], "speed": SPEED}
    with shown(display, window_program, tmp_path, STILL) as window:
        start = open_switches(window)
        window.keys("F4")
        window.wait_for_picture(lambda picture: differ(picture[SPEED], start[SPEED]), "another speed")
        act(window, "the plot", lambda: window.click(*PLACES["plot"]), parts["plot"])
        act(window, "the ring", lambda: window.click(*pixel_of(500, 695)), parts["robot"])
        window.move_mouse(*ASIDE)
        before = settled(window)
        window.keys("r", "k")
        wait_for(lambda: "restarted with seed 1" in window.text(), "the restart")
        window.find_window()

        def has_all(picture: Picture) -> bool:
            # The section View is closed in the new window, so the plot has other room.
            is_same = not any(differ(picture[parts[part]], before[parts[part]]) for part in ("robot", "speed"))
            return is_same and differ(picture[parts["plot"]], start[parts["plot"]])

        window.wait_for_picture(has_all, "the same picture")
