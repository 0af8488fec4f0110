"""The calibration of a magnetometer: the picture and the lines of `pogosim calibrate magnetometer`.

.venv/bin/python docs/figures/all.py magnetometer
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from pictures import ROOT, Picture, from_figure
from pogosim.magnetometer.block import configuration_block
from pogosim.magnetometer.figure import DPI, drawn
from pogosim.magnetometer.fit import CurveFit, fit_curve
from pogosim.magnetometer.table import AXES, ReadingTable, read_reading_table
from quotes import Quote

NAMES = ("magnetometer.png", "magnetometer.md: calibration")
REFERENCE = ROOT / "conf" / "example_magnetometer_reference.csv"


def fitted_reference() -> tuple[ReadingTable, CurveFit]:
    """Return the table that comes with the simulator, and its fit."""
    table = read_reading_table(REFERENCE, None, is_y_up=False, warn=print)
    return table, fit_curve(table, 2, 0.0)


def draw(_folder: Path) -> dict[str, Picture | Quote]:
    """Draw the table, and print what is fitted to it."""
    table, fitted = fitted_reference()
    rows = pd.DataFrame(fitted.readings(fitted.angle_rad).round(6), columns=list(AXES)).assign(angle=table.angle_rad)
    return {
        "magnetometer.png": from_figure(drawn(table, fitted, 0.0), DPI, rows),
        "magnetometer.md: calibration": Quote(tuple(configuration_block(fitted, 0.0).splitlines())),
    }
