"""The picture of a replay: a screenshot of the page in Chromium.

    .venv/bin/python docs/figures/all.py replay

It shows the run of conf/demo.yaml. The browser's fonts and drawing differ between machines more than matplotlib's, so
only the data are compared, not the pixels.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from pictures import ROOT, Picture, fingerprint
from playwright.sync_api import sync_playwright
from pogosim.film.command import main as make_film
from pogosim.utils import load_dataframe

NAMES = ("replay.png",)

SCRIPT = "replay.setTime(12.8); replay.select(24)"
OPTIONS = ("--tail", "4", "--links")


def screenshot(page: Path) -> bytes:
    """Open the page, and return what it shows (PNG)."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        sys.exit("the picture of a replay needs chromium: sudo apt install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        opened = browser.new_page(viewport={"width": 1100, "height": 760})
        opened.goto(page.as_uri())
        opened.evaluate("replay.ready")
        opened.evaluate(SCRIPT)
        opened.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        image = opened.screenshot()
        browser.close()
    return image


def draw(folder: Path) -> dict[str, Picture]:
    """Run the demonstration, and replay it."""
    data, page = folder / "data.feather", folder / "run.html"
    command = ["examples/hanabi/hanabi", "-c", "conf/demo.yaml", "-g", "-q", "--set", f"data_filename={data}"]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)
    if code := make_film([str(data), "-o", str(page), *OPTIONS]):
        sys.exit(code)
    return {"replay.png": Picture(screenshot(page), fingerprint(load_dataframe(data)[0]), is_exact=False)}
