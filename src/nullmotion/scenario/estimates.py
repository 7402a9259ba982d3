"""Names of what a controller has learned, for files and charts."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.sim.trajectory import Trajectory
from nullmotion.spacecraft.controllers.adaptive import Estimates

_ENTRIES = ("xx", "yy", "zz", "xy", "xz", "yz")


def estimates(run: Trajectory) -> dict[str, tuple[list[str], str, np.ndarray]]:
    """Return what was learned by kind: names of its parts, unit, values (N+1, parts).

    ``inertia``: theta_1 of the controller ``adaptive``, six entries of the constant part of the
    inertia and J_s - J_t of each unit; ``unit_inertia``: theta_2, J_g and J_s - J_t of each
    unit as they act through gimbal rates; ``outside_torque``. A controller that is not known
    here has its state as ``state``, without names. Nothing for one that learns nothing.
    """
    table, controller = run.estimates, run.setup.controller
    if table is None or controller is None or not table.shape[1]:
        return {}
    n = run.setup.array.n
    like = controller.init(run.setup.array)
    if not isinstance(like, Estimates):
        return {"state": ([str(i) for i in range(table.shape[1])], "1", table)}
    sideways = [f"Js-Jt_{i}" for i in range(n)]
    named: dict[str, tuple[list[str], str]] = {
        "inertia": ([f"J_{entry}" for entry in _ENTRIES] + sideways, "kg m2"),
        "unit_inertia": ([f"Jg_{i}" for i in range(n)] + sideways, "kg m2"),
        "outside_torque": (list("xyz"), "N m"),
    }
    found, at = {}, 0
    for (kind, (names, unit)), part in zip(named.items(), like[:3], strict=True):
        size = len(tree.flatten(part))
        found[kind] = (names, unit, table[:, at : at + size])
        at += size
    return {kind: entry for kind, entry in found.items() if _learned(controller, kind)}


def _learned(controller: Any, kind: str) -> bool:
    gain = {"inertia": "Gamma1", "unit_inertia": "Gamma2", "outside_torque": "Gamma3"}[kind]
    return bool(getattr(controller, gain, 0.0) > 0)
