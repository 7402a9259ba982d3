"""What the theorem behind the controller ``adaptive`` assumes, and where a run breaks it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.vscmg.parameters import Parameters

SAMPLED = "control is continuous"


@dataclass(frozen=True, eq=False)
class Broken:
    """An assumption of the theorem that does not hold.

    Attributes:
        assumption: What is assumed.
        spans: From when to when it does not hold [s], (k, 2), in order.
        detail: What there is instead.
    """

    assumption: str
    spans: np.ndarray
    detail: str

    @property
    def seconds(self) -> float:
        """For how long it does not hold [s]."""
        return float(np.sum(self.spans[:, 1] - self.spans[:, 0]))

    def summary(self) -> dict[str, Any]:
        """Return the record for ``summary.json``."""
        return {
            "assumption": self.assumption,
            "found": self.detail,
            "from_s": float(self.spans[0, 0]),
            "to_s": float(self.spans[-1, 1]),
            "seconds": self.seconds,
            "times": len(self.spans),
        }

    def __str__(self) -> str:
        first, last = self.spans[0, 0], self.spans[-1, 1]
        return f"{self.assumption} ({self.detail}, {first:.4g} to {last:.4g} s)"


def broken(run: Any, true: Parameters, rows: np.ndarray) -> Iterator[Broken]:
    """Yield the assumptions that do not hold on a run.

    Args:
        run: A `nullmotion.sim.Trajectory`.
        true: Its true parameters.
        rows: Marks the rows that are samples of the controller, (k,).
    """
    setup, end = run.setup, float(run.t[-1])
    for assumption, detail in (*_plant(run), *_knowledge(setup, true)):
        yield Broken(assumption, np.array([[0.0, end]]), detail)
    for assumption, detail, marks, late in _moments(run, rows):
        if np.any(marks):
            spans = np.minimum(_spans(run.t[rows], marks, setup.period) + late, end)
            yield Broken(assumption, spans[spans[:, 0] < end], detail)
    for event in setup.events:
        if event.at < end:
            spans = np.array([[event.at, end]])
            yield Broken("every motor works", spans, f"CMG {event.cmg + 1}: {event.kind}")


def _plant(run: Any) -> Iterator[tuple[str, str]]:
    """Yield what of the equations of motion is not the theorem's, over the whole run."""
    setup, units = run.setup, run.setup.units
    yield SAMPLED, f"sampled every {setup.period:g} s"
    if setup.delay_steps:
        yield "commands act at once", f"after {setup.delay_steps * setup.dt:g} s"
    if units.terms == "all" and np.any(units.gimbal_inertia > 0):
        torque = np.diff(run.speed, axis=0) / np.diff(run.t)[:, None] * units.gimbal_inertia
        most = np.max(np.linalg.norm(torque @ setup.true_array.gimbal_axes, axis=1), initial=0.0)
        yield "gimbals accelerate without torque", f"up to {most:.2g} N m"
    if units.drive == "torque":
        yield "rates and accelerations are as commanded", "torque-driven units"
    if setup.desaturation is not None:
        yield "no torque from outside", "desaturation"
    outside = setup.disturbance
    if outside is not None:
        if outside.orbit is not None or np.any(outside.amplitude):
            yield "no torque from outside", "a changing disturbance"
        elif np.any(outside.constant) and not setup.controller.Gamma3 > 0:
            yield "no torque from outside", "a constant disturbance, not learned (Gamma3 = 0)"


def _knowledge(setup: Any, true: Parameters) -> Iterator[tuple[str, str]]:
    """Yield what is not known or learned as the theorem has it."""
    controller, sensors = setup.controller, setup.sensors
    for name in ("Gamma1", "Gamma2"):
        if not getattr(controller, name) > 0:
            yield "parameters are learned", f"{name} = 0"
    for name, theta, bound in (
        ("theta_1", true.theta1, controller.inertia_bound),
        ("theta_2", true.theta2, controller.unit_inertia_bound),
    ):
        most = float(np.max(np.abs(theta)))
        if most > bound:
            yield "parameters lie within the projection's bounds", f"{name}: {most:g} > {bound:g}"
    if setup.plant is not None:
        yield "axes and wheels are known", "the plant differs"
    biased = setup.encoder_bias is not None and np.any(setup.encoder_bias)
    if biased or (sensors is not None and (sensors.noisy or np.any(sensors.gyro_bias))):
        yield "measurements are exact", "errors of sensors"


def _moments(run: Any, rows: np.ndarray) -> Iterator[tuple[str, str, np.ndarray, float]]:
    """Yield what may happen at some samples: assumption, detail, marks (K,), delay [s]."""
    setup, array, delta = run.setup, run.setup.array, run.delta[rows]
    late = setup.delay_steps * setup.dt
    yield "all torque asked for is given", "cut by a limit", run.limited[rows] > 0, late
    if array.has_angle_limits:
        low, high = array.angle_limits.T
        stopped = np.any((delta <= low + 1e-9) | (delta >= high - 1e-9), axis=1)
        yield "gimbals turn freely", "end stop", stopped, 0.0
    q, reference = run.q_BN[rows], run.reference[rows]
    e0 = np.sum(q * reference, axis=1)
    # a quaternion's sign may change in a table, too: far from a half turn
    turned = (e0[1:] * e0[:-1] < 0) & (np.abs(e0[1:]) < 0.5)
    marks = np.append(turned, False)
    yield "the error stays within half a turn", "e0 changes its sign", marks, 0.0


def _spans(t: np.ndarray, marks: np.ndarray, period: float) -> np.ndarray:
    """Return from when to when marks are set, each for a period [s], (k, 2)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], marks.astype(int), [0]])))
    first, last = edges[::2], edges[1::2] - 1
    return np.stack([t[first], t[last] + period], axis=1)
