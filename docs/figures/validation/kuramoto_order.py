"""Kuramoto's transition: order against coupling, for oscillators that hear all others or those they meet.

Oscillators with frequencies from a Lorentzian of half-width gamma, coupled to all others with the strength K, stay
incoherent below K_c = 2 gamma; above, their order parameter is

    r = sqrt(1 - K_c / K)

(Kuramoto 1975; Acebron et al., Reviews of Modern Physics 77, 137, 2005). Moving ones that hear only their neighbours
follow it, too, if they meet others faster than their phases change: all see the mean field (Peruani, Nicola and
Morelli, New Journal of Physics 12, 093029, 2010). What a few neighbours tell is not the mean over all, which acts as
a weak noise and lowers r a little.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from .agreement import Comparison, Values, absolute, two_samples
from .experiment import Outcome, batch, compile_program

NAME = "kuramoto"
RUNS, QUICK_RUNS = 6, 3
ROBOTS, GAMMA_RAD_S = 100, 0.5
COUPLINGS = (0.5, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0)  # rad/s
QUICK_COUPLINGS = (0.5, 2.0, 3.0)
TICK_S, TIME_S, LEFT_OUT_S, RECORD_S = 0.1, 100.0, 40.0, 0.5
SETTINGS = {  # title, communication radius (mm), motor power, chance to send (%), colour
    "all": ("all robots hear each other", 3000, 0, 10, "#1b6ca8"),
    "driving": ("only within 0.4 m, driving at 1 m/s", 400, 512, 100, "#d98200"),
    "standing": ("only within 0.4 m, standing", 400, 0, 100, "#a8321b"),
}
FAR_ABOVE = 1.5  # critical couplings, from where on theory is compared: near the transition, 100 oscillators are few
MARGIN_THEORY, MARGIN_DRIVING, MARGIN_MODEL = 0.02, 0.05, 0.005


def theory(coupling_rad_s: Values) -> Values:
    """Order parameter of infinitely many oscillators."""
    return np.sqrt(np.maximum(0.0, 1.0 - 2.0 * GAMMA_RAD_S / coupling_rad_s))


def model_order(coupling_rad_s: float, seed: int) -> float:
    """Integrate the same oscillators, each coupled to the mean over all others; return the mean order parameter."""
    random = np.random.default_rng([seed, int(1000 * coupling_rad_s)])
    frequency = GAMMA_RAD_S * np.tan(np.pi * ((np.arange(ROBOTS) + 0.5) / ROBOTS - 0.5))
    theta = random.uniform(-np.pi, np.pi, ROBOTS)
    order = []
    for tick in range(round(TIME_S / TICK_S)):
        field = np.exp(1j * theta).sum()
        if tick >= LEFT_OUT_S / TICK_S:
            order.append(abs(field) / ROBOTS)
        pull = (field * np.exp(-1j * theta)).imag / (ROBOTS - 1)
        theta = theta + TICK_S * (frequency + coupling_rad_s * pull)
    return float(np.mean(order))


def robot_orders(program: Path, setting: str, couplings: tuple[float, ...], runs: int) -> Values:
    """Run robots. Returns each run's mean order parameter. Shape (runs, couplings)."""
    _, radius_mm, power, percent, _ = SETTINGS[setting]
    changes = {
        "objects.robots.communication_radius": radius_mm,
        "parameters.cruise_power": power,
        "parameters.send_percent": percent,
        "parameters.coupling_k": {"batch_options": list(couplings)},
    }
    rows = batch(program, NAME, runs, changes)[NAME]
    rows = rows[rows["time"] >= LEFT_OUT_S].assign(x=np.cos(rows["theta"]), y=np.sin(rows["theta"]))
    means = rows.groupby(["parameters.coupling_k", "run", "time"])[["x", "y"]].mean()
    order = means.assign(r=np.hypot(means["x"], means["y"])).groupby(level=[0, 1])["r"].mean()
    return np.asarray(order.unstack(0)[list(couplings)].to_numpy())


def compare(orders: dict[str, Values], couplings: Values, runs: int) -> list[Comparison]:
    """Compare all that has a theory."""
    model = np.array([[model_order(k, seed) for k in couplings] for seed in range(2 * runs)])
    above = couplings >= FAR_ABOVE * 2.0 * GAMMA_RAD_S
    expected = theory(couplings)[above]
    return [
        two_samples("all, against the same oscillators in numpy", orders["all"], model, MARGIN_MODEL),
        absolute("all, against sqrt(1 - K_c / K)", orders["all"][:, above], expected, MARGIN_THEORY),
        absolute("driving, against sqrt(1 - K_c / K)", orders["driving"][:, above], expected, MARGIN_DRIVING),
    ]


def measure(folder: Path, quick: bool) -> Outcome:
    """Run, compare, draw."""
    runs, couplings = (QUICK_RUNS, QUICK_COUPLINGS) if quick else (RUNS, COUPLINGS)
    program = compile_program(NAME, folder)
    orders = {setting: robot_orders(program, setting, couplings, runs) for setting in SETTINGS}
    figure = Figure(figsize=(6.5, 4.2), layout="constrained")
    axes = figure.subplots()
    fine = np.linspace(0.3, 3.1, 500)
    axes.plot(fine, theory(fine), color="0.3", linewidth=1, label=r"theory: $\sqrt{1 - K_c / K}$")
    for setting, (title, _, _, _, colour) in SETTINGS.items():
        mean, error = orders[setting].mean(axis=0), orders[setting].std(axis=0, ddof=1) / np.sqrt(runs)
        axes.errorbar(couplings, mean, error, fmt="o", color=colour, markersize=4, label=title)
    axes.set(xlabel="coupling K (rad/s)", ylabel="order parameter r", ylim=(0.0, 1.0))
    axes.legend(fontsize=8, loc="upper left")
    table = pd.DataFrame({name: values.mean(axis=0) for name, values in orders.items()}).assign(coupling=couplings)
    counted = f"{runs} runs of {ROBOTS} robots for each coupling and each kind of neighbours, {TIME_S:g} s"
    return Outcome(counted, figure, (table.round(9),), tuple(compare(orders, np.array(couplings), runs)))
