"""The pages of live runs and of replays in Firefox; tests of each control are in Chromium (test_live_page.py)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pogosim
import pytest
from firefox import FIREFOX, Firefox, firefox
from live_client import wait_for
from pogosim.command.watch import listening
from pogosim.film.command import main as make_film
from pogosim.watch.live import LiveRun
from pogosim.watch.page import watch_page
from pogosim.watch.server import WatchServer
from pogosim.watch.serving import served_in_thread
from recordings import walkers, write
from running import write_scene

pytestmark = pytest.mark.skipif(FIREFOX is None, reason="no Firefox: on macOS, none is installed for tests")


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Firefox]:
    with firefox(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_scene(tmp_path, {"simulation_time": 60.0, "objects.robots.nb": 8})


def test_live_run(browser: Firefox, sim: pogosim.Simulation) -> None:
    live = LiveRun(sim)
    server = WatchServer(live, watch_page("a run"))
    with listening("127.0.0.1", 0) as own, served_in_thread(server, own):
        browser.open(f"http://127.0.0.1:{own.getsockname()[1]}/?token={server.tokens.steer}")
        wait_for(lambda: browser.value("Boolean(live.view)"))
        play = browser.value("(({x, y}) => [x + 5, y + 5])(document.getElementById('play').getBoundingClientRect())")
        browser.click(*play)
        wait_for(lambda: sim.time > 0.3)
        browser.click(*play)
        wait_for(lambda: not live.status.is_playing)
        wait_for(lambda: browser.value("live.view.state.time") == sim.time)
        places = browser.value("live.view.poses.map(({x, y}) => [x, y])")
        np.testing.assert_allclose(places, sim.positions, atol=0.02)
        browser.click(*browser.value("live.view.camera.toScreen(live.view.poses[3].x, live.view.poses[3].y)"))
        wait_for(lambda: "levels[1]" in browser.value("document.getElementById('robot').innerText"))
        assert len(browser.picture()) > 10_000
    live.end()


def test_replay(browser: Firefox, tmp_path: Path) -> None:
    data, page = write(tmp_path / "run.feather", walkers()), tmp_path / "run.html"
    assert make_film([str(data), "-o", str(page)]) == 0
    browser.open(page.as_uri())
    browser.value("replay.ready")
    browser.value("replay.setTime(replay.times[replay.times.length - 1])")
    assert browser.value("replay.time") == browser.value("replay.times[replay.times.length - 1]")
    wait_for(lambda: browser.value("replay.frames") > 0)
    assert len(browser.picture()) > 10_000
