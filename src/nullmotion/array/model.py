"""A control moment gyroscope array: axes, momenta, limits.

Conventions (docs/conventions.md): CMG i has gimbal axis g_i, spin axis s_i at
delta_i = 0 and t_i = g_i x s_i, all unit vectors in the body frame B. Then

    h_i(delta_i) = h0_i (s_i cos delta_i + t_i sin delta_i)
    h(delta)     = bias + sum_i h_i,      A = dh/d(delta)

and the torque on the vehicle is -A delta_dot - omega x h.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from nullmotion import ops
from nullmotion.array.checks import as_vectors, checked_axes, checked_limits, per_cmg, torque_basis
from nullmotion.array.wheels import Wheels
from nullmotion.errors import InputError

RateLimitMode = Literal["scale", "clip"]


@dataclass(frozen=True, eq=False)
class CmgArray:
    """An array of n single-gimbal control moment gyroscopes with m torque dimensions.

    Args:
        gimbal_axes: Unit gimbal axes g_i in B, (n, 3).
        spin_axes: Unit spin axes s_i at delta_i = 0 in B, (n, 3), perpendicular to g_i.
        h0: Spin momentum of each CMG [N m s], one number or (n,).
        rate_limit: Largest gimbal rate [rad/s], one number or (n,); infinite if none.
        rate_limit_mode: ``scale`` all rates by one factor (keeps the torque's
            direction) or ``clip`` each by itself.
        angle_limits: Lowest and highest gimbal angle [rad], (2,) or (n, 2).
        momentum_bias: Constant momentum beside the CMGs' [N m s], (3,), such as a frozen CMG's.
        torque_axes: Orthonormal directions in which the array gives torque, (m, 3); by
            default all of B, or the common plane when all gimbal axes are parallel.
        label: Name for reports.
        wheels: Flywheels whose speed may change (VSCMGs); None when the speeds are constant.

    Raises:
        InputError: For axes that are not unit vectors or not perpendicular, negative
            momenta, limits that are not positive, and the like.
    """

    gimbal_axes: np.ndarray
    spin_axes: np.ndarray
    h0: np.ndarray = field(default_factory=lambda: np.array(1.0))
    rate_limit: np.ndarray = field(default_factory=lambda: np.array(np.inf))
    rate_limit_mode: RateLimitMode = "scale"
    angle_limits: np.ndarray = field(default_factory=lambda: np.array([-np.inf, np.inf]))
    momentum_bias: np.ndarray = field(default_factory=lambda: np.zeros(3))
    torque_axes: np.ndarray | None = None
    label: str = "custom"
    wheels: Wheels | None = None

    def __post_init__(self) -> None:
        """Check and normalise; symbols are put in by `nullmotion.tree` without this."""
        gimbal, spin = checked_axes(self.gimbal_axes, self.spin_axes)
        n = len(gimbal)
        put = object.__setattr__
        put(self, "gimbal_axes", gimbal)
        put(self, "spin_axes", spin)
        put(
            self,
            "h0",
            per_cmg(
                "h0", self.h0, n, "finite and not negative", lambda v: (v >= 0) & np.isfinite(v)
            ),
        )
        if not np.any(self.h0 > 0):
            raise InputError("h0", self.h0.tolist(), "at least one CMG with momentum")
        put(
            self,
            "rate_limit",
            per_cmg("rate_limit", self.rate_limit, n, "above 0 (rad/s)", lambda v: v > 0),
        )
        if self.rate_limit_mode not in ("scale", "clip"):
            raise InputError("rate_limit_mode", self.rate_limit_mode, "'scale' or 'clip'")
        put(self, "angle_limits", checked_limits("angle_limits", self.angle_limits, n))
        put(self, "momentum_bias", as_vectors("momentum_bias", self.momentum_bias, 1)[0])
        if self.wheels is not None:
            put(self, "wheels", self.wheels.for_n(n))
        put(
            self,
            "torque_axes",
            torque_basis(gimbal) if self.torque_axes is None else self._checked_basis(),
        )

    def _checked_basis(self) -> np.ndarray:
        basis = as_vectors("torque_axes", self.torque_axes)
        if not np.allclose(basis @ basis.T, np.eye(len(basis)), atol=1e-9):
            raise InputError("torque_axes", basis.tolist(), "orthonormal rows")
        return basis

    @property
    def n(self) -> int:
        """Number of CMGs."""
        return len(self.gimbal_axes)

    @property
    def m(self) -> int:
        """Number of torque dimensions."""
        return len(self._basis)

    @property
    def _basis(self) -> np.ndarray:
        assert self.torque_axes is not None
        return self.torque_axes

    @property
    def transverse_axes(self) -> np.ndarray:
        """Torque axes t_i = g_i x s_i at delta_i = 0, (n, 3)."""
        g, s = self.gimbal_axes, self.spin_axes
        return np.stack(
            [
                g[:, 1] * s[:, 2] - g[:, 2] * s[:, 1],
                g[:, 2] * s[:, 0] - g[:, 0] * s[:, 2],
                g[:, 0] * s[:, 1] - g[:, 1] * s[:, 0],
            ],
            axis=1,
        )

    @property
    def mean_momentum(self) -> Any:
        """Mean spin momentum of the working CMGs [N m s]: the scale of every measure."""
        working = ops.where(ops.less(0.0, self.h0), 1.0, 0.0)
        return sum(self.h0) / sum(working)

    @property
    def reference_rate(self) -> Any:
        """Rate that laws scale their own rates by: the least rate limit, pi rad/s if none."""
        least = ops.amin(self.rate_limit)
        return ops.where(ops.less(least, np.inf), least, np.pi)

    @property
    def flywheels(self) -> Wheels:
        """The flywheels of variable-speed CMGs.

        Raises:
            InputError: When the wheels' speeds are constant.
        """
        if self.wheels is None:
            raise InputError("array.wheels", None, "flywheels, for variable-speed CMGs")
        return self.wheels

    @property
    def design_speed(self) -> Any:
        """Wheel speeds that give the momenta h0 [rad/s], (n,); for VSCMGs."""
        return self.h0 / self.flywheels.inertia

    def _spin(self) -> Any:
        return (self.spin_axes @ self._basis.T) * self.h0[:, None]

    def _transverse(self) -> Any:
        return (self.transverse_axes @ self._basis.T) * self.h0[:, None]

    def wheel_axes(self, delta: Any) -> Any:
        """Return C_W, the directions of the spin axes, (..., m, n), for angles (..., n) [rad]."""
        delta = np.asarray(delta)
        s, t = self.spin_axes @ self._basis.T, self.transverse_axes @ self._basis.T
        return ops.cos(delta)[..., None, :] * s.T + ops.sin(delta)[..., None, :] * t.T

    def transverse_directions(self, delta: Any) -> Any:
        """Return C_T, the derivatives of C_W by the angles, (..., m, n): A = C_T diag(h0)."""
        delta = np.asarray(delta)
        s, t = self.spin_axes @ self._basis.T, self.transverse_axes @ self._basis.T
        return ops.cos(delta)[..., None, :] * t.T - ops.sin(delta)[..., None, :] * s.T

    def rotor_momenta(self, delta: Any) -> Any:
        """Return each CMG's momentum h_i [N m s], (..., n, m)."""
        delta = np.asarray(delta)
        return (
            ops.cos(delta)[..., None] * self._spin()
            + ops.sin(delta)[..., None] * self._transverse()
        )

    def momentum(self, delta: Any) -> Any:
        """Return the array's momentum h(delta) [N m s], (..., m), for angles (..., n) [rad]."""
        delta = np.asarray(delta)
        turning = ops.cos(delta) @ self._spin() + ops.sin(delta) @ self._transverse()
        return turning + self._basis @ self.momentum_bias

    def jacobian(self, delta: Any) -> Any:
        """Return A = dh/d(delta) [N m s/rad], (..., m, n), for angles (..., n) [rad]."""
        delta = np.asarray(delta)
        return (
            ops.cos(delta)[..., None, :] * self._transverse().T
            - ops.sin(delta)[..., None, :] * self._spin().T
        )

    def unit_jacobian(self, delta: Any) -> Any:
        """Return A divided by `mean_momentum` (dimensionless), (..., m, n)."""
        return self.jacobian(delta) / self.mean_momentum

    def limited(self, rates: Any) -> Any:
        """Return gimbal rates (..., n) within the rate limit, by `rate_limit_mode` [rad/s]."""
        if self.rate_limit_mode == "clip":
            return ops.clip(rates, -self.rate_limit, self.rate_limit)
        excess = ops.amax(ops.absolute(rates) * (1.0 / self.rate_limit))
        factor = 1.0 / ops.where(ops.less(1.0, excess), excess, 1.0)
        return rates * np.asarray(factor)[..., None]

    def altered(self, **fields: Any) -> CmgArray:
        """Return a copy with some fields replaced, unchecked: they may hold symbols."""
        copy = object.__new__(CmgArray)
        for name in self.__dataclass_fields__:
            object.__setattr__(copy, name, fields.get(name, getattr(self, name)))
        return copy

    def within_angle_limits(self, delta: Any) -> Any:
        """Return angles stopped at the gimbals' end stops [rad]."""
        if not self.has_angle_limits:
            return delta
        return ops.clip(delta, self.angle_limits[:, 0], self.angle_limits[:, 1])

    @property
    def has_angle_limits(self) -> bool:
        """Whether any gimbal has an end stop."""
        return any(ops.is_symbolic(v) or np.isfinite(v) for v in np.ravel(self.angle_limits))

    def without(
        self, failed: int | Iterable[int], frozen_at: float | Iterable[float] | None = None
    ) -> CmgArray:
        """Return the array after CMGs failed.

        Args:
            failed: Index of a CMG counted from 0, or several.
            frozen_at: Gimbal angle [rad] at which each failed CMG stays with its wheel
                spinning, its momentum kept as bias; one, or one for each in the order of
                ``failed``. Without it the momentum is gone.

        Raises:
            InputError: For an index out of range, or when no CMG would be left.
        """
        gone = [int(failed)] if isinstance(failed, (int, np.integer)) else [int(i) for i in failed]
        if (
            not gone
            or min(gone) < 0
            or max(gone) >= self.n
            or not len(set(gone)) == len(gone) < self.n
        ):
            allowed = f"different indices 0 to {self.n - 1}, at least one CMG left"
            raise InputError("failed CMG", gone, allowed)
        keep = [i for i in range(self.n) if i not in gone]
        bias = self.momentum_bias
        if frozen_at is not None:
            angles = per_cmg("frozen_at", frozen_at, len(gone), "finite angles (rad)", np.isfinite)
            c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
            held = c * self.spin_axes[gone] + s * self.transverse_axes[gone]
            bias = bias + self.h0[gone] @ held
        return CmgArray(
            self.gimbal_axes[keep],
            self.spin_axes[keep],
            self.h0[keep],
            self.rate_limit[keep],
            self.rate_limit_mode,
            self.angle_limits[keep],
            bias,
            self.torque_axes,
            f"{self.label} without CMG {', '.join(str(i) for i in sorted(gone))}",
            self.wheels and self.wheels.kept(keep),
        )
