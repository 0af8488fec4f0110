"""What pages show of a run: what its configuration says at first, and what keys, mouse and fingers change."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from chromium import CHROMIUM
from live_client import wait_for
from PIL import Image
from playwright.sync_api import Browser, Page
from pogosim.film.command import main
from pogosim.film.timeline import timeline_of
from pogosim.picture.palette import PALETTE, led_colours
from pogosim.picture.swarm import OBJECT, read_recording
from pogosim.view.beginning import view_of
from recordings import walkers, write

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: on macOS, none is installed for tests")

OBJECTS: dict[str, Any] = {
    "robots": {"type": "pogobot", "geometry": "disk", "radius": 26.5, "communication_radius": 400},
    "lamp": {"type": "static_light", "geometry": "disk", "radius": 200, "value": 500, "x": 500, "y": 600},
}
BLIND = {"theme": "light", "palette": "color_blind"}
Colour = npt.NDArray[np.int64]


class Replay:
    """The page of walkers, at 1 s; every message of the browser is an error of the test."""

    def __init__(self, browser: Browser, data: Path, *options: str, **page: Any) -> None:
        path = data.with_suffix(".html")
        assert main([str(data), "-o", str(path), "-q", *options]) == 0
        self.page: Page = browser.new_page(viewport={"width": 1000, "height": 740}, **page)
        self.page.set_default_timeout(20_000)
        self.said: list[str] = []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.goto(path.as_uri())
        self.value("replay.ready.then(() => replay.setTime(1))")

    def value(self, expression: str) -> Any:
        return self.page.evaluate(expression)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def picture(self) -> Colour:
        """Return the pixels of the arena."""
        self.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        with Image.open(io.BytesIO(self.page.screenshot())) as shown:
            return np.asarray(shown.convert("RGB")).astype(np.int64)[:620]

    def key(self) -> list[str]:
        """Return the words that say what colours mean."""
        self.picture()
        return self.page.inner_text("#key").split()

    def screen(self, robot: int) -> tuple[float, float]:
        x, y = self.value(f"replay.screen({robot})")
        return float(x), float(y)

    @property
    def pixels_per_mm(self) -> float:
        return (self.screen(2)[0] - self.screen(0)[0]) / (2000.0 / 3.0)

    def beside(self, robot: int, right_mm: float, down_mm: float) -> Colour:
        """Return the colour at a place beside a robot."""
        x, y = self.screen(robot)
        own: Colour = self.picture()[round(y + down_mm * self.pixels_per_mm), round(x + right_mm * self.pixels_per_mm)]
        return own


def colour(text: str) -> list[int]:
    return [int(text[i : i + 2], 16) for i in (1, 3, 5)]


def shade(share: float) -> npt.NDArray[np.float64]:
    """Return the colour of a value at a share of its range."""
    colours = np.array([colour(own) for own in PALETTE["colour_map"]])
    place = share * (len(colours) - 1)
    return np.array([np.interp(place, range(len(colours)), channel) for channel in colours.T])


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return write(tmp_path / "run.feather", walkers(), OBJECTS)


@pytest.fixture
def replay(browser: Browser, data: Path) -> Iterator[Replay]:
    opened = Replay(browser, data)
    yield opened
    opened.page.close()
    assert opened.said == []


def test_page_begins_with_the_view_of_the_configuration(browser: Browser, tmp_path: Path) -> None:
    view = {
        **BLIND,
        **{"trails": True, "links": "above", "labels": True, "velocities": True, "light_levels": True},
        **{"time": False, "scale_bar": False, "color_by": "heard", "heat_map": "density", "follow": 1, "zoom": 2.5},
    }
    plain = Replay(browser, write(tmp_path / "plain.feather", walkers()))
    shown = Replay(browser, write(tmp_path / "run.feather", walkers(), view=view))
    assert shown.value("replay.chosen") == {key: value for key, value in view.items() if key != "zoom"}
    assert shown.pixels_per_mm == pytest.approx(2.5 * plain.pixels_per_mm, rel=1e-3)
    box = shown.page.locator("#arena").bounding_box()
    assert box is not None
    assert shown.screen(1) == pytest.approx((box["width"] / 2, box["height"] / 2), abs=0.5)
    assert not shown.page.is_visible("#clock")
    assert shown.page.is_checked("#follow")
    assert shown.page.inner_text("#key").split()[0] == "heard"
    assert plain.page.is_visible("#clock")
    assert plain.value("replay.chosen")["scale_bar"] is True
    for own in (plain, shown):
        assert own.said == []
        own.page.close()


def test_older_keys_say_what_the_section_does_not() -> None:
    older = {"show_time": False, "show_trajectory_traces": True, "show_communication_channels": True}
    assert view_of(older) == {"time": False, "trails": True, "links": "below"}
    above = {**older, "show_communication_channels_above_all": True}
    assert view_of({**above, "view": {"time": True, "theme": "light"}}) == {
        **{"time": True, "trails": True, "links": "above", "theme": "light"}
    }


def test_command_line_prevails_over_the_configuration(browser: Browser, tmp_path: Path) -> None:
    data = write(tmp_path / "run.feather", walkers(), view={"links": "above", "color_by": "heard", "theme": "light"})
    page = Replay(browser, data, "--links", "--color-by", "led_rgb", "--view", "theme=dark", "--view", "labels=true")
    chosen = page.value("replay.chosen")
    assert [chosen[key] for key in ("links", "color_by", "theme", "labels")] == ["below", "LED", "dark", True]
    page.page.close()


def test_page_refuses_a_view_that_films_refuse(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(data), "-o", str(data.with_suffix(".html")), "--view", "theme=pink"]) == 2
    assert "view.theme: expected dark or light, found 'pink'" in capsys.readouterr().err


@pytest.mark.parametrize("key", ["F2", "c", "l", "v", "d", "F7", "F8"])
def test_each_key_changes_the_picture_and_back(replay: Replay, key: str) -> None:
    plain = replay.picture()
    replay.press(key)
    changed = replay.picture()
    assert (np.abs(changed - plain).max(axis=-1) > 20).sum() > 50
    replay.press(*([key, key] if key == "c" else [key]))  # links are above, too
    np.testing.assert_array_equal(replay.picture(), plain)


@pytest.mark.parametrize("on", ["time", "scale_bar"])
def test_time_and_scale_bar_go_off_together_and_then_on(replay: Replay, on: str) -> None:
    replay.press("F9")
    replay.page.uncheck({"time": "#scale_bar", "scale_bar": "#time"}[on])
    for is_on in (False, True, False):
        replay.press("F8")
        chosen = replay.value("replay.chosen")
        assert (chosen["time"], chosen["scale_bar"]) == (is_on, is_on)


def test_the_key_of_the_density_switches_any_heat_map_off(replay: Replay) -> None:
    replay.press("F9")
    replay.page.select_option("#heat", "heard")
    replay.page.locator("#arena").focus()
    for heat in ("", "density", ""):
        replay.press("d")
        assert replay.value("replay.chosen")["heat_map"] == heat


@pytest.mark.parametrize("palette", ["standard", "color_blind"])
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_colours_are_those_of_theme_and_palette(replay: Replay, theme: str, palette: str) -> None:
    replay.press("F9")
    replay.page.select_option("#theme", theme)
    replay.page.select_option("#palette", palette)
    view = {"theme": theme, "palette": palette}
    leds = np.round(255 * led_colours([0x190000, 0x001900, 0x000019], view))
    for robot in range(3):
        np.testing.assert_allclose(replay.beside(robot, 12.0, -10.0), leds[robot], atol=1)
    floor = PALETTE["light"]["floor"] if theme == "light" else PALETTE["floor"]
    assert replay.beside(1, 0.0, 250.0).tolist() == colour(floor)
    replay.press("t")
    assert replay.value("replay.chosen")["theme"] == ("dark" if theme == "light" else "light")


def test_first_picture_has_the_colours_of_the_view(browser: Browser, tmp_path: Path) -> None:
    page = Replay(browser, write(tmp_path / "run.feather", walkers(), view=BLIND))
    page.value("replay.setTime(0)")
    by_program = page.picture()
    page.value("document.getElementById('arena').remove()")
    by_page = page.picture()
    page.page.close()
    inside = (slice(60, 580), slice(20, 980))
    assert (np.abs(by_program[inside] - by_page[inside]).max(axis=-1) > 60).mean() < 0.01
    assert (np.abs(by_page[inside] - colour(PALETTE["color_blind"]["led_by_hue"][2])).max(axis=-1) < 50).any()


def test_arrows_lead_to_where_robots_are_a_second_later(replay: Replay) -> None:
    replay.press("v")
    for time_s in (0.0, 1.0, 1.2):  # in the first record: as they move until the next
        replay.value(f"replay.setTime({time_s})")
        for robot, arrow in enumerate(replay.value("replay.arrows")):
            pose = replay.value(f"replay.pose({robot})")
            np.testing.assert_allclose(arrow["from"], [pose["x"], pose["y"]], atol=0.05)
            np.testing.assert_allclose(arrow["to"], [pose["x"], pose["y"] + 100.0], atol=0.1)
    assert replay.beside(1, 0.0, 90.0).min() > 150  # the head
    assert replay.beside(1, 0.0, 110.0).max() < 50


@pytest.mark.parametrize(("boundary", "mm_s"), [("solid", [0.0, 0.0]), ("periodic", [-800.0, 100.0])])
def test_arrows_are_those_of_films(browser: Browser, tmp_path: Path, boundary: str, mm_s: list[float]) -> None:
    rows = walkers()
    rows.loc[(rows["robot_id"] == 0) & (rows["time"] > 0.9), "x"] += 600.0  # a jump of more than half the arena
    rows.loc[(rows["robot_id"] == 1) & (rows["time"] > 0.9), "x"] += 50.0
    data = write(tmp_path / "run.feather", rows, boundary_condition=boundary)
    recording = read_recording(str(data))
    line = timeline_of(recording, recording.last.rows, [OBJECT])
    page = Replay(browser, data)
    for time_s in (0.0, 0.7, 1.0, 1.2, 1.5, 2.0):
        page.value(f"replay.setTime({time_s})")
        shown = [np.subtract(arrow["to"], arrow["from"]) for arrow in page.value("replay.arrows")]
        np.testing.assert_allclose(shown, line.velocities_at(time_s), atol=0.1)
        if time_s == 1.0:
            np.testing.assert_allclose(shown[:2], [mm_s, [100.0, 100.0]], atol=0.1)
    assert page.said == []
    page.page.close()


@pytest.mark.parametrize("tail", [[], ["--tail", "15"]], ids=["5 s", "15 s"])
def test_trails_are_as_long_as_the_tail(browser: Browser, tmp_path: Path, tail: list[str]) -> None:
    rows = walkers(3, 41).assign(y=lambda frame: 100.0 + 40.0 * frame["time"])
    page = Replay(browser, write(tmp_path / "run.feather", rows, view={"trails": True}), *tail)
    page.value("replay.setTime(20)")
    (x, y), mm = page.screen(0), page.pixels_per_mm
    for seconds, is_shown in ((3.0, True), (10.0, bool(tail)), (17.0, False)):
        ago = round(y - 40.0 * seconds * mm)
        around = page.picture()[ago - 1 : ago + 2, round(x) - 3 : round(x) + 4]
        assert bool((around != colour(PALETTE["floor"])).any()) == is_shown, seconds
    assert page.said == []
    page.page.close()


def test_labels_are_inside_of_robots_and_stand_out(replay: Replay) -> None:
    replay.press("l")
    shown = replay.picture()
    for robot, bright in ((0, True), (1, False)):  # on red, and on green
        x, y = replay.screen(robot)
        reach = round(13 * replay.pixels_per_mm)
        own = shown[
            round(y) - reach : round(y) + reach, round(x) - reach : round(x)
        ]  # the mark of the heading is below
        assert bool((own.min(axis=-1) > 180).any()) == bright
        assert bool((own.max(axis=-1) < 80).any()) != bright


def test_density_is_that_of_a_normal_distribution(replay: Replay) -> None:
    replay.press("d")
    assert replay.key() == ["robots", "per", "m2", "0", "100"]
    peak = 1.0 / (2.0 * np.pi * 0.04**2)  # per square metre
    for mm in (50.0, 70.0, 95.0):  # beyond the glow of its LED
        share = peak * np.exp(-0.5 * (mm / 40.0) ** 2) / 100.0
        opacity = 0.85 * min(share / 0.12, 1.0)
        expected = opacity * shade(share) + (1.0 - opacity) * np.array(colour(PALETTE["floor"]))
        np.testing.assert_allclose(replay.beside(1, mm, 0.0), expected, atol=9)
    assert replay.beside(1, 0.0, 250.0).tolist() == colour(PALETTE["floor"])


def test_heat_map_is_computed_when_it_changes(replay: Replay) -> None:
    replay.press("d")
    replay.picture()
    replay.value(
        """() => {
            const Canvas = OffscreenCanvas;
            window.canvases = 0;
            window.OffscreenCanvas = class extends Canvas {
                constructor(...size) { super(...size); window.canvases++; }
            };
        }"""
    )
    frames = replay.value("replay.frames")
    for x in (300, 320, 340):
        replay.page.mouse.move(x, 300)
        replay.picture()
    assert (replay.value("replay.frames") > frames, replay.value("canvases")) == (True, 0)
    for change in ("replay.setTime(1.5)", "replay.setTime(1)"):
        before = replay.value("canvases")
        replay.value(change)
        replay.picture()
        assert replay.value("canvases") == before + 1
    before = replay.value("canvases")
    replay.press("t")
    replay.picture()
    assert replay.value("canvases") > before


def test_heat_map_shows_the_mean_of_a_column(replay: Replay) -> None:
    replay.press("F9")
    replay.page.select_option("#heat", "heard")  # 2, 12 and 22
    assert replay.key() == ["heard", "0", "24"]
    for robot, value in ((0, 2.0), (2, 22.0)):
        expected = 0.85 * shade(value / 24.0) + 0.15 * np.array(colour(PALETTE["floor"]))
        np.testing.assert_allclose(replay.beside(robot, 50.0, 0.0), expected, atol=12)
    replay.page.select_option("#heat", "angle")  # all head down
    assert replay.key() == ["angle", "(rad)", "-pi", "pi"]
    down = replay.beside(1, 50.0, 0.0)
    assert down[1] > 180  # a quarter of the circle from red on
    replay.page.select_option("#heat", "")
    assert not replay.page.is_visible("#key")


def test_key_says_that_a_column_has_no_values(browser: Browser, tmp_path: Path) -> None:
    page = Replay(browser, write(tmp_path / "run.feather", walkers().assign(heard=np.nan)))
    page.value("replay.colourBy('heard')")
    assert page.key() == ["heard", "no", "values"]
    assert page.said == []
    page.page.close()


def test_canvas_has_the_pixels_of_the_screen(browser: Browser, data: Path) -> None:
    page = Replay(browser, data, device_scale_factor=2.5)
    width, shown = page.value("(({width, clientWidth}) => [width, clientWidth])(document.getElementById('arena'))")
    assert (width, shown) == (2500, 1000)
    page.page.close()


def test_fingers_tap_move_and_pinch(browser: Browser, data: Path) -> None:
    page = Replay(browser, data, has_touch=True)
    before = page.pixels_per_mm
    fingers = page.page.context.new_cdp_session(page.page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        places = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

    x, y = page.screen(1)
    page.page.touchscreen.tap(x + 26.5 * before + 10.0, y)  # beside it, as fingers do
    assert page.value("replay.selected") == 1
    touch("touchStart", (300.0, 300.0))
    touch("touchMove", (340.0, 320.0))
    touch("touchEnd")
    assert page.screen(1) == pytest.approx((x + 40.0, y + 20.0), abs=1.0)
    touch("touchStart", (400.0, 300.0), (600.0, 300.0))
    touch("touchMove", (300.0, 300.0), (700.0, 300.0))
    touch("touchEnd")
    assert page.pixels_per_mm == pytest.approx(2.0 * before, rel=1e-3)
    assert page.screen(1) == pytest.approx((500.0 + 2.0 * (x - 460.0), 300.0 + 2.0 * (y - 280.0)), abs=2.0)
    assert page.value("replay.selected") == 1
    assert page.said == []
    page.page.close()


def test_help_names_every_key(replay: Replay) -> None:
    replay.press("?")
    told = replay.page.inner_text("#help")
    for key in ("F2", "C", "F7", "F8", "L", "V", "D", "T", "F9"):
        assert f"\n{key}\n" in told or f"\n{key}\t" in told, key


def test_page_in_a_part_that_is_shown_later_has_its_size(browser: Browser, tmp_path: Path) -> None:
    data = write(tmp_path / "a.feather", walkers(), OBJECTS, view={"follow": 1})
    assert main([str(data), "-o", str(tmp_path / "run.html"), "-q"]) == 0
    (tmp_path / "around.html").write_text(
        '<iframe src="run.html" width="800" height="600" style="display: none"></iframe>', encoding="utf-8"
    )
    page = browser.new_page()
    page.goto((tmp_path / "around.html").as_uri())
    inner = page.frames[1]
    inner.evaluate("replay.ready")
    page.evaluate("document.querySelector('iframe').style.display = 'block'")
    wait_for(lambda: inner.evaluate("replay.screen(2)[0] - replay.screen(0)[0]") > 100)  # of a frame of 800 pixels
    wait_for(lambda: abs(inner.evaluate("replay.screen(1)[0]") - 400) < 5)
    page.close()
