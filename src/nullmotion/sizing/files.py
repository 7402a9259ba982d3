"""A scenario that flies a sized array along its worst slew, for `nullmotion run`."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from nullmotion.scenario import toml
from nullmotion.sizing.cases import NONE_FAILED, Cases
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.trial import Trial

_HEADER = "t_s,q0,q1,q2,q3,wx,wy,wz,ax,ay,az"


def scenario_files(trial: Trial, h0: float, rate: float, slew: Cases) -> dict[str, str]:
    """Return the text of a scenario and of its profile, by file name.

    Args:
        trial: Layout, angle, law, coast.
        h0: Momentum of each CMG with margins [N m s].
        rate: Largest gimbal rate [rad/s].
        slew: One slew.
    """
    r, g = trial.requirement, trial.geometry
    name, failed = g.layout, int(slew.failed[0])
    size, limit = r.held_back(h0, rate)
    delta, _ = g.starts(slew, np.array([size]))
    array: dict[str, Any] = {"layout": g.layout, "h0_Nms": float(size)}
    array["rate_limit_deg_s"] = float(np.degrees(limit))
    if g.skew is not None:
        array["skew_deg"] = float(np.degrees(g.skew))
    if failed != NONE_FAILED:
        array["failed_cmgs"] = [failed]
    data: dict[str, Any] = {
        "scenario": {"title": f"{r.title}: {name}", "description": _about(r, slew)},
        "array": array,
        "initial": {"gimbal_deg": np.degrees(delta[0]).tolist()},
        "spacecraft": {"inertia_kg_m2": r.inertia.tolist()},
        "controller": {
            "name": "tracking",
            "natural_frequency_rad_s": r.natural_frequency,
            "damping": r.controller.damping,
        },
        "law": {"name": trial.law, "period_s": r.period},
    }
    if r.disturbance.torque_Nm is not None:
        data["disturbance"] = {"constant_Nm": list(r.disturbance.torque_Nm)}
    steps = int(np.ceil(r.time / r.period * (1.0 - 1e-9)))
    data["mission"] = {
        "kind": "attitude",
        "profile": f"{name}.csv",
        "settle_tolerance_deg": r.settling.pointing_error_deg,
    }
    data["simulation"] = {"dt_s": r.period, "duration_s": round(steps * r.period, 9)}
    data["requirements"] = {
        "settling_time_s_below": r.time,
        "final_pointing_error_deg_below": r.settling.pointing_error_deg,
        "final_body_rate_deg_s_below": r.settling.body_rate_deg_s,
    }
    text = f"# {_comment(r)}\n\n{toml.document_text(data)}"
    return {f"{name}.toml": text, f"{name}.csv": _profile(trial, slew.axis[0], steps)}


def _about(r: Requirement, slew: Cases) -> str:
    axis = ", ".join(f"{v:.4f}" for v in slew.axis[0])
    lost = "" if slew.failed[0] == NONE_FAILED else f", without CMG {int(slew.failed[0]) + 1}"
    return f"{r.slew.angle_deg:g} deg about ({axis}){lost}: the slew that binds."


def _comment(r: Requirement) -> str:
    if not (r.margin.momentum or r.margin.torque):
        return "Written by nullmotion size."
    return (
        f"Written by nullmotion size: margins of {100 * r.margin.momentum:g} % of momentum and "
        f"{100 * r.margin.torque:g} % of torque are held back."
    )


def _profile(trial: Trial, axis: np.ndarray, steps: int) -> str:
    """Return the reference attitude at every sample of the law as CSV."""
    times = np.arange(steps + 1) * trial.requirement.period
    rows = np.column_stack([times, trial.profile.reference(times, axis)])
    out = io.StringIO()
    np.savetxt(out, rows, fmt="%.17g", delimiter=",", header=_HEADER, comments="")
    return out.getvalue()
