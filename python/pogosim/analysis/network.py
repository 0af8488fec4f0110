"""The proximity graph of a swarm over time: its components, its degrees, and the spectrum of its Laplacian.

The graph has an edge between any two robots that are not farther apart than the reach. Averaged over a window of time,
an edge has a weight: the share of the save times at which its robots are neighbours. A swarm that is never connected
can be connected on average; messages that are passed on while robots move see that graph.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import sparse

from pogosim.analysis.arena import Floats
from pogosim.analysis.laplacian import Spectrum, largest_component, spectrum
from pogosim.analysis.neighbourhood import Neighbours, cluster_sizes, neighbours
from pogosim.analysis.trajectories import Trajectories, unwrapped

# Save times are stored with 24 bits, so a window may seem to end a little early.
ROUNDING = 1e-5


def graph_over_time(run: Trajectories, reach_mm: float | None = None) -> pd.DataFrame:
    """Return size and connectedness of the proximity graph at each save time.

    Returns:
        A row per time: time (s), n_nodes, n_edges, mean_degree, n_components, largest_component_fraction (of the robots
        that are there).
    """
    rows = []
    for now in neighbours(run, reach_mm):
        nodes, edges = int(now.is_there.sum()), len(now.robot) // 2
        sizes = cluster_sizes(now.cluster()[None])[0]
        fraction = sizes[0] / nodes if nodes else np.nan
        rows.append((now.time_s, nodes, edges, 2 * edges / nodes if nodes else np.nan, len(sizes), fraction))
    names = ["time", "n_nodes", "n_edges", "mean_degree", "n_components", "largest_component_fraction"]
    return pd.DataFrame(rows, columns=names)


def instantaneous_spectra(
    run: Trajectories, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
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
    rows = []
    for now in neighbours(run, reach_mm):
        rows.append({"time": now.time_s, **both_spectra(graph_of(now), count, zero_tol)})
    return pd.DataFrame(rows)


def averaged_spectra(
    run: Trajectories, window_s: float, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
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
    window = windows_of(run.time_s, window_s)
    rows = []
    snapshots = neighbours(run, reach_mm)
    for number in np.unique(window):
        times = run.time_s[window == number]
        adjacency = averaged_graph([next(snapshots) for _ in times])
        found = both_spectra(adjacency, count, zero_tol)
        rows.append({"time": (times[0] + times[-1]) / 2, "window_s": window_s, "n_times": len(times), **found})
    return pd.DataFrame(rows)


def windows_of(time_s: Floats, window_s: float) -> npt.NDArray[np.int64]:
    """Return the number of the window in which each save time is, shape (T,)."""
    return np.asarray(np.floor((time_s - time_s[0]) / window_s + ROUNDING), dtype=np.int64)


def averaged_graph(snapshots: list[Neighbours]) -> sparse.csr_array:
    """Return the mean of the adjacency matrices, without the robots that are at no time there."""
    total = snapshots[0].adjacency()
    for now in snapshots[1:]:
        total = total + now.adjacency()
    robots = np.flatnonzero(np.any([now.is_there for now in snapshots], axis=0))
    return sparse.csr_array(total[robots][:, robots] / len(snapshots))


def graph_of(now: Neighbours) -> sparse.csr_array:
    """Return the adjacency matrix of the robots that are there."""
    return averaged_graph([now])


def both_spectra(adjacency: sparse.csr_array, count: int, zero_tol: float) -> dict[str, float]:
    """Return the columns of a row, for the swarm and for its largest component."""
    swarm = spectrum(adjacency, count, zero_tol)
    part = largest_component(adjacency)
    whole = part.shape == adjacency.shape
    return columns("swarm", swarm) | columns("lcc", swarm if whole else spectrum(part, count, zero_tol))


def columns(prefix: str, found: Spectrum) -> dict[str, float]:
    """Return the columns of a graph."""
    numbered = {f"{prefix}_lambda_nz_{number}": value for number, value in enumerate(found.smallest.tolist(), 1)}
    rest = {"lambda_max": found.largest, "n_nodes": found.nodes, "n_edges": found.edges}
    return numbered | {f"{prefix}_{name}": value for name, value in rest.items()}


def mean_speed_mm_s(run: Trajectories) -> float:
    """Return the mean speed over all robots and pairs of successive save times; NaN without any."""
    step = np.linalg.norm(np.diff(unwrapped(run), axis=0), axis=2)
    speed = step / np.diff(run.time_s)[:, None]
    return float(speed[np.isfinite(speed)].mean()) if np.isfinite(speed).any() else float("nan")


def contact_time_s(runs: Sequence[Trajectories], reach_mm: float | None = None) -> float:
    """Return tau_c = reach / mean speed, the time in which a robot crosses the radius of its neighbourhood.

    Args:
        runs: Repetitions of the same; their mean speeds are averaged.
        reach_mm: Greatest distance of neighbours; None: that of the first run.

    Returns:
        s; infinite if no robot moves, or there is one save time.
    """
    speeds = [speed for speed in map(mean_speed_mm_s, runs) if speed > 0.0]
    return runs[0].reach(reach_mm) / float(np.mean(speeds)) if speeds else float("inf")


def ten_periods_s(runs: Sequence[Trajectories]) -> float:
    """Return 10 times the median of the times between successive save times; infinite if there is one only."""
    steps = np.concatenate([np.diff(run.time_s) for run in runs])
    return 10.0 * float(np.median(steps)) if len(steps) else float("inf")
