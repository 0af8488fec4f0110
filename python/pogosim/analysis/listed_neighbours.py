"""Neighbours that robots themselves have recorded: a column with lists of robot ids, or a text such as "3,17,20"."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from pogosim.analysis.arena import Floats
from pogosim.analysis.neighbourhood import Integers
from pogosim.analysis.trajectories import Trajectories
from pogosim.errors import AnalysisError


@dataclass(frozen=True)
class ListedNeighbours:
    """What the robots of a run have listed. Robots and times by their number in the run; E entries."""

    time: Integers  # (E,)
    robot: Integers  # (E,)
    neighbour: Integers  # (E,)
    unknown: int  # entries that name no robot of the run; left out


def listed_neighbours(run: Trajectories, column: str = "neighbors_list") -> ListedNeighbours:
    """Read the neighbours that robots have listed.

    Args:
        run: Its robots have different ids.
        column: With text from which whole numbers are taken, lists or arrays of numbers, or numbers; null is none.

    Returns:
        An entry for each id, in the order of times and robots; a robot that lists itself is left out.

    Raises:
        AnalysisError: There is no such column, it holds something else, or several robots have the same id.
    """
    if len(np.unique(run.robot_id)) < len(run.robot_id):
        raise AnalysisError("several robots have the same id, so lists of ids are ambiguous; take one with --category")
    cells = pd.Series(run.column(column).ravel()).dropna()
    is_text = cells.map(lambda value: isinstance(value, str))
    texts = cells[is_text].astype(str)
    wrong = texts[~texts.str.fullmatch(r"[\s\[\](){},;|\d]*")]
    if len(wrong):
        raise AnalysisError(f"its column {column} holds '{wrong.iloc[0]}', not ids of robots such as '3,17,20'")
    cells = pd.concat([texts.str.findall(r"\d+"), cells[~is_text]]).sort_index()
    lists = [np.atleast_1d(value) for value in cells]
    cell = np.repeat(cells.index.to_numpy(dtype=np.int64), [len(value) for value in lists])
    try:
        ids = np.concatenate([np.empty(0), *(value.astype(float) for value in lists)])
    except (TypeError, ValueError):
        raise AnalysisError(f"its column {column} holds something else than ids of robots") from None
    order = np.argsort(run.robot_id)
    place = np.minimum(np.searchsorted(run.robot_id, ids, sorter=order), len(order) - 1)
    neighbour = order[place]
    is_known = run.robot_id[neighbour] == ids
    time, robot = np.divmod(cell, len(run.robot_id))
    use = is_known & (neighbour != robot)
    return ListedNeighbours(time[use], robot[use], neighbour[use], int(np.count_nonzero(~is_known)))


def listed_distance(run: Trajectories, listed: ListedNeighbours) -> Floats:
    """Return the mean distance from each robot to the neighbours that it has listed at each time.

    Args:
        run: The same run.
        listed: Listed of `listed_neighbours`.

    Returns:
        Shape (T, N), mm; NaN where a robot lists none that has a position.
    """
    offset = run.position_mm[listed.time, listed.neighbour] - run.position_mm[listed.time, listed.robot]
    distance = np.linalg.norm(run.arena.minimum_image(offset), axis=1)
    is_there = np.isfinite(distance)
    shape = run.position_mm.shape[:2]
    cell = listed.time[is_there] * shape[1] + listed.robot[is_there]
    total = np.bincount(cell, distance[is_there], minlength=shape[0] * shape[1])
    count = np.bincount(cell, minlength=shape[0] * shape[1])
    mean = np.divide(total, count, out=np.full(len(total), np.nan), where=count > 0)
    return np.asarray(mean.reshape(shape))
