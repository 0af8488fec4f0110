"""Links against theory: normal modes of a passive lattice, a robot on a spring, and an active solid.

    .venv/bin/python docs/figures/all.py linked

The robots align themselves with their motion, as in P. Baconnier et al., "Selective and collective actuation in active
solids", Nature Physics 18, 1234 (2022): each turns at the rate (n x du/dt) / l_a, with the direction n of its heading,
its velocity du/dt and the length l_a. On a spring of stiffness k, a robot of speed v and mobility b moves by
du/dt = v n - b k u, so the elasto-active feedback is pi = v / (l_a b k). A robot whose motors set its velocity at each
tick T, and which the spring alone moves in between, has the mobility T / (2 m).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pogosim
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from pictures import Picture, from_figure
from pogosim.swarm_picture import INK, PAPER
from quotes import Quote, paragraph

NAMES = ("links.png", "links.md: against_theory")
Floats = npt.NDArray[np.float64]

SPACING_MM = 80.0
ROBOTS = 61  # four shells around the one in the middle; the outer one is held
RADIUS_MM = 26.5
DENSITY = 10.0
MASS_KG = np.pi * RADIUS_MM**2 / 1e4 * DENSITY
TICK_S = 0.016
MOBILITY_S_KG = TICK_S / (2 * MASS_KG)
SPEED_MM_S = 40.0
ALIGNMENT_MM = 16.0
STEP_S = 0.004
PLAIN: dict[str, Any] = {"geometry": "disk", "radius": RADIUS_MM, "body_density": DENSITY, "body_linear_damping": 0.0}


def configuration(objects: dict[str, Any], links: dict[str, Any], seconds: float) -> dict[str, Any]:
    """Return a run on a large square."""
    return {
        "arena_file": "arenas/square.csv",
        "arena_surface": 4e6,
        "time_step": STEP_S,
        "simulation_time": seconds,
        "enable_data_logging": False,
        "objects": objects,
        "links": links,
    }


def lattice(settings: dict[str, Any]) -> dict[str, Any]:
    """Return a category on a triangular lattice."""
    return {**settings, "nb": ROBOTS, "initial_formation": "lattice"}


def run(folder: Path, name: str, config: dict[str, Any]) -> pogosim.Simulation:
    """Start a run without a program."""
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump(config), encoding="utf-8")
    return pogosim.Simulation(None, str(path), seed=1)


def springs_of(sim: pogosim.Simulation) -> tuple[Floats, Floats]:
    """Return the ends of all springs as indices of objects, and the directions from the first to the second."""
    links = sim.links
    springs = links[links["kind"] == "spring"]
    pairs = np.stack([springs["a"], springs["b"]], axis=1)
    place = places(sim)
    way = place[pairs[:, 1]] - place[pairs[:, 0]]
    return pairs, way / np.linalg.norm(way, axis=1, keepdims=True)


def places(sim: pogosim.Simulation) -> Floats:
    """Return the positions of all objects, mm; shape (objects, 2)."""
    return np.array([each.position for each in sim.objects])


def dynamical_matrix(pairs: Floats, along: Floats, free: npt.NDArray[np.int64]) -> Floats:
    """Return the forces of unit springs at rest per displacement of the free nodes; shape (2 free, 2 free)."""
    matrix = np.zeros((ROBOTS, 2, ROBOTS, 2))
    for (a, b), e in zip(pairs, along, strict=True):
        block = np.outer(e, e)
        matrix[a, :, a] += block
        matrix[b, :, b] += block
        matrix[a, :, b] -= block
        matrix[b, :, a] -= block
    return matrix[free][:, :, free].reshape(2 * len(free), 2 * len(free))


def free_nodes(sim: pogosim.Simulation) -> npt.NDArray[np.int64]:
    """Return the nodes that no hinge holds to the arena."""
    links = sim.links
    held = set(links["a"][links["kind"] == "hinge"].tolist())
    return np.array([node for node in range(ROBOTS) if node not in held])


def frequency_hz(displacement: Floats) -> float:
    """Return the frequency of a sampled cosine by its zero crossings."""
    crossings = np.flatnonzero(displacement[:-1] * displacement[1:] < 0)
    before, after = displacement[crossings], displacement[crossings + 1]
    times = (crossings + before / (before - after)) * STEP_S
    return float((len(times) - 1) / 2 / (times[-1] - times[0]))


def normal_modes(folder: Path, stiffness_n_m: float) -> pd.DataFrame:
    """Return the frequency of each mode of a lattice of disks with a held rim, by theory and in the simulator, Hz."""
    links = {
        "skeleton": {"between": "disks", "topology": "triangular", "stiffness": stiffness_n_m, "damping": 0},
        "pins": {"type": "hinge", "between": "disks", "topology": "fixed", "which": "rim"},
    }
    disks = {**PLAIN, "type": "passive_object"}
    config = configuration({"disks": lattice(disks)}, links, 1e4)
    config["lattice_distance_between_neighbors"] = SPACING_MM
    with run(folder, "modes", config) as sim:
        start = places(sim)
        pairs, along = springs_of(sim)
        free = free_nodes(sim)
        squared, modes = np.linalg.eigh(dynamical_matrix(pairs, along, free))
        expected = np.sqrt(squared * stiffness_n_m / MASS_KG) / (2 * np.pi)
        measured = []
        for mode, hz in zip(modes.T, expected, strict=True):
            sim.reset(seed=1)
            shape = mode.reshape(-1, 2)
            for node, shift in zip(free, 0.5 * shape, strict=True):
                x_mm, y_mm = start[node] + shift
                sim.objects[int(node)].move(x_mm, y_mm, 0.0)
            projected = []
            for _ in range(int(3.25 / hz / STEP_S)):
                projected.append(float(np.sum((places(sim)[free] - start[free]) * shape)))
                sim.step(1)
            measured.append(frequency_hz(np.array(projected)))
    return pd.DataFrame({"theory": expected, "simulator": measured})


class Solid:
    """Self-aligning robots that springs hold: a policy on the host."""

    def __init__(self, sim: pogosim.Simulation) -> None:
        self.sim = sim
        self.brain = sim.brain("robots")
        self.before = sim.positions.copy()

    def tick(self) -> None:
        """Turn each robot towards the way it went since the last tick, and let a tick pass."""
        velocity = (self.sim.positions - self.before) / TICK_S
        self.before = self.sim.positions.copy()
        heading = np.stack([np.cos(self.sim.headings), np.sin(self.sim.headings)], axis=1)
        turn_rad_s = (heading[:, 0] * velocity[:, 1] - heading[:, 1] * velocity[:, 0]) / ALIGNMENT_MM
        share = np.clip(turn_rad_s / FASTEST_TURN_RAD_S, -0.5, 0.5)  # clockwise on the screen: the left wheel is faster
        self.brain.motors[:, 0] = np.rint(1023 * (0.5 - share))
        self.brain.motors[:, 1] = np.rint(1023 * (0.5 + share))
        self.sim.step(round(TICK_S / STEP_S))


FASTEST_TURN_RAD_S = 12.0
ACTIVE: dict[str, Any] = {
    **PLAIN,
    "type": "pogobot",
    "brain": "host",
    "max_linear_speed": 2 * SPEED_MM_S,
    "max_angular_speed": FASTEST_TURN_RAD_S / 4,  # both wheels against each other turn it four times as fast
}


def stiffness_for(feedback: float) -> float:
    """Return the stiffness, N/m, at which the elasto-active feedback is this for a node with one spring."""
    return SPEED_MM_S / (ALIGNMENT_MM * MOBILITY_S_KG * feedback)


def orbit(folder: Path, feedback: float) -> float:
    """Return the mean rate at which a robot turns whose centre a spring of length 0 pulls to a point, rad/s."""
    spring = {"between": "robots", "topology": "fixed", "rest_length": 0, "damping": 0}
    config = configuration(
        {"robots": {**ACTIVE, "poses": [[1000, 1000, 0.3]]}},
        {"tether": {**spring, "stiffness": stiffness_for(feedback)}},
        200.0,
    )
    with run(folder, "orbit", config) as sim:
        solid = Solid(sim)
        sim.set_pose(0, 1003.0, 1000.0, 0.3)
        turned = []
        for tick in range(2500):
            before = float(sim.headings[0])
            solid.tick()
            if tick >= 1500:
                turned.append(np.remainder(float(sim.headings[0]) - before + np.pi, 2 * np.pi) - np.pi)
    return float(abs(np.mean(turned)) / TICK_S)


def active_solid(folder: Path, feedback: float) -> tuple[float, float, pd.DataFrame]:
    """Return the polarisation and mean rate of turning of a lattice with a held rim, rad/s, and where its nodes are."""
    links = {
        "skeleton": {"between": "robots", "topology": "triangular", "stiffness": stiffness_for(feedback), "damping": 0},
        "pins": {"type": "hinge", "between": "robots", "topology": "fixed", "which": "rim"},
    }
    config = configuration({"robots": lattice(ACTIVE)}, links, 400.0)
    config["lattice_distance_between_neighbors"] = SPACING_MM
    with run(folder, "solid", config) as sim:
        solid = Solid(sim)
        free = free_nodes(sim)
        start = sim.positions.copy()
        polarisation, turned = [], []
        for tick in range(6000):
            before = sim.headings[free].copy()
            solid.tick()
            if tick >= 4500:
                headings = sim.headings[free]
                polarisation.append(abs(np.mean(np.exp(1j * headings))))
                turned.append(np.mean(np.remainder(headings - before + np.pi, 2 * np.pi) - np.pi))
        nodes = pd.DataFrame(
            np.hstack([start, sim.positions, sim.headings[:, None]]), columns=["x0", "y0", "x", "y", "a"]
        )
        nodes["is_free"] = np.isin(np.arange(ROBOTS), free)
    return float(np.mean(polarisation)), float(abs(np.mean(turned)) / TICK_S), nodes


ORBITS = (0.7, 0.9, 1.2, 1.5, 2.0, 3.0, 4.0)  # pi
SOLIDS = (0.2, 0.3, 0.4, 0.45, 0.5, 0.6, 0.8, 1.0, 1.4)
PICTURED = (0.3, 1.0)
GREY, BLUE, RED = "#b8b2a3", "#1f6f8b", "#c0392b"


def draw_solid(axes: Axes, nodes: pd.DataFrame, title: str) -> None:
    """Draw nodes, their headings, and three times their displacements."""
    for x, y in nodes[["x", "y"]].to_numpy():
        axes.add_patch(Circle((x, y), RADIUS_MM, facecolor="#e9e5da", edgecolor=GREY, linewidth=0.6))
    free = nodes[nodes["is_free"]]
    style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.006}
    way_x, way_y = 3 * (free["x"] - free["x0"]), 3 * (free["y"] - free["y0"])
    axes.quiver(free["x0"], free["y0"], way_x, way_y, color=BLUE, **style)
    ahead_x, ahead_y = RADIUS_MM * np.cos(free["a"]), RADIUS_MM * np.sin(free["a"])
    axes.quiver(free["x"], free["y"], ahead_x, ahead_y, color=RED, **style)
    axes.set_title(title, color=INK, fontsize=10)
    axes.set_aspect("equal")
    axes.set_xlim(640, 1360)
    axes.set_ylim(1360, 640)
    axes.axis("off")


def draw_rates(axes: Axes, orbits: Sequence[float], solids: Sequence[float], least: float) -> None:
    """Draw the rates of turning over the feedback, and below which feedback no solid can begin to turn."""
    rate = SPEED_MM_S / ALIGNMENT_MM
    curve = np.linspace(1, max(ORBITS), 200)
    theory = np.concatenate([[0.0], rate * np.sqrt(curve - 1) / curve])
    axes.plot([0, *curve], theory, color=GREY, linewidth=1, label="one robot, theory")
    axes.plot(ORBITS, orbits, "o", color=BLUE, markersize=4, label="one robot")
    axes.plot(SOLIDS, solids, "s", color=RED, markersize=4, label="active solid")
    axes.axvline(least, color=RED, linewidth=0.8, linestyle=":", label="none can turn to the left of this")
    axes.set_xlabel("elasto-active feedback π")
    axes.set_ylabel("rate of turning, rad/s")
    axes.legend(frameon=False, fontsize=8)


def draw(folder: Path) -> dict[str, Picture | Quote]:
    """Run everything; draw the solids, and theory against what was measured."""
    stiffness_n_m = 50.0
    modes = normal_modes(folder, stiffness_n_m)
    orbits = [orbit(folder, feedback) for feedback in ORBITS]
    solids = {feedback: active_solid(folder, feedback) for feedback in SOLIDS}
    least = float((2 * np.pi * modes["theory"].min()) ** 2 * MASS_KG / stiffness_n_m)

    figure = Figure(figsize=(10, 8), facecolor=PAPER, layout="constrained")
    (frozen, turning), (left, right) = figure.subplots(2, 2)
    for axes, feedback in zip((frozen, turning), PICTURED, strict=True):
        draw_solid(axes, solids[feedback][2], f"active solid, π = {feedback}")
    left.plot([0, 2], [0, 2], color=GREY, linewidth=1)
    left.plot(modes["theory"], modes["simulator"], "o", color=BLUE, markersize=3)
    left.set_xlabel("frequency of a normal mode by theory, Hz")
    left.set_ylabel("in the simulator, Hz")
    draw_rates(right, orbits, [solids[each][1] for each in SOLIDS], least)
    for axes in (left, right):
        axes.set_facecolor(PAPER)

    worst = float((modes["simulator"] / modes["theory"] - 1).abs().max())
    fast = float(np.max([abs(rate / theory_of(pi) - 1) for pi, rate in zip(ORBITS, orbits, strict=True) if pi >= 2]))
    first = next(pi for pi in SOLIDS if solids[pi][1] > 0.1)
    still = max(pi for pi in SOLIDS if pi < first)
    text = (
        f"The {len(modes)} normal modes differ from theory by at most {100 * worst:.1f} %, and the rates of one robot "
        f"at π ≥ 2 by at most {100 * fast:.1f} %. The solid rests up to π = {still:g}, and turns from {first:g} on; "
        f"its lowest mode allows it from {least:.2f}."
    )
    return {"links.png": from_figure(figure, 80, modes.round(2)), "links.md: against_theory": paragraph(text)}


def theory_of(feedback: float) -> float:
    """Return the rate at which one robot turns, rad/s."""
    return float(SPEED_MM_S / ALIGNMENT_MM * np.sqrt(feedback - 1) / feedback)
