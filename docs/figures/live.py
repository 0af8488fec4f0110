"""The picture of a live run: a screenshot of the page in Chromium.

    .venv/bin/python docs/figures/all.py live

It shows the run of conf/demo.yaml. The browser's fonts and drawing differ between machines more than matplotlib's, so
only what the run is like is compared, not the pixels.
"""

from __future__ import annotations

import shutil
import sys
import time
from pathlib import Path

import pandas as pd
from pictures import ROOT, Picture, fingerprint
from playwright.sync_api import Page, sync_playwright
from pogosim import Simulation
from pogosim.watch.serving import LivePage

NAMES = ("live.png",)
SEEN_S = 13.0  # simulated time of the picture
SELECTED = 24
LIMIT_S = 60.0


def wait(page: Page, expression: str) -> None:
    """Wait until an expression is true in the page."""
    end_s = time.monotonic() + LIMIT_S
    while not page.evaluate(expression):
        if time.monotonic() > end_s:
            sys.exit(f"the page of a live run does not come to {expression}")
        time.sleep(0.02)


def screenshot(simulation: Simulation) -> bytes:
    """Open the page of a run, go on, and return what it shows (PNG)."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        sys.exit("the picture of a live run needs chromium: sudo apt install chromium")
    with sync_playwright() as playwright, LivePage(simulation) as served:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1200, "height": 780})
        page.goto(served.address)
        wait(page, "Boolean(live.view)")
        page.evaluate(f"live.view.select({SELECTED}); live.view.switches.set('trails', true)")
        page.select_option("#colour", "messages_received")
        while simulation.time < SEEN_S:
            simulation.step(10)
            wait(page, f"Math.abs(live.view.state.time - {simulation.time}) < 1e-6")
        page.click("#adjust")
        wait(
            page,
            "document.querySelector('#robot').innerText.includes('USERDATA') || "
            "document.querySelector('#robot').innerText.includes('messages_received')",
        )
        time.sleep(1.0)  # values of the robot and the scale of colours come five times a second
        image = page.screenshot()
        browser.close()
    return image


def draw(_: Path) -> dict[str, Picture]:
    """Run the demonstration, and look at it."""
    program, configuration = ROOT / "examples" / "hanabi" / "hanabi.so", ROOT / "conf" / "demo.yaml"
    with Simulation(program, configuration, set={"enable_data_logging": False}) as simulation:
        image = screenshot(simulation)
        seen = pd.DataFrame(simulation.positions.copy(), columns=["x", "y"])
        seen["heard"] = simulation.messages_received
    return {"live.png": Picture(image, fingerprint(seen), is_exact=False)}
