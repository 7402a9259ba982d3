"""The workload on nullmotion: plain source for one run, traced and compiled to a SIMD loop.

The spacecraft stands here as plain functions; the array, the laws, the small linear
algebra and the loop kernel are the package's own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import workload as w

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage
from nullmotion.compile.tape import unguarded


class State(NamedTuple):
    """Attitude, body rate, gimbal angles."""

    q: Any
    omega: Any
    delta: Any


def steering(law: str, array: CmgArray, delta: Any, hdot: Any) -> Any:
    """Return gimbal rates by one of the three laws."""
    a = array.jacobian(delta)
    if law == "svd":
        rows = linalg.rows(a, hdot)
        s1, s2, s3 = rows.squares
        return rows.solve(np.array([s1, s2, s3 + 0.01 * ops.exp(-10.0 * s3)]))
    gram = a @ a.T
    adj = linalg.adjugate(gram)
    det = gram[0] @ adj[:, 0]
    damped = gram + 0.01 * ops.exp(-10.0 * det) * np.eye(3)
    if law == "sr":
        return a.T @ linalg.solve(damped, hdot)
    momenta = array.rotor_momenta(delta)
    gradient = np.array([-2.0 * (momenta[i] @ (adj @ a[:, i])) for i in range(4)])
    null = 0.5 * gradient
    return a.T @ linalg.solve(damped, hdot - a @ null) + null


def _slopes(array: CmgArray, rates: Any, q: Any, omega: Any, delta: Any) -> tuple[Any, Any]:
    """Return 2 q_dot and J omega_dot: what is constant beside them goes into the step sizes."""
    momentum = w.INERTIA * omega + array.momentum(delta)
    torque = -linalg.cross(omega, momentum) - array.jacobian(delta) @ rates
    x, y, z = omega
    doubled = np.array(
        [
            -q[1] * x - q[2] * y - q[3] * z,
            q[0] * x + q[2] * z - q[3] * y,
            q[0] * y - q[1] * z + q[3] * x,
            q[0] * z + q[1] * y - q[2] * x,
        ]
    )
    return doubled, torque


def loop(law: str) -> Loop:
    """Return the closed loop of one law."""
    array = CmgArray(w.GIMBAL_AXES, w.SPIN_AXES, 1.0, w.RATE_MAX)
    dt = w.DT

    def step(k: Any, row: Any, s: State, p: State) -> State:
        flip = ops.where(ops.less(s.q[0], 0.0), -1.0, 1.0)
        wanted = -(w.KP * flip) * s.q[1:] - w.KW * s.omega
        hdot = -wanted - linalg.cross(s.omega, array.momentum(s.delta))
        rates = array.limited(steering(law, array, s.delta, hdot))
        middle, end = s.delta + (0.5 * dt) * rates, s.delta + dt * rates
        u, v = 0.5 * dt, dt / w.INERTIA  # steps of 2 q_dot and of J omega_dot
        a, b = _slopes(array, rates, s.q, s.omega, s.delta)
        with unguarded():  # between two guarded angles
            c, d = _slopes(array, rates, s.q + 0.5 * u * a, s.omega + 0.5 * v * b, middle)
            e, f = _slopes(array, rates, s.q + 0.5 * u * c, s.omega + 0.5 * v * d, middle)
            g, h = _slopes(array, rates, s.q + u * e, s.omega + v * f, end)
        q = s.q + (u / 6.0) * (a + 2.0 * (c + e) + g)
        omega = s.omega + (v / 6.0) * (b + 2.0 * (d + f) + h)
        return State(q * ops.rsqrt(q @ q), omega, end)

    example = State(np.zeros(4), np.zeros(3), np.zeros(4))
    return Loop(lambda p: p, (Stage(step),), lambda s, p: s, example, (True,) * 11)


def build(law: str, width: int | None = None) -> Callable[[Any, Any, Any, int], w.Batch]:
    """Return a compiled batch function (q, omega, delta, steps) -> final states."""
    kernel = LoopKernel(loop(law), width=width)
    none = np.zeros(1)

    def run(q: Any, omega: Any, delta: Any, steps: int) -> w.Batch:
        runs = q.shape[1]
        padded = -(-runs // kernel.width) * kernel.width
        values = np.empty((11, padded))
        values[:, :runs] = np.concatenate([q, omega, delta])
        values[:, runs:] = values[:, runs - 1 : runs]
        state = np.empty((kernel.carried, padded))
        out = np.empty((kernel.outputs + len(kernel.flags), padded))
        kernel.run(state, values, none, none, out, 0, padded, 0, steps, True)
        return w.Batch(out[:4, :runs], out[4:7, :runs], out[7:11, :runs])

    run.kernel = kernel  # type: ignore[attr-defined]
    return run
