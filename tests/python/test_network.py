from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from pogosim.analysis import laplacian, network, snapshots
from pogosim.analysis.laplacian import largest_component, spectrum
from pogosim.analysis.network import (
    AveragedSpectra,
    Connectedness,
    InstantaneousSpectra,
    averaged_spectra,
    contact_time_s,
    graph_over_time,
    graph_tables,
    instantaneous_spectra,
    ten_periods_s,
    windows_of,
)
from pogosim.analysis.trajectories import Trajectories, trajectories_of
from scipy import sparse
from swarms import Floats, metadata_of, rows_of


def graph(edges: Floats | list[tuple[int, int]], nodes: int) -> sparse.csr_array:
    row, column = np.asarray(edges, dtype=int).reshape(-1, 2).T
    ones = np.ones(2 * len(row))
    where = (np.concatenate([row, column]), np.concatenate([column, row]))
    return sparse.csr_array((ones, where), shape=(nodes, nodes))


def path(nodes: int) -> sparse.csr_array:
    return graph([(i, i + 1) for i in range(nodes - 1)], nodes)


def cycle(nodes: int) -> sparse.csr_array:
    return graph([(i, (i + 1) % nodes) for i in range(nodes)], nodes)


def complete(nodes: int) -> sparse.csr_array:
    return graph([(i, j) for i in range(nodes) for j in range(i)], nodes)


def star(leaves: int) -> sparse.csr_array:
    return graph([(0, i + 1) for i in range(leaves)], leaves + 1)


def lattice(side: int) -> sparse.csr_array:
    """A periodic square lattice."""
    one, ring = sparse.eye_array(side), cycle(side)
    return sparse.csr_array(sparse.kron(ring, one) + sparse.kron(one, ring))


def run_at(position_mm: Floats, periodic: bool = False, period_s: float = 1.0) -> Trajectories:
    position = np.asarray(position_mm, dtype=float)
    position = position if position.ndim == 3 else position[None]
    (run,) = trajectories_of(rows_of(position, period_s=period_s), metadata_of(1000.0, periodic))
    return run


def on_a_line(*x: float) -> Floats:
    return np.column_stack([x, np.full(len(x), 500.0)])


@pytest.mark.parametrize("nodes", [2, 7, 30])
def test_spectra_of_known_graphs(nodes: int) -> None:
    k = np.arange(1, nodes)
    np.testing.assert_allclose(spectrum(path(nodes), nodes - 1).smallest, 2 - 2 * np.cos(np.pi * k / nodes))
    np.testing.assert_allclose(spectrum(complete(nodes), nodes - 1).smallest, nodes)
    expected = np.ones(nodes - 1)
    expected[-1] = nodes
    np.testing.assert_allclose(spectrum(star(nodes - 1), nodes - 1).smallest, expected)
    assert spectrum(complete(nodes)).largest == pytest.approx(nodes)
    if nodes > 2:
        np.testing.assert_allclose(
            spectrum(cycle(nodes), nodes - 1).smallest, np.sort(2 - 2 * np.cos(2 * np.pi * k / nodes))
        )


def test_large_graphs_have_all_copies_of_multiple_eigenvalues() -> None:
    side = 25
    assert side**2 > laplacian.DENSE_UP_TO
    found = spectrum(lattice(side), 6)
    one = 2 - 2 * np.cos(2 * np.pi / side)
    np.testing.assert_allclose(found.smallest, [one, one, one, one, 2 * one, 2 * one])
    assert found.largest == pytest.approx(4 * (1 + np.cos(np.pi / side)))
    nodes = side**2
    np.testing.assert_allclose(spectrum(path(nodes), 3).smallest, 2 - 2 * np.cos(np.pi * np.arange(1, 4) / nodes))


