"""One policy as a program in C, as firmware and as a host's brain: a picture and numbers; and what policies take.

    .venv/bin/python docs/figures/all.py exported_policy

The policy is that of examples/policy. Its firmware is made by the robots' compiler.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
import pogosim
from loads import project_of
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pictures import ROOT, Picture, from_figure
from pogosim.firmware.making import made_in
from pogosim.installation import find_installation
from pogosim.policy import Dense, Gru, Network, Policy, network_of
from pogosim.policy.c_header import header_of
from pogosim.policy.choices import NUMBERS
from pogosim.policy.example_steps import example_steps
from pogosim.policy.measuring import measure
from pogosim.policy.network import Layer
from pogosim.swarm_picture import INK, PAPER
from pogosim.utils import load_dataframe
from quotes import Quote, paragraph

NAMES = ("policy_export.png", "policy_export.md: report", "policy_export.md: alike", "policy_export.md: sizes")
FOLDER = ROOT / "examples" / "policy"
CONFIGURATION = ROOT / "conf" / "policy.yaml"
DURATION_S = 20.0
PERIOD_S = 0.1
BEFORE_CONTACTS_S = 2.0
STEP_S = 0.01
LAMP_MM = (800.0, 564.0)
COLOURS = {"program in C": "#1f6f8b", "host, int16": "#c0392b", "host, float": "#d9a441", "host, int8": "#5b8c5a"}

Floats = npt.NDArray[np.float64]


def observe(photosensors: npt.NDArray[np.int16]) -> npt.NDArray[np.int32]:
    """Return the inputs of the policy, as the example's main.c computes them."""
    back, left, right = np.moveaxis(photosensors.astype(np.int32), -1, 0)
    return np.stack([(back + left + right) // 3, (left + right) // 2 - back, right - left], axis=-1)


def of_program(command: Sequence[str | Path], data: Path) -> Floats:
    """Run a program or a firmware. Returns where its robots are: shape (times, robots, 2), mm."""
    settings = {
        "seed": 1,
        "simulation_time": DURATION_S,
        "save_data_period": PERIOD_S,
        "data_filename": data,
        "GUI": "false",
    }
    sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([*command, "-c", CONFIGURATION, "-g", "-q", "-nr", *sets], cwd=ROOT, check=True, capture_output=True)
    rows = load_dataframe(data)[0]
    robots = rows[rows["robot_category"] == "robots"].sort_values(["time", "robot_id"])
    return robots[["x", "y"]].to_numpy(dtype=float).reshape(robots["time"].nunique(), -1, 2)


def of_host(policy: Policy) -> Floats:
    """Let Python drive the robots. Returns where they are, as above."""
    settings = {
        "objects.robots.brain": "host",
        "simulation_time": DURATION_S + 1,
        "enable_data_logging": False,
    }
    places = []
    every = round(PERIOD_S / STEP_S)
    with pogosim.Simulation(None, CONFIGURATION, seed=1, set=settings) as sim:
        brain = sim.brain("robots")
        for step in range(round(DURATION_S / STEP_S) + 1):
            if step % every == 0:
                places.append(sim.positions.copy())
            if step > 0:  # sensors are read at the first tick
                brain.motors[:, :2] = np.rint(policy.step(observe(brain.photosensors)))
            sim.step()
    return np.array(places)


def policy_in(numbers: str) -> Policy:
    """Return the policy of the example."""
    observations = np.load(FOLDER / "observations.npz")["observations"]
    return Policy.load(FOLDER / "phototaxis.npz", numbers=numbers, calibration=observations)


def draw_paths(axes: Axes, places: Floats) -> None:
    """Draw where robots go."""
    for robot in range(places.shape[1]):
        axes.plot(*places[:, robot].T, color=COLOURS["program in C"], linewidth=0.8, alpha=0.7)
    axes.plot(*places[0].T, ".", color="#b8b2a3", markersize=5)
    axes.plot(*places[-1].T, "o", color=INK, markersize=4)
    axes.set_aspect("equal")
    axes.invert_yaxis()
    axes.axis("off")
    axes.set_title("20 s, from grey to black", color=INK, fontsize=10)


def distances(places: Floats, others: Floats) -> Floats:
    """Return how far each robot is from where it is in another run. Shape (times, robots), mm."""
    return np.asarray(np.hypot(*np.moveaxis(places - others, -1, 0)))


def to_middle(places: Floats) -> Floats:
    """Return the mean distance of the robots from the lamp's middle, over time, mm."""
    return np.asarray(np.hypot(*np.moveaxis(places - LAMP_MM, -1, 0)).mean(axis=1))


def large_policy() -> Network:
    """Return a GRU of a size that remembers something: 8 inputs, 16 units, 2 outputs."""
    random = np.random.default_rng(1)

    def some(*shape: int) -> npt.NDArray[np.float32]:
        return random.normal(0, 0.3, shape).astype(np.float32)

    layers: list[Layer] = [Gru(some(48, 8), some(48, 16), some(48), some(48)), Dense(some(2, 16), some(2), "hardtanh")]
    return network_of(layers, input_scale=1e-3, output_scale=1023, input_low=-1000, input_high=1000)


def sizes() -> Quote:
    """Return what a call takes on an emulated robot, of two policies with all kinds of numbers."""
    installed = find_installation()
    rows = [
        "| policy | numbers | program | state | multiplications | cycles | of a tick |",
        "|---|---|---|---|---|---|---|",
    ]
    for numbers in NUMBERS:
        for policy in (policy_in(numbers), Policy(large_policy(), numbers=numbers)):
            header = header_of(policy, example_steps(policy, None), "policy", "policy.npz")
            cost = measure(header.text, "policy", policy.network.is_recurrent, installed)
            program = f"{header.constant_bytes + cost.code_bytes} bytes"
            rows.append(
                f"| {policy.network.describe()} | {numbers} | {program} | {header.state_bytes} bytes "
                f"| {header.multiplications} | {cost.cycles:.0f} | {cost.percent} |"
            )
    return Quote((*rows[:2], *sorted(rows[2:], key=lambda row: row.split("|")[1])))


def report(folder: Path) -> Quote:
    """Return what the command of the page says."""
    given: list[str | Path] = [
        FOLDER / "phototaxis.npz",
        "--numbers",
        "int16",
        "--calibration",
        FOLDER / "observations.npz",
    ]
    command: list[str | Path] = [sys.executable, "-m", "pogosim", "export-policy", *given, "-o", "phototaxis.h"]
    printed = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout
    return Quote(tuple(printed.splitlines()))


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Run all brains; draw, and write the numbers."""
    installed = find_installation()
    example = FOLDER / "policy"
    firmware = made_in(project_of(FOLDER, folder, installed), FOLDER, installed, is_quiet=True)
    native = of_program([example], folder / "native.feather")
    emulated = of_program([installed.without_program, "--firmware", firmware], folder / "firmware.feather")
    counted = of_program(
        [installed.without_program, "--firmware", firmware, "--set", "objects.robots.cpu_time=counted"],
        folder / "counted.feather",
    )
    hosts = {f"host, {numbers}": of_host(policy_in(numbers)) for numbers in ("int16", "float", "int8")}

    figure = Figure(figsize=(10, 3.8), facecolor=PAPER, layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=[1, 1.1, 1.1])
    draw_paths(left, native)
    time_s = PERIOD_S * np.arange(len(native))
    for name, places in {"program in C": native, **hosts}.items():
        middle.plot(time_s, to_middle(places), color=COLOURS[name], linewidth=1, label=name)
    middle.set_ylabel("mean distance from the lamp, mm")
    exact, whole = hosts["host, float"], hosts["host, int16"]
    for label, color, one, other in (
        ("host, int16, and program in C", COLOURS["program in C"], whole, native),
        ("host, int8, and host, float", COLOURS["host, int8"], hosts["host, int8"], exact),
        ("host, int16, and host, float", COLOURS["host, int16"], whole, exact),
    ):
        apart_mm = np.median(distances(one, other), axis=1)
        right.semilogy(time_s[apart_mm > 0], apart_mm[apart_mm > 0], color=color, linewidth=1, label=label)
    right.set_ylabel("median distance of a robot, mm")
    for axes in (middle, right):
        axes.set_xlabel("time, s")
        axes.set_facecolor(PAPER)
        axes.legend(frameon=False, fontsize=8)
    shown = pd.DataFrame({name: places.reshape(-1).round(1) for name, places in {"native": native, **hosts}.items()})

    near = np.searchsorted(time_s, BEFORE_CONTACTS_S - 1e-9)
    ends = {name: f"{to_middle(places)[-1]:.0f}" for name, places in {"program in C": native, **hosts}.items()}

    def apart(one: Floats, other: Floats) -> str:
        """Return how far the median robot is from where it is in another run, before robots meet."""
        return f"{np.median(distances(one, other)[near]):.2g} mm"

    most_mm = distances(native, emulated).max()
    same = "the firmware moves all robots to the bit as the program in C"
    if most_mm > 0:
        same = f"the firmware moves all robots within {most_mm:.2g} mm of their places with the program in C"
    text = (
        f"In {DURATION_S:g} s, {same}. After {BEFORE_CONTACTS_S:g} s, before most "
        f"robots meet, the median robot of firmware whose code takes time (`cpu_time: counted`) is "
        f"{apart(native, counted)} from there, and that of a host {apart(native, whole)}: it acts a tick later, and "
        f"draws other noise. Among hosts, which draw the same noise, int16 moves it by {apart(exact, whole)} from "
        f"where floats do, and int8 by {apart(exact, hosts['host, int8'])}. Then robots push each other, and paths "
        f"part. The swarms end alike, at a mean distance of {ends['program in C']} mm from the lamp's middle (program "
        f"in C), {ends['host, float']} (host, float), {ends['host, int16']} (int16) and {ends['host, int8']} mm (int8)."
    )
    return {
        NAMES[0]: from_figure(figure, 90, shown),
        NAMES[1]: report(folder),
        NAMES[2]: paragraph(text),
        NAMES[3]: sizes(),
    }
