"""Directional singularity escape and avoidance."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, ClassVar, NamedTuple

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.array.momentum_state import command_direction, rotor_directions, working
from nullmotion.law import Claim, Law, Observation, check_parameters, command_size

_FLOOR = 1e-4  # of the other singular values, which vanish only where A loses two ranks
_TIE = 1e-9  # differences below this share of the terms are rounding
_ENUMERATED = 6  # up to so many CMGs every sign pattern is tried


class DseaState(NamedTuple):
    """What the chattering guard remembers of the sample before, each (n,)."""

    theta: Any
    inside: Any
    escape: Any


@dataclass(frozen=True)
class DirectionalEscapeAvoidance(Law):
    """Damping of the singular direction, and rates that lead CMGs off the anti-parallel state.

        delta_dot = A^# hdot + (I - A^# A) delta_s,   A^# = A^T (A A^T + alpha u_m u_m^T)^-1
        alpha     = sigma_min^2 exp(eta (sigma_min^2 - sigma_m^2))                   (13, 14)

    A and hdot are divided by the mean momentum h. With the vehicle's torque
    tau = -hdot, t its direction, a_i and g_i rotor and gimbal axes, for all CMGs with
    a_i . t > 0, those still turned against the wanted momentum:

        |delta_s,i| = d0 (|tau|/tau_max)^xi |tau|^3/(|tau|^3 + tau_min^3) d_i (1 - track)  (20)
        d_i   = (a_i . t)^2                                                          (21)
        track = 1 - sqrt(sum_j (1 - z_j)^2 (u_j . t)^2),  z_j = sigma_j^2/(sigma_j^2 + k_j)
        k_j   = sigma_acp^2 exp(eta (sigma_acp^2 - sigma_j^2))                       (19)

    The signs theta_i in {-1, 1} of delta_s minimise what these CMGs would give together
    once they stand anti-parallel: |sum h_i theta_i f_i r_i|, f_i = g_i x t / |g_i x t|,
    r_i the factors of (20) without d_i and track, times 1 - (g_i . t)^2 (18, 22-25).
    theta is the first minimiser, +1 before -1, the first index changing fastest; that of
    the last CMG stays +1, since -theta gives the same. Beyond six CMGs: from the last
    CMG to the first, each takes the sign that leaves the smaller sum, then two passes
    turn single signs where that helps. A pattern wins only by more than rounding.
    The guard against chattering keeps the signs while the same CMGs take part and little
    is lost, and else the side on which delta_s turned before (Algorithm 2).

    Args:
        sigma_min: Singular value below which the singular direction is damped.
        sigma_acp: Acceptable singular value: below it delta_s sets in.
        eta: How sharply both set in.
        d0: Escape rate [rad/s]; None for 3/pi times the reference rate.
        tau_min: Torque below which nothing is done [N m]; None for 0.001/pi times
            mean momentum times reference rate.
        tau_max: Torque scale [N m]; None for 2/pi, likewise.
        xi: Exponent of the torque.
        as_published: The reading under which Mao's tables come back: d_i and the last
            factor of r_i with tau [N m] in place of t, and no chattering guard.
    """

    name: ClassVar[str] = "dsea"
    full_name: ClassVar[str] = "Directional singularity escape and avoidance"
    aliases: ClassVar[tuple[str, ...]] = ("directional-singularity-escape-avoidance",)
    citation: ClassVar[str] = (
        "Valk, Berry & Vallery, J. Guid. Control Dyn. 41 (2018); "
        "Mao et al., IEEE Access 7 (2019), Eqs 13-26, Algorithms 1, 2"
    )
    claims: ClassVar[frozenset[Claim]] = frozenset(
        {Claim.FINITE, Claim.BOUNDED, Claim.ROTATION, Claim.SCALING, Claim.TIMELESS}
    )

    sigma_min: float = 0.25
    sigma_acp: float = 0.75
    eta: float = 10.0
    d0: float | None = None
    tau_min: float | None = None
    tau_max: float | None = None
    xi: float = 0.5
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(
            self,
            positive=("sigma_min", "sigma_acp", "tau_min", "tau_max"),
            not_negative=("eta", "d0", "xi"),
        )

    def init(self, array: CmgArray, delta: Any) -> DseaState:
        """Start with nothing to remember."""
        return DseaState(np.ones(array.n), np.zeros(array.n), np.zeros(array.n))

    def step(self, array: CmgArray, obs: Observation, state: DseaState) -> tuple[Any, DseaState]:
        """Return the damped rates with the escape rates in their null space."""
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        escape, state = self._escape_rates(array, obs, rows, state)
        alpha = self._onset(self.sigma_min, rows.squares[-1]) * np.eye(array.m)[-1]
        squares = ops.maximum(rows.squares + alpha, _FLOOR * _FLOOR)
        rates = rows.solve(squares)
        return rates + rows.project_out(escape, squares), state

    def _onset(self, sigma: Any, squares: Any) -> Any:
        return sigma * sigma * ops.exp(self.eta * (sigma * sigma - squares))

    def _escape_rates(
        self, array: CmgArray, obs: Observation, rows: linalg.Rows, state: DseaState
    ) -> tuple[Any, DseaState]:
        """Return delta_s (Algorithm 1)."""
        e = command_direction(array, obs.hdot)
        against = -(rotor_directions(array, obs.delta) @ e)
        inside = ops.where(ops.less(_TIE, against), 1.0, 0.0) * working(array)
        size, common, least = self._sizes(array, obs)
        potential = ops.maximum(against, 0.0) * size
        share = self._onset(self.sigma_acp, rows.squares)
        along = rows.along * array.mean_momentum / _nonzero(linalg.norm(obs.hdot))
        lost = share / (rows.squares + share) * along
        magnitude = inside * (common * linalg.norm(lost)) * (potential * potential)
        arms = _anti_parallel(array, e) * (array.h0 / array.mean_momentum)[:, None]
        arms = arms * (inside * (common * size * size))[:, None]
        theta = _best_signs(arms)
        if not self.as_published:
            theta = _guarded(theta, arms, inside, magnitude, least, state)
        escape = theta * magnitude
        return escape, DseaState(theta, inside, escape)

    def _sizes(self, array: CmgArray, obs: Observation) -> tuple[Any, Any, Any]:
        """Return |t| or |tau| for Eqs 21, 22, the factor before d_i in Eq 20, and tau_min / h."""
        unit = array.reference_rate / np.pi
        h = array.mean_momentum
        tau = command_size(array, obs)
        least = 0.001 * unit if self.tau_min is None else self.tau_min / h
        most = 2.0 * unit if self.tau_max is None else self.tau_max / h
        rate = 3.0 * unit if self.d0 is None else self.d0
        enough = ops.less_equal(least, tau)
        safe = ops.where(enough, tau, least)
        cube = safe * safe * safe
        onset = cube / (cube + least * least * least)
        common = rate * ops.exp(self.xi * ops.log(safe / most)) * onset
        size = tau * h if self.as_published else 1.0
        return size, ops.where(enough, common, 0.0), least


def _nonzero(x: Any) -> Any:
    return ops.where(ops.less(0.0, x), x, 1.0)


def _anti_parallel(array: CmgArray, e: Any) -> Any:
    """Return f_i (1 - (g_i . t)^2) = (g_i x t) |g_i x t| for t = -e, (n, 3)."""
    f = [linalg.cross(e, g) for g in array.gimbal_axes]
    return np.stack([v * linalg.norm(v) for v in f])


def _best_signs(arms: Any) -> Any:
    """Return the signs under which the arms sum to the least."""
    return _enumerated(arms) if len(arms) <= _ENUMERATED else _greedy(arms)


def _enumerated(arms: Any) -> Any:
    n = len(arms)
    tie = _TIE * sum(linalg.norm(arm) for arm in arms)
    best, least = np.ones(n), linalg.norm(arms.sum(axis=0))
    for signs in product((1.0, -1.0), repeat=n - 1):
        theta = np.array([*reversed(signs), 1.0])
        length = linalg.norm(theta @ arms)
        better = ops.less(length, least - tie)
        best, least = ops.where(better, theta, best), ops.where(better, length, least)
    return best


def _greedy(arms: Any) -> Any:
    n = len(arms)
    tie = _TIE * sum(arm @ arm for arm in arms)
    total, theta = 1.0 * arms[n - 1], [1.0] * n
    for i in reversed(range(n - 1)):
        theta[i] = ops.where(ops.less(tie, total @ arms[i]), -1.0, 1.0)
        total = total + theta[i] * arms[i]
    for i in [*range(n - 1)] * 2:
        turned = total - (2.0 * theta[i]) * arms[i]
        better = ops.less(turned @ turned, total @ total - tie)
        total, theta[i] = ops.where(better, turned, total), ops.where(better, -theta[i], theta[i])
    return np.array(theta)


def _guarded(
    theta: Any, arms: Any, inside: Any, magnitude: Any, least: Any, state: DseaState
) -> Any:
    """Return the signs after the guard against chattering (Algorithm 2)."""
    gain = linalg.norm(state.theta @ arms) - linalg.norm(theta @ arms)
    change = ops.absolute(inside - state.inside).sum()
    keep = ops.logical_and(ops.less(change, 0.5), ops.less(ops.absolute(gain), least))
    wanted = theta * magnitude
    along = wanted @ state.escape
    reach = (wanted @ wanted) * (state.escape @ state.escape)
    same = ops.less_equal(-_TIE * ops.sqrt(reach), along)
    return ops.where(keep, state.theta, ops.where(same, theta, -theta))
