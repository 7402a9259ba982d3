"""Lyapunov's function along a run of the controller ``adaptive``, beside the bound of its theorem.

    V   = kp (e.e + (1 - e0)^2) + r.J r / 2 + theta~.Gamma^-1 theta~ / 2        (Eq 48)
    V_b = V(0) - integral of (alpha kp e.e + k r.r)                             (Eqs 49, 50)

e0, e: scalar and vector part of q_BR, r = omega - C omega_R + alpha e, C = C_BR; theta~ = theta -
estimate with the true parameters of the run (`Parameters`), a constant outside torque among them
where the controller learns it. In continuous time V <= V_b, as equal until the projection acts.

What sampling adds. Over a period T the command is held and the estimates step at its end. With Q
as estimated, u = -Q [wheel accelerations, gimbal rates] and u* = -(Y_1 theta_1 + k r + kp e),

    V(t + T) - V(t) = integral of (-alpha kp e.e - k r.r + r.Y theta~ + r.(u - u*))
                      - T (r.Y theta~)(t + T) + T^2 |Gamma^(1/2) Y^T r|^2 / 2

where r.Y theta~ cancels up to -T^2 (d/dt r.Y theta~) / 2, and u - u* grows from 0 over the period.
So V - V_b = T/2 integral of (|Gamma^(1/2) Y^T r|^2 - d/dt r.Y theta~ + r.d(u - u*)/dt) + O(T^2): of
first order in T, halved with it, and at rest once r is. Beyond the tolerance sampling is not the
reason, or T is too long.

Source: Kim, Leve, Fitz-Coy & Dixon, J. Guid. Control Dyn. 35 (2012), Eqs 18, 37-39, 47-51.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.vscmg.assumptions import SAMPLED, Broken, broken
from nullmotion.vscmg.parameters import true_parameters

_SETTLED = 0.01  # |e| below which an error counts as none


@dataclass(frozen=True, eq=False)
class LyapunovMonitor:
    """V and its bound at the samples of the controller.

    Shares are of the greatest part of V that comes of tracking errors, V without theta~: with a
    small Gamma the rest of V is large and hardly moves. Where an attitude is held this part may be
    made by sampling alone: what |e| = 0.01 makes is the least that shares are taken of.

    Attributes:
        t: Times of the samples [s], (K,).
        V: Lyapunov's function [N m], (K,).
        bound: V_b [N m], (K,).
        tracking: kp (e.e + (1 - e0)^2) + r.J r / 2 [N m], (K,).
        settled: kp e.e where |e| = 0.01 [N m].
        limited: 1 where a limit cut the torque of the period that begins, (K,).
        broken: Assumptions of the theorem that do not hold on this run.
        tolerance: Share by which sampling may take V above its bound.
    """

    t: np.ndarray
    V: np.ndarray
    bound: np.ndarray
    tracking: np.ndarray
    settled: float
    limited: np.ndarray
    broken: tuple[Broken, ...]
    tolerance: float

    @property
    def excess(self) -> np.ndarray:
        """V - V_b as a share, (K,)."""
        return (self.V - self.bound) / self._scale

    @property
    def above(self) -> np.ndarray:
        """Times at which V is above its bound by more than the tolerance, or not a number [s]."""
        return self.t[~(self.excess <= self.tolerance)]

    @property
    def rise(self) -> float:
        """Greatest rise of V above an earlier value, as a share."""
        return float(np.max(self.V - np.minimum.accumulate(self.V)) / self._scale)

    @property
    def gained_while_cut(self) -> float:
        """What V - V_b gained over the periods whose torque a limit cut, as a share."""
        return float(np.sum(np.diff(self.excess)[self.limited[:-1] > 0]))

    @property
    def applies(self) -> bool:
        """Whether all that the theorem assumes holds, but for continuous control."""
        return all(b.assumption == SAMPLED for b in self.broken)

    @property
    def _scale(self) -> float:
        return max(float(np.max(self.tracking)), self.settled)

    def summary(self) -> dict[str, Any]:
        """Return the numbers, as ``summary.json`` holds them."""
        above = self.above
        return {
            "V_start_Nm": float(self.V[0]),
            "V_end_Nm": float(self.V[-1]),
            "bound_end_Nm": float(self.bound[-1]),
            "tracking_max_Nm": float(np.max(self.tracking)),
            "max_excess": float(np.max(self.excess)),
            "max_rise": self.rise,
            "excess_gained_while_cut": self.gained_while_cut,
            "tolerance": self.tolerance,
            "above_bound_from_s": float(above[0]) if len(above) else None,
            "above_bound_share_of_time": len(above) / len(self.t),
            "theorem_applies": self.applies,
            "assumptions_broken": [b.summary() for b in self.broken],
        }

    def words(self) -> str:
        """Return what was found in two sentences."""
        most, above = 100.0 * float(np.max(self.excess)), self.above
        tolerance = f"{100.0 * self.tolerance:g} % of its part from tracking errors"
        course = f"Lyapunov's V goes from {self.V[0]:.3g} to {self.V[-1]:.3g} N m "
        if len(above):
            course += f"and passes its bound by more than {tolerance}, first at {above[0]:.4g} s, "
            course += f"by up to {most:.2g} %. "
        else:
            course += f"and keeps its bound within the {tolerance} that is left to sampling "
            course += f"(at most {max(most, 0.0):.2g} %). "
        real = [str(b) for b in self.broken if b.assumption != SAMPLED]
        if not real:
            return course + "All that the theorem assumes holds, but for continuous control."
        return course + f"The theorem assumes what does not hold here: {'; '.join(real)}."


def monitor(trajectory: Any, tolerance: float = 0.05) -> LyapunovMonitor:
    """Return V and its bound along a run.

    Args:
        trajectory: A `nullmotion.sim.Trajectory` under the controller ``adaptive``.
        tolerance: Share by which sampling may take V above its bound; the startup of Kim et
            al., case 2, takes 0.021 with a period of 0.01 s, half of it with half the period.

    Raises:
        InputError: For another controller, or a tolerance that is not above 0.
    """
    name = getattr(trajectory.setup.controller, "name", None)
    if name != "adaptive" or trajectory.estimates is None:
        raise InputError("controller.name", name, "'adaptive' with VSCMGs, whose theorem this is")
    if not tolerance > 0:
        raise InputError("tolerance", tolerance, "above 0")
    setup, controller = trajectory.setup, trajectory.setup.controller
    rows = np.rint(trajectory.t / setup.dt).astype(int) % setup.period_steps == 0
    true, t = true_parameters(setup), trajectory.t[rows]
    e0, e, r = (x[rows] for x in _errors(trajectory))
    axes = setup.true_array.wheel_axes(trajectory.delta[rows])
    tracking = controller.kp * (np.sum(e * e, axis=1) + (1.0 - e0) ** 2)
    tracking = tracking + 0.5 * true.weighed(axes, r)
    gains = controller.Gamma1, controller.Gamma2, controller.Gamma3
    V = tracking + true.ignorance(trajectory.estimates[rows], gains)
    fall = controller.alpha * controller.kp * np.sum(e * e, 1) + controller.k * np.sum(r * r, 1)
    fallen = np.concatenate([[0.0], np.cumsum(0.5 * (fall[1:] + fall[:-1]) * np.diff(t))])
    found = tuple(broken(trajectory, true, rows))
    return LyapunovMonitor(
        t=t,
        V=V,
        bound=V[0] - fallen,
        tracking=tracking,
        settled=controller.kp * _SETTLED**2,
        limited=trajectory.limited[rows],
        broken=found,
        tolerance=float(tolerance),
    )


def _errors(run: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return e0 (k,), e (k, 3) and r (k, 3) of Eqs 9 and 18 at each row of a run."""
    setup, q = run.setup, run.q_BR
    wanted = np.zeros((len(run.t), 3))
    if setup.reference is not None:
        sample = np.rint(run.t / setup.dt).astype(int) // setup.period_steps
        given = sample < len(setup.reference)  # beyond its end the reference rests
        wanted[given] = setup.reference[sample[given], 4:7]
    wanted = np.einsum("ijk,kj->ki", rotation.matrix(q.T), wanted)
    return q[:, 0], q[:, 1:], run.omega_BN_B - wanted + setup.controller.alpha * q[:, 1:]
