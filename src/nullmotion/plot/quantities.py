"""What pictures derive from a trajectory: directions, names, limits."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.plot.view import Run

STUCK_FRACTION = 0.02  # of the command; an escaping law gives at least some of it
STUCK_SHARE = 0.1  # of the whole command: shorter pauses at the end are not called stuck
USED_UP = 0.2  # momentum state (Mao 2019, Sec. VI: epsilon)
SINGULAR = 0.1  # sigma_min below: somewhere a CMG gives less than a tenth of its torque
_BODY_AXES = np.eye(3)


def axis_names(run: Run) -> list[str]:
    """Return a name for each of the m torque axes: x, y, z where they are body axes."""
    basis = getattr(run.setup.array, "torque_axes", None)
    if basis is None or len(basis) != run.hdot.shape[1]:
        return [f"axis {i + 1}" for i in range(run.hdot.shape[1])]
    return basis_names(basis)


def basis_names(basis: Any) -> list[str]:
    """Return a name for each row of torque axes: x, y, z where they are body axes."""
    return [_axis_name(np.asarray(row, float), i) for i, row in enumerate(basis)]


def _axis_name(row: np.ndarray, index: int) -> str:
    for name, axis in zip("xyz", _BODY_AXES, strict=True):
        if np.allclose(row, axis, atol=1e-9):
            return name
    return f"axis {index + 1}"


def cmg_names(run: Run) -> list[str]:
    """Return a name for each CMG, counted from 1."""
    return [f"CMG {i + 1}" for i in range(run.delta.shape[1])]


def directions(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Return |hdot| (k,) and its unit vector (k, m); no number where nothing is asked."""
    size = np.linalg.norm(run.hdot, axis=1)
    asked = size > 1e-12 * max(float(np.nanmax(size, initial=0.0)), 1e-300)
    return size, run.hdot / np.where(asked, size, np.nan)[:, None]


def steady_direction(run: Run) -> np.ndarray | None:
    """Return the command's direction if it never turns, else None."""
    _, unit = directions(run)
    asked = unit[np.isfinite(unit).all(axis=1)]
    if len(asked) and np.allclose(asked, asked[0], atol=1e-6):
        return np.asarray(asked[0], float)
    return None


def torque_fractions(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Return the torque along the command and across it, as fractions of the command, (k,)."""
    size, unit = directions(run)
    torque = np.where(np.isfinite(run.torque), run.torque, np.nan)
    along = np.sum(torque * unit, axis=1)
    across = np.linalg.norm(torque - along[:, None] * unit, axis=1)
    scale = np.where(size > 0, size, np.nan)
    return along / scale, across / scale


def stuck_since(run: Run) -> float | None:
    """Return the time [s] from which a run gains no momentum until its end though asked; or None.

    Stuck is a run that, over at least the last tenth of what was asked of it, gains less
    than 2 % of it. Momentum tells, not torque: a law that chatters gives torque to and fro.
    """
    _, unit = directions(run)
    span = np.diff(run.t)
    asked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(run.hdot[:-1], axis=1) * span)])
    steps = np.sum(np.diff(run.momentum, axis=0) * np.nan_to_num(unit[:-1]), axis=1)
    gained = np.concatenate([[0.0], np.cumsum(steps)])
    away = np.abs(gained - gained[-1]) > STUCK_FRACTION * STUCK_SHARE * asked[-1]
    first = int(np.flatnonzero(away)[-1]) + 1 if away.any() else 0
    return float(run.t[first]) if asked[-1] - asked[first] > STUCK_SHARE * asked[-1] else None


def saturated(run: Run) -> bool:
    """Return whether the momentum along the command is used up at the end."""
    state = run.metrics.get("final_momentum_state")
    if state is None and "momentum_state" in run.measures:
        state = run.measures["momentum_state"][-1]
    return state is not None and bool(state < USED_UP)


def finite(limits: Any) -> list[float]:
    """Return the different finite values of a limit, ascending."""
    return sorted({float(v) for v in np.ravel(np.asarray(limits, float)) if np.isfinite(v)})


def rate_limits(run: Run) -> list[float]:
    """Return the different finite rate limits of the gimbals [rad/s], ascending."""
    return finite(run.setup.array.rate_limit)


def motor_limits(run: Run) -> list[float]:
    """Return the different finite torque limits of the gimbal motors [N m], ascending."""
    servo, units = getattr(run.setup, "servo", None), getattr(run.setup, "units", None)
    if units is not None and units.drive == "torque":
        return finite(units.gimbal_torque_limit)
    return [] if servo is None else finite(servo.torque_limit)


def turns_wheels(run: Run | None) -> bool:
    """Return whether a run's wheel speeds change."""
    return getattr(run, "wheel_speed", None) is not None


def wheel_tolerance(run: Run) -> float | None:
    """Return the relative error that counts as a wheel at its speed; None if not measured."""
    for metric in getattr(run.setup, "metrics", ()):
        if metric.name == "wheel_settling_s":
            return float(metric.tolerance)
    return None


def of_attitude(run: Run | None) -> bool:
    """Return whether a run turned a spacecraft."""
    return getattr(run, "q_BN", None) is not None


def tolerance_deg(run: Run) -> float | None:
    """Return the pointing error that counts as settled [deg]; None where that is not measured."""
    for metric in getattr(run.setup, "metrics", ()):
        if metric.name == "settling_time_s":
            return float(np.degrees(metric.tolerance))
    return None


def final_error_deg(run: Run) -> float:
    """Return the pointing error at the end [deg]."""
    last = run.metrics.get("final_pointing_error_deg")
    return float(np.degrees(run.pointing_error[-1]) if last is None else last)


def sigma_min(run: Run) -> np.ndarray | None:
    """Return sigma_min of the CMGs that turn, (k,); None if it is not known."""
    return run.measures.get("sigma_min")


def stop_level(run: Run, metric: str) -> float | None:
    """Return the threshold at which the run's stop rules watch a metric, or None."""
    for rule in run.setup.stop:
        if rule.metric.name == metric:
            return float(rule.threshold)
    return None
