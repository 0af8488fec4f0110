"""The page that replays a run, in a real browser."""

from __future__ import annotations

import io
import re
import subprocess
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from chromium import CHROMIUM
from live_client import wait_for
from PIL import Image
from playwright.sync_api import Browser, Page
from pogosim.film.command import main
from pogosim.picture.links import proximity_pairs
from pogosim.picture.palette import PALETTE
from recordings import link_table, linked, walkers, write

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: on macOS, none is installed for tests")


def page_of(data: Path, *options: str) -> Path:
    out = data.with_suffix(".html")
    assert main([str(data), "-o", str(out), *options]) == 0
    return out


def show(browser: Browser, page: Path) -> Page:
    """Open a page from its file; every message of the browser is an error of the test."""
    opened = browser.new_page(viewport={"width": 900, "height": 700})
    opened.set_default_timeout(20_000)
    said: list[str] = []
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("request", lambda request: said.append(request.url) if request.url.startswith("http") else None)
    opened.goto(page.as_uri())
    opened.evaluate("replay.ready")
    wait_for(partial(opened.evaluate, "replay.frames > 0"))
    opened.said = said  # type: ignore[attr-defined]
    return opened


@pytest.fixture
def page(browser: Browser, tmp_path: Path) -> Iterator[Page]:
    opened = show(browser, page_of(write(tmp_path / "run.feather", walkers())))
    yield opened
    assert opened.said == []  # type: ignore[attr-defined]
    opened.close()


def poses(page: Page, count: int = 3) -> list[dict[str, float]]:
    found: list[dict[str, float]] = page.evaluate(f"[...Array({count}).keys()].map(replay.pose)")
    return found


