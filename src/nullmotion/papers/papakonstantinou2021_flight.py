"""One run of Papakonstantinou et al. 2021: the quantities that the paper prints and draws.

The terms of its cost are taken from the history in NumPy here, apart from those that
`nullmotion.plan` sums up in its kernels.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.laws.follow_plan import FollowPlan
from nullmotion.plan.costs.papakonstantinou import Papakonstantinou
from nullmotion.sim import Trajectory


@dataclass(frozen=True)
class Terms:
    """Terms of Eq 25 over the samples before each step.

    Attributes:
        mean: w_mean.
        low: Samples with w below its threshold.
        error: Norm of the greatest errors along each axis [rad, or N m s].
        excess: Samples at which a rate above its limit is asked for.
        off_axis: The same norm without roll, about which the paper's first manoeuvre turns.
    """

    mean: float
    low: int
    error: float
    excess: int
    off_axis: float

    def value(self, cost: Papakonstantinou, off_axis: bool = False) -> float:
        """Return the cost, with all axes or those off the manoeuvre's as its third term."""
        g1, g2, g3, g4 = cost.weights
        error = self.off_axis if off_axis else self.error
        return g1 * self.mean / (g2 * self.low + g3 * error + g4 * self.excess)


@dataclass(frozen=True)
class Flight:
    """A run and what it is judged by. Rows are instants; the last has no sample of the law."""

    run: Trajectory
    cost: Papakonstantinou

    @property
    def t(self) -> np.ndarray:
        """Times [s], (N + 1,)."""
        return self.run.t

    @cached_property
    def manipulability(self) -> np.ndarray:
        """Manipulability as the cost takes it: sqrt(det(A A^T)), or its square."""
        w = self.run.measures["sqrt_det_AAT"]
        return np.asarray(w * w if self.cost.index == "det" else w)

    @cached_property
    def attitude_deg(self) -> np.ndarray:
        """Yaw, pitch and roll of the body [deg], (N + 1, 3)."""
        return _euler_deg(self.run.q_BN)

    @cached_property
    def attitude_error_deg(self) -> np.ndarray:
        """Yaw, pitch and roll of the attitude error [deg], (N + 1, 3)."""
        return _euler_deg(self.run.q_BR)

    @cached_property
    def momentum_error(self) -> np.ndarray:
        """What is missing of the momentum asked for [N m s], (N + 1, 3)."""
        target = self.run.setup.momentum_target
        assert target is not None
        return np.asarray(target - self.run.momentum)

    @cached_property
    def greatest_errors(self) -> np.ndarray:
        """Greatest error along each axis: yaw, pitch, roll [rad], or x, y, z [N m s], (3,)."""
        kinematic = self.run.setup.momentum_target is not None
        errors = self.momentum_error if kinematic else np.radians(self.attitude_error_deg)
        return np.asarray(np.abs(errors[:-1]).max(axis=0))

    @cached_property
    def saturated(self) -> np.ndarray:
        """Whether more than the rate limit is asked of a gimbal, (N, n)."""
        return np.asarray(np.abs(self.run.rates_asked[:-1]) > self.run.setup.array.rate_limit)

    @property
    def law(self) -> FollowPlan:
        """The law with its course."""
        assert isinstance(self.run.setup.law, FollowPlan)
        return self.run.setup.law

    @cached_property
    def gain(self) -> np.ndarray:
        """Size k of the null motion over time [rad/s], (N + 1,)."""
        return np.array([self.law.gain(t) for t in self.t.tolist()], float)

    @cached_property
    def null_motion(self) -> np.ndarray:
        """4 k n of Eq 22 before any limit [rad/s], (N + 1, n)."""
        array = self.run.setup.array
        n = np.array([linalg.null_vector(array.unit_jacobian(d)) for d in self.run.delta])
        if self.law.lag:
            n = np.concatenate([np.zeros((1, array.n)), n[:-1]])
        return 4.0 * self.gain[:, None] * n

    @cached_property
    def terms(self) -> Terms:
        """Terms of the cost."""
        w = self.manipulability[:-1]
        errors = self.greatest_errors
        return Terms(
            float(w.mean()),
            int(np.count_nonzero(w < self.cost.manipulability_threshold)),
            float(np.linalg.norm(errors)),
            int(np.count_nonzero(self.saturated.any(axis=1))),
            float(np.linalg.norm(errors[:2])),
        )

    def first_below(self, after: int = 0) -> float:
        """Return when w first falls through its threshold from a row on [s], interpolated."""
        w, level = self.manipulability, self.cost.manipulability_threshold
        falls = np.flatnonzero((w[after:-1] >= level) & (w[after + 1 :] < level))
        return crossing(self.t, w, level, after + int(falls[0]))


def crossing(t: np.ndarray, y: np.ndarray, level: float, row: int) -> float:
    """Return when y passes a level between a row and the next."""
    share = (y[row] - level) / (y[row] - y[row + 1])
    return float(t[row] + share * (t[row + 1] - t[row]))


def _euler_deg(q: np.ndarray | None) -> np.ndarray:
    assert q is not None
    return np.degrees(np.asarray(rotation.euler_321(q.T))).T
