"""Small dense linear algebra without branches, on floats and symbols alike."""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops

Matrix = Any

_SWEEPS = {1: 0, 2: 1, 3: 4}  # one-sided Jacobi on m rows, to the last bit: design/svd_sweeps.py
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
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


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
    q, lower = _householder(a)
    parts = [np.concatenate([lower[:, j], np.eye(m)[j]]) for j in range(m)]
    parts, weights, squares = _orthogonalised(parts, m, 0.0)
    scaled = [ops.sqrt(e) * x for e, x in zip(weights, parts, strict=True)]
    columns = np.stack(scaled, axis=1)
    w, g = columns[:m], columns[m:]
    inverse = [ops.rsqrt(x) for x in squares]
    s = np.array([x * y for x, y in zip(squares, inverse, strict=True)])
    return Svd(_left_basis(w, s, inverse[0]), s, q[:, :m] @ g, q[:, m:])


class Rows(NamedTuple):
    """Orthogonal rows of a matrix and a right-hand side, the longest row first.

    The rows of R = U^T A are sqrt(weight_j) x_j = sigma_j v_j^T.

    Attributes:
        x: Rows up to their weights, (m, n); a row of zeros where A loses rank.
        b: U^T b up to the weights, (m,).
        weights: What squares must be multiplied by, (m,).
        squares: sigma_j^2, descending, (m,).
    """

    x: Matrix
    b: Matrix
    weights: Matrix
    squares: Matrix

    @property
    def along(self) -> Matrix:
        """U^T b: the right-hand side along the left singular vectors, (m,)."""
        return ops.sqrt(self.weights) * self.b

    def solve(self, squares: Matrix) -> Matrix:
        """Return V diag(sigma / squares) U^T b: a pseudo-inverse with squares for sigma^2."""
        return (self.weights * self.b / squares) @ self.x

    def project_out(self, y: Matrix, squares: Matrix) -> Matrix:
        """Return y - V diag(sigma^2 / squares) V^T y: null motion, where squares are sigma^2."""
        return y - (self.weights * (self.x @ y) / squares) @ self.x


def rows(a: Matrix, b: Matrix) -> Rows:
    """Return what the singular value decomposition of A (m x n) says about A x = b.

    One-sided Jacobi on the rows of [A | b]: no singular vector is asked for that rounding
    alone would choose.
    """
    n = a.shape[1]
    parts, weights, squares = _orthogonalised(
        list(np.concatenate([a, b[:, None]], axis=1)), n, _ORTHOGONAL
    )
    stacked = np.stack(parts)
    return Rows(stacked[:, :n], stacked[:, n], np.array(weights), np.array(squares))


def _orthogonalised(
    parts: list[Matrix], n: int, least: float
) -> tuple[list[Matrix], list[Any], list[Any]]:
    """Rotate vectors until their first n entries are orthogonal; the longest comes first.

    Sweeps of one-sided Jacobi with square-root-free rotations: a vector is
    sqrt(weight) part. The angles of all but the last sweep need not be sharp.

    Args:
        parts: The vectors.
        n: Number of entries that are to become orthogonal.
        least: Squared cosine up to which two vectors count as orthogonal.

    Returns:
        Parts, weights and squared lengths.
    """
    m = len(parts)
    pairs = list(combinations(range(m), 2))
    last = _SWEEPS[m] - 1
    weight: list[Any] = [1.0] * m

    def square(p: int) -> Any:
        return weight[p] * (parts[p][:n] @ parts[p][:n])

    for sweep in range(_SWEEPS[m]):
        for p, q in pairs:
            x, y = parts[p], parts[q]
            alpha, beta = _rotation(
                weight[p], weight[q], square(p), square(q), x[:n] @ y[:n], least, sweep < last
            )
            parts[p], parts[q] = x - alpha * y, y + beta * x
            cosine2 = 1.0 / (1.0 + alpha * beta)
            weight[p], weight[q] = weight[p] * cosine2, weight[q] * cosine2
    size = [square(p) for p in range(m)]
    for p, q in [(0, 1), (1, 2), (0, 1)] if m == 3 else pairs:
        swap = ops.less(size[p], size[q])
        for values in (parts, weight, size):
            values[p], values[q] = (
                ops.where(swap, values[q], values[p]),
                ops.where(swap, values[p], values[q]),
            )
    return parts, weight, size


def _rotation(
    ex: Any, ey: Any, xx: Any, yy: Any, xy: Any, least: float, rough: bool
) -> tuple[Any, Any]:
    """Return alpha and beta of the rotation that makes two weighted vectors orthogonal.

    x - alpha y and y + beta x, with both weights times 1/(1 + alpha beta), are the vectors
    turned by the angle with tan(2 angle) = 2 x.y / (y.y - x.x). Vectors orthogonal to
    ``least`` are left alone, so that what is zero by symmetry stays exactly zero, with and
    without fused multiply-adds.
    """
    a, b = ey * xy, ex * xy
    coupling = a * b
    gap = 0.5 * (yy - xx)
    square = gap * gap + coupling
    slope = 1.0 / (ops.absolute(gap) + square * ops.rsqrt(square, rough) + _TINY)
    near = ops.less_equal(coupling, least * (xx * yy))
    slope = ops.where(near, 0.0, ops.copysign(slope, gap))
    return a * slope, b * slope


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


def _left_basis(w: Matrix, s: Matrix, inverse: Any) -> Matrix:
    """Return orthonormal columns along w, completed where a singular value vanishes."""
    m = w.shape[0]
    first = ops.where(ops.less(0.0, s[0]), w[:, 0] * inverse, np.eye(m)[0])
    if m == 1:
        return first[:, None]
    if m == 2:
        second = _facing(np.array([-first[1], first[0]]), w[:, 1])
        return np.stack([first, second], axis=1)
    rest = w[:, 1] - (first @ w[:, 1]) * first
    square = rest @ rest
    usable = ops.less(_RANK * s[0], square * ops.rsqrt(square))
    second = ops.where(usable, rest * ops.rsqrt(square), _perpendicular(first))
    third = _facing(cross(first, second), w[:, 2])
    return np.stack([first, second, third], axis=1)


def _facing(direction: Matrix, reference: Matrix) -> Matrix:
    """Return a direction or its opposite, whichever has no negative part along the reference."""
    return ops.where(ops.less(direction @ reference, 0.0), -direction, direction)


def _perpendicular(u: Matrix) -> Matrix:
    """Return a unit vector perpendicular to the unit vector u."""
    flat = ops.less(ops.absolute(u[2]), 0.7)
    x = ops.where(flat, np.array([-u[1], u[0], 0.0 * u[2]]), np.array([0.0 * u[0], -u[2], u[1]]))
    return x * ops.rsqrt(x @ x)
