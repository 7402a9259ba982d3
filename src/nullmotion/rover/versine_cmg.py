"""A versine step driven by the CMG: why steps are planned.

The motion fixes the CMG's momentum about the edge, and that the gimbal angle:

    h s.r + theta' (A_s (s.r)^2 + A_g (g.r)^2 + A_o (o.r)^2) + N theta'
        = h s.r at the start + integral of tau_g dt,          (o.r)^2 = rho^2 - (s.r)^2

with rho^2 = 1 - (g.r)^2. (The gimbal's own spin about r, A_g delta' g.r, is left out: half a per
cent of h at most.) Only the angle at the start is free: all are tried, on both branches of o.r.
A slow step asks for more momentum than the 2 h rho there are and stalls, however the load on the
spikes grows as o.r goes to zero; a fast one swings the rotor so quickly that the off-axis torque
takes the weight off a spike. Elliott 2019, Sections 5.3, 5.6.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.step_dynamics import State, gravity_torque, thresholds
from nullmotion.rover.step_model import StepModel, step_model
from nullmotion.rover.versine import Verdict, Versine, verdict

_SAMPLES = 401
_STARTS = 181  # momenta about the edge at the start, on each branch


@dataclass(frozen=True, eq=False)
class CmgVersine:
    """The versine step of a CMG rover from the best gimbal angle; arrays over time, (k,).

    Attributes:
        step: The motion.
        delta: Gimbal angle [rad]; NaN where none gives the torque.
        delta_dot: Gimbal rate, at most its limit [rad/s].
        margin: Torque to spare before the rover tips [N m]; NaN where delta is.
        branch: Sign of o . r.
        verdict: How it comes out.
    """

    step: Versine
    delta: np.ndarray
    delta_dot: np.ndarray
    margin: np.ndarray
    branch: int
    verdict: Verdict

    @property
    def outcome(self) -> str:
        """``landed``, ``stalled``, ``tipped``, ``lifted off`` or ``fell behind``."""
        return self.verdict.outcome


class _Tries(NamedTuple):
    """Courses of the gimbal, one a row, (starts, k); `empty`: no momentum left to give."""

    delta: np.ndarray
    delta_dot: np.ndarray
    empty: np.ndarray
    weak: np.ndarray
    late: np.ndarray
    spare: tuple[np.ndarray, np.ndarray]
    branch: int

    def rank(self, row: int) -> tuple[int, float]:
        """Return whether a course gets through (2), is too fast (1) or stalls (0), how well."""
        stalled = self.empty[row] | self.weak[row]
        if stalled.any():
            return 0, float(np.argmax(stalled))
        least = np.minimum(*(spare[row] for spare in self.spare)).min()
        return 2 - int(self.late[row].any()), float(least)


def cmg_versine(
    rover: Rover,
    edge: int = 1,
    site: Site | None = None,
    rate: float = 2.0,
    face: int | None = None,
) -> CmgVersine:
    """Return the versine step of a CMG rover over an edge, from its best start.

    Best is what gets through with the greatest margin; next what only the gimbal's rate limit
    stops; last, of what cannot hold the rover, what gets farthest.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        rate: Greatest rate of the body [rad/s].
        face: Face on the ground before the step; the lower number of the two by default.

    Raises:
        InputError: For an unknown edge, or a rate that is not above 0.
    """
    frame = rover.edge_frame(edge, face)
    model = step_model(rover, frame, site or Site())
    step = Versine.over(frame.turn, rate, _SAMPLES)
    found = [_tried(model, rover.cmg.rate_limit, step, branch) for branch in (1, -1)]
    every = ((tries, row) for tries in found for row in range(len(tries.delta)))
    tries, row = max(every, key=lambda at: at[0].rank(at[1]))
    margin = np.minimum(*(spare[row] for spare in tries.spare))
    margin[tries.empty[row]] = np.nan
    ends = _verdict(tries, row, step, rover.cmg.rate_limit)
    return CmgVersine(step, tries.delta[row], tries.delta_dot[row], margin, tries.branch, ends)


def _verdict(tries: _Tries, row: int, step: Versine, rate_limit: float) -> Verdict:
    """Return how a course comes out."""
    stalled, late = tries.empty[row] | tries.weak[row], tries.late[row]
    i = int(np.argmax(stalled if stalled.any() else late))
    if stalled.any():
        why = "the CMG's momentum about the edge is used up: gravity wins"
        return Verdict("stalled", float(step.t[i]), float(step.theta[i]), why)
    for_b, for_a = (spare[row] for spare in tries.spare)
    ends = verdict(step, stalled, (for_b, for_a), "")
    if ends.outcome == "landed" and late.any():
        why = f"the gimbal would have to turn faster than {rate_limit:g} rad/s"
        return Verdict("fell behind", float(step.t[i]), float(step.theta[i]), why)
    return ends


def _tried(model: StepModel, rate_limit: float, step: Versine, branch: int) -> _Tries:
    """Return the courses from all starts on one branch."""
    from scipy.integrate import cumulative_simpson

    rho = np.sqrt(max(1 - model.g[1] ** 2, 0.0))
    starts = rho * np.linspace(-1, 1, _STARTS + 2)[1:-1, None]
    tau_g = gravity_torque(model, step.theta)
    impulse = cumulative_simpson(tau_g, x=step.t, initial=0.0)
    A_s, A_g, A_o = model.A
    N = model.N + A_g * model.g[1] ** 2 + A_o * rho**2
    s_r = wanted = starts + (impulse - N * step.theta_dot) / model.h
    for _ in range(5):  # the inertia of the CMG moves with it a little: a contraction by 1 %
        s_r = wanted - step.theta_dot * (A_s - A_o) * s_r**2 / model.h
    empty = np.maximum.accumulate(np.abs(s_r) >= rho, axis=1)
    o_r = branch * np.sqrt(np.maximum(rho**2 - s_r**2, 1e-12))
    turned = (model.h + 2 * step.theta_dot * (A_s - A_o) * s_r) * o_r
    asked = (tau_g - (N + (A_s - A_o) * s_r**2) * step.theta_ddot) / turned
    delta_dot = np.clip(asked, -rate_limit, rate_limit)
    weak = rate_limit * np.abs(turned) < -tau_g
    s0, o0 = model.s0[1], model.o0[1]
    delta = np.unwrap(np.arctan2(o0 * s_r - s0 * o_r, s0 * s_r + o0 * o_r), axis=1)
    delta_ddot = np.gradient(delta_dot, step.t, axis=1)
    state = State(step.theta, step.theta_dot, delta, delta_dot, delta_ddot)
    spare = thresholds(model, state, step.theta_ddot).spare
    late = np.abs(asked) > rate_limit
    return _Tries(np.where(empty, np.nan, delta), delta_dot, empty, weak, late, spare, branch)
