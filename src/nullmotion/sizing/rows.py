"""A row of the result from a design."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.sizing.cases import NONE_FAILED
from nullmotion.sizing.choose import Choice
from nullmotion.sizing.curve import Curve
from nullmotion.sizing.demand import demand
from nullmotion.sizing.design import Designed
from nullmotion.sizing.polish import FINE, REDUCTIONS, Polished
from nullmotion.sizing.result import Row

_BINDS = {"h0": "momentum", "gimbal_rate": "gimbal rate"}


def fill(row: Row, found: Designed) -> None:
    """Write a design into its row."""
    p, r = found.polished, found.curve.trial.requirement
    trial, (h0, rate) = p.trial, p.design
    row.law, row.coast_fraction, row.skew_deg = trial.law, trial.coast, degrees(trial.geometry.skew)
    row.h0_Nms, row.gimbal_rate_deg_s = h0, round(float(np.degrees(rate)), 9)
    row.torque_Nm = h0 * rate
    row.flown, row.smaller_by_5_percent = p.flown, p.smaller
    row.binds = [name for key, name in _BINDS.items() if not p.smaller[key]]
    row.axes = len(np.unique(np.round(p.slews.joined(p.checked).axis, 9), axis=0))
    asked = demand(trial.profile, r.inertia, p.checked.axis, p.checked.bias, r.torque)
    row.peak_momentum_Nms = float(asked.momenta.max())
    row.peak_torque_Nm = float(asked.torques.max())
    row.worst = _worst(p)
    row.start, row.start_gimbal_deg = trial.geometry.start, _start(p)
    row.check = {"slews": len(p.slews) + len(p.checked), "steps_per_law_period": FINE}
    row.curve = {
        "gimbal_rate_deg_s": np.degrees(found.curve.rates).tolist(),
        "h0_Nms": found.curve.h0.tolist(),
    }


def tried(choice: Choice) -> list[dict[str, Any]]:
    """Return every candidate with its knee, the smallest first."""
    return [_described(curve) for curve in sorted(choice.tried, key=lambda curve: curve.best)]


def degrees(angle: float | None) -> float | None:
    """Return an angle in degrees, None for none."""
    return None if angle is None else round(float(np.degrees(angle)), 9)


def _worst(p: Polished) -> dict[str, Any]:
    assert p.worst is not None
    failed, (h0, rate) = int(p.worst.failed[0]), p.design
    factors = np.array([(1.0, 1.0), *REDUCTIONS.values()])
    late = p.trial.settled(p.worst, h0 * factors[:, 0], rate * factors[:, 1], FINE)[:, 0]
    return {
        "axis": p.worst.axis[0],
        "failed_cmg": None if failed == NONE_FAILED else failed,
        "momentum_Nms": p.worst.bias[0],
        "settling_time_s": float(late[0]),
        "smaller_settling_time_s": dict(zip(REDUCTIONS, late[1:].tolist(), strict=True)),
    }


def _start(p: Polished) -> list[float]:
    """Return the gimbal angles [deg] that the worst slew begins with."""
    assert p.worst is not None
    size, _ = p.trial.requirement.held_back(p.design.h0, p.design.rate)
    delta, _ = p.trial.geometry.starts(p.worst, np.array([size]))
    found: list[float] = np.degrees(delta[0]).tolist()
    return found


def _described(curve: Curve) -> dict[str, Any]:
    trial = curve.trial
    return {
        "law": trial.law,
        "coast_fraction": trial.coast,
        "start": trial.geometry.start,
        "skew_deg": degrees(trial.geometry.skew),
        "h0_Nms": curve.knee.h0,
        "gimbal_rate_deg_s": float(np.degrees(curve.knee.rate)),
    }
