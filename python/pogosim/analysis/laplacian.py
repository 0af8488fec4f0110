"""Spectrum of a graph: the smallest non-zero and the largest eigenvalues of its combinatorial Laplacian L = D - A.

The number of zero eigenvalues is the number of connected components. The smallest non-zero one of a connected graph is
its algebraic connectivity: rates of consensus and diffusion over the graph are proportional to it. M. Fiedler,
"Algebraic connectivity of graphs", Czech. Math. J. 23, 298 (1973); B. Mohar, "The Laplacian spectrum of graphs" (1991).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh, splu

from pogosim.analysis.arena import Floats
from pogosim.analysis.snapshots import Integers

# Larger components are faster as sparse matrices.
DENSE_UP_TO = 400

# Elements of matrices that are solved at once.
MAX_CELLS = 2_000_000

# Eigenvalues beyond the wanted ones, in search of a gap.
EXTRA = 5


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of a Laplacian, in the unit of the weights (none for an unweighted graph)."""

    smallest: Floats  # (k,), the smallest ones that are not zero, increasing; NaN where there are fewer
    largest: float  # 0 without edges; NaN without nodes
    nodes: int
    edges: int


@dataclass(frozen=True)
class Spectra:
    """The `Spectrum` of each of G graphs."""

    smallest: Floats  # (G, k)
    largest: Floats  # (G,)
    nodes: Integers  # (G,)
    edges: Integers  # (G,)


def spectrum(adjacency: sparse.csr_array, count: int = 5, zero_tol: float = 1e-10) -> Spectrum:
    """Return the extreme eigenvalues of a graph, of all its components together.

    Each component has one eigenvalue that is zero, which is left out; so is what is not above zero_tol.

    Args:
        adjacency: Shape (n, n), symmetric, weights above 0, nothing on the diagonal.
        count: How many small eigenvalues, k.
        zero_tol: Greatest eigenvalue that counts as zero.

    Returns:
        The eigenvalues. Those of components with up to 400 nodes are from LAPACK; of larger ones from ARPACK (shifted
        and inverted), checked for completeness by Sylvester's law of inertia.
    """
    swarm, _ = spectra(adjacency, np.zeros(adjacency.shape[0], dtype=np.int64), 1, count, zero_tol)
    return Spectrum(swarm.smallest[0], float(swarm.largest[0]), int(swarm.nodes[0]), int(swarm.edges[0]))


def spectra(
    adjacency: sparse.csr_array, graph: Integers, graphs: int, count: int = 5, zero_tol: float = 1e-10
) -> tuple[Spectra, Spectra]:
    """Return the `spectrum` of each of several graphs, and that of its largest connected component.

    Args:
        adjacency: Adjacency of all graphs together, see `spectrum`; without edges from one graph to another.
        graph: Number of the graph of each node, 0 to graphs - 1, increasing, shape (n,).
        graphs: How many.
        count: See `spectrum`.
        zero_tol: See `spectrum`.
    """
    number, label = csgraph.connected_components(adjacency, directed=False)
    size = np.bincount(label, minlength=number)
    smallest, largest = np.full((number, count), np.inf), np.zeros(number)
    for which, part in components(adjacency, label, size):
        values, largest[which] = dense(part) if part.shape[-1] <= DENSE_UP_TO else ends(part, count)
        values = np.sort(np.where(values > zero_tol, values, np.inf), axis=1)[:, :count]
        smallest[which, : values.shape[1]] = values
    first = np.unique(label, return_index=True)[1]
    home = graph[first]  # of a component
    edges = np.bincount(label, np.diff(adjacency.indptr), minlength=number).astype(np.int64) // 2
    nodes = np.bincount(graph, minlength=graphs)
    swarm = Spectra(
        least_of_groups(smallest, home, graphs, count),
        np.where(nodes > 0, 0.0, np.nan),
        nodes,
        np.bincount(home, edges, minlength=graphs).astype(np.int64),
    )
    np.maximum.at(swarm.largest, home, largest)
    # Among equal components, the one with the first node.
    order = np.lexsort((first, -size, home))
    top = order[np.concatenate([np.ones(min(number, 1), dtype=bool), np.diff(home[order]) > 0])]
    part = Spectra(np.full((graphs, count), np.nan), np.full(graphs, np.nan), 0 * nodes, 0 * nodes)
    own = home[top]
    part.smallest[own] = np.where(np.isfinite(smallest[top]), smallest[top], np.nan)
    part.largest[own], part.nodes[own], part.edges[own] = largest[top], size[top], edges[top]
    return swarm, part


def least_of_groups(values: Floats, group: Integers, groups: int, count: int) -> Floats:
    """Return the smallest finite values of each group of rows, increasing, NaN where there are fewer.

    Shapes (n, k) and (n,) to (groups, count).
    """
    known = np.isfinite(values)
    value, owner = values[known], np.broadcast_to(group[:, None], values.shape)[known]
    order = np.lexsort((value, owner))
    value, owner = value[order], owner[order]
    rank = np.arange(len(owner)) - np.searchsorted(owner, owner)
    found = np.full((groups, count), np.nan)
    wanted = rank < count
    found[owner[wanted], rank[wanted]] = value[wanted]
    return found


