"""The proximity graph of a swarm over time: its components, its degrees, and the spectrum of its Laplacian.

The graph has an edge between any two robots that are not farther apart than the reach. Averaged over a window of time,
an edge has a weight: the share of the save times at which its robots are neighbours. A swarm that is never connected
can be connected on average; messages that are passed on while robots move see that graph.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import sparse

from pogosim.analysis.arena import Floats
from pogosim.analysis.laplacian import Spectra, spectra
from pogosim.analysis.neighbourhood import components, ranks
from pogosim.analysis.snapshots import Integers, pairs_of, snapshots_of, times_of
from pogosim.analysis.sums import sum_of_parts
from pogosim.analysis.trajectories import Run, unwrapped_blocks

# Save times are stored with 24 bits, so a window may seem to end a little early.
ROUNDING = 1e-5


def graph_over_time(run: Run, reach_mm: float | None = None) -> pd.DataFrame:
    """Return size and connectedness of the proximity graph at each save time.

    Returns:
        A row per time: time (s), n_nodes, n_edges, mean_degree, n_components, largest_component_fraction (of the robots
        that are there).
    """
    reach = run.reach(reach_mm)
    shape = len(run.time_s)
    edges, parts, largest = np.zeros((3, shape), dtype=np.int64)
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach)
        edges[own.times] = np.bincount(own.time[i], minlength=own.length)
        rank = ranks(components(len(own.robot), i, j), own.time)
        np.maximum.at(parts[own.times], own.time, rank + 1)
        largest[own.times] = np.bincount(own.time[rank == 0], minlength=own.length)
    nodes = run.present
    there = np.where(nodes > 0, nodes, np.nan)
    return pd.DataFrame(
        {
            "time": run.time_s,
            "n_nodes": nodes,
            "n_edges": edges,
            "mean_degree": 2 * edges / there,
            "n_components": parts,
            "largest_component_fraction": largest / there,
        }
    )


def instantaneous_spectra(
    run: Run, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
) -> pd.DataFrame:
    """Return the extreme Laplacian eigenvalues of the unweighted proximity graph at each save time.

    Args:
        run: Robots without a position at a time are no nodes then.
        count: How many of the smallest non-zero eigenvalues.
        reach_mm: Greatest distance of neighbours; None: that of the run.
        zero_tol: Greatest eigenvalue that counts as zero.

    Returns:
        A row per time: time (s), then for the swarm `swarm_lambda_nz_1` ... `swarm_lambda_nz_k` (increasing, NaN where
        there are fewer), `swarm_lambda_max`, `swarm_n_nodes` and `swarm_n_edges`, and `lcc_...` for its largest
        connected component.
    """
    reach = run.reach(reach_mm)
    tables = []
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach)
        graph = adjacency_of(len(own.robot), i, j, np.ones(len(i)))
        found = spectra(graph, own.time, own.length, count, zero_tol)
        tables.append(pd.DataFrame({"time": run.time_s[own.times], **columns(*found)}))
    return pd.concat(tables, ignore_index=True)


def averaged_spectra(
    run: Run, window_s: float, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
) -> pd.DataFrame:
    """Return the extreme Laplacian eigenvalues of the adjacency averaged over windows of time.

    Windows follow each other from the first save time on; the last one may be shorter. Nodes are all robots that have
    a position at some time of the window.

    Args:
        run: See `instantaneous_spectra`.
        window_s: Length of the windows, above 0; infinite: one window.
        count: See `instantaneous_spectra`.
        reach_mm: See `instantaneous_spectra`.
        zero_tol: See `instantaneous_spectra`.

    Returns:
        A row per window that has a save time: time (s), the middle of its first and last save time, window_s, n_times
        (save times in it), and the columns of `instantaneous_spectra`; edges count with any weight.
    """
    number, window = np.unique(windows_of(run.time_s, window_s), return_inverse=True)
    first = np.searchsorted(window, np.arange(len(number)))
    last = np.append(first[1:], len(window)) - 1
    times = last - first + 1
    tables = []
    for windows, graph, node_window in averaged_graphs(run, window.reshape(-1), times, run.reach(reach_mm)):
        tables.append(pd.DataFrame(columns(*spectra(graph, node_window, len(windows), count, zero_tol))))
    middle = (run.time_s[first] + run.time_s[last]) / 2
    own = pd.DataFrame({"time": middle, "window_s": window_s, "n_times": times})
    return pd.concat([own, pd.concat(tables, ignore_index=True)], axis=1)


def averaged_graphs(
    run: Run, window: Integers, times: Integers, reach_mm: float
) -> Iterator[tuple[range, sparse.csr_array, Integers]]:
    """Yield the adjacency matrices averaged over windows, of some windows after the other.

    Args:
        run: See `instantaneous_spectra`.
        window: Number of the window of each save time, 0 to W - 1, increasing, shape (T,).
        times: Number of save times in each window, shape (W,).
        reach_mm: Greatest distance of neighbours.

    Yields:
        The numbers of the windows; their matrices as one, with the robots that are there at some time of a window as
        its nodes; and the window of each node, counted from the first of these.
    """
    robots = len(run.robot_id)
    key, weight = np.zeros((2, 0), dtype=np.int64)  # of the edges of windows that are not over yet
    there = np.zeros(0, dtype=np.int64)  # the robots that are there in those
    begin = 0
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach_mm)
        found, count = np.unique(
            (window[own.times][own.time[i]] * robots + own.robot[i]) * robots + own.robot[j], return_counts=True
        )
        key, inverse = np.unique(np.concatenate([key, found]), return_inverse=True)
        weight = np.bincount(inverse.reshape(-1), np.concatenate([weight, count]), minlength=len(key)).astype(np.int64)
        there = np.unique(np.concatenate([there, window[own.times][own.time] * robots + own.robot]))
        # Windows are over that have no time in the next block.
        end = len(times) if own.times.stop == len(window) else int(window[own.times.stop])
        if end == begin:
            continue
        over = int(np.searchsorted(key, end * robots**2))
        at, rest = np.divmod(key[:over], robots**2)
        i, j = np.divmod(rest, robots)
        present = np.zeros((end - begin, robots), dtype=bool)
        gone = int(np.searchsorted(there, end * robots))
        present.ravel()[there[:gone] - begin * robots] = True
        node = np.cumsum(present).reshape(present.shape) - 1
        share = weight[:over] / times[at]
        graph = adjacency_of(int(present.sum()), node[at - begin, i], node[at - begin, j], share)
        yield range(begin, end), graph, np.nonzero(present)[0]
        key, weight, there, begin = key[over:], weight[over:], there[gone:], end


def adjacency_of(nodes: int, i: Integers, j: Integers, weight: Floats) -> sparse.csr_array:
    """Return a symmetric adjacency matrix from the edges, each of them once."""
    where = (np.concatenate([i, j]), np.concatenate([j, i]))
    return sparse.csr_array((np.concatenate([weight, weight]), where), shape=(nodes, nodes))


def windows_of(time_s: Floats, window_s: float) -> npt.NDArray[np.int64]:
    """Return the number of the window in which each save time is, shape (T,)."""
    return np.asarray(np.floor((time_s - time_s[0]) / window_s + ROUNDING), dtype=np.int64)


def columns(swarm: Spectra, largest: Spectra) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of a table with a row per graph, for the swarm and for its largest component."""
    found: dict[str, npt.NDArray[Any]] = {}
    for prefix, own in (("swarm", swarm), ("lcc", largest)):
        found |= {f"{prefix}_lambda_nz_{number}": values for number, values in enumerate(own.smallest.T, 1)}
        rest = {"lambda_max": own.largest, "n_nodes": own.nodes, "n_edges": own.edges}
        found |= {f"{prefix}_{name}": values for name, values in rest.items()}
    return found


