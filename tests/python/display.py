"""A display in memory (Xvfb), and a program whose window is on it, pressed and dragged as by a user."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from running import Settings, write_scene

Picture = npt.NDArray[np.uint8]

WIDTH, HEIGHT = 1400, 1100  # of the display
SCREEN = f"{WIDTH}x{HEIGHT}x24"
RELAY = Path(__file__).with_name("ssh_relay.py")
FIRST_PORT = 6000  # of display :0
LONGEST_S = 30.0  # that anything takes on a busy machine


def wait_for(is_done: Callable[[], object], what: str) -> None:
    """Wait until something is true."""
    end = time.monotonic() + LONGEST_S
    while not is_done():
        assert time.monotonic() < end, f"waited {LONGEST_S} s for {what}"
        time.sleep(0.02)


@dataclass
class Display:
    """A running X server."""

    name: str
    server: subprocess.Popen[bytes]

    @property
    def environment(self) -> dict[str, str]:
        """Environment of programs that open their windows there."""
        return {**os.environ, "DISPLAY": self.name}

    def xdotool(self, *arguments: str) -> str:
        """Let xdotool act on the display."""
        done = subprocess.run(
            ["xdotool", *arguments],
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=LONGEST_S,
            check=False,
        )
        return done.stdout.strip()

    def shot(self, window: str) -> Picture:
        """Return what a window shows, shape (height, width, 3)."""
        done = subprocess.run(
            ["xwd", "-id", window, "-silent"], env=self.environment, capture_output=True, timeout=LONGEST_S, check=True
        )
        return read_xwd(done.stdout)

    def close(self, window: str) -> None:
        """Ask a window to close, as a window manager does when its button is clicked."""
        xlib = ctypes.CDLL("libX11.so.6")
        xlib.XOpenDisplay.restype = ctypes.c_void_p
        xlib.XInternAtom.restype = ctypes.c_ulong
        connection = ctypes.c_void_p(xlib.XOpenDisplay(self.name.encode()))
        event = (ctypes.c_long * 24)()  # an XClientMessageEvent: type, serial, send_event, display, window, ...
        event[0], event[4], event[6] = 33, int(window), 32
        event[5] = xlib.XInternAtom(connection, b"WM_PROTOCOLS", 0)
        event[7] = xlib.XInternAtom(connection, b"WM_DELETE_WINDOW", 0)
        xlib.XSendEvent(connection, ctypes.c_ulong(int(window)), 0, ctypes.c_long(0), ctypes.byref(event))
        xlib.XCloseDisplay(connection)

    def go_away(self) -> None:
        """End the server, as when a connection breaks."""
        self.server.kill()
        self.server.wait()


def read_xwd(dump: bytes) -> Picture:
    """Pixels of a dump of xwd (32 bits per pixel, blue first): shape (height, width, 3), red first."""
    header = np.frombuffer(dump[:100], dtype=">u4")
    header_size, width, height, bytes_per_line, colours = (int(header[i]) for i in (0, 4, 5, 12, 19))
    start = header_size + 12 * colours
    rows = np.frombuffer(dump[start : start + height * bytes_per_line], dtype=np.uint8).reshape(height, bytes_per_line)
    return rows[:, : 4 * width].reshape(height, width, 4)[:, :, 2::-1]


@contextmanager
def open_display(*options: str) -> Iterator[Display]:
    """Start an X server without a screen, on the first free number; `options` are Xvfb's, such as "-auth", "FILE"."""
    assert shutil.which("Xvfb") and shutil.which("xdotool") and shutil.which("xwd"), (
        "install xvfb, xdotool and x11-apps"
    )
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", SCREEN, "-nolisten", "tcp", "-noreset", *options],
        pass_fds=[write_end],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as answer:
        number = answer.readline().strip()
    assert number, "Xvfb does not start"
    display = Display(f":{number}", server)
    try:
        yield display
    finally:
        server.terminate()
        server.wait()


