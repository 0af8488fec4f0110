"""The page of a live run in a real browser: what its controls do, and that it draws what the run is like."""

from __future__ import annotations

import contextlib
import io
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pogosim
import pytest
from chromium import CHROMIUM
from live_client import wait_for
from PIL import Image
from playwright.sync_api import Browser, Page
from pogosim.picture.palette import PALETTE
from pogosim.watch.live import LiveRun
from pogosim.watch.page import watch_page
from pogosim.watch.serving import served_in_thread
from running import write_scene

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: on macOS, none is installed for tests")


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_scene(
        tmp_path,
        {
            "simulation_time": 60.0,
            "objects.robots.nb": 12,
            "objects.box": {
                "type": "passive_object",
                "nb": 1,
                "geometry": "rectangle",
                "body_width": 90,
                "body_height": 60,
            },
            "objects.lamp": {
                "type": "static_light",
                "geometry": "disk",
                "radius": 300,
                "value": 1000,
                "x": 560,
                "y": 560,
            },
            "parameters": {"gain": 2.0, "flag": True},
        },
    )


class Shown:
    """The page of a run, and what is known of it outside of the browser."""

    def __init__(self, page: Page, simulation: pogosim.Simulation, live: LiveRun) -> None:
        self.page, self.simulation, self.live = page, simulation, live

    def value(self, expression: str) -> Any:
        return self.page.evaluate(expression)

    def wait(self, expression: str) -> Any:
        return wait_for(lambda: self.value(expression))

    def screen(self, robot: int) -> tuple[float, float]:
        """Return where a robot is on the page, in pixels."""
        x, y = self.value(f"live.view.camera.toScreen(live.view.poses[{robot}].x, live.view.poses[{robot}].y)")
        return float(x), float(y)

    def text(self, name: str) -> str:
        return str(self.page.inner_text(f"#{name}"))

    def picture(self) -> np.ndarray[Any, Any]:
        return np.asarray(Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")).astype(int)


@contextlib.contextmanager
def shown_page(browser: Browser, simulation: pogosim.Simulation) -> Iterator[Shown]:
    """Open a page that steers a run; every message of the browser is an error of the test."""
    from pogosim.command.watch import listening
    from pogosim.watch.server import WatchServer

    live = LiveRun(simulation, one_steers=True)
    server = WatchServer(live, watch_page("a run"))
    with listening("127.0.0.1", 0) as own, served_in_thread(server, own):
        page = browser.new_page(viewport={"width": 1000, "height": 740}, accept_downloads=True)
        page.set_default_timeout(20_000)
        said: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(f"http://127.0.0.1:{own.getsockname()[1]}/?token={server.tokens.steer}")
        wait_for(lambda: page.evaluate("Boolean(live.view)"))
        yield Shown(page, simulation, live)
        page.close()
    live.end()
    assert said == []


@pytest.fixture
def shown(browser: Browser, sim: pogosim.Simulation) -> Iterator[Shown]:
    """The page of the run."""
    with shown_page(browser, sim) as page:
        yield page


def test_page_draws_robots_where_they_are_in_the_colour_of_their_leds(shown: Shown) -> None:
    shown.simulation.step(30)  # LEDs are red by now
    shown.wait(f"live.view.state.time === {shown.simulation.time}")
    places = shown.value("live.view.poses.map(({x, y}) => [x, y])")
    np.testing.assert_allclose(places[:12], shown.simulation.positions, atol=0.02)
    shown.wait("live.view.state.frames > 1")
    picture = shown.picture()
    for robot in range(12):
        x, y = shown.screen(robot)
        red, green, blue = picture[round(y) - 2 : round(y) + 3, round(x) - 2 : round(x) + 3].mean(axis=(0, 1))
        assert red > 90
        assert max(green, blue) < 60
    assert shown.text("title") == "1\u00a0box, 12\u00a0robots"
    assert shown.text("clock") == "0.30 s"


def test_play_pause_step_and_reset(shown: Shown) -> None:
    shown.page.click("#play")
    wait_for(lambda: shown.simulation.time > 0.3)
    shown.page.keyboard.press(" ")
    wait_for(lambda: not shown.live.status.is_playing)
    at = shown.simulation.steps
    shown.page.click("#step")
    shown.page.keyboard.press("n")
    wait_for(lambda: shown.simulation.steps == at + 2)
    shown.wait(f"Math.abs(live.view.state.time - {0.01 * (at + 2)}) < 1e-6")
    shown.page.click("#reset")
    wait_for(lambda: shown.simulation.steps == 0)
    shown.wait("live.view?.state.time === 0")


def test_speed_is_chosen(shown: Shown) -> None:
    shown.page.select_option("#speed", "Infinity")
    shown.page.click("#play")
    wait_for(lambda: shown.simulation.is_over)
    shown.wait("document.getElementById('title').textContent.includes('the run is over')")
    shown.page.click("#play")
    wait_for(lambda: "reset it to play it again" in shown.text("notice"))


def test_lamps_are_suns(shown: Shown) -> None:
    shown.wait("live.view.state.frames > 1")
    x, y = shown.value("live.view.camera.toScreen(560, 560)")
    red, green, blue = shown.picture()[round(y), round(x)]
    assert (red, green, blue) == (0xFF, 0xD1, 0x66)


def test_time_that_was_seen_can_be_looked_at_again(shown: Shown) -> None:
    first = shown.simulation.positions.copy()
    for _ in range(20):
        before = shown.value("live.run.times.length")
        shown.simulation.step(5)
        shown.wait(f"live.run.times.length > {before}")
    shown.wait("live.view.state.time === 1")
    shown.page.keyboard.press("Home")
    shown.wait("live.view?.state.time === 0")
    np.testing.assert_allclose(shown.value("live.view.poses.map(({x, y}) => [x, y])")[:12], first, atol=0.02)
    shown.simulation.step(5)  # goes on unseen
    shown.page.keyboard.press("ArrowRight")
    shown.wait("Math.abs(live.view.state.time - 0.05) < 1e-6")
    shown.page.click("#newest")
    shown.wait("Math.abs(live.view.state.time - 1.05) < 1e-6")


def test_click_shows_the_values_of_a_robot(shown: Shown) -> None:
    shown.simulation.step(20)
    shown.wait("live.view.state.time > 0.19")
    shown.page.mouse.click(*shown.screen(4))
    wait_for(lambda: f"age\t{shown.simulation.user_data['age'][4]}" in shown.text("robot"))
    assert "levels[1]\t-3" in shown.text("robot")
    shown.page.keyboard.press("Escape")
    shown.wait("document.getElementById('robot').hidden")


def test_robot_is_dragged(shown: Shown) -> None:
    shown.simulation.step(10)
    shown.wait(f"live.view.state.time === {shown.simulation.time}")
    before = shown.simulation.positions[0].copy()
    x, y = shown.screen(0)
    to = shown.value("live.view.camera.toScreen(560, 500)")
    shown.page.mouse.move(x, y)
    shown.page.mouse.down()
    shown.page.mouse.move((x + to[0]) / 2, (y + to[1]) / 2, steps=4)
    shown.page.mouse.move(*to, steps=4)
    shown.page.mouse.up()
    wait_for(lambda: np.allclose(shown.simulation.positions[0], (560.0, 500.0), atol=3.0))
    assert not np.allclose(before, shown.simulation.positions[0], atol=3.0)
    shown.wait("Math.hypot(live.view.poses[0].x - 560, live.view.poses[0].y - 500) < 3")  # the run is paused
    velocity = shown.value("live.run.track.velocity(0, live.run.times.length - 1)")
    assert np.hypot(*velocity) < 200.0  # a hand is no motion of its own
    camera = shown.value("[live.view.camera.x, live.view.camera.y]")
    shown.page.mouse.move(30, 300)  # beside the arena: this moves the picture
    shown.page.mouse.down()
    shown.page.mouse.move(80, 300, steps=4)
    shown.page.mouse.up()
    assert shown.value("live.view.camera.x") < camera[0]


def test_settings_are_changed(shown: Shown) -> None:
    shown.page.click("#adjust")
    assert shown.page.is_visible("#settings")
    field = shown.page.locator('#parameters [aria-label="gain, as a number"]')
    field.fill("7.5")
    field.press("Enter")
    wait_for(lambda: shown.simulation.parameters.get("gain") == 7.5)
    shown.page.locator('#lamps [aria-label="lamp shines"]').uncheck()
    wait_for(lambda: not shown.simulation.lamps[0].is_on)
    shown.wait("live.run.light === null")
    shown.page.locator('#lamps [aria-label="lamp shines"]').check()
    shown.wait("live.run.light !== null")
    slider = shown.page.locator('#lamps [aria-label="intensity of lamp"]')
    slider.fill("0.5")
    wait_for(lambda: shown.simulation.lamps[0].intensity == 0.5)


def test_colours_show_a_value(shown: Shown) -> None:
    shown.page.select_option("#colour", "light")
    shown.wait("live.run.values[live.run.values.length - 1] !== null")
    shown.wait("document.querySelector('#key .ends').textContent.includes('1000')")
    colours = shown.value("Array.from({length: 12}, (_, robot) => live.view.colourOf(robot))")
    levels = shown.simulation.light_levels
    assert len(set(colours)) > 1
    assert len({colour for colour, level in zip(colours, levels, strict=True) if level == levels.min()}) == 1


def test_key_says_that_no_values_have_come_yet(shown: Shown) -> None:
    assert shown.value("(live.view.colourBy('light'), document.getElementById('key').innerText)").split() == [
        *("light", "no", "values")
    ]
    shown.wait("document.querySelector('#key .ends').textContent.includes('1000')")


def test_picture_and_film_are_saved(shown: Shown, tmp_path: Path) -> None:
    with shown.page.expect_download() as download:
        shown.page.click("#save_picture")
    assert download.value.suggested_filename == "swarm_0.00s.png"
    download.value.save_as(tmp_path / "picture.png")
    with Image.open(tmp_path / "picture.png") as picture:
        assert picture.size[0] == 1000
    shown.page.click("#film")
    shown.page.click("#play")
    shown.wait("Number(document.getElementById('film').title.match(/Recorded: (\\d+) kB/)?.[1]) > 20")
    with shown.page.expect_download() as download:
        shown.page.click("#film")
    assert download.value.suggested_filename in ("swarm.webm", "swarm.mp4")
    download.value.save_as(tmp_path / "film")
    probe = [
        "ffprobe",
        "-v",
        "error",
        "-count_frames",
        "-show_entries",
        "stream=nb_read_frames,width",
        "-of",
        "csv=p=0",
    ]
    told = subprocess.run([*probe, str(tmp_path / "film")], capture_output=True, text=True, timeout=60, check=True)
    width, frames = map(int, told.stdout.split(","))
    assert width == 1000
    assert frames >= 2  # a busy machine records few


def test_second_viewer_takes_over(shown: Shown) -> None:
    assert shown.page.context.browser is not None
    other = shown.page.context.browser.new_page()
    other.goto(shown.page.url)
    wait_for(lambda: other.evaluate("Boolean(live.view)"))
    assert other.is_disabled("#play")
    wait_for(lambda: "2 viewers" in shown.text("viewers"))
    other.click("#steer")
    wait_for(lambda: not other.is_disabled("#play") and shown.page.is_disabled("#play"))
    other.click("#step")
    wait_for(lambda: shown.simulation.steps == 1)
    other.close()
    wait_for(lambda: not shown.page.is_disabled("#play"))


def test_page_says_that_the_simulation_is_closed(shown: Shown) -> None:
    shown.simulation.close()
    wait_for(lambda: "closed" in shown.text("problem"))


def test_random_keys_and_clicks_leave_the_page_alive(shown: Shown) -> None:
    chance = np.random.default_rng(3)
    keys = [
        " ",
        "n",
        "r",
        "p",
        "m",
        "t",
        "l",
        "v",
        "d",
        "c",
        "F2",
        "F9",
        "f",
        "0",
        "+",
        "-",
        "?",
        "Escape",
        "Home",
        "End",
        "ArrowLeft",
        "ArrowRight",
    ]
    for _ in range(150):
        if chance.random() < 0.6:
            shown.page.keyboard.press(str(chance.choice(keys)))
        else:
            shown.page.mouse.click(float(chance.integers(1000)), float(chance.integers(650)))
    shown.page.keyboard.press("End")
    shown.value(
        """() => {
            document.getElementById("reset").click();
            const field = document.querySelector('#parameters [aria-label="gain, as a number"]');
            field.value = "7.5";
            field.dispatchEvent(new Event("change"));
        }"""
    )
    wait_for(lambda: shown.simulation.parameters.get("gain") == 7.5)  # so all that was asked for before is done
    shown.wait("live.view?.state.time === 0")
    shown.live.play()
    shown.wait("live.view?.state.time > 0.1")


def test_page_begins_with_the_view_of_the_configuration(browser: Browser, hosted: Path, tmp_path: Path) -> None:
    view = {"theme": "light", "labels": True, "color_by": "light", "heat_map": "speed", "follow": 4, "zoom": 2.0}
    scene = write_scene(tmp_path, {"simulation_time": 60.0, "objects.robots.nb": 12, "view": view})
    with pogosim.Simulation(hosted, scene) as simulation, shown_page(browser, simulation) as shown:
        simulation.step(20)
        shown.wait(f"live.view.state.time === {simulation.time}")
        chosen = shown.value("live.view.chosen()")
        assert {key: chosen[key] for key in view if key != "zoom"} == {key: view[key] for key in view if key != "zoom"}
        shown.wait("document.getElementById('key').textContent.includes('speed (mm/s)')")
        index = "live.run.columns.find(({name}) => name === 'NAME').value"
        speeds = shown.value(
            f"Array.from({{length: 12}}, (_, i) => {index.replace('NAME', 'speed')}(i, live.view.state.index))"
        )
        np.testing.assert_allclose(speeds, np.hypot(*simulation.velocities.T), rtol=1e-5)
        width, height = shown.value("[live.view.camera.canvas.clientWidth, live.view.camera.canvas.clientHeight]")
        assert shown.screen(4) == pytest.approx((width / 2, height / 2), abs=0.5)
        floor = [int(PALETTE["light"]["floor"][i : i + 2], 16) for i in (1, 3, 5)]
        assert (shown.picture() == floor).all(axis=-1).mean() > 0.01
        shown.page.keyboard.press("v")
        shown.page.click("#reset")
        shown.wait("live.view?.state.time === 0")
        again = shown.value("live.view.chosen()")
        assert again == {**chosen, "velocities": True}