def mean_speed_mm_s(run: Run) -> float:
    """Return the mean speed over all robots and pairs of successive save times; NaN without any."""
    count = sum(map(len, speeds_of(run)))
    return sum_of_parts(speeds_of(run), count) / count if count else float("nan")


def speeds_of(run: Run) -> Iterator[Floats]:
    """Yield the speeds of robots between successive save times, those of some times after the other."""
    path, time_s = np.full((1, len(run.robot_id), 2), np.nan), run.time_s[:1] - 1.0
    for times, _, own in unwrapped_blocks(run, times_of(run.present)):
        path, time_s = np.concatenate([path, own]), np.concatenate([time_s, run.time_s[times]])
        step = np.linalg.norm(np.diff(path, axis=0), axis=2)
        speed = step / np.diff(time_s)[:, None]
        yield speed[np.isfinite(speed)]
        path, time_s = path[-1:], time_s[-1:]


def contact_time_s(runs: Sequence[Run], reach_mm: float | None = None) -> float:
    """Return tau_c = reach / mean speed, the time in which a robot crosses the radius of its neighbourhood.

    Args:
        runs: Repetitions of the same; their mean speeds are averaged.
        reach_mm: Greatest distance of neighbours; None: that of the first run.

    Returns:
        s; infinite if no robot moves, or there is one save time.
    """
    speeds = [speed for speed in map(mean_speed_mm_s, runs) if speed > 0.0]
    return runs[0].reach(reach_mm) / float(np.mean(speeds)) if speeds else float("inf")


def ten_periods_s(runs: Sequence[Run]) -> float:
    """Return 10 times the median of the times between successive save times; infinite if there is one only."""
    steps = np.concatenate([np.diff(run.time_s) for run in runs])
    return 10.0 * float(np.median(steps)) if len(steps) else float("inf")
