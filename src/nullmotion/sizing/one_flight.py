"""One slew as a setup, what is measured of it, and what differs between slews."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops, rotation
from nullmotion.array.model import CmgArray
from nullmotion.law import Law
from nullmotion.metrics.base import Metric, Reduction, Sample
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Parameters
from nullmotion.sizing.requirement import Requirement
from nullmotion.spacecraft import Disturbance, Spacecraft, controllers

WATCHED = 0.2  # share of the time allowed for which a flight goes on beyond it


@dataclass(frozen=True)
class Unsettled(Metric):
    """First sample after which pointing error and body rate stay within their tolerances.

    Args:
        angle: Pointing error that counts as settled [rad].
        rate: Body rate that counts as settled [rad/s].
    """

    name: ClassVar[str] = "unsettled_s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("latest",)
    needs_body: ClassVar[bool] = True

    angle: float
    rate: float

    def of(self, sample: Sample) -> Any:
        """Return the time from which this sample lets the run be settled [s]."""
        there = ops.less_equal(rotation.angle(sample.q_BR), self.angle)
        still = ops.less_equal(linalg.norm(sample.omega_BN_B), self.rate)
        return ops.where(ops.logical_and(there, still), 0.0, sample.t + sample.dt)  # NaN is neither


def setup(r: Requirement, array: CmgArray, law: Law, substeps: int) -> Setup:
    """Return a slew with an array; what differs between slews stands for itself.

    Args:
        r: What is flown.
        array: An array that the law steers.
        law: The law.
        substeps: Integration steps in a period of the law.
    """
    dt, torque = r.period / substeps, r.disturbance.torque_Nm
    periods = int(np.ceil((1.0 + WATCHED) * r.time / r.period))
    rest = np.tile([1.0, *[0.0] * 9], (periods, 1))
    own: dict[str, Any] = {"natural_frequency_rad_s": r.natural_frequency}
    return Setup(
        array=array.altered(rate_limit=np.ones(array.n)),
        law=law,
        delta=np.zeros(array.n),
        hdot=np.zeros(3),
        dt=dt,
        steps=periods * substeps,
        period_steps=substeps,
        metrics=(Unsettled(np.radians(r.settling.pointing_error_deg), _body_rate(r)),),
        spacecraft=Spacecraft(r.inertia),
        controller=controllers.create("tracking", damping=r.controller.damping, **own),
        reference=rest,
        disturbance=None if torque is None else Disturbance(np.array(torque, float)),
    )


def _body_rate(r: Requirement) -> float:
    return float(np.radians(r.settling.body_rate_deg_s))


def marked(own: Parameters) -> Parameters:
    """Return the parameters with what differs between slews not a number."""
    array = ("gimbal_axes", "spin_axes", "h0", "rate_limit", "torque_axes")
    marks: dict[str, Any] = {"array": _blank(own.array, *array), "delta": own.delta * np.nan}
    marks["spacecraft"] = _blank(own.spacecraft, "inertia")
    if own.disturbance is not None:
        marks["disturbance"] = _blank(own.disturbance, "constant")
    return own._replace(**marks)


def _blank(record: Any, *fields: str) -> Any:
    """Return an unchecked copy with fields that are not numbers."""
    made = copy.copy(record)
    for name in fields:
        object.__setattr__(made, name, getattr(record, name) * np.nan)
    return made
