"""The motion of the gimbals over one step: a constant acceleration from a rate."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.spacecraft import faults
from nullmotion.spacecraft.servo import Servo


class Motion(NamedTuple):
    """Gimbal motion over a step; ``acceleration`` is None for an ideal servo, whose rate jumps.

    Attributes:
        rate: Rate at the start of the step [rad/s], (n,).
        acceleration: [rad/s^2], (n,).
        end_rate: Rate at its end, where the next step starts.
        torque: Torque of the motors about the gimbal axes [N m], (n,).
    """

    rate: Any
    acceleration: Any
    end_rate: Any
    torque: Any

    def mean(self, dt: Any) -> Any:
        """Return the mean rate over the step [rad/s]."""
        return self.rate if self.acceleration is None else self.rate + 0.5 * dt * self.acceleration

    def rate_at(self, time: Any) -> Any:
        """Return the rate at a time after the start of the step."""
        return self.rate if self.acceleration is None else self.rate + time * self.acceleration

    def angle_at(self, delta: Any, time: Any) -> Any:
        """Return the gimbal angles at a time after the start of the step."""
        mean = self.rate if self.acceleration is None else self.rate_at(0.5 * time)
        return delta + time * mean


def ideal(
    array: CmgArray, events: faults.Events, delta: Any, rates: Any, previous: Any, t: Any, dt: Any
) -> Motion:
    """Return motion at the commanded rates, but for stuck and slow gimbals and end stops."""
    if events:
        bound = faults.rate_bound(events, array.n, t)
        rates = ops.clip(rates, -bound, bound) * faults.stuck(events, array.n, t)
    if array.has_angle_limits:
        rates = (array.within_angle_limits(delta + dt * rates) - delta) / dt
    return Motion(rates, None, rates, np.zeros(array.n))


def driven(
    servo: Servo,
    array: CmgArray,
    events: faults.Events,
    delta: Any,
    command: Any,
    speed: Any,
    reading: Any,
    turning: Any,
    t: Any,
    dt: Any,
) -> Motion:
    """Return motion under a servo (`Servo` holds the equations).

    Args:
        servo: The servo.
        array: The true array.
        events: Faults.
        delta: Gimbal angles [rad], (n,).
        command: Commanded rates [rad/s], (n,).
        speed: Gimbal rates [rad/s], (n,).
        reading: Encoder angles a step ago and now [rad]; () when the encoder is exact.
        turning: omega . c_i [N m], c_i: column of A; the gyroscopic torque about gimbal i.
        t: Time [s].
        dt: Step [s].
    """
    measured = speed
    if reading:
        stepped = ops.less(0.0, servo.encoder_resolution)
        measured = ops.where(stepped, (reading[1] - reading[0]) / dt, speed)
    lag = ops.where(ops.less(0.0, servo.time_constant), servo.time_constant, 1.0)
    share = ops.where(ops.less(0.0, servo.time_constant), 1.0 - ops.exp(-dt / lag), 1.0)
    wanted = (command - measured) * (share / dt)
    wanted = ops.clip(wanted, -servo.acceleration_limit, servo.acceleration_limit)
    torque = servo.inertia * wanted - turning
    end = speed + dt * wanted
    if servo.has("torque_limit") or servo.has("friction"):
        torque = ops.clip(torque, -servo.torque_limit, servo.torque_limit)
        heavy = ops.less(0.0, servo.inertia)  # in a batch some runs may have neither of the two
        inertia = ops.where(heavy, servo.inertia, 1.0)
        free = speed + dt * (torque + turning) / inertia
        size = ops.maximum(ops.absolute(free) - dt * servo.friction / inertia, 0.0)
        end = ops.where(heavy, ops.copysign(size, free), end)
    bound = ops.minimum(servo.rate_limit, faults.rate_bound(events, array.n, t))
    end = ops.clip(end, -bound, bound) * faults.stuck(events, array.n, t)
    return _stopped(array, delta, Motion(speed, (end - speed) / dt, end, torque), dt)


def _stopped(array: CmgArray, delta: Any, motion: Motion, dt: Any) -> Motion:
    """Return the motion as the end stops let it be: a gimbal that meets one stands there."""
    if not array.has_angle_limits:
        return motion
    free = motion.angle_at(delta, dt)
    held = array.within_angle_limits(free)
    hit = ops.logical_not(ops.equal(free, held))
    return Motion(
        ops.where(hit, (held - delta) / dt, motion.rate),
        ops.where(hit, 0.0, motion.acceleration),
        ops.where(hit, 0.0, motion.end_rate),
        motion.torque,
    )


def quantised(angle: Any, resolution: Any) -> Any:
    """Return angles as an encoder with a resolution [rad] reads them; exact where it is 0."""
    step = ops.where(ops.less(0.0, resolution), resolution, 1.0)
    return ops.where(ops.less(0.0, resolution), ops.rint(angle / step) * step, angle)
