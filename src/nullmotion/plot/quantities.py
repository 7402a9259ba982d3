"""What pictures derive from a trajectory: directions, names, limits."""

from __future__ import annotations

import numpy as np

from nullmotion.plot.view import Run

STUCK_FRACTION = 0.02  # of the command; an escaping law gives at least some of it
_BODY_AXES = np.eye(3)


def axis_names(run: Run) -> list[str]:
    """Return a name for each of the m torque axes: x, y, z where they are body axes."""
    basis = getattr(run.setup.array, "torque_axes", None)
    if basis is None or len(basis) != run.hdot.shape[1]:
        return [f"axis {i + 1}" for i in range(run.hdot.shape[1])]
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
    along = np.sum(run.torque * unit, axis=1)
    across = np.linalg.norm(run.torque - along[:, None] * unit, axis=1)
    scale = np.where(size > 0, size, np.nan)
    return along / scale, across / scale


def stuck_since(run: Run) -> float | None:
    """Return the time [s] from which a run gives no torque until its end though asked; or None.

    Less than 2 % of the command along its direction, for at least a tenth of the run.
    """
    along, _ = torque_fractions(run)
    known = np.flatnonzero(np.isfinite(along))
    if len(known) < 10:
        return None
    giving = known[np.abs(along[known]) >= STUCK_FRACTION]
    first = known[0] if not len(giving) else giving[-1] + 1
    if first > known[-1] or run.t[known[-1]] - run.t[first] < 0.1 * (run.t[-1] - run.t[0]):
        return None
    return float(run.t[first])


def rate_limits(run: Run) -> list[float]:
    """Return the different finite rate limits of the gimbals [rad/s], ascending."""
    limits = np.atleast_1d(np.asarray(run.setup.array.rate_limit, float))
    return sorted({float(v) for v in limits if np.isfinite(v)})


def stop_level(run: Run, metric: str) -> float | None:
    """Return the threshold at which the run's stop rules watch a metric, or None."""
    for rule in run.setup.stop:
        if rule.metric.name == metric:
            return float(rule.threshold)
    return None
