"""How near an array is to singular: measures of A, and the nearest singular configuration.

CMG i cannot give torque along the unit vector u of the torque space when its column
of A is perpendicular to u,

    a_i(delta_i) . u = 0    <=>    delta_i = atan2(t_i . u, s_i . u)  (mod pi),

and the array is singular when that holds for all its CMGs at once. So its singular set
is a surface over the directions u, and the distance to it a minimum over u
(Pereira 2022 works out the triangle; this is any array, m = 1 to 3).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.singular_kind import TOLERANCE, Kind, kind

_GRID = {1: 1, 2: 360, 3: 1200}  # directions; 4 deg apart on the half sphere
_STARTS = 10  # least local minima of the grid that are polished
_STEPS = 30  # damped Newton steps; six do, save for minima close to a gimbal axis
_SETTLED = 1e-11  # rad; Newton steps below it end the polish
_FREE = 1e-20  # squared sine of the angle between u and a gimbal axis, below which it is on it
_LEAST_SIGMA = 1e-16  # divisor of the condition number at a singular state
_CHUNK = 64  # configurations searched at once: keeps the grid's values in the cache


@dataclass(frozen=True, eq=False)
class Nearest:
    """The singular configuration nearest to given gimbal angles.

    Attributes:
        distance: 2-norm over the CMGs of the gimbal rotation to get there [rad], (...).
        delta_s: The singular gimbal angles [rad], (..., n), each within pi/2 of where it was.
        u: Singular direction, a unit vector of the torque space, (..., m); its sign is arbitrary.
    """

    distance: Any
    delta_s: np.ndarray
    u: np.ndarray


def measures(array: CmgArray, delta: Any) -> dict[str, Any]:
    """Return the singularity measures of A divided by the mean momentum of the working CMGs.

        sqrt_det_AAT = sqrt(det(A A^T)) = sigma_1 ... sigma_m    (Nakamura's manipulability)
        condition_number = sigma_1 / max(sigma_m, 1e-16)
        distance_to_singularity: see `nearest` [rad]

    Args:
        array: The array.
        delta: Gimbal angles [rad], (..., n).

    Returns:
        ``sqrt_det_AAT``, ``sigma_min``, ``condition_number`` and ``distance_to_singularity``,
        each a float, or an array over delta's leading axes.

    Raises:
        InputError: For angles of another number of CMGs, or angles that are not finite.
    """
    angles = checked_angles(array, delta)
    sigma = np.linalg.svd(array.unit_jacobian(angles), compute_uv=False)
    if array.n < array.m:
        sigma = np.concatenate([sigma, np.zeros((*sigma.shape[:-1], array.m - array.n))], axis=-1)
    distance = _search(array, angles.reshape(-1, array.n))[0].reshape(angles.shape[:-1])
    return {
        "sqrt_det_AAT": np.prod(sigma, axis=-1),
        "sigma_min": sigma[..., -1][()],
        "condition_number": sigma[..., 0] / np.maximum(sigma[..., -1], _LEAST_SIGMA),
        "distance_to_singularity": distance[()],
    }


def classify(array: CmgArray, delta: Any, tolerance: float = TOLERANCE) -> Any:
    """Return what null motion can do at gimbal angles.

    - ``regular``: not singular.
    - ``saturation``: no gimbal angles at all have more momentum along u.
    - ``elliptic``: no null motion; the angles are isolated among those of their momentum.
    - ``hyperbolic``: null motion leads out of the singular set.
    - ``degenerate-hyperbolic``: there is null motion, but close by all of it stays singular
      (looked at up to 0.1 rad away).

    Args:
        array: The array.
        delta: Gimbal angles [rad], (..., n).
        tolerance: A / mean momentum with sigma_min up to this is singular, and eigenvalues of
            Q / mean momentum up to this are zero. Angles that are singular when rounded
            to a millionth of a rad are thus singular.

    Returns:
        A string (`nullmotion.singular_kind.Kind`), or an array of them over the leading axes.

    Raises:
        InputError: For angles of another number of CMGs, or angles that are not finite, and for
            a tolerance that is not above 0 and below 1.
    """
    if not 0 < tolerance < 1:
        raise InputError("tolerance", tolerance, "above 0, below 1")
    angles = checked_angles(array, delta)
    if angles.ndim == 1:
        return kind(array, angles, tolerance)
    rows = angles.reshape(-1, array.n)
    found = np.full(len(rows), Kind.REGULAR, dtype=object)
    sigma = np.linalg.svd(array.unit_jacobian(rows), compute_uv=False)
    for k in np.flatnonzero(np.sum(sigma > tolerance, axis=1) < array.m):
        found[k] = kind(array, rows[k], tolerance)
    return found.reshape(angles.shape[:-1])


def nearest(array: CmgArray, delta: Any) -> Nearest:
    """Return the singular configuration nearest to gimbal angles (..., n) [rad].

    Arrays with parallel gimbal axes have it in closed form: `nullmotion.singular_lines`.
    A CMG whose gimbal axis is along u is singular at any angle and stays where it is, as does
    one without momentum.

    Raises:
        InputError: For angles of another number of CMGs, or angles that are not finite.
    """
    angles = checked_angles(array, delta)
    table, batch = angles.reshape(-1, array.n), angles.shape[:-1]
    distance, u = _search(array, table)
    offset = _offsets(*_frames(array, table), u[:, None])[0][:, 0]
    found = distance.reshape(batch) if batch else float(distance[0])
    return Nearest(found, angles - offset.reshape(angles.shape), u.reshape(*batch, array.m))


def checked_angles(array: CmgArray, delta: Any, single: bool = False) -> np.ndarray:
    """Return gimbal angles (..., n) as floats; with ``single`` they have no leading axes.

    Raises:
        InputError: For another number of CMGs, and angles that are not finite.
    """
    angles = np.asarray(delta, float)
    if angles.ndim == 0 or angles.shape[-1] != array.n or (single and angles.ndim > 1):
        raise InputError("delta", angles.tolist(), f"{array.n} gimbal angles (rad)")
    if not np.isfinite(angles).all():
        raise InputError("delta", angles.tolist(), "finite gimbal angles (rad)")
    return angles


def _frames(array: CmgArray, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each CMG's spin and torque direction in the torque space, (B, n, m) each."""
    assert array.torque_axes is not None
    working = (np.asarray(array.h0) > 0)[:, None]
    spin = np.where(working, array.spin_axes @ array.torque_axes.T, 0.0)
    torque = np.where(working, array.transverse_axes @ array.torque_axes.T, 0.0)
    c, s = np.cos(delta)[..., None], np.sin(delta)[..., None]
    return c * spin + s * torque, c * torque - s * spin


def _offsets(
    spin: np.ndarray, torque: np.ndarray, u: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return delta - delta_s in (-pi/2, pi/2] for directions u, and its polar coordinates.

    Args:
        spin: Unit momenta h_i / h0_i, (B, n, m).
        torque: Unit columns a_i / h0_i, (B, n, m).
        u: Directions, (B, k, m).

    Returns:
        -atan(a_i.u / h_i.u), h_i.u and a_i.u, each (B, k, n); zero for a free CMG.
    """
    q, p = u @ spin.mT, u @ torque.mT
    free = p * p + q * q < _FREE * np.sum(u * u, axis=-1, keepdims=True)
    q, p = np.where(free, 1.0, q), np.where(free, 0.0, p)
    return -np.arctan2(np.where(q < 0, -p, p), np.abs(q)), q, p


def _cost(spin: np.ndarray, torque: np.ndarray, u: np.ndarray) -> np.ndarray:
    return np.sum(_offsets(spin, torque, u)[0] ** 2, axis=-1)


def _search(array: CmgArray, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the least distance and its direction for angles (B, n)."""
    if len(delta) > _CHUNK:
        parts = [_search(array, part) for part in np.array_split(delta, -(-len(delta) // _CHUNK))]
        return np.concatenate([d for d, _ in parts]), np.concatenate([u for _, u in parts])
    spin, torque = _frames(array, delta)
    polished = _polished(spin, torque, _starts(spin, torque))
    u = np.concatenate([polished, _axes(array, len(delta))], axis=1)
    cost = _cost(spin, torque, u)
    best = np.argmin(cost, axis=1)
    rows = np.arange(len(delta))
    return np.sqrt(cost[rows, best]), u[rows, best]


def _axes(array: CmgArray, count: int) -> np.ndarray:
    """Return the gimbal axes in the torque space: there CMGs come free, at isolated points."""
    assert array.torque_axes is not None
    axes = array.gimbal_axes @ array.torque_axes.T
    axes = axes[np.linalg.norm(axes, axis=1) > 1 - 1e-12]
    return np.broadcast_to(axes, (count, *axes.shape))


def _starts(spin: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Return the least local minima on the grid of directions, (B, k, m)."""
    grid, neighbours = _grid(spin.shape[-1])
    cost = _cost(spin, torque, grid[None])
    least = cost <= np.min(cost[:, neighbours], axis=-1)
    kept = min(_STARTS, len(grid))
    chosen = np.argpartition(np.where(least, cost, np.inf), kept - 1, axis=1)[:, :kept]
    return grid[chosen]


@lru_cache(maxsize=3)
def _grid(m: int) -> tuple[np.ndarray, np.ndarray]:
    """Return directions spread evenly (u and -u are one), and each one's eight neighbours."""
    count = _GRID[m]
    k = np.arange(count)
    if m == 1:
        return np.ones((1, 1)), np.zeros((1, 1), int)
    if m == 2:
        angle = np.pi * k / count
        return np.stack([np.cos(angle), np.sin(angle)], axis=1), (k[:, None] + [-1, 1]) % count
    z = (k + 0.5) / count
    azimuth = np.pi * (3 - np.sqrt(5.0)) * k  # Fibonacci's spiral
    radius = np.sqrt(1 - z * z)
    grid = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=1)
    near = np.argpartition(-np.abs(grid @ grid.T), 9, axis=1)[:, :9]
    return grid, near


def _polished(spin: np.ndarray, torque: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return directions (B, k, m) moved to local minima by damped Newton steps."""
    if u.shape[-1] == 1:
        return u
    damping = np.full(u.shape[:2], 1e-3)
    cost = _cost(spin, torque, u)
    for _ in range(_STEPS):
        step = _newton_step(spin, torque, u, damping)
        trial = u + step
        trial = trial / np.linalg.norm(trial, axis=-1, keepdims=True)
        trial_cost = _cost(spin, torque, trial)
        better = trial_cost < cost
        u, cost = np.where(better[..., None], trial, u), np.where(better, trial_cost, cost)
        damping = np.where(better, damping * 0.1, damping * 8.0)
        if np.abs(step).max(initial=0.0) < _SETTLED:
            break
    return u


def _newton_step(
    spin: np.ndarray, torque: np.ndarray, u: np.ndarray, damping: np.ndarray
) -> np.ndarray:
    """Return the step in the tangent plane of u that a positive definite model asks for.

    With d_i the polar angle of (q, p) = (h_i.u, a_i.u) and rho its radius, F = sum d_i^2 has
    grad = 2 sum d_i w_i,  w_i = (q a_i - p h_i)/rho^2, and hess = 2 sum w_i w_i^T + d_i D_i.
    """
    offset, q, p = _offsets(spin, torque, u)
    d = -offset
    basis = tangents(u)  # (B, k, m, m - 1)
    a, h = torque[:, None] @ basis, spin[:, None] @ basis  # (B, k, n, m - 1)
    rho2 = (p * p + q * q)[..., None]
    along = (q[..., None] * a - p[..., None] * h) / rho2
    across = (p[..., None] * a + q[..., None] * h) / rho2
    gradient = np.sum(d[..., None] * along, axis=-2)
    curvature = d[..., None, None] * (along[..., :, None] * across[..., None, :])
    hessian = along.mT @ along - np.sum(curvature + curvature.mT, axis=-3)
    scale = np.trace(along.mT @ along, axis1=-2, axis2=-1) + 1e-12
    least = np.linalg.eigvalsh(hessian)[..., 0]
    shift = np.maximum(0.0, -1.5 * least) + damping * scale
    matrix = hessian + shift[..., None, None] * np.eye(basis.shape[-1])
    move = np.linalg.solve(matrix, -gradient[..., None])
    return (basis @ move)[..., 0]


def tangents(u: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of the plane normal to u as columns, (..., m, m - 1)."""
    if u.shape[-1] == 1:
        return np.zeros((*u.shape, 0))
    if u.shape[-1] == 2:
        return np.stack([-u[..., 1], u[..., 0]], axis=-1)[..., None]
    least = np.eye(3)[np.argmin(np.abs(u), axis=-1)]
    e1 = np.cross(u, least)
    e1 = e1 / np.linalg.norm(e1, axis=-1, keepdims=True)
    return np.stack([e1, np.cross(u, e1)], axis=-1)
