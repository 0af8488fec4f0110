"""The proximity graph of a swarm over time: its components, its degrees, and the spectrum of its Laplacian.

The graph has an edge between any two robots that are not farther apart than the reach. Averaged over a window of time,
an edge has a weight: the share of the save times at which its robots are neighbours. A swarm that is never connected
can be connected on average; messages that are passed on while robots move see that graph.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import sparse

from pogosim.analysis.arena import Floats
from pogosim.analysis.laplacian import Spectra, spectra
from pogosim.analysis.neighbourhood import components, ranks
from pogosim.analysis.snapshots import Integers, Snapshots, pairs_of, snapshots_of, times_of
from pogosim.analysis.sums import sum_of_parts
from pogosim.analysis.trajectories import Run, unwrapped_blocks

# Save times are stored with 24 bits, so a window may seem to end a little early.
ROUNDING = 1e-5


class GraphTable(Protocol):
    """A table of the proximity graphs of a run; their edges are added block by block."""

    def add(self, own: Snapshots, i: Integers, j: Integers) -> None:
        """Add the edges at the next block of save times, each once, by the numbers of their points, shape (E,)."""

    def table(self) -> pd.DataFrame:
        """Return the table, when all blocks have been added."""


def graph_tables(run: Run, tables: Sequence[GraphTable], reach_mm: float | None = None) -> list[pd.DataFrame]:
    """Return several tables of the proximity graphs of a run, whose edges are found once for all of them.

    Args:
        run: Robots without a position at a time are no nodes then.
        tables: Empty ones: `Connectedness`, `InstantaneousSpectra`, `AveragedSpectra`.
        reach_mm: Greatest distance of neighbours; None: that of the run.
    """
    reach = run.reach(reach_mm)
    for own in snapshots_of(run):
        i, j, _ = pairs_of(own, run.arena, reach)
        for table in tables:
            table.add(own, i, j)
    return [table.table() for table in tables]


def graph_over_time(run: Run, reach_mm: float | None = None) -> pd.DataFrame:
    """Return size and connectedness of the proximity graph at each save time, see `Connectedness`."""
    return graph_tables(run, [Connectedness(run)], reach_mm)[0]


def instantaneous_spectra(
    run: Run, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
) -> pd.DataFrame:
    """Return the extreme Laplacian eigenvalues of the graph at each save time, see `InstantaneousSpectra`."""
    return graph_tables(run, [InstantaneousSpectra(run, count, zero_tol)], reach_mm)[0]


def averaged_spectra(
    run: Run, window_s: float, count: int = 5, reach_mm: float | None = None, zero_tol: float = 1e-10
) -> pd.DataFrame:
    """Return the extreme Laplacian eigenvalues of graphs averaged over windows of time, see `AveragedSpectra`."""
    return graph_tables(run, [AveragedSpectra(run, window_s, count, zero_tol)], reach_mm)[0]


class Connectedness:
    """Size and connectedness of the graph at each save time.

    A row per time: time (s), n_nodes, n_edges, mean_degree, n_components, largest_component_fraction (of the robots
    that are there).
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self.edges, self.parts, self.largest = np.zeros((3, len(run.time_s)), dtype=np.int64)

    def add(self, own: Snapshots, i: Integers, j: Integers) -> None:
        """Add edges, see `GraphTable`."""
        self.edges[own.times] = np.bincount(own.time[i], minlength=own.length)
        rank = ranks(components(len(own.robot), i, j), own.time)
        np.maximum.at(self.parts[own.times], own.time, rank + 1)
        self.largest[own.times] = np.bincount(own.time[rank == 0], minlength=own.length)

    def table(self) -> pd.DataFrame:
        """Return the table."""
        nodes = self.run.present
        there = np.where(nodes > 0, nodes, np.nan)
        return pd.DataFrame(
            {
                "time": self.run.time_s,
                "n_nodes": nodes,
                "n_edges": self.edges,
                "mean_degree": 2 * self.edges / there,
                "n_components": self.parts,
                "largest_component_fraction": self.largest / there,
            }
        )


class InstantaneousSpectra:
    """The extreme Laplacian eigenvalues of the unweighted graph at each save time.

    A row per time: time (s), then for the swarm `swarm_lambda_nz_1` ... `swarm_lambda_nz_k` (increasing, NaN where
    there are fewer), `swarm_lambda_max`, `swarm_n_nodes` and `swarm_n_edges`, and `lcc_...` for its largest connected
    component.

    Args:
        run: The run.
        count: How many of the smallest non-zero eigenvalues, k.
        zero_tol: Greatest eigenvalue that counts as zero.
    """

    def __init__(self, run: Run, count: int = 5, zero_tol: float = 1e-10) -> None:
        self.time_s, self.count, self.zero_tol = run.time_s, count, zero_tol
        self.tables: list[pd.DataFrame] = []

    def add(self, own: Snapshots, i: Integers, j: Integers) -> None:
        """Add edges, see `GraphTable`."""
        graph = adjacency_of(len(own.robot), i, j, np.ones(len(i)))
        found = spectra(graph, own.time, own.length, self.count, self.zero_tol)
        self.tables.append(pd.DataFrame({"time": self.time_s[own.times], **columns(*found)}))

    def table(self) -> pd.DataFrame:
        """Return the table."""
        return pd.concat(self.tables, ignore_index=True)


