"""The archive of a quality-diversity search: a table, a configuration for each elite, and a heat map."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.result_files.manifests import write_whole
from pogosim.optimize.optimizers.quality_diversity import MapElites
from pogosim.optimize.plots import draw_archive
from pogosim.optimize.results import (
    ARCHIVE,
    ARCHIVE_TABLE,
    ELITES,
    QD_ARCHIVE,
    configuration_text,
    free_name,
    remove_elites,
    write_text,
)
from pogosim.optimize.search import Search
from pogosim.optimize.variables import as_json


def write_archive(folder: Path, search: Search, configuration: Configuration) -> dict[str, Any] | None:
    """Write the archive; returns its summary, or None if the search has none."""
    optimizer = search.optimizer
    if not isinstance(optimizer, MapElites):
        return None
    elites = optimizer.elites()
    shape = search.settings.qd_shape
    names = list(search.feature_names or ())
    fitness = np.full(shape, np.nan)
    rows, plain_rows = [], []
    remove_elites(folder)
    for elite in elites:
        evaluation = search.history[elite.number - 1]
        fitness[elite.cell] = evaluation.fitness
        file = f"{ELITES}/{'_'.join(f'{place:02d}' for place in elite.cell)}.yaml"
        notes = [
            f"The best candidate in cell {elite.cell}: evaluation {elite.number}, fitness {evaluation.fitness:.6g}.",
            f"Features: {as_json(dict(evaluation.features))}",
            f"Values: {as_json(evaluation.values)}",
        ]
        write_text(folder / file, configuration_text(search.space, evaluation.values, configuration.path.parent, notes))
        cell = {f"cell_{i + 1}": place for i, place in enumerate(elite.cell)}
        values = {"eval": elite.number, "fitness": evaluation.fitness}
        features = {free_name(name, {*cell, *values}): value for name, value in evaluation.features.items()}
        rows.append({**cell, **values, **features, "values": as_json(evaluation.values), "config": file})
        plain_rows.append(
            {
                "fitness": evaluation.fitness,
                **{f"feature_{i}": value for i, value in enumerate(evaluation.features.values())},
                **{f"u_{i}": x for i, x in enumerate(evaluation.point)},
                "values": as_json(evaluation.values),
            }
        )
    for name, own in ((ARCHIVE_TABLE, rows), (QD_ARCHIVE, plain_rows)):
        write_whole(folder / name, partial(pd.DataFrame(own).to_csv, index=False))
    if len(shape) <= 2:
        draw_archive(folder / ARCHIVE, fitness, optimizer.ranges, names)
    filled = np.isfinite(fitness)
    return {
        "shape": list(shape),
        "features": names,
        "ranges": [list(pair) for pair in optimizer.ranges],
        "cells_filled": int(np.count_nonzero(filled)),
        "coverage": float(np.mean(filled)),
        "qd_score": float(np.nansum(fitness)),
        "archive": ARCHIVE_TABLE,
        "elites": ELITES,
    }
