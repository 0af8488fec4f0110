"""A fit of a law of reception from the command line to the results."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
from pathlib import Path

import pandas as pd

from pogosim.command.parser import guarded, warn
from pogosim.communication.fit import Fit, fit
from pogosim.communication.fit_command import RESIDUALS, RESULTS
from pogosim.communication.fit_settings import FitSettings
from pogosim.communication.measurements import ROBOTS_OWN, Measurements, read_measurements
from pogosim.communication.quality import Quality, compare, quality
from pogosim.communication.reception_law import (
    LAWS,
    configuration_block,
    parameter_names,
    parameters_of,
)
from pogosim.lines import say
from pogosim.outputs import results_folder


def settings_of(options: argparse.Namespace) -> FitSettings:
    """Return how to fit.

    Raises:
        FitError: The options contradict each other.
    """
    settings = FitSettings(
        law=options.law,
        objective=options.objective,
        huber_delta=options.huber_delta,
        bounds=dict(options.bounds),
        fixed=dict(options.fix),
        seed=options.seed,
        restarts=options.restarts,
    )
    settings.check()
    return settings


def shown(value: float | None, digits: str = ".6f") -> str:
    """Return a number as text, or a dash where it is not defined."""
    return "-" if value is None else format(value, digits)


def report(measurements: Measurements, fitted: Fit, compared: pd.DataFrame) -> None:
    """Print the table of predictions, how well they fit, and the lines for a configuration."""
    say("payload cluster p_send  measured predicted  residual")
    for row in compared.itertuples(index=False):
        say(
            f"{row.payload_size:7g} {row.cluster_size:7g} {row.p_send:6.3f} {row.success_probability:9.4f}"
            f" {row.predicted:9.4f} {row.residual:+9.4f}"
        )
    found = quality(compared)
    say("")
    say(f"measurements: {len(measurements.rows)}")
    say(f"R2: {shown(found.r2)}")
    say(f"MAE: {shown(found.mae)}")
    say(f"RMSE: {shown(found.rmse)}")
    say(f"MAPE: {shown(found.mape_percent, '.2f')} %")
    say(f"residuals, Shapiro-Wilk: W = {shown(found.shapiro_w, '.4f')}, p = {shown(found.shapiro_p, '.2g')}")
    say("")
    say(*configuration_block(fitted.law).split("\n"))


def results_text(settings: FitSettings, fitted: Fit, found: Quality, measurements: Measurements, data: Path) -> str:
    """Return the content of the file of results."""
    free = [name for name in parameter_names(LAWS[settings.law]) if name not in settings.fixed]
    content = {
        "law": settings.law,
        "parameters": parameters_of(fitted.law),
        "quality": dataclasses.asdict(found),
        "objective": settings.objective,
        "huber_delta": settings.huber_delta if settings.objective == "huber" else None,
        "loss": fitted.loss,
        "bounds": {name: settings.bounds_of(name) for name in free},
        "fixed": dict(settings.fixed),
        "seed": settings.seed,
        "evaluations": fitted.evaluations,
        "data": data.name,
        "measurements": len(measurements.rows),
        "header_bytes": measurements.header_bytes,
    }
    return json.dumps(content, indent=2) + "\n"


def fit_measurements(options: argparse.Namespace, prog: str) -> int:
    """Do what the command line says. Returns the exit code: 0 done, 2 nothing could be fitted, or written."""
    data = Path(options.data) if options.data else ROBOTS_OWN

    def run() -> None:
        settings = settings_of(options)
        measurements = read_measurements(data, options.header_bytes)
        if written := fit_and_report(prog, data, measurements, settings, options.output_dir):
            say("", f"written to {options.output_dir}: {', '.join(written)}")

    return guarded(prog, run, options.output_dir or data)


def fit_and_report(
    prog: str, data: Path, measurements: Measurements, settings: FitSettings, output: str | None
) -> list[str]:
    """Fit, print, and write if a folder is given; returns the names of the files written."""
    warn_of_measurements(prog, data, measurements, settings)
    names = [RESULTS, RESIDUALS]
    if output is not None:
        from pogosim.communication import fit_plots

        names += [f"{name}.{suffix}" for name in fit_plots.PLOTS for suffix in fit_plots.FORMATS]
        results_folder(Path(output), names, [data], "would take the place of the measurements")
    fitted = fit(measurements, settings)
    warn_of_bounds(prog, fitted, settings)
    compared = compare(fitted.law, measurements)
    report(measurements, fitted, compared)
    if output is None:
        return []
    content = {
        RESULTS: results_text(settings, fitted, quality(compared), measurements, data).encode(),
        RESIDUALS: compared.to_csv(index=False, float_format="%.9g", lineterminator="\n").encode(),
        **fit_plots.pictures(fitted.law, measurements, compared),
    }
    for name in names:
        (Path(output) / name).write_bytes(content[name])
    return names


def warn_of_bounds(prog: str, fitted: Fit, settings: FitSettings) -> None:
    """Say which parameters would be better outside of their bounds."""
    for name in parameter_names(LAWS[settings.law]):
        if name in settings.fixed:
            continue
        value, (low, high) = getattr(fitted.law, name), settings.bounds_of(name)
        for bound, which in ((low, "lower"), (high, "upper")):
            if math.isclose(value, bound, rel_tol=1e-3):
                warn(
                    prog,
                    f"{name} = {value:.6g} is at its {which} bound; the fit may be better with other "
                    f"--bounds {name}=LOW:HIGH",
                )


def warn_of_measurements(prog: str, data: Path, measurements: Measurements, settings: FitSettings) -> None:
    """Say what is doubtful about the measurements."""
    if measurements.left_out:
        warn(prog, f"{data}: {measurements.left_out} rows without all numbers are left out")
    free = len(parameter_names(LAWS[settings.law])) - len(settings.fixed)
    if len(measurements.rows) < free:
        warn(
            prog,
            f"{data}: {len(measurements.rows)} measurements do not determine {free} parameters; "
            "measure more, or fix some with --fix",
        )
