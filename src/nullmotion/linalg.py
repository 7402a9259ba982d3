"""Small dense linear algebra without branches, on floats and symbols alike."""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops

Matrix = Any

_SWEEPS = {1: 0, 2: 2, 3: 4}  # one-sided Jacobi on m x m: to the last bit (design/svd_sweeps.py)
_ORTHOGONAL = 1e-28  # squared cosine of two rows below which their product is rounding
_TINY = 1e-150  # its square is still a normal number
_RANK = 4e-16  # a second singular value below this share of the first is rounding


class Svd(NamedTuple):
    """Singular value decomposition A = U diag(s) V^T of an m x n matrix, m <= 3.

    Attributes:
        u: Left singular vectors as columns, (m, m).
        s: Singular values, descending, (m,).
        v: Right singular vectors as columns, (n, m).
        null: Orthonormal basis of the rest of the gimbal space as columns, (n, n - m);
            its sign and rotation are arbitrary (see `null_vector`).
    """

    u: Matrix
    s: Matrix
    v: Matrix
    null: Matrix


def dot(a: Matrix, b: Matrix) -> Any:
    """Return the inner product of two vectors."""
    return a @ b


def norm(a: Matrix) -> Any:
    """Return the Euclidean norm of a vector."""
    return ops.sqrt(a @ a)


def cross(a: Matrix, b: Matrix) -> Matrix:
    """Return the vector product (np.cross does not take objects of every kind)."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def adjugate(m: Matrix) -> Matrix:
    """Return adj(M), so that M adj(M) = det(M) I, for 1 x 1 to 3 x 3."""
    size = m.shape[0]
    if size == 1:
        return np.ones((1, 1))
    if size == 2:
        return np.array([[m[1, 1], -m[0, 1]], [-m[1, 0], m[0, 0]]])
    rows = [cross(m[:, 1], m[:, 2]), cross(m[:, 2], m[:, 0]), cross(m[:, 0], m[:, 1])]
    return np.stack(rows)


def det(m: Matrix) -> Any:
    """Return the determinant, 1 x 1 to 3 x 3."""
    return m[0] @ adjugate(m)[:, 0] if m.shape[0] > 1 else m[0, 0]


def solve(m: Matrix, b: Matrix) -> Matrix:
    """Return M^-1 b through the adjugate; for the well-conditioned M of damped laws."""
    adj = adjugate(m)
    return (adj @ b) * (1.0 / (m[0] @ adj[:, 0]))


def minors_null_vector(a: Matrix) -> Matrix:
    """Return the vector of signed minors of an m x (m+1) matrix.

    A n = 0 and |n| = sqrt(det(A A^T)): a null vector that is continuous everywhere,
    zero only where A loses rank.
    """
    m = a.shape[0]
    keep = [[j for j in range(m + 1) if j != i] for i in range(m + 1)]
    return np.array([(-1.0) ** i * det(a[:, columns]) for i, columns in enumerate(keep)])


def null_vector(a: Matrix) -> Matrix:
    """Return a continuous null vector of A (m x n, n > m), of length sqrt(det(A A^T)) if n = m + 1.

    Beyond one degree of freedom: the sum over all choices of m + 1 columns.
    """
    m, n = a.shape
    total = np.array([0.0 * a[0, j] for j in range(n)])
    for columns in combinations(range(n), m + 1):
        total[list(columns)] = total[list(columns)] + minors_null_vector(a[:, list(columns)])
    return total


def svd(a: Matrix) -> Svd:
    """Return the singular value decomposition of an m x n matrix, m in 1..3, any n.

    Householder QR of A^T, then a fixed number of one-sided Jacobi sweeps on the
    m x m factor; left vectors of vanishing singular values are completed to a
    basis. A matrix with n < m is padded with zero columns and its v cut back.
    """
    m, n = a.shape
    if n < m:
        wide = svd(np.concatenate([a, np.zeros((m, m - n))], axis=1))
        return Svd(wide.u, wide.s, wide.v[:n], np.zeros((n, 0)))
    q, r = _householder(a)
    w, g = _jacobi(r)
    order = _sort(np.concatenate([w, g]), m)
    w, g = order[:m], order[m:]
    s = np.array([norm(w[:, j]) for j in range(m)])
    return Svd(_left_basis(w, s), s, q[:, :m] @ g, q[:, m:])


class Rows(NamedTuple):
    """A = U R with orthogonal U and orthogonal rows of R, the longest first.

    Attributes:
        u: Left singular vectors as columns, (m, m).
        r: sigma_j v_j^T as rows, (m, n); a row of zeros where A loses rank.
        squares: sigma_j^2, descending, (m,).
    """

    u: Matrix
    r: Matrix
    squares: Matrix

    def solve(self, b: Matrix, squares: Matrix) -> Matrix:
        """Return R^T diag(1 / squares) U^T b: a pseudo-inverse with squares in sigma^2's place."""
        return ((self.u.T @ b) / squares) @ self.r

    def project_out(self, x: Matrix, squares: Matrix) -> Matrix:
        """Return x - R^T diag(1 / squares) R x: null motion, where squares are sigma^2."""
        return x - ((self.r @ x) / squares) @ self.r


