"""What a summary says of wheels whose speed changes: where they end, what was limited and when."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

_AT_LIMIT = 1e-3  # share below a limit from which it counts as reached: motors follow so closely
_SETTLING = ("momentum_settling_s", "wheel_settling_s")


def wheels(run: Any) -> dict[str, Any]:
    """Return final speeds and settling times; None for what was not measured.

    Args:
        run: A `nullmotion.sim.Trajectory` with variable wheel speeds.
    """
    times = {key: run.metrics.get(key) for key in _SETTLING}
    found = {"final_speed_rad_s": run.wheel_speed[-1].tolist()}
    return found | {k: None if v is None else float(v) for k, v in times.items()}


def limits(run: Any) -> dict[str, dict[str, float]]:
    """Return what was limited and when, by limit; empty if nothing ever was.

    ``gimbal_rate``: a gimbal was asked for its rate limit or more. ``gimbal_torque``,
    ``wheel_torque``, ``wheel_power``: a motor gave all it could. ``wheel_speed``: a wheel
    turned as fast as it may. ``torque``: some of the torque that was asked for was cut.

    Returns:
        First and last time [s], share of the run's time, and the CMGs, counted from 0.
    """
    return {name: _said(run, rows) for name, rows in reached(run) if rows.any()}


def reached(run: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Yield limits by name with where they were reached, (steps, n); (steps, 1) for ``torque``."""
    array, units = run.setup.true_array, run.setup.units
    wheel, acting = array.flywheels, slice(0, len(run.t) - 1)
    speed = np.abs(run.wheel_speed[acting])
    taken = np.abs(wheel.inertia * run.wheel_acceleration[acting])
    torque = np.maximum(taken, np.abs(run.wheel_motor_torque[acting]))
    asked = np.maximum(np.abs(run.rates_asked[acting]), np.abs(run.rates[acting]))
    yield "gimbal_rate", _at(asked, array.rate_limit)
    if units is not None and units.drive == "torque":
        yield "gimbal_torque", _at(np.abs(run.motor_torque[acting]), units.gimbal_torque_limit)
    yield "wheel_torque", _at(torque, wheel.torque_limit)
    yield "wheel_power", _at(torque * speed, wheel.power_limit)
    yield "wheel_speed", _at(speed, wheel.speed_limit)
    yield "torque", run.limited[acting, None] > 0


def spans(t: np.ndarray, rows: np.ndarray) -> list[tuple[float, float]]:
    """Return from when to when marks are set [s].

    Args:
        t: Times of the rows and of the end, (k + 1,).
        rows: Marks of the steps between them, (k,).
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], rows.astype(int), [0]])))
    return [(float(t[a]), float(t[b])) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _at(size: np.ndarray, limit: Any) -> np.ndarray:
    """Return where a size has come to a limit; a limit of 0 holds what cannot act anyway."""
    bound = np.broadcast_to(np.asarray(limit, float), size.shape)
    found: np.ndarray = (size >= bound * (1 - _AT_LIMIT)) & (bound > 0)
    return found


def _said(run: Any, rows: np.ndarray) -> dict[str, Any]:
    when = np.flatnonzero(rows.any(axis=1))
    spent = float(np.diff(run.t)[when].sum())
    found = {
        "first_s": float(run.t[when[0]]),
        "last_s": float(run.t[when[-1]]),
        "share": spent / float(run.t[-1]),
    }
    if rows.shape[1] == 1:
        return found
    return found | {"cmgs": np.flatnonzero(rows.any(axis=0)).tolist()}
