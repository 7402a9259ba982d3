"""The history of one run and what is derived from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.array import momentum_state
from nullmotion.sim import wheel_summary
from nullmotion.sim.setup import Setup
from nullmotion.spacecraft import faults
from nullmotion.vscmg import dynamics
from nullmotion.vscmg.hardware import rest_inertia


@dataclass(frozen=True)
class Trajectory:
    """One run. Rows are the states at t_0 ... t_N; rates act from their row on.

    Attributes:
        setup: What was run.
        t: Times [s], (N+1,).
        delta: True gimbal angles [rad], (N+1, n).
        rates: Applied gimbal rates [rad/s], (N+1, n); NaN in the last row.
        rates_asked: What the law asked before the rate limit [rad/s], (N+1, n).
        hdot: Commanded rate of momentum [N m], (N+1, m).
        momentum_wanted: h(0) + integral of hdot [N m s], (N+1, m).
        impulse: Integral of the achieved torque [N m s], (N+1, m).
        metrics: Sums over the run, such as ``min_sigma_min``.
        stopped_at_s: When a stop condition ended the run; None if none did.
        stop_reason: The condition, or ``end of run``.
        status: Flags that the run raised; empty if all is well.
        backend: ``kernel`` or ``python``.
        instruction_set: Vector instructions of the kernel.
        speed: Gimbal rates at each instant [rad/s], (N+1, n); `rates` are their means over steps.
        motor_torque: Torque of the gimbal motors [N m], (N+1, n); NaN in the last row.
        q_BN: Attitude, (N+1, 4); None without a spacecraft, as the next two.
        omega_BN_B: Body rate in B [rad/s], (N+1, 3).
        reference: Attitude to be reached or followed, q_RN, (N+1, 4).
        wheel_momentum: Of the reaction wheel [N m s], (N+1,); None without one, as the next.
        wheel_torque: Rate of its momentum [N m], (N+1,); NaN in the last row.
        law_counts: What the law counted on the way, such as solutions that did not come.
        wheel_speed: Wheel speeds of variable-speed CMGs [rad/s], (N+1, n); None, as all that
            follow, where they are constant.
        wheel_acceleration: Their derivatives over the steps [rad/s^2], (N+1, n).
        wheel_motor_torque: Torque of the wheel motors [N m], (N+1, n).
        limited: 1 where a limit kept back some of the torque that was asked for, else 0, (N+1,).
        motor_work: Work of all motors so far, less friction [J], (N+1,); torque-driven units.
        estimates: State of the controller, (N+1, ...).
    """

    setup: Setup
    t: np.ndarray
    delta: np.ndarray
    rates: np.ndarray
    rates_asked: np.ndarray
    hdot: np.ndarray
    momentum_wanted: np.ndarray
    impulse: np.ndarray
    metrics: Mapping[str, float]
    stopped_at_s: float | None
    stop_reason: str
    status: list[str] = field(default_factory=list)
    backend: str = "kernel"
    instruction_set: str = ""
    speed: np.ndarray | None = None
    motor_torque: np.ndarray | None = None
    q_BN: np.ndarray | None = None
    omega_BN_B: np.ndarray | None = None
    reference: np.ndarray | None = None
    wheel_momentum: np.ndarray | None = None
    wheel_torque: np.ndarray | None = None
    law_counts: Mapping[str, int] = field(default_factory=dict)
    wheel_speed: np.ndarray | None = None
    wheel_acceleration: np.ndarray | None = None
    wheel_motor_torque: np.ndarray | None = None
    limited: np.ndarray | None = None
    motor_work: np.ndarray | None = None
    estimates: np.ndarray | None = None

    @cached_property
    def momentum(self) -> np.ndarray:
        """Momentum of the true array [N m s], (N+1, m)."""
        array = self.setup.true_array
        if self.wheel_speed is not None:
            return self._wheel_momentum(array.wheel_axes(self.delta), self.wheel_speed)
        if not faults.of_kind(self.setup.events, "spin-down"):
            return array.momentum(self.delta)
        turning = np.einsum("kn,knm->km", self._shares(), array.rotor_momenta(self.delta))
        return turning + array.torque_axes @ array.momentum_bias

    def _wheel_momentum(self, directions: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return the sum of I_W Omega times directions of each CMG, (N+1, m)."""
        array = self.setup.true_array
        total = np.einsum("kmn,kn->km", directions, array.flywheels.inertia * speed)
        found: np.ndarray = total + array.torque_axes @ array.momentum_bias
        return found

    def _shares(self) -> np.ndarray:
        """Return what share of its momentum each wheel still has, (N+1, n)."""
        spinning = faults.of_kind(self.setup.events, "spin-down")
        return faults.shares(spinning, self.setup.array.n, self.t)

    @cached_property
    def q_BR(self) -> np.ndarray | None:
        """Attitude error against the reference, scalar part not negative, (N+1, 4)."""
        if self.q_BN is None or self.reference is None:
            return None
        error = rotation.multiply(rotation.conjugate(self.reference.T), self.q_BN.T)
        turned: np.ndarray = rotation.shortest(error).T
        return turned

    @cached_property
    def pointing_error(self) -> np.ndarray | None:
        """Angle between attitude and reference [rad], (N+1,)."""
        if self.q_BR is None:
            return None
        sine = np.linalg.norm(self.q_BR[:, 1:], axis=1)
        return 2.0 * np.arctan2(sine, np.abs(self.q_BR[:, 0]))

    @cached_property
    def inertial_momentum(self) -> np.ndarray | None:
        """Angular momentum of spacecraft and array in N [N m s], (N+1, 3)."""
        craft, servo = self.setup.spacecraft, self.setup.servo
        if craft is None or self.q_BN is None or self.omega_BN_B is None:
            return None
        array = self.setup.true_array
        if self.wheel_speed is not None:
            return np.einsum("kij,ki->kj", _matrices(self.q_BN), self._vscmg_momentum())
        total = self.omega_BN_B @ craft.inertia + self.momentum @ array.torque_axes
        if self.setup.reaction_wheel is not None and self.wheel_momentum is not None:
            total = total + self.wheel_momentum[:, None] * self.setup.reaction_wheel.axis
        if servo is not None and self.speed is not None:
            total = total + (servo.inertia * self.speed) @ array.gimbal_axes
        return np.einsum("kij,ki->kj", _matrices(self.q_BN), total)

    def _vscmg_momentum(self) -> np.ndarray:
        """Return the angular momentum of everything in B [N m s], (N+1, 3)."""
        setup = self.setup
        assert setup.units is not None and setup.spacecraft is not None
        return dynamics.total_momentum(
            setup.true_array,
            setup.units,
            rest_inertia(setup.true_array, setup.units, setup.spacecraft.inertia, setup.delta),
            self.delta,
            self.omega_BN_B,
            self.speed,
            self.wheel_speed,
        )

    @cached_property
    def torque(self) -> np.ndarray:
        """Achieved rate of momentum A delta_dot [N m], (N+1, m); the vehicle gets its negative.

        With variable wheel speeds: A delta_dot + C_W I_W Omega_dot.
        """
        if self.wheel_speed is not None and self.wheel_acceleration is not None:
            array = self.setup.true_array
            turned = self._wheel_momentum(
                array.transverse_directions(self.delta), self.wheel_speed * self.rates
            )
            spun = self._wheel_momentum(array.wheel_axes(self.delta), self.wheel_acceleration)
            return turned + spun - 2.0 * (array.torque_axes @ array.momentum_bias)
        return np.einsum("kmn,kn->km", self._jacobians, self.rates)

    @cached_property
    def _jacobians(self) -> np.ndarray:
        return self.setup.true_array.jacobian(self.delta) * self._shares()[:, None, :]

    @cached_property
    def measures(self) -> dict[str, np.ndarray]:
        """Singularity measures and momentum state along the run, each (N+1,)."""
        s = self._singular_values
        return {
            "sigma_min": s[:, -1],
            "sqrt_det_AAT": np.prod(s, axis=1),
            "condition_number": s[:, 0] / np.maximum(s[:, -1], 1e-16),
            "residual_momentum": self.eram.sum(axis=1),
            "momentum_state": self.eram.sum(axis=1) + s[:, -1],
        }

    @cached_property
    def _working(self) -> np.ndarray:
        """Spin momentum of each CMG that turns [N m s], (N+1, n); 0 for a stuck one."""
        array, events = self.setup.true_array, self.setup.events
        return array.h0 * faults.shares(events, array.n, self.t)

    @cached_property
    def _singular_values(self) -> np.ndarray:
        """Singular values of A / mean momentum, descending; NaN where angles are not finite."""
        array, working = self.setup.true_array, self._working
        mean = working.sum(axis=1) / np.maximum((working > 0).sum(axis=1), 1)
        whole = array.h0 * mean[:, None]
        share = working / np.where(whole > 0, whole, 1.0)
        jacobians = array.jacobian(self.delta) * share[:, None, :]
        known = np.isfinite(jacobians).all(axis=(1, 2))
        s = np.full((len(jacobians), array.m), np.nan)
        found = np.linalg.svd(jacobians[known], compute_uv=False)
        s[known] = np.pad(found, ((0, 0), (0, array.m - found.shape[1])))
        return s

    @cached_property
    def eram(self) -> np.ndarray:
        """Effective residual angular momentum of each CMG (Mao 2019, Eq 28), (N+1, n)."""
        found = momentum_state.eram(self.setup.true_array, self.delta, self.hdot)
        found = found * (self._working > 0)
        return np.where(np.isfinite(self.delta).all(axis=1, keepdims=True), found, np.nan)

    @cached_property
    def desaturation_due_at_s(self) -> float | None:
        """When Mao 2019, Eq 39, first calls for desaturation [s]; None if it never does."""
        given = {
            k: getattr(self.setup.law, k)
            for k in ("epsilon", "epsilon1", "sigma_c")
            if hasattr(self.setup.law, k)
        }
        due = momentum_state.desaturation_due(
            self.measures["momentum_state"], self.measures["sigma_min"], **given
        )
        return float(self.t[np.argmax(due)]) if due.any() else None

    def summary(self) -> dict[str, Any]:
        """Return the numbers of the run, as ``summary.json`` holds them."""
        return {
            "law": self.setup.law.name,
            "stopped_at_s": self.stopped_at_s,
            "stop_reason": self.stop_reason,
            "duration_s": round(float(self.t[-1]), 12),
            "steps": len(self.t) - 1,
            "final_momentum": self.momentum[-1].tolist(),
            "final_gimbal_deg": np.degrees(self.delta[-1]).tolist(),
            "momentum_state": momentum_state.describe(self.measures["momentum_state"][-1]),
            "desaturation_due_at_s": self.desaturation_due_at_s,
            **self._attitude(),
            **{key: float(value) for key, value in self.metrics.items()},
            **({"law_counts": dict(self.law_counts)} if self.law_counts else {}),
            **self._wheels(),
            "status": list(self.status) or ["ok"],
            "backend": self.backend,
            "instruction_set": self.instruction_set,
        }

    def _attitude(self) -> dict[str, Any]:
        if self.q_BN is None or self.omega_BN_B is None:
            return {}
        yaw_pitch_roll = np.degrees(rotation.euler_321(self.q_BN[-1]))
        return {
            "final_q_BN": self.q_BN[-1].tolist(),
            "final_euler_321_deg": yaw_pitch_roll.tolist(),
            "final_omega_BN_B_rad_s": self.omega_BN_B[-1].tolist(),
        }

    def _wheels(self) -> dict[str, Any]:
        if self.wheel_speed is None:
            return {}
        return {"wheels": wheel_summary.wheels(self), "limited": wheel_summary.limits(self)}

    def to_xarray(self) -> Any:
        """Return the run as an `xarray.Dataset` with units and conventions."""
        from nullmotion.scenario import store

        return store.to_xarray(self)


def _matrices(q: np.ndarray) -> np.ndarray:
    """Return the direction cosine matrices C_BN of quaternions (k, 4), (k, 3, 3)."""
    return np.moveaxis(rotation.matrix(q.T), -1, 0)