def rows(a: Matrix) -> Rows:
    """Return the singular value decomposition of A kept as orthogonal rows.

    One-sided Jacobi on the rows of A. Rows that are orthogonal up to rounding are left
    alone, so that what is zero by symmetry stays exactly zero, with and without fused
    multiply-adds; and no singular vector is asked for that rounding alone would choose.
    """
    m, n = a.shape
    parts = list(np.concatenate([a, np.eye(m)], axis=1))
    for _ in range(_SWEEPS[m]):
        for p, q in combinations(range(m), 2):
            parts[p], parts[q] = _rotated(parts[p], parts[q], n)
    size = [x[:n] @ x[:n] for x in parts]
    for p, q in [(0, 1), (1, 2), (0, 1)] if m == 3 else [(0, 1)] if m == 2 else []:
        swap = ops.less(size[p], size[q])
        parts[p], parts[q] = (
            ops.where(swap, parts[q], parts[p]),
            ops.where(swap, parts[p], parts[q]),
        )
        size[p], size[q] = ops.where(swap, size[q], size[p]), ops.where(swap, size[p], size[q])
    stacked = np.stack(parts)
    return Rows(stacked[:, n:].T, stacked[:, :n], np.array(size))


def _rotated(x: Matrix, y: Matrix, n: int) -> tuple[Matrix, Matrix]:
    """Rotate two rows so that their first n entries become orthogonal."""
    xx, yy, xy = x[:n] @ x[:n], y[:n] @ y[:n], x[:n] @ y[:n]
    coupling = ops.where(ops.less(_ORTHOGONAL * (xx * yy), xy * xy), 2.0 * xy, 0.0)
    c, s = _rotation(yy - xx, coupling)
    return c * x - s * y, s * x + c * y


def _rotation(gap: Any, coupling: Any) -> tuple[Any, Any]:
    """Return cosine and sine of the smaller angle that decouples two vectors.

    tan(2 angle) = coupling / gap, with gap = y.y - x.x and coupling = 2 x.y.
    """
    square = gap * gap + coupling * coupling
    p = ops.absolute(gap) + square * ops.rsqrt(square) + _TINY
    w = ops.rsqrt(p * p + coupling * coupling)
    return p * w, ops.where(ops.less(gap, 0.0), -coupling, coupling) * w


def _householder(a: Matrix) -> tuple[Matrix, Matrix]:
    """Return Q (n x n) and L = R^T (m x m) with A = L Q[:, :m]^T."""
    m, n = a.shape
    work = [list(row) for row in a]
    reflections = []
    for k in range(min(m, n - 1)):
        x = np.array(work[k][k:])
        alpha = ops.where(ops.less(x[0], 0.0), 1.0, -1.0) * norm(x)
        v = x.copy()
        v[0] = x[0] - alpha
        beta = 2.0 / (v @ v + _TINY * _TINY)
        reflections.append((k, v, beta))
        for i in range(k + 1, m):
            row = np.array(work[i][k:])
            work[i][k:] = list(row - (beta * (v @ row)) * v)
        work[k][k:] = [alpha] + [0.0] * (n - k - 1)
    q = np.eye(n).astype(a.dtype)
    for k, v, beta in reversed(reflections):
        block = q[k:, k:]
        q[k:, k:] = block - np.outer(v, beta * (v @ block))
    lower = np.array([[work[i][j] if j <= i else 0.0 for j in range(m)] for i in range(m)])
    return q, lower


def _jacobi(w: Matrix) -> tuple[Matrix, Matrix]:
    """Rotate the columns of W until they are orthogonal; return W G and G."""
    m = w.shape[0]
    both = np.concatenate([w, np.eye(m)])
    for _ in range(_SWEEPS[m]):
        for p, q in combinations(range(m), 2):
            x, y = both[:m, p], both[:m, q]
            c, s = _rotation(y @ y - x @ x, 2.0 * (x @ y))
            left, right = both[:, p] * c - both[:, q] * s, both[:, p] * s + both[:, q] * c
            both = both.copy() if both.dtype != object else np.array(both)
            both[:, p], both[:, q] = left, right
    return both[:m], both[m:]


def _sort(columns: Matrix, m: int) -> Matrix:
    """Order columns by the norm of their first m entries, descending."""
    cols = [columns[:, j] for j in range(m)]
    size = [c[:m] @ c[:m] for c in cols]
    for p, q in [(0, 1), (1, 2), (0, 1)] if m == 3 else [(0, 1)] if m == 2 else []:
        swap = ops.less(size[p], size[q])
        cols[p], cols[q] = ops.where(swap, cols[q], cols[p]), ops.where(swap, cols[p], cols[q])
        size[p], size[q] = ops.where(swap, size[q], size[p]), ops.where(swap, size[p], size[q])
    return np.stack(cols, axis=1)


def _left_basis(w: Matrix, s: Matrix) -> Matrix:
    """Return orthonormal columns along w, completed where a singular value vanishes."""
    m = w.shape[0]
    present = ops.less(0.0, s[0])
    first = ops.where(present, w[:, 0] * (1.0 / ops.where(present, s[0], 1.0)), np.eye(m)[0])
    if m == 1:
        return first[:, None]
    if m == 2:
        second = _facing(np.array([-first[1], first[0]]), w[:, 1])
        return np.stack([first, second], axis=1)
    rest = w[:, 1] - (first @ w[:, 1]) * first
    length = norm(rest)
    usable = ops.less(_RANK * s[0], length)
    second = ops.where(usable, rest * (1.0 / ops.where(usable, length, 1.0)), _perpendicular(first))
    third = _facing(cross(first, second), w[:, 2])
    return np.stack([first, second, third], axis=1)


def _facing(direction: Matrix, reference: Matrix) -> Matrix:
    """Return a direction or its opposite, whichever has no negative part along the reference."""
    return ops.where(ops.less(direction @ reference, 0.0), -direction, direction)


def _perpendicular(u: Matrix) -> Matrix:
    """Return a unit vector perpendicular to the unit vector u."""
    flat = ops.less(ops.absolute(u[2]), 0.7)
    x = ops.where(flat, np.array([-u[1], u[0], 0.0 * u[2]]), np.array([0.0 * u[0], -u[2], u[1]]))
    return x * (1.0 / norm(x))
