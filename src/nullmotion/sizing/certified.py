"""The array that is proven to give what the slews ask for, in every direction of the cone.

The demand is bounded over all axes e of the cone, with the largest inertia L = max |J e| there,
bias b and torque T from outside:

    |h|    <= L w(t) + b + T t
    |hdot| <= L a(t) + w(t) (b + T t) + T

A constraint function with TC >= c_k for every |h| <= r_k, balls r_1 < r_2 < ... in each other,
gives the demand at every instant if |hdot| <= h0 rate c_k wherever |h| <= h0 r_k. The least
capabilities are found by search, and the momentum that they call for; then each is proven.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.radius import guaranteed_radius, least_capabilities
from nullmotion.sizing import boundary
from nullmotion.sizing.axes import frames
from nullmotion.sizing.profile import RateProfile
from nullmotion.sizing.requirement import Requirement

INTERRUPTED = "interrupted"
_BALLS = np.array([0.9, 1.0])  # radii over the greatest: torque falls off near the last
_SLACK = 0.99  # of the least capability that was found: a proof needs room
_FEEDBACK = 0.1  # of the greatest torque: asked at every momentum, for what the slew leaves out
_INSIDE = 0.999  # of the radius at which torque is lost
_SAMPLES, _RIM, _GRID = 2001, 3600, 60
_STEP, _TOLERANCE = 1.3, 1e-4


class Bound(NamedTuple):
    """Greatest |h| [N m s] and |hdot| [N m] of any slew over time, (samples,)."""

    momentum: np.ndarray
    torque: np.ndarray


class Claim(NamedTuple):
    """TC >= capability wherever |h| <= radius, in units of one CMG's momentum and rate."""

    radius: float
    capability: float


def demand_bound(requirement: Requirement, profile: RateProfile) -> Bound:
    """Return what no slew about an axis of the cone exceeds."""
    r, t = requirement, np.linspace(0.0, profile.time, _SAMPLES)
    _, rate, acceleration = profile.at(t)
    torque = float(np.linalg.norm(r.disturbance.torque_Nm or 0.0))
    held = float(np.linalg.norm(r.disturbance.momentum_Nms)) + torque * t
    L = largest_inertia(r.inertia, r.axis, r.cone)
    return Bound(L * rate + held, L * np.abs(acceleration) + rate * held + torque)


def largest_inertia(inertia: np.ndarray, axis: np.ndarray, cone: float) -> float:
    """Return max |J e| over the axes e of a cone [kg m^2]; not less, and hardly more.

    |J e| has no maximum but at the axis of the greatest moment, or on the cone's rim.
    """
    moments, axes = np.linalg.eigh(inertia)
    if abs(axes[:, 2] @ axis) >= np.cos(cone) or cone >= 0.5 * np.pi:
        return float(moments[2])
    C, around = frames(axis[None, :])[0], np.linspace(0.0, 2.0 * np.pi, _RIM, endpoint=False)
    aside = np.cos(around)[:, None] * C[1] + np.sin(around)[:, None] * C[2]
    rim = np.cos(cone) * axis + np.sin(cone) * aside
    between = np.sin(cone) * np.pi / _RIM  # to the nearest of these axes
    found = np.linalg.norm(rim @ inertia, axis=1).max() + moments[2] * between
    return float(min(found, moments[2]))


def momenta(constraint: Constraint, bound: Bound, rates: np.ndarray) -> np.ndarray:
    """Return the least momentum [N m s] whose capability, as searched, suffices at each rate."""
    reach = _INSIDE * _capability(constraint)[0][-1]
    start = np.maximum(bound.momentum.max() / reach, bound.torque.max() / rates)

    def suffices(h0: np.ndarray, lanes: np.ndarray) -> np.ndarray:
        return np.array(
            [needed(constraint, bound, h) <= rates[i] for h, i in zip(h0, lanes, strict=True)]
        )

    return boundary.least(suffices, 3.0 * start, _STEP, _TOLERANCE)


def needed(constraint: Constraint, bound: Bound, h0: float) -> float:
    """Return the gimbal rate [rad/s] that a momentum needs; infinite if it is too small."""
    radii, least = _capability(constraint)
    ball = _ball(bound, h0)
    if ball[-1] > _INSIDE * radii[-1]:
        return np.inf
    capability = _SLACK * np.interp(ball, radii, least)
    return float(max(a / (h0 * c) for a, c in zip(_asked(bound, h0), capability, strict=True)))


def claims(bound: Bound, h0: float, rate: float) -> list[Claim]:
    """Return what has to be proven of a design."""
    asked = [a / (h0 * rate) for a in _asked(bound, h0)]
    return [Claim(float(r), float(a)) for r, a in zip(_ball(bound, h0), asked, strict=True)]


def proofs(constraint: Constraint, wanted: list[Claim]) -> list[dict[str, Any]]:
    """Return what became of each claim: the certificate without its boxes.

    Raises:
        KeyboardInterrupt: On Ctrl-C.
    """
    found = []
    for claim in wanted:
        made = constraint.certificate(claim.radius, claim.capability)
        if made.reason == INTERRUPTED:  # a proof comes back on Ctrl-C
            raise KeyboardInterrupt
        record: dict[str, Any] = {"radius": made.radius}
        record["torque_capability"] = made.torque_capability
        record |= {"proven": made.proven, "statement": made.statement, "boxes": made.boxes}
        found.append(record | {"seconds": round(made.seconds, 3)})
    return found


def _ball(bound: Bound, h0: float) -> np.ndarray:
    """Return the radii of the balls, in each other, up to the greatest momentum."""
    radii: np.ndarray = bound.momentum.max() / h0 * _BALLS
    return radii


def _asked(bound: Bound, h0: float) -> list[float]:
    """Return the greatest torque [N m] asked within each ball and outside the one before."""
    inner = bound.momentum.max() * np.array([0.0, *_BALLS[:-1]])
    least = _FEEDBACK * bound.torque.max()
    return [float(bound.torque[bound.momentum >= h].max(initial=least)) for h in inner]


@lru_cache(maxsize=16)
def _capability(constraint: Constraint) -> tuple[np.ndarray, np.ndarray]:
    """Return radii and the least TC within each, up to where it is lost."""
    whole = guaranteed_radius(constraint, 0.0).value
    radii = np.linspace(0.0, _INSIDE * whole, _GRID)
    return radii, np.minimum.accumulate(least_capabilities(constraint, radii))
