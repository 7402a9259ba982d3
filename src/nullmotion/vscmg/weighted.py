"""Weighted allocation of torque to wheels and gimbals, with null motion (Kim et al., Eqs 27-43)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops

_SHORT = 1e-6  # of a torque: what may be missing of one that is reached
_TINY = 1e-30  # an inverse stays finite where nothing turns and nothing can


class Command(NamedTuple):
    """Wheel accelerations [rad/s^2] and gimbal rates [rad/s], (n,) each."""

    wheel: Any
    gimbal: Any

    def plus(self, other: Command, share: Any = 1.0) -> Command:
        """Return this command and a share of another."""
        return Command(self.wheel + share * other.wheel, self.gimbal + share * other.gimbal)

    def scaled(self, share: Any) -> Command:
        """Return the command times a factor."""
        return Command(share * self.wheel, share * self.gimbal)

    def spare(self, low: Command, high: Command) -> Any:
        """Return for each wheel how much of its acceleration is within bounds, 0 to 1, (n,)."""
        bound = ops.where(ops.less(self.wheel, 0.0), -low.wheel, high.wheel)
        bound, size = ops.maximum(bound, 0.0), ops.absolute(self.wheel)
        fits = ops.less_equal(size, bound)
        return ops.where(fits, 1.0, bound / (size + _TINY))

    def share_within(self, low: Command, high: Command) -> Any:
        """Return the largest factor up to 1 that keeps this command within bounds about 0."""
        share: Any = 1.0
        for value, least, most in zip(self, low, high, strict=True):
            for x, below, above in zip(value, least, most, strict=True):
                bound = ops.maximum(ops.where(ops.less(x, 0.0), -below, above), 0.0)
                size = ops.absolute(x)
                fits = ops.less_equal(size, bound)
                share = ops.minimum(share, ops.where(fits, 1.0, bound / (size + _TINY)))
        return share


class Weighted(NamedTuple):
    """Q = [Q_1, Q_2], the torque matrix of wheels and gimbals, with weights W.

        Q_W^+ = W Q^T (Q W Q^T)^-1,     N = 1 - Q_W^+ Q

    Attributes:
        Q1: Columns of the wheels, (m, n).
        Q2: Columns of the gimbals, (m, n).
        weights: Diagonal of W.
    """

    Q1: Any
    Q2: Any
    weights: Command

    @property
    def _parts(self) -> tuple[Any, Any]:
        """Return Q_1 W_1 Q_1^T and Q_2 W_2 Q_2^T, (m, m)."""
        Q1, Q2, W = self
        return (Q1 * W.wheel) @ Q1.T, (Q2 * W.gimbal) @ Q2.T

    def ranged(self, torque: Any) -> Command:
        """Return Q_W^+ torque, damped to rounding where Q has lost rank."""
        wheel, gimbal = self._parts
        y = linalg.solve(_regular(wheel + gimbal), torque)
        return Command(self.weights.wheel * (self.Q1.T @ y), self.weights.gimbal * (self.Q2.T @ y))

    def within(self, torque: Any, low: Command, high: Command) -> Command:
        """Return as much of Q_W^+ torque as bounds allow, in its direction.

        Wheels that would pass a bound are weighed by the square of what is left to them first: one
        that is at its limit leaves the torque to the others.
        """
        spare = self.ranged(torque).spare(low, high)
        wheel = self.weights.wheel * spare * spare
        command = self._replace(weights=Command(wheel, self.weights.gimbal)).ranged(torque)
        short = self.Q1 @ command.wheel + self.Q2 @ command.gimbal - torque
        reached = ops.less_equal(short @ short, _SHORT * _SHORT * (torque @ torque))
        return command.scaled(ops.where(reached, command.share_within(low, high), 0.0))

    def null(self, goal: Any, turn: Any, s_w: Any, damping: Any) -> Command:
        """Return N [v; turn] with v so that the wheels' part comes to the goal (Eqs 42, 43).

        The wheels' block of N is 1 - W_1 Q_1^T (Q W Q^T)^-1 Q_1; its inverse by Woodbury's
        identity 1 + W_1 Q_1^T (Q_2 W_2 Q_2^T)^-1 Q_1, damped in proportion to Q_1 W_1 Q_1^T.

        Args:
            goal: Wheel accelerations wanted [rad/s^2], (n,).
            turn: Gimbal rates before the projection [rad/s], (n,).
            s_w: What the wheels' goal counts (Eq 33), 0 to 1.
            damping: Share of Q_1 W_1 Q_1^T; where s_w^2 Q_2 W_2 Q_2^T is small against it the
                wheels serve the torque, not the goal.
        """
        wheel, gimbal = self._parts
        beside = self.ranged(self.Q2 @ turn)
        v = goal + beside.wheel
        weight = s_w * s_w  # both sides by it: it may be no number above 0
        inverse = linalg.solve(_regular(weight * gimbal + damping * wheel), weight * (self.Q1 @ v))
        v = v + self.weights.wheel * (self.Q1.T @ inverse)
        used = self.ranged(self.Q1 @ v)
        return Command(v - used.wheel - beside.wheel, turn - used.gimbal - beside.gimbal)


def _regular(M: Any) -> Any:
    """Return a symmetric matrix and what keeps its inverse finite: 1e-12 of its mean."""
    m = M.shape[0]
    mean = sum(M[i, i] for i in range(m)) * (1.0 / m)
    return M + (1e-12 * mean + _TINY) * np.eye(m)