def drawn(page: Page) -> None:
    """Wait until what has been asked for is on the screen."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def pixel(page: Page, x: float, y: float) -> list[int]:
    """Colour on the screen."""
    drawn(page)
    with Image.open(io.BytesIO(page.screenshot())) as shown:
        red, green, blue = np.asarray(shown.convert("RGB"))[round(y), round(x)]
    return [int(red), int(green), int(blue)]


def share_of_floor(picture: Path) -> float:
    with Image.open(picture) as shown:
        pixels = np.asarray(shown.convert("RGB")).astype(int)
    floor = np.array([int(PALETTE["floor"][i : i + 2], 16) for i in (1, 3, 5)])
    return float((np.abs(pixels - floor).max(axis=-1) <= 3).mean())


def test_screenshot_taken_at_once_shows_the_arena_and_its_robots(tmp_path: Path) -> None:
    page = page_of(write(tmp_path / "run.feather", walkers()))
    shot = tmp_path / "shot.png"
    command = [
        str(CHROMIUM),
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--hide-scrollbars",
        "--window-size=900,700",
    ]
    command += [f"--user-data-dir={tmp_path / 'profile'}", f"--screenshot={shot}", page.as_uri()]
    subprocess.run(command, check=True, timeout=120, capture_output=True)
    assert share_of_floor(shot) > 0.2


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
def test_page_without_javascript_shows_the_same_first_picture(browser: Browser, tmp_path: Path, boundary: str) -> None:
    rows = walkers().assign(x=lambda frame: frame["x"] - 160.0, y=1.0)  # at the border, and in a corner
    page = page_of(write(tmp_path / "run.feather", rows, boundary_condition=boundary))
    pictures = []
    for has_javascript in (True, False):
        opened = browser.new_page(viewport={"width": 900, "height": 700}, java_script_enabled=has_javascript)
        opened.goto(page.as_uri())
        if has_javascript:
            wait_for(partial(opened.evaluate, "replay.frames > 0"))
            drawn(opened)
        else:
            assert "first picture" in opened.inner_text("noscript p")
            assert opened.inner_text("#clock") == "0.00 s"
        with Image.open(io.BytesIO(opened.screenshot())) as shown:
            pictures.append(np.asarray(shown.convert("RGB")).astype(int))
        opened.close()
    drawn_by_program, drawn_by_page = (picture[60:560, 20:880] for picture in pictures)
    assert (np.abs(drawn_by_program - drawn_by_page).max(axis=-1) > 60).mean() < 0.01


def test_robots_are_where_the_data_say_at_each_time(page: Page) -> None:
    rows = walkers()
    for time_s, own in rows.groupby("time"):
        page.evaluate("(time) => replay.setTime(time)", time_s)
        for pose, row in zip(poses(page), own.to_dict("records"), strict=True):
            assert (pose["x"], pose["y"]) == pytest.approx((row["x"], row["y"]), abs=0.02)
            assert pose["angle"] == pytest.approx(row["angle"], abs=2e-4)
    page.evaluate("replay.setTime(0.25)")
    assert poses(page)[1]["y"] == pytest.approx(125.0, abs=0.02)


def test_scrubbing_shows_the_time_that_it_says(page: Page) -> None:
    page.evaluate(
        "() => { const s = document.getElementById('scrub'); s.value = 1.25; s.dispatchEvent(new Event('input')); }"
    )
    drawn(page)
    assert page.inner_text("#clock") == "1.25 s"
    assert poses(page)[0]["y"] == pytest.approx(225.0, abs=0.02)


def test_playing_goes_on_to_the_end_and_stops(page: Page) -> None:
    page.select_option("#speed", "0.1")  # 20 s, so that a slow machine sees it playing
    page.keyboard.press("Space")
    wait_for(partial(page.evaluate, "replay.time > 0"))
    assert page.get_attribute("#play", "aria-label") == "Pause"
    page.select_option("#speed", "8")
    wait_for(partial(page.evaluate, "replay.time === 2 && !replay.playing"))
    assert page.get_attribute("#play", "aria-label") == "Play"
    page.select_option("#speed", "0.1")
    page.click("#play")  # from the start again
    wait_for(partial(page.evaluate, "replay.playing && replay.time < 2"))
    page.keyboard.press("Space")
    assert page.evaluate("replay.playing") is False


def test_keys_step_from_record_to_record(page: Page) -> None:
    for key, time_s in (
        ("ArrowRight", 0.5),
        ("Shift+ArrowRight", 2.0),
        ("ArrowLeft", 1.5),
        ("Home", 0.0),
        ("End", 2.0),
    ):
        page.keyboard.press(key)
        assert page.evaluate("replay.time") == time_s
    page.keyboard.press("?")
    assert page.is_visible("#help")


def test_robots_shine_in_the_colours_of_their_leds(page: Page) -> None:
    page.evaluate("replay.setTime(1)")
    x, y = page.evaluate("replay.screen(0)")
    assert pixel(page, x, y - 8) == [210, 0, 0]
    x, y = page.evaluate("replay.screen(2)")
    assert pixel(page, x, y - 8) == [0, 0, 210]


def test_lit_robots_glow_and_leave_trails_up_to_where_they_are(page: Page) -> None:
    page.evaluate("replay.setTime(1.45)")
    x, y = page.evaluate("replay.screen(0)")
    radius = (page.evaluate("replay.screen(1)")[0] - x) / (1000 / 3) * 26.5
    floor = pixel(page, x + 3 * radius, y)
    assert pixel(page, x + 1.2 * radius, y)[0] > floor[0] + 10
    behind = (x, y - 1.35 * radius)  # after the last record
    before = pixel(page, *behind)
    page.check("#trails")
    assert pixel(page, *behind)[0] > before[0] + 40
    assert pixel(page, x, y - 3 * radius)[0] > floor[0] + 10
    page.select_option("#colour", "state")
    page.uncheck("#trails")
    assert pixel(page, x + 1.2 * radius, y) == floor


def test_column_colours_robots_and_the_legend_explains(page: Page) -> None:
    page.select_option("#colour", "state")
    assert page.inner_text("#key").split() == ["state", "waits", "walks"]
    swatches = page.eval_on_selector_all(".swatch", "(all) => all.map((own) => getComputedStyle(own).backgroundColor)")
    x, y = page.evaluate("replay.screen(1)")
    assert f"rgb({', '.join(map(str, pixel(page, x, y - 8)))})" == swatches[0]
    page.select_option("#colour", "heard")
    assert page.inner_text("#key").split() == ["heard", "0", "24"]
    assert page.evaluate("replay.setTime(2), replay.colourOf(2)") == "#fde725"  # the last of viridis


def test_hovering_and_clicking_tell_the_values_of_the_robot_below(page: Page) -> None:
    page.evaluate("replay.setTime(1)")
    page.mouse.move(*page.evaluate("replay.screen(1)"))
    drawn(page)
    cells = page.inner_text("#hover").split()
    assert cells[:2] == ["robots", "1"]
    told = dict(zip(cells[2::2], cells[3::2], strict=True))
    assert (told["heard"], told["state"], told["fed"], told["LED"]) == ("12", "waits", "false", "#001900")
    page.mouse.click(*page.evaluate("replay.screen(2)"))
    drawn(page)
    assert page.inner_text("#robot").startswith("robots 2")
    page.keyboard.press("Escape")
    drawn(page)
    assert not page.is_visible("#robot")


def test_wheel_zooms_where_the_mouse_is_and_following_keeps_the_robot_in_the_middle(page: Page) -> None:
    x, y = page.evaluate("replay.screen(2)")
    before = page.evaluate("replay.screen(0)")
    page.mouse.move(x, y)
    page.mouse.wheel(0, -300)
    wait_for(partial(page.evaluate, "(before) => replay.screen(0)[0] < before - 50", before[0]))
    assert page.evaluate("replay.screen(2)") == pytest.approx([x, y], abs=0.5)
    page.evaluate("replay.select(0)")
    page.check("#follow")
    drawn(page)
    box = page.locator("#arena").bounding_box()
    assert box is not None
    assert page.evaluate("replay.screen(0)") == pytest.approx([box["width"] / 2, box["height"] / 2], abs=0.5)
    page.click("#fit")
    assert page.evaluate("replay.screen(0)") == pytest.approx(before, abs=0.5)


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
def test_links_are_those_of_pictures(browser: Browser, tmp_path: Path, boundary: str) -> None:
    random = np.random.default_rng(1)
    rows = walkers(60, 1).assign(x=random.uniform(0, 1000, 60), y=random.uniform(0, 1000, 60))
    data = write(tmp_path / "run.feather", rows, boundary_condition=boundary)
    page = show(browser, page_of(data, "--links"))
    found = sorted(sorted(pair) for pair in page.evaluate("replay.links"))
    box = (np.zeros(2), np.full(2, 1000.0)) if boundary == "periodic" else None
    place = rows[["x", "y"]].to_numpy()
    assert found == proximity_pairs(place, np.full(60, 80.0), np.full(60, 26.5), box).tolist()
    assert page.said == []  # type: ignore[attr-defined]


def test_way_across_a_periodic_border_leaves_no_streak(browser: Browser, tmp_path: Path) -> None:
    rows = walkers(1, 2).assign(x=np.array([980.0, 20.0]))
    page = show(browser, page_of(write(tmp_path / "run.feather", rows, boundary_condition="periodic"), "--tail", "1"))
    page.evaluate("replay.setTime(0.25)")
    assert poses(page, 1)[0]["x"] % 1000.0 == pytest.approx(0.0, abs=0.05)
    page.evaluate("replay.setTime(0.5)")
    x, y = page.evaluate("replay.screen(0)")
    assert max(pixel(page, x + 200, y)) < 40  # the floor
    assert page.said == []  # type: ignore[attr-defined]


@pytest.mark.parametrize("boundary", ["solid", "periodic"])
def test_robot_at_a_periodic_border_comes_back_on_the_other_side(
    browser: Browser, tmp_path: Path, boundary: str
) -> None:
    rows = walkers(2, 1).assign(x=[995.0, 495.0], y=500.0, led_rgb=[0x190000, 0])
    page = show(browser, page_of(write(tmp_path / "run.feather", rows, boundary_condition=boundary)))
    (x, y), (other_x, _) = page.evaluate("[replay.screen(0), replay.screen(1)]")
    scale = (x - other_x) / 500.0  # pixels per mm
    is_red, is_back, is_beyond = (
        bool(np.ptp(pixel(page, x + scale * (mm - 995.0), y)) > 100) for mm in (980.0, 12.0, 1012.0)
    )
    assert is_red
    assert is_back == (boundary == "periodic")
    assert is_beyond == (boundary == "solid")
    assert page.said == []  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    "rows",
    [
        walkers().iloc[:1],
        walkers().drop(columns=["angle", "led_rgb"]),
        walkers().drop(columns=["robot_category", "robot_id"]),
        walkers().assign(x=lambda frame: frame["x"].where(frame["time"] != 1.0), heard=np.nan, state=None),
        walkers().assign(state="</script><b>", robot_category="<i>&"),
        walkers().assign(empty=np.inf, big=2**62, date=pd.Timestamp("2020-01-01")),
    ],
    ids=["one row", "places only", "nobody", "gaps", "markup", "odd"],
)
def test_page_of_odd_data_works(browser: Browser, tmp_path: Path, rows: pd.DataFrame) -> None:
    page = show(browser, page_of(write(tmp_path / "run.feather", rows)))
    names: list[Any] = page.evaluate("replay.columns")
    for name in names:
        page.evaluate("([name, time]) => { replay.colourBy(name); replay.setTime(time); replay.select(0); }", [name, 1])
        drawn(page)
    assert page.said == []  # type: ignore[attr-defined]


def test_thousand_robots_are_drawn_frame_by_frame(browser: Browser, tmp_path: Path) -> None:
    rows = walkers(1000, 3)
    page = show(browser, page_of(write(tmp_path / "run.feather", rows), "--tail", "1", "--links"))
    page.evaluate("replay.play()")
    wait_for(partial(page.evaluate, "replay.frames > 5"))
    assert page.evaluate("replay.count") == 1000
    assert page.said == []  # type: ignore[attr-defined]


def test_page_of_a_minute_at_60_records_per_second_is_small_and_the_same_each_time(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    count, records = 100, 3601
    rows = walkers(count, records)
    turns = np.cumsum(random.normal(0, 0.1, (records, count)), axis=0)
    walk = 500 + np.cumsum(100 / 60 * np.stack([np.cos(turns), np.sin(turns)]), axis=1)
    rows = rows.assign(x=walk[0].ravel(), y=walk[1].ravel(), angle=np.angle(np.exp(1j * turns)).ravel())
    data = write(tmp_path / "run.feather", rows)
    first, again = (page_of(data).read_bytes() for _ in range(2))
    assert first == again
    assert len(first) < 5_000_000
    assert not re.search(rb"https?://", first)


def test_links_between_bodies_follow_them_until_they_are_cut(browser: Browser, tmp_path: Path) -> None:
    made = {**link_table(), "time_s": [9, 9]}
    changes = {"made": made, "cut": {"link": [0], "time_s": [1.5]}}
    page = show(browser, page_of(linked(tmp_path / "run.feather", link_table(), changes)))
    page.evaluate("replay.setTime(1.0)")
    spring, rod = page.evaluate("replay.bodyLinks")
    np.testing.assert_allclose(spring["from"], [166.667, 220.0], atol=0.1)  # from the front of a robot that heads down
    np.testing.assert_allclose(spring["to"], [500.0, 200.0], atol=0.1)
    assert (spring["kind"], spring["load"]) == ("spring", 1)
    np.testing.assert_allclose(rod["to"], [500.0, 900.0], atol=0.1)
    assert rod["load"] == 0
    x, y = page.evaluate("replay.screen(1)")
    box = page.locator("#arena").bounding_box()
    assert box is not None
    scale = page.evaluate("replay.screen(2)[0] - replay.screen(1)[0]") / 333.333
    shown = pixel(page, box["x"] + x - 100.0 * scale, box["y"] + y + 6.0 * scale)  # 100 mm from its end
    np.testing.assert_allclose(shown, [255, 122, 26], atol=60)  # pulled
    page.evaluate("replay.setTime(1.5)")
    assert [link["kind"] for link in page.evaluate("replay.bodyLinks")] == ["rod"]
    assert page.said == []  # type: ignore[attr-defined]
    page.close()
