"""Table 1 of Papakonstantinou et al. 2021: every printed parameter beside the one used here."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.laws.sr import SingularityRobust
from nullmotion.papers.base import Cell, Value
from nullmotion.papers.papakonstantinou2021_cases import PRINTED_DT, Manoeuvre
from nullmotion.plan import skip

_NO_BODY = "printed, but the kinematic model has no body"
_G1 = (
    "300 gives a cost of 0.78 where 0.129 is printed; 50 gives 0.129. A gain in percent does not "
    "depend on g1"
)
_WEIGHTS = ("g1", "g2", "g3", "g4")
_TOLERANCE = 1e-9

# column: complex model, kinematics-only model; None where the table has no value
PRINTED: dict[str, tuple[Value, Value]] = {
    "maneuver_deg": ("0 to -90", "0 to -90"),
    "inertia_kg_m2": ("diag([1, 1, 1])", "diag([1, 1, 1])"),
    "h0_Nms": (1.0, 1.0),
    "time_step_s": (0.1, 0.1),
    "simulation_time_s": (7.0, 7.0),
    "Kp_Nm": (20.0, None),
    "Kw_Nms": (15.0, None),
    "h_c_Nms": (None, "[1.5, 0, 0]"),
    "skew_deg": (54.73, 54.73),
    "rate_threshold_deg_s": (50.0, 50.0),
    "initial_gimbal_deg": ("[-70, 0, 75, 0]", "[0, 0, 0, 0]"),
    "k_max": (0.7, 0.7),
    "lambda0": (1.0, 1.0),
    "mu": (0.2, 0.2),
    "w_th": (0.5, 0.5),
    "g1": (300.0, 300.0),
    "g2": (5.0, 50.0),
    "g3": (4.0, 4.0),
    "g4": (6.0, 6.0),
    "D": (10.0, 10.0),
    "skip_rate": ("[0, 250]", "[0, 250]"),
    "skip_th": (250.0, 250.0),
}
_NOTES = {("complex", "g1"): _G1} | {
    ("kinematic", column): _NO_BODY for column in ("maneuver_deg", "inertia_kg_m2")
}


def cells(roll: Manoeuvre, kinematic: Manoeuvre) -> list[Cell]:
    """Return Table 1."""
    found = []
    for i, (row, manoeuvre) in enumerate((("complex", roll), ("kinematic", kinematic))):
        used = parameters(manoeuvre)
        for column, printed in PRINTED.items():
            if printed[i] is None:
                continue
            exact = isinstance(printed[i], str)
            found.append(
                Cell(
                    "1",
                    row,
                    column,
                    printed[i],
                    used.get(column),
                    0.0 if exact else _TOLERANCE,
                    note=_NOTES.get((row, column), ""),
                )
            )
    return found


def parameters(manoeuvre: Manoeuvre) -> dict[str, Value]:
    """Return what a run on the paper's plant really uses, by column."""
    setup, section, law = manoeuvre.setup, manoeuvre.section, manoeuvre.setup.law
    assert isinstance(law, SingularityRobust)
    used: dict[str, Value] = {
        "h0_Nms": float(np.mean(setup.array.h0)),
        "time_step_s": setup.dt,
        "simulation_time_s": setup.steps * setup.dt,
        "skew_deg": float(manoeuvre.scenario.layout_parameters()["skew_deg"]),
        "rate_threshold_deg_s": float(np.degrees(np.min(setup.array.rate_limit))),
        "initial_gimbal_deg": words(np.degrees(setup.delta)),
        "k_max": manoeuvre.rollouts.k_max,
        "lambda0": law.lambda0,
        "mu": law.mu,
        "w_th": manoeuvre.cost.manipulability_threshold,
        "D": float(manoeuvre.rollouts.depth),
        "skip_rate": words((0, skip.MOST)),
        "skip_th": float(skip.MOST),
    }
    assert setup.dt == PRINTED_DT and section.weights is not None
    used |= zip(_WEIGHTS, manoeuvre.cost.weights, strict=True)
    return used | (_of_body(setup) if setup.spacecraft else _of_momentum(setup))


def _of_body(setup: Any) -> dict[str, Value]:
    turned = rotation.euler_321(setup.target)
    return {
        "maneuver_deg": f"0 to {np.degrees(turned[2]):.6g}",
        "inertia_kg_m2": f"diag({words(np.diag(setup.spacecraft.inertia))})",
        "Kp_Nm": float(np.mean(setup.controller.kp)),
        "Kw_Nms": float(np.mean(setup.controller.kw)),
    }


def _of_momentum(setup: Any) -> dict[str, Value]:
    return {"h_c_Nms": words(setup.momentum_target)}


def words(numbers: Sequence[float] | np.ndarray, digits: int = 9) -> str:
    """Return numbers as the paper prints a vector."""
    return "[" + ", ".join(f"{x + 0.0:.6g}" for x in np.round(numbers, digits)) + "]"
