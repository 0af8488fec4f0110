"""Figures of a search: how it got better, and the archive of a quality-diversity search."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pogosim.fonts import literal, without_tex
from pogosim.optimize.history import Evaluation
from pogosim.optimize.results import FreshRuns, best_so_far
from pogosim.picture.palette import INK
from pogosim.reports.figures import new_figure, save

DOT, LINE, FRESH, INITIAL, FAILED = "#8fa8c8", "#1f4e9e", "#c2571a", "#5c7a29", "#b3261e"


@without_tex()
def draw_convergence(
    path: Path, history: Sequence[Evaluation], best: FreshRuns | None, initial: FreshRuns | None
) -> None:
    """Draw the fitness of all candidates, the best one so far, and it and the initial values on fresh seeds."""
    figure, ((axes,),) = new_figure()
    number = np.array([e.number for e in history])
    fitness = np.array([np.nan if e.fitness is None else e.fitness for e in history])
    axes.plot(number, fitness, ".", color=DOT, label="candidates")
    axes.step(number, best_so_far(history), where="post", color=LINE, label="best so far")
    failed = number[np.isnan(fitness)]
    if len(failed):
        axes.plot(failed, np.zeros(len(failed)), "|", color=FAILED, transform=axes.get_xaxis_transform(), clip_on=False)
        axes.plot([], [], "|", color=FAILED, label="failed")
    for fresh, colour, name in ((best, FRESH, "best"), (initial, INITIAL, "initial values")):
        if fresh is None or (fresh is best and colour == INITIAL):
            continue
        axes.axhline(fresh.mean, color=colour, label=f"{name}, {len(fresh.seeds)} fresh seeds")
        if np.isfinite(fresh.low):
            axes.axhspan(fresh.low, fresh.high, color=colour, alpha=0.2, linewidth=0)
    axes.set_xlabel("evaluation")
    axes.set_ylabel("fitness")
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.legend(loc="lower right", fontsize="small")
    save(figure, path)


@without_tex()
def draw_archive(
    path: Path,
    fitness: npt.NDArray[np.float64],
    ranges: Sequence[tuple[float, float]],
    names: Sequence[str],
) -> None:
    """Draw the fitness of the elites in a grid of one or two features.

    Args:
        path: The picture.
        fitness: Fitness of each cell, NaN where it is empty, of shape (cells,) or (cells, cells).
        ranges: Least and greatest value of each feature.
        names: Names of the features.
    """
    figure, ((axes,),) = new_figure(width=6.0, height=5.0 if fitness.ndim == 2 else 3.5)
    (left, right), *others = ranges
    if others:
        bottom, top = others[0]
        extent = (left, right, bottom, top)
        image = axes.imshow(fitness.T, origin="lower", extent=extent, aspect="auto", interpolation="nearest")
        axes.set_ylabel(literal(names[1]))
        figure.colorbar(image, ax=axes, label="fitness")
    else:
        edges = np.linspace(left, right, len(fitness) + 1)
        axes.bar(edges[:-1], np.nan_to_num(fitness), np.diff(edges), align="edge", color=LINE)
        axes.set_ylabel("fitness")
    filled = np.count_nonzero(np.isfinite(fitness))
    axes.set_title(f"{filled} of {fitness.size} cells", color=INK, fontsize="medium")
    axes.set_xlabel(literal(names[0]))
    save(figure, path)
