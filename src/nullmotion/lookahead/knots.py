"""What can be done about one knot of a plan: source that is compiled for many knots at once."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops

FLOOR = 0.02  # singular value below which a correction of momentum is damped
_LONGEST = 0.5  # rad; a knot is corrected by no more at once


class Knot(NamedTuple):
    """A configuration moved to its momentum, and how singularity depends on null motion there.

    Attributes:
        point: Gimbal angles delta + c with A c = target - h(delta) [rad], (n,).
        null: Orthonormal basis of null motion as columns, (n, n - m).
        ahead: sigma_min expected at ``point``.
        slope: Its derivative along the null motion, (n - m,).
        level: sigma_min where it was.
        miss: |target - h(delta)|, over the mean momentum.
    """

    point: Any
    null: Any
    ahead: Any
    slope: Any
    level: Any
    miss: Any


def rotors(spin: Any, torque: Any, delta: Any) -> tuple[Any, Any]:
    """Return unit momenta and the unit Jacobian, (n, m) and (m, n).

    Args:
        spin: Momenta at delta = 0 over the mean momentum, (n, m).
        torque: Their derivatives there, (n, m).
        delta: Gimbal angles [rad], (n,).
    """
    c, s = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    return c * spin + s * torque, (c * torque - s * spin).T


def knot(delta: Any, target: Any, spin: Any, torque: Any) -> Knot:
    """Return the linearisation of one knot.

    With A = U diag(sigma) V^T and h_i the momentum of CMG i over the mean momentum,

        d sigma_m / d delta_i = -(u_m . h_i) v_mi,

    for column i of A turns into -h_i.

    Args:
        delta: Gimbal angles of the plan so far [rad], (n,).
        target: Momentum to have there, over the mean momentum and without bias, (m,).
        spin: See `rotors`.
        torque: See `rotors`.
    """
    momenta, A = rotors(spin, torque, delta)
    svd = linalg.svd(A)
    error = target - sum(momenta)
    floored = ops.maximum(svd.s, FLOOR)
    change = svd.v @ (svd.s / (floored * floored) * (svd.u.T @ error))
    longest = _LONGEST * ops.rsqrt(change @ change)
    change = change * ops.minimum(longest, 1.0)
    gradient = -(momenta @ svd.u[:, -1]) * svd.v[:, -1]
    level = svd.s[-1]
    return Knot(
        delta + change,
        svd.null,
        level + gradient @ change,
        svd.null.T @ gradient,
        level,
        linalg.norm(error),
    )


def moved(delta: Any, target: Any, push: Any, climb: Any, spin: Any, torque: Any) -> Any:
    """Return gimbal angles (n,) with the momentum ``target``, and a null motion on the way.

    First c = A^+ (target - h) and ``push`` along the continuous null vector and ``climb`` along
    the null motion that raises sigma_min (unit vectors both), then two Newton corrections.

    Args:
        delta: Gimbal angles [rad], (n,).
        target: Momentum to have, (m,).
        push: Null motion along the null vector [rad].
        climb: Null motion up the slope of sqrt(det(A A^T)) [rad].
        spin: See `rotors`.
        torque: See `rotors`.
    """
    momenta, A = rotors(spin, torque, delta)
    rows = linalg.rows(A, target - sum(momenta))
    squares = ops.maximum(rows.squares, FLOOR * FLOOR)
    along = _sideways(A, rows, squares)
    upward = rows.project_out(_gradient(momenta, A), squares)
    change = _shortened(rows.solve(squares)) + push * _unit(along) + climb * _unit(upward)
    for _ in range(2):
        delta = delta + change
        momenta, A = rotors(spin, torque, delta)
        rows = linalg.rows(A, target - sum(momenta))
        change = _shortened(rows.solve(ops.maximum(rows.squares, FLOOR * FLOOR)))
    return delta + change


def _gradient(momenta: Any, A: Any) -> Any:
    """Return d log det(A A^T)/2 up to scale: -h_i . adj(A A^T) a_i, which has no division."""
    weighted = linalg.adjugate(A @ A.T) @ A
    return np.array([-(momenta[i] @ weighted[:, i]) for i in range(A.shape[1])])


def _sideways(A: Any, rows: linalg.Rows, squares: Any) -> Any:
    """Return null motion that is continuous along a path: the minors, or a fixed vector's share."""
    m, n = A.shape
    if n == m + 1:
        return linalg.minors_null_vector(A)
    return rows.project_out(np.cos(np.arange(n) ** 2), squares)


def _unit(x: Any) -> Any:
    return x * ops.rsqrt(x @ x + 1e-12)


def _shortened(change: Any) -> Any:
    return change * ops.minimum(_LONGEST * ops.rsqrt(change @ change), 1.0)
