"""The picture of a magnetometer's calibration: readings and the fitted curve, in the plane and over the heading."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pogosim.calibration.figure import MEASURED, SIMULATED
from pogosim.fonts import rendered, without_tex
from pogosim.magnetometer.fit import CurveFit, ellipse_of
from pogosim.magnetometer.table import AXES, ReadingTable

COLOURS = ("#1b6ca8", "#d98200", "#3b8f4f")
POINTS = 361
DPI = 110
ABOVE: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3, "fontsize": "small"}


def plane(axes: Axes, table: ReadingTable, fitted: CurveFit) -> None:
    """Draw y over x, with the fitted curve, its ellipse and centre."""
    angle = np.linspace(0.0, 2.0 * math.pi, POINTS)
    curve = fitted.readings(angle)
    centre = fitted.coefficients[0]
    first = centre[:2] + np.outer(np.cos(angle), fitted.coefficients[1, :2])
    first = first + np.outer(np.sin(angle), fitted.coefficients[2, :2])
    ellipse = ellipse_of(fitted.coefficients)
    axis = np.array([math.cos(ellipse.rotation), math.sin(ellipse.rotation)]) * ellipse.major
    axes.plot(*table.reading[:, :2].T, ".", color=MEASURED, alpha=0.5, markersize=4, label="readings")
    axes.plot(*curve[:, :2].T, color=SIMULATED, linewidth=1.6, label=f"fitted curve, {fitted.order} harmonics")
    axes.plot(*first.T, "--", color="0.35", linewidth=1.0, label="its ellipse")
    axes.plot(*np.array([centre[:2] - axis, centre[:2] + axis]).T, ":", color="0.35", linewidth=1.0)
    axes.plot(*centre[:2], "+", color="black", markersize=10)
    axes.set(xlabel="x (counts)", ylabel="y (counts)", aspect="equal", adjustable="datalim")
    # y points down, as in the arena.
    axes.yaxis.set_inverted(True)
    axes.legend(**ABOVE)


def over_heading(axes: Axes, table: ReadingTable, fitted: CurveFit, field_angle_rad: float) -> None:
    """Draw the readings of the three axes over the heading."""
    heading = np.linspace(0.0, 2.0 * math.pi, POINTS)
    curve = fitted.readings(field_angle_rad - heading)
    measured = np.degrees(np.mod(table.angle_rad, 2.0 * math.pi))
    for axis, (name, colour) in enumerate(zip(AXES, COLOURS, strict=True)):
        axes.plot(measured, table.reading[:, axis], ".", color=colour, alpha=0.4, markersize=4)
        axes.plot(np.degrees(heading), curve[:, axis], color=colour, linewidth=1.4, label=name)
    axes.set(xlabel="heading (degrees, clockwise)", ylabel="reading (counts)", xlim=(0.0, 360.0))
    axes.set_xticks(range(0, 361, 60))
    axes.legend(**ABOVE)


def residuals(axes: Axes, table: ReadingTable, fitted: CurveFit) -> None:
    """Draw what the curve leaves."""
    measured = np.degrees(np.mod(table.angle_rad, 2.0 * math.pi))
    for axis, (name, colour) in enumerate(zip(AXES, COLOURS, strict=True)):
        label = f"{name}, deviation {fitted.noise[axis]:.2g}"
        axes.plot(measured, fitted.residual[:, axis], ".", color=colour, alpha=0.5, markersize=4, label=label)
    axes.axhline(0.0, color="0.35", linewidth=0.8)
    axes.set(xlabel="heading (degrees, clockwise)", ylabel="reading - curve (counts)", xlim=(0.0, 360.0))
    axes.set_xticks(range(0, 361, 60))
    axes.legend(**ABOVE)


@without_tex()
def drawn(table: ReadingTable, fitted: CurveFit, field_angle_rad: float) -> Figure:
    """Draw the readings and the fit."""
    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    plane(left, table, fitted)
    over_heading(middle, table, fitted, field_angle_rad)
    residuals(right, table, fitted)
    for axes in (left, middle, right):
        axes.grid(color="0.92")
        axes.set_axisbelow(True)
    return figure


def picture(table: ReadingTable, fitted: CurveFit, field_angle_rad: float) -> bytes:
    """Return a PNG picture."""
    return rendered(drawn(table, fitted, field_angle_rad), "png", DPI)
