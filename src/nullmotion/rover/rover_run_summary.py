"""A step in numbers, for files and screens; units are in the keys."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from nullmotion.rover.files import StepFile
from nullmotion.rover.initialise import Initialisation
from nullmotion.rover.landing_result import Landing
from nullmotion.rover.rover_run import WheelPlan
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.versine import Verdict
from nullmotion.scenario import dataset


def of_file(file: StepFile) -> dict[str, Any]:
    """Return what was asked for."""
    return {
        "title": file.title,
        "rover": file.rover.name,
        "edge": file.edge,
        "face": file.rover.chassis.edge_frame(file.edge, file.face).start_face,
        "gravity_m_s2": file.site.gravity,
        "incline_deg": round(float(np.degrees(file.site.incline)), 12),
        "heading_deg": round(float(np.degrees(file.site.heading)), 12),
    }


def of_plan(plan: StepPlan, verdict: Verdict | None) -> dict[str, Any]:
    """Return a plan without its histories."""
    return {
        "motion": "planned" if verdict is None else "versine",
        "duration_s": plan.duration,
        "least_margin_Nm": plan.least_margin,
        "energy_J": plan.energy,
        "cost_of_travel_J_kg_m": plan.cost_of_travel,
        "branch": plan.branch,
        "start_gimbal_deg": float(np.degrees(plan.delta[0])),
        "max_gimbal_rate_rad_s": _greatest(plan.delta_dot),
        "max_body_rate_rad_s": _greatest(plan.theta_dot),
        "seconds": plan.seconds,
        **({} if verdict is None else of_verdict(verdict)),
    }


def of_verdict(verdict: Verdict) -> dict[str, Any]:
    """Return how a versine comes out."""
    return {
        "outcome": verdict.outcome,
        "reason": verdict.reason,
        "outcome_at_s": verdict.time,
        "outcome_at_deg": float(np.degrees(verdict.angle)),
    }


def of_wheels(plan: WheelPlan) -> dict[str, Any]:
    """Return what a step takes with wheels."""
    quick, slow = plan.impulsive, plan.versine
    return {
        "impulsive": {
            "outcome": quick.outcome,
            "energy_J": quick.energy,
            "cost_of_travel_J_kg_m": quick.cost_of_travel,
            "wheel_speed_rad_s": quick.wheel_speed,
            "lift_J": quick.lift,
        },
        "versine": {
            **of_verdict(slow.verdict),
            "duration_s": float(slow.step.t[-1]),
            "energy_J": slow.energy,
            "cost_of_travel_J_kg_m": slow.cost_of_travel,
            "wheel_speed_rad_s": _greatest(slow.speed) * float(np.abs(plan.frame.r).max()),
        },
    }


def of_initialisation(way: Initialisation) -> dict[str, Any]:
    """Return the gimbal's way to the start of a step."""
    return {
        "from_deg": float(np.degrees(way.delta[0])),
        "to_deg": float(np.degrees(way.delta[-1])),
        "duration_s": way.duration,
        "static_threshold_Nm": way.threshold,
        "least_spare_Nm": float(way.spare.min()),
        "max_gimbal_rate_rad_s": _greatest(way.delta_dot),
    }


def of_run(run: StepRun) -> dict[str, Any]:
    """Return a step in closed loop."""
    return {
        "outcome": run.outcome,
        "duration_s": float(run.t[-1]),
        "max_angle_error_rad": run.max_angle_error,
        "least_margin_Nm": run.least_margin,
        "least_static_margin_Nm": run.least_static_margin,
        "energy_J": run.energy,
        "cost_of_travel_J_kg_m": run.cost_of_travel,
        "work_J": run.work,
        "energy_change_J": run.energy_change,
        "energy_balance": run.energy_balance,
        "lift_off_s": run.lift_off,
    }


def of_landing(landing: Landing) -> dict[str, Any]:
    """Return a step on the ground."""
    return {
        "outcome": landing.outcome,
        "as_planned": landing.as_planned,
        "ground": landing.ground.name,
        "landed_at_s": landing.landed_at,
        "slip_mm": 1e3 * landing.slip,
        "tilt_deg": float(np.degrees(landing.tilt)),
        "max_angle_error_rad": landing.max_angle_error,
        "energy_J": landing.energy,
        "cost_of_travel_J_kg_m": landing.cost_of_travel,
        "work_J": landing.work,
        "dissipated_J": landing.dissipated,
        "energy_change_J": landing.energy_change,
        "energy_balance": landing.energy_balance,
        "events": [
            {"t_s": e.t, "kind": e.kind, "spike": e.spike, "size": e.size, "unit": e.unit}
            for e in landing.events
        ],
    }


def versions() -> dict[str, str]:
    """Return the versions of what computes."""
    try:
        return {**dataset.versions(), "casadi": version("casadi")}
    except PackageNotFoundError:
        return dataset.versions()


def _greatest(values: np.ndarray) -> float:
    return float(np.abs(values).max())
