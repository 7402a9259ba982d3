"""The workload on nullmotion's own simulation: body, controller, law and loop are the package's.

The laws stand here, as a user's own would: the workload's damping is none of the catalogue's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import workload as w

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.compile.kernel import LoopKernel
from nullmotion.law import Law, Observation
from nullmotion.sim import Setup, batch, stages
from nullmotion.spacecraft import Spacecraft, controllers


@dataclass(frozen=True)
class Steering(Law):
    """One of the workload's three laws."""

    kind: str = "sr"
    name: ClassVar[str] = "workload"

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the gimbal rates."""
        a, hdot = array.jacobian(obs.delta), obs.hdot
        if self.kind == "svd":
            rows = linalg.rows(a, hdot)
            s1, s2, s3 = rows.squares
            return rows.solve(np.array([s1, s2, s3 + 0.01 * ops.exp(-10.0 * s3)])), state
        gram = a @ a.T
        adj = linalg.adjugate(gram)
        det = gram[0] @ adj[:, 0]
        damped = gram + 0.01 * ops.exp(-10.0 * det) * np.eye(3)
        if self.kind == "sr":
            return a.T @ linalg.solve(damped, hdot), state
        momenta = array.rotor_momenta(obs.delta)
        gradient = np.array([-2.0 * (momenta[i] @ (adj @ a[:, i])) for i in range(4)])
        null = 0.5 * gradient
        return a.T @ linalg.solve(damped, hdot - a @ null) + null, state


def setup(law: str, steps: int) -> Setup:
    """Return one run of the workload."""
    return Setup(
        CmgArray(w.GIMBAL_AXES, w.SPIN_AXES, 1.0, w.RATE_MAX),
        Steering(law),
        np.zeros(4),
        np.zeros(3),
        dt=w.DT,
        steps=steps,
        spacecraft=Spacecraft(w.INERTIA),
        controller=controllers.create("quaternion-feedback", kp=w.KP, kw=w.KW),
        target=np.array([1.0, 0.0, 0.0, 0.0]),
    )


def build(law: str, width: int | None = None) -> Callable[[Any, Any, Any, int], w.Batch]:
    """Return a compiled batch function (q, omega, delta, steps) -> final states."""
    kernels: dict[int, LoopKernel] = {}
    none = np.zeros(1)

    def kernel(steps: int) -> LoopKernel:
        if steps not in kernels:
            one = setup(law, steps)
            rows = {"delta": one.delta, "spacecraft.q_BN": np.ones(4)}
            rows["spacecraft.omega_BN_B"] = np.zeros(3)
            varying = batch.values(one, {key: row[None] for key, row in rows.items()}, None)[1]
            kernels[steps] = LoopKernel(stages.loop(one, varying), width=width)
        return kernels[steps]

    def run(q: Any, omega: Any, delta: Any, steps: int) -> w.Batch:
        made, runs = kernel(steps), q.shape[1]
        padded = -(-runs // made.width) * made.width
        values = np.empty((11, padded))
        values[:, :runs] = np.concatenate([delta, q, omega])
        values[:, runs:] = values[:, runs - 1 : runs]
        state = np.empty((made.carried, padded))
        out = np.empty((made.outputs + len(made.flags), padded))
        made.run(state, values, none, none, out, 0, padded, 0, steps, True)
        found = [out[i, :runs] for i in range(made.outputs)]
        return w.Batch(np.array(found[-7:-3]), np.array(found[-3:]), np.array(found[2:6]))

    return run
