"""Our defaults beside the settings of conf/original.yaml: statistics of four studies, and a figure.

    .venv/bin/python docs/figures/all.py original    # takes a minute

Both are runs of this simulator; nothing of another one is run.
"""

from __future__ import annotations

import copy
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.analysis.directions import directions_of_headings
from pogosim.analysis.motion import speed
from pogosim.analysis.order import polar_order
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from pogosim.analysis.walls import distance_to_walls
from pogosim.utils import load_dataframe
from quotes import Quote

NAMES = ("original.png", "original.md: statistics")
SEEDS = 3
DURATION_S = 50.0
NEAR_MM = 10.0  # from a robot's border to a wall
RED = 0xFF0000  # a particle of active_brownian_particles that is stuck
LAG_S = 5.0

TOP_LEVEL = (
    "arena_stretch",
    "physics_engine",
    "save_data_times",
    "wall_friction",
    "wall_message_copies",
    "wall_restitution",
)
OF_ROBOTS = ("imu_acceleration", "message_queue_size", "msg_success_rate")

Settings = dict[str, Any]


@dataclass(frozen=True)
class Run:
    """What a run has left."""

    of_robots: Trajectories
    rows: pd.DataFrame
    messages: pd.DataFrame  # the message log

    @property
    def duration_s(self) -> float:
        """Time of the last rows."""
        return float(self.of_robots.time_s[-1])


def mean_speed(run: Run) -> float:
    """Return the mean over robots and times, mm/s."""
    return float(np.nanmean(speed(run.of_robots)))


def share_near_walls(run: Run) -> float:
    """Return the share of robots and times within some millimetres of a wall, in the second half."""
    own = run.of_robots
    later = own.time_s > run.duration_s / 2.0
    near = distance_to_walls(own.arena, own.position_mm[later]) < own.radius_mm + NEAR_MM
    return 100.0 * float(near.mean())


def displacement(run: Run) -> float:
    """Return the root mean squared displacement after some seconds, mm. Rows need not be evenly spaced."""
    own = run.of_robots
    first = np.flatnonzero(own.time_s <= run.duration_s - LAG_S)
    last = np.abs(own.time_s[None, :] - own.time_s[first, None] - LAG_S).argmin(axis=1)
    moved = own.path_mm[last] - own.path_mm[first]
    return float(np.sqrt((moved**2).sum(axis=2).mean()))


def order(run: Run) -> float:
    """Return the mean polar order in the second half."""
    later = run.of_robots.time_s > run.duration_s / 2.0
    return float(np.nanmean(polar_order(directions_of_headings(run.of_robots))[later]))


def share_stuck(run: Run) -> float:
    """Return the share of robots and times that back out, since they feel stuck."""
    robots = run.rows[run.rows["robot_category"] == "robots"]
    return 100.0 * float((robots["led_rgb"] == RED).mean())


def copies_of_walls(run: Run) -> float:
    """Return the copies of messages from walls that a robot finds in its queue, per second."""
    own = run.messages[run.messages["sender_category"] == "walls"]
    return float(own["copies"].sum()) / len(run.of_robots.robot_id) / run.duration_s


@dataclass(frozen=True)
class Study:
    """An example with its configuration, and what is measured."""

    program: str
    configuration: str
    statistics: Mapping[str, Callable[[Run], float]]  # by name, with unit


STUDIES = (
    Study(
        "run_and_tumble",
        "simple",
        {
            "mean speed, mm/s": mean_speed,
            f"displacement in {LAG_S:g} s, mm": displacement,
            f"robots within {NEAR_MM:g} mm of a wall, %": share_near_walls,
        },
    ),
    Study("vicsek", "vicsek", {"mean speed, mm/s": mean_speed, "polar order": order}),
    Study(
        "active_brownian_particles",
        "active_brownian_particles",
        {
            "mean speed, mm/s": mean_speed,
            f"displacement in {LAG_S:g} s, mm": displacement,
            "robots that feel stuck, %": share_stuck,
            f"robots within {NEAR_MM:g} mm of a wall, %": share_near_walls,
        },
    ),
    Study(
        "avoid_walls",
        "active_objects",
        {
            "copies of messages from walls, per robot and s": copies_of_walls,
            "mean speed, mm/s": mean_speed,
            f"robots within {NEAR_MM:g} mm of a wall, %": share_near_walls,
        },
    ),
)


def read(name: str) -> Settings:
    """Return a configuration of conf/."""
    settings: Settings = yaml.safe_load((ROOT / "conf" / f"{name}.yaml").read_text(encoding="utf-8"))
    return settings


