"""The picture of the window: a screenshot of the demonstration, conf/demo.yaml, while colours spread.

    .venv/bin/python docs/figures/all.py window

Needs Xvfb, xdotool and xwd, like the tests of the window. The run stands still and is advanced step by step with the
key S, so that the picture shows the same moment on every machine, however busy.
"""

from __future__ import annotations

import io
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
from pictures import ROOT, Picture, fingerprint
from PIL import Image
from pogosim.utils import load_dataframe
from quotes import Quote, paragraph

sys.path.append(str(ROOT / "tests" / "python"))

from display import Display, open_display, read_xwd, wait_for

NAMES = ("window.png", "window.md: caption")

WIDTH, HEIGHT = 1240, 740  # pixels
FIT = 0.95  # share of the window that the arena fills
FIRST_S, LAST_S = 8, 30  # the picture shows a second between these
COLOURS, ROBOTS = 3, 15  # that many colours, with that many robots each, are on their way then
STEP_S = 0.01  # time_step of conf/demo.yaml
ROBOT = 24  # the one that is selected
NO_LIMIT = (187, 102)  # "max" in the panel "Run"
VIEW_HEADER = (60, 168)
BESIDE = (120, 600)  # nothing there

SETTINGS: dict[str, object] = {
    "window_width": WIDTH,
    "window_height": HEIGHT,
    "GUI_speed_up": 1.0e-6,  # the second step is not due before it is paused
    "show_trajectory_traces": "true",
    "show_communication_channels": "true",
}


def colours(rows: pd.DataFrame) -> list[int]:
    """Return how many robots have each colour in one state, the most frequent one first."""
    return rows["rgb_colors_index"].value_counts().tolist()


def moment(rows: pd.DataFrame) -> tuple[int, list[int]]:
    """Return the first second at which several colours are on their way, and how many robots have each."""
    for second in range(FIRST_S, LAST_S + 1):
        counts = colours(rows[np.isclose(rows["time"], second, atol=1e-3)])
        if len(counts) >= COLOURS and counts[COLOURS - 1] >= ROBOTS:
            return second, counts
    sys.exit(f"no {COLOURS} colours have {ROBOTS} robots each from {FIRST_S} to {LAST_S} s: choose another seed")


def place_of(data: Path, robot: int) -> tuple[int, int]:
    """Return the pixel at which the last row of a robot is."""
    rows, metadata = load_dataframe(data)
    outline = metadata["arena_polygons"][0]
    low, high = outline.min(axis=0), outline.max(axis=0)
    scale = FIT * min(WIDTH / (high[0] - low[0]), HEIGHT / (high[1] - low[1]))
    place = rows.loc[rows["robot_id"] == robot, ["x", "y"]].iloc[-1].to_numpy()
    x, y = np.array([WIDTH, HEIGHT]) / 2 + scale * (place - (low + high) / 2)
    return round(x), round(y)


class Screen:
    """The window of a run."""

    def __init__(self, display: Display) -> None:
        self.display = display
        wait_for(self.find, "the window")
        display.xdotool("windowfocus", "--sync", self.window)
        wait_for(lambda: np.asarray(self.shot()).any(), "a picture")

    def find(self) -> bool:
        """Look for the window."""
        self.window = self.display.xdotool("search", "--onlyvisible", "--name", "Pogosim")
        return bool(self.window)

    def point(self, place: tuple[int, int]) -> None:
        """Move the mouse to a pixel."""
        self.display.xdotool("mousemove", "--window", self.window, *map(str, place))

    def click(self, place: tuple[int, int]) -> None:
        """Click a pixel."""
        self.point(place)
        self.display.xdotool("sleep", "0.3", "click", "1", "sleep", "0.3")

    def shot(self) -> Image.Image:
        """Return what the window shows."""
        command = ["xwd", "-id", self.window, "-silent"]
        dump = subprocess.run(command, env=self.display.environment, capture_output=True, timeout=30, check=True)
        return Image.fromarray(np.ascontiguousarray(read_xwd(dump.stdout)))

    def still(self) -> Image.Image:
        """Return what the window shows once nothing moves."""
        pictures = [self.shot()]

        def is_still() -> bool:
            time.sleep(1.0)
            pictures.append(self.shot())
            return pictures[-2] == pictures[-1]

        wait_for(is_still, "the last step")
        return pictures[-1]


def advance(screen: Screen, seconds: int) -> None:
    """Press S for each step."""
    for _ in range(round(seconds / STEP_S) // 10):
        screen.display.xdotool("key", "--delay", "0", "--repeat", "10", "--repeat-delay", "1", "s")


def picture_of(image: Image.Image, rows: pd.DataFrame) -> Picture:
    """Describe a screenshot and what it shows."""
    buffer = io.BytesIO()
    image.save(buffer, format="png")
    return Picture(buffer.getvalue(), fingerprint(rows))


def command_with(data: Path, settings: dict[str, object]) -> list[str]:
    """Return the command of a run."""
    command = [str(ROOT / "examples/hanabi/hanabi"), "-c", str(ROOT / "conf/demo.yaml"), "-q"]
    for key, value in {**settings, "data_filename": data}.items():
        command += ["--set", f"{key}={value}"]
    return command


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Run the demonstration in a window on a display in memory."""
    whole, alone, data = (folder / f"{name}.feather" for name in ("whole", "alone", "data"))
    subprocess.run([*command_with(whole, {"simulation_time": LAST_S}), "-g"], check=True, timeout=120)
    second, counts = moment(load_dataframe(whole)[0])
    subprocess.run([*command_with(alone, {"simulation_time": second}), "-g"], check=True, timeout=120)
    with open_display() as display:
        command = command_with(data, SETTINGS)
        with subprocess.Popen(command, cwd=folder, env=display.environment) as run:
            screen = Screen(display)
            display.xdotool("key", "space")
            screen.click(NO_LIMIT)
            screen.click(NO_LIMIT)  # real time again
            advance(screen, second)
            screen.still()
            screen.click(place_of(alone, ROBOT))
            screen.click(VIEW_HEADER)
            screen.point(BESIDE)
            window = screen.still()
            display.xdotool("key", "Escape")
            if code := run.wait(timeout=30):
                sys.exit(f"{command[0]} ended with exit code {code}")
    rows = load_dataframe(data)[0]
    if not rows.equals(load_dataframe(alone)[0]):
        sys.exit(f"the window shows t = {rows['time'].max()} s of {second} s, or another run")
    return {"window.png": picture_of(window, rows), "window.md: caption": caption(second, counts)}


def caption(second: int, counts: list[int]) -> Quote:
    """Say what the picture shows."""
    shares = f"{', '.join(map(str, counts[:-1]))} and {counts[-1]}"
    return paragraph(
        f"*The demonstration after {second} s, with trails (F2) and links between robots that hear each other (F5). "
        f"New colours have spread to {shares} robots. Robot {ROBOT} is selected.*"
    )
