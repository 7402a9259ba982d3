"""Tables of a reference attitude: a row q_RN, omega_RN_R, alpha_RN_R for each time.

q_RN is scalar first and turns N into R, its rate and acceleration have components in R:
q_dot = 1/2 q * [0, omega]. A row has 4 + 3 + 3 numbers, in rad and s.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.spacecraft.body import checked_quaternion


def eigenaxis_slew(q_start: Any, q_end: Any, slew_time: float, times: Any) -> np.ndarray:
    """Return a rotation from rest to rest about one axis, the shorter way, (len(times), 10).

        q(t) = q_start * [cos(s theta / 2), n sin(s theta / 2)]
        omega = s_dot theta n,    alpha = s_ddot theta n,    s = 10 x^3 - 15 x^4 + 6 x^5

    with x = t / slew_time. Rate and acceleration begin and end at zero and reach 1.875
    theta / slew_time and 5.774 theta / slew_time^2. Before and after it stands still.

    Args:
        q_start: Attitude at t = 0.
        q_end: Attitude from t = slew_time on.
        slew_time: [s].
        times: Time of each row [s].

    Raises:
        InputError: For a zero quaternion or a time that is not above 0.
    """
    start, end = checked_quaternion("q_start", q_start), checked_quaternion("q_end", q_end)
    if not (np.isfinite(slew_time) and slew_time > 0):
        raise InputError("slew_time", slew_time, "a finite time above 0 s")
    turn = rotation.shortest(rotation.multiply(rotation.conjugate(start), end))
    sine = float(np.linalg.norm(turn[1:]))
    angle = 2.0 * np.arctan2(sine, turn[0])
    axis = turn[1:] / sine if sine > 0 else np.zeros(3)
    x = np.clip(np.asarray(times, float) / slew_time, 0.0, 1.0)[:, None]
    half = 0.5 * angle * x**3 * (10.0 + x * (6.0 * x - 15.0))
    rate = 30.0 * (x * (1.0 - x)) ** 2 * (angle / slew_time)
    acceleration = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) * (angle / slew_time**2)
    turned = np.concatenate([np.cos(half), np.sin(half) * axis], axis=1)
    q = rotation.multiply(start, turned.T).T
    return np.concatenate([q, rate * axis, acceleration * axis], axis=1)


def held(t: Any, q: Any, times: Any) -> np.ndarray:
    """Return a reference that stands still at each row of a table until the next, (len(times), 10).

    Args:
        t: Time of each row [s], increasing, (k,); the first holds before it, too.
        q: q_RN, scalar first, (k, 4).
        times: Time of each row wanted [s].

    Raises:
        InputError: For a zero quaternion.
    """
    unit = np.array([checked_quaternion("profile", row) for row in q])
    late = np.asarray(times, float) * (1 + 1e-12) + 1e-9  # a sample at a row's time has that row
    row = np.maximum(np.searchsorted(np.asarray(t, float), late, side="right") - 1, 0)
    return np.concatenate([unit[row], np.zeros((len(row), 6))], axis=1)


def from_csv_table(t: Any, q: Any, omega: Any, alpha: Any, times: Any) -> np.ndarray:
    """Return a given history of the attitude at other times, (len(times), 10).

    The attitude is the smooth curve through the rows whose rate and acceleration are
    continuous (SciPy's RotationSpline; two rows: a constant rate). Where the table has no
    rates or accelerations, they are the curve's own; where it has, they are linear between
    its rows. Before the first and after the last row it stands still there.

    Args:
        t: Time of each row of the table [s], increasing, (k,).
        q: q_RN, scalar first, of any length and sign, (k, 4).
        omega: omega_RN_R [rad/s], (k, 3), or None.
        alpha: alpha_RN_R [rad/s^2], (k, 3), or None.
        times: Time of each row wanted [s].

    Raises:
        InputError: With the key ``profile`` for a table that cannot be.
    """
    t = _column("t", t, ())
    q = _column("q_RN", q, (4,), len(t))
    given = [
        None if v is None else _column(f"{k}_RN_R", v, (3,), len(t))
        for k, v in (("omega", omega), ("alpha", alpha))
    ]
    late = np.flatnonzero(np.diff(t) <= 0)
    if len(late):
        raise InputError("profile", t[late[0] : late[0] + 2].tolist(), "times that increase")
    lengths = np.linalg.norm(q, axis=1, keepdims=True)
    if np.any(lengths < 1e-6):
        i = int(np.argmin(lengths))
        raise InputError("profile", q[i].tolist(), f"quaternions that are not zero (row {i + 1})")
    q = _same_sign(q / lengths)
    times = np.asarray(times, float)
    inside = (times >= t[0]) & (times <= t[-1]) & (len(t) > 1)
    rows = np.zeros((len(times), 10))
    rows[:, :4] = np.where(times[:, None] < t[0], q[0], q[-1])
    if inside.any():
        rows[inside] = _between(t, q, given, times[inside])
    return rows


def _between(t: np.ndarray, q: np.ndarray, given: list[Any], times: np.ndarray) -> np.ndarray:
    """Return rows within a table of at least two rows."""
    curve = _curve(t, q)
    attitude = np.roll(curve(times).as_quat(), 1, axis=1)
    before = q[np.searchsorted(t, times, side="right") - 1]
    attitude *= np.where(np.sum(attitude * before, axis=1, keepdims=True) < 0, -1.0, 1.0)
    columns = [attitude]
    for order, table in enumerate(given, 1):
        if table is None:
            columns.append(curve(times, order))
        else:
            columns.append(np.stack([np.interp(times, t, c) for c in table.T], axis=1))
    return np.concatenate(columns, axis=1)


def _curve(t: np.ndarray, q: np.ndarray) -> Any:
    """Return SciPy's spline; its rates have components in R, as the same q turns R into N there."""
    from scipy.spatial.transform import Rotation, RotationSpline

    with np.errstate(all="ignore"):
        spline = RotationSpline(t, Rotation.from_quat(np.roll(q, -1, axis=1)))
        steps = np.diff(t)
        early, late = t[1:-1] - 1e-6 * steps[:-1], t[1:-1] + 1e-6 * steps[1:]
        jumps = np.abs(spline(early, 2) - spline(late, 2)) if len(early) else np.zeros(1)
        allowed = 1e-3 * np.abs(spline(t, 2)).max() + 1e-6 / steps.min()
    if not np.all(jumps <= allowed):  # its iteration for the rates has not converged
        i = int(np.argmax(np.max(jumps, axis=1))) + 1
        wanted = f"rows close enough for a smooth curve through them (near row {i + 1})"
        raise InputError("profile", t[i - 1 : i + 2].tolist(), wanted)
    return spline


def _same_sign(q: np.ndarray) -> np.ndarray:
    """Return rows q or -q so that none turns away from the one before it."""
    turned = np.where(np.sum(q[1:] * q[:-1], axis=1) < 0, -1.0, 1.0)
    return q * np.concatenate([[1.0], np.cumprod(turned)])[:, None]


def _column(name: str, value: Any, shape: tuple[int, ...], rows: int | None = None) -> np.ndarray:
    """Return a part of a table as finite numbers of a shape."""
    part = np.asarray(value, float)
    if part.shape != (len(np.atleast_1d(part)) if rows is None else rows, *shape) or not part.size:
        wanted = " x ".join(map(str, ("k" if rows is None else rows, *shape)))
        raise InputError("profile", list(part.shape), f"{name} of {wanted} numbers")
    if not np.isfinite(part).all():
        i = int(np.flatnonzero(~np.isfinite(part.reshape(len(part), -1)).all(axis=1))[0])
        raise InputError("profile", part[i].tolist(), f"finite numbers ({name}, row {i + 1})")
    return part