def as_originally(settings: Settings) -> Settings:
    """Return a configuration with the settings of conf/original.yaml."""
    original = read("original")
    changed = copy.deepcopy(settings) | {key: original[key] for key in TOP_LEVEL}
    changed["objects"]["robots"] |= {key: original["objects"]["robots"][key] for key in OF_ROBOTS}
    return changed


def run_of(study: Study, settings: Settings, seed: int, folder: Path) -> Run:
    """Run an example with a configuration."""
    folder.mkdir()
    own = settings | {"seed": seed, "GUI": False, "save_video_period": -1, "enable_console_logging": False}
    own |= {"data_filename": str(folder / "data.feather"), "message_log": str(folder / "messages.feather")}
    own |= {"simulation_time": min(float(settings["simulation_time"]), DURATION_S), "data_logger_led": True}
    path = folder / "own.yaml"
    path.write_text(yaml.safe_dump(own, sort_keys=False), encoding="utf-8")
    program = ROOT / "examples" / study.program / study.program
    subprocess.run([program, "-c", path, "-g", "-q"], cwd=ROOT, check=True, timeout=300, stderr=subprocess.DEVNULL)
    rows, _ = load_dataframe(folder / "data.feather")
    messages, _ = load_dataframe(folder / "messages.feather")
    (of_robots,) = trajectories_of(rows, category="robots")
    return Run(of_robots, rows, messages)


def measured(folder: Path) -> pd.DataFrame:
    """Return a row for each study, setting and seed, and statistic."""
    found: list[dict[str, object]] = []
    for study in STUDIES:
        settings = read(study.configuration)
        for name, own in {"our defaults": settings, "conf/original.yaml": as_originally(settings)}.items():
            for seed in range(SEEDS):
                run = run_of(study, own, seed, folder / f"{study.program}_{len(found)}")
                found += [
                    {
                        "example": study.program,
                        "statistic": statistic,
                        "settings": name,
                        "seed": seed,
                        "value": round(compute(run), 9),
                    }
                    for statistic, compute in study.statistics.items()
                ]
    return pd.DataFrame(found)


def with_spread(values: pd.Series[float]) -> str:
    """Return the mean and the standard deviation of runs, which has one digit."""
    return f"{values.mean():.3g} +- {float(f'{values.std():.1g}'):g}"


def table(found: pd.DataFrame) -> Quote:
    """Return means and standard deviations, in Markdown."""
    lines = ["| example | statistic | our defaults | `conf/original.yaml` |", "|---|---|---|---|"]
    for study in STUDIES:
        for statistic in study.statistics:
            own = found[(found["example"] == study.program) & (found["statistic"] == statistic)]
            cells = [with_spread(own["value"][own["settings"] == name]) for name in own["settings"].unique()]
            lines.append(f"| {study.program} | {statistic} | {' | '.join(cells)} |")
    return Quote(tuple(lines))


def figure_of(found: pd.DataFrame) -> Figure:
    """Draw the values of all runs, a panel for each statistic."""
    pairs = [(study.program, statistic) for study in STUDIES for statistic in study.statistics]
    columns = 4
    figure = Figure(figsize=(11.0, 2.4 * -(-len(pairs) // columns)), layout="constrained")
    panels = figure.subplots(-(-len(pairs) // columns), columns).ravel()
    for axes, (program, statistic) in zip(panels, pairs, strict=False):
        own = found[(found["example"] == program) & (found["statistic"] == statistic)]
        for place, (colour, name) in enumerate(zip(("#1b6ca8", "#a8321b"), own["settings"].unique(), strict=True)):
            values = own["value"][own["settings"] == name]
            axes.plot([place] * len(values), values, "o", color=colour, alpha=0.6)
            axes.plot(place, values.mean(), "_", color=colour, markersize=24, markeredgewidth=2)
        axes.set_xlim(-0.6, 1.6)
        axes.set_ylim(0.0, 1.15 * own["value"].max())
        axes.set_xticks([0, 1], ["ours", "original"])
        axes.set_title(f"{program.replace('_', ' ')}\n{statistic}", fontsize=8)
        axes.grid(axis="y", color="0.9")
    for axes in panels[len(pairs) :]:
        axes.set_axis_off()
    return figure


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Run all studies with both settings."""
    found = measured(folder)
    return {"original.png": from_figure(figure_of(found), 90, found), "original.md: statistics": table(found)}
