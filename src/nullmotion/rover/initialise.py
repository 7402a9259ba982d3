"""Bringing the gimbal to where a step starts, with the rover at rest (Elliott 2019, Section 5.3).

    -(h delta' o + A_g delta'' g) . r_k <= share * W_k      for every edge k of the face below

W_k is what gravity holds the rover with over edge k: the CMG's torque stays below a share of the
static threshold. Along the gimbal's way the greatest rate is the lesser of what this leaves and
what constant accelerations from and to rest reach. A loop around the gimbal follows:

    delta'_c = delta'_r + k (delta_r - delta),   delta'' = clip(k_g (clip(delta'_c) - delta'))
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.limits import rest_torque, static_spare, weight_spares
from nullmotion.rover.step_plan import StepPlan

_POINTS = 720  # of the gimbal's way
_SAMPLE = 5e-3  # [s] between values that are kept
_LOOP, _GIMBAL = 10.0, 200.0  # k and k_g [1/s]; the loop is far slower than the gimbal
_KEPT = 0.95  # of the torque is planned with, the rest is the loop's
_SETTLE = 1.0  # [s] in which the loop's error dies out


@dataclass(frozen=True, eq=False)
class Initialisation:
    """The gimbal's way to the start of a step; arrays over time, (k,).

    Attributes:
        t: Times [s].
        delta: Gimbal angle [rad].
        delta_dot: Gimbal rate [rad/s].
        delta_ddot: Gimbal acceleration [rad/s^2].
        spare: Torque to spare before the rover tips over an edge [N m].
        threshold: Least torque that gravity holds the rover with [N m].
    """

    t: np.ndarray
    delta: np.ndarray
    delta_dot: np.ndarray
    delta_ddot: np.ndarray
    spare: np.ndarray
    threshold: float

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.t[-1])


class Way(NamedTuple):
    """A way of the gimbal: pieces of constant acceleration.

    Attributes:
        t: Times of the points [s], (n,).
        delta: Gimbal angles there [rad], (n,).
        rate: Gimbal rates there [rad/s], (n,).
    """

    t: np.ndarray
    delta: np.ndarray
    rate: np.ndarray


def initialise(plan: StepPlan, delta: float, share: float = 0.5) -> Initialisation:
    """Bring the gimbal from an angle to the start of a plan, the faster way round.

    Args:
        plan: The step that is to follow.
        delta: Where the gimbal is, at rest [rad].
        share: Share of the static threshold that may be used, in (0, 1].

    Returns:
        The gimbal's motion; it ends at the plan's first angle, up to whole turns.

    Raises:
        InputError: For a share outside, or a slope on which gravity does not hold the rover.
    """
    if not 0 < share <= 1:
        raise InputError("share", share, "above 0, at most 1")
    weight, r = weight_spares(plan.rover, plan.frame, plan.site)
    if weight.min() <= 0:
        allowed = f"a slope on which the rover stands (here {weight.min():.3g} N m to spare)"
        raise InputError("incline", plan.site.incline, allowed)
    short = float(np.mod(plan.delta[0] - delta + np.pi, 2 * np.pi) - np.pi)
    turns = [short, short - 2 * np.pi * (1 if short > 0 else -1)]
    ways = [_way(plan, delta, turn, _KEPT * share * weight, r) for turn in turns]
    t, y, y_ddot = _followed(plan, min(ways, key=lambda way: float(way.t[-1])))
    torque = rest_torque(plan.rover, y[0], y[1], y_ddot)
    spare = static_spare(plan.rover, plan.frame, plan.site, torque)
    return Initialisation(t, y[0], y[1], y_ddot, spare, float(weight.min()))


def _way(plan: StepPlan, start: float, turn: float, usable: np.ndarray, r: np.ndarray) -> Way:
    """Return the fastest way with bounded acceleration under a rate that depends on the angle."""
    cmg = plan.rover.cmg
    delta = start + turn * np.linspace(0.0, 1.0, _POINTS)
    tilting = cmg.inertia[1] * np.abs(r @ cmg.gimbal_axis)
    a = min(cmg.acceleration_limit, 0.2 * float((usable / np.maximum(tilting, 1e-9)).min())) / 2
    pushing = -rest_torque(plan.rover, delta, np.sign(turn), 0.0) @ r.T
    left = (usable - a * tilting) / np.maximum(pushing, 1e-9)
    most = np.minimum(left.min(axis=1), cmg.rate_limit) ** 2
    most[0] = most[-1] = 0.0
    gain = 2 * a * abs(turn) / (_POINTS - 1)
    for i in range(1, _POINTS):
        most[i] = min(most[i], most[i - 1] + gain)
    for i in reversed(range(_POINTS - 1)):
        most[i] = min(most[i], most[i + 1] + gain)
    rate = np.sqrt(most)
    t = np.append(0.0, np.cumsum(2 * np.abs(np.diff(delta)) / (rate[1:] + rate[:-1] + 1e-300)))
    return Way(t, delta, np.sign(turn) * rate)


def _followed(plan: StepPlan, way: Way) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times, angle and rate (2, k), and acceleration of the gimbal along a way."""
    from scipy.integrate import solve_ivp

    cmg = plan.rover.cmg

    def swing(t: np.ndarray | float, y: np.ndarray) -> np.ndarray:
        rate = np.interp(t, way.t, way.rate)
        wanted = rate + _LOOP * (np.interp(t, way.t, way.delta) - y[0])
        error = np.clip(wanted, -cmg.rate_limit, cmg.rate_limit) - y[1]
        limit = cmg.acceleration_limit
        acceleration: np.ndarray = np.clip(_GIMBAL * error, -limit, limit)
        return acceleration

    end = float(way.t[-1]) + _SETTLE
    t = np.append(np.arange(0.0, end - _SAMPLE / 2, _SAMPLE), end)
    start = [way.delta[0], 0.0]
    found = solve_ivp(
        lambda t, y: [y[1], float(swing(t, y))], (0.0, end), start, t_eval=t, max_step=0.01
    )
    return t, found.y, swing(t, found.y)
