"""A versine step driven by reaction wheels.

    T = tau_g - (N - I_RW) theta''             torque on the wheel, from rest
    I_RW (w + theta') = integral of T dt       w: its speed against the body
    E = integral of |T w| dt                                                           (Eq 96)

N holds the wheel, tau_g = M (cm/o x g) . r. Gravity loads the wheel all the way up and unloads it
on the way down, and both count: this is why a versine takes many times an impulsive step.
Elliott 2019, Section 5.6.1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullmotion.rover.rover import Site
from nullmotion.rover.step_dynamics import State, gravity_torque, thresholds
from nullmotion.rover.versine import Verdict, Versine, verdict
from nullmotion.rover.wheels import WheelRover, check_stays

RATE = 2.0  # [rad/s], Section 5.6.1


@dataclass(frozen=True, eq=False)
class WheelStep:
    """A versine step of a rover with wheels; arrays over time, (k,).

    Attributes:
        step: The motion.
        torque: T, on the wheels together [N m].
        speed: w, of the wheels together against the body [rad/s].
        spare: Torque to spare before spike b, and spike a, lifts off [N m], (2, k).
        energy: E [J].
        work: The same with its sign: what the motors do in all [J].
        cost_of_travel: E/(M distance) [J/(kg m)].
        verdict: How it comes out.
    """

    step: Versine
    torque: np.ndarray
    speed: np.ndarray
    spare: np.ndarray
    energy: float
    work: float
    cost_of_travel: float
    verdict: Verdict

    @property
    def outcome(self) -> str:
        """``landed``, ``stalled``, ``tipped`` or ``lifted off``."""
        return self.verdict.outcome


def versine_step(
    rover: WheelRover,
    edge: int = 1,
    site: Site | None = None,
    rate: float = RATE,
    face: int | None = None,
) -> WheelStep:
    """Return a versine step of a rover with wheels over an edge.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        rate: Greatest rate of the body [rad/s].
        face: Face on the ground before the step; the lower number of the two by default.

    Raises:
        InputError: For an edge that it does not have, a slope on which it does not stay, or a
            rate that is not above 0.
    """
    site = site or Site()
    frame = rover.chassis.edge_frame(edge, face)
    check_stays(rover.chassis, frame, site)
    model, step = rover.model(frame, site), Versine.over(frame.turn, rate)
    state = State(step.theta, step.theta_dot, 0.0, 0.0, 0.0)
    I_RW, share = rover.wheel_inertia, float(np.abs(frame.r).max())
    T = gravity_torque(model, step.theta) - (model.N - I_RW) * step.theta_ddot
    w = _integral(T, step.t) / I_RW - step.theta_dot
    spare = thresholds(model, state, step.theta_ddot).spare
    short = (share * np.abs(w) > rover.speed_limit) | (share * np.abs(T) > rover.torque_limit)
    ends = verdict(step, short, spare, _lacking(rover))
    energy, work = (float(_integral(power, step.t)[-1]) for power in (np.abs(T * w), T * w))
    cost = energy / (rover.mass * frame.distance)
    return WheelStep(step, T, w, np.array(spare), energy, work, cost, ends)


def _lacking(rover: WheelRover) -> str:
    limits = []
    if math.isfinite(rover.speed_limit):
        limits.append(f"a speed of {rover.speed_limit:g} rad/s")
    if math.isfinite(rover.torque_limit):
        limits.append(f"a torque of {rover.torque_limit:g} N m")
    return f"the wheels are limited to {' and '.join(limits)}"


def _integral(values: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return the running integral over even times, by Simpson's rule."""
    from scipy.integrate import cumulative_simpson

    found: np.ndarray = cumulative_simpson(values, x=t, initial=0.0)
    return found
