"""Everything that defines a run, in SI and radians."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError, UnsupportedArrayError
from nullmotion.law import Law
from nullmotion.metrics.base import Metric
from nullmotion.spacecraft import (
    Controller,
    Desaturation,
    Disturbance,
    Event,
    ReactionWheel,
    Sensors,
    Servo,
    Spacecraft,
)
from nullmotion.spacecraft.body import checked_quaternion
from nullmotion.vscmg.hardware import Units

Integrator = Literal["euler", "rk4", "semi-implicit-euler", "dop853"]


@dataclass(frozen=True)
class Stop:
    """Stop a run when a metric passes a threshold, tested before each step."""

    metric: Metric
    threshold: float
    below: bool = True

    @property
    def reason(self) -> str:
        """The condition in words."""
        side = "below" if self.below else "above"
        return f"{self.metric.name} {side} {self.threshold:g}"


@dataclass(frozen=True)
class Setup:
    """One run: what is asked, of which array, by which law, on which plant.

    What is asked is a rate of momentum (`hdot`), a momentum (`momentum_target`) or, with
    a `spacecraft`, an attitude (`target` or `reference`).

    Args:
        array: The array that the law is given.
        law: The steering law.
        delta: True gimbal angles at the start [rad], (n,).
        hdot: Commanded rate of momentum [N m]: constant (m,), or a schedule with one row
            for each law period (rows, m), whose last row holds on.
        plant: The array that really turns; None if it is ``array``.
        encoder_bias: What the law's measured angles are off by [rad], (n,).
        dt: Integration step [s].
        steps: Number of steps.
        period_steps: Steps between two samples of the law.
        delay_steps: Steps between a sample and the rates that come of it.
        integrator: ``euler``, ``rk4``, ``semi-implicit-euler``, or ``dop853`` (SciPy's adaptive
            one, uncompiled, for cross-checks); serves the plant.
        stop: Conditions that end the run early.
        metrics: What is measured on the way.
        momentum_target: Momentum to go to [N m s], (m,): hdot = (target - h) / period.
        spacecraft: Body that carries the array; needs `controller` and an array that
            gives torque in all of B.
        controller: Makes hdot of the attitude error.
        target: Attitude to go to, q_RN, (4,).
        reference: Attitude to follow, a row for each law period: q_RN, omega_RN_R
            [rad/s], alpha_RN_R [rad/s^2], (rows, 10); the last row holds on, at rest.
        servo: How gimbals follow; at once and exactly if None.
        sensors: Errors of measured rate and attitude.
        disturbance: Torque on the body from outside.
        desaturation: Torque from outside that takes momentum off the array.
        events: Faults; each begins with the first step that starts at or after its time.
        reaction_wheel: Wheel normal to the torque plane of a planar array on a spacecraft.
        units: Inertias and drives of VSCMG units on a spacecraft (`array.wheels` are their
            flywheels); a law that turns wheels alone needs none.
        wheel_speed: Wheel speeds at the start [rad/s], (n,); those of h0 by default.

    Raises:
        UnsupportedArrayError: When the law cannot steer the array.
        InputError: For lengths that do not fit and numbers that cannot be.
    """

    array: CmgArray
    law: Law
    delta: np.ndarray
    hdot: np.ndarray
    plant: CmgArray | None = None
    encoder_bias: np.ndarray | None = None
    dt: float = 0.01
    steps: int = 1000
    period_steps: int = 1
    delay_steps: int = 0
    integrator: Integrator = "rk4"
    stop: tuple[Stop, ...] = ()
    metrics: tuple[Metric, ...] = field(default=())
    momentum_target: np.ndarray | None = None
    spacecraft: Spacecraft | None = None
    controller: Controller | None = None
    target: np.ndarray | None = None
    reference: np.ndarray | None = None
    servo: Servo | None = None
    sensors: Sensors | None = None
    disturbance: Disturbance | None = None
    desaturation: Desaturation | None = None
    events: tuple[Event, ...] = ()
    reaction_wheel: ReactionWheel | None = None
    units: Units | None = None
    wheel_speed: np.ndarray | None = None

    def __post_init__(self) -> None:
        """Check lengths and signs."""
        reason = self.law.supports(self.array)
        if reason:
            raise UnsupportedArrayError(self.law.name, reason)
        put = object.__setattr__
        put(self, "delta", _finite("delta", self.delta, (self.array.n,)))
        hdot = np.asarray(self.hdot, float)
        shape = (self.array.m,) if hdot.ndim == 1 else (len(hdot), self.array.m)
        put(self, "hdot", _finite("hdot", hdot, shape))
        if self.encoder_bias is not None:
            put(self, "encoder_bias", _finite("encoder_bias", self.encoder_bias, (self.array.n,)))
        put(self, "dt", float(self.dt))
        if not (np.isfinite(self.dt) and self.dt > 0):
            raise InputError("dt", self.dt, "above 0 s")
        for key, least in (("steps", 1), ("period_steps", 1), ("delay_steps", 0)):
            if int(getattr(self, key)) < least:
                raise InputError(key, getattr(self, key), f"a whole number from {least}")
        if self.momentum_target is not None:
            wanted = _finite("momentum_target", self.momentum_target, (self.array.m,))
            put(self, "momentum_target", wanted)
        put(self, "events", tuple(_on_a_step(event, self.dt) for event in self.events))
        for event in self.events:
            if not 0 <= event.cmg < self.array.n:
                raise InputError("event.cmg", event.cmg, f"from 0 to {self.array.n - 1}")
        if self.servo is not None:
            self._check_servo(self.servo)
        for metric in (*self.metrics, *(s.metric for s in self.stop)):
            if metric.needs_body and self.spacecraft is None:
                raise InputError("metrics", metric.name, "a metric that needs no spacecraft")
            if metric.needs_wheels and not self.variable_speed:
                allowed = "a metric that needs no variable wheel speeds"
                raise InputError("metrics", metric.name, allowed)
        if self.spacecraft is not None:
            self._check_attitude()
        elif self.reaction_wheel is not None:
            raise InputError("reaction_wheel", "given", "only on a spacecraft")
        if self.variable_speed:
            self._check_wheels()
        elif self.wheel_speed is not None:
            raise InputError("wheel_speed", "given", "only with a law or units that use it")

    def _check_wheels(self) -> None:
        put, array = object.__setattr__, self.array
        if array.wheels is None:
            raise InputError("array.wheels", None, "flywheels, for variable-speed CMGs")
        for key in ("servo", "reaction_wheel"):
            if getattr(self, key) is not None:
                raise InputError(key, "given", "no such thing beside variable-speed CMGs")
        for event in self.events:
            if event.kind == "spin-down":
                raise InputError("event.kind", event.kind, "'wheel-dead', or a gimbal's fault")
        if self.integrator != "rk4" and self.spacecraft is not None:
            raise InputError("integrator", self.integrator, "'rk4' for variable-speed CMGs")
        if self.spacecraft is not None:
            put(self, "units", (self.units or Units(0.0, 0.0, 0.0)).for_n(array.n))
            assert self.units is not None
            self.units.check_beside(self.true_array, self.spacecraft.inertia, self.delta)
            stuck = [event.kind for event in self.events if event.kind == "stuck"]
            if self.units.drive == "torque" and (stuck or array.has_angle_limits):
                allowed = "'rate' with end stops or a stuck gimbal"
                raise InputError("vscmg.drive", self.units.drive, allowed)
        elif self.units is not None:
            raise InputError("units", "given", "only on a spacecraft")
        given = array.design_speed if self.wheel_speed is None else self.wheel_speed
        put(self, "wheel_speed", _finite("wheel_speed", given, (array.n,)))

    def _check_servo(self, servo: Servo) -> None:
        for key, value in vars(servo).items():
            if np.ndim(value) == 1 and len(value) != self.array.n:
                allowed = f"one number or {self.array.n}"
                raise InputError(f"servo.{key}", value.tolist(), allowed)

    def _check_attitude(self) -> None:
        self._check_torque()
        if self.controller is None:
            raise InputError("controller", None, "a controller for the spacecraft")
        if (self.target is None) == (self.reference is None):
            raise InputError("target", self.target, "either a target or a reference")
        put = object.__setattr__
        if self.target is not None:
            put(self, "target", checked_quaternion("target", self.target))
        else:
            table = np.asarray(self.reference, float)
            put(self, "reference", _finite("reference", table, (len(table), 10)))

    def _check_torque(self) -> None:
        """Ask for torque in all three dimensions, of the array or of array and wheel."""
        if self.reaction_wheel is not None:
            self.reaction_wheel.check_beside(self.array)
        elif self.array.m != 3:
            allowed = "an array with torque in all three dimensions, or a reaction wheel"
            raise InputError("array", self.array.label, allowed)

    @property
    def variable_speed(self) -> bool:
        """Whether the wheels' speeds change."""
        return self.units is not None or self.law.turns_wheels

    @property
    def true_array(self) -> CmgArray:
        """The array that really turns."""
        return self.array if self.plant is None else self.plant

    @property
    def scheduled(self) -> bool:
        """Whether the command changes over time."""
        return self.reference is not None or self.hdot.ndim == 2

    @property
    def table(self) -> np.ndarray:
        """The command for each law period, one row each; empty rows when it is constant."""
        if self.reference is not None:
            return self.reference
        return self.hdot if self.hdot.ndim == 2 else np.zeros((1, 0))

    @property
    def period(self) -> float:
        """Time between two samples of the law [s]."""
        return self.dt * self.period_steps


def _on_a_step(event: Event, dt: float) -> Event:
    """Return an event that begins where a step does."""
    if not np.isfinite(event.at):
        return event
    return replace(event, at=float(np.ceil(event.at / dt - 1e-6) + 0.0) * dt)


def _finite(key: str, value: object, shape: tuple[int, ...]) -> np.ndarray:
    array = np.asarray(value, float)
    if array.shape != shape:
        raise InputError(key, array.tolist(), f"{' x '.join(map(str, shape))} numbers")
    if not np.isfinite(array).all():
        raise InputError(key, array.tolist(), "finite numbers")
    return array