def largest_component(adjacency: sparse.csr_array) -> sparse.csr_array:
    """Return the adjacency matrix of the largest connected component; of equal ones, that with the first node."""
    if adjacency.shape[0] == 0:
        return adjacency
    label = csgraph.connected_components(adjacency, directed=False)[1]
    own = np.flatnonzero(label == np.argmax(np.bincount(label)))
    return adjacency[own][:, own]


def components(
    adjacency: sparse.csr_array, label: Integers, size: Integers
) -> Iterator[tuple[Integers, Floats | sparse.csr_array]]:
    """Yield the components that have edges: equal sizes as an array of shape (m, n, n), large ones one by one.

    Args:
        adjacency: Adjacency of all components.
        label: Number of the component of each node.
        size: Number of nodes of each component.

    Yields:
        The numbers of the components, shape (m,), and their adjacency matrices.
    """
    order = np.argsort(label, kind="stable")
    start = np.concatenate([[0], np.cumsum(size)])
    place = np.empty(len(label), dtype=np.int64)  # of a node in its component
    place[order] = np.arange(len(label)) - np.repeat(start[:-1], size)
    edges = adjacency.tocoo()
    owner = label[edges.row]
    by_owner = np.argsort(owner, kind="stable")
    border = np.searchsorted(owner[by_owner], np.arange(len(size) + 1))
    for nodes in np.unique(size[size > 1]):
        same = np.flatnonzero(size == nodes)
        if nodes > DENSE_UP_TO:
            for component in same:
                own = order[start[component] : start[component + 1]]
                yield np.array([component]), adjacency[own][:, own]
            continue
        for part in np.array_split(same, -(-len(same) * nodes**2 // MAX_CELLS)):
            # The edges of these components, one component after the other.
            counts = border[part + 1] - border[part]
            total = np.cumsum(counts)
            mine = by_owner[np.arange(total[-1]) + np.repeat(border[part] - total + counts, counts)]
            matrices = np.zeros((len(part), nodes, nodes))
            which = np.repeat(np.arange(len(part)), counts)
            matrices[which, place[edges.row[mine]], place[edges.col[mine]]] = edges.data[mine]
            yield part, matrices


def dense(adjacency: Floats | sparse.csr_array) -> tuple[Floats, Floats]:
    """Return all eigenvalues of connected graphs but the zero of each, and the largest. Shape (m, n, n)."""
    matrices = np.asarray(adjacency)
    laplacian = -matrices
    diagonal = np.arange(matrices.shape[-1])
    laplacian[:, diagonal, diagonal] = matrices.sum(axis=2)
    values = np.linalg.eigvalsh(laplacian)
    return values[:, 1:], values[:, -1]


def ends(adjacency: Floats | sparse.csr_array, count: int) -> tuple[Floats, Floats]:
    """Return the smallest non-zero eigenvalues of a large connected graph, and the largest one.

    Shape (n, n) to (1, count) and (1,).
    """
    laplacian = sparse.csc_array(csgraph.laplacian(sparse.csc_array(adjacency)))
    nodes = laplacian.shape[0]
    first = np.random.default_rng(0).standard_normal(nodes)  # the same each time
    try:
        largest = float(eigsh(laplacian, 3, which="LA", v0=first, ncv=min(nodes, 60), return_eigenvectors=False)[-1])
        if below(laplacian, largest * (1.0 + 1e-9)) < nodes:  # a greater one is missing
            raise RuntimeError("the largest eigenvalue was not found")
        values = smallest_by_inversion(laplacian, min(count + EXTRA, nodes - 1), largest, first)
        # Copies of a multiple eigenvalue can be missing; a gap above the wanted ones shows how many there should be.
        gaps = np.diff(values[count:])
        gap = count + int(np.argmax(gaps))
        if gaps.max() > 1e-9 * largest and below(laplacian, float(values[gap : gap + 2].mean())) == gap + 1:
            return values[None, 1 : count + 1], np.array([largest])
    except (ArpackError, RuntimeError):  # not converged, or singular
        pass
    every = linalg.eigvalsh(laplacian.toarray())
    return every[None, 1 : count + 1], every[-1:]


def smallest_by_inversion(laplacian: sparse.csc_array, count: int, scale: float, first: Floats) -> Floats:
    """Return the smallest eigenvalues, zero included, increasing: the largest ones of the inverse of L + shift."""
    nodes = laplacian.shape[0]
    shift = 1e-4 * scale
    solve = splu(laplacian + shift * sparse.eye_array(nodes, format="csc"), permc_spec="MMD_AT_PLUS_A").solve
    inverse = LinearOperator(laplacian.shape, matvec=solve, dtype=float)
    found = eigsh(inverse, count, which="LA", v0=first, ncv=min(nodes, 4 * count + 20), return_eigenvectors=False)
    return np.sort(1.0 / found - shift)


def below(laplacian: sparse.csc_array, value: float) -> int:
    """Count the eigenvalues below a value: the negative pivots of L - value (Sylvester's law of inertia)."""
    shifted = laplacian - value * sparse.eye_array(laplacian.shape[0], format="csc")
    factors = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return int(np.count_nonzero(factors.U.diagonal() < 0.0))
