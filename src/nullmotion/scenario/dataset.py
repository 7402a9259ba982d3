"""A trajectory as named variables with units and attributes, whatever file they go to."""

from __future__ import annotations

import dataclasses
import json
import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Any, NamedTuple

import numpy as np

from nullmotion.scenario.scenario import Scenario
from nullmotion.sim.trajectory import Trajectory

CONVENTIONS = (
    "SI units and radians; vectors in body frame B along torque_axes. CMG i (counted from 0) "
    "has gimbal axis g_i, spin axis s_i at delta_i = 0, t_i = g_i x s_i, momentum "
    "h_i = h0_i (s_i cos delta_i + t_i sin delta_i); A = dh/d(delta). hdot is the commanded rate "
    "of the array's momentum, torque the achieved A delta_dot; the vehicle gets "
    "-A delta_dot - omega x h. Rates act from their row's time to the next row's; the last row "
    "has none. Singularity measures are those of A over the mean momentum of the working CMGs."
)


class Variable(NamedTuple):
    """A named array."""

    name: str
    dims: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str


_CMG, _AXIS = ("time", "cmg"), ("time", "torque_axis")
_HISTORY = (
    ("delta", _CMG, "rad", "gimbal angle (true)"),
    ("rates", _CMG, "rad s-1", "gimbal rate applied"),
    ("rates_asked", _CMG, "rad s-1", "gimbal rate asked by the law, before the rate limit"),
    ("hdot", _AXIS, "N m", "commanded rate of momentum"),
    ("torque", _AXIS, "N m", "achieved rate of momentum A delta_dot"),
    ("momentum", _AXIS, "N m s", "momentum of the array"),
    ("momentum_wanted", _AXIS, "N m s", "start momentum and integral of the command"),
    ("impulse", _AXIS, "N m s", "integral of the achieved torque"),
    (
        "eram",
        _CMG,
        "1",
        "effective residual angular momentum over the mean momentum (Mao 2019, Eq 28)",
    ),
)
_MEASURES = {
    "sigma_min": "least singular value of A over the mean momentum",
    "sqrt_det_AAT": "manipulability sqrt(det(A A^T)) of A over the mean momentum",
    "condition_number": "ratio of the extreme singular values of A",
    "residual_momentum": "sum of the effective residual momenta over the mean momentum",
    "momentum_state": "singularity state estimation sse (Mao 2019)",
}


def variables(trajectory: Trajectory) -> list[Variable]:
    """Return everything that a run holds over time, and its geometry."""
    found = [Variable("time", ("time",), trajectory.t, "s", "time since the start")]
    for name, dims, units, text in _HISTORY:
        found.append(Variable(name, dims, np.asarray(getattr(trajectory, name)), units, text))
    for name, values in trajectory.measures.items():
        found.append(
            Variable(
                name,
                ("time",),
                np.asarray(values),
                "1",
                _MEASURES.get(name, name.replace("_", " ")),
            )
        )
    return [*found, *_geometry(trajectory)]


def _geometry(trajectory: Trajectory) -> list[Variable]:
    array, real = trajectory.setup.array, trajectory.setup.true_array
    axes, one = ("cmg", "body_axis"), ("cmg",)
    return [
        Variable(
            "torque_axes",
            ("torque_axis", "body_axis"),
            np.asarray(array.torque_axes),
            "1",
            "directions of torque in B",
        ),
        Variable(
            "gimbal_axes", axes, array.gimbal_axes, "1", "gimbal axes in B as the law knows them"
        ),
        Variable(
            "spin_axes",
            axes,
            array.spin_axes,
            "1",
            "spin axes in B at delta = 0 as the law knows them",
        ),
        Variable("h0", one, array.h0, "N m s", "spin momentum as the law knows it"),
        Variable("rate_limit", one, array.rate_limit, "rad s-1", "largest gimbal rate"),
        Variable("true_gimbal_axes", axes, real.gimbal_axes, "1", "gimbal axes in B as they are"),
        Variable(
            "true_spin_axes", axes, real.spin_axes, "1", "spin axes in B at delta = 0 as they are"
        ),
        Variable("true_h0", one, real.h0, "N m s", "spin momentum as it is"),
    ]


def attributes(
    trajectory: Trajectory, scenario: Scenario | None = None, law_file: str = ""
) -> dict[str, str]:
    """Return what tells how a run came about: text, all of it."""
    found = {
        "title": scenario.title
        if scenario
        else f"{trajectory.setup.law.name} on {trajectory.setup.array.label}",
        "source": f"nullmotion {versions()['nullmotion']}",
        "conventions": CONVENTIONS,
        "law": trajectory.setup.law.name,
        "stop_reason": trajectory.stop_reason,
        "status": ", ".join(trajectory.status) or "ok",
        "summary": json.dumps(plain(trajectory.summary())),
        "parameters": json.dumps(plain(resolved(trajectory, scenario))),
        "backend": trajectory.backend,
        "instruction_set": trajectory.instruction_set,
        **{f"{name}_version": text for name, text in versions().items()},
        "platform": platform.platform(),
    }
    if scenario is None:
        return found
    return found | {
        "scenario": scenario.source.effective_text(),
        "scenario_name": scenario.source.name,
        "scenario_files": json.dumps(scenario.named_files()),
        "seed": str(scenario.plant.seed if scenario.plant else 0),
        "law_file": law_file,
    }


def resolved(trajectory: Trajectory, scenario: Scenario | None) -> dict[str, Any]:
    """Return all parameters of a run, defaults put in."""
    setup = trajectory.setup
    found: dict[str, Any] = {"law": {"name": setup.law.name, **dataclasses.asdict(setup.law)}}
    if scenario is None:
        return found
    for name in ("array", "plant", "initial", "mission", "simulation", "stop"):
        section = getattr(scenario, name)
        found[name] = None if section is None else section.model_dump()
    found["array"] |= scenario.layout_parameters()
    found["law"] |= {"period_s": setup.period, "delay_s": scenario.law.delay_s}
    found["initial"] = {"gimbal_deg": np.degrees(setup.delta)}
    return found


def versions() -> dict[str, str]:
    """Return the versions of what computes."""
    import nullmotion

    found = {"nullmotion": nullmotion.__version__}
    for name in ("numpy", "llvmlite"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # pragma: no cover
            found[name] = "unknown"
    return found | {"python": sys.version.split()[0]}


def plain(value: Any) -> Any:
    """Return a value as JSON has it: lists and numbers, null for what is not finite."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else str(value)
