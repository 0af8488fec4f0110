"""What films and frames cost: processor time for a frame of `pogosim film`, and for one that a run draws itself.

    .venv/bin/python bench/films.py

Runs examples/hanabi (./build.sh) with 100 and 1000 robots. Processor time is that of all threads and of ffmpeg, without
what a film of one frame takes.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "examples" / "hanabi" / "hanabi"
ROBOTS = (100, 1000)
DURATION_S = 10
FPS = 30
FRAMES = DURATION_S * FPS
FILMS: dict[str, tuple[dict[str, str], float | None]] = {
    "robots": ({}, None),
    "with links": ({"links": "below"}, None),
    "with trails": ({}, 5.0),
    "with both": ({"links": "below"}, 5.0),
}
PERIODS_S = (-1, 1, 0.1)  # of frames; -1: none


def spent_s(command: list[str], folder: Path) -> float:
    """Run a command; return its processor time."""
    before = os.times()
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def running(robots: int, *settings: str) -> list[str]:
    """Return the command of a run without a window."""
    every = (f"simulation_time={DURATION_S}", f"objects.robots.nb={robots}", f"arena_surface={robots * 1e4}", *settings)
    command = [str(PROGRAM), "-c", str(ROOT / "conf" / "demo.yaml"), "-g", "-q"]
    return [*command, *(f"--set={setting}" for setting in every)]


def drawing_ms(data: Path, view: dict[str, str], tail_s: float | None) -> float:
    """Return the processor time of drawing a frame, without ffmpeg."""
    import numpy as np
    from pogosim.film.frames import Frames, size_for
    from pogosim.picture.swarm import read_recording

    recording = read_recording(data)
    size = size_for(recording)
    frames = Frames(recording, size, {**view, "trails": tail_s is not None}, tail_s)
    frame = np.empty((size[1], size[0], 3), np.uint8)
    times_s = np.linspace(float(recording.times_s[0]), float(recording.times_s[-1]), FRAMES)
    frames.draw(times_s[0], frame)
    began_s = time.process_time()
    for time_s in times_s:
        frames.draw(time_s, frame)
    return 1e3 * (time.process_time() - began_s) / FRAMES


def measure_film(folder: Path, robots: int, name: str) -> None:
    """Print what a film costs."""
    view, tail_s = FILMS[name]
    options = [f"--view={key}={value}" for key, value in view.items()]
    options += [] if tail_s is None else ["--tail", f"{tail_s:g}"]
    film = [sys.executable, "-m", "pogosim", "film", "data.feather", "-o", "film.mp4", "--fps", str(FPS), *options]
    done = subprocess.run(film, cwd=folder, check=True, capture_output=True, text=True)
    frames = int(done.stdout.split(": ")[1].split(" ")[0])
    start_s = spent_s([*film, "--from", str(DURATION_S)], folder)
    each_ms = 1e3 * (spent_s(film, folder) - start_s) / (frames - 1)
    drawn_ms = drawing_ms(folder / "data.feather", view, tail_s)
    print(
        f"film of {robots:4d} robots, {name:12s} {each_ms:5.1f} ms per frame, {drawn_ms:.1f} of it drawing", flush=True
    )


def measure(folder: Path) -> None:
    """Print all times."""
    for robots in ROBOTS:
        spent_s(running(robots, "data_filename=data.feather"), folder)
        for name in FILMS:
            measure_film(folder, robots, name)
        for period_s in PERIODS_S:
            frames = (f"save_video_period={period_s}", "frames_name=f{:06.3f}.png", "enable_data_logging=false")
            name = "no frames" if period_s < 0 else f"a frame every {period_s:g} s"
            run_s = spent_s(running(robots, *frames), folder)
            print(f"run  of {robots:4d} robots for {DURATION_S} s, {name:20s} {run_s:5.2f} s", flush=True)


def main() -> int:
    """Run the command line; returns the exit code."""
    argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0]).parse_args()
    if find_spec("pogosim") is None:
        print(
            "films.py: No module named 'pogosim'; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr
        )
        return 2
    if not PROGRAM.is_file():
        print(f"films.py: {PROGRAM} is missing: ./build.sh builds it", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        try:
            measure(Path(folder))
        except subprocess.CalledProcessError as error:
            said = error.stderr if isinstance(error.stderr, str) else error.stderr.decode(errors="replace")
            print(f"films.py: {error}: {said.strip()}", file=sys.stderr)
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