def test_large_and_small_graphs_are_solved_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    position = np.random.default_rng(4).uniform(0.0, 1000.0, (300, 2))
    full = instantaneous_spectra(run_at(position), reach_mm=90.0)
    monkeypatch.setattr(laplacian, "DENSE_UP_TO", 20)
    by_arpack = instantaneous_spectra(run_at(position), reach_mm=90.0)
    np.testing.assert_allclose(by_arpack, full, rtol=1e-9)


def test_two_components_have_two_zeros_which_do_not_count() -> None:
    both = sparse.csr_array(sparse.block_diag([path(3), complete(4), path(1)]))
    found = spectrum(both, 7)
    np.testing.assert_allclose(found.smallest, [1, 3, 4, 4, 4, np.nan, np.nan])
    assert found.largest == pytest.approx(4.0)
    assert (found.nodes, found.edges) == (8, 8)
    largest = spectrum(largest_component(both), 2)
    assert (largest.nodes, largest.edges) == (4, 6)
    np.testing.assert_allclose(largest.smallest, 4.0)


def test_weak_edges_below_the_tolerance_count_as_none() -> None:
    weak = 1e-12 * path(2)
    assert np.isnan(spectrum(weak).smallest).all()
    np.testing.assert_allclose(spectrum(weak, 1, zero_tol=1e-13).smallest, 2e-12)


def test_graphs_without_edges_or_nodes() -> None:
    alone = spectrum(graph([], 3))
    assert (alone.largest, alone.nodes, alone.edges) == (0.0, 3, 0)
    assert np.isnan(alone.smallest).all()
    nobody = spectrum(graph([], 0))
    assert nobody.nodes == 0
    assert np.isnan(nobody.largest)


def test_table_has_a_row_per_time_with_the_swarm_and_its_largest_component() -> None:
    position = np.stack([on_a_line(0, 100, 200, 800, 900), on_a_line(0, 100, 200, 300, 400)])
    table = instantaneous_spectra(run_at(position), 2, reach_mm=110.0)
    assert table.columns.tolist() == [
        "time",
        *(f"{part}_lambda_{name}" if name in ("nz_1", "nz_2", "max") else f"{part}_{name}"
          for part in ("swarm", "lcc") for name in ("nz_1", "nz_2", "max", "n_nodes", "n_edges")),
    ]  # fmt: skip
    first, second = table.iloc[0], table.iloc[1]
    assert first[["swarm_lambda_nz_1", "swarm_lambda_nz_2", "swarm_lambda_max"]].tolist() == pytest.approx([1, 2, 3])
    assert first[["swarm_n_nodes", "swarm_n_edges", "lcc_n_nodes", "lcc_n_edges"]].tolist() == [5, 3, 3, 2]
    assert first[["lcc_lambda_nz_1", "lcc_lambda_nz_2"]].tolist() == pytest.approx([1, 3])
    assert second["swarm_lambda_nz_1"] == second["lcc_lambda_nz_1"] == pytest.approx(2 - 2 * np.cos(np.pi / 5))


def test_a_ring_across_periodic_borders_is_a_cycle() -> None:
    ring = on_a_line(*np.arange(50.0, 1000.0, 100.0))
    closed = instantaneous_spectra(run_at(ring, periodic=True), 1, reach_mm=110.0)
    opened = instantaneous_spectra(run_at(ring), 1, reach_mm=110.0)
    assert closed["swarm_lambda_nz_1"][0] == pytest.approx(2 - 2 * np.cos(np.pi / 5))
    assert opened["swarm_lambda_nz_1"][0] == pytest.approx(2 - 2 * np.cos(np.pi / 10))


def test_graph_over_time_counts_components() -> None:
    position = np.stack([on_a_line(0, 100, 200, 800, 900), on_a_line(0, 100, 200, 300, 400)])
    position[1, 4] = np.nan
    table = graph_over_time(run_at(position), 110.0)
    assert table["n_nodes"].tolist() == [5, 4]
    assert table["n_components"].tolist() == [2, 1]
    assert table["largest_component_fraction"].tolist() == [0.6, 1.0]
    assert table["mean_degree"].tolist() == [6 / 5, 6 / 4]


