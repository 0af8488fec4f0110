"""Pictures of a fitted law of reception, as in the article: how well it fits, and how it behaves.

L. Cazenille, L. Macabre, N. Bredeche, "Pogosim - a Simulator for Pogobot robots", figure of the comparison of the model
with the measurements.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.axes3d import Axes3D
from scipy import stats

from pogosim.communication.measurements import Measurements
from pogosim.communication.quality import quality
from pogosim.communication.reception_law import Law
from pogosim.fonts import rendered, without_tex

COLOURS = ("#1b6ca8", "#d98200", "#a8321b", "#3c8d5a", "#7a4fa0", "#5f6b73")
CELLS = 25  # of a surface, along each side
FORMATS = ("png", "pdf")


def scatter(_law: Law, _measurements: Measurements, compared: pd.DataFrame) -> Figure:
    """Draw predictions against measurements, by payload."""
    figure = Figure(figsize=(5.6, 5.4), layout="constrained")
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color="0.5", linestyle="--", linewidth=1, label="perfect prediction")
    for number, (payload, rows) in enumerate(compared.groupby("payload_size")):
        colour = COLOURS[number % len(COLOURS)]
        axes.scatter(
            rows["success_probability"], rows["predicted"], color=colour, alpha=0.75, label=f"{payload:g} bytes"
        )
    found = quality(compared)
    r2 = "" if found.r2 is None else f"R2 = {found.r2:.4f}, "
    axes.set_title(f"{r2}MAE = {found.mae:.4f}, {len(compared)} measurements", fontsize=10)
    axes.set(xlabel="measured probability of reception", ylabel="predicted", xlim=(-0.03, 1.03), ylim=(-0.03, 1.03))
    axes.set_aspect("equal")
    axes.grid(color="0.9")
    axes.legend(title="payload", fontsize=8, title_fontsize=8)
    return figure


def mae_heat_map(_law: Law, _measurements: Measurements, compared: pd.DataFrame) -> Figure:
    """Draw the mean absolute error by payload and cluster size."""
    error = compared.assign(error=compared["residual"].abs())
    table = error.pivot_table(index="payload_size", columns="cluster_size", values="error", aggfunc="mean")
    figure = Figure(
        figsize=(1.8 + 0.9 * max(table.shape[1], 3), 1.4 + 0.75 * max(table.shape[0], 3)), layout="constrained"
    )
    axes = figure.subplots()
    values = table.to_numpy(dtype=float)
    image = axes.imshow(values, cmap="YlOrRd", vmin=0.0, vmax=max(float(np.nanmax(values)), 1e-9), aspect="auto")
    middle = 0.6 * float(np.nanmax(values))
    for row, column in np.ndindex(values.shape):
        if np.isfinite(value := values[row, column]):
            colour = "white" if value > middle else "black"
            axes.text(column, row, f"{value:.3f}", ha="center", va="center", color=colour)
    axes.set_xticks(range(table.shape[1]), [f"{c:g}" for c in table.columns])
    axes.set_yticks(range(table.shape[0]), [f"{m:g}" for m in table.index])
    axes.set(xlabel="cluster size", ylabel="payload (bytes)", title="mean absolute error")
    figure.colorbar(image, ax=axes)
    return figure


def qq_plot(_law: Law, _measurements: Measurements, compared: pd.DataFrame) -> Figure:
    """Draw the quantiles of the residuals against those of a normal distribution."""
    residual = np.sort(compared["residual"].to_numpy(dtype=float))
    figure = Figure(figsize=(5.2, 4.4), layout="constrained")
    axes = figure.subplots()
    # Filliben's medians of the order statistics (Technometrics 17(1), 1975), as in scipy.stats.probplot.
    (theoretical, ordered), _ = stats.probplot(residual) if len(residual) > 1 else (([0.0], residual), None)
    axes.plot(theoretical, ordered, "o", color=COLOURS[0], alpha=0.75)
    ends = np.array([np.min(theoretical), np.max(theoretical)])
    axes.plot(ends, residual.mean() + residual.std() * ends, color=COLOURS[2], label="normal, same mean and deviation")
    found = quality(compared)
    if found.shapiro_w is not None:
        axes.set_title(f"Shapiro-Wilk: W = {found.shapiro_w:.4f}, p = {found.shapiro_p:.2g}", fontsize=10)
    axes.set(xlabel="quantiles of the normal distribution", ylabel="residual, measured - predicted")
    axes.grid(color="0.9")
    axes.legend(fontsize=8)
    return figure


def surfaces(law: Law, measurements: Measurements, _compared: pd.DataFrame) -> Figure:
    """Draw the law as surfaces over chance to send and cluster size, one per payload, and over payload."""
    payloads = np.unique(measurements.rows["payload_size"])
    shown = payloads if len(payloads) <= 3 else payloads[[0, len(payloads) // 2, -1]]
    largest_cluster = float(max(measurements.cluster_size.max(), 2.0))
    p = np.linspace(0.01, 1.0, CELLS)
    figure = Figure(figsize=(4.3 * (len(shown) + 1), 4.2))
    panels = len(shown) + 1

    def panel(number: int, title: str, y_label: str) -> Axes3D:
        axes = figure.add_subplot(1, panels, number, projection="3d")
        assert isinstance(axes, Axes3D)
        axes.set_title(title, fontsize=10)
        axes.set(xlabel="chance to send", ylabel=y_label, zlabel="probability of reception", zlim=(0.0, 1.0))
        axes.view_init(elev=25, azim=50)
        return axes

    style = {"cmap": "viridis", "norm": Normalize(0.0, 1.0), "linewidth": 0, "rcount": CELLS, "ccount": CELLS}
    c = np.linspace(1.0, largest_cluster, CELLS)
    for number, payload in enumerate(shown, start=1):
        size = float(payload) + measurements.header_bytes
        grid_p, grid_c = np.meshgrid(p, c)
        axes = panel(number, f"payload of {payload:g} bytes", "cluster size")
        axes.plot_surface(grid_p, grid_c, law.probability(size, grid_p, grid_c), **style)
        rows = measurements.rows[measurements.rows["payload_size"] == payload]
        axes.scatter(rows["p_send"], rows["cluster_size"], rows["success_probability"], color=COLOURS[2], s=14)
    grid_p, grid_m = np.meshgrid(p, np.linspace(0.0, float(max(payloads.max(), 1.0)), CELLS))
    axes = panel(panels, f"cluster of {largest_cluster:g} robots", "payload (bytes)")
    chance = law.probability(grid_m + measurements.header_bytes, grid_p, largest_cluster)
    axes.plot_surface(grid_p, grid_m, chance, **style)
    rows = measurements.rows[measurements.rows["cluster_size"] == largest_cluster]
    axes.scatter(rows["p_send"], rows["payload_size"], rows["success_probability"], color=COLOURS[2], s=14)
    figure.subplots_adjust(left=0.01, right=0.97, bottom=0.08, top=0.95, wspace=0.12)
    return figure


Draw = Callable[[Law, Measurements, pd.DataFrame], Figure]
PLOTS: dict[str, Draw] = {
    "model_predicted_vs_measured": scatter,
    "model_mae_heat_map": mae_heat_map,
    "model_qq_plot": qq_plot,
    "model_surfaces": surfaces,
}


@without_tex()
def pictures(law: Law, measurements: Measurements, compared: pd.DataFrame) -> dict[str, bytes]:
    """Return the pictures by file name; the same ones each time, to the byte."""
    made: dict[str, bytes] = {}
    for name, draw in PLOTS.items():
        figure = draw(law, measurements, compared)
        made |= {f"{name}.{suffix}": rendered(figure, suffix) for suffix in FORMATS}
    return made
