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

# Larger components are faster as sparse matrices.
DENSE_UP_TO = 400

# Eigenvalues beyond the wanted ones, in search of a gap.
EXTRA = 5


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of a Laplacian, in the unit of the weights (none for an unweighted graph)."""

    smallest: Floats  # (k,), the smallest ones that are not zero, increasing; NaN where there are fewer
    largest: float  # 0 without edges; NaN without nodes
    nodes: int
    edges: int


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
    nodes = adjacency.shape[0]
    if nodes == 0:
        return Spectrum(np.full(count, np.nan), float("nan"), 0, 0)
    small: list[Floats] = []
    largest = 0.0
    for part in components(adjacency):
        values, greatest = dense(part) if part.shape[-1] <= DENSE_UP_TO else ends(part, count)
        small.append(values[values > zero_tol])
        largest = max(largest, greatest)
    found = np.sort(np.concatenate(small))[:count] if small else np.empty(0)
    smallest = np.full(count, np.nan)
    smallest[: len(found)] = found
    return Spectrum(smallest, largest, nodes, adjacency.nnz // 2)


def largest_component(adjacency: sparse.csr_array) -> sparse.csr_array:
    """Return the adjacency matrix of the largest connected component; of equal ones, that with the first node."""
    if adjacency.shape[0] == 0:
        return adjacency
    label = csgraph.connected_components(adjacency, directed=False)[1]
    own = np.flatnonzero(label == np.argmax(np.bincount(label)))
    return adjacency[own][:, own]


def components(adjacency: sparse.csr_array) -> Iterator[Floats | sparse.csr_array]:
    """Yield the components that have edges: equal sizes as an array of shape (m, n, n), large ones one by one."""
    count, label = csgraph.connected_components(adjacency, directed=False)
    size = np.bincount(label)
    order = np.argsort(label, kind="stable")
    start = np.concatenate([[0], np.cumsum(size)])
    place = np.empty(len(label), dtype=np.int64)  # of a node in its component
    place[order] = np.arange(len(label)) - np.repeat(start[:-1], size)
    edges = adjacency.tocoo()
    for nodes in np.unique(size[size > 1]):
        same = np.flatnonzero(size == nodes)
        if nodes > DENSE_UP_TO:
            yield from (adjacency[own][:, own] for own in (order[start[c] : start[c + 1]] for c in same))
            continue
        which = np.full(count, -1)
        which[same] = np.arange(len(same))
        mine = which[label[edges.row]] >= 0
        matrices = np.zeros((len(same), nodes, nodes))
        row, column = edges.row[mine], edges.col[mine]
        matrices[which[label[row]], place[row], place[column]] = edges.data[mine]
        yield matrices


def dense(adjacency: Floats | sparse.csr_array) -> tuple[Floats, float]:
    """Return all eigenvalues of connected graphs but the zero of each, and the largest. Shape (m, n, n)."""
    matrices = np.asarray(adjacency)
    laplacian = -matrices
    diagonal = np.arange(matrices.shape[-1])
    laplacian[:, diagonal, diagonal] = matrices.sum(axis=2)
    values = np.linalg.eigvalsh(laplacian)
    return values[:, 1:].ravel(), float(values[:, -1].max())


def ends(adjacency: Floats | sparse.csr_array, count: int) -> tuple[Floats, float]:
    """Return the smallest non-zero eigenvalues of a large connected graph, and the largest one. Shape (n, n)."""
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
            return values[1 : count + 1], largest
    except (ArpackError, RuntimeError):  # not converged, or singular
        pass
    every = linalg.eigvalsh(laplacian.toarray())
    return every[1 : count + 1], float(every[-1])


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