class AveragedSpectra:
    """The extreme Laplacian eigenvalues of the adjacency averaged over windows of time.

    Windows follow each other from the first save time on; the last one may be shorter. Nodes are all robots that have
    a position at some time of the window. A row per window that has a save time: time (s), the middle of its first and
    last save time, window_s, n_times (save times in it), and the columns of `InstantaneousSpectra`; edges count with
    any weight.

    Args:
        run: The run.
        window_s: Length of the windows, above 0; infinite: one window.
        count: See `InstantaneousSpectra`.
        zero_tol: See `InstantaneousSpectra`.
    """

    def __init__(self, run: Run, window_s: float, count: int = 5, zero_tol: float = 1e-10) -> None:
        self.window_s, self.count, self.zero_tol = window_s, count, zero_tol
        self.robots = len(run.robot_id)
        number, window = np.unique(windows_of(run.time_s, window_s), return_inverse=True)
        self.window = window.reshape(-1)  # (T,), number of the window of each save time, from 0 on
        first = np.searchsorted(self.window, np.arange(len(number)))
        last = np.append(first[1:], len(self.window)) - 1
        self.times = last - first + 1  # (W,), save times in each window
        self.middle_s = (run.time_s[first] + run.time_s[last]) / 2
        # The windows that are not over yet: the first one, their edges, and the robots that are there.
        self.begin = 0
        self.key, self.weight = np.zeros((2, 0), dtype=np.int64)
        self.there = np.zeros(0, dtype=np.int64)
        self.tables: list[pd.DataFrame] = []

    def add(self, own: Snapshots, i: Integers, j: Integers) -> None:
        """Add edges, see `GraphTable`."""
        robots, window = self.robots, self.window[own.times][own.time]
        found, count = np.unique((window[i] * robots + own.robot[i]) * robots + own.robot[j], return_counts=True)
        self.key, inverse = np.unique(np.concatenate([self.key, found]), return_inverse=True)
        weight = np.bincount(inverse.reshape(-1), np.concatenate([self.weight, count]), minlength=len(self.key))
        self.weight = weight.astype(np.int64)
        self.there = np.unique(np.concatenate([self.there, window * robots + own.robot]))
        # Windows are over that have no time in the next block.
        is_last = own.times.stop == len(self.window)
        end = len(self.times) if is_last else int(self.window[own.times.stop])
        if end > self.begin:
            graph, node_window = self.averaged(end)
            found_spectra = spectra(graph, node_window, end - self.begin, self.count, self.zero_tol)
            self.tables.append(pd.DataFrame(columns(*found_spectra)))
            self.leave_out(end)

    def averaged(self, end: int) -> tuple[sparse.csr_array, Integers]:
        """Return the averaged adjacency matrices of the windows up to and without one.

        Returns:
            The matrices as one, with the robots that are there at some time of a window as its nodes; and the window
            of each node, counted from the first of these.
        """
        robots, begin = self.robots, self.begin
        over = int(np.searchsorted(self.key, end * robots**2))
        at, rest = np.divmod(self.key[:over], robots**2)
        i, j = np.divmod(rest, robots)
        present = np.zeros((end - begin, robots), dtype=bool)
        gone = int(np.searchsorted(self.there, end * robots))
        present.ravel()[self.there[:gone] - begin * robots] = True
        node = np.cumsum(present).reshape(present.shape) - 1
        share = self.weight[:over] / self.times[at]
        graph = adjacency_of(int(present.sum()), node[at - begin, i], node[at - begin, j], share)
        return graph, np.nonzero(present)[0]

    def leave_out(self, end: int) -> None:
        """Forget the windows up to and without one."""
        over = int(np.searchsorted(self.key, end * self.robots**2))
        gone = int(np.searchsorted(self.there, end * self.robots))
        self.key, self.weight, self.there, self.begin = self.key[over:], self.weight[over:], self.there[gone:], end

    def table(self) -> pd.DataFrame:
        """Return the table."""
        own = pd.DataFrame({"time": self.middle_s, "window_s": self.window_s, "n_times": self.times})
        return pd.concat([own, pd.concat(self.tables, ignore_index=True)], axis=1)


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
