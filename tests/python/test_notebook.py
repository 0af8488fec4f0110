"""Live views in notebooks: a kernel that runs cells, and JupyterLab itself with a browser that clicks."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import nbclient
import nbformat
import numpy as np
import pogosim
import pytest
from chromium import CHROMIUM
from live_client import Client, wait_for
from playwright.sync_api import Browser, Page
from running import ROOT, write_scene

WIDGET = "application/vnd.jupyter.widget-view+json"
TOKEN = "for-the-test"
LIMIT_S = 60.0


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_scene(
        tmp_path, {"simulation_time": 600.0, "objects.robots.nb": 10, "seed": 2, "parameters": {"gain": 2.0}}
    )


@pytest.fixture(autouse=True)
def _simulator(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


def notebook_of(hosted: Path, scene: Path, *cells: str) -> nbformat.NotebookNode:
    first = f"import pogosim\nsim = pogosim.Simulation({str(hosted)!r}, {str(scene)!r})\nsim"
    own: list[dict[str, Any]] = [
        {
            "cell_type": "code",
            "id": f"cell{i}",
            "metadata": {},
            "execution_count": None,
            "outputs": [],
            "source": source,
        }
        for i, source in enumerate((first, *cells))
    ]
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": own}
    return nbformat.from_dict(notebook)  # type: ignore[no-any-return, no-untyped-call]


def test_executed_notebook_has_a_view_and_a_picture(hosted: Path, scene: Path, tmp_path: Path) -> None:
    notebook = notebook_of(hosted, scene, "sim.step(10); print(sim.time)", "sim.close()", "sim")
    nbclient.NotebookClient(notebook, timeout=LIMIT_S, resources={"metadata": {"path": str(tmp_path)}}).execute()
    still, view = (output["data"] for output in notebook.cells[0]["outputs"] if "data" in output)  # warnings beside
    assert '<img class="pogosim-still-' in still["text/html"]
    assert "data:image/png;base64," in still["text/html"]
    assert WIDGET in view
    assert notebook.cells[1]["outputs"][0]["text"] == "0.1\n"
    (closed,) = notebook.cells[3]["outputs"]
    assert list(closed["data"]) == ["text/plain"]
    assert "closed" in closed["data"]["text/plain"]


class Cell(Client):
    """What a view of a widget in a page would be told."""

    def __init__(self, view: Any, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        super().__init__()
        self.view, self.name = view, name
        others = view.send

        def send(content: dict[str, Any], buffers: list[bytes] | None = None) -> None:
            if content["to"] == name:
                self.take(buffers[0] if buffers else content["message"])
            else:
                others(content, buffers)

        monkeypatch.setattr(view, "send", send)
        self.send({"do": "join"})
        wait_for(lambda: self.pictures)

    def send(self, message: Any) -> None:
        self.view._hear(self.view, {"view": self.name, "message": message}, [])


def test_messages_of_views_are_checked(sim: pogosim.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    view = sim.view()
    cell = Cell(view, "one", monkeypatch)
    for content in (None, 5, {}, {"view": 1}, {"view": "one"}, {"view": "unknown", "message": {"do": "play"}}):
        view._hear(view, content, [])
    for message in (None, {}, {"do": "nothing"}, {"do": "step", "steps": -1}, "{"):
        cell.send(message)
    assert len(wait_for(lambda: len(cell.of_kind("refused")) >= 6 and cell.of_kind("refused"))) == 6
    assert sim.steps == 0
    cell.send({"do": "step", "steps": 3})
    wait_for(lambda: sim.steps == 3)
    cell.send({"do": "leave"})
    cell.send({"do": "step", "steps": 3})
    view.pause()
    assert sim.steps == 3


def test_view_plays_and_pauses_from_python(sim: pogosim.Simulation) -> None:
    view = sim.view(height_px=300)
    assert view.height == 300
    view.play(speed=4.0)
    wait_for(lambda: sim.time > 0.3)
    view.pause()
    at = sim.steps
    assert sim.step(5) == 5
    assert sim.steps == at + 5
    for speed in (0.0, -1.0, float("nan"), "fast"):
        with pytest.raises(pogosim.ConfigurationError, match="speed: expected a number above 0"):
            view.play(speed)  # type: ignore[arg-type]
    for height in (5, 10_000, "tall"):
        with pytest.raises(pogosim.ConfigurationError, match="height"):
            sim.view(height_px=height)  # type: ignore[arg-type]


def test_still_picture_is_drawn_once_for_each_pause(sim: pogosim.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    view = sim.view()
    drawn: list[int] = []

    class Handle:
        def update(self, _: Any) -> None:
            drawn.append(sim.steps)

    monkeypatch.setattr(view, "_stills", [Handle()])
    cells = [Cell(view, name, monkeypatch) for name in "ab"]
    wait_for(lambda: all(cell.status.get("viewers") == 2 for cell in cells[:1]))
    assert drawn == [0]
    view.play()
    wait_for(lambda: sim.steps > 3)
    view.pause()
    assert drawn == [0, sim.steps]


def test_run_pauses_when_its_last_view_is_gone(sim: pogosim.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    view = sim.view()
    cell = Cell(view, "one", monkeypatch)
    view.play()
    wait_for(lambda: sim.steps > 3)
    cell.send({"do": "leave"})
    wait_for(lambda: not view._live.status.is_playing)
    sim.close()
    wait_for(lambda: not view._live.is_alive)
    with pytest.raises(pogosim.SimulationError, match="closed"):
        sim.view()


def test_missing_package_is_named(hosted: Path, scene: Path) -> None:
    code = (
        "import sys; sys.modules['anywidget'] = None\nimport pogosim\n"
        f"sim = pogosim.Simulation({str(hosted)!r}, {str(scene)!r})\n"
        "try:\n    sim.view()\nexcept pogosim.SimulationError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert "a live view needs the Python package 'anywidget'; install it:" in done.stdout


# ---- JupyterLab


@dataclass
class Lab:
    """A JupyterLab that runs."""

    folder: Path
    port: int

    def call(self, path: str, method: str = "GET") -> Any:
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}?token={TOKEN}", method=method)
        with urllib.request.urlopen(request, timeout=20) as answer:
            content = answer.read()
        return json.loads(content) if content else None

    def end_kernels(self) -> None:
        for kernel in self.call("/api/kernels"):
            self.call(f"/api/kernels/{kernel['id']}", "DELETE")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    folder = tmp_path_factory.mktemp("lab")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    own = {name: str(folder / name) for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR")}
    environment = {**os.environ, **own, "POGOSIM_DIR": str(ROOT), "IPYTHONDIR": str(folder / "ipython")}
    options = ("--no-browser", "--allow-root", f"--port={port}", f"--IdentityProvider.token={TOKEN}")
    with (folder / "log").open("w") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "jupyterlab", *options, f"--ServerApp.root_dir={folder}"],
            stdout=log,
            stderr=log,
            env=environment,
        )
        started = Lab(folder, port)

        def answers() -> bool:
            assert process.poll() is None, (folder / "log").read_text()
            with contextlib.suppress(OSError):
                return bool(started.call("/api/kernels") == [])
            return False

        try:
            wait_for(answers, LIMIT_S)
            yield started
            started.end_kernels()
        finally:
            process.terminate()
            process.wait(30)


def open_notebook(browser: Browser, lab: Lab, name: str) -> Page:
    page = browser.new_page(viewport={"width": 1200, "height": 1000})
    page.set_default_timeout(1000 * LIMIT_S)
    page.goto(f"http://127.0.0.1:{lab.port}/lab/tree/{name}?token={TOKEN}&reset")
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    wait_for(lambda: "Idle" in page.inner_text("#jp-bottom-panel, #jp-main-statusbar"), LIMIT_S)
    return page


def run_cell(page: Page, number: int) -> None:
    page.locator(".jp-Notebook .jp-Cell").nth(number).locator(".cm-content").click()
    page.keyboard.press("Shift+Enter")


def printed(page: Page, number: int) -> str:
    output = page.locator(".jp-Notebook .jp-Cell").nth(number).locator(".jp-OutputArea-output")
    return str(wait_for(lambda: output.count() and output.last.inner_text(), LIMIT_S)).strip()


def saved_outputs(file: Path) -> str:
    """Return the outputs of the first cell of a notebook, nothing while it is being written."""
    try:
        return str(json.loads(file.read_text())["cells"][0]["outputs"])
    except ValueError:
        return ""


LIVE = "[...document.querySelectorAll('.jp-Notebook *')].filter((own) => own.live).map((own) => own.live)"


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: on macOS, none is installed for tests")
def test_view_in_jupyterlab(browser: Browser, lab: Lab, hosted: Path, scene: Path) -> None:
    """Cells return while it plays; what cells read is what the picture shows; a saved notebook keeps the last one."""
    cells = ("sim.view()", "at = sim.steps; sim.step(5); print(sim.steps - at >= 5)", "print(sim.positions.tolist())")
    (lab.folder / "run.ipynb").write_text(json.dumps(notebook_of(hosted, scene, *cells)))
    page = open_notebook(browser, lab, "run.ipynb")
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))

    run_cell(page, 0)
    wait_for(lambda: page.evaluate(f"{LIVE}.length === 1 && Boolean({LIVE}[0].view)"), LIMIT_S)
    run_cell(page, 1)  # a second view of the same run
    wait_for(lambda: page.evaluate(f"{LIVE}.length === 2 && Boolean({LIVE}[1].view)"), LIMIT_S)
    assert page.locator("img[class^=pogosim-still]").count() == 2
    assert not any(picture.is_visible() for picture in page.locator("img[class^=pogosim-still]").all())

    page.locator("#play").first.click()
    wait_for(lambda: page.evaluate(f"{LIVE}.every((own) => own.view.state.time > 0.5)"), LIMIT_S)
    run_cell(page, 2)  # while it plays
    assert printed(page, 2) == "True"
    page.locator("#play").nth(1).click()
    wait_for(lambda: page.evaluate(f"{LIVE}.every((own) => !own.view.player.isPlaying)"), LIMIT_S)
    run_cell(page, 3)
    places = np.array(json.loads(printed(page, 3)))

    def shows_places() -> bool:
        seen = page.evaluate(f"{LIVE}.map((own) => own.view.poses.map(({{x, y}}) => [x, y]))")
        return all(np.allclose(own, places, atol=0.02) for own in seen)

    wait_for(shows_places, LIMIT_S)
    page.screenshot(path=lab.folder / "live.png")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+s")
    time_s = page.evaluate(f"{LIVE}[0].view.state.time")
    wait_for(lambda: f"t = {time_s:g} s" in saved_outputs(lab.folder / "run.ipynb"), LIMIT_S)
    assert errors == []
    page.close()

    lab.end_kernels()
    page = open_notebook(browser, lab, "run.ipynb")
    wait_for(lambda: page.locator("img[class^=pogosim-still]").first.is_visible(), LIMIT_S)
    page.screenshot(path=lab.folder / "saved.png")
    page.close()