def test_averaged_over_a_window_edges_have_weights_between_0_and_1() -> None:
    # Robot 1 goes back and forth between two others: half a weight each, a path that is at no time there.
    position = np.stack([on_a_line(0, 100 if step % 2 else 300, 400) for step in range(8)])
    run = run_at(position)
    assert (graph_over_time(run, 110.0)["n_components"] == 2).all()
    table = averaged_spectra(run, 4.0, 2, reach_mm=110.0)
    assert table["n_times"].tolist() == [4, 4]
    assert table["time"].tolist() == [1.5, 5.5]
    np.testing.assert_allclose(table["swarm_lambda_nz_1"], 0.5)
    np.testing.assert_allclose(table["lcc_lambda_max"], 1.5)
    assert table["swarm_n_edges"].tolist() == [2, 2]


def test_a_window_of_one_save_time_is_the_snapshot() -> None:
    position = np.random.default_rng(0).uniform(0.0, 500.0, (5, 12, 2))
    run = run_at(position)
    averaged = averaged_spectra(run, 1.0).drop(columns=["window_s", "n_times"])
    np.testing.assert_allclose(averaged, instantaneous_spectra(run))


@pytest.mark.parametrize("in_a_window", [3, 7, 10])
def test_windows_hold_the_save_times_they_should_despite_24_bits(in_a_window: int) -> None:
    times = (0.1 * np.arange(100 * in_a_window)).astype(np.float32).astype(float)
    assert (np.bincount(windows_of(times, 0.1 * in_a_window)) == in_a_window).all()


def test_contact_time_is_reach_over_speed() -> None:
    position = np.stack([on_a_line(10 * step, 100 + 10 * step) for step in range(5)])
    run = run_at(position, period_s=0.5)
    assert contact_time_s([run], 133.0) == pytest.approx(133.0 / 20.0)
    assert contact_time_s([run]) == pytest.approx(run.reach_mm / 20.0)
    assert ten_periods_s([run]) == 5.0
    still = run_at(position[:1])
    assert contact_time_s([still]) == ten_periods_s([still]) == np.inf
    assert len(averaged_spectra(still, np.inf)) == 1


def test_windows_that_go_on_in_the_next_block_are_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    position = np.random.default_rng(7).uniform(0.0, 1000.0, (11, 20, 2))
    position[3:6, 4] = np.nan
    run = run_at(position)
    tables = [averaged_spectra(run, window_s, reach_mm=250.0) for window_s in (1.0, 4.0, np.inf)]
    assert tables[1]["n_times"].tolist() == [4, 4, 3]
    monkeypatch.setattr(snapshots, "MAX_POINTS", 50)
    for table, window_s in zip(tables, (1.0, 4.0, np.inf), strict=True):
        pd.testing.assert_frame_equal(averaged_spectra(run, window_s, reach_mm=250.0), table)
    now = instantaneous_spectra(run, reach_mm=250.0)
    np.testing.assert_allclose(tables[0].filter(like="lambda"), now.filter(like="lambda"))


def test_pairs_are_found_once_for_all_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshots, "MAX_POINTS", 12)
    position = np.random.default_rng(3).uniform(0.0, 300.0, (10, 6, 2))
    (run,) = trajectories_of(rows_of(position), metadata_of())
    apart = [graph_over_time(run), instantaneous_spectra(run), averaged_spectra(run, 3.0)]
    searches = 0

    def counted(*arguments: Any) -> Any:
        nonlocal searches
        searches += 1
        return snapshots.pairs_of(*arguments)

    monkeypatch.setattr(network, "pairs_of", counted)
    together = graph_tables(run, [Connectedness(run), InstantaneousSpectra(run), AveragedSpectra(run, 3.0)])
    assert searches == 5
    for one, other in zip(apart, together, strict=True):
        pd.testing.assert_frame_equal(one, other, check_exact=True)