@contextmanager
def forwarded(display: Display) -> Iterator[Display]:
    """Return a display as it is seen through `ssh -X`: X servers refuse shared memory to a process named ssh."""
    process = subprocess.Popen(
        ["ssh", RELAY, display.name.removeprefix(":")], executable=sys.executable, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        port = int(process.stdout.readline())
        yield Display(f"127.0.0.1:{port - FIRST_PORT}", display.server)
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


@dataclass
class Shown:
    """A program that runs in a window."""

    display: Display
    process: subprocess.Popen[bytes]
    folder: Path
    window: str  # number of X

    def keys(self, *names: str) -> None:
        """Press keys, named as xdotool does: F1, space, plus, shift+r."""
        self.display.xdotool("key", "--delay", "40", *names)

    def size(self) -> tuple[int, int]:
        """Width and height."""
        lines = self.display.xdotool("getwindowgeometry", "--shell", self.window).splitlines()
        values = dict(line.split("=") for line in lines)
        return int(values["WIDTH"]), int(values["HEIGHT"])

    def move_mouse(self, x: float, y: float) -> None:
        """Move to a pixel of the window."""
        self.display.xdotool("mousemove", "--window", self.window, str(round(x)), str(round(y)))

    def click(self, x: float, y: float, button: int = 1) -> None:
        """Click a pixel of the window."""
        self.move_mouse(x, y)
        time.sleep(0.1)
        self.display.xdotool("click", str(button))

    def drag(self, start: tuple[float, float], end: tuple[float, float], button: int = 1, steps: int = 8) -> None:
        """Drag from one pixel of the window to another."""
        self.move_mouse(*start)
        time.sleep(0.1)
        self.display.xdotool("mousedown", str(button))
        for i in range(1, steps + 1):
            self.move_mouse(*(a + (b - a) * i / steps for a, b in zip(start, end, strict=True)))
            time.sleep(0.05)
        time.sleep(0.1)
        self.display.xdotool("mouseup", str(button))

    def shot(self) -> Picture:
        """Return what the window shows, shape (height, width, 3)."""
        return self.display.shot(self.window)

    def wait_for_picture(self, is_right: Callable[[Picture], object], what: str) -> Picture:
        """Wait until the window shows something."""
        seen: list[Picture] = []

        def look() -> bool:
            seen[:] = [self.shot()]
            return bool(is_right(seen[0]))

        wait_for(look, what)
        return seen[0]

    def text(self) -> str:
        """All that the program has printed so far."""
        return (self.folder / "printed.txt").read_text()

    def end(self) -> tuple[int, str]:
        """Wait for the end of the program. Its exit code, and all it has printed."""
        return self.process.wait(timeout=LONGEST_S), self.text()

    def find_window(self) -> None:
        """Look for the window, and wait until there is a picture in it."""

        def look() -> bool:
            assert self.process.poll() is None, self.text()
            found = self.display.xdotool("search", "--onlyvisible", "--name", "Pogosim").split()
            self.window = found[-1] if found else ""
            return bool(self.window)

        wait_for(look, "a window")
        self.display.xdotool("windowfocus", self.window)
        self.wait_for_picture(lambda picture: picture.max() > 0, "a picture")


@contextmanager
def shown(
    display: Display, program: Path, folder: Path, settings: Settings | None = None, arguments: Sequence[str] = ()
) -> Iterator[Shown]:
    """Run a program in a window, with scene.yaml made in a folder."""
    write_scene(folder, {"GUI": True, **(settings or {})})
    with (folder / "printed.txt").open("w") as printed:
        process = subprocess.Popen(
            [str(program), "-c", "scene.yaml", *arguments],
            cwd=folder,
            env=display.environment,
            stdout=printed,
            stderr=subprocess.STDOUT,
        )
    try:
        window = Shown(display, process, folder, "")
        window.find_window()
        yield window
    finally:
        process.kill()
        process.wait()


SCALE = 0.95 * 800 / 1000  # pixels per mm of a square of 1 m in a window of 800 x 800 pixels


def pixel_of(x_mm: float, y_mm: float) -> tuple[float, float]:
    """Where a point of the square of 1 m is in a window of 800 x 800 pixels."""
    return 400 + (x_mm - 500) * SCALE, 400 + (y_mm - 500) * SCALE


def differ(a: Picture, b: Picture) -> bool:
    return a.shape != b.shape or bool((a != b).any())


def ended(window: Shown) -> str:
    """Text of a run that the user ends with Esc."""
    window.keys("Escape")
    code, text = window.end()
    assert code == 0, text
    return text
